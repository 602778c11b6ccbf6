"""What a line of a campaign file asks behind its '# ?': one question by one, and which of them are answered."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from thermodata.draft.writing.in_line import parted

MARK = "# ? "
ANSWERED = "# answered: "
_DONE = "answered: "
# how the questions begin that a draft writes behind another one
_HEADS = (
    r"a difference, not|a limit, or|a set value, not|at: |axis\?|axis: \S+ by|calibration\?|clock: \{|format of the |"
    r"kind[?:] |names: |one log for many tests|each file is of |period: |quantity: |quantity and unit\?|role: |"
    r"stands: |start: |start_state: |time: |timezone\?|unit of the time|unit: |what does it measure\?|"
    r"which way does it count\?"
)
# "facing: ?, increases_with: ?" in the words of a question ends none
_NEXT = re.compile(rf"(?<=\S\?)[,;] |[,;] (?={_DONE}|{_HEADS})")
# a question of a source that refers to the one of another: "timezone? as in 'bed'"
_REFERS = re.compile(r"[^?:;(]+\? as in '(?P<first>[^']+)'")
# key of an answer -> how the questions begin that it answers; any of the line where it stands in none
_OF = {
    "at": "at:",
    "axis": "axis[?:]",
    "files": "one log for many tests|each file is of the tests",
    "format": "format",
    "kind": "kind",
    "period": "period",
    "quantity": "quantity|unit:|what does it measure",
    "role": "role",
    "sign": r"which way does it count|calibration\?",
    "start": "start:",
    "start_state": "start_state:",
    "timezone": "timezone",
    "unit": "unit",
}


@dataclass(frozen=True, slots=True)
class AskedInLine:
    """open, answered: the questions of a line in its own words."""

    open: tuple[str, ...] = ()
    answered: tuple[str, ...] = ()


def asked_in(line: str) -> AskedInLine:
    """What the comment of a line asks."""
    comment = parted(line)[1]
    if comment.startswith(ANSWERED):
        return AskedInLine((), tuple(p.removeprefix(_DONE) for p in _NEXT.split(comment.removeprefix(ANSWERED))))
    if not comment.startswith(MARK):
        return AskedInLine()
    parts = _NEXT.split(comment.removeprefix(MARK))
    done = tuple(p.removeprefix(_DONE) for p in parts if p.startswith(_DONE))
    return AskedInLine(tuple(p for p in parts if not p.startswith(_DONE)), done)


def answers(key: str, question: str) -> bool:
    """Whether a value for a key, as the last name of where it stands, answers a question of its line."""
    return key not in _OF or re.match(_OF[key], question) is not None


def refers_to(question: str) -> str | None:
    """The source whose question is asked for this one too; None of a question of its own."""
    found = _REFERS.fullmatch(question)
    return found["first"] if found is not None else None


def ticked(line: str, keys: Sequence[str]) -> str:
    """The line with the questions ticked off that values for these keys answer; what it asks beside them stays."""
    return ticked_where(line, lambda question: any(answers(k, question) for k in keys))


def ticked_where(line: str, is_answered: Callable[[str], bool]) -> str:
    """The line with the questions ticked off that are answered; what it asks beside them stays."""
    asked = asked_in(line)
    now = [q for q in asked.open if is_answered(q)]
    if not now:
        return line
    still = [q for q in asked.open if q not in now]
    done = [*asked.answered, *now]
    if still:
        return parted(line)[0] + MARK + "; ".join([*still, *(f"{_DONE}{q}" for q in done)])
    return parted(line)[0] + ANSWERED + "; ".join(done)
