"""MAT 5 and 7.3: the layouts that labs save, what is asked, and scipy's own files."""

from __future__ import annotations

import zlib
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import scipy.io
from scipy.io import matlab
from thermodata_reader_table import Reader
from thermodata_reader_table.mat.tree import Cells, Node, Numbers, Odd, Struct, Structs, Text
from thermodata_reader_table.mat.version5 import variables as version5

from thermodata.errors import FormatError, UsageError
from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

S = 1_000_000_000
N = 50
T = np.arange(N) * 0.5
WAVE = np.sin(T)
SCIPYS = sorted((Path(matlab.__file__).parent / "tests" / "data").glob("*.mat"))


def col(values: Any) -> Any:
    return np.asarray(values)[:, None]


def cell(*values: Any) -> Any:
    made = np.empty((len(values), 1), object)
    made[:, 0] = values
    return made


def read(tmp_path: Path, variables: dict[str, Any], packed: bool = True, **table: Any) -> Data:
    path = tmp_path / "x.mat"
    scipy.io.savemat(path, variables, do_compression=packed)
    return load(Reader(), path, Source(timezone="Europe/Prague", table=table or None))


def names(data: Data) -> list[tuple[str, str | None]]:
    return [(s.name, s.unit) for s in data.recording.signals]


def only(data: Data) -> Any:
    """The times of the one stream."""
    (t_ns,) = data.t_ns.values()
    return t_ns


def column(data: Data, name: str) -> Any:
    (stream,) = {s.stream for s in data.recording.signals if s.name == name}
    return data.values[stream, name]


def utc(text: str) -> int:
    return int(np.datetime64(text, "ns").astype(np.int64))


@pytest.mark.parametrize("packed", [True, False])
@pytest.mark.parametrize("time", ["t", "time", "Zeit", "cas", "time_s", "tAxis"])
def test_vectors_beside_a_time_keep_dtypes_and_scalars_are_properties(tmp_path: Path, time: str, packed: bool) -> None:
    data = read(
        tmp_path,
        {
            time: col(T),
            "T1": col(WAVE),
            "i": col(np.arange(N, dtype=np.int16)),
            "door": col(WAVE > 0),
            "serial": 4711.0,
            "machine": "Gantry 138",
        },
        packed,
    )
    assert {s.name: s.dtype for s in data.recording.signals} == {"T1": "float64", "i": "int16", "door": "bool"}
    np.testing.assert_array_equal(only(data), (T * S).astype(np.int64))
    np.testing.assert_array_equal(column(data, "T1"), WAVE)
    assert data.recording.signals[0].properties == {"serial": "4711", "machine": "Gantry 138"}


def test_a_matrix_with_names_has_its_time_where_the_name_says(tmp_path: Path) -> None:
    data = read(
        tmp_path,
        {"log": np.stack([WAVE, T, -WAVE], 1), "names": cell("dZ", "Time", "T1"), "units": cell("um", "min", "degC")},
    )
    assert names(data) == [("dZ", "um"), ("T1", "degC")]
    np.testing.assert_array_equal(only(data), (T * 60 * S).astype(np.int64))


def test_a_matrix_without_names_is_read_by_the_only_column_that_rises_with_a_note(tmp_path: Path) -> None:
    data = read(tmp_path, {"log": np.stack([T, WAVE], 1)})
    assert names(data) == [("log(:,2)", None)]
    assert any("first column" in n for n in data.recording.notes)


def test_two_columns_that_rise_are_asked_for_and_declared(tmp_path: Path) -> None:
    variables = {"log": np.stack([T, T * 2], 1)}
    with pytest.raises(FormatError, match=r"time: \{column: NAME or number"):
        read(tmp_path, variables)
    assert names(read(tmp_path, variables, time={"column": 2, "unit": "s"})) == [("log(:,1)", None)]


def test_structs_records_and_simulink_logs(tmp_path: Path) -> None:
    record = [(cell(n), "degC", col(WAVE + i), col(T)) for i, n in enumerate(("front", "rear"))]
    ch = np.array(record, [("name", object), ("unit", object), ("data", object), ("time", object)])
    assert names(read(tmp_path, {"ch": ch})) == [("front", "degC"), ("rear", "degC")]
    sim = {"time": col(T), "signals": {"values": np.stack([WAVE, -WAVE], 1), "label": "tilt"}}
    assert names(read(tmp_path, {"out": sim})) == [("tilt(1)", None), ("tilt(2)", None)]
    nested = read(tmp_path, {"run": {"t": col(T), "T1": col(WAVE), "axis": {"pos": col(-WAVE)}}})
    assert names(nested) == [("run/T1", None), ("run/axis/pos", None)]


