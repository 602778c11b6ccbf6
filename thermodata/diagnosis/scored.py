"""One candidate with its evidence."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from thermodata.diagnosis.candidates import CandidateEffect
from thermodata.plugin import Float1D


@dataclass(frozen=True, slots=True)
class Scored:
    """One candidate's evidence. drop, white_drop: relative fall of the squared error on left-out tests.
    sse_before, sse_after: shape (tests,), as measured. shape: the fitted contribution on all compressed rows,
    what the base model can do removed, unit length. size: its RMS in the response's unit."""

    candidate: CandidateEffect
    params: Mapping[str, float]
    gain: Float1D
    drop: float
    white_drop: float
    p_value: float
    sse_before: Float1D
    sse_after: Float1D
    shape: Float1D
    size: float
    order: float = 0.0
