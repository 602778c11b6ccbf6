"""A test that was ingested from a table, taken away as MAT and MDF4, and read again with our own reader."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from thermodata_reader_table import Reader

from thermodata.errors import UsageError
from thermodata.export import export_test
from thermodata.export import mat as mat_module
from thermodata.export.xlsx import _sheet_names
from thermodata.plugin import Source
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.testing.reader import Data, load
from thermodata.view import StoreView

START = "2026-03-01T08:00:00.123456789"
CAMPAIGN = """
schema: thermodata/campaign/1
id: c
machine: {id: "138", spindle: SP1}
sources:
  daq: {reader: table, files: "{test}.csv", timezone: UTC}
  nc: {reader: table, files: "{test}_nc.csv", timezone: UTC}
channels:
  T_front: {source: daq, signal: T1, quantity: temperature, unit: degC, at: spindle.bearing.front, notes: "glued čidlo"}
  T_rear: {source: daq, signal: T2, quantity: temperature, unit: degC, at: spindle.bearing.rear}
  mode: {source: nc, signal: mode, quantity: label}
  speed: {source: nc, signal: speed, quantity: rotational_speed, unit: rpm, at: spindle}
tests:
  - {id: sp9000, kind: spindle, role: calibration, notes: first of the day,
     conditions: {speed: 9000 rpm, coolant: "on", feed: 600 mm/min, run: 3}}
