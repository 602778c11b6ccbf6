"""`StoreView`: SQL over a store, and the answers that are asked for most often."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.errors import StoreError, UsageError, unknown_name
from thermodata.store import Store
from thermodata.store.base.connection import damaged_data, literal
from thermodata.view.query.reserved import reserved_hint
from thermodata.view.query.rows import Rows
from thermodata.view.query.statements import check_statement
from thermodata.view.query.units import KnownUnits, column_units, known_units
from thermodata.view.query.unknown_column import unknown_column_hint

if TYPE_CHECKING:
    import duckdb

    from thermodata.view.grid.dataset import Dataset


class FlaggedValuesWarning(UserWarning):
    """A query takes values of samples that do not count in means."""


class StoreView:
    """Read-only. Answers see the store as of their making, hold no lock, and give .df(), .to_arrow_table() with units,
    .pl() and .fetchall().

    store: its folder, or a Store. UsageError where there is none.
    """

    def __init__(self, store: Store | str | Path = "thermodata.store") -> None:
        self.store = store if isinstance(store, Store) else Store(Path(store))
        self._known: tuple[duckdb.DuckDBPyConnection, KnownUnits] | None = None

    def __repr__(self) -> str:
        return f"StoreView({str(self.store.path)!r})"

    @property
    def path(self) -> Path:
        """The store's folder."""
        return self.store.path

    def sql(
        self,
        query: str,
        params: Sequence[Any] | dict[str, Any] | None = None,
        *,
        tell: Callable[[str], object] | None = None,
    ) -> Rows:
        """The relation of a query over the store's tables, views and macros (docs/architecture.md#tables-and-views).

        params: values of `?` or `$name`. tell: is told where the query takes flagged values and asks for no flag; by
        default that is a `FlaggedValuesWarning`. UsageError where DuckDB refuses the query, with its reason;
        StoreError where a file is gone.
        """
        import duckdb

        con = self.store.connect()
        try:
            # the connection is a copy that later queries share: a write would spoil it and change nothing on disk
            for statement in con.extract_statements(query):
                check_statement(statement, self.path)
            relation = con.sql(query, params=params) if params is not None else con.sql(query)
        except duckdb.IOException as error:
            raise StoreError(
                "a file of the store can't be read",
                where=str(self.path),
                got=str(error).strip(),
                hint="ingest the campaign again: what can be made anew is made anew; "
                "'thermodata check' lists what is damaged",
            ) from error
        except duckdb.Error as error:
            damage = damaged_data(self.path, error)
            if damage is not None:
                raise damage from error
            parsed = not isinstance(error, duckdb.ParserException)
            hint = unknown_column_hint(con, query, error) if parsed else reserved_hint(query)
            raise UsageError("the query fails", got=str(error).strip(), hint=hint) from error
        if relation is None:
            raise UsageError(
                "the query gives no table",
                expected="SELECT, FROM, DESCRIBE or SHOW",
                got=query,
                hint="begin it with one of these: the store is written by 'ingest', 'fit' and 'diagnose' alone",
            )
        flagged = self.values_that_do_not_count(query, relation.columns)
        if flagged is not None and tell is not None:
            tell(flagged)
        elif flagged is not None:
            warnings.warn(flagged, FlaggedValuesWarning, stacklevel=2)
        return Rows(relation, lambda: column_units(con, self._known_units(con), query, relation), con.interrupt)

    def _known_units(self, con: duckdb.DuckDBPyConnection) -> KnownUnits:
        if self._known is None or self._known[0] is not con:  # a commit gives another copy
            self._known = (con, known_units(con))
        return self._known[1]

    def verify(self, query: str) -> str | None:
        """Looks at the checksums of the files that a query reads; see `verify.verify_pages`. A sentence where not all
        were looked at."""
        from thermodata.view.query.verify import verify_pages

        con = self.store.connect()
        statements = con.extract_statements(query)
        if len(statements) != 1 or statements[0].type.name != "SELECT":
            return None if not statements else "the pages of what it read were not verified: thermodata check does"
        return verify_pages(con, self.path, query)

    def values_that_do_not_count(self, query: str, columns: Collection[str]) -> str | None:
        """See `not_counting`: a sentence where a query takes flagged values and asks for no flag."""
        from thermodata.view.query.not_counting import values_that_do_not_count

        return values_that_do_not_count(self.store.connect(), query, columns)

    def signal(self, campaign: str, test: str, channel: str) -> Rows:
        """One channel of one test: campaign, test, source, channel, t, t_s, value, flag."""
        return self._macro("signal", campaign, test, channel)

    def binned(self, campaign: str, test: str | Sequence[str] | None = None, step: str | float = "30 s") -> Rows:
        """One row a bin: means of the valid samples, states held. test: one, several, or None for all of the campaign.
        step: '30 s', '1 min', or seconds (60, '60')."""
        return self._macro("binned", campaign, test, str(step))

    def aligned(self, campaign: str, test: str | Sequence[str] | None = None, step: str | float = "30 s") -> Rows:
        """One row a point: each channel's last sample and its flag. test, step: as of `binned`."""
        return self._macro("aligned", campaign, test, str(step))

    def residual(
        self, model: str, campaign: str | None = None, test: str | None = None, response: str | None = None
    ) -> Rows:
        """Measured and predicted of a model. model: its id, a unique prefix of it, or a name (the newest version).

        UsageError names the nearest campaign, test or response where the model was not predicted on the given one.
        """
        chosen = self.model_id(model)
        for name, value in (("campaign", campaign), ("test", test), ("response", response)):
            if value is None:
                continue
            query = f"select distinct {name} from prediction where model = ? order by {name}"
            known = [str(row[0]) for row in self.sql(query, [chosen]).fetchall()]
            if value not in known:
                raise unknown_name(f"{name} in the predictions of {model}", value, known)
        given = {"model": chosen, "campaign": campaign, "test": test, "response": response}
        where = " and ".join(f"{name} = {literal(value)}" for name, value in given.items() if value is not None)
        return self.sql(f"select * from residual where {where} order by campaign, test, response, t_s")

    def model_id(self, ref: str) -> str:
        """The id of a model from its id, a unique prefix, or a name (the newest version of that name)."""
        with self.store.reader() as con:
            rows = con.execute("select model, name from model order by created_at, rowid").fetchall()
        if ref in (ids := [model for model, _ in rows]):
            return ref
        named = [str(model) for model, name in rows if name == ref]
        if named:
            return named[-1]
        begun = [str(model) for model in ids if model.startswith(ref)] if ref else []
        if len(begun) > 1:
            raise UsageError(
                f"'{ref}' begins several models",
                expected=", ".join(begun),
                got=ref,
                hint="give more of the id",
            )
        if not begun:
            raise unknown_name("model", ref, [*dict.fromkeys(str(name) for _, name in rows), *ids])
        return begun[0]

    def tests(self, campaign: str | None = None) -> Rows:
        """The table `test`."""
        return self.sql(f"select * from test{_where_campaign(campaign)}")

    def channels(self, campaign: str | None = None) -> Rows:
        """The table `channel`: one row a test and channel, with unit, place, axis and sign."""
        return self.sql(f"select * from channel{_where_campaign(campaign)}")

    def dataset(
        self, campaigns: str | Sequence[str], step_s: float = 30.0, channels: Collection[str] | None = None
    ) -> Dataset:
        """All tests of the campaigns on one grid; see `view.grid.load.load_dataset`."""
        from thermodata.view.grid.load import load_dataset

        return load_dataset(self.store, campaigns, step_s, channels)

    def _macro(self, name: str, *arguments: str | Sequence[str] | None) -> Rows:
        return self.sql(f"select * from {name}({', '.join(map(_argument, arguments))})")


def _argument(value: str | Sequence[str] | None) -> str:
    if value is None or isinstance(value, str):
        return "null" if value is None else literal(value)
    return f"[{', '.join(map(literal, value))}]::varchar[]"


def _where_campaign(campaign: str | None) -> str:
    return "" if campaign is None else f" where campaign = {literal(campaign)}"
