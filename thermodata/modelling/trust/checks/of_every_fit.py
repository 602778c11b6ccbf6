"""What every fit says about itself: one row a check, with a threshold and what to do."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from thermodata.modelling.inputs.drivers import names_of
from thermodata.modelling.least_squares.design import Design
from thermodata.modelling.terms.bound import each_group_its_own
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm
from thermodata.modelling.trust.checks.apart import told_apart
from thermodata.modelling.trust.checks.bound_checks import at_bounds
from thermodata.modelling.trust.checks.groups_apart import groups_apart
from thermodata.modelling.trust.checks.term_checks import lags_apart, longer_than_record, own_channel, ripple
from thermodata.modelling.trust.memory import effective_count
from thermodata.plugin import Float1D, Float2D
from thermodata.schema.answers.result import Check
from thermodata.view.grid.dataset import TestData

CONDITION = 1000.0
COLLINEAR = 0.98
FEWEST = 5.0  # independent samples a parameter
LOST = 0.2  # of a test's samples, to flags


def checks(response: FittedResponse, tests: Sequence[TestData]) -> dict[str, Any]:
    """{'checks': ..., 'noise': rms of the calibration residual} of a fitted response."""
    design = Design(response.bound, [each_group_its_own(t.bound) for t in response.terms], tests, response.phases)
    blocks, names, gains = [], [], list[float]()
    for s, slot in enumerate(design.slots):
        term = response.terms[slot.term]
        values = term.groups.get(slot.group)
        if values is None:
            continue
        blocks.append(design.columns(s, values.params))
        tag = f"[{slot.group}]" if slot.group else ""
        names += [f"{term.id}.{g.name}{tag}" for g in term.effect.gains]
        gains += [values.gains[g.name] for g in term.effect.gains]
    matrix = np.concatenate(blocks, axis=1) if blocks else np.zeros((design.n, 0))
    residual = design.y - matrix @ np.array(gains) if gains else design.y
    rows = [
        *_samples(residual, design, sum(_fitted(t) for t in response.terms)),
        *_conditioning(matrix, names),
        *_lost(response, tests),
        *_orders(response),
        *_warm(design),
        *told_apart(response, tests),
    ]
    for term in response.terms:
        rows += [
            *own_channel(response, term, tests),
            *at_bounds(response, term, tests),
            *longer_than_record(term, tests),
            *lags_apart(term),
            *groups_apart(response, term, tests),
            *ripple(response, term, tests),
        ]
    noise = float(np.sqrt(np.mean(residual**2))) if len(residual) else None
    return {"checks": tuple(rows), "noise": noise}


def _fitted(term: FittedTerm) -> int:
    """How many parameters and gains of a term the data set: not what the model file fixes, nor what changes nothing,
    and once what groups share."""
    spec, groups = term.bound.spec, len(term.groups)
    # of an ARX function the file's gain stands for its coefficients
    fixed = {} if spec.method == "arx" else spec.fixed
    held = {*fixed, *next(iter(term.groups.values())).silent} if groups else fixed
    params = [p for p in term.effect.params if p.name not in held and p.upper > p.lower]
    gains = sum(g.name not in fixed for g in term.effect.gains)
    of_gains = gains + groups - 1 if spec.one_gain else gains * groups
    return of_gains + sum(1 if spec.shares(p.name) else groups for p in params)


def _samples(residual: Float1D, design: Design, parameters: int) -> list[Check]:
    count = effective_count(residual, design.parts)
    need = FEWEST * max(1, parameters)
    return [
        Check(
            name="effective_samples",
            value=round(count, 1),
            threshold=need,
            passed=count >= need,
            advice=f"the residual hangs together: {design.n} samples are worth {count:.0f}"
            + ("" if count >= need else f"; {parameters} parameters want {need:.0f}: add tests"),
        )
    ]


def _lost(response: FittedResponse, tests: Sequence[TestData]) -> list[Check]:
    """Tests of which flags take away more than a fifth, of the response or of a driver."""
    read = {n for term in response.terms for text in term.binding.values() for n in names_of(text)}
    rows = []
    for test in tests:
        own = response.bound.channel_of(test)
        named = {n: info for n in (own, *sorted(read - {own})) if (info := test.channels.get(n)) is not None}
        lost = {n: info.lost for n, info in named.items() if info.lost > LOST}
        if not lost:
            continue
        worst = max(lost, key=lambda n: lost[n])
        told = ", ".join(f"{100 * share:.0f} % of '{name}'" for name, share in lost.items())
        rows.append(
            Check(
                name=f"lost_to_flags:{test.campaign}/{test.test}",
                value=lost[worst],
                threshold=LOST,
                passed=False,
                advice=f"{told} does not count in '{test.test}': look at thermodata quality, overrule what is sound, "
                "or leave the test out",
            )
        )
    return rows


def _conditioning(matrix: Float2D, names: list[str]) -> list[Check]:
    size = np.sqrt(np.sum(matrix**2, axis=0)) if matrix.shape[1] else np.zeros(0)
    kept = np.flatnonzero(size > 0)
    rows = [
        Check(
            name=f"not_excited:{names[i]}",
            value=0.0,
            threshold=0.0,
            passed=False,
            advice=f"nothing moves {names[i]} in the calibration tests: add a test that does",
        )
        for i in np.flatnonzero(size == 0)
    ]
    if len(kept) < 2:
        return rows
    unit = matrix[:, kept] / size[kept]
    condition = float(np.linalg.cond(unit))
    rows.append(
        Check(
            name="condition_number",
            value=condition,
            threshold=CONDITION,
            passed=condition <= CONDITION,
            advice="the effects can be told apart"
            if condition <= CONDITION
            else "the data cannot tell the effects apart: remove one, or add a test that moves them separately",
        )
    )
    correlation = unit.T @ unit
    for a in range(len(kept)):
        for b in range(a + 1, len(kept)):
            if abs(correlation[a, b]) > COLLINEAR:
                pair = f"{names[kept[a]]} and {names[kept[b]]}"
                rows.append(
                    Check(
                        name=f"collinear:{names[kept[a]]}:{names[kept[b]]}",
                        value=float(correlation[a, b]),
                        threshold=COLLINEAR,
                        passed=False,
                        advice=f"{pair} move together in these tests",
                    )
                )
    return rows


def _orders(response: FittedResponse) -> list[Check]:
    return [
        Check(
            name=f"orders:{row.effect}",
            value=row.fit_left_out,
            threshold=None,
            passed=True,
            advice=f"{row.numerator} over {row.denominator}{_late(row.delay)} chosen by FIT on what was left out, of "
            f"{sum(other.effect == row.effect for other in response.tried)}; thermodata orders shows them all",
        )
        for row in response.tried
        if row.chosen
    ]


def _late(delay: int) -> str:
    return f", {delay} step{'s' if delay > 1 else ''} late," if delay else ""


def _warm(design: Design) -> list[Check]:
    """Tests that began warm: what faded is left out of the fit, and stands in the scores."""
    return [
        Check(
            name=f"warm_start:{test.campaign}/{test.test}",
            value=None,
            threshold=None,
            passed=True,
            advice="start_state: warm: how warm each part was is not known; what fades from the start was fitted "
            "freely, and the free run begins as that of any other test",
        )
        for test, free in zip(design.tests, design.nuisance, strict=True)
        if free.free is not None
    ]
