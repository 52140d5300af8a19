"""Both sides of `margin` against `predict` 1 % within and 1 % beyond the value at which hunting ends or begins."""

import re

from .asked import Finding, goes_on, refused, stable_cycles, texts, undecided, without_document
from ..case_numbers import numbers

STEP = 0.01


def judge(asked, dice):
    """The finding of one number of the case: own values and both sides."""
    known = numbers(asked.case)
    path, own = known[int(dice.random.integers(len(known)))]
    answer = asked.run("margin", "--parameter", path)
    if answer.document is None:
        return [without_document(answer)]
    document = answer.document
    if not document["parameters"]:
        return [Finding("undecided", [f"{path}: no answer; {document['status']}"])]
    one = document["parameters"][0]
    findings = [_at_own(document, asked.predict())]
    for name, limit in (("up", own * document["factor"]), ("down", own / document["factor"])):
        found = side(asked, path, one[name], document["hunts"], own, limit)
        found.why = [f"{path} {name} ({one[name]['hunting']} {one[name]['value']!r}: {one[name]['why']}): {w}" for w in found.why]
        findings.append(found)
    return [_worst(findings)]


def _at_own(document, answer):
    """Whether it hunts at the own values."""
    if answer.document is None:
        return without_document(answer)
    stable = stable_cycles(answer.document)
    if document["hunts"] == bool(stable):
        return Finding("right")
    found = "undecided" if undecided(answer.document) else _kind(document["hunts"])
    return Finding(found, [f"hunts: {document['hunts']}; predict lists {texts(answer.document['cycles'])}"])


def side(asked, path, one, hunts, own, limit):
    """One side."""
    what, value = one["hunting"], one["value"]
    if what == "unknown":
        return Finding("undecided", ["not determined"])
    if what == "none":
        return _nothing(asked, path, one, hunts, limit)
    outwards = STEP if abs(limit) > abs(own) else -STEP
    beyond, within = value * (1.0 + outwards), _within(value, own, outwards)
    # Without an error the value is the last or first one that was seen, and only its outer side is known.
    exact = one["error"] is not None
    wanted = [(beyond, what == "begins")]
    if what == "ends" and exact or what == "begins" and exact and value != own:
        wanted.append((within, what == "ends"))
    other = re.search("another cycle (beyond|before) it was not determined", one["why"]) is not None
    return _worst([at(asked, path, p, expected, other and not expected) for p, expected in wanted])


def _within(value, own, outwards):
    """1 % inside, or half the way to the own value where that is nearer."""
    inside = value * (1.0 - outwards)
    return inside if abs(inside - value) < abs(own - value) else 0.5 * (own + value)


def _nothing(asked, path, one, hunts, limit):
    """Neither within the range: the last value that was looked at is as the own one."""
    last = re.search(r"none up to ([-+.0-9e]+);", one["why"])
    return at(asked, path, float(last.group(1)) if last else limit, hunts)


def at(asked, path, value, hunts, open_=False):
    """Whether predict hunts at a value; `open_`: the command leaves open whether there is another cycle."""
    answer = asked.predict((path, value))
    if refused(answer):
        return Finding("right") if not hunts else Finding("wrong", [f"at {value!r}: {answer.message}"])
    if answer.document is None:
        return without_document(answer)
    document = answer.document
    if bool(stable_cycles(document)) == hunts:
        return Finding("right")
    known = not (undecided(document) or goes_on(document) or open_)
    outcomes = ", ".join(sorted({one["outcome"] for one in document["outcomes"]}))
    why = [f"at {value!r} predict has {outcomes}; cycles {texts(document['cycles'])}"]
    return Finding(_kind(hunts) if known else "undecided", why)


def _kind(hunts):
    """predict may miss a cycle that margin has followed; one that it lists has been confirmed by shooting."""
    return "missed" if hunts else "wrong"


def _worst(findings):
    order = ("failed", "late", "wrong", "missed", "undecided", "right")
    kind = min((found.kind for found in findings), key=order.index)
    return Finding(kind, [reason for found in findings for reason in found.why])
