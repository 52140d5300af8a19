"""Friction laws and elements: limcycle.laws.lugre(Fs=1.5, Fc=1.0, vs=0.001, sigma0=1e5).

Each kind of a case file is a function here, with "_" for "-", whose arguments are the keys of the file (lambda_ for
"lambda") and which returns a Law. help() and dir() list them with units, defaults and equations.
"""

from __future__ import annotations

import inspect
import json
import os
from types import MappingProxyType
from typing import Any, Callable, Dict, List, Mapping

from . import _core
from ._errors import CaseError
from ._toml import attribute_of, key_of_attribute, lines_of, plain

_makers: Dict[str, Callable[..., "Law"]] = {}
_SECTIONS = {"friction": "friction", "element": "element", "error element": "error"}


class Law:
    """A friction law or element with its parameters, which are attributes. It is checked when it is made, and does not
    change: lists in it are tuples."""

    kind: str
    parameters: Mapping[str, Any]
    _case: _core.Case

    def __init__(self, kind: str, **parameters: Any) -> None:
        given = {key_of_attribute(name): _frozen(value) for name, value in parameters.items() if value is not None}
        if isinstance(given.get("file"), str):
            given["file"] = os.path.abspath(given["file"])  # as it is found from the present folder
        self.__dict__.update(kind=kind, parameters=MappingProxyType(given))
        parts: Dict[str, Any] = {self.section: self.to_table()}
        if self.section == "error":  # which needs a loop around it
            parts = {"plant": {"kind": "mass", "mass": 1.0}, "controller": {"kind": "pid", "kp": 1.0}, **parts}
        text = lines_of({"title": kind, "loop": parts})
        self.__dict__.update(_case=_core.read_case(text, "", [], None))

    @property
    def section(self) -> str:
        """Where it stands in a loop: "friction", "element" or "error"."""
        for entry in _catalogue():
            if entry["kind"] == self.kind:
                return _SECTIONS[entry["group"]]
        return "friction"  # whose error lists the kinds

    def to_table(self) -> Dict[str, Any]:
        """The law as a table of a case file."""
        return {"kind": self.kind, **self.parameters}

    def __getattr__(self, name: str) -> Any:
        parameters = self.__dict__.get("parameters", {})
        if key_of_attribute(name) in parameters:
            return parameters[key_of_attribute(name)]
        raise AttributeError(f"the law {self.__dict__.get('kind')!r} was made without {name}")

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"a law does not change: make another one, with {name}={value!r}")

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Law) and self.to_table() == other.to_table()

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        given = ", ".join(f"{attribute_of(key)}={value!r}" for key, value in self.parameters.items())
        return f"{self.kind.replace('-', '_')}({given})"

    def __reduce__(self) -> Any:
        return _remade, (self.kind, dict(self.parameters))


def _frozen(value: Any) -> Any:
    value = plain(value)
    return tuple(_frozen(one) for one in value) if isinstance(value, (list, tuple)) else value


def _remade(kind: str, parameters: Dict[str, Any]) -> Law:
    return Law(kind, **parameters)


def _catalogue() -> List[Dict[str, Any]]:
    if not _entries:
        _entries.extend(one for one in json.loads(_core.laws())["laws"] if one["group"] in _SECTIONS)
    return _entries


_entries: List[Dict[str, Any]] = []


def _default(parameter: Dict[str, Any]) -> str:
    if parameter["required"]:
        return "required"
    if parameter["default_from"]:
        return f"default: {parameter['default_from']}"
    return "optional" if parameter["default"] is None else f"default: {parameter['default']}"


def _maker(entry: Dict[str, Any]) -> Callable[..., Law]:
    kind = entry["kind"]

    def make(**parameters: Any) -> Law:
        return Law(kind, **parameters)

    make.__name__ = make.__qualname__ = kind.replace("-", "_")
    lines = [f"    {one['key']}: {one['meaning']}" + ("" if one["unit"] in ("", "1") else f", {one['unit']}") +
             f" ({_default(one)})" for one in entry["parameters"]]
    make.__doc__ = "\n".join([entry["equation"] or kind, "", *lines, "", f"Source: {entry['source']}"])
    order = sorted(entry["parameters"], key=lambda one: not one["required"])
    make.__signature__ = inspect.Signature(  # type: ignore[attr-defined]
        [inspect.Parameter(attribute_of(one["key"]), inspect.Parameter.KEYWORD_ONLY,
                           default=inspect.Parameter.empty if one["required"] else one["default"]) for one in order],
        return_annotation=Law)
    return make


def kinds() -> List[str]:
    """All kinds, as a case file spells them."""
    return list(dict.fromkeys(entry["kind"] for entry in _catalogue()))


def __getattr__(name: str) -> Callable[..., Law]:
    if name.startswith("__"):
        raise AttributeError(name)
    if name not in _makers:
        for entry in _catalogue():
            if entry["kind"].replace("-", "_") == name:
                _makers[name] = _maker(entry)
                break
        else:
            try:
                Law(name.replace("_", "-"))
            except CaseError as error:
                raise AttributeError(f"limcycle.laws has no {name}; {error.suggestion}") from None
    return _makers[name]


def __dir__() -> List[str]:
    return ["Law", "kinds", *(kind.replace("-", "_") for kind in kinds())]
