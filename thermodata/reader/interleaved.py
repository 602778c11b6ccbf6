"""Whether a column of few words parts the rows of a table into series: several sensors or hosts that stand below each
other in one column. Read as it stands, such a column is a saw of all of them.

What tells it from a state of the machine is time: series go on side by side, each with a clock of its own, while a
state leaves holes in the one clock of its table.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Array, Float1D, Int1D
from thermodata.reader.header_words import LABEL_WORDS, NAME_WORDS, SENSOR_WORDS

_FEWEST = 5  # rows of a word, by which its steps are known
_MOST_WORDS, _MOST_NUMBERS = 200, 32  # that name series
_BLANK = 0.1  # of the rows may name nothing
_MIXED = 0.4  # of the changes that words make which never stand twice in a row; chance makes half of them
_MEET = 0.05  # of the rows share their time with another word's,
_EXPLAINED = 0.95  # of which this share are other words
_STEADY, _ODD = 0.9, 0.03  # shares of steps like their median: a clock; of others that want a reason
_RESOLVED = 0.25  # of the odd steps may be left within the words
_APART = 3.0  # times as far from the row before as from the row before of the same word
_NUMBER, _TIME = re.compile(r"\d+"), re.compile(r"\d+[-.:/]\d+[-.:/ T\dZ+]*")
_STATES = frozenset(
    (
        *("on", "off", "true", "false", "yes", "no", "open", "closed", "run", "running", "stop", "stopped", "start"),
        *("idle", "ok", "nok", "error", "alarm", "ready", "busy", "auto", "manual", "active", "inactive", "normal"),
        *("rapid", "feed", "warning", "good", "bad", "high", "low", "in", "out", "up", "down", "cw", "ccw", "+", "-"),
        *("heating", "cooling", "measuring", "moving", "warmup", "pause", "event", "cyclic"),
        *("ein", "aus", "an", "auf", "zu", "wahr", "falsch", "ja", "nein", "offen", "geschlossen", "gestoppt"),
        *("fehler", "bereit", "heizen", "kühlen", "messen", "zapnuto", "vypnuto", "ano", "ne", "marche", "arrêt"),
    )
)


@dataclass(frozen=True, slots=True)
class _Words:
    """codes: shape (n,), which word each row has, -1 for none. numbers: they are ids, or counts of something; named,
    sensor: its header says that it names something, or what is measured."""

    codes: Int1D
    words: tuple[str, ...]
    numbers: bool
    named: bool
    sensor: bool


def series_columns(t_ns: Int1D, columns: Mapping[str, Array], *, absolute: bool) -> tuple[str, ...]:
    """The columns whose words, together, name the series that the rows are of; none where all are of one.

    t_ns: shape (n,), in the order of the file; columns: name -> shape (n,), numbers or text. absolute: times that begin
    anew are no second test.
    """
    found = {name: made for name, values in columns.items() if (made := _words(name, values)) is not None}
    order = sorted(found, key=lambda name: (not found[name].sensor, not found[name].named))
    numbers = {k: v.astype(np.float64) for k, v in columns.items() if v.dtype.kind in "iuf"}
    chosen: list[str] = []
    rows = np.arange(t_ns.size)
    while True:
        more = next(
            (
                name
                for name in order
                if name not in chosen
                and _parts(t_ns[rows], found[name], [v[rows] for k, v in numbers.items() if k != name], rows, absolute)
            ),
            None,
        )
        if more is None:
            return tuple(name for name in columns if name in chosen)
        chosen.append(more)
        codes = found[more].codes[rows]
        rows = rows[codes == np.bincount(codes[codes >= 0]).argmax()]


def bare_header(name: str) -> str:
    """The last part of a header, without what names are written with: 'header.frame_id' is 'frameid'."""
    return re.sub(r"[\s_#()-]", "", name.rsplit(".", 1)[-1]).casefold()


def words_of(header: str, values: Array) -> list[str]:
    """What each row says in a column that names series; '' where it says nothing. A number says it with the column's
    header: 'Sensor-ID 1'."""
    if values.dtype.kind in "iuf":
        return ["" if v != v else f"{header} {v:.0f}" for v in values.tolist()]
    return ["" if v is None else str(v).strip() for v in values.tolist()]


def _words(header: str, values: Array) -> _Words | None:
    """A column's words; None where it holds too many, too few, or others than names."""
    numbers = values.dtype.kind in "iuf"
    if values.size < 2 * _FEWEST or values.dtype.kind == "b":
        return None
    if numbers:
        full = values[values == values]
        # most columns measure, and are left here
        if not 1 < np.unique(full).size <= _MOST_NUMBERS or (full != np.round(full)).any() or (full < 0).any():
            return None
    cells = words_of(header, values)
    words = sorted(set(cells) - {""})
    if not 1 < len(words) <= min(_MOST_NUMBERS if numbers else _MOST_WORDS, len(cells) // 3):
        return None
    if cells.count("") > _BLANK * len(cells) or {w.casefold() for w in words} <= _STATES:
        return None
    if not numbers and any(map(_TIME.fullmatch, words)):
        return None
    place = {word: k for k, word in enumerate(words)} | {"": -1}
    bare = bare_header(header)
    sensor = bare in SENSOR_WORDS
    named = sensor or bare in NAME_WORDS or bare in LABEL_WORDS
    codes = np.array([place[c] for c in cells], np.int64)
    return _Words(codes, tuple(words), numbers or all(map(_NUMBER.fullmatch, words)), named, sensor)


def _parts(t_ns: Int1D, column: _Words, values: Sequence[Float1D], rows: Int1D, absolute: bool) -> bool:
    """Whether a column parts rows into series. rows: which of its own they are."""
    codes = column.codes[rows]
    good = codes >= 0
    t, codes, values = t_ns[good], codes[good], [v[good] for v in values]
    counts = np.bincount(codes) if codes.size else np.zeros(1, np.int64)
    if int((counts >= _FEWEST).sum()) < 2:
        return False
    changed = codes[1:] != codes[:-1]
    steps = np.diff(t)
    if (back := int((steps < 0).sum())) and _begins_anew(t, codes):
        return absolute and 2 * back >= int(changed.sum()) and (column.named or not column.numbers)
    if column.sensor and int(changed.sum()) > 2 * (counts > 0).sum():
        return True
    mixed = float(changed.sum()) / (2 * (codes.size - int(counts.max()))) >= _MIXED
    if _meet(t, codes):
        return mixed and (column.named or not column.numbers or _alternate(codes, values))
    if not mixed:
        return False
    whole, own = _steady([t]), _steady([t[codes == k] for k in np.flatnonzero(counts >= _FEWEST)])
    if whole >= _STEADY and 1 - own > 2 * (1 - whole) + _ODD:
        return False  # the clock of the table goes on whatever the word
    clocks = 1 - whole >= _ODD and 1 - own <= _RESOLVED * (1 - whole)
    return column.named or (not column.numbers and (clocks or _alternate(codes, values)))


def _begins_anew(t: Int1D, codes: Int1D) -> bool:
    """Whether times go back between words only, each of which stands in order."""
    return all(bool((np.diff(t[codes == k]) >= 0).all()) for k in np.unique(codes))


def _meet(t: Int1D, codes: Int1D) -> bool:
    """Whether rows share their times, and differ in their words there."""
    times = np.unique(t).size
    again = t.size - times
    pairs = np.unique(np.stack([t, codes]), axis=1).shape[1]
    return again >= max(_MEET * t.size, _FEWEST) and pairs - times >= _EXPLAINED * again


def _steady(parts: Sequence[Int1D]) -> float:
    """The share of steps that are nearly the median of their part's."""
    like = total = 0
    for t in parts:
        steps = np.diff(t).astype(np.float64)
        usual = float(np.median(steps)) if steps.size else 0.0
        like += int((np.abs(steps - usual) <= 0.1 * usual).sum()) if usual > 0 else 0
        total += steps.size
    return like / max(1, total)


def _alternate(codes: Int1D, values: Sequence[Float1D]) -> bool:
    """Whether all numbers that move do so with the words: far from the row before, near the word's own row before."""
    found = False
    for x in values:
        full = np.isfinite(x)
        v, c = x[full], codes[full]
        if np.unique(c).size < 2 or np.unique(v).size < 2:
            continue
        across = np.abs(np.diff(v))[c[1:] != c[:-1]]
        within = np.concatenate([np.abs(np.diff(v[c == k])) for k in np.unique(c)])
        if not across.size or not within.size or np.median(across) <= _APART * np.median(within):
            return False
        found = True
    return found
