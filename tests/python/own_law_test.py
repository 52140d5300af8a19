"""Laws written in Python, and compiled ones, against the same laws of the library."""

import ctypes
import math
import os
import pickle
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path
from types import SimpleNamespace

import limcycle
import numpy as np
from common import servo


class Dahl:
    """dz/dt = v - sigma0 |v| z/Fc, F = sigma0 z."""

    states, odd, scales = 1, True, (0.01, math.inf, 1.0)
    Fc, sigma0 = 1.0, 100.0

    def output(self, v, z):
        return self.sigma0 * z[0]

    def rate(self, v, z):
        return v - self.sigma0 * abs(v) * z[0] / self.Fc


class ArrayDahl(Dahl):
    """The same written for arrays of velocities and states."""

    def output(self, v, z):
        return self.sigma0 * np.asarray(z)[0]

    def rate(self, v, z):
        z = np.asarray(z)
        return np.array([np.where(v == 0.0, 0.0, v - self.sigma0 * np.abs(v) * z[0] / self.Fc)])


class Viscous:
    """F = c v + d v^3, no state."""

    scales = (math.inf, 1.0, 1.0)

    def output(self, v, z):
        return 2.0 * v + 0.5 * v**3


class Rayleigh:
    """F = mu (v^3/3 - v): feeds a slow motion, damps a fast one."""

    odd, scales = True, (math.inf, 1.0, 1.0)

    def __init__(self, mu):
        self.mu = mu

    def output(self, v, z):
        return self.mu * (v**3 / 3.0 - v)


