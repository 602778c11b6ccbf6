"""TDMS: files of every layout, made field by field, so that a mutation knows what it hits."""

from __future__ import annotations

import random
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tests.fuzz.harness import Mutation, Seed
from tests.fuzz.mutations import cut, flip, insert

READER = "crio"
CODES = {
    "i1": 1,
    "i2": 2,
    "i4": 3,
    "i8": 4,
    "u1": 5,
    "u2": 6,
    "u4": 7,
    "f4": 9,
    "f8": 10,
    "b1": 0x21,
    "stamp": 0x44,
    "text": 0x20,
    "c16": 0x10000D,
}
SIZES = {
    1: 1,
    2: 2,
    3: 4,
    4: 8,
    5: 1,
    6: 2,
    7: 4,
    8: 8,
    9: 4,
    10: 8,
    0x19: 4,
    0x1A: 8,
    0x21: 1,
    0x44: 16,
    0x08000C: 8,
    0x10000D: 16,
}
NOTHING, AS_BEFORE = 0xFFFFFFFF, 0
START_S = 3_855_000_000  # since 1904: in 2026


@dataclass(frozen=True)
class Field:
    """A few bytes with one meaning. segment: its number; about: the property's name, where it is of one."""

    role: str
    segment: int
    data: bytes
    about: str = ""


class Maker:
    """Builds the fields of one file."""

    def __init__(self, order: str = "<") -> None:
        self.order = order
        self.fields: list[Field] = []
        self.segment = -1

    def add(self, role: str, code: str, *values: Any, about: str = "") -> None:
        self.fields.append(Field(role, self.segment, struct.pack(self.order + code, *values), about))

    def text(self, role: str, text: str, about: str = "") -> None:
        raw = text.encode()
        self.add(f"{role} length", "I", len(raw), about=about)
        self.fields.append(Field(role, self.segment, raw, about))

    def property(self, name: str, value: Any) -> None:
        self.text("property name", name, name)
        if isinstance(value, str):
            self.add("property type", "I", 0x20, about=name)
            self.text("property text", value, name)
        elif isinstance(value, tuple):
            self.add("property type", "I", 0x44, about=name)
            self.add(
                "property value",
                "Qq" if self.order == "<" else "qQ",
                *(value[::-1] if self.order == "<" else value),
                about=name,
            )
        elif isinstance(value, float):
            self.add("property type", "I", 10, about=name)
            self.add("property value", "d", value, about=name)
        else:
            self.add("property type", "I", 7, about=name)
            self.add("property value", "I", value, about=name)

    def object(self, path: str, index: Callable[[], None], properties: dict[str, Any] | None = None) -> None:
        self.text("path", path)
        index()
        self.add("properties", "I", len(properties or {}))
        for name, value in (properties or {}).items():
            self.property(name, value)

    def plain(self, dtype: str, n: int, nbytes: int = 0) -> Callable[[], None]:
        def write() -> None:
            self.add("index header", "I", 28 if dtype == "text" else 20)
            self.add("type", "I", CODES[dtype])
            self.add("dimension", "I", 1)
            self.add("n", "Q", n)
            if dtype == "text":
                self.add("text bytes", "Q", nbytes)

        return write

    def word(self, value: int) -> Callable[[], None]:
        return lambda: self.add("index header", "I", value)

    def daqmx(
        self,
        n: int,
        scalers: Sequence[tuple[int, int, int, int]],
        widths: Sequence[int],
        digital: bool = False,
        kind: int = 0xFFFFFFFF,
    ) -> Callable[[], None]:
        def write() -> None:
            self.add("index header", "I", 0x126A if digital else 0x1269)
            self.add("type", "I", kind)
            self.add("dimension", "I", 1)
            self.add("n", "Q", n)
            self.add("scalers", "I", len(scalers))
            for code, buffer, offset, scale in scalers:
                for role, value in (("scaler type", code), ("scaler buffer", buffer), ("scaler offset", offset)):
                    self.add(role, "I", value)
                self.add("scaler bitmap", "B" if digital else "I", 0)
                self.add("scaler id", "I", scale)
            self.add("widths", "I", len(widths))
            for width in widths:
                self.add("width", "I", width)

        return write

    def put(
        self, objects: Sequence[Callable[[], None]] | None, raw: bytes, *, flags: int = 0, new: bool = True
    ) -> None:
        """A segment. flags: interleaved 32, DAQmx 128."""
        self.segment += 1
        before = self.fields
        self.fields = []
        if objects is not None:
            self.add("objects", "I", len(objects))
            for write in objects:
                write()
        meta, self.fields = self.fields, before
        size = sum(len(f.data) for f in meta)
        toc = flags | (2 if objects is not None else 0) | (4 if new and objects is not None else 0) | (8 if raw else 0)
        self.fields.append(Field("tag", self.segment, b"TDSm"))
        self.fields.append(Field("toc", self.segment, struct.pack("<I", toc | (64 if self.order == ">" else 0))))
        self.add("version", "I", 4713)
        self.add("to next", "Q", size + len(raw))
        self.add("to raw", "Q", size)
        self.fields += meta
        self.fields.append(Field("raw", self.segment, raw))


