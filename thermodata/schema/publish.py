"""The published JSON Schemas of the files that users write, from the pydantic models."""

from __future__ import annotations

import json

from pydantic import BaseModel

from thermodata.schema.campaign import Campaign
from thermodata.schema.model import Model
from thermodata.schema.result import Diagnosis, FitResult


def documents() -> dict[str, str]:
    """File name -> text. Input files as they may be written, results as they are answered."""
    return {
        "campaign-1.schema.json": _schema(Campaign, "thermodata/campaign/1", "validation"),
        "model-1.schema.json": _schema(Model, "thermodata/model/1", "validation"),
        "fit-result.schema.json": _schema(FitResult, "thermodata fit, add, compare --json", "serialization"),
        "diagnosis.schema.json": _schema(Diagnosis, "thermodata diagnose --json", "serialization"),
    }


def _schema(model: type[BaseModel], title: str, mode: str) -> str:
    made = model.model_json_schema(by_alias=True, mode="validation" if mode == "validation" else "serialization")
    made = {"$schema": "https://json-schema.org/draft/2020-12/schema", **made, "title": title}
    return json.dumps(made, indent=2, ensure_ascii=False) + "\n"
