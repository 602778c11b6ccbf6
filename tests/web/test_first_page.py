"""The first page waits for nothing that only other pages need, and all pages share one copy of the catalogue."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from thermodata.cli import main
from thermodata.errors import UsageError
from thermodata.store import Store
from thermodata.web.app import application
from thermodata.web.desk import desk_of
from thermodata.web.later import page_named

from .client import Client
from .conftest import PORT, client_of

ASKED = """
import json, sys
sys.path.insert(0, sys.argv[1])
from web.client import Client
from thermodata.web.app import application
from thermodata.web.desk import desk_of
from pathlib import Path
desk = desk_of(Path(sys.argv[2]), None, write=False, port=8423)
cookie = f"thermodata_{desk.port}={desk.keys.session}"
answer = Client(application(desk), [("host", desk.host), ("cookie", cookie)]).get(sys.argv[3])
print(json.dumps([answer.status, sorted({name.partition(".")[0] for name in sys.modules})]))
"""


def loaded_by(folder: Path, url: str) -> set[str]:
    """Packages that a new process holds after this page."""
    words = [sys.executable, "-c", ASKED, str(Path(__file__).parents[1]), str(folder), url]
    status, packages = json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)
    assert status == 200
    return set(packages)


def test_every_route_has_its_page(made_lab: Path) -> None:
    app = application(desk_of(made_lab, None, write=False, port=PORT))
    names = [route.endpoint.__name__ for route in app.routes]  # type: ignore[attr-defined]
    pages = [name for name in names if "." in name]
    assert len(pages) >= 15
    for name in pages:
        assert page_named(name).__module__ == f"thermodata.web.pages.{name.partition('.')[0]}"


def test_the_first_page_loads_neither_models_nor_numbers(made_lab: Path, tmp_path: Path) -> None:
    Store(tmp_path / "thermodata.store", create=True)
    assert not loaded_by(tmp_path, "/") & {"numpy", "scipy", "pydantic", "pyarrow", "yaml"}
    # with a model its residuals are drawn
    with_model = loaded_by(made_lab, "/")
    assert "numpy" in with_model
    assert not with_model & {"scipy", "pydantic", "pyarrow", "yaml"}


def test_a_plot_loads_no_model(made_lab: Path) -> None:
    assert not loaded_by(made_lab, "/test?campaign=small&test=heat1") & {"scipy", "pydantic", "pyarrow", "yaml"}


def test_pages_share_a_copy_of_the_catalogue_until_a_commit(lab: Path) -> None:
    desk = desk_of(lab, None, write=False, port=PORT)
    first = desk.store()
    assert desk.store() is first
    with first.reader() as con:
        before = con.execute("select max(generation) from store").fetchall()
    with Store(lab / "thermodata.store").write() as con:
        con.execute("update test set notes = 'seen' where test = 'heat1'")
    with desk.store().reader() as con:
        assert con.execute("select max(generation) from store").fetchall() != before
        assert con.execute("select notes from test where test = 'heat1'").fetchall() == [("seen",)]


def test_a_store_that_is_gone_is_said_and_one_that_came_is_taken(tmp_path: Path, lab: Path) -> None:
    desk = desk_of(tmp_path, None, write=False, port=PORT)
    with pytest.raises(UsageError, match="no store here"):
        desk.store()
    shutil.copytree(lab / "thermodata.store", tmp_path / "thermodata.store")
    assert desk.store().path == tmp_path / "thermodata.store"
    shutil.rmtree(tmp_path / "thermodata.store")
    with pytest.raises(UsageError, match="no store here"):
        desk.store()


def test_a_page_that_there_is_not_is_said(made_lab: Path) -> None:
    desk = desk_of(made_lab, None, write=False, port=PORT)
    headers = [("host", desk.host), ("cookie", f"thermodata_{desk.port}={desk.keys.session}")]
    assert Client(application(desk), headers).get("/nowhere").status == 404


def test_the_share_of_the_displacement_stands_below_that_of_all_channels(lab: Path) -> None:
    path = lab / "campaign.yaml"
    text = path.read_text()
    assert "displacement 0 %" not in client_of(lab)[0].get("/").text
    path.write_text(text.replace("role: verification", 'role: verification, measuring: "T_hall > 1000"', 1))
    assert main(["--store", str(lab / "thermodata.store"), "ingest", str(path)]) in (0, 3)
    assert '<br><small class="muted">displacement 0 %</small>' in client_of(lab)[0].get("/").text
