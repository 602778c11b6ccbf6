"""Files of predictions as other programs and spreadsheets write them: read right, or refused with the line."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.errors import SpecError
from thermodata.modelling.model_file.prediction.as_effect import read_prediction

WANTED = {"a": [(0.0, 0.5), (30.0, 1.5)]}


def read(tmp_path: Path, data: str | bytes) -> dict[str, list[tuple[float, float]]]:
    path = tmp_path / "theirs.csv"
    path.write_bytes(data if isinstance(data, bytes) else data.encode())
    tables = read_prediction(path, {"c": "dZ", "d": "dZ"}, "um").tables
    return {test: list(zip(s.t_s.tolist(), s.y.tolist(), strict=True)) for test, s in tables.items()}


@pytest.mark.parametrize(
    "text",
    [
        "test,t_s,predicted\na,0,0.5\na,30,1.5\n",
        "test;t_s;predicted [µm]\r\na;0;0,5\r\na;30;1,5\r\n",
        "test;t_s;predicted\na;0;0.5\na;30;1.5\n",
        "test\tt_s\tpredicted\na\t0\t0,5\na\t30\t1,5\n",
        "sep=;\ntest;t_s;predicted\na;0;0,5\na;30;1,5\n",
        'test,t_s,predicted\na,0,"0,5"\na,30,"1,5"\n',
        "test;t_s;predicted\na;0;0,5\n;;\n\na;30;1,5;;\n",  # rows that a spreadsheet leaves behind
        "test , t_s,predicted\n a,0,0.5\na ,30, 1.5\n",
        "test,t_s,predicted,remark\na,0,0.5\na,30,1.5,warm\n",  # cut behind what is read
        '"test","t_s","predicted"\n"a","0","5e-1"\n"a","3.0E1","1.5"\n',
    ],
)
def test_whatever_parts_the_cells_and_the_numbers_the_rows_are_the_same(tmp_path: Path, text: str) -> None:
    assert read(tmp_path, text) == WANTED


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "cp1252", "utf-16"])
def test_the_encoding_is_found(tmp_path: Path, encoding: str) -> None:
    assert read(tmp_path, "test;t_s;predicted [µm]\na;0;0,5\na;30;1,5\n".encode(encoding)) == WANTED


@pytest.mark.parametrize(
    ("text", "line", "says"),
    [
        ("test,t_s,predicted\na,0,1\na,30\n", 3, "fewer cells"),
        ("test,t_s,predicted\na\n", 2, "fewer cells"),
        ("test,t_s,predicted\na,0,0.5\na,30,1,5\n", 3, "more cells"),
        ("test,t_s,predicted\na,0,1_000\n", 2, "not a number"),
        ("test,t_s,predicted\na,0,٣\n", 2, "not a number"),
        ("test,t_s,predicted\na,0,TRUE\n", 2, "not a number"),
        ("test,t_s,predicted\na,0x1F,1\n", 2, "not a number"),
        ("test;t_s;predicted\na;0;0,5\na;30;1.5\n", 3, "not a number"),
        ("test;t_s;predicted\na;0;0,5\na;1.500;1,5\n", 3, "not a number"),
        ("test,t_s,predicted\na,0,1\n,30,2\n", 3, "names no test"),
        ('test,t_s,predicted\na,0,1\n"a,30,2\na,60,3\n', 3, "none of a CSV file"),
        ("test,t_s,predicted\na,0,1\n" + "x" * 200_000 + ",30,2\n", 3, "none of a CSV file"),
        ("test,t_s,predicted\na,0,1\na,\0,2\n", 3, "zero byte"),
        ("test,campaign,campaign,t_s,predicted\na,c,d,0,1\n", 1, "two columns"),
        ("sep=;\ntest;t_s;predicted [K]\na;0;1\n", 2, "unit of another kind"),
        ("test,t_s,predicted\nc/a,0,1\na,0,1\n", 3, "one test by two names"),
        ("campaign,test,t_s,predicted\n,a,0,1\nc,b,0,1\nc,a,30,1\n", 4, "one test by two names"),
    ],
)
def test_what_may_be_read_in_two_ways_or_none_is_refused_with_its_line(
    tmp_path: Path, text: str, line: int, says: str
) -> None:
    with pytest.raises(SpecError, match=says) as caught:
        read(tmp_path, text)
    assert (caught.value.where or "").endswith(f"theirs.csv:{line}")


def test_a_number_with_the_other_mark_is_refused_with_the_line_of_the_first(tmp_path: Path) -> None:
    with pytest.raises(SpecError) as caught:
        read(tmp_path, "test;t_s;predicted\na;0;1\na;30;0,5\na;60;1.5\n")
    assert caught.value.expected == "a finite number with a decimal comma, as at line 3"


def test_a_decimal_comma_among_commas_is_named(tmp_path: Path) -> None:
    with pytest.raises(SpecError) as caught:
        read(tmp_path, "test,t_s,predicted\na,0,0,5\n")
    assert "decimal comma" in (caught.value.hint or "")


def test_one_name_in_two_campaigns_is_two_tests(tmp_path: Path) -> None:
    text = "campaign,test,t_s,predicted\nc,a,0,1\nd,a,0,1\nd,d/b,0,1\n"
    assert list(read(tmp_path, text)) == ["c/a", "d/a", "d/b"]


def test_a_name_with_a_campaign_of_no_model_is_another_test(tmp_path: Path) -> None:
    assert list(read(tmp_path, "test,t_s,predicted\nold/a,0,1\na,0,2\n")) == ["old/a", "a"]
