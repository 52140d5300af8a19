#!/usr/bin/env python3
"""Tables and charts from the rows that the programs of bench/run print.
  table.py RESULT ROWS.csv...      prints the tables, writes RESULT.md and RESULT-*.svg"""
import collections
import csv
import math
import pathlib
import subprocess
import sys

import chart

Row = collections.namedtuple("Row", "part problem contender setting error seconds evaluations status")
OURS = "limcycle"
# A cycle of the servo is 0.064 m large: such an error is another motion, not the right one badly computed.
WRONG_MOTION = 0.02
# Times faster than limcycle must be, by the project's own goals: (problem, target) -> contender -> ratio.
GOALS = {
    ("sigma0=1e5", 1e-6): {"odeint rosenbrock4": 2.5, "odeint dopri5 dense": 14, "odeint dopri5 controlled": 14,
                           "cvode bdf": 12},
    ("sigma0=1e5", 1e-8): {"odeint rosenbrock4": 5, "odeint dopri5 dense": 10, "odeint dopri5 controlled": 10,
                           "cvode bdf": 18},
    ("table", 1e-6): {"odeint dopri5 + FFTW 3 periods": 7000, "odeint dopri5 + FFTW 3 periods one setting": 7000},
    ("random servos", 1e-6): {"limcycle one lane": 7}, ("random servos", 1e-8): {"limcycle one lane": 7},
    ("servo over kd", 1e-8): {"auto-07p": 1}, ("van-der-pol over mu", 1e-8): {"auto-07p": 1},
}


def read(paths):
    rows, references = [], []
    for path in paths:
        with open(path, encoding="utf-8") as lines:
            for words in csv.reader(lines):
                if words[0] == "reference":
                    references.append(words[1:])
                else:
                    part, problem, contender, setting, error, seconds, evaluations, status = words
                    rows.append(Row(part, problem, contender, setting, float(error), float(seconds), int(evaluations), status))
    return least_of_rounds(rows), references


def least_of_rounds(rows):
    """One row for each run, with the least time of all rounds: a machine that others use is slow for seconds on end."""
    least = collections.OrderedDict()
    for row in rows:
        key = row[:4]
        if key not in least or row.seconds < least[key].seconds:
            least[key] = row
    return list(least.values())


def grouped(rows, key):
    groups = collections.OrderedDict()
    for row in rows:
        groups.setdefault(key(row), []).append(row)
    return groups


def answers(rows):
    """(error, seconds) of the runs that gave an answer, loose to tight. An error of 0 is below the digits compared."""
    return [(max(row.error, 1e-16), row.seconds) for row in rows if row.error >= 0 and math.isfinite(row.error)]


def cost_at(rows, target):
    """Least cost of an error of `target`: runs that are at least as good, and between two neighbours of the ladder one of
    which is better and one worse the line through both in logarithms. None where no run is that good."""
    points = answers(rows)
    costs = [seconds for error, seconds in points if error <= target]
    for (e1, s1), (e2, s2) in zip(points, points[1:]):
        if min(e1, e2) < target < max(e1, e2):
            share = math.log(target / e1) / math.log(e2 / e1)
            costs.append(math.exp(math.log(s1) + share * math.log(s2 / s1)))
    return min(costs, default=None)


def nearest(rows, target):
    """The run whose error is nearest to the target, as "7.9 ms [4.5e-07]"."""
    points = answers(rows)
    if not points:
        return "no answer"
    error, seconds = min(points, key=lambda point: abs(math.log(point[0] / target)))
    return f"{milliseconds(seconds)} [{error:.1e}]"


def milliseconds(seconds):
    return f"{1e3 * seconds:.3g} ms" if seconds >= 1e-4 else f"{1e6 * seconds:.3g} µs"


def remarks(rows):
    found = []
    wrong = [row.setting for row in rows if row.part == "stepping" and row.error > WRONG_MOTION]
    if wrong:
        found.append(f"another motion at {', '.join(wrong)}")
    for status, group in grouped([row for row in rows if row.status], lambda row: row.status).items():
        settings = [row.setting for row in group]
        found.append(f"{status} at {settings[0]}" + (f" to {settings[-1]}" if len(settings) > 1 else ""))
    return "; ".join(found)


def table(head, body):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return lines + ["| " + " | ".join(str(cell) for cell in line) + " |" for line in body]


def comparison(problem, rows, targets, unit):
    """Cost at each target and ratio to limcycle, contender by contender."""
    contenders = grouped(sorted(rows, key=lambda row: row.contender != OURS), lambda row: row.contender)
    head, body = ["contender"], []
    for target in targets:
        head += [f"{unit} at {target:.0e}", "ratio (goal)", "nearest run [error]"]
    for name, runs in contenders.items():
        line = [f"**{name}**" if name.startswith(OURS) else name]
        for target in targets:
            cost, ours = cost_at(runs, target), cost_at(contenders.get(OURS, []), target)
            goal = GOALS.get((problem, target), {}).get(name)
            ratio = f"{cost / ours:.3g}" if cost and ours else "-"
            line += [milliseconds(cost) if cost else "not reached", ratio + (f" ({goal:g})" if goal else ""),
                     nearest(runs, target)]
        body.append(line + [remarks(runs)])
    return ["", f"### {problem}", ""] + table(head + ["remarks"], body)


