"""Tables of LaTeX, for papers. They need the package booktabs."""

from __future__ import annotations

import math
from typing import Any, Dict, List, Optional, Sequence

_ESCAPED = {"\\": r"\textbackslash{}", "{": r"\{", "}": r"\}", "&": r"\&", "%": r"\%", "$": r"\$", "#": r"\#",
            "_": r"\_", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}


def table(records: Sequence[Dict[str, Any]], columns: Optional[Sequence[str]], digits: int) -> str:
    """The records as rows. Columns that are not named: those that have a number or a word in every row."""
    names = list(columns) if columns is not None else _plain_columns(records)
    numeric = [all(isinstance(row.get(name), (int, float, type(None))) for row in records) for name in names]
    lines = [f"\\begin{{tabular}}{{{''.join('r' if one else 'l' for one in numeric)}}}", r"\toprule",
             _row(_escaped(name.replace("_", " ")) for name in names), r"\midrule",
             *(_row(_cell(row.get(name), digits) for name in names) for row in records), r"\bottomrule", r"\end{tabular}"]
    return "\n".join(lines) + "\n"


def _plain_columns(records: Sequence[Dict[str, Any]]) -> List[str]:
    kinds = (str, int, float, type(None))
    return [name for name in (records[0] if records else {})
            if all(isinstance(row.get(name), kinds) for row in records) and any(row.get(name) is not None for row in records)]


def _row(cells: Any) -> str:
    return " & ".join(cells) + r" \\"


def _escaped(text: str) -> str:
    return "".join(_ESCAPED.get(one, one) for one in text)


def _cell(value: Any, digits: int) -> str:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return "--"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if not isinstance(value, (int, float)):
        return _escaped(str(value))
    text = str(value) if isinstance(value, int) else f"{value:.{digits}g}"
    mantissa, _, exponent = text.partition("e")
    if exponent:
        return f"${mantissa} \\times 10^{{{int(exponent)}}}$"
    return f"${text}$"
