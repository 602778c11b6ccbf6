"""`aligned` and `binned`: all sources of a test, of several, or of a campaign on one grid.

The grid is taken from the sources' own extent: point k stands at k * step from the test's start.

`binned` is for fitting. Bin k holds the samples of [k * step, (k + 1) * step); a measurement is the mean of its
valid ones; of a speed, feed, load, current or torque that goes both ways in the bin, of its size: heat knows no
direction. States, labels and schedules are held: the last valid value in the bin or before it. A number that is
written on change is held too, until a row says that there is none, and a bin has its mean over the time. Where a source
is slower than the step (period over half a step), empty bins between valid ones are interpolated linearly, over
at most INTERPOLATED_PERIODS of the source's period, and between two signs of what heats either way its size is; every
other bin without a valid sample is NULL.

`aligned` is for looking. Each point shows the last sample at or before it, whatever its flag (beside it as
`<channel>__flag`); a measurement older than AGED_PERIODS of its source's period, and the step, is NULL.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from thermodata.schema.flag import INVALID
from thermodata.schema.units.quantity import UNDIRECTED
from thermodata.store.base.connection import literal, quoted
from thermodata.store.views.catalogue import Catalogue, Column, Group
from thermodata.store.views.dispatch import dispatcher, files_call, from_files, known_call, of_each_test

INTERPOLATED_PERIODS = 3.5
AGED_PERIODS = 3.5
MAX_POINTS = 20_000_000
# 30 us on a grid of 30 s: times such as 29.999999999 belong to the point that they mean
_SLACK = 1e-6
ONE_WAY = 1 - 1e-9  # of the mean size of what goes one way, by rounding
_EMPTY = "select null::varchar as campaign, null::varchar as test, null::timestamp_ns as t, null::double as t_s limit 0"

_SECONDS = "coalesce(try_cast(cast(step as varchar) as double), epoch(try_cast(cast(step as varchar) as interval)))"
STEP = f"""create macro step_seconds(step) as case
  when {_SECONDS} > 0 and isfinite({_SECONDS}) then {_SECONDS}
  else error({literal("no step '")} || coalesce(cast(step as varchar), 'NULL') ||
             {literal("'; a step is positive: '30 s', '1 min', INTERVAL '1 minute', or seconds: 60, '60'")}) end"""


def grid_macros(catalogue: Catalogue) -> Iterator[str]:
    """The statements that make both macros: one a campaign, and the dispatcher."""
    yield STEP
    for kind, body in (("binned", _binned), ("aligned", _aligned)):
        texts: dict[str, str | None] = {}
        several: dict[str, str] = {}
        for campaign, suffix in catalogue.campaigns.items():
            groups = [g for g in catalogue.of(campaign) if g.columns]
            texts[campaign] = None
            if not groups:
                continue
            name = quoted(f"{kind}_grid_{suffix}")
            files = "".join(f", p__files_{i}, p__own_{i}" for i in range(len(groups)))
            yield (
                f"create macro {name}(p__test, p__step{files}) as table "
                + body(campaign, groups, catalogue.channels[campaign])
            )
            arguments = " || ', ' || ".join(files_call(g) for g in groups)
            texts[campaign] = (
                f"{literal(f'select * from {name}(')} || {known_call(catalogue, campaign)} || ', ' || "
                f"cast(step_seconds(step) as varchar) || '::double, ' || {arguments} || ')'"
            )
            several[campaign] = of_each_test(catalogue, campaign, str(texts[campaign]))
        yield from dispatcher(catalogue, kind, {"test": None, "step": "'30 s'"}, texts, _EMPTY, several)


def _source(i: int) -> str:
    return from_files(f"p__files_{i}", f"p__own_{i}")


def _grid(campaign: str, groups: list[Group]) -> str:
    """CTEs: e__i extent and period of each source, e the test's, g the grid."""
    extents = []
    for i, group in enumerate(groups):
        # the declared period first: a gap stretches the mean one
        declared = (
            f"(select any_value(q.step_s) from source q where q.campaign = {literal(campaign)} "
            f"and q.test = p__test and q.source = {literal(group.source)} "
            f"and q.stream = {literal(group.stream)})"
        )
        extents.append(
            f"e__{i} as (select min(r.t_s) as a, max(r.t_s) as b, "
            f"min(epoch_ns(r.t) - cast(round(r.t_s * 1e9) as bigint)) as t0, "
            f"coalesce({declared}, (max(r.t_s) - min(r.t_s)) / nullif(count(*) - 1, 0), 0) as period "
            f"from {_source(i)})"
        )
    union = " union all ".join(f"select a, b, t0 from e__{i}" for i in range(len(groups)))
    points = f"cast(floor(a / p__step + {_SLACK}) as bigint), cast(floor(b / p__step + {_SLACK}) as bigint)"
    return (
        f"{', '.join(extents)}, e as (select min(a) as a, max(b) as b, min(t0) as t0 from ({union})), "
        f"g as (select t0, unnest(generate_series({points})) as k from (select * from e where "
        f"case when (b - a) / p__step > {MAX_POINTS} then error('the step is too small for this test: over "
        f"{MAX_POINTS} points') else a is not null end))"
    )


