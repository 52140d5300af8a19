#!/usr/bin/python3
"""Writes lugre_df.csv: describing functions of the LuGre law, computed apart from the program.

The law is affine in its state, so u = sigma0 z = P + H u0 with a particular solution P and a homogeneous one H. Both,
together with their integrals against sin, cos and 1 and the work, are integrated in time by DOP853 (scipy, rtol 1e-13)
from one velocity reversal to the next, stopping also at geometrically spaced times around each reversal so that no
layer is stepped over; u0 then follows from u(T) = u(0) without waiting for a transient. Takes some minutes.

Usage: make_lugre_df.py > lugre_df.csv
"""
import math

import numpy as np
from scipy.integrate import solve_ivp

BASE = dict(Fs=1.5, Fc=1.0, vs=1e-3, delta=2.0, curve="exponential", sigma0=1e5, sigma1=316.22776601683796,
            sigma2=0.4, vd=0.0, A=1e-3, w=1.0, bias=0.0)
CASES = [
    {}, dict(A=5e-6), dict(A=5e-6, w=10.0, sigma2=0.0), dict(A=5e-6, w=1.0, sigma2=0.0), dict(A=1.5e-5, sigma2=0.0),
    dict(A=1e-6, w=0.1), dict(A=1e-6, w=1000.0), dict(A=1e-4, w=10.0), dict(A=1e-4, w=1000.0), dict(A=1e-2, w=0.1),
    dict(A=1e-2, w=10.0), dict(A=2e-2, w=1000.0),
    dict(bias=2e-4), dict(bias=9e-4), dict(bias=-9.9e-4), dict(bias=1.05e-3), dict(bias=5e-3), dict(A=1e-2, bias=-4e-3),
    dict(A=1e-4, w=10.0, bias=3e-4), dict(A=2e-5, w=1.0, bias=1e-5),
    dict(curve="tustin"), dict(curve="tustin", A=1e-2, w=10.0), dict(curve="lorentzian"),
    dict(curve="lorentzian", A=1e-4, w=10.0, delta=1.3), dict(delta=1.0), dict(delta=0.5), dict(delta=1.5, bias=3e-4),
    dict(vd=2e-3), dict(vd=1e-3, A=1e-2), dict(vd=5e-4, bias=4e-4),
    dict(Fs_minus=1.8, Fc_minus=1.2), dict(Fs_minus=1.2, Fc_minus=0.9, A=1e-4, w=10.0),
    dict(Fs_minus=1.3, Fc_minus=1.1, bias=2e-4), dict(vs=1e-6), dict(vs=1e-6, A=1e-2, w=10.0), dict(vs=1e-2, A=1e-2),
    dict(vs=1e-6, bias=-5e-4), dict(sigma0=1e6, sigma1=1e3), dict(sigma0=1e6, sigma1=0.0, A=1e-4),
    dict(sigma0=1e7, sigma1=100.0, A=1e-4), dict(sigma0=1e3, sigma1=30.0, A=1e-2), dict(sigma1=0.0, sigma2=0.0),
]
KEYS = ["Fs", "Fc", "Fs_minus", "Fc_minus", "vs", "delta", "curve", "sigma0", "sigma1", "sigma2", "vd", "A", "w", "bias"]


def level(p, v):
    fs, fc = (p["Fs"], p["Fc"]) if v >= 0 else (p["Fs_minus"], p["Fc_minus"])
    r = abs(v) / p["vs"]
    if p["curve"] == "tustin":
        return fc + (fs - fc) * math.exp(-r)
    if p["curve"] == "lorentzian":
        return fc + (fs - fc) / (1.0 + r ** p["delta"])
    return fc + (fs - fc) * math.exp(-r ** p["delta"])


def describe(p):
    A, w, bias = p["A"], p["w"], p["bias"]
    period = 2.0 * math.pi / w
    ratio = bias / (A * w)

    def right_side(turn, v_turn, t, y):
        # Time is measured from the turning point, at phase `turn` with velocity `v_turn`; the velocity is formed from
        # the distance to it, without cancellation.
        h = 0.5 * w * t
        v = v_turn - 2.0 * A * w * math.sin(turn + h) * math.sin(h)
        theta = turn + w * t
        s, c = math.sin(theta), math.cos(theta)
        damping = p["sigma1"] * (math.exp(-(v / p["vd"]) ** 2) if p["vd"] > 0 else 1.0)
        loss = p["sigma0"] * abs(v) / level(p, v)
        du_p, du_h = p["sigma0"] * v - loss * y[0], -loss * y[1]
        F_p = y[0] + damping / p["sigma0"] * du_p + p["sigma2"] * v
        F_h = y[1] + damping / p["sigma0"] * du_h
        return [du_p, du_h, F_p * s, F_p * c, F_p, F_p * v, F_h * s, F_h * c, F_h, F_h * v]

    if abs(ratio) < 1.0:
        one = math.acos(-ratio)
        turns = [(one, 0.0), (2.0 * math.pi - one, 0.0), (one + 2.0 * math.pi, 0.0)]
    else:
        at = math.pi if ratio > 0 else 0.0
        turns = [(at, bias - math.copysign(A * w, ratio)), (at + 2.0 * math.pi, bias - math.copysign(A * w, ratio))]
    y = np.zeros(10)
    y[1] = 1.0
    for (left, v_left), (right, v_right) in zip(turns, turns[1:]):
        half = 0.5 * (right - left) / w
        distances = [0.0] + sorted(half * 10.0 ** (-k / 2.0) for k in range(0, 25))
        for k in range(len(distances) - 1):
            y = advance(lambda t, y: right_side(left, v_left, t, y), distances[k], distances[k + 1], y, p)
        for k in range(len(distances) - 1, 0, -1):
            y = advance(lambda t, y: right_side(right, v_right, t, y), -distances[k], -distances[k - 1], y, p)
    u0 = y[0] / (1.0 - y[1])
    b1, a1, mean, work = (y[2 + i] + u0 * y[6 + i] for i in range(4))
    return b1 * w / math.pi / A, a1 * w / math.pi / A, mean / period, work


def advance(f, start, end, y, p):
    size = np.array([1.0, 1.0] + [1.0 / p["w"]] * 3 + [p["A"]] + [1.0 / p["w"]] * 3 + [p["A"]])
    answer = solve_ivp(f, (start, end), y, method="DOP853", rtol=1e-13, atol=1e-15 * size)
    assert answer.success
    return answer.y[:, -1]


def main():
    print("# made by make_lugre_df.py: DOP853 at rtol 1e-13 between reversals, fixed point of the affine period map")
    print(",".join(KEYS + ["re", "im", "mean", "dissipation"]))
    for change in CASES:
        p = dict(BASE)
        p.update(change)
        p.setdefault("Fs_minus", p["Fs"])
        p.setdefault("Fc_minus", p["Fc"])
        row = [str(p[k]) for k in KEYS] + ["%.15g" % x for x in describe(p)]
        print(",".join(row), flush=True)


if __name__ == "__main__":
    main()
