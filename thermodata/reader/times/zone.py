"""Local time to UTC: the zone's own rules, and the repeated hour resolved by the order of the rows."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Any
from zoneinfo import ZoneInfo, ZoneInfoNotFoundError

import numpy as np
import numpy.typing as npt

from thermodata.errors import FormatError, UsageError
from thermodata.plugin import Bool1D, Int1D
from thermodata.reader.times.newest_first import Steps

NAT = np.iinfo(np.int64).min
NO_ZONE = "no time zone declared"  # begins the note on local times whose zone nobody says
REPEATS = "the hour that repeats at"  # begins the note on local times that lie in both of its passes
_S = 1_000_000_000
# A clock that steps back by less is jitter; by more, inside a repeated hour, it is the hour that repeats.
_STEP_BACK = 60 * _S
# The place of the hour between two passes is sure where each other one costs more by this: a step grows twice as long.
_TELLS = 0.69


def zone(name: str) -> ZoneInfo:
    """The IANA zone; UsageError where there is none of this name."""
    try:
        return ZoneInfo(name)
    except (ZoneInfoNotFoundError, ValueError, OSError):
        raise UsageError(
            f"no time zone '{name}'",
            expected="an IANA name such as Europe/Prague",
            got=name,
            hint="a city of the zone, Continent/City; where the clock keeps one offset all year Etc/GMT-1, which is an "
            "hour ahead of UTC (its sign is turned); 'UTC' where it shows UTC",
        ) from None


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


def local_to_utc_ns(naive: npt.NDArray[Any], timezone: str | None, *, of: str = "rows") -> tuple[Int1D, list[str]]:
    """UTC nanoseconds of local times, in file order, with notes on what had to be decided.

    naive: shape (n,), datetime64; NaT stays the smallest int64 (`zone.NAT`). timezone None: taken as UTC, with
    a note. of: what the times are of, for the notes. The hour that repeats in autumn is told apart by the step back of
    the clock inside it; where no row steps back, by the usual step of the rows. Times that do not exist in spring keep
    the offset of before.

    FormatError where the times run straight on through a change of the zone: that clock keeps one offset all year.
    """
    local = naive.astype("datetime64[ns]").astype(np.int64)
    if timezone is None:
        return local, [f"{NO_ZONE}: times are taken as UTC"]
    if _newest_first(local):
        turned, said = local_to_utc_ns(naive[::-1], timezone, of=of)
        return turned[::-1], said
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
            notes.append(_in_skipped_hour(int(inside.sum()), timezone, when))
        else:
            second, sure = _second_pass(local, inside, before - after)
            utc[inside] = local[inside] - before
            utc[second] = local[second] - after
            notes.append(
                f"{REPEATS} {when}: {int((inside & ~second).sum())} {of} in its first pass, "
                f"{int(second.sum())} in its second"
                + ("" if sure else f" (no {of.removesuffix('s')} steps back: a guess)")
            )
    return utc, notes


def skips_between(timezone: str, first_ns: int, last_ns: int) -> bool:
    """Whether a zone skips an hour between two instants in UTC, or within a day of them."""
    found = _transitions(zone(timezone), first_ns // _S - 86_400, last_ns // _S + 86_400)
    return any(after > before for _, before, after in found)


def skipped_notes(local_ns: Int1D, timezone: str) -> list[str]:
    """What is told of local times, shape (n,), that lie in an hour that a zone skips in spring."""
    good = local_ns[local_ns != NAT]
    if not good.size:
        return []
    first, last = (int(end) // _S for end in (good.min(), good.max()))
    found = []
    for instant, before, after in _transitions(zone(timezone), first - 2 * 86_400, last + 2 * 86_400):
        many = int(((good >= instant + before) & (good < instant + after)).sum())
        if many:
            when = datetime.fromtimestamp(instant // _S, UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
            found.append(_in_skipped_hour(many, timezone, when))
    return found


def _in_skipped_hour(many: int, timezone: str, when: str) -> str:
    return (
        f"{many} local times in the hour that {timezone} skips at {when}: the logger's "
        "clock does not follow daylight saving, or not at once"
    )


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
    """Which rows of a repeated hour are its second pass, and whether the order of the rows proves it.

    Where no row steps back, the hour between the passes is put where it fits the usual step best: rows of every 90 min
    that stand at 01:50 and 02:20 have it between them. It costs a step as much as it grows out of all proportion."""
    second, sure = np.zeros(local.shape, bool), True
    edges = np.flatnonzero(np.diff(np.concatenate(([0], inside.astype(np.int8), [0]))))
    usual = _usual_step(local)
    for start, stop in zip(edges[::2], edges[1::2], strict=True):
        back = np.flatnonzero(np.diff(local[start:stop]) < -_STEP_BACK)
        if back.size:
            second[start + 1 + int(back[0]) : stop] = True
            continue
        before, after = (bool(0 <= i < local.size and local[i] != NAT) for i in (start - 1, stop))
        # the hour may stand before each row and behind the last; it stands nowhere where the file begins or ends inside
        costs = np.zeros(stop - start + 1)
        steps = np.diff(local[start - before : stop + after])
        if usual and steps.size:
            first = 0 if before else 1
            costs[first : first + steps.size] = _cost(steps, shift, usual)
        at = int(np.argmin(costs))
        if (np.delete(costs, at) - costs[at] > _TELLS).all() and (before or after or steps.size):
            second[start + at : stop] = True
        else:
            sure = False
    return second, sure


def _newest_first(local: Int1D) -> bool:
    steps = Steps()
    steps.add(local[local != NAT])
    return steps.newest_first


def _usual_step(local: Int1D) -> float:
    steps = np.diff(local[local != NAT])
    steps = steps[steps > 0]
    return float(np.median(steps)) if steps.size else 0.0


def _cost(steps: Int1D, shift: int, usual: float) -> npt.NDArray[np.float64]:
    """How much further from the usual step each of these becomes with an hour more, in powers of e."""
    now, then = np.maximum(steps, usual / 10) / usual, (steps + shift) / usual
    cost: npt.NDArray[np.float64] = np.abs(np.log(then)) - np.abs(np.log(now))
    return cost
