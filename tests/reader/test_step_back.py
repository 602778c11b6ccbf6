"""A clock that goes back: in words, and what set it back where that shows."""

from __future__ import annotations

import numpy as np
import pytest

from thermodata.reader.times.step_back import cause_of, in_words, likely_cause, said


def ns(text: str) -> int:
    return int(np.datetime64(text, "ns").astype(np.int64))


@pytest.mark.parametrize(
    ("span_ns", "words"),
    [
        (43_140 * 10**9, "11 h 59 min"),
        (-3540 * 10**9, "59 min"),
        (3600 * 10**9, "1 h"),
        (90_061 * 10**9, "25 h 1 min 1 s"),
        (43 * 10**9, "43 s"),
        (1_500_000_000, "1.5 s"),
        (59_999_999_999, "60 s"),
    ],
)
def test_a_span_is_told_in_hours_minutes_and_seconds(span_ns: int, words: str) -> None:
    assert in_words(span_ns) == words


def test_from_when_to_when_is_told_on_the_clock_of_the_file() -> None:
    a, b = ns("2026-10-25T02:59"), ns("2026-10-25T02:00")
    assert said(a, b, absolute=True, local=True) == "59 min (from 2026-10-25 02:59:00 to 2026-10-25 02:00:00)"
    assert said(a, b, absolute=True, local=False).endswith("to 2026-10-25 02:00:00 UTC)")
    assert said(7200 * 10**9, 0, absolute=False, local=False) == "2 h (from 2 h after its start to 0 s after its start)"
    assert (
        said(0, -7200 * 10**9, absolute=False, local=False) == "2 h (from 0 s after its start to 2 h before its start)"
    )
    ten = 36_000 * 10**9
    assert said(7200 * 10**9, 0, False, False, ten) == "2 h (from 12:00:00 to 10:00:00)"


@pytest.mark.parametrize(
    ("before", "at", "local", "cause"),
    [
        ("2026-03-22T12:59", "2026-03-22T01:00", True, "12 hours"),
        ("2026-03-22T11:59", "2026-03-22T00:00", False, "12 hours"),  # of a zone that is declared: in UTC
        ("2026-03-22T12:30", "2026-03-22T00:31", True, None),  # set, in the middle of an hour
        ("2026-03-22T12:59", "2026-03-22T03:00", True, None),
        ("2026-10-25T02:59", "2026-10-25T02:00", True, "summer time"),
        ("2026-10-25T02:59", "2026-10-25T02:00", False, None),  # in UTC, or its zone tells it
        ("2026-10-26T02:59", "2026-10-26T02:00", True, None),  # a Monday
        ("2026-07-26T02:59", "2026-07-26T02:00", True, None),  # a Sunday in July
        ("2026-10-25T14:59", "2026-10-25T14:00", True, None),
        ("2026-10-25T02:59", "2026-10-25T02:30", True, None),
    ],
)
def test_what_set_a_clock_back_is_named_where_it_shows(before: str, at: str, local: bool, cause: str | None) -> None:
    found = likely_cause(ns(before), ns(at), local)
    assert (found is None) if cause is None else (cause in str(found))


@pytest.mark.parametrize(
    ("at", "told"),
    [("2026-10-25T00:00", True), ("2026-10-25T00:40", True), ("2026-10-24T23:50", False), ("2026-10-25T09:00", False)],
)
def test_a_step_back_in_the_hour_that_the_zone_repeats_is_not_advised_to_be_joined(at: str, told: bool) -> None:
    """Joined, what follows would stand as much too late as it stepped back."""
    notes = ("no comment", "the hour that repeats at 2026-10-25T01:00:00Z: 4 starts in its first pass, 0 in its second")
    cause = cause_of(ns(at) + 1_800 * 10**9, ns(at), True, False, None, notes)
    assert (cause is not None and "split the file there" in cause) is told
    assert cause_of(ns(at) + 1_800 * 10**9, ns(at), True, False, None) is None
