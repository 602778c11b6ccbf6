"""The times of an LVM packet's rows: its start, and either an X column or a count of Delta_X."""

from __future__ import annotations

import numpy as np

from thermodata.plugin import Bool1D, Float1D, Int1D
from thermodata.reader.text.cells.values.number import of_either_mark
from thermodata.reader.text.rows.grid import Rows
from thermodata_reader_crio.labview_clock import EPOCH_1904_NS, step_ns
from thermodata_reader_crio.lvm.header import Header, Packet
from thermodata_reader_crio.lvm.starts import Starts, is_unset, said_start
from thermodata_reader_crio.row_times import counted_ns, is_labview_seconds, seconds_ns


class Times:
    """The clock of one packet. first: its first rows; starts: of all packets of the file. notes: of what is odd about
    it, as far as it was asked."""

    def __init__(self, header: Header, packet: Packet, first: Rows, starts: Starts) -> None:
        self.header, self.packet, self.starts = header, packet, starts
        self.notes: list[str] = []
        self.labview: dict[int, bool] = {}
        self.empty: set[int] = set()
        for x in {x for x in packet.x if x is not None}:
            values = first.columns[x].values
            self.labview[x] = is_labview_seconds(values)
            if values.size and not np.isfinite(values).any():
                self.empty.add(x)
                self.notes.append(f"line {packet.line}: its X column is empty; rows are counted by Delta_X")
        if packet.x and packet.x[0] is None and first.n and bool(np.isfinite(first.columns[0].values).all()):
            self._note(f"line {packet.line}: X_Columns is 'No', but rows begin with a number; it is not used as time")

    def base(self, channel: int) -> int:
        """The time of X = 0, or of the first row where rows are counted; 0 where the file names no date."""
        if self._seconds(channel):
            return (
                EPOCH_1904_NS
                if self.packet.x[channel] is not None
                else EPOCH_1904_NS + round(self._number("X0", channel, 0.0) * 1e9)
            )
        start = self._start(channel) or 0
        if self.packet.x[channel] is not None:
            return start
        return start + round(self._number("X0", channel, 0.0) * 1e9)

    def dated(self, channel: int) -> bool:
        return self._seconds(channel) or self._start(channel) is not None

    def of(self, channel: int, x: Float1D | None, done: int, n: int) -> tuple[Int1D, Bool1D]:
        """(times of rows [done, done + n), which of them have one)."""
        if x is not None and self.packet.x[channel] not in self.empty:
            return seconds_ns(x, self.base(channel))
        return counted_ns(done, n, step_ns(self._step(channel)), self.base(channel))

    def _step(self, channel: int) -> float:
        step = self._number("Delta_X", channel, 1.0)
        return step if 1e-12 < step < 1e9 else 1.0

    def _seconds(self, channel: int) -> bool:
        """Whether X counts from 1904."""
        x = self.packet.x[channel]
        if x is not None:
            return self.labview.get(x, False)
        return is_labview_seconds(np.array([self._number("X0", channel, 0.0)]))

    def _start(self, channel: int) -> int | None:
        """UTC of the packet's Date and Time (local, as the source's zone says); None where there is none."""
        start, decided = self.starts.utc(self.packet, channel)
        for note in decided:
            self._note(note)
        date, time = said_start(self.header, self.packet, channel)
        if is_unset(self.packet, channel):
            instead = "the file's is taken" if start is not None else "times count from the start of the rows"
            self._note(f"line {self.packet.line}: its start is LabVIEW's zero, in 1904, which says none; {instead}")
        if start is None and (date or time):
            self._note(
                f"line {self.packet.line}: date '{date[:20]}' and time '{time[:30]}' are not understood; "
                "times count from the start of the rows"
            )
        return start

    def _number(self, key: str, channel: int, default: float) -> float:
        text = self.packet.key(key, channel)
        if not text:
            return default
        value = of_either_mark(text)
        if value is None or not abs(value) <= 9e9:
            self._note(f"line {self.packet.line}: {key} '{text[:30]}' is no number; taken as {default:g}")
            return default
        return value

    def _note(self, text: str) -> None:
        if text not in self.notes:
            self.notes.append(text)