"""


@pytest.fixture(scope="module")
def view(tmp_path_factory: pytest.TempPathFactory) -> StoreView:
    folder = tmp_path_factory.mktemp("export")
    t = np.datetime64(START, "ns") + np.arange(400) * np.timedelta64(500, "ms")
    rows = [f"{a},{20 + i / 16!r},{'' if i in (7, 8) else repr(30 - i / 8)}" for i, a in enumerate(t)]
    rows[100] = rows[100].replace(rows[100].split(",")[1], "999.5")  # a spike
    (folder / "sp9000.csv").write_text("time,T1 [degC],T2 [degC]\n" + "\n".join(rows) + "\n")
    slow = [f"{a},{'cut' if i % 20 > 9 else 'idle'},{9000 * (i > 9)}" for i, a in enumerate(t[::10])]
    (folder / "sp9000_nc.csv").write_text("time,mode,speed [rpm]\n" + "\n".join(slow) + "\n")
    (folder / "campaign.yaml").write_text(CAMPAIGN, "utf-8")
    store = Store(folder / "store", create=True)
    ingest(store, folder / "campaign.yaml")
    return StoreView(store)


def again(path: Path) -> Data:
    return load(Reader(), path, Source(timezone="UTC"))


def stored(view: StoreView, channel: str) -> Any:
    query = "select t_s, value, flag from signal('c', 'sp9000', ?) order by t"
    return view.sql(query, [channel]).to_arrow_table().to_pandas()


@pytest.mark.parametrize("suffix", ["mat", "mf4"])
def test_a_grid_comes_back_equal(view: StoreView, tmp_path: Path, suffix: str) -> None:
    done = export_test(view, "c", "sp9000", tmp_path / f"x.{suffix}", step="10 s")
    assert done.units["T_front"] == "degC"
    data = again(tmp_path / f"x.{suffix}")
    grid = view.binned("c", "sp9000", "10 s").to_arrow_table()
    stream = data.recording.signals[0].stream
    assert done.rows == grid.num_rows
    zero = np.datetime64(START, "ns").astype(np.int64)
    np.testing.assert_array_equal(data.t_ns[stream] - zero, np.rint(grid["t_s"].to_numpy() * 1e9).astype(np.int64))
    for name in ("T_front", "T_rear", "speed"):
        np.testing.assert_array_equal(data.values[stream, name], grid[name].to_numpy())
    assert {s.name: s.unit for s in data.recording.signals}["T_front"] == "degC"
    assert {p.name for p in tmp_path.iterdir()} == {f"x.{suffix}"}


@pytest.mark.parametrize("suffix", ["mat", "mf4"])
def test_as_logged_each_source_keeps_its_times_values_and_flags(view: StoreView, tmp_path: Path, suffix: str) -> None:
    export_test(view, "c", "sp9000", tmp_path / f"x.{suffix}", step="logged")
    data = again(tmp_path / f"x.{suffix}")
    prefix = {"mat": "daq/", "mf4": ""}[suffix]
    stream = next(s.stream for s in data.recording.signals if s.name == f"{prefix}T_front")
    want = stored(view, "T_front")
    np.testing.assert_array_equal(data.values[stream, f"{prefix}T_front"], want["value"])
    flags = data.values[stream, "daq/flags/T_front" if suffix == "mat" else "T_front.flag"]
    np.testing.assert_array_equal(flags, want["flag"])
    assert flags.any()
    labels = next(v for (_, name), v in data.values.items() if name.endswith("mode"))
    assert list(labels[8:12]) == ["idle", "idle", "cut", "cut"]


def test_matlab_finds_what_describes_the_test(view: StoreView, tmp_path: Path) -> None:
    import scipy.io

    export_test(view, "c", "sp9000", tmp_path / "x.mat", step="10 s")
    found = scipy.io.loadmat(tmp_path / "x.mat", simplify_cells=True)
    assert found["about"]["conditions"]["coolant"] == "on"
    assert [found["about"]["conditions"][name] for name in ("speed", "feed", "run")] == pytest.approx([9000, 0.6, 3])
    assert found["about"]["condition_units"] == {"speed": "rpm", "feed": "m/min"}, "of numbers with a unit"
    assert found["about"]["test"] == "sp9000"
    assert found["about"]["notes"] == "first of the day"
    assert found["about"]["start_utc"] == START + "Z"
    assert found["time_epoch"] == START + "Z"
    assert found["time"][0] == 0, "counts from time_epoch, in seconds"
    assert found["units"]["speed"] == "rpm"
    assert found["channels"]["T_front"]["at"] == "spindle.bearing.front"
    assert found["channels"]["T_front"]["notes"] == "glued čidlo"
    assert found["time"].ndim == 1


def test_an_mdf_tool_finds_what_describes_the_test(view: StoreView, tmp_path: Path) -> None:
    import asammdf

    export_test(view, "c", "sp9000", tmp_path / "x.mf4", step="logged")
    with asammdf.MDF(tmp_path / "x.mf4") as mdf:
        assert (mdf.header.project, mdf.header.subject) == ("c", "sp9000")
        assert "condition coolant: on" in mdf.header.comment
        assert "condition speed: 9000 rpm" in mdf.header.comment
        signal = mdf.get("T_front", ignore_invalidation_bits=True)
        assert signal.unit == "degC"
        assert "at: spindle.bearing.front" in signal.comment
        assert mdf.get("T_rear", ignore_invalidation_bits=True).invalidation_bits.nonzero()[0].tolist()[:2] == [7, 8]


def test_a_test_too_large_for_version_5_is_written_as_hdf5(
    view: StoreView, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mat_module, "MOST_BYTES", 1000)
    export_test(view, "c", "sp9000", tmp_path / "x.mat", step="logged")
    assert (tmp_path / "x.mat").read_bytes()[:10] == b"MATLAB 7.3"
    data = again(tmp_path / "x.mat")
    np.testing.assert_array_equal(
        data.values[next(k for k in data.values if k[1] == "daq/T_rear")], stored(view, "T_rear")["value"]
    )
    assert {s.name: s.unit for s in data.recording.signals}["daq/T_rear"] == "degC"
    assert set(next(v for k, v in data.values.items() if k[1] == "nc/mode")) == {"idle", "cut"}


def test_logged_sources_are_no_one_table(view: StoreView, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="at their own times"):
        export_test(view, "c", "sp9000", tmp_path / "x.csv", step="logged")


def test_a_name_too_long_for_matlab_is_refused_not_cut() -> None:
    with pytest.raises(UsageError, match="too long for MATLAB"):
        mat_module._safe("T_" + "x" * 80)


def test_excel_gets_numbers_and_dates_with_units_in_the_second_row(view: StoreView, tmp_path: Path) -> None:
    import python_calamine

    done = export_test(view, "c", "sp9000", tmp_path / "x.xlsx", step="10 s")
    book = python_calamine.CalamineWorkbook.from_path(str(tmp_path / "x.xlsx"))
    assert book.sheet_names == ["grid", "about"]
    names, units, first, *rest = book.get_sheet_by_name("grid").to_python()
    assert names == done.columns == ["time_utc", "t_s", *list(names)[2:]]
    assert dict(zip(names, units, strict=True))["T_front"] == "degC"
    grid = view.binned("c", "sp9000", "10 s").to_arrow_table()
    assert len(rest) + 1 == done.rows == grid.num_rows
    assert first[0].isoformat().startswith(START[:19])
    at = names.index("T_front")
    assert [row[at] for row in (first, *rest)] == pytest.approx(grid["T_front"].to_pylist())
    about = book.get_sheet_by_name("about").to_python()
    assert ["test", "sp9000"] in [row[:2] for row in about]
    assert ["speed", "9000 rpm"] in [row[:2] for row in about]
    assert "glued čidlo" in next(row for row in about if row[0] == "T_front")


def test_excel_has_room_for_times_and_names_and_keeps_them_in_sight(view: StoreView, tmp_path: Path) -> None:
    """Without widths a time is shown as '####', and a library warns of a workbook without a style."""
    import zipfile
    from xml.etree import ElementTree

    export_test(view, "c", "sp9000", tmp_path / "x.xlsx", step="10 s")
    main = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
    with zipfile.ZipFile(tmp_path / "x.xlsx") as book:
        sheet = ElementTree.fromstring(book.read("xl/worksheets/sheet1.xml"))
        styles = ElementTree.fromstring(book.read("xl/styles.xml"))
    assert [child.tag.removeprefix(main) for child in sheet] == ["sheetViews", "cols", "sheetData"], "in Excel's order"
    names = ["".join(c.itertext()) for c in sheet.find(f"{main}sheetData")[0]]  # type: ignore[index]
    wide = [float(c.get("width", "0")) for c in sheet.find(f"{main}cols") or ()]
    assert len(wide) == len(names)
    assert wide[0] >= len("2026-03-01 08:00:00.123")
    assert all(w > len(n) for w, n in zip(wide, names, strict=True))
    pane = next(sheet.iter(f"{main}pane"))
    assert (pane.get("xSplit"), pane.get("ySplit"), pane.get("topLeftCell")) == ("2", "2", "C3")
    assert next(styles.iter(f"{main}cellStyle")).get("name") == "Normal"


def test_as_logged_excel_has_a_sheet_a_source_and_the_answer_the_rows_of_each(view: StoreView, tmp_path: Path) -> None:
    import python_calamine

    done = export_test(view, "c", "sp9000", tmp_path / "x.xlsx", step="logged")
    assert done.streams == {"daq": 400, "nc": 40}
    book = python_calamine.CalamineWorkbook.from_path(str(tmp_path / "x.xlsx"))
    assert {n: len(book.get_sheet_by_name(n).to_python()) - 2 for n in ("daq", "nc")} == done.streams
    names, _, *rows = book.get_sheet_by_name("nc").to_python()
    assert rows[8][names.index("mode")] == "idle"


def test_a_test_with_more_rows_than_a_sheet_is_refused(
    view: StoreView, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata.export import xlsx

    monkeypatch.setattr(xlsx, "MOST_ROWS", 100)
    with pytest.raises(UsageError, match="does not fit into a sheet"):
        export_test(view, "c", "sp9000", tmp_path / "x.xlsx", step="logged")
    assert not (tmp_path / "x.xlsx").exists()


def test_the_times_of_csv_say_that_they_are_utc(view: StoreView, tmp_path: Path) -> None:
    done = export_test(view, "c", "sp9000", tmp_path / "x.csv", step="10 s")
    lines = (tmp_path / "x.csv").read_text().splitlines()
    assert lines[0].startswith('"campaign","test","time_utc","t_s [s]"')
    assert lines[1].split(",")[2] == f'"{START}Z"'
    assert "time_utc" in done.columns
    data = load(Reader(), tmp_path / "x.csv", Source(timezone="Europe/Berlin"))  # the mark counts, not the timezone
    stream = data.recording.signals[0].stream
    assert data.t_ns[stream][0] == np.datetime64(START, "ns").astype(np.int64)


def test_the_answer_names_the_time_as_the_file_does(view: StoreView, tmp_path: Path) -> None:
    for suffix, time in (("mat", "time"), ("mf4", "time"), ("csv", "time_utc"), ("parquet", "t")):
        done = export_test(view, "c", "sp9000", tmp_path / f"x.{suffix}", step="10 s")
        assert time in done.columns
        assert done.streams is None
        assert set(done.units) <= set(done.columns)


def test_a_name_of_another_format_is_refused_with_one_of_this(view: StoreView, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="says another format") as caught:
        export_test(view, "c", "sp9000", tmp_path / "x.xlsx", step="10 s", kind="parquet")
    assert "x.parquet" in str(caught.value.hint)
    with pytest.raises(UsageError, match="does not say the format") as caught:
        export_test(view, "c", "sp9000", tmp_path / "x.ods", step="10 s")
    assert "x.xlsx" in str(caught.value.hint)
    export_test(view, "c", "sp9000", tmp_path / "x.data", step="10 s", kind="csv")


@pytest.mark.parametrize(
    ("file", "step"),
    [
        ("warm.csv", "30 s"),
        ("warm.parquet", "30 s"),
        ("warm.xlsx", "30 s"),
        ("warm.xlsx", "logged"),
        ("warm.mat", "30 s"),
        ("warm.mat", "logged"),
        ("warm.mf4", "30 s"),
        ("warm.mf4", "logged"),
    ],
)
def test_an_own_file_comes_back_without_questions_of_zone_and_sign(tmp_path: Path, file: str, step: str) -> None:
    """But for a displacement whose sign nobody knew: it says so in the file."""
    from thermodata.cli import main

    lab, back = tmp_path / "lab", tmp_path / "back"
    lab.mkdir()
    back.mkdir()
    t = np.datetime64("2026-03-01T08:00:00.250", "ms") + np.arange(0, 7200, 10) * np.timedelta64(1, "s")
    rows = [f"{a},{22 + i / 100:.2f},{i / 50:.2f},{i / 40:.3f},{i // 200 % 2},{i}" for i, a in enumerate(t)]
    (lab / "warm.csv").write_text("time,T [degC],Z [um],X [um],Coolant on,Feed [mm/min]\n" + "\n".join(rows) + "\n")
    (lab / "campaign.yaml").write_text("""
