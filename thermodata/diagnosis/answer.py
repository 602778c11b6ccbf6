"""The answer to a fitted model and its data. Pure: no store."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from thermodata.diagnosis.candidates.failing import without_failing
from thermodata.diagnosis.case import case_of
from thermodata.diagnosis.clocks.ends_of_logs import UNKNOWN, Ends
from thermodata.diagnosis.concluded import concluded
from thermodata.diagnosis.in_contract import in_contract
from thermodata.diagnosis.locked.unlocking import Look
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.plugin import Effect
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.view.grid.dataset import Dataset, TestData


@dataclass(frozen=True, slots=True)
class Answer:
    """looks: each time that locked tests were opened."""

    diagnosis: Diagnosis
    looks: tuple[Look, ...] = ()

    @property
    def locked(self) -> tuple[TestData, ...]:
        """The tests that were looked at."""
        return tuple({t.key: t for look in self.looks for t in look.tests}.values())

    @property
    def asked(self) -> tuple[str, ...]:
        """The ids of the candidates that they were looked at for."""
        return tuple(dict.fromkeys(name for look in self.looks for name in look.asked))


def answer(
    fitted: FittedModel,
    data: Dataset,
    library: Mapping[str, Effect],
    model_id: str,
    seed: int = 0,
    *,
    left_on_locked: Mapping[str, float] | None = None,
    ends: Ends = UNKNOWN,
    name: str | None = None,
) -> Answer:
    """Diagnose the response that is named, else the one of which most is left; locked tests are opened once, for what
    is claimed or likely. left_on_locked: response -> their error, where it is known already. ends: how logs begin and
    end. EffectError for an effect of the model that fails; one of the library is left out, and told."""

    def ask(asked: Mapping[str, Effect]) -> Answer:
        case = case_of(fitted, data, asked, seed, ends, name)
        left = (left_on_locked or {}).get(case.response.name)
        found = concluded(case, left)
        told = in_contract(case, found, model_id, left, by_choice=name is not None)
        return Answer(told, found.looks)

    found, failed = without_failing(library, ask)
    return replace(found, diagnosis=found.diagnosis.model_copy(update={"not_asked": list(failed)}))
