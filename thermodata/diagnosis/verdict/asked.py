"""What the library has to ask of tests."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from thermodata.diagnosis.candidates.candidate_effect import CandidateEffect
from thermodata.diagnosis.candidates.feedback import feedback_of_axes
from thermodata.diagnosis.candidates.of_library import candidates
from thermodata.diagnosis.candidates.seen import Seen
from thermodata.diagnosis.candidates.warm_at_rest import warm_at_rest
from thermodata.diagnosis.question.present import present
from thermodata.diagnosis.question.problem import Problem
from thermodata.diagnosis.steps.places_that_tell import places_that_tell
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.plugin import Effect
from thermodata.view.grid.dataset import Dataset, TestData


def of_library(
    fitted: FittedResponse, data: Dataset, tests: Sequence[TestData], library: Mapping[str, Effect], fine: Problem
) -> list[CandidateEffect]:
    """What could be missing, by the channels and by what these did in the tests. fine: in the samples in which steps
    are looked for."""
    seen = Seen(places_that_tell(fine), warm_at_rest(data.channels, tests), feedback_of_axes(tests))
    return candidates(library, data.channels, present(fitted), fitted.name, seen)
