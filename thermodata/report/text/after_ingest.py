"""What to do after an ingest, until the campaign has a model: a command is named only where nothing known stops it."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.effect.places import holds
from thermodata.errors import ThermodataError
from thermodata.modelling.inputs.drivers import names_of
from thermodata.schema.files.load import load_model, parse_model
from thermodata.schema.files.model import Driver, Model, Place, Response
from thermodata.schema.strict.lines import read_document
from thermodata.schema.units.quantity import NOT_DRIVERS, PROBED
from thermodata.schema.words.sentences import listed

if TYPE_CHECKING:
    import duckdb

    from thermodata.store import Store

_CHANNEL = re.compile(r"\bchannel '(\w+)'")
_FILLED = """select distinct unnest(json_extract_string("columns", '$.filled[*]')) from file
where campaign = ? and layer = 'tidy'"""


def next_step(
    store: Store,
    summary: Mapping[str, Any],
    campaign: Path,
    draft: Callable[[], str | None],
    is_drafted: Callable[[str], bool],
) -> str | None:
    """What leads to a model; to samples, where the campaign has none of these. None where it has a model. summary: of
    the ingest, as its JSON; campaign: the file; draft: the text of its first model; is_drafted: whether the text of a
    model file stands as some draft had it."""
    again = f"then thermodata ingest {campaign} again"
    if not summary["samples"]:
        # where nothing was lost, it has no tests yet, as a note says
        return f"next: mend what was lost, {again}" if summary["losses"] else None
    path = campaign.with_name("model.yaml")
    model = _read(path)
    with store.reader() as con:
        name = summary["campaign"]
        if con.execute("select 1 from model where list_contains(campaigns, ?) limit 1", [name]).fetchone():
            return None
        lost = _lost_everywhere(con, name, summary["losses"])
        stored = [c for (c,) in con.execute("select campaign from campaign order by rowid").fetchall()]
        unfitted = _nothing_to_fit(con, (name,) if model is None else model.campaign_ids, model)
    fit = f"thermodata fit {path}"
    if model is not None and (strange := [c for c in model.campaign_ids if c not in stored]):
        return f"next: {_of_no_campaign(path, strange, stored, name)}, then {fit}"
    asking = model
    if lost and not path.exists():
        text = draft()
        asking = None if text is None else parse_model(text)
    if asking is not None and (read := [one["name"] for one in lost if _reads(asking, one)]):
        whose = f"{path} reads" if path.exists() else "a first model reads"
        return f"next: mend {' and '.join(read)}, which {whose} and every test lost, {again}"
    make = f"thermodata first-model {campaign} drafts {path}; " if _to_draft(path, draft, is_drafted) else ""
    if unfitted:
        return (
            f"next: give the tests roles in {campaign}, for none has 'role: calibration' and there is nothing to fit "
            f"(role: verification for those that judge the model); {again}; {make}{fit}"
        )
    return f"next: {make}{fit}"


def _to_draft(path: Path, draft: Callable[[], str | None], is_drafted: Callable[[str], bool]) -> bool:
    """Whether there is no model file, or one as it was drafted before the campaign file was answered."""
    if not path.exists():
        return True
    try:
        there = path.read_text("utf-8")
    except (OSError, UnicodeDecodeError):  # `fit` says what is wrong with it
        return False
    return is_drafted(there) and (text := draft()) is not None and text != there


def _read(path: Path) -> Model | None:
    """The model file beside the campaign; None where there is none, or one that `fit` will refuse with its line."""
    try:
        return load_model(path) if path.exists() else None
    except ThermodataError:
        return None


def _of_no_campaign(path: Path, strange: Sequence[str], stored: Sequence[str], campaign: str) -> str:
    """What to change in a model file whose campaigns the store does not have."""
    document = read_document(path)
    key = next(k for k in ("campaign", "campaigns") if k in document.data)
    wrong, there = (listed([f"'{c}'" for c in some]) for some in (strange, stored))
    return f"write '{campaign}' in place of {wrong} at {document.where((key,))}, for the store has {there}"


def _lost_everywhere(
    con: duckdb.DuckDBPyConnection, campaign: str, losses: Sequence[Mapping[str, Any]]
) -> list[dict[str, Any]]:
    """The channels that losses name and of which no test has a value, each as the campaign file declares it."""
    had = {c for (c,) in con.execute(_FILLED, [campaign]).fetchall()}
    row = con.execute("select spec from campaign where campaign = ?", [campaign]).fetchone()
    declared: dict[str, Any] = json.loads(row[0]).get("channels", {}) if row else {}
    named = dict.fromkeys(name for loss in losses for name in _CHANNEL.findall(loss["reason"]))
    return [{**declared[name], "name": name} for name in named if name in declared and name not in had]


def _reads(model: Model, channel: Mapping[str, Any]) -> bool:
    """Whether a model names a channel, as a response or in what drives an effect, or means it by its place."""
    responses = [*model.responses]
    for effect in model.effects:
        responses += [*(effect.acts_on or ()), *filter(None, [effect.response])]
        if any(_drives(driver, channel) for driver in effect.drivers.values()):
            return True
    return any(_is_response(one, channel) for one in responses)


def _is_response(response: Response, channel: Mapping[str, Any]) -> bool:
    if response.channel is not None:
        return bool(response.channel == channel["name"])
    if channel.get("quantity") not in PROBED or channel.get("axis") != response.axis:
        return False
    return response.at is None or holds(response.at, channel.get("at"))


def _drives(driver: Driver, channel: Mapping[str, Any]) -> bool:
    if isinstance(driver, Place):
        return channel.get("quantity") not in NOT_DRIVERS and holds(driver.at, channel.get("at"))
    try:
        return channel["name"] in names_of(driver)
    except ThermodataError:  # `fit` refuses it with its line
        return False


def _nothing_to_fit(con: duckdb.DuckDBPyConnection, campaigns: Sequence[str], model: Model | None) -> bool:
    """Whether no test is fitted: neither by its role nor because the model file names it."""
    if model is not None and model.calibrate_on is not None:
        return False
    asked = "select 1 from test where role = 'calibration' and list_contains(?, campaign) limit 1"
    return con.execute(asked, [list(campaigns)]).fetchone() is None
