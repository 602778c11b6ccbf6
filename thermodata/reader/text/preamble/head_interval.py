"""Lines above a table that say the time from row to row: 'Sample interval: 2 s', 'Abtastrate;10 Hz'. It is proposed
where no column tells the time, never taken: rows may be left out, or the setting may be another logger's."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

import numpy as np

from thermodata.errors import QuestionError
from thermodata.reader.text.cells.cell import Cell, number_of
from thermodata.reader.times.open_questions import ASK, UNKNOWN
from thermodata.reader.times.time_units import SECONDS

_LABEL = re.compile(
    r"(?i)(?:(?:sampl(?:e|ing)|scan|log(?:ging)?|record(?:ing)?|measur(?:e|ing|ement)|data|time|storage)[ _-]*)?"
    r"(?P<what>interval|period|step|rate|frequency|cycle)|(?:abtast|mess|log|aufzeichnungs|speicher)?-?(?P<de>intervall|zeit|"
    r"periode|rate|frequenz|takt)|intervallo|intervalle|intervalo|période|periodo|interval vzorkování|perioda|"
    r"hresolution|サンプリング間隔|サンプリング周期|采样间隔|采样周期|记录间隔"
)
_VALUE = re.compile(r"(?P<number>\d+(?:[.,]\d+)?(?:[eE][+-]?\d+)?)\s*(?P<unit>[^\W\d]{1,8})?")
_RATE = re.compile(r"(?i)rate|frequen[cz]")  # at which a logger samples, whatever it writes
_CLOCK = re.compile(r"(?P<h>\d{1,2}):(?P<m>\d{2}):(?P<s>\d{2}(?:[.,]\d+)?)")
_HERTZ = ("hz", "khz")
_NEAR = 1.05  # of an interval, by which rows may be off
_BARE_WORDS = ("zeit", "takt", "rate", "period", "step", "cycle")  # which alone say another thing as well


def interval_above(lines: Iterable[Sequence[str]], rates: bool = True) -> tuple[float, str] | None:
    """(the time from row to row [s], the line that says so); None where none says one, or several say others. rates:
    whether lines that say a rate count, too."""
    found: dict[float, str] = {}
    for cells in _with_units_below([_said_of_all_once(cells) for cells in lines]):
        text = " ".join(cells).strip("#%;/* \t\"'")
        match = re.fullmatch(
            r"(?P<label>[^:=\d\[(]+?)\s*(?:[\[(](?P<unit>[^\W\d]+)[\])])?\s*[:=]?\s*(?P<value>\d\S*.*)", text
        )
        label = _LABEL.fullmatch(match["label"].strip()) if match else None
        if (
            match is None
            or label is None
            or (label[0].casefold() in _BARE_WORDS and (match["unit"] or "").lower() not in _HERTZ)
        ):
            continue
        if not rates and _RATE.search(label[0]):
            continue
        seconds = _seconds(match["value"].strip(), match["unit"])
        if seconds is not None:
            found[seconds] = text
    return next(iter(found.items())) if len(found) == 1 else None


def _said_of_all_once(cells: Sequence[str]) -> list[str]:
    """The filled cells of a line; of one that says of all channels the same, its label and that: 'HUnit,s,s,s'."""
    filled = [c.strip() for c in cells if c and c.strip()]
    return filled[:2] if len(filled) > 2 and len(set(filled[1:])) == 1 else filled


def _with_units_below(lines: Sequence[list[str]]) -> list[list[str]]:
    """Lines, where the resolution of Yokogawa's recorders, 'HResolution,10', says what it is with the unit of
    'HUnit,s'."""
    unit = next((cells[1] for cells in lines if len(cells) == 2 and cells[0] == "HUnit"), None)
    said = [[cells[0], f"{cells[1]} {unit}"] for cells in lines if len(cells) == 2 and cells[0] == "HResolution"]
    return [*lines, *(said if unit else [])]


def _seconds(value: str, unit: str | None) -> float | None:
    if clock := _CLOCK.fullmatch(value):
        return 3600 * int(clock["h"]) + 60 * int(clock["m"]) + float(clock["s"].replace(",", ".")) or None
    match = _VALUE.fullmatch(value)
    if match is None or not float(match["number"].replace(",", ".")):
        return None
    number, said = float(match["number"].replace(",", ".")), (match["unit"] or unit or "").lower()
    if said in _HERTZ:
        return 1.0 / (number * (1000 if said == "khz" else 1))
    return number * SECONDS[said] if said in SECONDS else None


def against_interval(
    name: str, cells: Sequence[Cell], unit_s: float | None, lines: Iterable[Sequence[str]]
) -> str | None:
    """The note on a time that the interval above it contradicts: its rows follow each other faster, or it only numbers
    them. None where it does not, and of dates; rows that are further apart may be means, as those under a rate and at
    each minute or hour are. cells: of the time, in units of unit_s [s], None of dates."""
    found = None if unit_s is None or unit_s >= SECONDS["min"] else interval_above(lines, rates=False)
    steps = np.diff([v for c in cells if (v := number_of(c)) is not None])
    if unit_s is None or found is None or not steps.size:
        return None
    seconds, line = found
    step, numbered = float(np.median(steps)), bool((steps == 1).all())
    if not step > 0 or not (seconds > _NEAR * step * unit_s or (numbered and unit_s > _NEAR * seconds)):
        return None
    apart, every = f"{step * unit_s:.6g} s", f"{seconds:.12g} s"
    return (
        f"rows are {apart} apart by '{name}', and every {every} by '{line[:80]}' above them: {ASK} declare "
        f"table: {{time: {{period: {every}}}}} where they follow each other so, or time: {{column: ...}}"
    )


def with_interval(question: QuestionError, lines: Iterable[Sequence[str]]) -> QuestionError:
    """A question of the time from row to row, with the one that stands above the rows to be confirmed; another question
    as it is."""
    if question.declare.get("time") != {"period": UNKNOWN} or (found := interval_above(lines)) is None:
        return question
    seconds, line = found
    said = {"time": {"period": f"{seconds:.12g} s"}}
    return QuestionError(
        question.what,
        where=question.where,
        expected=question.expected,
        got=f"{question.got}; above them: '{line[:80]}'",
        hint=f"declare table: {{time: {{period: {seconds:.12g} s}}}} where the rows follow each other so",
        ask=f"period: do all rows follow each other every {seconds:.12g} s, as '{line[:80]}' above them says?",
        declare=said,
        meanwhile=said,
        times=question.times,
    )
