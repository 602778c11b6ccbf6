"""One fitted response as it is asked about: which tests take part, which stay locked, and what is wrong with the logs.

What is investigated and what is fitted on the way are asked of it, so that all of it is of the same tests.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from thermodata.diagnosis.claims.other_axes import OtherAxes
from thermodata.diagnosis.clocks.ends_of_logs import Ends
from thermodata.diagnosis.locked.confirm import Fits
from thermodata.diagnosis.locked.copies import as_artefacts, copies
from thermodata.diagnosis.question.responses import response_index
from thermodata.diagnosis.sensors.exchanged import exchanged_sensors
from thermodata.diagnosis.sensors.loose import loose_sensors
from thermodata.diagnosis.sound import Sound, beside_slips, sound
from thermodata.diagnosis.verdict.inquiry import Given, Inquiry, Prepared
from thermodata.diagnosis.verdict.investigate import Investigation, investigate
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.plugin import Effect
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.view.grid.dataset import Dataset, TestData


@dataclass(frozen=True, slots=True)
class Case:
    """fitted: the model as it stands, to tests as they were logged. index: of the response among the model's responses.
    logged: its open tests, likewise. sound: what the question is asked of. beside: the same with the response's effects
    as they are beside its slips. locked: the tests that can be predicted and are no copies of open ones; shut: the
    others, and why each can't be asked. faults: of the logs, that were known before anything was asked."""

    fitted: FittedModel
    index: int
    logged: tuple[TestData, ...]
    sound: Sound
    beside: Sound
    locked: tuple[TestData, ...]
    shut: tuple[tuple[TestData, str], ...]
    faults: tuple[Artefact, ...]
    library: Mapping[str, Effect]
    seed: int

    @property
    def response(self) -> FittedResponse:
        """As the model has it."""
        return self.fitted.responses[self.index]

    @property
    def data(self) -> Dataset:
        """With the logs put right."""
        return self.sound.data

    @property
    def tests(self) -> tuple[TestData, ...]:
        """That take part in the choice."""
        return self.sound.tests

    def investigated(
        self, locked: Sequence[TestData], faults: Sequence[Artefact], refused: frozenset[str] = frozenset()
    ) -> Investigation:
        """The open tests beside some locked ones. faults: found since. refused: channels that are asked no more."""
        beside = self.beside
        return investigate(
            Inquiry(beside.fitted.responses[self.index], self.data, self.tests, self.library, self.seed),
            Given(
                as_fitted=self.response,
                locked=locked,
                # a second look asks so much of the locked tests that no other axis decides
                others=None if refused else OtherAxes(self.sound.spec, self.response.name, self.data, self.library),
                known_faults=(*self.faults, *faults),
                refused=refused,
            ),
            Prepared(beside.fine, beside.steps, beside.means),
        )

    def fits(self, locked: Sequence[TestData]) -> Fits:
        """Models with candidates, fitted to the open tests, for some locked ones."""
        return Fits(self.fitted.spec, self.index, self.data, self.tests, locked, self.sound.fitted)

    def fits_beside_slips(self) -> Fits | None:
        """The same to the data without the slips of the response; None where it has none."""
        if self.beside.level is None:
            return None
        return Fits(self.fitted.spec, self.index, self.beside.level, self.tests, (), self.beside.fitted)


def case_of(
    fitted: FittedModel, data: Dataset, library: Mapping[str, Effect], seed: int, ends: Ends, name: str | None
) -> Case:
    """Of the response that is named, else of the one of which most is left. ends: how logs begin and end."""
    logged = fitted.tests(data)
    index = response_index(fitted, logged, name)
    response = fitted.responses[index]
    asked_of = sound(fitted, index, data, [t for t in logged if response.can_predict(t)], library, ends)
    closed = fitted.tests(asked_of.data, "locked")
    same = copies(closed, logged, response.name)
    cannot = _cannot_be_asked(response, closed, {one.key: other for one, other in same})
    return Case(
        fitted,
        index,
        tuple(logged),
        asked_of,
        beside_slips(asked_of, index),
        tuple(t for t in closed if t.key not in cannot),
        tuple((t, cannot[t.key]) for t in closed if t.key in cannot),
        (
            *asked_of.faults,
            *as_artefacts(same, response.name),
            *loose_sensors(asked_of.data, response.name),
            *exchanged_sensors(asked_of.data, response.name),
        ),
        library,
        seed,
    )


def _cannot_be_asked(
    response: FittedResponse, closed: Sequence[TestData], repeated: Mapping[tuple[str, str], TestData]
) -> dict[tuple[str, str], str]:
    """Why, by the keys of locked tests. repeated: by such a key the open test whose recording it is."""
    why = {t.key: response.why_not(t) for t in closed}
    copied = {key: f"a copy of the open test {other.test}" for key, other in repeated.items()}
    return {key: said for key in why if (said := why[key] or copied.get(key)) is not None}
