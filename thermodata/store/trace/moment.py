"""Where in a test a moment is: seconds from its start, or a date and time."""

from __future__ import annotations

import re
from datetime import UTC, datetime
from typing import TYPE_CHECKING

from thermodata.errors import UsageError
from thermodata.schema.units.value import value_in

if TYPE_CHECKING:
    from thermodata.store import Store

_DATED = re.compile(r"\d{4}-\d{2}-\d{2}[T ]")
FORMS = "'2.5 h' from the start of the test, or 2026-03-30T08:30Z"


def seconds_at(store: Store, campaign: str, test: str, text: str) -> tuple[float, str | None]:
    """([s] from the start of the test, what was taken for granted): '2.5 h', or a date and time, in UTC where it names
    no zone, as the store has all times. UsageError for what is neither, and for a test without dates."""
    if not _DATED.match(text):
        return value_in(text, "s"), None
    try:
        at = datetime.fromisoformat(text)
    except ValueError:
        raise UsageError(
            "a time",
            where="--at",
            expected=FORMS,
            got=text,
            hint="the time from the test's start, in s, min or h, works for every log",
        ) from None
    with store.reader() as con:
        row = con.execute(
            "select start_ns, clock from test where campaign = ? and test = ?", [campaign, test]
        ).fetchone()
    if row is None:
        return 0.0, None  # an unknown test: `trace` names the nearest
    start_ns, clock = row
    if start_ns is None or clock != "absolute":
        raise UsageError(
            f"the logs of test '{test}' have no date",
            where="--at",
            expected="'2.5 h' from its start",
            got=text,
        )
    said = None
    if at.tzinfo is None:
        at = at.replace(tzinfo=UTC)
        said = f"--at {text}: taken as UTC, as the store has times; local ones with their zone: {text}+02:00"
    start = datetime.fromtimestamp(start_ns // 10**9, UTC)
    return (at - start).total_seconds() - (start_ns % 10**9) / 1e9, said
