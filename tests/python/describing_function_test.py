"""limcycle.describing_function: elements and functions, against closed forms. Those of python-control: peers."""

import unittest

import limcycle
import numpy as np


class DescribingFunction(unittest.TestCase):
    amplitude = np.array([[0.2, 0.5], [1.0, 4.0]])

    def test_of_an_element(self):
        A = self.amplitude
        np.testing.assert_allclose(limcycle.describing_function(limcycle.laws.relay(level=2.0), A), 8.0 / (np.pi * A),
                                   rtol=1e-9)
        gain = limcycle.describing_function({"kind": "dead-zone", "half_width": 0.3}, A)
        b = np.minimum(1.0, 0.3 / A)
        np.testing.assert_allclose(gain, 1.0 - 2.0 / np.pi * (np.arcsin(b) + b * np.sqrt(1.0 - b**2)), atol=1e-12)

    def test_of_a_function(self):
        A = self.amplitude
        np.testing.assert_allclose(limcycle.describing_function(lambda u: u**3, A), 0.75 * A**2, rtol=1e-8)
        np.testing.assert_allclose(limcycle.describing_function(np.sign, A), 4.0 / (np.pi * A), rtol=1e-5)
        limited = limcycle.describing_function(lambda u: np.array([np.clip(u, -0.3, 0.3)]), A)
        np.testing.assert_allclose(limited, limcycle.describing_function(limcycle.laws.saturation(limit=0.3), A), rtol=1e-4)

    def test_of_one_that_is_not_odd(self):
        theta = 2.0 * np.pi * np.arange(256) / 256
        expected = [2.0 * np.mean(np.exp(A * np.sin(theta)) * np.sin(theta)) / A for A in (0.5, 2.0)]
        np.testing.assert_allclose(limcycle.describing_function(np.exp, [0.5, 2.0]), expected, rtol=1e-6)

    def test_shapes(self):
        relay = limcycle.laws.relay(level=1.0)
        self.assertEqual(limcycle.describing_function(relay, 2.0).shape, ())
        self.assertEqual(limcycle.describing_function(relay, []).shape, (0,))
        self.assertEqual(limcycle.describing_function(np.sign, [1.0]).dtype, complex)

    def test_what_is_not_known_well_enough_is_nan(self):
        rough = limcycle.describing_function(lambda u: np.floor(40.0 * u) / 40.0, [0.1])
        self.assertTrue(np.isnan(rough).all())

    def test_what_is_refused(self):
        for what, amplitude, key, rule in (
                (3.0, 1.0, "nonlinearity", "element of limcycle.laws"), (np.sin, [1.0, 0.0], "amplitude", "above 0"),
                (lambda u: "far", 1.0, "nonlinearity", "finite number"), (np.log, 1.0, "nonlinearity", "finite number"),
                (limcycle.laws.coulomb(Fc=1.0), 1.0, "nonlinearity", "must not depend on the frequency"),
                (limcycle.laws.clamped_pi(ki=1.0, limit=1.0), 1.0, "nonlinearity", "must not depend on the frequency")):
            with self.subTest(rule), np.errstate(all="ignore"), self.assertRaisesRegex(limcycle.CaseError, rule) as caught:
                limcycle.describing_function(what, amplitude)
            self.assertEqual(caught.exception.key, key)


if __name__ == "__main__":
    unittest.main()
