"""Arrays whose elements have names: in an array beside them (`name`, `position`), or in a field of each element. An
element is read by its name, for its place may change from message to message and from file to file."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from thermodata_reader_mcap.encodings.decoder import Decoder, hints
from thermodata_reader_mcap.encodings.field_paths import MOST_DEPTH, MOST_ELEMENTS, Path
from thermodata_reader_mcap.encodings.topic import Hint

_ALONE = ("name", "id", "key", "channel", "sensor", "label", "tag", "signal", "probe", "joint", "node")
_KEYS = frozenset(f"{before}{word}" for before in ("", "sensor_", "channel_", "signal_", "joint_") for word in _ALONE)
_LISTS = _KEYS | {f"{word}s" for word in _KEYS}
_NUMBERED = ("id", "ids")  # ends of the keys whose numbers are names; those of a probe or a channel are its readings
_STANDS = 0.9  # of the messages have all of their names, and each number is in so many of them on average
_AGAIN = 2  # messages that a name is in, on average; ids that are each their own name nothing


@dataclass(frozen=True, slots=True)
class Naming:
    """columns: where an array holds the names of those beside it; elements: arrays of objects, and the field in these
    that holds a name. Places in a path count from 0, for any. orders: of both, the names in the order in which they
    stood in all messages that were looked at; none where it changed."""

    columns: frozenset[Path] = frozenset()
    elements: frozenset[tuple[Path, str]] = frozenset()
    orders: Mapping[Path, tuple[str, ...]] = field(default_factory=dict)

    def __bool__(self) -> bool:
        return bool(self.columns or self.elements)

    def place(self, path: Path) -> Path | None:
        """The same by the place of the element, as it stood in all messages; None where no name stands in it, or it had
        no one place."""
        for where, names in self.orders.items():
            inside = where[:-1] if where in self.columns else where
            at = len(where)
            if path[: len(inside)] == inside and len(path) > at and path[at] in names:
                return (*path[:at], names.index(str(path[at])), *path[at + 1 :])
        return None

    def named(self, value: Any, path: Path = ()) -> Any:
        """A message with its named arrays as mappings; those that do not fit their names stay as they are."""
        if len(path) >= MOST_DEPTH:
            return value
        if isinstance(value, Mapping):
            return self._mapping(value, path)
        if not isinstance(value, list):
            return value
        inner = [self.named(each, (*path, 0)) for each in value]
        for where, key in self.elements:
            names = _of_elements(value, key) if where == path else None
            if names is not None:
                rest = [{k: v for k, v in each.items() if k != key} for each in inner]
                return dict(zip(names, rest, strict=True))
        return inner

    def _mapping(self, value: Mapping[str, Any], path: Path) -> dict[str, Any]:
        made = {str(k): self.named(v, (*path, str(k))) for k, v in value.items()}
        for key in value:
            names = _texts(value[key], str(key)) if (*path, str(key)) in self.columns else None
            if names is None:
                continue
            fit = [k for k, v in value.items() if k != key and isinstance(v, list) and len(v) == len(names)]
            made |= {k: dict(zip(names, made[k], strict=True)) for k in fit if isinstance(made[k], list)}
            if fit or not names:
                del made[str(key)]
            return made
        return made


@dataclass(slots=True)
class NamedDecoder:
    """A decoder whose arrays are taken by the names of their elements."""

    inner: Decoder
    naming: Naming
    json: bool = False

    def decode(self, payload: bytes) -> Any:
        """A payload as Python values, named arrays as mappings."""
        return self.naming.named(self.inner.decode(payload))

    def hint(self, path: Path) -> Hint | None:
        """What the schema says of the element that a name stands for."""
        arrays = {where for where, _ in self.naming.elements}
        beside = {where[:-1] for where in self.naming.columns}
        real: list[str | int] = []
        told = hints(self.inner)
        for at, part in enumerate(path):
            here = tuple(real)
            by_name = here in arrays or (here[:-1] in beside and at > 0 and told(here) is None)
            real.append(0 if by_name else part)
        return told(tuple(real)) or told(path)


def find_naming(messages: Sequence[Any]) -> Naming:
    """The arrays whose elements are named, in messages as they are decoded."""
    columns: dict[Path, list[list[str] | None]] = {}
    elements: dict[tuple[Path, str], list[list[str]]] = {}
    unnamed = Counter[Path]()
    for message in messages:
        for path, value in _lists(message, ()):
            key = next((k for k in _keys(value) if _of_elements(value, k) is not None), None)
            if key is not None:
                elements.setdefault((path, key), []).append(_of_elements(value, key) or [])
            else:
                unnamed[path] += 1
        for path, names in _named_columns(message, ()):
            columns.setdefault(path, []).append(names)
    told = {path: [names for names in every if names is not None] for path, every in columns.items()}
    beside = {p: t for p, t in told.items() if _names(t, len(columns[p]) - len(t))}
    within = {(p, k): t for (p, k), t in elements.items() if _names(t, unnamed[p])}
    each = [*beside.items(), *((path, every) for (path, _), every in within.items())]
    orders = {path: tuple(every[0]) for path, every in each if all(names == every[0] for names in every)}
    return Naming(frozenset(beside), frozenset(within), orders)


def _names(every: Sequence[Sequence[str]], without: int) -> bool:
    """Whether they name elements. every: the names of each message. without: how many messages have none."""
    return len(every) >= _STANDS * (len(every) + without) and _come_again(every)


def _come_again(every: Sequence[Sequence[str]]) -> bool:
    counts = Counter(name for names in every for name in names)
    numbers = all(name.lstrip("-").isdecimal() for name in counts)
    again = len(every) * _STANDS if numbers else _AGAIN if len(every) >= 4 else 0
    return 0 < len(counts) <= MOST_ELEMENTS and counts.total() >= again * len(counts)


def is_name_key(key: str) -> bool:
    """Whether a field of an object is called as what names it."""
    return key.lower() in _KEYS


def _keys(value: Sequence[Any]) -> list[str]:
    first = value[0] if value and isinstance(value[0], Mapping) else {}
    return [str(k) for k in first if is_name_key(str(k))]


def _of_elements(value: Sequence[Any], key: str) -> list[str] | None:
    """The names in the elements of an array; None where one has none, or two have the same."""
    if not all(isinstance(each, Mapping) and key in each and len(each) > 1 for each in value):
        return None
    return _texts([each[key] for each in value], key)


def _texts(names: Any, key: str) -> list[str] | None:
    """Names that are all there and differ; None otherwise."""
    if not isinstance(names, list) or len(names) > MOST_ELEMENTS:
        return None
    kinds = (str, int) if key.lower().endswith(_NUMBERED) else (str,)
    if not all(isinstance(n, kinds) and not isinstance(n, bool) and str(n).strip() for n in names):
        return None
    texts = [str(n) for n in names]
    return texts if len(set(texts)) == len(texts) else None


def _lists(value: Any, path: Path) -> Iterator[tuple[Path, list[Any]]]:
    if len(path) >= MOST_DEPTH:
        return
    if isinstance(value, Mapping):
        for key, inner in value.items():
            yield from _lists(inner, (*path, str(key)))
    elif isinstance(value, list):
        if value and isinstance(value[0], Mapping):
            yield path, value
        for inner in value[:MOST_ELEMENTS] if value and isinstance(value[0], Mapping | list) else ():
            yield from _lists(inner, (*path, 0))


def _named_columns(value: Any, path: Path) -> Iterator[tuple[Path, list[str] | None]]:
    """The names of the arrays beside each array of names; None where those have elements and it does not name them."""
    if len(path) >= MOST_DEPTH:
        return
    if isinstance(value, Mapping):
        lists = {str(k): v for k, v in value.items() if isinstance(v, list)}
        for key, names in lists.items():
            others = [v for k, v in lists.items() if k != key and v]
            if key.lower() not in _LISTS or not others:
                continue
            texts = _texts(names, key)
            fit = bool(texts) and any(len(v) == len(names) for v in others)
            yield (*path, key), texts if fit else None
            if fit:
                break
        for key, inner in value.items():
            yield from _named_columns(inner, (*path, str(key)))
    elif isinstance(value, list) and value and isinstance(value[0], Mapping | list):
        for inner in value[:MOST_ELEMENTS]:
            yield from _named_columns(inner, (*path, 0))
