"""What to do after an ingest, until the campaign has a model: a command is named only where nothing known stops it."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from thermodata.errors import ThermodataError
from thermodata.schema.load import load_model
from thermodata.schema.model import Model

if TYPE_CHECKING:
    import duckdb

    from thermodata.store import Store

_CHANNEL = re.compile(r"\bchannel '(\w+)'")


def next_step(store: Store, summary: Mapping[str, Any], campaign: Path) -> str | None:
    """What leads to a model; to samples, where the campaign has none of these. None where it has a model. summary: of
    the ingest, as its JSON; campaign: the file."""
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
        lost = [one for one in _lost_everywhere(con, name, summary["losses"]) if model is None or _reads(model, one)]
        unfitted = _nothing_to_fit(con, (name,) if model is None else model.campaign_ids, model)
    fit = f"thermodata fit {path}"
    if lost:
        whose = f"{path} reads" if model is not None else "a first model may read"
        return f"next: mend {' and '.join(c['name'] for c in lost)}, which {whose} and every test lost, {again}"
    make = "" if path.exists() else f"thermodata first-model {campaign} drafts {path}; "
    if unfitted:
        return (
            f"next: give the tests roles in {campaign}, for none has 'role: calibration' and there is nothing to fit "
            f"(role: verification for those that judge the model); {again}; {make}{fit}"
        )
    return f"next: {make}{fit}"


def _read(path: Path) -> Model | None:
    """The model file beside the campaign; None where there is none, or one that `fit` will refuse with its line."""
    try:
        return load_model(path) if path.exists() else None
    except ThermodataError:
        return None


def _lost_everywhere(
    con: duckdb.DuckDBPyConnection, campaign: str, losses: Sequence[Mapping[str, Any]]
) -> list[dict[str, Any]]:
    """The channels that losses name and that no test has, each as the campaign file declares it."""
    had = {c for (c,) in con.execute("select distinct channel from channel where campaign = ?", [campaign]).fetchall()}
    row = con.execute("select spec from campaign where campaign = ?", [campaign]).fetchone()
    declared: dict[str, Any] = json.loads(row[0]).get("channels", {}) if row else {}
    named = dict.fromkeys(name for loss in losses for name in _CHANNEL.findall(loss["reason"]))
    return [{**declared[name], "name": name} for name in named if name in declared and name not in had]


def _reads(model: Model, channel: Mapping[str, Any]) -> bool:
    """Whether a model file names a channel, or models a displacement at its place."""
    for response in model.responses:
        of_axis = response.axis is not None and response.axis == channel.get("axis")
        if of_axis and response.at in (None, channel.get("at")):
            return True
    said = json.dumps([r.channel for r in model.responses]) + "".join(e.model_dump_json() for e in model.effects)
    return re.search(rf"\b{channel['name']}\b", said) is not None


def _nothing_to_fit(con: duckdb.DuckDBPyConnection, campaigns: Sequence[str], model: Model | None) -> bool:
    """Whether no test is fitted: neither by its role nor because the model file names it."""
    if model is not None and model.calibrate_on is not None:
        return False
    asked = "select 1 from test where role = 'calibration' and list_contains(?, campaign) limit 1"
    return con.execute(asked, [list(campaigns)]).fetchone() is None
