"""Friction laws as equations, from docs/laws.md and not from the program's source."""

import math


def stribeck_level(keys):
    """g(v): the sliding level over the speed."""
    Fc, Fs, vs, delta = keys["Fc"], keys["Fs"], keys["vs"], keys.get("delta", 2.0)
    curve = keys.get("curve", "exponential")
    if curve == "lorentzian":
        return lambda v: Fc + (Fs - Fc) / (1.0 + (abs(v) / vs) ** delta)
    if curve == "tustin":
        return lambda v: Fc + (Fs - Fc) * math.exp(-abs(v) / vs)
    if delta == 2.0:
        return lambda v: Fc + (Fs - Fc) * math.exp(-min(700.0, (v / vs) ** 2))
    return lambda v: Fc + (Fs - Fc) * math.exp(-min(700.0, (abs(v) / vs) ** delta))


def _damping(keys):
    sigma1, vd = keys.get("sigma1", 0.0), keys.get("vd", 0.0)
    return (lambda v: sigma1 * math.exp(-((v / vd) ** 2))) if vd else (lambda v: sigma1)


def bristle(keys):
    """(v, z) -> (force, dz/dt) of a law with one bristle."""
    kind = keys["kind"]
    s0, s2 = keys["sigma0"], keys.get("sigma2", 0.0)
    if kind == "dahl":
        Fc, n = keys["Fc"], keys.get("exponent", 1.0)

        def dahl(v, z):
            a = 1.0 - math.copysign(1.0, v) * s0 * z / Fc
            return s0 * z, v * math.copysign(abs(a) ** n, a)

        return dahl
    g, damping = stribeck_level(keys), _damping(keys)
    if kind == "lugre":

        def lugre(v, z):
            rate = v - s0 * abs(v) * z / g(v)
            return s0 * z + damping(v) * rate + s2 * v, rate

        return lugre
    if kind != "elasto-plastic":
        raise ValueError(f"no such bristle: {kind}")
    ratio, coulomb = keys.get("zba_ratio", 0.69), keys.get("zba_of", "steady-state") == "coulomb"

    def elasto_plastic(v, z):
        level = g(v)
        z_ss, s = level / s0, math.copysign(1.0, v)
        z_ba = ratio * (keys["Fc"] / s0 if coulomb else z_ss)
        if s * z <= z_ba:
            a = 0.0
        elif s * z >= z_ss:
            a = 1.0
        else:
            a = 0.5 + 0.5 * math.sin(math.pi * (s * z - 0.5 * (z_ss + z_ba)) / (z_ss - z_ba))
        rate = v * (1.0 - a * s0 * s * z / level)
        return s0 * z + damping(v) * rate + s2 * v, rate

    return elasto_plastic
