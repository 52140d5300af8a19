"""Dictionaries as the text of a case file, so that both pass through the same loader."""

from __future__ import annotations

import json
import keyword
import math
import os
import re
from typing import Any, Mapping

from ._errors import CaseError

_BARE = re.compile(r"[A-Za-z0-9_-]+\Z")


def plain(value: Any) -> Any:
    """NumPy's numbers and arrays as Python's."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if hasattr(value, "item"):
        return value.item()
    return value


def attribute_of(key: str) -> str:
    """A key as Python can write it: "lambda_" for "lambda", which it reserves."""
    return key + "_" if keyword.iskeyword(key) else key


def key_of_attribute(name: str) -> str:
    """The key that attribute_of() made this name of."""
    return name[:-1] if name.endswith("_") and keyword.iskeyword(name[:-1]) else name


def text_of(value: Any, path: str) -> str:
    """A value in TOML. Raises CaseError, with `path` as its key, for one that no case has."""
    value = plain(value)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value) if abs(value) < 2**63 else repr(float(value))
    if isinstance(value, float):
        if math.isnan(value):
            raise CaseError(path, "nan", "must be a number")
        return repr(value)
    if isinstance(value, complex):
        return text_of([value.real, value.imag], path)
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if hasattr(value, "to_table"):
        value = value.to_table()
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key_of(key, path)} = {text_of(one, f'{path}.{key}')}"
                               for key, one in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(text_of(one, path) for one in value) + "]"
    raise CaseError(path, repr(value), f"must be a value of a case file, found a {type(value).__name__}")


def key_of(key: Any, path: str) -> str:
    if not isinstance(key, str):
        raise CaseError(path, repr(key), "keys must be strings")
    return key if _BARE.match(key) else json.dumps(key, ensure_ascii=False).replace("\x7f", "\\u007f")


def lines_of(table: Mapping[str, Any], path: str = "") -> str:
    """A table as lines "key = value", its own tables under headings."""
    text, below = "", ""
    for key, value in table.items():
        if value is None:
            continue
        name = key_of(key, path or str(key))
        full = f"{path}.{name}" if path else name
        if hasattr(value, "to_table"):
            value = value.to_table()
        if isinstance(value, Mapping):
            below += f"\n[{full}]\n" + lines_of(value, full)
        else:
            text += f"{name} = {text_of(value, full)}\n"
    return text + below
