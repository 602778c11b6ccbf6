"""Small pictures that need no script: before and after, and a place among chance."""

from __future__ import annotations

import math
from collections.abc import Sequence

from markupsafe import Markup


def pair(before: float, after: float, most: float) -> Markup:
    """Two bars on one scale. most: the longest, > 0."""
    scale = 100 / most if most > 0 else 0.0
    return Markup(
        '<svg class="pair" viewBox="0 0 100 12" preserveAspectRatio="none" aria-hidden="true">'
        '<rect class="before" width="{:.2f}" height="5"/><rect class="after" y="6.5" width="{:.2f}" height="5"/></svg>'
    ).format(before * scale, after * scale)


def among(chance: Sequence[float], evidence: float) -> Markup:
    """chance: quantiles in even steps, non-decreasing. A tick for each, and a mark where the evidence stands; on the
    signed square root of the log evidence, for it grows with the samples."""

    def at(value: float) -> float:
        return math.copysign(math.sqrt(abs(value)), value)

    low, high = at(min(chance[0], evidence, 0.0)), at(max(chance[-1], evidence, 1.0))
    scale = 100 / (high - low)
    ticks = Markup("").join(
        Markup('<rect class="tick" x="{:.2f}" y="6" width=".25" height="8"/>').format((at(v) - low) * scale)
        for v in chance
    )
    return Markup(
        '<svg class="among" viewBox="-1 0 102 16" preserveAspectRatio="none" role="img" '
        'aria-label="chance reaches {:.3g}, this candidate {:.3g}"><rect class="base" y="14" width="100" height=".6"/>'
        '{}<rect class="here" x="{:.2f}" y="0" width=".35" height="15"/></svg>'
    ).format(chance[-1], evidence, ticks, (at(evidence) - low) * scale - 0.17)
