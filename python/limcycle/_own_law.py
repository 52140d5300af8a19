"""Friction laws of the user's own, written in Python."""

from __future__ import annotations

import math
from typing import Any, Callable, Mapping

from . import _core
from ._errors import CaseError
from ._toml import lines_of, plain

KIND = {"kind": "own"}  # what the text of a case has in the place of the law


def is_own(law: Any) -> bool:
    """True for an object that is to be asked itself."""
    return law is not None and not isinstance(law, Mapping) and not hasattr(law, "to_table")


class StaticLaw:
    """A function of one number as a law of friction: driven at 1 rad/s, its velocity has the amplitude of its motion."""

    def __init__(self, function: Callable[[float], Any], amplitude: float) -> None:
        self._function = function
        largest = max(abs(self.output(sign * amplitude, ())) for sign in (-1.0, 1.0))
        self.scales = (math.inf, amplitude, largest or 1.0)

    def output(self, v: float, z: Any) -> float:
        value = plain(self._function(v))
        while isinstance(value, list) and len(value) == 1:  # static systems of python-control return arrays
            value = value[0]
        if not isinstance(value, (int, float)) or not math.isfinite(value):
            raise CaseError("nonlinearity", f"F({v:g}) = {value!r}", "must return a finite number")
        return value


def own_case(law: Any) -> _core.Case:
    """The case of a lone law."""
    return _core.read_case(lines_of({"title": type(law).__name__, "loop": {"friction": KIND}}), "", [], law)
