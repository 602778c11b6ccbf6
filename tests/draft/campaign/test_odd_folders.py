"""Folders from which a draft must come all the same: columns parted by blanks, files of no reader, several times."""

from __future__ import annotations

import json
import time
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from tests.commands import Say
from tests.draft.labs import workbook
from thermodata.schema.files.load import load_campaign, load_model

ROWS = [(10 * i, 20 + 0.05 * i, 3000 if i < 60 else 0) for i in range(120)]
HEADS = {"names": "Time T_front [degC] n [rpm]", "wide": "      Time    T_front [degC]   n [rpm]", "none": None}
WAYS = {
    "blanks": "{:.1f} {:.3f} {:d}",
    "columns": "{:10.1f}  {:8.3f}  {:6d}  ",
    "tabs": "{:.1f}\t{:.3f}\t{:d}",
}


# each two of them together
PAIRS = [(way, head, ".,"[(i + k) % 2]) for i, way in enumerate(WAYS) for k, head in enumerate(HEADS)]


@pytest.mark.parametrize(("way", "head", "mark"), PAIRS)
def test_columns_with_blanks_or_tabs_between_are_drafted_and_read(
    tmp_path: Path, say: Say, way: str, head: str, mark: str
) -> None:
    names = HEADS[head] and (HEADS[head] if way != "tabs" else "Time\tT_front [degC]\tn [rpm]")
    lines = [*([names] if names else []), *(WAYS[way].format(*row).replace(".", mark) for row in ROWS)]
    (tmp_path / "day1.txt").write_text("\n".join(lines) + "\n")
    assert say("init", tmp_path).code == 0
    path = tmp_path / "campaign.yaml"
    text = path.read_text()
    assert text.count("unit: unknown") == 1
    path.write_text(text.replace("unit: unknown", "unit: s"))
    signal = "T_front" if head != "none" else "column 2"
    (channel,) = [n for n, c in load_campaign(path).channels.items() if (c.signal or "").startswith(signal)]
    store = ("--store", tmp_path / "s")
    assert json.loads(say(*store, "ingest", path, "--json").out)["losses"] == []
    asked = f"select t_s, value from sample where channel = '{channel}' order by t_s"
    rows = json.loads(say(*store, "sql", asked, "--json").out)
    np.testing.assert_allclose([(r["t_s"], r["value"]) for r in rows], [row[:2] for row in ROWS], atol=5e-4)


def test_dates_and_times_with_blanks_between_are_two_columns_of_one_time(tmp_path: Path, say: Say) -> None:
    lines = [f"2026-03-02 08:{i:02d}:00   {20 + i / 8:.3f}  {100 * i}" for i in range(40)]
    (tmp_path / "day1.txt").write_text("Date Time T1 n\n" + "\n".join(lines) + "\n")
    found = json.loads(say("preview", tmp_path / "day1.txt", "--json").out)
    assert (found["clock"], found["rows_read"], found["streams"][0]["step_s"]) == ("absolute", 40, 60.0)
    assert [s["name"] for s in found["streams"][0]["signals"]] == ["T1", "n"]


def test_a_row_that_lacks_a_cell_between_blanks_is_lost_and_told(tmp_path: Path, say: Say) -> None:
    lines = [f"{i} {20 + i / 8:.3f} {100 * i}" for i in range(40)]
    lines[17] = "17 1700"
    (tmp_path / "day1.txt").write_text("time_s T1 n\n" + "\n".join(lines) + "\n")
    found = json.loads(say("preview", tmp_path / "day1.txt", "--json").out)
    assert found["rows_read"] == 39
    assert [x["where"] for x in found["losses"]] == ["day1.txt line 19"]


@pytest.mark.parametrize(
    "text", ["Measured on Monday.\nProbe 3 was loose.\n" * 20, "1. warm up\n2. measure\n3. cool down\n" * 10]
)
def test_prose_is_no_table(tmp_path: Path, say: Say, text: str) -> None:
    (tmp_path / "notes.txt").write_text(text)
    assert json.loads(say("sniff", tmp_path / "notes.txt", "--json").out)[0]["reader"] is None


