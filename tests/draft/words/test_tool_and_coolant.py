"""The tool of a test and its coolant, by names, notes beside the logs and heads of these: conditions of its line."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import pytest

from thermodata.draft.campaign.parts import DraftTest
from thermodata.draft.make import draft_files
from thermodata.draft.words.tool_and_coolant import tool_and_coolant, tool_and_coolant_of_head


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("sp6000_toolA_coolant_on", {"tool": "A", "coolant": "on"}),
        ("Tool 12 wet", {"tool": "12", "coolant": "on"}),
        ("WZ3_ohne_KSS", {"tool": "3", "coolant": "off"}),
        ("Werkzeug_Nr_7-mit KSS", {"tool": "7", "coolant": "on"}),
        ("nástroj D50, bez chlazení", {"tool": "D50", "coolant": "off"}),
        ("outil: fraise 16, arrosage: non", {"tool": "fraise 16", "coolant": "off"}),
        ("tool: HSK63 D50", {"tool": "HSK63 D50"}),
        ("Kühlmittel aus", {"coolant": "off"}),
        ("sp9000_dry", {"coolant": "off"}),
        ("S6000 with coolant", {"coolant": "on"}),
        # the nearest that say neither
        ("T12", {}),
        ("tooling", {}),
        ("tool_change", {}),
        ("tooltip", {}),
        ("etve_coolant", {}),
        ("T_coolant_supply", {}),
        ("laundry_3", {}),
        ("hydryl", {}),
        ("emulsion no. 3", {}),
    ],
)
def test_words_say_the_tool_and_the_coolant(text: str, said: dict[str, str]) -> None:
    assert tool_and_coolant([text]) == said


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("coolant: on", "on"),
        ("Coolant;off", "off"),
        ("KSS = aus", "off"),
        ('Kühlmittel: "ein"', "on"),
        ("## coolant | 0", "off"),
        ("coolant: off (dry), 20 degC", "off"),
        ("coolant: on, 20 bar", "on"),
        ("coolant off, tool D50", "off"),
        ("emulsion: no", "off"),
        # the nearest that say nothing
        ("Kanal 2: KSS ein", None),
        ("Kanal 3: KSS aus", None),
        ("ch2: T_KSS_aus", None),
        ("ch2: T_coolant_1", None),
        ("KSS ein: Kanal 2", None),
        ("KSS aus;T_bett", None),
        ("coolant 1;T_bed", None),
        ("coolant_on;0", None),
        ("coolant: 0.5 l/min", None),
        ("coolant: 0,5 l/min", None),
        ("coolant: 1 bar", None),
        ("coolant: emulsion no. 3", None),
        ("emulsion no. 3, 7 %", None),
        ("emulsion: no. 3", None),
        ("dry bulb: 21.3", None),
        ("Wet bulb;17.1", None),
        ("spindle dry run: no", None),
    ],
)
def test_a_line_of_a_head_that_begins_with_the_coolant_says_it(line: str, said: str | None) -> None:
    assert tool_and_coolant_of_head([line]) == ({"coolant": said} if said else {})


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("Tool 12, ground", {"tool": "12"}),
        ("ch2: T_tool_1", {}),
        ("Kanal 3: Werkzeug 2", {}),
    ],
)
def test_a_line_of_a_head_that_begins_with_the_tool_says_it(line: str, said: dict[str, str]) -> None:
    assert tool_and_coolant_of_head([line]) == said


def log(path: Path, head: str = "", day: int = 2, speed: int = 6000) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    start = datetime(2026, 3, day, 8)
    rows = [f"{start + timedelta(seconds=30 * k)};{20 + k * 0.02:.2f};{speed * (k > 20)}" for k in range(200)]
    path.write_text("\n".join([*filter(None, [head]), "time;T_bed [degC];n_spindle [rpm]", *rows, ""]), "utf-8")


def drafted(folder: Path) -> dict[str, DraftTest]:
    return {t.id: t for t in draft_files(folder).draft.tests}


def test_names_of_files_and_folders_are_conditions(tmp_path: Path) -> None:
    log(tmp_path / "toolA_sp6000_dry.csv")
    log(tmp_path / "toolB_sp6000_wet.csv", day=3)
    tests = drafted(tmp_path)
    assert tests["toolA_sp6000_dry"].conditions == {"speed": "6000 rpm", "tool": "A", "coolant": "off"}
    assert tests["toolB_sp6000_wet"].conditions == {"speed": "6000 rpm", "tool": "B", "coolant": "on"}
    assert "tool, coolant guess: name only" in tests["toolA_sp6000_dry"].kind.comment


def test_lines_of_notes_are_quoted_with_what_they_say(tmp_path: Path) -> None:
    for k in (1, 2, 3):
        log(tmp_path / f"run0{k}.csv", day=k)
    notes = "March\nrun01: tool D50, 6000 rpm, coolant on\n- run02.csv - tool D20, no coolant; door open\nrun033: x"
    (tmp_path / "notes.txt").write_text(notes, "utf-8")
    tests = drafted(tmp_path)
    assert tests["run01"].conditions == {"speed": "6000 rpm", "tool": "D50", "coolant": "on"}
    assert tests["run02"].conditions == {"speed": "6000 rpm", "tool": "D20", "coolant": "off"}
    assert tests["run03"].conditions == {"speed": "6000 rpm"}
    assert "notes.txt says 'tool D20, no coolant; door open'" in tests["run02"].kind.comment
    assert not any(t.doubts for t in tests.values())


def test_a_table_in_a_readme_is_read_by_its_heads(tmp_path: Path) -> None:
    rows = [
        "| nr | tool | speed | coolant |",
        "|---|---|---|---|",
        "| 01 | A | 6000 rpm | on |",
        "| 02 | B | 9000 rpm | off |",
    ]
    for k in (1, 2):
        log(tmp_path / f"0{k}.csv", day=k)
    (tmp_path / "README.md").write_text("\n".join(["# Tests", "", *rows]), "utf-8")
    tests = drafted(tmp_path)
    assert tests["01"].conditions == {"speed": "6000 rpm", "tool": "A", "coolant": "on"}
    assert tests["02"].conditions == {"speed": "6000 rpm", "tool": "B", "coolant": "off"}
    assert tests["02"].doubts == ("speed: README.md says 9000 rpm, and 6000 rpm is taken",)


def test_heads_of_logs_say_their_tools(tmp_path: Path) -> None:
    for k, tool in enumerate(("HSK63 D50", "HSK63 D20"), 1):
        log(tmp_path / f"run0{k}.csv", f"# tool: {tool}\n# coolant: {'on' if k == 1 else 'off'}\n# logger: A", day=k)
    tests = drafted(tmp_path)
    assert tests["run01"].conditions == {"speed": "6000 rpm", "tool": "HSK63 D50", "coolant": "on"}
    assert tests["run02"].conditions == {"speed": "6000 rpm", "tool": "HSK63 D20", "coolant": "off"}
    assert "tool, coolant guess: the head of run01.csv" in tests["run01"].kind.comment


def test_other_texts_and_heads_say_nothing(tmp_path: Path) -> None:
    for k in (1, 2):
        log(tmp_path / f"run0{k}.csv", "# logger: A\n# operator: tool shop\n# ch2: T_KSS_aus\n# dry bulb: 21.3", day=k)
    (tmp_path / "notes.txt").write_text("run01 and run02 were warm\nrun01: see run02\nrun01: repeated\n", "utf-8")
    tests = drafted(tmp_path)
    assert [t.conditions for t in tests.values()] == [{"speed": "6000 rpm"}] * 2
    assert not any("notes.txt" in t.kind.comment for t in tests.values())


@pytest.mark.parametrize(
    ("notes", "coolant"),
    [
        ("dankai:\n  tool D50\n  - coolant on\n\nsweep: no coolant\n", {"dankai": "on", "sweep": "off"}),
        ("# 0812_dankai\n\n- coolant on\n\n# Hall\n\n- no coolant\n", {"dankai": "on", "sweep": None}),
        ("dankai: coolant on\nall of them:\n  no coolant\n", {"dankai": "on", "sweep": None}),
        # the nearest that say nothing of one test
        ("dankai\ncoolant on\n", {"dankai": None, "sweep": None}),
        ("kai:\n  coolant on\n", {"dankai": None, "sweep": None}),
        ("rest:\n  coolant on\n", {"dankai": None, "sweep": None}),
        ("dankai:\n\nThe day before, coolant on.\n", {"dankai": None, "sweep": None}),
        ("## dankai\n\n- warm\n\n- coolant on\n", {"dankai": None, "sweep": None}),
    ],
)
def test_a_heading_names_a_test_without_the_day_before_its_name(
    tmp_path: Path, notes: str, coolant: dict[str, str | None]
) -> None:
    for k, name in enumerate(("0812_dankai", "0813_sweep", "0814_rest", "0815_rest"), 1):
        log(tmp_path / f"{name}.csv", day=k)
    (tmp_path / "notes.txt").write_text(notes, "utf-8")
    tests = drafted(tmp_path)
    assert len(tests) == 4
    assert {
        name: tests[test].conditions.get("coolant") for test in tests for name in coolant if name in test
    } == coolant
    assert not any("coolant" in t.conditions for name, t in tests.items() if "rest" in name)


@pytest.mark.parametrize(
    "name", ["feed_10", "10_feed", "01_spindle", "02_axis", "02_x-axis", "03_Achsen", "04_cooling"]
)
def test_a_line_that_begins_with_a_word_of_the_trade_is_of_no_test(tmp_path: Path, name: str) -> None:
    log(tmp_path / f"{name}.csv", day=1)
    log(tmp_path / "0813_sweep.csv", day=2)
    word = name.strip("0123456789_")
    (tmp_path / "README.md").write_text(f"# Machine 138\n\n{word}: linear motors, dry\n\n## {word}\n\n- dry\n", "utf-8")
    assert not any("coolant" in t.conditions for t in drafted(tmp_path).values())
