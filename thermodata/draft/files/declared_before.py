"""What a campaign file says that stands there already; it need not be finished, nor load."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path


def declared_before(path: Path, written: re.Pattern[str], is_one: Callable[[str], bool]) -> str | None:
    """The one value that a file declares; None where it declares none, or several. written: has the value in its one
    group. is_one: what else stands there is no value."""
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
    except OSError:
        return None
    declared = {value for value in written.findall(text) if is_one(value)}
    return declared.pop() if len(declared) == 1 else None
