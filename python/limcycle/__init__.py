"""Limit cycles of feedback loops with friction.

    >>> import limcycle
    >>> loop = limcycle.Loop(plant={"kind": "mass", "mass": 1.0},
    ...                      controller={"kind": "pid", "kp": 3.0, "ki": 4.0, "kd": 6.0},
    ...                      friction=limcycle.laws.lugre(Fs=1.5, Fc=1.0, vs=0.001, sigma0=1e5, sigma1=316.0))
    >>> result = limcycle.predict(loop)
    >>> print(result)                     # the answer in words and tables
    >>> result.cycles[0].period           # attributes have the names of the JSON document
    >>> result.plot()                     # needs Matplotlib

A Loop is made of dictionaries with the keys of a case file, or read from one by load(). Each question is a function,
which returns a Result.
"""

from . import laws
from ._core import version as __version__
from ._errors import CaseError, NoAnswer
from ._loop import Loop, Number, load
from ._questions import (continue_, describing_function, df, dissipativity, identify, map as map, margin, predict,
                         remedy, sensitivity, simulate, tune)
from ._results import (Continuation, DescribingFunctions, Dissipativity, Identification, Map, Margin, Prediction, Record,
                       Remedies, Result, Sensitivity, Simulation, Tuning)

# Without `map`, which would hide the one of Python.
__all__ = [
    "CaseError", "Continuation", "DescribingFunctions", "Dissipativity", "Identification", "Loop", "Map", "Margin",
    "NoAnswer", "Number", "Prediction", "Record", "Remedies", "Result", "Sensitivity", "Simulation", "Tuning", "continue_",
    "describing_function", "df", "dissipativity", "identify", "laws", "load", "margin", "predict", "remedy", "sensitivity",
    "simulate", "tune",
]

for _name in [*__all__, "map"]:
    if _name != "laws":
        globals()[_name].__module__ = __name__  # as users import it: in tracebacks and help()
