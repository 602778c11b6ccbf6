"""The functions that the commands call, under the names of the commands. Each answers with what the next page needs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

from thermodata.store import Store
from thermodata.store.base.counting import Tell, watched

Task = Callable[..., dict[str, Any]]


def diagnose(store: Path, tell: Tell, model: str) -> dict[str, Any]:
    """`thermodata diagnose MODEL`."""
    from thermodata.diagnosis.run import diagnose as run

    found = run(Store(store), model, tell)
    return {"verdict": found.verdict, "onward": _to("/missing", model=found.model)}


def add(store: Path, tell: Tell, model: str, candidate: str) -> dict[str, Any]:
    """`thermodata add MODEL CANDIDATE...`. candidate: one a line."""
    from thermodata.modelling.add import add as run

    with watched(tell):
        result = run(Store(store), model, *candidate.splitlines())
    return {"model": result.model, "onward": _to("/compare", model=result.model)}


def confirm(store: Path, tell: Tell, model: str, candidate: str) -> dict[str, Any]:
    """`thermodata confirm MODEL CANDIDATE`."""
    from thermodata.diagnosis.choice import confirm_choice

    with watched(tell):
        found, _ = confirm_choice(Store(store), model, candidate)
    return {"holds": found.holds, "onward": _to("/confirm", model=found.model, candidate=found.candidate)}


def fit(store: Path, tell: Tell, path: str) -> dict[str, Any]:
    """`thermodata fit MODEL.yaml`."""
    from thermodata.modelling.run import fit as run
    from thermodata.schema.files.load import load_model

    with watched(tell):
        result = run(Store(store), load_model(Path(path)), base=Path(path).parent)
    return {"model": result.model, "onward": _to("/compare", model=result.model)}


def draft(store: Path, tell: Tell, folder: str) -> dict[str, Any]:
    """`thermodata init FOLDER`."""
    from thermodata.draft.make import draft_files
    from thermodata.store.catalogue.campaign_paths import campaign_paths

    held = campaign_paths(store)
    made = draft_files(Path(folder), progress=lambda done, of, path: tell("files", done, of), held=held)
    return {"questions": made.questions, "onward": _to("/start", file=str(made.campaign))}


def ingest(store: Path, tell: Tell, campaign: str) -> dict[str, Any]:
    """`thermodata ingest CAMPAIGN.yaml`."""
    from thermodata.report.words.causes import said_at_ingest
    from thermodata.store.ingest.run import ingest as run
    from thermodata.store.ingest.run import store_for

    found = run(store_for(store, Path(campaign)), campaign, _FilesTold(tell))
    summary = found.to_json()
    kept = {k: summary[k] for k in ("campaign", "tests", "files", "samples", "calibrations", "stale")}
    # what was lost, and what the engine wondered at, is read before anybody goes on
    return {"told": {**kept, **said_at_ingest(summary)}, "onward": _to("/", campaign=found.campaign)}


def report(store: Path, tell: Tell, model: str, out: str) -> dict[str, Any]:
    """`thermodata report MODEL --out FILE`."""
    from thermodata.report import build_report

    tell("page", 0, 1)
    page = build_report(Store(store), model, Path(out))
    return {"bytes": page.stat().st_size, "onward": _to("/report/file", name=page.name)}


TASKS: dict[str, Task] = {
    "draft": draft,
    "diagnose": diagnose,
    "add": add,
    "confirm": confirm,
    "fit": fit,
    "ingest": ingest,
    "report": report,
}


class _FilesTold:
    """An ingest's progress as counted files."""

    def __init__(self, tell: Tell) -> None:
        self._tell, self._files, self._done = tell, 0, 0

    def begin(self, files: int, size_bytes: int) -> None:
        self._files = files
        self._tell("files", 0, files)

    def samples(self, count: int) -> None:
        """Files are counted, for their number is known."""

    def done(self, path: str, size_bytes: int) -> None:
        self._done += 1
        self._tell("files", min(self._done, self._files), self._files)

    def say(self, text: str) -> None:
        if self._done >= self._files:
            self._tell(f"on one clock: {text}", 0, 0)


def _to(path: str, **state: str) -> str:
    return f"{path}?{urlencode(state)}"
