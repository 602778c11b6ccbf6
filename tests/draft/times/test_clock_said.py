"""A text that says that a clock is slow gets the offset, with its sign."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.commands import Said
from thermodata.draft.folder.beside.clock_said import offset_of


@pytest.mark.parametrize(
    ("sentence", "offset"),
    [
        ("Control clock is 37 min SLOW against the PC all week", "37 min"),
        ("the clock of the NC was 2,5 s fast", "-2.5 s"),
        ("NC clock 1 h ahead", "-1 h"),
        ("Die Uhr der Steuerung geht 4 Minuten nach", "4 min"),
        ("Die Uhr der Steuerung geht 4 min vor", "-4 min"),
        ("Steuerung: Ortszeit, Uhr geht 3 min nach (Steuerung zeigt 3 min zu wenig).", "3 min"),
        ("hodiny CNC o 12 min pozadu", "12 min"),
        ("Horloge de la CN en avance (env 1,5 min)", "-1.5 min"),
        ("L'orologio del Mazak e indietro di 12 min 50 s rispetto al PC", "12 min 50 s"),
        ("clock 1 h and 2 min ahead", "-1 h 2 min"),
        ("Uhr des Almemo 2:30 min vor", "-2 min 30 s"),
        ("Uhr des Almemo 1:05 h nach.", "1 h 5 min"),
        ("the logger's clock is 3m05s behind", "3 min 5 s"),
        ("GL840_B geht 2 min 10 s vor", "-2 min 10 s"),
        ("The testo hall logger is 10 min slow (summer time set)", "10 min"),
        ("testo jde o 7 minut napřed", "-7 min"),
        ("HIOKIの時計はGL840より3分5秒遅れている", "3 min 5 s"),
        ("Uhr 2 min vor dem Start gestellt", None),
        ("die Spindel geht 5 min nach oben", None),
        ("clock loses 2 s/day, slow", None),
        ("Die Uhr geht 4 bis 5 min vor", None),
        ("clock is 4 to 5 min slow", None),
        ("clock between 4 and 5 min slow", None),
        ("clock 1.234,5 s slow", None),
        ("clock 1 h and 2 min slow", "1 h 2 min"),
        ("clock 2,5 s slow", "2.5 s"),
        ("clock 4-5 min slow", None),
        ("clock 50 s slow, and 12 min later still", None),
        ("Nach 4 min die Uhr gestellt", None),
        ("clock set 5 min before", None),
        ("the clock is slow", None),
        ("the spindle was 30 s slow", None),
        ("clock 5 min slow, later 3 min slow", None),
    ],
)
def test_the_offset_of_a_sentence(sentence: str, offset: str | None) -> None:
    assert offset_of(sentence) == offset


def test_the_draft_says_it(tmp_path: Path, say: Callable[..., Said]) -> None:
    rows = "".join(f"2026-03-02 08:{k:02d}:00,{20 + k / 10}\n" for k in range(60))
    (tmp_path / "a.csv").write_text(f"Time,T_bed [degC]\n{rows}")
    (tmp_path / "README.txt").write_text("Lab 3. Control clock is 37 min SLOW against the PC. Nice weather.\n")
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text()
    assert (
        "says 'Control clock is 37 min SLOW against the PC': at the source of that clock, clock: {offset: 37 min}"
        in text
    )


def test_the_draft_says_it_of_amounts_that_are_about_so_large(tmp_path: Path, say: Callable[..., Said]) -> None:
    rows = "".join(f"2026-03-02 08:{k:02d}:00,{20 + k / 10}\n" for k in range(60))
    (tmp_path / "a.csv").write_text(f"Time,T_bed [degC]\n{rows}")
    (tmp_path / "LISEZMOI.txt").write_text("Horloge de la CN en avance (env. 1,5 min). Broche: 22 kW\n")
    assert say("init", tmp_path).code == 0
    assert "clock: {offset: -1.5 min}" in (tmp_path / "campaign.yaml").read_text()


@pytest.mark.parametrize(
    ("said", "zone"),
    [("Uhr: MEZ (keine Sommerzeit)", "Etc/GMT-1"), ("Uhr: Ortszeit", None), ("MEZ GmbH, Halle 3", None)],
)
def test_a_zone_that_a_text_says_of_a_clock_is_offered_at_its_question(
    tmp_path: Path, say: Callable[..., Said], said: str, zone: str | None
) -> None:
    rows = "".join(f"2026-03-02 08:{k:02d}:00,{20 + k / 10}\n" for k in range(60))
    (tmp_path / "a.csv").write_text(f"Time,T_bed [degC]\n{rows}")
    (tmp_path / "Info.txt").write_text(f"Lab 3\n{said}\n")
    assert say("init", tmp_path).code == 0
    (line,) = [x for x in (tmp_path / "campaign.yaml").read_text().splitlines() if "timezone?" in x]
    assert (f"Info.txt says '{said}': timezone: {zone}?" in line) is (zone is not None)


@pytest.mark.parametrize("hostile", ["1" * 99_000, "geht " * 19_000])
def test_a_sentence_longer_than_anybody_writes_says_nothing(hostile: str) -> None:
    """Its patterns take the square of its length: ten minutes of these."""
    assert offset_of(hostile + "clock 3 min slow") is None


@pytest.mark.parametrize(
    "sentence",
    [
        "clock of the DAQ is not 5 min slow",
        "clock synchronised, no longer 5 min slow",
        "Uhr geht nicht mehr 5 min nach",
        "recorder: slow channel every 10 s",
        "fast logger: period 0.1 s",
        "Logger slow, Abtastung 5 s",
        "the clock is 1,200 s slow",
    ],
)
def test_what_is_not_so_or_of_how_often_it_measures_is_no_offset(sentence: str) -> None:
    assert offset_of(sentence) is None


@pytest.mark.parametrize(
    ("sentence", "offset"),
    [
        ("the clock is 1,20 s slow", "1.2 s"),
        ("logger 1.5 h ahead", "-1.5 h"),
        ("NC clock 3 min slow (not corrected)", "3 min"),
        ("Uhr der Steuerung geht 2 min vor, noch nicht korrigiert", "-2 min"),
        ("alle Uhren gehen 2 min vor", "-2 min"),
    ],
)
def test_and_what_is_so_is(sentence: str, offset: str) -> None:
    assert offset_of(sentence) == offset
