"""Each fast path of the readers beside the plain way that it stands in for: equal on every file of a corpus, and how
much faster.

    uv run python tests/benchmarks/fast_paths.py [--only lvm] [--runs 3]        # with times, on a middling file
    uv run python tests/benchmarks/fast_paths.py --check                        # equality only, as the tests run it

The corpus: the seeds of the fuzzed formats, their first mutations (damaged files must be read the same too), and a
file of the benchmark. "acted" counts parts that the fast path read, "fell back" those that it left to the plain way.
For TDMS the plain way is npTDMS itself, on whole files. The exit code is 1 where a file differs or a fast path never
acts. A fast path stands only where it is 2 times as fast or more.
"""

from __future__ import annotations

import argparse
import importlib
import json
import random
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from functools import reduce
from pathlib import Path
from typing import Any
from unittest.mock import patch

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(Path(__file__).parent)]

import formats  # noqa: E402
from measure import machine, python, table  # noqa: E402

MUTATIONS, ROWS = 40, {"mcap": 20_000, "tdms": 36_000}


@dataclass(frozen=True)
class FastPath:
    """where: module and attribute that reads a part fast. off: what it does when it leaves the part to the plain way
    ("none": returns None, "false": returns False, or the name of the module's exception to raise).
    seeds: modules in tests/fuzz/formats. case: of the benchmark. small: constants of the module that keep small
    files from it, and what they are here, so that the corpus reaches it."""

    where: tuple[str, str]
    off: str
    seeds: tuple[str, ...]
    case: str
    small: tuple[tuple[str, int], ...] = ()


FAST: dict[str, FastPath] = {
    "control csv": FastPath(
        ("thermodata.reader.text.rows.typed", "_typed"), "none", ("cnc_csv", "trace_csv"), "control_csv"
    ),
    "lvm": FastPath(("thermodata.reader.text.rows.typed", "_typed"), "none", ("lvm",), "lvm"),
    "csv": FastPath(("thermodata.reader.text.rows.typed", "_typed"), "none", ("table_csv",), "csv"),
    "csv as text": FastPath(
        ("thermodata.reader.text.rows.typed", "_as_text"), "none", ("table_csv", "cnc_csv", "lvm"), "csv"
    ),
    "mcap json": FastPath(
        ("thermodata_reader_mcap.encodings.json.arrow", "_by_arrow"),
        "_OddError",
        ("mcap_json",),
        "mcap",
        (("_SMALL", 1),),
    ),
}


@dataclass
class Count:
    acted: int = 0
    fell_back: int = 0


@contextmanager
def plain(fast: FastPath) -> Iterator[None]:
    """The fast path leaves everything to the plain way."""
    module = importlib.import_module(fast.where[0])

    def leave(*_: Any, **__: Any) -> Any:
        if fast.off in ("none", "false"):
            return None if fast.off == "none" else False
        raise getattr(module, fast.off)

    with patch(".".join(fast.where), leave):
        yield


@contextmanager
def counted(fast: FastPath) -> Iterator[Count]:
    """The fast path as it is, without the sizes below which it is not taken; counts what it did."""
    module = importlib.import_module(fast.where[0])
    real = reduce(getattr, fast.where[1].split("."), module)
    count = Count()
    left = () if fast.off in ("none", "false") else (getattr(module, fast.off),)

    def whole(*words: Any, **more: Any) -> Any:
        try:
            found = real(*words, **more)
        except left:
            count.fell_back += 1
            raise
        if found is None or found is False:
            count.fell_back += 1
        elif isinstance(found, Iterator):
            return stepwise(found)
        else:
            count.acted += 1
        return found

    def stepwise(found: Iterator[Any]) -> Iterator[Any]:
        try:
            for item in found:
                count.acted += 1
                yield item
        except left:
            count.fell_back += 1
            raise

    with ExitStack() as stack:
        stack.enter_context(patch(".".join(fast.where), whole))
        for name, least in fast.small:
            stack.enter_context(patch(f"{fast.where[0]}.{name}", least))
        yield count


def corpus(names: tuple[str, ...], case: str, folder: Path, mutations: int) -> Iterator[tuple[str, Path, Any]]:
    """(what, path, source) of every file; the path is written anew each time."""
    from thermodata.plugin import Source

    for name in names:
        try:
            module = importlib.import_module(f"tests.fuzz.formats.{name}")
        except ModuleNotFoundError as error:
            if error.name != f"tests.fuzz.formats.{name}":
                raise
            print(f"no seeds of {name}", file=sys.stderr)
            continue
        seeds = module.seeds()
        for seed in seeds:
            path = folder / seed.name
            path.write_bytes(seed.data)
            yield f"{name} {seed.name}", path, seed.source
        for number in range(mutations):
            seed = seeds[number % len(seeds)]
            path = folder / seed.name
            path.write_bytes(module.mutate(seed, random.Random(f"0:{number}")).data)
            yield f"{name} {seed.name}, mutation {number}", path, seed.source
    entry = formats.CASES[case]
    path = folder / f"bench{entry.suffix}"
    entry.make(path, 2000)
    yield f"benchmark {case}", path, Source(**formats.declared(entry))


@dataclass
class Result:
    files: int = 0
    different: list[str] = field(default_factory=list)
    count: Count = field(default_factory=Count)


def reading(reader: str, path: Path, source: Any) -> Any:
    """All that the reader gives, or the first line of its refusal."""
    from thermodata.errors import ThermodataError
    from thermodata.reader import reader as named
    from thermodata.testing.reader import load

    try:
        return load(named(reader), path, source)
    except ThermodataError as error:
        return error.what


