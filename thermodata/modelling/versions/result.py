"""From a fitted model to what `fit`, `add` and `compare` answer, and the id that names it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path

from thermodata.modelling.compare.common import lost_tests
from thermodata.modelling.predictions.score import ALL, FEWEST, scores
from thermodata.modelling.seen.doubtful_clocks import doubtful_clocks
from thermodata.modelling.terms.fitted import FittedModel
from thermodata.modelling.trust.checks.started_on import started_on_checks
from thermodata.schema.answers.result import Check, FitResult, Score
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import Dataset

ID_LENGTH = 12
# keys of an effect that ids of models without them do not know
_LATER = frozenset({"response", "phases", "also", "groups", "one_gain", "name", "gain", "inside", "parts", "acts_on"})


def model_id(spec: Model, data_version: str, base: Path | None = None) -> str:
    """Content-addressed: the spec, the data's version, and the files that the spec names."""
    content = spec.model_dump(mode="json", by_alias=True)
    for effect in content["effects"]:
        for key in _LATER & effect.keys():
            if effect[key] is None or effect[key] is False or effect[key] in ({}, []):
                del effect[key]
    for key in ("weights", "taken_back", "in_sample_on"):
        if not content[key]:
            del content[key]
    text = json.dumps(content, sort_keys=True, ensure_ascii=False)
    digest = hashlib.sha256(f"{text}\n{data_version}".encode())
    for given in spec.effects:
        if given.file is not None:
            digest.update(((base or Path()) / given.file).read_bytes())
    return digest.hexdigest()[:ID_LENGTH]


def make_result(
    fitted: FittedModel,
    data: Dataset,
    identity: str,
    *,
    parent: str | None = None,
    before: list[Score] | None = None,
) -> FitResult:
    """The answer of a fit. identity: the model's id; before: the scores of its parent. Locked tests have no score."""
    names = [r.name for r in fitted.responses]
    lacking: dict[str, list[str]] = {}  # a test may lack something for each of several responses
    for why in fitted.skipped:
        lacking.setdefault(why.split(":")[0], []).append(why)
    skipped = [
        Check(name=f"skipped:{test}", value=None, threshold=None, passed=False, advice="; ".join(why))
        for test, why in lacking.items()
    ]
    rows = scores(fitted, data, identity)
    started = started_on_checks(fitted, data)
    checks = [*fitted.checks(), *_clocks(fitted, data), *started, *skipped]
    checks += [*_not_predicted(fitted, data), *_not_scored(rows)]
    return FitResult(
        model=identity,
        name=fitted.spec.name,
        parent=parent,
        campaigns=list(fitted.spec.campaign_ids),
        response=names[0] if len(names) == 1 else names,
        parameters=fitted.parameters(),
        scores=rows,
        checks=checks,
        before=before,
        lost=None if before is None else lost_tests(before, rows, checks),
    )


def _clocks(fitted: FittedModel, data: Dataset) -> list[Check]:
    return [
        Check(
            name=f"clock_doubtful:{one.source}",
            value=None,
            threshold=None,
            passed=False,
            advice=f"{one.sentence}; it may lie minutes off, and is fitted as it stands: thermodata quality says how "
            "its log lies beside the other; declare clock: {{offset: ...}} of the source, or clocks of the test, by "
            "what both logs show, then ingest and fit again, or leave the test out of calibrate_on",
        )
        for one in doubtful_clocks(fitted, data)
    ]


def _not_predicted(fitted: FittedModel, data: Dataset) -> list[Check]:
    """Tests of the model that have no score, and why: none vanishes without a word. Of locked ones too, which silently
    could bear out no claim."""
    said = {why.split(":")[0] for why in fitted.skipped}
    rows = []
    for test in (*fitted.tests(data), *fitted.tests(data, "locked")):
        name = f"{test.campaign}/{test.test}"
        reasons = [f"{r.name}: {why}" for r in fitted.responses if (why := r.why_not(test)) is not None]
        if reasons and name not in said:
            rows.append(
                Check(name=f"not_predicted:{name}", value=None, threshold=None, passed=False, advice="; ".join(reasons))
            )
    return rows


def _not_scored(rows: Sequence[Score]) -> list[Check]:
    """Tests that the model predicts and that say nothing of it: too few of their samples count."""
    return [
        Check(
            name=f"not_scored:{row.campaign}/{row.test}"
            + ("" if len({r.response for r in rows}) == 1 else f":{row.response}"),
            value=float(row.n),
            threshold=float(FEWEST),
            passed=False,
            advice=("one of its samples counts, which gives its offset: " if row.n else "none of its samples counts: ")
            + "the model's phases, the test's measuring, or flags leave no more",
        )
        for row in rows
        if row.phase == ALL and row.n < FEWEST
    ]
