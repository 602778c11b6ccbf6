"""How thermodata grows: a campaign of 1,000 tests, a hundred long ones, very wide and very dense files.

    uv run python tests/benchmarks/growth.py [--tests 1000] [--part ingest query ...] [--runs 1]
    uv run python tests/benchmarks/growth.py --against ../before/.venv/bin/python     # another checkout beside it

Each row is measured for both programs in turn, so that a busy machine is as hard on each: wall and processor seconds
and the peak of memory of a process of its own, the interpreter's start included. Ratios of processor seconds tell
more than times. With --against the stores of both are compared: raw and tidy files by their bytes, the catalogue by
its rows without the moments at which they were written.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from subprocess import CalledProcessError
from typing import Any

from growth_files import dense_workbook, folder_of_logs, many_tests, many_values, wide_csv, wide_tdms
from measure import Run, machine, run, table

CATALOGUE = ("campaign", "machine", "source", "channel", "test", "file", "calibration", "quality_event")
MOMENTS = ("added_at", "ingested_at", "path")


@dataclass(frozen=True)
class Program:
    """name: of its column. python: the interpreter of its environment. env: what it is told besides."""

    name: str
    python: Path

    def __call__(self, *words: object) -> Run:
        """A command of thermodata; one that ends with losses or a refusal is measured too."""
        return run([self.python.with_name("thermodata"), *words], ok=(0, 2, 3))

    def say(self, code: str, *words: object) -> Run:
        """A piece of Python that prints JSON."""
        return run([self.python, "-c", code, *words])


@dataclass(frozen=True)
class Row:
    """What was done, how long it should take at most [s], and the medians for each program."""

    what: str
    limit: str
    runs: list[Run]


ASK = """
import json, statistics, sys, time, thermodata
view, query, runs = thermodata.open(sys.argv[1]), sys.argv[2], int(sys.argv[3])
times, answer = [], None
for _ in range(runs + 1):
    begin = time.perf_counter(), time.process_time()
    answer = view.sql(query).fetchall()
    times.append((1000 * (time.perf_counter() - begin[0]), 1000 * (time.process_time() - begin[1])))
print(json.dumps({"first": times[0], "wall": statistics.median(t[0] for t in times[1:]),
                  "cpu": statistics.median(t[1] for t in times[1:]), "answer": repr(sorted(answer))}))
"""
VERIFY = """
import json, sys, time, thermodata
view, query = thermodata.open(sys.argv[1]), sys.argv[2]
view.sql(query)
begin = time.perf_counter(), time.process_time()
said = view.verify(query)
print(json.dumps({"wall": 1000 * (time.perf_counter() - begin[0]), "cpu": 1000 * (time.process_time() - begin[1]),
                  "said": said}))
