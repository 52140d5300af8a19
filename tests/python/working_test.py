"""While it works: interrupts, threads, progress, time limits, memory."""

import gc
import io
import os
import resource
import signal
import subprocess
import sys
import threading
import time
import unittest
import unittest.mock

import limcycle
import numpy as np
from common import case, document, relay_loop, servo

LONG = (("loop.controller.kd", 1.0, 50.0, 100), ("loop.controller.kp", 1.0, 50.0, 100))  # minutes


class WhileItWorks(unittest.TestCase):
    def test_an_interrupt_ends_it(self):
        script = ("import limcycle, sys\nloop = limcycle.load(sys.argv[1])\nprint('begin', flush=True)\n"
                  f"try:\n    limcycle.map(loop, *{LONG!r})\nexcept KeyboardInterrupt:\n    print('interrupted')\n")
        with subprocess.Popen([sys.executable, "-c", script, case("pid-lugre")], stdout=subprocess.PIPE, text=True) as run:
            self.assertEqual(run.stdout.readline(), "begin\n")
            time.sleep(0.3)
            run.send_signal(signal.SIGINT)
            self.assertEqual(run.communicate(timeout=60)[0], "interrupted\n")
            self.assertEqual(run.returncode, 0)

    def test_other_threads_go_on(self):
        loop = limcycle.load(case("pid-lugre"))
        other = threading.Thread(target=lambda: limcycle.map(loop, *LONG, time_limit=2.0))
        other.start()
        turns = 0
        while other.is_alive():  # two seconds; with the lock held there would be one turn
            time.sleep(1e-3)
            turns += 1
        self.assertGreater(turns, 10)

    def test_several_threads_may_ask(self):
        expected = limcycle.predict(relay_loop()).to_dict()
        answers = [None] * 4

        def ask(k):
            answers[k] = limcycle.predict(relay_loop()).to_dict()

        threads = [threading.Thread(target=ask, args=(k,)) for k in range(4)]
        for one in threads:
            one.start()
        for one in threads:
            one.join()
        self.assertEqual(answers, [expected] * 4)

    def test_progress_is_reported(self):
        seen = []
        limcycle.predict(servo(), progress=lambda fraction, what: seen.append((fraction, what)))
        self.assertEqual(seen[-1], (1.0, "done"))
        self.assertTrue(all(0.0 <= fraction <= 1.0 and what for fraction, what in seen))

    def test_a_bar_of_tqdm(self):
        with unittest.mock.patch("sys.stderr", new=io.StringIO()) as shown:
            limcycle.map(limcycle.load(case("pid-lugre")), ("loop.controller.kp", 1.0, 5.0, 2),
                         ("loop.controller.ki", 0.0, 4.0, 2), progress=True)
            gc.collect()
        self.assertIn("%|", shown.getvalue())
        with unittest.mock.patch.dict(sys.modules, {"tqdm.auto": None}):
            with self.assertRaisesRegex(limcycle.CaseError, "progress.*tqdm"):
                limcycle.predict(servo(), progress=True)
        limcycle.predict(servo(), progress=False)

    def test_an_exception_of_progress_ends_it(self):
        def refuse(fraction, what):
            raise LookupError(what)

        with self.assertRaises(LookupError):
            limcycle.map(limcycle.load(case("pid-lugre")), *LONG, progress=refuse)

    def test_a_time_limit_keeps_what_there_is(self):
        result = limcycle.map(limcycle.load(case("pid-lugre")), *LONG, time_limit=0.5)
        self.assertEqual(result.status, "time-limit")
        self.assertLess(result.known, 10000)
        self.assertIn(None, result.points)

    def test_the_number_of_threads_does_not_matter(self):
        def points(threads):
            return limcycle.df(limcycle.load(case("df-lugre")), threads=threads).to_dict()["points"]

        self.assertEqual(points(1), points(3))

    def test_what_a_method_cannot_handle(self):
        with self.assertRaisesRegex(limcycle.NoAnswer, "this case is valid, but could not be computed: .*stepper exact"):
            limcycle.simulate(limcycle.load(case("pid-lugre"), {"simulate.stepper": "exact"}))


class Costs(unittest.TestCase):
    def test_numpy_and_matplotlib_are_loaded_when_they_are_needed(self):
        script = "import sys, limcycle; print({'numpy', 'matplotlib', 'scipy', 'control'} & set(sys.modules))"
        self.assertEqual(subprocess.run([sys.executable, "-c", script], capture_output=True, text=True).stdout, "set()\n")

    def test_memory_is_flat(self):
        loop = relay_loop(df={"amplitude": [1.0], "frequency": [1.0]})

        def ask(times):
            for _ in range(times):
                limcycle.df(loop, threads=1).gain
            gc.collect()
            with open("/proc/self/statm", encoding="ascii") as file:
                return int(file.read().split()[1]) * resource.getpagesize()

        before = ask(500)
        self.assertLess(ask(10000) - before, 2_000_000)  # a leak of 200 bytes a call would show

    def test_memory_is_flat_with_threads(self):
        law = limcycle.laws.relay(level=1.0)

        def ask(times):
            for _ in range(times):
                limcycle.df(law, [1.0, 2.0], [1.0], threads=2).gain
            gc.collect()
            with open("/proc/self/statm", encoding="ascii") as file:
                return int(file.read().split()[1]) * resource.getpagesize()

        before = ask(500)
        self.assertLess(ask(2000) - before, 2_000_000)  # arenas of threads that are not kept would cost 12 kB a call


if __name__ == "__main__":
    unittest.main()
