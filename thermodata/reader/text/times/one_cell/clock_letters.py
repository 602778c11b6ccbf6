"""How the time of day of a stamp is written, in strptime's letters: of a format that is proposed, and of one that was
declared and reads none of the cells."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from thermodata.errors import FormatError
from thermodata.reader.text.cells.time_forms import time_pattern
from thermodata.reader.text.cells.time_forms.time_pattern import TimeFormat
from thermodata.reader.text.times.one_cell.odd_stamps import guess_format

_CLOCK = re.compile(
    r"(?P<between>\D*)\d{1,2}:\d{2}(?P<seconds>:\d{2})?(?:(?P<mark>[.,:])\d{1,9})?(?P<half>\s*[AaPp][Mm])?(?P<zone>\s*.+)?",
    re.ASCII,
)
_IN_LETTERS = re.compile(r"%[HI].*")
_LONGEST = 100  # letters of a cell that holds a time: no search goes through what somebody pasted there
Share = Callable[[Sequence[str], TimeFormat], float]


def with_clock(date: str, cell: str) -> str:
    """The format of a stamp. date: the letters of its date; cell: what stands behind the date in it: ' 21:30:00.0'."""
    found = _CLOCK.fullmatch(cell.rstrip())
    if found is None:
        return date
    letters = f"{found['between']}%{'I' if found['half'] else 'H'}:%M" + (":%S" if found["seconds"] else "")
    letters += f"{found['mark']}%f" if found["mark"] else ""
    letters += f"{' ' if found['half'][0] == ' ' else ''}%p" if found["half"] else ""
    zone = found["zone"] or ""
    return date + letters + (f"{zone[: len(zone) - len(zone.lstrip())]}%z" if zone else "")


def refuse_unread(declared: str, form: TimeFormat, cells: Sequence[str], share: Share, where: str) -> None:
    """FormatError where a declared format reads none of the cells, with one that does where there is one."""
    full = [c for c in cells if c.strip()]
    if not full or share(full, form):
        return
    spelled = next((text for text in _with_other_clocks(declared, full) if _reads(text, full, share)), None)
    raise FormatError(
        f"the declared format '{declared}' reads none of the times",
        where=where,
        expected=f"times {declared}",
        got=full[0].strip(),
        hint=f"declare table: {{time: {{format: '{spelled or '%Y-%m-%d %H:%M:%S'}'}}}}"
        + ("" if spelled else ", or the letters that the times are written in; %f is a part of a second"),
    )


def _with_other_clocks(declared: str, cells: Sequence[str]) -> list[str]:
    """Formats of the same date with the times of day that stand in the cells, and what is guessed without it."""
    date, short = _IN_LETTERS.sub("", declared).rstrip(), [c.strip() for c in cells if len(c) <= _LONGEST]
    tails = [re.sub(r"^.*?(?=\D\d{1,2}:\d{2})", "", c, count=1) for c in (*short[:1], *short[-1:])]
    return [t for t in (*(with_clock(date, tail) for tail in tails), guess_format(short)) if t is not None]


def _reads(text: str, cells: Sequence[str], share: Share) -> bool:
    try:
        return share(cells, time_pattern.declared_format(text)) > 0.9
    except FormatError:
        return False
