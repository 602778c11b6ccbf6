"""One piece of work in a process of its own: a request on stdin; on stdout a line of JSON for each step, then one with
the result or the error. It ends with its parent."""

from __future__ import annotations

import json
import os
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

from thermodata.errors import ThermodataError
from thermodata.web.tasks import TASKS


def main() -> int:
    """One task, read as a line of JSON; a line of JSON for each step of it, and for its result or error. Returns the
    exit code."""
    request = json.loads(sys.stdin.readline())
    out, sys.stdout = sys.stdout, sys.stderr  # what a library prints is no answer
    threading.Thread(target=_end_with_parent, daemon=True).start()

    def tell(**line: Any) -> None:
        out.write(json.dumps(line, default=str) + "\n")
        out.flush()

    def progress(what: str, done: int, total: int) -> None:
        tell(progress=f"{done} of {total} {what}" if total else what, share=done / total if total else None)

    task: Callable[..., dict[str, Any]] = TASKS[request["task"]]
    try:
        tell(result=task(Path(request["store"]), progress, **request["arguments"]))
    except ThermodataError as error:
        tell(error={k: getattr(error, k) for k in ("what", "where", "expected", "got", "hint")})
        return error.exit_code
    except Exception as error:
        tell(error={"what": f"a defect in thermodata: {type(error).__name__}: {error}"})
        return 1
    return 0


def _end_with_parent() -> None:
    sys.stdin.read()  # returns when the other end closes
    os._exit(1)


if __name__ == "__main__":
    sys.exit(main())
