"""`sql`: any question to the store, answered as a table, CSV or JSON."""

from __future__ import annotations

import csv
import io
import json
import re
import sys
from collections.abc import Iterator
from itertools import chain, islice
from typing import Any

import click

from thermodata.cli.terminal.common import Session, command, plain
from thermodata.cli.terminal.interrupting import interruptible
from thermodata.errors import UsageError
from thermodata.report.text.table import table

_CHUNK = 10_000
# whose values are the same in Python whether Arrow gives them or not; a time's nanoseconds come by Arrow only
_ALIKE = {"BOOLEAN", "TINYINT", "SMALLINT", "INTEGER", "BIGINT", "USMALLINT", "UINTEGER", "DOUBLE", "VARCHAR"}


@command("sql")
@click.argument("query", required=False)
@click.option("--csv", "as_csv", is_flag=True, help="Print CSV, all rows.")
@click.option("--rows", default=100, show_default=True, type=click.IntRange(1), help="Most rows of the table.")
def sql_command(session: Session, query: str | None, as_csv: bool, rows: int) -> None:
    """Ask the store in SQL.

    Tables test, channel, model, ...; views sample, temperature, displacement, driver, residual, score, ...
    'show tables' lists them, 'describe test' the columns of one; a test's name is test.test, a campaign's
    campaign.campaign.

    Without QUERY it is read from stdin. Times t are UTC; t_s are seconds from the test's start. Flagged samples are
    among the others: 'where valid(flag)' leaves out what does not count in means.
    Verification scores of a version that 'add' made have the role 'verification (in-sample)'.

    \b
      thermodata sql "from score where role like 'verification%'"
      thermodata sql "select channel, avg(value) from temperature where valid(flag) group by 1"
      thermodata sql "from binned('gantry', 'day1', '60 s')" --csv > day1.csv
      thermodata sql "from binned('gantry', ['day1', 'day2'])"; null for all tests of gantry
    """
    if as_csv and session.as_json:
        raise UsageError("--csv and --json exclude each other", hint="leave one of them out")
    if query is None:
        if sys.stdin.isatty():
            raise UsageError("no query", hint='thermodata sql "select * from test"')
        query = sys.stdin.read()
    view = session.view()
    relation = view.sql(query, tell=session.say)
    unverified = view.verify(query)
    if unverified is not None:
        session.say(unverified)
    columns: list[str] = list(relation.columns)

    def batches(rows: Any) -> Iterator[list[tuple[Any, ...]]]:
        return interruptible(_batches(rows), relation.interrupt)

    if as_csv:
        _write_csv(columns, batches(relation))
    elif session.as_json:
        _write_json(columns, batches(relation))
    else:
        first = relation.limit(rows + 1)
        found = list(islice(chain.from_iterable(interruptible(_small(first), relation.interrupt)), rows + 1))
        text = table(
            [{str(i): v for i, v in enumerate(r)} for r in found[:rows]],
            [(str(i), name) for i, name in enumerate(columns)],
        )  # by position: names may repeat
        click.echo(text)
        if empty := _left_out(columns, found[:rows], text):
            session.say(f"without a value in {'these rows' if len(found) > 1 else 'this row'}: {', '.join(empty)}")
        if len(found) > rows:
            session.say(f"the first {rows} rows; --rows N shows more, --csv all")


def _left_out(columns: list[str], rows: list[tuple[Any, ...]], text: str) -> list[str]:
    """The columns without a value in any row that a table which has no room for all of them does not show."""
    empty = [name for i, name in enumerate(columns) if rows and all(row[i] is None for row in rows)]
    heads = " ".join(part.partition("\n─")[0] for part in text.split("\n\n") if "\n─" in part)
    return [name for name in empty if re.search(rf"(?<!\w){re.escape(name)}(?!\w)", heads) is None]


def _small(relation: Any) -> Iterator[list[tuple[Any, ...]]]:
    """The rows of a relation of few: without Arrow, which takes longer to load than they to be found, where it would
    give them alike."""
    if all(str(kind) in _ALIKE for kind in relation.types):
        yield relation.fetchall()
    else:
        yield from _batches(relation)


def _batches(relation: Any) -> Iterator[list[tuple[Any, ...]]]:
    # DuckDB 2 renamed the streaming result; nothing else yields a relation's rows without running it again
    stream = relation.to_arrow_reader if hasattr(relation, "to_arrow_reader") else relation.fetch_record_batch
    for batch in stream(_CHUNK):
        yield list(zip(*(column.to_pylist() for column in batch.columns), strict=True))


def _write_csv(columns: list[str], batches: Iterator[list[tuple[Any, ...]]]) -> None:
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(columns)
    for batch in batches:
        writer.writerows(batch)
        click.echo(buffer.getvalue(), nl=False)
        buffer.seek(0)
        buffer.truncate()
    click.echo(buffer.getvalue(), nl=False)


def _write_json(columns: list[str], batches: Iterator[list[tuple[Any, ...]]]) -> None:
    # one row a line, as it comes: a list of millions is never held
    between = "["
    for batch in batches:
        for row in batch:
            click.echo(between + json.dumps(plain(dict(zip(columns, row, strict=True))), ensure_ascii=False), nl=False)
            between = ",\n "
    click.echo("[]" if between == "[" else "]")
