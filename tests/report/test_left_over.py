"""What may hide in what a model leaves is told alike, whether it is refined or nothing is missing."""

from __future__ import annotations

from typing import Any

import pytest

from thermodata.report.verdict.verdict import verdict_sentence

from ..answers import candidate, diagnosis

HEAT = "heat of what nobody logs may be in it"
AS_MUCH = f"as much as models leave of a machine that lacks nothing, and {HEAT}"
MORE = f"more than is mostly left of a machine that lacks nothing: {HEAT}"


@pytest.mark.parametrize(
    ("left", "share", "said"),
    [(1.99, "20 %", ""), (2.0, "20 %", AS_MUCH), (2.5, "25 %", AS_MUCH), (2.51, "25 %", MORE)],
)
def test_heat_that_nobody_logs_may_be_in_a_fifth_of_the_response(left: float, share: str, said: str) -> None:
    """2.71 um, a quarter of the response, were heat of a part without a sensor, and stood there as nothing missing."""
    given: dict[str, Any] = {"noise_um": 0.05, "response_um": 10.0}
    none = verdict_sentence(diagnosis(verdict="none", rmse_um=left, **given))
    assert (f"{left:.2f} um are left on left-out tests, {share} of the response, more than noise" in none) is bool(said)
    assert none.endswith(f", and {said}" if said else "but no more than models leave of a machine that lacks nothing")
    mode = candidate("mode:T", refinement=True, rmse_um_before=5.0, rmse_um_after=left)
    stays = verdict_sentence(diagnosis(mode, verdict="refine", named_rmse_um=left, **given))
    assert stays.endswith(f"um stay then, {share} of the response" + (f", {said}" if said else ""))
