"""Every format by size: what ours takes to read and to ingest, beside what a user would do without us, in one run.

    uv run python tests/benchmarks/formats.py [--size small|medium|large] [--only tdms,mcap] [--runs 1] [--folder DIR]
    uv run --with asammdf --with 'dlt[duckdb]' --with openpyxl python tests/benchmarks/formats.py --size large
    uv run python tests/benchmarks/formats.py --gigabytes 4 [--only tdms,csv,mcap]     # memory of ingest

"read" takes the whole file through the guard, "ingest" brings it into a store: two layers, calibrated and flagged.
Each run is a process of its own; times are wall times with the interpreter's start and imports (about 0.4 s, which
decides the small sizes), medians of the runs. What a peer gave (count and sum of values, first and last time) must be
what ours gave; the exit code is 1 where it is not, or where a way fails. A target that is not met is said and is no
error: machines differ.
"""

from __future__ import annotations

import argparse
import importlib
import json
import math
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import format_files as files
import format_peers as peers
from measure import Run, machine, middle, python, run, table

MEMORY_MIB = 700
TARGET_MEMORY = f"< {MEMORY_MIB} MiB"
FAILED, OTHER = "FAILED", "OTHER VALUES"


@dataclass(frozen=True)
class Case:
    """One format. rows: by size. peers: way -> (function, what of ours it stands beside, the least ratio wanted).
    source: what a campaign declares. needs: a package without which neither the file nor ours is there."""

    reader: str
    suffix: str
    make: Callable[[Path, int], None]
    rows: tuple[int, int, int]
    columns: int
    peers: Mapping[str, tuple[Callable[[Path, Path], peers.Answer], str, float | None]]
    source: Mapping[str, Any] = field(default_factory=dict)
    needs: str | None = None
    relative: bool = False


_SECONDS = {"header_rows": 1, "time": {"column": 1, "unit": "s"}}
CASES: dict[str, Case] = {
    "tdms": Case(
        "crio",
        ".tdms",
        files.tdms,
        (36_000, 216_000, 864_000),
        40,
        {
            "npTDMS + pandas": (peers.nptdms_pandas, "read", None),
            "npTDMS streaming into DuckDB": (peers.nptdms_duckdb, "ingest", 1.3),
        },
    ),
    "tdms_rows": Case(
        "crio",
        ".tdms",
        files.tdms_rows,
        (3_600, 21_600, 86_400),
        40,
        {"npTDMS + pandas": (peers.nptdms_pandas, "read", 8.0)},
    ),
    "lvm": Case(
        "crio", ".lvm", files.lvm, (20_000, 200_000, 1_000_000), 8, {"pandas read_csv": (peers.pandas_lvm, "read", 1.5)}
    ),
    "control_csv": Case(
        "cnc",
        ".csv",
        files.control_csv,
        (20_000, 200_000, 1_000_000),
        8,
        {"pandas read_csv, to_datetime": (peers.pandas_control_csv, "read", 1.5)},
    ),
    "csv": Case(
        "table",
        ".csv",
        files.iso_csv,
        (20_000, 200_000, 1_000_000),
        8,
        {
            "pandas read_csv, to_datetime": (peers.pandas_iso_csv, "read", 1.5),
            "dlt into DuckDB": (peers.dlt_csv, "ingest", None),
        },
        {"table": {"header_rows": 1}},
    ),
    "mcap": Case(
        "mcap",
        ".mcap",
        files.mcap_json,
        (20_000, 150_000, 450_000),
        8,
        {"mcap reader with json": (peers.mcap_with_json, "read", 4.0)},
    ),
    "xlsx": Case(
        "table",
        ".xlsx",
        files.xlsx,
        (3_000, 20_000, 100_000),
        8,
        {
            "pandas with calamine": (peers.pandas_calamine, "read", None),
            "pandas with openpyxl": (peers.pandas_openpyxl, "read", None),
        },
        {"table": _SECONDS},
        relative=True,
    ),
    "parquet": Case(
        "table",
        ".parquet",
        files.parquet,
        (36_000, 216_000, 864_000),
        40,
        {
            "pandas read_parquet": (peers.pandas_parquet, "read", None),
            "dlt into DuckDB": (peers.dlt_parquet, "ingest", None),
        },
    ),
    "mat5": Case(
        "table",
        ".mat",
        files.mat5,
        (20_000, 200_000, 1_000_000),
        20,
        {"scipy loadmat": (peers.scipy_mat, "read", None)},
        relative=True,
    ),
    "mat73": Case(
        "table",
        ".mat",
        files.mat73,
        (20_000, 200_000, 1_000_000),
        20,
        {"h5py": (peers.h5py_mat, "read", None)},
        relative=True,
        needs="h5py",
    ),
    "mdf4": Case(
        "table",
        ".mf4",
        files.mdf4,
        (36_000, 216_000, 864_000),
        40,
        {"asammdf to_dataframe": (peers.asammdf_frame, "read", None)},
        needs="asammdf",
    ),
}
BIG = {"tdms": 320, "csv": 76, "mcap": 40}  # bytes a row, about


