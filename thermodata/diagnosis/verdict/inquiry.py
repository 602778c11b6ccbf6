"""What is investigated: a fitted response with its tests, what is known of it before, and what was made for others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from thermodata.diagnosis.candidates.basis import Means
from thermodata.diagnosis.claims.other_axes import OtherAxes
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.steps.step import Step
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.plugin import Effect
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.view.grid.dataset import Dataset, TestData


@dataclass(frozen=True, slots=True)
class Inquiry:
    """fitted: to all tests that take part in the choice, which are `tests`. library: the effects that may be named.
    seed: of what is drawn by chance."""

    fitted: FittedResponse
    data: Dataset
    tests: Sequence[TestData]
    library: Mapping[str, Effect]
    seed: int = 0


@dataclass(frozen=True, slots=True)
class Given:
    """as_fitted: the model that is asked about, whose weak spots are shown; None: the same. locked: tests that are
    asked where nothing else decides. others: what other axes say; None: nothing. known_faults: mended before, or left
    out. refused: channels; what reads these alone is not asked."""

    as_fitted: FittedResponse | None = None
    locked: Sequence[TestData] = ()
    others: OtherAxes | None = None
    known_faults: Sequence[Artefact] = ()
    refused: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class Prepared:
    """Made for other questions of the same tests (`Sound`): fine, steps: None where they are to be made; means: what
    candidates do, which each question adds to."""

    fine: Problem | None = None
    steps: Sequence[Step] | None = None
    means: Means = field(default_factory=dict)
