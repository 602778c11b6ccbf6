"""YAML with the line of every key, read strictly: one document, no duplicate keys, bounded aliases."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import yaml

from thermodata.errors import SpecError
from thermodata.schema.strict.yaml_faults import advice, place_of, problem_of

MAX_BYTES = 16 * 1024 * 1024
MAX_NODES = 500_000
MAX_DEPTH = 60

Place = tuple[str | int, ...]


@dataclass(slots=True)
class Document:
    """Plain data and where it stood: `line[place]` is the 1-based line of the key or item at that place.
    `digits[place]` is the text of a number with a fraction."""

    path: Path
    data: Any
    line: dict[Place, int] = field(default_factory=dict)
    digits: dict[Place, str] = field(default_factory=dict)

    def where(self, place: Sequence[str | int]) -> str:
        """`file:line (a.b[2])`, at the deepest known part of the place."""
        known = tuple(place)
        while known and known not in self.line:
            known = known[:-1]
        dotted = dotted_place(place)
        return f"{self.path.name}:{self.line.get(known, 1)}" + (f" ({dotted})" if dotted else "")


def dotted_place(place: Sequence[str | int]) -> str:
    """('tests', 2, 'id') -> 'tests[2].id', counted from 0 as in JSON."""
    text = ""
    for part in place:
        text += f"[{part}]" if isinstance(part, int) else (f".{part}" if text else part)
    return text


# dates stay text: a campaign file has none, and 2026-03-01 may be an id
_RESOLVERS = {
    key: [(tag, regexp) for tag, regexp in resolvers if tag != "tag:yaml.org,2002:timestamp"]
    for key, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}


class SlowLoader(yaml.SafeLoader):
    """The parser in Python, which is always there."""

    yaml_implicit_resolvers = _RESOLVERS


# the parser in C takes byte order marks and tabs where the other one refuses them
_LOOSE = "\ufeff\t"
FastLoader: type[Any] | None = None
if hasattr(yaml, "CSafeLoader"):

    class _FastLoader(yaml.CSafeLoader):
        """The parser in C: a tenth of the time, where PyYAML was built with it."""

        yaml_implicit_resolvers = _RESOLVERS

    FastLoader = _FastLoader


def read_document(path: Path) -> Document:
    """Parse a YAML file; SpecError names file and line where it is not one mapping of plain values."""
    if path.is_dir():
        own = path / "campaign.yaml"
        raise SpecError(
            f"'{path}' is a folder",
            where=str(path),
            expected="a YAML file",
            got="a folder",
            hint=f"name the file: {own}" if own.is_file() else f"thermodata init {path} drafts {own}",
        )
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise SpecError(
            f"cannot read '{path}'",
            where=str(path),
            got=error.strerror or str(error),
            hint="give the path of the YAML file",
        ) from None
    if len(raw) > MAX_BYTES:
        raise SpecError(
            "the file is too large for a YAML description",
            where=str(path),
            expected=f"under {MAX_BYTES} bytes",
            got=str(len(raw)),
            hint="name the file that describes the logs; measured data belongs into logs, and many tests"
            " into tests_from",
        )
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise SpecError(
            "the file is not UTF-8", where=f"{path.name}, byte {error.start}", hint="save it as UTF-8"
        ) from None
    return parse_document(text, path)


def parse_document(text: str, path: Path) -> Document:
    """The same from text; `path` is for messages and relative files."""
    if FastLoader is not None and not any(char in text for char in _LOOSE) and not _too_deep(text, FastLoader):
        try:
            return _document_of(FastLoader(text), path)
        except yaml.YAMLError:
            pass  # what it refuses the other one reads, or says where and why in its own words
    try:
        return _document_of(SlowLoader(text), path)
    except RecursionError:
        line = _too_deep(text, SlowLoader)
        raise SpecError(
            "the file nests too deep",
            where=f"{path.name}:{line}",
            expected=f"at most {MAX_DEPTH} levels",
            hint=f"look at the brackets and indentation of line {line}: a campaign or model file needs some six levels",
        ) from None
    except yaml.YAMLError as error:
        raise SpecError(
            "not valid YAML",
            where=f"{path.name}{place_of(error, text)}",
            got=problem_of(error),
            hint=advice(error, text),
        ) from None


def _too_deep(text: str, loader: Any) -> int:
    """The line, from 1, from which on it nests deeper than is allowed; 0 where it doesn't. The parser in C composes by
    recursion and doesn't count it: deep nesting would end the process. Its events come one by one. What is no YAML is
    not deep: who composes it says why."""
    depth = 0
    with suppress(yaml.YAMLError):
        for event in yaml.parse(text, Loader=loader):
            depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
            if depth > MAX_DEPTH:
                return 1 + (event.start_mark.line if event.start_mark else 0)
    return 0


def _document_of(loader: Any, path: Path) -> Document:
    try:
        root = loader.get_single_node()
        if root is None or not isinstance(root, yaml.MappingNode):
            raise SpecError(
                "the file holds no keys",
                where=f"{path.name}:1",
                expected="key: value lines",
                hint="thermodata init FOLDER drafts a campaign file from raw files",
            )
        document = Document(path, None)
        document.data = _Builder(loader, document).build(root, (), 0)
        return document
    finally:
        loader.dispose()


@dataclass(slots=True)
class _Builder:
    loader: Any
    document: Document
    count: int = 0

    def build(self, node: yaml.Node, place: Place, depth: int) -> Any:
        self.count += 1
        name, line = self.document.path.name, node.start_mark.line + 1
        # aliases may nest: a file of a few lines can describe more nodes than memory holds
        if self.count > MAX_NODES or depth > MAX_DEPTH:
            raise SpecError(
                "the file describes too much",
                where=f"{name}:{line}",
                expected=f"at most {MAX_NODES} values and {MAX_DEPTH} levels",
                hint="many alike tests are shorter as tests_from with a pattern of file names",
            )
        self.document.line.setdefault(place, line)
        if isinstance(node, yaml.MappingNode):
            return self._mapping(node, place, depth)
        if isinstance(node, yaml.SequenceNode):
            return [self.build(item, (*place, i), depth + 1) for i, item in enumerate(node.value)]
        try:
            value = self.loader.construct_object(node)
        except (yaml.YAMLError, ValueError):
            raise SpecError(
                "a value that YAML cannot read",
                where=f"{name}:{line}",
                got=str(node.value)[:80],
                hint="put it in quotes",
            ) from None
        if place[-1:] == ("id",) and isinstance(value, bool | int | float):
            value = str(node.value)  # a name as it stands: 1_2 is no 12, 010 no 8, 1:30 no 90, and no is no False
        if isinstance(value, float):
            self.document.digits[place] = node.value
        if isinstance(value, str):
            _whole_letters(value, f"{name}:{line}")
        return value

    def _mapping(self, node: yaml.MappingNode, place: Place, depth: int) -> dict[str, Any]:
        result: dict[str, Any] = {}
        name = self.document.path.name
        for key_node, value_node in node.value:
            line = key_node.start_mark.line + 1
            key = _key(key_node, f"{name}:{line}")
            if key in result:
                raise SpecError(
                    f"the key '{key}' stands twice",
                    where=f"{name}:{line}",
                    got=f"first at line {self.document.line[(*place, key)]}",
                    hint="keep one of them",
                )
            self.document.line[(*place, key)] = line
            result[key] = self.build(value_node, (*place, key), depth + 1)
        return result


def is_text(name: str) -> bool:
    """Whether a name can be written down: one of a disk may hold bytes that are no UTF-8."""
    try:
        name.encode()
    except UnicodeEncodeError:
        return False
    return True


def _whole_letters(text: str, where: str) -> str:
    """The text; SpecError where it holds half a letter, which nothing can write down again: "\\udce9"."""
    if is_text(text):
        return text
    raise SpecError(
        "a text that is no UTF-8",
        where=where,
        got=ascii(text)[1:-1],
        expected="whole letters",
        hint="where it names a file, give the file another name",
    )


def _key(node: yaml.Node, where: str) -> str:
    """A word, or a list of words as it is written: `[D25, D63]: k1` names what several keys have in common."""
    if isinstance(node, yaml.ScalarNode):
        return _whole_letters(str(node.value), where)
    if isinstance(node, yaml.SequenceNode) and all(isinstance(part, yaml.ScalarNode) for part in node.value):
        return f"[{', '.join(str(part.value) for part in node.value)}]"
    raise SpecError(
        "a key must be a word, or a list of words",
        where=where,
        hint="put the key in quotes where it is a number or a date: '2026-03-01': ...",
    )


def at_place(data: Any, place: Sequence[str | int]) -> Any:
    """The value at a place, or None."""
    for part in place:
        in_list = isinstance(data, list) and isinstance(part, int) and 0 <= part < len(data)
        if not in_list and not (isinstance(data, Mapping) and part in data):
            return None
        data = data[part]
    return data
