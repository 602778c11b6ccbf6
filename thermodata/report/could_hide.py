"""What a verdict without a claim can't exclude, in words: the same in the terminal and on the pages."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.report.words import number, percent

if TYPE_CHECKING:
    from thermodata.schema.diagnosis import DetectionLimit, Diagnosis

SHOWN = 4


def could_hide(found: Diagnosis) -> str:
    """'these tests can't exclude guideway (C03_guide) up to 13.6 um, for feed_screw does 91 % of it'; '' where nothing
    is known of it."""
    least = _of_each(found.limits)
    if not least or not found.response_um:
        return ""
    size = f"RMS where it acts; the response has {number(found.response_um)} um"
    large = [one for one in least if one.large]
    if not large:
        return (
            f"an effect of the library that acts by more than {number(least[0].least_um)} um ({size}) would have been "
            f"named here; {_name(least[0])} could hide most"
        )
    told = "; ".join(_one(one, found.response_um) for one in large[:SHOWN])
    rest = f"; {len(large) - SHOWN} more" if len(large) > SHOWN else ""
    return f"these tests can't exclude {told}{rest} ({size})"


def _of_each(limits: list[DetectionLimit]) -> list[DetectionLimit]:
    """Of each effect and family the sensor that shows it best, the one that could hide most first."""
    best: dict[tuple[str, str], DetectionLimit] = {}
    for one in sorted(limits, key=_size):
        best.setdefault((one.effect, one.family), one)
    return sorted(best.values(), key=_size, reverse=True)


def _size(one: DetectionLimit) -> float:
    return float("inf") if one.least_um is None else one.least_um


def _name(one: DetectionLimit) -> str:
    return f"{one.effect} ({', '.join(one.drivers)})"


def _one(one: DetectionLimit, response: float) -> str:
    # more than all that was measured is no bound
    unbound = one.least_um is None or one.least_um > response
    size = "of any size" if unbound else f"up to {number(one.least_um)} um"
    behind = f", for {one.behind} does {percent(1 - one.seen)} of it" if one.behind else ""
    return f"{_name(one)} {size}{behind}"
