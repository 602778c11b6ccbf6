"""A simulated machine that writes raw logs and knows the truth. Nothing below the command line imports it.

`simulate` writes a campaign; `dataset` gives the same data without files; `HIDEABLE` names what can be hidden.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from thermodata.virtual.binned import dataset
    from thermodata.virtual.catalogue import HIDEABLE
    from thermodata.virtual.world import World, make_world
    from thermodata.virtual.writing import Truth, simulate

_WHERE = {
    "HIDEABLE": "catalogue",
    "Truth": "writing",
    "simulate": "writing",
    "World": "world",
    "dataset": "binned",
    "make_world": "world",
}


def __getattr__(name: str) -> Any:
    if name not in _WHERE:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    value = getattr(import_module(f"{__name__}.{_WHERE[name]}"), name)
    globals()[name] = value
    return value


__all__ = ["HIDEABLE", "Truth", "World", "dataset", "make_world", "simulate"]
