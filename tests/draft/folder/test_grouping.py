"""Which files are one source, which are one test: by names, and by times where names do not tell."""

from __future__ import annotations

from datetime import timedelta
from pathlib import Path

import numpy as np
import pytest

from tests.draft.labs import START, local, numbers, speeds, staircase, tdms, text, warm
from thermodata.draft.campaign.parts import Draft
from thermodata.draft.campaign.plan import plan
from thermodata.draft.folder.scan import scan
from thermodata.draft.words.filenames import matches, normal
from thermodata.draft.writing.write import text_of
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.files.load import load_campaign


def drafted(folder: Path) -> tuple[Draft, Campaign]:
    made = plan("c", folder, scan(folder))
    (folder / "campaign.yaml").write_text(text_of(made), encoding="utf-8")
    return made, load_campaign(folder / "campaign.yaml")


def log(path: Path, days: float, signal: str = "Lager vorne", unit: str = "degC", step_s: float = 10) -> None:
    tdms(path, {"g": {signal: (warm(100, 20, 1, 1, 1), unit)}}, START + timedelta(days=days), step_s)


def test_files_that_follow_each_other_are_parts_of_one_test(tmp_path: Path) -> None:
    for k, test in enumerate(("heat", "cool")):
        for part in range(3):
            log(tmp_path / f"{test}_{part + 1}.tdms", k + part * 1000 / 86400)
    _, made = drafted(tmp_path)
    assert sorted(t.id for t in made.tests) == ["cool", "heat"]
    assert made.sources["daq"].files == "{test}_*.tdms"


def test_numbered_files_of_other_days_are_tests(tmp_path: Path) -> None:
    for k in range(3):
        log(tmp_path / f"heat_{k + 1}.tdms", k)
    _, made = drafted(tmp_path)
    assert [t.id for t in made.tests] == ["heat_1", "heat_2", "heat_3"]


def test_parts_that_another_sources_file_names_as_one(tmp_path: Path) -> None:
    n = 300
    for k, test in enumerate(("run_A", "run_B")):
        for part in range(3):
            log(tmp_path / f"{test}_{part + 1}.tdms", k + part * 1000 / 86400)
        text(
            tmp_path / f"{test}.csv",
            ["Time", "Spindle speed [rpm]"],
            [local(n, 10, START + timedelta(days=k), "UTC", "%Y-%m-%d %H:%M:%S"), numbers(speeds(n, [3000]), 0)],
        )
    _, made = drafted(tmp_path)
    assert [t.id for t in made.tests] == ["run_A", "run_B"]
    assert {s.files for s in made.sources.values()} == {"{test}_*.tdms", "{test}.csv"}


def test_two_loggers_of_one_make_are_two_sources(tmp_path: Path) -> None:
    for k in range(3):
        for logger in (1, 2):
            log(tmp_path / f"daq{logger}_test{k}.tdms", k, signal="ch0", unit="degC")
    _, made = drafted(tmp_path)
    assert sorted(str(s.files) for s in made.sources.values()) == ["daq1_{test}.tdms", "daq2_{test}.tdms"]
    assert sorted(made.channels) == ["ch0", "ch0_2"]


def test_a_log_of_the_hall_belongs_to_all_tests(tmp_path: Path) -> None:
    for k in range(3):
        log(tmp_path / "daq" / f"test{k}.tdms", k / 5)
    n = 400
    text(
        tmp_path / "hall" / "Klima_KW10.csv",
        ["Zeit", "Hallentemperatur [°C]"],
        [local(n, 300, START - timedelta(hours=1), "UTC", "%d.%m.%Y %H:%M:%S"), numbers(warm(n, 20, 2, 1, 1), 1)],
    )
    _, made = drafted(tmp_path)
    assert [t.id for t in made.tests] == ["test0", "test1", "test2"]
    assert "hall/Klima_KW10.csv" in {s.files for s in made.sources.values()}


