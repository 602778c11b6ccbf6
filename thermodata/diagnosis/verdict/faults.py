"""Faults of the logs that only a model tells: clocks that are off, and gains of probes."""

from __future__ import annotations

from functools import partial

from thermodata.diagnosis.clocks.by_commands import timings
from thermodata.diagnosis.question.known_effects import otherwise
from thermodata.diagnosis.question.present import present
from thermodata.diagnosis.question.problem import Base, Problem
from thermodata.diagnosis.sensors.logging_faults import clock_offsets, clocks_beside, wrong_gains
from thermodata.diagnosis.verdict.judged import Judgement
from thermodata.modelling.terms.fitted_response import FittedResponse
from thermodata.schema.answers.diagnosis import Artefact
from thermodata.view.grid.dataset import Dataset


def that_nothing_missing_makes(faults: list[Artefact], judgement: Judgement, at_floor: bool) -> list[Artefact]:
    """A missing effect also makes one test larger or smaller than the others say, as lags do that leave much, and its
    heat comes earlier or later than what the model has. at_floor: whether the model leaves no more than is left
    alone."""
    stands = {"gain": judgement.verdict == "none" and at_floor, "clock_offset": not judgement.claims}
    return [f for f in faults if stands.get(f.kind, True)]


def faults_of_logs(fitted: FittedResponse, data: Dataset, problem: Problem, base: Base) -> list[Artefact]:
    """Clocks, where nothing acts at once, and gains of probes, where there is a model to hold them against."""
    if not problem.blocks or not problem.blocks[0].base.shape[1]:
        return []
    drivers = {n for one in present(fitted) for n in one.channels}
    told = timings(problem, data.channels).told
    sources = {n: s for n, s in clocks_beside(data.channels, drivers, fitted.name).items() if s not in told}
    warm = {n for n in sources if data.channels[n].quantity == "temperature"}
    late = clock_offsets(problem, base, partial(otherwise, fitted), sources, warm)
    return [*late, *wrong_gains(problem)]
