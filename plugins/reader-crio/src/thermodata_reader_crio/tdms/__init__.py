"""TDMS, National Instruments' binary log: segments with metadata and raw data, DAQmx included."""

from __future__ import annotations

import struct

from thermodata.plugin import Head
from thermodata_reader_crio.tdms.recording import blocks, describe
from thermodata_reader_crio.tdms.row_location import locate

__all__ = ["EXAMPLE", "blocks", "claims", "describe", "locate"]

_LEAD_IN = b"TDSm"
EXAMPLE = _LEAD_IN + struct.pack("<IIQQ", 0x0E, 4713, 64, 32) + b"\x01\0\0\0\x01\0\0\0/" + bytes(64)


def claims(head: Head) -> str | None:
    """The reason for claiming a file: the lead-in of its first segment."""
    return "TDMS: the file starts with the lead-in 'TDSm'" if head.start.startswith(_LEAD_IN) else None
