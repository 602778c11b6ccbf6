"""Whether a column of few words parts the rows of a table into series: several sensors or hosts that stand below each
other in one column. Read as it stands, such a column is a saw of all of them.

What tells it from a state of the machine is time: series go on side by side, each with a clock of its own, while a
state leaves holes in the one clock of its table (series_evidence.py).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Array, Int1D
from thermodata.reader.signals.header_words import HOST_IDS, LABEL_WORDS, NAME_WORDS, SENSOR_IDS, SENSOR_WORDS
from thermodata.reader.signals.series_evidence import FEWEST, Header, Rows, Verdict, judge

_MOST_WORDS, _MOST_NUMBERS = 200, 32  # that name series
_BLANK = 0.1  # of the rows may name nothing
_NUMBER, _TIME = re.compile(r"\d+"), re.compile(r"\d+[-.:/]\d+[-.:/ T\dZ+]*")
STATES = frozenset(
    (
        *("on", "off", "true", "false", "yes", "no", "open", "closed", "run", "running", "stop", "stopped", "start"),
        *("idle", "ok", "nok", "error", "alarm", "ready", "busy", "auto", "manual", "active", "inactive", "normal"),
        *("rapid", "feed", "warning", "good", "bad", "high", "low", "in", "out", "up", "down", "cw", "ccw", "+", "-"),
        *("heating", "cooling", "measuring", "moving", "warmup", "pause", "event", "cyclic"),
        *("ein", "aus", "an", "auf", "zu", "wahr", "falsch", "ja", "nein", "offen", "geschlossen", "gestoppt"),
        *("connected", "disconnected", "lost", "missing", "fault", "defect", "valid", "invalid", "uncertain", "cut"),
        *("free", "occupied", "waiting", "working", "left", "right", "manually", "automatic", "enabled", "disabled"),
        *("gültig", "ungültig", "gestört", "frei", "belegt", "verbunden", "getrennt", "links", "rechts", "leer"),
        *("fehler", "bereit", "heizen", "kühlen", "messen", "zapnuto", "vypnuto", "ano", "ne", "marche", "arrêt"),
    )
)


@dataclass(frozen=True, slots=True)
class _Words:
    """codes: shape (n,), which word each row has, -1 for none."""

    codes: Int1D
    words: tuple[str, ...]
    header: Header


@dataclass(frozen=True, slots=True)
class Parting:
    """tags: the columns whose words, together, name the series that the rows are of; none where all are of one.
    doubtful: columns that may, and some of their words."""

    tags: tuple[str, ...]
    doubtful: Mapping[str, tuple[str, ...]]


def series_columns(
    t_ns: Int1D, columns: Mapping[str, Array], *, absolute: bool, pieces: Int1D | None = None
) -> Parting:
    """How the columns of a table part its rows.

    t_ns: shape (n,), in the order of the file; columns: name -> shape (n,), numbers or text. absolute: times that begin
    anew are no second test. pieces: shape (n,), in which part of the file that was read on end each row stands; all in
    one by default.
    """
    pieces = np.zeros(t_ns.size, np.int64) if pieces is None else pieces
    found = {name: made for name, values in columns.items() if (made := _words(name, values)) is not None}
    order = sorted(found, key=lambda name: (not found[name].header.sensor, not found[name].header.named))
    numbers = {k: v.astype(np.float64) for k, v in columns.items() if v.dtype.kind in "iuf"}
    chosen: list[str] = []
    rows = np.arange(t_ns.size)
    while True:
        verdicts = dict[str, Verdict]()
        for name in order:
            if name in chosen:
                continue
            good = rows[found[name].codes[rows] >= 0]
            others = [v[good] for k, v in numbers.items() if k != name]
            at = Rows(t_ns[good], found[name].codes[good], pieces[good], others)
            verdicts[name] = judge(at, found[name].header, absolute=absolute)
            if verdicts[name] is Verdict.PLAIN:
                break
        more = next((name for name, verdict in verdicts.items() if verdict is Verdict.PLAIN), None)
        if more is None:
            doubtful = {k: found[k].words[:4] for k, verdict in verdicts.items() if verdict is Verdict.DOUBTFUL}
            return Parting(tuple(name for name in columns if name in chosen), doubtful)
        chosen.append(more)
        codes = found[more].codes[rows]
        rows = rows[codes == np.bincount(codes[codes >= 0]).argmax()]


def bare_header(name: str) -> str:
    """The last part of a header, without what names are written with: 'header.frame_id' is 'frameid', 'Eh.' 'eh'."""
    return re.sub(r"[\s_#()-]", "", name.rstrip(" .").rsplit(".", 1)[-1]).casefold()


def words_of(header: str, values: Array) -> list[str]:
    """What each row says in a column that names series; '' where it says nothing. A number says it with the column's
    header: 'Sensor-ID 1'."""
    if values.dtype.kind in "iuf":
        return ["" if v != v else f"{header} {v:.0f}" for v in values.tolist()]
    return ["" if v is None else str(v).strip() for v in values.tolist()]


def _words(header: str, values: Array) -> _Words | None:
    """A column's words; None where it holds too many, too few, or others than names."""
    numbers = values.dtype.kind in "iuf"
    if values.size < 2 * FEWEST or values.dtype.kind == "b":
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
    if cells.count("") > _BLANK * len(cells) or {w.casefold() for w in words} <= STATES:
        return None
    if not numbers and any(map(_TIME.fullmatch, words)):
        return None
    place = {word: k for k, word in enumerate(words)} | {"": -1}
    bare = bare_header(header)
    codes = np.array([place[c] for c in cells], np.int64)
    header_says = Header(
        numbers=numbers or all(map(_NUMBER.fullmatch, words)),
        named=bare in SENSOR_WORDS or bare in NAME_WORDS or bare in LABEL_WORDS,
        sensor=bare in SENSOR_WORDS,
        identity=bare in SENSOR_IDS or bare in HOST_IDS,
    )
    return _Words(codes, tuple(words), header_says)
