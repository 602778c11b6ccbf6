"""What a list of tests says of them: speeds in any language, and the kind of a test whose logs do not show it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.commands import Say
from tests.draft.labs import workbook
from thermodata.draft.folder.beside.table import find_table
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.files.load import load_campaign


def listed(folder: Path, title: str, *values: str, more: str = "") -> dict[str, str]:
    """The conditions of the first of as many tests as values."""
    rows = "".join(f"P{k};{value}{';7' if more else ''}\n" for k, value in enumerate(values, 1))
    (folder / "tests.csv").write_text(f"Test;{title}{';' + more if more else ''}\n{rows}", encoding="utf-8")
    table = find_table(folder, ["tests.csv"], [f"P{k}" for k in range(1, len(values) + 1)])
    assert table is not None
    return dict(table.rows["P1"])


@pytest.mark.parametrize(
    "title",
    [
        "Obroty [obr/min]",
        "Drehzahl [U/min]",
        "Otáčky [ot/min]",
        "Vitesse de broche [tr/min]",
        "Giri mandrino [giri/min]",
        "n husillo [vueltas/min]",
        "Varvtal [varv/min]",
        "Toerental [omw/min]",
        "Devir [dev/dk]",
        "whatever [rpm]",
    ],
)
def test_turns_a_minute_are_the_speed_in_any_language(tmp_path: Path, title: str) -> None:
    found = listed(tmp_path, title, "4000", "8000", "12000")
    assert list(found) == ["speed"]
    assert float(found["speed"].split()[0]) == 4000


@pytest.mark.parametrize("title", ["Chłodzenie [l/min]", "Uwagi", "Temperatura [°C]", "Masa [g/min]"])
def test_other_columns_are_no_speed(tmp_path: Path, title: str) -> None:
    assert "speed" not in listed(tmp_path, title, "1", "2", "3")


def test_a_second_speed_keeps_its_own_name(tmp_path: Path) -> None:
    found = listed(tmp_path, "Drehzahl [U/min]", "4000", "8000", more="Drehzahl Tisch [U/min]")
    assert found == {"speed": "4000 U/min", "drehzahl_tisch": "7 U/min"}


def test_numbers_keep_their_digits(tmp_path: Path) -> None:
    assert listed(tmp_path, "Serial", "1234567", "8") == {"serial": "1234567"}
    workbook(tmp_path / "tests.xlsx", [["Test", "Weg [um]"], [20260301, 1234567.25], [20260302, 2]])
    table = find_table(tmp_path, ["tests.xlsx"], ["20260301", "20260302"])
    assert table is not None
    assert table.rows == {"20260301": {"weg": "1234567.25 um"}, "20260302": {"weg": "2 um"}}


def test_a_text_with_a_cell_of_any_length_is_no_table(tmp_path: Path) -> None:
    (tmp_path / "tests.csv").write_text(f'Test;Note\nP1;"{"x" * 200_000}"\nP2;y\n')
    assert find_table(tmp_path, ["tests.csv"], ["P1", "P2"]) is None


def folder_of(tmp_path: Path, units: dict[str, str], speeds: dict[str, str]) -> None:
    """Logs of a probe, each in its unit, and the list of their speeds."""
    for test, unit in units.items():
        scale = 1e-3 if unit == "mm" else 1.0
        rows = "".join(f"2026-03-02 08:{i // 60:02}:{i % 60:02};{scale * (10 + i / 20):.6g}\n" for i in range(300))
        (tmp_path / f"{test}.csv").write_text(f"Czas;Czujnik Z [{unit}]\n{rows}", encoding="utf-8")
    rows = "".join(f"{test};{speed}\n" for test, speed in speeds.items())
    (tmp_path / "tests.csv").write_text(f"Test;Obroty [obr/min]\n{rows}", encoding="utf-8")


def drafted(tmp_path: Path, say: Say) -> Campaign:
    assert say("init", tmp_path).code == 0
    return load_campaign(tmp_path / "campaign.yaml")


def test_a_probe_in_mm_is_what_it_is_in_um_and_the_list_tells_the_kind(tmp_path: Path, say: Say) -> None:
    folder_of(tmp_path, {"P1": "µm", "P2": "mm", "P3": "µm"}, {"P1": "4000", "P2": "8000", "P3": "12000"})
    campaign = drafted(tmp_path, say)
    assert [(n, c.quantity, c.at) for n, c in campaign.channels.items()] == [("Czujnik_Z", "displacement", "tcp")]
    assert [t.kind for t in campaign.tests] == ["spindle"] * 3
    assert campaign.tests[1].conditions["speed"] == "8000 obr/min"
    assert "spindle_speed" in (tmp_path / "campaign.yaml").read_text(encoding="utf-8")


def test_a_probe_in_mm_alone_shows_no_axis_that_stands_still(tmp_path: Path, say: Say) -> None:
    folder_of(tmp_path, {"P1": "mm", "P2": "mm"}, {"P1": "0", "P2": "0"})
    campaign = drafted(tmp_path, say)
    assert [t.kind for t in campaign.tests] == ["other"] * 2
    assert "nothing moves" not in (tmp_path / "campaign.yaml").read_text(encoding="utf-8")


def test_sums_of_a_pivot_are_no_conditions(tmp_path: Path) -> None:
    tests = ["T1_4000", "T2_8000"]
    rows = [row for t in tests for row in (f"{t};0;-6.2", ";1;-8.1", f"{t} Totale;;-7.2")]
    (tmp_path / "pivot.csv").write_text("\n".join(["Prova;Ora;Z", *rows, "Totale complessivo;;-7.2", ""]))
    assert find_table(tmp_path, ["pivot.csv"], tests) is None
    (tmp_path / "pivot.csv").write_text("\n".join(["Prova;Ora;Z", "T1_4000;8;-6", "T2_8000;9;-7", "Totale;;-13", ""]))
    assert find_table(tmp_path, ["pivot.csv"], tests) is not None


@pytest.mark.parametrize(
    ("name", "title", "cell", "asked"),
    [
        ("n8000", "Drehzahl [krpm]", "8", None),
        ("n8000", "Drehzahl [krpm]", "8,5", "speed: the name says 8000 rpm, the table 8.5 krpm"),
        ("n8000", "Drehzahl [rpm]", "8000,0", None),
        ("X_6mmin", "Vorschub [mm/min]", "6000", None),
        ("X_6mmin", "Vorschub [mm/min]", "6", "feed: the name says 6 m/min, the table 6 mm/min"),
    ],
)
def test_a_name_and_a_table_are_compared_in_their_units(
    tmp_path: Path, say: Say, name: str, title: str, cell: str, asked: str | None
) -> None:
    folder_of(tmp_path, {f"{name}_a": "um", f"{name}_b": "um"}, {})
    (tmp_path / "tests.csv").write_text(f"Test;{title}\n{name}_a;{cell}\n{name}_b;{cell}\n", encoding="utf-8")
    drafted(tmp_path, say)
    text = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    assert (asked in text) if asked else ("the name says" not in text)
