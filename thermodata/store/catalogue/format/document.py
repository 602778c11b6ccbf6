"""Documents that a store keeps as JSON: what this program can't read in one was written by another version of it."""

from __future__ import annotations

from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from thermodata.errors import StoreError
from thermodata.schema.answers.confirmed import Confirmed
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.answers.locked_error import LockedError
from thermodata.schema.answers.result import FitResult
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.files.model import Model
from thermodata.store.catalogue.format.ddl import FORMAT

KEPT: tuple[type[BaseModel], ...] = (Campaign, Model, FitResult, Diagnosis, Confirmed, LockedError)
"""Which documents: where one changes, the store's format is to be raised."""

_M = TypeVar("_M", bound=BaseModel)


def read_document(kind: type[_M], text: str, where: str, context: dict[str, Any] | None = None) -> _M:
    """A document as the store keeps it; StoreError where it has other keys than this program knows. context: of its
    validation."""
    try:
        return kind.model_validate_json(text, context=context)
    except ValidationError as error:
        first = error.errors(include_input=False, include_url=False)[0]
        raise StoreError(
            f"the store holds a {error.title} that this program can't read: another version of thermodata wrote it",
            where=where,
            expected=f"the keys of store format {FORMAT}",
            got=f"{'.'.join(map(str, first['loc']))}: {first['msg']}",
            hint="use the version that wrote it, or a newer one; a model is made again by thermodata fit",
        ) from error


def readable(kind: type[_M], text: str) -> _M | None:
    """The same of an answer, which is asked again where another version wrote it: None then."""
    try:
        return kind.model_validate_json(text)
    except ValidationError:
        return None
