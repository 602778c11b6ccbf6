"""Names whose sense their neighbours give, and words of one trade: the draft guesses or asks, and is never sure."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.commands import Say
from thermodata.draft.courses.kinds import kind_of
from thermodata.draft.signals.guess import guess
from thermodata.draft.words.said_by_names import said_by


@pytest.mark.parametrize(
    ("name", "unit", "at", "sure"),
    [
        ("T_chladic_vstup", "degC", "chiller", False),
        ("T_chladici_kapalina", "degC", "coolant", True),
        ("T_Fuehr_Z", "degC", "axis.z.guide", False),
        ("T_prac_vretenik", "degC", None, False),
        ("Teplota pracovního vřeteníku", "degC", None, False),
        ("Otáčky pracovního vřeteníku", "rpm", "rotary.c", False),
        ("Otáčky pracovního vřetene", "rpm", "rotary.c", False),
        ("Otáčky brusného vřetene", "rpm", "spindle", True),
        ("T_vretenik", "degC", "headstock", True),
        ("Reitstock", "degC", "tailstock", True),
        ("Teplota koníku", "degC", "tailstock", True),
        ("TC07_gway_Z", "degC", "axis.z.guide", False),
        ("n_WSS", "rpm", "rotary.c", False),
        ("Workhead.nAct", "rpm", "rotary.c", False),
        ("ot_prac_vret", "rpm", "rotary.c", False),
        ("ot_vretene", "rpm", "spindle", True),
        ("T7 stojan vpředu", "degC", "column.front", True),
        ("T8 stojan vzadu", "degC", "column.rear", True),
        ("T3 olej převodovky", "degC", "spindle.gearbox", False),
        ("Getriebe_Oel", "degC", "spindle.gearbox", False),
        ("Hydr_Oel", "degC", "hydraulics", True),
        ("Traghuelse", "degC", "ram", True),
        ("Kuehler_VL", "degC", "chiller.supply", False),
    ],
)
def test_a_word_of_the_trade_is_its_place(name: str, unit: str, at: str | None, sure: bool) -> None:
    said = guess(name, unit)
    assert (said.at, said.sure) == (at, sure)


def test_a_czech_probe_is_a_displacement_and_its_sensor_of_a_temperature_none() -> None:
    said = guess("snimac_X", None)
    assert (said.quantity, said.at, said.axis) == ("displacement", "tcp", "X")
    assert guess("snimac_teploty", None).quantity == "temperature"


@pytest.mark.parametrize(("name", "at"), [("ot_vreteno", "spindle"), ("ot_prac_vret", "rotary.c")])
def test_a_speed_in_czech_is_one_without_its_unit(name: str, at: str) -> None:
    said = guess(name, None)
    assert (said.quantity, said.at) == ("rotational_speed", at)


def _draft(folder: Path, header: str, say: Say) -> dict[str, str]:
    (folder / "raw").mkdir(parents=True)
    width = header.count(";")
    rows = [f"12.06.2025 07:00:{k:02d}" + f";{20 + k % 7},5" * width for k in range(50)]
    (folder / "raw" / "01_lauf.csv").write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    assert say("init", folder).code == 0
    lines = (folder / "campaign.yaml").read_text(encoding="utf-8").splitlines()
    return {line.split(":")[0].strip(): line for line in lines if "source: " in line}


def test_r_beside_f_is_rear_and_beside_l_right(tmp_path: Path, say: Say) -> None:
    found = _draft(tmp_path / "a", "Zeit;TC15_column_R [°C];TC16_column_F [°C]", say)
    assert "at: column.rear}   # guess" in found["TC15_column_R"]
    assert "at: column.front}   # guess" in found["TC16_column_F"]
    found = _draft(tmp_path / "b", "Zeit;TC15_column_R [°C];TC16_column_L [°C]", say)
    assert "at: column.right}   # sure" in found["TC15_column_R"]


def test_two_speeds_without_a_name_at_one_spindle_are_asked(tmp_path: Path, say: Say) -> None:
    found = _draft(tmp_path / "a", "Zeit;n_Spindel [1/min];n_Nebenantrieb [1/min]", say)
    assert "# ? at: spindle, rotary.c or table? n_Spindel is drafted at the spindle, too" in found["n_Nebenantrieb"]
    assert "# sure" in found["n_Spindel"]
    found = _draft(tmp_path / "c", "Zeit;Drehzahl Schleifspindel [1/min];Drehzahl Werkstueck [1/min]", say)
    assert "# ? at: counter_spindle or rotary.c, as a workhead, or spindle?" in found["Drehzahl_Werkstueck"]
    found = _draft(tmp_path / "b", "Zeit;nAct [1/min];T_Halle [°C]", say)
    assert "at: spindle}   # guess" in found["nAct"]


def test_several_spindles_are_told_apart_by_their_names_or_numbers(tmp_path: Path, say: Say) -> None:
    named = _draft(tmp_path / "a", "Zeit;Frässpindel Lager vorn [°C];Gegenspindel Lager vorn [°C]", say)
    found = [line.partition("at: ")[2].partition("}")[0] for line in named.values()]
    assert found == ["milling_spindle.bearing.front", "counter_spindle.bearing.front"]
    alone = _draft(tmp_path / "b", "Zeit;Frässpindel Lager vorn [°C];T_Halle [°C]", say)
    assert any("at: spindle.bearing.front}   # sure" in line for line in alone.values())
    counted = _draft(tmp_path / "c", "Zeit;Drehzahl S1 [1/min];Drehzahl S2 [1/min];S2 Motortemperatur [°C]", say)
    at = [line.partition("at: ")[2].partition("}")[0] for line in counted.values()]
    assert at == ["spindle", "second_spindle", "second_spindle.motor"]
    header = "Zeit;Drehzahl S1 [1/min];Drehzahl S2 [1/min];Drehzahl S3 [1/min];Motortemp S3 Gegenspindel [°C]"
    both = _draft(
        tmp_path / "e", f"{header};Motortemp S2 Frässpindel [°C];Motortemp S1 [°C];Frässpindel Lager [°C]", say
    )
    at = [line.partition("at: ")[2].partition("}")[0] for line in both.values()]
    assert at[:3] == ["spindle", "milling_spindle", "counter_spindle"]
    assert at[3:6] == ["counter_spindle.motor", "milling_spindle.motor", "spindle.motor"]
    assert "# ? at: milling_spindle.bearing.front or .rear?" in both["Frasspindel_Lager"]
    short = _draft(tmp_path / "f", "Zeit;HSP Drehzahl [1/min];GSP Drehzahl [1/min];Frässpindel Drehzahl [1/min]", say)
    at = [line.partition("at: ")[2].partition("}")[0] for line in short.values()]
    assert at == ["spindle", "counter_spindle", "milling_spindle"]
    speeds = "Zeit;主軸回転数[min-1];ミーリング主軸回転数[min-1];対向主軸回転数[min-1];ミーリング主軸動力[kW]"
    japanese = _draft(tmp_path / "g", speeds, say)
    at = [line.partition("at: ")[2].partition("}")[0] for line in japanese.values()]
    assert at == ["spindle", "milling_spindle", "counter_spindle", "milling_spindle"]
    two = _draft(tmp_path / "h", "Zeit;Spindel Drehzahl [1/min];Frässpindel Drehzahl [1/min]", say)
    assert [line.partition("at: ")[2].partition("}")[0] for line in two.values()] == ["spindle", "milling_spindle"]
    sensors = _draft(tmp_path / "d", "Zeit;Spindel 1 [°C];Spindel 2 [°C];Drehzahl [1/min]", say)
    assert not any("second" in line for line in sensors.values())


def test_a_table_that_travels_is_a_linear_axis_and_one_that_turns_a_rotary() -> None:
    assert (kind_of("01_tisch_Z", []).kind, kind_of("01_tisch_Z", []).conditions) == ("linear_axis", {"axis": "Z"})
    assert kind_of("01_tisch", []).kind == "rotary_axis"
    assert kind_of("01_drehtisch_Z", []).kind == "rotary_axis"


def test_a_running_number_before_an_axis_is_no_temperature() -> None:
    assert said_by(["02_C"]).questions == ()
    assert "2 degC" in said_by(["2C"]).questions[0]


@pytest.mark.parametrize(
    ("one", "other", "at"),
    [
        ("Col_R", "Col_F", "column.rear"),
        ("Col_R", "Col_L", "column.right"),
        ("Bett_R", "Bett_F", "bed.rear"),
        ("brg_r", "brg_f", "spindle.bearing.rear"),
    ],
)
def test_a_letter_is_a_side_by_the_one_beside_it(tmp_path: Path, say: Say, one: str, other: str, at: str) -> None:
    found = _draft(tmp_path, f"Zeit;{one} [°C];{other} [°C]", say)
    assert f"at: {at}}}   # {'sure' if at == 'column.right' else 'guess'}" in found[one]


def test_a_letter_alone_is_asked(tmp_path: Path, say: Say) -> None:
    found = _draft(tmp_path, "Zeit;Col_R [°C];Bett [°C]", say)
    assert "# ? at: column.right or .rear?" in found["Col_R"]


def test_the_speed_beside_a_grinding_wheels_is_asked(tmp_path: Path, say: Say) -> None:
    found = _draft(tmp_path, "Zeit;toishi_kaiten [rpm];shujiku_kaiten [rpm]", say)
    assert "at: spindle}   # ?" not in found["toishi_kaiten"]
    assert "# ? at: counter_spindle or rotary.c, as a workhead, or spindle? toishi_kaiten" in found["shujiku_kaiten"]


@pytest.mark.parametrize(
    ("name", "at", "asked"),
    [
        ("Spdl_FB", "spindle.bearing.front", ""),
        ("Spdl_RB", "spindle.bearing.rear", ""),
        ("Spdl_wdg", "spindle.motor", ""),
        ("tbl_brg", "table.bearing", ""),
        ("B_brg", None, "at: rotary.b, of the B axis? or of what else"),
        ("palier_A", None, "at: rotary.a, of the A axis? or of what else"),
        ("knee_bearing", None, "at: which bearing?"),
        ("Lager", "spindle.bearing", "at: spindle.bearing.front or .rear?"),
    ],
)
def test_what_a_bearing_is_of_is_not_put_into_a_mouth(name: str, at: str | None, asked: str) -> None:
    said = guess(name, "degC")
    assert said.at == at
    assert " ".join(said.questions).startswith(asked)


def test_a_word_that_nobody_knows_makes_a_spindle_a_guess() -> None:
    assert guess("T_spindle", "degC").sure
    assert not guess("spindle_qfx", "degC").sure


@pytest.mark.parametrize(
    ("names", "asked"),
    [
        (("n_SSp", "n_WSp"), ["n_WSp"]),
        (("n_HSp", "n_GSp", "n_HSp_soll"), ["n_GSp"]),
        (("n_Sp_ist", "n_Sp_soll"), []),
        (("n_ASp", "n_ASp_soll"), []),  # one letter alone tells no spindle from another
    ],
)
def test_spindles_that_a_letter_tells_apart_are_not_all_the_main_one(
    say: Say, tmp_path: Path, names: tuple[str, ...], asked: list[str]
) -> None:
    """WSp turns the part of a grinder: its speed was drafted at the spindle, 'sure', beside that of the wheel."""
    rows = "".join(f"{60 * i},{','.join(str(100 * i) for _ in names)},{0.1 * i:.3f}\n" for i in range(60))
    (tmp_path / "a.csv").write_text(f"t [s],{','.join(f'{n} [rpm]' for n in names)},dX [um]\n{rows}", encoding="utf-8")
    say("init", tmp_path)
    drafted = (tmp_path / "campaign.yaml").read_text(encoding="utf-8").splitlines()
    lines = {
        n: next(line for line in drafted if f'signal: "{n} [rpm]"' in line or f"signal: {n}" in line) for n in names
    }
    assert [n for n in names if "# ? at: counter_spindle or rotary.c" in lines[n]] == asked
