"""Texts whose cells are parted by nothing but how wide they are: no delimiter finds them all."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import PurePath

from thermodata.reader.text.cells.lines.delimiter import find_delimiter
from thermodata.reader.text.file.foreign_texts import foreign_text

_FEWEST_FIXED, _RAGGED, _NEARLY_ALL = 5, 0.15, 0.8


def fixed_width(lines: Sequence[str]) -> bool:
    """Whether nothing but blanks parts the cells of lines that are all as long, some cells being empty or joined."""
    full = [line.rstrip("\r\n") for line in lines if line.strip()][:-1]  # the last one may be cut
    if len(full) < _FEWEST_FIXED or any(c in line for line in full for c in ",;|\t"):
        return False
    width = max(map(len, full))
    numbers = sum(len(re.findall(r"(?<![\w.])[+-]?\d+(?:\.\d+)?", line)) > 2 for line in full)
    alike = sum(abs(len(line) - width) <= _RAGGED * width for line in full)
    even = min(numbers, alike) >= _NEARLY_ALL * len(full)
    return even and foreign_text(lines) is None and find_delimiter(full) is None


def by_width(name: str) -> str:
    """What to do with a text of fixed width."""
    return (
        'make a CSV of its columns of fixed width: python -c "import pandas; '
        f"pandas.read_fwf('{name}').to_csv('{PurePath(name).stem}.csv', index=False)\", and see that none is cut in two"
    )
