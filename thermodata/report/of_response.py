"""Which of a model's responses was diagnosed, and why it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.report.words import percent

if TYPE_CHECKING:
    from thermodata.schema.diagnosis import Diagnosis


def of_response(found: Diagnosis) -> str:
    """'of dY, of which the model leaves most: 93 % of its variance, of dZ 41 %'; '' of a model with one response."""
    if len(found.responses) < 2:
        return ""
    left = {r.response: "nothing that counts" if r.left is None else percent(r.left) for r in found.responses}
    mine = left.pop(found.response)
    why = "as asked; the model leaves" if found.by_choice else "of which the model leaves most:"
    return f"of {found.response}, {why} {mine} of its variance, {', '.join(f'of {n} {s}' for n, s in left.items())}"
