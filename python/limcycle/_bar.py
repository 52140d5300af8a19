"""Progress as a bar of tqdm: in a terminal and in a notebook, as that package sees fit."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from ._errors import CaseError


class Bar:
    """Called with the fraction done and the activity; closed when the work is done or given up."""

    def __init__(self) -> None:
        try:
            tqdm = import_module("tqdm.auto").tqdm
        except ImportError:
            raise CaseError("progress", "True", "needs the package tqdm, which is not installed",
                            "install it, or give a function of the fraction done and the activity") from None
        self._bar: Any = tqdm(total=100.0, bar_format="{l_bar}{bar}| {elapsed}<{remaining}", leave=False)

    def __call__(self, fraction: float, what: str) -> None:
        self._bar.set_description_str(what, refresh=False)
        self._bar.n = 100.0 * fraction
        self._bar.refresh()

    def __del__(self) -> None:
        if hasattr(self, "_bar"):
            self._bar.close()