def stepping(rows, charts):
    lines = ["## Time stepping", "", "Hunting servo from y = 1 for 244.37 s (ten periods at sigma0 = 1e5); error: largest "
             "|dx| in m over 200 equally spaced times. Ratio: times the cost of limcycle at the same true error."]
    problems = grouped(rows, lambda row: row.problem)
    for problem, group in problems.items():
        lines += comparison(problem, group, (1e-6, 1e-8), "CPU")
        if problem == "sigma0=1e5":
            charts["stepping"] = chart.lines("Hunting servo, sigma0 = 1e5 N/m: error against cost", "CPU time, ms",
                                             "largest error of position, m", error_against_cost(group, 1e3))
    over = {}
    for name, runs in grouped(rows, lambda row: row.contender).items():
        costs = [(float(problem.split("=")[1]), cost_at(group, 1e-8))
                 for problem, group in grouped(runs, lambda row: row.problem).items()]
        over[name] = [(sigma0, 1e3 * cost) for sigma0, cost in costs if cost]
    charts["stiffness"] = chart.lines("Cost of an error of 1e-8 m over stiffness", "sigma0, N/m", "CPU time, ms", over)
    base = dict(over.get(OURS, [])).get(1e5)
    if base:
        lines += ["", "limcycle's cost at 1e-8 against that at sigma0 = 1e5 (goal from 1e6 on: at most 2): "
                  + ", ".join(f"{sigma0:.0e}: {cost / base:.2f}" for sigma0, cost in over[OURS])]
    return lines


def error_against_cost(rows, scale):
    return {name: [(scale * seconds, error) for error, seconds in answers(runs) if error < 1]
            for name, runs in grouped(rows, lambda row: row.contender).items()}


def describing_functions(rows, charts):
    lines = ["## Describing functions", "", "LuGre friction, amplitudes 1e-6..1e-1 m, frequencies 0.1..1000 rad/s; error: "
             "largest relative error of N. limcycle: all 40,000 points of a table, one thread. Plain programs: 25 points "
             "spread over the same range, each with the setting that is cheapest for it and without those that no setting "
             "solves, which flatters them; or all with the one setting that solves the most."]
    for target in (1e-6, 1e-9):
        rates = []
        for name, runs in grouped([row for row in rows if row.problem == "200 x 200 table"], lambda row: row.contender).items():
            good = [row for row in runs if 0 <= row.error <= target]
            if good:
                best = min(good, key=lambda row: row.seconds)
                rates.append((name, 1 / best.seconds, best.error, f"all points, {best.setting}"))
        for row in rows:
            if row.problem == f"25 points to {target:.1e}" and row.evaluations:
                rates.append((row.contender, 1 / row.seconds, row.error, f"{row.status}, {row.setting}"))
        ours = next((rate for name, rate, _, _ in rates if name == OURS), None)
        body = []
        for name, rate, error, remark in rates:
            goal = GOALS.get(("table", target), {}).get(name)
            body.append([f"**{name}**" if name.startswith(OURS) else name, f"{rate:.3g}",
                         (f"{ours / rate:.3g}" if ours else "-") + (f" ({goal})" if goal else ""), f"{error:.1e}", remark])
        lines += ["", f"### To {target:.0e}", ""] + table(["contender", "points/s", "limcycle is times faster (goal)",
                                                         "largest error", "solved"], body)
        if rates:
            charts[f"df-{target:.0e}"] = chart.bars(
                f"Describing functions of LuGre friction to {target:.0e}", "points per second and core",
                [(name, rate, f"{rate:.3g}" if rate < 1000 else f"{rate:,.0f}") for name, rate, _, _ in rates])
    unsolved = grouped([row for row in rows if row.problem.startswith("point ") and row.status], lambda row: row.contender)
    for name, group in unsolved.items():
        lines += ["", f"{name} cannot solve: " + "; ".join(row.problem.removeprefix("point ") for row in group) + "."]
    laws = [row for row in rows if row.problem.startswith("laws to")]
    if laws:
        lines += ["", "### Other laws to 1e-06", "", "40 x 40 points of the same range, parameters of the presets; what no "
                  "kernel answers goes by quadrature.", ""]
        base = next((row.seconds for row in laws if row.setting == "lugre"), math.nan)
        lines += table(["law", "points/s", "cost against LuGre (goal: 5)", "by a kernel, of 1600", "largest error stated"],
                       [[row.setting, f"{1 / row.seconds:.3g}", f"{row.seconds / base:.3g}", row.evaluations,
                         f"{row.error:.1e}"] for row in laws])
    threads = [row for row in rows if row.problem == "threads"]
    if len(threads) == 2:
        lines += ["", f"Two threads at accuracy 1e-9: {threads[0].seconds / threads[1].seconds:.2f} times one in wall time "
                  "(goal: 1.8)."]
    ends = [row for row in rows if "end to end" in row.problem]
    if ends:
        lines += ["", "### As a process", "", "`limcycle df` at accuracy 1e-6, start, harmonics and writing included "
                  "(goal: 0.15 s).", ""]
        lines += table(["what", "time", "s"], [[row.problem, row.setting, f"{row.seconds:.3f}"] for row in ends])
    return lines


