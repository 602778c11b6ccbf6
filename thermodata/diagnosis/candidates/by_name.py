"""Effects that diagnosis does not ask for by itself, though the logs have all that drives them: few tests tell them
from what it asks for, so the user names them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from thermodata.diagnosis.candidates.of_library import ARTEFACT, that_may_drive
from thermodata.diagnosis.question.present import Present
from thermodata.effect.binding import bindings, candidate_id
from thermodata.plugin import Effect
from thermodata.view.grid.dataset import ChannelInfo, TestData


def only_by_name(
    library: Iterable[Effect],
    channels: Mapping[str, ChannelInfo],
    tests: Sequence[TestData],
    response: str,
    has: Iterable[Present] = (),
) -> list[str]:
    """Ids of those of which every driver moves in one of the tests at least, but for what the model has already by one
    of their channels. library: effects that are not asked. has: of the model."""
    usable = that_may_drive(channels, response)
    moves = {n for n in usable if any(_moves(t, n) for t in tests)}
    return [
        candidate_id(one.name, binding)
        for one in library
        if one.needs and one.family != ARTEFACT
        for binding in bindings(one, usable)
        if moves.issuperset(binding.values())
        and not any(one.name == own.effect and own.channels & set(binding.values()) for own in has)
    ]


def _moves(test: TestData, name: str) -> bool:
    values = test.values.get(name)
    seen = values[np.isfinite(values)] if values is not None else np.empty(0)
    return len(seen) > 0 and float(np.ptp(seen)) > 0
