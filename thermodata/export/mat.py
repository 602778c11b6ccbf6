"""A test as a MAT file: vectors by channel name beside `time`, and structs that describe them.

Version 5 (MATLAB's -v7), which every program reads; 7.3 (HDF5, by h5py) where a variable passes its 2 GiB.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from thermodata.errors import UsageError
from thermodata.export.content import Content, Stream
from thermodata.schema.words.numbered import numbered

MOST_BYTES = (1 << 31) - (1 << 20)  # of all variables in a file of version 5
TIME_EPOCH = "time_epoch"
_NAME = 63  # characters of a name in MATLAB
_ABOUT = ("about", TIME_EPOCH)  # what stands at the top beside the streams
_BESIDE = ("time", "units", "channels", "flags")  # and beside the channels of each


def variables(content: Content) -> dict[str, Any]:
    """The file's variables: one stream stands at the top, several are structs; numbers are columns of shape (n, 1)."""
    if len(content.streams) == 1:
        found = _stream(content, content.streams[0], _ABOUT)
    else:
        names = _named([s.name for s in content.streams], _ABOUT)
        found = {name: _stream(content, s) for name, s in zip(names, content.streams, strict=True)}
    about: dict[str, Any] = dict(content.about)
    about["step"] = content.step
    if content.start_ns is not None:
        # MATLAB: datetime(about.start_posix, 'ConvertFrom', 'posixtime', 'TimeZone', 'UTC')
        about["start_utc"] = _iso(content.start_ns)
        about["start_posix"] = content.start_ns / 1e9
        # what `time` counts from: readers that know the word date it, and so does MATLAB:
        # datetime(time_epoch, 'InputFormat', 'uuuu-MM-dd''T''HH:mm:ss.SSSSSSSSSX', 'TimeZone', 'UTC') + seconds(time)
        found[TIME_EPOCH] = about["start_utc"]
    if content.conditions:
        conditions = dict(zip(content.conditions, _named(list(content.conditions)), strict=True))
        about["conditions"] = {conditions[k]: v for k, v in content.conditions.items()}
        if content.condition_units:
            about["condition_units"] = {conditions[k]: v for k, v in content.condition_units.items()}
    about["flag_bits"] = flag_bits()
    found["about"] = about
    return found


def _stream(content: Content, stream: Stream, beside: Sequence[str] = ()) -> dict[str, Any]:
    """beside: names of what else stands there."""
    names = dict(zip(stream.values, _named(list(stream.values), (*_BESIDE, *beside)), strict=True))
    found: dict[str, Any] = {"time": stream.t_s[:, None]}
    for name, values in stream.values.items():
        found[names[name]] = list(values) if values.dtype == object else values[:, None]
    found["units"] = {"time": "s", **{names[n]: content.unit(n) for n in stream.values if content.unit(n)}}
    found["channels"] = {names[n]: dict(content.channels[n]) for n in stream.values if n in content.channels}
    if stream.flags:
        found["flags"] = {names[n]: bits[:, None] for n, bits in stream.flags.items()}
    return {k: v for k, v in found.items() if not (isinstance(v, dict) and not v)}


def _named(names: Sequence[str], taken: Sequence[str] = ()) -> list[str]:
    """The names as MATLAB takes them, in their order: one that is taken, or another's too, has a number, 'time_2'."""
    found: list[str] = []
    for name in names:
        found.append(numbered(_safe(name), lambda one: one in taken or one in found, "_"))
    return found


def flag_bits() -> str:
    from thermodata.schema.flag import Flag

    return ", ".join(f"{int(f)} {f.word.replace('_', ' ')}" for f in Flag if f)


def _safe(name: str) -> str:
    """A name that MATLAB takes; UsageError where two words would have to be cut to fit."""
    safe = re.sub(r"\W", "_", name, flags=re.ASCII)
    safe = safe if re.match(r"[A-Za-z]", safe) else f"x{safe}"
    if len(safe) > _NAME:
        raise UsageError(
            "a name is too long for MATLAB",
            where=name,
            expected=f"at most {_NAME} characters",
            got=str(len(safe)),
            hint="export CSV or Parquet",
        )
    return safe


