"""Tests that a lab numbers by one letter: the Z of 'Z10_cooling' in a folder of Z00 to Z12 is no axis."""

from __future__ import annotations

import re
from collections.abc import Sequence

_NUMBER = re.compile(r"([A-Za-z])(\d{1,3})(?:[ _\-.]+)(?=\S)")
_FEWEST = 3
_MOST_OTHERS = 0.2  # of the tests, that are called otherwise
_MOST_LEFT_OUT = 3.0  # times as large as their number may be the largest: feeds and angles are larger


def without_number(tests: Sequence[str]) -> dict[str, str]:
    """Test -> its name without the letter and number that all tests are numbered by; as it is where they are not."""
    same, found = {t: t for t in tests}, {t: m for t in tests if (m := _NUMBER.match(t))}
    numbers = {int(m[2]) for m in found.values()}
    numbered = (
        len(numbers) == len(found) >= max(_FEWEST, (1 - _MOST_OTHERS) * len(same))
        and len({m[1] for m in found.values()}) == 1
        and max(numbers) <= _MOST_LEFT_OUT * len(found)
    )
    return same | {t: t[m.end() :] for t, m in found.items()} if numbered else same
