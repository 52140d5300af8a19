"""Figures of the results, with Matplotlib."""

from __future__ import annotations

import io
import shutil
from itertools import groupby
from typing import Any, List, Optional, Sequence, Tuple

import matplotlib.pyplot as plt  # type: ignore[import]
import numpy as np

from . import _results

COLOURS = {"rest": "#7fb3d5", "cycle": "#d35400", "sliding": "#a9dfbf", "divergence": "#922b21", "family": "#af7ac5",
           "irregular": "#f4d03f", "undecided": "#bfc9ca"}


def _axes(ax: Any) -> Any:
    return plt.subplots()[1] if ax is None else ax


def save(result: Any, path: Any) -> None:
    """The figure of result.plot(), in a file."""
    if str(path).endswith(".pgf") and shutil.which(plt.rcParams["pgf.texsystem"]) is None:
        raise ValueError(f"PGF needs {plt.rcParams['pgf.texsystem']} of LaTeX, which is not installed: save .pdf or .png")
    _draw(result, path)


def svg(result: Any) -> str:
    """The same as SVG; empty where there is nothing to draw."""
    drawn = io.StringIO()
    try:
        _draw(result, drawn, format="svg", metadata={"Date": None})
    except ValueError:
        return ""
    return drawn.getvalue()[drawn.getvalue().find("<svg"):]


def _draw(result: Any, into: Any, **how: Any) -> None:
    """result.plot(), written to a file; no figure stays open."""
    before = set(plt.get_fignums())
    try:
        np.ravel(result.plot())[0].figure.savefig(into, bbox_inches="tight", **how)
    finally:
        for number in set(plt.get_fignums()) - before:
            plt.close(number)


def _window(ax: Any, points: Sequence[complex]) -> None:
    """Shows the surroundings of some points, with the origin."""
    radius = 1.6 * max((abs(one) for one in points), default=1.0)
    ax.set_xlim(-radius, 0.6 * radius)
    ax.set_ylim(-0.8 * radius, 0.8 * radius)
    ax.axhline(0.0, color="grey", linewidth=0.5)
    ax.axvline(0.0, color="grey", linewidth=0.5)
    ax.set_xlabel("real")
    ax.set_ylabel("imaginary")


def nyquist(result: _results.Prediction, ax: Any) -> Any:
    ax = _axes(ax)
    curves = result.nyquist
    frequency, G, family = curves["frequency"], curves["G"], curves["minus_inverse_N"]
    ax.plot(G.real, G.imag, color="C0", label="G(jw)")
    for k, member in enumerate(family):
        ax.plot(member.real, member.imag, color="C1", linewidth=1.5 if len(family) == 1 else 0.7,
                label="-1/N(A)" if k == 0 else None)
    met: List[complex] = []
    for k, one in enumerate(result.predictions):
        if not len(frequency) or not frequency[0] <= one.frequency <= frequency[-1]:
            continue
        if one.method == "composite-describing-function":  # has a linear part of its own
            continue
        at = complex(np.interp(one.frequency, frequency, G.real), np.interp(one.frequency, frequency, G.imag))
        met.append(at)
        ax.plot(at.real, at.imag, "o", color="C3" if one.stable else "C7")
        ax.annotate(f"{one.amplitude:.3g}, {one.frequency:.3g} rad/s", (at.real, at.imag),
                    textcoords="offset points", xytext=(6, 6 + 11 * (k % 3)), fontsize="small")
    inside = np.abs(family[np.isfinite(family)]) if family.size else np.abs(G)
    _window(ax, met or [np.median(inside) if inside.size else 1.0])
    ax.legend(loc="best", fontsize="small")
    ax.set_title("Describing function", fontsize="medium")
    return ax


