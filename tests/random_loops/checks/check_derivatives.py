"""Derivatives of `sensitivity --local` against central differences of `predict`."""

from .asked import Finding, alike, stable_cycles, without_document

STEP = 1e-4  # relative, either way
ACCURACY = 1e-11  # of the cycles that are subtracted
TOLERANCE = 1e-3  # of the derivative, and of value over parameter
MOST = 4  # numbers of one loop


def judge(asked, dice):
    """Findings, one for each of some numbers of the case; none without a cycle."""
    answer = asked.run("sensitivity", "--local", "--factors", "1")
    if answer.document is None:
        return [without_document(answer)]
    cycle = answer.document["cycle"]
    if cycle is None:
        return []
    some = [one for one in answer.document["parameters"] if one["value"]]
    findings = []
    for i in dice.random.permutation(len(some))[:MOST]:
        found = number(asked, cycle, some[i])
        found.why = [f"{some[i]['name']}: {reason}" for reason in found.why]
        findings.append(found)
    return findings


def number(asked, cycle, one):
    """One number."""
    if one["why"]:
        return Finding("undecided", [one["why"]])
    step = STEP * abs(one["value"])
    beside = []
    for value in (one["value"] - step, one["value"] + step):
        answer = asked.predict((one["name"], value), accuracy=ACCURACY)
        if answer.document is None:
            return without_document(answer)
        same = [other for other in stable_cycles(answer.document) if alike(other, cycle, 0.01)]
        if not same:
            return Finding("undecided", [f"predict does not list the cycle at {value!r}"])
        beside.append(min(same, key=lambda other: abs(other["period"] / cycle["period"] - 1.0)))
    wrong = []
    for key in ("period", "amplitude"):
        difference = (beside[1][key] - beside[0][key]) / (2.0 * step)
        noise = cycle[key] * sum(other["error"] or ACCURACY for other in beside) / (2.0 * step)
        told = one["derivative"][key]
        allowed = TOLERANCE * (abs(difference) + 0.01 * cycle[key] / abs(one["value"])) + 3.0 * noise
        allowed += 3.0 * (one["errors"][key] or 0.0)
        if told is None or abs(told - difference) > allowed:
            wrong.append(f"d({key}) = {told!r}, by differences {difference!r} within {allowed:.2g}")
    return Finding("wrong" if wrong else "right", wrong)
