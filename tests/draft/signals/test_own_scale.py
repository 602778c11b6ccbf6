"""A scale that a file declares is applied by the store: the line of its channel says so."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from nptdms import ChannelObject, TdmsWriter

from thermodata.draft.make import draft_files
from thermodata.draft.signals.told_units.own_scale import scale_note
from thermodata.plugin import Scaling, Signal


def linear(gain: float, offset: float = 0.0) -> Scaling:
    return Scaling("linear", {"gain": gain, "offset": offset})


def polynomial(*factors: float) -> Scaling:
    said: dict[str, Any] = {"Scale_Type": "Polynomial", "Polynomial_Coefficients_Size": len(factors)}
    said |= {f"Polynomial_Coefficients[{i}]": f for i, f in enumerate(factors)}
    said["Polynomial_Input_Source"] = 0xFFFFFFFF
    named = {f"NI_Scale[0]_{k}": v for k, v in said.items()}
    return Scaling("ni", {"NI_Number_Of_Scales": 1, **named})


@pytest.mark.parametrize(
    ("scalings", "dtype", "said"),
    [
        ([linear(10)], "float64", "the file's own scale (x10) is applied"),
        ([linear(-0.5, 2), linear(-0.5, 2)], "float32", "the file's own scale (x-0.5 +2) is applied"),
        ([linear(10), None, linear(10)], "float64", "each file's own scale is applied: x10 (2), none (1)"),
        ([linear(1)], "float64", None),
        ([None], "float64", None),
        ([linear(0.0003)], "int16", None),  # counts of a converter
        ([polynomial(0, 1, 2)], "float64", "the file's own scale (polynomial) is applied"),
        ([Scaling("ni", {"NI_Number_Of_Scales": 900})], "float64", "the file's own scale (another) is applied"),
    ],
)
def test_a_scale_is_told_in_words(scalings: list[Scaling | None], dtype: str, said: str | None) -> None:
    assert scale_note([Signal("X", "g", "V", dtype, s) for s in scalings]) == said


def test_the_line_of_a_channel_tells_its_scale(tmp_path: Path) -> None:
    scale: dict[str, Any] = {"NI_Scaling_Status": "unscaled", "NI_Number_Of_Scales": 2}
    named = {"Scale_Type": "Linear", "Linear_Slope": 10.0, "Linear_Y_Intercept": 0.0, "Linear_Input_Source": 0}
    scale |= {f"NI_Scale[1]_{key}": value for key, value in named.items()}
    clock = {"wf_start_time": np.datetime64("2026-05-04T06:00"), "wf_start_offset": 0.0, "wf_increment": 1.0}
    values = 2 + np.arange(300) / 300
    with TdmsWriter(str(tmp_path / "run.tdms")) as writer:
        writer.write_segment(
            [
                ChannelObject("g", name, values, properties={**clock, "wf_samples": 300, "unit_string": "V", **own})
                for name, own in (("X1 tcp", scale), ("Y1 tcp", {}))
            ]
        )
    draft_files(tmp_path)
    lines = (tmp_path / "campaign.yaml").read_text("utf-8").splitlines()
    told = [line for line in lines if "the file's own scale (x10) is applied" in line]
    assert [line.split(":")[0].strip() for line in told] == ["X1_tcp"]
