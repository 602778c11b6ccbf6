"""Effects of a stored model that no installed plugin has: it can't be run, and what its fit stored can be told."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.effect import effect as find_effect
from thermodata.errors import PluginError, UsageError
from thermodata.modelling.model_file import nested
from thermodata.modelling.model_file.prediction import as_effect as prediction
from thermodata.modelling.model_file.transfer import as_effect as transfer
from thermodata.schema.files.model import Model


class NotInstalledError(UsageError):
    """A stored model has effects whose plugin is not there."""


def not_installed(spec: Model) -> list[str]:
    """Names of effects, in the order of the model; those of models inside of it too."""
    found: list[str] = []
    for effect in spec.effects:
        if effect.inside is not None:
            found += not_installed(Model.model_validate(effect.inside))
        elif effect.effect not in (nested.NAME, prediction.NAME, transfer.NAME):
            try:
                find_effect(effect.effect)
            except (UsageError, PluginError):
                found.append(effect.effect)
    return list(dict.fromkeys(found))


def refuse_not_installed(spec: Model, identity: str) -> None:
    """NotInstalledError where the stored model can't be run here."""
    lacking = not_installed(spec)
    if lacking:
        raise NotInstalledError(
            f"{named(lacking)} of model '{spec.name}' {'is' if len(lacking) == 1 else 'are'} not installed",
            where=f"model '{spec.name}' ({identity})",
            expected="the plugins that the model was fitted with",
            got=f"none that has {', '.join(lacking)}",
            hint="install what has it ('thermodata plugins' lists what is there); compare, show, history and sql tell "
            "what its fit stored without it",
        )


def named(effects: Sequence[str]) -> str:
    """'the effect a', or 'the effects a, b'."""
    return f"the effect{'' if len(effects) == 1 else 's'} {', '.join(effects)}"


def as_stored(lacking: Sequence[str], name: str) -> str:
    """The warning beside figures that were not made anew."""
    return (
        f"{named(lacking)} of model '{name}' {'is' if len(lacking) == 1 else 'are'} not installed: told is what its "
        "fit stored, of the data as they were then"
    )
