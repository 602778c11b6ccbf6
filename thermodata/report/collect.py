"""Collects a report's data from a store: one fit to its data as they are now, and what its tables say beside it."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from thermodata.modelling.score import role_of
from thermodata.plugin import Array, Bool1D, Float1D
from thermodata.report.data import Curve, ReportData, TestPart, Version
from thermodata.report.records import written_conditions
from thermodata.report.spots import weak_spots_of
from thermodata.report.verdict import claims_of
from thermodata.report.words import base_role, pooled
from thermodata.schema.diagnosis import Diagnosis
from thermodata.schema.model import EffectSpec
from thermodata.schema.result import Score

if TYPE_CHECKING:
    from thermodata.modelling.fitted import FittedModel
    from thermodata.modelling.run import Loaded
    from thermodata.store import Store
    from thermodata.store.catalogue.models import StoredModel
    from thermodata.view.dataset import Dataset, TestData

_LANES = ("rotational_speed", "feed", "power", "load", "state", "flow")
_ROLES = ("calibration", "verification", "locked")
Part = TypeVar("Part", TestPart, Score)
_MOST_LANES, _MOST_DRIVERS = 6, 8


def collect(store: Store, ref: str) -> ReportData:
    """All of a report about a model (id, prefix or name). Opens no locked test."""
    from thermodata.modelling.result import make_result
    from thermodata.modelling.run import load
    from thermodata.modelling.seen import see
    from thermodata.store.catalogue.models import find_model, load_diagnosis, model_chain

    stored = find_model(store, ref)
    chain = model_chain(store, stored.model)
    loaded = load(store, stored.model, uncertainty=True)
    diagnosis = load_diagnosis(store, stored.model)
    reason = _reason([load_diagnosis(store, m.model) for m in chain[:-1]])
    responses = tuple(r.name for r in loaded.fitted.responses)
    # curves, scores and parameters are of one fit; what was kept may be of data that have changed since
    result = make_result(loaded.fitted, loaded.data, stored.model)
    scores = [_scores_today(store, m, loaded) for m in chain[:-1]] + [result.scores]
    before = scores[-2] if len(chain) > 1 else stored.result.before or []
    conditions = written_conditions(r["spec"] for r in _rows(store, "select spec from campaign"))
    return ReportData(
        model=stored.model,
        name=stored.name,
        campaigns=stored.spec.campaign_ids,
        machine=_machines(loaded),
        responses=responses,
        unit=next((r.unit for r in loaded.fitted.responses), "um"),
        effects=tuple(t.id for t in loaded.fitted.responses[0].terms) if responses else (),
        created=_created(store, stored.model),
        parameters=result.parameters,
        scores=_by_role(result.scores),
        checks=result.checks,
        before=before,
        tests=tuple(_by_role(_tests(loaded.fitted, loaded.data, conditions))),
        versions=versions(chain, scores),
        diagnosis=diagnosis,
        reason=reason,
        weak=weak_spots_of(loaded, (reason, diagnosis)),
        calibrations=tuple(_calibrations(store, stored.spec.campaign_ids)),
        looks=_looks(store, [m.model for m in chain]),
        first=tuple(_by_role(_first(store, chain, loaded))),
        stale=stored.stale,
        systems=tuple(see(loaded.fitted, loaded.data)),
    )


def _refitted(store: Store, version: StoredModel, loaded: Loaded) -> tuple[FittedModel, Dataset]:
    """A version of the same chain on the data as they are now."""
    from thermodata.modelling.fit import fit_model
    from thermodata.modelling.run import load_data

    same = (version.spec.campaign_ids, version.spec.step) == (loaded.fitted.spec.campaign_ids, loaded.fitted.spec.step)
    data = loaded.data if same else load_data(store, version.spec)
    return fit_model(version.spec, data, uncertainty=False), data


def _scores_today(store: Store, version: StoredModel, loaded: Loaded) -> list[Score]:
    if not version.stale:
        return version.result.scores
    from thermodata.modelling.score import scores

    return scores(*_refitted(store, version, loaded), version.model)


def _first(store: Store, chain: Sequence[StoredModel], loaded: Loaded) -> Iterable[TestPart]:
    """The tests as the chain's first version foretells them; nothing where there is no other version."""
    if len(chain) > 1:
        yield from _tests(*_refitted(store, chain[0], loaded), {})