def test_a_folder_that_no_reader_knows_is_drafted_with_what_would_help(tmp_path: Path, say: Say) -> None:
    (tmp_path / "scope.wfm").write_bytes(bytes(range(256)) * 40)
    (tmp_path / "notes.txt").write_text("Measured on Monday.\n")
    said = say("init", tmp_path)
    assert said.code == 0
    assert "no reader claims any file" in said.err
    text = (tmp_path / "campaign.yaml").read_text()
    load_campaign(tmp_path / "campaign.yaml")
    (asked,) = [line for line in text.splitlines() if line.startswith("sources:")]
    assert "# ?" in asked
    assert "export the logs as CSV" in asked
    assert "what wrote scope.wfm?" in text
    assert "# not used: scope.wfm: no reader claims it (binary;" in text
    said = say("--store", tmp_path / "s", "ingest", tmp_path / "campaign.yaml")
    assert said.code == 3
    assert "no data" in said.out + said.err


def test_an_empty_folder_is_refused(tmp_path: Path, say: Say) -> None:
    said = say("init", tmp_path)
    assert said.code == 2
    assert "a folder without files" in said.err
    assert not (tmp_path / "campaign.yaml").exists()


def test_several_columns_of_times_in_parquet_are_asked(tmp_path: Path, say: Say) -> None:
    t = np.datetime64("2026-03-02T08:00:00", "us") + np.arange(60) * np.timedelta64(10, "s")
    later = t + np.timedelta64(7, "s")
    table = {"logged_at": pa.array(t), "sent_at": pa.array(later), "T1": 20 + np.arange(60) / 8}
    pq.write_table(pa.table(table), tmp_path / "a.parquet")
    assert say("init", tmp_path).code == 0
    path = tmp_path / "campaign.yaml"
    text = path.read_text()
    (line,) = [x for x in text.splitlines() if "column: unknown" in x]
    assert "# ? which column is the time: logged_at or sent_at?" in line
    said = say("--store", tmp_path / "s", "ingest", path)
    assert said.code == 3
    assert "'time.column' of the table is not answered yet" in said.out + said.err
    path.write_text(text.replace("column: unknown", "column: logged_at"))
    assert say("--store", tmp_path / "s", "ingest", path, "--json").code == 0
    start = say("--store", tmp_path / "s", "sql", "select start from test", "--json").out
    assert "08:00:00" in start


def test_of_several_columns_of_times_the_one_that_is_called_time_counts(tmp_path: Path, say: Say) -> None:
    t = np.datetime64("2026-03-02T08:00:00", "us") + np.arange(60) * np.timedelta64(10, "s")
    table = {"logged_at": pa.array(t + np.timedelta64(7, "s")), "time": pa.array(t), "T1": 20 + np.arange(60) / 8}
    pq.write_table(pa.table(table), tmp_path / "a.parquet")
    found = json.loads(say("preview", tmp_path / "a.parquet", "--json").out)
    assert found["start"].startswith("2026-03-02T08:00:00")


def test_an_overview_beside_sheets_that_are_tests_is_left_out_and_said(tmp_path: Path, say: Say) -> None:
    header, units = ["Time", "Displ. Z", "Spindle bearing", "Speed"], ["min", "µm", "°C", "rpm"]
    book: dict[str, list[list[object]]] = {"Overview": [["Test", "Date", "What"]]}
    for k, test in enumerate(("V1_Warm", "V2_Steps", "V3_Idle")):
        rows = [[float(i), round(0.3 * i * (k < 2), 2), round(21 + 0.1 * i * (k < 2), 2), 4000.0] for i in range(61)]
        book["Overview"].append([test, "2021-06-0" + str(k + 1), "spindle"])
        book[test] = [header, units, *rows]
    workbook(tmp_path / "VMC.xlsx", book)
    assert say("init", tmp_path).code == 0
    path = tmp_path / "campaign.yaml"
    campaign = load_campaign(path)
    assert [t.id for t in campaign.tests] == ["V1_Warm", "V2_Steps", "V3_Idle"]
    assert list(campaign.channels) == ["Displ_Z", "Spindle_bearing", "Speed"]
    assert campaign.tests[0].conditions["date"] == "2021-06-01"
    assert "conditions from VMC.xlsx, column 'Test'" in path.read_text("utf-8")


