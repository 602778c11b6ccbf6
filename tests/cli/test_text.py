from __future__ import annotations

import json
import math
import random
from dataclasses import dataclass
from datetime import date
from decimal import Decimal
from pathlib import Path

import numpy as np
import pytest

from thermodata.cli.model.besides import as_table
from thermodata.cli.terminal.common import plain
from thermodata.cli.terminal.json_text import json_text
from thermodata.cli.terminal.layout import LAYOUTS, latex, markdown
from thermodata.modelling.compare.beside import ModelOnTest
from thermodata.report.text.fit import check_text
from thermodata.report.text.table import sentences_folded, table
from thermodata.report.words.numbers import change, duration, number, typeset
from thermodata.schema.answers.result import Check


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (12.345, "12.3"),
        (0.0123456, "0.0123"),
        (1234.5, "1234"),
        (-0.5, "-0.500"),
        (0.0, "0"),
        (None, "-"),
        (float("nan"), "-"),
        (float("inf"), "inf"),
        (7, "7"),
        (1.5e9, "1.50e+09"),
        (2e-6, "2.00e-06"),
        (True, "True"),
    ],
)
def test_numbers_have_three_figures(value: object, text: str) -> None:
    assert number(value) == text


@pytest.mark.parametrize(("seconds", "text"), [(36000.0, "10.0 h"), (1500.0, "25 min"), (8.0, "8 s"), (None, "-")])
def test_durations_read_well(seconds: float | None, text: str) -> None:
    assert duration(seconds) == text


def test_a_change_is_a_share_of_what_was() -> None:
    assert (change(4.0, 1.0), change(1.0, 1.5), change(None, 1.0), change(0.0, 1.0)) == ("-75 %", "+50 %", "-", "-")


@pytest.mark.parametrize(
    ("value", "threshold", "text"),
    [
        (456.0, None, "not_determined:lag.tau = 456: time constant is not determined"),
        (456.0, 60.0, "not_determined:lag.tau = 456 (limit 60.0): time constant is not determined"),
        (None, None, "not_determined:lag.tau: time constant is not determined"),
    ],
)
def test_the_number_of_a_check_is_no_part_of_its_sentence(
    value: float | None, threshold: float | None, text: str
) -> None:
    advice = "time constant is not determined"
    check = Check(name="not_determined:lag.tau", value=value, threshold=threshold, passed=False, advice=advice)
    assert check_text(check) == text


def test_a_page_typesets_units_and_minus() -> None:
    assert typeset("-2.4 um/K -> 1 um, jump-z") == "−2.4\u00a0µm/K → 1\u00a0µm, jump-z"


def test_a_table_aligns_numbers_right_and_texts_left() -> None:
    rows: list[dict[str, object]] = [{"test": "a", "rmse": 1.0, "n": 5}, {"test": "longer", "rmse": None, "n": 12345}]
    assert table(rows, [("test", "test"), ("rmse", "RMSE [um]"), ("n", "n")]).splitlines() == [
        "test    RMSE [um]      n",
        "──────  ─────────  ─────",
        "a            1.00      5",
        "longer          -  12345",
    ]


def test_a_table_cuts_long_texts_and_keeps_one_line_a_row() -> None:
    lines = table([{"a": "x y " * 25, "b": "two\nlines"}], [("a", "a"), ("b", "b")], widest=10).splitlines()
    assert lines[-1] == "x y x y x…  two lines"


def test_a_table_cuts_names_in_their_middle() -> None:
    rows = [{"a": f"temperature_of_the_bearing_no_{i}"} for i in range(2)]
    assert table(rows, [("a", "a")], widest=15).splitlines()[-2:] == ["tempera…ng_no_0", "tempera…ng_no_1"]


def test_json_knows_no_nan_and_takes_anything() -> None:
    @dataclass
    class Row:
        a: float
        b: object

    found = plain({"x": [Row(math.nan, np.float64(2.5)), Row(math.inf, np.array([1, 2]))], 3: (True, None)})
    assert found == {"x": [{"a": None, "b": 2.5}, {"a": None, "b": [1, 2]}], "3": [True, None]}


def test_a_bar_in_a_heading_does_not_end_a_column_of_markdown() -> None:
    found = markdown([{"a": 1.0, "b": "x|y"}], [("a", "|max|+|min| [um]"), ("b", "b")]).splitlines()
    assert found == [r"| \|max\|+\|min\| [um] | b |", "| ---: | --- |", r"| 1.00 | x\|y |"]


