"""The window of a test that is some rows of a log, beside other logs of that test."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from thermodata.draft.files.raw_file import RawFile


def window_question(files: Sequence[RawFile]) -> str:
    """What to ask of it: since when it counts where a log beside it has no date, and is the test's own. files: of the
    test, one of them with a block."""
    log = next(f for f in files if f.block is not None)
    undated = next((f for f in files if f.counts_from_ns is not None), None)
    first_ns = log.sample.first_ns
    if undated is None or log.block is None or first_ns is None or log.recording.clock != "absolute":
        return "window: it is counted in one log, and meant since the start of the first of several"
    a, b = log.block.window
    began = str(np.datetime64(first_ns // 10**9, "s")).replace("T", " ")
    return (
        f"window: it is counted in {log.path.name}; {undated.path.name} has no date: where it began with these rows, "
        f"start: {began} in the test, and window: [0 s, {b - a:.15g} s] in its place, for it counts from there then"
    )
