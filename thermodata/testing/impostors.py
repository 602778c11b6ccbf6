"""Heads of files of many formats, for readers to leave alone. The first word of a name is the format.

Those of formats that an installed reader knows are its own `heads`; here are the others, and what no reader reads.
"""

from __future__ import annotations

import struct

from thermodata.plugin import Reader
from thermodata.reader.finding.registry import readers

_TDMS = b"TDSm" + struct.pack("<IIQQ", 0x0E, 4713, 64, 32) + b"\x01\0\0\0\x01\0\0\0/" + bytes(64)
_SPREADSHEET = b"PK\x03\x04\x14\0\x06\0\x08\0\0\0!\0" + bytes(12) + b"\x13\0\0\0[Content_Types].xml" + bytes(80)

IMPOSTORS: dict[str, bytes] = {
    "TDMS": _TDMS,
    "TDMS_INDEX": b"TDSh" + _TDMS[4:],
    "LVM": b"LabVIEW Measurement\t\r\nWriter_Version\t2\r\nSeparator\tTab\r\n***End_of_Header***\t\r\n",
    "MCAP": b"\x89MCAP0\r\n\x01\x10\0\0\0\0\0\0\0\x04\0\0\0ros2\x04\0\0\0test",
    "PARQUET": b"PAR1\x15\x04\x15\x80" + bytes(60),
    "XLSX": _SPREADSHEET,
    "ZIP of pictures": b"PK\x03\x04\x14\0\0\0\x08\0" + bytes(16) + b"\x09\0\0\0photo.jpg" + bytes(40),
    "CSV": b"time [s];T1 [degC];speed [rpm]\n0;20.5;0\n1;20.6;100\n2;20.7;200\n3;20.8;300\n",
    "PNG": b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + bytes(40),
    "PDF": b"%PDF-1.7\n%\xe2\xe3\xcf\xd3\n1 0 obj\n<< /Type /Catalog >>\nendobj\n",
    "PROSE": "Měření teplot vřetena dne 1. 3. 2026, poznámky obsluhy.\nSonda 3 drží špatně.\n".encode(),
    "YAML": b"schema: thermodata/campaign/1\nid: gantry\nsources:\n  daq: {reader: crio, files: raw/a.tdms}\n",
    "JSON": b'{"time": [0, 1, 2], "T1": [20.5, 20.6, 20.7]}\n',
    "SQLITE": b"SQLite format 3\0" + bytes(60),
    "ZEROS": bytes(4096),
    "NOTHING": b"",
    "NOISE": bytes((i * 167 + 13) % 256 for i in range(4096)),
}


def impostors(reader: Reader) -> dict[str, bytes]:
    """All heads that a reader has to leave alone, by name: of no format that it has a head of itself."""
    others = [each for name, each in readers().items() if name != reader.name]
    known = IMPOSTORS | {name: head for each in others for name, head in _heads(each).items()}
    own = {name.casefold() for name in _heads(reader)}
    return {name: head for name, head in known.items() if name.split(" ")[0].casefold() not in own}


def _heads(reader: Reader) -> dict[str, bytes]:
    return dict(getattr(reader, "heads", {}))
