"""Where a row stands in its file: the line of a text, the row of a sheet, of a row group, of an array, of a group.

Lines and sheets are counted, and held against the row's own values: where these do not stand there, the row is told
by its number only.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from thermodata.plugin import Int1D, Source
from thermodata.reader.zone import NAT

_CLEAN = re.compile(r"[ \u00a0\u202f'’%]")
_Record = tuple[int, Sequence[Any]]  # number of the line or row from 1, its cells
_Found = tuple[list[Any], int]  # a row's values, the rows of its stream


def place(module: ModuleType, path: Path, source: Source, stream: str, row: int) -> str | None:
    """Where a row (counted from 0) of a stream stands; None where that can't be told."""
    form = module.__name__.rsplit(".", 1)[-1]
    if form in ("parquet", "mat", "mdf"):
        from thermodata_reader_table import placearrays

        return {"parquet": placearrays.parquet_row, "mat": placearrays.mat_row, "mdf": placearrays.mdf_row}[form](
            path, source, stream, row
        )
    found: str | None = module.locate(path, source, stream, row)
    return found


def nth_good(parts: Iterable[Int1D], row: int) -> int | None:
    """The number, from 0, of the row-th time that is one."""
    done = start = 0
    for t_ns in parts:
        good = np.flatnonzero(t_ns != NAT)
        if row < done + good.size:
            return start + int(good[row - done])
        done, start = done + good.size, start + t_ns.size
    return None
