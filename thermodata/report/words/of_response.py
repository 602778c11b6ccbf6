"""Which of a model's responses an error is of; which was diagnosed, and why it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from thermodata.report.words.numbers import percent
from thermodata.schema.words.sentences import listed

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import Diagnosis


def of_response(found: Diagnosis) -> str:
    """'of dY, of which the model leaves most: 93 % of its variance, of dZ 41 %'; '' of a model with one response."""
    if len(found.responses) < 2:
        return ""
    left = {r.response: "nothing that counts" if r.left is None else percent(r.left) for r in found.responses}
    mine = left.pop(found.response)
    why = "as asked; the model leaves" if found.by_choice else "of which the model leaves most:"
    return f"of {found.response}, {why} {mine} of its variance, {', '.join(f'of {n} {s}' for n, s in left.items())}"


def some_of(told: Sequence[str], responses: Sequence[str]) -> str:
    """'dY and dZ', where an error is of some of a model's responses only; '' where it is of all."""
    return listed(told) if len(told) < len(responses) else ""


def worst_of(told: Sequence[str], responses: Sequence[str]) -> str:
    """'dY', 'the worst of dY and dZ', of an error that is the largest of these; '' of a model with one response."""
    if len(responses) < 2:
        return ""
    return told[0] if len(told) == 1 else f"the worst of {listed(told)}"
