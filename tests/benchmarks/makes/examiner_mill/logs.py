"""Files of this laboratory: LabVIEW's spreadsheet, an export of the control, the hall's recorder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from pathlib import Path
from zoneinfo import ZoneInfo

import numpy as np

from ..bodies import Array
from ..files import POINT, csv
from ..labview import Signals, Spelling, lvm, tdms
from ..recorder import mcap

ZONE = ZoneInfo("Europe/Prague")
EPOCH = datetime(1904, 1, 1, tzinfo=ZoneInfo("UTC"))  # of LabVIEW
TEXT = Spelling(",", 4, "0,0000000000000000E+0", padded=True, fraction="000")
GROUP = "cRIO"


def in_utc(local: datetime) -> datetime:
    """Without a zone."""
    return local.replace(tzinfo=ZONE).astimezone(ZoneInfo("UTC")).replace(tzinfo=None)


def spreadsheet(path: Path, start: datetime, dt_s: float, signals: Signals) -> None:
    """What 'Write To Spreadsheet File' leaves: tabs, and seconds since 1904. start: in local time, as of all here."""
    first = (start.replace(tzinfo=ZONE) - EPOCH).total_seconds()
    rows = ["\t".join(["Time [s]", *(f"{name} [{unit}]" for name, (unit, _) in signals.items())])]
    columns = np.column_stack([x for _, x in signals.values()])
    for t, values in zip(first + np.arange(len(columns)) * dt_s, columns, strict=True):
        rows.append("\t".join([f"{t:.3f}", *(f"{v:.4f}" for v in values)]))
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")


def probes(path: Path, start: datetime, dt_s: float, signals: Signals) -> None:
    """The cRIO's log in the form that the path ends with."""
    if path.suffix == ".tdms":
        named = {f"{GROUP}/{name}": x for name, x in signals.items()}
        tdms(path, {"name": path.stem}, in_utc(start), dt_s, named)
    elif path.suffix == ".lvm":
        lvm(path, start, dt_s, signals, TEXT)
    else:
        spreadsheet(path, start, dt_s, signals)


def control(path: Path, start: datetime, signals: Signals) -> None:
    """An export with semicolons, decimal commas and a row of units, a row a minute."""
    rows = [";".join(["Time", *signals]), ";".join(["[]", *(f"[{unit}]" for unit, _ in signals.values())])]
    for i, values in enumerate(np.column_stack([x for _, x in signals.values()])):
        cells = [f"{v:.6g}".replace(".", ",") for v in values]
        rows.append(";".join([f"{start + timedelta(minutes=i):%d.%m.%Y %H:%M:%S}", *cells]))
    path.write_text("\r\n".join(rows) + "\r\n", encoding="cp1250", newline="")


def recorder(path: Path, times: Sequence[datetime], data: Mapping[str, Array]) -> None:
    """MCAP in UTC, or a logger's table in local time. data: by signal, shape (n,)."""
    if path.suffix == ".mcap":
        mcap(path, [in_utc(t) for t in times], data, "hall")
    else:
        csv(path, [["time", *data]], times, [*data.values()], POINT, 2)
