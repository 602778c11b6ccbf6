"""Reading a store: SQL over it (`StoreView`), and the data that models are fitted to (`load_dataset`)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.lazy import on_demand

if TYPE_CHECKING:
    from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData
    from thermodata.view.grid.load import load_dataset
    from thermodata.view.query.store_view import StoreView

__all__ = ["ChannelInfo", "Dataset", "StoreView", "TestData", "load_dataset"]
__getattr__ = on_demand(
    __name__,
    {
        "grid.dataset": "ChannelInfo Dataset TestData",
        "grid.load": "load_dataset",
        "query.store_view": "StoreView",
    },
)
