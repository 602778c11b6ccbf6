"""A scale that a file states beside a signal and nobody applies, `Scale = 0.1`: asked, for values may have it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import replace

from thermodata.draft.signals.quantity import Guess
from thermodata.plugin import Signal
from thermodata.reader.text.cells.number import of_either_mark
from thermodata.reader.text.preamble.scale_words import FACTOR, OFFSET, TURNED, is_called, stated_of
from thermodata.schema.listed import with_count
from thermodata.schema.unit_scale import with_power_of_ten

_TURNS = re.compile(r"(?i)-1(?:[.,]0*)?|-|neg(?:ative|ativ)?|invert(?:ed|iert)?|revers(?:ed)?|true|yes|ja")

_FILES = 3  # that are shown
_LEAST, _MOST = 1e-12, 1e12


def with_scale_asked(found: Guess, signals: Mapping[str, Signal]) -> Guess:
    """With a question where properties of a signal say a factor, an offset or a turned sign that nobody applies, in all
    files or in some. signals: file -> the signal as it has it."""
    if found.quantity in (None, "state", "label"):
        return found
    files: dict[str, list[str]] = {}
    for file, signal in signals.items():
        files.setdefault("" if signal.scaling is not None else "; ".join(_asked(signal, found.unit)), []).append(file)
    several = len(files) > 1
    asked = [f"in {with_count(of, _FILES)} {told}" if several else told for told, of in files.items() if told]
    return replace(found, sure=False, questions=(*found.questions, "; ".join(asked))) if asked else found


def _asked(signal: Signal, unit: str | None) -> Iterator[str]:
    for key, text in signal.properties.items():
        said = f"the file says '{key} = {text}': is that in the values?"
        number = of_either_mark(text.strip())
        if number is not None and number and not _LEAST < abs(number) < _MOST:
            continue  # 'inf', or what nobody measures by
        of = stated_of(key)
        if of is not None and not is_called(signal.name, of[0]):
            continue  # of another signal
        word = key if of is None else of[1]
        if FACTOR.fullmatch(word) and number is not None and number not in (0.0, 1.0):
            own = with_power_of_ten(abs(number), unit or "?")
            way = f'unit: "{own}"' + (f", instead_of: {unit}" if unit else "") if own else None
            yield f"{said} where they still need it: {way or f'a calibration of kind linear or scale, gain {number:g}'}"
            if number < 0:
                yield "it turns the sign, which is kept as it stands in the file"
        elif OFFSET.fullmatch(word) and number:
            yield f"{said} where they still need it: a calibration of kind linear"
        elif TURNED.fullmatch(word) and _TURNS.fullmatch(text.strip()):
            yield f"{said} their sign is kept as it stands in the file"
