"""What the columns say by which rows of all views are told apart: the same words everywhere."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from thermodata.store.base.connection import literal

IDENTIFIERS = {
    "campaign": "id of the campaign",
    "test": "id of the test, unique within its campaign",
    "source": "one logger with one clock: key of `sources` in the campaign file",
    "stream": "signals of a source on common times",
    "channel": "key of `channels` in the campaign file, unique within its campaign",
    "model": "id of the model, a version of it",
    "response": "the channel that the model explains",
    "machine": "id of the machine",
    "parent": "id of the model that this one was made of",
    "root": "id of the first version",
}


def identified(view: str, columns: Iterable[str]) -> Iterator[str]:
    """The statements that comment those columns of a view. view: as it stands in SQL."""
    for column in columns:
        yield f"comment on column {view}.{column} is {literal(IDENTIFIERS[column])}"
