"""A lab with a store, and a workbench over it that is asked without a port or in a real browser."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from thermodata.cli import main
from thermodata.web.app import application
from thermodata.web.desk import Desk, desk_of

from ..cli.conftest import made_campaign as made_campaign
from .client import Client, Header

PORT = 8423


@pytest.fixture(scope="session")
def made_lab(once: Callable[[str, Callable[[Path], object]], Path], made_campaign: Path) -> Path:
    """Four tests of 6 h, a baseline that lacks the nut's growth, and its diagnosis; read only."""

    def make(folder: Path) -> None:
        shutil.copytree(made_campaign, folder, dirs_exist_ok=True)
        assert main(["--store", str(folder / "thermodata.store"), "diagnose", "baseline", "--json"]) == 0

    return once("web", make)


@pytest.fixture
def lab(made_lab: Path, tmp_path: Path) -> Path:
    """A copy of its own."""
    shutil.copytree(made_lab, tmp_path / "lab")
    return tmp_path / "lab"


def headers_of(desk: Desk) -> list[Header]:
    """What a browser that was let in sends with a read."""
    return [("host", desk.host), ("cookie", f"thermodata_{desk.port}={desk.keys.session}")]


def write_headers(desk: Desk) -> list[Header]:
    """What our own pages send beside that with a write."""
    return [("origin", desk.address), ("x-thermodata-token", desk.keys.form)]


def client_of(folder: Path, *, write: bool = False) -> tuple[Client, Desk]:
    desk = desk_of(folder, None, write=write, port=PORT)
    return Client(application(desk), headers_of(desk)), desk


@pytest.fixture
def reader(made_lab: Path) -> Client:
    """A browser that was let in, over the lab that is only read."""
    return client_of(made_lab)[0]


@pytest.fixture
def writer(lab: Path) -> Client:
    """A browser that may write, over a copy of its own."""
    client, desk = client_of(lab, write=True)
    more: Sequence[Header] = write_headers(desk)
    return Client(client.app, [*client.headers, *more])
