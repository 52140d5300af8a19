"""One case and what the program answers about it: predict with other values is asked once for each."""

from dataclasses import dataclass, field

from .. import case_text
from ..case_numbers import setting

CLOSE = 1e-4  # relative, of periods and amplitudes of two commands


@dataclass
class Finding:
    """One thing that was compared: right, undecided, unlisted, wrong, missed, late or failed; and why.

    unlisted: predict does not have an unstable cycle, and does not have to. missed: nor a stable one that another command
    has found."""

    kind: str
    why: list = field(default_factory=list)


class Asked:
    """A case file and the commands that are run on it."""

    def __init__(self, program, path, case):
        self.program, self.path, self.case = program, path, case
        self.known = {}
        path.write_text(case_text.toml(case))

    def run(self, command, *words):
        """Any command; it has to end itself at the limit."""
        limit = self.program.limit
        return self.program.run(command, self.path, "--time-limit", limit, *words, limit=2.0 * limit)

    def predict(self, *pairs, accuracy=None):
        """predict with other values: pairs of path and value."""
        key = (*pairs, accuracy)
        if key not in self.known:
            words = [word for pair in pairs for word in setting(*pair)]
            words += ["--set", f"predict.accuracy={accuracy!r}"] if accuracy else []
            self.known[key] = self.run("predict", *words)
        return self.known[key]


def without_document(answer):
    """The finding where a command gave no document."""
    return Finding("late" if answer.late else "failed", [answer.message or f"exit code {answer.code}"])


def refused(answer):
    """Whether the values were refused as no valid case."""
    return answer.document is None and answer.code == 2


def stable_cycles(document):
    """Those of predict that are known to be stable."""
    return [cycle for cycle in document["cycles"] if cycle["stable"]]


def undecided(document):
    """Whether the outcome of some start is not known, or nothing is."""
    return not document["outcomes"] or any(one["outcome"] == "undecided" for one in document["outcomes"])


def goes_on(document):
    """Whether a motion never ends in another way than on a cycle of one period."""
    return any(one["outcome"] in ("family", "irregular") for one in document["outcomes"])


def alike(one, other, tolerance=CLOSE):
    """Whether period and amplitude agree."""
    return all(abs(one[key] - other[key]) <= tolerance * abs(other[key]) for key in ("period", "amplitude"))


def text(cycle):
    """A cycle in words."""
    return f"T = {cycle['period']:.9g}, A = {cycle['amplitude']:.7g}"


def texts(cycles):
    """Cycles in words."""
    return "; ".join(f"{text(c)} ({ {True: 'stable', False: 'unstable', None: '?'}[c['stable']] })" for c in cycles) or "none"
