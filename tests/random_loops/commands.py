"""The other commands on random loops: maps, margins, branches, derivatives, energy, remedies, against predict and simulation."""

from . import families, random_laws, report
from .checks import check_branch, check_derivatives, check_map, check_margin, check_passivity, check_remedy
from .checks.asked import Asked

COUNTS = {"cells": 100, "margins": 40, "branches": 20, "derivatives": 40, "dissipativity": 20, "remedies": 0}
OFFSET = 2 * 10**6  # of the indices of the loops of each command, in steps of 10^6
MOST = 20  # loops that are drawn for each finding that is wanted


def _family(seed, index, only):
    name, case, _ = families.loop(seed, index, only)
    return name, case


def _energy(seed, index, only):
    """A law alone and a loop in turn."""
    return random_laws.law(seed, index) if index % 2 == 0 else random_laws.loop(seed, index)


def _judge_energy(asked, dice):
    law = "plant" not in asked.case["loop"]
    return check_passivity.judge_law(asked, dice) if law else check_passivity.judge_loop(asked, dice)


CHECKS = {
    "cells": (_family, check_map.judge), "margins": (_family, check_margin.judge),
    "branches": (_family, check_branch.judge), "derivatives": (_family, check_derivatives.judge),
    "dissipativity": (_energy, _judge_energy), "remedies": (_family, check_remedy.judge),
}  # fmt: skip


def run(program, folder, counts, seed, only=None):
    """Checks until there are as many findings as wanted; returns the exit code."""
    table = report.Commands()
    for place, (name, count) in enumerate(counts.items()):
        draw, judge = CHECKS[name]
        for turn in range(MOST * count):
            if table.count(name) >= count:
                break
            index = OFFSET + place * 10**6 + turn
            family, case = draw(seed, index, only)
            asked = Asked(program, folder / f"{name}-{turn:04d}-{family}.toml", case)
            findings = judge(asked, families.Dice(seed, 10 * OFFSET + index))
            table.add(name, asked.path, findings[: count - table.count(name)])
    return table.print()
