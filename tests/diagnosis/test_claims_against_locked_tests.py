"""A claim with which the locked tests get no better says by which rule it stands."""

from __future__ import annotations

from dataclasses import replace

import pytest

from thermodata.diagnosis.locked.confirmation import Confirmation
from thermodata.diagnosis.tell.candidate.of_locked import stands_for
from thermodata.diagnosis.weigh.foretold import Foretold, Looked
from thermodata.report.verdict.candidate_errors import LAGS, locked_errors

from ..answers import candidate
from .hand_made import scored

WORSE, LESS, BETTER = Foretold(6.71, 6.87, 1.0), Foretold(5.65, 5.22, 1.0), Foretold(5.0, 1.0, 4.0)
OTHERWISE = "where the effects of the model may act otherwise than by their fitted lags"


@pytest.mark.parametrize(
    ("foretold", "added", "floor", "after", "said"),
    [
        (
            *(LESS, WORSE, 0.1, 6.87),
            f"their error falls by 8 % (5.65 -> 5.22 um) {OTHERWISE}, less than a cause mostly takes away, but the "
            "open tests outweigh that",
        ),
        (
            *(BETTER, Foretold(6.71, 5.0, 1.0), 0.1, 6.87),
            f"their error falls by 80 % (5.00 -> 1.00 um) {OTHERWISE}, and only what lets it fall in neither way is "
            "refused",
        ),
        (
            *(WORSE, BETTER, 0.1, 6.87),
            "their error falls by 80 % (5.00 -> 1.00 um) with it alone, beside all else that is claimed",
        ),
        (LESS, WORSE, 9.0, 6.87, "what is left there to be foretold is too little to speak against it"),
        (LESS, WORSE, 0.1, 6.70, None),
    ],
)
def test_a_claim_with_which_locked_tests_get_no_better_says_why_it_stands(
    foretold: Foretold, added: Foretold, floor: float, after: float, said: str | None
) -> None:
    one = replace(scored(after=0.4, evidence=2000.0), looked=Looked(foretold, added, floor))
    assert stands_for(one, Confirmation(12.9, 13.0, 6.71, after, 1.0, {})) == said


def test_the_head_says_that_they_do_not_bear_it_out_and_why_it_is_claimed() -> None:
    locked = {"locked_rmse_um_before": 12.9, "locked_rmse_um_after": 13.0}
    shape = {"locked_shape_um_before": 6.71, "locked_shape_um_after": 6.87}
    one = candidate("bent:T", claimed=True, stands_for="their error falls there", **locked, **shape)
    worse = "; locked tests get worse (12.9 -> 13.0 um, by their shape 6.71 -> 6.87 um)"
    assert locked_errors([one]) == (
        f"{worse}, so they do not bear it out as it would be added; it is claimed all the same, for their error falls "
        f"there{LAGS}"
    )
    assert locked_errors([one.model_copy(update={"stands_for": None})]) == worse + LAGS, "of an older version"
    other = candidate("sun:T", claimed=True, stands_for="it falls, too")
    assert locked_errors([one, other]).endswith(
        f"; they are claimed all the same: bent, for their error falls there, and sun, for it falls, too{LAGS}"
    )
