"""What to ask of times that are written in no way that is read by itself: their format, in strptime's letters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from thermodata.errors import QuestionError
from thermodata.reader.text.cells.first_rows import FirstRows
from thermodata.reader.times.open_questions import UNKNOWN


def format_question(
    columns: tuple[int, ...],
    seen: FirstRows,
    form: str | None,
    got: str,
    otherwise: str = "",
    either: Sequence[str] = (),
) -> QuestionError:
    """Asks for the format of times in strptime's letters; with one that fits, it is only to be confirmed. otherwise:
    what else may be declared; either: where several fit, these."""
    column: Any = columns[0] + 1 if len(columns) == 1 else [c + 1 for c in columns]
    asked = (
        f"format of the times, in strptime's letters ('%d-%b-%Y %H:%M:%S'), or period: 10 s? they begin with '{got}'"
    )
    if form is None and either:
        asked = f"format of the times: {' or '.join(either)}? they begin with '{got}'"
    said = {"time": {"column": column, "format": form or UNKNOWN}}
    meanwhile = {"column": column, "format": form or either[0]} if form or either else {"period": 1.0}
    return QuestionError(
        "times that are written in no way that is read by itself",
        where=seen.where,
        expected="a date and a time of day: 2026-03-01 08:00:00, 1.3.2026 8:00, ...",
        got=got,
        hint=f"declare table: {{time: {{column: {column}, format: '{form or '%d-%b-%Y %H:%M:%S'}'}}}}{otherwise}",
        times=[seen.names[c] for c in columns],
        ask=f"format of the times: is '{got}' {form}?" if form else asked,
        declare=said,
        meanwhile={"time": meanwhile},
    )
