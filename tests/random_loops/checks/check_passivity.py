"""Answers of `dissipativity` against simulations of the law and against `predict`."""

from .asked import Finding, texts, undecided, without_document
from ..law_motion import LawMotion, crossing
from ..case_numbers import setting

CLEAR = 1e-4  # relative crossing of the bounds that is no rounding
BESIDE = 3e-3  # relative, either side of a threshold
MOTIONS = 12  # random motions of each law


def judge_law(asked, dice):
    """The finding of one law."""
    keys = asked.case["loop"]["friction"]
    motion = LawMotion(keys)
    speed = motion.speed() * dice.log(0.3, 30.0)
    answer = asked.run("dissipativity", "--speed", repr(speed))
    if answer.document is None:
        return [without_document(answer)]
    document = answer.document
    if document["passive"] == "undecided":
        return [Finding("undecided", [document["why"]])]
    wrong = _verdict(motion, document) + _counterexample(motion, document)
    wrong += _motions(motion, document, speed, dice) + _beside(asked, document)
    return [Finding("wrong" if wrong else "right", wrong)]


def _verdict(motion, document, top=float("inf")):
    """Whether a storage exists, by the bounds on its slope."""
    if not motion.has_state:
        return [] if document["passive"] is True else [f"passive: {document['passive']}, of a law with F v >= 0"]
    cross, z, up, down = crossing(motion, top)
    found = f"to and fro at z = {z:.6g}, {up:.4g} and {down:.4g} m/s: the slopes cross by {cross:.2g} of their size"
    if document["passive"] is True and cross > CLEAR:
        return [f"passive: true, but {found}"]
    if document["passive"] is False and cross < -CLEAR:
        return [f"passive: false, but {found}"]
    return []


def _counterexample(motion, document):
    """The motion that takes energy out, marched again."""
    shown = document["counterexample"]
    if (document["passive"] is False) != (shown is not None):
        return [f"passive: {document['passive']}, and {'no' if shown is None else 'a'} counter-example"]
    if shown is None:
        return []
    ends = shown["time"][1:] + [shown["period"]]
    pieces = [(b - a, v) for a, b, v in zip(shown["time"], ends, shown["velocity"]) if b > a]
    z, energy, turned, _, _ = motion.run(pieces, shown["initial"][0])
    told, wrong = shown["energy_per_cycle"], []
    if abs(-energy - told) > 1e-3 * abs(told) + 1e-9 * turned or not told > 0.0:
        wrong.append(f"the counter-example takes out {-energy:.8g} J a cycle, not {told:.8g} J")
    if abs(z - shown["initial"][0]) > 1e-5 * motion.widest:
        wrong.append(f"the counter-example does not close: z from {shown['initial'][0]:.8g} to {z:.8g}")
    return wrong


def random_motion(motion, dice, most):
    """Constant velocities to and fro over decades of speed and way, up to a speed."""
    pieces = []
    for _ in range(int(dice.random.integers(2, 7))):
        v = min(most, motion.speed() * dice.log(1e-4, 1e4))
        way = motion.widest * dice.log(1e-2, 30.0) if motion.has_state else v
        pieces.append((way / v, dice.among([-1.0, 1.0]) * v))
    return pieces


def _motions(motion, document, speed, dice):
    """Random motions up to the speed of the bounds: none beyond a bound, and none that takes out what must stay in."""
    wrong = []
    bound = document["force_bound"] or {}
    deflection = [one for one in document["state_bounds"] if one["high"] is not None]
    for _ in range(MOTIONS):
        pieces = random_motion(motion, dice, speed)
        if document["passive"] is True and motion.has_state:
            found = motion.taken(pieces)
            if found and found[0] > 1e-7 * found[1]:
                wrong.append(f"passive: true, but {found[0]:.6g} J a cycle of {found[1]:.6g} J come out of {pieces}")
        _, energy, turned, force, reach = motion.run(pieces)
        if not motion.has_state and energy < -1e-9 * turned:
            wrong.append(f"passive: true, but {-energy:.6g} J come out of {pieces}")
        if bound.get("value") is not None and force > bound["value"] * (1.0 + 1e-8):
            wrong.append(f"|F| reaches {force:.9g} N below {bound['up_to_speed']:.6g} m/s; bound {bound['value']:.9g} N")
        if deflection and reach > deflection[0]["high"] * (1.0 + 1e-8):
            wrong.append(f"z reaches {reach:.9g}; bound {deflection[0]['high']:.9g}")
    return wrong


def _beside(asked, document):
    """Just above and just below what the document has as borders of passivity."""
    asks = []
    border = document["threshold"]
    if border is not None:
        near = BESIDE + 3.0 * (border["error"] or 0.0) / max(border["value"], 1e-300)
        asks += [(setting(border["parameter"], border["value"] * (1.0 + near)), True)]
        asks += [(setting(border["parameter"], border["value"] * (1.0 - near)), False)] if border["value"] > 0.0 else []
    top = document["passive_up_to_speed"]
    if isinstance(top, float):
        asks += [(["--top-speed", repr(top * (1.0 - BESIDE))], True), (["--top-speed", repr(top * (1.0 + BESIDE))], False)]
    wrong = []
    for words, expected in asks:
        answer = asked.run("dissipativity", *words)
        found = answer.document["passive"] if answer.document else answer.message
        if found is not expected and found != "undecided":
            wrong.append(f"{' '.join(words)}: passive: {found}, expected {expected}")
    return wrong


def judge_loop(asked, dice):
    """The finding of one loop: proofs and equilibria against predict."""
    answer = asked.run("dissipativity")
    if answer.document is None:
        return [without_document(answer)]
    other = asked.predict()
    if other.document is None:
        return [without_document(other)]
    wrong = contradictions(answer.document["loop"], other.document)
    if wrong:
        return [Finding("wrong", wrong)]
    known = answer.document["loop"]["no_cycle"]["answer"] != "undecided" and not undecided(other.document)
    return [Finding("right" if known else "undecided", [] if known else [answer.document["loop"]["no_cycle"]["why"]])]


def contradictions(proved, document):
    """What is proved of a loop and is not so in predict."""
    outcomes = {one["outcome"] for one in document["outcomes"]}
    wrong = []
    if proved["no_cycle"]["answer"] is True and (document["cycles"] or "cycle" in outcomes):
        wrong.append(f"proved to have no cycle; predict lists {texts(document['cycles'])}")
    if proved["agrees_with_predict"] is False:
        wrong.append("the program itself finds that its proof and predict differ")
    if proved["stuck_states"]["exists"]["answer"] is False and "rest" in outcomes:
        wrong.append("it cannot stand still; predict has rest")
    if proved["sliding"]["stable"]["answer"] is False and "sliding" in outcomes:
        wrong.append("steady sliding is unstable; predict has sliding")
    return wrong
