"""The loop that is asked about."""

from __future__ import annotations

import os
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Union

from . import _core
from ._errors import CaseError
from ._own_law import KIND, checked, is_own
from ._systems import element_of, table_of
from ._toml import lines_of, text_of


class Number(NamedTuple):
    """A number of a loop: its path ("loop.controller.kd"), unit ("1": none), meaning and value."""

    path: str
    unit: str
    meaning: str
    value: float


class Loop:
    """A feedback loop, checked as a case file is.

    `plant` and `controller` are dictionaries with the keys of a case file, (num, den), (A, B, C, D), (zeros, poles,
    gain), or continuous systems of python-control or SciPy; `friction`, `element` and `error` dictionaries or objects of
    limcycle.laws; `element` may be a nonlinearity of python-control, and `friction` a law of your own, an object with `output(v, z)` (see docs/python.md).
    `reference` is a number or {"kind": "ramp", "rate": ...}, `load` a constant force on the plant, `delay`
    the dead time of a plant that has one (transfer-function, zpk), s. Other sections of a case file are keywords too:
    `diagram` (then without plant), `search`, `predict`, `simulate`, `df`, `sensitivity`, `dissipativity`,
    `identify`, `units`.

    Raises CaseError, which names the key.
    """

    def __init__(self, *, plant: Any = None, controller: Any = None, friction: Any = None, element: Any = None,
                 error: Any = None, reference: Any = None, load: Optional[float] = None,
                 delay: Optional[float] = None, title: str = "Loop", **sections: Any) -> None:
        plant = table_of(plant, "loop.plant")
        element = element_of(element, "loop.element")
        if delay is not None:
            plant = {**(plant or {}), "delay": delay}
        for name, part in (("element", element), ("error", error)):
            if is_own(part):
                raise CaseError(name, type(part).__name__, "must be a dictionary or an object of limcycle.laws",
                                "only friction may be a law of your own")
        self._own = checked(friction) if is_own(friction) else None
        parts = {"reference": reference, "load": load, "plant": plant,
                 "controller": table_of(controller, "loop.controller"),
                 "friction": friction if self._own is None else KIND, "element": element, "error": error}
        parts = {key: value for key, value in parts.items() if value is not None}
        case: Dict[str, Any] = {"title": title, **({"loop": parts} if parts else {}), **sections}
        self._case = _core.read_case(lines_of(_with_full_names(case)), "", [], self._own)

    @classmethod
    def _of(cls, case: _core.Case, own: Any = None) -> Loop:
        loop = cls.__new__(cls)
        loop._case, loop._own = case, own
        return loop

    def set(self, values: Mapping[str, Any]) -> Loop:
        """The loop with other values at some paths: loop.set({"loop.controller.kd": 8.0})."""
        if not isinstance(values, Mapping):
            raise CaseError("values", repr(values), 'must be values by path, such as {"loop.controller.kd": 8.0}')
        return Loop._of(changed(self._case, values), self._own)

    @property
    def title(self) -> str:
        """The title of the case."""
        return self._case.title

    @property
    def file(self) -> str:
        """The case file, with its full name; empty for a loop that was made here."""
        return self._case.file

    @property
    def text(self) -> str:
        """The case file, or the one that this loop would be, without the values of set()."""
        return self._case.text

    @property
    def overrides(self) -> List[str]:
        """The values of set(), as `--set` of the program takes them."""
        return list(self._case.overrides)

    @property
    def numbers(self) -> List[Number]:
        """Every number of the loop that can be varied."""
        return [Number(*one) for one in self._case.numbers()]

    def __getitem__(self, path: str) -> float:
        for one in self.numbers:
            if one.path == path:
                return one.value
        raise KeyError(path)

    def __repr__(self) -> str:
        return f"<limcycle.Loop {self.title!r}{' of ' + self.file if self.file else ''}>"

    def __reduce__(self) -> Any:
        return _reread, (self.text, self.file, self.overrides, self._own)


def _reread(text: str, file: str, overrides: List[str], own: Any) -> Loop:
    return Loop._of(_core.read_case(text, file, overrides, own), own)


def changed(case: _core.Case, values: Mapping[str, Any]) -> _core.Case:
    """The case with other values at some paths."""
    if not case.file:
        values = {path: _full_name(value) if path.endswith(".file") else value for path, value in values.items()}
    return _core.read_again(case, [*case.overrides, *(f"{path}={text_of(value, path)}" for path, value in values.items())])


def _full_name(file: Any) -> Any:
    return os.path.abspath(file) if isinstance(file, (str, os.PathLike)) else file


def _with_full_names(value: Any) -> Any:
    """The same with full names of files: a loop that was made here has no folder from which they could be found later."""
    if isinstance(value, Mapping):
        return {key: _full_name(one) if key == "file" else _with_full_names(one) for key, one in value.items()}
    return [_with_full_names(one) for one in value] if isinstance(value, (list, tuple)) else value


def load(path: Union[str, "os.PathLike[str]"], overrides: Optional[Mapping[str, Any]] = None) -> Loop:
    """Reads a case file; `overrides` as Loop.set(). The loop knows the file by its full name. Raises CaseError with
    file, line and key."""
    if not isinstance(path, (str, os.PathLike)):
        raise CaseError("path", repr(path), "must be the name of a case file")
    changes = [f"{key}={text_of(value, key)}" for key, value in (overrides or {}).items()]
    return Loop._of(_core.load_case(os.path.abspath(path), changes))
