"""LVM files that several tests write, and what is read of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from thermodata_reader_crio import Reader

from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

S = 1_000_000_000
START = np.datetime64("2026-03-01T07:00:00", "ns").astype(np.int64).item()  # 08:00 in Prague
PRAGUE = Source(timezone="Europe/Prague")


def head(columns: str, several: str = "No", decimal: str = "Decimal_Separator\t,\n") -> str:
    return (
        f"LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\n{decimal}Multi_Headings\t{several}\n"
        f"X_Columns\t{columns}\nTime_Pref\tAbsolute\nDate\t2026/03/01\nTime\t08:00:00,0\n"
        "***End_of_Header***\t\n\t\n"
    )


def packet(names: list[str], *, start: str = "08:00:00,0", delta: str = "0,5", x: str = "", gap: str = "\t") -> str:
    n = len(names)

    def row(key: str, value: str) -> str:
        return key + "".join(f"{gap}{value}" if i else f"\t{value}" for i in range(n)) + "\t\n"

    return (
        f"Channels\t{n}\n"
        + row("Samples", "3")
        + row("Date", "2026/03/01")
        + row("Time", start)
        + row("Y_Unit_Label", "V")
        + row("X0", "0,0E+0")
        + row("Delta_X", delta)
        + "***End_of_Header***\t\n"
        + x
        + "\tComment\n"
    )


def read(tmp_path: Path, text: str, source: Source = PRAGUE) -> Data:
    path = tmp_path / "x.lvm"
    path.write_text(text, encoding="utf-8")
    return load(Reader(), path, source)
