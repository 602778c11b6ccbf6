"""How thermodata grows: a campaign of 1,000 tests, a hundred long ones, very wide and very dense files.

    uv run python tests/benchmarks/growth.py [--tests 1000] [--only ingest query ...] [--runs 1]
    uv run python tests/benchmarks/growth.py --against ../before/.venv/bin/python     # another checkout beside it
    uv run python tests/benchmarks/growth.py --folder ../growth                       # goes on where it was ended

Each row is measured for both programs in turn, so that a busy machine is as hard on each: wall and processor seconds
and the peak of memory of a process of its own, the interpreter's start included. Ratios of processor seconds tell
more than times. A row is printed once it is measured. With --folder all that was made and measured is kept there: the
same again measures what is not in its `measured.jsonl` yet (delete that to measure anew). With --against the stores of
both are compared: raw and tidy files by their bytes, the catalogue by its rows without the moments at which they were
written.
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
from contextlib import ExitStack
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from statistics import median
from subprocess import CalledProcessError

from growth_files import dense_workbook, folder_of_logs, many_tests, many_values, wide_csv, wide_tdms
from measure import Run, machine, run

CATALOGUE = ("campaign", "machine", "source", "channel", "test", "file", "calibration", "quality_event")
MOMENTS = ("added_at", "ingested_at", "path")


@dataclass(frozen=True)
class Program:
    """name: of its column. python: the interpreter of its environment. env: what it is told besides."""

    name: str
    python: Path

    def __call__(self, *words: object) -> Run:
        """A command of thermodata; one that ends with losses or a refusal, which says nothing, is measured too."""
        return run([self.python.with_name("thermodata"), *words], ok=(0, 2, 3))

    def say(self, code: str, *words: object) -> Run:
        """A piece of Python that prints JSON."""
        return run([self.python, "-c", code, *words])


@dataclass(frozen=True)
class Row:
    """What was done, how much it should take at most, the medians for each program (None: it refuses), and the load of
    the machine behind it."""

    what: str
    limit: str
    runs: list[Run | None]
    load: float


class Bench:
    """Measures row after row. folder: of what is made, with `measured.jsonl` of the rows that are there already."""

    def __init__(self, programs: Sequence[Program], folder: Path, runs: int) -> None:
        self.programs, self.folder, self.runs = programs, folder, runs
        self._kept = folder / "measured.jsonl"
        self._known = {}
        for line in self._kept.read_text().splitlines() if self._kept.exists() else ():
            row = json.loads(line)
            self._known[row["what"], tuple(row["programs"])] = Row(
                row["what"], row["limit"], [None if r is None else Run(**r) for r in row["runs"]], row["load"]
            )

    def made(self, name: str, make: Callable[[Path], None]) -> Path:
        """A file or folder, made unless it is there; half of one is not."""
        place, part = self.folder / name, self.folder / f"{name}.part"
        if not place.exists():
            shutil.rmtree(part, ignore_errors=True)
            part.unlink(missing_ok=True)
            make(part)
            part.rename(place)
        return place

    def row(self, what: str, limit: str, do: Callable[[Program], Run], runs: int | None = None) -> Row:
        """Medians of the runs of each program, which take turns; kept ones where there are."""
        key = what, tuple(str(p.python) for p in self.programs)
        if key not in self._known:
            found: dict[str, list[Run]] = {p.name: [] for p in self.programs}
            for _ in range(runs or self.runs):
                for program in self.programs:
                    try:
                        found[program.name].append(do(program))
                    except CalledProcessError as error:
                        raise SystemExit(f"{program.name}: {what}: {error.stderr[-2000:]}") from error
            medians = [middle(found[p.name]) for p in self.programs]
            row = Row(what, limit, medians, round(os.getloadavg()[0], 1))
            self._known[key] = row
            with self._kept.open("a") as file:
                file.write(json.dumps(asdict(row) | {"programs": key[1]}) + "\n")
        return self._known[key]


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


def ingests(bench: Bench, tests: int) -> Iterator[Row]:
    """First ingest, nothing changed, one file edited; the stores must be equal."""
    folder = bench.made(f"many-{tests}", lambda place: many_tests(place, tests))
    stores = {p.name: bench.folder / f"store-{tests}-{p.name}" for p in bench.programs}
    size = sum(f.stat().st_size for f in folder.rglob("*") if f.is_file()) / 1e6

    def ingest(program: Program) -> Run:
        return program("--store", stores[program.name], "ingest", folder / "campaign.yaml", "--json")

    def first(program: Program) -> Run:
        shutil.rmtree(stores[program.name], ignore_errors=True)
        return ingest(program)

    yield bench.row(f"first ingest of {tests} tests of two files, {size:.0f} MB", f"{45 * tests / 1000:.2g} s", first)
    equal(list(stores.values()))
    yield bench.row(f"ingest of {tests} tests that changes nothing", "1 s", ingest, max(bench.runs, 3))
    edited = folder / "raw" / "t00007_nc.csv"

    def edit(program: Program) -> Run:
        # each program sees a file that is new to its store
        text = edited.read_text().splitlines()
        text.append(text[-1].replace(text[-1].split(",")[0], str(int(text[-1].split(",")[0]) + 1)))
        edited.write_text("\n".join(text) + "\n")
        return ingest(program)

    yield bench.row(f"ingest of {tests} tests after an edit of one file", "2 s", edit, max(bench.runs, 3))
    for program in bench.programs:
        ingest(program)
    equal(list(stores.values()))


def queries(bench: Bench, tests: int) -> Iterator[Row]:
    """Means over a hundred tests of 12 h, in a process that has its store open, and what looking at pages costs."""
    folder = bench.made(f"values-{tests}", lambda place: many_values(place, tests))
    stores = {p.name: bench.folder / f"values-{tests}-{p.name}" for p in bench.programs}

    def first(program: Program) -> Run:
        shutil.rmtree(stores[program.name], ignore_errors=True)
        return program("--store", stores[program.name], "ingest", folder / "campaign.yaml", "--json")

    yield bench.row(f"first ingest of {tests} tests of 12 h at 1 Hz, 8 channels", "", first, 1)
    equal(list(stores.values()))
    for view in ("sample", "temperature"):
        for what, query in (
            (
                "mean of a channel in each test",
                f"select test, avg(value) from {view} where channel = 'T3' group by test",
            ),
            ("mean of a channel over all", f"select avg(value) from {view} where channel = 'T3'"),
        ):
            ask = partial(answered, stores=stores, query=query)
            yield bench.row(f"{view}, {tests} tests of 12 h: {what}", "0.1 s", ask)
    for what, query in (
        ("all tests", "select avg(value) from sample where channel = 'T3'"),
        ("one test", "select avg(value) from sample where channel = 'T3' and test = 't007'"),
    ):
        yield bench.row(f"page checksums of {what}, one channel", "", partial(verified, stores=stores, query=query))


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


def previews(bench: Bench, tests: int) -> Iterator[Row]:
    """Files that ask for much: very many channels; a workbook that unpacks to a hundred times its size."""
    for what, limit, make, name in (
        ("100,000 channels (TDMS)", "10 s, 400 MiB", wide_tdms, "wide.tdms"),
        ("2,500 columns (CSV)", "10 s, 400 MiB", wide_csv, "wide.csv"),
        ("a workbook of 20 sheets of a million rows", "5 s", dense_workbook, "dense.xlsx"),
    ):
        file = bench.made(name, make)
        size = f"{file.stat().st_size / 1e6:.1f} MB"
        yield bench.row(f"preview of {what}, {size}", limit, lambda p, f=file: p("preview", f, "--json"))


def drafts(bench: Bench, tests: int) -> Iterator[Row]:
    """`init` of 43 files of 4.9 MB."""
    folder = bench.made("logs", folder_of_logs)

    def init(program: Program) -> Run:
        (folder / "campaign.yaml").unlink(missing_ok=True)
        (folder / "model.yaml").unlink(missing_ok=True)
        return program("init", folder, "--json")

    yield bench.row("init of 43 files, 4.9 MB", "2 s", init, max(bench.runs, 3))


# quick ones first, so that there is something to read
PARTS: dict[str, Callable[[Bench, int], Iterator[Row]]] = {
    "init": drafts,
    "preview": previews,
    "ingest": ingests,
    "query": queries,
}


def middle(runs: Sequence[Run]) -> Run | None:
    """Medians of the times, and the largest of the peaks; None where nothing was answered."""
    if not all(r.out.strip() for r in runs):
        return None
    return Run(median(r.seconds for r in runs), max(r.peak_mib for r in runs), "", median(r.cpu_seconds for r in runs))


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


def head(programs: Sequence[Program]) -> str:
    """The first lines of a Markdown table; ratios are of the first program to the last."""
    cells = ["what", "at most"]
    for program in programs:
        cells += [f"{program.name}: wall [s]", "processor [s]", "peak [MiB]"]
    cells += ["wall", "processor"] if len(programs) > 1 else []
    return "\n".join("| " + " | ".join(line) + " |" for line in ([*cells, "load"], ["---"] * (len(cells) + 1)))


def shown(row: Row) -> str:
    """A line of the table."""
    cells = [row.what, row.limit]
    for one in row.runs:
        cells += (
            ["refused", "", ""]
            if one is None
            else [f"{one.seconds:.2f}", f"{one.cpu_seconds:.2f}", f"{one.peak_mib:.0f}"]
        )
    if len(row.runs) > 1:
        a, b = row.runs[0], row.runs[-1]
        both = a is not None and b is not None
        cells += [f"{a.seconds / b.seconds:.1f} x", f"{a.cpu_seconds / b.cpu_seconds:.1f} x"] if both else ["", ""]
    return "| " + " | ".join([*cells, f"{row.load:.0f}"]) + " |"


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--tests", type=int, default=1000)
    arguments.add_argument("--long", type=int, default=100, help="tests of 12 h")
    arguments.add_argument("--only", nargs="+", choices=PARTS, default=list(PARTS), help="these parts")
    arguments.add_argument("--runs", type=int, default=1)
    arguments.add_argument("--against", type=Path, help="the Python of another version's environment")
    arguments.add_argument("--folder", type=Path, help="where all that is made and measured is kept, to go on from")
    given = arguments.parse_args()
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # or every process compiles itself anew
    programs = [Program("now", Path(sys.executable))]
    if given.against:
        programs.insert(0, Program("before", Path(os.path.abspath(given.against))))
    for program in programs:
        program("--help")  # compiles what the first row would
    with ExitStack() as stack:
        folder = given.folder or Path(stack.enter_context(tempfile.TemporaryDirectory()))
        folder.mkdir(parents=True, exist_ok=True)
        bench = Bench(programs, folder, given.runs)
        print(f"{machine()}\n\n{head(programs)}", flush=True)
        for part in given.only:
            for row in PARTS[part](bench, given.long if part == "query" else given.tests):
                print(shown(row), flush=True)


if __name__ == "__main__":
    main()
