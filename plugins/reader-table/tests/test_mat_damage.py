"""Damaged MAT files: what is gone is told, and no number is made of it."""

from __future__ import annotations

import zlib
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
import scipy.io
from thermodata_reader_table import Reader

from thermodata.errors import FormatError
from thermodata.plugin import Source
from thermodata.testing.reader import Data, load

from .test_mat import WAVE, N, T, col, column, read


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


@pytest.mark.parametrize(
    ("said", "unit"), [(b"\xb0C", "°C"), ("°C".encode(), "°C"), (b"K", "K"), (b"\xef\xbf\xbdC", None), (b"raw", None)]
)
def test_a_unit_beside_an_array_is_read_in_latin_1_too_and_only_where_it_is_one(
    tmp_path: Path, said: bytes, unit: str | None
) -> None:
    path = tmp_path / "x.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in (("t", T), ("T1", WAVE)):
            file.create_dataset(name, data=values[None, :]).attrs["MATLAB_class"] = np.bytes_("double")
        file["T1"].attrs["units"] = np.bytes_(said)
    (signal,) = load(Reader(), path, Source()).recording.signals
    assert signal.unit == unit


def test_an_attribute_that_can_not_be_read_loses_nothing(tmp_path: Path) -> None:
    path = tmp_path / "x.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in (("t", T), ("T1", WAVE)):
            item = file.create_dataset(name, data=values[None, :])
            item.attrs["MATLAB_class"] = np.bytes_("double")
            h5py.h5a.create(item.id, b"stamp", h5py.h5t.UNIX_D32LE, h5py.h5s.create(h5py.h5s.SCALAR))
            item.attrs["unit"] = "s" if name == "t" else "um"
    data = load(Reader(), path, Source())
    assert data.losses == ()
    assert [(s.name, s.unit) for s in data.recording.signals] == [("T1", "um")]
    np.testing.assert_array_equal(column(data, "T1"), WAVE)
