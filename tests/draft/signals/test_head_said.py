"""What the head of a file says of units stands beside the question of a unit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say
from thermodata.draft.make import draft_files
from thermodata.draft.signals.guess import guess_of
from thermodata.draft.signals.head_said import with_text
from thermodata.draft.signals.values import values_of
from thermodata.plugin import Signal


@pytest.mark.parametrize(
    ("head", "asked"),
    [
        (
            "Temperature scale: Fahrenheit\n\nDate Time,T_bed,T_column",
            "the head of the file says 'Temperature scale: F",
        ),
        ("Units: INCH / DEG F\n\nDate Time,T_bed,Z probe", "the head of the file says 'Units: INCH / DEG F'"),
        ('"Scaling","CH1","Ratio","100","um"\n\n"Date Time","CH1[V]","T_bed"', "says 'Scaling CH1 Ratio 100 um'"),
        ("Operator: Smith\n\nDate Time,T_bed,T_column", ""),
    ],
)
def test_units_of_the_head_are_quoted(tmp_path: Path, say: Say, head: str, asked: str) -> None:
    rows = [f"2026-03-12 08:{k:02d}:00,{45 + k / 7:.2f},{0.01 + k / 900:.5f}" for k in range(60)]
    (tmp_path / "run1.csv").write_text("\n".join([head, *rows, ""]), encoding="utf-8")
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    assert asked in text if asked else "the head of the file" not in text


def _two_heads(folder: Path, second: str) -> None:
    """A test in um and one in another unit, of which the lines above the names alone tell."""
    for day, (name, unit) in enumerate([("a", "um"), ("b", second)]):
        times = {"um": 1.0}.get(unit, 0.001)
        rows = [f"2026-03-1{day} 08:{k:02d}:00;{(4 + k * 0.7) * times:.5g};{20 + k / 30:.2f}" for k in range(60)]
        head = f"% Einheit Weg: {unit}\n% Einheit Temperatur: degC\nZeit;Weg_Z;T_vorn"
        (folder / f"{name}.csv").write_text("\n".join([head, *rows, ""]), encoding="utf-8")


@pytest.mark.parametrize(("second", "differ"), [("mm", True), ("um", False)])
def test_heads_of_files_that_differ_are_asked_with_their_files_and_told_where_one_unit_is_taken(
    tmp_path: Path, say: Say, second: str, differ: bool
) -> None:
    _two_heads(tmp_path, second)
    assert say("init", tmp_path).code == 0
    campaign = tmp_path / "campaign.yaml"
    text = campaign.read_text(encoding="utf-8")
    (line,) = [line for line in text.splitlines() if "signal: Weg_Z" in line]
    assert ("the heads of the files differ" in line) is differ
    assert not differ or ("(a.csv)" in line and "Einheit Weg: mm" in line and "(b.csv)" in line)
    assert "the heads of the files differ" not in next(x for x in text.splitlines() if "signal: T_vorn" in x)
    text = text.replace("quantity: displacement,", "quantity: displacement, unit: um,")
    campaign.write_text(text, encoding="utf-8")
    said = say("--store", tmp_path / "store", "ingest", campaign)
    told = "Weg_Z: read in um throughout, and the heads of its files differ"
    assert (told in said.out) is differ
    assert said.code == (3 if differ else 0)
    if differ:
        campaign.write_text(text.replace("{id: b,", "{id: b, channels: {Weg_Z: {unit: mm}},"), encoding="utf-8")
        said = say("--store", tmp_path / "store", "ingest", campaign)
        assert (said.code, told in said.out) == (0, False)


@pytest.mark.parametrize(
    ("head", "quoted"),
    [
        ("# +Z means spindle grows towards table", ["dZ"]),
        ("# sign: positive dX = tool moves away from the column", ["dX"]),
        ("# probe moved by 50 um at 8:10", ["dZ", "dX"]),
        ("Bemerkung: Tisch 100 µm nach +Z verfahren", ["dZ"]),
        ("# Operator: A. Positive, block 3", []),
        ("# steps of 1 min", []),
    ],
)
def test_what_the_head_says_of_a_sign_or_a_jump_is_quoted_beside_its_displacements(
    tmp_path: Path, say: Say, head: str, quoted: list[str]
) -> None:
    rows = [f"2026-03-12 08:{k:02d}:00,{20 + k / 30:.2f},{4 + k * 0.7:.2f},{2 + k * 0.2:.2f}" for k in range(60)]
    names = "time,T_front_degC,dZ [um],dX [um]"
    (tmp_path / "run1.csv").write_text("\n".join([head, names, *rows, ""]), encoding="utf-8")
    assert say("init", tmp_path).code == 0
    lines = (tmp_path / "campaign.yaml").read_text(encoding="utf-8").splitlines()
    told = [line.strip().split(":")[0] for line in lines if f"the head of the file says '{head}'" in line]
    assert told == quoted


@pytest.mark.parametrize(
    ("head", "asked"),
    [
        ("# speed in 1/s, T_bed in degC", "unit: rpm, or 1/s? the head of the file says '# speed in 1/s"),
        ("# speed in rpm, T_bed in degC", ""),
        ("# speed in a table", ""),
        ("# Operator: A, speed: V", ""),
    ],
)
def test_a_unit_that_the_head_says_of_a_column_is_asked_beside_that_of_its_name(
    tmp_path: Path, say: Say, head: str, asked: str
) -> None:
    rows = [f"2026-03-12 08:{k:02d}:00,{25 + k / 7:.2f},{66 + 66 * (k > 30)}" for k in range(60)]
    (tmp_path / "run1.csv").write_text("\n".join([head, "time,T_bed,speed_rpm", *rows, ""]), encoding="utf-8")
    assert say("init", tmp_path).code == 0
    text = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    assert asked in text if asked else "the head of the file" not in text


@pytest.mark.parametrize(
    ("text", "asked"),
    [
        ("time in hours, dZ in mm, n in 1/s", "unit: rpm, or 1/s? the file's info says 'time in hours"),
        ("time in hours, n in rpm", ""),
        ("n in a row, dZ in mm", ""),
        ("dZ in mm, speed in 1/s", ""),  # of another signal
    ],
)
def test_a_text_beside_the_signals_that_says_a_unit_is_asked(text: str, asked: str) -> None:
    signal = Signal("n", "s", None, "float64", None, {"info": text})
    said = with_text(guess_of(signal, values_of(np.linspace(0.0, 133.0, 300))), signal)
    assert (said.quantity, said.unit) == ("rotational_speed", "rpm")
    questions = " ".join(said.questions)
    assert asked in questions if asked else "says" not in questions


@pytest.mark.parametrize(
    ("head", "quantity", "unit"),
    [
        ("Units: microinch", "displacement", "microinch"),
        ("Units: um", "displacement", "um"),
        ("Units: see manual", None, None),
        ("Operator: Miller", None, None),
    ],
)
def test_a_signal_whose_name_says_nothing_is_drafted_by_the_one_unit_of_the_head(
    tmp_path: Path, head: str, quantity: str | None, unit: str | None
) -> None:
    rows = [f"{k}\t{np.sin(k / 9) * 40:.1f}\t{np.cos(k / 7) * 9:.1f}" for k in range(120)]
    lines = ["Spindle Error Analyzer", head, "", "Elapsed (min)\tZ\tX1", *rows, ""]
    (tmp_path / "run1.txt").write_text("\n".join(lines), encoding="utf-8")
    found = {c.signal: c.said for c in draft_files(tmp_path).draft.channels}
    assert {(s.quantity, s.unit) for s in found.values()} == {(quantity, unit)}
    if quantity:
        assert any(q.startswith(f"unit: {unit}?, the head of the file says '{head}'") for q in found["Z"].questions)


def test_what_is_said_of_an_array_is_asked_of_each_of_its_elements() -> None:
    properties = {"array description": "five probes, gap in nm"}
    signal = Signal("/nest.gap[3]", "/nest", properties=properties)
    found = with_text(guess_of(signal, values_of(np.linspace(2.4e5, 3.0e5, 300))), signal)
    assert any("the file's array description says 'five probes, gap in nm'" in q for q in found.questions)
