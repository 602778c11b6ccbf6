"""A header of units alone: 'Time,°C,°C,V,V', as Fluke's NetDAQ writes it, where other loggers have names."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from thermodata.plugin import Signal
from thermodata.reader.text.names.header import looks_like_unit
from thermodata.schema.units.unit import is_unit

LEAST_COLUMNS = 2
_AGAIN = re.compile(r"#\d+$")  # behind a name that stood there before


def with_names_as_units(signals: Sequence[Signal]) -> tuple[tuple[Signal, ...], str | None]:
    """(the signals, each with its name for its unit; what is asked), where all names of a file are units and no letters
    of axes: one stands there twice, or none is of a single letter. A number for a name, as the first column of NetDAQ's
    files has it, is none. Others as they are, and None."""
    said = {s.name: _AGAIN.sub("", s.name) for s in signals if not s.name.isdigit()}
    names = list(dict.fromkeys(said.values()))
    if len(said) < LEAST_COLUMNS or not all(map(_is_unit, names)) or any(s.unit is not None for s in signals):
        return tuple(signals), None
    if len(names) == len(said) and any(len(name) == 1 for name in names):
        return tuple(signals), None
    asked = (
        f"names: its header has units where names stand elsewhere ({', '.join(names)}): each channel is called by its "
        "unit and its turn; what is measured where?"
    )
    return tuple(replace(s, unit=said.get(s.name)) for s in signals), asked


def _is_unit(name: str) -> bool:
    return looks_like_unit(name) and is_unit(name)
