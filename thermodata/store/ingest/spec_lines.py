"""Losses that the campaign file made, with their line in it: a channel whose signal no file has."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from thermodata.errors import ThermodataError
from thermodata.schema.lines import read_document

_OF_CHANNEL = re.compile(r"channel '([^']+)': ")


def with_lines(losses: list[dict[str, Any]], path: Path) -> list[dict[str, Any]]:
    """The same rows; those of a channel name file and line where the campaign file is there to be read."""
    of_channel = [(row, found[1]) for row in losses if (found := _OF_CHANNEL.match(row["reason"])) and not row["file"]]
    if not of_channel or not path.is_file():
        return losses
    try:
        lines = read_document(path).line
    except (ThermodataError, OSError):
        return losses
    for row, channel in of_channel:
        line = lines.get(("channels", channel))
        if line is not None:
            row["file"], row["where"] = path.name, f"line {line}"
    return losses
