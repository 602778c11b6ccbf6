"""Checks: a reader reads, and does nothing else to the file, its folder or the process."""

from __future__ import annotations

import contextlib
import gc
import hashlib
import io
import locale
import os
import shutil
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from thermodata.errors import ThermodataError
from thermodata.plugin import Reader, Source
from thermodata.testing.reader.case import Case, fault, load


@contextlib.contextmanager
def _copied(path: Path) -> Iterator[Path]:
    """The file in a folder of its own, under a name with blanks and accents."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "měření 1" / f"soubor č. 1{path.suffix}"
        copy.parent.mkdir()
        shutil.copy(path, copy)
        yield copy


def the_file_and_its_folder_stay_as_they_were(case: Case, path: Path, source: Source) -> None:
    with _copied(path) as copy:
        before = hashlib.sha256(copy.read_bytes()).digest()
        load(case.make(), copy, source)
        if hashlib.sha256(copy.read_bytes()).digest() != before:
            fault(f"{path.name} was changed", "open the file with mode 'rb': logs are read, never written")
        left = sorted(p.name for p in copy.parent.iterdir() if p != copy)
        if left:
            fault(
                f"left beside the file: {left}",
                "write no index or cache beside the file (the folder may be read-only, and is hashed); keep it in "
                "memory, or in tempfile.TemporaryDirectory",
            )


def the_file_is_closed_after_use(case: Case, path: Path, source: Source) -> None:
    """After describe, after a whole reading, after one that is given up at the first block, and after a refusal."""
    with _copied(path) as copy:
        reader = case.make()
        reader.describe(copy, source)
        _closed(copy, "describe")
        load(reader, copy, source)
        _closed(copy, "a whole reading")
        items = iter(reader.blocks(copy, source))
        next(items, None)
        close = getattr(items, "close", None)
        if close is not None:
            close()
        del items, close
        _closed(copy, "a reading that was given up at its first block")
        content = copy.read_bytes()
        for size in (0, len(content) // 3, len(content) - 1):
            copy.write_bytes(content[:size])
            with contextlib.suppress(ThermodataError, OSError):
                load(reader, copy, source)
            gc.collect()  # the exception's traceback may have held frames, with their files
            _closed(copy, f"reading its first {size} bytes")
        _keep_alive(reader)


def _keep_alive(reader: Reader) -> None:
    """The reader lives until here: what it holds on to is held on to."""


def _closed(path: Path, after: str) -> None:
    real = os.path.realpath(path)
    held: list[str] = []
    if sys.platform == "linux":
        for number in os.listdir("/proc/self/fd"):
            with contextlib.suppress(OSError):
                held += ["file"] * (os.readlink(f"/proc/self/fd/{number}") == real)
        held += ["mapping"] * any(
            line.rstrip().endswith(real) for line in Path("/proc/self/maps").read_text("utf-8", "replace").splitlines()
        )
    else:
        moved = path.with_name("moved")  # Windows renames no open file
        try:
            path.rename(moved).rename(path)
        except PermissionError:
            held = ["file"]
    if held:
        fault(
            f"{path.suffix or path.name}: the {held[0]} is still open after {after}",
            "open the file in a `with` inside describe and blocks (a generator's `with` closes when it is given "
            "up), and let no reader, cache or cycle keep the file object",
        )


def it_prints_nothing(case: Case, path: Path, source: Source) -> None:
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        load(case.make(), path, source)
    if said.getvalue():
        fault(
            f"{path.name}: printed {said.getvalue()[:60]!r}",
            "stdout is data: put what a user should know into Recording.notes or a Loss",
        )


def it_leaves_the_process_as_it_was(case: Case, path: Path, source: Source) -> None:
    folder, language, numeric = os.getcwd(), locale.setlocale(locale.LC_ALL), np.geterr()
    environment, imports = dict(os.environ), list(sys.path)
    try:
        load(case.make(), path, source)
        changed = [
            name
            for name, same in (
                ("the working folder", os.getcwd() == folder),
                ("the locale", locale.setlocale(locale.LC_ALL) == language),
                ("numpy's error state", np.geterr() == numeric),
                ("the environment", dict(os.environ) == environment),
                ("the import path", sys.path == imports),
            )
            if not same
        ]
    finally:
        os.chdir(folder)
        locale.setlocale(locale.LC_ALL, language)
        np.seterr(**numeric)
    if changed:
        fault(
            f"{path.name}: reading changed {', '.join(changed)}",
            "parse with explicit arguments (a decimal mark, a full path) instead of setting them for everybody",
        )
