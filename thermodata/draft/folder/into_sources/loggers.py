"""Loggers of one kind that ran at once: told apart by the folder that each writes to, or by a word of its files' names.
What each calls 'T1' is another sensor."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from itertools import combinations

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.files.sheets import spans_at_once

_MOST = 8
_PIECE = r"[_\-. ]+"
_AT_LEAST_NS = 15 * 60 * 1_000_000_000  # what a log of which only the first rows were read runs on
Label = Callable[[RawFile], str]


def loggers(files: Sequence[RawFile]) -> list[list[RawFile]]:
    """The files of each logger, where like files are of several: in each pair of loggers at least half of the tests of
    one ran while one of the other did, and no logger ran twice at a time. All files where that is not so, or where
    clocks without dates do not tell. Two tests are needed, or one whose files are called alike in two folders."""
    if len(files) < 2 or any(f.start_ns is None or f.part is not None for f in files):
        return [list(files)]
    for label in _labels(files):
        apart: dict[str, list[RawFile]] = {}
        for file in files:
            apart.setdefault(label(file), []).append(file)
        if 2 <= len(apart) <= _MOST and _are_loggers(list(apart.values())):
            return [apart[name] for name in sorted(apart)]
    return [list(files)]


def _labels(files: Sequence[RawFile]) -> Iterator[Label]:
    """What may be a logger's name: each folder of the paths from the top, then each word of the files' names."""
    for level in range(max(len(f.path.parts) for f in files) - 1):
        yield partial(_folder, level)
    counts = {len(_words(f)) for f in files}
    for place in range(counts.pop()) if len(counts) == 1 else (0, -1):
        yield partial(_word, place)


def _folder(level: int, file: RawFile) -> str:
    folders = file.path.parts[:-1]
    return folders[level] if level < len(folders) else ""


def _word(place: int, file: RawFile) -> str:
    return _words(file)[place]


def _words(file: RawFile) -> list[str]:
    return re.split(_PIECE, file.path.stem)


def _are_loggers(apart: Sequence[list[RawFile]]) -> bool:
    if any(_ran_at_once(a, b) for own in apart for a, b in combinations(own, 2)):
        return False
    return all(_ran_together(one, other) for one, other in combinations(apart, 2))


def _ran_together(one: Sequence[RawFile], other: Sequence[RawFile]) -> bool:
    few, many = sorted((one, other), key=len)
    pairs = [(a, [b for b in many if _ran_at_once(a, b)]) for a in few]
    met = [(a, own[0]) for a, own in pairs if len(own) == 1]
    if any(len(own) > 1 for _, own in pairs) or 2 * len(met) < len(few):
        return False
    return len(met) > 1 or any(a.path.name == b.path.name for a, b in met)


def _ran_at_once(a: RawFile, b: RawFile) -> bool:
    """Whether one ran while the other did; their clocks may be minutes apart."""
    return spans_at_once(_span(a), _span(b))


def _span(file: RawFile) -> tuple[int, int]:
    begin = file.start_ns or 0
    return begin, max(file.sample.last_ns or begin, begin if file.sample.whole else begin + _AT_LEAST_NS)
