"""One function a question."""

from __future__ import annotations

import inspect
import math
from typing import Any, Callable, Mapping, Optional, Sequence, Tuple, TypeVar, Union

from . import _core, _results
from ._bar import Bar
from ._checks import number, stretch, whole, word, words
from ._errors import CaseError
from ._loop import Loop, changed
from ._own_law import StaticLaw, is_own, own_case
from ._systems import element_of
from ._toml import plain
from .laws import Law

Question = TypeVar("Question", bound=Callable[..., Any])
Progress = Union[None, bool, Callable[[float, str], None]]
Side = Union[Tuple[str, float, float, int], Tuple[str, float, float, int, str]]

_PATH = 'a path such as "loop.controller.kd"'
_COMMON = {
    "seed": "`seed`: of everything random.",
    "threads": "`threads`: 0 is one a core; results do not depend on it.",
    "isa": '`isa`: instruction set of the kernels; "auto" is the widest of this machine.',
    "time_limit": '`time_limit`: seconds after which the work ends and keeps its results, with the status "time-limit".',
    "progress": "`progress(fraction, what)` is called while it works; True shows a bar of tqdm.",
}


def _explained(function: Question) -> Question:
    """Adds to its description those of the arguments that several questions have."""
    lines = [line for name, line in _COMMON.items() if name in inspect.signature(function).parameters]
    function.__doc__ = "\n    ".join([(function.__doc__ or "").rstrip() + "\n", *lines,
                                      "Ctrl-C ends the work with KeyboardInterrupt."])
    return function


def _case_of(loop: Loop) -> _core.Case:
    if not isinstance(loop, Loop):
        raise CaseError("loop", type(loop).__name__, "must be a limcycle.Loop")
    return loop._case


def _case_or_law(what: Any) -> _core.Case:
    """The case of a Loop, or of a lone law."""
    if isinstance(what, (Loop, Law)):
        return what._case
    if isinstance(what, Mapping) and "kind" in what:
        return Law(**what)._case
    if is_own(what) and hasattr(what, "output"):
        return own_case(what)
    raise CaseError("loop_or_law", type(what).__name__,
                    "must be a limcycle.Loop, a law, or an object with output(v, z) and scales")


def _given(section: str, **values: Any) -> Mapping[str, Any]:
    """Values of a section of the case, by their paths."""
    return {f"{section}.{key}": value for key, value in values.items() if value is not None}


def _work(time_limit: Optional[float], progress: Progress, *, seed: int = 0, threads: int = 1,
          isa: str = "auto") -> _core.Work:
    limit = 0.0
    if time_limit is not None:
        limit = number("time_limit", time_limit, "finite and > 0 s, or None", lambda s: 0.0 < s < math.inf)
    if isinstance(progress, bool):
        progress = Bar() if progress else None
    if progress is not None and not callable(progress):
        raise CaseError("progress", repr(progress), "must be a function of the fraction done and the activity, or True")
    return _core.Work(whole("seed", seed, 0, 2**64 - 1), whole("threads", threads, 0, 1024),
                      word("isa", isa, "the name of an instruction set"), limit, progress)


@_explained
def predict(loop: Loop, *, time_limit: Optional[float] = None, progress: Progress = None) -> _results.Prediction:
    """Every limit cycle of a loop, by every method, each checked in the time domain, with a verdict."""
    return _results.Prediction(_core.predict(_case_of(loop), _work(time_limit, progress)))


@_explained
def df(loop_or_law: Any, amplitude: Any = None, frequency: Any = None, bias: Any = None,
       *, harmonics: Optional[int] = None, accuracy: Optional[float] = None, method: Optional[str] = None,
       threads: int = 0, isa: str = "auto", time_limit: Optional[float] = None,
       progress: Progress = None) -> _results.DescribingFunctions:
    """Describing functions over a grid: amplitude (m), frequency (rad/s), bias (m/s for a friction law; 0 if not given).

    `gain` of the result is a complex array of shape amplitude x frequency x bias; so are `mean`, `dissipation` and
    `error`. What is not given is taken from the section [df] of the case."""
    case = _case_or_law(loop_or_law)
    given = _given("df", amplitude=_axis(amplitude), frequency=_axis(frequency), bias=_axis(bias), harmonics=harmonics,
                   accuracy=accuracy, method=method)
    if not case.has_df:
        for name in ("amplitude", "frequency"):
            if f"df.{name}" not in given:
                raise CaseError(name, "", "is required: the case has no section [df]")
    answer = _core.df(changed(case, given) if given else case, _work(time_limit, progress, threads=threads, isa=isa))
    return _results.DescribingFunctions(answer)


