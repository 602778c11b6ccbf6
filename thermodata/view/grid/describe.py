"""What the catalogue says about tests and channels, as plain values."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from thermodata.calibration.measuring import measuring_names
from thermodata.schema.files.campaign import Measuring
from thermodata.store.catalogue.conditions import plain_value
from thermodata.store.tidy.rows.timeline import WHOLE_CLOCK
from thermodata.store.tidy.values.finer_steps import resolution_in
from thermodata.store.views.catalogue import SCHEDULE
from thermodata.view.grid.dataset import ChannelInfo
from thermodata.view.grid.flagged import flagged_channels

if TYPE_CHECKING:
    import duckdb


def describe_tests(con: duckdb.DuckDBPyConnection, campaigns: Sequence[str]) -> list[dict[str, Any]]:
    """Rows of the tests, in the order of the table: kind, role, clock, conditions, phases, ..., machine.

    conditions hold numbers in canonical units or text: the machine's attributes, `pose.*` and `tool.*`, and the
    test's own conditions, which win.
    """
    rows = con.execute(
        "select t.campaign, t.test, t.kind, t.role, t.clock, t.conditions, t.pose, t.tool, t.phases, t.zero_s, "
        "t.start_state, m.machine, m.attributes from test t left join "
        "(select campaign, test, any_value(machine) as machine, any_value(attributes) as attributes "
        "from machine group by all) m on m.campaign = t.campaign and m.test = t.test "
        "where list_contains(?, t.campaign) order by list_position(?, t.campaign), t.rowid",
        [list(campaigns), list(campaigns)],
    ).fetchall()
    tests = []
    for campaign, test, kind, role, clock, conditions, pose, tool, phases, zero_s, state, machine, attributes in rows:
        tests.append(
            {
                "campaign": campaign,
                "test": test,
                "kind": kind,
                "role": role,
                "clock": clock,
                "conditions": {
                    **flat(_json(attributes)),
                    **flat(_json(pose), "pose."),
                    **flat(_json(tool), "tool."),
                    **flat(_json(conditions)),
                },
                "phases": {str(name): (float(a), float(b)) for name, (a, b) in _json(phases).items()},
                "zero_s": 600.0 if zero_s is None else zero_s,
                "start_state": state or "balance",
                "machine": machine or "",
            }
        )
    return tests


def flat(values: Mapping[str, Any], prefix: str = "") -> dict[str, float | str]:
    """Nested values under dotted names; numbers and truth values as float, values with units in canonical ones."""
    out: dict[str, float | str] = {}
    for name, value in values.items():
        if isinstance(value, dict):
            out.update(flat(value, f"{prefix}{name}."))
            continue
        plain = plain_value(value if isinstance(value, str | int | float) or value is None else json.dumps(value))
        if plain is not None:
            out[prefix + name] = float(plain) if isinstance(plain, bool) else plain
    return out


def channel_infos(
    con: duckdb.DuckDBPyConnection, campaigns: Sequence[str]
) -> dict[tuple[str, str], dict[str, ChannelInfo]]:
    """(campaign, test) -> channel -> ChannelInfo, as in that test, in the campaign's order; texts left out."""
    rows = con.execute(
        'select c.campaign, test, channel, quantity, unit, "at", c.axis, relative_to, source, c.sign, sensor, '
        "raw_unit, k.uncertainty_pct from channel c left join calibration k on k.campaign = c.campaign "
        "and k.calibration = c.calibration where list_contains(?, c.campaign) and quantity <> 'label' order by c.rowid",
        [list(campaigns)],
    ).fetchall()
    flagged, declared = flagged_channels(con, campaigns), declared_clocks(con, campaigns)
    masks, doubtful = _masks(con, campaigns), _doubtful_clocks(con, campaigns)
    infos: dict[tuple[str, str], dict[str, ChannelInfo]] = {}
    for campaign, test, name, quantity, unit, at, axis, relative_to, source, sign, sensor, raw_unit, scale in rows:
        resolution = _json(sensor).get("resolution")
        infos.setdefault((campaign, test), {})[name] = ChannelInfo(
            name,
            quantity,
            unit,
            at,
            axis,
            relative_to,
            None if source == SCHEDULE else source,
            sign,
            resolution_in(unit, resolution, raw_unit),
            clock_declared=not declared.isdisjoint({(campaign, "", source), (campaign, test, source)}),
            is_mask=quantity == "state" and at is None and name in masks.get((campaign, test), frozenset()),
            scale_pct=scale,
            clock_doubtful=(campaign, test, source) in doubtful,
            in_measuring=name in masks.get((campaign, test), frozenset()),
        )
        own = flagged.get((campaign, test), {}).get(name)
        if own is not None:
            known = infos[campaign, test][name]
            infos[campaign, test][name] = replace(
                known, lost=own.lost_while_measuring, faulty=own.faulty, shifted=own.shifted
            )
    return infos


def _masks(con: duckdb.DuckDBPyConnection, campaigns: Sequence[str]) -> dict[tuple[str, str], frozenset[str]]:
    """(campaign, test) -> the channels that its `measuring` reads."""
    rows = con.execute(
        "select campaign, test, measuring from test where list_contains(?, campaign) and measuring is not null",
        [list(campaigns)],
    ).fetchall()
    found = {}
    for campaign, test, text in rows:
        spec = json.loads(text)
        if isinstance(spec, dict):  # kept without units, which a campaign file has to write
            spec = Measuring.model_construct(when=spec.get("when"), in_range=spec.get("in_range"))
        found[campaign, test] = measuring_names(spec)
    return found


def _doubtful_clocks(con: duckdb.DuckDBPyConnection, campaigns: Sequence[str]) -> set[tuple[str, str, str]]:
    """(campaign, test, source), where the whole clock is doubtful."""
    rows = con.execute(
        "select distinct campaign, test, source from quality_event where list_contains(?, campaign) "
        "and flag = 'clock_suspect' and channel is null and starts_with(detail, ?)",
        [list(campaigns), WHOLE_CLOCK],
    )
    return {(campaign, test, source) for campaign, test, source in rows.fetchall()}


def declared_clocks(con: duckdb.DuckDBPyConnection, campaigns: Sequence[str]) -> set[tuple[str, str, str]]:
    """(campaign, test, source), where the campaign file gives the offset of a clock, or what it is aligned to; test '':
    in all of them."""
    rows = con.execute("select campaign, spec from campaign where list_contains(?, campaign)", [list(campaigns)])
    found: set[tuple[str, str, str]] = set()
    for campaign, text in rows.fetchall():
        spec = _json(text)
        for name, source in _json(spec.get("sources")).items():
            clock = _json(_json(source).get("clock"))
            if clock.get("offset") is not None or clock.get("align_to") is not None:
                found.add((campaign, "", name))
        for test in spec.get("tests") or ():
            found |= {(campaign, test["id"], name) for name in _json(test.get("clocks"))}
    return found


def _json(text: Any) -> dict[str, Any]:
    value = json.loads(text) if isinstance(text, str) and text else text
    return value if isinstance(value, dict) else {}
