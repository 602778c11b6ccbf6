"""`tests` with what is looked for: the list that the workbench shows."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from .conftest import write_campaign


def test_tests_are_found_by_words_role_and_kind(campaign: Path, say: Callable[..., Any]) -> None:
    def found(*words: str) -> list[str]:
        said = say("--store", campaign / "thermodata.store", "tests", *words, "--json")
        assert said.code == 0, said.err
        return [row["test"] for row in json.loads(said.out)]

    assert sorted(found("--find", "day")) == ["day1", "day2"]
    assert found("--role", "locked") == ["day2"]
    assert found("--find", "day", "--role", "verification", "--kind", "mixed") == ["day1"]
    assert found("--find", "9000 nothing") == []
    assert len(found()) == 4


def test_tests_and_campaigns_are_found_by_their_machine(campaign: Path, say: Callable[..., Any]) -> None:
    store = ("--store", campaign / "thermodata.store")
    rows = json.loads(say(*store, "tests", "--json").out)
    (machine,) = {row["machine"] for row in rows}
    assert machine
    for words in (("--find", machine.lower()), ("--machine", machine)):
        assert len(json.loads(say(*store, "tests", *words, "--json").out)) == len(rows)
    (one,) = json.loads(say(*store, "campaigns", "--machine", machine, "--json").out)
    assert (one["campaign"], one["machines"], one["tests"], one["locked"]) == ("small", [machine], len(rows), 1)
    shown = say(*store, "campaigns").out
    for told in (machine, "small", "campaign.yaml"):
        assert told in shown
    for command in ("tests", "campaigns"):
        said = say(*store, command, "--machine", machine + "x")
        assert (said.code, f"did you mean '{machine}'?" in said.err) == (2, True)


def test_that_nothing_is_found_is_said_with_where_it_was_looked_for(campaign: Path, say: Callable[..., Any]) -> None:
    said = say("--store", campaign / "thermodata.store", "tests", "--find", "SB-42")
    assert said.code == 0
    assert "none of 4 tests is such a one: all of 'SB-42' would have to stand in its campaign, name, kind" in said.err


@pytest.mark.parametrize(("option", "word", "meant"), [("--role", "lokced", "locked"), ("--kind", "mixd", "mixed")])
def test_a_role_or_kind_that_there_is_not_is_refused(
    campaign: Path, say: Callable[..., Any], option: str, word: str, meant: str
) -> None:
    said = say("--store", campaign / "thermodata.store", "tests", option, word)
    assert said.code == 2
    assert f"did you mean '{meant}'?" in said.err


def test_a_test_without_samples_is_not_exported(say: Callable[..., Any], tmp_path: Path) -> None:
    path = write_campaign(tmp_path)
    path.write_text(path.read_text(encoding="utf-8") + "  - {id: ghost, kind: mixed, role: locked}\n", encoding="utf-8")
    store = ("--store", tmp_path / "thermodata.store")
    say(*store, "ingest", path)
    said = say(*store, "export", "small", "ghost", tmp_path / "g.csv")
    assert said.code == 2
    assert "test 'ghost' has no samples" in said.err
    assert "heat1" in said.err
    assert not (tmp_path / "g.csv").exists()
