"""The answer of a query: a relation of DuckDB's whose Arrow tables say the unit of each column that has one."""

from __future__ import annotations

from collections.abc import Callable
from html import escape
from typing import TYPE_CHECKING, Any

from thermodata.errors import UsageError

if TYPE_CHECKING:
    import duckdb

UNIT = "unit"
"""The key of a field's metadata, in Arrow and Parquet."""
_SHOWN = 12


class Rows:
    """A relation with all that DuckDB's has (`df`, `fetchall`, `filter`, `limit`, ...), asked when it is needed.

    units: column -> unit, found out when they are asked for; a column that is computed has none. interrupt: ends what
    runs, called from another thread than the one that waits for its rows.
    """

    def __init__(
        self, relation: duckdb.DuckDBPyRelation, units: Callable[[], dict[str, str]], interrupt: Callable[[], None]
    ) -> None:
        self._relation, self._ask, self.interrupt = relation, units, interrupt
        self._units: dict[str, str] | None = None

    def __getattr__(self, name: str) -> Any:
        return getattr(self._relation, name)

    def __len__(self) -> int:
        return len(self._relation)

    def __repr__(self) -> str:
        return repr(self._relation)

    def __str__(self) -> str:
        return str(self._relation)

    @property
    def relation(self) -> duckdb.DuckDBPyRelation:
        """DuckDB's own."""
        return self._relation

    def units(self) -> dict[str, str]:
        """column -> unit of the columns that are channels or have one by the views' comments."""
        if self._units is None:
            self._units = self._ask()
        return self._units

    def to_arrow_table(self, *arguments: Any) -> Any:
        """As a pyarrow.Table; `table.schema.field("dZ").metadata[b"unit"]` is b"um"."""
        found: Any = self._relation.to_arrow_table(*arguments)
        return with_units(found, self._units_of(found))

    def arrow(self, *arguments: Any) -> Any:
        """The same as `to_arrow_table`."""
        return self.to_arrow_table(*arguments)

    def pl(self, *arguments: Any) -> Any:
        """As a polars.DataFrame. UsageError where Polars is not installed."""
        try:
            import polars  # noqa: F401
        except ImportError as error:
            raise UsageError(
                "Polars is not installed",
                expected="the extra 'polars'",
                got="an environment without it",
                hint='pip install "thermodata[polars]"; .df() and .to_arrow_table() need nothing more',
            ) from error
        return self._relation.pl(*arguments)

    def __arrow_c_stream__(self, requested_schema: Any = None) -> Any:
        return self.to_arrow_table().__arrow_c_stream__(requested_schema)

    def _units_of(self, table: Any) -> dict[str, str]:
        return {name: unit for name, unit in self.units().items() if name in table.column_names}

    def _repr_html_(self) -> str:
        """The first rows, with units in the heads."""
        columns, units = list(self._relation.columns), self.units()
        rows = self._relation.limit(_SHOWN + 1).fetchall()
        heads = "".join(
            f"<th>{escape(name)}{f' [{escape(units[name])}]' if name in units else ''}</th>" for name in columns
        )
        body = "".join(f"<tr>{''.join(f'<td>{escape(_short(v))}</td>' for v in row)}</tr>" for row in rows[:_SHOWN])
        more = "<p>… and more rows</p>" if len(rows) > _SHOWN else ""
        return f"<table><thead><tr>{heads}</tr></thead><tbody>{body}</tbody></table>{more}"


def with_units(table: Any, units: dict[str, str]) -> Any:
    """A pyarrow.Table whose fields name their units."""
    import pyarrow as pa

    fields = [
        field.with_metadata({**(field.metadata or {}), UNIT: units[field.name]}) if field.name in units else field
        for field in table.schema
    ]
    return table.cast(pa.schema(fields, table.schema.metadata))


def _short(value: Any) -> str:
    if value is None:
        return "–"
    text = f"{value:.6g}" if isinstance(value, float) else str(value)
    return text if len(text) <= 60 else text[:59] + "…"
