"""What of a test is taken away: its streams on their times, with units, flags, and all that describes it."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from thermodata.errors import UsageError, unknown_name
from thermodata.plugin import Array, Float1D
from thermodata.schema.words.numbered import numbered
from thermodata.store.base.connection import literal, quoted
from thermodata.store.catalogue.conditions import plain_unit

if TYPE_CHECKING:
    from thermodata.view import StoreView

LOGGED = "logged"
_INFO = (
    "source",
    "stream",
    "signal",
    "quantity",
    "unit",
    "raw_unit",
    "axis",
    "at",
    "relative_to",
    "sign",
    "calibration",
    "sensor",
    "notes",
)


@dataclass(frozen=True)
class Stream:
    """Channels of one clock. t_s: shape (n,), from the start of the test; values: channel -> shape (n,);
    flags: channel -> uint16 of shape (n,), of those that have any."""

    name: str
    t_s: Float1D
    values: Mapping[str, Array]
    flags: Mapping[str, Array]


@dataclass(frozen=True)
class Content:
    """One test. about: of the test, as text; conditions: numbers in the canonical units; written: the same as the
    campaign file has them, with units; channels: channel -> what is known of it, as text; start_ns: UTC of t_s == 0,
    None where no clock was absolute."""

    campaign: str
    test: str
    about: Mapping[str, str]
    conditions: Mapping[str, float | str]
    written: Mapping[str, str]
    channels: Mapping[str, Mapping[str, str]]
    start_ns: int | None
    step: str
    streams: tuple[Stream, ...]

    @property
    def condition_units(self) -> dict[str, str]:
        """Of the conditions that are numbers with a unit."""
        units = {name: plain_unit(text) for name, text in self.written.items() if name in self.conditions}
        return {name: unit for name, unit in units.items() if unit is not None}

    def unit(self, channel: str) -> str:
        return self.channels.get(channel, {}).get("unit", "")


def check_test(view: StoreView, campaign: str, test: str) -> None:
    """UsageError with the nearest names where there is no such test."""
    known = [str(row[0]) for row in view.sql("select test from test where campaign = ?", [campaign]).fetchall()]
    if not known:
        campaigns = view.sql("select campaign from campaign").fetchall()
        raise unknown_name("campaign", campaign, [str(row[0]) for row in campaigns])
    if test not in known:
        raise unknown_name("test", test, known)
    logged = view.sql("select distinct test from file where campaign = ? and layer = 'tidy'", [campaign]).fetchall()
    if (test,) not in logged:
        raise UsageError(
            f"test '{test}' has no samples",
            where=f"campaign {campaign}",
            expected=", ".join(sorted(str(name) for (name,) in logged)) or "a test with logs: there is none",
            got=f"{test}, whose logs are not in the store",
            hint="put its files where the campaign file says, then thermodata ingest",
        )


def read_content(view: StoreView, campaign: str, test: str, step: str) -> Content:
    """A test on one grid of `step`, or as it was logged where step is 'logged'."""
    rows = view.sql(
        "select kind, role, start_ns, clock, conditions, machine, notes, duration_s from test left join "
        "machine using (campaign, test) where campaign = ? and test = ?",
        [campaign, test],
    ).fetchall()
    kind, role, start_ns, clock, conditions, machine, notes, duration_s = rows[0]
    about = {
        "campaign": campaign,
        "test": test,
        "kind": kind,
        "role": role,
        "machine": machine,
        "notes": notes,
        "duration_s": None if duration_s is None else f"{duration_s:.9g}",
        "clock": clock,
    }
    columns = ", ".join(quoted(c) for c in _INFO)
    found = view.sql(
        f"select channel, {columns} from channel where campaign = ? and test = ?", [campaign, test]
    ).fetchall()
    channels = {
        str(name): {k: str(v) for k, v in zip(_INFO, values, strict=True) if v not in (None, "")}
        for name, *values in found
    }
    streams = (
        _logged_streams(view, campaign, test)
        if step == LOGGED
        else [_binned_stream(view, campaign, test, step, channels)]
    )
    absolute = clock == "absolute" and start_ns is not None
    return Content(
        campaign,
        test,
        {k: str(v) for k, v in about.items() if v not in (None, "")},
        _plain_conditions(conditions),
        _written_conditions(view, campaign, test),
        channels,
        int(start_ns) if absolute else None,
        step,
        tuple(s for s in streams if s.values),
    )


def _plain_conditions(conditions: Any) -> dict[str, float | str]:
    given = json.loads(conditions) if isinstance(conditions, str) else (conditions or {})
    return {
        str(k): float(v) if isinstance(v, int | float) else v if isinstance(v, str) else json.dumps(v)
        for k, v in given.items()
    }


def _written_conditions(view: StoreView, campaign: str, test: str) -> dict[str, str]:
    rows = view.sql(
        "select t.value->'$.conditions' from campaign c, json_each(c.spec, '$.tests') t "
        "where c.campaign = ? and t.value->>'$.id' = ?",
        [campaign, test],
    ).fetchall()
    given = json.loads(rows[0][0] or "{}") if rows else {}
    return {str(k): v if isinstance(v, str) else json.dumps(v) for k, v in (given or {}).items()}


def _binned_stream(view: StoreView, campaign: str, test: str, step: str, channels: Collection[str]) -> Stream:
    """Without the columns of channels that other tests have."""
    table: Any = view.binned(campaign, test, step=step).to_arrow_table()
    values = {str(n): _column(table.column(n)) for n in table.column_names if n in channels}
    return Stream("grid", np.asarray(table.column("t_s").to_numpy(), np.float64), values, {})


def _logged_streams(view: StoreView, campaign: str, test: str) -> list[Stream]:
    wide = view.sql('select source, stream, "view" from wide where campaign = ?', [campaign]).fetchall()
    streams: list[Stream] = []
    for source, stream, name in wide:
        table: Any = view.sql(
            f"select * exclude (campaign, test, source, t) from {quoted(str(name))} "
            f"where test = {literal(test)} order by t"
        ).to_arrow_table()
        if not table.num_rows:
            continue
        names = [n for n in table.column_names if n != "t_s" and not n.endswith("__flag")]
        values = {n: _column(table.column(n)) for n in names if table.column(n).null_count < table.num_rows}
        flags = {}
        for n in values:
            bits = np.asarray(table.column(f"{n}__flag").fill_null(0).to_numpy(), np.uint16)
            if bits.any():
                flags[n] = bits
        label = str(source) if stream in (source, "table") else f"{source}_{stream}"
        label = numbered(label, lambda one: any(one == s.name for s in streams), "_")  # a_b of c, and a of b_c
        streams.append(Stream(label, np.asarray(table.column("t_s").to_numpy(), np.float64), values, flags))
    if not streams:
        raise UsageError(
            "the test holds no samples",
            where=f"{campaign}/{test}",
            hint="name another test, or ingest its logs",
        )
    return streams


def _column(column: Any) -> Array:
    """Numbers (missing: NaN) or text (missing: '')."""
    import pyarrow.types as pt

    if pt.is_string(column.type) or pt.is_large_string(column.type) or pt.is_dictionary(column.type):
        return np.array(["" if v is None else str(v) for v in column.to_pylist()], object)
    return np.asarray(column.to_numpy(), np.float64)
