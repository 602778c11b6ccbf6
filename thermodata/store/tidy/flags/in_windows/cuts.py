"""A stream in pieces: where it is cut, and each piece loaded while the one before is worked on."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

_T = TypeVar("_T")


def cuts(start: int, stop: int, rows: int, borders: Sequence[int]) -> Iterator[tuple[int, int]]:
    """(first row, row past the last) of pieces of so many rows; none crosses a border."""
    a = start
    while a < stop:
        b = min([a + rows - (a - start) % rows, stop, *(x for x in borders if x > a)])
        yield a, b
        a = b


def ahead(load: Callable[[int], _T], places: Sequence[int], allowed: bool) -> Iterator[tuple[int, _T]]:
    """(place, what is loaded there), each loaded while the one before is worked on, where that is allowed."""
    if not allowed or len(places) < 2:
        yield from ((place, load(place)) for place in places)
        return
    with ThreadPoolExecutor(1) as reader:
        coming = reader.submit(load, places[0])
        for i, place in enumerate(places):
            loaded = coming.result()
            if i + 1 < len(places):
                coming = reader.submit(load, places[i + 1])
            yield place, loaded
            del loaded
