"""Random friction laws alone, and loops for which energy may prove something, in random units."""

import math

from . import families, units


def law(seed, index):
    """A case with a friction law and no loop."""
    dice = families.Dice(seed, index)
    kind = dice.among(["lugre", "lugre", "lugre", "elasto-plastic", "elasto-plastic", "dahl", "coulomb", "stribeck", "karnopp"])
    keys = families.friction(dice, kind)
    if kind in ("lugre", "elasto-plastic"):
        _damping(keys, dice)
    if kind in ("lugre", "stribeck") and dice.chance(0.4):
        keys["curve"] = dice.among(["tustin", "lorentzian"])
        keys.pop("delta", None)
    if kind == "elasto-plastic" and dice.chance(0.5):
        keys |= {"zba_ratio": dice.between(0.3, 0.95), "zba_of": dice.among(["steady-state", "coulomb"])}
        if keys["zba_of"] == "coulomb":
            keys["zba_ratio"] *= 0.9
    factors = dice.log(1e-4, 1e2), dice.log(1e-2, 1e4), dice.log(1e-3, 1e1)
    case = units.scaled({"loop": {"plant": {"kind": "mass", "mass": 1.0}, "friction": keys}}, *factors)
    case = {"title": f"{kind}, law {index} of seed {seed}", "loop": {"friction": case["loop"]["friction"]}}
    return kind, families.rounded(case)


def _damping(keys, dice):
    """Micro-damping and viscous friction about the border of passivity."""
    border = (keys["Fs"] - keys["Fc"]) / keys["Fc"]
    keys["sigma1"] = dice.among([0.0, 1.0, 1.0]) * dice.log(0.1, 1.0) * math.sqrt(keys["sigma0"])
    keys["sigma2"] = dice.among([0.0, 1.0, 1.0]) * keys["sigma1"] * border * dice.log(0.2, 5.0)
    if keys["sigma1"] and dice.chance(0.3):
        keys["vd"] = keys["vs"] * dice.log(0.3, 30.0)


def loop(seed, index):
    """A servo, mostly without integral action, or a belt."""
    dice = families.Dice(seed, index)
    name = dice.among(["coulomb", "stribeck", "lugre", "dahl", "elasto-plastic", "belt-coulomb", "belt-lugre", "belt-stribeck"])
    natural = families.FAMILIES[name](dice)
    controller = natural["loop"].get("controller")
    if controller and dice.chance(0.7):
        controller.pop("lag", None)
        controller["ki"] = 0.0
    factors = dice.log(1e-4, 1e2), dice.log(1e-2, 1e4), dice.log(1e-3, 1e1)
    case = {"title": f"{name}, energy of loop {index} of seed {seed}"} | units.scaled(natural, *factors)
    return name, families.rounded(case)