def inverse_gain(result: _results.DescribingFunctions, ax: Any) -> Any:
    ax = _axes(ax)
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = -1.0 / result.gain
    for k, w in enumerate(result.frequency):
        for m, bias in enumerate(result.bias):
            curve = inverse[:, k, m]
            name = f"{w:.3g} rad/s" + (f", bias {bias:.3g}" if len(result.bias) > 1 else "")
            ax.plot(curve.real, curve.imag, marker="." if len(curve) < 30 else None, label=name)
    ax.set_xlabel("real of -1/N")
    ax.set_ylabel("imaginary of -1/N")
    if len(result.frequency) * len(result.bias) <= 8:
        ax.legend(fontsize="small")
    return ax


def run(result: _results.Simulation, ax: Any, columns: Optional[Sequence[str]]) -> Any:
    names = list(columns) if columns is not None else [one for one in result.columns if one != "t"][:6]
    axes = plt.subplots(len(names), 1, sharex=True, squeeze=False)[1][:, 0] if ax is None else np.atleast_1d(ax)
    if len(axes) != len(names):
        raise ValueError(f"{len(names)} columns need as many axes, found {len(axes)}: choose with columns=[...]")
    for one, name in zip(axes, names):
        one.plot(result["t"], result[name])
        one.set_ylabel(name)
    axes[-1].set_xlabel("t [s]")
    return axes if ax is None or len(axes) > 1 else axes[0]


def _part(point: _results.Record) -> int:
    return int(point.part)


def branches(result: _results.Continuation, ax: Any, quantity: str) -> Any:
    ax = _axes(ax)
    for _, part in groupby(result.branch, _part):
        points = list(part)
        begin = 0
        for k in range(1, len(points) + 1):
            if k < len(points) and points[k].stable == points[begin].stable:
                continue
            piece = points[begin:k + 1]  # to the first point of the next piece, so that no gap is drawn
            ax.plot([one.parameter for one in piece], [one[quantity] for one in piece], color="C0",
                    linestyle={True: "-", False: "--"}.get(points[begin].stable, ":"))
            begin = k
    for event in result.events:
        if quantity in event and event[quantity] is not None:
            ax.plot(event.parameter, event[quantity], "s" if event.type == "fold" else "o", color="C3", markersize=5)
    unit = result.parameter.unit
    ax.set_xlabel(result.parameter.path + (f" [{unit}]" if unit not in (None, "", "1") else ""))
    ax.set_ylabel(quantity)
    return ax


def margins(result: _results.Margin, ax: Any) -> Any:
    ax = _axes(ax)
    names = []
    for row, one in enumerate(reversed(result.parameters)):
        names.append(one.name)
        for side, limit in ((one.up, result.factor), (one.down, 1.0 / result.factor)):
            ends = side.value is not None and side.value / one.value > 0.0
            factor = side.value / one.value if ends else limit
            ax.plot([1.0, factor], [row, row], color="C0", linewidth=4, solid_capstyle="butt", alpha=0.7)
            if ends:
                ax.plot(factor, row, "|", color="C3" if side.hunting == "begins" else "C2", markersize=12)
    ax.set_xscale("log")
    ax.axvline(1.0, color="grey", linewidth=0.5)
    ax.set_yticks(range(len(names)), names, fontsize="small")
    ax.set_xlabel("factor on the parameter; red: hunting begins, green: it ends")
    return ax


def outcomes(result: _results.Map, ax: Any) -> Any:
    from matplotlib.colors import ListedColormap  # type: ignore[import]
    from matplotlib.patches import Patch  # type: ignore[import]

    ax = _axes(ax)
    x, y = result.x["values"], result.y["values"]
    words = [one.happens if one is not None else "not computed" for one in result.points]
    kinds = list(dict.fromkeys(words))
    image = np.array([kinds.index(one) for one in words]).reshape(len(y), len(x))
    palette = [_colour(kind) for kind in kinds]
    ax.pcolormesh(x, y, image, cmap=ListedColormap(palette), vmin=-0.5, vmax=len(kinds) - 0.5, shading="nearest")
    for side, scale in ((result.x, ax.set_xscale), (result.y, ax.set_yscale)):
        if side.logarithmic and min(side["values"]) > 0.0:
            scale("log")
    ax.set_xlabel(result.x.parameter)
    ax.set_ylabel(result.y.parameter)
    ax.legend(handles=[Patch(color=colour, label=kind) for colour, kind in zip(palette, kinds)], fontsize="small")
    return ax