def _reason(earlier: Sequence[Diagnosis | None]) -> Diagnosis | None:
    """Why the last effect was added. earlier: of the ancestors, oldest first. Each claim of one answer becomes a
    version of its own, so the answer may stand as many versions back as it has claims."""
    for back, found in enumerate(reversed(earlier), 1):
        if found is not None:
            return found if back <= max(1, len(claims_of(found))) else None
    return None


def _by_role(rows: Iterable[Part]) -> list[Part]:
    """In the order of the work: calibration, verification, the rest; within a role as they came."""
    return sorted(rows, key=lambda r: _ROLES.index(base_role(r.role)) if base_role(r.role) in _ROLES else len(_ROLES))


def versions(chain: Sequence[StoredModel], scored: Sequence[list[Score]] | None = None) -> tuple[Version, ...]:
    """The chain as rows, oldest first, with what each version added to the one before it. scored: the scores of each,
    those that were kept with it where None."""
    from thermodata.modelling.resolve import term_ids

    made: list[Version] = []
    known: dict[str, str] = {}
    for i, m in enumerate(chain):
        ids = term_ids(m.spec.effects)
        fresh = (
            [
                _in_words(spec, name) if name not in known else f"{name} by {_parted_by(spec)}"
                for spec, name in zip(m.spec.effects, ids, strict=True)
                if name not in known or known[name] != _parted_by(spec)
            ]
            if i
            else []
        )
        scores = scored[i] if scored is not None else m.result.scores
        made.append(
            Version(
                m.model,
                m.name,
                ", ".join(fresh) or None,
                pooled(scores, "calibration", "verification"),
                pooled(scores, "calibration"),
                pooled(scores, "verification"),
                m.stale,
            )
        )
        known = {name: _parted_by(spec) for name, spec in zip(ids, m.spec.effects, strict=True)}
    return tuple(made)


def history_rows(store: Store, ref: str) -> list[dict[str, Any]]:
    """The versions that led to a model, oldest first, as `thermodata history --json` prints them."""
    from thermodata.store.catalogue.models import model_chain

    chain = model_chain(store, ref)
    return [
        {
            "model": v.model,
            "name": v.name,
            "parent": m.parent,
            "added": v.added,
            "rmse_um": v.all_um,
            "calibration_rmse_um": v.calibration_um,
            "verification_rmse_um": v.verification_um,
            "stale": v.stale,
        }
        for v, m in zip(versions(chain), chain, strict=True)
    ]


def test_parts(loaded: Loaded) -> list[TestPart]:
    """Every open test of a model and response, by role."""
    return _by_role(_tests(loaded.fitted, loaded.data, {}))


test_parts.__test__ = False  # type: ignore[attr-defined]


def _parted_by(spec: EffectSpec) -> str:
    """What its gain belongs to, as the model file has it; '' where one gain serves all."""
    return " and ".join([spec.gain_by] if isinstance(spec.gain_by, str) else spec.gain_by or [])


def _in_words(spec: EffectSpec, term: str) -> str:
    """An effect's name says what it is; a plain lag is told by its channel."""
    if spec.effect not in ("lag", "static"):
        return term
    acts = f" in {' and '.join(spec.phases)}" if spec.phases else ""
    return f"{spec.effect}({', '.join(d if isinstance(d, str) else d.at for d in spec.drivers.values())}){acts}"


def _tests(
    fitted: FittedModel, data: Dataset, conditions: Mapping[tuple[str, str], dict[str, Any]]
) -> Iterable[TestPart]:
    """A part for every open test and response that can be predicted, in the order of the data."""
    from thermodata.modelling.table import prediction_columns

    drivers = _driver_names(fitted, data)
    for test in fitted.tests(data):
        for response in fitted.responses:
            if response.can_predict(test):
                columns = prediction_columns(response, test)
                role = role_of(fitted, test)
                yield _part(test, response.name, role, columns, drivers, conditions.get(test.key, {}))


