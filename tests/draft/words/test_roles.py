"""Roles that a list of the tests says are offered beside each test, and never taken."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.commands import Said
from thermodata.draft.words.naming import words
from thermodata.draft.words.roles import said_by_list, said_by_name


@pytest.mark.parametrize(
    ("cells", "found"),
    [
        ({"verwendung": "Kalibrierung"}, ("calibration", "verwendung")),
        ({"verwendung": "gesperrt"}, ("locked", "verwendung")),
        ({"uso": "verifica"}, ("verification", "uso")),
        ({"uso": "taratura", "tipo": "mandrino"}, ("calibration", "uso")),
        ({"usage": "Validierung"}, ("verification", "usage")),
        ({"note": "checked after calibration of the probes"}, None),
        ({"note": "calibration check"}, None),
        ({"a": "calibration", "b": "verification"}, None),
        ({"speed": "8000 rpm"}, None),
        ({"use": "überprüft"}, ("verification", "use")),
        ({"use": "holdout set"}, ("locked", "use")),
        *(({"state": s}, None) for s in ("invalid", "unlocked", "uncalibrated", "sbloccato", "neověřeno", "ungeprüft")),
        *(({"state": s}, None) for s in ("not valid", "non validé", "nicht kalibriert", "ne calibre pas", "未验证")),
    ],
)
def test_a_role_by_a_cell(cells: dict[str, str], found: tuple[str, str] | None) -> None:
    assert said_by_list(cells) == found


@pytest.mark.parametrize(
    ("name", "role"),
    [("D05_validation", "verification"), ("D05_invalid", None), ("D06Locked", "locked"), ("D06_unlocked", None)],
)
def test_a_role_by_a_name(name: str, role: str | None) -> None:
    assert said_by_name(words(name)) == role


def test_a_list_of_tests_offers_their_roles(tmp_path: Path, say: Callable[..., Said]) -> None:
    for i in (1, 2, 3):
        rows = "".join(f"{k};{20 + i + k / 10:.1f}\n" for k in range(60))
        (tmp_path / f"Versuch {i}.csv").write_text("time [s];T_front [degC]\n" + rows)
    (tmp_path / "Versuchsliste.csv").write_text(
        "Nr.;Verwendung\nVersuch 1;Kalibrierung\nVersuch 2;Validierung\nVersuch 3;gesperrt\n"
    )
    assert say("init", tmp_path).code == 0
    lines = [x for x in (tmp_path / "campaign.yaml").read_text().splitlines() if x.startswith("  - {id:")]
    assert all("role: none" in x for x in lines)
    for line, role in zip(lines, ("calibration", "verification", "locked"), strict=True):
        assert f"? role: {role}, as the table's 'verwendung' says?" in line


@pytest.mark.parametrize(("names", "told"), [(("run",), True), (("run 1", "run 2"), False)])
def test_a_test_alone_is_to_be_cut_so_that_some_of_it_can_confirm(
    tmp_path: Path, say: Callable[..., Said], names: tuple[str, ...], told: bool
) -> None:
    for name in names:
        rows = "".join(f"{k};{20 + k / 10:.1f}\n" for k in range(60))
        (tmp_path / f"{name}.csv").write_text("time [s];T_front [degC]\n" + rows)
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text()
    (head,) = [x for x in text.splitlines() if x.startswith("tests:")]
    assert ("window: [0 h, 16 h], history: recording" in head) == told
