"""Friction laws of the user's own, written in Python."""

from __future__ import annotations

from typing import Any, Mapping

from . import _core
from ._toml import lines_of

KIND = {"kind": "own"}  # what the text of a case has in the place of the law


def is_own(law: Any) -> bool:
    """True for an object that is to be asked itself."""
    return law is not None and not isinstance(law, Mapping) and not hasattr(law, "to_table")


def own_case(law: Any) -> _core.Case:
    """The case of a lone law."""
    return _core.read_case(lines_of({"title": type(law).__name__, "loop": {"friction": KIND}}), "", [], law)