def _iso(ns: int) -> str:
    return datetime.fromtimestamp(ns // 1_000_000_000, UTC).strftime("%Y-%m-%dT%H:%M:%S") + f".{ns % 10**9:09d}Z"


def size_of(found: Mapping[str, Any]) -> int:
    """Bytes of all arrays and texts."""
    total = 0
    for value in found.values():
        if isinstance(value, Mapping):
            total += size_of(value)
        elif isinstance(value, np.ndarray):
            total += value.nbytes
        else:
            total += sum(64 + 2 * len(v) for v in value) if isinstance(value, list) else 64
    return total


def write_mat(content: Content, path: Path) -> None:
    """Writes version 5, or 7.3 where that is too small. UsageError where 7.3 is needed and h5py is not there."""
    found = variables(content)
    if size_of(found) > MOST_BYTES:
        _write73(found, path)
        return
    import scipy.io

    with path.open("wb") as file:
        scipy.io.savemat(file, _cells(found), do_compression=True, long_field_names=True)


def _cells(found: Mapping[str, Any]) -> dict[str, Any]:
    """Lists of text as MATLAB's cells."""
    out: dict[str, Any] = {}
    for key, value in found.items():
        if isinstance(value, Mapping):
            out[key] = _cells(value)
        elif isinstance(value, list):
            cells = np.empty((len(value), 1), object)
            cells[:, 0] = value
            out[key] = cells
        else:
            out[key] = value
    return out


def _write73(found: Mapping[str, Any], path: Path) -> None:
    try:
        import h5py
    except ImportError:
        raise UsageError(
            "the test is too large for a MAT file of version 5",
            expected=f"at most {MOST_BYTES} bytes",
            got=str(size_of(found)),
            hint="a longer --step, or pip install h5py for version 7.3",
        ) from None
    with h5py.File(path, "w", userblock_size=512) as file:
        _Writer(file).struct(file, found)
    with path.open("r+b") as raw:
        head = f"MATLAB 7.3 MAT-file, Platform: thermodata, Created on: {datetime.now(UTC):%a %b %d %H:%M:%S %Y} HDF5 "
        raw.write((head + "schema 1.00 .").encode().ljust(116) + b"\0" * 8 + b"\x00\x02IM")


class _Writer:
    """Variables as MATLAB lays them in HDF5: turned, with their class as an attribute, cells by reference."""

    def __init__(self, file: Any) -> None:
        self.file, self.count = file, 0

    def struct(self, group: Any, found: Mapping[str, Any]) -> None:
        for key, value in found.items():
            if isinstance(value, Mapping):
                inner = group.create_group(key)
                inner.attrs["MATLAB_class"] = np.bytes_("struct")
                self.struct(inner, value)
            elif isinstance(value, list):
                self.cells(group, key, value)
            elif isinstance(value, str):
                self.text(group, key, value)
            else:
                self.numbers(group, key, np.atleast_2d(np.asarray(value)))

    def numbers(self, group: Any, key: str, values: Any) -> Any:
        kind = {"float64": "double", "float32": "single"}.get(values.dtype.name, values.dtype.name)
        more: dict[str, Any] = (
            {"chunks": (1, 65536), "compression": "gzip", "shuffle": True} if values.shape[0] > 65536 else {}
        )
        made = group.create_dataset(key, data=values.T, **more)
        made.attrs["MATLAB_class"] = np.bytes_(kind)
        return made

    def text(self, group: Any, key: str, value: str) -> Any:
        codes = np.frombuffer(value.encode("utf-16-le"), "<u2").reshape(-1, 1)
        made = group.create_dataset(key, data=codes if codes.size else np.array([0, 0], np.uint64))
        made.attrs["MATLAB_class"] = np.bytes_("char")
        made.attrs["MATLAB_int_decode"] = np.int32(2)
        if not codes.size:
            made.attrs["MATLAB_empty"] = np.uint8(1)
        return made

    def cells(self, group: Any, key: str, values: list[str]) -> None:
        import h5py

        store = self.file.require_group("#refs#")
        known: dict[str, Any] = {}
        references = []
        for value in values:
            if value not in known:
                self.count += 1
                known[value] = self.text(store, f"c{self.count}", value).ref
            references.append(known[value])
        made = group.create_dataset(key, data=np.array([references], h5py.ref_dtype))
        made.attrs["MATLAB_class"] = np.bytes_("cell")
