"""The wide views, one per campaign, source and stream."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from thermodata.store.base.connection import literal, quoted
from thermodata.store.views.catalogue import Catalogue, Group
from thermodata.store.views.identifiers import identified


def file_list(paths: Iterable[str]) -> str:
    """A SQL list of paths."""
    return "[" + ", ".join(literal(path) for path in paths) + "]"


def prefix(path: str) -> str:
    """A FROM item p(prefix): what DuckDB puts before a path of the store to call the file.

    The working folder, one of the search paths, or a tidier spelling of it (2.0 resolves '..', 1.5 doesn't): only
    DuckDB knows, so it is asked. Joined on the very column `filename` it then opens only the files that a filter on
    campaign and test leaves (18 ms over 1,000 tests; 100 ms where the name is computed from the column).
    """
    return f"(select left(g.file, length(g.file) - length({literal(path)})) as prefix from glob({literal(path)}) g) p"


def wide_name(group: Group) -> str:
    return f"wide_{group.name}"


def wide_views(catalogue: Catalogue) -> Iterator[str]:
    """The statements that make the views, with units as comments of their columns."""
    for group in catalogue.groups:
        name = quoted(wide_name(group))
        columns = ", ".join(f"r.{quoted(c.name)}, r.{quoted(c.name + '__flag')}" for c in group.columns)
        yield (
            _view_that_fails(group)
            if group.broken
            else (
                f"create view {name} as select {literal(group.campaign)} as campaign, f.test, "
                f"{literal(group.source)} as source, r.t, r.t_s{', ' if columns else ''}{columns} "
                f"from read_parquet({file_list(group.files)}, filename = true, hive_partitioning = false) r "
                f"join (select q.test, p.prefix || q.path as filename from file q cross join {prefix(group.files[0])} "
                f"where q.campaign = {literal(group.campaign)} and q.source = {literal(group.source)} "
                f"and q.stream = {literal(group.stream)} and q.layer = 'tidy' and q.part = 'test') f "
                f"on f.filename = r.filename"
            )
        )
        yield (
            f"comment on view {name} is "
            + literal(f"campaign {group.campaign}, source {group.source}, stream {group.stream}")
        )
        yield from identified(name, ("campaign", "test", "source"))
        yield f"comment on column {name}.t is 'UTC'"
        yield f"comment on column {name}.t_s is '[s] from the start of the test'"
        for column in group.columns:
            if column.comment:
                yield f"comment on column {name}.{quoted(column.name)} is {literal(column.comment)}"
    listing = (
        " union all ".join(
            f"select {literal(g.campaign)}, {literal(g.source)}, {literal(g.stream)}, {literal(wide_name(g))}"
            for g in catalogue.groups
        )
        or "select null::varchar, null::varchar, null::varchar, null::varchar limit 0"
    )
    yield f'create view wide as select * from ({listing}) w(campaign, source, stream, "view")'
    yield from identified("wide", ("campaign", "source", "stream"))


def _view_that_fails(group: Group) -> str:
    """The view of a group with a damaged file: its columns, and an error for whoever reads it. Rows that are missing
    without a word would be worse, and without the view nothing else could be committed, not even the repair."""

    # values that depend on a row: a NULL that is known beforehand lets the planner skip the condition
    def nothing(kind: str) -> str:
        return f"cast(nullif(r.i, r.i) as {kind})"

    columns = "".join(
        f", {nothing('varchar' if c.text else 'double')} as {quoted(c.name)}, "
        f"{nothing('usmallint')} as {quoted(c.name + '__flag')}"
        for c in group.columns
    )
    return (
        f"create view {quoted(wide_name(group))} as select {literal(group.campaign)} as campaign, "
        f"cast(r.i as varchar) as test, {literal(group.source)} as source, "
        f"make_timestamp_ns(nullif(r.i, r.i)) as t, {nothing('double')} as t_s{columns} from range(1) r(i) "
        f"where {damaged_file(group.broken or '', group.campaign)}"
    )


def damaged_file(path: str, campaign: str) -> str:
    """A condition that is an error: what is damaged, and what to do."""
    text = (
        f"damaged store: {path} is gone or cut; try: thermodata ingest the campaign file of '{campaign}' again, "
        "it makes the file anew"
    )
    return f"cast(error({literal(text)}) as boolean)"
