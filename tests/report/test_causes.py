"""Many lines of one cause are one line, with a count and the first place."""

from __future__ import annotations

import pytest

from thermodata.report.quality.told import by_cause as flags_by_cause
from thermodata.report.quality.told import by_channel, with_reason
from thermodata.report.words.causes import by_cause, cause_of, losses_in_words, notes_in_words


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("day1, daq: 3 rows stood twice", "day2, daq: 41 rows stood twice", True),
        ("channel 'T_1': no signal 'x'", "channel 'T_22': no signal 'yy'", True),
        ("raw/day1.csv: cp1252 was taken", "raw/sub/day22.csv: cp1252 was taken", True),
        ("exactly 3.25 for 360 samples while T_1 moved", "exactly -1e3 for 12 samples while T_1, T_2 moved", True),
        ("1 row stands out of order: it was sorted", "2 rows stand out of order: they were sorted", True),
        ("day1, daq: 3 rows stood twice", "day1, daq: 3 rows were lost", False),
        ("cp1252 was taken", "cp1250 was not taken", False),
    ],
)
def test_numbers_names_and_paths_make_no_cause(one: str, other: str, same: bool) -> None:
    names = ["day1", "day2", "daq", "T_1", "T_2"]
    assert (cause_of(one, names) == cause_of(other, names)) is same
    assert len(by_cause([one, other], str, names)) == (1 if same else 2)


def test_86_losses_of_one_cause_are_one_line_with_the_first_place() -> None:
    losses = [
        {
            "test": f"day{i}",
            "source": "daq",
            "file": f"raw/day{i}.csv",
            "where": f"line {i + 7}",
            "reason": f"{i} cells cut",
        }
        for i in range(1, 87)
    ]
    losses.append(
        {"test": "day3", "source": None, "file": None, "where": None, "reason": "no file fits", "fraction": 0.5}
    )
    assert losses_in_words(losses) == [
        "86 times: 1 cells cut (day1, daq, raw/day1.csv, line 8); also in raw/day2.csv, raw/day3.csv, raw/day4.csv "
        "and 82 more",
        "no file fits (day3, 50 % of the file)",
    ]
    assert losses_in_words([]) == []


def test_notes_of_one_cause() -> None:
    notes = [f"day{i}, nc: the clock was set ahead by {i} s" for i in range(1, 7)] + ["a place is unknown: bearng"]
    assert notes_in_words(notes, ["nc", *(f"day{i}" for i in range(9))]) == [
        "6 times: day1, nc: the clock was set ahead by 1 s; also in day2, nc (2 s), day3, nc (3 s), day4, nc (4 s) "
        "and 2 more (from 1 to 6)",
        "a place is unknown: bearng",
    ]


def test_figures_of_the_others_are_told() -> None:
    offsets = {"day1": "+8.468 s", "day2": "+9.40 s", "etve": "-31.2 s"}
    notes = [f"{test}, rec: clock aligned to 'nc2': {offset}" for test, offset in offsets.items()]
    assert notes_in_words(notes, ["rec", *offsets]) == [
        "3 times: day1, rec: clock aligned to 'nc2': +8.468 s; also in day2, rec (+9.40 s), etve, rec (-31.2 s)"
    ]


def test_names_of_others_without_a_place_are_told() -> None:
    texts = [f"calibration 'jump_{a}': its moves are unknown; try: moves: [100 um, -100 um]" for a in "XYZ"]
    told = "also in calibration 'jump_Y', calibration 'jump_Z'"
    assert told in notes_in_words(texts)[0]
    assert told in losses_in_words([{"reason": text} for text in texts])[0]


def test_each_channel_of_a_cause_is_named() -> None:
    losses = [
        {"test": test, "file": "c.yaml", "reason": f"channel '{name}': no unit is known of channels.{name}"}
        for test in ("S4000", "S8000")
        for name in ("dZ", "dX", "dY")
    ]
    assert losses_in_words(losses) == [
        "6 times: channel 'dZ': no unit is known of channels.dZ (S4000, c.yaml); also in S8000; the same of 'dX', 'dY'"
    ]


def flag(test: str, channel: str, detail: str, n: int = 3) -> dict[str, object]:
    return with_reason(
        {
            **{"campaign": "c", "test": test, "source": "daq", "channel": channel, "flag": "held", "n": n},
            **{"from_s": 60.0, "to_s": 90.0, "detail": detail},
        }
    )


def test_flags_of_one_cause_are_one_row() -> None:
    rows = [flag(f"day{i}", f"d{a}", f"exactly {i}.5 for 3 samples while T_{i} moved") for i in range(9) for a in "XYZ"]
    rows.append(flag("day1", "dX", "overruled: filtered by hand (was: exactly 2 for 3 samples)"))
    told = flags_by_cause(rows)
    assert [(r["n"], r["events"], r["tests"], r["channels"]) for r in told] == [(81, 27, 9, 3), (3, 1, 1, 1)]
    assert told[0]["first"] == "day0, dX, 60 s"
    sums = by_channel(rows)
    assert len(sums) == 28
    assert [r["overruled"] for r in sums if r["overruled"]] == ["filtered by hand"]
