"""Friction laws of the user's own, written in Python."""

from __future__ import annotations

import math
from typing import Any, Callable, List, Mapping, Optional, Tuple

from . import _core
from ._errors import CaseError
from ._toml import lines_of, plain

KIND = {"kind": "own"}  # what the text of a case has in the place of the law


def is_own(law: Any) -> bool:
    """True for an object that is to be asked itself."""
    return law is not None and not isinstance(law, Mapping) and not hasattr(law, "to_table")


def checked(law: Any) -> Any:
    """A law of the user's own, whose compiled functions have the signatures that they are called with."""
    if isinstance(law, type):
        raise CaseError("loop.friction", law.__name__, "must be an object of that class, not the class itself",
                        f"write {law.__name__}()")
    for name, pointers, returned in (("output", 1, "float64"), ("rate", 2, "none")):
        found = _signature(getattr(law, name, None))
        wanted = (["float64"] + ["pointer"] * pointers, returned)
        if found is not None and found != wanted:
            shown = "double output(double v, const double *z)" if name == "output" else \
                "void rate(double v, const double *z, double *dz)"
            raise CaseError("loop.friction", f"{name}: {', '.join(found[0])} -> {found[1]}",
                            f"must have the signature {shown}")
    return law


def _signature(function: Any) -> Optional[Tuple[List[str], str]]:
    """Kinds of the arguments and of what is returned, of a function of Numba or ctypes that states them."""
    numba = getattr(function, "_sig", None)
    if numba is not None and hasattr(function, "address"):
        kinds = [str(one) for one in numba.args]
        return ["pointer" if kind in ("float64*", "voidptr", "void*") else kind for kind in kinds], str(numba.return_type)
    if getattr(function, "argtypes", None) is None or not hasattr(function, "restype"):
        return None
    return [_kind(one) for one in function.argtypes], _kind(function.restype)


def _kind(type_of_ctypes: Any) -> str:
    code = getattr(type_of_ctypes, "_type_", None)
    if type_of_ctypes is None:
        return "none"
    if isinstance(code, str) and code != "P":
        return "float64" if code == "d" else str(type_of_ctypes.__name__)
    return "pointer"


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
    return _core.read_case(lines_of({"title": type(law).__name__, "loop": {"friction": KIND}}), "", [], checked(law))
