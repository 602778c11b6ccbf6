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
