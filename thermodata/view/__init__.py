"""Reading a store: SQL over it (`StoreView`), and the data that models are fitted to (`load_dataset`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from thermodata.view.dataset import ChannelInfo, Dataset, TestData
    from thermodata.view.load import load_dataset
    from thermodata.view.store_view import StoreView

__all__ = ["ChannelInfo", "Dataset", "StoreView", "TestData", "load_dataset"]
_HOME = {
    "ChannelInfo": "dataset",
    "Dataset": "dataset",
    "TestData": "dataset",
    "StoreView": "store_view",
    "load_dataset": "load",
}


def __getattr__(name: str) -> Any:
    if name in _HOME:
        from importlib import import_module

        return getattr(import_module(f"thermodata.view.{_HOME[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
