from __future__ import annotations

import shutil
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from thermodata.store import Store

sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture(autouse=True)
def npz_reader(monkeypatch: pytest.MonkeyPatch) -> None:
    """The store finds the reader of these tests, as it would find an installed one."""
    import store_fakes

    from thermodata.store.ingest.reading import campaign_files
    from thermodata.store.trace import reread

    for module in (campaign_files, reread):
        monkeypatch.setattr(module, "find_reader", lambda name: store_fakes.NpzReader())
    store_fakes.NpzReader.reads = 0


@pytest.fixture
def installed_readers(npz_reader: None, monkeypatch: pytest.MonkeyPatch) -> None:
    """The installed readers, which another process finds too."""
    from thermodata.reader.finding import registry
    from thermodata.store.ingest.reading import campaign_files

    monkeypatch.setattr(campaign_files, "find_reader", registry.reader)


@pytest.fixture(scope="session")
def _made(once: Callable[[str, Callable[[Path], object]], Path]) -> Path:
    """An empty store, and a campaign with the store that holds it; each test gets copies."""
    import store_fakes

    from thermodata.store.ingest.reading import campaign_files
    from thermodata.store.ingest.run import ingest

    def make(folder: Path) -> None:
        Store(folder / "empty", create=True)
        campaign = store_fakes.write_campaign(folder / "lab")
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(campaign_files, "find_reader", lambda name: store_fakes.NpzReader())
            ingest(Store(folder / "filled", create=True), campaign)

    return once("store", make)


@pytest.fixture
def store(tmp_path: Path, _made: Path) -> Store:
    """An empty store."""
    shutil.copytree(_made / "empty", tmp_path / "store")
    return Store(tmp_path / "store")


@pytest.fixture
def campaign(tmp_path: Path, _made: Path) -> Path:
    """A campaign file with the logs of its two tests."""
    shutil.copytree(_made / "lab", tmp_path / "lab")
    return tmp_path / "lab/campaign.yaml"


@pytest.fixture
def filled(tmp_path: Path, _made: Path, campaign: Path) -> Store:
    """A store that holds the campaign."""
    shutil.copytree(_made / "filled", tmp_path / "store")
    return Store(tmp_path / "store")
