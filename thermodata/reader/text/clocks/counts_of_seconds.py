"""Times in seconds that may count from a date that nothing states: by a scale that the name hints at (GPS, TAI, NTP),
or by a size that no recording reaches from its start."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from thermodata.errors import QuestionError
from thermodata.plugin import Array
from thermodata.reader.times.open_questions import UNKNOWN
from thermodata.reader.times.since import leaves_leaps_open
from thermodata.reader.times.time_units import (
    EPOCHS,
    REACH_S,
    SECONDS,
    date_of_count,
    found_epoch,
    is_logged,
    known_unit,
)

_SCALES = {
    "gps": "GPS time, ahead of UTC by its leap seconds",
    "tai": "atomic time, ahead of UTC by 37 s",
    "ntp": "s since 1900",
}
_HINT = re.compile(r"(?i)(?:^|[^a-z])(?P<scale>gps|tai|ptp|ntp)(?:$|[^a-z])|^(?P<begins>gps|tai|ptp|ntp)(?=[A-Z])")
_ZEROS = ("1900-01-01", "1904-01-01", "1970-01-01", "1980-01-06", "2000-01-01", "2001-01-01")
_FROM_START_S = 2.8e8  # nine years: a control that ran for so long had its updates meanwhile
_FIRST, _LAST = np.datetime64("2010-01-01"), np.datetime64("2040-01-01")  # when what is so large is likely logged


def names_scale(name: str) -> bool:
    """Whether a name hints at a scale."""
    return _HINT.search(name) is not None


def scale_question(
    name: str,
    values: Array,
    where: str,
    column: int | None = None,
    unit: str | None = None,
    hint: str | None = None,
) -> QuestionError | None:
    """Asks whether times are of the scale that their name hints at; None where it hints at none, or they are of no year
    in it, or where their unit says what they count from. column: its number, from 1, where its name does not tell it
    for a time. hint: what else of the file names a scale, in place of the name."""
    open_in = next((text for text in (unit, name) if text is not None and leaves_leaps_open(text)), None)
    match = _HINT.search(name if hint is None else hint) or _HINT.search(open_in or "")
    values = values[np.isfinite(values)]
    if match is None or not values.size or (open_in is None and unit is not None and known_unit(unit) in EPOCHS):
        return None
    word = (match["scale"] or match["begins"]).lower()
    scale = "tai" if word == "ptp" else word
    own = next((u for u in EPOCHS if u.split("_")[0] == scale and is_logged(values, u)), None)
    if own is None:
        return None
    other = found_epoch(values)
    instead = "" if other is None else f"; as {other} it is {date_of_count(values[0], other)}"
    count = Count(own, _SCALES[scale], f"{date_of_count(values[0], own)} UTC")
    return may_be(OpenTimes(name, values[0], where, column), count, declare_else=instead, asked_else=instead)


@dataclass(frozen=True, slots=True)
class OpenTimes:
    """The column of a table whose times are asked about. first: of them; column: its number, from 1, where it has to be
    declared."""

    name: str
    first: float
    where: str
    column: int | None


@dataclass(frozen=True, slots=True)
class Count:
    """A unit that times may be counted in: as it is declared and in words. begins: when the first of them is then."""

    unit: str
    meaning: str
    begins: str


def may_be(times: OpenTimes, count: Count, *, declare_else: str, asked_else: str = "") -> QuestionError:
    """Asks whether times are such a count, which a draft takes meanwhile. declare_else, asked_else: what else they may
    be, behind what is to be declared and behind what is asked."""
    said = {"time": {**({} if times.column is None else {"column": times.column}), "unit": count.unit}}
    shown = ", ".join(f"{key}: {value}" for key, value in said["time"].items())
    first = f"{times.first:.14g}"
    return QuestionError(
        f"times that may be {count.meaning}",
        where=times.where,
        got=f"{times.name}: {first} ...",
        expected="a unit",
        hint=f"declare table: {{time: {{{shown}}}}}{declare_else}",
        times=[times.name],
        ask=f"unit of the time: is '{times.name}' in {count.unit} ({count.meaning})? "
        f"{first} is {count.begins} then{asked_else}",
        declare=said,
        meanwhile=said,
    )


def far_question(name: str, values: Array, unit: str, where: str) -> QuestionError | None:
    """Asks what times in a unit count from that are too large for any start; None for others."""
    values, seconds = values[np.isfinite(values)], SECONDS.get(unit)
    if seconds is None or not values.size or not _FROM_START_S < float(values.min()) * seconds < REACH_S:
        return None
    known = found_epoch(values) or ""
    if known.startswith("unix") and EPOCHS[known].seconds == seconds:
        return None  # which leaves nothing open
    of = next(u for u in ("s", "min", "h", "d", "ms", "us", "ns") if SECONDS[u] == seconds)
    begins = {z: np.datetime64(z, "s") + np.timedelta64(round(float(values[0]) * seconds), "s") for z in _ZEROS}
    fits = {f"{of} since {z} UTC": at for z, at in begins.items() if _FIRST <= at < _LAST}
    if not fits:
        return None
    shown = " or ".join(f"'{u}' ({str(at).replace('T', ' ')})" for u, at in fits.items())
    return QuestionError(
        f"times in {unit} that count from more than {_FROM_START_S / SECONDS['d'] / 365.25:.0f} years before",
        where=where,
        got=f"{name}: {values[0]:.14g} ...",
        expected="the date that they count from",
        hint=f"declare table: {{time: {{unit: {next(iter(fits))}}}}}, or unit: {unit} where they count from a start",
        times=[name],
        ask=f"unit of the time: {shown}; or {unit}, from any start? '{name}' begins with {values[0]:.14g}",
        declare={"time": {"unit": UNKNOWN}},
        meanwhile={"time": {"unit": unit}},
    )


def ask_what_counts(name: str, values: Array, unit: str | None, where: str) -> None:
    """Raises the question of what times count from, where one is open. unit: what the file says, None where nothing."""
    known = None if unit is None else known_unit(unit)
    if (asked := scale_question(name, values, where, unit=unit)) is not None:
        raise asked
    if known is not None and (asked := far_question(name, values, known, where)) is not None:
        raise asked
