"""Fitted models and their predictions; what was found out about them: `findings`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from thermodata.errors import UsageError, nearest
from thermodata.schema.answers.result import FitResult
from thermodata.schema.files.model import Model
from thermodata.store.base.connection import fetch, insert
from thermodata.store.base.moment import utc_now
from thermodata.store.catalogue.format.document import read_document
from thermodata.store.catalogue.models.prediction_files import write_prediction
from thermodata.store.catalogue.models.renamed import renamed, with_names
from thermodata.store.catalogue.store import Store

if TYPE_CHECKING:
    import duckdb
    import pyarrow as pa

STALE = "stale"  # the kind of finding that says what changed in a test since the fit; among its words:
GONE, BACK = "gone", "gone for a while"  # BACK: there again, without the results of the fit


@dataclass(frozen=True, slots=True)
class StoredModel:
    """A version of a model. stale: its data changed since it was fitted; data_version: of what it was fitted to;
    renamed: name of a channel in the fit -> name now, which the spec has."""

    model: str
    name: str
    parent: str | None
    spec: Model
    result: FitResult
    stale: bool
    data_version: str = ""
    renamed: Mapping[str, str] = field(default_factory=dict)


def save_fit(
    store: Store,
    *,
    spec: Model,
    result: FitResult,
    parent: str | None,
    predictions: Mapping[tuple[str, str, str], pa.Table],
    data_version: str,
    check: Callable[[duckdb.DuckDBPyConnection], None] = lambda con: None,
) -> str:
    """Keeps a fit and its predictions ((campaign, test, response) -> table); returns the model's id. check: is asked in
    the turn that keeps it, and raises where it is not to be kept.

    The same model again replaces its figures and keeps its place in the history. Prediction columns: t_s,
    measured, predicted, residual, valid, and `c__<term>` for each effect's contribution.
    """
    model, now = result.model, utc_now()
    written = [
        (key, write_prediction(store.path, model, key, table), table.num_rows)
        for key, table in sorted(predictions.items())
    ]
    with store.write() as con:
        check(con)
        old = fetch(con, "select parent, created_at from model where model = ?", [model])
        _delete_fit(con, model)
        row = {
            "model": model,
            "name": result.name,
            "parent": parent if parent is not None or not old else old[0]["parent"],
            "campaigns": list(result.campaigns),
            "response": result.response if isinstance(result.response, str) else ", ".join(result.response),
            "spec": spec.model_dump_json(by_alias=True, exclude_none=True),
            "data_version": data_version,
            "stale": False,
            "created_at": old[0]["created_at"] if old else now,
            "result": result.model_dump_json(),
        }
        insert(con, "model", [row])
        insert(con, "fit", _parameters(result))
        insert(con, "score_row", [{**s.model_dump(), "model": model} for s in result.scores])
        files = [
            {"campaign": c, "test": t, "model": model, "response": r, "path": path, "rows": rows}
            for (c, t, r), path, rows in written
        ]
        insert(con, "prediction", files)
    return model


def _delete_fit(con: duckdb.DuckDBPyConnection, model: str) -> None:
    """The rows of a model's last fit; what was found out about it stays, but for what is stale."""
    for table in ("fit", "score_row", "prediction"):
        con.execute(f"delete from {table} where model = ?", [model])
    con.execute("delete from model where model = ?", [model])
    con.execute("delete from finding where model = ? and kind = ?", [model, STALE])


def _parameters(result: FitResult) -> list[dict[str, object]]:
    """Rows of `fit`. response: None where the model has several."""
    response = result.response if isinstance(result.response, str) else None
    return [
        {
            "model": result.model,
            "response": response,
            "parameter": name,
            "value": p.value,
            "unit": p.unit,
            "low": p.low,
            "high": p.high,
        }
        for name, p in result.parameters.items()
    ]


def find_model(store: Store, ref: str) -> StoredModel:
    """A model by id, unique prefix of an id, name (its newest version), or 'campaign/name'; UsageError where none or
    several fit."""
    with store.reader() as con:
        listed = fetch(con, "select model, name, campaigns from model order by created_at desc, model")
        ids = [r["model"] for r in listed]
        named = _of_name(listed, ref)
        begun = [m for m in ids if m.startswith(ref)] if ref else []
        if ref in ids:
            chosen = ref
        elif named:
            chosen = named[0]
        elif len(begun) == 1:
            chosen = begun[0]
        elif begun:
            raise UsageError(
                f"'{ref}' begins the ids of several models",
                expected=", ".join(begun),
                got=ref,
                hint="write more of the id",
            )
        else:
            names = list(dict.fromkeys(r["name"] for r in listed))
            close = nearest(ref, names)
            raise UsageError(
                f"no model '{ref}'",
                expected=", ".join(names) or "nothing: no model was fitted yet",
                got=ref,
                hint=f"did you mean '{close}'?" if close else _other_way(names),
            )
        return _stored(con, chosen)


def _of_name(rows: Sequence[Mapping[str, Any]], ref: str) -> list[str]:
    """Ids of the models of a name, or of 'campaign/name' ('one,other/name' of a model of both), in the order of rows.
    Of a campaign that models have with others too, those of it alone come first."""
    if plain := [r["model"] for r in rows if r["name"] == ref]:
        return plain
    of, _, name = ref.rpartition("/")
    wanted = {c.strip() for c in of.split(",")} if of else set()
    having = [r for r in rows if wanted and r["name"] == name and wanted <= set(r["campaigns"])]
    return [r["model"] for r in sorted(having, key=lambda r: set(r["campaigns"]) != wanted)]


def _other_way(names: Sequence[str]) -> str:
    return "thermodata models lists all versions, with their ids" if names else "thermodata fit MODEL.yaml"


def model_chain(store: Store, model: str) -> list[StoredModel]:
    """A model and the versions that it came from, oldest first."""
    chain = [find_model(store, model)]
    with store.reader() as con:
        while (parent := chain[-1].parent) is not None and parent not in {m.model for m in chain}:
            if not con.execute("select 1 from model where model = ?", [parent]).fetchone():
                break  # forgotten since
            chain.append(_stored(con, parent))
    return chain[::-1]


def _stored(con: duckdb.DuckDBPyConnection, model: str) -> StoredModel:
    row = fetch(con, "select * from model where model = ?", [model])[0]
    spec = read_document(Model, row["spec"], f"model {model}")
    names = renamed(con, spec.campaign_ids, model) if row["stale"] else {}
    return StoredModel(
        row["model"],
        row["name"],
        row["parent"],
        with_names(spec, names) if names else spec,
        read_document(FitResult, row["result"], f"the fit of {model}"),
        bool(row["stale"]),
        row["data_version"],
        names,
    )
