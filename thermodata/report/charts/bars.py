"""Small bars as SVG: lengths in percent, so that they fit any width, and colours by class, so that they follow the
page's look without a style of their own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from thermodata.report.collected.data import Version
from thermodata.report.words.numbers import number


@dataclass(frozen=True, slots=True)
class Step:
    """One row of a waterfall. left, width: of its bar [% of the row]; colour: class of the bar; text: the figure."""

    name: str
    left: float
    width: float
    colour: str
    text: str


def waterfall(versions: Sequence[Version]) -> list[Step]:
    """The error of the first version, what each added effect took from it, and what is left; shape (versions + 1,).
    Empty where there are less than two versions with an error."""
    kept = [v for v in versions if v.all_um is not None]
    errors = [v.all_um for v in kept if v.all_um is not None]
    if len(errors) < 2:
        return []
    full = 1.02 * max(errors) or 1.0
    made = [Step(kept[0].name, 0.0, 100 * errors[0] / full, "model", number(errors[0]))]
    for version, (old, new) in zip(kept[1:], pairwise(errors), strict=True):
        fell = new < old
        made.append(
            Step(
                version.change or f"+ {version.name}",
                100 * min(old, new) / full,
                100 * abs(new - old) / full,
                "good" if fell else "bad",
                f"{'-' if fell else '+'}{number(abs(new - old))}",
            )
        )
    return [*made, Step("now", 0.0, 100 * errors[-1] / full, "model", number(errors[-1]))]
