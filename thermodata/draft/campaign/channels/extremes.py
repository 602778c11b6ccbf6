"""The lowest and the highest of what a logger averaged: 'dX Min' and 'dX Max' beside 'dX Mean', the channel; and its
last reading, 'dX_Last' beside 'dX_Avg'."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence

from thermodata.draft.folder.into_sources.one_signal import OneSignal
from thermodata.reader.text import split_unit
from thermodata.schema.units.unit import normal_unit
from thermodata.schema.words.sentences import with_count

_LOW = frozenset(["min", "minimum", "minimal", "minimalwert", "minwert", "tmn"])
_HIGH = frozenset(["max", "maximum", "maximal", "maximalwert", "maxwert", "tmx"])
_SPREAD = frozenset(["std", "stdev", "stddev", "stdabw", "standardabweichung"])
_LAST = frozenset(["last", "lastvalue", "letzter", "letztwert"])
_MEAN = frozenset(["avg", "average", "mean", "mittel", "mittelwert", "mw", "moyenne", "media", "promedio", "srednia"])
_PARTED = re.compile(r"[\s/\\_.,:()\[\]-]+|(?<=[^\W_])(?=(?:Min|Max|Avg|Mean|Std|Last)(?![a-z]))")
_SHOWN = 4


def extremes_among(found: Sequence[OneSignal]) -> dict[str, str]:
    """By its name each signal that is the lowest, the highest or the spread of another one in its stream and unit, and
    that other one: of a mean that has both beside it. One that alone is called a maximum may be a limit. The last
    reading of what is called a mean is one, too."""
    of_stem: dict[tuple[str, str, tuple[str, ...]], dict[str, OneSignal]] = {}
    for one in found:
        kind, stem = _taken_apart(one.signal.name)
        unit = normal_unit(one.signal.unit or split_unit(one.signal.name)[1] or "")
        of_stem.setdefault((one.signal.stream, unit, stem), {}).setdefault(kind, one)
    beside: dict[str, str] = {}
    for kinds in of_stem.values():
        mean = kinds.get("mean") or kinds.get("")
        if mean is not None and {"low", "high"} <= kinds.keys() and _hold(kinds["low"], mean, kinds["high"]):
            beside |= {kinds[k].signal.name: mean.signal.name for k in ("low", "high", "spread") if k in kinds}
        if "last" in kinds and (mean := kinds.get("mean")) is not None:
            beside[kinds["last"].signal.name] = mean.signal.name
    return beside


def extremes_note(source: str, means: Mapping[str, str]) -> str:
    """What is told of those that are left out, by their names the means that they stand beside."""
    return (
        f"{source}: {with_count(means, _SHOWN)}: left out, for they are the lowest, the highest or the last of what a "
        f"logger averaged to {with_count(dict.fromkeys(means.values()), _SHOWN)}; one that is wanted is a channel "
        "by its signal"
    )


def _taken_apart(name: str) -> tuple[str, tuple[str, ...]]:
    """(low, high, spread, last, mean or '' where nothing says it; the other words of a name)."""
    words = [w for w in _PARTED.split(split_unit(name)[0]) if w]
    for kind, known in (("low", _LOW), ("high", _HIGH), ("spread", _SPREAD), ("last", _LAST), ("mean", _MEAN)):
        at = [k for k, w in enumerate(words) if w.casefold() in known]
        if len(at) == 1 and len(words) > 1:
            return kind, tuple(w for k, w in enumerate(words) if k != at[0])
    return "", tuple(words)


def _hold(low: OneSignal, mean: OneSignal, high: OneSignal) -> bool:
    """Whether the values of the mean lie between those of the others, by all files that were sampled."""
    lows, means, highs = ([v for _, v in one.seen() if v is not None] for one in (low, mean, high))
    if not (lows and means and highs):
        return True
    if all(v.constant for v in (*lows, *highs)):
        return False  # limits, which somebody set
    lowest, lowest_mean = (min(v.low for v in values) for values in (lows, means))
    highest_mean, highest = (max(v.high for v in values) for values in (means, highs))
    return lowest <= lowest_mean and highest_mean <= highest
