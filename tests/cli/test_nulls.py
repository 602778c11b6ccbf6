"""JSON values that do not apply are null: no text of nothing."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from ..commands import Said


def empty(value: Any, place: str = "") -> Iterator[str]:
    if value == "":
        yield place
    inside = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, part in inside:
        yield from empty(part, f"{place}.{key}")


@pytest.mark.parametrize(
    "words",
    [
        ("calibrations",),
        ("trace", "small", "heat1", "dZ", "--at", "1 h"),
        ("tests",),
        ("channels",),
        ("fit", "baseline"),
        ("diagnose", "baseline"),
    ],
)
def test_a_command_answers_no_empty_text(
    say: Callable[..., Said], campaign: Path, tmp_path: Path, words: tuple[str, ...]
) -> None:
    store = shutil.copytree(campaign / "thermodata.store", tmp_path / "store")  # others ask what it holds, too
    said = say("--store", store, *words, "--json")
    assert said.code == 0, said.err
    assert list(empty(json.loads(said.out))) == []


def test_a_draft_answers_no_empty_text(say: Callable[..., Said], campaign: Path, tmp_path: Path) -> None:
    shutil.copytree(campaign / "raw", tmp_path / "lab")
    said = say("init", tmp_path / "lab", "--json")
    assert said.code == 0, said.err
    assert list(empty(json.loads(said.out))) == []
