"""A line of notes that names several tests says of each what stands behind its own name."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from thermodata.draft.folder.beside.notes import notes_of
from thermodata.draft.folder.beside.statements import statements

CALLED = {n.casefold(): n for n in ("P1", "P2", "P3", "exp_b", "exp_c")}


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            "P1, P2: kalibratie; P3: verificatie.",
            [("P1", "kalibratie"), ("P2", "kalibratie"), ("P3", "verificatie")],
        ),
        ("- exp_b: fit; exp_c: verify", [("exp_b", "fit"), ("exp_c", "verify")]),
        ("P1 und P2: Kalibrierung", [("P1", "Kalibrierung"), ("P2", "Kalibrierung")]),
        ("P1和P2: 标定", [("P1", "标定"), ("P2", "标定")]),
        ("P1/P2: kal. P3: ver", [("P1", "kal"), ("P2", "kal"), ("P3", "ver")]),
        (
            "P1, P2 Kalibrierung, P3 Verifikation.",
            [("P1", "Kalibrierung"), ("P2", "Kalibrierung"), ("P3", "Verifikation")],
        ),
        (
            "Uhr im Plan. P1 e P2 calibrazione, P3 verifica. Potenza nominale 18 kW",
            [("P1", "calibrazione"), ("P2", "calibrazione"), ("P3", "verifica")],
        ),
        ("P1, P2 with the door open, P3 closed", []),  # no roles
        ("P1 Kalibrierung", []),
        ("P2: om 09:30 gecorrigeerd", []),  # of one test, as before
        ("P1: slower than P2: 6000 rpm", []),
        ("Tasters: P1, P2 en P3 staan op de tafel", []),
    ],
)
def test_what_a_line_says_of_several_tests(line: str, said: list[tuple[str, str]]) -> None:
    assert statements(line, CALLED) == said


@pytest.mark.parametrize("mark", ["/", "/a", "-a", " a", "和x"])
def test_a_line_of_marks_takes_no_time(mark: str) -> None:
    began = time.process_time()
    assert statements(mark * 200 + " Notes of the hall: June", CALLED) == []
    assert time.process_time() - began < 1


def test_the_line_of_a_test_and_the_one_of_all_stand_beside_each_other(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("P2: door open\nP1, P2: fit; P3: verify\n", encoding="utf-8")
    notes = notes_of(tmp_path, ["notes.txt"], {"P1": (), "P2": (), "P3": ()})
    assert {t: n.quoted for t, n in notes.items()} == {"P1": "fit", "P2": "door open; fit", "P3": "verify"}


def test_a_test_is_called_for_short_where_no_other_begins_so(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("V01 Kalibrierung, V02 Verifikation\nV03: door open\n", encoding="utf-8")
    tests = dict.fromkeys(("V01_4000", "V02_8000", "V03_a", "V03_b"), ())
    assert {t: n.quoted for t, n in notes_of(tmp_path, ["notes.txt"], tests).items()} == {
        "V01_4000": "Kalibrierung",
        "V02_8000": "Verifikation",
    }
