"""The blocks of docs/python.md run, one after the other, in a folder with a store and a model file."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from thermodata.cli import main

from ..cli.conftest import write_campaign

PAGE = Path(__file__).parents[2] / "docs" / "python.md"
BLOCKS = re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), flags=re.DOTALL)


@pytest.fixture(scope="session")
def raw_lab(once: Callable[[str, Callable[[Path], object]], Path]) -> Path:
    def make(folder: Path) -> None:
        assert main(["--store", str(folder / "thermodata.store"), "ingest", str(write_campaign(folder)), "--json"]) == 0
        (folder / "baseline.yaml").rename(folder / "model.yaml")

    return once("python-doc", make)


def test_its_blocks_run(raw_lab: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.copytree(raw_lab, tmp_path / "lab")
    monkeypatch.chdir(tmp_path / "lab")
    names: dict[str, Any] = {}
    assert len(BLOCKS) == 3
    for block in BLOCKS:
        exec(compile(block, str(PAGE), "exec"), names)
    assert Path("better.html").stat().st_size > 100_000
    errors = [row["verification_rmse_um"] for row in names["better"].history()]
    assert errors[1] < 0.6 * errors[0]  # the effect that was left out
    assert names["verdict"].claims[0].effect == "feed_screw"
    assert set(names["largest"]) == {"spindle_bearing", "feed_screw"}
    assert all(size > 1.0 for size in names["largest"].values())
