"""A model of a store as a model file: what `fit` makes the same model of, effects, tests and choices included."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import yaml

from thermodata.errors import ThermodataError
from thermodata.schema.files.load import load_model
from thermodata.schema.files.model import Model
from thermodata.store.base.files import safe_name, whole_file


def model_text(spec: Model) -> str:
    """The text of model.yaml, one effect a line."""
    lines: list[str] = []
    for key, value in spec.model_dump(mode="json", by_alias=True, exclude_defaults=True).items():
        many = isinstance(value, list) and any(isinstance(one, dict) for one in value)
        lines += [f"{key}:", *(f"  - {_flow(one)}" for one in value)] if many else [f"{key}: {_flow(value)}"]
    return "\n".join(lines) + "\n"


def model_path(spec: Model, folder: Path, name: str | None = None) -> Path:
    """Where its file is written: of its name, or another one. Where a model of other campaigns has that file, its own
    come behind it: base_spring.yaml."""
    path = folder / f"{safe_name(name or spec.name)}.yaml"
    if name is not None or not _is_of_others(path, spec):
        return path
    return folder / f"{safe_name('_'.join([spec.name, *spec.campaign_ids]))}.yaml"


def _is_of_others(path: Path, spec: Model) -> bool:
    """Whether a file is that of a model of other campaigns."""
    if not path.is_file():
        return False
    try:
        return set(load_model(path).campaign_ids) != set(spec.campaign_ids)
    except ThermodataError:
        return False


def write_model(spec: Model, path: Path) -> Path:
    """Writes it, whole or not at all."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with whole_file(path, ".yaml") as part:
        part.write_text(model_text(spec), encoding="utf-8")
    return path


def _flow(value: Any) -> str:
    text: str = yaml.safe_dump(value, default_flow_style=True, width=10**9, allow_unicode=True, sort_keys=False)
    return text.strip().removesuffix("...").strip()
