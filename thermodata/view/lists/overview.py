"""The tests of a store as a list to look through: searched, filtered, sorted, a page at a time."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

from thermodata.errors import unknown_name
from thermodata.schema.flag import INVALID, Flag
from thermodata.store.views.result import OF_ITS_TEST

if TYPE_CHECKING:
    import duckdb

    from thermodata.store import Store

Sort = Literal["file", "test", "start", "length", "error", "valid"]
SORTS: tuple[Sort, ...] = ("file", "test", "start", "length", "error", "valid")
_ORDER: dict[Sort, str] = {
    "file": "campaign, place",
    "test": "campaign, test",
    "start": "start nulls last, campaign, place",
    "length": "duration_s desc nulls last, campaign, place",
    "error": "rmse_um desc nulls last, campaign, place",
    "valid": "valid nulls last, campaign, place",
}
# of files of an older version, which tell how many samples each flag has: what ran while the test did not measure is no
# defect of it, and saturation there is counted with 'not measuring'
_RULED_OUT = ", ".join(f"'{flag.word}'" for flag in Flag if flag & INVALID)
_TESTS = f"""
with counted as (
    select campaign, test, cast(columns->>'$.samples' as bigint) as samples,
           unnest(coalesce(cast(columns->'$.flags' as map(varchar, bigint)), map {{}}).map_entries()) as flag
    from file where layer = 'tidy' and part = 'test' and columns->>'$.not_counting' is null),
idle as (
    select campaign, test, lower(flag) as flag, sum(n) as n from quality_event e
    where detail = 'only while not measuring' and {OF_ITS_TEST} group by all),
ruled_out as (
    select campaign, test, sum(n) as n from (
        select c.campaign, c.test, greatest(c.flag.value - coalesce(i.n, 0), 0) as n
        from counted c left join idle i on (i.campaign, i.test, i.flag) = (c.campaign, c.test, lower(c.flag.key))
        where lower(c.flag.key) in ({_RULED_OUT})
        union all
        select campaign, test, cast(columns->>'$.not_counting' as bigint) from file
        where layer = 'tidy' and part = 'test') group by all),
sizes as (
    select campaign, test, sum(cast(columns->>'$.samples' as bigint)) as samples, count(*) as streams
    from file where layer = 'tidy' and part = 'test' group by all),
counting as (
    select campaign, test, min(share) as measured_least, max(share) as measured_most from (
        select campaign, test, c.value[1] / c.value[2] as share from (
            select campaign, test,
                   unnest(coalesce(cast(columns->'$.counting' as map(varchar, bigint[])), map {{}}).map_entries()) as c
            from file where layer = 'tidy' and part = 'test') where c.value[2] > 0) group by all),
errors as (
    select campaign, test, max(rmse_um) as rmse_um, min(fit) as fit, max(role) as model_role from score_row
    where (campaign, model) in (select unnest($of::varchar[]), unnest($models::varchar[])) and phase = 'all'
    group by all),
said as (
    select c.campaign, t.value->>'$.id' as test, t.value->'$.conditions' as conditions
    from campaign c, json_each(c.spec, '$.tests') t),
listed as (
    select t.rowid as place, t.campaign, t.test, t.kind, t.role, mc.machine, t.start, t.duration_s,
           coalesce(said.conditions, t.conditions) as conditions, t.notes,
           s.samples, coalesce(s.streams, 0) as streams,
           case when s.samples > 0 then 1 - least(coalesce(r.n, 0) / s.samples, 1) end as valid,
           m.measured_least, m.measured_most, e.rmse_um, e.fit, e.model_role
    from test t
    left join sizes s on (s.campaign, s.test) = (t.campaign, t.test)
    left join ruled_out r on (r.campaign, r.test) = (t.campaign, t.test)
    left join counting m on (m.campaign, m.test) = (t.campaign, t.test)
    left join errors e on (e.campaign, e.test) = (t.campaign, t.test)
    left join machine mc on (mc.campaign, mc.test) = (t.campaign, t.test)
    left join said on (said.campaign, said.test) = (t.campaign, t.test))
