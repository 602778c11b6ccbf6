"""What a channel of a draft is called, before names that repeat are told apart."""

from __future__ import annotations

import re

from thermodata.draft.signals.guess import called
from thermodata.draft.signals.quantity.guessed import Guess
from thermodata.draft.signals.units import rate_at_end
from thermodata.draft.words.naming import parts_of
from thermodata.plugin import Signal
from thermodata.reader.signals.header_words import VALUE_WORDS
from thermodata.reader.signals.series import SERIES
from thermodata.reader.text import split_unit
from thermodata.schema.units.quantity import CANONICAL_UNIT

_NODE = re.compile(r"(?i)^nsu?=[^;]*;s=(?=.*[^\W\d])")  # of OPC UA: the space of names says nothing of the signal
_STATISTIC = re.compile(r"(?i)min|max|avg|ave|mean|average|rms|std|med|last|actual")
_SHORT = {"temperature": "T", "temperature_difference": "dT", "rotational_speed": "speed", "displacement": "d"}


def with_series(signal: Signal) -> str:
    """What a signal is called; the series that its column is of is a part of its own name, and no group."""
    series, name = signal.properties.get(SERIES), called(signal)
    return name.replace(f"{series}/", f"{series} ", 1) if series else name


def wished_name(signal: str, said: Guess) -> str:
    """A name for a channel: the last part of the signal's, or what is known of it where that is in another script."""
    bare = _NODE.sub("", rate_at_end(split_unit(signal)[0])[0])
    parts = [p for p in parts_of(bare.replace("\\", "/")) if p.strip()] or [bare]
    last = parts[-1]
    if len(last.strip()) <= 2 and len(parts) > 1:  # Eddy/Z says more than Z
        last = "_".join(parts[-2:])
    statistic = len(parts) > 1 and _STATISTIC.fullmatch(last.strip()) is not None
    # 'Last' below '1 s' is a load in German, beside the interval in the head of its file
    if statistic and not (said.quantity == "load" and parts[-2].strip()[0].isdecimal()):
        # of which only the name above says what it is of
        last = f"{split_unit(parts[-2])[0]}_{last.strip()}"
    if last.strip().casefold() in VALUE_WORDS and len(parts) > 1:  # a head over a time and its values
        last = split_unit(parts[-2])[0]
    foreign = sum(ord(c) > 0x2FF for c in bare)
    if foreign and said.at and said.quantity in CANONICAL_UNIT:
        where = "_".join(p for p in said.at.split(".") if p not in ("axis",))
        tail = "".join(c for c in bare if c.isascii() and c.isdigit())
        return "_".join(
            filter(None, (_SHORT.get(said.quantity, said.quantity), f"{said.axis}" if said.axis else where, tail))
        )
    return last
