"""Runs the program: JSON documents, exit codes and CPU times."""

import json
import os
import resource
import subprocess
from dataclasses import dataclass


@dataclass
class Answer:
    """What one call gave; `document` is None where there is none."""

    document: dict
    code: int
    seconds: float  # of CPU time
    late: bool
    message: str


class Program:
    """The program under test."""

    def __init__(self, path, limit):
        self.path, self.limit = os.path.abspath(path), limit

    def run(self, *words, limit=None):
        """One call with --json -; CPU time is that of the child."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        command = [self.path, *map(str, words), "--json", "-", "--quiet"]
        late = False
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=limit or self.limit)
            out, code, message = done.stdout, done.returncode, done.stderr.strip()
        except subprocess.TimeoutExpired:
            out, code, message, late = "", -1, "not done within the limit", True
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        try:
            document = json.loads(out) if out.strip() else None
        except json.JSONDecodeError:
            document, message = None, "the document is not JSON"
        return Answer(document, code, seconds, late, message)

    def predict(self, path):
        """limcycle predict."""
        return self.run("predict", path)
