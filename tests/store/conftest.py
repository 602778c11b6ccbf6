from __future__ import annotations

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture(autouse=True)
def npz_reader(monkeypatch: pytest.MonkeyPatch) -> None:
    """The store finds the reader of these tests, as it would find an installed one."""
    import store_fakes

    import thermodata.store.gather as gather

    monkeypatch.setattr(gather, "find_reader", lambda name: store_fakes.NpzReader())
    store_fakes.NpzReader.reads = 0