class OwnLaws(unittest.TestCase):
    def test_gain_of_a_law_without_state(self):
        A, w = np.array([0.1, 1.0, 3.0]), np.array([0.5, 2.0])
        gain = limcycle.df(Viscous(), A, w).gain
        v = A[:, None] * w[None, :]
        np.testing.assert_allclose(gain[:, :, 0], 1j * w * (2.0 + 0.375 * v**2), rtol=1e-6, atol=1e-9)

    def test_gain_is_that_of_the_library(self):
        grid = ([0.003, 0.02], [1.0, 5.0])
        own = limcycle.df(Dahl(), *grid).gain
        np.testing.assert_allclose(own, limcycle.df(limcycle.laws.dahl(Fc=1.0, sigma0=100.0), *grid).gain, rtol=1e-5)

    def test_a_law_written_for_arrays(self):
        gain = [limcycle.df(law(), [1e-3, 0.02], [1.0]).gain for law in (Dahl, ArrayDahl)]
        np.testing.assert_allclose(gain[1], gain[0], rtol=1e-9)
        loops = [servo(friction=law(), search={"amplitude": [1e-3, 1.0], "frequency": [0.1, 10.0]}) for law in (Dahl, ArrayDahl)]
        runs = [limcycle.simulate(loop, 1.0, initial={"y": 0.1}, sample=0.25)["y"] for loop in loops]
        np.testing.assert_allclose(runs[1], runs[0], rtol=1e-9)

    def test_runs_are_those_of_the_library(self):
        given = {"plant": {"kind": "belt", "mass": 1.0, "stiffness": 4.0, "damping": 0.2, "speed": 0.1}}
        own = limcycle.Loop(friction=Dahl(), **given)
        ours = limcycle.Loop(friction=limcycle.laws.dahl(Fc=1.0, sigma0=100.0), **given)
        runs = [limcycle.simulate(loop, 3.0, initial={"y": 0.3}, sample=0.5)["y"] for loop in (own, ours)]
        np.testing.assert_allclose(runs[0], runs[1], rtol=1e-5, atol=1e-7)

    def test_a_limit_cycle_that_is_known(self):
        # Rayleigh's oscillator with damping d: with m = mu - d its period is 2 pi (1 + m^2/16 - 5 m^4/3072 + ...), and
        # the describing function has amplitude 2 sqrt(m/mu) at 1 rad/s
        mu, d = 0.5, 0.1
        m = mu - d
        loop = limcycle.Loop(plant={"kind": "mass", "mass": 1.0, "stiffness": 1.0, "damping": d}, friction=Rayleigh(mu),
                             search={"amplitude": [0.1, 10.0], "frequency": [0.1, 10.0]},
                             predict={"starts": 1, "methods": ["describing-function"]})
        found = limcycle.predict(loop)
        self.assertAlmostEqual(found.cycles[0].period, 2.0 * np.pi * (1.0 + m**2 / 16.0 - 5.0 * m**4 / 3072.0), delta=2e-4)
        self.assertIs(found.cycles[0].stable, True)
        self.assertAlmostEqual(found.predictions[0].amplitude, 2.0 * np.sqrt(m / mu), delta=1e-6)
        self.assertAlmostEqual(found.predictions[0].frequency, 1.0, delta=1e-6)
        self.assertIn("python-law", " ".join(found.notes))

    def test_the_loop_keeps_it(self):
        loop = servo(friction=Dahl()).set({"loop.plant.mass": 2.0})
        self.assertEqual(loop["loop.plant.mass"], 2.0)
        self.assertNotIn("loop.friction.Fc", [one.path for one in loop.numbers])
        self.assertIn('kind = "own"', loop.text)
        with self.assertRaisesRegex(limcycle.CaseError, "loop.friction.Fc"):
            loop.set({"loop.friction.Fc": 5.0})
        moved = limcycle.simulate(loop, 0.1, initial={"z": 0.005}, sample=0.1, check=False)  # its own state
        self.assertEqual(moved["state.z"][0], 0.005)
        run = limcycle.simulate(pickle.loads(pickle.dumps(loop)), 0.1, initial={"y": 0.01}, sample=0.1, check=False)
        self.assertIn("z", " ".join(run.columns))
        self.assertIsNone(run.case.sha256)

    def test_an_exception_passes_through(self):
        class Broken(Dahl):
            calls = 0

            def output(self, v, z):
                Broken.calls += 1
                if Broken.calls > 500:
                    raise LookupError("broken")
                return super().output(v, z)

        with self.assertRaisesRegex(LookupError, "broken"):
            limcycle.simulate(servo(friction=Broken()), 10.0, initial={"y": 0.1})

    def test_what_is_missing_is_named(self):
        class NoRate:
            states, scales = 1, (1.0, 1.0, 1.0)

            def output(self, v, z):
                return v

        class NoScales:
            def output(self, v, z):
                return v

        class NotOdd(Viscous):
            odd = True

            def output(self, v, z):
                return v + 1.0

        class BadScales(Viscous):
            scales = (1.0, -1.0, 1.0)

        for law, rule in ((NoRate(), "rate"), (NoScales(), "scales"), (NotOdd(), "odd"), (BadScales(), "positive")):
            with self.subTest(rule), self.assertRaisesRegex(limcycle.CaseError, f"friction: .*{rule}"):
                servo(friction=law)
        with self.assertRaisesRegex(limcycle.CaseError, "friction: .*dictionary.*own.*found a str"):
            servo(friction="coulomb")
        with self.assertRaisesRegex(limcycle.CaseError, "element = Viscous: .*only friction may be a law of your own"):
            limcycle.Loop(plant=([1.0], [1.0, 1.0]), element=Viscous())

    def test_a_file_cannot_hold_it(self):
        with self.assertRaisesRegex(limcycle.CaseError, 'friction.kind = "own": stands for a law of one\'s own'):
            servo(friction={"kind": "own"})

    def test_what_is_no_number_is_named(self):
        class Forgetful(Dahl):
            calls = 0

            def output(self, v, z):
                Forgetful.calls += 1
                return super().output(v, z) if Forgetful.calls < 500 else None

        class Wordy(Dahl):
            def rate(self, v, z):
                return "fast"

        with self.assertRaisesRegex(TypeError, r"output\(v, z\) must return a number, found None"):
            limcycle.simulate(servo(friction=Forgetful()), 10.0, initial={"y": 0.1})
        with self.assertRaisesRegex(limcycle.CaseError, r"rate\(v, z\) must return a number, found a str"):
            servo(friction=Wordy())

    def test_on_threads_of_python_that_end(self):
        statuses = []
        for _ in range(3):
            thread = threading.Thread(target=lambda: statuses.append(limcycle.simulate(servo(friction=Dahl()), 1.0, initial={"y": 0.1}).to_dict()["status"]))
            thread.start()
            thread.join()
        self.assertEqual(statuses, ["converged"] * 3)

    def test_the_interpreter_may_end_at_once(self):
        # A thread that freed what Python kept of it would have waited for the lock while the interpreter ended.
        script = "\n".join(["import limcycle", "class Bristle:",
                            "    states, odd, scales = 1, True, (0.01, float('inf'), 1.0)",
                            "    def output(self, v, z): return 100.0 * z[0]",
                            "    def rate(self, v, z): return v - 100.0 * abs(v) * z[0]",
                            "limcycle.df(Bristle(), [0.0001 * 1.05 ** k for k in range(150)], [1.0], threads=4)"])
        for _ in range(8):
            ran = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False,
                                 env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)})
            self.assertEqual((ran.returncode, ran.stderr), (0, ""))

    def test_every_question_keeps_it(self):
        # remedies, as thresholds, read the case again
        parts = {"plant": {"kind": "mass", "mass": 1.0, "stiffness": 1.0, "damping": 0.1},
                 "search": {"amplitude": [0.1, 10.0], "frequency": [0.1, 10.0]}, "predict": {"starts": 1, "methods": ["describing-function"]}}
        loop = limcycle.Loop(friction=Rayleigh(0.5), **parts)
        cured = limcycle.remedy(loop, "damping").apply("damping")
        self.assertAlmostEqual(cured["loop.plant.damping"], 0.5, delta=2e-3)  # it hunts while the damping is less than mu
        self.assertIn('kind = "own"', pickle.loads(pickle.dumps(cured)).text)