def describing_function(nonlinearity: Any, amplitude: Any) -> Any:
    """The describing function of an element over amplitudes > 0: a complex array of their shape, as that of
    python-control.

    `nonlinearity`: an element of limcycle.laws that does not depend on the frequency, a nonlinearity of python-control, or
    a function F(u) of one number without memory. NaN where the gain is not known to 0.1 %."""
    import numpy

    try:
        sizes = numpy.asarray(amplitude, dtype=float)
    except (TypeError, ValueError):
        raise CaseError("amplitude", repr(amplitude), "must be numbers, finite and above 0") from None
    for one in sizes.flat:
        number("amplitude", one, "finite and above 0", lambda x: 0.0 < x < math.inf)
    try:
        law = element_of(nonlinearity, "nonlinearity")
    except CaseError:  # of python-control, but none that a case can hold
        if not callable(nonlinearity) or not getattr(nonlinearity, "_isstatic", lambda: True)():
            raise
        law = nonlinearity
    if isinstance(law, Mapping):
        law = Law(**law)
    turn: complex = 1.0
    if isinstance(law, Law):
        friction = law.section == "friction"
        answers = [df(law, sizes.ravel(), [1.0, 2.0], threads=1)] if sizes.size and not friction else []
        if friction or not all(numpy.allclose(one.gain[:, 0], one.gain[:, 1], rtol=1e-6, atol=0.0, equal_nan=True)
                               for one in answers):
            raise CaseError("nonlinearity", law.kind, "must not depend on the frequency", "use limcycle.df")
    elif callable(law):
        if not getattr(law, "_isstatic", lambda: True)():
            raise CaseError("nonlinearity", type(law).__name__, "must be without memory: a function F(u) of one number")
        answers = [df(StaticLaw(law, one), one, 1.0, threads=1) for one in sizes.ravel().tolist()]
        turn = -1.0j  # gains of friction laws are of the displacement
    else:
        raise CaseError("nonlinearity", type(law).__name__, "must be an element of limcycle.laws, a nonlinearity of "
                        "python-control or a function of one number")
    gains = [numpy.where(one.error <= 1e-3, one.gain, numpy.nan)[:, 0].ravel() for one in answers]
    return turn * numpy.concatenate([numpy.zeros(0), *gains]).reshape(sizes.shape)


def _axis(values: Any) -> Any:
    values = plain(values)
    return values if values is None or isinstance(values, (list, tuple, Mapping)) else [values]


@_explained
def simulate(loop: Loop, duration: Optional[float] = None, *, initial: Optional[Mapping[str, float]] = None,
             force: Any = None, reference: Any = None, stepper: Optional[str] = None, rtol: Optional[float] = None,
             sample: Optional[float] = None, check: bool = True, audit: bool = True,
             time_limit: Optional[float] = None, progress: Progress = None) -> _results.Simulation:
    """A run in time. What is not given is taken from the section [simulate] of the case.

    `initial` has states by name, `force` and `reference` are signals as in a case file, `sample` is the time between rows
    (s). The run is checked by a second one at other tolerances (`check`), and its energy is balanced (`audit`)."""
    case = _case_of(loop)
    if duration is None and not case.has_simulate:
        raise CaseError("duration", "", "is required: the case has no section [simulate]")
    given = _given("simulate", duration=duration, initial=initial, force=force, reference=reference, stepper=stepper,
                   rtol=rtol, sample=sample)
    case = changed(case, given) if given else case
    return _results.Simulation(_core.simulate(case, _work(time_limit, progress), bool(check), bool(audit)))


@_explained
def continue_(loop: Loop, parameter: str, start: float, stop: float, *, time_limit: Optional[float] = None,
              progress: Progress = None) -> _results.Continuation:
    """Follows the limit cycles over a parameter ("loop.controller.kd") from `start` to `stop`: folds, changes of
    stability, ends."""
    path, (low, high) = word("parameter", parameter, _PATH), stretch("start, stop", start, stop)
    return _results.Continuation(_core.continue_(_case_of(loop), _work(time_limit, progress), path, low, high))


