"""Loops from dictionaries, laws and systems of other packages; what is wrong is named."""

import os
import pickle
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import limcycle
import numpy as np
from common import case, relay_loop, servo


class Wrong(unittest.TestCase):
    def refused(self, make, **facts):
        with self.assertRaises(limcycle.CaseError) as caught:
            make()
        for name, value in facts.items():
            self.assertEqual(getattr(caught.exception, name), value, name)
        return caught.exception

    def test_a_misspelt_key_names_the_nearest(self):
        error = self.refused(lambda: limcycle.laws.lugre(Fs=1.5, Fc=1.0, vs=0.001, sigm0=1e5),
                             key="loop.friction.sigm0", rule="unknown key", suggestion="did you mean sigma0?")
        self.assertIn("loop.friction.sigm0", str(error))

    def test_a_number_out_of_its_range(self):
        self.refused(lambda: servo(plant={"kind": "mass", "mass": -1.0}), key="loop.plant.mass", value="-1",
                     rule="must be > 0 kg", file="", line=0)

    def test_rules_between_numbers(self):
        self.refused(lambda: limcycle.laws.lugre(Fs=0.5, Fc=1.0, vs=0.001, sigma0=1e5), key="loop.friction.Fs")

    def test_an_unknown_law(self):
        with self.assertRaisesRegex(AttributeError, "lugree.*lugre"):
            limcycle.laws.lugree
        self.refused(lambda: servo(friction={"kind": "lugree"}), key="loop.friction.kind")

    def test_values_that_no_case_has(self):
        self.refused(lambda: servo(load=float("nan")), key="loop.load", value="nan")
        self.refused(lambda: servo(load=object()), key="loop.load")
        self.refused(lambda: servo(plant={"kind": "mass", 3: 1.0}), key="loop.plant")
        self.refused(lambda: servo(predikt={}), key="predikt", suggestion="did you mean predict?")
        self.refused(limcycle.Loop, key="loop")

    def test_a_change(self):
        loop = servo()
        self.refused(lambda: loop.set({"loop.plant.mass": -1.0}), key="loop.plant.mass", value="-1.0")
        self.refused(lambda: loop.set({"loop.plant.mas": 1.0}), suggestion="did you mean mass?")

    def test_a_file_has_lines(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "wrong.toml")
            with open(path, "w", encoding="utf-8") as file:
                file.write("[loop.plant]\nkind = 'mass'\nmass = 0\n")
            self.refused(lambda: limcycle.load(path), file=path, line=3, key="loop.plant.mass")
        self.refused(lambda: limcycle.load(path), file=path)

    def test_arguments_of_questions(self):
        loop = servo()
        self.refused(lambda: limcycle.continue_(loop, "loop.controller.kdd", 1, 2), key="parameter",
                     value="loop.controller.kdd", suggestion="did you mean loop.controller.kd?")
        self.refused(lambda: limcycle.continue_(loop, "loop.controller.kd", 1, 1), key="start, stop")
        self.refused(lambda: limcycle.margin(loop, "loop.controller.tf"), key="parameters", value="loop.controller.tf",
                     rule="is zero or absent: no factor changes it")
        self.refused(lambda: limcycle.margin(loop, 3), key="parameters", value="3")
        self.refused(lambda: limcycle.margin(loop, toward={"kx": 1.0}), key="toward", value="kx")
        self.refused(lambda: limcycle.margin(loop, toward=3), key="toward", value="3")
        self.refused(lambda: limcycle.margin(loop, toward={"kp": float("nan")}), key="toward['kp']", value="nan")
        self.refused(lambda: limcycle.margin(loop, factor=1.0), key="factor")
        self.refused(lambda: limcycle.margin(loop, factor="2"), key="factor", value="'2'")
        self.refused(lambda: limcycle.map(loop, ("loop.controller.kd", 1, 2, 1), ("loop.plant.mass", 1, 2, 2)), key="x")
        self.refused(lambda: limcycle.map(loop, ("loop.controller.kd", 1, 2, 2), ("loop.controller.kd", 1, 2, 2)), key="y")
        self.refused(lambda: limcycle.map(loop, ("loop.controller.kd", 1, 2, 2), ("loop.plant.mass", 1, 2, 2),
                                          outcomes=True, methods="describing-function"), key="methods")
        self.refused(lambda: limcycle.map(loop, ("loop.controller.kd", 1, 2, 2), ("loop.plant.mass", 1, 2, 2),
                                          methods=["describing"]), key="methods", value="describing")
        self.refused(lambda: limcycle.df(loop, [0.0], [1.0]), key="df.amplitude", value="[0.0]")
        self.refused(lambda: limcycle.df(loop, [1.0]), key="frequency")
        self.refused(lambda: limcycle.df(loop), key="amplitude")
        self.refused(lambda: limcycle.df(3.0, 1.0, 1.0), key="loop_or_law", value="float")
        self.refused(lambda: limcycle.simulate(loop), key="duration")
        self.refused(lambda: limcycle.simulate(loop, -1.0), key="simulate.duration")
        self.refused(lambda: limcycle.df(loop, 1.0, 1.0, threads=-1), key="threads")
        self.refused(lambda: limcycle.predict(loop, time_limit=0.0), key="time_limit")
        self.refused(lambda: limcycle.predict({"kind": "lugre"}), key="loop")
        self.refused(lambda: limcycle.predict(limcycle.laws.relay(level=1.0)), key="loop")
        self.refused(lambda: limcycle.df(loop, [1.0], [1.0], isa="avx9"), key="isa")
        self.refused(lambda: limcycle.dissipativity(loop, parameter=("loop.plant.mass", 1, 2)), key="parameter",
                     value="loop.plant.mass=1:2")
        self.refused(lambda: limcycle.dissipativity(loop, parameter=("loop.friction.Fs", 2, 1)), key="parameter",
                     rule="must begin below its end")
        self.refused(lambda: limcycle.dissipativity(loop, parameter=("loop.friction.Fs", 2.0)), key="parameter")
        self.refused(lambda: limcycle.sensitivity(loop, factors=[0.0]), key="factors")
        self.refused(lambda: limcycle.sensitivity(loop, thresholds="loop.controller.tf"), key="thresholds",
                     value="loop.controller.tf")
        self.refused(lambda: limcycle.map(loop, ("loop.controller.kd", 1, 2, True), ("loop.plant.mass", 1, 2, 2)), key="x")
        self.refused(lambda: limcycle.predict(loop, progress=3), key="progress")
        self.refused(lambda: limcycle.remedy(loop, "gain-kk"), key="only", value="gain-kk")
        self.refused(lambda: limcycle.remedy(loop, weights={"noise": 1.0}), key="weights", value="noise")
        self.refused(lambda: limcycle.tune(loop, {"kq": (1.0, 2.0)}), key="vary", value="kq")
        self.refused(lambda: limcycle.tune(loop, {"kp": 1.0}), key="vary['kp']")
        self.refused(lambda: limcycle.tune(loop, {"kp": (1.0, 2.0)}, minimise="mz"), key="minimise", value="mz")
        self.refused(lambda: limcycle.tune(loop, {"kp": (1.0, 2.0)}, at_most={"ms": 0.0}), key="at_most['ms']")

    def test_numbers_of_numpy_are_numbers(self):
        loop = servo()
        limcycle.map(loop, ("loop.controller.kd", np.float64(6.0), np.int64(7), np.int32(2)),
                     ("loop.plant.mass", 1, 2, 2), starts=np.int64(1), threads=np.int64(1), time_limit=np.float64(0.01))
        limcycle.sensitivity(loop, samples=np.int64(2), factors=np.array([0.9]), seed=np.int64(1), time_limit=0.01)

    def test_what_does_not_fit_into_memory(self):
        loop = limcycle.load(case("pid-lugre"))
        kd, kp = ("loop.controller.kd", 1.0, 9.0, 10000), ("loop.controller.kp", 1.0, 5.0, 10000)
        script = ("import limcycle, resource, sys\nloop = limcycle.load(sys.argv[1])\n"
                  "resource.setrlimit(resource.RLIMIT_AS, (2000000000, -1))\n"
                  f"for ask in (lambda: limcycle.map(loop, {kd!r}, {kp!r}),\n"
                  "            lambda: limcycle.sensitivity(loop, samples=1 << 24),\n"
                  "            lambda: limcycle.df(loop, {'from': 1e-6, 'to': 1.0, 'points': 1000000}, [1.0, 2.0, 3.0],\n"
                  "                                harmonics=1000)):\n"
                  "    try:\n        ask()\n    except limcycle.CaseError as error:\n        print(error)\n")
        run = subprocess.run([sys.executable, "-c", script, loop.file], capture_output=True, text=True)
        lines = run.stdout.splitlines()
        self.assertEqual([line.split(":")[0] for line in lines], ["x, y", "samples", "df"], run.stderr)
        for line in lines:
            self.assertRegex(line, "needs .* GB of memory; 2 GB are there; fewer ")

    def test_it_can_be_sent_to_another_process(self):
        error = self.refused(lambda: servo(plant={"kind": "mass", "mass": -1.0}))
        again = pickle.loads(pickle.dumps(error))
        self.assertEqual((str(again), again.key), (str(error), error.key))


