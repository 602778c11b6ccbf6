"""A library in which a plugin fails: its effects are left out of a question, and the question is asked all the same."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeVar

from thermodata.errors import EffectError
from thermodata.plugin import Effect
from thermodata.schema.answers.diagnosis import NotAsked

_T = TypeVar("_T")


def without_failing(
    library: Mapping[str, Effect], ask: Callable[[Mapping[str, Effect]], _T]
) -> tuple[_T, tuple[NotAsked, ...]]:
    """(what is answered with the effects that work, those that failed on the way). An effect that breaks its contract
    anywhere is asked nowhere: what it says elsewhere is no evidence. EffectError for one that the model itself has, for
    it fails without the library too."""
    asked = dict(library)
    failed: list[NotAsked] = []
    while True:
        try:
            return ask(asked), tuple(failed)
        except EffectError as error:
            if asked.pop(error.effect, None) is None:
                raise
            failed.append(NotAsked(effect=error.effect, why=f"{error.what}: {error.got}; it is of {error.origin}"))
