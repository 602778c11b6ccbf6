"""Ingest of a day at 10 Hz with 40 channels (34.6 million float64 values, one TDMS file) against npTDMS and DuckDB.

    uv run python tests/benchmarks/ingest.py [--runs 3] [--hours 24] [--folder DIR]
    uv run python tests/benchmarks/ingest.py --gigabytes 4 [--format tdms csv] [--channels 40] [--folder DIR]

thermodata makes two layers of it (raw; calibrated with flags) and a catalogue. The others only bring the values
into something that can be queried: no calibration, no flags, no metadata, no record of the file.
Each run is a process of its own; times are wall times with the interpreter's start, medians of the runs; processor
times tell more where other programs keep the machine busy.

With --gigabytes one file of that size for each format is brought into a store (1 kHz): what matters is that the peak
of memory does not grow with the file.
"""

from __future__ import annotations

import argparse
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from measure import PROGRAM, Run, machine, middle, python, run, table

RATE_HZ, CHANNELS, CHUNK_S = 10, 40, 600
WAYS = {
    "nptdms_parquet": "npTDMS + pandas, a Parquet file for each channel",
    "nptdms_table": "npTDMS + pandas, a DuckDB table for each channel",
    "nptdms_stream": "npTDMS in chunks -> Arrow -> one wide DuckDB table",
}


def chunks(rows: int, rate_hz: float, channels: int) -> Iterator[tuple[int, list[Any]]]:
    """(first row, the values of each channel) of what a logger writes at once: slow swings and fresh noise."""
    import numpy as np

    rng = np.random.default_rng(0)
    n = CHUNK_S * RATE_HZ
    for first in range(0, rows, n):
        row = np.arange(first, min(rows, first + n))
        t_h = row / rate_hz / 3600
        yield first, [20 + 5 * np.sin(t_h / (i + 1)) + 0.01 * rng.standard_normal(len(row)) for i in range(channels)]


def generate(folder: Path, rows: int, rate_hz: float = RATE_HZ, channels: int = CHANNELS, kind: str = "tdms") -> None:
    """raw/day.tdms (a segment every 6,000 rows) or raw/day.csv, as a logger writes it, and campaign.yaml."""
    (folder / "raw").mkdir(parents=True)
    {"tdms": write_tdms, "csv": write_csv}[kind](folder / "raw" / f"day.{kind}", rows, rate_hz, channels)
    reader, prefix = ("crio", "Log/") if kind == "tdms" else ("table", "")
    listed = "\n".join(
        f"  T{i:02d}: {{source: daq, signal: {prefix}S{i:02d}, quantity: temperature, unit: degC}}"
        for i in range(channels)
    )
    (folder / "campaign.yaml").write_text(
        "schema: thermodata/campaign/1\nid: day\nmachine: {id: m}\n"
        f"sources: {{daq: {{reader: {reader}, files: 'raw/{{test}}.{kind}'}}}}\n"
        f"channels:\n{listed}\ntests:\n  - {{id: day, kind: other, role: none}}\n",
        encoding="utf-8",
    )


def write_tdms(path: Path, rows: int, rate_hz: float, channels: int) -> None:
    import numpy as np
    from nptdms import ChannelObject, TdmsWriter

    start = {
        "wf_start_time": np.datetime64("2026-03-02T06:00:00"),
        "wf_increment": 1 / rate_hz,
        "wf_start_offset": 0.0,
        "unit_string": "degC",
    }
    with TdmsWriter(str(path)) as writer:
        for _, values in chunks(rows, rate_hz, channels):
            writer.write_segment([ChannelObject("Log", f"S{i:02d}", x, start) for i, x in enumerate(values)])


def write_csv(path: Path, rows: int, rate_hz: float, channels: int) -> None:
    import numpy as np
    import pyarrow as pa
    from pyarrow import csv

    plain = csv.WriteOptions(include_header=False)
    with path.open("wb") as out:
        out.write(("Time [s]," + ",".join(f"S{i:02d}" for i in range(channels)) + "\n").encode())
        for first, values in chunks(rows, rate_hz, channels):
            t = np.round((first + np.arange(len(values[0]))) / rate_hz, 6)
            csv.write_csv(pa.table({"t": t, **{f"S{i:02d}": np.round(x, 4) for i, x in enumerate(values)}}), out, plain)


def nptdms_parquet(tdms: Path, out: Path) -> int:
    from nptdms import TdmsFile

    out.mkdir()
    count = 0
    with TdmsFile.open(tdms) as file:
        for channel in file["Log"].channels():
            frame = channel.as_dataframe(time_index=True, absolute_time=True)
            frame.columns = [channel.name]
            frame.to_parquet(out / f"{channel.name}.parquet")
            count += len(frame)
    return count


def nptdms_table(tdms: Path, out: Path) -> int:
    import duckdb
    from nptdms import TdmsFile

    out.mkdir()
    count = 0
    with TdmsFile.open(tdms) as file, duckdb.connect(str(out / "day.duckdb")) as con:
        for channel in file["Log"].channels():
            frame = channel.as_dataframe(time_index=True, absolute_time=True)
            frame.columns = ["value"]
            frame = frame.rename_axis("t").reset_index()
            con.register("frame", frame)
            con.execute(f"create table {channel.name} as select * from frame")
            con.unregister("frame")
            count += len(frame)
    return count


