"""What arguments of questions must be. Each returns the value in Python's own type, or raises CaseError."""

from __future__ import annotations

import math
from typing import Any, Callable, List

from ._errors import CaseError
from ._toml import plain


def number(name: str, value: Any, rule: str, holds: Callable[[float], bool] = math.isfinite) -> float:
    """A real number for which `holds`; "must RULE"."""
    found = plain(value)
    if isinstance(found, bool) or not isinstance(found, (int, float)) or not holds(found):
        raise CaseError(name, repr(found), f"must be {rule}")
    return float(found)


def whole(name: str, value: Any, low: int, high: int) -> int:
    found = plain(value)
    if isinstance(found, bool) or not isinstance(found, int) or not low <= found <= high:
        raise CaseError(name, repr(found), f"must be a whole number, {low}..{high}")
    return found


def word(name: str, value: Any, rule: str) -> str:
    if not isinstance(value, str):
        raise CaseError(name, repr(value), f"must be {rule}")
    return value


def words(name: str, value: Any, rule: str) -> List[str]:
    """A string, or several."""
    if isinstance(value, str):
        return [value]
    if not isinstance(value, (list, tuple, set, frozenset)):
        raise CaseError(name, repr(value), f"must be {rule}, or a list of them")
    return [word(name, one, rule) for one in value]


def stretch(name: str, start: Any, stop: Any) -> tuple[float, float]:
    """Two ends that differ."""
    rule = "a range whose ends are finite numbers and differ"
    low, high = number(name, start, rule), number(name, stop, rule)
    if low == high:
        raise CaseError(name, repr(start), f"must be {rule}")
    return low, high
