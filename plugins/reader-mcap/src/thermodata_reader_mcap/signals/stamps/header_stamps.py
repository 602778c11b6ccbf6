"""Times that stand in the messages themselves, such as `header.stamp`."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from thermodata.plugin import Array
from thermodata_reader_mcap.container.message_batches import U64
from thermodata_reader_mcap.encodings.topic import Topic
from thermodata_reader_mcap.signals.options import Options

_DATED = 940_000_000 * 10**9  # from 1999 on; clocks that count from zero have a zero
Bools = npt.NDArray[np.bool_]


def stamps(
    topic: Topic, options: Options, values: Mapping[str, Array], flags: Mapping[str, Array], logs: U64
) -> tuple[U64, Bools]:
    """Times [ns] of a topic's messages, shape (n,), and where the log time stands for a missing one."""
    names = {leaf.path: leaf.name for leaf in topic.leaves if leaf.dtype != "str"}
    paths = next((p for p in options.stamps() if all(part in names for part in p)), None)
    if paths is None:
        return logs, np.ones(logs.size, bool)
    missing = np.zeros(logs.size, bool)
    parts = []
    for path in paths:
        column = values[names[path]]
        bad = flags.get(names[path], np.zeros(logs.size, np.uint16)) != 0
        if column.dtype.kind == "f":
            bad = bad | ~np.isfinite(column) | (column < 0) | (column > 2.0**63)
        elif column.dtype.kind == "i":
            bad = bad | (column < 0)
        missing |= bad
        parts.append(np.where(bad, 0, column))
    if len(parts) == 2:
        whole = _in_ns(parts[0], 10**9) + parts[1].astype(np.uint64)
    else:
        whole = _in_ns(parts[0], options.scale or 1)
    if whole.size and whole.max() > _DATED:
        missing |= whole == 0  # 1970, beside times of today: not set
    return np.where(missing, logs, whole), missing


def _in_ns(column: Array, scale: int) -> U64:
    """Numbers of a unit as nanoseconds; whole parts exactly."""
    if column.dtype.kind != "f":
        exact: U64 = column.astype(np.uint64) * np.uint64(scale)
        return exact
    whole = np.floor(column)
    if (whole > 2.0**63 / scale).any():
        late: U64 = np.minimum(column * scale, 1.8e19).astype(np.uint64)
        return late
    rounded: U64 = whole.astype(np.uint64) * np.uint64(scale) + np.rint((column - whole) * scale).astype(np.uint64)
    return rounded
