"""Collects a report's data from a store: its tables, the stored predictions, and the tests' operating state."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from thermodata.plugin import Bool1D, Float1D
from thermodata.report.data import Curve, ReportData, TestPart, Version
from thermodata.report.records import written_conditions
from thermodata.report.spots import weak_spots_of
from thermodata.report.verdict import claims_of
from thermodata.report.words import base_role, pooled
from thermodata.schema.model import EffectSpec
from thermodata.schema.result import Diagnosis, Score

if TYPE_CHECKING:
    from thermodata.modelling.run import Loaded
    from thermodata.store import Store
    from thermodata.store.catalogue.models import StoredModel
    from thermodata.view.dataset import TestData

_LANES = ("rotational_speed", "feed", "power", "load", "state", "flow")
_ROLES = ("calibration", "verification", "locked")
Part = TypeVar("Part", TestPart, Score)
_MOST_LANES, _MOST_DRIVERS = 6, 8


def collect(store: Store, ref: str) -> ReportData:
    """All of a report about a model (id, prefix or name). Opens no locked test."""
    from thermodata.modelling.run import load
    from thermodata.store.catalogue.models import find_model, load_diagnosis, model_chain

    stored = find_model(store, ref)
    chain = model_chain(store, stored.model)
    loaded = load(store, stored.model)
    diagnosis = load_diagnosis(store, stored.model)
    reason = _reason([load_diagnosis(store, m.model) for m in chain[:-1]])
    responses = tuple(r.name for r in loaded.fitted.responses)
    result = stored.result
    before = result.before or (chain[-2].result.scores if len(chain) > 1 else [])
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
        tests=tuple(_by_role(_tests(store, stored.model, loaded))),
        versions=versions(chain),
        diagnosis=diagnosis,
        reason=reason,
        weak=weak_spots_of(loaded, (reason, diagnosis)),
        calibrations=tuple(_calibrations(store, stored.spec.campaign_ids)),
        looks=_looks(store, [m.model for m in chain]),
        stale=stored.stale,
    )


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


def versions(chain: Sequence[StoredModel]) -> tuple[Version, ...]:
    """The chain as rows, oldest first, with what each version added to the one before it."""
    from thermodata.modelling.resolve import term_ids

    made: list[Version] = []
    known: dict[str, str | None] = {}
    for i, m in enumerate(chain):
        ids = term_ids(m.spec.effects)
        fresh = (
            [
                _in_words(spec, name) if name not in known else f"{name} by {spec.gain_by}"
                for spec, name in zip(m.spec.effects, ids, strict=True)
                if name not in known or known[name] != spec.gain_by
            ]
            if i
            else []
        )
        scores = m.result.scores
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
        known = {name: spec.gain_by for name, spec in zip(ids, m.spec.effects, strict=True)}
    return tuple(made)


def _in_words(spec: EffectSpec, term: str) -> str:
    """An effect's name says what it is; a plain lag is told by its channel."""
    if spec.effect not in ("lag", "static"):
        return term
    return f"{spec.effect}({', '.join(d if isinstance(d, str) else d.at for d in spec.drivers.values())})"


def _tests(store: Store, model: str, loaded: Loaded) -> Iterable[TestPart]:
    """A part for every stored prediction, in the order of the data."""
    rows = _rows(store, "select campaign, test, response, path from prediction where model = ?", [model])
    paths = {(r["campaign"], r["test"], r["response"]): store.path / r["path"] for r in rows}
    conditions = written_conditions(r["spec"] for r in _rows(store, "select spec from campaign"))
    drivers = _driver_names(loaded)
    for test in loaded.data.tests:
        for response in loaded.fitted.responses:
            path = paths.get((test.campaign, test.test, response.name))
            if path is not None and path.is_file():
                yield _part(
                    test, response.name, loaded.fitted.roles.role(test.key), path, drivers, conditions.get(test.key, {})
                )


def _part(
    test: TestData, response: str, role: str, path: Path, drivers: Sequence[str], conditions: dict[str, Any]
) -> TestPart:
    """One prediction with the state of its test, on the prediction's own grid."""
    import pyarrow.parquet as pq

    table = pq.read_table(path)
    columns = {name: np.asarray(table[name].to_numpy(), dtype=np.float64) for name in table.column_names}
    step = float(test.t_s[1] - test.t_s[0]) if len(test.t_s) > 1 else 30.0
    start = float(columns["t_s"][0]) if table.num_rows else 0.0
    # a grid with a hole (rows left out) is widened: the page draws by index
    index = np.rint((columns["t_s"] - start) / step).astype(np.int64)
    n = int(index[-1]) + 1 if len(index) else 0

    def spread(values: Float1D) -> Float1D:
        full = np.full(n, np.nan)
        full[index] = values
        return full

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
            Curve(name.removeprefix(prefix), "", spread(values))
            for name, values in columns.items()
            if name.startswith(prefix)
        ),
        drivers=_curves(test, drivers, inside)[:_MOST_DRIVERS],
        lanes=_curves(test, _lane_names(test), inside)[:_MOST_LANES],
        conditions=conditions,
        phases=dict(test.phases),
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


def _driver_names(loaded: Loaded) -> list[str]:
    """The temperatures that the model's effects are driven by."""
    from thermodata.modelling.drivers import names_of

    names = [
        name
        for response in loaded.fitted.responses
        for term in response.terms
        for text in term.binding.values()
        for name in names_of(text)
    ]
    info = loaded.data.channels
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
