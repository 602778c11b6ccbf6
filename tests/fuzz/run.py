"""Mutates files of a format and reads them; see harness.py for what a format hands over and what fails.

    .venv/bin/python tests/fuzz/run.py --format tdms [--count 10000] [--seed 0] [--jobs 1]
                                       [--limit 5] [--memory 1024] [--out DIR] [--replay NUMBER]

Prints a table of kinds and outcomes, then each class of failure with one example; writes failing files (at most five
of a class) with their report into DIR. Exit code 1 where a file failed.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import threading
import time
from collections import Counter, defaultdict
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
if str(ROOT) not in sys.path:
    sys.path.insert(0, str(ROOT))

OUTCOMES = ("same", "fewer", "changed", "reported", "refused", "failed")
MEANING = (
    "same: all rows of the seed; fewer: some, of an honest file; changed: values were touched, not judged; "
    "reported: loss, incomplete, note or flag; refused: an error of ours"
)
BATCH, KEPT, WAIT_FACTOR, START_S = 500, 5, 12, 120.0


@dataclass
class Tally:
    """What happened so far. failures: class of failure -> (number, seed, kind, why, trace)."""

    counts: dict[str, Counter[str]] = field(default_factory=lambda: defaultdict(Counter))
    failures: dict[str, list[tuple[int, str, str, str, str]]] = field(default_factory=lambda: defaultdict(list))
    lock: threading.Lock = field(default_factory=threading.Lock)

    def add(self, number: int, seed: str, kind: str, answer: dict[str, str]) -> None:
        with self.lock:
            self.counts[kind][answer["outcome"]] += 1
            if answer["outcome"] == "failed":
                self.failures[answer["place"]].append((number, seed, kind, answer["why"], answer["trace"]))

    @property
    def done(self) -> int:
        return sum(c.total() for c in self.counts.values())

    @property
    def failed(self) -> int:
        return sum(map(len, self.failures.values()))


def run_batch(given: argparse.Namespace, numbers: range, tally: Tally) -> None:
    """One worker after the other until all numbers are done; a dead one is replaced behind the file it died of."""
    at = numbers.start
    while at < numbers.stop:
        at = _one_worker(given, range(at, numbers.stop), tally)


def _one_worker(given: argparse.Namespace, numbers: range, tally: Tally) -> int:
    """Returns the number to go on with."""
    words = [
        sys.executable,
        __file__,
        "--worker",
        "--format",
        given.format,
        "--seed",
        given.seed,
        "--limit",
        given.limit,
        "--memory",
        given.memory,
        "--from",
        numbers.start,
        "--count",
        numbers.stop - numbers.start,
    ]
    # few arenas: each reserves address space, which the limit counts
    environment = {
        **os.environ,
        "MALLOC_ARENA_MAX": "2",
        "ARROW_DEFAULT_MEMORY_POOL": "system",
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
    }
    with tempfile.TemporaryFile("w+", errors="replace") as said:
        child = subprocess.Popen(
            [str(w) for w in words], stdout=subprocess.PIPE, stderr=said, text=True, env=environment
        )
        assert child.stdout is not None
        watch = _Watch(child)
        open_file: tuple[int, str, str] | None = None
        watch.expect(START_S)
        for line in child.stdout:
            answer = json.loads(line)
            if "start" in answer:
                open_file = (answer["start"], answer["seed"], answer["kind"])
            elif open_file is not None:
                tally.add(*open_file, answer)
                open_file, numbers = None, range(answer["end"] + 1, numbers.stop)
            watch.expect(given.limit * WAIT_FACTOR)
        watch.end()
        code = child.wait()
        said.seek(0)
        err = said.read()[-2000:]
    if open_file is not None:
        why = f"no end after {given.limit * WAIT_FACTOR:g} s" if watch.killed else f"the worker died, code {code}"
        tally.add(*open_file, {"outcome": "failed", "why": why, "place": why, "trace": err})
        return open_file[0] + 1
    if code or numbers:
        raise SystemExit(f"the worker ended with code {code} before file {numbers.start}:\n{err}")
    return numbers.stop


class _Watch:
    """Kills a worker that says nothing for too long. One that waits for a busy machine, or that somebody stopped, is
    not to blame: only the time counts in which it works, or waits for nothing that ever comes."""

    def __init__(self, child: subprocess.Popen[str]) -> None:
        self.killed = False
        self._child, self._clock, self._guard = child, threading.Timer(0, str), threading.Lock()
        self._ended = False

    def expect(self, seconds: float) -> None:
        """A line within so long."""
        with self._guard:
            self._set(seconds, _used_s(self._child.pid)[0])

    def end(self) -> None:
        with self._guard:
            self._ended = True
            self._clock.cancel()

    def _set(self, seconds: float, used_s: float) -> None:
        self._clock.cancel()
        self._clock = threading.Timer(seconds, self._look, (seconds, used_s))
        self._clock.daemon = True
        self._clock.start()

    def _look(self, seconds: float, used_s: float) -> None:
        with self._guard:
            if self._ended or threading.current_thread() is not self._clock:
                return
            now_s, state = _used_s(self._child.pid)
            if state in "RTD" and now_s - used_s < seconds:
                self._set(seconds, used_s)
                return
            self.killed = True
            self._child.kill()


def _used_s(pid: int) -> tuple[float, str]:
    """Processor time of a process [s], and its state (R: runs or would, T: stopped, D: waits for a disk)."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0, "X"
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK"), fields[0]