def nptdms_stream(tdms: Path, out: Path) -> int:
    import duckdb
    import numpy as np
    import pyarrow as pa
    from nptdms import TdmsFile

    out.mkdir()
    rows = columns = 0
    with TdmsFile.open(tdms) as file, duckdb.connect(str(out / "day.duckdb")) as con:
        start = np.datetime64(file["Log"].channels()[0].properties["wf_start_time"], "ns")
        for chunk in file.data_chunks():
            values = {c.name: c[:] for c in chunk["Log"].channels()}
            n, columns = len(next(iter(values.values()))), len(values)
            t = start + ((rows + np.arange(n)) * (1_000_000_000 // RATE_HZ)).astype("timedelta64[ns]")
            piece = pa.table({"t": t, **values})
            con.register("piece", piece)
            con.execute("insert into day select * from piece" if rows else "create table day as select * from piece")
            con.unregister("piece")
            rows += n
    return rows * columns


def large(folder: Path, gigabytes: float, channels: int, kinds: Sequence[str]) -> None:
    """A table: one file of that size for each format, what it took to bring it in, and the peak of memory."""
    found = []
    for kind in kinds:
        with tempfile.TemporaryDirectory(dir=folder) as name:
            place = Path(name) / "data"
            # of text, a value takes 8 characters with its comma
            generate(place, round(gigabytes * 1e9 / 8 / channels), 1000, channels, kind)
            file_mb = size_mb(place / "raw")
            print(f"{kind}: {file_mb / 1000:.1f} GB in one file", file=sys.stderr)
            done, store_mb = one("thermodata", place)
            samples = done.answer["samples"]
            found.append(
                [
                    kind,
                    f"{file_mb / 1000:.2f}",
                    f"{samples / 1e6:.0f}",
                    f"{done.seconds:.0f}",
                    f"{done.cpu_seconds:.0f}",
                    f"{file_mb / done.seconds:.0f}",
                    f"{done.peak_mib:.0f}",
                    f"{store_mb / 1000:.2f}",
                ]
            )
    print(
        table(
            [
                "format",
                "file [GB]",
                "million values",
                "wall [s]",
                "processor [s]",
                "MB/s",
                "peak RSS [MiB]",
                "store [GB]",
            ],
            found,
        )
    )


def size_mb(path: Path) -> float:
    return sum(p.stat().st_size for p in path.rglob("*") if p.is_file()) / 1e6


def one(way: str, folder: Path) -> tuple[Run, float]:
    """One run into a fresh place; its size on disk [MB]."""
    out = folder / "out"
    shutil.rmtree(out, ignore_errors=True)
    if way == "thermodata":
        done = run([PROGRAM, "--store", out, "ingest", folder / "campaign.yaml", "--json"])
    else:
        done = python(Path(__file__), "--way", way, "--folder", folder)
    return done, size_mb(out)


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--runs", type=int, default=3)
    arguments.add_argument("--hours", type=float, default=24.0)
    arguments.add_argument("--folder", type=Path)
    arguments.add_argument("--way", choices=WAYS, help=argparse.SUPPRESS)
    arguments.add_argument("--gigabytes", type=float)
    arguments.add_argument("--format", nargs="+", choices=("tdms", "csv"), default=["tdms"])
    arguments.add_argument("--channels", type=int, default=CHANNELS)
    given = arguments.parse_args()
    if given.way:
        print(globals()[given.way](given.folder / "raw" / "day.tdms", given.folder / "out"))
        return
    if given.gigabytes:
        print(machine(), flush=True)
        large(given.folder, given.gigabytes, given.channels, given.format)
        return
    values = round(given.hours * 3600 * RATE_HZ) * CHANNELS
    with tempfile.TemporaryDirectory(dir=given.folder) as name:
        folder = Path(name) / "data"
        generate(folder, round(given.hours * 3600 * RATE_HZ))
        print(f"{machine()}; {values / 1e6:.1f} million values, file of {size_mb(folder / 'raw'):.0f} MB", flush=True)
        # one after the other in each round, so that a busy machine is as hard on each
        found: dict[str, list[tuple[Run, float]]] = {way: [] for way in ("thermodata", *WAYS)}
        for round_ in range(given.runs):
            for way, runs in found.items():
                runs.append(one(way, folder))
                print(f"run {round_ + 1} {way}: {runs[-1][0].seconds:.1f} s", file=sys.stderr)
        samples = found["thermodata"][-1][0].answer["samples"]
        if samples != values:
            raise SystemExit(f"ingest gave {samples} samples of {values}")
    ours = middle([r for r, _ in found["thermodata"]])
    rows = []
    for way, runs in found.items():
        it = middle([r for r, _ in runs])
        rows.append(
            [
                WAYS.get(way, "thermodata ingest"),
                f"{it.seconds:.1f}",
                f"{it.seconds / ours.seconds:.2f}",
                f"{it.cpu_seconds:.1f}",
                f"{it.cpu_seconds / ours.cpu_seconds:.2f}",
                f"{values / it.seconds / 1e6:.1f}",
                f"{it.peak_mib:.0f}",
                f"{it.peak_mib / ours.peak_mib:.2f}",
                f"{runs[-1][1]:.0f}",
            ]
        )
    print(
        table(
            [
                "way",
                "wall [s]",
                "ratio",
                "processor [s]",
                "ratio",
                "million values/s",
                "peak RSS [MiB]",
                "ratio",
                "on disk [MB]",
            ],
            rows,
        )
    )


if __name__ == "__main__":
    main()