def wave(step: float = 0.1, start_s: int = START_S, **more: Any) -> dict[str, Any]:
    return {"wf_start_time": (start_s, 1 << 62), "wf_start_offset": 0.0, "wf_increment": step, **more}


def _plain(rng: Any, order: str = "<", interleaved: bool = False, repeat: bool = True) -> Maker:
    make = Maker(order)
    for k in range(4):
        z, y = rng.normal(size=7).astype(order + "f8"), rng.integers(-999, 999, 7).astype(order + "i2")
        raw = (
            b"".join(z[i : i + 1].tobytes() + y[i : i + 1].tobytes() for i in range(7))
            if interleaved
            else z.tobytes() + y.tobytes()
        )
        objects = [
            lambda: make.object("/", make.word(NOTHING), {"operator": "měřič"}),
            lambda: make.object("/'Eddy'", make.word(NOTHING)),
            lambda: make.object("/'Eddy'/'Z'", make.plain("f8", 7), wave(unit_string="V")),
            lambda: make.object("/'Eddy'/'Y/''1'''", make.plain("i2", 7), wave()),
        ]
        make.put(objects if repeat or not k else None, raw, flags=32 if interleaved else 0)
    return make


def _lists(rng: Any) -> Maker:
    """Chunks, indexes as before, channels without data, one that comes late."""
    make, f = Maker(), rng.normal
    make.put(
        [
            lambda: make.object("/'g'/'a'", make.plain("f4", 3), wave()),
            lambda: make.object("/'g'/'b'", make.plain("f4", 3), wave()),
        ],
        f(size=18).astype("f4").tobytes(),
    )
    make.put(
        [lambda: make.object("/'g'/'a'", make.word(AS_BEFORE)), lambda: make.object("/'g'/'b'", make.word(NOTHING))],
        f(size=6).astype("f4").tobytes(),
    )
    make.put([lambda: make.object("/'g'/'b'", make.word(AS_BEFORE))], f(size=6).astype("f4").tobytes(), new=False)
    make.put(
        [lambda: make.object("/'g'/'late'", make.plain("u4", 2), wave(1.0))],
        f(size=6).astype("f4").tobytes() + rng.integers(0, 99, 2).astype("u4").tobytes(),
        new=False,
    )
    return make


def _stamps(rng: Any) -> Maker:
    """A timestamp channel as the time of numbers, bools and text."""
    make = Maker()
    for k in range(3):
        words = [f"ř{k}{i}" * (1 + i) for i in range(5)]
        ends = np.cumsum([len(w.encode()) for w in words]).astype("<u4")
        text = ends.tobytes() + "".join(words).encode()
        size, stamps = len(text), b"".join(struct.pack("<Qq", (i * 12345) << 40, START_S + 5 * k + i) for i in range(5))
        make.put(
            [
                lambda: make.object("/'log'/'when'", make.plain("stamp", 5)),
                lambda: make.object("/'log'/'T'", make.plain("f8", 5), {"unit_string": "°C"}),
                lambda: make.object("/'log'/'door'", make.plain("b1", 5)),
                lambda size=size: make.object("/'log'/'state'", make.plain("text", 5, size)),
            ],  # type: ignore[misc]
            stamps + rng.normal(size=5).tobytes() + rng.integers(0, 2, 5).astype("u1").tobytes() + text,
        )
    return make


def _seconds(rng: Any) -> Maker:
    """Seconds since 1904 in a channel of doubles."""
    make = Maker()
    for k in range(3):
        t = START_S + np.arange(6.0) + 6 * k
        make.put(
            [
                lambda: make.object("/'abs'/'Time'", make.plain("f8", 6), {"unit_string": "s"}),
                lambda: make.object("/'abs'/'x'", make.plain("f8", 6)),
            ],
            t.tobytes() + rng.normal(size=6).tobytes(),
        )
    return make


def _relative(rng: Any) -> Maker:
    """Seconds from the start in a channel of their own."""
    make = Maker()
    for k in range(3):
        make.put(
            [
                lambda: make.object("/'rel'/'Time'", make.plain("f4", 6)),
                lambda: make.object("/'rel'/'y'", make.plain("i8", 6)),
            ],
            np.arange(6 * k, 6 * k + 6, dtype="f4").tobytes() + rng.integers(-(9**9), 9**9, 6).astype("i8").tobytes(),
        )
    return make


