"""A process that reads source files into the raw layer for an ingest: tasks come in, what became of them goes out.

It ends with the ingest, however that ends: when nothing can be heard of it any more, the file in hand is dropped and
no half of it stays.
"""

from __future__ import annotations

import os
import pickle
import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue
from typing import Any, BinaryIO

from thermodata.archive.unpacked import forget_unpacked
from thermodata.errors import FormatError, PluginError, UsageError
from thermodata.plugin import Reader, Source
from thermodata.store.base.files import drop_unfinished
from thermodata.store.ingest.progress import TextProgress, counted
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.raw.source_file import ChangedError, SourceFile
from thermodata.store.raw.streams import find_reader, raw_key, read_raw

_TELL_S, _ENDING_S = 0.2, 5.0


@dataclass(frozen=True, slots=True)
class Task:
    """A file to be read. key: of what it must become; path: relative to the campaign's folder; reader: its name;
    source: what is declared of it."""

    key: str
    store: Path
    path: str
    file: SourceFile
    reader: str
    source: Source


class _Ended(BaseException):
    """The ingest ended this process. No SystemExit, which is a fault of a reader that says it."""


@dataclass(frozen=True, slots=True)
class Ready:
    """The process has begun."""


@dataclass(frozen=True, slots=True)
class Samples:
    """So many more samples were read."""

    count: int


@dataclass(frozen=True, slots=True)
class Done:
    """What became of a file: its raw streams, why it can't be read, or None: whoever asked must read it. warned:
    (text, category, file, line) of warnings meanwhile."""

    streams: list[RawStream] | Exception | None
    warned: tuple[tuple[str, type[Warning], str, int], ...] = ()


class _Progress(TextProgress):
    """Tells of samples from time to time."""

    def __init__(self, tell: Callable[[Samples], None]) -> None:
        super().__init__(lambda _: None)
        self._tell, self._count, self._next = tell, 0, 0.0

    def samples(self, count: int) -> None:
        self._count += count
        if time.monotonic() >= self._next:
            self.flush()

    def flush(self) -> None:
        """Tells what is left."""
        if self._count:
            self._tell(Samples(self._count))
        self._count, self._next = 0, time.monotonic() + _TELL_S


def read(task: Task, tell: Callable[[Samples], None]) -> Done:
    """Reads one file as the ingest itself would."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            streams: list[RawStream] | Exception | None = _read_task(task, tell)
        except Exception as error:
            streams = error
    return Done(streams, tuple((str(w.message), w.category, w.filename, w.lineno) for w in caught))


def _read_task(task: Task, tell: Callable[[Samples], None]) -> list[RawStream] | None:
    try:
        reader: Reader = find_reader(task.reader)
    except UsageError:
        return None
    if raw_key(task.file.sha256, reader, task.source) != task.key:
        return None  # not the reader that was asked for
    told = _Progress(tell)
    try:
        try:
            return read_raw(
                task.store,
                task.file.path,
                task.path,
                task.file.sha256,
                counted(reader, told),
                task.source,
                task.file.check,
            )
        except (FormatError, PluginError):
            task.file.check()  # half of a file that is being written may look like a damaged one
            raise
    except ChangedError:
        return None
    finally:
        told.flush()


def main() -> None:
    """Reads tasks from stdin until it ends."""
    # what a reader prints must not get between the answers. Held until the end: whoever hears this pipe close takes the
    # process for dead and kills it, and it would leave half of a file
    out = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    try:
        with suppress(_Ended):
            _work(out)
    finally:
        drop_unfinished()
        forget_unpacked()
        # without the interpreter's own end, which waits in vain for the thread that listens
        os._exit(0)


def _work(out: BinaryIO) -> None:
    signal.signal(signal.SIGTERM, _end)
    tasks: SimpleQueue[Task | None] = SimpleQueue()
    sys.path[:] = pickle.load(sys.stdin.buffer)
    _send(out, Ready())
    threading.Thread(target=_listen, args=(sys.stdin.buffer, tasks), daemon=True).start()
    while (task := tasks.get()) is not None:
        _send(out, read(task, lambda samples: _send(out, samples)))


def _listen(incoming: BinaryIO, tasks: SimpleQueue[Task | None]) -> None:
    try:
        while True:
            tasks.put(pickle.load(incoming))
    except Exception:  # whoever asks is gone
        tasks.put(None)
        if hasattr(signal, "pthread_kill"):
            signal.pthread_kill(threading.main_thread().ident or 0, signal.SIGTERM)
            time.sleep(_ENDING_S)  # for the file in hand to be given up; a library may hear of nothing meanwhile
        drop_unfinished()
        forget_unpacked()
        os._exit(1)


def _send(out: BinaryIO, what: Any) -> None:
    try:
        data = pickle.dumps(what)
    except Exception:  # an error of a plugin's own that holds what can't be sent
        data = pickle.dumps(Done(None))
    try:
        out.write(data)
        out.flush()
    except OSError:
        raise _Ended from None


def _end(*_: object) -> None:
    raise _Ended
