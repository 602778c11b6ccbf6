"""What is said of one candidate: its rules, the tests that were left out, what it would take away."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

from thermodata.schema.answers.result import Parameter, Result


class Rung(Result):
    """One rule of a claim.

    name: of the rule: chance, fall, tests, gain, others, worth and more
    asks: what is measured
    value: measured; null where it can't be
    limit: of the rule
    unit: of value and limit; 1 for shares
    at: whether the value has to be at least or at most the limit
    holds: whether the rule is met
    asked: whether it decides; false where the value misses the limit and something stronger outweighs it
    fails: why who breaks it is no cause, in a sentence; null where it is met, or in an answer of an older version
    """

    name: str
    asks: str
    value: float | None
    limit: float
    unit: str
    at: Literal["least", "most"]
    holds: bool
    asked: bool = True
    fails: str | None = None


class LeftOut(Result):
    """A test, or a part of one, as the others foretell it.

    campaign: id
    test: id
    from_s: where the part begins, from the test's start [s]
    to_s: where it ends [s]
    acts: whether the candidate does there at least a fifth of what it does in the test in which it does most
    rmse_um_before: error without the candidate, in the response's unit
    rmse_um_after: with it
    """

    campaign: str
    test: str
    from_s: float
    to_s: float
    acts: bool
    rmse_um_before: float
    rmse_um_after: float


class CandidateCourse(Result):
    """What a candidate would take of the residual in one test, free offsets removed; lists have one entry a sample.

    campaign: id
    test: id
    t_s: from the test's start [s]
    residual_um: what the model leaves over, in the response's unit
    contribution_um: the candidate's, with its gains as all open tests give them
    """

    campaign: str
    test: str
    t_s: list[float]
    residual_um: list[float]
    contribution_um: list[float]


# of a candidate in a list: all of it has thousands of figures
_SAID = ("rank", "id", "claimed", "refinement", "probability")


class Candidate(Result):
    """An effect, bound to channels, that may be missing; with its evidence on left-out tests.

    rank: 1 is the head
    id: effect:channels; gain_by:effect,condition; or phases:effect,phase,phase
    effect: its name
    family: effects of one cause share it
    drivers: channels, in the order of the effect's roles
    gain_by: the effect is in the model, and would have a gain for each value of this condition; null for all others
    phases: the effect is in the model, and would have a function for each of these phases; empty for all others
    claimed: whether the evidence suffices for a missing cause
    refinement: whether it refines an effect that the model has (a second mode, a switch, a lead), which is never a
        missing cause
    probability: posterior probability that this cause is missing, given the data; of claims, of the first cause and of
        causes that keep all other rules, null for all else
    probability_with_unread: that it is this cause or heat at one of the places of `unread`; null where there are none
    p_value: share of responses in which nothing is missing on which the best of all candidates does as well
    rmse_um_before: error on left-out tests without it, in the response's unit
    rmse_um_after: with it
    acting_um_before: error in the tests in which it acts, each alike, its size from the other tests and the effects of
        the model fitted to all: what a rule goes by; null in an answer of an older version
    acting_um_after: with it
    fit_before: FIT [%] on left-out tests without it
    fit_after: with it
    locked_rmse_um_before: error on the locked tests without it, of a refit of the model to all open tests; for a
        claimed one only
    locked_rmse_um_after: with it, fitted likewise
    locked_rmse_um_fitted: of the model as it is fitted, which is the one that the user has; for a claimed one only;
        null where the refit leaves as much to a tenth, and in an answer of an older version
    locked_shape_um_before: the same over those in which the claims act, a free offset for each; of a refinement that
        they were opened for, over those in which it acts; of what they were opened for and is neither, of the looks
        that say anything the one in which the error falls least, as the reason tells it
    locked_shape_um_after: with it
    locked_tests_asked: in how many locked tests the claims act, and are asked, or what is likely and no claim; 0: they
        were opened only to see that they do not get twice as bad, which is a look as well; null where it is not known,
        or nothing was opened for it
    stands_for: of a claim with which the locked tests in which it acts get no better, why it is one all the same; null
        for all else, and in an answer of an older version
    beside: ids of the effects that stand in the model too where the errors and FITs before and after are told; empty
        where these are of the user's own model without and with this one; null in an answer of an older version
    as_modelled: whether errors and FITs before and after are beside the effects of the model as it has them, which are
        else free to act otherwise than by one lag each
    parameters: of the effect, fitted to all open tests; for a claimed one only
    equivalent: ids that the data cannot tell from it
    unread: places of other parts that it may be as well, for nothing that it reads tells them apart
    also_on: displacements along other axes at the same place that miss it too, each with its probability there; asked
        only where that decides
    why: the evidence in a sentence
    evidence: log Bayes factor of the model with it against the model without
    rungs: every rule of a claim with its value and limit
    left_out: each left-out test before and after; beside the user's own model, or beside all that is chosen
    courses: the residual and the contribution; for claims, refinements and the head of the list only
    """

    rank: int
    id: str
    effect: str
    family: str
    drivers: list[str]
    gain_by: str | None = None
    phases: list[str] = []
    claimed: bool
    refinement: bool = False
    probability: float | None = None
    probability_with_unread: float | None = None
    p_value: float | None
    rmse_um_before: float | None
    rmse_um_after: float | None
    acting_um_before: float | None = None
    acting_um_after: float | None = None
    fit_before: float | None
    fit_after: float | None
    locked_rmse_um_before: float | None = None
    locked_rmse_um_after: float | None = None
    locked_rmse_um_fitted: float | None = None
    locked_shape_um_before: float | None = None
    locked_shape_um_after: float | None = None
    locked_tests_asked: int | None = None
    stands_for: str | None = None
    beside: list[str] | None = None
    as_modelled: bool = False
    parameters: dict[str, Parameter] = {}
    equivalent: list[str] = []
    unread: list[str] = []
    also_on: dict[str, float] = {}
    why: str = ""
    evidence: float | None = None
    rungs: list[Rung] = []
    left_out: list[LeftOut] = []
    courses: list[CandidateCourse] = []

    def __repr_args__(self) -> Iterator[tuple[str | None, Any]]:
        yield from ((name, getattr(self, name)) for name in _SAID)