def _daqmx(rng: Any) -> Maker:
    """Two buffers: analog with a linear scale, a thermocouple with its cold junction, digital lines."""
    make = Maker()
    linear = {
        "NI_Scaling_Status": "unscaled",
        "NI_Number_Of_Scales": 2,
        "NI_Scale[1]_Scale_Type": "Linear",
        "NI_Scale[1]_Linear_Slope": 0.25,
        "NI_Scale[1]_Linear_Y_Intercept": 1.0,
        "NI_Scale[1]_Linear_Input_Source": 0,
    }
    both = {
        "NI_Scaling_Status": "unscaled",
        "NI_Number_Of_Scales": 3,
        "NI_Scale[2]_Scale_Type": "Add",
        "NI_Scale[2]_Add_Left_Operand_Input_Source": 0,
        "NI_Scale[2]_Add_Right_Operand_Input_Source": 1,
    }
    for k in range(3):
        raw = rng.integers(0, 255, 5 * 6 + 5 * 2).astype("u1").tobytes()
        objects = [
            lambda: make.object("/'d'/'U'", make.daqmx(5, [(3, 0, 0, 0)], [6, 2]), {**wave(), **linear}),
            lambda: make.object("/'d'/'T'", make.daqmx(5, [(3, 0, 0, 0), (5, 0, 2, 1)], [6, 2]), {**wave(), **both}),
            lambda: make.object("/'d'/'line3'", make.daqmx(5, [(0, 1, 3, 0)], [6, 2], digital=True), wave()),
        ]
        make.put(objects if not k else None, raw, flags=128 | 32)
    return make


def _rates(rng: Any) -> Maker:
    """Groups with rates and starts of their own, complex numbers, and rows without any time."""
    make = Maker()
    for _ in range(3):
        make.put(
            [
                lambda: make.object("/'fast'/'a'", make.plain("f4", 8), wave(0.01)),
                lambda: make.object("/'fast'/'c'", make.plain("c16", 8), wave(0.01)),
                lambda: make.object("/'slow'/'b'", make.plain("i4", 2), wave(1.0, START_S + 7)),
                lambda: make.object("/'none'/'n'", make.plain("u2", 3)),
            ],
            rng.normal(size=8).astype("f4").tobytes()
            + rng.normal(size=16).tobytes()
            + rng.integers(-(9**5), 9**5, 2).astype("i4").tobytes()
            + rng.integers(0, 9**4, 3).astype("u2").tobytes(),
        )
    return make


MAKERS: dict[str, Callable[[Any], Maker]] = {
    "plain": _plain,
    "big": lambda r: _plain(r, ">"),
    "interleaved": lambda r: _plain(r, "<", True, False),
    "lists": _lists,
    "stamps": _stamps,
    "seconds": _seconds,
    "relative": _relative,
    "daqmx": _daqmx,
    "rates": _rates,
}
FIELDS = {f"{name}.tdms": make(np.random.default_rng(5)).fields for name, make in MAKERS.items()}
# each row carries its time, so that lost segments move nothing
OWN_TIME = ("stamps.tdms", "seconds.tdms", "relative.tdms")
NUMBERS = (
    0,
    1,
    2,
    3,
    4,
    5,
    7,
    8,
    20,
    28,
    100,
    1000,
    0xFFFF,
    0x7FFFFFFF,
    0xFFFFFFFF,
    2**32,
    2**40,
    2**62,
    2**63,
    2**64 - 1,
)


def seeds() -> list[Seed]:
    return [Seed(name, _join(fields)) for name, fields in FIELDS.items()]


def _join(fields: Sequence[Field]) -> bytes:
    return b"".join(f.data for f in fields)


def mutate(seed: Seed, rng: random.Random) -> Mutation:
    fields = FIELDS[seed.name]
    kind = rng.choices(("cut", "field", "bytes", "segment", "junk", "nul", "raw length"), (3, 8, 3, 3, 3, 2, 2))[0]
    return {
        "cut": _cut,
        "field": _field,
        "bytes": _bytes,
        "segment": _segment,
        "junk": _junk,
        "nul": _nul,
        "raw length": _raw,
    }[kind](seed, fields, rng)


def _cut(seed: Seed, fields: list[Field], rng: random.Random) -> Mutation:
    # between two segments a file ends honestly
    data = cut(seed.data, rng)
    at, honest = 0, {0}
    for f in fields:
        at += len(f.data)
        honest |= {at} if f.role == "raw" else set()
    return Mutation(data, "cut", len(data) in honest, False)


