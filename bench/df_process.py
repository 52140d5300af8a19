#!/usr/bin/env python3
"""`limcycle df` on a table of 200 x 200 points as a process, start and writing included.
  df_process.py LIMCYCLE CASE WORK"""
import os
import pathlib
import subprocess
import sys
import time

POINTS = 200 * 200


def measure(limcycle, case, work, accuracy, kind):
    """Least wall time of three runs, and the CPU time of that run, s."""
    target = work / f"table.{kind}"
    command = [limcycle, "df", case, "--set", "df.amplitude.points=200", "--set", "df.frequency.points=200", "--set",
               f"df.accuracy={accuracy}", f"--{kind}", str(target), "--quiet"]
    best = (float("inf"), 0.0)
    for _ in range(3):
        begin = time.perf_counter()
        with subprocess.Popen(command, stdout=subprocess.DEVNULL) as child:
            _, status, usage = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
        best = min(best, (time.perf_counter() - begin, usage.ru_utime + usage.ru_stime))
        if child.returncode != 0:
            raise SystemExit(f"df_process: limcycle df ended with {child.returncode}")
    return best


def main():
    limcycle, case, work = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3])
    for kind in ("csv", "json"):
        wall, cpu = measure(limcycle, case, work, 1e-6, kind)
        # Two rows: what a user waits, and what it cost.
        for what, seconds in (("wall", wall), ("CPU", cpu)):
            print(f"df,limcycle df --{kind} end to end,limcycle process,{what} of the table,-1,{seconds:.4e},{POINTS},",
                  flush=True)


main()
