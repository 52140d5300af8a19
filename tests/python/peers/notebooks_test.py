"""The notebooks run, find what they say, and their figures are those of docs/notebooks.md."""

import re
import unittest

import numpy as np
from notebooks import FIGURES, NOTEBOOKS, SOURCES, names, run, words


class Notebooks(unittest.TestCase):
    def left_by(self, name):
        """What the notebook leaves, after a look at its form and its figures."""
        text = (NOTEBOOKS / f"{name}.py").read_text(encoding="utf-8")
        cells = re.split(r"^# %%.*\n", text, flags=re.MULTILINE)
        self.assertTrue(text.startswith("# %% [markdown]\n# # "))
        self.assertGreater(len(cells), 5)
        left, printed, figures = run(name)
        shown = {path.name: path.read_text(encoding="utf-8") for path in FIGURES.glob(f"{name}-*.svg")}
        self.assertEqual(sorted(figures), sorted(shown), "tools/notebooks --fix draws them")
        for file, picture in figures.items():
            self.assertEqual(words(picture), words(shown[file]), f"{file}: tools/notebooks --fix draws it")
        return left, printed

    def test_servo(self):
        left, printed = self.left_by("servo")
        self.assertAlmostEqual(left["cycle"].period, 5.070, delta=1e-3)
        self.assertIn("The describing function does not find this cycle.", printed)
        self.assertLess(np.abs(left["run"]["y"][-100:]).max(), 0.0015)
        self.assertEqual([one.ends for one in left["remedies"].remedies], [True, True])
        self.assertTrue(printed.endswith("\n[]\n"))  # no stable cycle is left

    def test_describing_functions(self):
        left, printed = self.left_by("describing_functions")
        self.assertLess(max(left["differences"]), 1e-9)
        for name, found in left["intersections"].items():
            ours = [one for one in left["results"][name].predictions if one.method == "describing-function"]
            ours.sort(key=lambda one: one.frequency)
            self.assertEqual(len(ours), len(found))
            for one, (amplitude, frequency) in zip(ours, sorted(found, key=lambda both: both[1])):
                self.assertAlmostEqual(one.amplitude / amplitude, 1.0, delta=0.01)
                self.assertAlmostEqual(one.frequency / frequency, 1.0, delta=0.005)
        page = (SOURCES / "docs" / "notebooks.md").read_text(encoding="utf-8")
        shown = [*(pair for found in left["intersections"].values() for pair in found),
                 *((one.first_harmonic, one.frequency) for found in left["results"].values() for one in found.cycles)]
        for amplitude, frequency in shown:
            self.assertIn(f"A = {amplitude:.3f} at {frequency:.3f} rad/s", page)
        simple, delayed, drive = left["results"].values()
        self.assertEqual([one.verdict for one in simple.predictions[:1]], ["confirmed"])
        self.assertEqual([one.stable for one in delayed.cycles], [False, False])
        self.assertEqual([one.stable for one in drive.cycles], [True])
        self.assertAlmostEqual(0.947 / drive.cycles[0].first_harmonic, 0.83, delta=0.005)
        self.assertEqual((len(left["missed"].cycles), left["missed"].predictions), (1, []))

    def test_maps_and_sensitivity(self):
        left, printed = self.left_by("maps_and_sensitivity")
        points = left["points"]
        np.testing.assert_allclose(left["measured"], left["closed_form"](points), rtol=1e-9)
        indices = left["indices"]
        for column, margin in (("limcycle, 64", 0.15), ("SALib, 64", 0.15)):
            np.testing.assert_allclose(indices[column], indices["closed form, 4096"], atol=margin)
        self.assertEqual(set(left["table"].happens), {"hunting", "sliding"})

    def test_own_law(self):
        left, printed = self.left_by("own_law")
        gains = left["gains"]
        np.testing.assert_allclose(gains["Lorentz"][:5], gains["LuGre"][:5], rtol=0.05)  # both are springs of 1e5 N/m
        self.assertEqual(set(left["costs"]), {"Python", "compiled", "LuGre of the library"})
        self.assertAlmostEqual(left["result"].cycles[0].period, 23.85, delta=0.05)  # as examples/own-law prints
        self.assertAlmostEqual(left["run"]["y"][-100:].max(), left["result"].cycles[0].amplitude, delta=0.01)

    def test_the_page_shows_each(self):
        page = (SOURCES / "docs" / "notebooks.md").read_text(encoding="utf-8")
        for name in names():
            self.assertIn(f"(../examples/notebooks/{name}.py)", page)
            self.assertTrue(hasattr(self, f"test_{name}"), name)
        for path in FIGURES.glob("*.svg"):
            self.assertIn(f"(notebooks/{path.name})", page)


if __name__ == "__main__":
    unittest.main()
