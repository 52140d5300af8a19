"""Signals at random moments of every command that writes: each file is whole or absent, and a store goes on.

SIGKILL leaves a file as it was, or as the command writes it when left alone. After SIGTERM or SIGINT a command may write
what it has so far: then the file is complete of its kind, as must be those that hold measured times."""

import json
import os
import random
import shutil
import signal
import subprocess
import time

SERVO = "cases/pid-lugre.toml"
SWEEP = ["--x", "loop.controller.kp=1:5:6", "--y", "loop.controller.kd=1:9:6"]
OVER = "cases/over-compensated.toml"
OLD = b"what stood there before\n"
MEASURES_TIME = ("precision",)  # no two documents of theirs are the same
SIGNALS = (signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT)


def commands(folder):
    """Arguments of each command, the files it writes, and the store it keeps."""
    def file(name):
        return os.path.join(folder, name)

    documents = ["--json", file("a.json"), "--csv", file("a.csv"), "-o", file("a.txt")]
    three = [file("a.json"), file("a.csv"), file("a.txt")]
    page = ["--html", file("a.html"), *documents]
    drawn = [*page, "--svg", file("a.svg")]
    all_drawn = [*three, file("a.html"), file("a.svg")]
    store = file("a.store")
    records = [os.path.join("rig", name) for name in (
        "break-away.csv", "identify.toml", "lag.csv", "pre-sliding.csv", "steady-velocity.csv")]
    return [
        (["check", SERVO, *documents], three, None),
        (["new", "-o", file("new.toml"), "--force"], [file("new.toml")], None),
        (["laws", *documents], three, None),
        (["simulate", "cases/tutorial-servo.toml", "--set", "simulate.duration=5.0", *documents], three, None),
        (["predict", "cases/saturation.toml", "--svg", file("a.svg"), *page], [*three, file("a.html"), file("a.svg")], None),
        (["report", "cases/saturation.toml", "--quick", "-o", file("a.html"), "--json", file("a.json")],
         [file("a.html"), file("a.json")], None),
        (["dissipativity", "cases/presets/lugre.toml", *page], [*three, file("a.html")], None),
        (["df", "cases/df-lugre.toml", "--store", store, *documents], three, store),
        (["map", SERVO, *SWEEP, "--store", store, *page], [*three, file("a.html")], store),
        (["sensitivity", SERVO, "--samples", "8", "--trajectories", "4", "--store", store, *page],
         [*three, file("a.html")], store),
        (["continue", "cases/belt-lugre.toml", "--parameter", "loop.plant.speed=0.1:0.12", *documents], three, None),
        (["margin", "cases/saturation.toml", "--parameter", "loop.element.limit", *page], [*three, file("a.html")], None),
        (["remedy", OVER, "--only", "gain-kp", *page], [*three, file("a.html")], None),
        (["remedy", OVER, "--apply", "gain-kp", "-o", file("a.toml")], [file("a.toml")], None),
        (["tune", SERVO, "--vary", "kp=1:2", "--minimise", "ms", "--samples", "1", *drawn], all_drawn, None),
        (["identify", "cases/records/servo.toml", "--fitted", file("a.toml"), "--svg", file("a.svg"), *documents],
         [*three, file("a.toml"), file("a.svg")], None),
        (["synthesize", SERVO, "-o", file("rig"), "--force", "--json", file("a.json")],
         [*map(file, records), file("a.json")], None),
        (["precision", "cases/saturation.toml", *page], [*three, file("a.html")], None),
        (["claims", "A1", *page], [*three, file("a.html")], None),
        (["experiment", "steady-velocity", "--law", "lugre", *drawn], all_drawn, None),
        (["completion", "bash", "-o", file("a.txt")], [file("a.txt")], None),
        (["manual", "predict", "-o", file("a.txt")], [file("a.txt")], None)]


def contents(files):
    found = {}
    for file in files:
        if os.path.exists(file):
            with open(file, "rb") as stream:
                found[file] = stream.read()
    return found


def listed(folder):
    """Names of all files, those in folders too."""
    return sorted(os.path.relpath(os.path.join(where, name), folder)
                  for where, _, names in os.walk(folder) for name in names)


def emptied(folder, files):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    for file in files:
        os.makedirs(os.path.dirname(file), exist_ok=True)