def test_a_sheet_that_is_no_test_and_no_list_of_them_is_said(tmp_path: Path, say: Say) -> None:
    rows: list[list[object]] = [
        ["t [s]", "Displ. Z [um]", "Bearing [degC]"],
        *([float(i), 0.1 * i, 20 + 0.1 * i] for i in range(40)),
    ]
    probes: list[list[object]] = [["t [s]", "Level [mm]"], *([float(i), 1.0 * i] for i in range(40))]
    workbook(tmp_path / "day.xlsx", {**dict.fromkeys(("warm", "steps", "idle"), rows), "Level": probes})
    assert say("init", tmp_path).code == 0
    path = tmp_path / "campaign.yaml"
    assert len(load_campaign(path).tests) == 3
    assert "its sheet 'Level' is not like the 3 others" in path.read_text("utf-8")


def test_two_sheets_of_different_loggers_are_not_taken_for_tests(tmp_path: Path, say: Say) -> None:
    rows = [[float(i), 20 + 0.1 * i] for i in range(40)]
    workbook(
        tmp_path / "day.xlsx",
        {"Temps": [["Time [s]", "Bearing [degC]"], *rows], "Probes": [["Time [s]", "Displ. Z [um]"], *rows]},
    )
    assert say("init", tmp_path).code == 0
    assert [t.id for t in load_campaign(tmp_path / "campaign.yaml").tests] == ["day"]


def test_a_rate_at_the_end_of_a_name_is_its_unit_and_no_path(tmp_path: Path, say: Say) -> None:
    lines = ["Time [s]\tX feed m/min\tY feed mm/s\tBearing [degC]"]
    lines += [f"{10 * i}\t{3 if i < 60 else 0}\t{50 if i > 60 else 0}\t{20 + 0.05 * i:.2f}" for i in range(120)]
    (tmp_path / "feed.txt").write_text("\n".join(lines) + "\n")
    assert say("init", tmp_path).code == 0
    channels = load_campaign(tmp_path / "campaign.yaml").channels
    assert {n: (c.quantity, c.unit, c.at) for n, c in channels.items() if c.quantity == "feed"} == {
        "X_feed": ("feed", "m/min", "axis.x"),
        "Y_feed": ("feed", "mm/s", "axis.y"),
    }


def test_a_speed_in_hz_is_compared_with_a_name_in_rpm(tmp_path: Path, say: Say) -> None:
    rows = [f"{10 * i},{100 if i < 300 else 0},{20 + 0.02 * i:.2f}" for i in range(400)]
    header = "Time [s],Main spindle rotational speed [Hz],Bearing [degC]"
    (tmp_path / "Spindle6000.csv").write_text("\n".join([header, *rows]) + "\n")
    assert say("init", tmp_path).code == 0
    path = tmp_path / "campaign.yaml"
    assert load_campaign(path).tests[0].conditions == {"speed": "6000 rpm"}
    assert "speed sure: name and data" in path.read_text("utf-8")


def test_a_first_model_says_which_other_axes_were_measured(tmp_path: Path, say: Say) -> None:
    rows = [f"{10 * i},{0.1 * i:.2f},{0.05 * i:.2f},{20 + 0.02 * i:.2f}" for i in range(100)]
    header = "Time [s],Displ. Y [um],Displ. Z [um],Front bearing [degC]"
    (tmp_path / "warm.csv").write_text("\n".join([header, *rows]) + "\n")
    said = say("init", tmp_path)
    assert said.code == 0
    assert "of what the sensors explain of Displ_Z: " in said.err
    assert (
        f"; Displ_Y is measured too: thermodata first-model {tmp_path / 'campaign.yaml'} --response Displ_Y" in said.err
    )
    model = tmp_path / "model.yaml"
    assert "response: {axis: Z, at: tcp}   # measured too: Y\n" in model.read_text("utf-8")
    other = say("first-model", tmp_path / "campaign.yaml", "--response", "Displ_Y")
    assert "a first model of Displ_Y in place of that of Displ_Z, which stood as drafted" in other.err
    assert f"to have both: move {model} away, then thermodata first-model " in other.err
    again = say("first-model", tmp_path / "campaign.yaml", "--response", "Displ_Y")
    assert "in place of" not in again.err


