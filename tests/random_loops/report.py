"""The table at the end: outcomes by family, times, rewritings, disagreements."""

import resource
import statistics
import time

KINDS = ("right", "undecided", "wrong", "missed", "late", "failed", "unchecked")
COMPARED = ("right", "undecided", "unlisted", "wrong", "missed", "late", "failed")
REWRITTEN = ("same", "undecided", "changed", "late", "failed")
BAD = ("wrong", "missed", "late", "failed", "changed")


def _counts(title, kinds, rows):
    """A table of how many of each kind: rows are (name, kind)."""
    lines = [f"\n{title:20}" + "".join(f"{kind:>11}" for kind in kinds)]
    for name in sorted({row[0] for row in rows}) + ["all"]:
        some = [row[1] for row in rows if name in (row[0], "all")]
        lines.append(f"{name:20}" + "".join(f"{some.count(kind):11}" for kind in kinds))
    return "\n".join(lines)


class Table:
    """Collects verdicts and tells at once what is not right."""

    def __init__(self, unit, decided):
        self.unit, self.decided = unit, decided
        self.rows, self.rewritings = [], []

    def add(self, family, path, answer, verdict, checked):
        """One loop."""
        self.rows.append((family, verdict.kind, answer.seconds, verdict, checked))
        if verdict.kind != "right":
            print(f"{verdict.kind}: {path} ({answer.seconds:.1f} s)", *verdict.why, sep="\n    ", flush=True)

    def rewritten(self):
        """How many rewritings there are."""
        return len(self.rewritings)

    def rewrite(self, kind, path, verdict, why):
        """One rewriting."""
        self.rewritings.append((kind, verdict))
        if verdict != "same":
            print(f"rewriting {verdict}: {path}", *why, sep="\n    ", flush=True)

    def print(self):
        """Prints all; returns the exit code."""
        if self.rows:
            print(_counts("family", KINDS, self.rows))
        if self.rewritings:
            print(_counts("rewriting", REWRITTEN, self.rewritings))
        enough = self._times_and_shares()
        verdicts = [row[1] for row in self.rows + self.rewritings]
        failed = sum(kind in BAD for kind in verdicts)
        print(f"{len(verdicts) - failed + enough} passed, {failed + (not enough)} failed")
        return 1 if failed or not enough else 0

    def _times_and_shares(self):
        """Prints times and the share of decided starts; whether that is enough."""
        times = sorted(row[2] for row in self.rows)
        if not times:
            return True
        marks = {"median": statistics.median(times), "90 %": times[int(0.9 * (len(times) - 1))], "max": times[-1]}
        print("\nCPU time of predict: " + ", ".join(f"{k} {v:.2f} s ({v / self.unit:.1f})" for k, v in marks.items()))
        print(f"  in brackets: over {self.unit:.2f} s of cases/pid-lugre.toml; checker {sum(r[4] for r in self.rows):.0f} s")
        starts = sum(row[3].starts for row in self.rows)
        undecided = sum(row[3].undecided_starts for row in self.rows)
        share = 1.0 - undecided / starts if starts else 0.0
        print(f"decided: {100.0 * share:.1f} % of {starts} starts (wanted: {100.0 * self.decided:g} %)")
        return share >= self.decided


class Commands:
    """Collects what was compared of each command."""

    def __init__(self):
        self.rows = []
        self.began = time.process_time(), _children()

    def count(self, name):
        """How many findings there are of a command."""
        return sum(row[0] == name for row in self.rows)

    def add(self, name, path, findings):
        """Those of one loop."""
        for finding in findings:
            self.rows.append((name, finding.kind))
            if finding.kind != "right":
                print(f"{name} {finding.kind}: {path}", *finding.why, sep="\n    ", flush=True)

    def print(self):
        """Prints the table; returns the exit code."""
        print(_counts("command", COMPARED, self.rows))
        own, children = time.process_time() - self.began[0], _children() - self.began[1]
        print(f"\nCPU time: program {children:.0f} s, checker {own:.0f} s")
        failed = sum(row[1] in BAD for row in self.rows)
        print(f"{len(self.rows) - failed} passed, {failed} failed")
        return 1 if failed else 0


def _children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
