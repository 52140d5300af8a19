"""Results: attributes, arrays, figures; gains against closed forms."""

import keyword
import os
import pickle
import tempfile
import unittest
import unittest.mock
import xml.etree.ElementTree as ElementTree

import limcycle
import numpy as np
from common import case, relay_loop, servo


class Gains(unittest.TestCase):
    amplitude = np.array([0.2, 0.5, 1.0, 3.0, 50.0])

    def test_relay(self):
        gain = limcycle.df(limcycle.laws.relay(level=2.0), self.amplitude, [1.0, 7.0]).gain
        self.assertEqual((gain.shape, gain.dtype), ((5, 2, 1), complex))
        np.testing.assert_allclose(gain[:, :, 0], np.outer(8.0 / (np.pi * self.amplitude), [1.0, 1.0]), rtol=1e-9)

    def test_saturation(self):
        A = np.array([0.5, 1.5, 4.0])
        r = np.minimum(0.5 / A, 1.0)  # the limit of the output is reached at 0.5
        exact = 2.0 * 2.0 / np.pi * (np.arcsin(r) + r * np.sqrt(1.0 - r * r))
        gain = limcycle.df(limcycle.laws.saturation(slope=2.0, limit=1.0), A, 3.0).gain
        np.testing.assert_allclose(gain[:, 0, 0], exact, rtol=1e-9)

    def test_cubic_with_bias(self):
        bias = np.array([-1.0, 0.0, 0.5])
        found = limcycle.df({"kind": "cubic", "coefficient": 2.0}, self.amplitude, 1.0, bias)
        A = self.amplitude[:, None]
        np.testing.assert_allclose(found.gain[:, 0, :], 2.0 * (0.75 * A**2 + 3.0 * bias**2), rtol=1e-9)
        np.testing.assert_allclose(found.mean[:, 0, :], 2.0 * (bias**3 + 1.5 * bias * A**2), rtol=1e-9, atol=1e-9)
        np.testing.assert_array_equal(found.bias, bias)

    def test_coulomb_friction_damps(self):
        # F = Fc sgn(v), v = A w cos(wt): N = j 4 Fc/(pi A), and each period takes 4 Fc A
        found = limcycle.df(limcycle.laws.coulomb(Fc=1.5), self.amplitude, [2.0])
        np.testing.assert_allclose(found.gain[:, 0, 0], 6j / (np.pi * self.amplitude), rtol=1e-9, atol=1e-12)
        np.testing.assert_allclose(found.dissipation[:, 0, 0], 6.0 * self.amplitude, rtol=1e-9)

    def test_the_order_is_that_of_the_document(self):
        found = limcycle.df(limcycle.laws.lugre(Fs=1.5, Fc=1.0, vs=0.001, sigma0=1e5, sigma1=316.0),
                            [1e-5, 1e-3], [1.0, 10.0, 100.0], [0.0, 1e-3])
        points = found.points
        self.assertEqual(found.gain.shape, (2, 3, 2))
        for k, index in enumerate(np.ndindex(2, 3, 2)):
            self.assertEqual(points[k].amplitude, found.amplitude[index[0]])
            self.assertEqual(points[k].frequency, found.frequency[index[1]])
            self.assertEqual(points[k].bias, found.bias[index[2]])
            self.assertEqual(points[k].gain, found.gain[index])
            self.assertEqual(points[k].error, found.error[index])
        self.assertEqual((points[0].harmonics.shape, points[0].harmonics.dtype), ((7,), complex))

    def test_what_is_undefined_is_nan_where_the_document_has_null(self):
        law = limcycle.laws.karnopp(Fs=1.5, Fc=1.0, vs=0.001, dv=1e-4)
        found = limcycle.df(law, [1e-3], [1e-2])  # slower than its band: the applied force decides
        self.assertIsNone(found.to_dict()["points"][0]["gain"][0])
        self.assertIsNone(found.points[0].gain)
        self.assertTrue(np.isnan(found.gain[0, 0, 0]))


