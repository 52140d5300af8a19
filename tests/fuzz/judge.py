"""Runs the program on a mutant, and says what a user should not have seen."""

import json
import os
import re
import signal
import subprocess
import time

# Words of the program's own inside, which mean nothing to who wrote the case.
INSIDE = re.compile(r"std::|bad_alloc|bad_variant|vector::|basic_string|map::at|_M_|internal error|out of memory|terminate|"
                    r"assert|optional access|stoi|stod|invalid argument:|Sanitizer|runtime error")
STEERS = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028\u2029\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069]")


class Ran:
    """How a run ended: exit code (negative: by a signal), its two streams and the seconds it took."""

    def __init__(self, words, limit):
        begin = time.monotonic()
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        try:
            self.out, self.err = process.communicate(timeout=limit)
            self.late = False
        except subprocess.TimeoutExpired:
            process.kill()
            self.out, self.err = process.communicate()
            self.late = True
        self.code = process.returncode
        self.seconds = time.monotonic() - begin


def _no_number(word):
    raise ValueError(word + " stands for a number")


def broken_json(document):
    """What is wrong with it, or nothing."""
    try:
        parsed = json.loads(document.decode("utf-8"), parse_constant=_no_number)
    except (ValueError, RecursionError) as error:
        return "broken JSON: " + str(error)[:120]
    return "" if parsed.get("schema") == "limcycle/1" else "JSON without its schema"


def names_its_place(message, file):
    """Does it name a file with a line or a key, be it one of data that the case names, or an option?"""
    rest = message.partition(os.path.basename(file))[2] if os.path.basename(file) in message else ""
    if re.search(r"[\w-]+\.csv:\d+: ", message):
        return True
    return bool(re.match(r":\d+: |: (the file |[\w.\[\]\"-]+( =|:| ))", rest)) or "--" in message


def faults(ran, file, limit, command):
    """Everything wrong with a run of `check` or `predict` with --json -, as short lines."""
    out, err = ran.out.decode("utf-8", "replace"), ran.err.decode("utf-8", "replace")
    found = []
    if ran.late or ran.seconds > 2.0 * limit:
        found.append("late: %.1f s, limit %g s" % (ran.seconds, limit))
        if ran.late:
            return found
    if ran.code < 0:
        return found + ["crash: " + signal.Signals(-ran.code).name + " " + err[-200:]]
    if ran.code not in (0, 1, 2, 3):
        found.append("exit code %d" % ran.code)
    if INSIDE.search(err) or INSIDE.search(out if ran.code != 2 else ""):
        found.append("words of the inside: " + (INSIDE.search(err) or INSIDE.search(out)).group() + ": " + err[-200:])
    if STEERS.search(err) or (command == "check" and STEERS.search(out)):
        found.append("raw text that steers a terminal")
    if ran.code == 2:
        if out:
            found.append("exit code 2 with output")
        if err.count("\n") != 1 or not err.startswith("limcycle: "):
            found.append("exit code 2 without one line: " + err[:200])
        elif not names_its_place(err, file):
            found.append("exit code 2 without a place: " + err[:200])
    elif ran.code in (0, 1) or (ran.code == 3 and out):
        fault = broken_json(ran.out)
        if fault:
            found.append(fault)
    if ran.code == 3 and (command == "check" or "did not stop" in err):
        found.append("exit code 3: " + err[:200])
    return found


def checked(program, file, limit=5.0):
    """`check`: the run and its faults."""
    ran = Ran([program, "check", file, "--json", "-"], 4.0 * limit)
    return ran, faults(ran, file, limit, "check")


def predicted(program, file, limit):
    """`predict` for a case that check accepted: there, wrong input is a fault of the program."""
    ran = Ran([program, "predict", file, "--time-limit", str(limit), "--json", "-"], 4.0 * limit)
    found = faults(ran, file, limit, "predict")
    needs_a_loop = b"is required by this command" in ran.err or b"[loop]" in ran.err
    if ran.code == 2 and not needs_a_loop:
        found.append("accepted by check, refused by predict: " + ran.err.decode("utf-8", "replace")[:200])
    return ran, found
