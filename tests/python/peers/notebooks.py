"""Runs the notebooks of examples/notebooks as scripts; with --fix their figures in docs/notebooks are drawn anew."""

import contextlib
import io
import runpy
import sys
import warnings
from pathlib import Path
from xml.etree import ElementTree

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

SOURCES = Path(__file__).resolve().parents[3]
NOTEBOOKS = SOURCES / "examples" / "notebooks"
FIGURES = SOURCES / "docs" / "notebooks"
STYLE = {"figure.figsize": (6.0, 4.0), "font.size": 9.0, "svg.fonttype": "none", "svg.hashsalt": "limcycle",
         "axes.unicode_minus": False}


def names():
    return sorted(path.stem for path in NOTEBOOKS.glob("*.py"))


def run(name):
    """The names that a notebook leaves, what it prints, and its figures as SVG by their file names."""
    plt.close("all")
    printed = io.StringIO()
    with matplotlib.rc_context(STYLE), contextlib.redirect_stdout(printed), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "FigureCanvasAgg is non-interactive|Matplotlib is currently using agg")
        left = runpy.run_path(str(NOTEBOOKS / f"{name}.py"))
        figures = {f"{name}-{k}.svg": drawn(plt.figure(number)) for k, number in enumerate(plt.get_fignums(), 1)}
    plt.close("all")
    return left, printed.getvalue(), figures


def drawn(figure):
    figure.tight_layout()
    file = io.StringIO()
    figure.savefig(file, format="svg", metadata={"Date": None, "Creator": None})
    return file.getvalue()


def words(svg):
    """The texts of a picture, which do not depend on rounding."""
    root = ElementTree.fromstring(svg)
    return ["".join(node.itertext()).strip() for node in root.iter("{http://www.w3.org/2000/svg}text")]


if __name__ == "__main__":
    if sys.argv[1:] != ["--fix"]:
        sys.exit("usage: tools/notebooks --fix")
    FIGURES.mkdir(exist_ok=True)
    for file in FIGURES.glob("*.svg"):
        file.unlink()
    for notebook in names():
        for file_name, picture in run(notebook)[2].items():
            (FIGURES / file_name).write_text(picture, encoding="utf-8")
            print(f"docs/notebooks/{file_name}")
