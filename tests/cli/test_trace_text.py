"""The way back to the files, on a narrow screen."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from pathlib import Path

import pytest

from ..commands import Said
from .conftest import write_campaign


@pytest.mark.parametrize("columns", ["80", "200"])
def test_a_hash_stands_once(
    say: Callable[..., Said], campaign: Path, monkeypatch: pytest.MonkeyPatch, columns: str
) -> None:
    monkeypatch.setenv("COLUMNS", columns)
    words = ("--store", campaign / "thermodata.store", "trace", "small", "heat1", "dZ")
    sha256 = json.loads(say(*words, "--json").out)["files"][0]["sha256"]
    assert say(*words).out.count(sha256) == 1


def test_the_sum_behind_a_sample_is_whole(say: Callable[..., Said], tmp_path: Path) -> None:
    path = write_campaign(tmp_path)
    text = path.read_text(encoding="utf-8").replace(
        "gain: 1 um/um, facing: -Z", "gain: 2 um/um, offset: 20 um, facing: -Z"
    )
    path.write_text(text, encoding="utf-8")
    store = ("--store", tmp_path / "thermodata.store")
    assert say(*store, "ingest", path).code == 0
    out = say(*store, "trace", "small", "heat1", "dZ", "--at", "1 h").out
    gain, raw, sign, offset, value = re.search(  # type: ignore[union-attr]
        r"sum +(\S+) \* (\S+) ([+-])(\S+) = (\S+) um", out
    ).groups()
    assert float(offset) == 20
    assert float(gain) * float(raw) + float(sign + offset) == pytest.approx(float(value))
    assert "offset" in next(line for line in out.splitlines() if line.startswith("calibration"))
