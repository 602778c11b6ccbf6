"""What the times of an array count from, where what a file says beside it states that: metadata, properties, other
variables. The same words as in a line above a table."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from thermodata.plugin import Array
from thermodata.reader.text.clocks.counts_of_seconds import scale_question
from thermodata.reader.text.preamble.epoch_said import epoch_said
from thermodata.reader.times.since import PTP
from thermodata.reader.times.time_units import EPOCHS, found_epoch, known_unit


def counted_from(
    name: str, values: Array, unit: str | None, said: Iterable[Mapping[str, str]], where: str
) -> tuple[str | None, list[str]]:
    """(the unit of times with what they count from, None where nothing states that; notes).

    values: some of them, shape (n,); unit: as the file says it, None where it says none; said: by their names the texts
    of the file that may state it, those of the time itself before those of all. QuestionError where they leave open
    whether it counts leap seconds."""
    known = None if unit is None else known_unit(unit)
    if known in EPOCHS:
        return None, []
    for texts in said:
        stated = epoch_said([f"{key}: {text}"] for key, text in texts.items() if _may_state(key, text))
        if stated is None:
            continue
        if stated.scale == PTP and (asked := scale_question(name, values, where, hint=PTP)) is not None:
            raise asked
        full = stated.fitting(known, values)
        if full is not None and stated.zero is not None and (found_epoch(values) or "").startswith("unix"):
            full = None  # counts as large as those since 1970 would be of 2031 or later
        return full, [stated.not_used("the file") if full is None else stated.note(full, "what the file says")]
    return None, []


def _may_state(key: str, text: str) -> bool:
    """Whether a text may state a date: a number is a factor or a size, but for that of an epoch."""
    return "epoch" in key.casefold() or not text.strip().replace(".", "", 1).isdecimal()
