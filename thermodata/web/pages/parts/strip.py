"""A residual as a line of coloured cells, drawn without a script."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from markupsafe import Markup

if TYPE_CHECKING:
    from thermodata.plugin import Float1D

FULL_COLOUR = 0.98  # share of all stretches of a page that are below full colour, here and beside each other
_STEPS = 6  # tints either side of zero; the style sheet has a class for each


def strip_svg(values: Float1D, limit: float) -> Markup:
    """values: shape (n,), NaN is hatched. limit: full colour from there on."""
    cells = []
    for i, value in enumerate(values):
        if not math.isfinite(value):
            cells.append(f'<rect x="{i}" width="1.03" height="1" class="none"/>')
            continue
        step = min(_STEPS, round(abs(value) / limit * _STEPS)) if limit > 0 else 0
        if step:
            side = "hot" if value > 0 else "cold"
            cells.append(f'<rect x="{i}" width="1.03" height="1" class="{side} s{step}"/>')
    most = max((abs(v) for v in values if math.isfinite(v)), default=0.0)
    return Markup(
        '<svg class="strip" viewBox="0 0 {n} 1" preserveAspectRatio="none" role="img" '
        'aria-label="residual over the test, at most {most} in a stretch">{cells}</svg>'
    ).format(n=len(values), most=f"{most:.2g}", cells=Markup("".join(cells)))
