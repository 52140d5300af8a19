"""Tests of the checks of commands: an honest program passes, and each wrong answer that is planted is found."""

import pathlib
import tempfile

from . import check_branch, check_derivatives, check_map, check_margin, check_passivity
from .asked import Asked
from ..families import Dice
from ..textbook import LAW, LOOP, Textbook


def _point(**changes):
    return lambda document: document["points"][4].update(changes)


def _scale(pick, key, factor):
    def spoil(document):
        one = pick(document)
        one[key] *= factor

    return spoil


def _put(pick, key, value):
    def spoil(document):
        pick(document)[key] = value

    return spoil


def _first(document):
    return document["parameters"][0]


def _flip(document):
    document["passive"] = not document["passive"]


def _everywhere(key, change):
    def spoil(document):
        for point in document["branch"]:
            point[key] = change(point[key])

    return spoil


def _derivatives(document):
    for one in document["parameters"]:
        one["derivative"]["period"] *= 1.005


def _value(document):
    """An end that is 3 % off, and one where there is none."""
    side = _first(document)["down"]
    side.update(hunting="ends", value=(side["value"] or 0.5) * 1.03, error=1e-9)


FAULTS = (
    ("map", check_map.judge, LOOP, _point(outcomes=["divergence"])),
    ("map", check_map.judge, LOOP, _point(stable_cycles=2)),
    ("map", check_map.judge, LOOP, _scale(lambda d: d["points"][8], "period", 1.001)),
    ("map", check_map.judge, LOOP, _scale(lambda d: d["points"][8], "amplitude", 0.999)),
    ("margin", check_margin.judge, LOOP, _value),
    ("margin", check_margin.judge, LOOP, lambda d: _first(d)["up"].update(hunting="ends", value=1.0, error=1e-9)),
    ("margin", check_margin.judge, LOOP, _put(lambda d: d, "hunts", False)),
    ("continue", check_branch.judge, LOOP, _everywhere("period", lambda period: 1.001 * period)),
    ("continue", check_branch.judge, LOOP, _everywhere("stable", lambda stable: not stable)),
    ("sensitivity", check_derivatives.judge, LOOP, _derivatives),
    ("sensitivity", check_derivatives.judge, LOOP, lambda d: [one["derivative"].update(amplitude=0.5) for one in d["parameters"]]),
    ("dissipativity", check_passivity.judge_law, LAW, _flip),
    ("dissipativity", check_passivity.judge_law, LAW, _scale(lambda d: d["counterexample"], "energy_per_cycle", 1.01)),
    ("dissipativity", check_passivity.judge_law, LAW, _scale(lambda d: d["threshold"], "value", 1.01)),
    ("dissipativity", check_passivity.judge_law, LAW, _scale(lambda d: d["force_bound"], "value", 0.5)),
    ("dissipativity", check_passivity.judge_law, LAW, _scale(lambda d: d["state_bounds"][0], "high", 0.9)),
    ("dissipativity", check_passivity.judge_law, LAW | {"sigma2": 200.0}, _flip),
    ("dissipativity", check_passivity.judge_loop, LOOP, _put(lambda d: d["loop"]["no_cycle"], "answer", True)),
)


def run():
    """(passed, failed)."""
    honest = {(command, judge, str(part)): (command, judge, part, None) for command, judge, part, _ in FAULTS}
    verdicts = [_case(number, *fault) for number, fault in enumerate((*honest.values(), *FAULTS))]
    return verdicts.count(True), verdicts.count(False)


def _case(number, command, judge, part, spoil):
    """Whether a check has the right opinion of an honest or a spoiled program."""
    calls = [0]

    def spoil_first(asked, document):
        # The first call alone: what is asked again about a threshold is honest.
        if spoil is not None and asked == command and not calls[0]:
            calls[0] = 1
            spoil(document)

    case = {"loop": {"friction": part} if "kind" in part else part}
    with tempfile.TemporaryDirectory() as folder:
        asked = Asked(Textbook(case, spoil_first), pathlib.Path(folder) / "case.toml", case)
        findings = judge(asked, Dice(7, number))
    kinds = [finding.kind for finding in findings]
    good = {"wrong", "missed"} & set(kinds) if spoil else set(kinds) == {"right"}
    if not good:
        print(f"planted: {command}, fault {number}: {', '.join(kinds) or 'nothing was compared'}")
        print(*(f"    {reason}" for finding in findings for reason in finding.why), sep="\n")
    return bool(good)
