"""Local time to UTC: the zone's own rules, and the repeated hour resolved by the order of the rows."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Any
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

import numpy as np
import numpy.typing as npt

from thermodata.errors import FormatError, UsageError
from thermodata.plugin import Bool1D, Int1D

NAT = np.iinfo(np.int64).min
NO_ZONE = "no time zone declared"  # begins the note on local times whose zone nobody says
_S = 1_000_000_000
# A clock that steps back by less is jitter; by more, inside a repeated hour, it is the hour that repeats.
_STEP_BACK = 60 * _S


def zone(name: str) -> ZoneInfo:
    """The IANA zone; UsageError where there is none of this name."""
    try:
        return ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError):
        raise UsageError(f"no time zone '{name}'", expected="an IANA name such as Europe/Prague", got=name) from None


def _offset_ns(tz: ZoneInfo, utc_s: int) -> int:
    shift = datetime.fromtimestamp(utc_s, UTC).astimezone(tz).utcoffset() or timedelta(0)
    return round(shift.total_seconds()) * _S


def utc_offset_ns(timezone: str, utc_s: int) -> int:
    """How far a zone's local time is ahead of UTC at an instant [ns]."""
    return _offset_ns(zone(timezone), utc_s)


def _transitions(tz: ZoneInfo, first_s: int, last_s: int) -> list[tuple[int, int, int]]:
    """[(UTC instant in ns, offset before, offset after)] between two instants, to the second."""
    found, day = [], 86_400
    at, before = first_s, _offset_ns(tz, first_s)
    while at < last_s:
        after = _offset_ns(tz, at + day)
        if after != before:
            low, high = at, at + day
            while high - low > 1:
                middle = (low + high) // 2
                low, high = (middle, high) if _offset_ns(tz, middle) == before else (low, middle)
            found.append((high * _S, before, after))
        at, before = at + day, after
    return found


def local_to_utc_ns(naive: npt.NDArray[Any], timezone: str | None) -> tuple[Int1D, list[str]]:
    """UTC nanoseconds of local times, in file order, with notes on what had to be decided.

    naive: shape (n,), datetime64; NaT stays the smallest int64 (`zone.NAT`). timezone None: taken as UTC, with
    a note. The hour that repeats in autumn is told apart by the step back of the clock inside it; where no row
    steps back, by the neighbour that it joins. Times that do not exist in spring keep the offset of before.

    FormatError where the times run straight on through a change of the zone: that clock keeps one offset all year.
    """
    local = naive.astype("datetime64[ns]").astype(np.int64)
    if timezone is None:
        return local, [f"{NO_ZONE}: times are taken as UTC"]
    tz = zone(timezone)
    valid = local != NAT
    if not valid.any():
        return local, []
    first, last = int(local[valid].min()) // _S, int(local[valid].max()) // _S
    changes = _transitions(tz, first - 2 * 86_400, last + 2 * 86_400)
    start = changes[0][1] if changes else _offset_ns(tz, first)
    utc = np.where(valid, local - start, NAT)
    notes: list[str] = []
    for instant, before, after in changes:
        later = valid & (local >= instant + max(before, after))
        utc[later] = local[later] - after
        low, high = instant + min(before, after), instant + max(before, after)
        inside = valid & (local >= low) & (local < high)
        if not inside.any():
            continue
        when = datetime.fromtimestamp(instant // _S, UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
        if _runs_on(local, inside, before, after):
            raise _keeps_one_offset(timezone, when, before, after)
        if after > before:
            utc[inside] = local[inside] - before
            notes.append(
                f"{int(inside.sum())} local times in the hour that {timezone} skips at {when}: the logger's "
                "clock does not follow daylight saving, or not at once"
            )
        else:
            second, sure = _second_pass(local, inside, before - after)
            utc[inside] = local[inside] - before
            utc[second] = local[second] - after
            notes.append(
                f"the hour that repeats at {when}: {int((inside & ~second).sum())} rows in its first pass, "
                f"{int(second.sum())} in its second" + ("" if sure else " (no row steps back: a guess)")
            )
    return utc, notes


def _runs_on(local: Int1D, inside: Bool1D, before: int, after: int) -> bool:
    """Whether rows go straight on behind the hour that a zone skips; or through the one that it repeats, from before it
    to an hour behind it, for a clock may be set late."""
    rows, shift, skipped = np.flatnonzero(inside), abs(after - before), after > before
    first, last = int(rows[0]), int(rows[-1])
    behind = np.flatnonzero(local[last + 1 :] >= local[last] + (0 if skipped else shift))
    if not behind.size or (first == 0 and not skipped):
        return False
    part = local[last if skipped else first - 1 : last + 2 + int(behind[0])]
    steps = np.diff(part)
    return bool((part != NAT).all() and (steps >= -_STEP_BACK).all() and (steps < shift).all())


def _keeps_one_offset(timezone: str, when: str, before: int, after: int) -> FormatError:
    hours = [ns / 3.6e12 for ns in (min(before, after), max(before, after))]
    # the names of the Etc zones have their signs turned round
    winter, summer = (f"Etc/GMT{-h:+.0f}" if h else "Etc/GMT" for h in hours)
    return FormatError(
        f"local times that run straight on where {timezone} changes its clocks, at {when}",
        expected="an hour that is skipped in spring, or repeated in autumn",
        got="neither: the logger's clock keeps one offset",
        hint=f"declare timezone: {winter} where it keeps winter time, {summer} for summer time, or UTC",
    )


def _second_pass(local: Int1D, inside: Bool1D, shift: int) -> tuple[Bool1D, bool]:
    """Which rows of a repeated hour are its second pass, and whether the order of the rows proves it."""
    second, sure = np.zeros(local.shape, bool), True
    edges = np.flatnonzero(np.diff(np.concatenate(([0], inside.astype(np.int8), [0]))))
    for start, stop in zip(edges[::2], edges[1::2], strict=True):
        steps = np.diff(local[start:stop])
        if steps.size and steps.min() < -_STEP_BACK:
            second[start + 1 + int(np.argmax(steps < -_STEP_BACK)) : stop] = True
            continue
        joins_before = start > 0 and local[start - 1] != NAT and 0 <= local[start] - local[start - 1] < shift
        joins_after = stop < local.size and local[stop] != NAT and 0 <= local[stop] - local[stop - 1] < shift
        if joins_after and not joins_before:
            second[start:stop] = True
        elif joins_before == joins_after:
            sure = False
    return second, sure
