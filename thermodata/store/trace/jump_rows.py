"""The rows of a jump test's file that a sensitivity comes from: those of each plateau."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.calibration.jump.evaluate import readings
from thermodata.calibration.jump.plateaus import at_rest
from thermodata.schema.files.campaign import Campaign, JumpCalibration
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.values.calibrations import jump_data

Answer = dict[str, Any]


def jump_rows(
    store: Path, campaign: Campaign, calibration: str, plateaus: Sequence[Mapping[str, Any]], raws: list[RawStream]
) -> list[Answer]:
    """For each plateau, as the calibration's `detail` tells it, where its rows stand in the file: the first and the
    last one that its mean is taken of (counted from 0), how many of them count (spikes do not), what they say.

    raws: the streams of the jump test's file. Nothing where that is not the recording that the plateaus are of.
    """
    spec = campaign.calibrations.get(calibration)
    if not isinstance(spec, JumpCalibration) or not plateaus or not raws:
        return []
    data = jump_data(store, campaign, spec, raws)
    index = np.flatnonzero(readings(data.line.t_ns, data.volts))
    if not index.size:
        return []
    t_s = (data.line.t_ns[index] - data.line.t_ns[index[0]]) / 1e9
    found = []
    for plateau in plateaus:
        inside = index[at_rest(t_s, plateau["from_s"], plateau["to_s"])]
        if not inside.size:
            return []
        ends = [data.line.raw_row(int(row)) for row in (inside[0], inside[-1])]
        rows = sorted(row for _, row in ends)
        found.append(
            {
                "commanded_um": plateau["commanded_um"],
                "source_path": ends[0][0].source_path,
                "sha256": ends[0][0].sha256,
                "stream": ends[0][0].stream,
                "signal": data.signal,
                "first_row": rows[0],
                "last_row": rows[-1],
                "used": plateau["n"],
                "mean": plateau["volts"],
                "unit": data.unit,
            }
        )
    return found
