"""Documents of the program in HDF5, read by h5py, against the same in JSON; MAT-files of SciPy; PDF. Called by
tools/exchange with the program and a folder, which then holds what the test in Octave reads."""

import json
import math
import re
import subprocess
import sys
from pathlib import Path

import h5py
import numpy
import scipy.io

PROGRAM, WORK = sys.argv[1], Path(sys.argv[2])
CASES = Path(__file__).resolve().parents[2] / "cases"
SERVO = CASES / "pid-lugre.toml"
QUESTIONS = {
    "predict": ["predict", SERVO],
    "predict-none": ["predict", SERVO, "--set", "loop.controller.ki=0.0"],
    "predict-sampled": ["predict", SERVO, "--set", "loop.controller.sample_time=0.01", "--time-limit", "2"],
    "check": ["check", CASES / "gantry-axis.toml"],
    "df": ["df", SERVO, "--set", "df.harmonics=3"],
    "simulate": ["simulate", SERVO],
    "continue": ["continue", SERVO, "--parameter", "loop.controller.ki=4:3"],
    "margin": ["margin", SERVO, "--parameter", "loop.controller.ki"],
    "map": ["map", SERVO, "--x", "loop.controller.kp=1:5:3", "--y", "loop.controller.ki=0:4:2"],
    "sensitivity": ["sensitivity", SERVO, "--samples", "16"],
    "dissipativity": ["dissipativity", SERVO],
    "remedy": ["remedy", SERVO, "--only", "gain-ki", "--samples", "0"],
    "identify": ["identify", CASES / "records" / "servo.toml"],
    "experiment": ["experiment", "pre-sliding", "--law", "dahl"],
    "claims": ["claims", "A1"],
    "laws": ["laws"],
}


def ask(*words, code=(0,)):
    made = subprocess.run([PROGRAM, *map(str, words), "--quiet"], capture_output=True, text=True, check=False)
    assert made.returncode in code, (words, made.returncode, made.stderr)
    return made


def same(value, node, index=()):
    """A value of the JSON document against the row `index` of what stands in the file."""
    if isinstance(value, dict):
        for key, one in value.items():
            same(one, node[key.replace("/", "_")], index)
    elif isinstance(value, list) and value and all(isinstance(one, dict) for one in value):
        if index:
            node, index = node[str(index[0])], ()
        assert node.attrs["rows"] == len(value), node.name
        for i, one in enumerate(value):
            same(one, node, (i,))
    elif isinstance(value, list):
        if isinstance(node, h5py.Group):  # of texts, or of objects, of which this row has none
            node, index = node[str(index[0])], ()
            if isinstance(node, h5py.Group):
                assert not value and node.attrs["rows"] == 0, node.name
                return
        assert node.shape[len(index)] >= len(value), node.name
        for i, one in enumerate(value):
            same(one, node, (*index, i))
        rest = node[index][len(value):]
        assert all(one in (b"", "") for one in rest.ravel()) if rest.dtype.kind == "S" else numpy.isnan(rest).all(), node.name
    elif value is None and isinstance(node, h5py.Group):
        for name in node:
            same(None, node[name], index)
    else:
        same_scalar(value, node, index)


def same_scalar(value, node, index):
    found = node[index]
    if value is None:
        found = numpy.asarray(found)
        assert (found == b"").all() if found.dtype.kind == "S" else numpy.isnan(found).all(), node.name
    elif isinstance(value, str):
        assert found.decode() == value, (node.name, found, value)
    elif isinstance(found, bytes):  # a number among texts
        assert json.loads(found) == value, node.name
    else:
        assert float(found) == float(value), (node.name, found, value)


def documents():
    for name, words in QUESTIONS.items():
        ask(*words, "--json", WORK / f"{name}.json", "--hdf5", WORK / f"{name}.h5", code=(0, 3))
        document = json.loads((WORK / f"{name}.json").read_text())
        with h5py.File(WORK / f"{name}.h5") as file:
            assert set(file) == set(document), name
            same(document, file)
    print(f"exchange: {len(QUESTIONS)} documents in HDF5: equal to JSON by h5py")


def plants():
    """The servo's plant from a MAT-file, in each version that SciPy writes, is that of the case."""
    (WORK / "mat.toml").write_text("""[loop]
plant = {kind = "state-space", file = "plant.mat"}
controller = {kind = "pid", kp = 3.0, ki = 4.0, kd = 6.0}
friction = {kind = "lugre", Fs = 1.5, Fc = 1.0, vs = 0.001, sigma0 = 1e5, sigma1 = 316.22776601683796, sigma2 = 0.4}
""")
    matrices = {"A": [[0.0, 1.0], [0.0, 0.0]], "B": [[0.0], [1.0]], "C": [[1.0, 0.0]]}
    periods = []
    for version, packed in (("4", False), ("5", False), ("5", True)):
        scipy.io.savemat(WORK / "plant.mat", {name: numpy.array(rows) for name, rows in matrices.items()}, format=version,
                         do_compression=packed)
        ask("predict", WORK / "mat.toml", "--json", WORK / "mat.json")
        document = json.loads((WORK / "mat.json").read_text())
        assert document["case"]["matrices"][0]["variables"] == ["A", "B", "C"]
        periods.append(document["cycles"][0]["period"])
    known = json.loads((WORK / "predict.json").read_text())["cycles"][0]["period"]
    assert all(math.isclose(one, known, rel_tol=1e-7) for one in periods), (periods, known)
    print("exchange: plants from MAT-files of SciPy: the same cycle")


def papers():
    ask("predict", SERVO, "-o", WORK / "a.pdf")
    ask("predict", SERVO, "--svg", WORK / "b.pdf", "--tex", WORK / "a.tex")
    pdf = (WORK / "a.pdf").read_bytes()
    assert pdf.startswith(b"%PDF-") and pdf == (WORK / "b.pdf").read_bytes() and b"%%EOF" in pdf[-16:]
    tex = (WORK / "a.tex").read_text()
    assert tex.count(r"\begin{tabular}") == tex.count(r"\end{tabular}") == tex.count(r"\caption{") >= 3
    for rows in re.findall(r"\\toprule\n(.*?)\\bottomrule", tex, re.S):
        counts = {len(re.findall(r"(?<!\\)&", line)) for line in rows.splitlines() if line.endswith("\\\\")}
        assert len(counts) == 1, rows
    print("exchange: picture as PDF, the same bytes each time; tables as LaTeX")


documents()
plants()
papers()
