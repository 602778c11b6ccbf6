"""Each fast path gives what the plain way gives, on whole and on damaged files, and is taken at all."""

from __future__ import annotations

import importlib
from pathlib import Path
from types import ModuleType

import pytest

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"
PATHS = ["control csv", "lvm", "csv", "csv as text", "mcap json", "tdms"]


@pytest.fixture
def fast_paths(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    for folder in (BENCHMARKS.parents[1], BENCHMARKS):  # in this process: each one's start takes longer than its files
        monkeypatch.syspath_prepend(str(folder))
    return importlib.import_module("fast_paths")


@pytest.mark.parametrize("name", PATHS)
def test_it_reads_the_same_as_the_plain_way(name: str, tmp_path: Path, fast_paths: ModuleType) -> None:
    result = fast_paths.checked(name, tmp_path, fast_paths.MUTATIONS)
    assert result.different == []
    assert result.count.acted > 0
    assert result.files >= 5


def test_every_fast_path_is_tried(fast_paths: ModuleType) -> None:
    assert [*fast_paths.FAST, "tdms"] == PATHS