def _part(
    test: TestData,
    response: str,
    role: str,
    found: Mapping[str, Array],
    drivers: Sequence[str],
    conditions: dict[str, Any],
) -> TestPart:
    """One prediction with the state of its test, on the prediction's own grid."""
    columns = {name: np.asarray(values, dtype=np.float64) for name, values in found.items()}
    step = float(test.t_s[1] - test.t_s[0]) if len(test.t_s) > 1 else 30.0
    start = float(columns["t_s"][0]) if len(columns["t_s"]) else 0.0
    # a grid with a hole (rows left out) is widened: the page draws by index
    index = np.rint((columns["t_s"] - start) / step).astype(np.int64)
    n = int(index[-1]) + 1 if len(index) else 0

    def spread(values: Float1D) -> Float1D:
        full = np.full(n, np.nan)
        full[index] = values
        return full

    def deviation(name: str) -> Float1D | None:
        known = columns.get(f"sd__{name}")
        return None if known is None else spread(known)

    valid = columns["valid"] > 0
    prefix = "c__"
    inside = (test.t_s >= start - step / 2) & (test.t_s < start + (n - 0.5) * step)
    return TestPart(
        campaign=test.campaign,
        test=test.test,
        kind=test.kind,
        role=role,
        response=response,
        start_s=start,
        step_s=step,
        measured=spread(columns["measured"]),
        predicted=spread(columns["predicted"]),
        residual=spread(np.where(valid, columns["residual"], np.nan)),
        contributions=tuple(
            Curve(name.removeprefix(prefix), "", spread(values), deviation(name.removeprefix(prefix)))
            for name, values in columns.items()
            if name.startswith(prefix)
        ),
        drivers=_curves(test, drivers, inside)[:_MOST_DRIVERS],
        lanes=_curves(test, _lane_names(test), inside)[:_MOST_LANES],
        conditions=conditions,
        phases=dict(test.phases),
        predicted_sd=deviation("predicted"),
    )


def _curves(test: TestData, names: Iterable[str], inside: Bool1D) -> tuple[Curve, ...]:
    """The channels that move in this test; NaN where they are not valid."""
    return tuple(
        Curve(name, test.channels[name].unit, np.where(test.valid[name], test.values[name], np.nan)[inside])
        for name in names
        if _moves(test, name, inside)
    )


def _moves(test: TestData, name: str, inside: Bool1D) -> bool:
    """Whether the channel is there and says something in this test."""
    if name not in test.values or name not in test.channels:
        return False
    values = test.values[name][inside & test.valid[name]]
    return bool(len(values) and np.ptp(values) > 0)


def _lane_names(test: TestData) -> list[str]:
    found = [c for c in test.channels.values() if c.quantity in _LANES]
    return [c.name for c in sorted(found, key=lambda c: _LANES.index(c.quantity))]


def _driver_names(fitted: FittedModel, data: Dataset) -> list[str]:
    """The temperatures that the model's effects are driven by."""
    from thermodata.modelling.drivers import names_of

    names = [
        name
        for response in fitted.responses
        for term in response.terms
        for text in term.binding.values()
        for name in names_of(text)
    ]
    info = data.channels
    return [n for n in dict.fromkeys(names) if n in info and info[n].quantity.startswith("temperature")]


def _machines(loaded: Loaded) -> str:
    return ", ".join(sorted({t.machine for t in loaded.data.tests if t.machine}))


def _created(store: Store, model: str) -> str:
    rows = _rows(store, "select created_at from model where model = ?", [model])
    return f"{rows[0]['created_at']:%Y-%m-%d %H:%M} UTC" if rows else ""


def _calibrations(store: Store, campaigns: Sequence[str]) -> list[dict[str, Any]]:
    marks = ", ".join("?" for _ in campaigns)
    rows = _rows(
        store, f"select * from calibration where campaign in ({marks}) order by campaign, calibration", list(campaigns)
    )
    return [{**row, "checks": json.loads(row["checks"] or "[]")} for row in rows]


def _looks(store: Store, models: Sequence[str]) -> dict[str, int]:
    marks = ", ".join("?" for _ in models)
    rows = _rows(
        store,
        f"select campaign, test, count(*) as n from locked_look where model in ({marks}) group by all",
        list(models),
    )
    return {f"{row['campaign']}/{row['test']}": int(row["n"]) for row in rows}


def _rows(store: Store, query: str, params: list[Any] | None = None) -> list[dict[str, Any]]:
    from thermodata.store.base.connection import fetch

    with store.reader() as con:
        found: list[dict[str, Any]] = fetch(con, query, params)
    return found
