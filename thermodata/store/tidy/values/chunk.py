"""Some rows of a stream: raw columns read together, calibrated as they are asked for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from thermodata.calibration.expression.evaluation import rate_of
from thermodata.calibration.quality.ends.limit import codes_of
from thermodata.calibration.result import CalibrationResult
from thermodata.errors import ThermodataError, UsageError
from thermodata.plugin import Array, Float1D, Int1D
from thermodata.reader.text.cells.values.number import is_empty, is_overload
from thermodata.schema.flag import Flag
from thermodata.schema.units.quantity import canonical
from thermodata.schema.words.on_off import SHOWN
from thermodata.store.tidy.plan import derive
from thermodata.store.tidy.plan.plan import Bound, TestPlan
from thermodata.store.tidy.rows.timeline import Timeline


class Streams(Protocol):
    """What a chunk asks of the test that it belongs to."""

    @property
    def plan(self) -> TestPlan: ...

    @property
    def calibrations(self) -> Mapping[str, CalibrationResult]: ...

    def timeline(self, member: tuple[str, str]) -> Timeline:
        """The rows of a stream (source, stream) in time order."""

    def scheduled(self, bound: Bound, t_ns: Int1D) -> tuple[Array, Array]:
        """(values, flags) of a channel that nobody logged, shape of t_ns."""

    def sampled(self, name: str, t_ns: Int1D) -> tuple[Array, Array]:
        """(values, flags) of a channel of any stream at other times, shape of t_ns."""

    def rated(self, bound: Bound, start: int, stop: int) -> tuple[Array, Array]:
        """(rates by the second, flags) of a channel on rows start to stop of its own stream, shape (stop - start,)."""


@dataclass(slots=True)
class Column:
    """A calibrated channel on some rows: values and uint16 flags, shape (n,). codes: a logger's for "no value", as they
    are in its unit."""

    bound: Bound
    values: Array
    flags: Array
    codes: Float1D | None = None

    def part(self, start: int, stop: int) -> Column:
        return Column(self.bound, self.values[start:stop], self.flags[start:stop], self.codes)


class Chunk:
    """Rows start to stop of a stream, for the channels `bounds` (others are read when they are needed)."""

    def __init__(
        self, series: Streams, member: tuple[str, str], start: int, stop: int, bounds: Sequence[Bound]
    ) -> None:
        self.series, self.member, self.start, self.stop = series, member, start, stop
        self.line = series.timeline(member)
        signals = list(dict.fromkeys(b.signal.name for b in bounds if b.signal is not None))
        self._raw = self.line.columns(signals, start, stop) if signals else {}
        self._flags = self.line.columns(signals, start, stop, flags=True) if self.line.flagged(signals) else {}
        self._asked = set(signals)
        self._clock = self.line.clock_flags(start, stop) if signals else None
        self._kept: dict[str, tuple[Array, Array]] = {}
        self._t: Int1D | None = None

    @property
    def t_ns(self) -> Int1D:
        """Shape (stop - start,), non-decreasing."""
        if self._t is None:
            self._t = self.line.times(self.start, self.stop)
        return self._t

    def part(self, start: int, stop: int) -> Chunk:
        """Some of its rows, without their values."""
        chunk = Chunk(self.series, self.member, start, stop, ())
        chunk._t = self.t_ns[start - self.start : stop - self.start]
        return chunk

    def values(self, bound: Bound) -> tuple[Array, Array]:
        """(values, flags) of a channel of this stream: float64 in the canonical unit or text as object, and uint16;
        both of shape (stop - start,)."""
        if bound.name not in self._kept:
            if bound.channel.schedule is not None:
                self._kept[bound.name] = self.series.scheduled(bound, self.t_ns)
            elif bound.signal is None:
                self._kept[bound.name] = self._derived(bound)
            else:
                self._kept[bound.name] = self._measured(bound, bound.signal.name)
        return self._kept[bound.name]

    def raw(self, signal: str) -> Array | None:
        """A signal as the raw layer has it; None where no file does."""
        return self._raw.get(signal)

    def codes(self, bound: Bound) -> Float1D | None:
        """A logger's codes for "no value" in the unit that a channel is logged in, in its canonical one; None where no
        file has it, or none can be logged so."""
        raw = None if bound.signal is None or bound.is_text else self._raw.get(bound.signal.name)
        if (
            raw is None
            or raw.dtype.kind not in "iuf"
            or (bound.signal is not None and bound.signal.scaling is not None)
        ):
            return None
        codes = codes_of(bound.channel.quantity)
        if raw.dtype.kind in "iu":
            codes = codes[(codes == np.round(codes)) & (codes >= 0 if raw.dtype.kind == "u" else True)]
        values, _ = self._calibrated(bound, codes.astype(raw.dtype if raw.dtype.kind == "f" else np.int64))
        return np.asarray(values[np.isfinite(values)], dtype=np.float64)

    def _measured(self, bound: Bound, signal: str) -> tuple[Array, Array]:
        if signal not in self._asked:
            return Chunk(self.series, self.member, self.start, self.stop, [bound]).values(bound)
        n = self.stop - self.start
        raw = self._raw.get(signal)
        if raw is None:
            return np.full(n, None if bound.is_text else np.nan, object if bound.is_text else float), np.zeros(
                n, np.uint16
            )
        values, flags = self._calibrated(bound, raw)
        from_reader = self._flags.get(signal)
        if from_reader is not None:
            flags = flags | from_reader.astype(np.uint16)
            if raw.dtype.kind in "iub" and not bound.is_text:
                # integers and truth values have no NaN: where the file said nothing, the raw layer holds a 0
                nothing = (from_reader.astype(np.uint16) & np.uint16(Flag.NOT_MEASURING)) != 0
                values = np.where(nothing & (raw == 0), np.nan, values)
        if self._clock is not None:
            flags = flags | self._clock
        return values, flags

    def _calibrated(self, bound: Bound, raw: Array) -> tuple[Array, Array]:
        from thermodata.calibration.channel import calibrate

        assert bound.signal is not None
        named = bound.channel.calibration
        names = [named] if isinstance(named, str) else list(named or [])
        known = self.series.calibrations
        missing = [n for n in names if n not in known]
        if missing:
            raise UsageError(
                f"calibration '{missing[0]}' is not available",
                where=f"channel {bound.name}",
                hint="mend that calibration first: 'thermodata calibrations' and the losses of 'ingest' say "
                "what is wrong with it",
            )
        if bound.is_text:
            return np.array([None if v is None else str(v) for v in raw.tolist()], dtype=object), np.zeros(
                len(raw), np.uint16
            )
        values, flags = calibrate(
            raw,
            channel=bound.channel,
            signal_unit=bound.unit,
            scaling=bound.signal.scaling,
            calibrations=[known[n] for n in names],
            name=bound.name,
        )
        return values, flags.astype(np.uint16, copy=False)

    def _derived(self, bound: Bound) -> tuple[Array, Array]:
        text = bound.channel.derive or ""
        values: dict[str, Array] = {}
        flags: Array = np.zeros(self.stop - self.start, np.uint16)
        for name in derive.names(text):
            other = self.series.plan.bound[name]
            operand, marks = (
                self.values(other)
                if (other.source, other.stream) == self.member
                else self.series.sampled(name, self.t_ns)
            )
            values[name], flags = operand, flags | marks
        for name in derive.rated(text):
            values[rate_of(name)], marks = self.series.rated(self.series.plan.bound[name], self.start, self.stop)
            flags = flags | marks
        units = {n: canonical(self.series.plan.bound[n].channel.quantity) for n in derive.names(text)}
        return derive.evaluate(bound, values, units), flags


def calibrated(chunk: Chunk, bounds: Sequence[Bound], problems: list[str], pool: Executor) -> dict[str, Column]:
    """The channels of a chunk; one that can't be calibrated is left out, with the reason in `problems`."""

    def one(bound: Bound) -> Column | str:
        try:
            return Column(bound, *chunk.values(bound), chunk.codes(bound))
        except ThermodataError as error:
            return f"channel '{bound.name}': " + "; ".join(str(error).splitlines())

    # derived channels look into others, which is not for several threads
    measured = [b for b in bounds if b.signal is not None]
    answers = dict(zip((b.name for b in measured), pool.map(one, measured), strict=True))
    columns: dict[str, Column] = {}
    for bound in bounds:
        answer = answers[bound.name] if bound.name in answers else one(bound)
        if isinstance(answer, str):
            problems.append(answer)
        else:
            columns[bound.name] = answer
            if bound.signal is not None and bound.signal.dtype == "str" and not bound.is_text:
                _say_words(chunk.raw(bound.signal.name), answer, problems)
    return columns


def _say_words(raw: Array | None, column: Column, problems: list[str]) -> None:
    """A problem where texts are no numbers: once a channel."""
    said = f"channel '{column.bound.name}': text where numbers are expected"
    if raw is None or any(p.startswith(said) for p in problems):
        return
    lost = [str(raw[i]) for i in np.flatnonzero(np.isnan(column.values)).tolist() if raw[i] is not None]
    word = next((w for w in lost if not is_empty(w) and not is_overload(w)), None)
    if word is None:
        return
    lost_to = "what is no number is left without a value"
    if column.bound.channel.quantity == "state":
        lost_to += (
            f"; try: write 1 and 0 into the file, or words for on and off that are known here ({SHOWN}); or "
            "quantity: label, which keeps the words and drives nothing"
        )
    problems.append(f"{said}, such as '{word[:40]}': {lost_to}")
