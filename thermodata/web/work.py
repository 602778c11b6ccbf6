"""Long work in processes of their own: what it is at, how it ended, and an end at any moment.

A store is whole whatever kills a writer, so to cancel is to kill; and a child that loses its parent ends by itself.
"""

from __future__ import annotations

import json
import secrets
import subprocess
import sys
import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from thermodata.errors import UsageError, unknown_name

MOST_AT_ONCE = 2
_KEPT = 50


@dataclass(slots=True)
class Job:
    """state: running, done, failed or cancelled. share: 0 to 1, None where it can't be told. onward: the page that
    shows the result. error: what, where, expected, got and hint of what failed."""

    identity: str
    task: str
    what: str
    state: str = "running"
    progress: str = ""
    share: float | None = None
    result: dict[str, Any] = field(default_factory=dict)
    error: dict[str, Any] = field(default_factory=dict)
    onward: str = ""
    process: subprocess.Popen[str] | None = field(default=None, repr=False)

    @property
    def running(self) -> bool:
        return self.state == "running"


class Work:
    """The jobs of one workbench."""

    def __init__(self) -> None:
        self._jobs: dict[str, Job] = {}
        self._guard = threading.Lock()

    def start(self, task: str, what: str, store: Path, arguments: Mapping[str, Any]) -> Job:
        """Begins. what: in words for a person. UsageError where too much runs already, or the same."""
        with self._guard:
            running = [j for j in self._jobs.values() if j.running]
            if len(running) >= MOST_AT_ONCE:
                raise UsageError(
                    "other work is still running",
                    got=", ".join(j.what for j in running),
                    hint="wait for it, or cancel it",
                )
            process = subprocess.Popen(
                # -P: a module that lies in the working folder, which may be one of somebody's data, is not imported
                [sys.executable, "-P", "-m", "thermodata.web.child"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.DEVNULL,
                text=True,
            )
            job = Job(secrets.token_urlsafe(12), task, what, process=process)
            self._jobs[job.identity] = job
            for old in list(self._jobs)[:-_KEPT]:
                if not self._jobs[old].running:
                    del self._jobs[old]
        assert process.stdin is not None
        # the pipe stays open: its end tells the child that nobody waits any more
        process.stdin.write(json.dumps({"task": task, "store": str(store), "arguments": dict(arguments)}) + "\n")
        process.stdin.flush()
        threading.Thread(target=self._follow, args=(job, process), daemon=True).start()
        return job

    def job(self, identity: str) -> Job:
        """UsageError where there is none: the workbench was started again since."""
        job = self._jobs.get(identity)
        if job is None:
            raise unknown_name("work", identity, [])
        return job

    def cancel(self, identity: str) -> Job:
        """Ends it where it still runs."""
        job = self.job(identity)
        with self._guard:
            if job.running:
                job.state = "cancelled"
        if job.process is not None:
            job.process.kill()
        return job

    def close(self) -> None:
        """Ends all that runs."""
        for identity in list(self._jobs):
            self.cancel(identity)

    def _follow(self, job: Job, process: subprocess.Popen[str]) -> None:
        assert process.stdout is not None
        last: dict[str, Any] = {}
        for line in process.stdout:
            last = json.loads(line)
            if "progress" in last:
                job.progress, job.share = last["progress"], last["share"]
        code = process.wait()
        with self._guard:
            if not job.running:
                return
            if "result" in last:
                job.result, job.onward, job.state = last["result"], last["result"].get("onward", ""), "done"
                return
            job.error = {"where": None, "expected": None, "got": None, "hint": None} | last.get(
                "error", {"what": "the work ended before it was done", "got": f"exit code {code}"}
            )
            job.state = "failed"