def test_a_first_model_names_the_channels_of_two_probes_along_one_axis(tmp_path: Path, say: Say) -> None:
    """An axis and a place alone would be refused as the response: both are along Y at the tool."""
    rows = [f"{10 * i},{0.1 * i:.2f},{0.05 * i:.2f},{0.09 * i:.2f},{20 + 0.02 * i:.2f}" for i in range(100)]
    header = "Time [s],Displ. Y1 [um],Displ. Z [um],Displ. Y2 [um],Front bearing [degC]"
    (tmp_path / "warm.csv").write_text("\n".join([header, *rows]) + "\n")
    say("init", tmp_path)
    model = tmp_path / "model.yaml"
    too = "measured too: Y by {channel: Displ_Y1} or {channel: Displ_Y2}\n"
    assert f"response: {{axis: Z, at: tcp}}   # {too}" in model.read_text("utf-8")
    assert say("first-model", tmp_path / "campaign.yaml", "--response", "Displ_Y2").code == 0
    too = "measured too: Z, Y by {channel: Displ_Y1}\n"
    assert f"response: {{channel: Displ_Y2}}   # {too}" in model.read_text("utf-8")


@pytest.mark.parametrize(
    ("nut", "line"), [("X", "# on another axis than the response's, Z: feed_screw (Nut_X"), ("Z", "")]
)
def test_a_first_model_offers_what_is_logged_and_says_which_sensors_are_of_another_axis(
    tmp_path: Path, say: Say, nut: str, line: str
) -> None:
    rows = [f"{10 * i},{0.05 * i:.2f},{20 + 0.02 * i:.2f},{20 + 0.03 * i:.2f},{20 + 0.01 * i:.2f}" for i in range(100)]
    header = f"Time [s],Displ. Z [um],Front bearing [degC],Spindle motor [degC],Nut {nut} [degC]"
    (tmp_path / "warm.csv").write_text("\n".join([header, *rows]) + "\n")
    assert say("init", tmp_path).code == 0
    path = tmp_path / "model.yaml"
    text = path.read_text("utf-8")
    offered = "#  - {effect: spindle_motor, drivers: {temperature: Spindle_motor"
    assert offered in text
    assert "spindle_motor" not in [e.effect for e in load_model(path).effects]
    path.write_text(text.replace(offered, offered[1:]))
    assert "spindle_motor" in [e.effect for e in load_model(path).effects]
    assert line in text
    assert ("feed_screw" in text.partition("# no sensor for")[2].partition("\n")[0]) is False
    assert ("effect: feed_screw" in text) is (nut == "Z")


