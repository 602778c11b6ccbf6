"""Logs that the tests of several formats write, and the values that were read of them."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from thermodata_reader_cnc import Reader

from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

START_S = 1_772_438_400  # 2026-03-02T08:00:00Z


def written(folder: Path, text: str, name: str, encoding: str = "utf-8") -> Path:
    path = folder / name
    path.write_bytes(text.encode(encoding))
    return path


def iso(k: int) -> str:
    """Second k of a message."""
    return str(np.datetime64(START_S + k, "s")) + "Z"


def stamp(k: float) -> str:
    """Second k of a row, to the millisecond; of the first hour."""
    return f"2026-03-02T08:{int(k) // 60:02d}:{k % 60:06.3f}Z"


def messages_written(folder: Path, messages: Sequence[Any], name: str = "log.jsonl") -> Path:
    """A line of JSON each; a text stands as it is."""
    text = "".join((m if isinstance(m, str) else json.dumps(m)) + "\n" for m in messages)
    return written(folder, text, name)


def read_messages(folder: Path, messages: Sequence[Any], source: Source | None = None) -> Data:
    return load(Reader(), messages_written(folder, messages), source or Source())


def read_long(folder: Path, header: str, rows: Sequence[str], source: Source | None = None) -> Data:
    """A long table, read as of UTC where nothing else is declared."""
    path = written(folder, "\n".join([header, *rows, ""]), "long.csv")
    return load(Reader(), path, source or Source(timezone="UTC"))


def values(data: Data) -> dict[str, list[Any]]:
    """Signal -> its values, whatever its stream."""
    return {name: column.tolist() for (_, name), column in data.values.items()}
