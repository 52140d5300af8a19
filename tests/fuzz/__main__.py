"""python3 -m fuzz: see tools/fuzz."""

import argparse
import collections
import concurrent.futures
import os
import pathlib
import resource
import shutil
import sys
import tempfile
import threading

from . import judge, kills, mutants

MEMORY = 4 << 30  # bytes that a run may ask for; more would be a fault of its own


class Findings:
    """Prints each, keeps the mutants, and counts them by their first words."""

    def __init__(self, keep):
        self.keep, self.counts, self.lock = keep, collections.Counter(), threading.Lock()
        if keep:
            os.makedirs(keep, exist_ok=True)

    def add(self, name, source, faults, body=None):
        with self.lock:
            for fault in faults:
                self.counts[fault.split(":")[0]] += 1
                print("%s (%s): %s" % (name, source, fault.strip()), flush=True)
            if self.keep and body is not None:
                with open(os.path.join(self.keep, name + ".toml"), "wb") as file:
                    file.write(body)


def attack(program, drawn, folder, findings, limit):
    """One mutant through check, and through predict where `limit` is given and check accepts it. Was it predicted?"""
    name, source, body = drawn
    file = os.path.join(folder, name + ".toml")
    with open(file, "wb") as stream:
        stream.write(body)
    ran, faults = judge.checked(program, file)
    accepted = ran.code == 0
    if accepted and limit:
        ran, more = judge.predicted(program, file, limit)
        faults += more
    os.remove(file)
    if faults:
        findings.add(name, source, faults, body)
    return accepted, ran.seconds


def many(program, count, mutator, folder, findings, jobs, limit):
    """Until `count` mutants were checked, or with a limit predicted."""
    word, done, drawn, slow = "predict" if limit else "check", 0, 0, []
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        running = set()
        while done < count:
            while len(running) < 2 * jobs:
                drawn += 1
                one = ("%s-%d-%d" % (word, mutator.seed, drawn), *mutator.next(mild=bool(limit)))
                running.add(pool.submit(attack, program, one, folder, findings, limit))
            ended, running = concurrent.futures.wait(running, return_when=concurrent.futures.FIRST_COMPLETED)
            results = [one.result() for one in ended]
            done += sum(1 for accepted, _ in results if accepted or not limit)
            slow += [seconds for accepted, seconds in results if accepted]
            if drawn > 100 * count:
                sys.exit("fuzz: hardly a mutant is a valid case")
        concurrent.futures.wait(running)
    slow.sort()
    share = "; the slowest took %.1f s, the median %.3f s" % (slow[-1], slow[len(slow) // 2]) if slow else ""
    print("%s: %d mutants%s" % (word, done, share), flush=True)


def arguments():
    parser = argparse.ArgumentParser(prog="tools/fuzz", description=__doc__)
    parser.add_argument("program", metavar="PROGRAM")
    parser.add_argument("--seed", type=int, default=1, metavar="N")
    parser.add_argument("--checks", type=int, default=0, metavar="N", help="mutants through limcycle check")
    parser.add_argument("--predicts", type=int, default=0, metavar="N",
                        help="mutants that check accepts through limcycle predict")
    parser.add_argument("--kills", type=int, default=0, metavar="N", help="runs of commands that write, each killed")
    parser.add_argument("--time-limit", type=float, default=10.0, metavar="S", help="of each predict")
    parser.add_argument("--jobs", type=int, default=2, metavar="N")
    parser.add_argument("--keep", metavar="FOLDER", help="keep the mutants that were found out")
    parser.add_argument("--self-test", action="store_true", help="a few mutants and kills: seconds")
    given = parser.parse_args()
    if given.self_test:
        given.checks, given.kills = 300, 6
    return given


def main():
    given = arguments()
    program = os.path.abspath(given.program)
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    findings = Findings(given.keep)
    sources = mutants.seeds(program)
    print("%d cases and templates to mutate" % len(sources), flush=True)
    with tempfile.TemporaryDirectory(dir="/dev/shm" if os.path.isdir("/dev/shm") else None) as folder:
        for data in pathlib.Path("cases").rglob("*.csv"):  # that shipped cases name
            shutil.copy(data, folder)
        for count, limit in ((given.checks, None), (given.predicts, given.time_limit)):
            if count > 0:
                mutator = mutants.Mutator(sources, given.seed)
                many(program, count, mutator, folder, findings, given.jobs, limit)
    if given.kills > 0:
        with tempfile.TemporaryDirectory() as folder:
            kills.kill_runs(program, given.kills, given.seed, os.path.join(folder, "out"),
                            lambda name, source, faults: findings.add(name, source, faults))
    for words, count in findings.counts.most_common():
        print("%6d  %s" % (count, words))
    print("fuzz: nothing found" if not findings.counts else "fuzz: %d findings" % sum(findings.counts.values()))
    return 1 if findings.counts else 0


if __name__ == "__main__":
    sys.exit(main())
