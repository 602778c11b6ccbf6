"""Files of this laboratory: exports of a Heidenhain and of a Fanuc control, recordings of the hall's air."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from ..bodies import Array
from ..recorder import mcap
from .sensors import SENSORS, UNITS


def heidenhain(path: Path, start: datetime, data: Mapping[str, Array]) -> None:
    """A recording of TNCscope, a value a minute. data: by channel, shape (n,)."""
    n = len(next(iter(data.values())))
    rows = ["%[GLOBAL]", "%VERSION=1", f"%DATE={start:%d.%m.%Y}", f"%TIME={start:%H:%M:%S}", "%"]
    for c in data:
        unit = UNITS[SENSORS[c].quantity]
        rows += ["%[CURVE]", f"%NAME={SENSORS[c].signal}", f"%DIMENSION={'°C' if unit == 'degC' else unit}"]
        rows += [f"%COUNT={n}", "%CYCLETIME=60000000", "%"]
    rows.append("%[DATA]")
    rows += [";".join(f"{v:.2f}" for v in row) for row in np.column_stack([np.arange(n), *data.values()])]
    path.write_bytes(("\r\n".join(rows) + "\r\n").encode("cp1252"))


def fanuc(path: Path, start: datetime, data: Mapping[str, Array]) -> None:
    """A table of MT-LINKi: a row each time that a signal changes, and each half hour."""
    rows = []
    for c, x in data.items():
        k = np.arange(len(x))
        for i in np.flatnonzero(np.r_[True, np.diff(x) != 0] | (k % 30 == 0) | (k == len(x) - 1)):
            time = start + timedelta(minutes=int(i))
            rows.append((i, f"{time:%Y-%m-%d %H:%M:%S},{SENSORS[c].signal},{x[i]:.2f}"))
    lines = ["updatedate,signalname,value", *(row for _, row in sorted(rows, key=lambda row: row[0]))]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def parquet(path: Path, times: Sequence[datetime], data: Mapping[str, Array]) -> None:
    """times: in UTC, without a zone. data: by signal, shape (n,)."""
    columns = {signal: pa.array(x) for signal, x in data.items()}
    pq.write_table(pa.table({"time": pa.array(times, pa.timestamp("us", tz="UTC")), **columns}), path)


CONTROLS = {"heidenhain": (".sco", heidenhain), "fanuc": ("_nc.csv", fanuc)}  # how their exports end, who writes them
RECORDERS = {"mcap": mcap, "parquet": parquet}
