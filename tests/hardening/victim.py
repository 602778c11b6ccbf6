"""A process to be killed: `victim.py OP STORE ARGUMENT [--die-at N]`.

OP: ingest, forget, gc, migrate, snapshot. It prints `ready`, works, and prints `steps N`. With --die-at it kills
itself with SIGKILL at the N-th step: a file made, renamed or removed in the store, or either side of a commit.

`victim.py serve` does so in a process of its own for each line of words (JSON), forked from one that has imported what
they need, and answers with a line: the exit code, and what was said.
"""

from __future__ import annotations

import argparse
import importlib
import json
import os
import signal
import sys
import tempfile
import traceback
from collections.abc import Sequence
from pathlib import Path
from typing import Any

EVENTS = ("open", "os.rename", "os.remove", "os.mkdir", "os.rmdir")


class Steps:
    """Counts, and dies when its time has come."""

    def __init__(self, folder: Path, die_at: int) -> None:
        self.folder, self.die_at, self.count, self.on = str(folder), die_at, 0, False

    def step(self) -> None:
        if self.on:
            self.count += 1
            if self.count == self.die_at:
                os.kill(os.getpid(), signal.SIGKILL)

    def audit(self, event: str, details: tuple[Any, ...]) -> None:
        if self.on and event in EVENTS and str(details[0]).startswith(self.folder):
            self.step()


class Watched:
    """A DuckDB connection; a step before and after each commit."""

    def __init__(self, con: Any, steps: Steps) -> None:
        self._con, self._steps = con, steps

    def __getattr__(self, name: str) -> Any:
        return getattr(self._con, name)

    def execute(self, query: str, *more: Any) -> Any:
        if query != "commit":
            return self._con.execute(query, *more)
        self._steps.step()
        done = self._con.execute(query, *more)
        self._steps.step()
        return done


def serve() -> None:
    for name in ("ingest.run", "keep.forget", "keep.gc", "keep.snapshot", "views.regenerate"):
        importlib.import_module(f"thermodata.store.{name}")
    for line in sys.stdin:
        with tempfile.TemporaryFile() as said:
            pid = os.fork()
            if not pid:
                signal.alarm(120)
                os.dup2(said.fileno(), 1)
                os.dup2(said.fileno(), 2)
                code = 1
                try:
                    main(json.loads(line))
                    code = 0
                except BaseException:
                    traceback.print_exc()
                finally:
                    sys.stdout.flush()
                    sys.stderr.flush()
                    os._exit(code)
            code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
            said.seek(0)
            print(json.dumps([code, said.read().decode()]), flush=True)


def main(words: Sequence[str]) -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("op")
    parser.add_argument("store", type=Path)
    parser.add_argument("argument")
    parser.add_argument("--die-at", type=int, default=0)
    parser.add_argument("--fakes", default="", help="a folder with store_fakes.py")
    given = parser.parse_args(words)
    if given.fakes:
        sys.path.insert(0, given.fakes)
        importlib.import_module("store_fakes").install()

    from thermodata.store import Store
    from thermodata.store.base import connection
    from thermodata.store.catalogue.format import migrate
    from thermodata.store.ingest.run import ingest
    from thermodata.store.keep.forget import forget
    from thermodata.store.keep.gc import gc
    from thermodata.store.keep.snapshot import snapshot

    steps = Steps(given.store.absolute().parent, given.die_at)
    right = connection.memory
    connection.memory = lambda folder: Watched(right(folder), steps)  # type: ignore[assignment,return-value]
    sys.addaudithook(steps.audit)
    if given.op == "ingest":
        # what is imported late would be counted as a part of the work
        importlib.import_module("thermodata.store.views.regenerate")
    store = Store(given.store, create=given.op == "ingest")
    print("ready", flush=True)
    steps.on = True
    if given.op == "ingest":
        ingest(store, Path(given.argument))
    elif given.op == "forget":
        campaign, _, test = given.argument.partition("/")
        forget(store, campaign, test or None)
    elif given.op == "gc":
        gc(store, grace_s=0)
    elif given.op == "snapshot":
        snapshot(store, given.argument)
    elif given.op == "migrate":
        migrate.STEPS[migrate.FORMAT] = "alter table test add column shift varchar; update test set shift = 'early'"
        migrate.FORMAT += 1
        with store.write() as con:
            con.execute("update campaign set data_version = data_version")
    steps.on = False
    print(f"steps {steps.count}", flush=True)


if __name__ == "__main__":
    if sys.argv[1:] == ["serve"]:
        serve()
    else:
        main(sys.argv[1:])
