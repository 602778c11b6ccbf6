"""An answer against the truth: which claim stands for which hidden cause, and what the whole answer is worth."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

from thermodata.effect.places import holds
from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.virtual.lathe.causes import CAUSES
from thermodata.virtual.lathe.right_names import Mark, mark
from thermodata.virtual.lathe.sensors import BY_NAME

ORDER: tuple[Mark, ...] = ("exact", "equivalent", "family", "wrong")
FOUND = ("exact", "equivalent", "told")


def claims_of(found: Diagnosis) -> list[Candidate]:
    """What is said to be a missing cause: a refinement never is, whatever else is said of it."""
    return [c for c in found.candidates if c.claimed and not c.refinement]


def refinements_of(found: Diagnosis) -> list[Candidate]:
    """What is offered as a refinement of an effect that the model has: claimed ones, and the head of a `refine`."""
    offered = [c for c in found.candidates if c.refinement]
    head = offered[:1] if found.verdict == "refine" else []
    return [*head, *(c for c in offered if c.claimed and c not in head)]


def head_of(found: Diagnosis) -> Candidate | None:
    """The cause that the answer thinks likeliest: by its probability where any is stated, else by its rank."""
    causes = [c for c in found.candidates if not c.refinement and not c.gain_by and not c.phases]
    return min(causes, key=lambda c: (-(c.probability or 0.0), c.rank), default=None)


def best(causes: Sequence[str], c: Candidate, broken: str | None = None) -> Mark:
    """The best mark of a candidate against any of the causes. broken: a channel that names nothing."""
    if broken in c.drivers:
        return "wrong"
    return min((mark(cause, c.effect, c.drivers, c.family) for cause in causes), key=ORDER.index, default="wrong")


def marks_of(hidden: Sequence[str], claims: Sequence[Candidate], broken: str | None = None) -> tuple[list[str], int]:
    """(mark of each claim, how many causes no claim found).

    Claims are given to causes so that most are found, and by the best marks: the order in which an answer lists them
    does not matter. exact, equivalent; told: a twin, with the cause named beside it; again: a further claim for a
    cause that another one found; family: of a cause that none found; wrong.
    """
    fits = [[_fit(cause, claim, broken) for claim in claims] for cause in hidden]
    none = len(claims)
    given = min(
        (g for g in product(range(none + 1), repeat=len(hidden)) if _possible(g, fits, none)),
        key=lambda g: (g.count(none), sum(FOUND.index(fits[i][j] or "told") for i, j in enumerate(g) if j < none), g),
    )
    left = [cause for cause, j in zip(hidden, given, strict=True) if j == none]
    marks = []
    for j, claim in enumerate(claims):
        own = fits[given.index(j)][j] if j in given else None
        again = any(row[j] is not None for row in fits)
        marks.append(own or ("again" if again else "family" if best(left, claim, broken) == "family" else "wrong"))
    return marks, len(left)


def _possible(given: Sequence[int], fits: Sequence[Sequence[str | None]], none: int) -> bool:
    """Whether no claim stands for two causes, and each for one that it fits."""
    used = [j for j in given if j != none]
    return len(used) == len(set(used)) and all(j == none or fits[i][j] is not None for i, j in enumerate(given))


def _fit(cause: str, claim: Candidate, broken: str | None) -> str | None:
    own = best([cause], claim, broken)
    if own in ("exact", "equivalent"):
        return own
    return "told" if broken not in claim.drivers and _told(cause, claim) else None


def _told(cause: str, claim: Candidate) -> bool:
    """Whether the claim names the cause among those that it can't be told from, or the part that it is."""
    places = [BY_NAME[sensor].at for sensor in CAUSES[cause].sensors]
    if CAUSES[cause].known and any(holds(part, place) for part in claim.unread for place in places):
        return True
    for name in claim.equivalent:
        effect, _, channels = name.partition(":")
        if mark(cause, effect, channels.split(","), "") == "exact":
            return True
    return False


def outcome_of(verdict: str, marks: Sequence[str], missed: int, nothing: bool) -> str:
    """The answer in one word. nothing: no cause is hidden, or none that the logs or the library could name.

    right, equivalent, told (all found, by the poorest mark), some (of several), family, wrong, abstained; where there
    is nothing: silent, which is right whichever verdict says it, family (of a cause that is not logged), false claim.
    """
    if nothing:
        good = all(m in ("equivalent", "told", "again", "family") for m in marks)
        if not marks:
            return "false claim" if verdict == "effect" else "silent"
        return "family" if good else "false claim"
    if not marks:
        return "abstained"
    if "wrong" in marks:
        return "wrong"
    if missed:
        return "family" if "family" in marks else "some"
    if "told" in marks:
        return "told"
    return "right" if all(m == "exact" for m in marks) else "equivalent"
