"""What the views are made from: the tidy files in groups of equal columns, read from the catalogue's tables."""

from __future__ import annotations

import json
import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.schema.units.quantity import CANONICAL_UNIT, STATES
from thermodata.store.base.connection import literal

if TYPE_CHECKING:
    import duckdb

# what a model explains; every other quantity can drive one
SCHEDULE = "schedule"


@dataclass(frozen=True, slots=True)
class Column:
    """A channel's column of a group. held: its last value stands until the next one; text: no number. on_change: of a
    number that is held, that it stands until the next row, which may say that there is none."""

    name: str
    quantity: str
    unit: str
    held: bool
    text: bool
    comment: str
    on_change: bool = False


@dataclass(frozen=True, slots=True)
class Group:
    """Tidy files of one (campaign, source, stream) with equal columns, so one read_parquet serves them all.

    name: unique suffix for views and macros. paths: test -> its files, relative to the store. broken: the first of
    them that is gone or cut, if any. rows: of all of them.
    """

    campaign: str
    source: str
    stream: str
    name: str
    columns: tuple[Column, ...]
    paths: Mapping[str, tuple[str, ...]]
    broken: str | None = None
    rows: int = 0

    @property
    def files(self) -> list[str]:
        return sorted({path for paths in self.paths.values() for path in paths})


@dataclass(frozen=True, slots=True)
class Catalogue:
    """campaigns: id -> unique suffix for macros. channels: campaign -> names in the campaign file's order."""

    campaigns: Mapping[str, str]
    groups: tuple[Group, ...]
    channels: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    def of(self, campaign: str) -> list[Group]:
        return [g for g in self.groups if g.campaign == campaign]


class Namer:
    """Plain identifiers from any text, unique ignoring case as DuckDB's are."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def __call__(self, *parts: str) -> str:
        bare = re.sub(r"[^A-Za-z0-9]+", "_", "_".join(parts)).strip("_") or "x"
        name, number = bare, 1
        while name.lower() in self._taken:
            number += 1
            name = f"{bare}_{number}"
        self._taken.add(name.lower())
        return name


def read_catalogue(con: duckdb.DuckDBPyConnection, folder: Path | None = None) -> Catalogue:
    """The campaigns and the groups of tidy files that views show (not the histories before windows).

    folder: the store's, to find out which files are gone or cut.
    """
    rows = con.execute(
        "select campaign, source, stream, test, path, columns->>'$.channels', columns->>'$.held', bytes, rows "
        "from file where layer = 'tidy' and part = 'test' order by campaign, source, stream, test, path"
    ).fetchall()
    known = con.execute(
        "select campaign from campaign union select campaign from test union select campaign from file order by 1"
    ).fetchall()
    described = _descriptions(con)
    namer, campaign_namer = Namer(), Namer()
    campaigns = {campaign: campaign_namer(campaign) for (campaign,) in known}
    files: dict[tuple[str, str, str, str | None, str | None], dict[str, list[str]]] = {}
    # files made before a campaign's channels changed stand in their own group: their columns differ
    sizes: dict[str, int | None] = {}
    lengths: dict[str, int] = {}
    for campaign, source, stream, test, path, channels, held, size, length in rows:
        sizes[path], lengths[path] = size, length or 0
        files.setdefault((campaign, source, stream, channels, held), {}).setdefault(test, []).append(path)
    streams: dict[tuple[str, str], set[str]] = {}
    for campaign, source, stream, *_ in files:
        streams.setdefault((campaign, source), set()).add(stream)
    groups = []
    for (campaign, source, stream, channels, held), tests in files.items():
        paths = {test: tuple(p) for test, p in tests.items()}
        listed = [p for some in paths.values() for p in some]
        broken = [p for p in listed if folder is not None and not _as_long(folder / p, sizes[p])]
        whole = next((p for p in listed if p not in broken), None)
        suffix = (campaign, source, stream) if len(streams[campaign, source]) > 1 else (campaign, source)
        groups.append(
            Group(
                campaign,
                source,
                stream,
                namer(*suffix),
                _columns(con, whole, channels, source, described.get(campaign, {}), json.loads(held or "[]")),
                paths,
                broken[0] if broken else None,
                sum(lengths[p] for p in set(listed)),
            )
        )
    order = {c: _ordered(described.get(c, {}), [g for g in groups if g.campaign == c]) for c in campaigns}
    return Catalogue(campaigns, tuple(groups), order)


def _descriptions(con: duckdb.DuckDBPyConnection) -> dict[str, dict[str, tuple[str, str, str]]]:
    """campaign -> channel -> (quantity, unit, comment), in the order of the table."""
    rows = con.execute(
        "select campaign, channel, first(quantity order by rowid), first(unit order by rowid), "
        'first(axis order by rowid), first("at" order by rowid), first(relative_to order by rowid), '
        "first(sign order by rowid) from channel group by campaign, channel order by min(rowid)"
    ).fetchall()
    descriptions: dict[str, dict[str, tuple[str, str, str]]] = {}
    for campaign, channel, quantity, unit, axis, at, relative_to, sign in rows:
        words = [f"[{unit}] {quantity}"]
        words += [f"axis {axis}"] if axis else []
        words += [f"at {at}"] if at else []
        words += [f"relative to {relative_to}"] if relative_to else []
        words += ["sign unknown"] if sign == "unknown" else []
        descriptions.setdefault(campaign, {})[channel] = (quantity, unit, ", ".join(words))
    return descriptions


def _as_long(path: Path, size_bytes: int | None) -> bool:
    try:
        return path.stat().st_size == size_bytes or not size_bytes
    except OSError:
        return False


def _columns(
    con: duckdb.DuckDBPyConnection,
    path: str | None,
    channels: str | None,
    source: str,
    described: Mapping[str, tuple[str, str, str]],
    on_change: Collection[str] = (),
) -> tuple[Column, ...]:
    """The channels of a tidy file: the columns that have a flag column. Where no file is whole, what the catalogue
    says of them."""
    if path is None:
        types = {
            n: "VARCHAR" if described.get(n, ("", "", ""))[0] == "label" else "DOUBLE"
            for n in json.loads(channels or "[]")
        }
        types |= {f"{n}__flag": "USMALLINT" for n in types}
    else:
        types = _types(con, path)
    columns = []
    for name, kind in types.items():
        if f"{name}__flag" not in types:
            continue
        text = kind == "VARCHAR"
        quantity, unit, comment = described.get(name, ("label" if text else "", "", ""))
        held = text or quantity in STATES or source == SCHEDULE
        number = name in on_change and not held
        unit = unit or CANONICAL_UNIT.get(quantity, "")
        columns.append(Column(name, quantity, unit, held or number, text, comment, number))
    return tuple(columns)


def _types(con: duckdb.DuckDBPyConnection, path: str) -> dict[str, str]:
    return {
        name: kind
        for name, kind, *_ in con.execute(
            f"describe select * from read_parquet([{literal(path)}], hive_partitioning = false)"
        ).fetchall()
    }


def _ordered(described: Iterable[str], groups: Iterable[Group]) -> tuple[str, ...]:
    present = {column.name: None for group in groups for column in group.columns}
    return tuple([n for n in described if n in present] + [n for n in present if n not in set(described)])
