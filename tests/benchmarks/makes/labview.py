"""Logs of LabVIEW: measurement text (LVM) of signals that share one clock, and TDMS."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np
from nptdms import ChannelObject, RootObject, TdmsWriter

from .bodies import Array

Signals = Mapping[str, tuple[str, Array]]  # by name: unit and samples, shape (n,); of TDMS the name is group/channel


@dataclass(frozen=True)
class Spelling:
    """How one version writes LVM: before decimals, digits of a sample, the first X, cells after a header's end, the
    fraction of a second in its head."""

    mark: str
    digits: int
    zero: str
    padded: bool
    fraction: str = "0"


def lvm(path: Path, start: datetime, dt_s: float, signals: Signals, spelling: Spelling) -> None:
    """A text file. start: in the computer's time."""
    units, mark = [unit for unit, _ in signals.values()], spelling.mark
    columns = [x for _, x in signals.values()]
    count, n = len(units), len(columns[0])
    day, time = f"{start:%Y/%m/%d}", f"{start:%H:%M:%S}{mark}{spelling.fraction}"
    head = [
        "LabVIEW Measurement\t",
        "Writer_Version\t2",
        "Reader_Version\t2",
        "Separator\tTab",
        f"Decimal_Separator\t{mark}",
        "Multi_Headings\tNo",
        "X_Columns\tOne",
        "Time_Pref\tAbsolute",
        f"Date\t{day}",
        f"Time\t{time}",
        "***End_of_Header***\t",
        "\t",
        f"Channels\t{count}",
        "Samples" + f"\t{n}" * count,
        "Date" + f"\t{day}" * count,
        "Time" + f"\t{time}" * count,
        "Y_Unit_Label\t" + "\t".join(units),
        "X0" + f"\t{spelling.zero}" * count,
        "Delta_X" + f"\t{dt_s:.6f}".replace(".", mark) * count,
        "***End_of_Header***" + "\t" * count * spelling.padded,
        "X_Value\t" + "\t".join(signals) + "\tComment",
    ]
    samples = np.column_stack([np.arange(n) * dt_s, *columns])
    rows = ["\t".join(f"{v:.{spelling.digits}f}" for v in row).replace(".", mark) for row in samples]
    path.write_text("\n".join(head + rows) + "\n", encoding="cp1252")


def tdms(path: Path, told: Mapping[str, str], start: datetime, dt_s: float, signals: Signals) -> None:
    """told: properties of the file. start: in UTC, without a zone."""
    clock = {"wf_start_time": np.datetime64(start, "us"), "wf_start_offset": 0.0, "wf_increment": dt_s}
    channels = [
        ChannelObject(*name.split("/"), x, clock | {"wf_samples": len(x), "unit_string": unit})
        for name, (unit, x) in signals.items()
    ]
    with TdmsWriter(str(path)) as file:
        file.write_segment([RootObject(dict(told)), *channels])
