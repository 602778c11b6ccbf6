"""What properties of a signal state of its scale: factors, offsets and turned signs that no reader applies, and the
line of a campaign file that does."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

from thermodata.plugin import Signal
from thermodata.reader.text.cells.values.number import of_either_mark
from thermodata.reader.text.preamble.scale_words import FACTOR, OFFSET, TURNED, is_called, stated_of
from thermodata.schema.units.scale import with_power_of_ten
from thermodata.schema.units.unit import is_unit

_TURNS = re.compile(r"(?i)-1(?:[.,]0*)?|-|neg(?:ative|ativ)?|invert(?:ed|iert)?|revers(?:ed)?|true|yes|ja")
_SCALED_UNIT = re.compile(r"(?i)scal(?:ed?|ing)[ _-]?(?:units?|einheit)")
_LEAST, _MOST = 1e-12, 1e12
Kind = Literal["factor", "offset", "sign"]


@dataclass(frozen=True, slots=True)
class Stated:
    """A property that scales a signal: key and text as the file has them; number: of a factor or an offset."""

    key: str
    text: str
    kind: Kind
    number: float = -1.0

    def __str__(self) -> str:
        return f"'{self.key} = {self.text}'"


def stated_scales(signal: Signal) -> list[Stated]:
    """What is stated of a signal and changes its values; nothing where its reader applies a scaling."""
    return [] if signal.scaling is not None else list(_stated_factors(signal))


def _stated_factors(signal: Signal) -> Iterator[Stated]:
    for key, text in signal.properties.items():
        found = _kind_of(key)
        if found is None or (found[0] is not None and not is_called(signal.name, found[0])):
            continue  # of another signal
        number = of_either_mark(text.strip())
        if number is not None and number and not _LEAST < abs(number) < _MOST:
            continue  # 'inf', or what nobody measures by
        kind = found[1]
        if kind == "sign":
            if _TURNS.fullmatch(text.strip()):
                yield Stated(key, text, "sign")
        elif number and (kind == "offset" or number != 1.0):
            yield Stated(key, text, kind, number)


@lru_cache(maxsize=4096)
def _kind_of(key: str) -> tuple[str | None, Kind] | None:
    """(signal, what is stated) of a property: (None, 'factor') of 'Gain'; None of one that states no scale."""
    signal, word = stated_of(key) or (None, key)
    kinds: tuple[tuple[re.Pattern[str], Kind], ...] = ((FACTOR, "factor"), (OFFSET, "offset"), (TURNED, "sign"))
    return next(((signal, kind) for pattern, kind in kinds if pattern.fullmatch(word)), None)


def stated_unit(signal: Signal) -> tuple[str, str] | None:
    """(key, unit) of a property that says the unit behind the stated scale: 'Scale_Unit = degC' of a channel in V; None
    where none does."""
    each = ((key, text.strip()) for key, text in signal.properties.items() if _SCALED_UNIT.fullmatch(key))
    return next(((key, text) for key, text in each if text and text != signal.unit and is_unit(text)), None)


def line_that_applies(stated: Sequence[Stated], name: str, unit: str | None, scaled: str | None = None) -> str:
    """What a channel has in a campaign file that applies a factor and an offset. name: of its signal; unit: of its
    values, as the file says it; scaled: behind the scale, where the file says it."""
    factors = [s.number for s in stated if s.kind == "factor"]
    offsets = [s.number for s in stated if s.kind == "offset"]
    if len(factors) > 1 or len(offsets) > 1:
        return "a calibration of kind linear, with what holds of them"
    own = with_power_of_ten(factors[0], unit or "?") if factors and not offsets and scaled is None else None
    if own is not None:
        return f'unit: "{own}"' + (f", instead_of: {unit}" if unit else "")
    of_gain, of_offset = (f" {scaled}/{unit or '?'}", f" {scaled}") if scaled else ("", "")
    gain = f", gain: {factors[0]:g}{of_gain}" if factors else ""
    offset = f", offset: {offsets[0]:g}{of_offset}" if offsets else ""
    called = "scale_" + re.sub(r"\W+", "_", re.split(r"[/\\.]", name)[-1]).strip("_")
    return f"calibration: {called}, and {called}: {{kind: linear{gain}{offset}}} under calibrations"