schema: thermodata/campaign/1
id: c
sources: {daq: {reader: table, files: "{test}.csv", timezone: UTC}}
channels:
  T_front: {source: daq, signal: T, quantity: temperature, unit: degC, at: spindle.bearing.front}
  disp_Z: {source: daq, signal: Z, quantity: displacement, unit: um, axis: Z, at: tcp, calibration: s}
  disp_X: {source: daq, signal: X, quantity: displacement, unit: um, axis: X, at: tcp}
  coolant_on: {source: daq, signal: Coolant on, quantity: state, at: coolant}
  feed_Z: {source: daq, signal: Feed, quantity: feed, unit: mm/min, at: axis.z}
calibrations: {s: {kind: scale, axis: Z, gain: 1 um/um, facing: -Z, increases_with: gap}}
tests: [{id: warm, kind: spindle, role: calibration}]
""")
    store = Store(tmp_path / "store", create=True)
    ingest(store, lab / "campaign.yaml")
    export_test(StoreView(store), "c", "warm", back / file, step=step)
    if file.endswith(".csv"):
        assert "disp_X (sign unknown) [um]" in (back / file).read_text().splitlines()[0]
    assert main(["--store", str(tmp_path / "other"), "init", str(back)]) == 0
    text = (back / "campaign.yaml").read_text()
    lines = {line.split(":")[0].strip(): line for line in text.splitlines()}
    assert "?" not in lines["log"]
    assert "calibration: sign_disp_Z" in lines["disp_Z"]
    assert "?" not in lines["disp_Z"]
    assert "which way does it count?" in lines["disp_X"]
    assert not {"campaign_2", "test_2", "# t_s", "# t_s_2"} & lines.keys()
    assert "coolant_on" in lines
    assert "unit: m/min" in lines["feed_Z"]
    assert "in mm/min" not in text
    again = Store(tmp_path / "again", create=True)
    ingest(again, back / "campaign.yaml")
    views = [(StoreView(store), "c"), (StoreView(again), "back")]
    own, other = (v.binned(c, "warm", "30 s").to_arrow_table() for v, c in views)
    assert other["t"].to_pylist() == own["t"].to_pylist()
    for name in ("T_front", "disp_Z", "disp_X", "coolant_on", "feed_Z"):
        assert other[name].to_pylist() == pytest.approx(own[name].to_pylist()), name
    turned = own["disp_Z"].to_pylist()
    assert turned[-1] < turned[0] - 10, "turned to the machine's axis in the first store, and not again in the other"
    said = "select channel, unit, sign from channel where axis is not null order by channel"
    assert views[0][0].sql(said).fetchall() == views[1][0].sql(said).fetchall()


@pytest.mark.parametrize("step", ["30 s", "logged"])
@pytest.mark.parametrize("suffix", ["xlsx", "mat", "mf4"])
def test_short_names_and_those_of_one_test_come_back_as_they_are(tmp_path: Path, suffix: str, step: str) -> None:
    """'dZ' of 'Eddy/Z' is no 'Eddy_Z_dZ'; the flags beside it are none of the machine's states."""
    from thermodata.cli import main

    lab, back = tmp_path / "lab", tmp_path / "back"
    lab.mkdir()
    back.mkdir()
    t = np.datetime64("2026-03-01T08:00:00") + np.arange(0, 7200, 10) * np.timedelta64(1, "s")
    for test, wear in (("cold", ""), ("warm", ",Eddy/X [um]")):
        rows = [
            f"{a},{'' if i == 30 else 22 + i / 100},{i / 50:.2f},{'' if i == 9 else i / 40}" + f",{i / 30}" * bool(wear)
            for i, a in enumerate(t)
        ]
        (lab / f"{test}.csv").write_text(f"time,T06 [degC],max [degC],Eddy/Z [um]{wear}\n" + "\n".join(rows) + "\n")
    (lab / "campaign.yaml").write_text("""
schema: thermodata/campaign/1
id: c
sources: {daq: {reader: table, files: "{test}.csv", timezone: UTC}}
channels:
  T1: {source: daq, signal: T06, quantity: temperature, unit: degC, at: spindle.bearing.front}
  max: {source: daq, signal: max, quantity: temperature, unit: degC, at: bed}
  dZ: {source: daq, signal: Eddy/Z, quantity: displacement, unit: um, axis: Z, at: tcp, calibration: s}
  dX: {source: daq, signal: Eddy/X, quantity: displacement, unit: um, axis: X, at: tcp, calibration: x, only_in: [warm]}
calibrations:
  s: {kind: scale, axis: Z, gain: 1 um/um, facing: -Z, increases_with: gap}
  x: {kind: scale, axis: X, gain: 1 um/um, facing: +X, increases_with: gap}
tests: [{id: cold, kind: spindle, role: calibration}, {id: warm, kind: spindle, role: calibration}]
""")
    store = Store(tmp_path / "store", create=True)
    ingest(store, lab / "campaign.yaml")
    for test in ("cold", "warm"):
        export_test(StoreView(store), "c", test, back / f"{test}.{suffix}", step=step)
    assert main(["--store", str(tmp_path / "other"), "init", str(back)]) == 0
    again = Store(tmp_path / "again", create=True)
    ingest(again, back / "campaign.yaml")
    said = "select test, channel, quantity, unit, sign from channel order by all"
    own, other = (StoreView(s).sql(said).fetchall() for s in (store, again))
    assert other == own


