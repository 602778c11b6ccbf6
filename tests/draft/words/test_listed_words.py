"""A list of words is looked for as its one expression would find it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from thermodata.draft.words import listed, vocabulary
from thermodata.draft.words.listed import beyond, holds_word
from thermodata.draft.words.naming import words

NAMES = [
    words(line.split("|")[column])
    for file, column in (("names.txt", 0), ("names_of_languages.txt", 1))
    for line in (Path(__file__).parents[1] / "signals" / file).read_text("utf-8").splitlines()[::4]
    if line and not line.startswith("#")
]
LISTS = (
    *vocabulary.QUANTITY_WORDS.values(),
    *vocabulary.PLACE_WORDS.values(),
    *(line for _, line in vocabulary.FOREIGN),
    vocabulary.SETPOINT,
    vocabulary.LIMIT,
    vocabulary.DIFFERENCE,
    vocabulary.OF_CONTROL,
)


def test_the_vocabulary_is_found_as_by_one_expression() -> None:
    for line in LISTS:
        one: re.Pattern[str] = listed._pattern(line)
        assert [n for n in NAMES if holds_word(line, n)] == [n for n in NAMES if one.search(n)], line[:40]


@pytest.mark.parametrize(
    ("line", "name", "held"),
    [
        ("lager", "spindellager vorn", True),
        ("nut.", "nut x", True),
        ("nut.", "minute", False),
        ("nut.", "nuts", False),
        ("^hall", "hallenluft", True),
        ("^hall", "schall", False),
        ("^on.", "door on", True),
        ("^on.", "motor one", False),
        ("pt~100", "t pt 100", True),
        ("pt~100", "pt100", True),
        ("pt~100", "opt 100", False),
        ("pt~100", "pt 1000", False),
        ("flow~", "flow meter", True),
        ("flow~", "flowmeter", True),
        ("flow~", "overflow", False),
        ("speed.~act", "speed act", True),
        ("speed.~act", "speed actual", False),
        ("^vod[ay].", "vody", True),
        ("^vod[ay].", "vodyx", False),
        ("(?<!ve[r])lager", "verlager", False),
        ("(?<!ve[r])lager", "lager", True),
        ("^feed~rate", "feedrates", True),
        ("^feed~rate", "the feed rate", True),
        ("^feed~rate", "offeed rate", False),
        ("a.b", "axb", False),
    ],
)
def test_a_mark_says_where_a_word_may_stand(line: str, name: str, held: bool) -> None:
    assert holds_word(line, name) is held
    assert holds_word(f"zzz. {line} ^qqq yyy", name) is held  # beside others of the list
    assert (listed._pattern(line).search(name) is not None) is held


def test_what_none_of_the_words_touches_is_beyond_them() -> None:
    assert beyond("spindle~speed pt~100", "speed of spindle speed pt 100") == ("speed", "of")
