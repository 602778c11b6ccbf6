"""Times in seconds that may count from a date that nothing states: by a scale that the name hints at (GPS, TAI, NTP),
or by a size that no recording reaches from its start."""

from __future__ import annotations

import re

import numpy as np

from thermodata.errors import QuestionError
from thermodata.plugin import Array
from thermodata.reader.times.open_questions import UNKNOWN
from thermodata.reader.times.since import leaves_leaps_open
from thermodata.reader.times.time_units import EPOCHS, REACH_S, SECONDS, found_epoch, is_logged, known_unit, when

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
    instead = "" if other is None else f"; as {other} it is {when(values[0], other)}"
    at = f"{when(values[0], own)} UTC"
    unit_of = own, _SCALES[scale]
    return may_be(name, values[0], where, column, unit_of, at, declare_else=instead, asked_else=instead)


def may_be(
    name: str,
    first: float,
    where: str,
    column: int | None,
    unit: tuple[str, str],
    at: str,
    *,
    declare_else: str,
    asked_else: str = "",
) -> QuestionError:
    """Asks whether times are counted in a unit, which a draft takes meanwhile. first: of them; column: its number, from
    1, where it has to be declared; unit: by its name and in words; at: when the first one is then."""
    own, what = unit
    said = {"time": {**({} if column is None else {"column": column}), "unit": own}}
    shown = ", ".join(f"{key}: {value}" for key, value in said["time"].items())
    return QuestionError(
        f"times that may be {what}",
        where=where,
        got=f"{name}: {first:.14g} ...",
        expected="a unit",
        hint=f"declare table: {{time: {{{shown}}}}}{declare_else}",
        times=[name],
        ask=f"unit of the time: is '{name}' in {own} ({what})? {first:.14g} is {at} then{asked_else}",
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
