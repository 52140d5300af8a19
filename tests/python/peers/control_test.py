"""Side by side with python-control: its systems, its nonlinearities, and the examples of its documentation."""

import unittest

import control
import limcycle
import numpy as np

OMEGA = np.logspace(-3, 3, 500)
SEARCH = {"amplitude": [0.05, 20.0], "frequency": [0.01, 100.0]}


def predictions(plant, element):
    found = limcycle.predict(limcycle.Loop(plant=plant, element=element, search=SEARCH)).predictions
    return sorted((one.amplitude, one.frequency) for one in found if one.method == "describing-function")


class Systems(unittest.TestCase):
    def test_each_form_is_the_same_plant(self):
        plant = control.tf([1.0], [1.0, 3.0, 3.0, 1.0])
        for system in (plant, control.ss(plant), control.zpk([], [-1.0, -1.0, -1.0], 1.0)):
            loop = limcycle.Loop(plant=system, element=limcycle.laws.relay(level=1.0), search=SEARCH)
            self.assertAlmostEqual(limcycle.predict(loop).cycles[0].frequency, np.pi / 1.8398753422, delta=1e-6)

    def test_a_frequency_response_is_a_measured_plant(self):
        plant = control.tf([1.0], [1.0, 3.0, 3.0, 1.0])
        omega = np.logspace(-1, 2, 200)
        relay = limcycle.laws.relay(level=1.0)
        exact, measured = predictions(plant, relay), predictions(control.frd(plant, omega), relay)
        np.testing.assert_allclose(measured, exact, rtol=1e-4)

    def test_what_is_no_continuous_model_is_refused(self):
        relay = limcycle.laws.relay(level=1.0)
        with self.assertRaisesRegex(limcycle.CaseError, "continuous-time"):
            limcycle.Loop(plant=control.tf([1.0], [1.0, 0.5], 0.1), element=relay)
        with self.assertRaisesRegex(limcycle.CaseError, "one input and one output"):
            limcycle.Loop(plant=control.ss(-np.eye(2), np.eye(2), np.eye(2), np.zeros((2, 2))), element=relay)


class Nonlinearities(unittest.TestCase):
    amplitude = np.linspace(1.01, 5.0, 60).reshape(2, 30)

    def test_describing_functions_agree(self):
        for nonlinearity in (control.saturation_nonlinearity(0.75), control.saturation_nonlinearity(2.0),
                             control.friction_backlash_nonlinearity(0.5), control.friction_backlash_nonlinearity(2.0),
                             control.relay_hysteresis_nonlinearity(1.0, 1.0)):
            ours = limcycle.describing_function(nonlinearity, self.amplitude)
            theirs = control.describing_function(nonlinearity, self.amplitude)
            np.testing.assert_allclose(ours, theirs, rtol=1e-12, atol=1e-14)

    def test_that_of_a_static_system(self):
        cubic = control.nlsys(None, lambda t, x, u, params: u**3, inputs=1, outputs=1)
        np.testing.assert_allclose(limcycle.describing_function(cubic, [0.5, 2.0]), [0.75 * 0.25, 3.0], rtol=1e-9, atol=1e-9)

    def test_what_stands_for_them(self):
        for nonlinearity, law in ((control.saturation_nonlinearity(2.0), limcycle.laws.saturation(limit=2.0)),
                                  (control.friction_backlash_nonlinearity(0.5), limcycle.laws.backlash(half_gap=0.25)),
                                  (control.relay_hysteresis_nonlinearity(2.0, 0.1),
                                   limcycle.laws.relay(level=2.0, hysteresis=0.1))):
            texts = [limcycle.Loop(plant=([1.0], [1.0, 1.0]), element=one).text for one in (nonlinearity, law)]
            self.assertEqual(*texts)

    def test_what_has_no_counterpart_is_refused(self):
        class Own(control.DescribingFunctionNonlinearity):
            def describing_function(self, A):
                return 1.0

        for ask in (lambda F: limcycle.describing_function(F, 1.0),
                    lambda F: limcycle.Loop(plant=([1.0], [1.0, 1.0]), element=F)):
            with self.assertRaisesRegex(limcycle.CaseError, "Own: must be one of saturation_nonlinearity"):
                ask(Own())
        with self.assertRaisesRegex(limcycle.CaseError, "from -1 to 2: must be symmetric"):
            limcycle.Loop(plant=([1.0], [1.0, 1.0]), element=saturation_from_minus_one_to_two())

    def test_what_a_case_cannot_hold_is_asked_itself(self):
        def symmetric(limit, amplitude):  # of a saturation
            u = min(limit / amplitude, 1.0)
            return 2.0 / np.pi * (np.arcsin(u) + u * np.sqrt(1.0 - u * u))

        one_sided, sizes = saturation_from_minus_one_to_two(), np.array([0.5, 1.5, 3.0])
        exact = [0.5 * (symmetric(1.0, A) + symmetric(2.0, A)) for A in sizes]
        np.testing.assert_allclose(limcycle.describing_function(one_sided, sizes), exact, atol=1e-4)
        # That of python-control is exact only where both limits are exceeded, or none: 1 instead of 0.89 at 1.5.
        np.testing.assert_allclose(control.describing_function(one_sided, sizes[[0, 2]]), np.array(exact)[[0, 2]], atol=1e-4)


def saturation_from_minus_one_to_two():
    import warnings

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of python-control: it would ignore the bias
        return control.saturation_nonlinearity(2.0, -1.0)


class Examples(unittest.TestCase):
    """Of the describing-function page and notebook of python-control."""

    def agree(self, plant, element, amplitude, delta):
        theirs = control.describing_function_response(plant, element, amplitude, OMEGA).intersections
        ours = predictions(plant, element)
        self.assertEqual(len(ours), len(theirs))
        np.testing.assert_allclose(ours, sorted((float(A), float(w)) for A, w in theirs), rtol=delta)
        return ours

    def test_saturation_and_a_third_order_plant(self):
        found = self.agree(control.tf([8.0], [1.0, 2.0, 2.0, 1.0]), control.saturation_nonlinearity(1.0),
                           np.linspace(0.0, 5.0, 50), 1e-3)
        self.assertAlmostEqual(found[0][1], np.sqrt(2.0), delta=1e-6)

    def test_backlash_and_a_delay(self):
        plant = control.tf(control.tf([1.0], [1.0, 2.0, 2.0, 1.0]) * control.tf(*control.pade(5, 4)) * 4.0)
        self.agree(plant, control.friction_backlash_nonlinearity(1.0), np.linspace(0.6, 5.0, 50), 1e-3)


if __name__ == "__main__":
    unittest.main()