def table(tally: Tally) -> str:
    """kind x outcome, with the sums."""
    rows = [["kind", *OUTCOMES, "all"]]
    for kind, counts in sorted(tally.counts.items()):
        rows.append([kind, *(str(counts[o] or "") for o in OUTCOMES), str(counts.total())])
    sums = sum(tally.counts.values(), Counter())
    rows.append(["all", *(str(sums[o]) for o in OUTCOMES), str(sums.total())])
    wide = [max(len(r[i]) for r in rows) for i in range(len(rows[0]))]
    return "\n".join(
        "  ".join(c.ljust(w) if i == 0 else c.rjust(w) for i, (c, w) in enumerate(zip(r, wide, strict=True)))
        for r in rows
    )


def write_failures(given: argparse.Namespace, tally: Tally, out: Path) -> None:
    """The first files of each class, with how to read them again."""
    from tests.fuzz.worker import Bench

    out.mkdir(parents=True, exist_ok=True)
    bench = Bench(given.format, given.seed, given.limit, out)
    for place, files in sorted(tally.failures.items(), key=lambda item: -len(item[1])):
        number, seed, kind, why, trace = files[0]
        print(f"\n{len(files)} x {place}\n  {kind} of {seed}: {why}\n  again: --replay {number}")
        for number, seed, kind, why, trace in sorted(files)[:KEPT]:
            path = out / f"{given.seed}-{number}-{seed}"
            path.write_bytes(bench.make(number)[1].data)
            path.with_name(path.name + ".txt").write_text(
                f"{kind} of {seed}\n{why}\n{place}\n\n{trace}\n"
                f"python tests/fuzz/run.py --format {given.format} --seed {given.seed} --replay {number}\n",
                "utf-8",
            )
    print(f"\nfailing files: {out}")


def replay(given: argparse.Namespace) -> int:
    """One file again in this process, with its traceback."""
    from tests.fuzz.worker import Bench

    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(given.format, given.seed, given.limit, Path(folder))
        which, mutation = bench.make(given.replay)
        verdict = bench.judge(which, mutation)
    print(
        f"{mutation.kind} of {bench.seeds[which].name}, {len(mutation.data)} bytes, well formed: "
        f"{mutation.well_formed}, values touched: {mutation.values_touched}\n{verdict.outcome}: {verdict.why}\n"
        f"{verdict.place}\n{verdict.trace}"
    )
    return int(verdict.outcome == "failed")


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("--format", required=True, help="a module in tests/fuzz/formats, or a path to one")
    arguments.add_argument("--count", type=int, default=10_000)
    arguments.add_argument("--seed", type=int, default=0)
    arguments.add_argument("--jobs", type=int, default=1)
    arguments.add_argument("--limit", type=float, default=5.0, help="processor time of a file [s]")
    arguments.add_argument("--memory", type=int, default=1024, help="address space above the imports' [MiB]")
    arguments.add_argument("--out", type=Path, help="folder of the failing files")
    arguments.add_argument("--replay", type=int, metavar="NUMBER")
    arguments.add_argument("--worker", action="store_true", help=argparse.SUPPRESS)
    arguments.add_argument("--from", type=int, default=0, dest="first", help=argparse.SUPPRESS)
    given = arguments.parse_args()
    if given.worker:
        from tests.fuzz.worker import work

        work(given.format, given.seed, range(given.first, given.first + given.count), given.limit, given.memory)
        return 0
    if given.replay is not None:
        return replay(given)
    tally, begin = Tally(), time.monotonic()
    batches = [range(i, min(i + BATCH, given.count)) for i in range(0, given.count, BATCH)]
    with ThreadPoolExecutor(given.jobs) as pool:
        for n, _ in enumerate(pool.map(lambda numbers: run_batch(given, numbers, tally), batches), 1):
            if sys.stderr.isatty() or n % 4 == 0:
                print(f"{tally.done} of {given.count}, {tally.failed} failed", file=sys.stderr)
    print(f"{given.format}: {tally.done} files, seed {given.seed}, {time.monotonic() - begin:.0f} s\n{MEANING}\n")
    print(table(tally))
    if tally.failures:
        out = given.out or Path(tempfile.gettempdir()) / "thermodata-fuzz" / Path(given.format).stem
        write_failures(given, tally, out)
    return int(bool(tally.failures))


if __name__ == "__main__":
    raise SystemExit(main())
