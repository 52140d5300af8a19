"""Systems and nonlinearities of other packages as tables of a case file. Told by what they offer, so that none is
needed."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping

from ._errors import CaseError
from ._toml import plain


def table_of(system: Any, path: str) -> Any:
    """`system`: a dictionary, (num, den), (A, B, C, D), (zeros, poles, gain), or a system of python-control
    (a frequency response too) or SciPy."""
    if system is None or isinstance(system, Mapping) or hasattr(system, "to_table"):
        return system
    if isinstance(system, (tuple, list)):
        if len(system) == 2:
            return _transfer_function(system[0], system[1], path)
        if len(system) == 3:
            return _zpk(system[0], system[1], system[2], path)
        if len(system) == 4:
            return _state_space(system[0], system[1], system[2], system[3], path)
        raise CaseError(path, "", f"must be (num, den), (zeros, poles, gain) or (A, B, C, D), found {len(system)} parts")
    if getattr(system, "dt", None) not in (None, 0, 0.0, False):
        raise CaseError(path, f"{type(system).__name__}(dt={system.dt})", "must be a continuous-time system",
                        "a sampled controller is a continuous one with the key sample_time")
    if hasattr(system, "frdata") or hasattr(system, "fresp"):
        return _frequency_response(system, path)
    if all(hasattr(system, name) for name in "ABCD"):
        return _state_space(system.A, system.B, system.C, system.D, path)
    if hasattr(system, "num") and hasattr(system, "den"):
        return _transfer_function(system.num, system.den, path)
    if hasattr(system, "zeros") and hasattr(system, "gain") and not callable(system.zeros):
        return _zpk(system.zeros, system.poles, system.gain, path)
    raise CaseError(path, "", f"must be a dictionary or a linear system, found a {type(system).__name__}")


def _frequency_response(system: Any, path: str) -> Dict[str, Any]:
    """Of an FRD object: its points, which the case then holds."""
    response = plain(system.frdata if hasattr(system, "frdata") else system.fresp)
    omega = _numbers(system.omega)
    while isinstance(response, (list, tuple)) and len(response) == 1 and isinstance(response[0], (list, tuple)):
        response = response[0]
    if not isinstance(response, (list, tuple)) or any(isinstance(one, (list, tuple)) for one in response):
        raise CaseError(path, "", "must have one input and one output")
    if len(response) != len(omega):
        raise CaseError(path, f"{len(response)} values at {len(omega)} frequencies", "must have a value at each frequency")
    points = [[w, complex(one).real, complex(one).imag] for w, one in zip(omega, response)]
    return {"kind": "frf", "frequency": "rad/s", "format": "re-im", "points": points}


def element_of(nonlinearity: Any, path: str) -> Any:
    """The table of a nonlinearity of python-control with a describing function of its own; anything else unchanged."""
    if not hasattr(nonlinearity, "describing_function") or hasattr(nonlinearity, "to_table"):
        return nonlinearity
    has = [name for name in ("lb", "ub", "b", "c", "center") if hasattr(nonlinearity, name)]
    if has == ["lb", "ub"]:
        if nonlinearity.lb != -nonlinearity.ub:
            raise CaseError(path, f"saturation from {nonlinearity.lb:g} to {nonlinearity.ub:g}", "must be symmetric",
                            "shift the reference by the middle of its limits")
        return {"kind": "saturation", "limit": plain(nonlinearity.ub)}
    if has == ["b", "c"]:
        return {"kind": "relay", "level": plain(nonlinearity.b), "hysteresis": plain(nonlinearity.c)}
    if has == ["b", "center"]:  # b is the whole gap
        return {"kind": "backlash", "half_gap": plain(nonlinearity.b) / 2.0}
    raise CaseError(path, type(nonlinearity).__name__, "must be one of saturation_nonlinearity, "
                    "relay_hysteresis_nonlinearity and friction_backlash_nonlinearity, or an object of limcycle.laws")


def _numbers(values: Any) -> List[Any]:
    values = plain(values)
    return list(values) if isinstance(values, (list, tuple)) else [values]


def _polynomial(values: Any, path: str) -> List[Any]:
    """Coefficients, highest power first; python-control has them in a list of lists."""
    values = _numbers(values)
    while len(values) == 1 and isinstance(plain(values[0]), (list, tuple)):
        values = _numbers(values[0])
    values = [plain(one) for one in values]
    if any(isinstance(one, (list, tuple)) for one in values):
        raise CaseError(path, "", "must have one input and one output")
    while len(values) > 1 and values[0] == 0:
        values = values[1:]
    return list(values)


def _transfer_function(num: Any, den: Any, path: str) -> Dict[str, Any]:
    return {"kind": "transfer-function", "numerator": _polynomial(num, path), "denominator": _polynomial(den, path)}


def _zpk(zeros: Any, poles: Any, gain: Any, path: str) -> Dict[str, Any]:
    if path == "loop.controller":  # which a case file has as a transfer function
        factor = plain(gain)
        return {"kind": "transfer-function", "numerator": [factor * one for one in _expanded(_numbers(zeros), path)],
                "denominator": _expanded(_numbers(poles), path)}
    return {"kind": "zpk", "zeros": _numbers(zeros), "poles": _numbers(poles), "gain": plain(gain)}


def _expanded(roots: List[Any], path: str) -> List[float]:
    """Coefficients of the polynomial with these roots, highest power first."""
    product = [complex(1.0)]
    for root in roots:
        lower = [0.0, *(-complex(*root) * one if isinstance(root, (list, tuple)) else -complex(root) * one
                        for one in product)]
        product = [one + other for one, other in zip([*product, 0.0], lower)]
    largest = max(abs(one) for one in product)
    if any(abs(one.imag) > 1e-12 * largest for one in product):
        raise CaseError(path, repr(roots), "must have complex zeros and poles in conjugate pairs")
    return [one.real for one in product]


def _rows(matrix: Any) -> List[List[Any]]:
    return [_numbers(row) for row in _numbers(matrix)]


def _state_space(A: Any, B: Any, C: Any, D: Any, path: str) -> Dict[str, Any]:
    A, B, C, D = _rows(A), _rows(B), _rows(C), _rows(D)
    if not any(A) and len(D) == 1 and len(D[0]) == 1:
        return {"kind": "transfer-function", "numerator": D[0], "denominator": [1.0]}
    if len(A) > 1 and len(B) == 1:  # a list is a column of B and a row of C
        B = [[one] for one in B[0]]
    if len(C) > 1 and len(A) > 1 and all(len(row) == 1 for row in C):
        C = [[row[0] for row in C]]
    if any(len(row) != 1 for row in B) or len(C) != 1 or len(D) != 1 or len(D[0]) != 1:
        raise CaseError(path, "", "must have one input and one output")
    if any(len(row) != len(A) for row in A) or len(B) != len(A) or len(C[0]) != len(A):
        raise CaseError(path, f"A of {len(A)} x {len(A[0])}, B of {len(B)} and C of {len(C[0])} numbers",
                        "must have a square A, and as many numbers in B and C as A has rows")
    return {"kind": "state-space", "A": A, "B": B, "C": C, "D": D}
