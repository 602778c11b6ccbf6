"""The worker: reads mutated files one after the other, in a process that may be killed.

    python tests/fuzz/run.py --worker ...       (started by run.py)

It takes the numbers of files from its arguments and writes a line of JSON before and after each to its first output.
"""

from __future__ import annotations

import importlib
import importlib.util
import json
import os
import random
import resource
import signal
import sys
import tempfile
import traceback
import warnings
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import FrameType, ModuleType
from typing import Any

from tests.fuzz import oracle
from tests.fuzz.harness import Mutation, Seed
from thermodata.errors import PluginError, ThermodataError
from thermodata.plugin import HEAD_BYTES, Head, Reader

HERE = Path(__file__).parent


class TooSlow(BaseException):
    """Not an Exception, so that no reader catches it."""


@dataclass(frozen=True)
class Verdict:
    """outcome: same, fewer, changed, reported, refused or failed. why: of a failure or refusal; place: where in the
    code it came from, which tells classes of failures apart; trace: the traceback."""

    outcome: str
    why: str = ""
    place: str = ""
    trace: str = ""


def load_format(name: str) -> ModuleType:
    """The module of a format, by its name or by a path."""
    if not name.endswith(".py"):
        return importlib.import_module(f"tests.fuzz.formats.{name}")
    spec = importlib.util.spec_from_file_location(Path(name).stem, name)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    return module


def reader_of(module: ModuleType) -> Reader:
    from thermodata.reader import reader

    return reader(module.READER) if isinstance(module.READER, str) else module.READER()


class Bench:
    """One format with its seeds, and what the seeds themselves give."""

    def __init__(self, name: str, run_seed: int, limit_s: float, folder: Path) -> None:
        self.module, self.run_seed, self.limit_s, self.folder = load_format(name), run_seed, limit_s, folder
        self.reader = reader_of(self.module)
        self.seeds: list[Seed] = self.module.seeds()
        self.of_seed = cache(self._of_seed)

    def _of_seed(self, which: int) -> oracle.Reading:
        seed = self.seeds[which]
        path = self.folder / seed.name
        path.write_bytes(seed.data)
        try:
            found = oracle.read(self.reader, path, seed.source)
        except Exception as error:
            raise SystemExit(f"seed '{seed.name}' itself is not read: {error!r}") from error
        finally:
            path.unlink()
        losses = [text for kind, text in found.said if kind == "loss"]
        if losses or found.complete is False or not found.delivered:
            raise SystemExit(
                f"seed '{seed.name}' is no whole file: complete={found.complete}, "
                f"{found.delivered} values, losses {losses}"
            )
        return found

    def make(self, number: int) -> tuple[int, Mutation]:
        """(which seed, its mutation) of a file's number."""
        rng = random.Random(f"{self.run_seed}:{number}")
        which = number % len(self.seeds)
        return which, self.module.mutate(self.seeds[which], rng)

    def judge(self, which: int, mutation: Mutation) -> Verdict:
        """Reads one mutated file under the time limit."""
        seed, known = self.seeds[which], self.of_seed(which)
        path = self.folder / seed.name
        path.write_bytes(mutation.data)
        signal.signal(signal.SIGPROF, _out_of_time)
        signal.setitimer(signal.ITIMER_PROF, self.limit_s)
        try:
            with path.open("rb") as file:
                self.reader.sniff(Head(path.name, len(mutation.data), file.read(HEAD_BYTES)))
            got = oracle.read(self.reader, path, seed.source)
        except PluginError as error:
            # the guard wraps what the reader raised; the place is where that came from
            return _failed("plugin bug: " + str(error).replace("\n", "; "), error.__cause__ or error)
        except ThermodataError as error:
            return Verdict("refused", error.what)
        except TooSlow as error:
            return _failed(f"more than {self.limit_s:g} s of processor time", error)
        except Exception as error:
            return _failed(f"{type(error).__name__}: {error}", error)
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0)
            beside = oracle.left_beside(path, [seed.name])
            path.unlink(missing_ok=True)
            for name in beside:
                (self.folder / name).unlink()
        if beside:
            return Verdict("failed", f"left beside the file: {beside}", "left beside")
        return compare(got, known, mutation)


def compare(got: oracle.Reading, seed: oracle.Reading, mutation: Mutation) -> Verdict:
    """The row oracle."""
    if oracle.reports(got, seed):
        return Verdict("reported")
    if mutation.values_touched:
        return Verdict("changed")
    wrong = oracle.wrong_rows(got, seed)
    if wrong is not None:
        return Verdict("failed", f"silently wrong: {wrong}", "silently wrong")
    missing = oracle.missing_rows(got, seed)
    if missing is None:
        return Verdict("same")
    if mutation.well_formed:
        return Verdict("fewer")
    return Verdict("failed", f"silently missing: {missing}", "silently missing")


def _out_of_time(number: int, frame: FrameType | None) -> None:
    raise TooSlow


def _failed(why: str, error: BaseException) -> Verdict:
    frames = traceback.extract_tb(error.__traceback__)
    inner = [
        f for f in frames if "/fuzz/" not in f.filename and not f.filename.endswith("reader/contract/guard.py")
    ] or frames
    ours = [f for f in inner if "thermodata" in f.filename] or inner
    place = " < ".join(f"{Path(f.filename).name}:{f.lineno}" for f in reversed(ours[-2:]))
    trace = "".join(traceback.format_exception(error))
    return Verdict("failed", why, f"{type(error).__name__} at {place}", trace)


def work(name: str, run_seed: int, numbers: range, limit_s: float, memory_mib: int) -> None:
    """All the files of a batch; what a reader prints goes to the second output."""
    answers = os.fdopen(os.dup(1), "w", buffering=1)
    os.dup2(2, 1)
    warnings.simplefilter("ignore")

    def say(**what: Any) -> None:
        answers.write(json.dumps(what) + "\n")

    with tempfile.TemporaryDirectory(prefix="fuzz-") as folder:
        bench = Bench(name, run_seed, limit_s, Path(folder))
        for which in {n % len(bench.seeds) for n in numbers}:
            bench.of_seed(which)  # imports what it needs before the limit is set
        _limit_memory(memory_mib)
        for number in numbers:
            which, mutation = bench.make(number)
            say(start=number, seed=bench.seeds[which].name, kind=mutation.kind)
            verdict = bench.judge(which, mutation)
            say(end=number, outcome=verdict.outcome, why=verdict.why, place=verdict.place, trace=verdict.trace)


def _limit_memory(memory_mib: int) -> None:
    pages = int(Path("/proc/self/statm").read_text().split()[0])
    wanted = pages * os.sysconf("SC_PAGE_SIZE") + memory_mib * 2**20
    hard = resource.getrlimit(resource.RLIMIT_AS)[1]
    resource.setrlimit(resource.RLIMIT_AS, (wanted if hard == resource.RLIM_INFINITY else min(wanted, hard), hard))
