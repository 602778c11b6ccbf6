"""What a log does not say and its campaign file has to: asked by `init`, refused by a reader until it is answered."""

from __future__ import annotations

import numpy as np

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Array

ASK = "which one is it?"  # in a note on times that may be read in two ways: `init` asks it
YEAR = "which year is it?"  # the same
UNKNOWN = "unknown"  # what a drafted campaign file writes where only the lab knows


def unanswered(key: str, expected: str, where: str) -> FormatError:
    """The refusal of an answer that is still open. key: below sources.*.table: time.unit."""
    return FormatError(
        f"'{key}' of the table is not answered yet",
        where=where,
        expected=expected,
        got=UNKNOWN,
        hint=f"write it into sources.*.table.{key} of the campaign file",
    )


def unit_question(name: str, values: Array, where: str, column: int | None = None) -> QuestionError:
    """Times that name no unit and count from no date: asked, for a factor of 60 shows in nothing else.

    values: some of them, shape (n,); column: its number, from 1, where its name does not tell it for a time.
    """
    full = values.astype(np.float64)
    full = full[np.isfinite(full)]
    steps = np.diff(full)
    said = f"'{name}' runs from {full[0]:g} in steps of {np.median(steps):g}" if steps.size else f"'{name}'"
    found = {} if column is None else {"column": column}
    shown = "" if column is None else f"column: {column}, "
    return QuestionError(
        f"the time '{name}' has no unit",
        where=where,
        expected="s, min, h or ms",
        got=said,
        hint=f"declare table: {{time: {{{shown}unit: s}}}}, or unit: min, h, ms",
        ask=f"unit of the time: s, min, h or ms? {said}",
        declare={"time": {**found, "unit": UNKNOWN}},
        meanwhile={"time": {**found, "unit": "s"}},
    )
