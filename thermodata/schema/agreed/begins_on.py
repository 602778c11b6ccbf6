"""How it is told that a test begins with something on, which may have run before."""

from __future__ import annotations

from collections.abc import Mapping

IF_SO = ". If so, "
"""Parts what is told of such a test from what to do about it."""


def values_of(channels: Mapping[str, str]) -> str:
    """'Coolant at 1 and n at 3000 rpm'."""
    return " and ".join(f"{name} at {value}" for name, value in channels.items())


def begins_on(test: str, channels: Mapping[str, str], rmse: float, left: float, unit: str = "um") -> str:
    """channels: what is on at the first sample -> its value there. rmse, left: error of the test as it is, and had they
    run before."""
    them, they = ("it", "it") if len(channels) == 1 else ("them", "they")
    return (
        f"{test} begins with {values_of(channels)}, and the model counts {them} as switched on there: "
        f"{rmse:.3g} {unit} of error, {left:.3g} {unit} had {they} run before"
    )