class CompiledLaws(unittest.TestCase):
    """Functions of ctypes; those of Numba have an address as the stand-in here has."""

    @classmethod
    def setUpClass(cls):
        code = ("extern \"C\" double output(double v, const double *z) { return 100.0 * z[0]; }\n"
                "extern \"C\" void rate(double v, const double *z, double *dz)\n"
                "{ dz[0] = v - 100.0 * (v < 0.0 ? -v : v) * z[0]; }\n")
        with tempfile.TemporaryDirectory() as folder:
            source, library = Path(folder, "law.cpp"), str(Path(folder, "law.so"))
            source.write_text(code, encoding="utf-8")
            subprocess.run(["g++", "-shared", "-fPIC", str(source), "-o", library], check=True)
            cls.library = ctypes.CDLL(library)

    def dahl(self, **changes):
        library = self.library
        parts = {"states": 1, "odd": True, "scales": Dahl.scales, "output": library.output, "rate": library.rate}
        return SimpleNamespace(**{**parts, **changes})

    def test_gain_is_that_of_the_library(self):
        grid = ([0.003, 0.02], [1.0, 5.0])
        ours = limcycle.df(limcycle.laws.dahl(Fc=1.0, sigma0=100.0), *grid).gain
        np.testing.assert_allclose(limcycle.df(self.dahl(), *grid).gain, ours, rtol=1e-5)
        addressed = {name: SimpleNamespace(address=ctypes.cast(getattr(self.library, name), ctypes.c_void_p).value)
                     for name in ("output", "rate")}
        np.testing.assert_array_equal(limcycle.df(self.dahl(**addressed), *grid).gain, limcycle.df(self.dahl(), *grid).gain)

    def test_runs_are_those_of_python(self):
        plant = {"kind": "belt", "mass": 1.0, "stiffness": 4.0, "damping": 0.2, "speed": 0.1}
        runs = [limcycle.simulate(limcycle.Loop(plant=plant, friction=law), 1.0, initial={"y": 0.3}, sample=0.5)["y"]
                for law in (Dahl(), self.dahl())]
        np.testing.assert_allclose(runs[0], runs[1], rtol=1e-9)

    def test_another_signature_is_refused(self):
        def numba(returned, *kinds):
            return SimpleNamespace(address=1, _sig=SimpleNamespace(args=kinds, return_type=returned))

        good = ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double, ctypes.POINTER(ctypes.c_double))
        for output in (numba("float32", "float32", "float64*"), numba("float64", "float64"),
                       ctypes.CFUNCTYPE(ctypes.c_float, ctypes.c_float, ctypes.c_void_p)(lambda v, z: v),
                       ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_double, ctypes.c_int)(lambda v, z: v)):
            with self.assertRaisesRegex(limcycle.CaseError, r"output: .* must have the signature double output\(double v"):
                limcycle.df(SimpleNamespace(scales=(1.0, 1.0, 1.0), output=output), 1.0, 1.0)
        with self.assertRaisesRegex(limcycle.CaseError, "rate: .* must have the signature void rate"):
            limcycle.Loop(plant={"kind": "mass", "mass": 1.0}, friction=self.dahl(rate=numba("float64", "float64", "float64*", "float64*")))
        fine = SimpleNamespace(scales=(math.inf, 1.0, 1.0), output=good(lambda v, z: 2.0 * v))
        self.assertAlmostEqual(limcycle.df(fine, 1.0, 1.0).gain[0, 0, 0], 2.0j, delta=1e-6)

    def test_a_class_is_no_law(self):
        with self.assertRaisesRegex(limcycle.CaseError, r"must be an object of that class.*write Dahl\(\)"):
            limcycle.df(Dahl, 1.0, 1.0)

    def test_both_or_neither(self):
        with self.assertRaisesRegex(limcycle.CaseError, "friction: output and rate must both be compiled, or neither"):
            limcycle.df(self.dahl(rate=Dahl().rate), 0.01, 1.0)
        self.assertIn("compiled-law", " ".join(limcycle.predict(servo(friction=self.dahl()), time_limit=0.2).notes))


if __name__ == "__main__":
    unittest.main()
