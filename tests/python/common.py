"""What several tests of the Python module need. The environment names the sources and the program."""

import json
import os
import subprocess
from pathlib import Path

import limcycle

SOURCES = Path(os.environ["LIMCYCLE_SOURCE_DIR"])
PROGRAM = os.environ["LIMCYCLE_PROGRAM"]


def case(name: str) -> str:
    return str(SOURCES / "cases" / f"{name}.toml")


def document(*words: str) -> dict:
    """The JSON document of the program."""
    run = subprocess.run([PROGRAM, *words, "--json", "-", "--quiet"], capture_output=True, text=True, check=False)
    return json.loads(run.stdout)


def relay_loop(**changes) -> limcycle.Loop:
    """The textbook loop whose limit cycle is known exactly."""
    parts = {"plant": ([1.0], [1.0, 3.0, 3.0, 1.0]), "element": limcycle.laws.relay(level=1.0),
             "search": {"amplitude": [1e-3, 10.0], "frequency": [0.01, 100.0]}}
    return limcycle.Loop(**{**parts, **changes})


def servo(**changes) -> limcycle.Loop:
    """A servo that hunts on LuGre friction, from dictionaries."""
    parts = {"plant": {"kind": "mass", "mass": 1.0}, "controller": {"kind": "pid", "kp": 3.0, "ki": 4.0, "kd": 6.0},
             "friction": limcycle.laws.lugre(Fs=1.5, Fc=1.0, vs=0.001, sigma0=1e5, sigma1=316.22776601683796, sigma2=0.4)}
    return limcycle.Loop(**{**parts, **changes})
