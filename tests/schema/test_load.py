"""Campaign and model files: what the README shows loads; every mistake names its line and what is right."""

from __future__ import annotations

import gzip
import shutil
import zipfile
from pathlib import Path

import pytest

from thermodata.errors import SpecError
from thermodata.schema.files.load import load_campaign, parse_model

EXAMPLE = Path(__file__).with_name("campaign.yaml")


def test_the_example_of_the_design_loads() -> None:
    campaign = load_campaign(EXAMPLE)
    assert campaign.sources["ir"].clock.offset == -3.2
    assert campaign.calibrations["jump_z"].moves == [100.0, -100.0]
    assert campaign.tests[3].window == (0.0, 57600.0)
    assert campaign.machine.axes["Y"].model_extra == {"preload": "2.1 kN"}


@pytest.mark.parametrize(
    ("right", "wrong", "line", "says"),
    [
        ("gain: 250", "gian: 250", 21, "did you mean 'gain'"),
        ("quantity: tilt", "quantity: tilts", 17, "did you mean 'tilt'"),
        ("dwell: 10 s", "dwell: 10", 20, "10 s"),
        ("calibration: jump_z", "calibration: jump_y", 13, "did you mean 'jump_z'"),
        ('measuring: "feed', 'mesuring: "feed', 25, "did you mean 'measuring'"),
        ('files: "raw/{test}.csv"', 'files: "../{test}.csv"', 9, "leaves the campaign's folder"),
        ("timezone: Europe/Prague}", "timezone: Europe/Prag}", 8, "Europe/Prague"),
        ("window: [0 h, 16 h]", "window: [16 h, 1 h]", 27, "ends before"),
        ("window: [0 h, 16 h]", "phases: {late: [17 h, 18 h]}, window: [0 h, 16 h]", 27, "outside the test's window"),
        ("id: feed_z10", "id: SP9000", 25, "stands twice"),
        ("source: daq, signal: n,", "source: dag, signal: n,", 16, "did you mean 'daq'"),
        ("T_bearing_front:", "T__front:", 14, "T__front"),
        ("  t03:", "  jump_z:", 22, "stands twice"),
    ],
)
def test_a_mistake_names_its_line_and_the_right_word(
    tmp_path: Path, right: str, wrong: str, line: int, says: str
) -> None:
    text = EXAMPLE.read_text()
    assert right in text
    path = tmp_path / "c.yaml"
    path.write_text(text.replace(right, wrong, 1))
    with pytest.raises(SpecError) as caught:
        load_campaign(path)
    assert f"c.yaml:{line}" in str(caught.value)
    assert says in str(caught.value)


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("campaign", "campaign_1"),
        ("T__front", "T_front"),
        ("1st", "ch_1st"),
        ("dx", "channels 'dX' and 'dx' differ only in case"),
    ],
)
def test_a_wrong_name_of_a_channel_is_told_at_its_line(tmp_path: Path, name: str, says: str) -> None:
    path = tmp_path / "c.yaml"
    text = """schema: thermodata/campaign/1
id: c
sources: {daq: {reader: crio, files: "raw/{test}.tdms"}}
channels:
  dX: {source: daq, signal: X, quantity: temperature}
  NAME: {source: daq, signal: Y, quantity: temperature}
tests: [{id: one, kind: mixed}]
"""
    path.write_text(text.replace("NAME", name))
    with pytest.raises(SpecError) as caught:
        load_campaign(path)
    assert caught.value.where == f"c.yaml:6 (channels.{name})"
    assert caught.value.got == name
    assert says in str(caught.value)
    assert caught.value.hint


def test_nested_aliases_do_not_fill_the_memory(tmp_path: Path) -> None:
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 9)]
    path = tmp_path / "bomb.yaml"
    path.write_text("\n".join(lines))
    with pytest.raises(SpecError, match="too much"):
        load_campaign(path)


def _from_names(tmp_path: Path, extra: str = "") -> Path:
    raw = tmp_path / "raw"
    raw.mkdir()
    for name in ("S3000_F500_07.csv", "S6000_F750_8.csv", "other.csv"):
        (raw / name).write_text("x")
    (tmp_path / "tests.csv").write_text("nr;air;speed\n7;21.5;3000\n8;22,5;6100\n")
    path = tmp_path / "c.yaml"
    path.write_text(
        "schema: thermodata/campaign/1\nid: c\nsources: {nc: {reader: cnc}}\ntests_from:\n"
        '  files: "raw/S{speed}_F{feed}_{nr}.csv"\n'
        f"  table: {{file: tests.csv, key: nr, columns: {{air: air{extra}}}}}\n"
        "  units: {speed: rpm, feed: mm/min, air: degC}\n  set: {kind: spindle, role: calibration}\n"
    )
    return path


@pytest.mark.parametrize("archive", ["raw.zip", "raw.tar.gz"])
def test_conditions_come_from_names_and_a_table_in_an_archive(tmp_path: Path, archive: str) -> None:
    loose = _from_names(tmp_path)
    want = load_campaign(loose)
    way = "gztar" if archive.endswith("gz") else "zip"
    (tmp_path / "tests.csv").rename(tmp_path / "raw" / "tests.csv")
    shutil.make_archive(str(tmp_path / "raw"), way, tmp_path / "raw")
    shutil.rmtree(tmp_path / "raw")
    loose.write_text(loose.read_text().replace('"raw/', f'"{archive}/').replace("tests.csv", f"{archive}/tests.csv"))
    found = load_campaign(loose)
    assert {t.id: t.conditions for t in found.tests} == {t.id: t.conditions for t in want.tests}
    assert {t.files["nc"] for t in found.tests} == {f"{archive}/S3000_F500_07.csv", f"{archive}/S6000_F750_8.csv"}


