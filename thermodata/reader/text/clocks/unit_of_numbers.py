"""The unit of times that are numbers: as declared, as the header says, or by their size; what to ask where these leave
it open."""

from __future__ import annotations

import numpy as np

from thermodata.reader.text.cells.cell import number_of
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.text.clocks.counts_of_days import days_note, quick_note, refuse_beyond
from thermodata.reader.text.clocks.counts_of_seconds import far_question, scale_question
from thermodata.reader.text.clocks.time_questions import epoch_in, of_day_question, size_of_clock
from thermodata.reader.text.names.time_header import unit_of_time
from thermodata.reader.times.time_units import check_unit, with_step


def unit_of_numbers(place: int, seen: FirstRows, declared: str | None) -> tuple[str, list[str]]:
    """(unit of the times in a column, notes). QuestionError where nothing tells what they count."""
    name, cells, notes = seen.names[place], seen.column(place), list[str]()
    values = np.array([v for c in cells if (v := number_of(c)) is not None])
    text = with_step(declared or seen.units[place] or unit_of_time(name))
    if (
        declared is None
        and text is not None
        and (asked := scale_question(name, values, seen.where, unit=text)) is not None
    ):
        raise asked
    if text is None:
        if (of_day := of_day_question(place, seen)) is not None:
            raise of_day
        text = size_of_clock(name, cells, seen.where)
        notes.append(
            f"time column '{name}' has no unit: by its size it is {text}; declare table: {{time: {{unit: ...}}}} "
            "if that is wrong"
        )
    elif declared is None and (epoch := epoch_in(name, str(text), cells, seen.where)) is not None:
        notes.append(
            f"time column '{name}' counts {text} from a date by its size: {epoch}; "
            "declare table: {time: {unit: ...}} if that is wrong"
        )
        text = epoch
    known = check_unit(str(text), seen.where)
    refuse_beyond(name, values, known, seen.where, declared=declared is not None)
    if declared is None and (asked := far_question(name, values, known, seen.where)) is not None:
        raise asked
    notes += days_note(name, values, known) if declared is not None else []
    quick = quick_note(name, values, known)
    return known, [*notes, *([quick] if quick else [])]
