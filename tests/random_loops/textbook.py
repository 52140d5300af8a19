"""Stands for the program where the checks themselves are tested: answers in closed form, and wrong ones on purpose.

The loop is a relay (level D, hysteresis h) before K/s: a triangle wave, T = 4 h/(K D), A = h. By decree it rests where
h <= 0.1, so that margins have something to find. The law is LuGre, which is passive from sigma2 = sigma1 (Fs - Fc)/Fc on.
"""

import copy
import math

import numpy as np

from .laws import bristle, stribeck_level
from .program import Answer

LOOP = {
    "plant": {"kind": "zpk", "zeros": [], "poles": [0.0], "gain": 2.0},
    "element": {"kind": "relay", "level": 1.5, "hysteresis": 0.12},
}
BORDER = 0.1  # hysteresis below which the loop rests
LAW = {"kind": "lugre", "Fs": 1.5, "Fc": 1.0, "vs": 1e-3, "sigma0": 1e5, "sigma1": 300.0, "sigma2": 50.0}
H, D, K = "loop.element.hysteresis", "loop.element.level", "loop.plant.gain"


class Textbook:
    """Has the face of program.Program. `spoil` gets the command and its document, and may change the document."""

    limit = 60.0

    def __init__(self, case, spoil=lambda command, document: None):
        self.case, self.spoil = case, spoil

    def run(self, command, path, *words, limit=None):
        """One call."""
        """One call."""
        words = [str(word) for word in words] + [""]
        values = dict(words[i + 1].split("=") for i, word in enumerate(words) if word == "--set")
        values.pop("predict.accuracy", None)
        loop = copy.deepcopy(self.case["loop"])
        for name, value in values.items():
            _, part, key = name.split(".")
            loop[part][key] = float(value)
        options = {word: words[i + 1] for i, word in enumerate(words) if word.startswith("--")}
        document = getattr(self, command)(loop, options)
        self.spoil(command, document)
        return Answer(document, 0, 0.0, False, "")

    def predict(self, loop, options):
        """The cycle and outcomes."""
        cycles = [_cycle(loop)] if _hunts(loop) else []
        return {"cycles": cycles, "outcomes": [{"outcome": "cycle" if cycles else "rest", "start": "y(0) = 1"}]}

    def map(self, loop, options):
        """3 x 3 points."""
        points = []
        for y in _values(options["--y"]):
            for x in _values(options["--x"]):
                one = _with(_with(loop, x), y)
                hunts, cycle = _hunts(one), _cycle(one)
                points.append({"x": x[1], "y": y[1], "outcomes": ["cycle" if hunts else "rest"], "stable_cycles": int(hunts)})
                points[-1] |= {key: cycle[key] if hunts else 0.0 for key in ("period", "amplitude")}
        return {"points": points}

    def margin(self, loop, options):
        """Only the hysteresis has an end, downwards."""
        none = {"hunting": "none", "value": None, "error": None, "why": "it hunts all the way"}
        ends = {"hunting": "ends", "value": BORDER, "error": 1e-9, "why": "by decree"}
        down = ends if options["--parameter"] == H else none
        return {"hunts": _hunts(loop), "factor": 10.0, "status": "converged", "parameters": [{"up": dict(none), "down": dict(down)}]}

    def __getattr__(self, name):
        if name == "continue":
            return self._branch
        raise AttributeError(name)

    def _branch(self, loop, options):
        path, ends = options["--parameter"].split("=")
        low, high = map(float, ends.split(":"))
        branch = []
        for value in np.linspace(max(low, BORDER * 1.001) if path == H else low, high, 8):
            cycle = _cycle(_with(loop, (path, value)))
            branch.append(cycle | {"part": 0, "parameter": float(value), "multipliers": [[0.0, 0.0]]})
        return {"branch": branch}

    def sensitivity(self, loop, options):
        """Derivatives of T = 4 h/(K D) and of A = h."""
        cycle, rows = _cycle(loop), []
        for path, slope in ((H, 1.0), (D, -1.0), (K, -1.0)):
            value = _of(loop, path)
            by = {"period": slope * cycle["period"] / value, "amplitude": 1.0 if path == H else 0.0}
            errors = {"period": 0.0, "amplitude": 0.0}
            rows.append({"name": path, "value": value, "derivative": by, "errors": errors, "why": ""})
        return {"cycle": cycle, "parameters": rows}

    def dissipativity(self, loop, options):
        """Of the law, or of the loop."""
        if "plant" in loop:
            answer = {"answer": False, "why": ""}
            return {"loop": {key: dict(answer) for key in ("no_cycle",)} | {
                "agrees_with_predict": True, "stuck_states": {"exists": {"answer": True}}, "sliding": {"stable": {"answer": True}},
            }}  # fmt: skip
        return _of_law(loop["friction"], float(options.get("--speed", 1.0)))


def _hunts(loop):
    return loop["element"]["hysteresis"] > BORDER


def _cycle(loop):
    h = loop["element"]["hysteresis"]
    period = 4.0 * h / (loop["element"]["level"] * loop["plant"]["gain"])
    return {"period": period, "amplitude": h, "offset": 0.0, "stable": True, "error": 1e-13, "multipliers": [[0.0, 0.0]]}


def _of(loop, path):
    _, part, key = path.split(".")
    return loop[part][key]


def _with(loop, pair):
    loop = copy.deepcopy(loop)
    _, part, key = pair[0].split(".")
    loop[part][key] = pair[1]
    return loop


def _values(axis):
    path, ends = axis.split("=")
    low, high, count = ends.split(":")
    return [(path, float(value)) for value in np.linspace(float(low), float(high), int(count))]


def _of_law(keys, top):
    """What dissipativity has to say of LuGre: bounds, the border of passivity, a stroke that takes energy out."""
    border = keys["sigma1"] * (keys["Fs"] - keys["Fc"]) / keys["Fc"]
    widest = keys["Fs"] / keys["sigma0"]
    law = bristle(keys)
    speeds = np.append(np.logspace(-6, 0, 2000) * top, 0.0)
    force = max(abs(law(v, side * widest)[0]) for v in speeds for side in (1.0, -1.0))
    passive = keys["sigma2"] >= border
    return {
        "passive": passive, "why": "", "state_bounds": [{"low": -widest, "high": widest}], "passive_up_to_speed": None,
        "force_bound": {"value": force, "up_to_speed": top}, "counterexample": None if passive else _stroke(keys),
        "threshold": {"parameter": "loop.friction.sigma2", "value": border, "error": 0.0},
    }  # fmt: skip


def _stroke(keys):
    """Up slowly, back down fast; z approaches its steady value exponentially at a constant speed."""
    s0, s1, s2, g = keys["sigma0"], keys["sigma1"], keys["sigma2"], stribeck_level(keys)
    ends, taken, times = (1.3e-5, 1.45e-5), 0.0, [0.0]
    velocity = [1e-6, 1000.0 * keys["vs"]]
    for v, a, b in ((velocity[0], *ends), (velocity[1], *reversed(ends))):
        rate, steady = s0 * v / g(v), g(v) / s0
        t = math.log((steady - a) / (steady - b)) / rate
        taken -= s0 * v * (steady * t - (b - a) / rate) + s1 * v * (b - a) + s2 * v * v * t
        times.append(times[-1] + t)
    return {"time": times[:2], "velocity": velocity, "period": times[2], "initial": [ends[0]], "energy_per_cycle": taken}
