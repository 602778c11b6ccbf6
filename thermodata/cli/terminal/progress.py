"""One line on a terminal while a long command works: how far, how fast, how long still. Nothing where nobody looks."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from thermodata.cli.terminal.interrupting import heed
from thermodata.store.base.counting import Tell
from thermodata.store.ingest.progress import Progress

_FORMAT = "{percentage:3.0f} %|{bar:20}| {postfix}, {remaining} left"


class Line:
    """files done of all, MB/s, million samples a second, time left; by bytes, rewritten in place.

    Within a file the bytes are guessed from how many samples the files before it had for each byte.
    """

    def __init__(self, bar: Any) -> None:
        self.bar = bar
        self.files, self.total, self.count, self.sure, self._in_file = 0, 0, 0, 0, 0
        self._text = ""

    def begin(self, files: int, size_bytes: int) -> None:
        self.total = files
        self.bar.reset(total=max(1, size_bytes))
        self._show_rate()

    def samples(self, count: int) -> None:
        self.count += count
        self._in_file += count
        read = self.count - self._in_file
        if read and self.sure:
            # never past what a file can have: the truth comes with its end
            guess = self.sure + round(self._in_file * self.sure / read)
            self._move_to(min(guess, self.bar.total))
        self._show_rate()

    def done(self, path: str, size_bytes: int) -> None:
        self.files, self.sure, self._in_file = self.files + 1, self.sure + size_bytes, 0
        self._move_to(self.sure)
        self._show_rate()

    def say(self, text: str) -> None:
        self._text = text
        self._show_rate()

    def _move_to(self, at: int) -> None:
        self.bar.n = at

    def _show_rate(self) -> None:
        heed()
        elapsed = max(self.bar.format_dict["elapsed"], 1e-6)
        self.bar.set_postfix_str(
            f"{self.files}/{self.total} files, {self.bar.n / 1e6 / elapsed:.1f} MB/s, "
            f"{self.count / 1e6 / elapsed:.2f} Msamples/s, {self._text[:40]}",
            refresh=False,
        )
        self.bar.update(0)


class Heeding:
    """Says nothing, and lets Ctrl-C through."""

    def begin(self, files: int, size_bytes: int) -> None:
        heed()

    def samples(self, count: int) -> None:
        heed()

    def done(self, path: str, size_bytes: int) -> None:
        heed()

    def say(self, text: str) -> None:
        heed()


def _columns() -> int:
    """The width of the terminal, less one, so that the cursor stays on the line; some don't tell theirs."""
    try:
        return (os.get_terminal_size(sys.stderr.fileno()).columns or 100) - 1
    except (OSError, ValueError):
        return 99


@contextmanager
def progress_line(quiet: bool = False) -> Iterator[Progress]:
    """A line on stderr, gone at the end; nothing where stderr is no terminal, or quiet."""
    if quiet or not sys.stderr.isatty():
        yield Heeding()
        return
    bar = _bar(_FORMAT)
    try:
        yield Line(bar)
    finally:
        bar.close()


@contextmanager
def counting_line(quiet: bool = False) -> Iterator[Tell]:
    """A line on stderr for work that is counted: done of all, how many a second, time left. Nothing where stderr is no
    terminal, or quiet."""
    if quiet or not sys.stderr.isatty():
        yield lambda *_: heed()
        return
    bar = _bar("{percentage:3.0f} %|{bar:20}| {n_fmt}/{total_fmt} {desc}, {rate_fmt}, {remaining} left")

    def tell(what: str, done: int, total: int) -> None:
        heed()
        if done == 0 or total != bar.total:
            bar.reset(total=total)
            bar.set_description_str(what, refresh=False)
        bar.n = done
        bar.update(0)

    try:
        yield tell
    finally:
        bar.close()


def _bar(text: str) -> Any:
    return import_module("tqdm").tqdm(
        total=1, file=sys.stderr, leave=False, bar_format=text, miniters=0, ncols=_columns(), unit=""
    )
