#!/usr/bin/python3
"""SciPy on the hunting servo. Its right side is Python, so most of the time is the interpreter's: what a user of SciPy pays,
not what LSODA costs.
  stepping_scipy.py REFERENCE"""
import math
import sys
import time

import numpy
from scipy.integrate import solve_ivp

DURATION, SAMPLES = 244.36786455993, 200
MASS, KP, KI, KD, FS, FC, VS, SIGMA2 = 1.0, 3.0, 4.0, 6.0, 1.5, 1.0, 1e-3, 0.4
TIMES = [DURATION * k / SAMPLES for k in range(1, SAMPLES + 1)]


def servo(sigma0):
    """Rate and Jacobian over (I, x, v/vs, f); plain floats, which are faster here than arrays of four."""
    sigma1 = math.sqrt(sigma0)

    def rate(_t, y):
        integral, x, w, f = y.tolist()
        v = VS * w
        z_rate = v - abs(v) * f / (FC + (FS - FC) * math.exp(-w * w))
        force = KI * integral - KP * x - KD * v - f - sigma1 * z_rate - SIGMA2 * v
        return (-x, v, force / (MASS * VS), sigma0 * z_rate)

    def jacobian(_t, y):
        _, _, w, f = y.tolist()
        v = VS * w
        bump = (FS - FC) * math.exp(-w * w)
        level = FC + bump
        by_w = VS - math.copysign(VS, w) * f / level - abs(v) * f * 2 * w * bump / (level * level)
        by_f = -abs(v) / level
        unit = 1.0 / (MASS * VS)
        return numpy.array([[0, -1, 0, 0], [0, 0, VS, 0],
                            [KI * unit, -KP * unit, -(KD * VS + sigma1 * by_w + SIGMA2 * VS) * unit,
                             -(1 + sigma1 * by_f) * unit],
                            [0, 0, sigma0 * by_w, sigma0 * by_f]])

    return rate, jacobian


def read_reference(path):
    with open(path, encoding="ascii") as lines:
        words = lines.read().split()
    size = SAMPLES + 2
    return {float(words[i]): numpy.array(words[i + 2:i + size], dtype=float) for i in range(0, len(words), size)}


def run(method, sigma0, tolerance, reference):
    rate, jacobian = servo(sigma0)
    begin = time.process_time()
    answer = solve_ivp(rate, (0.0, DURATION), [0.0, 1.0, 0.0, 0.0], method=method, t_eval=TIMES, rtol=tolerance,
                       atol=tolerance, jac=jacobian, first_step=1e-6)
    seconds = time.process_time() - begin
    error, status = -1.0, ""
    if not answer.success or answer.y.shape[1] != SAMPLES:
        status = "failed: " + answer.message.replace(",", ";")
    else:
        error = float(numpy.abs(answer.y[1] - reference).max())
    print(f"stepping,sigma0=1e{round(math.log10(sigma0))},scipy {method},{tolerance:.1e},{error:.4e},{seconds:.6e},"
          f"{answer.nfev},{status}", flush=True)


def main():
    for sigma0, reference in read_reference(sys.argv[1]).items():
        for method, tightest in (("LSODA", 11), ("Radau", 9)):
            for exponent in range(4, tightest + 1):
                run(method, sigma0, 10.0 ** -exponent, reference)


main()
