"""Settings beside a log without a header are offered where it is asked of its period; nothing of them is taken."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import pytest

from thermodata.draft.files.ini_beside import offered_by_ini
from thermodata.draft.make import draft_files

INI = """[Acquisition]
Voie0=S1 (nid +Z)
Voie1=Palier avant
Periode_s=5
[Essai]
Nom=E1
Date=02/06/2026
Heure=09:05:20
"""


def test_what_stands_beside_a_headless_log_is_offered_and_asked(tmp_path: Path) -> None:
    for test in ("E1", "E2"):
        rows = [f"{5 + (k * 7 % 9) / 1000:.4f}\t{1.8 + k / 1000:.4f}" for k in range(300)]
        (tmp_path / f"{test}.txt").write_text("\n".join([*rows, ""]))
        (tmp_path / f"{test}.ini").write_text(INI.replace("E1", test))
        first = datetime(2026, 6, 22, 9)
        stamps = [f"{first + timedelta(minutes=k):%Y-%m-%d %H:%M:%S},{20 + k / 50},{k % 7}" for k in range(240)]
        (tmp_path / f"cn_{test}.csv").write_text("\n".join(["time,T_bed [degC],n [rpm]", *stamps, ""]))
    (source,) = [s for s in draft_files(tmp_path).draft.sources if "period" in (s.table or {}).get("time", {})]
    assert source.table == {"time": {"period": "unknown"}}, "it is offered, not taken"
    (asked,) = [q for q in source.questions if q.startswith("period")]
    assert "E1.ini says 'Periode_s=5': period: 5 s?" in asked
    assert "'Date=02/06/2026' and 'Heure=09:05:20': the start of this test?" in asked
    assert "names: ['S1 (nid +Z)', 'Palier avant']" in asked
    assert not any("lasts" in q for q in source.questions), "nobody knows how long rows at an unknown period last"


@pytest.mark.parametrize(
    ("lines", "offered"),
    [
        ("Abtastzeit=200 ms", "; a.ini says 'Abtastzeit=200 ms': period: 200 ms?"),
        ("dt=0,5", ""),  # of what?
        ("Kanal1=T1\nKanal3=T3", ""),  # one is missing
        ("Nom=E1", ""),
    ],
)
def test_only_what_is_said_is_offered(tmp_path: Path, lines: str, offered: str) -> None:
    (tmp_path / "a.ini").write_text(f"[A]\n{lines}\n")
    assert offered_by_ini(tmp_path / "a.txt") == offered


def test_a_line_of_blanks_is_answered_at_once(tmp_path: Path) -> None:
    """A pattern with blanks before and behind its key took the square of them: 11 s of 19,000."""
    (tmp_path / "E1.ini").write_text(" " * 19_000 + "a\nPeriode_s=5\n")
    assert "period: 5 s?" in offered_by_ini(tmp_path / "E1.txt")
