"""The rules of a reader's data, as functions with sentence names: used by the guard, the kit and the docs.

Each takes what a reader said (its Recording) and one item that it yielded, and returns what is wrong, or None; of a
block also in which of its rows.
A rule that is broken is a bug of the plugin; backward or duplicate time is a defect of the data and no rule here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Block, Int1D, Loss, Recording, Signal


@dataclass(frozen=True, slots=True)
class Wrong:
    """What is wrong with a block. row: the first one of the block in which it is; 0 where it is in all of them."""

    got: str
    row: int = 0


@dataclass(frozen=True, slots=True)
class Broken:
    """A rule, as a sentence, that an item breaks. row: of a block, as in `Wrong`."""

    rule: str
    got: str
    row: int = 0


BlockRule = Callable[[Recording, Block], Wrong | None]
LossRule = Callable[[Recording, Loss], str | None]
RecordingRule = Callable[[Recording], str | None]
_MAX_NS = np.int64(9_000_000_000_000_000_000)


# ---- the recording -------------------------------------------------------------------------------


def signal_names_are_unique_within_a_stream(recording: Recording) -> str | None:
    seen: set[tuple[str, str]] = set()
    for signal in recording.signals:
        if (signal.stream, signal.name) in seen:
            return f"signal '{signal.name}' is declared twice in stream '{signal.stream}'"
        seen.add((signal.stream, signal.name))
    return None


DTYPES = "expected 'str' for text, else numpy's name of what its numbers are: 'float64', 'int16', 'bool'"


def every_signal_has_a_name_a_stream_and_a_dtype(recording: Recording) -> str | None:
    for signal in recording.signals:
        if not signal.name or not signal.stream:
            return f"a signal without name or stream: {signal.name!r} in {signal.stream!r}"
        if signal.dtype != "str":
            try:
                kind = np.dtype(signal.dtype).kind
            except (TypeError, ValueError, SyntaxError):
                kind = None
            if kind is None or kind not in "biuf":
                return f"signal '{signal.name}' declares dtype {signal.dtype!r}; {DTYPES}"
    return None


def the_clock_is_absolute_or_relative(recording: Recording) -> str | None:
    if recording.clock not in ("absolute", "relative"):
        return f"clock is {recording.clock!r}"
    if recording.clock == "absolute" and recording.start_ns is None and recording.signals:
        return "an absolute clock without start_ns"
    return None


# ---- a block -------------------------------------------------------------------------------------

_Streams = Mapping[str, Mapping[str, str]]
_dtypes_asked_last: list[tuple[tuple[Signal, ...], _Streams]] = []


def _dtypes_by_stream(recording: Recording) -> _Streams:
    """stream -> signal -> dtype. Kept for the recordings asked for last: a file of 100,000 channels or streams has
    as many blocks, and each asks."""
    for signals, streams in tuple(_dtypes_asked_last):
        if signals is recording.signals:
            return streams
    found: dict[str, dict[str, str]] = {}
    for signal in recording.signals:
        found.setdefault(signal.stream, {})[signal.name] = signal.dtype
    _dtypes_asked_last[:] = [*_dtypes_asked_last[-1:], (recording.signals, found)]
    return found


def _quoted_names(names: Iterable[str]) -> str:
    return ", ".join(f"'{name}'" for name in sorted(map(str, names)))


def _first_unpaired(values: object, t_ns: Int1D) -> int:
    """The first row of a block that has a value or a time alone; 0 where all rows are wrong."""
    if not isinstance(values, np.ndarray) or values.ndim != 1 or len(values) == len(t_ns):
        return 0
    return min(len(values), len(t_ns))


def the_stream_was_declared(recording: Recording, block: Block) -> Wrong | None:
    if block.stream not in _dtypes_by_stream(recording):
        return Wrong(f"stream '{block.stream}' was not declared")
    return None


def time_is_int64_nanoseconds_in_one_dimension(recording: Recording, block: Block) -> Wrong | None:
    if not isinstance(block.t_ns, np.ndarray) or block.t_ns.dtype != np.int64 or block.t_ns.ndim != 1:
        got = f"{getattr(block.t_ns, 'dtype', type(block.t_ns).__name__)} of shape {getattr(block.t_ns, 'shape', '?')}"
        return Wrong(f"t_ns is {got}, not int64 of shape (n,)")
    if block.t_ns.size:
        for row in (int(np.argmin(block.t_ns)), int(np.argmax(block.t_ns))):
            if -_MAX_NS < block.t_ns[row] < _MAX_NS:
                continue
            return Wrong(f"t_ns is {block.t_ns[row]}, no time", row)
    return None


def every_declared_signal_is_delivered_and_no_other(recording: Recording, block: Block) -> Wrong | None:
    declared = _dtypes_by_stream(recording).get(block.stream, {})
    if declared.keys() != block.values.keys():
        missing, extra = declared.keys() - block.values.keys(), block.values.keys() - declared.keys()
        said = [f"{_quoted_names(extra)}, which describe() does not declare"] if extra else []
        said += [f"no {_quoted_names(missing)}, which describe() declares"] if missing else []
        return Wrong(f"the block of stream '{block.stream}' holds {', and '.join(said)}")
    return None


def values_have_the_length_of_the_time(recording: Recording, block: Block) -> Wrong | None:
    for name, values in block.values.items():
        if not isinstance(values, np.ndarray) or values.shape != block.t_ns.shape:
            got = f"'{name}' has shape {getattr(values, 'shape', type(values).__name__)}, time {block.t_ns.shape}"
            return Wrong(got, _first_unpaired(values, block.t_ns))
    return None


def values_have_the_declared_dtype(recording: Recording, block: Block) -> Wrong | None:
    declared = _dtypes_by_stream(recording).get(block.stream, {})
    for name, values in block.values.items():
        wanted = declared.get(name)
        if wanted == "str":
            if values.dtype.kind == "U":
                continue
            if values.dtype.kind == "O":
                if set(map(type, values.tolist())) <= {str, type(None)}:
                    continue
                row = next((i for i, v in enumerate(values) if not (v is None or isinstance(v, str))), None)
                if row is None:
                    continue
                return Wrong(f"'{name}' is {type(values[row]).__name__}, declared str", row)
            return Wrong(f"'{name}' is {values.dtype}, declared str")
        if wanted is not None and values.dtype != np.dtype(wanted):
            return Wrong(f"'{name}' is {values.dtype}, declared {wanted}")
    return None


def flags_are_uint16_of_delivered_signals(recording: Recording, block: Block) -> Wrong | None:
    for name, flags in (block.flags or {}).items():
        if name not in block.values:
            return Wrong(f"flags of '{name}', which the block does not hold")
        if not isinstance(flags, np.ndarray) or flags.dtype != np.uint16 or flags.shape != block.t_ns.shape:
            got = f"{getattr(flags, 'dtype', '?')} of shape {getattr(flags, 'shape', '?')}"
            return Wrong(f"flags of '{name}' are {got}, not uint16 of shape (n,)", _first_unpaired(flags, block.t_ns))
    return None


def where_rows_stand_is_int64_of_the_time_s_length(recording: Recording, block: Block) -> Wrong | None:
    if block.at is None:
        return None
    if not isinstance(block.at, np.ndarray) or block.at.dtype != np.int64 or block.at.shape != block.t_ns.shape:
        got = f"{getattr(block.at, 'dtype', type(block.at).__name__)} of shape {getattr(block.at, 'shape', '?')}"
        return Wrong(f"at is {got}, not int64 of shape {block.t_ns.shape}", _first_unpaired(block.at, block.t_ns))
    return None


# ---- a loss --------------------------------------------------------------------------------------


def a_loss_says_where_and_why(recording: Recording, loss: Loss) -> str | None:
    return None if loss.where and loss.reason else "a loss without where or reason"


def the_fraction_lost_is_between_0_and_1(recording: Recording, loss: Loss) -> str | None:
    if loss.fraction is not None and not 0.0 <= loss.fraction <= 1.0:
        return f"fraction {loss.fraction}"
    return None


def a_loss_does_not_end_before_it_starts(recording: Recording, loss: Loss) -> str | None:
    if loss.from_ns is not None and loss.to_ns is not None and loss.to_ns < loss.from_ns:
        return f"from {loss.from_ns} to {loss.to_ns}"
    return None


RECORDING_RULES: tuple[RecordingRule, ...] = (
    signal_names_are_unique_within_a_stream,
    every_signal_has_a_name_a_stream_and_a_dtype,
    the_clock_is_absolute_or_relative,
)
BLOCK_RULES: tuple[BlockRule, ...] = (
    the_stream_was_declared,
    time_is_int64_nanoseconds_in_one_dimension,
    every_declared_signal_is_delivered_and_no_other,
    values_have_the_length_of_the_time,
    values_have_the_declared_dtype,
    flags_are_uint16_of_delivered_signals,
    where_rows_stand_is_int64_of_the_time_s_length,
)
LOSS_RULES: tuple[LossRule, ...] = (
    a_loss_says_where_and_why,
    the_fraction_lost_is_between_0_and_1,
    a_loss_does_not_end_before_it_starts,
)


def sentence(rule: Callable[..., object]) -> str:
    """A rule's name as a sentence."""
    return rule.__name__.replace("_", " ")


def broken_rule(recording: Recording, item: Block | Loss) -> Broken | None:
    """The first rule that an item breaks, or None."""
    rules: Iterable[Callable[..., Wrong | str | None]] = BLOCK_RULES if isinstance(item, Block) else LOSS_RULES
    for rule in rules:
        wrong = rule(recording, item)
        if isinstance(wrong, Wrong):
            return Broken(sentence(rule), wrong.got, wrong.row)
        if wrong is not None:
            return Broken(sentence(rule), wrong)
    return None
