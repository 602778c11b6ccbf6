"""The parser of interface definitions (ros2idl): the part of OMG IDL that message types use."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from thermodata_reader_mcap.encodings.ros.message_types import Field, Types, TypeTextError, is_struct, resolved, short

_TOKEN = re.compile(
    r'"(?:[^"\\]|\\.)*"|\'(?:[^\'\\]|\\.)*\'|::|'
    r"[A-Za-z_]\w*|\d[\w.+-]*|[{}<>();,\[\]=@:*/+|&~^%-]",
    re.ASCII,
)
_COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/|^[ \t]*#[^\n]*|^=+[ \t]*\n[ \t]*IDL:[^\n]*", re.DOTALL | re.MULTILINE)
_BASIC = {
    "boolean": "?",
    "octet": "u1",
    "char": "u1",
    "short": "i2",
    "long": "i4",
    "long long": "i8",
    "unsigned short": "u2",
    "unsigned long": "u4",
    "unsigned long long": "u8",
    "float": "f4",
    "double": "f8",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "int64": "i8",
    "uint64": "u8",
    "string": "string",
}


@dataclass(slots=True)
class _Parser:
    tokens: list[str]
    at: int = 0
    structs: dict[str, list[Field]] = field(default_factory=dict)
    aliases: dict[str, Field] = field(default_factory=dict)
    constants: dict[str, int] = field(default_factory=dict)

    def peek(self) -> str:
        return self.tokens[self.at] if self.at < len(self.tokens) else ""

    def next(self, wanted: str | None = None) -> str:
        token = self.peek()
        if not token or (wanted is not None and token != wanted):
            got = " ".join(self.tokens[self.at : self.at + 5])
            raise TypeTextError(f"IDL: expected {wanted or 'more'!r}, got {got!r}")
        self.at += 1
        return token

    def definitions(self, scope: tuple[str, ...]) -> None:
        """What stands between two braces, or in the file."""
        kinds: dict[str, Callable[[tuple[str, ...]], None]] = {
            "module": self._module,
            "struct": self._struct,
            "typedef": self._typedef,
            "enum": self._enum,
            "const": self._const,
        }
        while self.peek() not in ("", "}"):
            self._annotations()
            word = self.next()
            if word not in kinds:
                raise TypeTextError(f"IDL: '{word}' is not supported")
            kinds[word](scope)
            self.next(";")

    def _annotations(self) -> None:
        while self.peek() == "@":
            self.next()
            self._scoped()
            if self.peek() == "(":
                depth = 0
                while True:
                    depth += {"(": 1, ")": -1}.get(self.next(), 0)
                    if not depth:
                        break

    def _scoped(self) -> str:
        if self.peek() == "::":
            self.next()
        name = self.next()
        while self.peek() == "::":
            self.next()
            name += "::" + self.next()
        return name

    def _module(self, scope: tuple[str, ...]) -> None:
        name = self.next()
        self.next("{")
        self.definitions((*scope, name))
        self.next("}")

    def _struct(self, scope: tuple[str, ...]) -> None:
        name = "::".join((*scope, self.next()))
        fields: list[Field] = []
        if self.peek() == ":":
            self.next()
            base = self._scoped()
            fields += self.structs[self._full_name(base, scope, self.structs)]
        self.next("{")
        while self.peek() != "}":
            self._annotations()
            fields += self._members(scope)
        self.next("}")
        self.structs[name] = fields

    def _typedef(self, scope: tuple[str, ...]) -> None:
        for f in self._members(scope, end=False):
            self.aliases["::".join((*scope, f.name))] = f

    def _enum(self, scope: tuple[str, ...]) -> None:
        name = self.next()
        self.next("{")
        list(iter(self.next, "}"))  # names of the values: a message holds their numbers
        self.aliases["::".join((*scope, name))] = Field(name, "u4")

    def _const(self, scope: tuple[str, ...]) -> None:
        self._type(scope)
        name = self.next()
        self.next("=")
        value = []
        while self.peek() != ";":
            value.append(self.next())
        if len(value) == 1 and value[0].isdigit():
            self.constants["::".join((*scope, name))] = int(value[0])

    def _members(self, scope: tuple[str, ...], end: bool = True) -> list[Field]:
        """One declaration of fields, with its semicolon where `end`."""
        kind = self._type(scope)
        found = []
        while True:
            self._annotations()
            name, one = self.next(), kind
            while self.peek() == "[":
                self.next()
                count = self._number(scope)
                self.next("]")
                if one.fixed is not None or one.sequence:
                    raise TypeTextError(f"IDL: '{name}' is an array of arrays, which is not supported")
                one = replace(one, fixed=count)
            found.append(replace(one, name=name))
            if self.peek() != ",":
                break
            self.next()
        if end:
            self.next(";")
        return found

    def _number(self, scope: tuple[str, ...]) -> int:
        if self.peek().isdigit():
            return int(self.next())
        return self.constants[self._full_name(self._scoped(), scope, self.constants)]

    def _type(self, scope: tuple[str, ...]) -> Field:
        if self.peek() == "sequence":
            self.next()
            self.next("<")
            inner = self._type(scope)
            if self.peek() == ",":
                self.next()
                self._number(scope)
            self.next(">")
            if inner.fixed is not None or inner.sequence:
                raise TypeTextError("IDL: a sequence of arrays is not supported")
            return replace(inner, sequence=True)
        name = self._scoped()
        if name in ("unsigned", "long"):
            while self.peek() in ("long", "short", "double"):
                name += " " + self.next()
        if name == "string" and self.peek() == "<":
            self.next()
            self._number(scope)
            self.next(">")
        if name in _BASIC:
            return Field("", _BASIC[name])
        if name in ("wstring", "wchar", "long double", "any", "fixed"):
            raise TypeTextError(f"IDL: {name} is stored in different ways by different writers")
        try:
            return self.aliases[self._full_name(name, scope, self.aliases)]
        except TypeTextError:
            return Field("", "::".join((*scope, name)) if "::" not in name else name)

    def _full_name(self, name: str, scope: tuple[str, ...], among: object) -> str:
        for depth in range(len(scope), -1, -1):
            full = "::".join((*scope[:depth], name))
            if full in among:  # type: ignore[operator]
                return full
        raise TypeTextError(f"IDL: '{name}' is not defined")


def idl_types(name: str, text: str) -> Types:
    """The types of concatenated IDL files, in any order. TypeTextError."""
    plain = _COMMENT.sub(lambda m: "\f" if "IDL:" in m.group() else " ", text)
    parts = [_TOKEN.findall(part) for part in plain.split("\f")]
    parser = _Parser([])
    waiting = [part for part in parts if part]
    while waiting:  # a part may need aliases of one that stands behind it
        failed: list[list[str]] = []
        problem: TypeTextError | None = None
        for part in waiting:
            parser.tokens, parser.at = part, 0
            try:
                parser.definitions(())
                if parser.peek():
                    raise TypeTextError(f"IDL: unexpected '{parser.peek()}'")
            except TypeTextError as error:
                failed.append(part)
                problem = error
        if problem is not None and len(failed) == len(waiting):
            raise problem
        waiting = failed
    names = {full: short(full) for full in parser.structs}
    structs = {
        names[full]: tuple(_with_full_name(f, full, parser, names) for f in fields)
        for full, fields in parser.structs.items()
    }
    for built_in in ("Time", "Duration"):
        structs.setdefault(f"builtin_interfaces/{built_in}", (Field("sec", "i4"), Field("nanosec", "u4")))
    return Types(short(name), resolved(structs))


def _with_full_name(f: Field, inside: str, parser: _Parser, names: dict[str, str]) -> Field:
    """A field whose type is known by the name that `structs` has; aliases from later files are replaced."""
    if not is_struct(f.kind):
        return f
    parts = f.kind.split("::")
    scope = inside.split("::")[:-1]
    tail = parts[len(scope) :] if parts[: len(scope)] == scope else parts
    for candidate in ["::".join((*scope[:k], *tail)) for k in range(len(scope), -1, -1)] + [f.kind]:
        if candidate in names:
            return replace(f, kind=names[candidate])
        if candidate in parser.aliases:
            alias = parser.aliases[candidate]
            return replace(
                alias,
                name=f.name,
                fixed=alias.fixed if f.fixed is None else f.fixed,
                sequence=alias.sequence or f.sequence,
            )
    return replace(f, kind=short(f.kind))
