"""A probe that stands at one reading in all files needs no jump test: it is asked whether it is connected."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.draft.make import draft_files
from thermodata.draft.probes.at_rail import at_rail
from thermodata.draft.signals.values import values_of


def _log(path: Path, dx: np.ndarray, dy: np.ndarray) -> None:  # type: ignore[type-arg]
    rows = (f"{i};{x:.4f};{y:.4f};{21 + i / 2000:.3f}" for i, (x, y) in enumerate(zip(dx, dy, strict=True)))
    path.write_text("\n".join(["time [s];dX [V];dY [V];T_bed [degC]", *rows, ""]), "utf-8")


@pytest.mark.parametrize(("level", "noise", "stands"), [(10.0, 0.0, True), (10.0, 2e-4, True), (10.0, 3e-3, False)])
def test_a_probe_at_its_rail_gets_no_question_for_moves(
    tmp_path: Path, level: float, noise: float, stands: bool
) -> None:
    rng = np.random.default_rng(1)
    for day in (1, 2):
        i = np.arange(600)
        _log(tmp_path / f"day{day}.csv", 5 + day * i / 3000, level + rng.normal(0, noise, 600))
    stairs = np.repeat([5.0, 6.0, 5.5, 5.0], 30) + rng.normal(0, 1e-3, 120)
    _log(tmp_path / "jump_x.csv", stairs, level + rng.normal(0, noise, 120))
    _log(tmp_path / "jump_y.csv", np.full(120, 5.0), level + rng.normal(0, noise, 120))
    draft_files(tmp_path)
    text = (tmp_path / "campaign.yaml").read_text("utf-8")
    line = next(x for x in text.splitlines() if x.startswith("  dY:"))
    assert ("stands at 10 V in all its files: at the end of its range, or not connected?" in line) is stands
    assert ("  jump_dY: {kind: jump" in text) is not stands
    assert "  jump_dX: {kind: jump" in text


@pytest.mark.parametrize(
    ("levels", "rows", "asked"),
    [([0.0, 0.0], 100, True), ([10.0, -10.0], 100, False), ([10.0, 10.0019], 100, True), ([10.0, 10.0021], 100, False)],
)
def test_all_files_hold_one_reading_or_it_is_none(levels: list[float], rows: int, asked: bool) -> None:
    assert bool(at_rail([values_of(np.full(rows, x)) for x in levels], "V")) is asked


def test_few_rows_and_files_that_nobody_saw_tell_nothing() -> None:
    assert at_rail([values_of(np.full(99, 10.0))], "V") is None
    assert at_rail([values_of(np.full(100, 10.0)), None], "V") is None
    assert at_rail([], "V") is None