class Attributes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.result = limcycle.predict(relay_loop())

    def test_they_are_the_keys_of_the_document(self):
        for key, value in self.result.to_dict().items():
            self.assertIn(key, self.result)
            if isinstance(value, (str, int, float)):
                self.assertEqual(getattr(self.result, key), value)
        cycle = self.result.cycles[0]
        self.assertEqual(cycle.to_dict(), self.result.to_dict()["cycles"][0])
        self.assertEqual(cycle.period, cycle["period"])
        self.assertIs(cycle.stable, True)
        with self.assertRaisesRegex(AttributeError, "amplitud.*amplitude"):
            cycle.amplitud

    def test_multipliers_are_complex(self):
        multipliers = self.result.cycles[0].multipliers
        self.assertEqual(multipliers.dtype, complex)
        self.assertLess(abs(multipliers[0]), 1.0)

    def test_a_key_that_is_a_word_of_python(self):
        parameter = limcycle.continue_(relay_loop(), "loop.element.level", 0.5, 2.0).parameter
        self.assertTrue(keyword.iskeyword("from"))
        self.assertEqual((parameter.from_, parameter["from"], parameter.to), (0.5, 0.5, 2.0))
        self.assertIn("from_", dir(parameter))
        self.assertEqual((parameter.get("to"), parameter.get("till", 3)), (parameter.to, 3))
        self.assertEqual(dict(parameter.items())["from"], 0.5)
        with self.assertRaises(AttributeError):
            parameter.to_  # "to" is no word of Python

    def test_null_among_numbers_is_nan(self):
        record = limcycle.Record({"some": [1.0, None], "rows": [[1.0, None], [2.0, 3.0]], "none": None,
                                  "multipliers": [[1.0, 2.0], [None, None]]})
        np.testing.assert_array_equal(record.some, [1.0, np.nan])
        np.testing.assert_array_equal(record.rows, [[1.0, np.nan], [2.0, 3.0]])
        np.testing.assert_array_equal(record.multipliers, [1.0 + 2.0j, np.nan])
        self.assertIsNone(record.none)

    def test_what_is_done_to_a_copy_stays_there(self):
        self.result.to_dict()["cycles"].clear()
        self.result.cycles[0].to_dict()["multipliers"].clear()
        self.assertTrue(self.result.to_dict()["cycles"][0]["multipliers"])
        with self.assertRaises(ValueError):
            limcycle.df(limcycle.laws.relay(level=1.0), 1.0, 1.0).gain[0] = 0.0

    def test_they_can_be_sent_to_another_process(self):
        again = pickle.loads(pickle.dumps(self.result))
        self.assertEqual(again.to_dict(), self.result.to_dict())
        self.assertEqual((str(again), again.to_csv(), again.to_svg()),
                         (str(self.result), self.result.to_csv(), self.result.to_svg()))
        np.testing.assert_array_equal(again.nyquist["G"], self.result.nyquist["G"])
        with self.assertRaisesRegex(limcycle.NoAnswer, "no page"):
            again.to_html()
        run = pickle.loads(pickle.dumps(limcycle.simulate(servo(), 1.0, initial={"y": 0.1}, sample=0.5)))
        self.assertEqual(run["y"][0], 0.1)

    def test_a_map_has_arrays(self):
        found = limcycle.map(relay_loop(), ("loop.element.level", 0.5, 2.0, 3), ("loop.element.hysteresis", 0.0, 0.1, 2))
        self.assertEqual(found.amplitude.shape, (2, 3))
        np.testing.assert_array_equal(found.cycles, 1.0)
        np.testing.assert_allclose(found.amplitude[0], found.amplitude[0, 0] * np.array([1.0, 2.5, 4.0]), rtol=1e-5)
        for k, point in enumerate(found.points):
            self.assertEqual(point.period, found.period[k // 3, k % 3])

    def test_a_run(self):
        run = limcycle.simulate(servo(), 4.0, initial={"y": 0.1}, sample=0.5)
        self.assertEqual(run.rows.shape, (9, len(run.columns)))
        np.testing.assert_array_equal(run["t"], np.linspace(0.0, 4.0, 9))
        self.assertEqual(run["y"][0], 0.1)
        self.assertIs(run.agreement.agrees, True)

    def test_nyquist_curve_is_that_of_the_plant(self):
        curves = self.result.nyquist
        s = 1j * curves["frequency"]
        np.testing.assert_allclose(curves["G"], 1.0 / (s + 1.0) ** 3, rtol=1e-9)
        np.testing.assert_allclose(curves["minus_inverse_N"][0], -np.pi * curves["family_amplitude"] / 4.0, rtol=1e-9)


class Documents(unittest.TestCase):
    def test_saved_files(self):
        result = limcycle.predict(relay_loop())
        with tempfile.TemporaryDirectory() as folder:
            for ending, begin in ((".json", "{"), (".csv", "kind,"), (".html", "<!"), (".svg", "<svg"), (".txt", "Loop"),
                                  (".tex", "% limcycle")):
                path = os.path.join(folder, "result" + ending)
                result.save(path)
                with open(path, encoding="utf-8") as file:
                    self.assertTrue(file.read().startswith(begin), ending)
            result.save(os.path.join(folder, "result.h5"))
            with open(os.path.join(folder, "result.h5"), "rb") as file:
                self.assertEqual(file.read(8), b"\x89HDF\r\n\x1a\n")
            with self.assertRaisesRegex(ValueError, r"\.json, \.h5, \.csv, .*\.svg, \.txt, \.pdf, \.pgf, \.png, not \.doc"):
                result.save(os.path.join(folder, "result.doc"))
            with self.assertRaisesRegex(ValueError, r"\.json, \.h5, \.csv, \.tex, \.txt, \.pdf, \.pgf, \.png, not \.svg"):
                limcycle.df(limcycle.laws.relay(level=1.0), 1.0, 1.0).save(os.path.join(folder, "table.svg"))

    def test_tables_of_latex(self):
        result = limcycle.predict(relay_loop())
        lines = result.to_latex("cycles", ["period", "amplitude", "stable", "method", "locked"], digits=4).splitlines()
        self.assertEqual(lines[0], r"\begin{tabular}{rrrlr}")
        self.assertEqual(lines[2], r"period & amplitude & stable & method & locked \\")
        cells = lines[4][:-3].split(" & ")
        self.assertEqual(cells[0], "$3.68$")  # 2 x 1.83988
        self.assertEqual(cells[2:], ["yes", "exact", "--"])
        self.assertEqual(lines[-1], r"\end{tabular}")
        whole = result.to_latex("cycles").splitlines()
        self.assertIn("first harmonic", whole[2])
        self.assertNotIn("multipliers", whole[2])
        self.assertEqual({line.count("&") for line in (whole[2], whole[4])}, {whole[2].count("&")})
        self.assertRegex(result.to_latex("cycles", ["error"]), r"\$1 \\times 10\^\{-1[0-9]\}\$|\$[0-9.]+ \\times")
        with self.assertRaisesRegex(ValueError, "status is no list of records; there are: cycles"):
            result.to_latex("status")
        with self.assertRaisesRegex(ValueError, "cycles has no speed; known: amplitude"):
            result.to_latex("cycles", ["speed"])

    def test_what_latex_would_read_is_escaped(self):
        from limcycle._latex import table

        text = table([{"a_b": "50 % of {x} & $y_1$ \\ ~#^"}], None, 3)
        self.assertIn(r"a b \\", text)
        self.assertIn(r"50 \% of \{x\} \& \$y\_1\$ \textbackslash{} \textasciitilde{}\#\textasciicircum{} \\", text)
        self.assertEqual(table([], None, 3).splitlines()[0], r"\begin{tabular}{}")

    def test_saved_figures(self):
        import matplotlib.pyplot

        results = limcycle.predict(relay_loop()), limcycle.simulate(relay_loop(), 2.0, sample=0.1)
        with tempfile.TemporaryDirectory() as folder:
            for result in results:
                for ending, begin in ((".pdf", b"%PDF"), (".png", b"\x89PNG")):
                    path = os.path.join(folder, "figure" + ending)
                    result.save(path)
                    with open(path, "rb") as file:
                        self.assertTrue(file.read().startswith(begin), ending)
        self.assertEqual(matplotlib.pyplot.get_fignums(), [])

    def test_a_notebook_shows_the_picture_and_the_words(self):
        html = limcycle.predict(relay_loop(title="a < b"))._repr_html_()
        self.assertIn("a &lt; b", html)
        ElementTree.fromstring(html[html.index("<svg"):html.index("</svg>") + 6])
        others = (limcycle.df(limcycle.laws.relay(level=1.0), [1.0, 2.0], 1.0), limcycle.simulate(relay_loop(), 2.0, sample=0.1),
                  limcycle.margin(servo(), "loop.controller.kd"))
        for result in others:  # the program has no picture of these
            html = result._repr_html_()
            ElementTree.fromstring(html[html.index("<svg"):html.index("</svg>") + 6])
            self.assertIn("<pre>", html)
        self.assertNotIn("<svg", limcycle.dissipativity(limcycle.laws.coulomb(Fs=1.0, Fc=1.0))._repr_html_())

    def test_a_figure_of_latex_needs_latex(self):
        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch("shutil.which", return_value=None):
            with self.assertRaisesRegex(ValueError, "PGF needs xelatex"):
                limcycle.simulate(relay_loop(), 2.0, sample=0.1).save(os.path.join(folder, "figure.pgf"))


class Followers(unittest.TestCase):
    """Loops that follow from a result."""

    def test_a_remedy_is_applied(self):
        result = limcycle.remedy(limcycle.load(case("over-compensated")), "gain-kp")
        cured = result.apply("gain-kp")
        self.assertEqual(cured["loop.controller.kp"], result.remedies[0].value)
        self.assertIs(limcycle.remedy(cured, "gain-kp").hunts, False)
        with self.assertRaisesRegex(limcycle.NoAnswer, "gain-kd: this remedy was not tried"):
            result.apply("gain-kd")

    def test_a_loop_is_tuned(self):
        result = limcycle.tune(limcycle.load(case("over-compensated")), {"kp": (20.0, 40.0)}, samples=4)
        tuned = result.tuned()
        self.assertEqual(tuned["loop.controller.kp"], result.numbers[0].value)
        self.assertEqual(tuned["loop.controller.kp"], result.points[result.best].values[0])
        nothing = limcycle.tune(limcycle.load(case("pid-lugre")), {"ki": (2.0, 8.0)}, samples=2)
        self.assertIsNone(nothing.best)
        with self.assertRaisesRegex(limcycle.NoAnswer, "there is nothing to apply"):
            nothing.tuned()

    def test_a_law_is_fitted(self):
        result = limcycle.identify(limcycle.load(case("records/servo")))
        loop = result.fitted()
        self.assertIn('kind = "lugre"', loop.text)
        Fs = next(one for law in result.laws if law.kind == "lugre" for one in law.parameters if one.name == "loop.friction.Fs")
        self.assertEqual(loop["loop.friction.Fs"], Fs.value)


class Figures(unittest.TestCase):
    def setUp(self):
        import matplotlib.pyplot

        self.addCleanup(matplotlib.pyplot.close, "all")

    def test_nyquist_marks_the_predictions(self):
        result = limcycle.predict(relay_loop())
        ax = result.plot()
        marks = [line for line in ax.lines if line.get_marker() == "o"]
        self.assertEqual(len(marks), len(result.predictions))
        self.assertAlmostEqual(marks[0].get_xdata()[0], -0.125, delta=1e-3)  # G(j sqrt 3) = -1/8
        self.assertIs(result.plot(ax), ax)

    def test_every_question_has_one(self):
        loop = relay_loop()
        level, hysteresis = ("loop.element.level", 0.5, 2.0, 2), ("loop.element.hysteresis", 0.0, 0.1, 2)
        limcycle.df(loop, [0.1, 1.0], [1.0]).plot()
        limcycle.simulate(loop, 5.0, sample=0.1).plot()
        limcycle.continue_(loop, "loop.element.level", 0.5, 2.0).plot(quantity="period")
        limcycle.margin(limcycle.load(case("belt-coulomb")), "loop.plant.speed").plot()
        self.assertEqual(len(limcycle.map(loop, level, hysteresis).plot().collections), 1)
        limcycle.sensitivity(loop, local=True).plot(output="period")
        limcycle.dissipativity(limcycle.load(case("df-lugre"))).plot()
        limcycle.remedy(limcycle.load(case("over-compensated")), "gain-kp").plot()
        limcycle.tune(limcycle.load(case("over-compensated")), {"kp": (20.0, 40.0)}, samples=4).plot()
        ax = limcycle.identify(limcycle.load(case("records/servo"))).plot()
        self.assertEqual(ax.get_title(), "lugre")
        with self.assertRaisesRegex(ValueError, "no counter-example"):
            limcycle.dissipativity(limcycle.laws.coulomb(Fc=1.0)).plot()

    def test_stable_parts_are_solid_and_unstable_ones_dashed(self):
        result = limcycle.continue_(limcycle.load(case("pid-lugre")), "loop.friction.Fs", 1.02, 0.99)
        styles = {line.get_linestyle() for line in result.plot().lines if line.get_marker() in ("None", "", None)}
        self.assertLessEqual({True, False}, {one.stable for one in result.branch})
        self.assertLessEqual({"-", "--"}, styles)


if __name__ == "__main__":
    unittest.main()
