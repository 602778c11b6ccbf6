"""A table of many tests below each other: a column called 'test' whose words stand in blocks, one after another.

Each block is drafted as a test: the part of the file that its `window` cuts out.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path, PurePosixPath
from types import MappingProxyType
from typing import Any

import numpy as np

from thermodata.draft.files.described_file import described_file
from thermodata.draft.files.file_question import FileQuestion
from thermodata.draft.files.raw_file import RawFile, RowsOfTest
from thermodata.draft.files.sample import Watch, sample_of
from thermodata.draft.signals.numerals import bare_word
from thermodata.draft.words.naming import words
from thermodata.plugin import Array, Block, Head, Loss, Reader, Recording, Signal, Source
from thermodata.reader.contract.guard import guarded
from thermodata.reader.signals.series import NEVER, SERIES


def _split(text: str) -> list[str]:
    return text.split()


_CALLED = frozenset(
    _split(
        "test tests versuch versuche messung messreihe experiment trial prueba ensayo essai mesure prova medicao proba "
        "pomiar mereni zkouska meres kiserlet forsok matning deneme meting proef 试验 测试 实验 試験 実験 시험"
    )
)
_IF_NUMBERED = frozenset(_split("run runs lauf"))  # alone they say that something runs
_BEFORE_NUMBERS = frozenset(["", "v", "t", "nr", "no"])
_BESIDE = frozenset(_split("id name nr no num number nummer label code bezeichnung kod key"))
_MOST, _FEWEST = 200, 5  # tests of a file, and rows of each
_SWITCH = {"0", "1"}
_PATIENCE_S = 10.0
_NOTHING: Mapping[str, Any] = MappingProxyType({})
_NO_SERIES = "its rows name tests: or sensors? then series: [the column] in place of none, and no windows"
_ANEW = (
    "its rows name tests, and times begin anew with each: add clock: {resets: allow}, by which they follow each other"
)


@dataclass(frozen=True, slots=True)
class _Run:
    """Rows on end with one word. first, last: their places in what was read."""

    word: str
    first: int
    last: int


class _BlockRows:
    """The rows of one block, as a reader gives them that is asked for no others."""

    formats = ()

    def __init__(self, name: str, recording: Recording, rows: Iterator[Block]) -> None:
        self.name, self._recording, self._rows = name, recording, rows

    def sniff(self, head: Head) -> str | None:
        return None

    def describe(self, path: Path, source: Source) -> Recording:
        return self._recording

    def blocks(self, path: Path, source: Source) -> Iterator[Block | Loss]:
        return self._rows


class _InTurn:
    """The rows of a file, run by run as they stand in it, and never all at once."""

    def __init__(self, items: Iterator[Block | Loss]) -> None:
        self._items, self._begin = items, 0
        self._block: Block | None = None

    def of(self, run: _Run) -> Iterator[Block]:
        while True:
            if self._block is None:
                self._block = next((b for b in self._items if not isinstance(b, Loss)), None)
            if self._block is None:
                return
            block, size = self._block, self._block.t_ns.size
            first, last = max(run.first - self._begin, 0), min(run.last + 1 - self._begin, size)
            if first < last:
                yield block.part(first, last)
            if self._begin + size > run.last:
                return  # what is left of it is of the next run
            self._begin, self._block = self._begin + size, None


class _Looked:
    """Times of a file and the runs of one of its columns, as far as it was looked through. whole: to its end, with
    nothing lost; no_names: numbers that are none of tests."""

    def __init__(self) -> None:
        self._times: list[Array] = []
        self._every: list[_Run] = []
        self._rows, self.whole, self.no_names = 0, True, False

    @property
    def t_ns(self) -> Array:
        """Shape (n,)."""
        return np.concatenate(self._times)

    @property
    def runs(self) -> list[_Run]:
        """Rows without a word belong to none."""
        return [r for r in self._every if r.word]

    @property
    def rows(self) -> int:
        return self._rows

    def take(self, t_ns: Array, column: Array) -> bool:
        """Looks at more rows; False where that is enough."""
        number = column.dtype.kind in "iuf"
        if column.dtype.kind == "f" and bool((column[np.isfinite(column)] % 1 != 0).any()):
            self.no_names = True
            return False
        for first, last, word in _runs(column):
            before = self._every[-1] if self._every else None
            if before is not None and before.word == word:
                self._every[-1] = replace(before, last=self._rows + last)
            else:
                self._every.append(_Run(word, self._rows + first, self._rows + last))
        self._times.append(t_ns)
        self._rows += t_ns.size
        many = len(self._every) > 2 * _MOST + 1
        self.no_names = number and many
        return not many


def not_as_series(
    who: Reader, full: Path, path: PurePosixPath, encoding: str | None, whole: RawFile | None, left_s: float
) -> list[RawFile] | None:
    """A file whose words its reader takes for series (whole), or cannot tell from them and refuses (None): where they
    are tests, a part for each, and the question whether they are. whole, with what is asked of it, for any other.

    ThermodataError where it cannot be read at all.
    """
    plain = described_file(who, full, path, encoding, {"series": NEVER})
    found = by_tests(who, full, plain, left_s, {"series": NEVER})
    if len(found) > 1 or whole is None:
        return found if len(found) > 1 else None
    return [replace(whole, asked=(*whole.asked, *(a for a in found[0].asked if a not in plain.asked)))]


def is_of_series(file: RawFile) -> bool:
    """Whether its reader took its rows apart by words."""
    return any(SERIES in s.properties for s in file.signals)


def by_tests(
    who: Reader, full: Path, file: RawFile, left_s: float, declare: Mapping[str, Any] = _NOTHING
) -> list[RawFile]:
    """A file whose rows name their test, as a part with a sample for each; any other as it is, and with a question
    where its words or times are in another order, where times without a date begin anew with each test, and where not
    all of it could be looked through. declare: by which it is read so."""
    named = [s for s in file.signals if _is_called_test(s)]
    if len(named) != 1 or len({s.stream for s in file.signals}) != 1:
        return [file]
    looked = _look(who, full, file, named[0].name, min(left_s, _PATIENCE_S))
    if not looked.rows or looked.no_names:
        return [file]
    asked = f"'{named[0].name}' may name tests, one below the other: then write each with its window: [from, to]"
    open_still = replace(file, asked=(*file.asked, FileQuestion(asked, {})))
    t_ns, runs = looked.t_ns, looked.runs
    if not looked.whole:
        return [open_still]
    if len({r.word for r in runs}) < 2 or {r.word for r in runs} == _SWITCH:
        return [file]
    if not _each_once(runs):
        return [open_still]
    anew = file.recording.clock == "relative" and bool((np.diff(t_ns) < 0).any())
    if anew:
        t_ns = _behind_each_other(t_ns, runs)
    if (np.diff(t_ns) < 0).any():
        return [open_still]
    if anew or declare:
        file = replace(file, asked=(*file.asked, FileQuestion(_ANEW if anew else _NO_SERIES, declare)))
    left = replace(file.recording, signals=tuple(s for s in file.signals if s is not named[0]))
    delivered = file.delivered or file.recording
    found, rows = [], _InTurn(guarded(who, full, file.source, delivered))
    for run, following in zip(runs, [*runs[1:], None], strict=True):
        kept = _BlockRows(file.reader, delivered, rows.of(run))
        sample = sample_of(full, kept, file.source, delivered, file.size)
        window = _window(t_ns, run, following)
        found.append(
            replace(file, recording=left, delivered=delivered, block=RowsOfTest(run.word, window), sample=sample)
        )
    return found


def _is_called_test(signal: Signal) -> bool:
    """Whether its name says no more than that it names the test: 'Test', 'test_id', 'Versuch Nr.'."""
    said = frozenset(words(signal.name).split())
    beside = said & _BESIDE
    called = said & (_CALLED | _IF_NUMBERED if beside else _CALLED)
    return bool(called) and said == called | beside and signal.dtype != "bool"


def is_test_number(name: str) -> bool:
    """Whether a name says no more than the number of a test: 'Test 3', 'Messung_12', 'V2', '07'."""
    said = re.fullmatch(r"([^\W\d]*)[\W_]*\d+", name.strip())
    return said is not None and said[1].strip("_").casefold() in _CALLED | _IF_NUMBERED | _BEFORE_NUMBERS


def is_called_test(name: str) -> bool:
    """Whether a name says no more than that it is a test, whose number stands elsewhere: 'Test', 'Messung', 'V'. A
    'run' may be one of a logger."""
    return name.strip(" _.-").casefold() in _CALLED | _BEFORE_NUMBERS


def _look(who: Reader, full: Path, file: RawFile, column: str, left_s: float) -> _Looked:
    """What a column says of the rows of a file: as far as there is time for it."""
    watch, looked = Watch(), _Looked()
    for item in guarded(who, full, file.source, file.delivered or file.recording):
        if isinstance(item, Loss):
            looked.whole = False
            continue
        if not looked.take(item.t_ns, item.values[column]):
            break
        if watch.spent_s > left_s:
            looked.whole = False
            break
    return looked


def _runs(column: Array) -> Iterator[tuple[int, int, str]]:
    """(first, last, word) of rows on end that are equal. column: shape (n,)."""
    starts = [0, *(np.flatnonzero(column[1:] != column[:-1]) + 1).tolist()]
    for a, b in zip(starts, [*starts[1:], column.size], strict=True):
        yield a, b - 1, _word(column[a : a + 1].tolist()[0])


def _word(value: object) -> str:
    if isinstance(value, float):
        return f"{value:.15g}" if value == value else ""
    return bare_word(value)


def _each_once(runs: Sequence[_Run]) -> bool:
    """Whether each word has one block, of some length."""
    if len(runs) > _MOST or len({r.word for r in runs}) != len(runs):
        return False
    return all(r.last - r.first + 1 >= _FEWEST for r in runs)


def _behind_each_other(t_ns: Array, runs: Sequence[_Run]) -> Array:
    """The times as ingest joins them where the clock was set back: a block one step behind the one before it."""
    joined = t_ns.copy()
    for before, run in pairwise(runs):
        step = int(np.median(np.diff(t_ns[before.first : before.last + 1])))
        joined[run.first :] += int(joined[before.last]) + step - int(joined[run.first])
    return joined


def _window(t_ns: Array, run: _Run, following: _Run | None) -> tuple[float, float]:
    """[from, to) of a block since the first row [s]: to is one step behind its last row, and never in the next."""
    own = t_ns[run.first : run.last + 1]
    end = int(own[-1]) + max(int(np.median(np.diff(own))), 1)
    if following is not None:
        end = min(end, int(t_ns[following.first]))
    return (int(own[0]) - int(t_ns[0])) / 1e9, (end - int(t_ns[0])) / 1e9
