"""`Store`: one folder, its catalogue, and the two ways in: a private copy for reading, a short turn for writing."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.errors import StoreError, UsageError
from thermodata.store.base import connection
from thermodata.store.base.files import write_text
from thermodata.store.catalogue.format.create import (
    CATALOGUE,
    MARK,
    create_catalogue,
    new_mark,
    not_begun,
    regenerate_views,
)
from thermodata.store.catalogue.format.migrate import check_format, migrate
from thermodata.store.catalogue.lock import catalogue_lock
from thermodata.store.views.version import of_this_version

if TYPE_CHECKING:
    import duckdb


class Store:
    """A store's folder. Cheap to make; safe to share between threads; opens nothing until it is asked.

    path: the folder. create: makes an empty store where there is none (else a UsageError).
    timeout_s: how long a turn at the catalogue may be waited for before StoreError.
    """

    def __init__(self, path: Path | str, create: bool = False, *, timeout_s: float = 60.0) -> None:
        self.path = Path(path).absolute()
        self.timeout_s = timeout_s
        self._guard = threading.RLock()
        self._copy: tuple[str, duckdb.DuckDBPyConnection] | None = None
        if "," in str(self.path):
            raise StoreError(
                "a store's path holds no comma",
                where=str(self.path),
                hint="DuckDB separates search paths by commas: move or rename the folder",
            )
        begun = self.is_at(self.path)
        if not begun or not_begun(self.path):
            if not create:
                raise UsageError(
                    "there is no store here",
                    where=str(self.path),
                    expected=CATALOGUE,
                    got="one without tables, and no data" if begun else "no such file",
                    hint="thermodata ingest CAMPAIGN.yaml makes one; --store names another folder",
                )
            self._create()

    @staticmethod
    def is_at(path: Path) -> bool:
        """Whether a folder is a store."""
        return (path / CATALOGUE).exists()

    def __repr__(self) -> str:
        return f"Store({str(self.path)!r})"

    # ---- reading ---------------------------------------------------------------------------------

    @contextmanager
    def reader(self) -> Iterator[duckdb.DuckDBPyConnection]:
        """A connection to a copy of the catalogue in memory, as of the last commit. No lock is held meanwhile."""
        with self.marked_reader() as (con, _):
            yield con

    @contextmanager
    def marked_reader(self) -> Iterator[tuple[duckdb.DuckDBPyConnection, str]]:
        """As `reader`, with the mark of that commit; '' where the store has none. StoreError where a query meets a
        Parquet file that is gone, cut or altered."""
        import duckdb

        mark, con = self._fresh()
        cursor = connection.cursor_of(con)
        try:
            yield cursor, mark
        except duckdb.Error as error:
            damage = connection.damaged_data(self.path, error)
            if damage is None:
                raise
            raise damage from error
        finally:
            cursor.close()

    def connect(self) -> duckdb.DuckDBPyConnection:
        """As `reader`, for callers that close it themselves."""
        return connection.cursor_of(self._fresh()[1])

    def private_copy(self) -> duckdb.DuckDBPyConnection:
        """A copy of the catalogue that nobody else sees, for work that attaches databases. The caller closes it."""
        return self._copied()[1]

    @property
    def generation(self) -> int:
        """Counts the commits."""
        with self.reader() as con:
            row = con.execute("select max(generation) from store").fetchone()
        return int(row[0]) if row else 0

    def _fresh(self) -> tuple[str, duckdb.DuckDBPyConnection]:
        with self._guard:
            if self._copy is not None and self._copy[0] == self.mark():
                return self._copy
            mark, con = self._copied()
            # without a mark it can't be told when to refresh: then every reader copies
            self._copy = (mark, con) if mark else None
            return mark, con

    def _copied(self) -> tuple[str, duckdb.DuckDBPyConnection]:
        """The mark of a commit, and a copy in memory of the catalogue as of then."""
        con = connection.memory(self.path)  # before the turn: it takes longer than the turn
        try:
            with self._catalogue_locked(exclusive=False):
                mark = self.mark()
                self._copy_into(con)
            _our_views(con, self.path)
        except BaseException:
            con.close()
            raise
        return mark, con

    def _copy_into(self, con: duckdb.DuckDBPyConnection) -> None:
        import duckdb

        path = self.path / CATALOGUE
        if not path.exists():
            raise StoreError(
                "the store has no catalogue any more",
                where=str(path),
                expected="a DuckDB database",
                got="no such file",
                hint="bring catalog.duckdb back from a copy, or name a new folder with --store and ingest again",
            )
        try:
            con.execute(f"attach {connection.literal(str(path))} as kept (read_only)")
            check_format(con, path, "kept.")
            con.execute("copy from database kept to memory; detach kept")
        except duckdb.Error as error:
            con.close()
            raise connection.damaged(path, error) from error

    def mark(self) -> str:
        """What changes with every commit; '' where it can't be told."""
        try:
            return (self.path / MARK).read_text()
        except OSError:
            return ""

    # ---- writing ---------------------------------------------------------------------------------

    @contextmanager
    def write(self, *, views: bool = True, mark: str | None = None) -> Iterator[duckdb.DuckDBPyConnection]:
        """One transaction on the catalogue, alone. On success the views are made anew and all becomes visible
        at once; on an exception nothing does. Bulk goes to Parquet before this is entered.

        views: False where neither files nor tests nor channels change. mark: that of this commit, for who wants to
        know it again. Not to be entered twice in one thread."""
        with self._guard:
            con = connection.memory(self.path)  # before the turn: it takes 20 ms
            try:
                with self._catalogue_locked(exclusive=True), self._attached_for_writing(con):
                    ours = of_this_version(con)  # outside of the transaction, which would end if it fails
                    con.execute("begin transaction")
                    try:
                        yield con
                        con.execute("update store set generation = generation + 1")
                        if views or not ours:
                            regenerate_views(con, self.path)
                        # before the commit: who sees the new mark waits for this turn to end, whoever dies in
                        # between causes one needless refresh; the other order could leave a stale copy in use
                        write_text(self.path / MARK, mark or new_mark())
                        _commit(con, self.path / CATALOGUE)
                    except BaseException:
                        _rollback(con)
                        raise
            finally:
                con.close()

    @contextmanager
    def _attached_for_writing(self, con: duckdb.DuckDBPyConnection) -> Iterator[None]:
        """The catalogue attached for writing, in this program's format."""
        connection.attach(con, self.path)
        try:
            check_format(con, self.path / CATALOGUE)
            migrate(con, self.path)
            yield
        finally:
            connection.detach(con)

    def _catalogue_locked(self, *, exclusive: bool) -> AbstractContextManager[None]:
        return catalogue_lock(self.path, exclusive=exclusive, timeout_s=self.timeout_s)

    @contextmanager
    def standstill(self) -> Iterator[duckdb.DuckDBPyConnection]:
        """A copy of the catalogue, with no commit from its making until the end: for deleting what nothing needs."""
        with self._guard:
            con = connection.memory(self.path)
            try:
                with self._catalogue_locked(exclusive=True):
                    self._copy_into(con)
                    yield con
            finally:
                con.close()

    def _create(self) -> None:
        try:
            self.path.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise StoreError(
                "the store's folder cannot be made",
                where=str(self.path),
                got=str(error),
                hint="name another folder with --store",
            ) from error
        with self._catalogue_locked(exclusive=True):
            if not self.is_at(self.path) or not_begun(self.path):  # else another process was first
                create_catalogue(self.path)


def _our_views(con: duckdb.DuckDBPyConnection, folder: Path) -> None:
    """Makes the views of a copy anew where another version wrote the store last: a query means the same on every store.
    They stay as they are where a damaged file does not let them be made."""
    if of_this_version(con):
        return
    import duckdb

    con.execute("begin transaction")
    try:
        regenerate_views(con, folder)
        con.execute("commit")
    except (StoreError, duckdb.Error):
        _rollback(con)


def _commit(con: duckdb.DuckDBPyConnection, path: Path) -> None:
    import duckdb

    try:
        con.execute("commit")
    except duckdb.Error as error:  # a full disk, or one that fails
        raise connection.damaged(path, error) from error


def _rollback(con: duckdb.DuckDBPyConnection) -> None:
    import duckdb

    with contextlib.suppress(duckdb.Error):  # the failure may have ended the transaction already
        con.execute("rollback")
