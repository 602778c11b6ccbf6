"""JSON messages one by one, with what a JSON Schema says of their fields."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from thermodata.reader.text.preamble.scale_words import states_scale
from thermodata_reader_mcap.encodings.field_paths import Path
from thermodata_reader_mcap.encodings.json.text import loads
from thermodata_reader_mcap.encodings.topic import Hint

OF_ARRAY = "array description"  # the property of an element: what a schema says of all of them
_UNIT_KEYS = ("unit", "units", "x-unit", "x-units", "engineeringUnit", "engineeringUnits")
_MOST_REFERENCES = 8


@dataclass(slots=True)
class JsonDecoder:
    """JSON, with or without a JSON Schema. encoding: of its text, where that is not UTF-8."""

    schema: Any
    encoding: str | None = None
    json: bool = True

    def decode(self, payload: bytes) -> Any:
        """A payload as Python values. ValueError, RecursionError: it is no JSON, or a key comes twice."""
        return loads(self.text(payload))

    def text(self, payload: bytes) -> bytes:
        """The payload in UTF-8."""
        return payload if self.encoding is None else payload.decode(self.encoding).encode()

    def hint(self, path: Path) -> Hint | None:
        """What the JSON Schema says of a path; None where it says nothing."""
        node, of_array = self._meant(self.schema), None
        for part in path:
            if not isinstance(node, Mapping):
                return None
            of_array = node.get("description") if isinstance(part, int) else None
            inner = node.get("items") if isinstance(part, int) else node.get("properties")
            node = self._meant(
                inner if isinstance(part, int) else inner.get(part) if isinstance(inner, Mapping) else None
            )
        if not isinstance(node, Mapping):
            return None
        kind = node.get("type")
        if isinstance(kind, list):
            kind = next((k for k in kind if k != "null"), None)
        unit = next((node[k] for k in _UNIT_KEYS if isinstance(node.get(k), str)), None)
        described = node.get("description", node.get("title"))
        said = {"description": described} if isinstance(described, str) else {}
        if isinstance(of_array, str) and not said:
            said[OF_ARRAY] = of_array
        bare = {k.removeprefix("x-"): v for k, v in node.items()}
        said |= {k: str(v) for k, v in bare.items() if states_scale(k) and isinstance(v, str | int | float)}
        return Hint(kind if isinstance(kind, str) else None, unit, tuple(said.items()))

    def _meant(self, node: Any) -> Any:
        """What a node of the schema stands for: of a reference ('#/$defs/celsius') what it names, with what is said
        beside it."""
        for _ in range(_MOST_REFERENCES):
            if not isinstance(node, Mapping) or not isinstance(to := node.get("$ref"), str) or not to.startswith("#/"):
                break
            found: Any = self.schema
            for key in to[2:].split("/"):
                found = found.get(key) if isinstance(found, Mapping) else None
            beside = {k: v for k, v in node.items() if k != "$ref"}
            node = {**found, **beside} if isinstance(found, Mapping) else beside
        return node


def json_schema(data: bytes) -> Any:
    """A JSON Schema as Python values; None where it is none."""
    try:
        return json.loads(data) if data.strip() else None
    except (ValueError, RecursionError):
        return None
