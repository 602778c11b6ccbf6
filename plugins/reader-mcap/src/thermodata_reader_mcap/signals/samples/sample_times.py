"""What the times of samples are called in messages, and what they count from."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from datetime import datetime
from typing import Any

import numpy as np

from thermodata.plugin import Int1D
from thermodata.reader.signals.header_words import VALUE_WORDS
from thermodata.reader.times.time_units import EPOCHS, SECONDS, found_epoch

TIMES = frozenset({"t", "time", "times", "timestamp", "timestamps", "ts", "stamp", "stamps"})
BEGINS = frozenset(
    {"t0", "t_0", "start", "start_time", "starttime", "t_start", "begin", "first_time", "time0"}
    | {"timestamp", "stamp", "time", "t", "ts"}
)
STEPS = frozenset(
    {"dt", "delta_t", "deltat", "step", "interval", "period", "sample_period", "sampling_period"}
    | {"sample_time", "sample_interval"}
)
RATES = frozenset(
    {"fs", "rate", "sample_rate", "samplerate", "sampling_rate", "sampling_frequency", "sample_frequency"}
    | {"frequency", "hz"}
)
_VALUES = frozenset({*VALUE_WORDS, "values", "data", "samples"})
_UNIT = re.compile(r"^(?P<word>.+?)_?(?P<unit>ns|us|ms|s|sec|hz|khz)$")


def word(key: str) -> tuple[str, str | None]:
    """(the word of a key, the unit at its end): 'dt_ms' -> ('dt', 'ms')."""
    low = key.strip().lower().replace("-", "_").replace(" ", "_")
    match = _UNIT.match(low)
    known = TIMES | BEGINS | STEPS | RATES
    return (match["word"], match["unit"]) if match and low not in known and match["word"] in known else (low, None)


def calls_times(keys: Sequence[str]) -> bool:
    """Whether keys lead to what is called a time: 't', 'time.values'."""
    if not keys:
        return False
    held = len(keys) > 1 and keys[-1].casefold() in _VALUES
    return word(keys[-1])[0] in TIMES or (held and word(keys[-2])[0] in TIMES)


def sizes(step: str, rate: bool) -> Iterable[float]:
    """How long a unit of a step may be [ns], or how many samples a second one of a rate is."""
    unit = word(step)[1]
    if rate:
        return (1e3 if unit == "khz" else 1.0,)
    return (SECONDS[unit] * 1e9,) if unit in SECONDS else (1e9, 1e6, 1e3, 1.0)


def dated(values: Sequence[Any]) -> Int1D | None:
    """Times since 1970 [ns], of numbers by their size, or of texts with a zone; None where they are none."""
    if values and all(isinstance(v, str) for v in values):
        try:
            moments = [datetime.fromisoformat(v) for v in values]
        except ValueError:
            return None
        if any(m.tzinfo is None for m in moments):
            return None
        return np.array([round(m.timestamp() * 1e6) * 1000 for m in moments], np.int64)
    if not values or not all(map(is_number, values)):
        return None
    numbers = np.array(values)
    epoch = found_epoch(numbers) if numbers.dtype.kind in "if" else None
    return EPOCHS[epoch].ns(numbers) if epoch is not None and epoch.startswith("unix") else None


def is_number(value: Any) -> bool:
    """Whether a value of a message is a number."""
    return isinstance(value, int | float) and not isinstance(value, bool)
