"""Linear parts: matrices of plants and controllers, in a form of our own.

Checks the program, so nothing here is taken from it: polynomials by NumPy, controllable canonical form for transfer
functions, a cascade of sections of order one and two for zeros and poles.
"""

from dataclasses import dataclass, field

import numpy as np


@dataclass
class Plant:
    """dx/dt = A x + B u - B_friction F + bias, y = C x, v = velocity x - belt."""

    A: np.ndarray
    B: np.ndarray
    C: np.ndarray
    B_friction: np.ndarray = None
    velocity: np.ndarray = None
    belt: float = 0.0
    delay: float = 0.0
    positions: list = field(default_factory=list)  # states that are lengths, all moved by a displaced start


def canonical(numerator, denominator):
    """A, B, C, D of a proper transfer function (highest power first)."""
    denominator = np.trim_zeros(np.asarray(denominator, float), "f")
    numerator = np.asarray(numerator, float) / denominator[0]
    denominator = denominator / denominator[0]
    n = len(denominator) - 1
    numerator = np.concatenate([np.zeros(n + 1 - len(numerator)), numerator])
    A = np.zeros((n, n))
    A[:-1, 1:] = np.eye(n - 1) if n > 1 else A[:-1, 1:]
    if n:
        A[-1] = -denominator[:0:-1]
    B = np.zeros(n)
    if n:
        B[-1] = 1.0
    direct = numerator[0]
    C = (numerator[1:] - direct * denominator[1:])[::-1]
    return A, B, C, direct


def roots(entries):
    """Complex roots from numbers and [re, im] pairs."""
    return [complex(*entry) if isinstance(entry, (list, tuple)) else complex(entry) for entry in entries]


def cascade(zeros, poles, gain):
    """A, B, C of gain prod(s - zeros) / prod(s - poles), strictly proper: sections of order one and two in series."""
    zeros = _sections(roots(zeros))
    poles = sorted(_sections(roots(poles)), key=lambda section: -len(section))
    A, B, C, D = np.zeros((0, 0)), np.zeros(0), np.zeros(0), 1.0
    for pole in poles:
        # A section takes all the zeros that fit, pairs first.
        top = [z for z in zeros if len(z) <= len(pole)]
        top = max(top, key=len) if top else None
        if top is not None:
            zeros.remove(top)
            if len(pole) == 2 and len(top) == 1 and any(len(z) == 1 for z in zeros):
                second = next(z for z in zeros if len(z) == 1)
                zeros.remove(second)
                top = top + second
        a, b, c, d = canonical(np.real(np.poly(top)) if top else [1.0], np.real(np.poly(pole)))
        A = np.block([[A, np.zeros((len(A), len(a)))], [np.outer(b, C), a]])
        B = np.concatenate([B, b * D])
        C = np.concatenate([d * C, c])
        D = d * D
    if zeros or D != 0.0:
        raise ValueError("the plant is not strictly proper, or its zeros could not be paired")
    return A, B, C * gain


def _sections(values):
    """Real roots alone, complex ones with their conjugates."""
    real = [[z] for z in values if z.imag == 0.0]
    return [[z, z.conjugate()] for z in values if z.imag > 0.0] + real


def plant(keys):
    """The plant of a case."""
    kind = keys["kind"]
    if kind in ("mass", "belt"):
        m = keys["mass"]
        A = np.array([[0.0, 1.0], [-keys.get("stiffness", 0.0) / m, -keys.get("damping", 0.0) / m]])
        B = np.array([0.0, 1.0 / m])
        rate = np.array([0.0, 1.0])
        return Plant(A, B, np.array([1.0, 0.0]), B, rate, keys.get("speed", 0.0), positions=[0])
    if kind == "two-mass":
        return _two_mass(keys)
    if kind == "state-space":
        A, B, C = (np.atleast_2d(np.asarray(keys[key], float)) for key in "ABC")
        friction = np.asarray(keys.get("B_friction", B), float).ravel()
        rate = np.asarray(keys.get("C_velocity", C @ A), float).ravel()
        return Plant(A, B.ravel(), C.ravel(), friction, rate)
    if kind == "zpk":
        A, B, C = cascade(keys["zeros"], keys["poles"], keys["gain"])
    elif kind == "transfer-function":
        A, B, C, _ = canonical(keys["numerator"], keys["denominator"])
    else:
        raise ValueError(f"no plant for the checker: {kind}")
    return Plant(A, B, C, B, C @ A, delay=keys.get("delay", 0.0))


def _two_mass(keys):
    m, l = keys["motor_mass"], keys["load_mass"]
    k, d = keys["stiffness"], keys.get("damping", 0.0)
    A = np.array([[0, 1, 0, 0], [-k / m, -d / m, k / m, d / m], [0, 0, 0, 1], [k / l, d / l, -k / l, -d / l]], float)
    B = np.array([0.0, 1.0 / m, 0.0, 0.0])
    on_load = keys.get("friction_on", "motor") == "load"
    C = np.array([0.0, 0.0, 1.0, 0.0] if keys.get("measured", "load") == "load" else [1.0, 0.0, 0.0, 0.0])
    friction = np.array([0.0, 0.0, 0.0, 1.0 / l]) if on_load else B
    rate = np.array([0.0, 0.0, 0.0, 1.0] if on_load else [0.0, 1.0, 0.0, 0.0])
    return Plant(A, B, C, friction, rate, positions=[0, 2])
