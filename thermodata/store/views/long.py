"""The long views over all numeric channels, the macro `signal` for one of them, and `valid` for what counts."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from thermodata.schema.flag import INVALID
from thermodata.schema.units.quantity import MEASURED
from thermodata.store.base.connection import literal, quoted
from thermodata.store.views.catalogue import Catalogue, Column, Group
from thermodata.store.views.dispatch import dispatcher, files_call, from_files, known_call, refuse
from thermodata.store.views.identifiers import identified
from thermodata.store.views.wide import wide_name

_EMPTY = (
    "select null::varchar as campaign, null::varchar as test, null::varchar as source, "
    "null::varchar as channel, null::timestamp_ns as t, null::double as t_s, null::double as value, "
    "null::usmallint as flag limit 0"
)
_COMMENTS = {
    "t": "UTC",
    "t_s": "[s] from the start of the test",
    "value": "in channel.unit",
    "flag": "bit mask: 1 gap, 2 held, 4 saturated, 8 spike, 16 out of range, 32 interpolated, 64 clock "
    "suspect, 128 not measuring, 256 stuck, 512 offset, 1024 duplicate time, 2048 rate change, 4096 foreign; "
    "where valid(flag): what counts in means",
}
# of gaps, drawn values, suspect clocks and changes of rate the values count: `flag = 0` would lose them
VALID = f"create macro valid(flag) as (coalesce(flag, 0) & {int(INVALID)}) = 0"

VIEWS: dict[str, Callable[[Column], bool]] = {
    "sample": lambda column: True,
    "displacement": lambda column: column.quantity == "displacement",
    "temperature": lambda column: column.quantity == "temperature",
    "driver": lambda column: column.quantity not in MEASURED,
}
# where a channel is a branch of its own: rows of a file from which reading costs more than opening, and how many files
# may be opened for all channels together (15 us each)
_LONG_ROWS, _MOST_OPENED = 5_000, 4_000


def long_views(catalogue: Catalogue) -> Iterator[str]:
    """The statements that make `sample` and its selections by quantity, flagged samples too, and `valid`, by which who
    asks for a mean or an extreme leaves the defects out."""
    yield VALID
    for name, wanted in VIEWS.items():
        parts = [
            _unpivoted(g, columns)
            for g in catalogue.groups
            if (columns := [c for c in g.columns if not c.text and wanted(c)])
        ]
        text = " union all ".join(parts)
        yield f"create view {name} as {text or _EMPTY}"
        yield from identified(name, ("campaign", "test", "source", "channel"))
        for column, comment in _COMMENTS.items():
            yield f"comment on column {name}.{column} is {literal(comment)}"


def _unpivoted(group: Group, columns: list[Column]) -> str:
    files = max(1, len(group.files))
    if files * len(columns) <= _MOST_OPENED and group.rows >= _LONG_ROWS * files:
        return " union all ".join(_select_of_channel(group, c) for c in columns)
    # a cross join with the names reads each file once; a UNION ALL of channels opens the list of files once a
    # channel (50-150 ms instead of 20 over 1,000 tests)
    value = " ".join(f"when {literal(c.name)} then cast(w.{quoted(c.name)} as double)" for c in columns)
    flag = " ".join(f"when {literal(c.name)} then w.{quoted(c.name + '__flag')}" for c in columns)
    names = ", ".join(f"({literal(c.name)})" for c in columns)
    return (
        f"select * from (select w.campaign, w.test, w.source, c.channel, w.t, w.t_s, "
        f"case c.channel {value} end as value, cast(case c.channel {flag} end as usmallint) as flag "
        f"from {quoted(wide_name(group))} w cross join (values {names}) c(channel)) "
        f"where value is not null or flag is not null"
    )


def _select_of_channel(group: Group, column: Column) -> str:
    """One channel of a group: a filter on another channel drops all of it before anything is read. A cross join reads
    every column for any channel, three times the work for one of eight."""
    value, flag = f"w.{quoted(column.name)}", f"w.{quoted(column.name + '__flag')}"
    return (
        f"select w.campaign, w.test, w.source, {literal(column.name)} as channel, w.t, w.t_s, "
        f"cast({value} as double) as value, cast({flag} as usmallint) as flag from {quoted(wide_name(group))} w "
        f"where {value} is not null or {flag} is not null"
    )


def signal_macros(catalogue: Catalogue) -> Iterator[str]:
    """`signal(campaign, test, channel)`: one file, one column, the same columns as `sample`."""
    for group in catalogue.groups:
        columns = [c for c in group.columns if not c.text]
        if not columns:
            continue
        value = " ".join(f"when {literal(c.name)} then cast(r.{quoted(c.name)} as double)" for c in columns)
        flag = " ".join(f"when {literal(c.name)} then r.{quoted(c.name + '__flag')}" for c in columns)
        yield (
            f"create macro {quoted('signal_' + group.name)}(p__channel, p__files, p__own) as table "
            f"select * from (select {literal(group.source)} as source, r.t, r.t_s, "
            f"case p__channel {value} end as value, cast(case p__channel {flag} end as usmallint) as flag "
            f"from {from_files('p__files', 'p__own')}) where value is not null or flag is not null"
        )
    texts = {campaign: _signal_text(catalogue, campaign) for campaign in catalogue.campaigns}
    yield from dispatcher(catalogue, "signal", {"test": None, "channel": None}, texts, _EMPTY)


def _signal_text(catalogue: Catalogue, campaign: str) -> str | None:
    """SQL over the parameters test and channel that gives the text of the query. Each group's files are looked
    up in one place only: every mention of the lookup costs its map."""
    channels: dict[str, None] = {}
    parts = []
    for group in catalogue.of(campaign):
        names = [c.name for c in group.columns if not c.text]
        if names:
            channels.update(dict.fromkeys(names))
            parts.append(
                f"case when cast(channel as varchar) in ({', '.join(map(literal, names))}) then "
                f"{literal('select * from ' + quoted('signal_' + group.name) + '(')} || "
                f"sql_text(channel) || ', ' || {files_call(group)} || ')' end"
            )
    if not parts:
        return None
    refusal = refuse(
        "no channel of numbers ",
        "channel",
        f" in campaign '{campaign}'",
        [c for c in catalogue.channels[campaign] if c in channels],
    )
    head = literal(f"select {literal(campaign)} as campaign, ")
    return (
        f"case when cast(channel as varchar) in ({', '.join(map(literal, channels))}) then "
        f"{head} || {known_call(catalogue, campaign)} || ' as test, source, ' || sql_text(channel) || "
        f"' as channel, t, t_s, value, flag from (' || concat_ws(' union all ', {', '.join(parts)}) || ')' "
        f"else {refusal} end"
    )