def complete(file, body):
    """Is it a whole document of its kind, whatever it holds?"""
    kind = os.path.splitext(file)[1]
    if kind == ".json":
        try:
            return "schema" in json.loads(body)
        except ValueError:
            return False
    return body.rstrip().endswith({".html": b"</html>", ".svg": b"</svg>"}.get(kind, b"")) and body.endswith(b"\n")


def start(program, arguments):
    # A shell that runs this in the background has SIGINT ignored, and the program would go on ignoring it.
    return subprocess.Popen([program, *arguments, "--quiet"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL,
                            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))


def kill_at(process, folder, took, rng, number):
    """Sends the signal anywhere in the run, near its end, or as soon as anything changes in the folder of its files."""
    way = rng.randrange(3)
    if way < 2:
        time.sleep(rng.uniform(0.0, took) if way == 0 else took * rng.uniform(0.9, 1.05))
    else:
        before = listed(folder)
        while process.poll() is None and listed(folder) == before:
            pass
        time.sleep(rng.choice((0.0, 0.0, rng.uniform(0.0, 0.003))))
    process.send_signal(number)
    try:
        return process.wait(timeout=20.0)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        return None


def resumed(program, arguments, store, whole, files):
    """What is wrong after the store was taken up again."""
    extra = ["--resume"] if os.path.exists(store) and os.path.getsize(store) > 0 else []
    again = subprocess.run([program, *arguments, *extra, "--quiet"], capture_output=True)
    if again.returncode != 0:
        return ["the store does not go on: exit code %d: %s" % (again.returncode, again.stderr.decode()[:200])]
    differ = [file for file, body in contents(files).items() if body != whole[file]]
    return ["other results after --resume: " + os.path.basename(file) for file in differ]


def faults_after(number, code, whole, files, folder, store, old, any_content):
    """What a run that was sent this signal left wrong."""
    def right(file, body):
        return body == whole.get(file) or (old and body == OLD) or (any_content and complete(file, body))

    name = signal.Signals(number).name
    found = [] if code is not None else ["deaf: did not end within 20 s of " + name]
    if code not in (None, 0, 1, 3, -number):
        found.append("exit code %d after %s" % (code, name))
    found += ["neither whole nor as before after %s: %s, %d bytes" % (name, os.path.basename(file), len(body))
              for file, body in contents(files).items() if not right(file, body)]
    found += ["lost: " + os.path.basename(file) for file in files if old and not os.path.exists(file)]
    kept = {os.path.relpath(file, folder) for file in files}

    def is_whole_draft(left):
        """Between its name and that of the older file that it replaces there is a moment for SIGKILL."""
        target = os.path.join(folder, left.partition(".part")[0])
        if not old or number != signal.SIGKILL or target not in files:
            return False
        with open(os.path.join(folder, left), "rb") as draft:
            return right(target, draft.read())

    return found + ["left behind after %s: %s" % (name, left) for left in listed(folder)
                    if left not in kept and not (store and left.startswith(os.path.basename(store)))
                    and not is_whole_draft(left)]


def kill_runs(program, count, seed, folder, report):
    """Kills `count` runs; returns the number of faults."""
    rng, bad, killed = random.Random(seed), 0, 0
    known = {}
    for run in range(count):
        listing = commands(folder)
        which = run % len(listing)
        arguments, files, store = listing[which]
        emptied(folder, files)
        if which not in known:
            begin = time.monotonic()
            start(program, arguments).wait()
            known[which] = contents(files), time.monotonic() - begin
            if set(known[which][0]) != set(files):
                report("kill", " ".join(arguments[:2]), ["does not write all of its files when left alone"])
                bad += 1
            emptied(folder, files)
        whole, took = known[which]
        old = rng.random() < 0.5
        for file in files if old else []:
            with open(file, "wb") as stream:
                stream.write(OLD)
        number = rng.choice(SIGNALS)
        code = kill_at(start(program, arguments), folder, took, rng, number)
        killed += code not in (0, 1)
        any_content = number != signal.SIGKILL or arguments[0] in MEASURES_TIME
        faults = faults_after(number, code, whole, files, folder, store, old, any_content)
        if store:
            faults += resumed(program, arguments, store, whole, files)
        if faults:
            report("kill", " ".join(arguments[:2]), faults)
            bad += 1
    print("%d runs of %d commands, %d ended by their signal" % (count, len(known), killed), flush=True)
    return bad
