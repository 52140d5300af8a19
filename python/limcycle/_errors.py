"""Exceptions of the package."""

from __future__ import annotations

from typing import Any


class CaseError(ValueError):
    """Bad input. `key` names what is wrong ("loop.friction.Fs", or an argument), `value` is the value as it was written
    (empty if there is none), `rule` the condition it breaks, `suggestion` a nearby valid name or what to do (or empty),
    `file` and `line` the place in a case file (empty and 0: it did not come from one)."""

    def __init__(self, key: str, value: str = "", rule: str = "", suggestion: str = "", file: str = "", line: int = 0,
                 override: str = "") -> None:
        if override:
            key, _, value = override.partition("=")
            file = ""
        self.key, self.value, self.rule, self.suggestion = key, value, rule, suggestion
        self.file, self.line = file, line if file else 0
        place = f"{file}:{line}: " if self.line else f"{file}: " if file else ""
        what = f"{key} = {value}: " if value else f"{key}: " if key else ""
        super().__init__(place + what + rule + (f"; {suggestion}" if suggestion else ""))

    def __reduce__(self) -> Any:
        return type(self), (self.key, self.value, self.rule, self.suggestion, self.file, self.line)


class NoAnswer(RuntimeError):
    """A valid case with numbers that no method can handle, or a result that does not hold what is wanted of it."""
