"""The same loop written otherwise: what must not change an answer.

Each rewriting takes a case and dice and returns a Rewriting, or None where it does not apply.
"""

import copy
from dataclasses import dataclass

import numpy as np
import scipy.linalg

from . import linear, units


@dataclass
class Rewriting:
    """A case, the factors of length and time between it and the first one, and how close both have to be."""

    case: dict
    length: float = 1.0
    time: float = 1.0
    shift: float = 0.0  # of offsets, after the factor of length
    tolerance: float = 1e-5
    same_starts: bool = True  # outcomes are comparable one by one
    outcomes: bool = True  # they are comparable at all: starts that follow from another law may come to other ends
    backwards: bool = False  # sections and keys in reverse


def other_units(case, dice):
    """Random factors of length, force and time."""
    length, force, time = dice.log(1e-3, 1e3), dice.log(1e-3, 1e3), dice.log(1e-2, 1e2)
    return Rewriting(units.scaled(case, length, force, time), length, time)


def mirror(case, dice):
    """Reference, load and the velocity of a belt with the other sign."""
    turned = copy.deepcopy(case)
    for key in ("reference", "load"):
        if key in turned["loop"]:
            turned["loop"][key] = -turned["loop"][key]
    plant = turned["loop"]["plant"]
    if "speed" in plant:
        plant["speed"] = -plant["speed"]
    # Its starts are displaced to the same side, which is the other one of the mirrored loop.
    return Rewriting(turned, -1.0, outcomes=False) if turned != case else None


def reordered(case, dice):
    """Sections and keys from last to first."""
    return Rewriting(copy.deepcopy(case), backwards=True)


def _roots_of(plant):
    """(zeros, poles, gain) of a plant from the force to y, or None where that does not say all of it."""
    if plant["kind"] == "zpk":
        return linear.roots(plant["zeros"]), linear.roots(plant["poles"]), plant["gain"]
    c, k = plant.get("damping", 0.0), plant.get("stiffness", 0.0)
    if plant["kind"] == "mass":
        return [], _pair(plant["mass"], c, k), 1.0 / plant["mass"]
    if plant["kind"] != "two-mass" or plant["friction_on"] != "motor" or plant["measured"] != "motor":
        return None
    m, other = plant["motor_mass"], plant["load_mass"]
    return _pair(other, c, k), [0.0, 0.0] + _pair(m * other / (m + other), c, k), 1.0 / m


def _pair(m, c, k):
    """Roots of m s^2 + c s + k; a zero one is exact."""
    return [0.0, -c / m or 0.0] if k == 0.0 else list(np.roots([m, c, k]))


def _with_plant(case, keys, tolerance):
    """The case with another plant, which keeps its dead time."""
    other = copy.deepcopy(case)
    delay = case["loop"]["plant"].get("delay")
    other["loop"]["plant"] = keys | {"delay": delay} if delay is not None else keys
    named = case["loop"]["plant"]["kind"] in ("mass", "two-mass")
    return Rewriting(other, tolerance=tolerance, same_starts=not named)


def transfer_function(case, dice):
    """The plant as a quotient of polynomials."""
    known = _roots_of(case["loop"]["plant"])
    if known is None:
        return None
    zeros, poles, gain = known
    top = gain * np.atleast_1d(np.real(np.poly(zeros)))
    below = np.real(np.poly(poles))
    keys = {"kind": "transfer-function", "numerator": top.tolist(), "denominator": below.tolist()}
    return _with_plant(case, keys, 1e-4)


def zeros_and_poles(case, dice):
    """The plant by its zeros, poles and gain."""
    known = _roots_of(case["loop"]["plant"])
    if known is None or case["loop"]["plant"]["kind"] == "zpk":
        return None
    zeros, poles, gain = ([_root(root) for root in some] if isinstance(some, list) else some for some in known)
    return _with_plant(case, {"kind": "zpk", "zeros": zeros, "poles": poles, "gain": gain}, 1e-4)


def _root(root):
    """As a case has it: a number, or its two parts."""
    return [float(np.real(root)), float(np.imag(root))] if np.imag(root) else float(np.real(root))


def _matrices(plant):
    """A linear.Plant of everything that a state space can say, or None."""
    if plant.get("delay", 0.0) or plant["kind"] == "belt":
        return None
    return linear.plant(plant)


def _sizes(plant):
    """Sizes of the states that balance the plant: mixed without them, its numbers lose the digits that its poles need."""
    system = np.block([[plant.A, plant.B[:, None]], [plant.C[None, :], np.zeros((1, 1))]])
    scale = scipy.linalg.matrix_balance(system, permute=False, separate=True)[1][0]
    return scale[:-1] / scale[-1]


