"""A model of a store as a model file: what `fit` makes the same model of, effects, tests and choices included."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from thermodata.schema.files.model import Model
from thermodata.store.base.files import safe_name, whole_file


def model_text(spec: Model) -> str:
    """The text of model.yaml, one effect a line."""
    lines: list[str] = []
    for key, value in spec.model_dump(mode="json", by_alias=True, exclude_defaults=True).items():
        many = isinstance(value, list) and any(isinstance(one, dict) for one in value)
        lines += [f"{key}:", *(f"  - {_flow(one)}" for one in value)] if many else [f"{key}: {_flow(value)}"]
    return "\n".join(lines) + "\n"


def model_path(spec: Model, folder: Path) -> Path:
    """Where its file is written."""
    return folder / f"{safe_name(spec.name)}.yaml"


def write_model(spec: Model, folder: Path) -> Path:
    """Writes it, whole or not at all."""
    path = model_path(spec, folder)
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path, ".yaml") as part:
        part.write_text(model_text(spec), encoding="utf-8")
    return path


def _flow(value: Any) -> str:
    text: str = yaml.safe_dump(value, default_flow_style=True, width=10**9, allow_unicode=True, sort_keys=False)
    return text.strip().removesuffix("...").strip()