def _head(campaign: str, table: str) -> str:
    return (
        f"{literal(campaign)} as campaign, p__test as test, "
        f"make_timestamp_ns({table}.t0 + cast(round({table}.k * p__step * 1e9) as bigint)) as t, "
        f"{table}.k * p__step as t_s"
    )


def bin_index(step: str) -> str:
    """SQL of the bin that a row r belongs to."""
    return f"cast(floor(r.t_s / {step} + {_SLACK}) as bigint)"


def bin_value(column: Column, invalid: int = int(INVALID)) -> str:
    """SQL of a column's value in a bin: the mean of the valid samples, or the last of them where it is held. invalid:
    the flags that rule a sample out."""
    value, flag = f"r.{quoted(column.name)}", f"r.{quoted(column.name + '__flag')}"
    if column.on_change:
        # NaN: from here on there is none
        valid = f"{value} is not null and ({flag} & {invalid}) = 0"
        return f"arg_max(case when {valid} then cast({value} as double) else 'nan'::double end, r.t_s)"
    if column.held:
        good = "" if column.text else f" and not isnan(cast({value} as double))"
        return f"arg_max({value}, r.t_s) filter (where {value} is not null and ({flag} & {invalid}) = 0{good})"
    # a CASE inside the mean: twice as fast as FILTER
    number = f"cast({value} as double)"
    mean, size = (
        f"avg(case when ({flag} & {invalid}) = 0 and not isnan({number}) then {told} end)"
        for told in (number, f"abs({number})")
    )
    return _either_way(mean, size) if column.quantity in UNDIRECTED else mean


def _either_way(mean: str, size: str) -> str:
    """SQL of a mean, and of the mean of the absolute values where it is of both signs."""
    return f"case when abs({mean}) < {ONE_WAY} * {size} then {size} else {mean} end"


def held_sums(column: Column, step: str, invalid: int = int(INVALID), name: str = "") -> str:
    """SQL of what a number that is written on change was for in its bin, from its first row there on: the sum of value
    times time, the same of its size, and the time in which it had one. Rows need `next__s`, the time of the next one.
    name: of the sums, the column's where it is empty."""
    value, flag = f"r.{quoted(column.name)}", f"r.{quoted(column.name + '__flag')}"
    valid = f"{value} is not null and ({flag} & {invalid}) = 0 and not isnan(cast({value} as double))"
    name = name or column.name
    until = f"least(coalesce(r.next__s, 'infinity'::double), ({bin_index(step)} + 1) * {step})"
    lasts = f"greatest({until} - r.t_s, 0)"
    number = f"cast({value} as double)"
    return (
        f"sum(case when {valid} then {number} * {lasts} else 0 end) as {quoted(name + '__sum')}, "
        f"sum(case when {valid} then abs({number}) * {lasts} else 0 end) as {quoted(name + '__size')}, "
        f"sum(case when {valid} then {lasts} else 0 end) as {quoted(name + '__for')}"
    )


def _neighbour_bins(i: int, column: Column) -> str:
    """Window expressions for a column of source i: its last and next bins that hold a value."""
    value, n = f"s__{i}.{quoted(column.name)}", f"{i}__{column.name}"
    last = f"last_value({value} ignore nulls) over before as {quoted('pv__' + n)}"
    if column.on_change:
        told = ("sum", "size", "for")
        own = ", ".join(f"s__{i}.{quoted(f'{column.name}__{w}')} as {quoted(f'{w}__{n}')}" for w in told)
        until_then = f"last_value({value} ignore nulls) over earlier as {quoted('nv__' + n)}"
        return f"{value} as {quoted('v__' + n)}, {last}, {until_then}, {own}, s__{i}.first__s as {quoted('nk__' + n)}"
    if column.held:
        return last
    at = f"case when {value} is not null then g.k end"
    return (
        f"{value} as {quoted('v__' + n)}, {last}, "
        f"last_value({at} ignore nulls) over before as {quoted('pk__' + n)}, "
        f"first_value({value} ignore nulls) over behind as {quoted('nv__' + n)}, "
        f"first_value({at} ignore nulls) over behind as {quoted('nk__' + n)}"
    )