WIDE = [
    {"campaign": "gantry-2026-03", "test": "sp9000", "role": "verification (in-sample)", "fit": 90.1, "left": 5.0},
    {"campaign": "gantry-2026-03", "test": "sp2000", "role": "calibration", "fit": -3.25, "left": 12.5},
]
HEADS = [("campaign", "campaign"), ("test", "test"), ("role", "role"), ("fit", "FIT [%]"), ("left", "PTP left [um]")]


def test_a_table_is_folded_to_the_screen_and_says_once_what_all_rows_share() -> None:
    assert table(WIDE, HEADS, width=44).splitlines() == [
        "campaign gantry-2026-03",
        "",
        "test    role          FIT [%]  PTP left [um]",
        "──────  ────────────  ───────  ─────────────",
        "sp9000  verification     90.1           5.00",
        "        (in-sample)",
        "sp2000  calibration     -3.25           12.5",
    ]


def test_a_single_row_says_above_what_it_stands_in() -> None:
    assert table(WIDE[:1], HEADS, width=60).splitlines() == [
        "campaign gantry-2026-03",
        "",
        "test    role                      FIT [%]  PTP left [um]",
        "──────  ────────────────────────  ───────  ─────────────",
        "sp9000  verification (in-sample)     90.1           5.00",
    ]


def test_numbers_are_never_folded_and_columns_without_room_stand_below() -> None:
    text = table(WIDE, HEADS, width=30)
    first, second = text.split("\n\n")[1:]
    assert [line.split()[-1] for line in first.splitlines() if line[:2] == "sp"] == ["90.1", "-3.25"]
    assert [line.split()[-1] for line in second.splitlines() if line[:2] == "sp"] == ["5.00", "12.5"]
    assert max(map(len, text.splitlines())) <= 30


def test_a_range_and_a_number_with_its_unit_stay_in_one_line() -> None:
    rows = [
        {"parameter": f"displacement_of_the_tool_{axis}/bearing.tau", "95 %": f"0.{k}95 … 0.442", "p": f"over 9{k} %"}
        for k, axis in enumerate("XY", 3)
    ]
    lines = table(rows, [(key, key) for key in ("parameter", "95 %", "p")], width=48).splitlines()
    assert lines[2:4] == [
        "displacement_of_the_tool_X/  0.395 … 0.442  over",
        "bearing.tau                                 93 %",
    ]


def test_rows_that_share_their_first_column_stand_under_it_where_nothing_else_tells_them_apart() -> None:
    rows = [
        {"campaign": campaign, "test": f"warm_up_no_{i}_in_the_hall", "kind": f"spindle-{i}", "role": "calibration"}
        for campaign in ("gantry-in-march-of-2026", "lathe-in-march-of-2026")
        for i in range(2)
    ]
    text = table(rows, [(key, key) for key in ("campaign", "test", "kind", "role")], width=44)
    parts = text.split("\n\n")
    assert [part.splitlines()[0].split() for part in parts] == [
        ["role", "calibration"],
        ["campaign", "gantry-in-march-of-2026"],
        ["test", "kind"],
        ["campaign", "lathe-in-march-of-2026"],
        ["test", "kind"],
    ]
    assert parts[2].splitlines()[2] == "warm_up_no_0_in_the_hall  spindle-0"


@pytest.mark.parametrize("version", [1, "first"])
def test_every_part_of_a_table_begins_with_what_tells_its_rows_apart(version: object) -> None:
    rows = [
        {"name": name, "version": v, "about": f"{name}-{v}-is-of-one-word", "left": f"left-of-{name}-{v}"}
        for name in ("baseline", "linear")
        for v in (version, "second" if version == "first" else 2)
    ]
    parts = table(rows, [(key, key) for key in ("name", "version", "about", "left")], width=50).split("\n\n")
    assert [part.split()[:3] for part in parts] == [["name", "version", "about"], ["name", "version", "left"]]
    for part in parts:
        assert [tuple(line.split()[:2]) for line in part.splitlines()[2:]] == [
            (row["name"], str(row["version"])) for row in rows
        ]


