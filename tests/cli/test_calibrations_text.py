"""What stands in the table of calibrations: offsets, and of what an uncertainty is made."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest

from ..commands import Say

CAMPAIGN = """
schema: thermodata/campaign/1
id: lab
sources: {log: {reader: table, files: "raw/{test}.csv"}}
channels:
  dZ: {source: log, signal: dZ, quantity: displacement, unit: V, axis: Z, at: tcp, calibration: jump}
  T_bed: {source: log, signal: T_bed, quantity: temperature, unit: degC, at: bed, calibration: ice}
calibrations:
  jump: {kind: jump, axis: Z, source: log, file: jump.csv, signal: dZ, moves: [50 um, -100 um, 100 um]MOVES}
  ice: {kind: linear, offset: -0.12 K}
tests:
  - {id: heat, kind: spindle, role: calibration}
"""


def _lab(folder: Path) -> Path:
    (folder / "raw").mkdir(parents=True)
    rng, t = np.random.default_rng(1), np.arange(0, 40, 0.1)
    level = np.repeat([0.0, 50.0, -50.0, 50.0], 100) / 50 + rng.normal(0, 1e-4, t.size)
    rows = [f"{a:.1f},{v:.5f}" for a, v in zip(t, level, strict=True)]
    (folder / "jump.csv").write_text("\n".join(["t [s],dZ [V]", *rows]) + "\n")
    rows = [f"{60 * i},{0.01 * i:.3f},{20 + 0.01 * i:.2f}" for i in range(100)]
    (folder / "raw" / "heat.csv").write_text("\n".join(["t [s],dZ [V],T_bed [degC]", *rows]) + "\n")
    return folder / "campaign.yaml"


@pytest.mark.parametrize(("moves", "mostly"), [("", 1.0), (", move_uncertainty: 0.001 um", None)])
def test_offsets_and_the_share_of_the_moves_are_told(
    say: Say, tmp_path: Path, moves: str, mostly: float | None
) -> None:
    path, store = _lab(tmp_path / "lab"), tmp_path / "store"
    path.write_text(CAMPAIGN.replace("MOVES", moves))
    texts = [say("--store", store, "ingest", path).out, say("--store", store, "calibrations").out]
    for text in texts:
        assert "offset" in text
        assert "-0.12" in text
        assert "(k=1)" in text, "one standard uncertainty, where predict has 95 %"
        assert ("± of jump: mostly move_uncertainty, 1 um a move" in text) == (mostly is not None)
        assert "passed" in text, "of a check nobody asks yes or no"
    rows = {c["calibration"]: c for c in json.loads(say("--store", store, "calibrations", "--json").out)}
    assert rows["jump"]["move_uncertainty_um"] == (mostly or 0.001)
    assert rows["ice"]["move_uncertainty_um"] is None
    (again,) = (
        c
        for c in json.loads(say("--store", store, "ingest", path, "--json").out)["calibrations"]
        if c["name"] == "jump"
    )
    assert again["move_uncertainty_um"] == (mostly or 0.001)


def test_at_a_terminal_sentences_are_folded_and_a_pipe_has_each_in_one_line(
    say: Say, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path, store = _lab(tmp_path / "lab"), tmp_path / "store"
    path.write_text(CAMPAIGN.replace("MOVES", ""))
    monkeypatch.setenv("COLUMNS", "100")
    commands = [("--store", store, "ingest", path), ("--store", store, "calibrations")]
    for words in commands:
        assert max(map(len, say(*words).out.splitlines())) > 100, "the sentence about moves"
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    for words in commands:
        assert max(map(len, say(*words).out.splitlines())) <= 100
