"""A log of which much is lost: `init` says what, and how much of it, as `ingest` does."""

from __future__ import annotations

from pathlib import Path

from tests.commands import Say


def test_the_draft_says_what_is_lost_and_how_much(tmp_path: Path, say: Say) -> None:
    rows = [f"2026-03-02 {8 + k // 60:02d}:{k % 60:02d}:00" for k in range(300)]
    lines = ["Time,T_bed [°C]", *(f"{t},21.{k % 9}" for k, t in enumerate(rows[:100]))]
    lines += ["Time,dZ [um]", *(f"{t},1.{k % 9}" for k, t in enumerate(rows[100:])), ""]
    (tmp_path / "P1.csv").write_text("\n".join(lines), encoding="utf-8")
    say("init", tmp_path)
    (told,) = [x for x in (tmp_path / "campaign.yaml").read_text("utf-8").splitlines() if x.startswith("# damaged")]
    assert "1 loss in what was read of it: P1.csv line 102: another header begins here" in told
    assert "of the file)" in told
    said = say("--store", tmp_path / "store", "ingest", tmp_path / "campaign.yaml")
    assert "another header begins here" in said.out