def test_names_with_other_times_are_joined_by_time(tmp_path: Path) -> None:
    n = 100
    for k in range(3):
        start = START + timedelta(hours=5 * k)
        log(tmp_path / "eddy" / f"eddy_{start:%Y%m%d_%H%M%S}.tdms", 5 * k / 24, "Eddy Z", "V")
        late = start + timedelta(seconds=47)
        text(
            tmp_path / "nc" / f"nc_{late:%Y%m%d_%H%M%S}.csv",
            ["Time", "Spindle speed [rpm]"],
            [local(n, 10, late, "Europe/Prague", "%Y-%m-%d %H:%M:%S"), numbers(speeds(n, [4000]), 0)],
        )
    draft, made = drafted(tmp_path)
    assert len(made.tests) == 3
    assert all(t.files["nc"] for t in made.tests)
    assert any("by their times" in q for s in draft.sources for q in s.questions)
    assert [t.conditions for t in made.tests] == [{"speed": "4000 rpm"}] * 3


def test_a_jump_test_is_found_in_the_data_alone(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    for k in range(3):
        tdms(
            tmp_path / f"m{k}.tdms",
            {
                "g": {
                    "dZ": (warm(3000, 5, 0.1, 0.3, k), "V"),
                    "dX": (warm(3000, 5, 0.1, 0.3, 9), "V"),
                    "T1": (warm(3000, 22, 5, 0.3, k), "degC"),
                }
            },
            START + timedelta(days=k),
            10,
        )
    tdms(
        tmp_path / "m7.tdms",
        {
            "g": {
                "dZ": (staircase([50, 50, -100, -50, 50], 80, 8, 20, 3), "V"),
                "dX": (5 + rng.normal(0, 0.002, 960), "V"),
                "T1": (22 + rng.normal(0, 0.01, 960), "degC"),
            }
        },
        START,
        0.05,
    )
    draft, made = drafted(tmp_path)
    assert [t.id for t in made.tests] == ["m0", "m1", "m2"]
    jump = draft.jumps[0]
    assert (jump.file, jump.signal, jump.axis) == ("m7.tdms", "g/dZ", "Z")
    assert jump.dwell_s == pytest.approx(8, rel=0.05)
    assert jump.seen == pytest.approx([0.625, 0.625, -1.25, -0.625, 0.625], rel=0.02)
    assert made.calibrations["jump_g_dZ"].moves == "unknown"  # type: ignore[union-attr]


def test_signals_of_some_tests_only_and_units_that_disagree(tmp_path: Path) -> None:
    for k in range(3):
        more = {"Mutter X": (warm(100, 20, 1, 1, k), "°C")} if k == 2 else {}
        tdms(
            tmp_path / f"m{k}.tdms",
            {"g": {"Lager vorne": (warm(100, 20, 1, 1, k), "°C" if k else "K"), **more}},
            START + timedelta(days=k),
            10,
        )
    draft, made = drafted(tmp_path)
    assert made.channels["Lager_vorne"].unit is None  # each file's own is taken
    assert next(c for c in draft.channels if c.signal == "g/Mutter X").only_in == ("m2",)
    assert any("disagree" in q for c in draft.channels for q in c.said.questions)


def test_whatever_names_hold_the_draft_loads(tmp_path: Path) -> None:
    tdms(
        tmp_path / "a [1]{x}.tdms",
        {
            "g": {
                "T'; drop table--": (warm(100, 20, 1, 1, 1), "degC"),
                "t": (warm(100, 20, 1, 1, 1), "degC"),
                "温度 é": (warm(100, 20, 1, 1, 1), "degC"),
                'Ω#"@': (warm(100, 20, 1, 1, 2), None),
                "y\nx: {": (warm(100, 20, 1, 1, 2), "degC"),
            }
        },
        START,
        1,
    )
    whole = (tmp_path / "a [1]{x}.tdms").read_bytes()
    (tmp_path / "cut.tdms").write_bytes(whole[:-1500])
    (tmp_path / "empty.csv").write_bytes(b"")
    draft, made = drafted(tmp_path)
    assert {t.id for t in made.tests} == {"a _1__x_", "cut"}
    assert all(c.signal is not None for c in made.channels.values())
    assert len(made.channels) == 5
    assert [p for p, _ in draft.damaged] == ["cut.tdms"]
    assert ("empty.csv", "an empty file") in draft.not_used


def test_a_log_with_too_many_signals_is_drafted_in_part(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    n = 60
    monkeypatch.setattr("thermodata.draft.campaign.channels.channels._MOST_SIGNALS", 50)
    text(
        tmp_path / "a.csv",
        ["time [s]", *(f"T{i} [degC]" for i in range(n))],
        [[str(k) for k in range(3)], *([f"{20 + k}.5" for k in range(3)] for _ in range(n))],
        mark=",",
    )
    draft, made = drafted(tmp_path)
    assert len(made.channels) == 50
    assert any("10 more signals" in note for note in draft.notes)


@pytest.mark.parametrize(("one", "other"), [("Heat-01", "heat_1"), ("run 007", "RUN_7"), ("a.b", "a_b")])
def test_ids_are_the_same_whatever_the_spelling(one: str, other: str) -> None:
    assert normal(one) == normal(other)


def test_a_template_matches_as_ingest_does() -> None:
    paths = ["raw/a_1.tdms", "raw/a_2.tdms", "raw/ab.tdms", "raw/x/a_1.tdms"]
    assert matches("raw/{test}_*.tdms", "a", paths) == ["raw/a_1.tdms", "raw/a_2.tdms"]
    assert matches("*/{test}_1.tdms", "a", paths) == ["raw/a_1.tdms"]
    assert matches("raw/a[[]1].tdms", "", ["raw/a[1].tdms"]) == ["raw/a[1].tdms"]


def test_a_file_that_two_readers_claim_is_said_with_both_reasons(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    log(tmp_path / "a.tdms", 0)
    (tmp_path / "b.dat").write_text("x\n")
    real = __import__("thermodata.reader.finding.registry", fromlist=["claims"]).claims
    monkeypatch.setattr(
        "thermodata.draft.files.described_file.claims",
        lambda path: {"crio": "one reason", "table": "another"} if Path(path).name == "b.dat" else real(path),
    )
    drafted(tmp_path)
    text = (tmp_path / "campaign.yaml").read_text("utf-8")
    left = [x for x in text.splitlines() if x.startswith("# not used: b.dat")]
    assert len(left) == 1
    assert "crio (one reason) and table (another)" in left[0]


def test_a_table_with_dates_that_names_the_tests_is_no_log(tmp_path: Path) -> None:
    for k, test in enumerate(("run_a", "run_b")):
        for part in range(2):
            log(tmp_path / f"{test}_{part + 1}.tdms", k + part * 1000 / 86400)
    log(tmp_path / "jump_z.tdms", 9, "probe Z", "V")
    (tmp_path / "tabulka.csv").write_text(
        "Test;Otáčky [1/min];Datum\nrun_a;9000;2026-03-01\nrun_b;6000;2026-03-02\n", encoding="utf-8"
    )
    made, _ = drafted(tmp_path)
    assert made.table is not None
    assert made.table.file == "tabulka.csv"
    said = {t.id: t.conditions.get("speed") for t in made.tests}
    assert (said["run_a"], said["run_b"]) == ("9000 1/min", "6000 1/min")


def test_numbers_that_read_in_two_ways_are_asked_whoever_reads_them(tmp_path: Path) -> None:
    """LabVIEW's text without a time, or with a column that may be one; points that may part thousands."""
    n = range(50)
    for k in (1, 2):
        (tmp_path / f"bare{k}.lvm").write_text("".join(f"{20 * (1 - 0.9**i):.6f}\t{30 + k * i / 4}\n" for i in n))
        (tmp_path / f"still{k}.lvm").write_text("".join(f"{20 + k * (i % 3) / 7:.5f}\t{30 + i % 5}\n" for i in n))
        (tmp_path / f"point{k}.csv").write_text(
            "time [s];T\n" + "".join(f"{i};1.{250 * k * i % 1000:03d}\n" for i in n)
        )
    made, campaign = drafted(tmp_path)
    assert len(campaign.tests) == 6
    assert sorted(repr(s.table) for s in made.sources) == [
        "{'decimal': 'unknown'}",
        "{'time': {'column': 1, 'unit': 'unknown'}}",
        "{'time': {'period': 'unknown'}}",
    ]


@pytest.mark.parametrize(
    ("name", "pieces", "template"),
    [
        ("{test}/thermo.log{piece}", (".2", ".1", ""), "{test}/thermo.log*"),
        ("{test}.log{piece}", (".2", ".1", ""), "{test}.log*"),
        ("{test}.csv{piece}", ("-20260301", "-20260302", ""), "{test}.csv*"),
    ],
)
def test_pieces_that_logrotate_put_aside_are_one_log(
    tmp_path: Path, name: str, pieces: tuple[str, ...], template: str
) -> None:
    n = 300
    for k, test in enumerate(("heat", "cool")):
        for part, piece in enumerate(pieces):
            begin = START + timedelta(days=k, seconds=3000 * part)
            path = tmp_path / name.format(test=test, piece=piece)
            path.parent.mkdir(exist_ok=True)
            columns = [local(n, 10, begin, "UTC", "%Y-%m-%d %H:%M:%S"), numbers(warm(n, 20, 1, 1, 1))]
            text(path, ["Time", "T hall [degC]"], columns)
    _, made = drafted(tmp_path)
    assert sorted(t.id for t in made.tests) == ["cool", "heat"]
    assert [s.files for s in made.sources.values()] == [template]
    assert list(made.channels) == ["T_hall"]


@pytest.mark.parametrize("pieces", [(".1", ".2", ".3"), ("", ".1", ".2")])
def test_logs_of_other_days_are_tests_also_where_they_are_numbered(tmp_path: Path, pieces: tuple[str, ...]) -> None:
    n = 300
    for day, piece in enumerate(pieces):
        columns = [local(n, 10, START + timedelta(days=day), "UTC", "%Y-%m-%d %H:%M:%S"), numbers(warm(n, 20, 1, 1, 1))]
        text(tmp_path / f"heat.log{piece}", ["Time", "T hall [degC]"], columns)
    _, made = drafted(tmp_path)
    assert len(made.tests) == 3
    assert len(made.sources) == 1


def hall(path: Path, signal: str, days: float = 3.2) -> None:
    rows = [f"{START + timedelta(minutes=10 * k):%Y-%m-%d %H:%M:%S};{20 + k / 100}" for k in range(round(144 * days))]
    path.write_text("\n".join([f"Time;{signal} [degC]", *rows, ""]))


def test_two_logs_of_the_hall_that_are_called_alike_run_over_the_tests_and_are_none(tmp_path: Path) -> None:
    for k, test in enumerate(("heat_2000", "heat_5000", "heat_8000")):
        log(tmp_path / f"{test}.tdms", k + 0.1)
    hall(tmp_path / "tinytag_hall.csv", "T north")
    hall(tmp_path / "ttn_hall.txt", "T south")
    _, made = drafted(tmp_path)
    assert [t.id for t in made.tests] == ["heat_2000", "heat_5000", "heat_8000"]
    assert {s.files for s in made.sources.values()} == {"{test}.tdms", "tinytag_hall.csv", "ttn_hall.txt"}


def test_two_logs_of_one_test_beside_others_are_that_test(tmp_path: Path) -> None:
    for k, test in enumerate(("heat_2000", "heat_5000", "heat_8000")):
        log(tmp_path / f"{test}.tdms", k + 0.1)
    hall(tmp_path / "tinytag_warmup.csv", "T north", days=0.05)
    hall(tmp_path / "ttn_warmup.txt", "T south", days=0.05)
    _, made = drafted(tmp_path)
    assert "warmup" in {t.id for t in made.tests}


def test_the_length_of_a_test_in_parts_is_that_of_all(tmp_path: Path) -> None:
    """Of dated parts with the pause between them, of two logs the longer one."""
    for k, test in enumerate(("heat", "cool")):
        for part in range(3):
            text(
                tmp_path / f"{test}_{part + 1}.csv",
                ["Time", "Spindle speed [rpm]"],
                [
                    local(300, 10, START + timedelta(days=k, seconds=3060 * part), "UTC", "%Y-%m-%d %H:%M:%S"),
                    numbers(speeds(300, [3000]), 0),
                ],
            )
    draft, _ = drafted(tmp_path)
    assert [(t.id, t.length_s) for t in draft.tests] == [("cool", 9110.0), ("heat", 9110.0)]


@pytest.mark.parametrize(("name", "pause_s", "asked"), [("run_B_Fortsetzung", 300, True), ("run_B_neu", 90_000, False)])
def test_a_test_that_goes_on_soon_after_another_of_its_name_is_asked(
    tmp_path: Path, name: str, pause_s: float, asked: bool
) -> None:
    log(tmp_path / "run_A.tdms", 0)
    log(tmp_path / "run_B.tdms", 1)
    log(tmp_path / f"{name}.tdms", 1 + (1000 + pause_s) / 86400)
    draft, _ = drafted(tmp_path)
    doubts = {t.id: "; ".join(t.doubts) for t in draft.tests}
    assert ("does it go on 'run_B', which ended 5 min before?" in doubts[name]) is asked
    assert not any("does it go on" in doubts[t] for t in ("run_A", "run_B"))
