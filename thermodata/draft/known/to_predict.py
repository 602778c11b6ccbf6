"""What a model is to predict: a campaign of the store, a campaign file, or a folder of logs like the model's own."""

from __future__ import annotations

import glob
import tempfile
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from thermodata.draft.known.of_logs import as_list
from thermodata.errors import UsageError, unknown_name

if TYPE_CHECKING:
    from thermodata.modelling.compare.ahead import Ahead
    from thermodata.modelling.predictions.predict import Predicted
    from thermodata.modelling.run import Loaded
    from thermodata.modelling.terms.fitted import FittedModel
    from thermodata.schema.files.campaign import Campaign
    from thermodata.store import Store
    from thermodata.store.ingest.progress import Progress
    from thermodata.view.grid.dataset import Dataset


OF_STORE = "campaign:"  # before the id of a campaign, where a path is called so too


@dataclass(frozen=True, slots=True)
class ToPredict:
    """What is to be predicted. target: a campaign of the store, a campaign file, a folder of logs, or one of these;
    tests: none but these, where any are named; conditions: of all tests, beside their own or in place of them."""

    target: str
    tests: Collection[str] = ()
    conditions: Mapping[str, str | float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Listener:
    """Who is told while logs are read. say: of losses; progress: how far it is."""

    say: Callable[[str], object]
    progress: Progress | None = None


@contextmanager
def data_of(store: Store, fitted: FittedModel, target: str, listener: Listener) -> Iterator[tuple[Dataset, list[str]]]:
    """The tests of a campaign of the store; of a campaign file or a folder, through a store that goes again. And tests
    without data."""
    path = Path(target)
    with store.reader() as con:
        known = [str(row[0]) for row in con.execute("select campaign from campaign order by 1").fetchall()]
    said = target.startswith(OF_STORE) and target not in known and not path.exists()
    campaign = target.removeprefix(OF_STORE) if said else target
    if said and campaign not in known:
        raise unknown_name("campaign", campaign, known)
    if path.exists() and campaign in known:
        raise UsageError(
            f"'{target}' is a campaign of the store and a path",
            hint=f"./{target} is the path alone, {OF_STORE}{target} the campaign",
        )
    if campaign in known:
        yield _loaded(store, campaign, fitted.spec.step)
        return
    if not path.exists():
        raise UsageError(
            f"no folder, campaign file or campaign '{target}'",
            expected="a path, or a campaign of the store: " + ", ".join(known),
            got=target,
            hint="check the path, or 'thermodata tests' for the campaigns of the store",
        )
    with tempfile.TemporaryDirectory(prefix="thermodata-predict-") as folder:
        passing, campaign = _ingested(store, fitted, path, Path(folder), listener)
        yield _loaded(passing, campaign, fitted.spec.step)


@dataclass(frozen=True, slots=True)
class LogsPredicted:
    """A model on other logs. loaded: it on the tests that it was fitted to and checked on; band: what these say of how
    far a prediction may be off; made: the predictions, each with its band; left_out: why tests are."""

    loaded: Loaded
    band: Ahead
    made: list[Predicted]
    left_out: list[str]


def predict_logs(store: Store, model: str, asked: ToPredict, listener: Listener) -> LogsPredicted:
    """A model of the store on the tests that are asked for. UsageError for an unknown test, and where there is none."""
    from thermodata.modelling.compare.ahead import ahead
    from thermodata.modelling.on_its_tests import on_its_tests
    from thermodata.modelling.run import load

    loaded = on_its_tests(store, load(store, model, uncertainty=True))
    band = ahead(loaded.fitted, loaded.data, kept=loaded.kept)
    made, left_out = _predicted(store, loaded.fitted, asked, listener)
    return LogsPredicted(loaded, band, [band.of(p) for p in made], left_out)


def _predicted(
    store: Store, fitted: FittedModel, asked: ToPredict, listener: Listener
) -> tuple[list[Predicted], list[str]]:
    from thermodata.modelling.predictions.conditions import under
    from thermodata.modelling.predictions.predict import predict

    with data_of(store, fitted, asked.target, listener) as (data, empty):
        known = [t.test for t in data.tests]
        for name in asked.tests:
            if name not in known:
                raise unknown_name("test", name, known)
        chosen = replace(data, tests=tuple(t for t in data.tests if not asked.tests or t.test in asked.tests))
        made, left_out = predict(fitted, under(chosen, asked.conditions))
    left_out += [f"{name}: nothing in its logs is read by the model" for name in empty if not asked.tests]
    if not made and not left_out:
        raise UsageError(
            "no test can be predicted",
            where=asked.target,
            got="no test",
            hint="name a campaign with tests, or a folder with logs",
        )
    return made, left_out


def _loaded(store: Store, campaign: str, step_s: float) -> tuple[Dataset, list[str]]:
    from thermodata.modelling.inputs.coarse_readings import drawn
    from thermodata.view.grid.load import load_dataset

    data = drawn(load_dataset(store, campaign, step_s))
    with store.reader() as con:
        rows = con.execute("select test from test where campaign = ? order by rowid", [campaign]).fetchall()
    there = {t.test for t in data.tests}
    return data, [f"{campaign}/{row[0]}" for row in rows if row[0] not in there]


def _ingested(store: Store, fitted: FittedModel, path: Path, folder: Path, listener: Listener) -> tuple[Store, str]:
    """(a store in the folder that holds what is at the path, the id of its campaign)."""
    from thermodata.draft.known.of_logs import campaign_of_logs
    from thermodata.modelling.inputs.drivers import names_of
    from thermodata.store import Store
    from thermodata.store.ingest.run import ingest
    from thermodata.store.trace.replan import read_campaign

    passing = Store(folder / "store", create=True)
    log = path.is_file() and path.suffix.lower() not in (".yaml", ".yml")
    file = None if log else path if path.is_file() else _campaign_file(path)
    if file is not None:
        summary = ingest(passing, file, progress=listener.progress)
    else:
        first = fitted.spec.campaign_ids[0]
        terms = [t for r in fitted.responses for t in r.terms]
        needed = {n for t in terms for text in t.binding.values() for n in names_of(text)}
        with store.reader() as con:
            known = read_campaign(con, first)
        folder_of_logs = path.parent if log else path
        made = campaign_of_logs(known, folder_of_logs, needed)
        if log:
            made = _of_log(made, path)
        summary = ingest(passing, folder_of_logs / "campaign.yaml", progress=listener.progress, campaign=made)
    for loss in summary.losses:
        listener.say(f"loss: {loss.get('reason', loss)}")
    return passing, summary.campaign


def _of_log(campaign: Campaign, log: Path) -> Campaign:
    """The test of one log, with the logs of its other sources beside it."""
    own = glob.escape(log.name)
    tests = [t for t in campaign.tests if any(own in as_list(files) for files in t.files.values())]
    if not tests:
        raise UsageError(
            "the log fits no source of the model's campaign",
            where=str(log),
            expected=", ".join(", ".join(as_list(s.files)) for s in campaign.sources.values()),
            got=log.name,
            hint="name it like these, or predict a folder of logs or a campaign file",
        )
    return campaign.model_copy(update={"tests": tests})


def _campaign_file(folder: Path) -> Path | None:
    found = [
        p
        for p in sorted(folder.glob("*.y*ml"))
        if p.suffix in (".yaml", ".yml") and "thermodata/campaign/" in p.read_text("utf-8", "replace")[:2000]
    ]
    if len(found) > 1:
        raise UsageError(
            "several campaign files in the folder",
            where=str(folder),
            got=", ".join(p.name for p in found),
            hint="name the one that is meant",
        )
    return found[0] if found else None
