"""Bare logs of a known campaign: which of them are one test is told by all of its sources together."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.known.by_patterns import ids_in
from thermodata.draft.known.of_logs import campaign_of_logs
from thermodata.errors import UsageError
from thermodata.schema.files.load import parse_campaign
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

Tests = dict[str, dict[str, list[str]]]


def found_in(folder: Path, daq: str, hall: str, files: dict[str, str]) -> Tests:
    """The tests of a folder whose sources are called so. files: name -> the source that wrote it, and at what hour."""
    for name, said in files.items():
        source, _, hour = said.partition(" ")
        signal = {"daq": "T_bed [degC]", "hall": "Air [degC]"}[source]
        rows = "".join(f"2026-03-02 {int(hour or 8):02d}:{i:02d}:00,{20 + i / 100}\n" for i in range(60))
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(f"time,{signal}\n{rows}")
    known = parse_campaign(
        f"""
schema: thermodata/campaign/1
id: known
machine: {{id: "1"}}
sources:
  daq: {{reader: table, files: "{daq}"}}
  hall: {{reader: table, files: "{hall}"}}
channels:
  T_bed: {{source: daq, signal: T_bed, quantity: temperature, unit: degC, at: bed}}
  T_air: {{source: hall, signal: Air, quantity: temperature, unit: degC, at: hall.top}}
tests: [{{id: old, role: none}}]
""",
        "campaign.yaml",
    )
    made = campaign_of_logs(known, folder, ["T_bed", "T_air"])
    found = {t.id: {s: f if isinstance(f, list) else [f] for s, f in t.files.items()} for t in made.tests}
    return {t: {s: f for s, f in files.items() if f} for t, files in found.items()}


@pytest.mark.parametrize(
    ("daq", "hall", "files", "tests"),
    [
        (
            "raw/{test}.csv",
            "raw/{test}_hall.csv",
            {"a_1.csv": "daq", "a_1_hall.csv": "hall", "b_1.csv": "daq", "b_1_hall.csv": "hall"},
            {
                "a_1": {"daq": ["a_1.csv"], "hall": ["a_1_hall.csv"]},
                "b_1": {"daq": ["b_1.csv"], "hall": ["b_1_hall.csv"]},
            },
        ),
        (
            "{test}.csv",
            "{test}_hall.csv",
            {"near_hall.csv": "daq", "near_hall_hall.csv": "hall"},
            {"near_hall": {"daq": ["near_hall.csv"], "hall": ["near_hall_hall.csv"]}},
        ),
        (
            "raw/{test}_*.csv",
            "raw/{test}.csv",
            {"raw/day_1.csv": "hall", "raw/day_1_1.csv": "daq 8", "raw/day_1_2.csv": "daq 9"},
            {"day_1": {"daq": ["raw/day_1_1.csv", "raw/day_1_2.csv"], "hall": ["raw/day_1.csv"]}},
        ),
        (
            "{test}_*.csv",
            "hall/{test}.csv",
            {"V1_eddy_fast.csv": "daq", "hall/V1.csv": "hall"},
            {"V1": {"daq": ["V1_eddy_fast.csv"], "hall": ["hall/V1.csv"]}},
        ),
        (
            "{test}_*.csv",
            "hall_{test}.csv",  # without one here
            {"day_1_1.csv": "daq 8", "day_1_2.csv": "daq 9", "day_2_1.csv": "daq 20"},
            {"day_1": {"daq": ["day_1_1.csv", "day_1_2.csv"]}, "day_2": {"daq": ["day_2_1.csv"]}},
        ),
        (
            "{test}_daq.csv",
            "{test}-hall.csv",
            {"Heat-01_daq.csv": "daq", "heat_1-hall.csv": "hall"},
            {"Heat-01": {"daq": ["Heat-01_daq.csv"], "hall": ["heat_1-hall.csv"]}},
        ),
        (
            "{test}_daq.csv",
            "{test}_hall.csv",
            {"heat_1_daq.csv": "daq", "heat_01_daq.csv": "daq"},
            {"heat_1": {"daq": ["heat_1_daq.csv"]}, "heat_01": {"daq": ["heat_01_daq.csv"]}},
        ),
    ],
)
def test_two_sources_of_one_test_are_one(
    tmp_path: Path, daq: str, hall: str, files: dict[str, str], tests: Tests
) -> None:
    assert found_in(tmp_path, daq, hall, files) == tests


@pytest.mark.parametrize(
    ("name", "pattern", "ids"),
    [
        ("a_1.csv", "{test}.csv", ["a_1"]),
        ("day_1_2.csv", "{test}_*.csv", ["day", "day_1"]),
        ("V12a.csv", "{test}*.csv", ["V", "V12", "V12a"]),
        ("V1/V1_2.csv", "{test}/{test}_*.csv", ["V1"]),
        ("a.csv", "{test}.tdms", []),
    ],
)
def test_a_test_ends_where_a_piece_of_the_name_does(name: str, pattern: str, ids: list[str]) -> None:
    assert ids_in(name, [pattern]) == ids


@pytest.mark.parametrize(("probe", "start"), [("daq", "08:05"), ("hall", "08:00")])
def test_a_test_begins_with_the_record_of_its_probes_though_the_model_reads_none(
    tmp_path: Path, probe: str, start: str
) -> None:
    """As in the campaign: temperatures count from there."""
    for name, signal, first in (("d1_daq.csv", "T_bed", 5), ("d1_hall.csv", "Air", 0)):
        rows = "".join(f"2026-03-02 08:{i:02d}:00,{20 + i / 100},{i}\n" for i in range(first, 60))
        (tmp_path / name).write_text(f"time,{signal} [degC],dZ [um]\n{rows}")
    known = parse_campaign(
        f"""
schema: thermodata/campaign/1
id: known
sources:
  daq: {{reader: table, files: "{{test}}_daq.csv"}}
  hall: {{reader: table, files: "{{test}}_hall.csv"}}
channels:
  T_bed: {{source: daq, signal: T_bed, quantity: temperature, unit: degC, at: bed}}
  T_air: {{source: hall, signal: Air, quantity: temperature, unit: degC, at: hall.top}}
  dZ: {{source: {probe}, signal: dZ, quantity: displacement, unit: um, axis: Z, at: tcp}}
tests: [{{id: old, role: none}}]
""",
        "campaign.yaml",
    )
    made = campaign_of_logs(known, tmp_path, ["T_bed", "T_air"])
    store = Store(tmp_path / "store", create=True)
    ingest(store, tmp_path / "campaign.yaml", campaign=made)
    with store.reader() as con:
        rows_of = con.execute("select strftime(start, '%H:%M') from test").fetchall()
    assert rows_of == [(start,)]


@pytest.mark.parametrize("beside", [False, True])
def test_a_log_that_runs_through_several_tests_is_read_by_the_campaign_file_above(tmp_path: Path, beside: bool) -> None:
    """It does not name its test, which that file says."""
    if beside:
        (tmp_path / "campaign.yaml").write_text("schema: thermodata/campaign/1\n")
    (tmp_path / "raw").mkdir()
    with pytest.raises(UsageError, match="the files of source 'hall' do not name their test") as refused:
        found_in(tmp_path / "raw", "{test}.csv", "hall.csv", {"a.csv": "daq", "hall.csv": "hall"})
    said = str(refused.value.hint)
    assert said.startswith(f"predict {tmp_path}, whose campaign.yaml" if beside else "write a campaign file")
