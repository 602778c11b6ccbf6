"""A model file that calls a channel as its campaign did once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

from thermodata.errors import SpecError

if TYPE_CHECKING:
    from thermodata.store import Store


@contextmanager
def advised_by_names_now(store: Store, campaigns: Sequence[str]) -> Iterator[None]:
    """Where a channel is missing inside of it that fitted models knew: its error names the channel of the same
    signal."""
    from thermodata.store.catalogue.models.renamed import renamed

    try:
        yield
    except SpecError as error:
        with store.reader() as con:
            now = renamed(con, campaigns).get(error.got or "")
        if now is None or error.what != f"no channel '{error.got}'":
            raise
        raise type(error)(
            error.what,
            where=error.where,
            expected=error.expected,
            got=error.got,
            hint=f"'{now}': the same signal is called that now",
        ) from error
