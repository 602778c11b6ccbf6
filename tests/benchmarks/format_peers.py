"""What a user would do without us: each reads a whole file into memory (or a DuckDB file) with UTC times and float64
values, and answers what the benchmark checks: how many values, their sum, and the first and last time [ns].

An ImportError says that the peer is not installed; the benchmark then leaves it out, and says so.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
from format_files import START

Answer = dict[str, Any]


def _frame(frame: Any, times: Any, columns: Any = None) -> Answer:
    """columns: those to count; times: datetime64 or, for files without a date, seconds."""
    values = frame if columns is None else frame[columns]
    t = np.asarray(times)
    ns = np.rint(t * 1e9).astype(np.int64) if t.dtype.kind == "f" else t.astype("datetime64[ns]").astype(np.int64)
    total = float(sum(values[c].to_numpy(np.float64).sum() for c in values.columns))
    return {"values": int(values.size), "sum": total, "first": int(ns[0]), "last": int(ns[-1])}


def nptdms_pandas(path: Path, out: Path) -> Answer:
    import pandas as pd
    from nptdms import TdmsFile

    with TdmsFile.open(path) as file:
        columns = {
            c.name: c.as_dataframe(time_index=True, absolute_time=True).iloc[:, 0] for c in file["Log"].channels()
        }
    frame = pd.DataFrame(columns)
    return _frame(frame, frame.index.to_numpy())


def nptdms_duckdb(path: Path, out: Path) -> Answer:
    import duckdb
    from ingest import nptdms_stream

    nptdms_stream(path, out)
    with duckdb.connect(str(out / "day.duckdb"), read_only=True) as con:
        return _in_duckdb(con, "day", "t")


def _in_duckdb(con: Any, table: str, time: str) -> Answer:
    columns = [r[0] for r in con.execute(f"describe {table}").fetchall() if r[0].lower().startswith("s")]
    total = " + ".join(f'sum("{c}")' for c in columns)
    n, first, last, all_ = con.execute(
        f'select count(*), min("{time}")::timestamp_ns, max("{time}")::timestamp_ns, {total} from {table}'
    ).fetchone()
    ns = [int(np.datetime64(t, "ns").astype(np.int64)) for t in (first, last)]
    return {"values": n * len(columns), "sum": float(all_), "first": ns[0], "last": ns[1]}


def pandas_lvm(path: Path, out: Path) -> Answer:
    import pandas as pd

    with path.open(encoding="cp1252") as file:
        ends = [i for i, line in zip(range(100), file, strict=False) if line.startswith("***End_of_Header***")]
    frame = pd.read_csv(path, sep="\t", decimal=",", skiprows=ends[-1] + 1, encoding="cp1252")
    times = pd.Timestamp(START) + pd.to_timedelta((frame["X_Value"] * 1e9).round().astype("int64"), unit="ns")
    return _frame(frame, times.to_numpy(), [c for c in frame.columns if c.startswith("S")])


def pandas_control_csv(path: Path, out: Path) -> Answer:
    import pandas as pd

    frame = pd.read_csv(path, sep=";", decimal=",", encoding="cp1252", skiprows=[1])
    times = pd.to_datetime(frame["Zeit"], format="%d.%m.%Y %H:%M:%S,%f")
    return _frame(frame, times.to_numpy(), [c for c in frame.columns if c.startswith("S")])


def pandas_iso_csv(path: Path, out: Path) -> Answer:
    import pandas as pd

    frame = pd.read_csv(path)
    times = pd.to_datetime(frame["time"], format="ISO8601")
    return _frame(frame, times.to_numpy(), [c for c in frame.columns if c.startswith("S")])


def mcap_with_json(path: Path, out: Path) -> Answer:
    import pandas as pd
    from mcap.reader import make_reader

    rows, times = [], []
    with path.open("rb") as file:
        for _, _, message in make_reader(file).iter_messages():
            rows.append(json.loads(message.data))
            times.append(message.log_time)
    frame = pd.DataFrame(rows)
    return _frame(frame, np.array(times, np.int64).view("datetime64[ns]"))


def _excel(path: Path, engine: Any) -> Answer:
    import pandas as pd

    frame = pd.read_excel(path, engine=engine)
    return _frame(frame, frame.iloc[:, 0].to_numpy(np.float64), list(frame.columns[1:]))


def pandas_openpyxl(path: Path, out: Path) -> Answer:
    import openpyxl  # noqa: F401

    return _excel(path, "openpyxl")


def pandas_calamine(path: Path, out: Path) -> Answer:
    import python_calamine  # noqa: F401

    return _excel(path, "calamine")


def pandas_parquet(path: Path, out: Path) -> Answer:
    import pandas as pd

    frame = pd.read_parquet(path)
    return _frame(frame, frame["time"].to_numpy(), [c for c in frame.columns if c.startswith("S")])


def scipy_mat(path: Path, out: Path) -> Answer:
    import pandas as pd
    from scipy.io import loadmat

    read = loadmat(path)
    frame = pd.DataFrame({k: v.ravel() for k, v in read.items() if k.startswith("S")})
    return _frame(frame, read["time"].ravel())


def h5py_mat(path: Path, out: Path) -> Answer:
    import h5py
    import pandas as pd

    with h5py.File(path) as file:
        frame = pd.DataFrame({k: v[()].ravel() for k, v in file.items() if k.startswith("S")})
        return _frame(frame, file["time"][()].ravel())


def asammdf_frame(path: Path, out: Path) -> Answer:
    from asammdf import MDF

    with MDF(path) as file:
        frame = file.to_dataframe()
        start = np.datetime64(file.start_time.replace(tzinfo=None), "ns")
    return _frame(frame, start + np.rint(frame.index.to_numpy() * 1e9).astype("timedelta64[ns]"))


def _dlt(rows: Any, out: Path) -> Answer:
    import os

    import dlt
    import duckdb

    out.mkdir(parents=True, exist_ok=True)
    os.environ.update(RUNTIME__DLTHUB_TELEMETRY="false", DATA_WRITER__DISABLE_COMPRESSION="true")
    pipeline = dlt.pipeline(
        "bench",
        pipelines_dir=str(out / "pipelines"),
        dataset_name="bench",
        destination=dlt.destinations.duckdb(str(out / "lab.duckdb")),
    )
    pipeline.run(rows, table_name="log")
    with duckdb.connect(str(out / "lab.duckdb"), read_only=True) as con:
        return _in_duckdb(con, "bench.log", "time")


def dlt_csv(path: Path, out: Path) -> Answer:
    """As dlt's own file reader does it: pandas in chunks."""
    import pandas as pd

    return _dlt(
        (
            piece.assign(time=pd.to_datetime(piece["time"], format="ISO8601"))
            for piece in pd.read_csv(path, chunksize=100_000)
        ),
        out,
    )


def dlt_parquet(path: Path, out: Path) -> Answer:
    import pyarrow.parquet as pq

    return _dlt(pq.ParquetFile(path).iter_batches(), out)
