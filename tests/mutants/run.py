"""Changes one rule at a time in a copy of the checkout, runs the tests that stand beside it, and says what noticed.

    python tests/mutants/run.py [LIST ...] [--only WORD] [--jobs N]

LIST: modules beside this one with MUTANTS (default: all that have some). WORD: in the file, the old or new text, or
the reason. Exit code 1 where a mutant survives, or its old text does not stand exactly once in its file. The checkout
itself is never touched.
"""

from __future__ import annotations

import argparse
import compileall
import importlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from py_compile import PycInvalidationMode
from queue import SimpleQueue

from mutant import Mutant

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
COPIED = ("thermodata", "plugins", "tests", "schemas", "pyproject.toml", "README.md", "conftest.py")
LONGEST_S = 600.0
KILLED, SURVIVED, STALE, BROKEN = "killed", "SURVIVED", "STALE", "BROKEN"


def copy(folder: Path) -> Path:
    for name in COPIED:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, folder / name, ignore=shutil.ignore_patterns("__pycache__", ".hypothesis"))
        elif source.exists():
            shutil.copy2(source, folder / name)
    # by content, for a change within the same second must not go unnoticed
    for name in ("thermodata", "plugins"):
        compileall.compile_dir(folder / name, quiet=2, invalidation_mode=PycInvalidationMode.CHECKED_HASH)
    return folder


@contextmanager
def changed(checkout: Path, mutant: Mutant) -> Iterator[bool]:
    """The copy with the change; False where the old text does not stand there exactly once."""
    path = checkout / mutant.file
    text = path.read_text("utf-8") if path.exists() else ""
    fits = text.count(mutant.old) == 1 and mutant.old != mutant.new
    if fits:
        path.write_text(text.replace(mutant.old, mutant.new), "utf-8")
    try:
        yield fits
    finally:
        if fits:
            path.write_text(text, "utf-8")


def tested(checkout: Path, tests: Iterable[str]) -> int:
    """pytest's exit code: 0 where all tests pass, 1 where one fails. Modules are those of the copy."""
    sources = [checkout, *sorted(checkout.glob("plugins/*/src"))]
    done = subprocess.run(
        [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", "-p", "no:xdist", *tests],
        cwd=checkout,
        env={
            **os.environ,
            "PYTHONPATH": os.pathsep.join(map(str, sources)),
            "PYTHONDONTWRITEBYTECODE": "1",
            "OMP_NUM_THREADS": "1",
            "OPENBLAS_NUM_THREADS": "1",
        },
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        timeout=LONGEST_S,
        check=False,
    )
    return done.returncode


def outcome(checkout: Path, mutant: Mutant) -> str:
    with changed(checkout, mutant) as fits:
        if not fits:
            return STALE
        try:
            code = tested(checkout, mutant.tests)
        except subprocess.TimeoutExpired:
            return KILLED
    # 0: all pass, 1: one failed; anything else (no tests, a wrong path) says nothing about the mutant
    return {0: SURVIVED, 1: KILLED}.get(code, BROKEN)


def lists(names: list[str]) -> list[Mutant]:
    names = names or [
        n for n in sorted(p.stem for p in HERE.glob("*.py")) if not n.startswith(("run", "mutant", "test_"))
    ]
    return [mutant for name in names for mutant in importlib.import_module(name).MUTANTS]


def main() -> int:
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("lists", nargs="*", metavar="LIST")
    asked.add_argument("--only", default="", metavar="WORD")
    asked.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    options = asked.parse_args()
    mutants = [m for m in lists(options.lists) if options.only in " ".join((m.file, m.old, m.new, m.why))]
    with tempfile.TemporaryDirectory(prefix="mutants-") as folder:
        free: SimpleQueue[Path] = SimpleQueue()
        for number in range(options.jobs):
            free.put(copy(Path(folder) / str(number)))
        whole = free.get()
        for tests in sorted({m.tests for m in mutants}):
            if tested(whole, tests) != 0:
                print(f"the tests fail without a mutant: {' '.join(tests)}", file=sys.stderr)
                return 1
        free.put(whole)

        def one(mutant: Mutant) -> str:
            checkout = free.get()
            try:
                return outcome(checkout, mutant)
            finally:
                free.put(checkout)

        results: list[str] = []
        with ThreadPoolExecutor(options.jobs) as pool:
            for mutant, result in zip(mutants, pool.map(one, mutants), strict=True):
                results.append(result)
                change = f"{' '.join(mutant.old.split())} -> {' '.join(mutant.new.split()) or '(nothing)'}"
                print(f"{result:9} {mutant.file:45} {change}  [{mutant.why}]", flush=True)
    counts = {name: results.count(name) for name in (KILLED, SURVIVED, STALE, BROKEN)}
    print(", ".join(f"{count} {name.lower()}" for name, count in counts.items()), f"of {len(mutants)}")
    return 0 if counts[KILLED] == len(mutants) else 1


if __name__ == "__main__":
    raise SystemExit(main())
