"""MAT 5 (plain and packed) and 7.3: elements, dimensions, names, classes, links, chunks."""

from __future__ import annotations

import io
import random
import struct
import tempfile
import zlib
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from tests.fuzz.harness import Mutation, Seed, Source
from tests.fuzz.mutations import cut, edit_parts, flip, insert

READER = "table"
_N = 40
_PRAGUE = Source(timezone="Europe/Prague")
_LEAVES = {5: "numbers", 6: "numbers", 1: "text"}


def _column(values: Any) -> Any:
    return np.asarray(values)[:, None]


def _variables() -> dict[str, dict[str, Any]]:
    t = np.arange(_N) * 0.5
    wave = np.sin(t) * 40.0
    return {
        "vectors": {
            "t": _column(t),
            "T_front": _column(wave),
            "speed": _column((wave * 50).astype(np.int16)),
            "door": _column(wave > 0),
            "machine": "gantry 138",
            "serial": 4711.0,
        },
        "matrix": {"log": np.stack([t, wave, wave[::-1]], 1), "names": ["time [s]", "dZ [um]", "n [rpm]"]},
        "struct": {
            "run": {
                "time": _column(t),
                "Y": {"values": np.stack([wave, -wave], 1), "label": "probe"},
                "T": _column(wave),
            }
        },
        "records": {"ch": [{"name": f"T{i}", "unit": "degC", "dt": 0.5, "data": _column(wave + i)} for i in range(3)]},
        "dates": {"time": [f"2026-03-01 08:00:{i:02}" for i in range(_N)], "T": _column(wave)},
        "datenum": {"tm_time": _column(740000 + t / 86400), "T": _column(wave)},
    }


def _scipy(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: _scipy(v) for k, v in value.items()}
    if isinstance(value, list) and isinstance(value[0], dict):
        return np.array([tuple(_scipy(v) for v in x.values()) for x in value], [(k, object) for k in value[0]])
    return np.array(value, object) if isinstance(value, list) else value


def mat5(variables: dict[str, Any], *, packed: bool) -> bytes:
    import scipy.io

    out = io.BytesIO()
    scipy.io.savemat(out, _scipy(variables), do_compression=packed)
    return out.getvalue()


def mat73(variables: dict[str, Any]) -> bytes:
    """A file as MATLAB's -v7.3 writes it: a user block of 512 bytes, classes as attributes, cells as references."""
    import h5py

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "x.mat"
        with h5py.File(path, "w", userblock_size=512) as file:
            refs, count = file.create_group("#refs#"), [0]

            def classed(item: Any, kind: str) -> Any:
                item.attrs["MATLAB_class"] = np.bytes_(kind)
                return item

            def reference(value: Any) -> Any:
                count[0] += 1
                return put(refs, f"r{count[0]}", value).ref

            def put(parent: Any, name: str, value: Any) -> Any:
                if isinstance(value, dict):
                    group = classed(parent.create_group(name), "struct")
                    for key, inner in value.items():
                        put(group, key, inner)
                    return group
                if isinstance(value, str):
                    codes = np.array([ord(c) for c in value], np.uint16).reshape(-1, 1)
                    return classed(parent.create_dataset(name, data=codes), "char")
                if isinstance(value, list) and isinstance(value[0], dict):
                    group = classed(parent.create_group(name), "struct")
                    for key in value[0]:
                        group.create_dataset(
                            key, data=np.array([reference(x[key]) for x in value], h5py.ref_dtype).reshape(-1, 1)
                        )
                    return group
                if isinstance(value, list):
                    return classed(
                        parent.create_dataset(
                            name, data=np.array([reference(x) for x in value], h5py.ref_dtype).reshape(-1, 1)
                        ),
                        "cell",
                    )
                array = np.atleast_2d(np.asarray(value))
                kind = {"float64": "double", "bool": "logical"}.get(array.dtype.name, array.dtype.name)
                stored = array.astype(np.uint8) if kind == "logical" else array
                more = {"chunks": (1, 16), "compression": "gzip"} if array.size > 60 else {}
                return classed(parent.create_dataset(name, data=stored.T, **more), kind)

            for key, value in variables.items():
                put(file, key, value)
        data = bytearray(path.read_bytes())
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Mon Mar  2 08:00:00 2026 HDF5 schema 1.00 ."
    data[:128] = head.ljust(116) + b"\0" * 8 + b"\x00\x02IM"
    return bytes(data)