def test_several_times_are_several_streams_and_rates_make_a_grid(tmp_path: Path) -> None:
    data = read(tmp_path, {"t_fast": col(T), "t_slow": col(T[::5]), "a": col(WAVE), "b": col(WAVE[::5])})
    assert {s.name: s.stream for s in data.recording.signals} == {"a": "t_fast", "b": "t_slow"}
    grid = read(tmp_path, {"Fs": 10.0, "a": col(WAVE)})
    assert set(np.diff(only(grid)).tolist()) == {S // 10}
    both = read(tmp_path, {"x": {"data": col(WAVE), "dt": 0.1, "unit": "V"}, "y": {"data": col(WAVE), "fs": 5.0}})
    assert [int(np.diff(t)[0]) for t in both.t_ns.values()] == [S // 10, S // 5]


def test_two_times_of_one_length_are_told_apart_by_names_or_asked(tmp_path: Path) -> None:
    two = {"time_a": col(T), "time_b": col(T + 1), "a": col(WAVE), "b": col(WAVE)}
    assert {s.name: s.stream for s in read(tmp_path, two).recording.signals} == {"a": "time_a", "b": "time_b"}
    with pytest.raises(FormatError, match="which is the time of 'x'"):
        read(tmp_path, {**two, "x": col(WAVE)})
    data = read(tmp_path, {**two, "x": col(WAVE)}, time={"column": "time_b"})
    assert only(data)[0] == S
    assert "x" in dict(names(data))


def test_dates_as_datenum_text_and_unix_time(tmp_path: Path) -> None:
    day = 740042.0  # 2026-03-01
    data = read(tmp_path, {"t": col(day + np.arange(4) / 24), "T1": col(WAVE[:4])})
    # a double of this size resolves 10 us
    np.testing.assert_allclose(only(data), utc("2026-02-28T23:00") + 3600 * S * np.arange(4), rtol=0, atol=10_000)
    assert any("datenum" in n for n in data.recording.notes)
    text = np.array([f"2026-03-01 08:00:{i:02}" for i in range(4)])
    assert only(read(tmp_path, {"time": text, "T1": col(WAVE[:4])}))[1] == utc("2026-03-01T07:00:01")
    unix = read(tmp_path, {"time": col(1_770_000_000.25 + np.arange(4)), "T1": col(WAVE[:4])})
    assert only(unix)[0] == 1_770_000_000_250_000_000
    with pytest.raises(FormatError, match="some times are dates"):
        read(tmp_path, {"time_a": col(day + T), "time_b": col(T), "a": col(WAVE), "b": col(WAVE)})


def test_version_73_is_read_in_pieces_and_what_is_not_stored_is_no_zero(tmp_path: Path) -> None:
    path = tmp_path / "x.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in (("t", T), ("T1", WAVE)):
            item = file.create_dataset(name, data=values[None, :], chunks=(1, 16), compression="gzip")
            item.attrs["MATLAB_class"] = np.bytes_("double")
        hole = file.create_dataset("hole", shape=(1, N), dtype="f8", chunks=(1, 16))
        hole.attrs["MATLAB_class"] = np.bytes_("double")
    data = load(Reader(), path, Source(options={"block_rows": 7}))
    np.testing.assert_array_equal(column(data, "T1"), WAVE)
    assert [x.where for x in data.losses] == ["x.mat variable 'hole'"]
    with h5py.File(path, "a") as file:
        del file["T1"]
        file.create_dataset("T1", shape=(1, 10**9), dtype="f8", chunks=(1, 10**6), compression="gzip")
    with pytest.raises(FormatError, match="no time and signals"):
        load(Reader(), path, Source())


def test_a_wrong_variable_is_answered_with_the_nearest(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="did you mean 'run_1'"):
        read(tmp_path, {"run_1": {"t": col(T), "a": col(WAVE)}}, sheet="rum_1")


def same(ours: Node, theirs: Any) -> None:
    """Plain arrays equal scipy's; what is no plain data is told as such."""
    if isinstance(ours, Numbers):
        got = np.stack([ours.line(i, 0) for i in range(ours.columns)], 1) if ours.columns else np.zeros((0, 0))
        np.testing.assert_array_equal(got.ravel(), np.asarray(theirs).ravel())
    elif isinstance(ours, Text):
        assert list(ours.lines) == [str(x).rstrip() for x in np.atleast_1d(theirs).ravel()]
    elif isinstance(ours, Cells):
        for a, b in zip(ours.items, theirs.ravel(order="F"), strict=True):
            same(a, b)
    elif isinstance(ours, Struct) and ours.fields:
        for key, node in ours.fields.items():
            if "#" not in key:
                same(node, theirs[0, 0][key])
    elif isinstance(ours, Structs):
        for item, b in zip(ours.items, theirs.ravel(order="F"), strict=True):
            for key, node in item.fields.items():
                same(node, b[key])


@pytest.mark.skipif(not SCIPYS, reason="scipy ships no files")
@pytest.mark.parametrize(
    "path", [p for p in SCIPYS if p.read_bytes()[124:128] in (b"\0\1IM", b"\1\0MI")], ids=lambda p: p.stem
)
def test_scipys_own_files_read_as_scipy_reads_them(path: Path) -> None:
    tree = version5.read(path)
    try:
        theirs = scipy.io.loadmat(path)
    except (ValueError, TypeError, OSError, zlib.error):
        assert tree.losses or path.stem == "bad_miutf8_array_name"
        return
    theirs = {k: v for k, v in theirs.items() if not k.startswith("__")}
    if path.stem == "broken_utf8":
        assert tree.variables["bad_string"] == Text(("€ am broken",))
        return
    assert set(tree.variables) <= set(theirs) | {"None"}
    for name, node in tree.variables.items():
        if not isinstance(node, Odd):
            same(node, theirs[name])


@pytest.mark.parametrize("version", ["5", "7.3"])
def test_zeros_in_text_are_the_blanks_that_matlab_shows(tmp_path: Path, version: str) -> None:
    log = np.stack([np.arange(9.0)] * 3, 1)
    path = tmp_path / "x.mat"
    if version == "5":
        scipy.io.savemat(path, {"log": log, "names": cell("time [s]", "dZ~[um]", "n [rpm]~~")})
        assert path.read_bytes().count(b"~") == 3
        path.write_bytes(path.read_bytes().replace(b"~", b"\0"))
    else:
        with h5py.File(path, "w", userblock_size=512) as file:
            file.create_dataset("log", data=log.T).attrs["MATLAB_class"] = np.bytes_("double")
            cells = []
            for k, title in enumerate(("time [s]", "dZ\0[um]", "n [rpm]\0\0")):
                codes = np.array([ord(c) for c in title], np.uint16)[:, None]
                item = file.create_dataset(f"#refs#/r{k}", data=codes)
                item.attrs["MATLAB_class"] = np.bytes_("char")
                cells.append([item.ref])
            named = file.create_dataset("names", data=np.array(cells, h5py.ref_dtype))
            named.attrs["MATLAB_class"] = np.bytes_("cell")
        head = b"MATLAB 7.3 MAT-file".ljust(116) + b"\0" * 8 + b"\x00\x02IM"
        path.write_bytes(head.ljust(512, b"\0") + path.read_bytes()[512:])
    assert names(load(Reader(), path, Source())) == [("dZ [um]", "um"), ("n [rpm]", "rpm")]


@pytest.mark.parametrize(
    ("name", "said", "begun"),
    [
        ("start", "2026-05-06 08:10:00", "2026-05-06T06:10:00"),
        ("start_time", "06.05.2026 08:10", "2026-05-06T06:10:00"),
        ("start_time", "2026-05-06 08:10:00 UTC", "2026-05-06T08:10:00"),
        ("start", "2026-05-06T08:10:00Z", "2026-05-06T08:10:00"),
        ("created", "2026-05-06 08:10:00", None),
        ("start", "slowly", None),
    ],
)
def test_a_start_that_stands_beside_the_signals_is_told_and_taken_where_declared(
    tmp_path: Path, name: str, said: str, begun: str | None
) -> None:
    rising = {"t": col(np.arange(50.0)), "dX_um": col(np.arange(50.0)), name: said}
    found = read(tmp_path, rising)
    told = [n for n in found.recording.notes if n.startswith("a text beside the signals says")]
    assert ["declare table: {time: {start: head}}" in n and said in n for n in told] == [True] * bool(begun)
    assert found.recording.clock == "relative"
    assert not [n for n in read(tmp_path, rising, time={"start": "none"}).recording.notes if "beside the signals" in n]
    if begun is not None:
        dated = read(tmp_path, rising, time={"start": "head", "unit": "s"})
        assert (dated.recording.clock, dated.recording.start_ns) == ("absolute", utc(begun))
        assert only(dated)[:2].tolist() == [utc(begun), utc(begun) + 10**9]
    dates = {**rising, "t": col(1.7e9 + np.arange(50.0))}
    assert not [n for n in read(tmp_path, dates).recording.notes if "beside the signals" in n]
