"""The command that does what a page does, as it is typed."""

from __future__ import annotations

import shlex
from pathlib import Path

from thermodata.web.desk import DEFAULT_STORE


def command(store: Path, *words: str | Path) -> str:
    """'thermodata tests -c gantry'; names the store where it is not the one that a terminal would take."""
    named = [] if store == Path.cwd() / DEFAULT_STORE else ["--store", str(store)]
    return shlex.join(["thermodata", *named, *(str(w) for w in words)])
