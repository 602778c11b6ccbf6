"""A column that numbers the rows of its files is no channel of a draft, and asks nothing; another count is asked."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.commands import Say


@pytest.mark.parametrize(("first", "every", "left_out"), [(1, 1, True), (0, 1, True), (1, 2, False), (5, 1, False)])
def test_numbers_of_rows_are_left_out(tmp_path: Path, say: Say, first: int, every: int, left_out: bool) -> None:
    (tmp_path / "raw").mkdir()
    for day in (2, 3):
        rows = (f"2026-03-0{day} 08:{k // 60:02d}:{k % 60:02d},{first + k // every},2{k % 9}.5" for k in range(240))
        (tmp_path / "raw" / f"t{day}.csv").write_text("\n".join(["Time,Scan,T_bed (°C)", *rows, ""]), encoding="utf-8")
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    assert ("'Scan' numbers the rows of each file: left out" in text) == left_out
    assert ("signal: Scan" in text) != left_out


def test_a_position_that_numbers_the_rows_is_none(tmp_path: Path, say: Say) -> None:
    for name, step in (("a", 1.0), ("b", 2.5)):
        (tmp_path / name).mkdir()
        rows = (f"{1 + k * step:g},2026-03-02 08:{k // 60:02d}:{k % 60:02d},2{k % 9}.5" for k in range(240))
        text = "\n".join(["Position,Time,T_bed (°C)", *rows, ""])
        (tmp_path / name / "log.csv").write_text(text, encoding="utf-8")
        assert say("init", tmp_path / name).code == 0
        text = (tmp_path / name / "campaign.yaml").read_text(encoding="utf-8")
        assert ("'Position' numbers the rows of each file: left out" in text) == (step == 1.0)
        assert ("signal: Position" in text) == (step != 1.0)
