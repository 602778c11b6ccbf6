"""Turns pydantic's complaints into errors with the file's line and the nearest right key."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any, TypeVar, get_args

from pydantic import BaseModel, ValidationError

from thermodata.errors import SpecError, nearest
from thermodata.schema.strict.declared import NOT_TYPED, MissingKeyError, WrongKeyError, WrongValueError
from thermodata.schema.strict.explain_types import missed, wanted
from thermodata.schema.strict.lines import Document, Place, at_place, dotted_place
from thermodata.schema.words.sentences import listed

M = TypeVar("M", bound=BaseModel)
SHOWN = 8


def validate(model: type[M], document: Document) -> M:
    """The document as `model`; SpecError with every problem's line."""
    try:
        return model.model_validate(document.data)
    except ValidationError as error:
        problems = list(_problems(model, document, error))
        raise _as_error(document, problems) from None


def _as_error(document: Document, problems: list[SpecError]) -> SpecError:
    first = problems[0]
    if len(problems) == 1:
        return first
    others = "; ".join(f"{p.where}: {p.what}" + (f" ({p.hint})" if p.hint else "") for p in problems[1:SHOWN])
    more = f"; and {len(problems) - SHOWN} more" if len(problems) > SHOWN else ""
    return SpecError(
        f"{first.what} (the first of {len(problems)} problems)",
        where=first.where,
        expected=first.expected,
        got=first.got,
        hint=_sentences(first.hint, f"then also {others}{more}"),
    )


def _sentences(first: str | None, second: str) -> str:
    """Two hints, each a sentence of its own."""
    if first is None:
        return second
    return f"{first}{'' if first.endswith(('?', '.', '!')) else '.'} {second[:1].upper()}{second[1:]}"


def _problems(model: type[BaseModel], document: Document, error: ValidationError) -> Iterator[SpecError]:
    seen: set[tuple[Place, str]] = set()
    in_list: Counter[tuple[Place, str]] = Counter()
    found: list[tuple[tuple[Place, str] | None, SpecError]] = []
    # a misspelt key is why another is missing: say it first
    details = sorted(_once(error.errors()), key=lambda detail: detail["type"] != "extra_forbidden")
    for detail in details:
        place, tags = _real_place(document.data, detail["loc"], detail["type"])
        value = at_place(document.data, place)
        # in a union each branch complains; a mapping never meant to be the text branch, and so on
        if _other_branch(detail["type"], value, tags):
            continue
        kind = detail["type"]
        if (place, kind) in seen:
            continue
        seen.add((place, kind))
        # what all values of a list lack is said of the first
        alike = (place[:-1], str(detail["msg"]).partition(";")[0]) if place and isinstance(place[-1], int) else None
        if alike is not None:
            in_list[alike] += 1
            if in_list[alike] > 1:
                continue
        found.append((alike, _one(model, document, place, detail, tags)))
    for alike, problem in found:
        if alike is not None and (more := in_list[alike] - 1):
            problem.what = f"{more + 1} values of '{dotted_place(alike[0])}': {problem.what.partition(': ')[2]}"
        yield problem
    if not seen:
        detail = details[0]
        place, tags = _real_place(document.data, detail["loc"], detail["type"])
        yield _one(model, document, place, detail, tags)


def _once(details: Sequence[Any]) -> list[Any]:
    """Without what a list lacks before its last value: that one tells how many it should have."""
    last = {d["loc"][:-1]: d for d in details if d["type"] == "missing" and isinstance(d["loc"][-1], int)}
    return [d for d in details if not (d["type"] == "missing" and d["loc"][:-1] in last) or d is last[d["loc"][:-1]]]


def _one(model: type[BaseModel], document: Document, place: Place, detail: Any, tags: tuple[str, ...]) -> SpecError:
    where, kind = document.where(place), detail["type"]
    name = place[-1] if place else ""
    if kind == "extra_forbidden":
        keys = sorted(_keys_at(model, place[:-1], tags))
        close = nearest(str(name), keys)
        return SpecError(
            f"unknown key '{name}'",
            where=where,
            expected="one of " + ", ".join(keys),
            got=str(name),
            hint=f"did you mean '{close}'?" if close else None,
        )
    if kind in ("union_tag_invalid", "union_tag_not_found"):
        return _tag(document, place, detail)
    if kind == "missing" and isinstance(name, int):
        found = at_place(document.data, place[:-1])
        return SpecError(
            f"'{dotted_place(place[:-1])}': too few values",
            where=document.where(place[:-1]),
            expected=f"{name + 1} values",
            got=_short(found),
        )
    if kind == "missing":
        return SpecError(
            f"the key '{name}' is missing", where=document.where(place[:-1]), expected=f"{dotted_place(place)}: ..."
        )
    fault = detail.get("ctx", {}).get("error")
    if isinstance(fault, MissingKeyError):
        return SpecError(
            str(fault),
            where=document.where(place),
            expected=f"{dotted_place((*place, fault.key))}: {listed(fault.words, 'or')}",
        )
    if isinstance(fault, WrongKeyError):
        return SpecError(
            str(fault),
            where=document.where((*place, fault.key)),
            expected=fault.expected,
            got=fault.key,
            hint=fault.hint,
        )
    value = at_place(document.data, place)
    message = str(detail["msg"]).removeprefix("Value error, ")
    close = None
    if kind == "literal_error":
        choices = [c.strip("' ") for c in str(detail["ctx"]["expected"]).replace(" or ", ", ").split(",")]
        close = nearest(str(value), choices)
        return SpecError(
            f"'{name}' is not one of the allowed words",
            where=where,
            expected=", ".join(c for c in choices if c),
            got=repr(value),
            hint=f"did you mean '{close}'?" if close else None,
        )
    expected: str | None = None
    hint: str | None = None
    if isinstance(fault, WrongValueError):
        expected, hint = fault.expected, fault.hint
    else:
        of_model = kind in ("model_type", "model_attributes_type")
        expected = wanted(kind, detail.get("ctx", {}), _keys_at(model, place, tags) if of_model else ())
        message = (missed(kind, expected) if expected is not None else None) or message
    return SpecError(
        f"'{name}': {message}" if name != "" else message, where=where, expected=expected, got=_short(value), hint=hint
    )


def _tag(document: Document, place: Place, detail: Any) -> SpecError:
    """Of a value whose kind is told by one of its keys: the key is missing, or its word is none of those known."""
    key = str(detail["ctx"]["discriminator"]).strip("'")
    if detail["type"] == "union_tag_not_found":
        return SpecError(
            f"the key '{key}' is missing", where=document.where(place), expected=f"{dotted_place((*place, key))}: ..."
        )
    choices = [word.strip("' ") for word in str(detail["ctx"]["expected_tags"]).split(",")]
    close = nearest(str(detail["ctx"]["tag"]), choices)
    return SpecError(
        f"'{key}' is not one of the allowed words",
        where=document.where((*place, key)),
        expected=", ".join(choices),
        got=repr(detail["ctx"]["tag"]),
        hint=f"did you mean '{close}'?" if close else None,
    )


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 80 else text[:77] + "..."


def _other_branch(kind: str, value: Any, tags: tuple[str, ...]) -> bool:
    if isinstance(value, dict):
        return kind in ("string_type", "list_type", "float_type", "int_type", "tuple_type") and bool(tags)
    if isinstance(value, list):
        return kind in ("string_type", "dict_type", "model_type", "literal_error") and bool(tags)
    return kind in ("model_type", "list_type", "dict_type") and bool(tags) and value is not None


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
