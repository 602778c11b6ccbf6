"""One signal of a test in the files that it consists of, which may have it in units of their own: 'dZ [mm]' in the
first, 'dZ [µm]' in the second."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from thermodata.errors import UsageError
from thermodata.plugin import Array, Signal
from thermodata.reader.finding.match import match_signal
from thermodata.reader.text import split_unit
from thermodata.schema.files.campaign import Channel
from thermodata.schema.units.conversion import delta_factor, linear_conversion
from thermodata.schema.units.unit import is_unit
from thermodata.store.raw.raw_stream import RawStream


@dataclass(frozen=True, slots=True)
class InPart:
    """A signal as one file has it: its name there, and what makes its readings those of the first file."""

    name: str
    factor: float = 1.0
    offset: float = 0.0

    def read(self, column: Array) -> Array:
        """Its readings in the unit of the first file. column: shape (n,)."""
        if (self.factor, self.offset) == (1.0, 0.0):
            return column
        return np.asarray(column * self.factor + self.offset, dtype=np.float64)


Parts = Mapping[tuple[str, str], InPart]  # (path of a raw stream, signal of the first file) -> what that file has


@dataclass(frozen=True, slots=True)
class FoundSignal:
    """The signal behind a name of a campaign file. raw, signal: of the first file that has it; unit: there; parts:
    files that have it otherwise; note: in which units, where they differ."""

    raw: RawStream
    signal: Signal
    unit: str | None
    parts: dict[tuple[str, str], InPart] = field(default_factory=dict)
    note: str | None = None


def find_signal(raws: Iterable[RawStream], wanted: str) -> tuple[RawStream, Signal, str | None]:
    """The raw stream, signal and unit behind a name in the campaign file; UsageError where none or several fit.

    A unit in brackets after the name in the file may be left out, and is then the signal's unit. Signals that differ
    in it only, and that no file has beside each other, are one.
    """
    first: dict[tuple[str, str], RawStream] = {}
    signals: list[Signal] = []
    for raw in raws:
        for signal in raw.signals:
            if (raw.stream, signal.name) not in first:
                first[raw.stream, signal.name] = raw
                signals.append(signal)
    match = match_signal(wanted, _each_once(signals, raws, wanted))
    return first[match.stream, match.name], match, _unit_of(match)


def find_in_parts(raws: Iterable[RawStream], channel: Channel) -> FoundSignal:
    """The signal of a channel in all files of a test. UsageError as of `find_signal`, and where files have it in units
    that have nothing in common, or in another than the campaign file says."""
    raws = list(raws)
    raw, signal, unit = find_signal(raws, channel.signal or "")
    parts: dict[tuple[str, str], InPart] = {}
    said: dict[str, str] = {}
    for other in (r for r in raws if r.stream == raw.stream):
        own = _as_in(other, signal)
        if own is None:
            continue
        written = _unit_of(own)
        if written:
            said.setdefault(written, other.source_path)
        elif own.name != signal.name and not channel.unit:
            raise UsageError(
                f"no unit in {other.source_path}, and '{unit}' in {raw.source_path}",
                hint="unit: in the channel, where both are in one",
            )
        part = _in_unit_of(own, written, signal, next(iter(said), None), channel, said)
        if part != InPart(signal.name):
            parts[other.path, signal.name] = part
    return FoundSignal(raw, signal, unit, parts, _note(said, parts))


def _as_in(raw: RawStream, signal: Signal) -> Signal | None:
    """The signal as another file has it: by its name, else by its name in another unit."""
    same = next((s for s in raw.signals if s.name == signal.name), None)
    if same is not None:
        return same
    bare = _name_without_unit(signal)
    alike = [s for s in raw.signals if _name_without_unit(s) == bare]
    return alike[0] if len(alike) == 1 else None


def _in_unit_of(
    own: Signal, written: str | None, signal: Signal, first: str | None, channel: Channel, said: Mapping[str, str]
) -> InPart:
    """What makes the readings of one file those of the first. first: the unit of the first that says one."""
    from thermodata.calibration.channel import same_unit, unit_contradiction

    problem = unit_contradiction(channel, written)
    if problem is not None:
        raise UsageError(problem)
    if written is None or first is None or same_unit(first, written) or (channel.unit and channel.instead_of):
        return InPart(own.name)
    try:
        numbers = own.dtype != "str" and signal.dtype != "str" and own.scaling is None and signal.scaling is None
        if not numbers:
            raise UsageError("what a scaling makes of it is not known here")
        if channel.quantity == "temperature_difference":
            return InPart(own.name, delta_factor(written, first))
        return InPart(own.name, *linear_conversion(written, first))
    except UsageError as error:
        raise UsageError(
            f"'{first}' in {said[first]}, and '{written}' in {said[written]}",
            hint="a source of its own for files of another unit",
        ) from error


def _note(said: Mapping[str, str], parts: Parts) -> str | None:
    if all((p.factor, p.offset) == (1.0, 0.0) for p in parts.values()):
        return None
    return "in " + ", ".join(f"{unit} in {path}" for unit, path in said.items()) + ": each file's own is taken"


def _each_once(signals: list[Signal], raws: Iterable[RawStream], wanted: str) -> list[Signal]:
    """The signals, of those that differ in their unit only the first, and the one that is wanted by its whole name."""
    alike: dict[tuple[str, str], list[Signal]] = {}
    for signal in signals:
        alike.setdefault((signal.stream, _name_without_unit(signal)), []).append(signal)
    later = {
        (s.stream, s.name)
        for (stream, _), same in alike.items()
        if len(same) > 1 and not _beside_each_other(same, [r for r in raws if r.stream == stream])
        for s in same[1:]
        if s.name != wanted
    }
    return [s for s in signals if (s.stream, s.name) not in later]


def _beside_each_other(same: list[Signal], raws: list[RawStream]) -> bool:
    names = {s.name for s in same}
    return any(sum(s.name in names for s in r.signals) > 1 for r in raws)


def _name_without_unit(signal: Signal) -> str:
    """A name without its unit; whole where the brackets hold none."""
    name, unit = split_unit(signal.name)
    return name if unit is not None and not unit.isdigit() and is_unit(unit) else signal.name


def _unit_of(signal: Signal) -> str | None:
    return signal.unit or split_unit(signal.name)[1]


def joined_parts(parts: list[Array | int], *, zero: bool) -> Array:
    """A column from those of the files, one after the other; a number stands for so many rows of one that lacks it."""
    arrays = [p for p in parts if not isinstance(p, int)]
    if len(parts) == 1:
        return arrays[0]
    text = any(a.dtype == object for a in arrays)
    kind = np.dtype(object) if text else np.result_type(*arrays)
    if any(isinstance(p, int) for p in parts) and not text and not zero:
        kind = np.result_type(kind, np.float64)

    def missing(n: int) -> Array:
        if text:
            return np.full(n, None, dtype=object)
        return np.zeros(n, kind) if zero else np.full(n, np.nan)

    return np.concatenate([(missing(p) if isinstance(p, int) else p).astype(kind, copy=False) for p in parts])
