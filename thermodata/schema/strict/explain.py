"""Turns pydantic's complaints into errors with the file's line and the nearest right key."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from thermodata.errors import SpecError
from thermodata.schema.strict.complaint import Complaint
from thermodata.schema.strict.explain_one import as_error
from thermodata.schema.strict.lines import Document, Place, dotted_place

M = TypeVar("M", bound=BaseModel)
SHOWN = 8


def validate(model: type[M], document: Document) -> M:
    """The document as `model`; SpecError with every problem's line."""
    try:
        return model.model_validate(document.data)
    except ValidationError as error:
        problems = list(_problems(model, document, error))
        raise _as_one(problems) from None


def _as_one(problems: list[SpecError]) -> SpecError:
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
    details = sorted(_without_lacking_before(error.errors()), key=lambda detail: detail["type"] != "extra_forbidden")
    for detail in details:
        complaint = Complaint.of(model, document, detail)
        place = complaint.place
        # in a union each branch complains; a mapping never meant to be the text branch, and so on
        if _of_another_branch(complaint) or (place, complaint.kind) in seen:
            continue
        seen.add((place, complaint.kind))
        # what all values of a list lack is said of the first
        alike = (place[:-1], str(detail["msg"]).partition(";")[0]) if place and isinstance(place[-1], int) else None
        if alike is not None:
            in_list[alike] += 1
            if in_list[alike] > 1:
                continue
        found.append((alike, as_error(complaint)))
    for alike, problem in found:
        if alike is not None and (more := in_list[alike] - 1):
            problem.what = f"{more + 1} values of '{dotted_place(alike[0])}': {problem.what.partition(': ')[2]}"
        yield problem
    if not seen:
        yield as_error(Complaint.of(model, document, details[0]))


def _without_lacking_before(details: Sequence[Any]) -> list[Any]:
    """Without what a list lacks before its last value: that one tells how many it should have."""
    last = {d["loc"][:-1]: d for d in details if d["type"] == "missing" and isinstance(d["loc"][-1], int)}
    return [d for d in details if not (d["type"] == "missing" and d["loc"][:-1] in last) or d is last[d["loc"][:-1]]]


def _of_another_branch(complaint: Complaint) -> bool:
    """Whether a branch of a union complains that the value is not for it."""
    kind, value, tags = complaint.kind, complaint.value, complaint.tags
    if isinstance(value, dict):
        return kind in ("string_type", "list_type", "float_type", "int_type", "tuple_type") and bool(tags)
    if isinstance(value, list):
        return kind in ("string_type", "dict_type", "model_type", "literal_error") and bool(tags)
    return kind in ("model_type", "list_type", "dict_type") and bool(tags) and value is not None