"""


@dataclass(frozen=True, slots=True)
class WantedTests:
    """What is looked for. find: words that all stand in a test's campaign, name, kind, role, machine, conditions or
    notes. models: by campaign, the one whose errors are shown beside its tests. page: from 1."""

    find: str = ""
    campaign: str = ""
    role: str = ""
    kind: str = ""
    models: Mapping[str, str] = field(default_factory=dict)
    sort: Sort = "file"
    page: int = 1
    per_page: int = 50
    machine: str = ""


@dataclass(frozen=True, slots=True)
class TestRow:
    """valid: share of the samples that count, 0 to 1; None where nothing was logged. measured_least, measured_most: of
    those of the displacement, tilt or angle of which fewest and most count; outside of `measuring` none do. rmse_um,
    fit: of the model's worst response over the whole test; model_role: of the test in the model, such as 'verification
    (in-sample)'; None where it was not predicted. machine: its id, None where none is known."""

    __test__ = False
    campaign: str
    test: str
    kind: str
    role: str
    start: Any
    duration_s: float | None
    conditions: dict[str, Any]
    notes: str | None
    samples: int
    streams: int
    valid: float | None
    measured_least: float | None
    measured_most: float | None
    rmse_um: float | None
    fit: float | None
    model_role: str | None
    machine: str | None = None


@dataclass(frozen=True, slots=True)
class TestList:
    """One page. total: of all that was found; all_tests: of the store. campaigns, roles, kinds, machines: with their
    counts."""

    __test__ = False
    rows: tuple[TestRow, ...]
    total: int
    all_tests: int
    page: int
    pages: int
    campaigns: dict[str, int] = field(default_factory=dict)
    roles: dict[str, int] = field(default_factory=dict)
    kinds: dict[str, int] = field(default_factory=dict)
    machines: dict[str, int] = field(default_factory=dict)


def find_tests(store: Store, asked: WantedTests) -> TestList:
    """The tests that are asked for, in the asked order. UsageError for a campaign, a machine or an order that there is
    not; a page beyond the last one is the last one."""
    if asked.sort not in SORTS:
        raise unknown_name("order", asked.sort, SORTS)
    with store.reader() as con:
        counts = {name: _counts(con, name) for name in ("campaign", "role", "kind")}
        counts["machine"] = _counts(con, "machine", of="machine")
        for name in ("campaign", "machine"):
            if (wanted := getattr(asked, name)) and wanted not in counts[name]:
                raise unknown_name(name, wanted, list(counts[name]))
        where, params = _condition(asked)
        total_row = con.execute(f"{_TESTS} select count(*) from listed where {where}", params).fetchone()
        total = int(total_row[0]) if total_row else 0
        pages = max(1, -(-total // asked.per_page))
        page = min(max(asked.page, 1), pages)
        found = con.execute(
            f"{_TESTS} select * exclude (place) from listed where {where} order by {_ORDER[asked.sort]} "
            f"limit {int(asked.per_page)} offset {int((page - 1) * asked.per_page)}",
            params,
        )
        names = [d[0] for d in found.description or ()]
        rows = tuple(_row(dict(zip(names, values, strict=True))) for values in found.fetchall())
    return TestList(
        rows,
        total,
        sum(counts["campaign"].values()),
        page,
        pages,
        campaigns=counts["campaign"],
        roles=counts["role"],
        kinds=counts["kind"],
        machines=counts["machine"],
    )


def _counts(con: duckdb.DuckDBPyConnection, column: str, of: str = "test") -> dict[str, int]:
    rows = con.execute(f"select {column}, count(*) from {of} group by 1 order by min(rowid)").fetchall()
    return {str(name): int(n) for name, n in rows}


def _condition(asked: WantedTests) -> tuple[str, dict[str, Any]]:
    parts = ["true"]
    params: dict[str, Any] = {"of": list(asked.models), "models": list(asked.models.values())}
    for name in ("campaign", "role", "kind", "machine"):
        if value := getattr(asked, name):
            parts.append(f"{name} = ${name}")
            params[name] = value
    text = "lower(concat_ws(' ', campaign, test, kind, replace(kind, '_', ' '), role, machine, conditions, notes))"
    for i, word in enumerate(asked.find.lower().split()[:20]):
        parts.append(f"contains({text}, $word{i})")
        params[f"word{i}"] = word
    return " and ".join(parts), params


def _row(values: dict[str, Any]) -> TestRow:
    said = json.loads(values["conditions"] or "{}")
    return TestRow(
        **{**values, "conditions": said if isinstance(said, dict) else {}, "samples": values["samples"] or 0}
    )
