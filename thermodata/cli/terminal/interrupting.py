"""Ctrl-C, noticed where it is pressed: libraries in C answer it by errors of their own, as if something had failed."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from itertools import islice
from types import FrameType
from typing import TypeVar

T = TypeVar("T")
_pressed = {"came": False, "unheard": False}


@contextmanager
def noticing_interrupts() -> Iterator[Callable[[], bool]]:
    """Gives a function that tells whether SIGINT came since. KeyboardInterrupt is raised as ever; DuckDB makes a
    RuntimeError of it, and who opens a file or a catalogue may take that for damage."""
    _pressed.update(came=False, unheard=False)

    def notice(number: int, frame: FrameType | None) -> None:
        _pressed.update(came=True, unheard=True)
        signal.default_int_handler(number, frame)

    ours = (
        threading.current_thread() is threading.main_thread()  # only there a handler can be set
        and signal.getsignal(signal.SIGINT) is signal.default_int_handler
    )
    if ours:
        signal.signal(signal.SIGINT, notice)
    try:
        yield lambda: _pressed["came"]
    finally:
        if ours:
            signal.signal(signal.SIGINT, signal.default_int_handler)


def heed() -> None:
    """KeyboardInterrupt where Ctrl-C was pressed and work goes on: a library may swallow what is raised in an import of
    its own. For places where progress is told, which nobody does who is on the way out."""
    if _pressed["unheard"] and threading.current_thread() is threading.main_thread():
        _pressed["unheard"] = False
        raise KeyboardInterrupt


def interruptible(items: Iterator[T], interrupt: Callable[[], None]) -> Iterator[T]:
    """The same items, each taken in a thread, so that Ctrl-C is noticed though the library that makes them asks for no
    signals. interrupt: makes it give up the item that it is at."""
    with ThreadPoolExecutor(1) as thread:
        while True:
            taken = thread.submit(lambda: list(islice(items, 1)))
            try:
                found = taken.result()
            except KeyboardInterrupt:
                interrupt()
                raise
            if not found:
                return
            yield from found
