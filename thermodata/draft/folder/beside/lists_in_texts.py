"""The lines of a text that say what signals are: a list, names in brackets, or names in the prose of a note."""

from __future__ import annotations

import re
from collections.abc import Sequence, Set

from thermodata.draft.words.naming import words
from thermodata.draft.words.vocabulary import places_in

_FEWEST = 3
_LISTED = re.compile(r"\W*(?P<name>[\w.]+)\s*(?:->|=>|→|=|:)\s*(?P<text>\S.*)")  # a line of 'CH1 -> bearing [degC], X'
_BRACKETED = re.compile(r"\W*(?P<text>[^():=]*\w)\s*\((?P<name>[\w.]+)\)\s*[:=]\s*(?P<more>\S.*)")
_PIECES = re.compile(r"[;,.]\s+|\.$|\t|\s{3,}")
# 'T01 Spindellager vorn', 'Temperatures: T1 = bed': a name of a letter and a digit, for 'bed warm' has none
_IN_PROSE = re.compile(
    r"(?:[^:=]{1,40}:\s+)?\W*(?P<name>(?=\w*\d)[^\W\d]\w*)\s*(?:->|=>|→|=|:|–|-|(?<=\w)\s)\s*(?P<text>[^\W\d].*)"
)
_MOST_WORDS = 8  # that say what a signal is


def listed(lines: Sequence[str], most: int) -> list[list[str]]:
    """The lines of a list ('CH1 -> spindle bearing [degC]') as rows of a name and words; none where few are such."""
    full = [line for line in lines if line]
    rows = [[m["name"], m["text"].strip()] for line in full if (m := _LISTED.fullmatch(line))]
    return rows if len(full) <= most and 2 * len(rows) > len(full) else []


def bracketed(lines: Sequence[str], most: int) -> list[list[str]]:
    """The lines of a text, among any others, that have a name in brackets ('top of the bed (T04): bed.top') as rows of
    a name, the words before it and those behind; none where few are such."""
    named = [m for line in lines[:most] if (m := _BRACKETED.fullmatch(line))]
    return [[m["name"], m["text"].strip(), m["more"].strip()] for m in named] if len(named) >= _FEWEST else []


def piped(lines: Sequence[str], most: int) -> list[list[str]]:
    """The rows of a table of Markdown, without the line below its head; none where a text has none."""
    rows = [[c.strip(" *`") for c in line.strip().strip("|").split("|")] for line in lines[:most] if "|" in line]
    full = [row for row in rows if len(row) > 1 and not all(re.fullmatch(r":?-*:?", c) for c in row)]
    return full if len(full) < len(rows) else []


def in_prose(lines: Sequence[str], names: Set[str]) -> list[list[str]]:
    """What lines say of signals, several in a line ('S1 front bearing; S2 = bed'), as rows of a name and words. None
    where few are such, where one is said twice, or where most are no places: 'T1 broke, T2 is fine'. names: what
    signals are called, in lower case."""
    rows = []
    for piece in (piece for line in lines for piece in _PIECES.split(line)):
        named = _IN_PROSE.fullmatch(piece.strip())
        if named is not None and named["name"].casefold() in names and _says_what(named["text"], names):
            rows.append([named["name"], re.split(r"\s\(", named["text"])[0].strip(" .,;")])
    said = {row[0].casefold() for row in rows}
    placed = sum(bool(places_in(words(row[1]))) for row in rows)
    return rows if len(rows) >= _FEWEST and len(said) == len(rows) and 2 * placed > len(rows) else []


def _says_what(text: str, names: Set[str]) -> bool:
    """Whether words may be what one signal is: few, no other signal among them, and a number at their end only."""
    each = text.casefold().split()
    inner = [word.strip("().,;:") for word in each[:-1]]
    return len(each) <= _MOST_WORDS and not names & set(inner) and not re.search(r"\d", " ".join(inner))


__all__ = ["bracketed", "in_prose", "listed", "piped"]
