"""Results: attributes with the names of the JSON document, made from it when they are asked for."""

from __future__ import annotations

import copy
import json
import os
from html import escape
from typing import Any, Callable, Dict, Iterator, List, Optional, Sequence, Tuple, Type, Union

from . import _core
from ._errors import NoAnswer
from ._loop import Loop
from ._toml import attribute_of, key_of_attribute

_FIGURES = (".pdf", ".pgf", ".png")  # of Matplotlib
_COMPLEX = {"multipliers", "gain", "harmonics"}  # keys whose pairs are [re, im]


def _array(values: List[Any], kind: Any = float) -> Any:
    """The numbers as an array of NumPy, null as NaN."""
    import numpy

    return numpy.array(values, dtype=kind)


def _are_numbers(values: List[Any]) -> bool:
    """True for a list of numbers, some of which may be null."""
    known = [one for one in values if one is not None]
    return bool(known) and all(isinstance(one, (int, float)) and not isinstance(one, bool) for one in known)


def _are_rows(values: List[Any]) -> bool:
    return (all(isinstance(row, list) for row in values) and len({len(row) for row in values}) == 1
            and _are_numbers([one for row in values for one in row]))


def _complex(pair: Any) -> Any:
    return None if pair is None or None in pair else complex(*pair)


def _wrapped(key: str, value: Any) -> Any:
    if isinstance(value, dict):
        return Record(value)
    if not isinstance(value, list):
        return value
    if key in _COMPLEX and any(isinstance(one, list) for one in value):
        return _array([complex("nan") if one is None else one for one in [_complex(pair) for pair in value]], complex)
    if key in _COMPLEX and len(value) == 2:
        return _complex(value)
    if _are_numbers(value) or (value and _are_rows(value)):
        return _array(value)
    return [_wrapped("", one) for one in value]


class Record:
    """A part of a document. Its keys are attributes (`from_` for the key "from") and items: lists of numbers are arrays
    of NumPy, in which null is NaN; pairs [re, im] of multipliers, gains and harmonics are complex; null is None."""

    def __init__(self, content: Dict[str, Any]) -> None:
        self._content: Optional[Dict[str, Any]] = content

    def _document(self) -> Dict[str, Any]:
        return self._content or {}

    def to_dict(self) -> Dict[str, Any]:
        """The part as the JSON document has it."""
        return copy.deepcopy(self._document())

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        content, key = self._document(), key_of_attribute(name)
        if key not in content:
            raise AttributeError(f"there is no {name}; known: {', '.join(content)}")
        value = _wrapped(key, content[key])
        self.__dict__[name] = value
        return value

    def __getitem__(self, key: str) -> Any:
        if key not in self._document():
            raise KeyError(key)
        return getattr(self, attribute_of(key))

    def get(self, key: str, default: Any = None) -> Any:
        """The value of a key, or `default` if there is none."""
        return self[key] if key in self else default

    def __contains__(self, key: str) -> bool:
        return key in self._document()

    def __iter__(self) -> Iterator[str]:
        return iter(self._document())

    def __len__(self) -> int:
        return len(self._document())

    def keys(self) -> List[str]:
        """The keys of the part, in the order of the document."""
        return list(self._document())

    def items(self) -> List[Tuple[str, Any]]:
        """The keys with their values."""
        return [(key, self[key]) for key in self]

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *(attribute_of(key) for key in self._document())]

    def __repr__(self) -> str:
        return f"Record({', '.join(f'{key}={_brief(value)}' for key, value in self._document().items())})"


def _brief(value: Any) -> str:
    if isinstance(value, (list, dict)) and len(value) > 3:
        return f"<{len(value)} {'entries' if isinstance(value, list) else 'keys'}>"
    return repr(value)


