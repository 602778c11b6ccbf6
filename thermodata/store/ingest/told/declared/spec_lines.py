"""Losses that the campaign file made, with their line in it: a channel whose signal no file has, a window behind the
end of its recording, a `measuring` that a test can't evaluate."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from thermodata.errors import ThermodataError
from thermodata.schema.strict.lines import Document, Place, read_document

_OF_CHANNEL = re.compile(r"channel '([^']+)': ")
_OF_TEST = {
    "window": re.compile(r"no rows of '[^']+' lie in the test's window"),
    "measuring": re.compile("measuring: "),
}


def with_lines(losses: list[dict[str, Any]], path: Path) -> list[dict[str, Any]]:
    """The same rows; those of a channel, or of a key of their test, name file and line where the campaign file is there
    to be read."""
    of_file = [row for row in losses if not row["file"] and (_OF_CHANNEL.match(row["reason"]) or _key(row))]
    if not of_file or not path.is_file():
        return losses
    try:
        document = read_document(path)
    except (ThermodataError, OSError):
        return losses
    for row in of_file:
        line = document.line.get(_place(row, document))
        if line is not None:
            row["file"], row["where"] = path.name, f"line {line}"
    return losses


def _key(row: dict[str, Any]) -> str | None:
    return next((key for key, said in _OF_TEST.items() if row["test"] and said.match(row["reason"])), None)


def _place(row: dict[str, Any], document: Document) -> Place:
    channel, key = _OF_CHANNEL.match(row["reason"]), _key(row)
    if channel is not None:
        return ("channels", channel[1])
    tests = document.data.get("tests")
    found = [i for i, test in enumerate(tests or []) if isinstance(test, dict) and test.get("id") == row["test"]]
    return ("tests", found[0], str(key)) if found else ()
