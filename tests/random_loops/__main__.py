"""tools/random-loops: random loops and rewritings of them, held against an independent checker."""

import argparse
import pathlib
import sys
import time

from . import case_text, compare, families, report, self_test
from .program import Program


def _arguments():
    parser = argparse.ArgumentParser(prog="tools/random-loops", description=__doc__)
    parser.add_argument("program", nargs="?", default="build/release/limcycle", help="the program under test")
    parser.add_argument("--self-test", action="store_true", help="only hold the checker against known answers")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--loops", type=int, default=40)
    parser.add_argument("--family", choices=sorted(families.FAMILIES), help="only this family")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds for one call of the program (60)")
    return parser.parse_args()


def main():
    """Runs what was asked for; 1 if anything failed."""
    options = _arguments()
    if options.self_test:
        return 1 if self_test.run() else 0
    program = Program(options.program, options.limit)
    folder = pathlib.Path("build/random-loops") / f"seed-{options.seed}"
    folder.mkdir(parents=True, exist_ok=True)
    unit = program.predict("cases/pid-lugre.toml").seconds
    table = report.Table(unit)
    for index in range(options.loops):
        name, case, _ = families.loop(options.seed, index, options.family)
        path = folder / f"{index:04d}-{name}.toml"
        path.write_text(case_text.toml(case))
        answer = program.predict(path)
        began = time.process_time()
        verdict = compare.judge(case, answer)
        table.add(name, path, answer, verdict, time.process_time() - began)
    return table.print()


if __name__ == "__main__":
    sys.exit(main())
