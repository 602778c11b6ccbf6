"""The questions of a campaign file as the fields of a form, and what was filled in."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from thermodata.draft.probes.which_way import ways
from thermodata.draft.writing.questions import Question, only_in_file, questions
from thermodata.draft.writing.unread import WHAT
from thermodata.errors import UsageError

_ANSWER, _STEP, _SO = "answer.", "step.", "so."
# (title, which questions, what they decide)
GROUPS = (
    (
        "The machine and its clocks",
        ("text", "zone", "time"),
        "A log in local time needs its zone, or nothing lines up.",
    ),
    ("Jump tests", ("moves",), "The commanded moves, signed, in machine coordinates: 100 um, 50 um, -200 um"),
    (
        "What was logged",
        ("what", "unit"),
        "A signal whose quantity nobody says is left out. The unit stands in brackets: feed [m/min].",
    ),
    (
        "Where the sensors are",
        ("axis", "way", "place"),
        "An effect is tried only where a sensor sits at its place. Leave empty what nobody knows: it drives nothing. "
        "The axis of a displacement says which screw moves it, and the way that its probe looks gives its sign: where "
        "the target on the tool side goes away along +Z, a probe that looks along +Z sees its gap grow.",
    ),
    (
        "The tests",
        ("kind", "moment", "start", "role"),
        "What heats one part alone is fitted (calibration); a working day checks it (verification); one that nobody "
        "has looked at is kept for the last word (locked). One that began before the machine had cooled starts warm.",
    ),
)
# role, start of a test, or way of a probe -> what it means
WORDS = {
    "calibration": "calibration: fitted",
    "verification": "verification: checked",
    "locked": "locked: kept for the last word",
    "none": "none: kept only",
    "balance": "balance: it was at rest",
    "warm": "warm: it had not cooled",
    **{way: f"looks along {way.replace(', ', ', reads more with the ')}" for way in ways(None)},
}
# what is asked -> what it is called
KEYS = {
    "table.time.unit": "unit of its times",
    "table.time.format": "format of its dates and times",
    "table.time.start": "its start, from the head",
    "table.time.period": "time from row to row",
    "sign": "the way that it counts",
}
# of the machine, for the schematic: the first parts of places that are drawn
BODIES = ("column", "headstock", "spindle", "ram", "axis", "table", "bed", "hall", "coolant")


def form_state(path: Path, text: str | None) -> dict[str, Any]:
    """What the form shows of a campaign file; text: None where there is none yet."""
    asked = questions(text) if text is not None else []
    in_file = only_in_file(text) if text is not None else []
    return {
        "path": path,
        "groups": [(title, _open_first(asked, kinds), why) for title, kinds, why in GROUPS],
        "in_file": in_file,
        "open_ones": sum(q.open for q in asked) + len(in_file),
        "bodies": {body: sum(q.value.startswith(body) for q in asked if q.kind == "place") for body in BODIES},
        "words": WORDS,
        "keys": KEYS,
        "what": WHAT,
        "answer": _ANSWER,
        "so": _SO,
    }


def _open_first(asked: list[Question], kinds: tuple[str, ...]) -> list[Question]:
    """Of sensors, what nobody has answered before what was guessed; all else in the order of the file."""
    own = [q for q in asked if q.kind in kinds]
    return sorted(own, key=lambda q: not q.open) if "place" in kinds else own


def answered(form: dict[str, str], asked: list[Question]) -> dict[str, str]:
    """What differs from what stands there, and what stands there rightly; a name that is no question is refused by
    `filled_in`."""
    stands = {q.name: q.value for q in asked}
    given = {k.removeprefix(_ANSWER): v.strip() for k, v in form.items() if k.startswith(_ANSWER)}
    given |= _moves(form)
    return {name: value for name, value in given.items() if value != stands.get(name) or _SO + name in form}


def _moves(form: dict[str, str]) -> dict[str, str]:
    """The moves of each jump test from the fields of its steps; UsageError where only some are filled in."""
    steps: dict[str, dict[int, str]] = {}
    for field, value in form.items():
        if field.startswith(_STEP):
            name, _, number = field.removeprefix(_STEP).rpartition(".")
            if not number.isdecimal() or "," in value:
                raise UsageError("a step has one move", where=field, expected="such as 100 um", got=value)
            steps.setdefault(name, {})[int(number)] = value.strip()
    moves = {}
    for name, each in steps.items():
        ordered = [each[k] for k in sorted(each)]
        if not any(ordered):
            continue
        if not all(ordered):
            lacking = [str(k + 1) for k in sorted(each) if not each[k]]
            raise UsageError(
                "a jump test needs the move of every step",
                where=name,
                got=f"none at step {', '.join(lacking)}",
                hint="give each the way from where the axis stood, such as 100 um or -100 um",
            )
        moves[name] = ", ".join(ordered)
    return moves
