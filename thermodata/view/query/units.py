"""The units of a query's columns, where they are certain: columns that the query takes as they are from the store.

A column is a channel where its table has channels for columns, or its view says its unit in a comment ('[s] from the
start of the test'; 'in channel.unit' is the unit of the channels that the rows are of, 'in the response's unit' that of
their errors: K of a temperature). What is computed has none: half of a displacement may be a radius.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from thermodata.schema.units.unit import difference_unit

if TYPE_CHECKING:
    import duckdb

_IN_BRACKETS = re.compile(r"\[([^\]]+)\]")
_OF_CHANNEL = "in channel.unit"
_OF_RESPONSE = "in the response's unit"
_WIDE = ("wide_", "binned", "aligned")  # tables and macros that have a column for each channel
_NAMES = ("channel", "response")  # columns that say which channel a row is of


@dataclass(frozen=True)
class KnownUnits:
    """What a copy of the catalogue says. channels: channel -> its unit, None where it has several. comments: table ->
    column -> comment. columns: table -> its columns. responses: of the models."""

    channels: Mapping[str, str | None]
    comments: Mapping[str, Mapping[str, str]]
    columns: Mapping[str, frozenset[str]]
    responses: frozenset[str]

    def of_errors(self, response: str) -> str | None:
        """The unit of a response's errors; None where it is not known, or several."""
        unit = self.channels.get(response)
        return None if unit is None else difference_unit(unit)


def known_units(con: duckdb.DuckDBPyConnection) -> KnownUnits:
    """Asked once a copy: it takes as long as a small query."""
    channels = con.execute(
        "select channel, case when count(distinct unit) = 1 then any_value(unit) end from channel "
        "where unit <> '' group by channel"
    ).fetchall()
    comments: dict[str, dict[str, str]] = {}
    columns: dict[str, set[str]] = {}
    for table, column, comment in con.execute(
        "select table_name, column_name, comment from duckdb_columns()"
    ).fetchall():
        columns.setdefault(str(table), set()).add(str(column))
        if comment is not None:
            comments.setdefault(str(table), {})[str(column)] = str(comment)
    responses = con.execute("select distinct unnest(string_split(response, ', ')) from model").fetchall()
    return KnownUnits(
        {str(channel): unit for channel, unit in channels},
        comments,
        {table: frozenset(names) for table, names in columns.items()},
        frozenset(str(name) for (name,) in responses),
    )


def column_units(
    con: duckdb.DuckDBPyConnection, known: KnownUnits, query: str, relation: duckdb.DuckDBPyRelation
) -> dict[str, str]:
    """column of the relation -> unit. con: of the connection that made it."""
    sources = _sources(con, query)
    if sources is None:
        return {}
    columns, tables = sources
    said = _comments(known, tables)
    units: dict[str, str] = {}
    for name in relation.columns:
        source = name if columns is None else columns.get(name)
        if source is None:
            continue
        comment = said.get(source)
        if comment is None and source in known.channels:
            unit = known.channels[source] if _is_channel(known, tables, source) else None
        elif comment is not None and _OF_CHANNEL in comment:
            unit = _one_unit(map(known.channels.get, _of_rows(relation) or ()))
        elif comment is not None and _OF_RESPONSE in comment:
            rows = _of_rows(relation)
            unit = _one_unit(map(known.of_errors, known.responses if rows is None else rows))
        else:
            found = _IN_BRACKETS.match(comment or "")
            unit = found[1] if found else None
        if unit and unit != "1":
            units[name] = unit
    return units


def _sources(con: duckdb.DuckDBPyConnection, query: str) -> tuple[dict[str, str] | None, list[str]] | None:
    """(column -> the one it is, None where all are as they are; tables and macros named), of one plain SELECT over
    them; None for anything else."""
    tree = json.loads(con.execute("select json_serialize_sql(?)", [query]).fetchall()[0][0])  # drained
    if tree.get("error") or len(tree["statements"]) != 1:
        return None
    node = tree["statements"][0]["node"]
    if node.get("type") != "SELECT_NODE" or node.get("group_expressions"):
        return None
    if (node.get("cte_map") or {}).get("map"):
        return None
    tables = list(_tables(node.get("from_table") or {}))
    if not tables or "" in tables:
        return None
    columns: dict[str, str] = {}
    whole = False
    for item in node["select_list"]:
        if item.get("class") == "STAR":
            whole = whole or not (item.get("replace_list") or item.get("expr"))
        elif item.get("class") == "COLUMN_REF":
            source = str(item["column_names"][-1])
            columns[item.get("alias") or source] = source
        elif item.get("alias"):
            columns[item["alias"]] = ""
    if not whole:
        return columns, tables
    # '*' gives all as they are, but for what stands beside it under a name of its own
    return (None if not columns else _Star(columns)), tables


class _Star(dict[str, str]):
    """The columns beside a '*', which gives all others as they are."""

    def get(self, name: str, default: Any = None) -> Any:
        return dict.get(self, name, name)


def _tables(node: Mapping[str, Any]) -> Iterable[str]:
    """Names of tables and table macros; '' for what is neither."""
    kind = node.get("type")
    if kind == "BASE_TABLE":
        yield str(node["table_name"])
    elif kind == "TABLE_FUNCTION":
        yield str(node["function"].get("function_name", ""))
    elif kind == "JOIN":
        yield from _tables(node["left"])
        yield from _tables(node["right"])
    else:
        yield ""


def _comments(known: KnownUnits, tables: list[str]) -> dict[str, str]:
    """column -> comment, of the columns that one of the tables alone has."""
    # what the macro of one channel gives has the columns of the view over all
    found = [known.comments.get("sample" if t == "signal" else t, {}) for t in tables]
    once = Counter(name for each in found for name in each)
    return {"t_s": "[s]", **{n: text for each in found for n, text in each.items() if once[n] == 1}}


def _is_channel(known: KnownUnits, tables: Iterable[str], column: str) -> bool:
    """Whether a column is of a table that has channels for columns, and of no other one."""
    wide = [t for t in tables if t.startswith(_WIDE)]
    others = (known.columns.get(t, frozenset[str]()) for t in tables if t not in wide)
    return bool(wide) and not any(column in names for names in others)


def _of_rows(relation: duckdb.DuckDBPyRelation) -> list[str] | None:
    """The channels that the rows are of; None where no column says it."""
    name = next((n for n in _NAMES if n in relation.columns), None)
    if name is None:
        return None
    return [str(c) for (c,) in relation.project(f'"{name}"').distinct().fetchall()]


def _one_unit(units: Iterable[str | None]) -> str | None:
    found = set(units)
    return found.pop() if len(found) == 1 else None