def _two_archives(tmp_path: Path) -> Path:
    for k in (0, 1):
        with zipfile.ZipFile(tmp_path / f"day{k}.zip", "w") as archive:
            archive.writestr(f"S3000_{k}.csv", "x")
    path = tmp_path / "c.yaml"
    path.write_text(
        "schema: thermodata/campaign/1\nid: c\nsources: {nc: {reader: cnc}}\n"
        'tests_from: {files: "day*.zip/S{speed}_{nr}.csv", set: {kind: spindle}}\n'
    )
    return path


def test_a_damaged_archive_of_tests_is_told(tmp_path: Path) -> None:
    path = _two_archives(tmp_path)
    assert len(load_campaign(path).tests) == 2
    (tmp_path / "day1.zip").write_bytes((tmp_path / "day1.zip").read_bytes()[:-30])
    with pytest.raises(SpecError, match="an archive of tests can't be read") as refused:
        load_campaign(path)
    assert refused.value.got == "day1.zip: File is not a zip file"


def test_a_file_that_an_archive_refuses_is_a_test_all_the_same(tmp_path: Path) -> None:
    path = _two_archives(tmp_path)
    data = bytearray((tmp_path / "day1.zip").read_bytes())
    data[data.index(b"PK\x01\x02") + 8] |= 1  # encrypted
    (tmp_path / "day1.zip").write_bytes(data)
    assert [t.files for t in load_campaign(path).tests] == [
        {"nc": "day0.zip/S3000_0.csv"},
        {"nc": "day1.zip/S3000_1.csv"},
    ]


def test_a_packed_table_of_tests_that_is_cut_is_told(tmp_path: Path) -> None:
    path = _from_names(tmp_path)
    packed = gzip.compress(b"nr;air;speed\n7;21.5;3000\n8;22,5;6100\n" + b"9;%d;3000\n" * 99)
    (tmp_path / "tests.csv.gz").write_bytes(packed)
    path.write_text(path.read_text().replace("tests.csv", "tests.csv.gz"))
    assert len(load_campaign(path).tests) == 2
    (tmp_path / "tests.csv.gz").write_bytes(packed[:-9])
    with pytest.raises(SpecError, match="cannot read the table of tests") as refused:
        load_campaign(path)
    assert "cut off" in (refused.value.got or "")


def test_conditions_come_from_file_names_and_the_table(tmp_path: Path) -> None:
    tests = {t.id: t for t in load_campaign(_from_names(tmp_path)).tests}
    assert set(tests) == {"S3000_F500_07", "S6000_F750_8"}
    assert tests["S6000_F750_8"].conditions == {"speed": "6000 rpm", "feed": "750 mm/min", "air": "22.5 degC"}
    assert tests["S3000_F500_07"].files == {"nc": "raw/S3000_F500_07.csv"}
    assert tests["S3000_F500_07"].role == "calibration"


@pytest.mark.parametrize(
    ("sources", "source"),
    [
        ('nc: {reader: cnc, files: "raw/{test}.csv"}, daq: {reader: crio, files: "raw/{test}.tdms"}', "nc"),
        ('daq: {reader: crio, files: "raw/{test}.tdms"}, nc: {reader: cnc, files: [x.csv, "raw/{test}.*"]}', "nc"),
        ('daq: {reader: crio, files: "raw/{test}.tdms"}, nc: {reader: cnc}', "nc"),
        ('nc: {reader: cnc, files: "raw/*.csv"}, daq: {reader: crio, files: "raw/{test}.*"}', None),
        ('nc: {reader: cnc, files: "raw/{test}.txt"}, daq: {reader: crio, files: "raw/{test}_b.csv"}', None),
        ("nc: {reader: cnc}, daq: {reader: crio}", None),
    ],
)
def test_of_several_sources_the_files_are_those_of_the_one_that_names_them(
    tmp_path: Path, sources: str, source: str | None
) -> None:
    path = _from_names(tmp_path)
    path.write_text(path.read_text().replace("sources: {nc: {reader: cnc}}", f"sources: {{{sources}}}"))
    if source is None:
        with pytest.raises(SpecError, match="which source are these files"):
            load_campaign(path)
    else:
        assert [t.files for t in load_campaign(path).tests] == [
            {source: f"raw/{name}.csv"} for name in ("S3000_F500_07", "S6000_F750_8")
        ]


def test_a_file_name_that_contradicts_the_table_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(SpecError, match="disagree on 'speed'"):
        load_campaign(_from_names(tmp_path, ", speed: speed"))


def test_a_model_names_its_nearest_right_key() -> None:
    good = (
        "schema: thermodata/model/1\nname: b\ncampaign: c\nresponse: {axis: Z, at: tcp}\neffects:\n  - {effect: lag}\n"
    )
    assert parse_model(good).campaign_ids == ("c",)
    with pytest.raises(SpecError, match=r"model\.yaml:6.*\n.*\n.*did you mean 'drivers'"):
        parse_model(good.replace("{effect: lag}", "{effect: lag, drivrs: {u: x}}"))


def test_a_folder_is_not_a_file_and_says_which_is(tmp_path: Path) -> None:
    with pytest.raises(SpecError, match="init"):
        load_campaign(tmp_path)
    (tmp_path / "campaign.yaml").write_text("schema: thermodata/campaign/1")
    with pytest.raises(SpecError) as caught:
        load_campaign(tmp_path)
    assert str(tmp_path / "campaign.yaml") in str(caught.value.hint)
