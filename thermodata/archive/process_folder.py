"""A temporary folder that goes with its process, one that is killed too: the next process deletes what that left.

Each holds the lock of a file in its folder for as long as it lives; where there are no such locks, a killed one leaves
its folder to the system.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from contextlib import suppress
from pathlib import Path

_IN_USE = "in-use"


def process_folder(what: str) -> Path:
    """A new folder of this process. It has its name once its lock is held: before, nobody looks at it."""
    prefix, unnamed = f"thermodata-{what}-", f"thermodata-new-{what}-"
    _delete_left(prefix)
    made = Path(tempfile.mkdtemp(prefix=unnamed))
    with suppress(ImportError, OSError):
        import fcntl

        lock = os.open(made / _IN_USE, os.O_CREAT | os.O_RDWR)
        fcntl.flock(lock, fcntl.LOCK_EX)  # for as long as this process
    return made.rename(made.with_name(made.name.replace(unnamed, prefix, 1)))


def _delete_left(prefix: str) -> None:
    """Deletes the folders whose lock nobody holds."""
    for left in Path(tempfile.gettempdir()).glob(f"{prefix}*"):
        with suppress(ImportError, OSError):
            import fcntl

            lock = os.open(left / _IN_USE, os.O_RDWR)
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                shutil.rmtree(left, ignore_errors=True)
            finally:
                os.close(lock)
