"""Runs a part of a check in processes of its own: side by side, or with bounded memory and time."""

from __future__ import annotations

import multiprocessing
import os
import sys
import warnings
from collections.abc import Callable
from multiprocessing.connection import Connection
from multiprocessing.synchronize import Barrier
from pathlib import Path

WAIT_S = 120.0
Task = Callable[[], str | None]


def together(task: Task, count: int = 1, memory_mib: int | None = None) -> list[str | None]:
    """What `task` answered (None: well) in `count` processes that start together.

    memory_mib: address space that each may take beside what it has. A process that dies or hangs is an answer too.
    Where processes cannot be forked (Windows) the task runs here, without bounds.
    """
    if "fork" not in multiprocessing.get_all_start_methods():
        return [task() for _ in range(count)]
    context = multiprocessing.get_context("fork")  # the reader may be a class of a test module: not to be pickled
    children, gate = [], context.Barrier(count)
    for _ in range(count):
        here, there = context.Pipe(duplex=False)
        child = context.Process(target=_run_in_child, args=(task, there, gate, memory_mib), daemon=True)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # threads of libraries that are idle
            child.start()
        there.close()
        children.append((child, here))
    answers: list[str | None] = []
    for child, here in children:
        try:
            answers.append(here.recv() if here.poll(WAIT_S) else f"no end after {WAIT_S:g} s")
        except EOFError:
            child.join()
            answers.append(f"the process died (exit code {child.exitcode})")
        finally:
            child.kill()
            child.join()
            here.close()
    return answers


def _run_in_child(task: Task, answer: Connection, gate: Barrier, memory_mib: int | None) -> None:
    if memory_mib is not None and sys.platform == "linux":
        import resource

        pages = int(Path("/proc/self/statm").read_text("ascii").split()[0])
        hard = resource.getrlimit(resource.RLIMIT_AS)[1]
        resource.setrlimit(resource.RLIMIT_AS, (pages * os.sysconf("SC_PAGE_SIZE") + memory_mib * 2**20, hard))
    try:
        gate.wait(WAIT_S)
        said = task()
    except BaseException as error:
        said = str(error) if isinstance(error, AssertionError) else f"{type(error).__name__}: {error}"
    answer.send(said)
    answer.close()