def test_sheets_have_names_that_differ_whatever_streams_are_called() -> None:
    names = _sheet_names(["a/b", "a_b", "Z", "z", "about", "x" * 40, "x" * 41, "about"])
    assert len({n.casefold() for n in names}) == len(names)
    assert all(0 < len(n) <= 31 for n in names)
    assert _sheet_names(["daq", "nc"]) == ["daq", "nc"]


def test_parquet_says_that_its_times_are_utc_and_what_its_columns_are(view: StoreView, tmp_path: Path) -> None:
    import pyarrow.parquet as pq

    export_test(view, "c", "sp9000", tmp_path / "x.parquet", step="10 s")
    schema = pq.read_schema(tmp_path / "x.parquet")
    assert str(schema.field("t").type) == "timestamp[ns, tz=UTC]"
    assert schema.field("T_front").metadata[b"unit"] == b"degC"


def test_a_displacement_of_parquet_without_a_sign_is_asked_for_it(tmp_path: Path) -> None:
    """As older exports have it: their columns say no sign, and it may be unknown."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    from thermodata.draft.make import draft_files

    t = np.datetime64("2026-03-01T08:00:00", "ns") + np.arange(240) * np.timedelta64(30, "s")
    columns = {"campaign": ["c"] * 240, "test": ["warm"] * 240, "t": t, "t_s": np.arange(240) * 30.0}
    units = {b"thermodata.units": b'{"t_s": "s", "disp_X": "um"}'}
    pq.write_table(
        pa.table({**columns, "disp_X": np.arange(240) / 10}).replace_schema_metadata(units), tmp_path / "warm.parquet"
    )
    (channel,) = draft_files(tmp_path).draft.channels
    assert channel.name == "disp_X"
    assert not channel.as_exported