def _colour(words: str) -> Any:
    """The mean colour of the outcomes that are possible."""
    from matplotlib.colors import to_rgb

    parts = [COLOURS.get("cycle" if one == "hunting" else one, "#ffffff") for one in words.split(" or ")]
    return tuple(np.mean([to_rgb(one) for one in parts], axis=0))


def _size(one: Tuple[str, float]) -> float:
    return abs(one[1])


def elasticities(result: _results.Sensitivity, ax: Any, output: str) -> Any:
    ax = _axes(ax)
    known = [(one.name, one.elasticity[output]) for one in result.parameters if one.elasticity[output] is not None]
    known.sort(key=_size)
    ax.barh([name for name, _ in known], [value for _, value in known], color="C0")
    ax.axvline(0.0, color="grey", linewidth=0.5)
    ax.tick_params(axis="y", labelsize="small")
    ax.set_xlabel(f"% of {output} for each % of the parameter")
    return ax


def counterexample(result: _results.Dissipativity, ax: Any) -> Any:
    found = result.counterexample
    if found is None:
        raise ValueError(f"there is no counter-example to draw: passive is {result.passive}")
    ax = _axes(ax)
    ax.plot(found.time, found.velocity)
    ax.set_xlabel("t [s]")
    ax.set_ylabel("velocity [m/s]")
    ax.set_title(f"gives {found.energy_per_cycle:.4g} J each cycle", fontsize="medium")
    return ax


def remedies(result: _results.Remedies, ax: Any, cost: str) -> Any:
    ax = _axes(ax)
    found = [("as it is", result.now[cost])] + [(one.name, one.costs[cost]) for one in result.remedies if one.ends]
    known = [(name, float(np.max(np.abs(value)))) for name, value in reversed(found) if value is not None]
    if not known:
        raise ValueError(f"the cost {cost} is not known for any remedy that ends hunting")
    ax.barh([name for name, _ in known], [value for _, value in known], color="C0")
    ax.tick_params(axis="y", labelsize="small")
    ax.set_xlabel(cost.replace("_", " "))
    return ax


def searched(result: _results.Tuning, ax: Any) -> Any:
    ax = _axes(ax)
    two = len(result.numbers) > 1
    for outcome, colour in (("not-judged", "lightgrey"), ("hunts", "C3"), ("feasible", "C0")):
        points = [one for one in result.points if one.outcome == outcome and (two or one[result.minimise] is not None)]
        ax.plot([one.values[0] for one in points],
                [one.values[1] if two else one[result.minimise] for one in points], ".", color=colour,
                label={"feasible": "does not hunt", "not-judged": "not judged"}.get(outcome, outcome))
    if result.best is not None:
        best = result.points[result.best]
        ax.plot([best.values[0]], [best.values[1] if two else best[result.minimise]], "o", color="black",
                fillstyle="none", label="best")
    ax.set_xlabel(result.numbers[0].parameter)
    ax.set_ylabel(result.numbers[1].parameter if two else result.minimise)
    ax.legend(fontsize="small")
    return ax


def intervals(result: _results.Identification, ax: Any) -> Any:
    laws = [one for one in result.laws if one.kind == result.chosen]
    known = [one for law in laws for one in law.parameters if one.identifiable and one.value and None not in (one.low, one.high)]
    if not known:
        raise ValueError("no law was chosen, or its numbers are not determined")
    ax = _axes(ax)
    for row, one in enumerate(reversed(known)):
        ax.plot([one.low / one.value, one.high / one.value], [row, row], color="C0", linewidth=4, solid_capstyle="butt")
    ax.axvline(1.0, color="grey", linewidth=0.5)
    ax.set_yticks(range(len(known)), [f"{one.name} = {one.value:.4g}" for one in reversed(known)], fontsize="small")
    ax.set_xlabel("95 % interval over the value")
    ax.set_title(result.chosen, fontsize="medium")
    return ax
