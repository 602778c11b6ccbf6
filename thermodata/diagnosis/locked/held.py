"""Whether a choice of the user's own holds on the locked tests: by its shape, and as they are scored."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.diagnosis.weigh.foretold import LEAST
from thermodata.schema.answers.confirmed import Confirmed, TestConfirmed

RESTS = "it hardly acts in the locked tests, so they say nothing of it"
HOLDS = "about each test's mean the error falls by what a cause of its size takes away"
AS_SCORED = "; counted from its first samples, as tests are scored, it does not fall"
FALLS_SHORT = "about each test's mean the error falls by less than a cause of its size takes away"
RISES = "the error rises"
RISES_ELSEWHERE = "; over all locked tests the error rises, in those in which it acts least: they say nothing of it"
IN_SHAPE_ONLY = (
    "in shape only: about each test's mean the error falls by what a cause of its size takes away, but counted from "
    "its first samples, as tests are scored, it rises. The course fits and its start does not: a test that began warm, "
    "or noise where its zero is taken"
)

BY_SHAPE = "the diagnosis claims it all the same: it goes by the shape"
OUTWEIGHED = (
    "the diagnosis claims it all the same: it weighs what these tests say against the open ones, and asks them where "
    "the effects of the model may act otherwise, too"
)


def held(result: Confirmed, by_shape: bool | None) -> Confirmed:
    """With `holds`, `holds_by_shape` and `why`. by_shape: of the locked tests in which it acts, a free offset for each;
    None where it rests in all of them."""
    rises = _error_rises([t for t in result.tests if t.acts])
    before, after = result.locked_shape_um_before, result.locked_shape_um_after
    if by_shape is None:
        holds, why = None, RESTS
    elif by_shape:
        elsewhere = RISES_ELSEWHERE if _error_rises(result.tests) else ""
        level = AS_SCORED if not elsewhere and not _error_falls([t for t in result.tests if t.acts]) else ""
        holds, why = not rises, IN_SHAPE_ONLY if rises else HOLDS + level + elsewhere
    else:
        falls = before is None or after is None or after < before
        holds, why = False, FALLS_SHORT if falls else RISES
    return result.model_copy(update={"holds": holds, "holds_by_shape": by_shape, "why": why})


def despite(result: Confirmed) -> Confirmed:
    """With the reason why a diagnosis claims what does not hold, where it does: `probability` is what it claims it
    with."""
    against = result.holds is False and result.probability is not None
    said = (BY_SHAPE if result.holds_by_shape else OUTWEIGHED) if against else None
    return result.model_copy(update={"despite": said})


def as_held(known: Confirmed) -> Confirmed:
    """An answer that the store holds; older ones went by the shape alone."""
    return held(known, known.holds if known.why is None else known.holds_by_shape)


def _error_rises(tests: Sequence[TestConfirmed]) -> bool:
    """Whether the error as scored rises by as much as counts for a fall. Tests weigh by their samples, alike where
    an older answer does not say how many."""
    before, after = _squared_errors(tests)
    return after > (1 + LEAST) ** 2 * before


def _error_falls(tests: Sequence[TestConfirmed]) -> bool:
    before, after = _squared_errors(tests)
    return after < before


def _squared_errors(tests: Sequence[TestConfirmed]) -> tuple[float, float]:
    """Sums of squared errors as scored, before and after."""
    before = sum(t.rmse_um_before**2 * (t.n or 1) for t in tests)
    after = sum(t.rmse_um_after**2 * (t.n or 1) for t in tests)
    return before, after
