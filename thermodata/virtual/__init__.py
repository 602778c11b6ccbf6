"""A simulated machine that writes raw logs and knows the truth. Nothing below the command line imports it.

`simulate` writes a campaign; `dataset` gives the same data without files; `HIDEABLE` names what can be hidden.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.lazy import on_demand

if TYPE_CHECKING:
    from thermodata.virtual.gantry.binned import dataset
    from thermodata.virtual.gantry.catalogue import HIDEABLE
    from thermodata.virtual.gantry.world import World, make_world
    from thermodata.virtual.gantry.writing import Truth, simulate
__all__ = ["HIDEABLE", "Truth", "World", "dataset", "make_world", "simulate"]
__getattr__ = on_demand(
    __name__,
    {
        "gantry.binned": "dataset",
        "gantry.catalogue": "HIDEABLE",
        "gantry.world": "World make_world",
        "gantry.writing": "Truth simulate",
    },
)
