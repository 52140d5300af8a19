"""The program's answer to one loop against what the checker finds."""

import math
import re
from dataclasses import dataclass, field

from .attractor import Attractor
from .truth import Truth

PERIOD = 2e-3  # relative, of periods and amplitudes that have to agree
TIGHTER = 0.01  # a disagreement counts only if it is there at a tolerance that much tighter
FACTORS = (0.0113, 0.137, 0.91, 4.3)  # of the typical length: the checker's own starts


@dataclass
class Verdict:
    """right, undecided, wrong, missed, late, failed or unchecked; and why."""

    kind: str
    why: list = field(default_factory=list)
    undecided_starts: int = 0
    starts: int = 0


def cycles_of(document):
    """Cycles of predict as attractors, with their stability."""
    listed = []
    for cycle in document["cycles"]:
        one = Attractor("cycle", cycle["period"], cycle["amplitude"], cycle["offset"])
        one.stable = cycle["stable"]
        one.multipliers = [complex(*m) for m in cycle["multipliers"]]
        listed.append(one)
    return listed


def matches(one, other):
    """Whether two cycles have the same period and amplitude; the mean is another thing than the middle."""
    return abs(one.period / other.period - 1.0) < PERIOD and abs(one.amplitude / other.amplitude - 1.0) < PERIOD


def displacement(start):
    """The displacement from rest in the name of a start, or None."""
    found = re.fullmatch(r"y\(0\) = (?:rest \+ )?([-+.0-9e]+)", start)
    return float(found.group(1)) if found else None


def judge(case, answer):
    """The verdict on one answer of predict."""
    if answer.late:
        return Verdict("late", [f"no answer within the limit ({answer.seconds:.1f} s of CPU time)"])
    if answer.document is None:
        return Verdict("failed", [answer.message or f"exit code {answer.code}"])
    document = answer.document
    outcomes = document["outcomes"]
    undecided = [o for o in outcomes if o["outcome"] == "undecided"]
    listed = cycles_of(document)
    try:
        truth = Truth(case)
        why, missed = _checked(truth, listed, document)
        if why and truth.smooth:  # a step of LSODA may pass over the instant at which a resting body breaks away
            tighter = Truth(case, rtol=TIGHTER * truth.rtol, seconds=30.0)
            again = _checked(tighter, listed, document)
            if again[0] or tighter.decided():
                why, missed = again
    except (ArithmeticError, ValueError, RuntimeError) as fault:  # LinAlgError is a ValueError
        return Verdict("unchecked", [f"the checker gave up: {fault}"], len(undecided), len(outcomes))
    verdict = Verdict("right", why, len(undecided), len(outcomes))
    if why:
        verdict.kind = "wrong"
    elif missed and not undecided:
        verdict.kind, verdict.why = "missed", missed
    elif undecided or not outcomes:
        verdict.kind = "undecided"
        verdict.why = sorted({o.get("why", "") for o in undecided}) + missed
    return verdict


def _checked(truth, listed, document):
    """(what is wrong, what was missed)."""
    why, missed = [], []
    scale = truth.scale()
    sizes = [factor * scale for factor in FACTORS]
    stable = [cycle for cycle in listed if cycle.stable]
    reference = truth.model.reference
    sizes = [0.93 * cycle.amplitude for cycle in stable] + sizes
    found = truth.attractors([reference + size for size in sizes] + [reference - sizes[-2]])
    for cycle in stable:
        if not any(one.kind == "cycle" and matches(one, cycle) for one in found):
            if not _reached(truth, cycle):
                text = f"stable cycle T = {cycle.period:.8g}, A = {cycle.amplitude:.6g} not found; found {_texts(found)}"
                if truth.decided():
                    why.append(text)
    irregular = any(o["outcome"] in ("family", "irregular") for o in document["outcomes"])
    for one in found:
        if one.kind == "cycle" and not any(matches(one, cycle) for cycle in listed) and not irregular:
            if _attracts(truth, one):
                missed.append(f"cycle T = {one.period:.8g}, A = {one.amplitude:.6g} is not listed")
    why += _starts(truth, listed, document)
    return why, missed


def _attracts(truth, cycle, sizes=(0.9, 1.1, -0.93)):
    """Whether a motion from another start comes to this cycle too: one of a continuum attracts none, the largest of a
    continuum none that is smaller."""
    for size in sizes:
        one = truth.settle(cycle.offset + size * cycle.amplitude)
        if one.kind == "cycle" and matches(one, cycle) and abs(one.offset - cycle.offset) < 0.01 * cycle.amplitude:
            return True
    return False


def _reached(truth, cycle):
    """Tries further starts for a cycle that was not found at first."""
    for factor in (0.5, 0.7, 0.85, 1.0, 1.15, 1.4, 2.0, -0.9):
        one = truth.settle(truth.model.reference + factor * cycle.amplitude + 1e-7 * cycle.amplitude)
        if one.kind == "cycle" and matches(one, cycle):
            return True
    for factor in (1.0, 0.9, 1.2):  # such as the swing of two masses against each other, which no displacement begins
        for phase in (0.0, 0.5 * math.pi):
            one = truth.settle_in_mode(2.0 * math.pi / cycle.period, factor * cycle.amplitude, phase)
            if one.kind == "cycle" and matches(one, cycle):
                return True
    return False


def _starts(truth, listed, document):
    """Starts whose displacement is told and whose plant has positions, all of which it moves: the checker does the same."""
    if not truth.model.names["positions"]:
        return []
    wrong = []
    middle = _rest_of_linear_part(truth)
    for outcome in document["outcomes"]:
        size = displacement(outcome["start"])
        if size is None or outcome["outcome"] == "undecided" or middle is None:
            continue
        one = truth.settle(middle + _all_digits(size, document))
        kind = outcome["outcome"]
        if one.kind == "unknown":
            continue
        if kind == "family" and one.kind == "cycle" and not _attracts(truth, one, (0.9, -0.93)):
            continue  # one motion of the family, which returns to itself as a cycle does
        if kind != one.kind and {kind, one.kind} != {"rest", "sliding"}:
            wrong.append(f"{outcome['start']}: {kind} was reported, {_texts([one])} is true")
        elif kind == "cycle" and outcome["cycle"] is not None and not matches(one, listed[outcome["cycle"]]):
            wrong.append(f"{outcome['start']}: another cycle, {_texts([one])}")
    return wrong


def _all_digits(size, document):
    """A displacement before it was rounded for the name of its start: the largest of the search box, or that over a
    power of ten. Long transients end elsewhere for another fifth digit."""
    largest = document["search"]["amplitude"][1]
    exact = math.copysign(largest * 10.0 ** round(math.log10(abs(size) / largest)), size)
    return exact if abs(exact / size - 1.0) < 1e-3 else size


def _rest_of_linear_part(truth):
    """y of the rest point without elements: the reference under integral action; otherwise only zero is known."""
    loop = truth.case["loop"]
    if loop.get("controller", {}).get("ki", 0.0) and not loop.get("load", 0.0):
        return truth.model.reference
    return 0.0 if not truth.model.reference and not loop.get("load", 0.0) else None


def _texts(found):
    return ", ".join(f"cycle T = {o.period:.8g}, A = {o.amplitude:.6g}" if o.kind == "cycle" else o.kind for o in found)
