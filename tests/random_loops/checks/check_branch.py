"""Points within a branch of `continue` against `predict` there."""

from .asked import Finding, alike, text, texts, undecided, without_document
from ..case_numbers import numbers, span

STABLE, UNSTABLE = 3, 1  # points of each kind that are looked at


def judge(asked, dice):
    """The finding of one branch over a number of the case, a factor of 1.5 either way; none where there is no cycle."""
    known = numbers(asked.case)
    path, own = known[int(dice.random.integers(len(known)))]
    answer = asked.run("continue", "--parameter", span(path, own, 1.5))
    if answer.document is None:
        return [without_document(answer)]
    branch = answer.document["branch"]
    if not branch:
        return []
    found = {"wrong": [], "missed": [], "undecided": [], "unlisted": []}
    for point in _interior(branch, dice):
        kind, why = at(point, asked.predict((path, point["parameter"])))
        reasons = [f"{path} = {point['parameter']!r}: {why}"]
        if kind in ("late", "failed"):
            return [Finding(kind, reasons)]
        if kind != "right":
            found[kind].extend(reasons)
    worst = next((kind for kind, reasons in found.items() if reasons), "right")
    return [Finding(worst, found.get(worst, []))]


def _interior(branch, dice):
    """Some points that are not at the end of a part nor at a change of stability."""
    ends = {one["part"]: [] for one in branch}
    for index, one in enumerate(branch):
        ends[one["part"]].append(index)
    inner = [branch[i] for part in ends.values() for i in part[1:-1] if _firm(branch[i])]
    chosen = []
    for stable, most in ((True, STABLE), (False, UNSTABLE)):
        some = [point for point in inner if point["stable"] is stable]
        chosen += [some[i] for i in dice.random.permutation(len(some))[:most]]
    return chosen


def _firm(point):
    """Away from a change of stability, and with a period and an amplitude."""
    sizes = [abs(complex(*m)) for m in point["multipliers"]]
    return bool(point["period"] and point["amplitude"]) and all(abs(size - 1.0) > 0.05 for size in sizes[:1])


def at(point, answer):
    """(kind, why) of one point: predict must list a stable cycle; an unstable one only with the same stability."""
    if answer.document is None:
        return ("late" if answer.late else "failed"), answer.message
    document = answer.document
    same = [cycle for cycle in document["cycles"] if alike(point, cycle)]
    if any(cycle["stable"] is point["stable"] for cycle in same):
        return "right", ""
    words = f"{text(point)} ({'stable' if point['stable'] else 'unstable'}); predict lists {texts(document['cycles'])}"
    if same:
        return ("undecided" if all(cycle["stable"] is None for cycle in same) else "wrong"), words
    if not point["stable"]:
        return "unlisted", words
    return ("undecided" if undecided(document) else "missed"), words
