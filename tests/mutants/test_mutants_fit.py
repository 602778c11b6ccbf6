"""Every mutant still changes something: its old text stands exactly once in its file."""

from __future__ import annotations

import importlib
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent


@pytest.mark.parametrize("name", ["claims", "measuring", "text"])
def test_the_old_text_of_each_mutant_stands_once_in_its_file(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(HERE))
    mutants = importlib.import_module(name).MUTANTS
    assert len(mutants) > 10
    for one in mutants:
        text = (HERE.parents[1] / one.file).read_text("utf-8")
        assert (text.count(one.old), one.old != one.new) == (1, True), (one.file, one.old)
