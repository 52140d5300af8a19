"""Random loops, rewritings of them and reproducers, held against an independent checker.

The last line is "N passed, N failed"; the exit code is 1 if anything failed: an answer that is wrong, missed or late, a
rewriting that changes an answer, or too few decided starts.
"""

import argparse
import os
import pathlib
import sys
import time

from . import case_text, commands, compare, families, report, reproducers, rewritings, self_test
from .program import Program

FULL = {"loops": 500, "rewritings": 2000}
SHORT = {"loops": 40, "rewritings": 100}


def _arguments():
    parser = argparse.ArgumentParser(prog="tools/random-loops", description=__doc__)
    parser.add_argument("program", nargs="?", default="build/release/limcycle", help="the program under test")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--loops", type=int, help=f"how many loops ({SHORT['loops']})")
    parser.add_argument("--rewritings", type=int, help=f"how many rewritings of them ({SHORT['rewritings']})")
    parser.add_argument("--full", action="store_true", help="500 loops and 2,000 rewritings")
    parser.add_argument("--family", choices=sorted(families.FAMILIES), help="only this family")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds for one call of the program (60)")
    parser.add_argument("--decided", type=float, default=0.97, help="share of starts that have to be decided (0.97)")
    parser.add_argument("--reproducers", action="store_true", help="only tests/reproducers")
    parser.add_argument("--commands", action="store_true", help="only map, margin, continue, sensitivity, dissipativity, remedy")
    for name, count in commands.COUNTS.items():
        parser.add_argument(f"--{name}", type=int, default=count, help=f"how many of them with --commands ({count})")
    parser.add_argument("--self-test", action="store_true", help="only hold the checker against known answers")
    return parser.parse_args()


def _loops(options, program, folder, table, count):
    """Predicts and checks the loops; returns what was answered, for the rewritings."""
    answered = []
    for index in range(count):
        name, case, _ = families.loop(options.seed, index, options.family)
        path = folder / f"{index:04d}-{name}.toml"
        path.write_text(case_text.toml(case))
        answer = program.predict(path)
        began = time.process_time()
        table.add(name, path, answer, compare.judge(case, answer), time.process_time() - began)
        if answer.document is not None:
            answered.append((index, name, case, answer.document))
    return answered


def _rewritings(options, program, folder, table, answered, count):
    """Rewrites the loops that were answered, in turn, each time in the next way that applies to it."""
    kinds = list(rewritings.REWRITINGS)
    for number in range(10 * count):
        if table.rewritten() >= count or not answered:
            return
        index, name, case, document = answered[number % len(answered)]
        kind = kinds[(number // len(answered) + number) % len(kinds)]
        done = rewritings.REWRITINGS[kind](case, families.Dice(options.seed, 10**6 + number))
        if done is None:
            continue
        path = folder / f"{index:04d}-{name}-{kind}-{number}.toml"
        path.write_text(case_text.toml(done.case, (f"rewriting of {index:04d}-{name}.toml: {kind}",), done.backwards))
        answer = program.predict(path)
        if answer.document is None:
            table.rewrite(kind, path, "late" if answer.late else "failed", [answer.message])
            continue
        table.rewrite(kind, path, *rewritings.changes(document, answer.document, done))


def _silence_fortran():
    """ODEPACK writes its warnings to the standard output itself; ours goes on to where it went."""
    sys.stdout.flush()
    kept = os.dup(1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    sys.stdout = os.fdopen(kept, "w", buffering=1)


def main():
    """Runs what was asked for; 1 if anything failed."""
    options = _arguments()
    _silence_fortran()
    if options.self_test:
        return 1 if self_test.run() else 0
    program = Program(options.program, options.limit)
    if options.reproducers:
        passed, failed = reproducers.run(program)
        print(f"{passed} passed, {failed} failed")
        return 1 if failed else 0
    counts = FULL if options.full else SHORT
    loops = counts["loops"] if options.loops is None else options.loops
    rewritten = counts["rewritings"] if options.rewritings is None else options.rewritings
    folder = pathlib.Path("build/random-loops") / f"seed-{options.seed}"
    folder.mkdir(parents=True, exist_ok=True)
    if options.commands:
        counts = {name: getattr(options, name) for name in commands.COUNTS}
        return commands.run(program, folder, counts, options.seed, options.family)
    table = report.Table(program.predict("cases/pid-lugre.toml").seconds, options.decided)
    answered = _loops(options, program, folder, table, loops)
    _rewritings(options, program, folder, table, answered, rewritten)
    return table.print()


if __name__ == "__main__":
    sys.exit(main())
