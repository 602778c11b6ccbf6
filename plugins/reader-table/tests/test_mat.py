"""MAT 5 and 7.3: the layouts that labs save, what is asked, damage, and scipy's own files."""

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
from thermodata_reader_table.mat import version5
from thermodata_reader_table.mat.tree import Cells, Node, Numbers, Odd, Struct, Structs, Text

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


def test_what_is_no_plain_data_is_a_loss_that_says_how_to_save_it(tmp_path: Path) -> None:
    data = read(tmp_path, {"t": col(T), "a": col(WAVE), "z": col(WAVE + 1j)})
    assert "Save it as real(x) and imag(x)" in data.losses[0].reason
    path = tmp_path / "o.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        item = file.create_dataset("TT", data=np.zeros((6, 1), np.uint32))
        item.attrs["MATLAB_class"] = np.bytes_("timetable")
        item.attrs["MATLAB_object_decode"] = np.int32(3)
    with pytest.raises(FormatError, match=r"S = struct\('time'"):
        load(Reader(), path, Source())


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


@pytest.mark.parametrize("packed", ["gzip", None])
def test_a_chunk_that_a_search_misses_is_a_loss_and_no_zeros(tmp_path: Path, packed: str | None) -> None:
    """The last number of a chunk's key, the byte within a value, is in no list of the chunks."""
    path = tmp_path / "x.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in (("t", T), ("T1", WAVE), ("T2", -WAVE)):
            item = file.create_dataset(name, data=values[None, :], chunks=(1, 16), compression=packed)
            item.attrs["MATLAB_class"] = np.bytes_("double")
        text = np.frombuffer("gantry".encode("utf-16-le"), "<u2")[:, None]
        item = file.create_dataset("machine", data=text, chunks=(2, 1), compression=packed)
        item.attrs["MATLAB_class"] = np.bytes_("char")
        at = {n: file[n].id.get_chunk_info_by_coord(p) for n, p in (("T1", (0, 16)), ("machine", (2, 0)))}
    whole = bytearray(path.read_bytes())
    data = load(Reader(), path, Source())
    assert (data.losses, data.recording.signals[0].properties) == ((), {"machine": "gantry"})
    for name, place in (("T1", (0, 16)), ("machine", (2, 0))):
        # a key: size, filter mask, place, byte within a value; then the address, from the end of the user block
        key = b"".join(n.to_bytes(8, "little") for n in (at[name].size, *place, 0, at[name].byte_offset - 512))
        assert whole.count(key) == 1
        flipped = bytearray(whole)
        flipped[whole.index(key) + 24 + 3] ^= 1
        path.write_bytes(flipped)
        with h5py.File(path) as file:
            assert not file[name][place[0] : place[0] + 1, place[1] : place[1] + 2].any()
        data = load(Reader(), path, Source())
        assert [x.where for x in data.losses] == [f"x.mat variable '{name}'"]
        assert "a search does not find the chunk" in data.losses[0].reason
        np.testing.assert_array_equal(column(data, "T2"), -WAVE)


@pytest.mark.parametrize("shuffled", [False, True])
def test_a_chunk_that_is_not_packed_is_as_long_as_its_values(tmp_path: Path, shuffled: bool) -> None:
    """HDF5 leaves a filter out that makes nothing smaller. Of a chunk that is shorter it would read its own memory."""
    path = tmp_path / "x.mat"
    raw = -WAVE[:16]

    def write(size: int) -> Data:
        with h5py.File(path, "w", userblock_size=512) as file:
            for name, values in (("t", T), ("T1", WAVE), ("T2", -WAVE)):
                item = file.create_dataset(
                    name, data=values[None, :], chunks=(1, 16), compression="gzip", shuffle=shuffled
                )
                item.attrs["MATLAB_class"] = np.bytes_("double")
            # every filter of the chunk is left out
            file["T2"].id.write_direct_chunk((0, 0), raw.tobytes()[:size], filter_mask=0b11 if shuffled else 0b1)
        return load(Reader(), path, Source())

    data = write(raw.nbytes)
    assert data.losses == ()
    np.testing.assert_array_equal(column(data, "T2"), -WAVE)
    data = write(raw.nbytes - 40)
    assert [x.where for x in data.losses] == ["x.mat variable 'T2'"]
    assert "a chunk of 88 bytes, not 128" in data.losses[0].reason
    np.testing.assert_array_equal(column(data, "T1"), WAVE)


def test_a_cut_or_flipped_file_keeps_its_whole_variables(tmp_path: Path) -> None:
    path = tmp_path / "x.mat"
    scipy.io.savemat(path, {"t": col(T), "a": col(WAVE), "b": col(WAVE * 2)}, do_compression=True)
    whole = path.read_bytes()
    path.write_bytes(whole[:-20])
    data = load(Reader(), path, Source())
    assert ([s.name for s in data.recording.signals], data.recording.complete) == (["a"], False)
    assert "what follows is lost" in data.losses[0].reason
    flipped = bytearray(whole)
    flipped[-20] ^= 1
    path.write_bytes(bytes(flipped))
    assert "does not unpack" in load(Reader(), path, Source()).losses[0].reason


