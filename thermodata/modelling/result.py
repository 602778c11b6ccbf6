"""From a fitted model to what `fit`, `add` and `compare` answer, and the id that names it."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

from thermodata.modelling.fitted import FittedModel
from thermodata.modelling.score import scores
from thermodata.schema.model import Model
from thermodata.schema.result import Check, FitResult, Score
from thermodata.view.dataset import Dataset

ID_LENGTH = 12


def model_id(spec: Model, data_version: str, base: Path | None = None) -> str:
    """Content-addressed: the spec, the data's version, and the files that the spec names."""
    text = json.dumps(spec.model_dump(mode="json", by_alias=True), sort_keys=True, ensure_ascii=False)
    digest = hashlib.sha256(f"{text}\n{data_version}".encode())
    for effect in spec.effects:
        if effect.file is not None:
            digest.update(((base or Path()) / effect.file).read_bytes())
    return digest.hexdigest()[:ID_LENGTH]


def make_result(
    fitted: FittedModel,
    data: Dataset,
    identity: str,
    *,
    parent: str | None = None,
    before: list[Score] | None = None,
    locked: bool = False,
) -> FitResult:
    names = [r.name for r in fitted.responses]
    skipped = [
        Check(name=f"skipped:{why.split(':')[0]}", value=None, threshold=None, passed=False, advice=why)
        for why in fitted.skipped
    ]
    return FitResult(
        model=identity,
        name=fitted.spec.name,
        parent=parent,
        campaigns=list(fitted.spec.campaign_ids),
        response=names[0] if len(names) == 1 else names,
        parameters=fitted.parameters(),
        scores=scores(fitted, data, identity, locked=locked),
        checks=[*fitted.checks(), *skipped],
        before=before,
    )
