"""`tests` with what is looked for: the list that the workbench shows."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any


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
