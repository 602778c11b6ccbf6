"""One complaint of pydantic: the place in the file that it is of, and the keys that may stand there."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, get_args

from pydantic import BaseModel

from thermodata.schema.strict.declared import NOT_TYPED
from thermodata.schema.strict.lines import Document, Place, at_place


@dataclass(frozen=True, slots=True)
class Complaint:
    """detail: as pydantic has it; place: the part of its path that stands in the file; tags: the rest of it, which
    names branches of unions."""

    model: type[BaseModel]
    document: Document
    detail: Any
    place: Place
    tags: tuple[str, ...]

    @classmethod
    def of(cls, model: type[BaseModel], document: Document, detail: Any) -> Complaint:
        """What pydantic says of a document that it held against a model."""
        return cls(model, document, detail, *_real_place(document.data, detail["loc"], detail["type"]))

    @property
    def kind(self) -> str:
        """pydantic's word for what is wrong."""
        return str(self.detail["type"])

    @property
    def name(self) -> str | int:
        """The last key or number of the place; '' of the whole file."""
        return self.place[-1] if self.place else ""

    @property
    def value(self) -> Any:
        """What stands at the place; None where nothing does."""
        return at_place(self.document.data, self.place)

    @property
    def context(self) -> Any:
        """What pydantic says beside its message."""
        return self.detail.get("ctx", {})

    @property
    def fault(self) -> Exception | None:
        """What a validator of our own raised."""
        found = self.context.get("error")
        return found if isinstance(found, Exception) else None

    def where(self, *more: str) -> str:
        """File and line of the place, or of keys below it."""
        return self.document.where((*self.place, *more))

    def keys(self, place: Place) -> set[str]:
        """Keys that may stand at a place."""
        return _keys_at(self.model, place, self.tags)


def _real_place(data: Any, loc: tuple[str | int, ...], kind: str) -> tuple[Place, tuple[str, ...]]:
    """The part of pydantic's path that stands in the file; what is left names union branches."""
    place: list[str | int] = []
    tags: list[str] = []
    last = len(loc) - 1
    for i, part in enumerate(loc):
        value = at_place(data, place)
        exists = (isinstance(value, dict) and part in value) or (
            isinstance(value, list) and isinstance(part, int) and part < len(value)
        )
        if exists or (i == last and kind == "missing"):
            place.append(part)
        elif isinstance(part, str):
            tags.append(part)
    return tuple(place), tuple(tags)


def _models_in(annotation: Any) -> Iterator[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for argument in get_args(annotation):
        yield from _models_in(argument)


def _keys_at(model: type[BaseModel], place: Place, tags: tuple[str, ...]) -> set[str]:
    models = [model]
    for part in place:
        found: list[type[BaseModel]] = []
        named = False
        for candidate in models:
            for field_name, info in candidate.model_fields.items():
                if part in (field_name, info.alias):
                    found.extend(_models_in(info.annotation))
                    named = True
        # a part that names no field is a free key or an index inside the models at hand
        if named:
            models = found
    chosen = [m for m in models if m.__name__ in tags or _kind_of(m) in tags] or models
    fields = [(name, info) for m in chosen for name, info in m.model_fields.items()]
    return {info.alias or name for name, info in fields if info.json_schema_extra != NOT_TYPED}


def _kind_of(model: type[BaseModel]) -> str | None:
    info = model.model_fields.get("kind")
    words = get_args(info.annotation) if info is not None else ()
    return words[0] if len(words) == 1 else None