def _value(i: int, column: Column) -> str:
    n = f"{i}__{column.name}"
    v, pv, pk, nv, nk = (f"w.{quoted(f'{what}__{n}')}" for what in ("v", "pv", "pk", "nv", "nk"))
    if column.on_change:
        # what it was when the bin began counts until its first row; nv: NaN where there was none
        total, size, lasted = (f"w.{quoted(f'{what}__{n}')}" for what in ("sum", "size", "for"))
        before = f"greatest({nk} - w.k * p__step, 0)"
        known = f"{nv} is not null and not isnan({nv})"

        def over(of: str, earlier: str) -> str:
            both = f"({of} + {earlier} * {before}) / nullif({lasted} + {before}, 0)"
            return f"(case when {known} then {both} else {of} / nullif({lasted}, 0) end)"

        mean = over(total, nv)
        mean = _either_way(mean, over(size, f"abs({nv})")) if column.quantity in UNDIRECTED else mean
        return f"case when {v} is null then nullif({pv}, 'nan'::double) else {mean} end"
    if column.held:
        return pv
    share = f"(w.k - {pk}) / ({nk} - {pk})"
    between = f"{pv} + ({nv} - {pv}) * {share}"
    if column.quantity in UNDIRECTED:
        # a line from one sign to the other goes through nought, where the axis may never have stood
        size = f"abs({pv}) + (abs({nv}) - abs({pv})) * {share}"
        between = f"case when {pv} * {nv} < 0 then {size} else {between} end"
    return f"case when {v} is not null then {v} when {nk} - {pk} <= w.reach__{i} then {between} end"


def _binned(campaign: str, groups: list[Group], channels: tuple[str, ...]) -> str:
    bins = []
    for i, group in enumerate(groups):
        values = ", ".join(f"{bin_value(c)} as {quoted(c.name)}" for c in group.columns)
        source, sums = _source(i), [held_sums(c, "p__step") for c in group.columns if c.on_change]
        if sums:
            values = ", ".join([values, *sums, "min(r.t_s) as first__s"])
            source = f"(select *, lead(t_s) over (order by t_s) as next__s from {source}) r"
        bins.append(f"s__{i} as (select {bin_index('p__step')} as b__k, {values} from {source} group by 1)")
    reach = ", ".join(
        f"(select case when period > p__step / 2 then {INTERPOLATED_PERIODS} * period / p__step "
        f"else 0 end from e__{i}) as reach__{i}"
        for i in range(len(groups))
    )
    windows = ", ".join(_neighbour_bins(i, c) for i, g in enumerate(groups) for c in g.columns)
    joins = " ".join(f"left join s__{i} on s__{i}.b__k = g.k" for i in range(len(groups)))
    out = _by_channel(groups, channels, _value)
    return (
        f"with {_grid(campaign, groups)}, {', '.join(bins)}, "
        f"w as (select g.k, g.t0, {reach}, {windows} from g {joins} window "
        f"before as (order by g.k rows between unbounded preceding and current row), "
        f"behind as (order by g.k rows between current row and unbounded following), "
        f"earlier as (order by g.k rows between unbounded preceding and 1 preceding)) "
        f"select {_head(campaign, 'w')}, {', '.join(out)} from w order by w.k"
    )


def _aligned(campaign: str, groups: list[Group], channels: tuple[str, ...]) -> str:
    def value(i: int, column: Column) -> str:
        bare = f"s__{i}.{quoted(column.name)}"
        return bare if column.held else f"case when {fresh(i)} then {bare} end"

    def flag(i: int, column: Column) -> str:
        bare = f"s__{i}.{quoted(column.name + '__flag')}"
        return bare if column.held else f"case when {fresh(i)} then {bare} end"

    def fresh(i: int) -> str:
        return f"g.k * p__step - s__{i}.t_s < (select greatest({AGED_PERIODS} * period, p__step) from e__{i})"

    joins = " ".join(
        f"asof left join (select * from {_source(i)}) s__{i} on g.k * p__step + {_SLACK} >= s__{i}.t_s"
        for i in range(len(groups))
    )
    values = _by_channel(groups, channels, value)
    flags = _by_channel(groups, channels, flag, "__flag")
    out = ", ".join(text for pair in zip(values, flags, strict=True) for text in pair)
    return f"with {_grid(campaign, groups)} select {_head(campaign, 'g')}, {out} from g {joins} order by g.k"


def _by_channel(
    groups: list[Group], channels: tuple[str, ...], expression: Callable[[int, Column], str], suffix: str = ""
) -> list[str]:
    """One expression a channel; a channel that moved between sources comes from whichever has it."""
    out = []
    for channel in channels:
        expressions = [expression(i, c) for i, g in enumerate(groups) for c in g.columns if c.name == channel]
        text = expressions[0] if len(expressions) == 1 else f"coalesce({', '.join(expressions)})"
        out.append(f"{text} as {quoted(channel + suffix)}")
    return out
