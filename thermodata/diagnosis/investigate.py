"""One fitted response, investigated: the problem, the ranked candidates, the steps, the weak spots, the judgement."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.diagnosis.artefact import as_artefacts, find_steps
from thermodata.diagnosis.candidates import GENERIC, SLACK_FACTORS, TIME_UNITS, candidates
from thermodata.diagnosis.evidence import Measure, passes, remaining
from thermodata.diagnosis.judge import TRIED, Judgement, Pair, judge, simplest
from thermodata.diagnosis.logging_faults import clock_offsets, first_of_each, turned_probes, wrong_parameters
from thermodata.diagnosis.problem import Base, Problem, build_problem
from thermodata.diagnosis.rank import rank
from thermodata.diagnosis.scored import Scored
from thermodata.diagnosis.weak import weak_spots
from thermodata.modelling.drivers import names_of
from thermodata.modelling.fitted_response import FittedResponse, FittedTerm
from thermodata.plugin import Effect, Float1D, Float2D
from thermodata.schema.result import Artefact, WeakSpot
from thermodata.view.dataset import ChannelInfo, Dataset, TestData

# half-width, in the logarithm, of the difference quotient that lets a known time constant move
TANGENT = 0.1


@dataclass(frozen=True, slots=True)
class Investigation:
    problem: Problem
    ranked: list[Scored]
    artefacts: list[Artefact]
    spots: list[WeakSpot]
    judgement: Judgement
    measure: Measure


def investigate(
    fitted: FittedResponse,
    data: Dataset,
    tests: Sequence[TestData],
    library: Mapping[str, Effect],
    seed: int = 0,
    *,
    as_fitted: FittedResponse | None = None,
) -> Investigation:
    """fitted: to all tests that take part in the choice (never the locked ones). as_fitted: the model that is asked
    about, whose weak spots are shown; by default the same."""
    info = data.channels[fitted.name]
    base = remembered_base(fitted)
    problem = build_problem(
        data,
        tests,
        fitted.name,
        info.unit,
        measured=fitted.measured,
        residual=fitted.residual,
        mask=fitted.mask,
        base=base,
        slack=lambda test: slack_columns(fitted, test),
    )
    steps = find_steps(problem)
    at: dict[tuple[str, str], list[float]] = {}
    for step in steps:
        at.setdefault(step.test.key, []).append(step.at_s)
    faults = _faults(fitted, data, problem, base)
    problem = problem.split(at)
    present = [
        (t.effect.name, frozenset(n for text in t.binding.values() for n in names_of(text))) for t in fitted.terms
    ]
    families = frozenset(t.family for t in fitted.terms) - {GENERIC}
    asked = candidates(library, data.channels, present, fitted.name)
    ranked = rank(problem, asked, seed)
    whole = np.concatenate(problem.response_blocks) if problem.blocks else np.zeros(1)
    measure = Measure(problem.rows, float(np.sqrt(np.mean(whole**2))), problem.noise, families)
    asked_about = fitted if as_fitted is None else as_fitted
    spots = weak_spots([(t, asked_about.residual(t), asked_about.mask(t)) for t in tests], problem.noise)

    def with_second(first: Scored) -> Pair:
        others = rank(problem.with_effect(first), [c for c in asked if c is not first.candidate], seed)
        good = [s for s in others[:TRIED] if not passes(s, measure)]
        second = simplest(good) if good else None
        return Pair(second, remaining(first.sse_after if second is None else second.sse_after, measure))

    judgement = judge(problem, ranked, measure, with_second)
    faults = gains_are_wrong_only_where_nothing_is_missing(faults, judgement)
    if ranked:
        faults += wrong_parameters(
            problem, _error_of(asked_about, tests), remaining(ranked[0].sse_before, measure), measure.floor
        )
    artefacts = first_of_each([*as_artefacts(steps, info.unit), *faults])
    return Investigation(problem, ranked, artefacts, spots, judgement, measure)


def _error_of(fitted: FittedResponse, tests: Sequence[TestData]) -> float:
    """RMS residual over what counts, a free offset for each test."""
    parts = [fitted.residual(t)[fitted.mask(t)] for t in tests]
    whole = np.concatenate([p - p.mean() for p in parts if len(p)] or [np.zeros(1)])
    return float(np.sqrt(np.mean(whole**2)))


def gains_are_wrong_only_where_nothing_is_missing(faults: list[Artefact], judgement: Judgement) -> list[Artefact]:
    """A missing effect also makes one test larger or smaller than the others say."""
    return faults if judgement.verdict == "none" else [f for f in faults if f.kind != "gain"]


def clocks_beside(channels: Mapping[str, ChannelInfo], drivers: Iterable[str], response: str) -> dict[str, str]:
    """Driver -> source, of the drivers that were logged by another source than the response."""
    home = channels[response].source
    return {n: s for n in drivers if n in channels and (s := channels[n].source) and s != home}


def _faults(fitted: FittedResponse, data: Dataset, problem: Problem, base: Base) -> list[Artefact]:
    """Clocks and probes, where there is a model to hold them against."""
    if not problem.blocks or not problem.blocks[0].base.shape[1]:
        return []
    drivers = {n for t in fitted.terms for text in t.binding.values() for n in names_of(text)}
    sources = clocks_beside(data.channels, drivers, fitted.name)
    moved = clock_offsets(problem, base, sources)
    return [*moved, *turned_probes(problem)]


def base_columns(fitted: FittedResponse, test: TestData) -> Float2D:
    """What the fitted model can still do in this test, shape (n, k): its gains, and its time constants to first order.

    The known effects are refitted together with each candidate: a base model held fixed leaves residuals that any
    slow channel explains, which raises false claims to a third.
    """
    return remembered_base(fitted)(test)


def remembered_base(fitted: FittedResponse) -> Base:
    """`base_columns`; of a copy of a test in which some channels are changed, only the terms that read these are made
    anew."""
    kept: dict[tuple[int, tuple[str, str]], tuple[list[Float1D], list[Float2D]]] = {}

    def base(test: TestData) -> Float2D:
        columns: list[Float2D] = []
        for i, term in enumerate(fitted.terms):
            binding = term.bound.bindings.get(test.campaign, term.binding)
            read = [test.values[n] for text in binding.values() for n in names_of(text) if n in test.values]
            before, made = kept.get((i, test.key), (None, []))
            if before is None or not all(a is b for a, b in zip(before, read, strict=True)):
                made = _term_columns(term, test)
                kept.setdefault((i, test.key), (read, made))
            columns += made
        return np.column_stack(columns) if columns else np.zeros((len(test.t_s), 0))

    return base


def _term_columns(term: FittedTerm, test: TestData) -> list[Float2D]:
    """Each in the response's unit: a coefficient of 1 doubles the effect, or moves a time constant by a factor of e."""
    values = term.values(test)
    size = len(test.t_s)
    moving = [p for p in term.effect.params if p.upper > p.lower]
    if values is None or not term.bound.covers(test):
        return [np.zeros((size, len(term.effect.gains) + len(moving)))]
    gains = np.array([values.gains[g.name] for g in term.effect.gains])
    columns = [term.columns(test) * np.where(gains == 0, 1.0, gains)]
    for param in moving:
        value = values.params[param.name]
        up = {**values.params, param.name: min(value * np.exp(TANGENT), param.upper)}
        down = {**values.params, param.name: max(value * np.exp(-TANGENT), param.lower)}
        change = term.bound.columns(test, up) - term.bound.columns(test, down)
        width = np.log(up[param.name] / down[param.name]) if down[param.name] > 0 else 2 * TANGENT
        columns.append((change @ gains)[:, None] / max(float(width), 1e-9))
    return columns


def slack_columns(fitted: FittedResponse, test: TestData) -> Float2D:
    """How a known effect may differ from its one time constant, shape (n, k), each column in the response's unit.

    A machine is distributed: the same heat also acts faster and slower than the fitted lag. That is no missing
    effect, so the base model may have it, at a price (see `cross_validation.Engine`).
    """
    columns = []
    for term in fitted.terms:
        values = term.values(test)
        for param in term.effect.params:
            if param.unit not in TIME_UNITS:
                continue
            for factor in SLACK_FACTORS:
                if values is None or not term.bound.covers(test):
                    columns.append(np.zeros(len(test.t_s)))
                    continue
                gains = np.array([values.gains[g.name] for g in term.effect.gains])
                other = {**values.params, param.name: values.params[param.name] * factor}
                columns.append((term.bound.columns(test, other) - term.columns(test)) @ gains)
    return np.column_stack(columns) if columns else np.zeros((len(test.t_s), 0))