def test_counts_that_pass_the_data_are_refused_before_anything_is_made(tmp_path: Path) -> None:
    path = tmp_path / "x.mat"
    scipy.io.savemat(path, {"a": col(WAVE)})
    data = path.read_bytes()
    path.write_bytes(
        data.replace((N).to_bytes(4, "little") + (1).to_bytes(4, "little"), (2**31 - 1).to_bytes(4, "little") * 2)
    )
    with pytest.raises(FormatError):
        load(Reader(), path, Source())
    path.write_bytes(data[:128] + (b"\x0e\0\0\0\x08\0\0\0" * 100_000))
    with pytest.raises(FormatError):
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


def test_a_name_that_is_no_text_or_of_an_unknown_class_is_told(tmp_path: Path) -> None:
    for damage in ("class", "numbers"):
        path = tmp_path / f"{damage}.mat"
        with h5py.File(path, "w") as file:
            record = file.create_group("ch")
            record.attrs["MATLAB_class"] = np.bytes_("struct")
            for name, values in (("data", np.arange(5.0)[None]), ("dt", np.array([[0.5]]))):
                record.create_dataset(name, data=values).attrs["MATLAB_class"] = np.bytes_("double")
            title = record.create_dataset("name", data=np.array([[84], [49]], np.uint16))
            if damage == "class":
                title.attrs["MATLAB_class"] = np.bytes_("chbr")
        head = b"MATLAB 7.3 MAT-file".ljust(116) + b"\0" * 8 + b"\x00\x02IM"
        path.write_bytes(head.ljust(512, b"\0") + path.read_bytes())
        data = load(Reader(), path, Source())
        assert [s.name for s in data.recording.signals] == ["ch"]
        assert any("ch/name" in x for x in (*data.recording.notes, *(loss.where for loss in data.losses)))


def test_a_packed_variable_with_bytes_behind_its_end_is_a_loss(tmp_path: Path) -> None:
    path = tmp_path / "x.mat"
    scipy.io.savemat(
        path, {"t": col(np.arange(5.0)), "T1": col(np.arange(5.0)), "T2": col(np.arange(5.0))}, do_compression=True
    )
    data = path.read_bytes()
    size = int.from_bytes(data[132:136], "little")
    last = 136 + size
    end = last + 8 + int.from_bytes(data[last + 4 : last + 8], "little")
    inside = bytearray(zlib.decompress(data[last + 8 : end]))
    inside[4:8] = b"\0" * 4  # a matrix of no bytes, and its bytes behind it
    packed = zlib.compress(bytes(inside))
    path.write_bytes(data[:last] + data[last : last + 4] + len(packed).to_bytes(4, "little") + packed + data[end:])
    found = load(Reader(), path, Source())
    assert [s.name for s in found.recording.signals] == ["T2"]
    assert any("bytes behind its end" in loss.reason for loss in found.losses)


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


@pytest.mark.parametrize("spoilt", ["name", "names", "rows"])
def test_a_data_set_that_declares_less_than_it_holds_is_a_loss(tmp_path: Path, spoilt: str) -> None:
    """Its count of rows is a number of the file like another, and nothing but what is stored contradicts it."""
    path = tmp_path / "x.mat"
    log, title = np.stack([np.arange(9.0)] * 3, 1), np.array([[ord(c)] for c in "T_front"], np.uint16)

    def write(less: str | None) -> list[str]:
        with h5py.File(path, "w", userblock_size=512) as file:
            places = {}

            def put(name: str, values: Any, kind: str, key: str | None = None, **more: Any) -> Any:
                item = file.create_dataset(name, data=values, **more)
                item.attrs["MATLAB_class"] = np.bytes_(kind)
                places[key] = (h5py.h5o.get_info(item.id).addr, values.shape)
                return item

            put("t", np.arange(9.0)[None, :], "double")
            put("speed", np.arange(9.0)[None, :] + 1, "double")
            put("log", log.T, "double", "rows", chunks=(1, 9), compression="gzip")
            cells = [[put(f"#refs#/r{k}", title + k, "char", "name" if k else None).ref] for k in range(3)]
            put("names", np.array(cells, h5py.ref_dtype), "cell", "names")
        data = bytearray(path.read_bytes())
        if less is not None:
            at, shape = places[less]
            old = b"".join(int(n).to_bytes(8, "little") for n in shape)
            found = data.index(old, 512 + at)  # in its header, the first that it tells
            data[found : found + 8] = (0 if less == "rows" else shape[0] - 1).to_bytes(8, "little")
        data[:128] = b"MATLAB 7.3 MAT-file".ljust(116) + b"\0" * 8 + b"\x00\x02IM"
        path.write_bytes(bytes(data))
        read = load(Reader(), path, Source(timezone="Europe/Prague"))
        return [f"{loss.where}: {loss.reason}" for loss in read.losses]

    assert write(None) == []
    (loss,) = write(spoilt)
    assert ("log" if spoilt == "rows" else "names") in loss
    assert "bytes and holds" in loss
