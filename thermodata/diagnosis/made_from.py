"""What an answer is made from: as long as it stays, the store's answer holds."""

from __future__ import annotations

import hashlib
import json
from typing import TYPE_CHECKING

from thermodata.effect import effects
from thermodata.effect.registry import code as code_of_effects
from thermodata.version import __version__

if TYPE_CHECKING:
    from thermodata.modelling.run import Loaded

# raise it where a rule of the diagnosis changes: answers of older rules are then given anew
RULES_VERSION = 99


def answer_key(model: Loaded, left: dict[str, float] | None = None) -> str:
    """Of the model, its data as they are now, the library of effects and its code, the rules, and what is known of the
    locked tests already."""
    library = {name: repr((e.needs, e.params, e.gains)) for name, e in effects().items()}
    rules = [RULES_VERSION, __version__, code_of_effects()]
    made_from = [model.identity, model.data.data_version, sorted(library.items()), *rules, left]
    return hashlib.sha256(json.dumps(made_from).encode()).hexdigest()
