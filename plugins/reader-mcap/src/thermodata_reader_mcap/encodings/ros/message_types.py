"""The types of ROS messages, and the parser of their definitions as text (ros1msg, ros2msg)."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

# name -> numpy's letter; bytes = the letter's number
PRIMITIVES = {
    "bool": "?",
    "byte": "u1",
    "char": "u1",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "int64": "i8",
    "uint64": "u8",
    "float32": "f4",
    "float64": "f8",
}
ROS1 = {"byte": "i1", "char": "u1"}
TEXTS = frozenset({"string"})


class TypeTextError(Exception):
    """A definition that does not parse; the message says where."""


class LineError(TypeTextError):
    """A line of a definition whose words are in no order that we know."""


@dataclass(frozen=True, slots=True)
class Field:
    """kind: numpy's letter, "string", or the name of a struct. fixed: elements of an array of one length;
    sequence: an array that says its length."""

    name: str
    kind: str
    fixed: int | None = None
    sequence: bool = False


@dataclass(frozen=True, slots=True)
class Types:
    """structs: full name -> fields. root: the name of the message itself."""

    root: str
    structs: Mapping[str, tuple[Field, ...]]


_LINE = re.compile(r"([A-Za-z][\w/]*)(<=\d+)?\s*(?:\[(<=)?(\d*)\])?\s+([A-Za-z_]\w*)\s*(.*)", re.ASCII)
_BREAK = re.compile(r"^={3,}[ \t]*$", re.MULTILINE)
_STAMPS = (Field("sec", "i4"), Field("nanosec", "u4"))
_BUILT_IN = {"builtin_interfaces/Time": _STAMPS, "builtin_interfaces/Duration": _STAMPS}
_ROS1_BUILT_IN = {
    "time": (Field("secs", "u4"), Field("nsecs", "u4")),
    "duration": (Field("secs", "i4"), Field("nsecs", "i4")),
}


def short(name: str) -> str:
    """'std_msgs/msg/Header' and 'std_msgs::msg::Header' are 'std_msgs/Header'."""
    parts = name.replace("::", "/").strip("/").split("/")
    return "/".join([parts[0], parts[-1]]) if len(parts) > 1 else parts[0]


def message_types(name: str, text: str, ros1: bool) -> Types:
    """The types of a concatenated message definition. TypeTextError."""
    structs: dict[str, tuple[Field, ...]] = dict(_ROS1_BUILT_IN if ros1 else _BUILT_IN)
    for k, part in enumerate(_BREAK.split(text)):
        own = name
        if k:
            head, _, part = part.strip().partition("\n")
            if not head.startswith("MSG:"):
                raise TypeTextError(f"expected 'MSG: name' behind a line of =, got {head[:40]!r}")
            own = head[4:].strip()
        structs[short(own)] = _fields(part, short(own).split("/")[0], ros1)
    return Types(short(name), resolved(structs))


def _fields(text: str, package: str, ros1: bool) -> tuple[Field, ...]:
    found: list[Field] = []
    for number, line in enumerate(text.splitlines(), 1):
        line = line.split("#", 1)[0].strip()
        if not line or line.startswith("@"):
            continue
        match = _LINE.fullmatch(line)
        if match is None:
            raise LineError(f"line {number} of a definition: {line[:60]!r}")
        kind, _, bound, count, name, rest = match.groups()
        if rest.startswith("="):
            continue  # a constant
        array = count is not None
        found.append(
            Field(
                name,
                _kind(kind, package, ros1),
                int(count) if array and count and not bound else None,
                array and (not count or bool(bound)),
            )
        )
    return tuple(found)


def _kind(kind: str, package: str, ros1: bool) -> str:
    if kind in PRIMITIVES:
        return ROS1.get(kind, PRIMITIVES[kind]) if ros1 else PRIMITIVES[kind]
    if kind in TEXTS or (ros1 and kind in _ROS1_BUILT_IN):
        return kind
    if kind == "wstring":
        raise TypeTextError("wstring is stored in different ways by different writers")
    if kind == "Header":
        return "std_msgs/Header"
    return short(kind) if "/" in kind else f"{package}/{kind}"


def resolved(structs: Mapping[str, tuple[Field, ...]]) -> Mapping[str, tuple[Field, ...]]:
    """The same, once every named type is there and none holds itself."""

    def check(name: str, above: tuple[str, ...]) -> None:
        if name in above:
            raise TypeTextError(f"{name} holds itself")
        if name not in structs:
            raise TypeTextError(f"the type {name} is not defined")
        if name in done:
            return
        for f in structs[name]:
            if is_struct(f.kind):
                check(f.kind, (*above, name))
        done.add(name)

    done = set[str]()
    for name in structs:
        check(name, ())
    return structs


def is_struct(kind: str) -> bool:
    """Whether a field's kind is the name of a struct."""
    return kind not in _LETTERS


_LETTERS = frozenset(PRIMITIVES.values()) | TEXTS
