"""What a person meets at a terminal: names after a Tab, no colour where none is wanted, the newest model, lines."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path

import pytest
from click.shell_completion import ShellComplete

from thermodata.cli import main
from thermodata.cli.app import cli
from thermodata.view import StoreView

from ..commands import Said
from .conftest import write_campaign


@pytest.fixture(scope="session")
def fitted(once: Callable[[str, Callable[[Path], object]], Path], made_campaign: Path) -> Path:
    """Four tests of 6 h, a baseline that lacks the nut's growth, its diagnosis, and a second version; read only."""

    def make(folder: Path) -> None:
        shutil.copytree(made_campaign, folder, dirs_exist_ok=True)
        store = str(folder / "thermodata.store")
        for words in (["diagnose"], ["add", "baseline", 1]):
            assert main(["--store", store, *map(str, words), "--json"]) == 0

    return once("terminal", make)


def offered(store: Path, *words: str, begun: str = "") -> list[str]:
    complete = ShellComplete(cli, {}, "thermodata", "_THERMODATA_COMPLETE")
    return [item.value for item in complete.get_completions(["--store", str(store), *words], begun)]


def test_a_tab_offers_what_the_store_holds(fitted: Path) -> None:
    store = fitted / "thermodata.store"
    assert "baseline" in offered(store, "compare", begun="base")
    assert offered(store, "export", begun="s") == ["small"]
    assert set(offered(store, "export", "small")) == {"heat1", "heat2", "day1", "day2"}
    assert "T_nut_Z" in offered(store, "trace", "small", "day1", begun="T_n")
    first = StoreView(store).sql("select model from model order by created_at").fetchall()[0][0]
    assert "1" in offered(store, "add", first)
    assert offered(store, "remove", "baseline", begun="spindle_b") == ["spindle_bearing"]
    assert "spindle_bearing" in offered(store, "plugins", "show", begun="spindle_b")
    assert "day1" in offered(store, "channels", "--test", begun="d")