def declared(case: Case) -> dict[str, Any]:
    return {"timezone": "UTC", **case.source}


def read_ours(case: Case, path: Path) -> peers.Answer:
    """Through the guard, block by block; nothing is kept."""
    import numpy as np

    from thermodata.plugin import Block, Source
    from thermodata.reader import reader
    from thermodata.reader.contract.guard import guarded

    values, total, first, last = 0, 0.0, math.inf, -math.inf
    for item in guarded(reader(case.reader), path, Source(**declared(case))):
        if not isinstance(item, Block):
            raise SystemExit(f"{path.name}: {item}")
        first, last = min(first, int(item.t_ns[0])), max(last, int(item.t_ns[-1]))
        for name, column in item.values.items():
            if column.dtype.kind in "iuf" and "S0" <= bare(name)[:2] <= "S9":
                values += column.size
                total += float(np.sum(column, dtype=np.float64))
    return {"values": values, "sum": total, "first": int(first), "last": int(last)}


def bare(name: str) -> str:
    """A signal's name without group, topic and field path."""
    return name.replace(".", "/").rsplit("/", 1)[-1]


def write_campaign(case: Case, path: Path) -> Path:
    """campaign.yaml beside the file, with every column as a channel."""
    from thermodata.plugin import Source
    from thermodata.reader import reader
    from thermodata.reader.contract.guard import described

    said = described(reader(case.reader), path, Source(**declared(case)))
    signals = [s for s in said.signals if "S0" <= bare(s.name)[:2] <= "S9"]
    channels = "\n".join(
        f"  {bare(s.name)[:3]}: {{source: log, signal: {json.dumps(s.name)}, quantity: temperature, unit: degC}}"
        for s in signals
    )
    source = {"reader": case.reader, "files": path.name, **declared(case)}
    campaign = path.with_name("campaign.yaml")
    campaign.write_text(
        f"schema: thermodata/campaign/1\nid: bench\nmachine: {{id: m}}\nsources: {{log: "
        f"{json.dumps(source)}}}\nchannels:\n{channels}\ntests:\n"
        "  - {id: log, kind: other, role: none}\n",
        encoding="utf-8",
    )
    return campaign


def make(name: str, path: Path, rows: int) -> None:
    """The file and its campaign, by a process of its own: what this one holds would count as its children's memory."""
    path.parent.mkdir(parents=True)
    python(Path(__file__), "--case", name, "--way", "make", "--rows", rows, "--folder", path)


def one(name: str, way: str, path: Path) -> Run:
    """One run in a process of its own, into a fresh place."""
    out = path.with_name("out")
    shutil.rmtree(out, ignore_errors=True)
    if way == "ingest":
        # by its module: `uv run --with ...` has no program beside its interpreter
        return run(
            [sys.executable, "-m", "thermodata", "--store", out, "ingest", path.with_name("campaign.yaml"), "--json"]
        )
    return python(Path(__file__), "--case", name, "--way", way, "--folder", path)


def tried(name: str, way: str, path: Path) -> Run | None:
    """one(), or None with what it said where it failed: a format that fails must not hide the others."""
    try:
        return one(name, way, path)
    except subprocess.CalledProcessError as error:
        said = (error.stderr or "").strip().splitlines()[-6:] or ["nothing on stderr", (error.output or "")[-600:]]
        print(f"{name}: {way} FAILED, exit code {error.returncode}\n  " + "\n  ".join(said), file=sys.stderr)
        return None


def same(ours: Mapping[str, Any], other: Mapping[str, Any]) -> bool:
    return (
        ours["values"] == other["values"]
        and math.isclose(ours["sum"], other["sum"], rel_tol=1e-9)
        and all(abs(ours[k] - other[k]) <= 1000 for k in ("first", "last"))
    )  # a microsecond of rounding


def left_out(way: str) -> str | None:
    """Why a way can't run, or None."""
    for package in ("dlt", "asammdf", "h5py", "openpyxl", "calamine"):
        if package in way:
            try:
                importlib.import_module(package.replace("calamine", "python_calamine"))
            except ImportError as error:
                return f"{way}: left out, {error} (uv run --with {package} ...)"
    return None


def measure(name: str, size: str, runs: int, folder: Path) -> list[list[str]]:
    """The rows of one format; a way that fails, or that gives other values than ours, says so in the last column."""
    case = CASES[name]
    if case.needs and (why := left_out(case.needs)):
        print(f"{name}: {why}", file=sys.stderr)
        return []
    rows = case.rows[("small", "medium", "large").index(size)]
    path = folder / name / f"log{case.suffix}"
    make(name, path, rows)
    ways = ["read", "ingest"]
    for way in case.peers:
        if why := left_out(way):
            print(f"{name}: {why}", file=sys.stderr)
        else:
            ways.append(way)
    found: dict[str, list[Run]] = {way: [] for way in ways}
    for number in range(runs):  # in turn, so that a busy machine is as hard on each
        for way, done in found.items():
            if len(done) == number and (it := tried(name, way, path)):
                done.append(it)
                print(f"{name} {size} run {number + 1} {way}: {it.seconds:.1f} s", file=sys.stderr)
    megabytes = path.stat().st_size / 1e6
    shutil.rmtree(path.parent)
    return lines(name, size, case, found, rows * case.columns, megabytes)


