"""Reads campaign and model files: strict, with the line of every mistake."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from thermodata.errors import SpecError
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.files.crosscheck import check_campaign
from thermodata.schema.files.model import Model
from thermodata.schema.files.tests_from import expand
from thermodata.schema.strict.explain import validate
from thermodata.schema.strict.lines import Document, at_place, parse_document, read_document


def load_campaign(path: Path | str) -> Campaign:
    """A campaign file with `tests_from` expanded into `tests`; SpecError names file and line."""
    return _campaign(read_document(Path(path)))


def parse_campaign(text: str, name: str = "campaign.yaml") -> Campaign:
    """A campaign from text, as `load_campaign` does from a file."""
    return _campaign(parse_document(text, Path(name)))


def _campaign(document: Document) -> Campaign:
    _expect_schema(document, "thermodata/campaign/1")
    _only_numbers(document)
    campaign = validate(Campaign, document)
    check_campaign(campaign, document)
    if campaign.tests_from is not None:
        campaign = expand(campaign, document)
    return campaign


def load_model(path: Path | str) -> Model:
    """A model file; SpecError names file and line."""
    document = read_document(Path(path))
    return _model(document)


def parse_model(text: str, name: str = "model.yaml") -> Model:
    """A model from text, as `load_model` does from a file."""
    return _model(parse_document(text, Path(name)))


def _model(document: Document) -> Model:
    _expect_schema(document, "thermodata/model/1")
    _keep_digits(document)
    return validate(Model, document)


def _only_numbers(document: Document) -> None:
    """`.nan` and `.inf` are numbers to YAML, and nothing of a machine: they would be kept as null."""
    for place, text in document.digits.items():
        if not math.isfinite(at_place(document.data, place)):
            raise SpecError(
                f"'{'.'.join(map(str, place))}': not a number that a machine can have",
                where=document.where(place),
                expected="a number with its unit: 9000 rpm",
                got=text,
                hint="leave out what is not known",
            )


def _keep_digits(document: Document) -> None:
    """What an effect fixes may be a printed coefficient: its text says how far it is known."""
    for place, text in document.digits.items():
        if "fixed" in place[:-1] and text != repr(at_place(document.data, place)):
            at_place(document.data, place[:-1])[place[-1]] = text


def _expect_schema(document: Document, expected: str) -> None:
    got: Any = document.data.get("schema")
    if got != expected:
        kind = expected.split("/")[1]
        other = isinstance(got, str) and got.startswith("thermodata/")
        raise SpecError(
            f"not a {kind} file" if not other else f"this is a '{got}' file",
            where=document.where(("schema",)),
            expected=f"schema: {expected}",
            got="no 'schema' key" if got is None else f"schema: {got}",
            hint=f"start the file with 'schema: {expected}'" if got is None else None,
        )
