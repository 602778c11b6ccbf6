"""One file in which the axes were moved one after the other: a jump test of each probe."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from tests.commands import Say


def _file(path: Path, columns: dict[str, Sequence[float]]) -> None:
    rows = [
        f"2026-03-02 {8 + k // 3600:02d}:{k // 60 % 60:02d}:{k % 60:02d}," + ",".join(f"{v:.5f}" for v in row)
        for k, row in enumerate(zip(*columns.values(), strict=True))
    ]
    path.write_text("\n".join([f"time,{','.join(columns)}", *rows, ""]), encoding="utf-8")


def _course(n: int, at: int, moves: Sequence[float], seed: int) -> Sequence[float]:
    """A probe that stands but for moves that are 20 s apart, from a second on."""
    x = np.random.default_rng(seed).normal(0, 2e-4, n)
    for k, move in enumerate(moves):
        x[at + 20 * k :] += move
    return x.tolist()


def _folder(folder: Path, starts: Sequence[int]) -> None:
    probes = ("U_X [V]", "U_Y [V]", "U_Z [V]")
    for test in ("S4000", "S8000"):
        drift = {p: np.linspace(0, 1 + k, 7200).tolist() for k, p in enumerate(probes)}
        _file(folder / f"{test}.csv", drift)
    moves = ([0.2, -0.2, 1.0, -1.0], [-0.2, 0.2, -1.0, 1.0], [4.0, -4.0, 2.0, -2.0])
    jump = {p: _course(300, s, m, k) for k, (p, s, m) in enumerate(zip(probes, starts, moves, strict=True))}
    _file(folder / "jump.csv", jump)


def test_probes_that_move_in_turn_have_a_jump_test_each(tmp_path: Path, say: Say) -> None:
    _folder(tmp_path, (20, 110, 200))
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    for axis, seen in (("X", "+0.2, -0.2, +1, -1"), ("Y", "-0.2, +0.2, -1, +1"), ("Z", "+4, -4, +2, -2")):
        (line,) = [one for one in text.splitlines() if one.startswith(f"  jump_U_{axis}: ")]
        assert f'file: jump.csv, signal: "U_{axis} [V]"' in line
        assert f"seen: steps of {seen} V" in line


def test_probes_that_move_at_once_have_one(tmp_path: Path, say: Say) -> None:
    _folder(tmp_path, (20, 20, 20))
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    assert [one[:13] for one in text.splitlines() if one.startswith("  jump_U_")] == ["  jump_U_Z: {"]
