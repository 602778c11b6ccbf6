"""The published JSON Schemas of the files that users write, from the pydantic models and their docstrings.

A docstring's first paragraph describes the object; each line `key: meaning` behind it describes that key, so that an
editor shows it where the key is typed.
"""

from __future__ import annotations

import inspect
import json
import re
from collections.abc import Iterator
from typing import Any

from pydantic import BaseModel

from thermodata.schema.answers import candidate, diagnosis, missing_heat, result
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.answers.result import FitResult
from thermodata.schema.files import campaign, campaign_channels, campaign_sources, campaign_tests, model
from thermodata.schema.files.campaign import Campaign
from thermodata.schema.files.model import Model

_DOCUMENTED = (
    campaign,
    campaign_channels,
    campaign_sources,
    campaign_tests,
    model,
    result,
    candidate,
    diagnosis,
    missing_heat,
)
_KEY = re.compile(r"^(\w+): (.+)$")


def documents() -> dict[str, str]:
    """File name -> text. Input files as they may be written, results as they are answered."""
    return {
        "campaign-1.schema.json": _schema(Campaign, "thermodata/campaign/1", "validation"),
        "model-1.schema.json": _schema(Model, "thermodata/model/1", "validation"),
        "fit-result.schema.json": _schema(FitResult, "thermodata fit, add, compare --json", "serialization"),
        "diagnosis.schema.json": _schema(Diagnosis, "thermodata diagnose --json", "serialization"),
    }


def models() -> dict[str, type[BaseModel]]:
    """Every model of the published files, by the name of its class."""
    return {
        name: kind
        for module in _DOCUMENTED
        for name, kind in vars(module).items()
        if isinstance(kind, type) and issubclass(kind, BaseModel) and kind.__module__ == module.__name__
    }


def described(kind: type[BaseModel]) -> tuple[str, dict[str, str]]:
    """(first paragraph, key -> meaning) of a model's docstring. Longer meanings go on in indented lines."""
    lead, _, rest = inspect.cleandoc(kind.__doc__ or "").partition("\n\n")
    return " ".join(lead.split()), dict(_keys(rest))


def _keys(text: str) -> Iterator[tuple[str, str]]:
    for entry in re.split(r"\n(?! )", text):
        if found := _KEY.match(" ".join(entry.split())):
            yield found[1], found[2]


def _schema(kind: type[BaseModel], title: str, mode: str) -> str:
    made = kind.model_json_schema(by_alias=True, mode="validation" if mode == "validation" else "serialization")
    known = models()
    _describe(made, kind)
    for name, part in made.get("$defs", {}).items():
        if name in known:
            _describe(part, known[name])
    made = {"$schema": "https://json-schema.org/draft/2020-12/schema", **made, "title": title}
    return json.dumps(made, indent=2, ensure_ascii=False) + "\n"


def _describe(part: dict[str, Any], kind: type[BaseModel]) -> None:
    """Puts the docstring's words into an object of the schema, and leaves out the titles that repeat each key."""
    part["description"], keys = described(kind)
    for key, value in part.get("properties", {}).items():
        value.pop("title", None)
        if key in keys:
            value["description"] = keys[key]
