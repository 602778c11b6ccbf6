"""One machine in one laboratory, as it is judged, whichever machine it is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from thermodata.modelling.versions.candidate import with_effect
from thermodata.plugin import Float1D
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.view.grid.dataset import Dataset
from thermodata.virtual.truth.marking import Key


@dataclass(frozen=True, slots=True)
class Fault:
    """What is wrong with a log. kind: offset, stuck, wander (of `channel`), step (of the probe), clock_offset. at_s:
    from the test's start."""

    kind: str
    test: str
    at_s: float | None
    size: float
    channel: str


@dataclass(frozen=True, slots=True)
class Case:
    """response, data, spec: what the laboratory has. key: what its answers are marked by. nothing: whether nothing is
    to be named.

    base: causes that the model knows. by_speed: a thin model that knows the spindle by its speed alone. right: hidden
    cause -> what the library would add for it; without those that it has no name for. contribution: of what is hidden
    to the response, a course for each test of the data, shape (n,) [um]. faults: what is wrong with the logs. rounds:
    how often the diagnosis is asked at most. imitated: whether a claim that does on the open tests what a cause does
    there is alike, and not wrong.
    """

    stratum: str
    seed: int
    response: str
    data: Dataset
    spec: Model
    key: Key
    nothing: bool
    base: tuple[str, ...]
    by_speed: bool
    right: Mapping[str, EffectSpec]
    contribution: tuple[Float1D, ...]
    faults: tuple[Fault, ...]
    rounds: int
    imitated: bool

    def named(self, without: str | None = None) -> Model:
        """The model with what is hidden by its right names. without: a cause that is left out."""
        spec = self.spec
        for cause in self.key.hidden:
            if cause != without:
                spec = with_effect(spec, self.right[cause])
        return spec