@_explained
def margin(loop: Loop, parameters: Union[str, Sequence[str]] = (), *, toward: Optional[Mapping[str, float]] = None,
           factor: float = 10.0, time_limit: Optional[float] = None, progress: Progress = None) -> _results.Margin:
    """How far each parameter (or those given) is, up to a factor, from where hunting begins or ends.

    `toward`: numbers that change together, such as {"kd": 10.0, "ki": 2.0}, as one parameter: 1 stands for the
    numbers of the loop, 2 for those given."""
    most = number("factor", factor, "1.01 to 1000", lambda x: 1.01 <= x <= 1000.0)
    paths = words("parameters", parameters, _PATH)
    if toward is not None and not isinstance(toward, Mapping):
        raise CaseError("toward", repr(toward), 'must be values by number, such as {"kd": 10.0, "ki": 2.0}')
    line = [(word("toward", name, _PATH), number(f"toward[{name!r}]", value, "a finite number"))
            for name, value in (toward or {}).items()]
    return _results.Margin(_core.margin(_case_of(loop), _work(time_limit, progress), paths, most,
                                        [line] if line else []))


@_explained
def map(loop: Loop, x: Side, y: Side, *, methods: Union[str, Sequence[str]] = (), outcomes: bool = False,
        starts: Optional[int] = None, threads: int = 0, isa: str = "auto", time_limit: Optional[float] = None,
        progress: Progress = None) -> _results.Map:
    """Outcomes over two parameters, each (path, start, stop, points) or (path, start, stop, points, "log").

    `outcomes`: by simulation from the starts alone, faster, without a verdict on any method."""
    count = 0 if starts is None else whole("starts", starts, 1, 100)
    names = words("methods", methods, "the name of a method")
    if outcomes and names:
        raise CaseError("methods", repr(methods), "must be left out of a map of outcomes, which judges none")
    return _results.Map(_core.map(_case_of(loop), _work(time_limit, progress, threads=threads, isa=isa), _side("x", x),
                                  _side("y", y), names, bool(outcomes), count))


def _side(name: str, side: Any) -> Tuple[str, float, float, int, bool]:
    if not isinstance(side, (tuple, list)) or len(side) not in (4, 5):
        raise CaseError(name, repr(side), 'must be (path, start, stop, points) or (path, start, stop, points, "log")')
    path, (start, stop) = word(name, side[0], _PATH), stretch(name, side[1], side[2])
    points, spacing = whole(name, side[3], 2, 10000), side[4] if len(side) == 5 else "linear"
    if spacing not in ("log", "linear"):
        raise CaseError(name, repr(spacing), 'must be "log" or "linear"')
    if spacing == "log" and start * stop <= 0.0:
        raise CaseError(name, repr(start), "must have ends of one sign, not 0, if it is logarithmic")
    return path, start, stop, points, spacing == "log"


@_explained
def sensitivity(loop: Loop, *, samples: Optional[int] = None, trajectories: Optional[int] = None,
                second_order: bool = False, factors: Union[float, Sequence[float]] = (0.5, 2.0), local: bool = False,
                thresholds: Union[str, Sequence[str]] = (), seed: int = 0, threads: int = 0, isa: str = "auto",
                time_limit: Optional[float] = None, progress: Progress = None) -> _results.Sensitivity:
    """Sensitivity of the cycle to every number, and share of loops that hunt over the spread of [sensitivity] (each
    number by +-20 % without it).

    `samples` and `trajectories` are the sizes of Sobol's and Morris' studies, `factors` those on each number, one at a
    time; `local`: derivatives and one at a time only; `thresholds`: paths of numbers whose threshold is wanted."""
    sizes = [0 if size is None else whole(name, size, 1, most)
             for name, size, most in (("samples", samples, 1 << 24), ("trajectories", trajectories, 1 << 20))]
    each = [number("factors", one, "finite and not 0", lambda x: math.isfinite(x) and x != 0.0)
            for one in _axis(factors)]
    return _results.Sensitivity(_core.sensitivity(
        _case_of(loop), _work(time_limit, progress, seed=seed, threads=threads, isa=isa), sizes[0], sizes[1],
        bool(second_order), each, bool(local), words("thresholds", thresholds, _PATH)))