def beside_plain(fast: FastPath, folder: Path, mutations: int) -> Result:
    """Fast and plain reading of every file of the corpus."""
    from thermodata.testing.reader.case import Data, difference

    result = Result()
    reader = formats.CASES[fast.case].reader
    for what, path, source in corpus(fast.seeds, fast.case, folder, mutations):
        with counted(fast) as count:
            quick = reading(reader, path, source)
        with plain(fast):
            careful = reading(reader, path, source)
        result.files += 1
        result.count.acted += count.acted
        result.count.fell_back += count.fell_back
        if isinstance(quick, Data) and isinstance(careful, Data):
            differs = difference(quick, careful)
            said = [[(x.from_ns, x.to_ns, x.reason) for x in data.losses] for data in (quick, careful)]
            if differs is None and said[0] != said[1]:
                differs = f"losses {said[0][:2]} and {said[1][:2]}"
        else:
            alike = type(quick) is type(careful) and quick == careful
            differs = None if alike else f"{quick!r:.80} and {careful!r:.80}"
        if differs is not None:
            result.different.append(f"{what}: {differs}")
    return result


def beside_nptdms(folder: Path) -> Result:
    """Our walk over a TDMS file and npTDMS, on whole files that npTDMS reads: raw values of every channel."""
    import numpy as np
    from nptdms import TdmsFile

    from thermodata.testing.reader.case import Data

    result = Result()
    for what, path, source in corpus(("tdms",), "tdms", folder, mutations=0):
        ours = reading("crio", path, source)
        try:
            with TdmsFile.open(path) as file:
                theirs = {
                    f"{g.name}/{c.name}": np.asarray(c.read_data(scaled=False))
                    for g in file.groups()
                    for c in g.channels()
                    if len(c)
                }
        except Exception as error:  # npTDMS stumbles over files that are none of its own fault
            result.count.fell_back += 1
            print(f"{what}: npTDMS does not read it: {error!r:.80}", file=sys.stderr)
            continue
        if not isinstance(ours, Data):
            result.different.append(f"{what}: refused: {ours}")
            continue
        result.files += 1
        for (stream, name), column in ours.values.items():
            wanted = theirs.get(name)
            if wanted is None or wanted.dtype.kind not in "iufb" or column.dtype.kind not in "iufb":
                continue
            good = ours.flags[stream, name] == 0
            nan = wanted.dtype.kind == "f"
            if wanted.size != good.sum() or not np.array_equal(column[good], wanted, equal_nan=nan):
                result.different.append(f"{what}: {name}: {good.sum()} values, npTDMS {wanted.size}")
            result.count.acted += 1
    return result


def checked(name: str, folder: Path, mutations: int) -> Result:
    """A fast path beside its plain way, on files that are written into a folder."""
    return beside_plain(FAST[name], folder, mutations) if name in FAST else beside_nptdms(folder)


def seconds(name: str, way: str, runs: int, path: Path) -> float:
    """The least of some readings in processes of their own, without the interpreter's start [s]."""
    return min(float(python(Path(__file__), "--only", name, "--way", way, "--file", path).answer) for _ in range(runs))


def timed(name: str, way: str, path: Path) -> float:
    case = formats.CASES[FAST[name].case]
    with ExitStack() as stack:
        if way == "plain":
            stack.enter_context(plain(FAST[name]))
        formats.read_ours(case, path)  # once for the imports
        begin = time.perf_counter()
        formats.read_ours(case, path)
        return time.perf_counter() - begin


def row(name: str, result: Result, ratio: float | None) -> list[str]:
    equal = f"{result.files - len({d.split(':')[0] for d in result.different})} of {result.files}"
    return [
        name,
        equal,
        str(result.count.acted),
        str(result.count.fell_back),
        "" if ratio is None else f"{ratio:.1f} x",
        "" if ratio is None else ("yes" if ratio >= 2 else "NO"),
    ]


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--only", choices=[*FAST, "tdms"])
    arguments.add_argument("--check", action="store_true", help="equality only")
    arguments.add_argument("--mutations", type=int, default=MUTATIONS, help="damaged files of each format")
    arguments.add_argument("--runs", type=int, default=3)
    arguments.add_argument("--way", choices=("fast", "plain"), help=argparse.SUPPRESS)
    arguments.add_argument("--file", type=Path, help=argparse.SUPPRESS)
    given = arguments.parse_args()
    if given.way:
        print(json.dumps(timed(given.only, given.way, given.file)))
        return 0
    rows, wrong = [], []
    for name in [given.only] if given.only else [*FAST, "tdms"]:
        with tempfile.TemporaryDirectory() as text:
            folder = Path(text)
            result = checked(name, folder, given.mutations)
            ratio = None
            wrong += [f"{name}: {d}" for d in result.different]
            wrong += [f"{name}: never acted"] * (result.count.acted == 0)
            if not given.check:
                case = formats.CASES[FAST[name].case if name in FAST else "tdms_rows"]
                path = folder / f"timed{case.suffix}"
                case.make(path, ROWS.get(FAST[name].case if name in FAST else "tdms", 100_000))
                if name in FAST:
                    ratio = seconds(name, "plain", given.runs, path) / seconds(name, "fast", given.runs, path)
                else:
                    took = [
                        min(
                            python(
                                Path(__file__).with_name("formats.py"),
                                "--case",
                                "tdms_rows",
                                "--way",
                                way,
                                "--folder",
                                path,
                            ).seconds
                            for _ in range(given.runs)
                        )
                        for way in ("read", "npTDMS + pandas")
                    ]
                    ratio = took[1] / took[0]
            rows.append(row(name, result, ratio))
    if not given.check:
        print(machine())
    print(table(["fast path", "equal files", "acted", "fell back", "faster than the plain way", ">= 2 x"], rows))
    print("\n".join(wrong), file=sys.stderr)
    return int(bool(wrong))


if __name__ == "__main__":
    raise SystemExit(main())
