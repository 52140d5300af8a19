"""SIGKILL at random moments of every command that writes: each file is whole or absent, and a store goes on."""

import os
import random
import shutil
import signal
import subprocess
import time

SERVO = "cases/pid-lugre.toml"
SWEEP = ["--x", "loop.controller.kp=1:5:6", "--y", "loop.controller.kd=1:9:6"]
OLD = b"what stood there before\n"


def commands(folder):
    """Arguments of each command, the files it writes, and the store it keeps."""
    def file(name):
        return os.path.join(folder, name)

    documents = ["--json", file("a.json"), "--csv", file("a.csv"), "-o", file("a.txt")]
    three = [file("a.json"), file("a.csv"), file("a.txt")]
    page = ["--html", file("a.html"), *documents]
    store = file("a.store")
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
        (["completion", "bash", "-o", file("a.txt")], [file("a.txt")], None),
        (["manual", "predict", "-o", file("a.txt")], [file("a.txt")], None)]


def contents(files):
    found = {}
    for file in files:
        if os.path.exists(file):
            with open(file, "rb") as stream:
                found[file] = stream.read()
    return found


def emptied(folder):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)


def start(program, arguments):
    return subprocess.Popen([program, *arguments, "--quiet"], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL)


def kill_at(process, folder, took, rng):
    """Anywhere in the run, near its end, or as soon as anything changes in the folder of its files."""
    way = rng.randrange(3)
    if way < 2:
        time.sleep(rng.uniform(0.0, took) if way == 0 else took * rng.uniform(0.9, 1.05))
    else:
        before = sorted(os.listdir(folder))
        while process.poll() is None and sorted(os.listdir(folder)) == before:
            pass
        time.sleep(rng.choice((0.0, 0.0, rng.uniform(0.0, 0.003))))
    process.send_signal(signal.SIGKILL)
    return process.wait()


def resumed(program, arguments, store, whole, files):
    """What is wrong after the store was taken up again."""
    extra = ["--resume"] if os.path.exists(store) and os.path.getsize(store) > 0 else []
    again = subprocess.run([program, *arguments, *extra, "--quiet"], capture_output=True)
    if again.returncode != 0:
        return ["the store does not go on: exit code %d: %s" % (again.returncode, again.stderr.decode()[:200])]
    differ = [file for file, body in contents(files).items() if body != whole[file]]
    return ["other results after --resume: " + os.path.basename(file) for file in differ]


def kill_runs(program, count, seed, folder, report):
    """Kills `count` runs; returns the number of faults."""
    rng, bad, killed = random.Random(seed), 0, 0
    known = {}
    for run in range(count):
        emptied(folder)
        listed = commands(folder)
        which = run % len(listed)
        arguments, files, store = listed[which]
        if which not in known:
            begin = time.monotonic()
            start(program, arguments).wait()
            known[which] = contents(files), time.monotonic() - begin
            if set(known[which][0]) != set(files):
                report("kill", " ".join(arguments[:2]), ["does not write all of its files when left alone"])
                bad += 1
            emptied(folder)
        whole, took = known[which]
        old = rng.random() < 0.5
        for file in files if old else []:
            with open(file, "wb") as stream:
                stream.write(OLD)
        code = kill_at(start(program, arguments), folder, took, rng)
        killed += code == -signal.SIGKILL
        faults = ["neither whole nor as before: %s, %d bytes" % (os.path.basename(file), len(body))
                  for file, body in contents(files).items() if body != whole.get(file) and not (old and body == OLD)]
        faults += ["lost: " + os.path.basename(file) for file in files if old and not os.path.exists(file)]
        kept = {os.path.basename(file) for file in files}
        faults += ["left behind: " + name for name in os.listdir(folder)
                   if name not in kept and not (store and name.startswith(os.path.basename(store)))]
        if store:
            faults += resumed(program, arguments, store, whole, files)
        if faults:
            report("kill", " ".join(arguments[:2]), faults)
            bad += 1
    print("%d runs of %d commands, %d killed before they ended" % (count, len(known), killed), flush=True)
    return bad