"""


def ingests(programs: Sequence[Program], folder: Path, tests: int, runs: int) -> Iterator[Row]:
    """First ingest, nothing changed, one file edited; the stores must be equal."""
    many_tests(folder / "many", tests)
    stores = {p.name: folder / f"store-{p.name}" for p in programs}
    size = sum(f.stat().st_size for f in (folder / "many").rglob("*") if f.is_file()) / 1e6
    print(f"{tests} tests of two files, {size:.0f} MB", file=sys.stderr)

    def ingest(program: Program) -> Run:
        return program("--store", stores[program.name], "ingest", folder / "many" / "campaign.yaml", "--json")

    def first(program: Program) -> Run:
        shutil.rmtree(stores[program.name], ignore_errors=True)
        return ingest(program)

    yield measured(f"first ingest of {tests} tests of two files", "45 s", programs, runs, first)
    equal(list(stores.values()))
    yield measured("ingest that changes nothing", "1 s", programs, max(runs, 3), ingest)
    edited = folder / "many" / "raw" / "t00007_nc.csv"

    def edit(program: Program) -> Run:
        # each program sees a file that is new to its store
        text = edited.read_text().splitlines()
        text.append(text[-1].replace(text[-1].split(",")[0], str(int(text[-1].split(",")[0]) + 1)))
        edited.write_text("\n".join(text) + "\n")
        return ingest(program)

    yield measured("ingest after an edit of one file", "2 s", programs, max(runs, 3), edit)
    for program in programs:
        ingest(program)


def queries(programs: Sequence[Program], folder: Path, tests: int, runs: int) -> Iterator[Row]:
    """Means over a hundred tests of 12 h, in a process that has its store open, and what looking at pages costs."""
    many_values(folder / "values", tests)
    stores = {p.name: folder / f"values-{p.name}" for p in programs}
    yield measured(
        f"first ingest of {tests} tests of 12 h at 1 Hz, 8 channels",
        "",
        programs,
        1,
        lambda p: p("--store", stores[p.name], "ingest", folder / "values" / "campaign.yaml", "--json"),
    )
    equal(list(stores.values()))
    for view in ("sample", "temperature"):
        query = f"select test, avg(value) from {view} where channel = 'T3' group by test"
        yield measured(
            f"{view}: mean of a channel in each test",
            "0.1 s",
            programs,
            runs,
            lambda p, q=query: answered(p, stores, q),
        )
        query = f"select avg(value) from {view} where channel = 'T3'"
        yield measured(
            f"{view}: mean of a channel over all", "0.1 s", programs, runs, lambda p, q=query: answered(p, stores, q)
        )
    for what, query in (
        ("all tests", "select avg(value) from sample where channel = 'T3'"),
        ("one test", "select avg(value) from sample where channel = 'T3' and test = 't007'"),
    ):
        yield measured(
            f"page checksums of {what}, one channel", "", programs, runs, lambda p, q=query: verified(p, stores, q)
        )


def answered(program: Program, stores: dict[str, Path], query: str) -> Run:
    """The median of a query that is asked ten times; processor time is that of all threads."""
    done = program.say(ASK, stores[program.name], query, 10)
    answer = done.answer
    return Run(answer["wall"] / 1000, done.peak_mib, json.dumps(answer["answer"]), answer["cpu"] / 1000)


def verified(program: Program, stores: dict[str, Path], query: str) -> Run:
    done = program.say(VERIFY, stores[program.name], query)
    answer = done.answer
    if answer["said"]:
        print(f"{program.name}: {answer['said']}", file=sys.stderr)
    return Run(answer["wall"] / 1000, done.peak_mib, json.dumps(None), answer["cpu"] / 1000)


def previews(programs: Sequence[Program], folder: Path, tests: int, runs: int) -> Iterator[Row]:
    """Files that ask for much: 100,000 channels; a workbook that unpacks to a hundred times its size."""
    folder.mkdir(exist_ok=True)
    for what, limit, make, name in (
        ("100,000 channels (TDMS)", "10 s, 400 MiB", wide_tdms, "wide.tdms"),
        ("100,000 columns (CSV)", "10 s, 400 MiB", wide_csv, "wide.csv"),
        ("a workbook of 20 sheets of a million rows", "5 s", dense_workbook, "dense.xlsx"),
    ):
        make(folder / name)
        print(f"{name}: {(folder / name).stat().st_size / 1e6:.1f} MB", file=sys.stderr)
        yield measured(
            f"preview of {what}", limit, programs, runs, lambda p, n=name: p("preview", folder / n, "--json")
        )


def drafts(programs: Sequence[Program], folder: Path, tests: int, runs: int) -> Iterator[Row]:
    """`init` of 43 files of 4.9 MB."""
    folder_of_logs(folder / "logs")

    def init(program: Program) -> Run:
        (folder / "logs" / "campaign.yaml").unlink(missing_ok=True)
        (folder / "logs" / "model.yaml").unlink(missing_ok=True)
        return program("init", folder / "logs", "--json")

    yield measured("init of 43 files, 4.9 MB", "2 s", programs, max(runs, 3), init)


PARTS: dict[str, Callable[[Sequence[Program], Path, int, int], Iterator[Row]]] = {
    "ingest": ingests,
    "query": queries,
    "preview": previews,
    "init": drafts,
}


def measured(what: str, limit: str, programs: Sequence[Program], runs: int, do: Callable[[Program], Run]) -> Row:
    """Medians of the runs of each program, which take turns."""
    found: dict[str, list[Run]] = {p.name: [] for p in programs}
    for _ in range(runs):
        for program in programs:
            try:
                found[program.name].append(do(program))
            except CalledProcessError as error:
                raise SystemExit(f"{program.name}: {what}: {error.stderr[-2000:]}") from error
    row = Row(what, limit, [middle(found[p.name]) for p in programs])
    for program, one in zip(programs, row.runs, strict=True):
        print(
            f"{program.name}: {what}: {one.seconds:.2f} s wall, {one.cpu_seconds:.2f} s processor, "
            f"{one.peak_mib:.0f} MiB",
            file=sys.stderr,
            flush=True,
        )
    return row


def middle(runs: Sequence[Run]) -> Run:
    return Run(
        median(r.seconds for r in runs),
        max(r.peak_mib for r in runs),
        runs[-1].out,
        median(r.cpu_seconds for r in runs),
    )


def equal(stores: Sequence[Path]) -> None:
    """SystemExit where two stores do not hold the same: files by their bytes, the catalogue by its rows."""
    for other in stores[1:]:
        for one, two in zip(digests(stores[0]), digests(other), strict=True):
            if one != two:
                raise SystemExit(f"{stores[0].name} and {other.name} differ: {one} and {two}")
    print(f"{len(stores)} stores are equal" if len(stores) > 1 else "one store", file=sys.stderr)


def digests(store: Path) -> list[tuple[str, str]]:
    """What a store holds: (name, digest) of each Parquet file and each table."""
    import duckdb

    found = [
        (str(p.relative_to(store)), hashlib.sha256(p.read_bytes()).hexdigest())
        for p in sorted(store.rglob("*.parquet"))
    ]
    with duckdb.connect(str(store / "catalog.duckdb"), read_only=True) as con:
        for name in CATALOGUE:
            left = ", ".join(
                f'"{c}"'
                for (c,) in con.execute(f"select column_name from (describe {name})").fetchall()
                if c not in MOMENTS
            )
            rows = sorted(map(repr, con.execute(f"select {left} from {name}").fetchall()))
            found.append((name, hashlib.sha256(repr(rows).encode()).hexdigest()))
    return found


def shown(rows: Sequence[Row], programs: Sequence[Program]) -> str:
    """A Markdown table; ratios are of the first program to the last."""
    head = ["what", "at most"]
    for program in programs:
        head += [f"{program.name}: wall [s]", "processor [s]", "peak [MiB]"]
    head += ["wall", "processor"] if len(programs) > 1 else []
    lines: list[list[Any]] = []
    for row in rows:
        line: list[Any] = [row.what, row.limit]
        for one in row.runs:
            line += [f"{one.seconds:.2f}", f"{one.cpu_seconds:.2f}", f"{one.peak_mib:.0f}"]
        if len(programs) > 1:
            a, b = row.runs[0], row.runs[-1]
            line += [f"{a.seconds / b.seconds:.1f} x", f"{a.cpu_seconds / b.cpu_seconds:.1f} x"]
        lines.append(line)
    return table(head, lines)


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--tests", type=int, default=1000)
    arguments.add_argument("--long", type=int, default=100, help="tests of 12 h")
    arguments.add_argument("--part", nargs="+", choices=PARTS, default=list(PARTS))
    arguments.add_argument("--runs", type=int, default=1)
    arguments.add_argument("--against", type=Path, help="the Python of another version's environment")
    arguments.add_argument("--folder", type=Path)
    given = arguments.parse_args()
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # or every process compiles itself anew
    programs = [Program("now", Path(sys.executable))]
    if given.against:
        programs.insert(0, Program("before", Path(os.path.abspath(given.against))))
    rows: list[Row] = []
    print(machine(), flush=True)
    for part in given.part:
        with tempfile.TemporaryDirectory(dir=given.folder) as name:
            place = Path(name)
            rows += PARTS[part](programs, place, given.long if part == "query" else given.tests, given.runs)
    print(shown(rows, programs))


if __name__ == "__main__":
    main()
