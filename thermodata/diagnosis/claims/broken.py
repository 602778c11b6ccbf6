"""Why who breaks a rule of a claim is no cause, in words."""

from __future__ import annotations

from thermodata.diagnosis.weigh.figures import HARDLY, from_to, of_more_than_noise
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.schema.words.sentences import apart, beside, in_percent


def too_little(scored: Scored, fall: float, unit: str, tests: str, doubles: float) -> str:
    """Why the error falls too little, with its size from the other tests. doubles: the fall below which it rises so
    much that tests contradict each other."""
    if scored.drop < doubles:
        return (
            f"with its size from the other {tests}, the error more than doubles where it acts ("
            f"{from_to(scored.error_before, scored.error_after, unit)}): the {tests} go against each other"
        )
    count = int(scored.acts.sum())
    acting = "" if count == 0 else f"in the one {tests[:-1]}" if count == 1 else f"in the {count} {tests}"
    where = f"{acting} in which it acts, with its size from the others, the error" if acting else "the error"
    if scored.drop <= 0:
        return f"{where} does not fall (limit: a fall of {in_percent(fall)})"
    if scored.drop < HARDLY:
        return f"{where} hardly falls (limit: a fall of {in_percent(fall)})"
    of = of_more_than_noise(scored.drop, scored.error_before, scored.error_after)
    return f"{where} falls by {apart(scored.drop, fall)}{of} only ({beside(scored.drop, fall)})"


def too_few(better: int, count: int, limit: float, tests: str) -> str:
    """Why it makes too few of the tests in which it acts more probable."""
    if count == 1:
        return f"it makes the one {tests[:-1]} in which it acts less probable"
    of = f"it makes {better or 'none'} of the {count} {tests} in which it acts more probable"
    return f"{of} ({beside(better / count, limit) if count else f'limit {in_percent(limit)}'})"


def unlike(spread: float, limit: float, count: int, tests: str) -> str:
    """Why its gain, which differs so much between so many tests, is not that of a cause."""
    if count < 2:
        return f"it acts in one {tests[:-1]} only, so no other tells its gain"
    return (
        f"its gain differs between {tests} by {apart(spread, limit)} ({beside(spread, limit)}): "
        "a cause acts alike everywhere"
    )
