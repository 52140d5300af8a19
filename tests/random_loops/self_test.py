"""Known answers: what the checker itself is held against."""

import math

from . import attractor, loop_model
from .checks import planted
from .motion import PiecewiseLoop
from .truth import Truth, in_mode


def _cycle_of(case, displacement):
    loop = PiecewiseLoop(loop_model.build(case))
    return attractor.settle(loop, loop.model.start(displacement), 1e9)


def _zpk(poles, gain, delay=0.0):
    return {"kind": "zpk", "zeros": [], "poles": poles, "gain": gain, "delay": delay}


def relay_with_integrator():
    """Ideal relay, hysteresis h, before 1/s: a triangle wave with slopes of 1, so T = 4 h and the amplitude is h."""
    case = {"loop": {"plant": _zpk([0.0], 1.0), "element": {"kind": "relay", "level": 1.0, "hysteresis": 0.25}}}
    found = _cycle_of(case, 0.1)
    return found.period, 1.0, found.amplitude, 0.25


def relay_with_delay():
    """Relay before 1/(s + 1) with a dead time L: half period ln(2 exp(L) - 1), amplitude 1 - exp(-L)."""
    case = {"loop": {"plant": _zpk([-1.0], 1.0, 0.5), "element": {"kind": "relay", "level": 1.0}}}
    found = _cycle_of(case, 0.3)
    return found.period, 2.0 * math.log(2.0 * math.exp(0.5) - 1.0), found.amplitude, 1.0 - math.exp(-0.5)


def relay_with_three_lags():
    """Relay before 1/(s + 1)^3; the half period h solves 2 C (I + exp(A h))^-1 (...) = 0: 3.679750670864798 s."""
    case = {"loop": {"plant": _zpk([-1.0, -1.0, -1.0], 1.0), "element": {"kind": "relay", "level": 1.0}}}
    h = _tsypkin_three_lags()
    found = _cycle_of(case, 0.1)
    return found.period, 2.0 * h, 1.0, 1.0


def _tsypkin_three_lags():
    """Half period of the square wave whose response through 1/(s + 1)^3 is zero at the switch.

    The response just before a switch is 1 - 2 (1 - d/da + (1/2) d^2/da^2) q(a) at a = 1, with q(a) = 1/(1 + exp(-a h))
    in the place of the lag 1/(s + a); the derivatives come from partial fractions of 1/(s (s + 1)^3).
    """

    def at_the_switch(h):
        e = math.exp(-h)
        q = e / (1.0 + e)  # sum of (-1)^(k + 1) exp(-k h)
        first = -h * e / (1.0 + e) ** 2
        second = h * h * e * (1.0 - e) / (1.0 + e) ** 3
        # The step response is 1 - exp(-t) (1 + t + t^2/2); t^n exp(-t) is (-d/da)^n exp(-a t).
        return 1.0 - 2.0 * (q - first + 0.5 * second)

    low, high = 0.5, 10.0
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if at_the_switch(low) * at_the_switch(middle) <= 0.0 else (middle, high)
    return 0.5 * (low + high)


def servo_with_bristles():
    """cases/pid-lugre.toml: T = 24.436786455993 s, from a long-double Runge-Kutta-Fehlberg run."""
    from . import smooth

    friction = {"kind": "lugre", "Fs": 1.5, "Fc": 1.0, "vs": 1e-3, "sigma0": 1e5, "sigma1": 1e5**0.5, "sigma2": 0.4}
    controller = {"kind": "pid", "kp": 3.0, "ki": 4.0, "kd": 6.0}
    case = {"loop": {"plant": {"kind": "mass", "mass": 1.0}, "controller": controller, "friction": friction}}
    loop = smooth.SmoothLoop(loop_model.build(case))
    found = smooth.settle(loop, loop.model.start(0.1), 1e9)
    return found.period, 24.436786455993, found.amplitude, 0.06390251034


def saturated_servo():
    """tests/reproducers/saturated-servo-fast.toml and -faster.toml: the same motion in other units of time."""
    periods = []
    for time in (1e-2, 1e-3):
        controller = {"kind": "pid", "kp": 3.0 / time**2, "ki": 4.0 / time**3, "kd": 6.0 / time, "saturation": 4.0}
        friction = {"kind": "coulomb", "Fs": 1.5, "Fc": 1.0}
        case = {"loop": {"plant": {"kind": "mass", "mass": 1.0}, "controller": controller, "friction": friction}}
        periods.append(_cycle_of(case, 0.1 * time**2).period)
    return periods[0], 0.2336927229, periods[1], 0.02336927229


def two_masses_in_their_mode():
    """Swing and velocity of y a quarter of a turn on, in the mode of two masses joined by a spring."""
    plant = {"kind": "two-mass", "motor_mass": 2.0, "load_mass": 3.0, "stiffness": 30.0}
    model = Truth({"loop": {"plant": plant, "friction": {"kind": "coulomb", "Fc": 1.0}}}).model
    w = math.sqrt(30.0 / 2.0 + 30.0 / 3.0)
    X = in_mode(model, 1.1 * w, 0.2, math.pi / 3.0)
    return model.y @ X, 0.1, model.y @ model.A @ X, -0.2 * w * math.sin(math.pi / 3.0)


TESTS = (relay_with_integrator, relay_with_delay, relay_with_three_lags, servo_with_bristles, saturated_servo,
         two_masses_in_their_mode)


def run():
    """All of them; prints what is off and returns how many."""
    failed = 0
    for test in TESTS:
        period, wanted, amplitude, expected = test()
        if abs(period / wanted - 1.0) > 1e-6 or abs(amplitude / expected - 1.0) > 1e-6:
            failed += 1
            print(f"{test.__name__}: {period!r} for {wanted!r}, {amplitude!r} for {expected!r}")
    found, unseen = planted.run()
    failed += unseen
    print(f"self-test: {len(TESTS) + found + unseen - failed} passed, {failed} failed")
    return failed
