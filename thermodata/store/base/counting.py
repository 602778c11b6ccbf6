"""Counts the rounds of a long computation for whoever watches it; nothing where nobody does."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import TypeVar

Tell = Callable[[str, int, int], None]
"""Is told what is being counted ("candidates"), how many are done, and of how many."""

_T = TypeVar("_T")
_watch: ContextVar[Tell | None] = ContextVar("watch", default=None)


@contextmanager
def watched(tell: Tell | None) -> Iterator[None]:
    """While this is open, `counted` of the same thread tells `tell`. None: nobody is told."""
    token = _watch.set(tell)
    try:
        yield
    finally:
        _watch.reset(token)


def counted(items: Sequence[_T], what: str) -> Iterator[_T]:
    """The items, one by one, telling how far it is."""
    tell = _watch.get()
    for done, item in enumerate(items):
        if tell is not None:
            tell(what, done, len(items))
        yield item
    if tell is not None and items:
        tell(what, len(items), len(items))


def watcher() -> Tell | None:
    """Who watches, for work that comes in no items; None where nobody does."""
    return _watch.get()


__all__ = ["Tell", "counted", "watched", "watcher"]