class _Kept:
    """The documents of an answer that was sent or stored. Pages are left out: each is megabytes."""

    has_page = False

    def __init__(self, documents: Dict[str, Any]) -> None:
        self._documents = documents
        self.has_picture = documents["picture"] is not None
        self.columns = documents["columns"]

    def json(self) -> str:
        return str(self._documents["json"])

    def csv(self) -> str:
        return str(self._documents["csv"])

    def text(self) -> str:
        return str(self._documents["text"])

    def latex(self) -> str:
        return str(self._documents["latex"])

    def picture(self) -> Optional[str]:
        picture: Optional[str] = self._documents["picture"]
        return picture

    def arrays(self) -> Dict[str, Any]:
        return dict(self._documents["arrays"])

    def page(self) -> Optional[str]:
        raise NoAnswer("a result that was sent or stored has no page: make it before, with to_html()")

    def applied(self, name: str) -> _core.Case:
        raise NoAnswer("a result that was sent or stored makes no loop: make it before")


def _revived(kind: Type[Result], documents: Dict[str, Any]) -> Result:
    return kind(_Kept(documents))


class Result(Record):
    """The answer to a question. print() shows it in words and tables; to_dict() is the JSON document of the program."""

    def __init__(self, answer: Union[_core.Answer, _Kept]) -> None:
        self._answer = answer
        self._content = None
        self._numbers: Optional[Dict[str, Any]] = None

    def _document(self) -> Dict[str, Any]:
        if self._content is None:
            self._content = self.to_dict()
        return self._content or {}

    def to_dict(self) -> Dict[str, Any]:
        """The JSON document of the program; numbers that do not exist are None."""
        document: Dict[str, Any] = json.loads(self.to_json())
        return document

    def to_json(self) -> str:
        """The JSON document as text."""
        return self._answer.json()

    def to_csv(self) -> str:
        """The CSV document of the program."""
        return self._answer.csv()

    def to_html(self) -> Optional[str]:
        """The self-contained page of the program's --html; None where it has none."""
        return self._answer.page()

    def to_svg(self) -> Optional[str]:
        """The picture of the program's --svg; None where it has none."""
        return self._answer.picture()

    def to_latex(self, part: str, columns: Optional[Sequence[str]] = None, digits: int = 6) -> str:
        """A part of the document that is a list of records, such as "cycles", as a table of LaTeX (with booktabs).
        `columns`: keys of the records; by default those with a number or a word. `digits`: significant ones."""
        from ._latex import table

        records = self._document().get(part)
        if not isinstance(records, list) or not all(isinstance(one, dict) for one in records):
            tables = [key for key, value in self._document().items()
                      if isinstance(value, list) and value and all(isinstance(one, dict) for one in value)]
            raise ValueError(f"{part} is no list of records; there are: {', '.join(tables) or 'none'}")
        missing = [name for name in columns or () if records and not any(name in one for one in records)]
        if missing:
            raise ValueError(f"{part} has no {missing[0]}; known: {', '.join(records[0])}")
        return table(records, columns, digits)

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the document that the ending of `path` names: .json, .h5 (the same as HDF5), .csv, .html, .svg, .txt or
        .tex (its tables), or the figure of plot() as .pdf, .pgf or .png."""
        makers: Dict[str, Callable[[], Union[str, bytes, None]]] = {
            ".json": self.to_json, ".h5": lambda: _core.hdf5(self.to_json()), ".csv": self.to_csv,
            ".tex": self._answer.latex}
        if self._answer.has_page:
            makers[".html"] = self.to_html
        if self._answer.has_picture:
            makers[".svg"] = self.to_svg
        makers[".txt"] = self._answer.text
        ending = os.path.splitext(os.fspath(path))[1]
        if ending in _FIGURES:
            self._save_figure(path)
            return
        if ending not in makers:
            raise ValueError(f"{type(self).__name__} is saved as {', '.join([*makers, *_FIGURES])}, "
                             f"not {ending or 'a file without ending'}")
        document = makers[ending]() or ""
        with open(path, "wb") as file:
            file.write(document if isinstance(document, bytes) else document.encode())

    def _save_figure(self, path: Union[str, "os.PathLike[str]"]) -> None:
        from . import _plots

        _plots.save(self, path)

    def _arrays(self) -> Dict[str, Any]:
        if self._numbers is None:
            self._numbers = self._answer.arrays()
        return self._numbers

    def __reduce__(self) -> Any:
        made = self._answer
        return _revived, (type(self), {"json": made.json(), "csv": made.csv(), "text": made.text(),
                                       "latex": made.latex(), "picture": made.picture(), "arrays": self._arrays(), "columns": made.columns})

    def __str__(self) -> str:
        return self._answer.text()

    def __repr__(self) -> str:
        return f"<limcycle.{type(self).__name__}: {self.status}>"

    def _repr_html_(self) -> str:
        return (self.to_svg() or self._drawn()) + f"<pre>{escape(str(self))}</pre>"

    def _drawn(self) -> str:
        """The figure of plot() as SVG; empty without Matplotlib, and where there is nothing to draw."""
        try:
            from . import _plots
        except ImportError:
            return ""
        return _plots.svg(self) if hasattr(self, "plot") else ""

    def _plot(self, name: str, ax: Any, **options: Any) -> Any:
        from . import _plots

        return getattr(_plots, name)(self, ax, **options)


class Prediction(Result):
    """Of predict(): `cycles`, `predictions`, `missed`, `outcomes`, `absence`, `cause`, `notes`."""

    cycles: List[Record]
    predictions: List[Record]
    missed: List[Record]
    outcomes: List[Record]
    status: str

    @property
    def nyquist(self) -> Dict[str, Any]:
        """Arrays of the Nyquist plot: `frequency` (rad/s), `G` of the linear part there, and `minus_inverse_N`, one row
        for each of `family_frequency`, one column for each of `family_amplitude` (of the element's input)."""
        return dict(self._arrays())

    def plot(self, ax: Any = None) -> Any:
        """Nyquist curve of the linear part, -1/N of the element, and the predicted cycles where they meet."""
        return self._plot("nyquist", ax)


class DescribingFunctions(Result):
    """Of df(): arrays over amplitude x frequency x bias; NaN where the document has null."""

    points: List[Record]
    status: str

    @property
    def amplitude(self) -> Any:
        """Of the input, m."""
        return self._arrays()["amplitude"]

    @property
    def frequency(self) -> Any:
        """rad/s."""
        return self._arrays()["frequency"]

    @property
    def bias(self) -> Any:
        """Mean velocity (of an element: mean input)."""
        return self._arrays()["bias"]

    @property
    def gain(self) -> Any:
        """Complex gain N, output over input (N/m for a friction law)."""
        return self._arrays()["gain"]

    @property
    def mean(self) -> Any:
        """Mean of the output."""
        return self._arrays()["mean"]

    @property
    def dissipation(self) -> Any:
        """Work done per period against the law, J."""
        return self._arrays()["dissipation"]

    @property
    def error(self) -> Any:
        """Estimated relative error of `gain`."""
        return self._arrays()["error"]

    def plot(self, ax: Any = None) -> Any:
        """-1/N in the complex plane, a curve over the amplitude for each frequency and bias."""
        return self._plot("inverse_gain", ax)


class Simulation(Result):
    """Of simulate(): `columns` and `rows`; result["y"] is the column of that name."""

    events: List[Record]
    outcome: str
    status: str

    @property
    def columns(self) -> List[str]:
        """Names of the columns: "t", the states, "y", "dy_dt", inputs and outputs."""
        return list(self._answer.columns)

    @property
    def rows(self) -> Any:
        """The samples, one row each."""
        return self._arrays()["rows"]

    def __getitem__(self, key: str) -> Any:
        if key in self._answer.columns:
            return self.rows[:, self._answer.columns.index(key)]
        return super().__getitem__(key)

    def plot(self, ax: Any = None, columns: Any = None) -> Any:
        """Columns over time, one below the other; `columns`: their names (default: all but the time, at most 6)."""
        return self._plot("run", ax, columns=columns)


class Continuation(Result):
    """Of continue_(): `branch`, `events`, `parameter`."""

    branch: List[Record]
    events: List[Record]
    parameter: Record
    status: str

    def plot(self, ax: Any = None, quantity: str = "amplitude") -> Any:
        """Amplitude, or another quantity of the branch, over the parameter: stable parts solid, unstable ones dashed,
        dotted where it is not known."""
        return self._plot("branches", ax, quantity=quantity)


class Margin(Result):
    """Of margin(): `hunts`, `parameters`, `notes`."""

    hunts: Any
    parameters: List[Record]
    status: str

    def plot(self, ax: Any = None) -> Any:
        """The factors on each parameter up to which nothing changes, up and down."""
        return self._plot("margins", ax)


class Map(Result):
    """Of map(): `x`, `y`, `points` (the first side fastest), `answer`."""

    x: Record
    y: Record
    points: List[Optional[Record]]
    status: str

    @property
    def amplitude(self) -> Any:
        """Of the largest stable cycle, over y x x; NaN without one, and where it was not computed."""
        return self._arrays()["amplitude"]

    @property
    def period(self) -> Any:
        """Of the same cycle, s."""
        return self._arrays()["period"]

    @property
    def cycles(self) -> Any:
        """Number of limit cycles, over y x x; NaN where it was not computed."""
        return self._arrays()["cycles"]

    @property
    def stable(self) -> Any:
        """Number of those that are stable."""
        return self._arrays()["stable"]

    def plot(self, ax: Any = None) -> Any:
        """What happens at each point."""
        return self._plot("outcomes", ax)


class Sensitivity(Result):
    """Of sensitivity(): `parameters`, `one_at_a_time`, `morris`, `sobol`, `bands`, `share_without_answer`."""

    parameters: List[Record]
    one_at_a_time: List[Record]
    morris: List[Record]
    sobol: List[Record]
    bands: List[Record]
    status: str

    def plot(self, ax: Any = None, output: str = "amplitude") -> Any:
        """Elasticities of the cycle's amplitude (or period), the largest on top."""
        return self._plot("elasticities", ax, output=output)


class Dissipativity(Result):
    """Of dissipativity(): `passive`, `deficit`, `threshold`, `counterexample`, `state_bound`, `force_bound`."""

    passive: Union[bool, str]
    status: str

    def plot(self, ax: Any = None) -> Any:
        """The velocity of the counter-example over time; raises ValueError if there is none."""
        return self._plot("counterexample", ax)


class Remedies(Result):
    """Of remedy(): `hunts`, `cause`, `remedies`, `notes`."""

    hunts: Any
    cause: Record
    remedies: List[Record]
    status: str

    def __init__(self, answer: Union[_core.Answer, _Kept], loop: Optional[Loop] = None) -> None:
        super().__init__(answer)
        self._own = loop._own if loop is not None else None

    def apply(self, name: str) -> Loop:
        """The loop with the remedy of this name. Raises NoAnswer if that was not tried, or does not end the hunting."""
        return Loop._of(self._answer.applied(name), self._own)

    def plot(self, ax: Any = None, cost: str = "peak_sensitivity") -> Any:
        """A cost of each remedy that ends hunting, and of the loop as it is."""
        return self._plot("remedies", ax, cost=cost)


class Tuning(Result):
    """Of tune(): `numbers`, each with its `value`, `best` (index of a point), `cost`, `costs`, `searches`, `points`."""

    hunts: Any
    best: Optional[int]
    cost: Optional[float]
    numbers: List[Record]
    points: List[Record]
    status: str

    def __init__(self, answer: Union[_core.Answer, _Kept], loop: Optional[Loop] = None) -> None:
        super().__init__(answer)
        self._own = loop._own if loop is not None else None

    def tuned(self) -> Loop:
        """The loop with the numbers that were found. Raises NoAnswer if none were."""
        return Loop._of(self._answer.applied(""), self._own)

    def plot(self, ax: Any = None) -> Any:
        """The points over the first two numbers, or over the only one their costs."""
        return self._plot("searched", ax)


class Identification(Result):
    """Of identify(): `laws`, each with `parameters`, and `chosen`, the kind of the least law that the data support."""

    laws: List[Record]
    chosen: Optional[str]
    status: str

    def fitted(self) -> Loop:
        """The case with the chosen law as its friction. Raises NoAnswer if none was chosen."""
        return Loop._of(self._answer.applied(""))

    def plot(self, ax: Any = None) -> Any:
        """The intervals of the chosen law's numbers, over their values."""
        return self._plot("intervals", ax)