@_explained
def dissipativity(loop_or_law: Union[Loop, Law, Mapping[str, Any]], *, speed: Optional[float] = None,
                  top_speed: Optional[float] = None, parameter: Optional[Tuple[str, float, float]] = None,
                  seed: int = 0, time_limit: Optional[float] = None,
                  progress: Progress = None) -> _results.Dissipativity:
    """Boundedness, passivity and storage of a law, with a counter-example where it fails.

    `speed`: up to which the force is bounded, `top_speed`: of the motions that may take energy out (m/s), `parameter`:
    (path, start, stop) of a number over which passivity is searched."""
    speeds = [0.0 if value is None else number(name, value, "> 0 m/s", lambda v: 0.0 < v < math.inf)
              for name, value in (("speed", speed), ("top_speed", top_speed))]
    path, start, stop = "", 0.0, 0.0
    if parameter is not None:
        if not isinstance(parameter, (tuple, list)) or len(parameter) != 3:
            raise CaseError("parameter", repr(parameter), "must be (path, start, stop)")
        path, (start, stop) = word("parameter", parameter[0], _PATH), stretch("parameter", parameter[1], parameter[2])
    return _results.Dissipativity(_core.dissipativity(
        _case_or_law(loop_or_law), _work(time_limit, progress, seed=seed), speeds[0], speeds[1], path, start, stop))


@_explained
def remedy(loop: Loop, only: Union[str, Sequence[str]] = (), *, weights: Optional[Mapping[str, float]] = None,
           samples: int = 32, seed: int = 0, threads: int = 0, time_limit: Optional[float] = None,
           progress: Progress = None) -> _results.Remedies:
    """Why the loop hunts, which changes end it, and what each costs.

    `only`: names of remedies, such as "gain-kd" (all if none is given), `weights`: of the costs by name, by whose sum
    the remedies are sorted, `samples`: of the section [sensitivity], for the share in which a remedy still works."""
    weighed = {word("weights", name, "the name of a cost"):
               number(f"weights[{name!r}]", value, "finite, 0 or more", lambda x: 0.0 <= x < math.inf)
               for name, value in (weights or {}).items()}
    answer = _core.remedy(_case_of(loop), _work(time_limit, progress, seed=seed, threads=threads),
                          words("only", only, "the name of a remedy"), weighed, whole("samples", samples, 0, 100000))
    return _results.Remedies(answer, loop)


@_explained
def tune(loop: Loop, vary: Mapping[str, Tuple[float, float]], *, minimise: str = "ms",
         at_most: Optional[Mapping[str, float]] = None, horizon: Optional[float] = None, margin: float = 0.0,
         samples: int = 64, seed: int = 0, threads: int = 0, time_limit: Optional[float] = None, progress: Progress = None) -> _results.Tuning:
    """The numbers within bounds for which the loop does not hunt and a cost is least.

    `vary`: the bounds of each number by its path or the end of that, such as {"kp": (1.0, 100.0)}, `minimise`: "ms",
    "settling" or "ise", `at_most`: limits of costs by name, `horizon`: s, of ise, `margin`: share by which
    each number may change without hunting, `samples`: of the global search."""
    if not isinstance(vary, Mapping):
        raise CaseError("vary", repr(vary), 'must be bounds by number, such as {"kp": (1.0, 100.0)}')
    bounds = []
    for name, ends in vary.items():
        if not isinstance(ends, (tuple, list)) or len(ends) != 2:
            raise CaseError(f"vary[{name!r}]", repr(ends), "must be (low, high)")
        bounds.append((word("vary", name, _PATH), *stretch(f"vary[{name!r}]", ends[0], ends[1])))
    limits = {word("at_most", name, "the name of a cost"):
              number(f"at_most[{name!r}]", value, "finite and above 0", lambda x: 0.0 < x < math.inf)
              for name, value in (at_most or {}).items()}
    span = 0.0 if horizon is None else number("horizon", horizon, "> 0 s", lambda x: 0.0 < x < math.inf)
    answer = _core.tune(_case_of(loop), _work(time_limit, progress, seed=seed, threads=threads), bounds,
                        word("minimise", minimise, "the name of a cost"), limits, span,
                        number("margin", margin, "0 to 0.5", lambda x: 0.0 <= x <= 0.5),
                        whole("samples", samples, 1, 100000))
    return _results.Tuning(answer, loop)


@_explained
def identify(case: Loop, *, plan: bool = False, time_limit: Optional[float] = None, progress: Progress = None) -> _results.Identification:
    """Friction laws fitted to measured records, as the section [identify] of a case names them: load() it, or give
    Loop(identify={"law": [...], "record": [{"kind": ..., "file": ...}]}). `plan`: also how far one more record of each kind
    would narrow each number."""
    return _results.Identification(_core.identify(_case_of(case), _work(time_limit, progress), bool(plan)))