def lines(
    name: str, size: str, case: Case, found: Mapping[str, list[Run]], values: int, megabytes: float
) -> list[list[str]]:
    took = {way: middle(done) for way, done in found.items() if done}
    ours = took["read"].answer if "read" in took else None
    made = []
    for way in found:
        start = [
            name,
            f"{size}: {megabytes:.0f} MB, {values / 1e6:.1f} M values",
            way if way in case.peers else f"ours, {way}",
        ]
        if way not in took:
            made.append([*start, "", "", "", "", "", "", "", FAILED])
            continue
        it, ratio, target, met = took[way], "", TARGET_MEMORY, "yes" if took[way].peak_mib < MEMORY_MIB else "NO"
        count = it.answer["samples" if way == "ingest" else "values"]
        if way in case.peers:
            beside, wanted = case.peers[way][1:]
            times = it.seconds / took[beside].seconds if beside in took else math.nan
            # wall times are worth little on a machine that is busy with other things; those of processors hold
            cpu = it.cpu_seconds / took[beside].cpu_seconds if beside in took else math.nan
            ratio = f"{times:.2f} x our {beside} (CPU {cpu:.2f})"
            target, met = (f">= {wanted:g} x", "yes" if times >= wanted else "NO") if wanted is not None else ("", "")
        if count != values or (way in case.peers and (ours is None or not same(ours, it.answer))):
            print(f"{name}: {way} gave {it.answer if way != 'ingest' else count}, ours {ours}", file=sys.stderr)
            met = OTHER
        made.append(
            [
                *start,
                f"{it.seconds:.2f}",
                f"{it.cpu_seconds:.2f}",
                f"{megabytes / it.seconds:.0f}",
                f"{values / it.seconds / 1e6:.1f}",
                f"{it.peak_mib:.0f}",
                ratio,
                target,
                met,
            ]
        )
    return made


def gigabytes(many: float, only: list[str], folder: Path) -> list[list[str]]:
    """Peak memory of ingest on one big file a format."""
    made = []
    for name in only:
        columns = CASES[name].columns
        rows = round(many * 1e9 / BIG[name])
        path = folder / name / f"log{CASES[name].suffix}"
        print(f"{name}: writing {many:g} GB", file=sys.stderr)
        make(name, path, rows)
        size = path.stat().st_size / 1e9
        if (done := tried(name, "ingest", path)) is None:
            continue
        if done.answer["samples"] != rows * columns:
            raise SystemExit(f"{name}: ingest gave {done.answer['samples']} samples of {rows * columns}")
        made.append(
            [
                name,
                f"{size:.2f}",
                f"{rows * columns / 1e6:.0f}",
                f"{done.seconds:.0f}",
                f"{size * 1000 / done.seconds:.0f}",
                f"{done.peak_mib:.0f}",
                TARGET_MEMORY,
                "yes" if done.peak_mib < MEMORY_MIB else "NO",
            ]
        )
        shutil.rmtree(path.parent)
    return made


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--size", choices=("small", "medium", "large"), default="small")
    arguments.add_argument("--only", default="", help="formats, with commas between: " + ", ".join(CASES))
    arguments.add_argument("--runs", type=int, default=1)
    arguments.add_argument("--folder", type=Path, help="where the files go")
    arguments.add_argument("--gigabytes", type=float, help="big files: the memory of ingest only")
    arguments.add_argument("--case", choices=CASES, help=argparse.SUPPRESS)
    arguments.add_argument("--way", help=argparse.SUPPRESS)
    arguments.add_argument("--rows", type=int, help=argparse.SUPPRESS)
    given = arguments.parse_args()
    if given.case:
        case = CASES[given.case]
        path = given.folder
        if given.way == "make":
            case.make(path, given.rows)
            write_campaign(case, path)
        elif given.way == "read":
            print(json.dumps(read_ours(case, path)))
        else:
            print(json.dumps(case.peers[given.way][0](path, path.with_name("out"))))
        return
    only = [w for w in given.only.split(",") if w]
    with tempfile.TemporaryDirectory(dir=given.folder) as name:
        print(machine(), flush=True)
        if given.gigabytes:
            print(
                table(
                    ["format", "GB", "M values", "wall [s]", "MB/s", "peak RSS [MiB]", "target", "met"],
                    gigabytes(given.gigabytes, only or list(BIG), Path(name)),
                )
            )
            return
        rows = [row for each in only or CASES for row in measure(each, given.size, given.runs, Path(name))]
    print(
        table(
            [
                "format",
                "size",
                "way",
                "wall [s]",
                "CPU [s]",
                "MB/s",
                "M values/s",
                "peak RSS [MiB]",
                "ratio",
                "target",
                "met",
            ],
            rows,
        )
    )
    if any(row[-1] in (FAILED, OTHER) for row in rows):
        raise SystemExit(1)


if __name__ == "__main__":
    main()