def _segment(seed: Seed, fields: list[Field], rng: random.Random) -> Mutation:
    """A segment that goes, comes twice, or changes its place. What counts rows then has other times; a list of
    objects that others reuse may go with it."""
    many = fields[-1].segment + 1
    parts = [_join([f for f in fields if f.segment == i]) for i in range(many)]
    i, j = rng.sample(range(many), 2)
    what = rng.choice(("dropped", "doubled", "swapped"))
    if what == "dropped":
        del parts[i]
    elif what == "doubled":
        parts.insert(j, parts[i])
    else:
        parts[i], parts[j] = parts[j], parts[i]
    return Mutation(b"".join(parts), f"segment {what}", True, seed.name not in OWN_TIME)


def _field(seed: Seed, fields: list[Field], rng: random.Random) -> Mutation:
    """One field with another value."""
    at = rng.choice([i for i, f in enumerate(fields) if f.role != "raw" and f.data])
    f = fields[at]
    if f.role in ("path", "property name", "property text", "tag") or rng.random() < 0.3:
        data = flip(f.data, rng, most=2)
    else:
        order = "<" if f.role == "toc" or not seed.name.startswith("big") else ">"
        number = (
            rng.choice(NUMBERS)
            if rng.random() < 0.6
            else int.from_bytes(f.data, "little" if order == "<" else "big")
            + rng.choice((-8, -2, -1, 1, 2, 4, 8, 16, 64))
        )
        data = (number % 2 ** (8 * len(f.data))).to_bytes(len(f.data), "little" if order == "<" else "big")
    mutated = [*fields[:at], replace(f, data=data), *fields[at + 1 :]]
    return Mutation(_join(mutated), f.role, f.role == "path", _undecidable(fields, mutated, at))


def _undecidable(old: list[Field], new: list[Field], at: int) -> bool:
    """Whether the file says something else that is as sound as what it said: another start or rate, another type of
    the same size, chunks of another length that fill the segment as well, ..."""
    f = old[at]
    if f.role == "toc":
        return bool(f.data[0] & 2)  # with metadata, nothing contradicts a flag of the raw data
    if f.role == "type":
        order = "big" if old is FIELDS["big.tdms"] else "little"
        was, now = (SIZES.get(int.from_bytes(g.data, order)) for g in (f, new[at]))  # type: ignore[arg-type]
        return was == now
    return f.role in ("property value", "property name", "property type", "property text", "path") or f.role.startswith(
        "scaler "
    )


def _bytes(seed: Seed, fields: list[Field], rng: random.Random) -> Mutation:
    """Random bytes overwritten in lead-ins or metadata."""
    segment = rng.randrange(fields[-1].segment + 1)
    begin = sum(len(f.data) for f in fields if f.segment < segment)
    end = begin + sum(len(f.data) for f in fields if f.segment == segment and f.role != "raw")
    return Mutation(flip(seed.data, rng, begin, end), "bytes", False, True)


def _junk(seed: Seed, fields: list[Field], rng: random.Random) -> Mutation:
    """Bytes put between two fields."""
    at = rng.randrange(len(fields) + 1)
    place = sum(len(f.data) for f in fields[:at])
    between = at == len(fields) or fields[at].role == "tag"
    return Mutation(
        insert(seed.data, rng, place), "junk between segments" if between else "junk between fields", False, False
    )


def _nul(seed: Seed, fields: list[Field], rng: random.Random) -> Mutation:
    """A lead-in, its metadata, or both, overwritten with zeros, as a lost disk block leaves it."""
    segment = rng.randrange(fields[-1].segment + 1)
    roles = {"tag", "toc", "version", "to next", "to raw"}
    lead = rng.random() < 0.7
    chosen = [f.segment == segment and f.role != "raw" and (f.role in roles) == lead for f in fields]
    data = b"".join(bytes(len(f.data)) if hit else f.data for f, hit in zip(fields, chosen, strict=True))
    return Mutation(data, "zeroed lead-in" if lead else "zeroed metadata", False, False)


def _raw(seed: Seed, fields: list[Field], rng: random.Random) -> Mutation:
    """Raw data that lost or gained some bytes, with a length that tells, or with one that does not."""
    at = rng.choice([i for i, f in enumerate(fields) if f.role == "raw"])
    f = fields[at]
    n = rng.randrange(1, len(f.data))
    place = rng.randrange(len(f.data) - n + 1)
    data = f.data[:place] + f.data[place + n :] if rng.random() < 0.6 else insert(f.data, rng, place)
    return Mutation(_join([*fields[:at], replace(f, data=data), *fields[at + 1 :]]), "raw length", False, False)
