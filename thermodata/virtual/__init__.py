"""A simulated machine that writes raw logs and knows the truth. Nothing below the command line imports it.

`simulate` writes a campaign; `dataset` gives the same data without files; `HIDEABLE` names what can be hidden.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.lazy import on_demand

if TYPE_CHECKING:
    from thermodata.virtual.binned import dataset
    from thermodata.virtual.catalogue import HIDEABLE
    from thermodata.virtual.world import World, make_world
    from thermodata.virtual.writing import Truth, simulate
__all__ = ["HIDEABLE", "Truth", "World", "dataset", "make_world", "simulate"]
__getattr__ = on_demand(
    __name__, {"binned": "dataset", "catalogue": "HIDEABLE", "world": "World make_world", "writing": "Truth simulate"}
)
