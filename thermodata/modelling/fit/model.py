"""Fitting: all calibration tests together, each with its own offset; effects with tests of their own come first."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from thermodata.errors import UsageError
from thermodata.modelling.fit.arx import identify_arx, placeholder
from thermodata.modelling.fit.joint import FitSettings, fit_jointly
from thermodata.modelling.fit.orders import Near, Tried, choose_orders, open_orders
from thermodata.modelling.fit.places import fit_together, together
from thermodata.modelling.fit.staged import moved_as_well, refined, stages_of
from thermodata.modelling.inputs.counted_samples import refuse_unknown_phases
from thermodata.modelling.inputs.overlap import overlaps
from thermodata.modelling.inputs.roles import Key, Roles, fitted_keys
from thermodata.modelling.model_file.resolve import resolve
from thermodata.modelling.terms.bound import BoundResponse
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse, FittedTerm, has_response
from thermodata.modelling.terms.usable import usable_tests
from thermodata.modelling.trust.checks.of_every_fit import checks
from thermodata.schema.files.model import Model
from thermodata.store.base.counting import counted
from thermodata.view.grid.dataset import Dataset, TestData

_SHOWN = 8  # tests, each with what it lacks


def fit_model(
    spec: Model,
    data: Dataset,
    *,
    base: Path | None = None,
    uncertainty: bool = True,
    profiled: Collection[str] | None = None,
) -> FittedModel:
    """Fit every response of a model. base: the folder that `file` of an effect is relative to (default: here).
    profiled: ids of the effects whose intervals are looked at by their profiles, which costs most of a fit (default:
    all); those of the others are as wide up as down.

    Tests that lack the response or a driver are skipped and named in `.skipped`. Raises SpecError where the spec does
    not fit the data, UsageError where no calibration test is left. It runs on one core: its matrices are so small that
    threads of the linear algebra library wait for each other, four times as long as they work.
    """
    import scipy.optimize  # noqa: F401 - brings a library of its own, which is limited with the others
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1):
        return _fit_model(spec, data, base, uncertainty, None if profiled is None else frozenset(profiled))


def _fit_model(
    spec: Model, data: Dataset, base: Path | None, uncertainty: bool, profiled: frozenset[str] | None
) -> FittedModel:
    inside = _fitter_of_models_inside(data, base)
    roles, bound = resolve(spec, data, base, inside)
    wanted = None if spec.phases is None else tuple(spec.phases)
    for names in (wanted, *(effect.phases for effect in spec.effects)):
        refuse_unknown_phases(names, data.tests)
    skipped = list[str]()
    keys = fitted_keys(spec, roles)
    open_tests: list[list[TestData]] = []
    for response in bound:
        usable, why = usable_tests(response, [data.test(*key) for key in keys])
        open_tests.append(usable)
        skipped += why
        # a place without a test of its own has its parameters from the others
        if why and not usable and not together(bound):
            raise UsageError(
                "no calibration test has all that the model reads",
                where=f"response '{response.name}'",
                expected="the response and the drivers of all effects in one test at least",
                got="; ".join(why[:_SHOWN]) + ("; ..." if len(why) > _SHOWN else ""),
                hint=_what_to_give(response, [data.test(*key) for key in keys]),
            )
    if together(bound):
        fitted = fit_together(bound, open_tests, wanted, data, fit_response)
        if uncertainty:
            # a place without a calibration test has its parameters from the others
            said = [
                checks(r, t) if t else {"checks": (), "noise": None} for r, t in zip(fitted, open_tests, strict=True)
            ]
            fitted = [replace(r, **own) for r, own in zip(fitted, said, strict=True)]
    else:
        fitted = [
            fit_response(response, usable, wanted, data, uncertainty=uncertainty, profiled=profiled)
            for response, usable in zip(counted(bound, "responses"), open_tests, strict=True)
        ]
    responses = tuple(
        _with_its_tests(response, roles, _tests_read(response.bound, own, data), data)
        for response, own in zip(fitted, _tests_fitted_to(bound, open_tests), strict=True)
    )
    again = overlaps(data, roles, keys, [response.bound.channel_of for response in responses])
    return FittedModel(spec, roles, responses, tuple(dict.fromkeys(skipped)), overlaps=again)


def _what_to_give(response: BoundResponse, tests: Sequence[TestData]) -> str:
    """What helps where no calibration test has all that a model reads."""
    if any(has_response(response, test) for test in tests):
        return "give a test that has all of it the role calibration, or take the effect out whose driver no test has"
    return (
        "give a test that has the response the role calibration; a probe in volts has no displacement before it has "
        "a calibration (a jump test, or kind: scale with a gain in um/V): thermodata ingest says where one is missing"
    )


def _with_its_tests(response: FittedResponse, roles: Roles, fitted_on: frozenset[Key], data: Dataset) -> FittedResponse:
    """Of several campaigns the least sure calibration counts: what errs in one may err in all."""
    infos = [t.channels.get(response.bound.channel_of(t)) for t in data.tests if t.key in fitted_on]
    scale = max((info.scale_pct or 0.0 for info in infos if info is not None), default=0.0) / 100.0
    return replace(response, calibrate=frozenset(roles.calibrate), fitted_on=fitted_on, scale=scale)


def _tests_fitted_to(bound: Sequence[BoundResponse], open_tests: Sequence[list[TestData]]) -> list[list[TestData]]:
    """The tests that each response has its parameters from: those of all, where they are fitted together."""
    return [[t for tests in open_tests for t in tests]] * len(bound) if together(bound) else list(open_tests)


def _tests_read(bound: BoundResponse, tests: Sequence[TestData], data: Dataset) -> frozenset[Key]:
    """These tests, and those that an effect which is identified first has of its own."""
    first = [
        usable_tests(replace(stage.bound, terms=tuple(bound.terms[i] for i in stage.members)), stage.tests)[0]
        for stage in stages_of(bound, tests, data)
    ]
    return frozenset(t.key for part in (tests, *first) for t in part)


def _fitter_of_models_inside(data: Dataset, base: Path | None) -> Callable[[Model], FittedModel]:
    """A model that several responses hold is fitted once."""
    kept: dict[str, FittedModel] = {}

    def fit(inside: Model) -> FittedModel:
        key = inside.model_dump_json(by_alias=True)
        if key not in kept:
            kept[key] = fit_model(inside, data, base=base, uncertainty=False)
        return kept[key]

    return fit


def fit_response(
    bound: BoundResponse,
    tests: Sequence[TestData],
    wanted: tuple[str, ...] | None,
    data: Dataset | None = None,
    *,
    uncertainty: bool = True,
    profiled: frozenset[str] | None = None,
) -> FittedResponse:
    """Fit one response to some tests (all must have its drivers). data: where effects that are identified first
    find their own tests (default: among `tests`). profiled: as of `fit_model`."""
    how, tried = FitSettings(wanted, uncertainty, of=profiled), list[Tried]()
    held: dict[int, FittedTerm] = {}
    stages = stages_of(bound, tests, data)
    for stage in stages:
        part = replace(stage.bound, terms=tuple(bound.terms[i] for i in stage.members))
        first, why = usable_tests(part, stage.tests)
        if not first:
            raise UsageError(
                "no usable test for an effect that is identified first",
                where=", ".join(bound.terms[i].id for i in stage.members),
                expected=f"'{stage.bound.name}' and the drivers in "
                + (", ".join("/".join(t.key) for t in stage.tests) or "a test"),
                got="; ".join(why[:_SHOWN]) or None,
                hint="list tests in its 'tests' that have these channels, or leave 'tests' out to identify "
                "it with the others",
            )
        known, found = _identify(stage.bound, stage.members, {}, first, replace(how, wanted=None), tried)
        bound = replace(bound, terms=known.terms)
        held |= {i: replace(found[i], held=True) for i in stage.members}
    rest = [i for i in range(len(bound.terms)) if i not in held]
    bound, found = _identify(bound, rest, held, tests, how, tried)
    fitted = refined(bound, {**held, **found}, tests, stages, how)
    terms = tuple(fitted[i] for i in range(len(bound.terms)))
    response = FittedResponse(bound, terms, wanted, frozenset(t.key for t in tests))
    response = replace(response, tried=tuple(tried))
    if not uncertainty:
        return response
    said = checks(response, tests)
    return replace(response, checks=(*said["checks"], *moved_as_well(response, stages)), noise=said["noise"])


def _identify(
    bound: BoundResponse,
    members: Sequence[int],
    held: Mapping[int, FittedTerm],
    tests: Sequence[TestData],
    how: FitSettings,
    tried: list[Tried],
) -> tuple[BoundResponse, dict[int, FittedTerm]]:
    """Some terms together, with others held; the response with the orders that were open."""
    for i in (i for i in open_orders(bound) if i in members):
        choice = choose_orders(bound, i, tests, how.wanted, partial(_with_given_orders, members, held, how))
        bound, how = choice.bound, replace(how, near=choice.near)
        tried += choice.table
    return _given_orders(bound, members, held, tests, how)


def _with_given_orders(
    members: Sequence[int],
    held: Mapping[int, FittedTerm],
    how: FitSettings,
    bound: BoundResponse,
    tests: Sequence[TestData],
    near: Near,
    uncertainty: bool,
) -> FittedResponse:
    """The response of these terms alone, while orders are tried."""
    trial = FitSettings(how.wanted, uncertainty, near, loose=not uncertainty, profiled=False)
    bound, found = _given_orders(bound, members, held, tests, trial)
    terms = {**held, **found}
    part = replace(bound, terms=tuple(t for i, t in enumerate(bound.terms) if i in terms))
    return FittedResponse(part, tuple(terms[i] for i in sorted(terms)), how.wanted, frozenset(t.key for t in tests))


def _given_orders(
    bound: BoundResponse,
    members: Sequence[int],
    held: Mapping[int, FittedTerm],
    tests: Sequence[TestData],
    how: FitSettings,
) -> tuple[BoundResponse, dict[int, FittedTerm]]:
    bound, arx = _with_placeholders(bound, members)
    if not arx:
        return bound, fit_jointly(bound, members, held, tests, how)
    anew = replace(how, near=None)
    found = fit_jointly(bound, members, held, tests, replace(anew, uncertainty=False))
    for i in arx:
        bound = identify_arx(bound, i, {**held, **found}, tests, how.wanted)
    return bound, fit_jointly(bound, members, held, tests, anew)


def _with_placeholders(bound: BoundResponse, members: Sequence[int]) -> tuple[BoundResponse, list[int]]:
    arx = [i for i, t in enumerate(bound.terms) if i in members and t.spec.method == "arx" and t.effect.params]
    terms = tuple(placeholder(t) if i in arx else t for i, t in enumerate(bound.terms))
    return replace(bound, terms=terms), arx
