"""Damaged case files: a shipped case or a template, with one to four changes to its values, keys, sections or bytes."""

import pathlib
import random
import re
import subprocess

EXTREMES = [
    "0", "0.0", "-0.0", "1", "-1", "2", "1e-300", "-1e-300", "1e300", "1.7e308", "-1.7e308", "5e-324", "1e16", "1e-16",
    "1e50", "1e28", "1e-12", "1e12", "1e100", "1e-100", "nan", "-nan", "inf", "-inf", "9223372036854775807",
    "-9223372036854775808", "9007199254740993", "1000000", "100000000", "0x7f", "0b1", "1_000"]
OTHER_TYPES = [
    '""', '"text"', "'1.0'", "[]", "[[]]", "[1.0]", "[1.0, 2.0]", "[[1.0, 0.0], [0.0, 1.0]]", "{}", "{a = 1}", "true",
    "2020-01-01", '"\\u001b[2J"', '"\\u0000"', "[1, \"x\"]", '{from = 1.0, to = 2.0, points = 3}', '{kind = "sine"}']
BYTES = [b"\x00", b"\x1b[31m", b"\xff", b"\xc2\x9b", b"\xe2\x80\xae", b"\r", b"\t", b"\n", b"\"", b"'''", b"[", b"]", b"{",
         b"=", b".", b"#", b"\\", b",", b"\xf0\x9f\x98\x80", b"\xef\xbb\xbf"]
ASSIGNMENT = re.compile(r"^(\s*)([A-Za-z0-9_.\"-]+)(\s*=\s*)([^#\n]*?)(\s*(?:#.*)?)$")
HEADER = re.compile(r"^\s*\[\[?[^\[\]=]+\]\]?\s*(?:#.*)?$")
NUMBER = re.compile(r"(?<![\w.\"])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w.\"])")


def templates(program):
    """What `limcycle new` writes for each kind of each part, and for pairs that a person would ask for."""
    def listed(part):
        return re.findall(r"'?\"?([a-z][a-z-]+)", subprocess.run(
            [program, "new", part, "?"], capture_output=True, text=True).stderr.partition("known: ")[2])

    parts = {flag: listed(flag) for flag in ("--plant", "--controller", "--friction", "--element", "--error")}
    wanted = [[]] + [[flag, kind] for flag, kinds in parts.items() for kind in kinds]
    wanted += [["--plant", plant, "--friction", law, "--controller", "none" if plant in ("belt", "froude-pendulum") else "pid"]
               for plant in parts["--plant"] for law in parts["--friction"]]
    texts = {}
    for flags in wanted:
        made = subprocess.run([program, "new", *flags], capture_output=True)
        if made.returncode == 0:
            texts["new " + " ".join(flags)] = made.stdout
    return texts


def seeds(program):
    """Name and bytes of everything that mutants come from."""
    found = {str(path): path.read_bytes() for path in sorted(pathlib.Path("cases").rglob("*.toml"))}
    found.update(templates(program))
    return found


