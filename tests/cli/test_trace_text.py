"""The way back to the files, on a narrow screen."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from .conftest import Said


@pytest.mark.parametrize("columns", ["80", "200"])
def test_a_hash_stands_once(
    say: Callable[..., Said], campaign: Path, monkeypatch: pytest.MonkeyPatch, columns: str
) -> None:
    monkeypatch.setenv("COLUMNS", columns)
    words = ("--store", campaign / "thermodata.store", "trace", "small", "heat1", "dZ")
    sha256 = json.loads(say(*words, "--json").out)["files"][0]["sha256"]
    assert say(*words).out.count(sha256) == 1
