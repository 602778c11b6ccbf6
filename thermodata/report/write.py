"""Pages on disk, and figures inside pages."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any


def write_page(out: Path | str, html: str) -> Path:
    """The page's path; a cut write leaves no half page."""
    target = Path(out)
    target.parent.mkdir(parents=True, exist_ok=True)
    part = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        part.write_text(html, encoding="utf-8")
        part.replace(target)
    finally:
        part.unlink(missing_ok=True)
    return target


def script_json(figure: dict[str, Any]) -> str:
    """JSON for inside a script element: '</script>' in a string would end it, '<' as an escape can't."""
    return json.dumps(figure, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")
