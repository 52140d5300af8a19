"""Writes a case as TOML: which keys, in which order of sections."""

import json
import math


def value(item):
    """One value in TOML syntax; floats keep all their digits."""
    if isinstance(item, bool):
        return "true" if item else "false"
    if isinstance(item, str):
        return json.dumps(item)
    if isinstance(item, int):
        return str(item)
    if isinstance(item, dict):
        return "{ " + ", ".join(f"{key} = {value(entry)}" for key, entry in item.items()) + " }"
    if isinstance(item, (list, tuple)):
        return "[" + ", ".join(value(entry) for entry in item) + "]"
    item = float(item)
    if not math.isfinite(item):
        raise ValueError(f"not a number of a case: {item}")
    return repr(item)


def section(name, keys):
    """A section with its keys, one a line."""
    return "\n".join([f"[{name}]"] + [f"{key} = {value(entry)}" for key, entry in keys.items()])


def toml(case, comments=(), backwards=False):
    """The text of a case; `backwards` turns the order of its sections and of their keys round."""
    parts = []
    for name, keys in case.items():
        if not isinstance(keys, dict):
            continue
        if name == "diagram":
            parts.append((name, {key: entry for key, entry in keys.items() if key != "block"}))
            parts += [("[diagram.block]", block) for block in keys["block"]]
            continue
        if name != "loop":
            parts.append((name, keys))
            continue
        plain = {key: entry for key, entry in keys.items() if key not in PARTS}
        if plain:
            parts.append(("loop", plain))
        parts += [(f"loop.{key}", keys[key]) for key in keys if key in PARTS]
    if backwards:
        parts = [(name, dict(reversed(keys.items()))) for name, keys in reversed(parts)]
    head = [f"# {line}" for line in comments]
    head += [f"{key} = {value(entry)}" for key, entry in case.items() if not isinstance(entry, dict)]
    return "\n\n".join(["\n".join(head)] * bool(head) + [section(*part) for part in parts]) + "\n"


PARTS = ("plant", "controller", "friction", "element", "error")
