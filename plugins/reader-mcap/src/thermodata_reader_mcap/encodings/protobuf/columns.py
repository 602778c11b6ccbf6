"""Many protobuf messages at once: parsed by the package, then field by field instead of message by message."""

from __future__ import annotations

from collections.abc import Sequence
from operator import attrgetter
from typing import Any, Protocol

import numpy as np

from thermodata_reader_mcap.encodings import decoded_messages
from thermodata_reader_mcap.encodings.columns import Columns, Wrong
from thermodata_reader_mcap.encodings.field_paths import MOST_ELEMENTS
from thermodata_reader_mcap.encodings.protobuf.fields import is_map, is_repeated
from thermodata_reader_mcap.encodings.topic import Leaf, Topic

Tree = dict[str | int, Any]


class MessageDecoder(Protocol):
    """message: the class that reads a payload. labels: enumerations as text."""

    message: Any
    labels: bool

    def decode(self, payload: bytes) -> Any:
        """A payload as Python values."""


class OtherwiseError(Exception):
    """Messages that hold more than the topic's signals: these go one by one."""


def message_columns(decoder: MessageDecoder, topic: Topic, payloads: Sequence[bytes]) -> Columns:
    """The payloads as columns; equal to decoding them one by one."""
    messages, kept, wrong = list[Any](), list[int](), list[Wrong]()
    parse = decoder.message.FromString
    for k, payload in enumerate(payloads):
        try:
            messages.append(parse(payload))
            kept.append(k)
        except Exception as error:  # whatever the package raises: no message
            got = payload[:60].decode("utf-8", "replace")
            wrong.append(Wrong(k, "", "a message", f"{type(error).__name__}: {str(error)[:80]}; {got!r}"))
    result = Columns(np.array(kept, np.int64), {}, {}, wrong)
    try:
        _Extractor(decoder, topic, result).message(decoder.message.DESCRIPTOR, messages, _tree(topic), ())
    except OtherwiseError:
        return decoded_messages.columns(topic, decoder.decode, payloads, 0)
    return result


def _tree(topic: Topic) -> Tree:
    tree: Tree = {}
    for leaf in topic.leaves:
        node = tree
        for part in leaf.path[:-1]:
            node = node.setdefault(part, {})
            if not isinstance(node, dict):
                raise OtherwiseError
        if leaf.path[-1] in node:
            raise OtherwiseError
        node[leaf.path[-1]] = leaf
    return tree


class _Extractor:
    def __init__(self, decoder: MessageDecoder, topic: Topic, into: Columns) -> None:
        self._decoder, self._topic, self._into = decoder, topic, into

    def message(self, descriptor: Any, messages: list[Any], tree: Tree, path: tuple[str | int, ...]) -> None:
        """The fields of messages of one type; None where one is missing."""
        if len(path) > MOST_ELEMENTS:
            raise OtherwiseError
        whole = None not in messages
        for f in descriptor.fields:
            name, here = f.name, (*path, f.name)
            node, get = tree.get(name), attrgetter(f.name)
            if is_map(f):
                self._map(f, [{} if m is None else get(m) for m in messages], node, here)
            elif is_repeated(f):
                lists = map(get, messages) if whole else (() if m is None else get(m) for m in messages)
                self._repeated(f, list(lists), node, here)
            elif f.has_presence and not f.has_default_value:
                self._value(f, [get(m) if m is not None and m.HasField(name) else None for m in messages], node, here)
            else:
                self._value(
                    f,
                    list(map(get, messages)) if whole else [None if m is None else get(m) for m in messages],
                    node,
                    here,
                )

    def _value(self, f: Any, values: list[Any], node: Any, path: tuple[str | int, ...]) -> None:
        if f.message_type is not None:
            if node is None or isinstance(node, Leaf):
                if any(v is not None for v in values):
                    raise OtherwiseError
                if node is not None:
                    self._leaf(node, values)
                return
            self.message(f.message_type, values, node, path)
        elif f.type == f.TYPE_BYTES:
            if path in self._topic.skipped:
                if node is not None or any(v is not None and len(v) <= MOST_ELEMENTS for v in values):
                    raise OtherwiseError
                return
            if any(v is not None and len(v) > MOST_ELEMENTS for v in values):
                raise OtherwiseError
            self._elements(None, [() if v is None else v for v in values], node, path)
        elif isinstance(node, Leaf):
            if f.enum_type is not None and self._decoder.labels:
                names = {v.number: v.name for v in f.enum_type.values}
                values = [None if v is None else names.get(v, str(v)) for v in values]
            self._leaf(node, values)
        elif node is not None or any(v is not None for v in values):
            raise OtherwiseError

    def _repeated(self, f: Any, lists: list[Any], node: Any, path: tuple[str | int, ...]) -> None:
        if f.type == f.TYPE_BYTES:
            raise OtherwiseError
        self._elements(f, lists, node, path)

    def _elements(self, f: Any, lists: list[Any], node: Any, path: tuple[str | int, ...]) -> None:
        """Arrays; f: the field, None for the numbers of bytes."""
        lengths = list(map(len, lists))
        longest = max(lengths, default=0)
        if isinstance(node, Leaf) or (longest > MOST_ELEMENTS and path not in self._topic.long):
            raise OtherwiseError
        known = node or {}
        if min(longest, MOST_ELEMENTS) > len(known):
            raise OtherwiseError
        for place, inner in known.items():
            if not isinstance(place, int):
                raise OtherwiseError
            values = [e[place] if n > place else None for e, n in zip(lists, lengths, strict=True)]
            if f is None:
                self._leaf(inner, values)
            else:
                self._value(f, values, inner, (*path, place))

    def _map(self, f: Any, maps: list[Any], node: Any, path: tuple[str | int, ...]) -> None:
        known = {} if node is None else node
        if isinstance(known, Leaf) or any(str(key) not in known for m in maps for key in m):
            raise OtherwiseError
        texts = [{str(key): value for key, value in m.items()} for m in maps]
        for key, inner in known.items():
            self._value(f.message_type.fields_by_name["value"], [t.get(key) for t in texts], inner, (*path, key))

    def _leaf(self, leaf: Any, values: list[Any]) -> None:
        if not isinstance(leaf, Leaf):
            raise OtherwiseError
        kinds = set(map(type, values)) - {type(None)}
        if not kinds <= _KINDS[leaf.dtype]:
            raise OtherwiseError
        try:
            column, missing = decoded_messages.as_array(values, leaf.dtype)
        except OverflowError:
            raise OtherwiseError from None
        self._into.values[leaf.name] = column
        if missing is not None:
            self._into.flags[leaf.name] = missing


_KINDS: dict[str, set[type]] = {"float64": {float}, "int64": {int}, "uint64": {int}, "bool": {bool}, "str": {str}}
