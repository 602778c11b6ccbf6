"""Checks: what a good file gives, beside what was declared."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from thermodata.errors import PluginError
from thermodata.plugin import Block, Source
from thermodata.reader.contract.guard import described, guarded
from thermodata.reader.contract.locate import locate
from thermodata.testing.reader.case import Case, equal, fault, gathered, load

_DAY_NS = 86_400_000_000_000
_LOCATE = "say what a person can look up in the file, as 'line 812'; where that can't be told, 'row 812'"


def its_data_follow_the_rules(case: Case, path: Path, source: Source) -> None:
    try:
        data = load(case.make(), path, source)
    except PluginError as error:
        raise AssertionError(
            f"{error}\ntry: hold blocks against thermodata.plugin.Block: int64 nanoseconds of shape "
            "(n,), every declared signal of the stream with n values of its declared dtype"
        ) from error
    if not data.t_ns:
        fault(f"{path.name}: no data", "yield a Block for a good file; is the file given to the kit a whole one?")


def a_row_of_it_can_be_located_where_the_reader_has_a_way(case: Case, path: Path, source: Source) -> None:
    """Only of readers that have `locate` (or `place`, its first name)."""
    reader = case.make()
    for stream, t_ns in load(reader, path, source).t_ns.items():
        for row in {0, t_ns.size - 1}:
            try:
                text = locate(reader, path, source, stream, row)
            except Exception as error:
                fault(f"{path.name}: row {row} of stream '{stream}': {type(error).__name__}: {error}", _LOCATE)
            if text is not None and not text.strip():
                fault(f"{path.name}: row {row} of stream '{stream}' stands nowhere: the answer is empty", _LOCATE)


def every_declared_signal_arrives(case: Case, path: Path, source: Source) -> None:
    data = load(case.make(), path, source)
    missing = [s.name for s in data.recording.signals if (s.stream, s.name) not in data.values]
    if missing:
        fault(
            f"{path.name}: declared, never delivered: {missing}",
            "yield a Block for each declared stream, or declare only what the file holds",
        )


def a_whole_file_is_read_without_a_loss(case: Case, path: Path, source: Source) -> None:
    data = load(case.make(), path, source)
    if data.losses or data.recording.complete is False:
        said = "; ".join(f"{loss.where}: {loss.reason}" for loss in data.losses) or "complete is False"
        fault(
            f"{path.name}: a good file is said to be damaged: {said}",
            "yield a Loss only where something is gone, and set complete to True, or to None where the format "
            "cannot tell; give the kit whole files",
        )


def an_absolute_recording_starts_when_it_says(case: Case, path: Path, source: Source) -> None:
    data = load(case.make(), path, source)
    if data.recording.clock == "absolute" and data.t_ns:
        first = min(int(t[0]) for t in data.t_ns.values())
        start = data.recording.start_ns
        if start is None or abs(first - start) >= _DAY_NS:
            says = "nothing" if start is None else np.datetime64(start, "ns")
            fault(
                f"{path.name}: says that it starts at {says}, and starts at {np.datetime64(first, 'ns')}",
                "set start_ns to the first sample's UTC nanoseconds; an absolute clock yields UTC in t_ns, a "
                "relative one counts from 0",
            )


def a_relative_recording_starts_at_no_date(case: Case, path: Path, source: Source) -> None:
    recording = load(case.make(), path, source).recording
    if recording.clock == "relative" and recording.start_ns is not None:
        fault(
            f"{path.name}: its clock is relative, and it says that it starts at "
            f"{np.datetime64(recording.start_ns, 'ns')}",
            "leave start_ns None: a relative clock counts from 0, and no date of the file; where the file has one, "
            "make the clock absolute",
        )


def a_block_stays_as_it_was_yielded(case: Case, path: Path, source: Source) -> None:
    reader, options = case.make(), dict(source.options)
    if case.block_rows is not None:
        options[case.block_rows] = 7
    small = Source(source.name, source.timezone, source.encoding, source.table, source.topics, options)
    recording = described(reader, path, small)
    kept, then = [], []
    for item in guarded(reader, path, small, recording):
        kept.append(item)
        then.append(
            Block(item.stream, item.t_ns.copy(), {n: v.copy() for n, v in item.values.items()})
            if isinstance(item, Block)
            else item
        )
    now, before = gathered(recording, kept), gathered(recording, then)
    for stream, t_ns in before.t_ns.items():
        if not equal(t_ns, now.t_ns[stream]):
            _overwritten(path, "t_ns")
    for key, values in before.values.items():
        if not equal(values, now.values[key]):
            _overwritten(path, key[1])


def _overwritten(path: Path, name: str) -> None:
    fault(
        f"{path.name}: '{name}' of an earlier block changed while later ones were read",
        "yield new arrays (.copy()), not views of a buffer that is filled again: blocks are kept and written later",
    )