class SystemsOfOthers(unittest.TestCase):
    """Each form gives the same loop as the table that it stands for."""

    class TransferFunction:  # as in python-control
        num, den, dt = [[np.array([0.0, 1.0])]], [[np.array([1.0, 3.0, 3.0, 1.0])]], 0

    class StateSpace:
        A = np.array([[-3.0, -3.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        B, C, D, dt = np.array([[1.0], [0.0], [0.0]]), np.array([[0.0, 0.0, 1.0]]), np.array([[0.0]]), None

    def frequency(self, plant):
        loop = relay_loop(plant=plant)
        return limcycle.predict(loop).cycles[0].frequency

    def test_continuous_ones(self):
        exact = np.pi / 1.8398753422  # half a period of the relay with 1/(s + 1)^3
        model = self.StateSpace
        for plant in (([1.0], [1, 3, 3, 1]), (np.array([1.0]), np.array([1.0, 3.0, 3.0, 1.0])), self.TransferFunction(),
                      model(), (model.A, model.B, model.C, model.D), (model.A, [1, 0, 0], [0, 0, 1], 0),
                      ([], [-1.0, -1.0, -1.0], 1.0), {"kind": "zpk", "zeros": [], "poles": [-1, -1, -1], "gain": 1}):
            with self.subTest(type(plant).__name__):
                self.assertAlmostEqual(self.frequency(plant), exact, delta=1e-7)

    def test_systems_of_scipy(self):
        from scipy import signal

        tf = signal.TransferFunction([2.0], [1.0, 0.5, 4.0])
        expected = limcycle.Loop(plant=([2.0], [1.0, 0.5, 4.0]), element=limcycle.laws.relay(level=1.0)).text
        self.assertEqual(limcycle.Loop(plant=tf, element=limcycle.laws.relay(level=1.0)).text, expected)
        self.assertIn("state-space", limcycle.Loop(plant=tf.to_ss(), element=limcycle.laws.relay(level=1.0)).text)
        self.assertIn("zpk", limcycle.Loop(plant=tf.to_zpk(), element=limcycle.laws.relay(level=1.0)).text)

    def test_discrete_ones_are_refused(self):
        sampled = self.TransferFunction()
        sampled.dt = 0.1
        with self.assertRaisesRegex(limcycle.CaseError, "loop.plant.*continuous"):
            relay_loop(plant=sampled)

    def test_several_inputs_are_refused(self):
        with self.assertRaisesRegex(limcycle.CaseError, "one input and one output"):
            relay_loop(plant=(np.eye(2), np.eye(2), np.eye(2), np.zeros((2, 2))))
        with self.assertRaisesRegex(limcycle.CaseError, "linear system"):
            relay_loop(plant=3.0)

    def test_a_controller_is_any_linear_system(self):
        parts = {"plant": {"kind": "mass", "mass": 1.0}, "friction": limcycle.laws.coulomb(Fs=1.5, Fc=1.0)}
        expected = limcycle.Loop(controller=([30.0, 120.0, 150.0], [1.0, 50.0, 600.0]), **parts).text
        zpk = ([-2.0 + 1.0j, -2.0 - 1.0j], [-20.0, -30.0], 30.0)
        self.assertEqual(limcycle.Loop(controller=zpk, **parts).text, expected)
        gain = limcycle.Loop(controller=([3.0], [1.0]), **parts).text
        self.assertEqual(limcycle.Loop(controller=([], [], [], [[3.0]]), **parts).text, gain)
        with self.assertRaisesRegex(limcycle.CaseError, "conjugate pairs"):
            limcycle.Loop(controller=([], [-1.0 + 1.0j], 1.0), **parts)

    def test_sizes_that_do_not_fit(self):
        with self.assertRaisesRegex(limcycle.CaseError, "A of 2 x 2, B of 2 and C of 3 numbers.*as many numbers"):
            relay_loop(plant=(np.eye(2), [1.0, 0.0], [1.0, 0.0, 0.0], 0.0))

    def test_arguments_of_another_type(self):
        with self.assertRaisesRegex(limcycle.CaseError, "values = 3: must be values by path"):
            relay_loop().set(3)
        with self.assertRaisesRegex(limcycle.CaseError, "path = None: must be the name of a case file"):
            limcycle.load(None)

    def test_a_measured_response_is_a_measured_plant(self):
        class FrequencyResponseData:  # as in python-control
            omega, dt = np.logspace(-1, 2, 80), None

            def __init__(self, shape):
                self.fresp = (1.0 / (1j * self.omega + 1.0) ** 3).reshape(shape)

        measured = limcycle.predict(relay_loop(plant=FrequencyResponseData((1, 1, 80))))
        known = limcycle.predict(relay_loop(plant=([1.0], [1.0, 3.0, 3.0, 1.0])))
        self.assertAlmostEqual(measured.predictions[0].frequency / known.predictions[0].frequency, 1.0, delta=1e-4)
        self.assertAlmostEqual(measured.cycles[0].period / known.cycles[0].period, 1.0, delta=1e-4)
        self.assertEqual(measured.case.measured[0].points, 80)
        with self.assertRaisesRegex(limcycle.CaseError, "one input and one output"):
            relay_loop(plant=FrequencyResponseData((2, 1, 40)))
        short = FrequencyResponseData((80,))
        short.fresp = short.fresp[:70]
        with self.assertRaisesRegex(limcycle.CaseError, "70 values at 80 frequencies.*a value at each"):
            relay_loop(plant=short)
        discrete = FrequencyResponseData((80,))
        discrete.dt = 0.01
        with self.assertRaisesRegex(limcycle.CaseError, "loop.plant.*continuous"):
            relay_loop(plant=discrete)

    def test_delay(self):
        loop = relay_loop(plant=([1.0], [1.0, 1.0]), delay=0.5)
        self.assertEqual(loop["loop.plant.delay"], 0.5)


class Loops(unittest.TestCase):
    def test_numbers_and_changes(self):
        loop = servo()
        self.assertEqual(loop["loop.controller.kd"], 6.0)
        changed = loop.set({"loop.controller.kd": np.float64(8.0)}).set({"loop.plant.mass": np.int64(2)})
        self.assertEqual((changed["loop.controller.kd"], changed["loop.plant.mass"]), (8.0, 2.0))
        self.assertEqual(loop["loop.controller.kd"], 6.0)
        self.assertEqual(changed.overrides, ["loop.controller.kd=8.0", "loop.plant.mass=2"])
        with self.assertRaises(KeyError):
            loop["loop.controller.k"]

    def test_every_shipped_case_is_read_and_sent(self):
        for file in sorted(os.listdir(os.path.dirname(case("pid-lugre")))):
            if file.endswith(".toml"):
                loop = limcycle.load(case(file[:-5]))
                again = pickle.loads(pickle.dumps(loop))
                self.assertEqual((again.text, again.numbers), (loop.text, loop.numbers), file)

    def test_a_diagram(self):
        loop = limcycle.Loop(diagram={
            "output": "axis.y", "reference": 0.0,
            "block": [{"name": "pid", "kind": "pid", "input": "r - axis.y", "kp": 3.0, "ki": 4.0, "kd": 6.0},
                      {"name": "axis", "kind": "mass", "input": "pid", "mass": 1.0},
                      {"name": "rub", **limcycle.laws.dahl(Fc=1.0, sigma0=1e4).to_table(), "on": "axis"}]})
        self.assertEqual(loop["diagram.axis.mass"], 1.0)

    def test_its_files_are_found_from_any_folder(self):
        source = Path(case("measured-axis")).parent
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(source)
        loop = limcycle.Loop(plant={"kind": "frf", "file": Path("measured-axis.csv"), "frequency": "Hz", "format": "re-im",
                                    "uncertainty": "coherence", "averages": 32}, friction=limcycle.laws.coulomb(Fc=8.0))
        records = limcycle.Loop(identify={"record": [{"kind": "lag", "file": "records/nothing.csv"}]})
        os.chdir("/")
        self.assertIn(str(source / "measured-axis.csv"), loop.set({"loop.friction.Fc": 9.0}).text)
        self.assertEqual(pickle.loads(pickle.dumps(loop)).text, loop.text)
        with self.assertRaisesRegex(limcycle.CaseError, str(source / "records/nothing.csv")):
            limcycle.identify(records)

    def test_a_law_and_a_case_keep_their_files_when_the_folder_changes(self):
        self.addCleanup(os.chdir, os.getcwd())
        with tempfile.TemporaryDirectory() as folder:
            for name, force in (("here", 1.0), ("there", 5.0)):
                os.makedirs(os.path.join(folder, name))
                with open(os.path.join(folder, name, "curve.csv"), "w", encoding="utf-8") as file:
                    file.write(f"velocity,force\n0.001,{1.2 * force}\n0.01,{force}\n0.1,{1.1 * force}\n")
            os.chdir(os.path.join(folder, "here"))
            law = limcycle.laws.stribeck(curve="table", file="curve.csv", Fs=1.5)
            with open("law.toml", "w", encoding="utf-8") as file:
                file.write(servo(friction=law).text.replace(os.path.join(os.getcwd(), "curve.csv"), "curve.csv"))
            loop, read = servo(friction=law), limcycle.load("law.toml")
            before = [limcycle.df(one, amplitude=[0.01], frequency=[1.0]).gain[0, 0, 0] for one in (law, loop, read)]
            os.chdir(os.path.join(folder, "there"))
            for one, gain in zip((law, loop.set({"loop.controller.kd": 6.5}), read.set({"loop.controller.kd": 6.5})), before):
                self.assertEqual(limcycle.df(one, amplitude=[0.01], frequency=[1.0]).gain[0, 0, 0], gain)
            os.chdir("/")

    def test_a_law_of_every_kind_that_a_loop_may_have(self):
        self.assertEqual(limcycle.laws.quantizer(step=0.1).to_table(), {"kind": "quantizer", "step": 0.1})
        servo(controller={"kind": "pid", "kp": 3.0}, error=limcycle.laws.quantizer(step=1e-4))

    def test_text_is_a_case_file(self):
        text = servo(title='a "quoted"\\ name\n\x7f', friction={"kind": "maxwell-slip", "k": np.array([1.0, 2.0]),
                                                                  "W": (0.5, 0.25)}).text
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "again.toml")
            with open(path, "w", encoding="utf-8", newline="") as file:
                file.write(text)
            self.assertEqual(limcycle.load(path).title, 'a "quoted"\\ name\n\x7f')


class Laws(unittest.TestCase):
    def test_every_kind_is_listed_and_explained(self):
        self.assertIn("elasto_plastic", dir(limcycle.laws))
        for kind in limcycle.laws.kinds():
            make = getattr(limcycle.laws, kind.replace("-", "_"))
            self.assertIn("Source:", make.__doc__)

    def test_a_key_that_is_a_word_of_python(self):
        law = limcycle.laws.xiong(Fs=1.5, Fc=1.0, vs=0.01, K=[1.0], sigma=[1.0], lambda_=[1.0], tau=0.1)
        self.assertEqual((law.to_table()["lambda"], law.lambda_), ((1.0,), (1.0,)))
        self.assertIn("lambda_=(1.0,)", repr(law))

    def test_parameters(self):
        law = limcycle.laws.coulomb(Fc=2.0, sigma2=None)
        self.assertEqual((law.Fc, law.to_table()), (2.0, {"kind": "coulomb", "Fc": 2.0}))
        self.assertEqual(repr(law), "coulomb(Fc=2.0)")
        self.assertEqual(pickle.loads(pickle.dumps(law)), law)
        with self.assertRaises(AttributeError):
            law.Fs

    def test_a_law_does_not_change(self):
        law = limcycle.laws.maxwell_slip(k=np.array([1.0, 2.0]), W=[0.5, 0.25])
        with self.assertRaisesRegex(AttributeError, "does not change"):
            law.k = [3.0, 2.0]
        with self.assertRaises(TypeError):
            law.parameters["k"] = [3.0, 2.0]
        with self.assertRaises(TypeError):
            law.k[0] = 3.0
        self.assertEqual(law, limcycle.laws.maxwell_slip(k=(1.0, 2.0), W=np.array([0.5, 0.25])))


if __name__ == "__main__":
    unittest.main()
