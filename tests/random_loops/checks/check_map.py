"""Cells of `map` against `predict` with the same two values."""

from .asked import CLOSE, Finding, refused, stable_cycles, texts, undecided, without_document
from ..case_numbers import numbers, span

SIDE = 3  # cells along a side


def judge(asked, dice):
    """Findings of one map of 3 x 3 cells over two numbers of the case, a factor of two each."""
    known = numbers(asked.case)
    if len(known) < 2:
        return []
    first, second = dice.random.choice(len(known), 2, replace=False)
    x, y = known[first], known[second]
    words = ["--x", f"{span(*x, 2**0.5)}:{SIDE}", "--y", f"{span(*y, 2**0.5)}:{SIDE}"]
    answer = asked.run("map", *words)
    if answer.document is None:
        return [without_document(answer)]
    findings = []
    for point in answer.document["points"]:
        if point is None:
            findings.append(Finding("undecided", ["a cell was not computed within the time limit"]))
            continue
        other = asked.predict((x[0], point["x"]), (y[0], point["y"]))
        found = cell(point, other)
        found.why = [f"{x[0]} = {point['x']!r}, {y[0]} = {point['y']!r}: {reason}" for reason in found.why]
        findings.append(found)
    return findings


def cell(point, answer):
    """One cell against the answer of predict."""
    if not point["outcomes"] or refused(answer):
        same = not point["outcomes"] and refused(answer)
        return Finding("right") if same else Finding("wrong", [f"the map has {point['happens']}; predict: {answer.message}"])
    if answer.document is None:
        return without_document(answer)
    document = answer.document
    differs = _differences(point, document)
    if not differs:
        return Finding("right")
    open_ = "undecided" in point["outcomes"] or undecided(document)
    missed = point["stable_cycles"] > len(stable_cycles(document))
    return Finding("undecided" if open_ else "missed" if missed else "wrong", differs)


def _differences(point, document):
    outcomes = sorted({one["outcome"] for one in document["outcomes"]})
    differs = []
    if sorted(point["outcomes"]) != outcomes:
        differs.append(f"outcomes: {', '.join(sorted(point['outcomes']))} in the map, {', '.join(outcomes)} in predict")
    stable = stable_cycles(document)
    if point["stable_cycles"] != len(stable):
        differs.append(f"{point['stable_cycles']} stable cycles in the map; predict lists {texts(document['cycles'])}")
    if stable and point["stable_cycles"]:
        largest = max(stable, key=lambda cycle: cycle["amplitude"])
        for key in ("period", "amplitude"):
            if abs(point[key] - largest[key]) > CLOSE * largest[key]:
                differs.append(f"{key}: {point[key]:.9g} in the map, {largest[key]:.9g} in predict")
    return differs
