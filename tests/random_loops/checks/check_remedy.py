"""One remedy of `remedy` against `predict`: the case that --apply writes does not hunt, and at the last value before it does."""

from .asked import Finding, goes_on, stable_cycles, texts, undecided, without_document

NAMES = (
    "error-dead-zone", "integrator-leak", "integrator-clamp", "integrator-reset", "integral-band", "gain-kp", "gain-ki",
    "gain-kd", "friction-compensation", "damping", "stiffness", "integrator-dead-zone", "integrator-hysteresis",
    "integrator-stop-reset", "gain-line-bandwidth", "gain-line-margin", "impulse-compensation",
)  # fmt: skip
# With another number that follows the one of the remedy: the last value before it is no change of one number.
FOLLOWED = ("integrator-hysteresis", "gain-line-bandwidth", "gain-line-margin")


def judge(asked, dice):
    """The finding of one remedy; none where the loop does not hunt or the remedy is not for it."""
    name = NAMES[int(dice.random.integers(len(NAMES)))]
    answer = asked.run("remedy", "--only", name)
    if answer.document is None:
        return [without_document(answer)]
    document = answer.document
    if document["hunts"] is False:
        return []
    one = next((remedy for remedy in document["remedies"] if remedy["name"] == name), None)
    if one is None or document["hunts"] is None:
        return [Finding("undecided", [f"{name}: no answer; {document['status']}"])]
    if not one["applicable"]:
        return []
    if one["ends"] is None:
        return [Finding("undecided", [f"{name}: {one['why']}"])]
    if not one["ends"]:
        return [Finding("right")]
    fixed = asked.path.with_suffix(".fixed.toml")
    asked.run("remedy", "--only", name, "--apply", name, "-o", fixed)
    if not fixed.exists():
        return [Finding("failed", [f"{name}: --apply wrote no case"])]
    findings = [_at(asked, fixed, one, None, False)]
    findings += [_at(asked, fixed, one, value, True) for value in one["beyond"][:1] if name not in FOLLOWED]
    order = ("failed", "late", "wrong", "undecided", "unlisted", "right")
    worst = min(findings, key=lambda found: order.index(found.kind))
    return [Finding(worst.kind, [f"{name} ({one['why']}): {why}" for why in worst.why])]


def _at(asked, fixed, one, value, hunts):
    """Whether predict hunts on the case with the remedy, at its own value or at another one."""
    words = [] if value is None else ["--set", f"{one['parameter']}={value!r}"]
    answer = asked.program.run("predict", fixed, "--time-limit", asked.program.limit, *words, limit=2.0 * asked.program.limit)
    if answer.document is None:
        return without_document(answer)
    document = answer.document
    found = bool(stable_cycles(document)) or goes_on(document)
    if found == hunts:
        return Finding("right")
    where = one["value"] if value is None else value
    why = [f"at {where!r} predict lists {texts(document['cycles'])}"]
    if undecided(document):
        return Finding("undecided", why)
    return Finding("unlisted" if hunts else "wrong", why)  # remedy follows a cycle that no start of predict may reach
