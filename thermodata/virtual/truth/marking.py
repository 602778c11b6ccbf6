"""An answer against the truth: which claim stands for which hidden cause, and what the whole answer is worth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

from thermodata.effect.places import holds
from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.virtual.truth.names import Mark, Names

ORDER: tuple[Mark, ...] = ("exact", "equivalent", "family", "wrong")
FOUND = ("exact", "equivalent", "told", "alike")


@dataclass(frozen=True, slots=True)
class Key:
    """What an answer is marked by. hidden: causes that the model lacks. names: what the library calls every cause.
    broken: a channel that names nothing. alike: (id of a claim, cause) of claims that do on the open tests what the
    cause does there."""

    hidden: tuple[str, ...]
    names: Names
    broken: str | None = None
    alike: frozenset[tuple[str, str]] = frozenset()

    def best(self, causes: Sequence[str], c: Candidate) -> Mark:
        """The best mark of a candidate against any of some causes."""
        if self.broken in c.drivers:
            return "wrong"
        marks = (self.names[cause].mark(c.effect, c.drivers, c.family) for cause in causes)
        return min(marks, key=ORDER.index, default="wrong")

    def is_hidden(self, c: Candidate) -> bool:
        """Whether a candidate is a hidden cause by its name."""
        return self.best(self.hidden, c) in ("exact", "equivalent")

    def stands_for(self, cause: str, claim: Candidate) -> str | None:
        """exact, equivalent, told or alike; None for a claim that does not name the cause."""
        own = self.best([cause], claim)
        if own in ("exact", "equivalent"):
            return own
        if self.broken in claim.drivers:
            return None
        return "told" if self._is_told(cause, claim) else "alike" if (claim.id, cause) in self.alike else None

    def _is_told(self, cause: str, claim: Candidate) -> bool:
        """Whether the claim names the cause among those that it can't be told from, or the part that it is."""
        right = self.names[cause]
        another = any(holds(part, place) for part in claim.unread for place in right.places)
        return another or right.among(claim.equivalent)


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


def marks_of(key: Key, claims: Sequence[Candidate]) -> tuple[list[str], int]:
    """(mark of each claim, how many causes no claim found).

    Claims are given to causes so that most are found, and by the best marks: the order in which an answer lists them
    does not matter. exact, equivalent; told: a twin, with the cause named beside it; alike: one that the open tests
    can't tell from the cause, whose answer does not say so; again: a further claim for a cause that another one found;
    family: of a cause that none found; wrong.
    """
    fits = [[key.stands_for(cause, claim) for claim in claims] for cause in key.hidden]
    none = len(claims)
    given = min(
        (g for g in product(range(none + 1), repeat=len(key.hidden)) if _possible(g, fits, none)),
        key=lambda g: (g.count(none), sum(FOUND.index(fits[i][j] or "told") for i, j in enumerate(g) if j < none), g),
    )
    left = [cause for cause, j in zip(key.hidden, given, strict=True) if j == none]
    marks = []
    for j, claim in enumerate(claims):
        own = fits[given.index(j)][j] if j in given else None
        again = any(row[j] not in (None, "alike") for row in fits)  # beside its cause an imitator is one cause more
        marks.append(own or ("again" if again else "family" if key.best(left, claim) == "family" else "wrong"))
    return marks, len(left)


def _possible(given: Sequence[int], fits: Sequence[Sequence[str | None]], none: int) -> bool:
    """Whether no claim stands for two causes, and each for one that it fits."""
    used = [j for j in given if j != none]
    return len(used) == len(set(used)) and all(j == none or fits[i][j] is not None for i, j in enumerate(given))


def outcome_of(verdict: str, marks: Sequence[str], missed: int, nothing: bool) -> str:
    """The answer in one word. nothing: no cause is hidden, or none that the logs or the library could name.

    right, equivalent, told, alike (all found, by the poorest mark), some (of several), family, wrong, abstained; where
    there is nothing: silent, which is right whichever verdict says it, family (of a cause that is not logged), false
    claim.
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
    for poorer in ("alike", "told"):
        if poorer in marks:
            return poorer
    return "right" if all(m == "exact" for m in marks) else "equivalent"
