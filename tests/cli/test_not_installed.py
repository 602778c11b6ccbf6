"""A stored model whose effect is no longer installed: told as its fit stored it, with a warning; never run."""

from __future__ import annotations

import html
import json
import shutil
from pathlib import Path

import pytest

from thermodata.effect import registry
from thermodata.errors import UsageError
from thermodata.modelling.model_file import make_effect, not_installed
from thermodata.store import Store

from ..commands import Say


@pytest.fixture
def store(campaign: Path) -> Path:
    return campaign / "thermodata.store"


@pytest.fixture
def without(monkeypatch: pytest.MonkeyPatch) -> None:
    """As if the plugin with spindle_bearing were gone."""

    def find(name: str) -> object:
        if name == "spindle_bearing":
            raise UsageError(f"no effect '{name}'", hint="did you mean 'spindle_motor'?")
        return registry.effect(name)

    monkeypatch.setattr(not_installed, "find_effect", find)
    monkeypatch.setattr(make_effect, "find_effect", find)


def test_it_is_compared_by_what_was_stored(say: Say, store: Path, without: None) -> None:
    said = say("--store", store, "compare", "baseline", "--json")
    assert said.code == 0
    assert "warning: the effect spindle_bearing of model 'baseline' is not installed" in said.err
    answer = json.loads(said.out)
    assert [s["test"] for s in answer["scores"] if s["phase"] == "all"] == ["heat1", "heat2", "day1"]
    assert answer["parameters"]["spindle_bearing.gain"]["unit"] == "um/K"
    assert (answer["weak_spots"], answer["differences"]) == ({}, None)
    assert "spindle_bearing" in say("--store", store, "compare", "baseline").out + said.err


def test_it_is_shown_by_what_was_stored(say: Say, store: Path, without: None) -> None:
    said = say("--store", store, "show", "baseline", "--json")
    assert said.code == 0
    assert "not installed" in said.err
    answer = json.loads(said.out)
    assert answer["responses"] == []
    assert answer["stored"]["name"] == "baseline"
    assert "spindle_bearing.tau" in say("--store", store, "show", "baseline").out


@pytest.mark.parametrize("command", ["report", "diagnose"])
def test_what_would_have_to_run_it_says_what_is_lacking(
    say: Say, store: Path, tmp_path: Path, without: None, command: str
) -> None:
    said = say("--store", store, command, "baseline", *(["-o", tmp_path / "r.html"] if command == "report" else []))
    assert said.code == 2
    assert "the effect spindle_bearing of model 'baseline' is not installed" in said.err
    assert "did you mean" not in said.err
    assert "compare, show, history and sql tell" in said.err


def test_with_its_plugin_it_is_run(say: Say, store: Path) -> None:
    said = say("--store", store, "show", "baseline", "--json")
    assert said.code == 0
    assert "not installed" not in said.err
    answer = json.loads(said.out)
    assert answer["stored"] is None
    assert answer["responses"]


@pytest.fixture
def later(say: Say, store: Path, tmp_path: Path) -> tuple[Path, str]:
    """(a store, a version of the model without the effect, which its first version has)."""
    own = shutil.copytree(store, tmp_path / "own")
    added = json.loads(say("--store", own, "add", "baseline", "feed_screw:T_nut_Z", "--plain", "--json").out)
    gone = say("--store", own, "remove", added["model"], "spindle_bearing", "--json")
    assert gone.code == 0, gone.err
    return own, json.loads(gone.out)["model"]


@pytest.mark.parametrize("stale", [False, True])
def test_a_later_version_without_it_has_a_report_which_says_what_is_not_drawn(
    say: Say, later: tuple[Path, str], tmp_path: Path, without: None, stale: bool
) -> None:
    own, model = later
    if stale:
        with Store(own).write(views=False) as con:
            con.execute("update model set stale = true")
    said = say("--store", own, "report", model, "-o", tmp_path / "r.html")
    assert said.code == 0, said.err
    told = "the effect spindle_bearing of model 'baseline' is not installed: told is what its fit stored"
    assert f"warning: an earlier version: {told}" in said.err
    page = html.unescape((tmp_path / "r.html").read_text())
    assert f"Of an earlier version: {told}" in page
    assert "<h3>First version" not in page, "its residuals are not drawn"


def test_with_its_plugin_the_first_version_is_drawn_too(say: Say, later: tuple[Path, str], tmp_path: Path) -> None:
    own, model = later
    said = say("--store", own, "report", model, "-o", tmp_path / "r.html")
    assert (said.code, "not installed" in said.err) == (0, False)
    page = (tmp_path / "r.html").read_text()
    assert "<h3>First version" in page
    assert "Of an earlier version" not in page
