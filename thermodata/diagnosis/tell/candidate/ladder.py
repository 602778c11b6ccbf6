"""The evidence of one candidate rung by rung, for who doubts it: each rule of a claim with its value and its limit,
each left-out test before and after, and the residual with the contribution over it. What decides stands in `rules`."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from thermodata.diagnosis.claims.measure import Measure
from thermodata.diagnosis.claims.rules import Rule, rules
from thermodata.diagnosis.claims.rules_together import surely
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.weigh.scored import Scored
from thermodata.plugin import Float1D
from thermodata.schema.answers.candidate import CandidateCourse, LeftOut, Rung

_QUANTILES = 41


OUTWEIGHED = "; not asked, for the locked tests outweigh it"


def rungs(
    scored: Scored, measure: Measure, unit: str, sure: Scored | None = None, *, claimed: bool = False
) -> list[Rung]:
    """Every rule of a claim, in the order in which they are asked; a candidate may be claimed where all hold. What is
    beside the effects as the model has them is no claim: chance and probability are of effects that act freely.
    sure: of which the probability is told, where it is another of the same equation. claimed: whether it is claimed all
    the same; then what it breaks is outweighed by the locked tests."""
    return [
        Rung(
            name=rule.name,
            asks=rule.asks + (OUTWEIGHED if claimed and not rule.holds else ""),
            value=float(rule.value) if np.isfinite(rule.value) else None,
            limit=float(rule.limit),
            unit=rule.unit,
            at=rule.at,
            holds=bool(rule.holds or claimed),
            asked=bool(rule.asked and (rule.holds or not claimed)),
            fails=None if rule.holds or claimed else rule.fails,
        )
        for rule in (*rules(scored, measure, unit), of_probability(scored, sure or scored))
        if not (scored.as_modelled and rule.name in ("chance", "probability"))
    ]


def of_probability(scored: Scored, sure: Scored) -> Rule:
    """Whether it is a cause, by the probability that is told of it. sure: whose that is; where it is another of the
    same equation, what it hangs on there is no figure of this one, and is not said."""
    rule = surely(sure)
    return rule if sure.candidate is scored.candidate else replace(rule, fails=rule.fails.partition(": ")[0])


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
    found, contribution = [], scored.columns.does(scored.weighed)
    for block, rows, acts in zip(problem.blocks, problem.parts, scored.acts, strict=True):
        if acts and len(block.t_s):
            found.append(
                CandidateCourse(
                    campaign=block.test.campaign,
                    test=block.test.test,
                    t_s=_rounded(block.t_s),
                    residual_um=_rounded(block.residual),
                    contribution_um=_rounded(contribution[rows]),
                )
            )
    return found


def _of_these(scored: Scored, problem: Problem) -> bool:
    """Whether it was scored on the problem's own blocks, and on any at all."""
    return len(scored.rows) == len(problem.blocks) > 0 and len(scored.columns.whole) == problem.rows


def chance(measure: Measure) -> list[float]:
    """Quantiles, 0 to 1 in even steps, of the log evidence that the best of all candidates has by chance."""
    if not len(measure.chance):
        return []
    return _rounded(np.quantile(measure.chance, np.linspace(0, 1, _QUANTILES)))


def _rounded(values: Float1D) -> list[float]:
    return [float(f"{v:.5g}") for v in values]
