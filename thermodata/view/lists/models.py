"""The models of a store, newest first, with their errors by role."""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import TYPE_CHECKING, Any

from thermodata.schema.agreed.effect_ids import ids_of
from thermodata.schema.units.unit import difference_unit
from thermodata.store.base.connection import fetch

if TYPE_CHECKING:
    from thermodata.store import Store


@dataclass(frozen=True, slots=True)
class ModelRow:
    """version: its place in the chain of versions, 1 is the first. effects: names in the order of the model file,
    terms: their ids there, as predictions name them.
    calibration_um, verification_um: RMSE over tests of the role, in `unit`, of the worst response in the unit of the
    first. verdict: of its diagnosis, None where it has none. label: its name and version, after its campaign where
    models of several campaigns have the name, and with its id where another model has these too. fitted: the last fit
    has the largest, of a version that is new or of an older one again.
    tests: how many it was fitted to. in_sample: whether verification tests are among them."""

    model: str
    name: str
    version: int
    parent: str | None
    created_at: datetime
    stale: bool
    campaigns: tuple[str, ...]
    responses: tuple[str, ...]
    unit: str
    effects: tuple[str, ...]
    terms: tuple[str, ...]
    calibration_um: float | None
    verification_um: float | None
    verdict: str | None
    label: str
    fitted: int
    tests: int
    in_sample: bool = False


_MODELS = """
with u as (select m.model, c.channel as response, min(nullif(c.unit, '')) as unit from model m, channel c
           where list_contains(m.campaigns, c.campaign)
           and list_contains(string_split(m.response, ', '), c.channel) group by all),
first as (select m.model, u.unit from model m left join u
          on u.model = m.model and u.response = string_split(m.response, ', ')[1]),
e as (select h.model, max(h.version) as version,
             max(h.rmse_um_calibration) filter (u.unit is not distinct from f.unit) as calibration,
             max(h.rmse_um_verification) filter (u.unit is not distinct from f.unit) as verification
      from history h join first f on f.model = h.model
      left join u on u.model = h.model and u.response = h.response group by h.model),
n as (select model, count(distinct (campaign, test)) as tests, bool_or(role <> 'calibration') as in_sample
      from score_row where role in ('calibration', 'verification (in-sample)') group by model),
d as (select model, arg_max(verdict, created_at) as verdict from diagnosis group by model)
select m.model, m.name, coalesce(e.version, 1) as version, m.parent, m.created_at, m.stale, m.campaigns, m.response,
       m.rowid as fitted, -- a fit writes its row anew
       coalesce(n.tests, 0) as tests, coalesce(n.in_sample, false) as in_sample,
       coalesce(u.unit, 'um') as unit, m.spec, e.calibration, e.verification, d.verdict
from model m left join n on n.model = m.model
left join e on e.model = m.model left join d on d.model = m.model left join first u on u.model = m.model
order by m.created_at desc, m.rowid desc"""


def model_rows(store: Store) -> list[ModelRow]:
    """All models of the store."""
    with store.reader() as con:
        rows = fetch(con, _MODELS)
    return [
        _row(r, json.loads(r["spec"]).get("effects", []), label) for r, label in zip(rows, _labels(rows), strict=True)
    ]


def of_several_campaigns(models: Iterable[ModelRow]) -> bool:
    """Whether a list of them has to say of which campaign each is."""
    return len({m.campaigns for m in models}) > 1


def role_in_model(store: Store, model: str, campaign: str, test: str) -> str | None:
    """Of a test, such as 'verification (in-sample)'; None where the model was not predicted in it."""
    with store.reader() as con:
        row = con.execute(
            "select max(role) from score_row where model = ? and campaign = ? and test = ?", [model, campaign, test]
        ).fetchone()
    return row[0] if row else None


def _labels(rows: Sequence[dict[str, Any]]) -> list[str]:
    """'base 2'; 'lathe/base 2' where other campaigns have a base; with the id where that is no name of one model."""
    of: dict[str, set[tuple[str, ...]]] = {}
    for r in rows:
        of.setdefault(r["name"], set()).add(tuple(r["campaigns"]))
    told = [
        f"{r['campaigns'][0]}/" * (len(of[r["name"]]) > 1 and len(r["campaigns"]) == 1) + f"{r['name']} {r['version']}"
        for r in rows
    ]
    often = Counter(told)
    return [f"{label} ({r['model'][:6]})" if often[label] > 1 else label for r, label in zip(rows, told, strict=True)]


def _row(r: dict[str, Any], effects: list[dict[str, Any]], label: str) -> ModelRow:
    return ModelRow(
        r["model"],
        r["name"],
        int(r["version"]),
        r["parent"],
        r["created_at"],
        bool(r["stale"]),
        tuple(r["campaigns"]),
        tuple(r["response"].split(", ")),
        difference_unit(r["unit"]),
        tuple(e["effect"] for e in effects),
        tuple(ids_of((e["effect"], e.get("id")) for e in effects)),
        r["calibration"],
        r["verification"],
        r["verdict"],
        label,
        int(r["fitted"]),
        int(r["tests"]),
        bool(r["in_sample"]),
    )


def read_by(store: Store, model: str, channels: Iterable[str]) -> set[str]:
    """Those of the channels that drive an effect of the model, by themselves or within an expression."""
    with store.reader() as con:
        row = con.execute("select spec from model where model = ?", [model]).fetchone()
    effects = json.loads(row[0]).get("effects", []) if row else []
    told = json.dumps([[e.get("drivers"), e.get("also")] for e in effects], ensure_ascii=False)
    return {name for name in channels if re.search(rf"(?<!\w){re.escape(name)}(?!\w)", told)}


def fitted_last(models: Sequence[ModelRow]) -> ModelRow:
    """The one that is taken where none is named, as commands take it."""
    return max(models, key=lambda m: m.fitted)


def fitted_last_of_each(models: Sequence[ModelRow]) -> dict[str, ModelRow]:
    """Campaign -> the one of its models that was fitted last."""
    return {campaign: m for m in sorted(models, key=lambda m: m.fitted) for campaign in m.campaigns}


def term_order(models: Sequence[ModelRow], chosen: Iterable[str]) -> list[str]:
    """The effects of the chosen models (ids) and of the versions that they came from, the oldest version's first: what
    is coloured in this order keeps its colour when an effect is added or taken out."""
    by_id, met = {m.model: m for m in models}, dict[str, ModelRow]()
    for identity in chosen:
        row = by_id.get(identity)
        while row is not None and row.model not in met:
            met[row.model] = row
            row = by_id.get(row.parent or "")
    chain = sorted(met.values(), key=lambda m: (m.version, m.created_at))
    return list(dict.fromkeys(term for m in chain for term in m.terms))