class Mutator:
    """Draws mutants; the same seed draws the same ones."""

    def __init__(self, sources, seed):
        self.seed, self.random = seed, random.Random(seed)
        self.sources = sorted(sources.items())
        text = "\n".join(body.decode("utf-8", "replace") for body in sources.values())
        self.kinds = sorted(set(re.findall(r'^kind = ("[^"\n]+")', text, re.M)))
        self.keys = sorted(set(re.findall(r"^([A-Za-z_0-9]+) =", text, re.M)))
        self.sections = sorted(set(re.findall(r"^\[[^\[\]\n=]+\]", text, re.M)))
        self.blocks = [block for body in sources.values() for block in _blocks(body.decode("utf-8", "replace"))]

    def next(self, mild=False):
        """One mutant: what it was made from, and its bytes. `mild`: mostly other numbers, as `check` would accept."""
        name, body = self.random.choice(self.sources)
        lines = body.decode("utf-8", "replace").split("\n")
        if mild:
            changes = [self._number] * 8 + [self._scale] * 8 + [self._kind, self._remove, self._splice]
        else:
            changes = [self._number, self._scale, self._type, self._kind, self._misspell, self._remove, self._repeat,
                       self._header, self._swap, self._splice, self._length]
        for _ in range(self.random.choice((1, 1, 1, 2, 2, 3))):
            self.random.choice(changes)(lines)
        text = "\n".join(lines).encode("utf-8", "surrogateescape")
        if not mild and self.random.random() < 0.15:
            text = self._bytes(text)
        return name, text

    def _assignments(self, lines):
        return [i for i, line in enumerate(lines) if ASSIGNMENT.match(line)]

    def _with_value(self, lines, change):
        places = self._assignments(lines)
        if not places:
            return
        i = self.random.choice(places)
        indent, key, equals, value, rest = ASSIGNMENT.match(lines[i]).groups()
        lines[i] = indent + key + equals + change(value) + rest

    def _in_number(self, lines, change):
        """Changes one number, wherever it stands in a value."""
        places = [i for i in self._assignments(lines) if NUMBER.search(ASSIGNMENT.match(lines[i]).group(4))]
        if not places:
            return
        i = self.random.choice(places)
        indent, key, equals, value, rest = ASSIGNMENT.match(lines[i]).groups()
        found = self.random.choice(list(NUMBER.finditer(value)))
        lines[i] = indent + key + equals + value[:found.start()] + change(found.group()) + value[found.end():] + rest

    def _number(self, lines):
        self._in_number(lines, lambda _: self.random.choice(EXTREMES))

    def _scale(self, lines):
        def scaled(text):
            value = float(text) * 10.0 ** self.random.choice((-9, -6, -3, -2, -1, 0, 1, 2, 3, 6, 9))
            return repr(value * self.random.choice((1.0, 1.0, -1.0, self.random.uniform(0.5, 2.0))))
        self._in_number(lines, scaled)

    def _type(self, lines):
        self._with_value(lines, lambda _: self.random.choice(OTHER_TYPES))

    def _length(self, lines):
        def longer(value):
            if not value.startswith("["):
                return "[" + ", ".join([value] * self.random.choice((1, 2, 3, 300))) + "]"
            items = value.strip("[]").split(",")
            self.random.choice((items.pop, items.clear, lambda: items.extend(items), lambda: items.reverse()))()
            return "[" + ",".join(items) + "]"
        self._with_value(lines, longer)

    def _kind(self, lines):
        places = [i for i, line in enumerate(lines) if line.startswith("kind =")]
        if places:
            lines[self.random.choice(places)] = "kind = " + self.random.choice(self.kinds)

    def _misspell(self, lines):
        places = self._assignments(lines)
        if not places:
            return
        i = self.random.choice(places)
        indent, key, equals, value, rest = ASSIGNMENT.match(lines[i]).groups()
        at = self.random.randrange(len(key))
        key = self.random.choice((key[:at] + key[at + 1:], key[:at] + "x" + key[at:], key.upper(), key + "." + key, '""',
                                  self.random.choice(self.keys)))
        lines[i] = indent + key + equals + value + rest

    def _remove(self, lines):
        places = self._assignments(lines)
        if places:
            del lines[self.random.choice(places)]

    def _repeat(self, lines):
        i = self.random.randrange(len(lines))
        lines.insert(self.random.randrange(len(lines) + 1), lines[i])

    def _header(self, lines):
        places = [i for i, line in enumerate(lines) if HEADER.match(line)]
        if not places:
            return
        i = self.random.choice(places)
        lines[i] = self.random.choice(("", lines[i] * 2, "[" + lines[i] + "]", lines[i].replace("loop.", ""),
                                       self.random.choice(self.sections)))

    def _swap(self, lines):
        blocks = _blocks("\n".join(lines))
        self.random.shuffle(blocks)
        lines[:] = "\n".join(blocks).split("\n")

    def _splice(self, lines):
        """A section of another case in place of the one of the same name, or added."""
        block = self.random.choice(self.blocks)
        blocks = _blocks("\n".join(lines))
        header = block.split("\n", 1)[0]
        same = [i for i, one in enumerate(blocks) if one.split("\n", 1)[0] == header]
        if same:
            blocks[same[0]] = block
        else:
            blocks.append(block)
        lines[:] = "\n".join(blocks).split("\n")

    def _bytes(self, text):
        at = self.random.randrange(len(text) + 1)
        end = min(len(text), at + self.random.choice((1, 2, 10, 100)))
        return self.random.choice((text[:at], text[:at] + text[end:], text[:at] + self.random.choice(BYTES) + text[at:],
                                   text[:end] + text[at:], text[:at] + bytes([self.random.randrange(256)]) + text[at + 1:]))


def _blocks(text):
    """The text before the first header, then each section with its header."""
    blocks, now = [], []
    for line in text.split("\n"):
        if HEADER.match(line) and now:
            blocks.append("\n".join(now))
            now = []
        now.append(line)
    return blocks + ["\n".join(now)]