def cycles(rows, charts):
    lines = ["## Cycles", "", "Error: relative error of the period, the largest over the branch. Time: CPU per cold start, or "
             "per point of a branch. limcycle's points carry multipliers and error estimates; AUTO-07p was asked for none. "
             "Start-up of AUTO-07p is taken off, and its points before the mesh has adapted are not judged."]
    for problem, group in grouped(rows, lambda row: row.problem).items():
        lines += comparison(problem, group, (1e-6, 1e-8, 1e-10), "CPU")
        if "cold" not in problem:
            charts["cycles-" + problem.split()[0]] = chart.lines(
                f"Following a limit cycle: {problem}", "CPU time per point, ms", "relative error of the period",
                error_against_cost(group, 1e3))
    return lines


def lane_gain(rows):
    one = {row.setting: row.seconds for row in rows if row.contender == OURS + " one lane"}
    gains = []
    for name, runs in grouped(rows, lambda row: row.contender).items():
        ratios = [one[row.setting] / row.seconds for row in runs if row.setting in one]
        if name.startswith(OURS) and "one" not in name and ratios:
            gains.append(f"{name} {min(ratios):.2f} to {max(ratios):.2f}")
    return ", ".join(gains) + "."


def ensembles(rows, charts):
    lines = ["## Ensembles", "", "Random servos from y = 1 for 250 s; error: largest |dx| in m at the end, over the first "
             "loops that all contenders ran. Time per loop. limcycle marches them in the lanes of the best instruction set; "
             "beside it those of others, one lane, and the stepper of single runs."]
    for problem, group in grouped(rows, lambda row: row.problem).items():
        lines += comparison(problem, group, (1e-6, 1e-8), "CPU")
        lines += ["", "Against one lane at the same tolerance (goal: 7 with AVX-512, 3.4 with AVX2): " + lane_gain(group)]
        charts["ensembles"] = chart.lines("Random servos, 250 s each", "CPU time per loop, ms", "largest error of position, m",
                                          error_against_cost(group, 1e3))
    return lines


def told(command):
    done = subprocess.run(command, shell=True, capture_output=True, text=True, check=False)
    return done.stdout.strip().splitlines()[0] if done.stdout.strip() else "?"


def circumstances(references):
    packages = ("libboost1.74-dev", "libsundials-dev", "libgsl-dev", "libfftw3-dev", "auto-07p", "python3-scipy")
    versions = ", ".join(f"{name} {told(f'dpkg-query -W -f=${{Version}} {name}'.replace('${', chr(92) + '${'))}"
                         for name in packages)
    lines = ["- machine: " + told("lscpu | sed -n 's/^Model name: *//p'") + ", " + told("nproc") + " cores, "
             + told("uname -sr"),
             "- compiler: " + told("g++ --version"),
             "- flags of limcycle: those of the release preset (-O2 -DNDEBUG -ffp-contract=off, portable x86-64)",
             "- flags of the peers: -O3 -march=native -DNDEBUG; AUTO-07p: its equations -O3 -march=native, its library as packaged",
             "- peers: " + versions,
             "- limcycle: commit " + told("git rev-parse --short HEAD")
             + (" with changes" if told("git status --porcelain --untracked-files=no") != "?" else ""),
             "- times: CPU, the least of the repeats and rounds of this run"]
    return lines + [f"- reference: {': '.join(words[:2])}: {words[2]}" if len(words) > 2 else "- reference: " + ": ".join(words)
                    for words in references]


def main():
    result = pathlib.Path(sys.argv[1])
    rows, references = read(sys.argv[2:])
    charts = {}
    lines = [f"# bench/run, {result.name}", ""] + circumstances(references)
    for part, tell in (("stepping", stepping), ("df", describing_functions), ("cycles", cycles), ("ensembles", ensembles)):
        group = [row for row in rows if row.part == part]
        if group:
            lines += [""] + tell(group, charts)
    print("\n".join(lines))
    result.parent.mkdir(parents=True, exist_ok=True)
    for name, svg in charts.items():
        path = result.parent / f"{result.name}-{name}.svg"
        path.write_text(svg, encoding="utf-8")
        lines += ["", f"![{name}]({path.name})"]
    (result.parent / f"{result.name}.md").write_text("\n".join(lines) + "\n", encoding="utf-8")


main()
