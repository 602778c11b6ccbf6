"""What an answer is told of: what was investigated, how it was judged, what the locked tests say of the claims."""

from __future__ import annotations

from dataclasses import dataclass

from thermodata.diagnosis.claims.measure import Measure
from thermodata.diagnosis.locked.confirmation import Confirmation
from thermodata.diagnosis.verdict.investigate import Investigation
from thermodata.diagnosis.verdict.judged import Judgement


@dataclass(frozen=True, slots=True)
class Outcome:
    """confirmation: of what is claimed, on the locked tests; None where nothing is."""

    investigation: Investigation
    judgement: Judgement
    confirmation: Confirmation | None = None

    @property
    def measure(self) -> Measure:
        """What the evidence is held against."""
        return self.investigation.measure

    @property
    def unit(self) -> str:
        """Of the response."""
        return self.investigation.problem.unit

    @property
    def tests(self) -> str:
        """What is left out in turn, in a word."""
        return self.investigation.measure.tests
