"""The numbers of a case by their paths, as `--set`, `--parameter`, `--x` and `--y` name them."""

PARTS = ("plant", "controller", "friction", "element")
SHAPES = ("exponent", "delta", "zba_ratio")  # exponents: another law, not another size


def numbers(case, shapes=False):
    """Pairs of path and value of all numbers that are written and not zero; lists (poles, matrices) are left out."""
    found = []
    for key, entry in case["loop"].items():
        if key in PARTS:
            found += [(f"loop.{key}.{name}", value) for name, value in entry.items() if shapes or name not in SHAPES]
        else:
            found.append((f"loop.{key}", entry))
    return [(path, value) for path, value in found if isinstance(value, float) and value != 0.0]


def setting(path, value):
    """Words of the command line that give a number another value."""
    return ["--set", f"{path}={float(value)!r}"]


def span(path, value, factor):
    """PATH=FROM:TO about a value, from its smaller to its larger end."""
    low, high = sorted((value / factor, value * factor))
    return f"{path}={low!r}:{high!r}"
