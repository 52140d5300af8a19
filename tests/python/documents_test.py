"""Every document is that of the program to the byte, provenance and all: both come from one build."""

import json
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import limcycle
from common import PROGRAM, case, document, relay_loop


class Documents(unittest.TestCase):
    maxDiff = 2000

    def same(self, result, *words):
        made = {"--json": result.to_json(), "--csv": result.to_csv(), "--html": result.to_html(), "--svg": result.to_svg()}
        with tempfile.TemporaryDirectory() as folder:
            files = {flag: Path(folder) / flag.strip("-") for flag, text in made.items() if text is not None}
            flags = [word for flag, file in files.items() for word in (flag, str(file))]
            run = subprocess.run([PROGRAM, *words, *flags, "--quiet"], capture_output=True, text=True, check=False)
            for flag, file in files.items():
                self.assertTrue(file.exists(), run.stderr)
                written = file.read_text(encoding="utf-8")
                if flag == "--html":  # only the command has flags, which reproduce its page
                    command = re.compile(rf"(?<=>)limcycle {words[0]} [^<]*(?=</pre>)")
                    own = command.search(made[flag])
                    if own is not None:
                        self.assertTrue(command.search(written)[0].startswith(own[0]))
                        written = command.sub(lambda _: own[0], written, count=1)
                self.assertTrue(written == made[flag], f"{words[0]} {flag}")
            page = f"\nreport: {files['--html']}\n" if "--html" in files else ""
        self.assertIn(page, run.stdout)
        self.assertEqual(run.stdout.replace(page, "", 1), str(result))
        self.assertEqual(result.to_dict(), json.loads(made["--json"]))

    def test_predict(self):
        for name in ("relay-third-order", "dead-zone", "measured-axis"):
            with self.subTest(name):
                self.same(limcycle.predict(limcycle.load(case(name))), "predict", case(name))

    def test_predict_with_other_values(self):
        file = case("relay-third-order")
        for loop in (limcycle.load(file).set({"loop.element.level": 2.0}),
                     limcycle.load(file, {"loop.element.level": 2.0})):
            self.same(limcycle.predict(loop), "predict", file, "--set", "loop.element.level=2.0")

    def test_df(self):
        for name in ("df-lugre", "relay-third-order"):
            with self.subTest(name):
                self.same(limcycle.df(limcycle.load(case(name))), "df", case(name))
        file = case("df-lugre")
        self.same(limcycle.df(limcycle.load(file), [1e-4], accuracy=1e-4), "df", file, "--set", "df.amplitude=[0.0001]",
                  "--set", "df.accuracy=0.0001")

    def test_simulate(self):
        self.same(limcycle.simulate(limcycle.load(case("valve-stiction"))), "simulate", case("valve-stiction"))
        file = case("belt-coulomb")
        self.same(limcycle.simulate(limcycle.load(file), 3.0, sample=0.5, check=False), "simulate", file, "--no-check",
                  "--set", "simulate.duration=3.0", "--set", "simulate.sample=0.5")

    def test_continue(self):
        file = case("relay-delay")
        self.same(limcycle.continue_(limcycle.load(file), "loop.element.level", 0.5, 2.0), "continue", file, "--parameter",
                  "loop.element.level=0.5:2.0")

    def test_margin(self):
        file = case("belt-coulomb")
        relay = case("relay-third-order")
        self.same(limcycle.margin(limcycle.load(relay), toward={"level": 0.5}, factor=3.0), "margin", relay, "--toward",
                  "level=0.5", "--factor", "3")
        self.same(limcycle.margin(limcycle.load(file), "loop.plant.speed", factor=2.0), "margin", file, "--parameter",
                  "loop.plant.speed", "--factor", "2")

    def test_map(self):
        file = case("relay-third-order")
        result = limcycle.map(limcycle.load(file), ("loop.element.level", 0.5, 2.0, 3, "log"),
                              ("loop.element.hysteresis", 0.0, 0.1, 2), methods="describing-function", starts=2)
        self.same(result, "map", file, "--x", "loop.element.level=0.5:2.0:3:log", "--y",
                  "loop.element.hysteresis=0.0:0.1:2", "--methods", "describing-function", "--starts", "2")
        file = case("pid-lugre")
        result = limcycle.map(limcycle.load(file), ("loop.controller.kd", 6.0, 20.0, 2),
                              ("loop.controller.ki", 2.0, 4.0, 2), outcomes=True)
        self.same(result, "map", file, "--x", "loop.controller.kd=6:20:2", "--y", "loop.controller.ki=2:4:2", "--outcomes")

    def test_sensitivity(self):
        file = case("relay-third-order")
        self.same(limcycle.sensitivity(limcycle.load(file), samples=8, seed=3), "sensitivity", file, "--samples", "8",
                  "--seed", "3")
        self.same(limcycle.sensitivity(limcycle.load(file), local=True, factors=[0.9]), "sensitivity", file, "--local",
                  "--factors", "0.9")

    def test_dissipativity(self):
        file = case("df-lugre")
        self.same(limcycle.dissipativity(limcycle.load(file), speed=0.1, parameter=("loop.friction.sigma2", 0.1, 1.0)),
                  "dissipativity", file, "--speed", "0.1", "--parameter", "loop.friction.sigma2=0.1:1.0")

    def test_remedy(self):
        file = case("belt-coulomb")
        self.same(limcycle.remedy(limcycle.load(file), "damping", weights={"noise_gain": 2.0}, threads=1), "remedy", file,
                  "--only", "damping", "--weight", "noise_gain=2")

    def test_tune(self):
        file = case("over-compensated")
        self.same(limcycle.tune(limcycle.load(file), {"kp": (20.0, 40.0)}, minimise="settling", at_most={"ms": 3.0},
                                margin=0.02, samples=4, threads=1), "tune", file, "--vary", "kp=20:40", "--minimise", "settling",
                  "--at-most", "ms=3", "--margin", "2", "--samples", "4")

    def test_identify(self):
        file = case("records/servo")
        self.same(limcycle.identify(limcycle.load(file)), "identify", file)
        self.same(limcycle.identify(limcycle.load(file), plan=True), "identify", file, "--plan")

    def test_what_a_time_limit_cut_short_says_so_first(self):
        sides = (("loop.controller.kd", 1.0, 50.0, 100), ("loop.controller.kp", 1.0, 50.0, 100))
        result = limcycle.map(limcycle.load(case("pid-lugre")), *sides, time_limit=0.3)
        self.assertEqual(str(result).split("\n")[:2], ["Time limit of 0.3 s reached: this result is incomplete.", ""])

    def test_a_loop_of_dictionaries_is_its_own_case_file(self):
        result = limcycle.predict(relay_loop())
        made, loaded = result.to_dict(), document("predict", case("relay-third-order"))
        self.assertIsNone(made["case"]["file"])
        for key in set(loaded) - {"case", "provenance"}:
            self.assertEqual(made[key], loaded[key], key)
        self.assertNotIn("To reproduce it", result.to_html())  # no file that a command could read

    def test_numbers_that_do_not_exist_are_none(self):
        text = json.dumps(limcycle.predict(limcycle.load(case("dead-zone"))).to_dict())
        self.assertNotIn("NaN", text)
        self.assertNotIn("Infinity", text)


if __name__ == "__main__":
    unittest.main()
