"""When a test measures, told from its recordings: probes that leave their range exactly while an axis is elsewhere or
feeds, or a state says so, as with a spindle that meets its probes once a cycle."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from thermodata.draft.courses.beside import SignalBeside, signals_beside
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.probes.out_of_range import LEAST, out_of_range
from thermodata.draft.times.clocks import Named
from thermodata.draft.times.one_clock import OneClock
from thermodata.draft.words.listed import holds_word
from thermodata.draft.words.naming import words
from thermodata.draft.words.switches import MEASURES
from thermodata.plugin import Bool1D, Float1D

_AGREES = 0.99  # of the samples
_SURE = 0.5  # of the samples, at least
_TOLD, _HOLDS = 0.2, 0.9  # of those in range: of which the rule says something, and of these where it holds
_MOST_FEEDS, _MOST_LEVELS = 6, 8
_MOST_AXES, _MOST_POINTS = 3, 6  # of a rule, of those that are tried
_EXACTLY = "exactly then the probes are in range"


@dataclass(frozen=True, slots=True)
class Measuring:
    """`measuring:` of a test. why: as its comment says it."""

    when: str
    why: str


def rule_of(files: Sequence[RawFile], named: Mapping[int, Named], clocks: Mapping[int, OneClock]) -> Measuring | None:
    """When a test measures; None where the probes stay in range, or nothing moves with them.

    named: id of a file -> (stream, signal) -> (quantity, place, channel); clocks: id of a file -> its clock.
    """
    for file in files:
        names = named.get(id(file), {})
        for key, course in file.sample.courses.items():
            quantity, place, _ = names.get(key, ("", None, ""))
            out = out_of_range(course.values) if (quantity, place) == ("displacement", "tcp") else None
            if out is None:
                continue
            for signals in signals_beside(files, named, file, course.t_ns, clocks):
                for way in (_by_state, _by_position, _by_feed, _by_feeds):
                    if (found := way(signals, out)) is not None:
                        return Measuring(found, _EXACTLY)
                if (found := _by_named_state(signals, out)) is not None:
                    return Measuring(found, "by its name, and no probe is out of range then")
    return None


def _by_state(signals: Sequence[SignalBeside], out: Bool1D) -> str | None:
    for one in signals:
        if one.quantity != "state":
            continue
        for level in np.unique(one.before[np.isfinite(one.before)])[:_MOST_LEVELS]:
            if _agree(one, lambda x, level=level: x == level, ~out):  # type: ignore[misc]
                return f"{one.channel} == {level:g}"
    return None


def _by_named_state(signals: Sequence[SignalBeside], out: Bool1D) -> str | None:
    """A state that by its name says when is measured: on its way to the rest a probe may be in range as well."""
    for one in signals:
        if one.quantity != "state" or not holds_word(MEASURES, words(one.channel)):
            continue
        for level in np.unique(one.before[np.isfinite(one.before)])[:_MOST_LEVELS][::-1]:
            holds, sure = one.told(lambda x, level=level: x == level)  # type: ignore[misc]
            measures, gone = holds & sure, out & sure
            if measures.mean() > LEAST and not measures[out].any() and gone.sum() > _SURE * out.sum():
                return f"{one.channel} == {level:g}"
    return None


def _by_position(signals: Sequence[SignalBeside], out: Bool1D) -> str | None:
    """An axis at a point, or several at once where each passes there by itself."""
    points = [p for b in signals if b.quantity == "position" and (p := _point(b, out)) is not None]
    for many in range(1, 1 + min(len(points), _MOST_AXES)):
        for some in combinations(points[:_MOST_POINTS], many):
            before, after = _farthest([p.before for p in some]), _farthest([p.after for p in some])
            known = np.isfinite(before + after)
            if not (known & ~out).any() or not (known & out).any():
                continue
            near = float(np.quantile(np.minimum(before, after)[known & ~out], 0.995))
            far = float(np.quantile(np.maximum(before, after)[known & out], 0.01))
            if far <= 2 * near or far <= 0:
                continue
            limit = float(f"{np.sqrt(max(near, 1e-3 * far) * far):.2g}")
            # a row of another log on either side: between them it may pass anywhere
            if _agrees(before < limit, (before < limit) == (after < limit), ~out):
                return " and ".join(f"abs({p.channel} - {p.middle:.6g}) < {limit:g}" for p in some)
    return None


@dataclass(frozen=True, slots=True)
class _Point:
    """Where an axis stands while the probes are in range. before, after: how far it is from there, shape (n,)."""

    channel: str
    middle: float
    before: Float1D
    after: Float1D


def _point(one: SignalBeside, out: Bool1D) -> _Point | None:
    moves = np.abs(one.after - one.before)
    known = ~out & np.isfinite(moves)
    if not known.any():
        return None
    # the rows of another log about the first reading in range are of the way there
    middle = float(np.median(one.before[known & (moves <= np.median(moves[known]))]))
    return _Point(one.channel, middle, np.abs(one.before - middle), np.abs(one.after - middle))


def _farthest(distances: Sequence[Float1D]) -> Float1D:
    return np.asarray(np.max(distances, axis=0))


def _by_feed(signals: Sequence[SignalBeside], out: Bool1D) -> str | None:
    """A feed that is 0 exactly while the probe has a reading, whatever its unit."""
    return next((f"{b.channel} == 0" for b in signals if b.quantity == "feed" and _agree(b, _stands, ~out)), None)


def _by_feeds(signals: Sequence[SignalBeside], out: Bool1D) -> str | None:
    """All feeds, and speeds of tables and axes, that move while the probe has no reading, and then only."""
    moving = []
    stand, sure = np.ones(out.size, dtype=bool), np.ones(out.size, dtype=bool)
    for one in signals:
        if one.quantity == "feed" or (one.quantity == "rotational_speed" and _is_axis(one.place)):
            stands, certain = one.told(_stands)
            here = stands[~out & certain]
            if here.size and here.mean() >= _AGREES and not stands[out & certain].all():
                moving.append(one.channel)
                stand, sure = stand & stands, sure & certain
    if not 0 < len(moving) <= _MOST_FEEDS or sure.mean() < _SURE or (stand == ~out)[sure].mean() < _AGREES:
        return None
    return " and ".join(f"{channel} == 0" for channel in moving)


def _is_axis(place: str | None) -> bool:
    return (place or "").split(".")[0] in ("axis", "rotary", "table")


def _stands(x: Float1D) -> Bool1D:
    return np.asarray(x == 0)


def _agree(one: SignalBeside, rule: Callable[[Float1D], Bool1D], measured: Bool1D) -> bool:
    return _agrees(*one.told(rule), measured)


def _agrees(holds: Bool1D, sure: Bool1D, measured: Bool1D) -> bool:
    """Whether a rule says what the range does, of what is measured too: that may be little of the whole."""
    right = (holds == measured) & sure
    there = sure & measured
    return bool(
        sure.mean() >= _SURE
        and right.sum() >= _AGREES * sure.sum()
        and there.sum() >= _TOLD * measured.sum()
        and right[measured].sum() >= _HOLDS * there.sum()
    )