@lru_cache(maxsize=1)
def _seeds() -> tuple[Seed, ...]:
    made = []
    for name, variables in _variables().items():
        made += [
            Seed(f"{name}_plain.mat", mat5(variables, packed=False), _PRAGUE),
            Seed(f"{name}_packed.mat", mat5(variables, packed=True), _PRAGUE),
        ]
        if name != "dates":
            made.append(Seed(f"{name}_73.mat", mat73(variables), _PRAGUE))
    return tuple(made)


def seeds() -> list[Seed]:
    return list(_seeds())


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    if seed.name.endswith("_73.mat"):
        return _mutate73(seed, rng)
    data = seed.data
    what = rng.choice(
        ("cut", "variable", "tag", "tag", "head", "head", "element", "junk", "header", "huge", "order", "nest")
    )
    if what == "cut":
        return Mutation(cut(data, rng), "cut", False, False)
    if what == "header":
        return Mutation(flip(data, rng, 0, 116), "header text", True, False)
    if what == "order":
        return Mutation(flip(data, rng, 116, 128), "version or byte order", False, False)
    parts = _top(data)
    if what == "variable":
        edited, how = edit_parts(parts, rng)
        return Mutation(data[:128] + b"".join(edited), f"variable {how}", how != "doubled", False)
    if what == "junk":
        parts.insert(rng.randrange(len(parts) + 1), insert(b"", rng))
        return Mutation(data[:128] + b"".join(parts), "junk between variables", False, False)
    i = rng.randrange(len(parts))
    packed = struct.unpack("<I", parts[i][:4])[0] == 15
    if packed and rng.random() < 0.3:
        parts[i] = parts[i][:8] + flip(parts[i][8:], rng)
        return Mutation(data[:128] + b"".join(parts), "byte in packed data", False, False)
    inside = bytearray(zlib.decompress(parts[i][8:]) if packed else parts[i])
    touched, fine, kind = _edit(inside, what, rng)
    again = bytes(inside)
    if packed:
        squeezed = zlib.compress(again)
        again = struct.pack("<II", 15, len(squeezed)) + squeezed
    parts[i] = again
    return Mutation(data[:128] + b"".join(parts), kind, fine, touched)


def _top(data: bytes) -> list[bytes]:
    parts, at = [], 128
    while at < len(data):
        size = 8 + struct.unpack("<I", data[at + 4 : at + 8])[0]
        parts.append(data[at : at + size])
        at += size
    return parts


