#!/usr/bin/env python3
"""AUTO-07p follows the limit cycle of the hunting servo over kd and that of van der Pol's oscillator over mu. CPU time per
point, without start-up: the time of a run of two points is taken off.
  auto_cycles.py AUTO_START WORK      lines "problem contender setting seconds-per-point parameter period" on stdout
AUTO_START is the program of that name; WORK a folder that may be filled."""
import os
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
LIBRARY = pathlib.Path(os.environ.get("AUTO_DIR", "/usr/lib/auto-07p")) / "lib"
# A converged start orbit, the analytic Jacobian, a new mesh every step.
CONSTANTS = """dat='{name}', NDIM={dimension}, IPS=2, IRS=0, ILP=0, ISP=0, ICP=[1,11],
NTST={mesh}, NCOL=4, IAD=1, ISW=1, NMX={points}, NPR=0, JAC=1, IID=2, ITMX=9, ITNW=7, NWTN=3,
EPSL=1e-9, EPSU=1e-9, EPSS=1e-7, DS={step}, DSMIN=1e-5, DSMAX={step}, IADS=1, RL0=1, RL1=50, THL={{11:0}}
"""
PROBLEMS = (
    {"name": "lugre", "orbit": "servo", "problem": "servo over kd", "dimension": 4, "points": 24, "step": 0.05,
     "meshes": (200, 400, 1000, 2000)},
    {"name": "vdp", "orbit": "van-der-pol", "problem": "van-der-pol over mu", "dimension": 2, "points": 41, "step": 0.11,
     "meshes": (30, 60, 120, 240)},
)


def build(problem, work, start):
    program = work / problem["name"]
    sources = [str(HERE / "auto" / name) for name in (problem["name"] + ".f90", "unused.f90")]
    objects = sorted(str(path) for path in LIBRARY.glob("*.o"))
    subprocess.run(["gfortran", "-O3", "-march=native", "-fopenmp", *sources, *objects, "-o", str(program)], check=True)
    with open(work / (problem["name"] + ".dat"), "w", encoding="ascii") as orbit:
        subprocess.run([start, problem["orbit"]], check=True, stdout=orbit)
    return program


def run(program, problem, mesh, points):
    """Least CPU time of five runs, and what the last one found: (parameter, period) of each point."""
    constants = CONSTANTS.format(**{**problem, "mesh": mesh, "points": points})
    least = float("inf")
    for _ in range(5):
        with subprocess.Popen([program], cwd=program.parent, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL, env={**os.environ, "OMP_NUM_THREADS": "1"}, text=True) as child:
            child.stdin.write(constants)
            child.stdin.close()
            _, _, usage = os.wait4(child.pid, 0)
            child.returncode = 0
        least = min(least, usage.ru_utime + usage.ru_stime)
    found = []
    for line in (program.parent / "fort.7").read_text(encoding="ascii").splitlines():
        words = line.split()
        if words[0] != "0":
            found.append((float(words[4]), float(words[-1])))
    return least, found


def main():
    start, work = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    work.mkdir(parents=True, exist_ok=True)
    for problem in PROBLEMS:
        program = build(problem, work, start)
        for mesh in problem["meshes"]:
            begin, _ = run(program, problem, mesh, 2)
            total, found = run(program, problem, mesh, problem["points"])
            if len(found) < problem["points"]:
                print(f"auto_cycles: {problem['problem']}: NTST={mesh} ended after {len(found)} points", file=sys.stderr)
            seconds = (total - begin) / max(1, len(found) - 2)
            for parameter, period in found:
                print(problem["problem"].replace(" ", "_"), "auto-07p", f"NTST={mesh}", f"{seconds:.6e}",
                      f"{parameter:.17g}", f"{period:.17g}")


main()
