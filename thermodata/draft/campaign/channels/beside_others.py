"""What the other temperatures of its files tell of one."""

from __future__ import annotations

import math
from statistics import median

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.one_signal import OneSignal
from thermodata.draft.signals.guess import guess_of
from thermodata.draft.signals.quantity.guessed import Guess
from thermodata.draft.signals.values import least_reading
from thermodata.plugin import Signal
from thermodata.schema.units.unit import normal_unit

_FEWEST_OTHERS = 3
_ALIKE_K = 2.0  # so near are all parts of a machine to each other before it works
_APART_K = 25.0  # and what reads so much more is warm, or in another unit
_MOVES = 3.0  # by which it moves in its unit: what is kept warm stands


def coldest_in(file: RawFile) -> float:
    """The lowest reading of all temperatures without a unit in a file; infinite where there is none."""
    return min(_least(file, [s for s in file.signals if s.unit is None]), default=math.inf)


def in_fahrenheit(said: Guess, one: OneSignal) -> str | None:
    """What to ask of a temperature that its files say in degrees Celsius, and whose coldest reading in each of them is
    that of the others there in Fahrenheit; None where it is not so."""
    if said.quantity != "temperature" or normal_unit(said.unit or "") != "degC" or not one.files:
        return None
    told: tuple[float, list[float]] | None = None
    for file in one.files:
        own = one.of(file) or one.signal
        values = file.sample.values.get((own.stream, own.name))
        alike = [s for s in file.signals if s.name != own.name and normal_unit(s.unit or "") == "degC"]
        others = _least(file, alike)
        if values is None or not values.n or len(others) < _FEWEST_OTHERS:
            return None
        least = least_reading(values)
        usual = median(others)  # another one of them may be in Fahrenheit
        apart = abs((least - 32) / 1.8 - usual)
        if apart > _ALIKE_K or least - usual < _APART_K or values.high - values.low < _MOVES:
            return None
        told = told or (least, others)
    if told is None:
        return None
    least, others = told
    colder = [x for x in others if least - x >= _APART_K]
    return (
        f"unit: degF, or degC? its coldest is {least:.3g}, which in degF is {(least - 32) / 1.8:.3g} degC, as "
        f"{'the' if colder == others else 'most'} others are ({min(colder):.3g} to {max(colder):.3g})"
    )


def _least(file: RawFile, signals: list[Signal]) -> list[float]:
    seen = [(s, file.sample.values.get((s.stream, s.name))) for s in signals]
    return [least_reading(v) for s, v in seen if v and guess_of(s, v).quantity == "temperature"]