def _elements(data: bytes, at: int, stop: int, depth: int = 0) -> list[tuple[int, int, int, int, str]]:
    """(tag, start, stop, type, role) of all elements inside; role: matrix, flags, dims, name, data."""
    found = []
    place = 0
    while at < stop:
        kind, size = struct.unpack("<II", data[at : at + 8])
        small = kind >> 16
        start, end, after = (
            (at + 4, at + 4 + small, at + 8) if small else (at + 8, at + 8 + size, at + 8 + (size + 7) // 8 * 8)
        )
        role = "matrix" if kind == 14 else ("flags", "dims", "name")[place] if depth and place < 3 else "data"
        found.append((at, start, end, kind & 0xFFFF if small else kind, role))
        if kind == 14 and size:
            found += _elements(data, start, end, depth + 1)
        at, place = after, place + 1
    return found


def _edit(data: bytearray, what: str, rng: random.Random) -> tuple[bool, bool, str]:
    """Changes the elements of one variable; (values touched, well formed, kind)."""
    all_of = _elements(bytes(data), 0, len(data))
    tag, start, end, number, role = rng.choice(all_of)
    # a name or a word that is shortened, lost or doubled is another name
    renamed = role == "name" or (role == "data" and number not in range(3, 14))
    if what == "tag":
        at = tag + rng.randrange(8 if start - tag == 8 else 4)
        data[at] = rng.randrange(256)
        # another type of number reads the same bytes as other values
        return role == "data", renamed, f"tag of {role}"
    if what == "huge":
        struct.pack_into("<I", data, tag + 4 if start - tag == 8 else tag, rng.choice((0, 2**31, 2**32 - 1, 2**24)))
        return start - tag != 8, renamed, f"size of {role}"
    if what == "nest":
        data[:] = bytes(data[:tag]) + struct.pack("<II", 14, 8) * rng.choice((1, 100, 20000)) + bytes(data[tag:])
        return False, False, "nested matrices"
    if what == "element":
        data[tag:end] = b"" if rng.random() < 0.5 else bytes(data[tag:end]) * 2
        # a whole variable less is an honest file, and so are other names in a cell of names
        return role == "matrix" and tag > 0, renamed or tag == 0, f"{role} element dropped or doubled"
    heads = [e for e in all_of if e[4] in ("flags", "dims", "name") and e[2] > e[1]]
    tag, start, end, _, role = rng.choice(heads)
    at = rng.randrange(start, end)
    data[at] = rng.choice((0, 1, 2, 255, rng.randrange(256)))
    # a name changed is another name; a matrix turned to others of the same size is a matrix still
    inner = role == "flags" and tag > 16  # a name of another class is no name
    return role == "dims", role == "name" or inner, f"{role} changed"


@lru_cache(maxsize=64)
def _values73(data: bytes) -> tuple[list[tuple[int, int]], list[tuple[int, int]]]:
    """(bytes of values, bytes of names and text) in an HDF5 file."""
    import h5py

    values: list[tuple[int, int]] = []
    words: list[tuple[int, int]] = []
    with h5py.File(io.BytesIO(data), "r") as file:

        def visit(name: str, item: Any) -> None:
            for part in name.encode().split(b"/"):
                at = data.find(part + b"\0")
                while at >= 0:
                    words.append((at, at + len(part)))
                    at = data.find(part + b"\0", at + 1)
            if not isinstance(item, h5py.Dataset):
                return
            into = words if item.attrs.get("MATLAB_class") == b"char" else values
            if item.chunks:
                for i in range(item.id.get_num_chunks()):
                    chunk = item.id.get_chunk_info(i)
                    into.append((chunk.byte_offset, chunk.byte_offset + chunk.size))
            elif item.id.get_offset() is not None:
                into.append((item.id.get_offset(), item.id.get_offset() + item.id.get_storage_size()))

        file.visititems(visit)
    return values, words


def _mutate73(seed: Seed, rng: random.Random) -> Mutation:
    data = seed.data
    what = rng.choice(("cut", "flip", "flip", "flip", "flip", "header", "junk", "huge", "swap"))
    if what == "cut":
        return Mutation(cut(data, rng), "7.3 cut", False, False)
    if what == "header":
        return Mutation(flip(data, rng, 0, 512), "7.3 user block", True, False)
    if what == "junk":
        return Mutation(insert(data, rng), "7.3 junk", False, True)
    values, words = _values73(data)
    at = rng.randrange(512, len(data) - 8)
    changed, width = bytearray(data), 1 if what == "flip" else 8
    touched = [at - at % width]
    if what == "huge":
        changed[touched[0] : touched[0] + 8] = struct.pack("<Q", rng.choice((0, 2**63, 2**64 - 1, 2**32, len(data), 1)))
    elif what == "swap":
        touched.append(rng.randrange(64, len(data) // 8 - 1) * 8)
        for to, of in (touched, reversed(touched)):
            changed[to : to + 8] = data[of : of + 8]
    else:
        changed[at] = rng.randrange(256)

    def reaches(parts: list[tuple[int, int]]) -> bool:
        return any(a < spot + width and spot < b for a, b in parts for spot in touched)

    where = "values" if reaches(values) else "text" if reaches(words) else "structure"
    return Mutation(bytes(changed), f"7.3 {what} in {where}", reaches(words), reaches(values))
