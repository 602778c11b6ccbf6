"""Files read side by side, each by a process of its own: as many as there are cores and room in memory."""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import subprocess
import sys
import threading
import warnings
from collections.abc import Callable, Iterator
from queue import SimpleQueue

from thermodata.errors import FormatError
from thermodata.store.ingest.reading.worker import Done, Ready, Samples, Task
from thermodata.store.raw.raw_stream import RawStream

_START = "from thermodata.store.ingest.reading.worker import main; main()"
MOST = 8
_ROOM = 1 << 30  # [bytes] of memory for a worker: its reader, and row groups on their way
# what a file, a byte and a worker cost [s]: a few small files are read sooner than a process starts
_FILE_S, _BYTE_S, _WORTH_S = 0.01, 1 / 30e6, 3.0
_ENDING_S = 5.0
_TRIES = 2


def workers_for(files: int, size_bytes: int) -> int:
    """How many processes read that much; 0 where it isn't worth starting any. THERMODATA_WORKERS says it otherwise."""
    said = os.environ.get("THERMODATA_WORKERS", "")
    if said.isdigit():
        most = int(said) if int(said) > 1 else 0
    elif files * _FILE_S + size_bytes * _BYTE_S < _WORTH_S:
        most = 0
    else:
        most = min(MOST, _cores(), _available() // _ROOM)
    return min(most, files) if min(most, files) > 1 and sys.executable else 0


def _cores() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _available() -> int:
    """Memory that is free or can be made free [bytes]; where the system doesn't tell, enough."""
    with contextlib.suppress(OSError, ValueError, IndexError), open("/proc/meminfo", encoding="ascii") as file:
        return next(1024 * int(line.split()[1]) for line in file if line.startswith("MemAvailable"))
    return MOST * _ROOM


def read_side_by_side(
    tasks: Iterator[Task], workers: int, tell: Callable[[int], None]
) -> Iterator[tuple[Task, list[RawStream] | Exception | None]]:
    """Each task with what became of it, as they are finished: raw streams, an error, or None where the caller must
    read the file itself. tell: how many more samples were read.

    A file that ends the process that reads it is tried once more, and is then one that can't be read.
    """
    pool = _Pool(workers)
    try:
        underway = 0
        more: Task | None = next(tasks, None)
        while underway or more is not None:
            while more is not None and underway < 2 * workers:  # the next file is hashed while others are read
                pool.tasks.put(more)
                underway += 1
                more = next(tasks, None)
            answer = pool.answers.get()
            if isinstance(answer, Samples):
                tell(answer.count)
                continue
            task, done = answer
            underway -= 1
            for text, category, file, line in done.warned:
                warnings.warn_explicit(text, category, file, line)
            yield task, done.streams
    finally:
        pool.end()


class _UnusableError(Exception):
    """No process of this program can be started here."""


class _Pool:
    """Processes, and a thread for each that hands it one task after the other."""

    def __init__(self, workers: int) -> None:
        self.tasks: SimpleQueue[Task | None] = SimpleQueue()
        self.answers: SimpleQueue[Samples | tuple[Task, Done]] = SimpleQueue()
        self._processes: dict[int, subprocess.Popen[bytes]] = {}
        self._ready: dict[int, subprocess.Popen[bytes]] = {}
        self._unusable = False
        self._ending = threading.Event()
        self._guard = threading.Lock()
        self._threads = [threading.Thread(target=self._serve, args=(i,), daemon=True) for i in range(workers)]
        for thread in self._threads:
            thread.start()

    def end(self) -> None:
        """Ends all processes; what one has begun is dropped, and no half of it stays."""
        self._ending.set()
        for _ in self._threads:
            self.tasks.put(None)
        with self._guard:
            processes = list(self._processes.values())
        for process in processes:
            with contextlib.suppress(OSError):
                process.terminate()
        for process in processes:
            try:
                process.wait(_ENDING_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        for thread in self._threads:
            thread.join(_ENDING_S)
        for pipe in (p for process in processes for p in (process.stdin, process.stdout) if p is not None):
            with contextlib.suppress(OSError):
                pipe.close()

    def _serve(self, number: int) -> None:
        while (task := self.tasks.get()) is not None and not self._ending.is_set():
            done = Done(None)
            for _ in range(_TRIES):
                try:
                    done = self._ask(number, task)
                    break
                except _UnusableError:
                    break
                except (EOFError, OSError, pickle.UnpicklingError):
                    done = Done(self._ended(number, task))
                if self._ending.is_set():
                    return
            self.answers.put((task, done))

    def _ask(self, number: int, task: Task) -> Done:
        process = self._ready.get(number) or self._started(number)
        assert process.stdin is not None
        assert process.stdout is not None
        process.stdin.write(pickle.dumps(task))
        process.stdin.flush()
        while not isinstance(answer := pickle.load(process.stdout), Done):
            self.answers.put(answer)
        return answer

    def _started(self, number: int) -> subprocess.Popen[bytes]:
        try:
            with self._guard:
                if self._ending.is_set() or self._unusable:
                    raise _UnusableError
                # a session of its own: Ctrl-C is the ingest's, which ends its workers
                process = subprocess.Popen(
                    [sys.executable, "-P", "-c", _START],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    start_new_session=True,
                )
                self._processes[number] = process
            assert process.stdin is not None
            assert process.stdout is not None
            process.stdin.write(pickle.dumps(sys.path))
            process.stdin.flush()
            if isinstance(pickle.load(process.stdout), Ready):
                self._ready[number] = process
                return process
        except (EOFError, OSError, pickle.UnpicklingError) as error:
            self._unusable = True
            raise _UnusableError from error
        raise _UnusableError

    def _ended(self, number: int, task: Task) -> Exception:
        """Why a worker ended in the middle of a file."""
        with self._guard:
            process = self._processes.pop(number)
            del self._ready[number]
        with contextlib.suppress(OSError):
            process.kill()
        code = process.wait()
        return FormatError(
            "reading it ended the process that read it",
            where=task.path,
            expected="a file that its reader can read or refuse",
            got=_signal(-code) if code < 0 else f"exit code {code}",
            hint="look whether the file is damaged, or larger than memory allows: thermodata preview FILE",
        )


def _signal(number: int) -> str:
    try:
        return f"signal {number} ({signal.Signals(number).name})"
    except ValueError:
        return f"signal {number}"
