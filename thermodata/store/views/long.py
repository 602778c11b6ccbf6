"""The long views over all numeric channels, and the macro `signal` for one of them."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from thermodata.store.connection import literal, quoted
from thermodata.store.views.catalogue import RESPONSES, Catalogue, Column, Group
from thermodata.store.views.dispatch import by_campaign, files_call, from_files, refuse
from thermodata.store.views.wide import wide_name

_EMPTY = ("select null::varchar as campaign, null::varchar as test, null::varchar as source, "
          "null::varchar as channel, null::timestamp_ns as t, null::double as t_s, null::double as value, "
          "null::usmallint as flag limit 0")
_COMMENTS = {"t": "UTC", "t_s": "[s] from the start of the test", "value": "in channel.unit",
             "flag": "bit mask: 1 gap, 2 held, 4 saturated, 8 spike, 16 out of range, 32 interpolated, 64 clock "
                     "suspect, 128 not measuring, 256 stuck, 512 offset, 1024 duplicate time, 2048 rate change"}

VIEWS: dict[str, Callable[[Column], bool]] = {
    "sample": lambda column: True,
    "displacement": lambda column: column.quantity == "displacement",
    "temperature": lambda column: column.quantity == "temperature",
    "driver": lambda column: column.quantity not in RESPONSES,
}


def long_views(catalogue: Catalogue) -> Iterator[str]:
    """The statements that make `sample` and its selections by quantity."""
    for name, wanted in VIEWS.items():
        parts = [_unpivoted(g, columns) for g in catalogue.groups
                 if (columns := [c for c in g.columns if not c.text and wanted(c)])]
        yield f"create view {name} as {' union all '.join(parts) or _EMPTY}"
        for column, comment in _COMMENTS.items():
            yield f"comment on column {name}.{column} is {literal(comment)}"


def _unpivoted(group: Group, columns: list[Column]) -> str:
    # a cross join with the names reads each file once; a UNION ALL of channels would open the list of files
    # once a channel (50-150 ms instead of 20 over 1,000 tests)
    value = " ".join(f"when {literal(c.name)} then cast(w.{quoted(c.name)} as double)" for c in columns)
    flag = " ".join(f"when {literal(c.name)} then w.{quoted(c.name + '__flag')}" for c in columns)
    names = ", ".join(f"({literal(c.name)})" for c in columns)
    return (f"select * from (select w.campaign, w.test, w.source, c.channel, w.t, w.t_s, "
            f"case c.channel {value} end as value, cast(case c.channel {flag} end as usmallint) as flag "
            f"from {quoted(wide_name(group))} w cross join (values {names}) c(channel)) "
            f"where value is not null or flag is not null")


def signal_macros(catalogue: Catalogue) -> Iterator[str]:
    """`signal(campaign, test, channel)`: one file, one column, the same columns as `sample`."""
    for group in catalogue.groups:
        columns = [c for c in group.columns if not c.text]
        if not columns:
            continue
        value = " ".join(f"when {literal(c.name)} then cast(r.{quoted(c.name)} as double)" for c in columns)
        flag = " ".join(f"when {literal(c.name)} then r.{quoted(c.name + '__flag')}" for c in columns)
        yield (
            f"create macro {quoted('signal_' + group.name)}(p__test, p__channel, p__files, p__own) as table "
            f"select * from (select {literal(group.campaign)} as campaign, p__test as test, "
            f"{literal(group.source)} as source, p__channel as channel, r.t, r.t_s, "
            f"case p__channel {value} end as value, cast(case p__channel {flag} end as usmallint) as flag "
            f"from {from_files('p__files', 'p__own')}) where value is not null or flag is not null")
    cases = {campaign: _channel_case(catalogue, campaign) for campaign in catalogue.campaigns}
    yield f"create macro signal_query(campaign, test, channel) as {by_campaign(cases, _EMPTY)}"
    yield ("create macro signal(campaign, test, channel) as table "
           "select * from query(signal_query(campaign, test, channel))")


def _channel_case(catalogue: Catalogue, campaign: str) -> str:
    """SQL that gives the text of the query for one campaign, by channel."""
    known = f"{quoted('known_' + catalogue.campaigns[campaign])}(test)"
    cases = {}
    for channel in catalogue.channels[campaign]:
        groups = [g for g in catalogue.of(campaign) if any(c.name == channel and not c.text for c in g.columns)]
        calls = [f"{literal('select * from ' + quoted('signal_' + g.name) + '(')} || {known} || ', ' || "
                 f"sql_text(channel) || ', ' || {files_call(g)} || ')'" for g in groups]
        if calls:
            cases[channel] = " || ' union all ' || ".join(calls)
    if not cases:
        return literal(_EMPTY)
    listed = " ".join(f"when {literal(name)} then {text}" for name, text in cases.items())
    refusal = refuse("no channel of numbers ", "channel", f" in campaign '{campaign}'", cases)
    return f"(case cast(channel as varchar) {listed} else {refusal} end)"