def test_files_whose_values_nobody_had_time_for_are_said(
    tmp_path: Path, say: Say, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What a test was is then guessed from its name alone; an answer must not depend on a busy machine unsaid."""
    for day in ("heat1", "heat2"):
        lines = [f"{10 * i},{20 + i / 8:.3f}" for i in range(40)]
        (tmp_path / f"{day}.csv").write_text("Time [s],T_front [degC]\n" + "\n".join(lines) + "\n")
    said = "2 files were opened, and no values looked at"
    assert said not in say("init", tmp_path).out + (tmp_path / "campaign.yaml").read_text()
    (tmp_path / "campaign.yaml").unlink()
    monkeypatch.setattr("thermodata.draft.folder.look._SAMPLES_S", -1.0)
    found = say("init", tmp_path)
    assert said in found.out + found.err + (tmp_path / "campaign.yaml").read_text()


def test_a_file_whose_time_was_up_before_its_end_is_said(
    tmp_path: Path, say: Say, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A spindle that starts late in a file is not seen then: which files that may be in must stand in the draft."""
    lines = [f"{10 * i},{0 if i < 9000 else 4000},{20 + i / 8000:.3f}" for i in range(12_000)]
    (tmp_path / "run1.csv").write_text("Time [s],nActSpeed [rpm],T_front [degC]\n" + "\n".join(lines) + "\n")
    said = "1 file was looked at in the first rows only"
    assert said not in say("init", tmp_path).out + (tmp_path / "campaign.yaml").read_text()
    whole = (tmp_path / "campaign.yaml").read_text()
    assert "kind: spindle" in whole
    (tmp_path / "campaign.yaml").unlink()
    monkeypatch.setattr("thermodata.draft.files.sample._SAMPLE_S", -1.0)
    monkeypatch.setattr("thermodata.reader.text.tables.blocks.table_rows._BLOCK_VALUES", 3000)
    say("init", tmp_path)
    hurried = (tmp_path / "campaign.yaml").read_text()
    assert said in hurried
    assert "kind: spindle" not in hurried


def test_a_busy_machine_drafts_the_same(tmp_path: Path, say: Say, monkeypatch: pytest.MonkeyPatch) -> None:
    """Time that others take is not counted as time for the folder."""
    from thermodata.draft.files import sample

    for day in range(8):
        lines = [f"{10 * i},{20 + i / 8:.3f}" for i in range(40)]
        (tmp_path / f"heat{day}.csv").write_text("Time [s],T_front [degC]\n" + "\n".join(lines) + "\n")
    say("init", tmp_path)
    quiet = (tmp_path / "campaign.yaml").read_text()
    (tmp_path / "campaign.yaml").unlink()
    clock, moment = time.monotonic, [0.0]

    def slow() -> float:
        moment[0] += 2.0  # passes whenever anybody looks
        return clock() + moment[0]

    monkeypatch.setattr(sample.time, "monotonic", slow)
    say("init", tmp_path)
    assert (tmp_path / "campaign.yaml").read_text() == quiet


def test_a_clock_that_is_set_back_to_its_start_is_drafted(tmp_path: Path, say: Say) -> None:
    seconds = np.arange(361) * 10 - np.where(np.arange(361) < 180, 0, 3600)
    rows = [str(t).replace("T", " ") for t in np.datetime64("2026-03-14T08:00:00") + seconds]
    body = "".join(f"{t},{20 + i / 100},{i / 50}\n" for i, t in enumerate(rows))
    (tmp_path / "day1.csv").write_text(f"Time,T_front [degC],dZ [um]\n{body}")
    assert rows[0] == rows[-1]
    assert say("init", tmp_path).code == 0
    assert "dZ" in load_campaign(tmp_path / "campaign.yaml").channels


PUMPS = {
    "a switch": ("KSS ein [-]", lambda i: str(int(20 < i < 80))),
    "a flow": ("KSS Durchfluss [l/min]", lambda i: f"{12.5 * (20 < i < 80):.1f}"),
    "none": ("Halle [°C]", lambda i: f"{21 + i / 1000:.3f}"),
}


@pytest.mark.parametrize(("test", "pump", "kind"), [
    ("t1", "a switch", "other"), ("t1", "a flow", "other"), ("fluids", "none", "other"), ("Kuehlung", "none", "other"),
    ("night", "none", "etve"),
])  # fmt: skip
def test_a_test_in_which_only_pumps_run_is_none_of_the_environment(
    tmp_path: Path, say: Say, test: str, pump: str, kind: str
) -> None:
    name, value = PUMPS[pump]
    rows = [f"{10 * i};0;{20 + 0.01 * i:.2f};{value(i)}" for i in range(120)]
    head = f"Time [s];Drehzahl Spindel [1/min];Spindellager vorn [°C];{name}"
    (tmp_path / f"{test}.csv").write_text("\n".join([head, *rows]) + "\n", "utf-8")
    assert say("init", tmp_path).code == 0
    (found,) = load_campaign(tmp_path / "campaign.yaml").tests
    assert found.kind == kind
    text = (tmp_path / "campaign.yaml").read_text("utf-8")
    assert ("? kind" in text) == (kind == "other")
