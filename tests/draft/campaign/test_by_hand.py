"""A log of changes that somebody wrote by hand: what its values leave open is asked, and only there."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.make import draft_files


@pytest.mark.parametrize(
    ("speeds", "asked"), [((0, 1987, 4031, 0), True), ((0, 2000, 4000, 0), False), ((1987, 1991, 1985, 1990), False)]
)
def test_few_rows_of_no_set_values_are_asked(tmp_path: Path, speeds: tuple[int, ...], asked: bool) -> None:
    minutes = [f"2026-05-11T{6 + m // 60:02d}:{m % 60:02d}:00Z;{20 + 0.01 * m:.2f}\n" for m in range(240)]
    (tmp_path / "V1.csv").write_text("timestamp;T_bearing_front [degC]\n" + "".join(minutes))
    steps = [f"2026-05-11T{6 + h:02d}:00:00Z;{n}\n" for h, n in enumerate(speeds)]
    (tmp_path / "V1_n.csv").write_text("timestamp;spindle speed [rpm]\n" + "".join(steps))
    draft = draft_files(tmp_path).draft
    (speed,) = [c for c in draft.channels if c.said.quantity == "rotational_speed"]
    assert any(q.startswith("held: true, or false?") for q in speed.said.questions) is asked
