"""Quality columns: which value they are of, what their code 0 means, and which rows they call bad."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import FormatError, QuestionError
from thermodata.plugin import Block, Source
from thermodata.reader.text import delimited
from thermodata.reader.text.cells.values.status import BAD, declared_zero, tells_quality, zero_is_good
from thermodata.reader.text.rows.qualities import find_qualities
from thermodata.reader.text.rows.quality_columns import bad_rows, quality_pairs, states, worded


@pytest.mark.parametrize(
    ("columns", "pairs"),
    [
        ({"T1": ["20"], "T1.Quality": ["192", "0"]}, {"T1": ("T1.Quality", False)}),
        ({"T1": ["20"], "T1 StatusCode": ["0", "2147483648"]}, {"T1": ("T1 StatusCode", True)}),
        ({"T1": ["20"], "T1.Quality": ["0"]}, {"T1": ("T1.Quality", False)}),
        ({"T1": ["20"], "T1 status code": ["0"]}, {"T1": ("T1 status code", True)}),
        ({"T1.Value": ["20"], "T1.Quality": ["192"]}, {"T1.Value": ("T1.Quality", False)}),
        ({"T1": ["20"], "Quality (T1)": ["Good"]}, {"T1": ("Quality (T1)", False)}),
        ({"T1": ["20"], "T1_quality_code": ["0", "2147483648"]}, {"T1": ("T1_quality_code", True)}),
        ({"T1": ["20"], "T1_OPCQuality": ["192", "24"]}, {"T1": ("T1_OPCQuality", False)}),
        ({"T1": ["20"], "T1.QualityDetail": ["192"]}, {"T1": ("T1.QualityDetail", False)}),
        (  # what one column shows of its codes tells those of the others
            {"T1": ["20"], "T1.Quality": ["0"], "T2": ["20"], "T2.Quality": ["0", "-2147483648"]},
            {"T1": ("T1.Quality", True), "T2": ("T2.Quality", True)},
        ),
        ({"T1": ["20"], "T2 quality": ["192"]}, {}),
        ({"quality": ["20"], "T1": ["1"]}, {}),
        ({"quality": ["98", "97"], "T1": ["1"]}, {}),  # per cent
        ({"T1": ["20"], "StatusCode": ["0", "1"]}, {}),  # a machine that stands, and runs
        ({"T1": ["20"], "StatusCode": ["0", "2147483648"]}, {"T1": ("StatusCode", True)}),
        ({"T1": ["20"], "T2": ["20"], "Quality": ["192", "0"]}, {"T1": ("Quality", False), "T2": ("Quality", False)}),
        ({"Value": ["20"], "Quality": ["Good", "Bad"]}, {"Value": ("Quality", False)}),
        (  # one behind each value
            {"T1": ["20"], "Quality": ["192"], "T2": ["20"], "Quality#2": ["0", "192"]},
            {"T1": ("Quality", False), "T2": ("Quality#2", False)},
        ),
        (  # one before each value
            {"Quality": ["192"], "T1": ["20"], "Quality#2": ["0", "192"], "T2": ["20"]},
            {"T1": ("Quality", False), "T2": ("Quality#2", False)},
        ),
        ({"Value": ["20"], "Severity": ["NONE", "INVALID"]}, {"Value": ("Severity", True)}),
        ({"T1": ["20"], "T1.SEVR": ["NO_ALARM", "MINOR"]}, {"T1": ("T1.SEVR", True)}),
        ({"T1": ["20"], "Severity": ["Info", "Warning"]}, {}),  # of a message
        ({"T1": ["20"], "T1 severity": ["100", "500"]}, {}),  # of an event of OPC
        ({"T1": ["20"], "Severity": ["INVALID"]}, {}),  # and nothing that counts
        (  # the surest of Wonderware's three
            {"Value": ["20"], "Quality": ["0", "1"], "QualityDetail": ["192", "24"]},
            {"Value": ("QualityDetail", False)},
        ),
    ],
)
def test_values_and_their_qualities(columns: dict[str, list[str]], pairs: dict[str, tuple[str, bool]]) -> None:
    assert quality_pairs(columns) == pairs


def test_a_quality_of_a_whole_row_flags_every_value_of_it_and_is_told(tmp_path: Path) -> None:
    rows = [f"2026-03-02 08:00:{k:02};{20 + k / 10:.1f};{22 - k / 10:.1f};{0 if k == 3 else 192}" for k in range(40)]
    (tmp_path / "a.csv").write_text("\n".join(["time;T_bed;T_air;Quality", *rows, ""]))
    table = delimited.open_table(tmp_path / "a.csv", Source(timezone="UTC"))
    (block,) = delimited.blocks(tmp_path / "a.csv", table, Source(timezone="UTC"))
    assert isinstance(block, Block)
    assert {name: np.flatnonzero(f).tolist() for name, f in (block.flags or {}).items()} == {"T_bed": [3], "T_air": [3]}
    assert any("all 2 values of its row (T_bed, T_air)" in note for note in table.notes)


def test_qualities_in_words_or_hexadecimal_are_text() -> None:
    columns = {
        "a": ["1"],
        "a.quality": ["Good"],
        "b": ["1"],
        "b.quality": ["0x80000000"],
        "c": ["1"],
        "c.quality": ["192", ""],
    }
    assert worded(columns, quality_pairs(columns)) == {"a.quality", "b.quality"}


@pytest.mark.parametrize(
    ("values", "zero", "bad"),
    [
        (np.array([192.0, 0.0, np.nan, 64.0, 63.0]), False, [0, 1, 0, 0, 1]),
        (np.array([0.0, 2147483648.0, 1073741824.0]), True, [0, 1, 0]),
        (np.array([192, 0, 24], np.int64), False, [0, 1, 1]),
        (np.array(["Good", None, "Bad", "uncertain", "", "OK"], object), False, [0, 0, 1, 0, 0, 0]),
        (np.array([True, False]), False, [0, 1]),
        (np.array([0, 1, 16, 133]), True, [0, 1, 0, 0]),  # Wonderware's good, bad, doubtful and initial
        # a vendor's byte above OPC's own: good, uncertain, bad; Ignition's stale, a fault and bad
        (np.array([16576, 0x4040, 16408, 500, 300, 512, 24]), False, [0, 0, 1, 1, 1, 1, 1]),
        (np.array([0, 0x8000, 0x40000000]), True, [0, 1, 0]),
    ],
)
def test_rows_that_are_called_bad(values: np.ndarray, zero: bool, bad: list[int]) -> None:
    assert bad_rows(values, zero).tolist() == [b * BAD for b in bad]


def test_of_a_severity_all_but_what_is_invalid_was_measured() -> None:
    said = np.array(["NONE", "NO_ALARM", "MINOR", "MAJOR_ALARM", "", None, "INVALID", "UNDEFINED"], object)
    assert bad_rows(said, True, "Severity").tolist() == [0, 0, 0, 0, 0, 0, BAD, BAD]
    assert bad_rows(said[:1], True, "Quality").tolist() == [BAD]


@pytest.mark.parametrize(
    ("codes", "name", "zero"),
    [
        (["192", "0"], "Quality", False),
        (["192"], "OPCQuality", False),
        (["0", "64"], "Quality", False),
        (["0", "2147483648"], "quality_code", True),
        (["0", "-2146762752"], "Quality", True),
        (["0", "1"], "Validity", False),
        (["0"], "StatusCode", True),
        (["0"], "Quality", None),
        (["0", "1"], "Quality", None),  # good and bad in Wonderware, bad and good of others
        (["0", "1"], "Status", None),
        (["0", "16"], "Quality", None),  # doubtful in Wonderware, a sensor's failure in OPC
        (["0", "1", "133"], "Quality", True),
        (["0", "133", "192"], "QualityDetail", False),
        (["0", "16576", "16408"], "Quality", False),  # of 16 bit, no status code of OPC UA
        (["0x4018", "0", "192"], "Quality", False),
        (["0", "0x8000"], "StatusCode", True),
        (["0", "0x8000"], "Quality", None),
        (["0", "512"], "dataintegrity", False),
        (["1"], "Quality", False),
        (["Good"], "Quality", False),
    ],
)
def test_what_the_code_0_means_is_told_by_the_others(codes: list[str], name: str, zero: bool | None) -> None:
    assert zero_is_good(codes, name) is zero


def test_a_quality_of_0_alone_is_asked_and_the_answer_has_the_last_word() -> None:
    with pytest.raises(QuestionError) as error:
        declared_zero(None, None, "Quality", "a.csv")
    assert error.value.declare == {"quality_zero": "unknown"}
    with pytest.raises(FormatError, match="not answered yet"):
        declared_zero({"quality_zero": "unknown"}, None, "Quality", "a.csv")
    assert declared_zero({"quality_zero": "unknown"}, True, "Quality", "a.csv")
    assert declared_zero({"quality_zero": "good"}, None, "Quality", "a.csv")
    assert not declared_zero({"quality_zero": "bad"}, True, "Quality", "a.csv")


@pytest.mark.parametrize(
    ("name", "told"),
    [
        *((n, True) for n in ("quality", "opcquality", "qualitydetail", "qualitycode", "status", "tagquality")),
        *((n, True) for n in ("statuscode", "statusname", "validity", "opcstatus", "qualität", "dataquality")),
        *((n, False) for n in ("machinestatus", "weldquality", "stat", "qualityofair", "value", "statusbar")),
    ],
)
def test_columns_of_quality_are_known_by_their_names(name: str, told: bool) -> None:
    assert (tells_quality(name) is not None) is told


@pytest.mark.parametrize(
    ("columns", "pairs"),
    [
        ({"T1 [°C]": ["20"], "T1_Err": ["0", "0", "8"]}, {"T1 [°C]": ("T1_Err", True)}),
        ({"T1": ["20"], "T1 Fault": ["FALSE", "FALSE", "TRUE"]}, {"T1": ("T1 Fault", True)}),
        ({"T1": ["20"], "T1.error_code": ["OK", "OK", "break"]}, {"T1": ("T1.error_code", True)}),
        ({"T1 [°C]": ["20"], "T1_Valid": ["1", "0"]}, {"T1 [°C]": ("T1_Valid", False)}),
        ({"T1 [°C]": ["20"], "T1.Quality": ["192"]}, {"T1 [°C]": ("T1.Quality", False)}),
        ({"T1": ["20"], "T1_Status": ["OK", "Bad"]}, {"T1": ("T1_Status", True)}),
        ({"X": ["20"], "X_err": ["0", "0.3", "-0.2"]}, {}),  # of a path: a length
        ({"X": ["20"], "X_err": [str(k) for k in range(40)]}, {}),
        ({"X": ["20"], "X_err": ["3", "3", "2"]}, {}),  # 0 is not what it mostly says
        ({"T1": ["20"], "T2_Err": ["0", "1"]}, {}),
        ({"T1": ["20"], "T1_Status": ["0", "3"]}, {}),
        ({"n": ["20"], "n State": ["0", "1"]}, {}),  # it turns
        ({"Pump": ["20"], "Pump Status": ["FALSE", "TRUE"]}, {}),
        ({"T1": ["20"], "T1_Alarm": ["0", "0", "1"]}, {}),  # of a limit: it is warm indeed
    ],
)
def test_columns_of_faults_are_of_the_channel_that_they_are_called_after(
    columns: dict[str, list[str]], pairs: dict[str, tuple[str, bool]]
) -> None:
    assert quality_pairs(columns) == pairs


def test_a_column_with_a_unit_tells_no_faults() -> None:
    columns = {"X": ["20"], "X_Error": ["0", "0", "3"]}
    assert quality_pairs(columns) == {"X": ("X_Error", True)}
    assert quality_pairs(columns, measured={"X_Error"}) == {}


@pytest.mark.parametrize(("other", "words"), [("T1_Quality", ["good", "bad"]), ("T1_Status", ["0", "3"])])
def test_faults_and_a_quality_of_one_value_both_count(other: str, words: list[str]) -> None:
    columns = {"T1": ["20"], "T1_Err": ["0", "0", "8"], other: words}
    found = find_qualities(columns, lambda zero, name: zero)
    told = sorted(own for each in (found.of_values, found.of_rows) for own, _ in each.values())
    assert told + sorted(found.states) == ["T1_Err", other]


def test_a_state_in_codes_that_are_not_known_is_told() -> None:
    columns = {"T1 [K]": ["20"], "T1_Status": ["0", "128"], "T2": ["20"], "T2_Status": ["21.5", "22.5"]}
    assert states(columns, {}) == {"T1_Status": "T1 [K]"}


def test_faults_of_a_value_and_of_its_row_are_both_flagged(tmp_path: Path) -> None:
    rows = [f"2026-03-02 08:00:{k:02};20.{k};{8 * (k == 3)};21.{k};{int(k != 5)}" for k in range(40)]
    head = "time;T_front [°C];T_front_Err;T_rear [°C];Valid"
    (tmp_path / "a.csv").write_text("\n".join([head, *rows, ""]), encoding="utf-8")
    table = delimited.open_table(tmp_path / "a.csv", Source())
    (block,) = [b for b in delimited.blocks(tmp_path / "a.csv", table, Source()) if isinstance(b, Block)]
    flagged = {name: np.flatnonzero(flags).tolist() for name, flags in (block.flags or {}).items()}
    assert flagged == {"T_front [°C]": [3, 5], "T_rear [°C]": [5]}
    said = {s.name: s.properties.get("quality_of") for s in delimited.signals(table)}
    assert said["T_front_Err"] == "T_front [°C]"
    assert set((said["Valid"] or "").split(", ")) == {"T_front [°C]", "T_rear [°C]"}


def test_unknown_codes_are_noted(tmp_path: Path) -> None:
    rows = [f"2026-03-02 08:00:{k:02};20.{k};{128 * (k == 3)}" for k in range(40)]
    (tmp_path / "a.csv").write_text("\n".join(["time;T1;T1_Status", *rows, ""]), encoding="utf-8")
    table = delimited.open_table(tmp_path / "a.csv", Source())
    assert any("'T1_Status' holds codes of 'T1' (0, 128) that are not known here" in note for note in table.notes)
    assert {s.name: s.properties for s in delimited.signals(table)}["T1_Status"] == {"state_of": "T1"}
