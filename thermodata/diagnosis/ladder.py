"""The evidence of one candidate rung by rung, for who doubts it: each rule of a claim with its value and its limit,
each left-out test before and after, and the residual with the contribution over it. What decides stands in `judge`."""

from __future__ import annotations

import numpy as np

from thermodata.diagnosis.candidates import GENERIC
from thermodata.diagnosis.judge import (
    BETTER_LIMIT,
    DROP_LIMIT,
    FORETOLD,
    P_LIMIT,
    PLACELESS_SHARP_LIMIT,
    SHARP_LIMIT,
    SPREAD_LIMIT,
    STEADIES,
    UNNAMED_DROP_LIMIT,
    UNNAMED_SHARP_LIMIT,
    WORTH_SHARE,
    Measure,
    acting_size,
    explained,
    sharpness,
)
from thermodata.diagnosis.null import p_value
from thermodata.diagnosis.problem import Problem
from thermodata.diagnosis.scored import Scored
from thermodata.plugin import Float1D
from thermodata.schema.result import CandidateCourse, LeftOut, Rung

_QUANTILES = 41


def rungs(scored: Scored, measure: Measure, unit: str) -> list[Rung]:
    """Every rule of a claim, in the order in which they are asked; a candidate may be claimed where all hold."""
    unnamed = scored.candidate.family == GENERIC and not scored.candidate.placeless
    sharp = UNNAMED_SHARP_LIMIT if unnamed else SHARP_LIMIT
    if scored.candidate.placeless:
        sharp = PLACELESS_SHARP_LIMIT
    size = acting_size(scored)
    p = p_value(scored.evidence, measure.chance)
    fall = UNNAMED_DROP_LIMIT if unnamed else DROP_LIMIT
    steady = explained(scored) / size if size > 0 else (np.inf if explained(scored) > 0 else 0.0)
    # few tests can't tell a spread: it is not asked where left-out tests are foretold well
    spread_holds = not (scored.spread > SPREAD_LIMIT and scored.drop < FORETOLD)
    falls = f"how much its gain differs between tests; not asked where the error falls by {FORETOLD:.0%}"
    return [
        _most("chance", "share of responses without a missing effect on which chance does as well", p, P_LIMIT),
        _least("fall", "fall of the error on left-out tests in which it acts", scored.drop, fall),
        _least("tests", "share of these tests that it makes more probable", scored.better, BETTER_LIMIT),
        _most("gain", falls, scored.spread, SPREAD_LIMIT).model_copy(update={"holds": spread_holds}),
        _least("worth", "what it explains where it acts", explained(scored), WORTH_SHARE * measure.spread, unit),
        _most("steadies", "what it explains, in multiples of its own size", steady, STEADIES),
        _least("timing", "log evidence a sample: its timing, not its slow shape alone", sharpness(scored), sharp),
    ]


def _most(name: str, asks: str, value: float, limit: float, unit: str = "1") -> Rung:
    return Rung(name=name, asks=asks, value=_told(value), limit=limit, unit=unit, at="most", holds=value <= limit)


def _least(name: str, asks: str, value: float, limit: float, unit: str = "1") -> Rung:
    return Rung(name=name, asks=asks, value=_told(value), limit=limit, unit=unit, at="least", holds=value >= limit)


def _told(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def left_out(scored: Scored, problem: Problem) -> list[LeftOut]:
    """Each test, or part of one, as the others foretell it without and with the candidate."""
    if not _of_these(scored, problem):
        return []
    before, after = np.sqrt(scored.sse_before / scored.rows), np.sqrt(scored.sse_after / scored.rows)
    return [
        LeftOut(
            campaign=block.test.campaign,
            test=block.test.test,
            from_s=float(block.t_s[0]) if len(block.t_s) else 0.0,
            to_s=float(block.t_s[-1]) if len(block.t_s) else 0.0,
            acts=bool(acts),
            rmse_um_before=float(b),
            rmse_um_after=float(a),
        )
        for block, acts, b, a in zip(problem.blocks, scored.acts, before, after, strict=True)
    ]


def courses(scored: Scored, problem: Problem) -> list[CandidateCourse]:
    """In each test in which it acts: what the model leaves over, and what the candidate would take of it."""
    if not _of_these(scored, problem):
        return []
    point, _ = scored.weighed.best
    found = []
    for block, columns, acts in zip(problem.blocks, scored.columns.blocks, scored.acts, strict=True):
        if acts and len(block.t_s):
            contribution = columns[:, point, :] @ scored.weighed.coefficients
            found.append(
                CandidateCourse(
                    campaign=block.test.campaign,
                    test=block.test.test,
                    t_s=_short(block.t_s),
                    residual_um=_short(block.residual),
                    contribution_um=_short(contribution),
                )
            )
    return found


def _of_these(scored: Scored, problem: Problem) -> bool:
    """Whether it was scored on the problem's own blocks, and on any at all."""
    return len(scored.rows) == len(problem.blocks) == len(scored.columns.blocks) > 0


def chance(measure: Measure) -> list[float]:
    """Quantiles, 0 to 1 in even steps, of the log evidence that the best of all candidates has by chance."""
    if not len(measure.chance):
        return []
    return _short(np.quantile(measure.chance, np.linspace(0, 1, _QUANTILES)))


def _short(values: Float1D) -> list[float]:
    return [float(f"{v:.5g}") for v in values]