def test_a_tab_without_a_store_offers_nothing_and_says_nothing(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    assert offered(tmp_path / "none", "export") == []
    (tmp_path / "broken").mkdir()
    (tmp_path / "broken" / "catalog.duckdb").write_bytes(b"no database")
    assert offered(tmp_path / "broken", "export") == []
    assert capfd.readouterr() == ("", "")


def test_no_color_means_none(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    import click

    monkeypatch.setattr(click.utils, "should_strip_ansi", lambda stream=None, color=None: color is False)
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert main(["--store", str(tmp_path / "none"), "tests"]) == 2
    assert "\x1b[" in capsys.readouterr().err
    monkeypatch.setenv("NO_COLOR", "1")
    assert main(["--store", str(tmp_path / "none"), "tests"]) == 2
    assert "\x1b[" not in capsys.readouterr().err


@pytest.mark.parametrize("words", [["history"], ["compare"], ["diagnose"]])
def test_without_a_model_the_newest_is_taken(fitted: Path, say: Callable[..., Said], words: list[str]) -> None:
    store = fitted / "thermodata.store"
    found = json.loads(say("--store", store, *words, "--json").out)
    models = [m["model"] for m in json.loads(say("--store", store, "history", "baseline", "--json").out)]
    assert len(models) == 2
    assert (found[-1] if words == ["history"] else found)["model"] == models[-1]
    assert models[-1] in say("--store", store, *words).err


def test_a_list_of_models_names_all_effects() -> None:
    from thermodata.cli.model.models import _text

    effects = ["ambient_frame", "centrifugal_shift", "probe_temperature", "tool_elongation", "feed_motor"]
    row = {"model": "m1", "name": "baseline", "version": 1, "parent": None, "effects": effects, "campaigns": ["c"]}
    more = {"responses": ["dZ"], "created_at": datetime(2026, 3, 1, tzinfo=UTC), "stale": False, "fitted_last": True}
    scored = {"calibration_um": 1.0, "verification_um": None, "in_sample": False}
    text = _text([{**row, **more, **scored}])
    assert "…" not in text
    assert all(effect in text for effect in effects)


def test_models_are_listed_with_the_one_that_is_taken_where_none_is_named(
    fitted: Path, say: Callable[..., Said]
) -> None:
    store = fitted / "thermodata.store"
    listed = json.loads(say("--store", store, "models", "--json").out)
    chain = [m["model"] for m in json.loads(say("--store", store, "history", "baseline", "--json").out)]
    assert [m["model"] for m in listed] == chain[::-1]
    assert [m["model"] for m in listed if m["fitted_last"]] == [chain[-1]]
    text = say("--store", store, "models", "-c", "small").out
    assert all(model in text for model in chain)
    assert re.search(rf"2  {chain[-1]}  version 1 \+ ", text), "a version tells what it has more"
    refused = say("--store", store, "models", "-c", "smal")
    assert refused.code == 2
    assert "did you mean 'small'" in refused.err


def test_the_report_of_the_newest_model(fitted: Path, say: Callable[..., Said], tmp_path: Path) -> None:
    done = say("--store", fitted / "thermodata.store", "report", "-o", tmp_path / "r.html")
    assert done.code == 0, done.err
    assert "<title>" in (tmp_path / "r.html").read_text("utf-8")


@pytest.mark.parametrize(
    ("right", "wrong", "line", "place"),
    [
        ("T_bearing}", "T_baering}", 8, "effects[0].drivers.temperature"),
        ("temperature:", "temprature:", 8, "effects[0].drivers.temprature"),
        ("spindle_bearing,", "spindle_baering,", 8, "effects[0].effect"),
        ("campaign: small", "campaign: smal", 4, "campaign"),
        ("step: 60 s", "step: 60 s\nverify_on: [dayX]", 7, "verify_on[0]"),
    ],
)
def test_what_only_the_data_show_to_be_wrong_has_its_line(
    fitted: Path, say: Callable[..., Said], tmp_path: Path, right: str, wrong: str, line: int, place: str
) -> None:
    text = (fitted / "baseline.yaml").read_text().lstrip("\n")
    assert right in text
    (tmp_path / "m.yaml").write_text("\n" + text.replace(right, wrong))
    said = say("--store", fitted / "thermodata.store", "fit", tmp_path / "m.yaml")
    assert said.code == 2
    assert f"m.yaml:{line} ({place})" in said.err
    assert "did you mean" in said.err


def test_an_unknown_signal_has_its_line(say: Callable[..., Said], tmp_path: Path) -> None:
    path = write_campaign(tmp_path)
    path.write_text(path.read_text().replace("signal: T_hall", "signal: T_hal"))
    line = next(i for i, text in enumerate(path.read_text().splitlines(), 1) if text.strip().startswith("T_hall:"))
    said = say("--store", tmp_path / "s", "ingest", path)
    assert said.code == 3
    assert f"{path.name}, line {line}" in said.out


@pytest.mark.parametrize("command", ["tests", "channels", "compare", "history", "diagnose", "portability baseline"])
def test_tables_fit_80_columns(fitted: Path, say: Callable[..., Said], command: str) -> None:
    out = say("--store", fitted / "thermodata.store", *command.split()).out
    tables = [line for line in out.splitlines() if "  " in line.strip()]
    assert tables
    assert [line for line in tables if len(line) > 80 and not line.startswith(("why", "  "))] == []


@pytest.mark.parametrize("command", ["tests", "channels", "quality", "calibrations"])
def test_a_campaign_where_a_command_takes_an_option_is_answered_with_it(
    say: Callable[..., Said], fitted: Path, command: str
) -> None:
    said = say("--store", fitted / "thermodata.store", command, "small")
    assert said.code == 2
    assert said.err.endswith(f"try: thermodata {command} --campaign small\n")
    assert say("gc", "small").err.endswith("try: thermodata gc --help\n")


def test_models_that_go_stale_are_told_by_name_and_id(say: Callable[..., Said], fitted: Path, tmp_path: Path) -> None:
    shutil.copytree(fitted, tmp_path / "lab")
    path, store = tmp_path / "lab" / "campaign.yaml", tmp_path / "lab" / "thermodata.store"
    path.write_text(path.read_text(encoding="utf-8").replace("gain: 1 um", "gain: 1.01 um"), encoding="utf-8")
    said = " ".join(say("--store", store, "ingest", path).out.split())
    rows = json.loads(say("--store", store, "models", "--json").out)
    assert len(rows) == 2
    assert all(f"baseline {row['version']} {row['model']}" in said for row in rows)


def test_two_names_of_one_model_are_told(fitted: Path, say: Callable[..., Said]) -> None:
    store = fitted / "thermodata.store"
    newest = StoreView(store).sql("select model from model order by created_at desc").fetchall()[0][0]
    said = say("--store", store, "compare", "baseline", newest)
    assert said.code == 0
    assert f"baseline and {newest} are one model, {newest}: 'baseline' is the newest version of that name" in said.err
    assert "the version before it is " in said.err
    assert "are one model" not in say("--store", store, "compare", "baseline").err
    against = say("--store", store, "compare", "baseline", "--against", newest)
    assert "is compared with itself" in against.err
    before = StoreView(store).sql("select model from model order by created_at").fetchall()[0][0]
    beside = say("--store", store, "compare", before, newest, "--against", newest)
    assert beside.code == 0
    assert "with itself" not in beside.err, "the reference may stand as a row of its own"
