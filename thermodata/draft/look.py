"""What `preview` adds to a file's description: which campaign describes it, and what would be flagged in it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.calibration.quality.column import ColumnInput
from thermodata.calibration.quality.concise import concise
from thermodata.calibration.quality.ends.range import ends_of_ranges
from thermodata.calibration.quality.event import QualityEvent
from thermodata.calibration.quality.flags import flag_stream
from thermodata.draft.signals.guess import guess_of
from thermodata.draft.signals.values import values_of
from thermodata.errors import UsageError
from thermodata.plugin import Array, Block, Float1D, Int1D, Signal
from thermodata.reader.finding.seen import time_shown
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.flag import Flag
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.units.quantity import STATES, canonical
from thermodata.store.tidy.flags.beside.between import HELD
from thermodata.store.tidy.flags.beside.readings import reading_with

_MOST_ROWS, _MOST_COLUMNS = 300_000, 200  # of a stream
_MOST_IN_ALL = 2000  # columns of a file: nobody looks at more, and each takes half a millisecond
_MOST_EVENTS = 20  # told of a stream
_BARS, _WIDTH = "▁▂▃▄▅▆▇█", 32


@dataclass(slots=True)
class Watch:
    """Keeps a bounded part of the columns that pass, for flags and pictures. streams: how many the file has, which
    share what is kept; seen, watched: columns that passed, and those of them that are kept."""

    streams: int = 1
    times: dict[str, list[Int1D]] = field(default_factory=dict)
    columns: dict[str, dict[str, list[Array]]] = field(default_factory=dict)
    flags: dict[str, dict[str, list[Array]]] = field(default_factory=dict)
    kept: dict[str, int] = field(default_factory=dict)
    seen: int = 0
    watched: int = 0

    def __call__(self, block: Block) -> None:
        room = _MOST_ROWS - self.kept.get(block.stream, 0)
        if room <= 0:
            return
        n = min(room, block.t_ns.size)
        self.kept[block.stream] = self.kept.get(block.stream, 0) + n
        if block.stream not in self.columns:
            names = list(block.values)[: self._room()]
            self.seen += len(block.values)
            self.watched += len(names)
            self.columns[block.stream], self.flags[block.stream] = {k: [] for k in names}, {k: [] for k in names}
        self.times.setdefault(block.stream, []).append(block.t_ns[:n])
        for name, parts in self.columns[block.stream].items():
            parts.append(block.values[name][:n])
            own = (block.flags or {}).get(name)
            part = np.zeros(n, np.uint16) if own is None else own[:n].astype(np.uint16)
            self.flags[block.stream][name].append(part)

    def _room(self) -> int:
        """How many columns of the next stream are kept: a share of all, so that each stream shows its first ones."""
        return min(_MOST_IN_ALL - self.watched, _MOST_COLUMNS, max(1, _MOST_IN_ALL // self.streams))

    def stream(self, name: str) -> tuple[Int1D, dict[str, Array], dict[str, Array]]:
        """(times, columns, the reader's own flags) of what was kept of a stream; shapes (n,)."""
        if name not in self.times:
            return np.zeros(0, np.int64), {}, {}
        own = {k: np.concatenate(v) for k, v in self.flags[name].items()}
        return np.concatenate(self.times[name]), {k: np.concatenate(v) for k, v in self.columns[name].items()}, own


@dataclass(frozen=True, slots=True)
class Meant:
    """What a campaign file says of a file. source: its name there; quantities: signal as written there -> (quantity,
    unit, channel)."""

    campaign: Path
    source: str
    test: str | None
    quantities: dict[str, tuple[str, str | None, str]]


def campaign_of(file: Path) -> Path | None:
    """The campaign.yaml beside a file or in one of three folders above it."""
    for folder in list(file.absolute().parents)[:4]:
        if (folder / "campaign.yaml").is_file():
            return folder / "campaign.yaml"
    return None


def meaning_of(campaign: Campaign, at: Path, file: Path) -> Meant | None:
    """The source and test that a file belongs to by `files` of the campaign file; None where it is in none."""
    from thermodata.store.ingest.reading.resolve import resolve

    folder = at.absolute().parent
    try:
        inside = file.absolute().resolve().relative_to(folder.resolve()).as_posix()
    except ValueError:
        return None
    for calibration in campaign.calibrations.values():
        if getattr(calibration, "file", None) == inside:
            return _meant(campaign, at, str(getattr(calibration, "source", "")), None)
    for test in campaign.tests:
        for source in campaign.sources:
            if inside in resolve(folder, campaign, test, source).paths:
                return _meant(campaign, at, source, test.id)
    return None


def _meant(campaign: Campaign, at: Path, source: str, test: str | None) -> Meant:
    found = {
        c.signal: (str(c.quantity), c.unit, name)
        for name, c in campaign.channels.items()
        if c.source == source and c.signal is not None
    }
    return Meant(at, source, test, found)


def flagged(
    watch: Watch, stream: str, signals: list[Signal], meant: Meant | None, absolute: bool
) -> tuple[dict[str, dict[str, Any]], list[dict[str, Any]]]:
    """(signal -> quantity, channel, counts of flags and a sparkline; the first events) of one stream as it was read.

    Quantities are those of the campaign file, else guesses from names, units and values.
    """
    t_ns, columns, own = watch.stream(stream)
    said = _meant_by(meant, signals)
    inputs: dict[str, ColumnInput] = {}
    told: dict[str, dict[str, Any]] = {}
    for signal in signals:
        column = columns.get(signal.name)
        if column is None:
            continue
        seen = values_of(column)
        guessed = guess_of(signal, None if signal.scaling else seen)
        quantity, unit, channel = said.get(signal.name) or (guessed.quantity or "voltage", guessed.unit, None)
        told[signal.name] = {
            "quantity": quantity if channel or guessed.quantity else None,
            "channel": channel,
            "guess": None if channel else guessed.comment(),
            "flags": {},
            "values": None if seen is None else {"low": seen.low, "high": seen.high, "median": seen.median},
            "sparkline": sparkline(column),
        }
        no_channel = channel is None and guessed.is_no_reading  # an ingest makes none of it, and flags nothing
        if seen is not None and not seen.numerals and not no_channel:
            values = _canonical(column, quantity, unit)
            inputs[signal.name] = ColumnInput(values, quantity, own[signal.name], held=signal.held)
    flags, events = _flag(t_ns, inputs) if t_ns.size and inputs else ({}, [])
    for name, column in flags.items():
        told[name]["flags"] = {f.word: n for f in Flag if f and (n := int(((column & np.uint16(f)) != 0).sum()))}
    return told, [_event(e, absolute) for e in concise(events)[:_MOST_EVENTS]]


@dataclass(frozen=True, slots=True)
class _AsFlagged:
    """values, flags: shape (n,)."""

    values: Array
    flags: Array


def _flag(t_ns: Int1D, inputs: Mapping[str, ColumnInput]) -> tuple[dict[str, Array], list[QualityEvent]]:
    """As an ingest flags a test: where a range ends all of it tells, and then the stream is flagged anew."""
    flags, events = flag_stream(t_ns, inputs)
    t_s = (t_ns - t_ns[0]) / 1e9
    readings = {
        ("", name): reading_with(None, _AsFlagged(one.values, flags[name]), t_s)
        for name, one in inputs.items()
        if one.quantity in HELD and one.is_float
    }
    limits = ends_of_ranges(readings)
    if not limits:
        return flags, events
    ended = {name: replace(one, limits=limits.get(("", name), one.limits)) for name, one in inputs.items()}
    return flag_stream(t_ns, ended)


def _meant_by(meant: Meant | None, signals: list[Signal]) -> dict[str, tuple[str, str | None, str | None]]:
    """Signal -> (quantity, unit, channel) of those that the campaign file means."""
    from thermodata.reader.finding.match import match_signal

    said: dict[str, tuple[str, str | None, str | None]] = {}
    for written, (quantity, unit, channel) in (meant.quantities if meant else {}).items():
        try:
            hit = match_signal(written, signals)
        except UsageError:
            continue
        said[hit.name] = (quantity, unit or hit.unit, channel)
    return said


def _event(e: QualityEvent, absolute: bool) -> dict[str, Any]:
    return {
        "signal": e.channel,
        "flag": e.flag,
        "from": time_shown(e.from_ns, absolute),
        "to": time_shown(e.to_ns, absolute),
        "n": e.n,
        "detail": e.detail,
    }


def _canonical(column: Array, quantity: str, unit: str | None) -> Array:
    """Values as the flags expect them; a probe's volts, which a calibration is needed for, stay volts."""
    if unit is None or quantity in STATES or column.dtype.kind not in "iuf":
        return column
    try:
        factor, shift = linear_conversion(unit, canonical(quantity))
    except UsageError:
        return column
    return column if (factor, shift) == (1.0, 0.0) else np.asarray(column * factor + shift)


def sparkline(column: Array) -> str | None:
    """A signal in one line of text, '▁▂▅█': means of 32 stretches between its extremes; None for text."""
    if column.dtype.kind not in "biuf" or not column.size:
        return None
    x = column.astype(np.float64)
    x[~np.isfinite(x)] = np.nan
    edges = np.linspace(0, x.size, min(_WIDTH, x.size) + 1).astype(int)
    means = x if x.size <= _WIDTH else np.array([_mean(x[a:b]) for a, b in pairwise(edges)])
    if np.isnan(means).all():
        return " " * means.size
    low, span = float(np.nanmin(means)), float(np.nanmax(means) - np.nanmin(means))
    scale = (means - low) / span if span > 1e-12 * max(1.0, abs(low)) else np.zeros_like(means)
    return "".join(" " if np.isnan(v) else _BARS[min(7, int(v * 8))] for v in scale)


def _mean(x: Float1D) -> float:
    """The mean of what is there; NaN where nothing is."""
    gone = np.isnan(x)
    return float(x.mean() if not gone.any() else np.nan if gone.all() else np.nanmean(x))