def _state_space(case, transform, extra=0):
    """The plant as a state space, after x -> transform x, with decoupled states already in the matrices."""
    plant = _matrices(case["loop"]["plant"])
    if plant is None:
        return None
    n = len(plant.A)
    size = _sizes(plant)
    wide = np.zeros((n + extra, n + extra))
    wide[:n, :n] = plant.A * size / size[:, None]
    for i in range(extra):
        wide[n + i, n + i] = -(i + 1.0) * np.abs(plant.A).max()
    T = transform(n + extra)
    back = np.linalg.inv(T)

    def column(values):
        return (T @ np.append(values / size, np.zeros(extra)))[:, None].tolist()

    def row(values):
        return (np.append(values * size, np.zeros(extra)) @ back)[None, :].tolist()

    other = copy.deepcopy(case)
    keys = {"kind": "state-space", "A": (T @ wide @ back).tolist(), "B": column(plant.B), "C": row(plant.C)}
    if "friction" in case["loop"]:
        keys |= {"B_friction": column(plant.B_friction), "C_velocity": row(plant.velocity)}
    other["loop"]["plant"] = keys
    return other


def similar(case, dice):
    """The plant as a state space after a random, well-conditioned change of coordinates."""

    def transform(n):
        first = np.linalg.qr(dice.random.normal(size=(n, n)))[0]
        second = np.linalg.qr(dice.random.normal(size=(n, n)))[0]
        return first @ np.diag([dice.log(0.3, 3.0) for _ in range(n)]) @ second

    other = _state_space(case, transform)
    return Rewriting(other, tolerance=1e-4, same_starts=False) if other else None


def decoupled(case, dice):
    """A stable state that nothing reaches and nobody sees."""
    other = _state_space(case, np.eye, extra=1)
    return Rewriting(other, tolerance=1e-4, same_starts=False) if other else None


def moved(case, dice):
    """Another set-point under integral action: nothing but the place changes."""
    loop = case["loop"]
    if loop["plant"]["kind"] not in ("mass", "two-mass") or loop["plant"].get("stiffness", 0.0) and loop["plant"]["kind"] == "mass":
        return None
    other = copy.deepcopy(case)
    scale = loop["friction"]["Fc"] / loop["controller"]["kp"]
    shift = dice.between(-3.0, 3.0) * scale * 10.0 ** dice.between(0.0, 6.0)
    other["loop"]["reference"] = loop.get("reference", 0.0) + shift
    return Rewriting(other, shift=shift, tolerance=1e-4, same_starts=False)


def fast_pole(case, dice):
    """A pole 1e5 times faster than all others."""
    plant = case["loop"]["plant"]
    if plant["kind"] != "zpk" or not any(np.abs(linear.roots(plant["poles"]))):
        return None
    other = copy.deepcopy(case)
    fast = 1e5 * float(max(np.abs(linear.roots(plant["poles"]))))
    other["loop"]["plant"]["poles"] = plant["poles"] + [-fast]
    other["loop"]["plant"]["gain"] = plant["gain"] * fast
    return Rewriting(other, tolerance=5e-3, same_starts=False)


def diagram(case, dice):
    """The five slots as blocks of a diagram, in random order."""
    loop = case["loop"]
    controller = loop.get("controller", {"kind": "none"})
    more = [key for key in ("saturation", "lag", "friction_compensation") if controller.get(key)]
    if "friction_compensation" in more or (more and controller["kind"] != "pid") or loop["plant"].get("gravity"):
        return None
    blocks, signal = [], ""

    def through(name, keys):
        nonlocal signal
        blocks.append({"name": name, "input": signal} | keys)
        signal = name

    if "element" in loop or "friction" not in loop or controller["kind"] != "none":
        signal = "r - axis.y"
        if "error" in loop:
            through("error", loop["error"])
        if controller["kind"] != "none":
            through("control", controller)
        if "element" in loop:
            through("element", loop["element"])
    if loop.get("load", 0.0) or not signal:
        blocks.append({"name": "weight", "kind": "constant", "value": loop.get("load", 0.0)})
        signal += " + weight" if signal else "weight"
    blocks.append({"name": "axis", "input": signal} | loop["plant"])
    if "friction" in loop:
        blocks.append({"name": "rub", "on": "axis"} | loop["friction"])
    keys = {"output": "axis.y"} | ({"reference": loop["reference"]} if "reference" in loop else {})
    keys["block"] = [blocks[i] for i in dice.random.permutation(len(blocks))]
    other = {key: entry for key, entry in case.items() if key != "loop"} | {"diagram": keys}
    return Rewriting(other, tolerance=1e-4 if loop.get("load") else 1e-6, same_starts=not loop.get("load"))


