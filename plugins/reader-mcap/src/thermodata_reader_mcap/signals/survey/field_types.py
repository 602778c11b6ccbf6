"""The signals of a topic by a survey of its messages: the leaves, each with a path, a name and one dtype."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from thermodata_reader_mcap.encodings.field_paths import MOST_ELEMENTS, Path, any_element, path_name
from thermodata_reader_mcap.encodings.topic import Declared, Hint, Leaf
from thermodata_reader_mcap.signals.survey.field_survey import FieldCounts, Survey

MOST_SIGNALS = 5_000  # of a topic; more are keys that hold data, no set of signals
_EXACT = 2**53
_DTYPES = {"string": "str", "boolean": "bool", "integer": "int64", "uint64": "uint64"}


def find_leaves(topic: str, survey: Survey, declared: Declared, exact: bool) -> tuple[tuple[Leaf, ...], list[str]]:
    """The leaves of sampled messages, and notes. exact: the messages are all of the topic. Whole numbers of a
    sampled topic become int64 only where the schema says so or a float64 would change them; else float64, for a
    fraction may follow."""
    notes = [
        f"{path_name(topic, path)} holds arrays of up to {n} elements; the first {MOST_ELEMENTS} are read"
        for path, n in survey.long.items()
    ]
    notes += [
        f"{path_name(topic, path)} holds up to {n} bytes of binary data; they are not read"
        for path, n in survey.binary.items()
    ]
    notes += [f"{path_name(topic, path)} is nested deeper than is read" for path in survey.deep]
    seen = survey.seen
    inner = {path[:k] for path in seen for k in range(len(path))}
    leaves, names = list[Leaf](), set[str]()
    for path, each in seen.items():
        if path in inner and not each.scalars:
            continue  # null or empty here, an object elsewhere
        if len(leaves) == MOST_SIGNALS:
            notes.append(f"topic '{topic}' has {len(seen)} fields; the first {MOST_SIGNALS} are read")
            break
        name = path_name(topic, path)
        while name in names:
            name += "#2"
        names.add(name)
        hint = declared(path) or Hint()
        dtype = _dtype(each, survey.total, hint.kind, exact)
        leaves.append(Leaf(path, name, dtype, hint.unit, hint.properties))
    return _one_type_an_array(leaves), notes


def _one_type_an_array(leaves: Iterable[Leaf]) -> tuple[Leaf, ...]:
    """Numbers at one place of an array's elements share a dtype: [1, 2.5] is float64."""
    kinds: dict[Path, set[str]] = {}
    for leaf in leaves:
        kinds.setdefault(any_element(leaf.path), set()).add(leaf.dtype)
    return tuple(
        replace(leaf, dtype="float64")
        if len(k := kinds[any_element(leaf.path)]) > 1 and k <= {"int64", "uint64", "float64"}
        else leaf
        for leaf in leaves
    )


def _dtype(each: FieldCounts, total: int, declared: str | None, exact: bool) -> str:
    numbers = each.integers + each.floats
    kinds = (each.bools > 0) + (numbers > 0) + (each.texts > 0)
    if kinds == 0:
        return _DTYPES.get(declared or "", "float64")
    if kinds > 1:
        # a few words among numbers ("ERROR") are defects; a real mixture is text
        return "float64" if numbers >= 0.9 * (each.count - each.nulls) else "str"
    if each.texts:
        return "str"
    if each.bools:
        return "bool"
    if each.floats or each.high >= 2**64 or each.low < -(2**63) or (each.high >= 2**63 and each.low < 0):
        return "float64"
    whole = "uint64" if each.high >= 2**63 or declared == "uint64" else "int64"
    if max(each.high, -each.low) > _EXACT or declared in ("integer", "uint64"):
        return whole
    always = each.count == total and not each.nulls
    return whole if exact and always and declared != "number" else "float64"
