"""SQL over the store, in a process of its own; the views stand beside the question."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
from starlette.requests import Request
from starlette.responses import Response, StreamingResponse

from thermodata.chart.colour import EFFECTS, effect_styles
from thermodata.chart.pack import script_json
from thermodata.chart.parts import Axis, Panel, Series
from thermodata.chart.spec import Chart
from thermodata.errors import ThermodataError, UsageError, unknown_name
from thermodata.store import Store
from thermodata.store.base.connection import fetch
from thermodata.view.query.store_view import StoreView
from thermodata.view.sandbox.ask import Form, Limits, Table, ask, stream
from thermodata.web.command import command
from thermodata.web.render import desk_of, page

EXAMPLES = (
    ("all tests", "select campaign, test, kind, role, duration_s from test"),
    (
        "campaigns with their machines",
        "select campaign, machine, count(*) as tests, sum(duration_s) / 3600 as hours from test "
        "join machine using (campaign, test) group by all order by 1",
    ),
    (
        "errors over all campaigns",
        "select campaign, name, model, role, count(*) as tests, max(rmse_um) from score join model using (model) "
        "where phase = 'all' group by all order by all",
    ),
    ("errors of a role", "select * from score where role like 'verification%' and phase = 'all'"),
    ("a test on one grid", "select * from binned('{campaign}', '{test}', '60 s')"),
    (
        "extremes of each channel",
        "select channel, min(value), max(value) from temperature where valid(flag) group by all order by 3 desc",
    ),
)
_KINDS: dict[str, str] = {"csv": "text/csv", "parquet": "application/vnd.apache.parquet"}
_TAKEN = Limits(seconds=120, rows=5_000_000)
_NUMBER = re.compile(r"DOUBLE|FLOAT|DECIMAL\(.*\)|U?(?:TINYINT|SMALLINT|INTEGER|BIGINT|HUGEINT)")  # DuckDB's types
_WIDE = "wide_"
_MOST_CURVES, _MOST_QUERY = len(EFFECTS), 20_000
_HEIGHT = 260  # of a panel, as the template knows it


def show(request: Request) -> Response:
    """GET /sql: q (the query, run where there is one), plot (the column along x)."""
    desk, given = desk_of(request), request.query_params
    store = desk.store()
    query = given.get("q", "").strip()
    table: Table | None = None
    error: ThermodataError | None = None
    if query:
        try:
            table = ask(store.path, _short(query))
        except ThermodataError as refused:
            error = refused
    numbers = _numbers(table) if table else []
    x = given.get("plot") or (numbers[0] if "t_s" not in numbers else "t_s") if len(numbers) > 1 else ""
    chart = _chart(table, x, numbers) if table and x in numbers and len(table.rows) > 1 else None
    return page(
        request,
        "sql.html.j2",
        title="SQL",
        command=command(desk.store_path, "sql", query or EXAMPLES[0][1]),
        status=400 if error else 200,
        sql=query,
        table=table,
        flagged=_flagged(store, query, table),
        error=error,
        numbers=numbers,
        x=x,
        plot=script_json(chart.as_json()) if chart else None,
        panels=len(chart.panels) if chart else 0,
        undrawn=_curves(numbers, x)[_MOST_CURVES:] if chart else [],
        **_beside(store),
        examples=_examples(store),
    )


def take(request: Request) -> Response:
    """GET /sql/FORM: all rows of q as a file."""
    form = request.path_params["form"]
    if form not in _KINDS:
        raise unknown_name("form", form, list(_KINDS))
    query = request.query_params.get("q", "")
    chosen: Form = "csv" if form == "csv" else "parquet"
    pieces = stream(desk_of(request).store().path, _short(query), chosen, _TAKEN)
    next(pieces)  # what is refused is told on a page, before a file begins
    headers = {"content-disposition": f'attachment; filename="thermodata.{form}"'}
    return StreamingResponse(_bytes(pieces), media_type=_KINDS[form], headers=headers)


def _bytes(pieces: Iterator[bytes]) -> Iterator[bytes]:
    yield from pieces


def _flagged(store: Store, query: str, table: Table | None) -> str | None:
    """What `thermodata sql` says of a query that takes flagged values."""
    columns = [name for name, _ in table.columns] if table else []
    return StoreView(store).values_that_do_not_count(query, columns) if table else None


def _short(query: str) -> str:
    if len(query) > _MOST_QUERY:
        raise UsageError(
            "the query is too long",
            expected=f"at most {_MOST_QUERY} letters",
            got=str(len(query)),
            hint="'thermodata sql < FILE' takes longer ones",
        )
    return query


def _numbers(table: Table) -> list[str]:
    """Columns of numbers, by name; of equal names the first."""
    return list(dict.fromkeys(n for n, kind in table.columns if _NUMBER.fullmatch(kind)))


def _curves(numbers: list[str], x: str) -> list[str]:
    return [n for n in numbers if n != x and not n.endswith("__flag")]


def _chart(table: Table, x: str, numbers: list[str]) -> Chart:
    names = [n for n, _ in table.columns]
    values = {n: np.array([_float(row[names.index(n)]) for row in table.rows]) for n in numbers}
    order = np.argsort(values[x], kind="stable")
    order = order[np.isfinite(values[x][order])]
    curves = _curves(numbers, x)[:_MOST_CURVES]
    styles = effect_styles(curves)
    by_unit: dict[str, list[str]] = {}  # micrometres and degrees share no axis
    for name in curves:
        by_unit.setdefault(table.units.get(name, ""), []).append(name)
    along = values[x][order]
    # many rows of one x make no line
    style = "line" if len(along) and len(np.unique(along)) > 0.9 * len(along) else "points"
    return Chart(
        f"{', '.join(curves)} over {x}",
        Axis(x, table.units.get(x, "s" if x.endswith("_s") else "")),
        along,
        [
            Panel(
                ", ".join(some) if len(some) < 3 else f"{len(some)} columns",
                unit,
                [Series(n, unit, values[n][order], styles[n][0], dash=styles[n][1], style=style) for n in some],  # type: ignore[arg-type]
                height=_HEIGHT,
            )
            for unit, some in by_unit.items()
        ],
    )


def _float(value: Any) -> float:
    try:
        return float(value)
    except (TypeError, ValueError):
        return float("nan")


def _beside(store: Store) -> dict[str, Any]:
    """views: those of the whole store. wide: a view a stream, of which a store of many campaigns has dozens."""
    found = _views(store)
    return {
        "views": [one for one in found if not one[0].startswith(_WIDE)],
        "wide": [one for one in found if one[0].startswith(_WIDE)],
    }


def _views(store: Store) -> list[tuple[str, list[tuple[str, str, str]]]]:
    """(view or table, its columns with type and comment), the views first."""
    with store.reader() as con:
        rows = fetch(
            con,
            "select table_name, column_name, data_type, comment from duckdb_columns() "
            "where not internal and schema_name = 'main' order by table_name, column_index",
        )
        views = [
            r["view_name"]
            for r in fetch(con, "select view_name from duckdb_views() where not internal order by view_name")
        ]
    columns: dict[str, list[tuple[str, str, str]]] = {}
    for r in rows:
        if not r["column_name"].endswith("__flag"):
            columns.setdefault(r["table_name"], []).append((r["column_name"], r["data_type"], r["comment"] or ""))
    names = [v for v in views if v != "made_from"] + [t for t in columns if t not in views]
    return [(name, columns.get(name, [])) for name in dict.fromkeys(names)]


def _examples(store: Store) -> list[tuple[str, str]]:
    with store.reader() as con:
        row = con.execute("select campaign, test from test order by rowid limit 1").fetchone()
    campaign, test = (str(v).replace("'", "''") for v in row) if row else ("campaign", "test")
    return [(name, text.format(campaign=campaign, test=test)) for name, text in EXAMPLES]
