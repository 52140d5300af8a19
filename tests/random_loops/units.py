"""Units: the same loop with other units of length, force and time.

Every key has a dimension (exponents of length, force, time). A number x becomes x times the product of the factors to
these exponents, which is exact physics: periods change by the factor of time, amplitudes by that of length.
"""

import copy

# Exponents of (length, force, time).
FRICTION = {
    "Fc": (0, 1, 0), "Fs": (0, 1, 0), "Fc_minus": (0, 1, 0), "Fs_minus": (0, 1, 0), "vs": (1, 0, -1), "dv": (1, 0, -1),
    "vd": (1, 0, -1), "sigma0": (-1, 1, 0), "sigma1": (-1, 1, 1), "sigma2": (-1, 1, 1), "delta": (0, 0, 0),
    "exponent": (0, 0, 0), "zba_ratio": (0, 0, 0),
}  # fmt: skip
PLANT = {
    "mass": (-1, 1, 2), "motor_mass": (-1, 1, 2), "load_mass": (-1, 1, 2), "damping": (-1, 1, 1),
    "stiffness": (-1, 1, 0), "speed": (1, 0, -1), "delay": (0, 0, 1),
}  # fmt: skip
CONTROLLER = {
    "kp": (-1, 1, 0), "ki": (-1, 1, -1), "kd": (-1, 1, 1), "tf": (0, 0, 1), "lag": (0, 0, 1), "saturation": (0, 1, 0),
}  # fmt: skip
ELEMENT = {
    "level": (0, 1, 0), "hysteresis": (1, 0, 0), "dead_zone": (1, 0, 0), "half_width": (1, 0, 0),
    "half_gap": (1, 0, 0), "slope": (-1, 1, 0), "limit": (0, 1, 0),
}  # fmt: skip
LOOP = {"reference": (1, 0, 0), "load": (0, 1, 0)}
RATE = {"rate": (1, 0, -1)}
SLOPED = ("saturation", "dead-zone", "backlash")


def scaled(case, length, force, time):
    """The case with lengths, forces and times multiplied by these factors."""

    def by(exponents):
        return length ** exponents[0] * force ** exponents[1] * time ** exponents[2]

    def table(keys, dimensions):
        for key, entry in keys.items():
            if key in dimensions:
                keys[key] = entry * by(dimensions[key])

    case = copy.deepcopy(case)
    loop = case["loop"]
    if isinstance(loop.get("reference"), dict):
        table(loop["reference"], RATE)
        table(loop, {"load": LOOP["load"]})
    else:
        table(loop, LOOP)
    _plant(loop["plant"], by, table)
    _controller(loop.get("controller", {}), by, table)
    table(loop.get("friction", {}), FRICTION)
    element = loop.get("element", {})
    if element.get("kind") in SLOPED:
        element.setdefault("slope", 1.0)
    table(element, ELEMENT)
    return case


def _plant(plant, by, table):
    rate = by((0, 0, -1))
    if plant["kind"] == "zpk":
        order = len(plant["poles"]) - len(plant["zeros"])
        plant["gain"] *= by((1, -1, -order))
        for key in ("zeros", "poles"):
            plant[key] = [[part * rate for part in root] if isinstance(root, list) else root * rate for root in plant[key]]
        table(plant, {"delay": PLANT["delay"]})
    elif plant["kind"] == "transfer-function":
        # In powers of s / rate; the gain of the plant is a length over a force.
        plant["numerator"] = [c * by((1, -1, k)) for k, c in _powers(plant["numerator"])]
        plant["denominator"] = [c * by((0, 0, k)) for k, c in _powers(plant["denominator"])]
        table(plant, {"delay": PLANT["delay"]})
    elif plant["kind"] == "state-space":
        # States keep their numbers, so the rows of outputs and the columns of forces take the units.
        plant["A"] = [[entry * rate for entry in row] for row in plant["A"]]
        for key in ("B", "B_friction"):
            if key in plant:
                plant[key] = [[entry * by((0, -1, -1)) for entry in row] for row in plant[key]]
        plant["C"] = [[entry * by((1, 0, 0)) for entry in row] for row in plant["C"]]
        for key, unit in (("C_velocity", (1, 0, -1)), ("C_friction", (1, 0, 0))):
            if key in plant:
                plant[key] = [[entry * by(unit) for entry in row] for row in plant[key]]
    else:
        table(plant, PLANT)


def _controller(controller, by, table):
    if controller.get("kind") == "transfer-function":
        controller["numerator"] = [c * by((-1, 1, k)) for k, c in _powers(controller["numerator"])]
        controller["denominator"] = [c * by((0, 0, k)) for k, c in _powers(controller["denominator"])]
    table(controller, CONTROLLER)


def _powers(coefficients):
    """Pairs of power and coefficient, highest power first."""
    return [(len(coefficients) - 1 - i, c) for i, c in enumerate(coefficients)]
