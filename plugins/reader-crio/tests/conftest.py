"""TDMS files written byte by byte, so that tests know where everything lies."""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pytest

CODES = {"int16": 2, "int32": 3, "uint8": 5, "float32": 9, "float64": 10}


class Bytes:
    """Builders of the parts of a TDMS file. order: '<' or '>'."""

    UNKNOWN_END = 0xFFFFFFFFFFFFFFFF

    def __init__(self, order: str = "<") -> None:
        self.order = order

    def pack(self, code: str, *values: Any) -> bytes:
        return struct.pack(self.order + code, *values)

    def text(self, text: str) -> bytes:
        raw = text.encode()
        return self.pack("I", len(raw)) + raw

    def property(self, name: str, value: Any) -> bytes:
        head = self.text(name)
        if isinstance(value, str):
            return head + self.pack("I", 0x20) + self.text(value)
        if isinstance(value, np.datetime64):
            ns = int(value.astype("datetime64[ns]").astype(np.int64))
            seconds, rest = divmod(ns, 1_000_000_000)
            fraction = -(-(rest << 64) // 1_000_000_000)
            both = (
                ("Qq", fraction, seconds + 2_082_844_800)
                if self.order == "<"
                else ("qQ", seconds + 2_082_844_800, fraction)
            )
            return head + self.pack("I", 0x44) + self.pack(*both)
        if isinstance(value, float):
            return head + self.pack("I", 10) + self.pack("d", value)
        return head + self.pack("I", 7) + self.pack("I", value)

    def channel(
        self,
        group: str,
        name: str,
        dtype: str | None,
        n: int,
        properties: dict[str, Any] | None = None,
        index: bytes | None = None,
    ) -> bytes:
        """The metadata of one object; dtype None: no data in this segment; index: a raw data index of its own."""
        if index is None:
            index = self.pack("I", 0xFFFFFFFF) if dtype is None else self.pack("IIIQ", 20, CODES[dtype], 1, n)
        items = properties or {}
        return (
            self.text(f"/'{group}'/'{name}'")
            + index
            + self.pack("I", len(items))
            + b"".join(self.property(k, v) for k, v in items.items())
        )

    def daqmx_index(self, n: int, scalers: Sequence[tuple[int, int, int, int]], widths: Sequence[int]) -> bytes:
        """scalers: (DAQmx type, buffer, byte offset, scale id)."""
        return (
            self.pack("IIIQI", 0x1269, 0xFFFFFFFF, 1, n, len(scalers))
            + b"".join(self.pack("IIIII", kind, buffer, offset, 0, scale) for kind, buffer, offset, scale in scalers)
            + self.pack("I", len(widths))
            + b"".join(self.pack("I", w) for w in widths)
        )

    def segment(
        self,
        objects: Sequence[bytes] | None,
        raw: bytes,
        *,
        interleaved: bool = False,
        new_list: bool = True,
        to_next: int | None = None,
        daqmx: bool = False,
    ) -> bytes:
        """A whole segment; objects None: no metadata, the raw data go on as before."""
        meta = b"" if objects is None else self.pack("I", len(objects)) + b"".join(objects)
        toc = (
            (0 if objects is None else 2)
            | (4 if new_list and objects is not None else 0)
            | (8 if raw else 0)
            | (32 if interleaved else 0)
            | (64 if self.order == ">" else 0)
            | (128 if daqmx else 0)
        )
        end = len(meta) + len(raw) if to_next is None else to_next
        return b"TDSm" + struct.pack("<I", toc) + self.pack("IQQ", 4713, end, len(meta)) + meta + raw

    def wave(self, start: str = "2026-03-01T08:00:00", step: float = 0.1, **more: Any) -> dict[str, Any]:
        return {"wf_start_time": np.datetime64(start, "ns"), "wf_start_offset": 0.0, "wf_increment": step, **more}


@pytest.fixture
def tdms() -> Bytes:
    return Bytes()


@pytest.fixture
def tdms_in() -> Callable[[str], Bytes]:
    return Bytes