def test_a_text_that_is_folded_keeps_its_blanks() -> None:
    rows = [{"a": "lag:T_nut_of_Z", "b": "the hall: k F and more"}, {"a": "lag:T", "b": "b"}]
    lines = table(rows, [("a", "a"), ("b", "b")], width=26).splitlines()
    assert [line.split() for line in lines[2:4]] == [["lag:", "the", "hall:", "k"], ["T_nut_of_Z", "F", "and", "more"]]


def test_names_that_would_fill_the_screen_are_not_repeated() -> None:
    rows = [{"a": a, "b": b * 24, "c": c * 12} for a, b, c in ("sxy", "szy", "oxw")]
    first, second = table(rows, [(key, key) for key in "abc"], width=30).split("\n\n")
    assert ("x" * 24 in first, "x" * 24 in second) == (True, False)
    assert second.split()[:2] == ["a", "c"]


def test_a_table_that_fits_is_left_alone() -> None:
    assert "campaign        test" in table(WIDE, HEADS, width=100)


def _anything(rng: random.Random, depth: int = 0) -> object:
    """A value such as commands answer with, nested at random."""
    leaves = (
        1,
        True,
        None,
        'a\n"\u00e9\u2028',
        1.5,
        float("nan"),
        np.float64(2.5),
        np.array([1.0, np.inf]),
        date(2026, 1, 1),
        Decimal("1.5"),
        Path("a/b"),
        {},
        [],
    )
    kind = rng.randrange(16 if depth < 5 else 12)
    if kind < 12:
        return rng.choice(leaves)
    if kind < 14:
        return {rng.choice(("a", "b", 1, None, 2.5, "ü\n")): _anything(rng, depth + 1) for _ in range(rng.randrange(5))}
    return [_anything(rng, depth + 1) for _ in range(rng.randrange(5))]


def test_json_in_pieces_is_what_json_dumps_writes() -> None:
    rng = random.Random(9)
    for _ in range(2000):
        value = _anything(rng)
        whole = json.dumps(plain(value), indent=2, ensure_ascii=False, allow_nan=False)
        assert "".join(json_text(value)) == whole


def test_json_of_a_large_answer_comes_in_pieces() -> None:
    signals = [{"name": f"c{i}", "unit": None, "values": {"low": float(i), "high": math.nan}} for i in range(20_000)]
    pieces = list(json_text({"signals": signals}))
    assert len(pieces) > 5
    assert max(map(len, pieces)) < 1_000_000
    assert json.loads("".join(pieces))["signals"][19_999] == {
        "name": "c19999",
        "unit": None,
        "values": {"low": 19999.0, "high": None},
    }


def _beside(model: str, name: str, residual: float) -> dict[str, object]:
    return ModelOnTest("c", "t_1", "verification", "dZ", model, name, residual=residual).to_json()


@pytest.mark.parametrize("layout", list(LAYOUTS))
def test_versions_of_one_model_are_told_apart_in_every_layout(layout: str) -> None:
    """`compare NEW --against OLD`, of a model that an effect was added to."""
    versions = as_table([_beside("0a57485b55b0", "baseline", 3.0), _beside("047fafc90cb0", "baseline", 1.0)], layout)
    assert "baseline 0a5748" in versions
    assert "baseline 047faf" in versions
    others = as_table([_beside("0a57485b55b0", "baseline", 3.0), _beside("047fafc90cb0", "linear", 1.0)], layout)
    assert "baseline" in others
    assert "0a5748" not in others


def test_latex_has_no_character_that_is_a_command_or_another_sign() -> None:
    text = latex([{"a": "T_x & 5 %|", "b": "a < b > c"}], [("a", "|max| [um]"), ("b", "$b$")])
    body = text.replace(r"\_", "").replace(r"\&", "").replace(r"\%", "").replace(r"\$", "").replace(" & ", " ")
    assert not set("_%$|<>&") & set(body)
    assert r"\textbar{}max\textbar{} [um]" in text


def test_sentences_are_folded_between_words_and_rows_of_tables_stay_whole() -> None:
    text = "\n".join(
        [
            "the open tests show no missing cause",
            "",
            "  ! at_bound: the time constant stands at its bound",
            "test  RMSE [um]  state of the machine then",
        ]
    )
    assert sentences_folded(text, 24).split("\n") == [
        "the open tests show no",
        "  missing cause",
        "",
        "  ! at_bound: the time",
        "    constant stands at",
        "    its bound",
        "test  RMSE [um]  state of the machine then",
    ]
