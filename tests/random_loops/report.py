"""The table at the end: outcomes by family, times, disagreements."""

import statistics

KINDS = ("right", "undecided", "wrong", "missed", "late", "failed")
BAD = ("wrong", "missed", "failed")


class Table:
    """Collects verdicts."""

    def __init__(self, unit, decided=0.97):
        self.unit, self.decided = unit, decided
        self.rows = []

    def add(self, family, path, answer, verdict, checked):
        """One loop; tells at once what is not right."""
        self.rows.append((family, path, answer, verdict, checked))
        if verdict.kind != "right":
            print(f"{verdict.kind}: {path} ({answer.seconds:.1f} s)", *verdict.why, sep="\n    ", flush=True)

    def print(self):
        """The table; returns the exit code."""
        print(f"\n{'family':16}" + "".join(f"{kind:>11}" for kind in KINDS))
        families = sorted({row[0] for row in self.rows})
        for family in families + ["all"]:
            some = [row for row in self.rows if family in (row[0], "all")]
            counts = [sum(row[3].kind == kind for row in some) for kind in KINDS]
            print(f"{family:16}" + "".join(f"{count:11}" for count in counts))
        times = sorted(row[2].seconds for row in self.rows)
        marks = {"median": statistics.median(times), "90 %": times[int(0.9 * (len(times) - 1))], "max": times[-1]}
        print("CPU time of predict: " + ", ".join(f"{k} {v:.2f} s ({v / self.unit:.1f})" for k, v in marks.items()))
        print(f"  in brackets: times cases/pid-lugre.toml, {self.unit:.2f} s; checker {sum(r[4] for r in self.rows):.0f} s")
        starts = sum(row[3].starts for row in self.rows)
        open_starts = sum(row[3].undecided_starts for row in self.rows)
        late = sum(row[3].kind == "late" for row in self.rows)
        share = 1.0 - open_starts / starts if starts else 0.0
        print(f"decided: {100.0 * share:.1f} % of {starts} starts, {late} loops late")
        bad = sum(row[3].kind in BAD for row in self.rows)
        failed = bad + (share < self.decided) + (late > 0)
        print(f"{len(self.rows) - bad} passed, {failed} failed")
        return 1 if failed else 0
