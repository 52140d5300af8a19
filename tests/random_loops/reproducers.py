"""Reproducers: tests/reproducers/*.toml against what is known to be true of each (reproducers.json).

`cycles` are [period, amplitude or null, stable]; `frequencies`: how near a prediction of a method comes to the first of
them (relative); `outcomes`: those of all starts in their order; `some`: at least one start comes to one of these;
`never`: none does; `answers`: other commands, with their flags, that have to give an answer.
"""

import json
import math
import pathlib

FOLDER = pathlib.Path("tests/reproducers")
TRUTHS = pathlib.Path(__file__).with_suffix(".json")


def faults(document, truth):
    """What a document says that is not true, and what it does not say."""
    tolerance = truth.get("tolerance", 1e-3)
    found = []
    for period, amplitude, stable in truth.get("cycles", []):
        if not any(_is(cycle, period, amplitude, stable, tolerance) for cycle in document["cycles"]):
            found.append(f"no {'stable' if stable else 'unstable'} cycle of {period:g} s")
    for method, within in truth.get("frequencies", {}).items():
        wanted = 2.0 * math.pi / truth["cycles"][0][0]
        said = [p["frequency"] for p in document["predictions"] if p["method"] == method and p["frequency"]]
        if not any(abs(frequency / wanted - 1.0) < within for frequency in said):
            found.append(f"{method}: none of {said} rad/s is within {within:g} of {wanted:.6g} rad/s")
    outcomes = [outcome["outcome"] for outcome in document["outcomes"]]
    if truth.get("outcomes", outcomes) != outcomes:
        found.append(f"the outcomes are {', '.join(outcomes)}")
    if "some" in truth and not set(truth["some"]) & set(outcomes):
        found.append(f"no start comes to {' or '.join(truth['some'])}")
    found += [f"a start comes to {kind}" for kind in truth.get("never", []) if kind in outcomes]
    return found


def _is(cycle, period, amplitude, stable, tolerance):
    close = abs(cycle["period"] / period - 1.0) < tolerance
    return close and cycle["stable"] == stable and (not amplitude or abs(cycle["amplitude"] / amplitude - 1.0) < 5 * tolerance)


def run(program):
    """All reproducers; prints what is off and returns (passed, failed)."""
    truths = json.loads(TRUTHS.read_text())
    passed = failed = 0
    for path in sorted(FOLDER.glob("*.toml")):
        truth = truths.get(path.stem)
        if truth is None:
            found = ["its truth is not in reproducers.json"]
        else:
            answer = program.predict(path)
            found = faults(answer.document, truth) if answer.document else [answer.message]
            for command, *flags in truth.get("answers", []):
                other = program.run(command, path, *flags)
                found += [] if other.document else [f"{command}: {other.message or f'exit code {other.code}'}"]
        passed, failed = passed + (not found), failed + bool(found)
        if found:
            print(f"reproducer: {path}", *found, sep="\n    ", flush=True)
    return passed, failed