def stiff_shaft(case, dice):
    """One mass as two with a shaft 300 times faster than the loop."""
    loop = case["loop"]
    plant, controller = loop["plant"], loop.get("controller", {})
    if plant["kind"] != "mass" or "damping" in plant or "stiffness" in plant or loop["friction"]["kind"] != "coulomb":
        return None
    other = copy.deepcopy(case)
    m = plant["mass"]
    shaft = 300.0 * max(np.sqrt(abs(controller["kp"]) / m), abs(controller.get("kd", 0.0)) / m)
    keys = {"kind": "two-mass", "motor_mass": 0.5 * m, "load_mass": 0.5 * m, "stiffness": 0.25 * m * shaft**2}
    keys |= {"damping": 0.25 * m * shaft, "friction_on": "motor", "measured": "motor"}
    other["loop"]["plant"] = keys
    return Rewriting(other, tolerance=3e-2, same_starts=False)


def bristles(case, dice):
    """Coulomb or Stribeck friction as LuGre with bristles 1e5 times stiffer than the loop.

    Not for a curve that begins with infinite slope: the creep of the bristles before break-away lowers the force by
    (Fs - Fc) (creep/vs)^delta. Of a belt loop with delta = 0.5, an integration by SciPy gave the periods 45.885,
    47.016 and 47.543 s for bristles of 1e5, 1e6 and 1e7 times the stiffness, against 47.996 s without bristles.
    """
    loop = case["loop"]
    friction, plant = loop.get("friction", {}), loop["plant"]
    levels = friction.get("Fc", 0.0), friction.get("Fs", 0.0)
    if friction.get("kind") not in ("coulomb", "stribeck") or plant["kind"] not in ("mass", "belt") or levels[1] < 1.05 * levels[0]:
        return None
    if friction.get("delta", 2.0) < 1.0:
        return None
    stiff = loop.get("controller", {}).get("kp", 0.0) + plant.get("stiffness", 0.0)
    bristle = 1e5 * stiff
    keys = {"kind": "lugre", "Fc": levels[0], "Fs": levels[1], "sigma0": bristle, "sigma1": np.sqrt(bristle * plant["mass"])}
    keys |= {key: friction[key] for key in ("sigma2", "delta") if key in friction}
    keys["vs"] = friction.get("vs", 1e-3 * levels[0] / np.sqrt(stiff * plant["mass"]))
    other = copy.deepcopy(case)
    other["loop"]["friction"] = keys
    return Rewriting(other, tolerance=3e-2, outcomes=False)


REWRITINGS = {
    "units": other_units, "mirror": mirror, "reordered": reordered, "transfer-function": transfer_function,
    "similar": similar, "decoupled": decoupled, "moved": moved, "fast-pole": fast_pole, "stiff-shaft": stiff_shaft,
    "zeros-and-poles": zeros_and_poles, "bristles": bristles, "diagram": diagram,
}  # fmt: skip


def changes(first, other, rewriting):
    """What differs between two documents of predict: (kind, sentences), kind: same, undecided or changed."""
    undecided = [any(o["outcome"] == "undecided" for o in d["outcomes"]) for d in (first, other)]
    differs = _cycles(first, other, rewriting)
    differs += _outcomes(first, other, rewriting) if rewriting.outcomes else []
    if not differs:
        return "same", []
    return ("undecided" if any(undecided) else "changed"), differs


def _cycles(first, other, rewriting):
    """Stable cycles of one that are not in the other."""
    length, tolerance = abs(rewriting.length), rewriting.tolerance

    def alike(a, b):
        return (
            abs(b["period"] / (a["period"] * rewriting.time) - 1.0) < tolerance
            and abs(b["amplitude"] / (a["amplitude"] * length) - 1.0) < 3.0 * tolerance
            and abs(b["offset"] - (a["offset"] * rewriting.length + rewriting.shift)) < 30.0 * tolerance * b["amplitude"]
        )

    stable = [[c for c in d["cycles"] if c["stable"]] for d in (first, other)]
    lost = [a for a in stable[0] if not any(alike(a, b) for b in stable[1])]
    new = [b for b in stable[1] if not any(alike(a, b) for a in stable[0])]
    sentences = [f"lost: T = {a['period'] * rewriting.time:.8g}, A = {a['amplitude'] * length:.6g}" for a in lost]
    return sentences + [f"new: T = {b['period']:.8g}, A = {b['amplitude']:.6g}" for b in new]


def displaced(outcome):
    return outcome["start"].startswith("y(0) = ")


def _outcomes(first, other, rewriting):
    """Outcomes that differ, start by start where the starts are the same, else the set of those decided. Starts beside
    unstable cycles and predictions are not compared one by one: they are as many as were found."""
    if rewriting.same_starts:
        a, b = ([o["outcome"] for o in d["outcomes"] if displaced(o)] for d in (first, other))
    else:
        a, b = ([o["outcome"] for o in d["outcomes"]] for d in (first, other))
        a, b = (sorted({o for o in some if o != "undecided"}) for some in (a, b))
    return [] if a == b else [f"outcomes: {', '.join(a)} became {', '.join(b)}"]
