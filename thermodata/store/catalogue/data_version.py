"""Which data a fit is of: a digest that changes with every ingest that changes a campaign, and what to do meanwhile."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import wraps
from typing import TYPE_CHECKING, ParamSpec, TypeVar

from thermodata.errors import StoreError

if TYPE_CHECKING:
    import duckdb

P = ParamSpec("P")
R = TypeVar("R")

TIMES = 4  # that something is done before it is given up: an ingest commits once


class DataChangedError(StoreError):
    """Data that something was made from changed before it was kept."""


def versions(con: duckdb.DuckDBPyConnection) -> dict[str, str]:
    """Campaign -> the version of its data."""
    return dict(con.execute("select campaign, data_version from campaign").fetchall())


def joined(found: Mapping[str, str], campaigns: Iterable[str]) -> str:
    """One version for some campaigns; '' where one of them is gone."""
    listed = sorted((c, found.get(c, "")) for c in dict.fromkeys(campaigns))
    if not all(version for _, version in listed):
        return ""
    return listed[0][1] if len(listed) == 1 else hashlib.sha256(repr(listed).encode()).hexdigest()[:32]


def refuse_changed(con: duckdb.DuckDBPyConnection, campaigns: Sequence[str], made_from: str) -> None:
    """DataChangedError where the data of some campaigns are no longer those that something was made from."""
    if joined(versions(con), campaigns) != made_from:
        raise DataChangedError(
            f"the data of {', '.join(campaigns)} changed meanwhile",
            expected="the data that were read, until what is made from them is kept",
            got="an ingest, or a test that was forgotten",
            hint="do it again when that is done",
        )


def again_where_data_changed(work: Callable[P, R]) -> Callable[P, R]:
    """Work that reads data and keeps what it makes of them, done from the start where they changed meanwhile: what is
    kept is of the data as they are when it is."""

    @wraps(work)
    def done(*args: P.args, **more: P.kwargs) -> R:
        for _ in range(TIMES - 1):
            try:
                return work(*args, **more)
            except DataChangedError:
                continue
        return work(*args, **more)

    return done
