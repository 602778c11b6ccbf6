"""What runs in the process of its own: one request on stdin; on stdout a line of JSON about the answer, then its rows.

The line: {"columns": [[name, type], ...]} or {"refused": {what, where, expected, got, hint, exit_code}}. For a table
the line holds the rows too, whether there are more, and the units of its columns.
"""

from __future__ import annotations

import contextlib
import json
import math
import sys
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

from thermodata.errors import ThermodataError, UsageError

if TYPE_CHECKING:
    import duckdb

_BATCH = 10_000
_MOST_TEXT = 2_000  # letters of a cell of a table


def main(source: IO[bytes], sink: IO[bytes]) -> int:
    """0, or the exit code of what was refused."""
    request = json.loads(source.readline())
    try:
        _limit(request["cpu_s"], request["memory_mb"])
        _answer(request, sink)
    except ThermodataError as error:
        return _write_refusal(sink, error)
    except MemoryError:
        return _write_refusal(sink, _too_much(request["memory_mb"]))
    except Exception as error:
        # by name: an error of DuckDB's is the query's, whatever its class is
        if not type(error).__module__.lstrip("_").startswith("duckdb"):
            raise
        if type(error).__name__ == "OutOfMemoryException":
            return _write_refusal(sink, _too_much(request["memory_mb"]))
        return _write_refusal(sink, UsageError("the query fails", got=str(error).strip()))
    return 0


def _answer(request: dict[str, Any], sink: IO[bytes]) -> None:
    from thermodata.store import Store
    from thermodata.view.query.units import column_units, known_units
    from thermodata.view.sandbox.enclosed import enclosed
    from thermodata.view.sandbox.parse import check_select

    con = enclosed(Store(Path(request["store"])), request["memory_mb"])
    check_select(con, request["query"])
    relation = _relation_of(con, request["query"])
    if relation is None:
        raise UsageError(
            "the query gives no table",
            expected="a SELECT",
            got=request["query"],
            hint="begin it with SELECT or FROM: nothing can be changed here",
        )
    head: dict[str, Any] = {"columns": [[n, str(t)] for n, t in zip(relation.columns, relation.types, strict=True)]}
    most = int(request["rows"])
    if request["form"] == "table":
        first = relation.limit(most + 1)
        rows = first.fetchall()
        head |= {"rows": [[_cell(v) for v in row] for row in rows[:most]], "more": len(rows) > most}
        head["units"] = column_units(con, known_units(con), request["query"], first)
        _line(sink, head)
        return
    _line(sink, head)
    _stream(relation.limit(most), request["form"], sink)


def _relation_of(con: duckdb.DuckDBPyConnection, query: str) -> duckdb.DuckDBPyRelation | None:
    """The relation of a query; UsageError where DuckDB refuses it, with what `thermodata sql` says to do."""
    import duckdb

    from thermodata.view.query.unknown_column import unknown_column_hint

    try:
        return con.sql(query)
    except duckdb.BinderException as error:
        raise UsageError(
            "the query fails", got=str(error).strip(), hint=unknown_column_hint(con, query, error)
        ) from error


def _stream(relation: duckdb.DuckDBPyRelation, form: str, sink: IO[bytes]) -> None:
    import pyarrow as pa
    import pyarrow.csv as csv
    import pyarrow.parquet as pq

    found: Any = relation
    reader = found.to_arrow_reader(_BATCH) if hasattr(found, "to_arrow_reader") else found.fetch_record_batch(_BATCH)
    if form == "parquet":
        # a Parquet file is written forwards only, but pyarrow asks the sink where it is
        with pq.ParquetWriter(pa.PythonFile(_Counting(sink), mode="w"), reader.schema) as writer:
            for batch in reader:
                writer.write_batch(batch)
        return
    flat = pa.schema([(f.name, pa.string() if pa.types.is_nested(f.type) else f.type) for f in reader.schema])
    with csv.CSVWriter(sink, flat) as writer:
        for batch in reader:
            columns = [
                pa.array([None if v is None else json.dumps(v, default=str) for v in column.to_pylist()])
                if pa.types.is_nested(column.type)
                else column
                for column in batch.columns
            ]
            writer.write_batch(pa.record_batch(columns, schema=flat))


class _Counting:
    """A pipe that knows how much went through it."""

    closed = False

    def __init__(self, sink: IO[bytes]) -> None:
        self._sink, self._at = sink, 0

    def write(self, data: Any) -> int:
        self._sink.write(data)
        self._at += len(data)
        return len(data)

    def tell(self) -> int:
        return self._at

    def flush(self) -> None:
        self._sink.flush()

    def close(self) -> None:
        self.flush()

    def readable(self) -> bool:
        return False

    def writable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return False


def _cell(value: Any) -> Any:
    if value is None or isinstance(value, bool | int):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else str(value)
    text = value if isinstance(value, str) else str(value)
    return text if len(text) <= _MOST_TEXT else text[:_MOST_TEXT] + "…"


def _limit(cpu_s: int, memory_mb: int) -> None:
    """Limits of the process, where the system has them; time is also watched from outside."""
    with contextlib.suppress(ImportError):
        import resource

        # beyond DuckDB's own: values of a result are Python's. A margin for the interpreter and its libraries
        for what, most in ((resource.RLIMIT_CPU, cpu_s), (resource.RLIMIT_DATA, (2 * memory_mb + 1024) << 20)):
            hard = resource.getrlimit(what)[1]
            top = most if hard == resource.RLIM_INFINITY else min(most, hard)
            resource.setrlimit(what, (top, top))


def _too_much(memory_mb: int) -> UsageError:
    return UsageError(
        "the query needs too much memory",
        expected=f"at most {memory_mb} MB",
        hint="ask for fewer tests or coarser bins: binned(campaign, test, '60 s')",
    )


def _write_refusal(sink: IO[bytes], error: ThermodataError) -> int:
    _line(sink, {"refused": {k: getattr(error, k) for k in ("what", "where", "expected", "got", "hint", "exit_code")}})
    return error.exit_code


def _line(sink: IO[bytes], value: dict[str, Any]) -> None:
    sink.write(json.dumps(value, default=str).encode() + b"\n")
    sink.flush()


if __name__ == "__main__":
    sys.exit(main(sys.stdin.buffer, sys.stdout.buffer))
