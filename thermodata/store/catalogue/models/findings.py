"""What was found out about a model: its diagnosis, further findings, and answers kept by what they were made from."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from pydantic import BaseModel

from thermodata.errors import StoreError
from thermodata.schema.answers.confirmed import Confirmed
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.schema.answers.locked_error import LockedError
from thermodata.store.base.connection import fetch, insert
from thermodata.store.base.moment import utc_now
from thermodata.store.catalogue.format.document import readable
from thermodata.store.catalogue.store import Store

if TYPE_CHECKING:
    import duckdb

# what a question, by its first word, is answered with
_DOCUMENTS: Mapping[str, type[BaseModel]] = {"diagnose": Diagnosis, "confirm": Confirmed, "locked": LockedError}
_OF_A_DIAGNOSIS = ("diagnosis", "weak_spot", "candidate", "artefact")


def save_diagnosis(store: Store, model: str, diagnosis: Diagnosis) -> None:
    """Keeps a diagnosis in place of the model's earlier one: as a whole, and each finding as a row."""
    rows = [_row("diagnosis", diagnosis.model_dump_json())]
    for i, spot in enumerate(diagnosis.weak_spots, 1):
        rows.append(_row("weak_spot", spot.model_dump_json(), spot.campaign, spot.test, i))
    for candidate in diagnosis.candidates:
        rows.append(_row("candidate", candidate.model_dump_json(), rank=candidate.rank))
    for i, artefact in enumerate(diagnosis.artefacts, 1):
        rows.append(_row("artefact", artefact.model_dump_json(), artefact.campaign, artefact.test or "", i))
    _replace_findings(store, model, _OF_A_DIAGNOSIS, rows)


def load_diagnosis(store: Store, model: str) -> Diagnosis | None:
    """The model's latest diagnosis; None where there is none, or one of another version that is to be asked again."""
    with store.reader() as con:
        rows = fetch(
            con,
            "select payload from finding where model = ? and kind = 'diagnosis' order by created_at desc limit 1",
            [model],
        )
    return readable(Diagnosis, rows[0]["payload"]) if rows else None


def save_findings(store: Store, model: str, kind: str, rows: Iterable[tuple[str, str, Mapping[str, Any]]]) -> None:
    """Keeps findings of another kind ("portability"): (campaign, test, payload), in place of the earlier ones."""
    _replace_findings(
        store, model, [kind], [_row(kind, json.dumps(dict(p)), c, t, i) for i, (c, t, p) in enumerate(rows, 1)]
    )


def keep_answer(store: Store, model: str, question: str, key: str, payload: str) -> None:
    """Keeps what was answered, for as long as the key of what it was made from stays the same. question: such as
    "diagnose"; payload: JSON."""
    kind = f"answer:{question}"
    _replace_findings(store, model, [kind], [_row(kind, json.dumps({"key": key, "answer": json.loads(payload)}))])


def kept_answer(store: Store, model: str, question: str, key: str | None = None) -> str | None:
    """The JSON of an answer that was made from the same; None where there is none, it is of another key, or another
    version wrote it in other words. Without a key: what was answered last."""
    with store.reader() as con:
        rows = fetch(con, "select payload from finding where model = ? and kind = ?", [model, f"answer:{question}"])
    kept = json.loads(rows[0]["payload"]) if rows else None
    if kept is None or key not in (None, kept["key"]):
        return None
    answer, kind = json.dumps(kept["answer"]), _DOCUMENTS.get(question.partition(" ")[0])
    return answer if kind is None or readable(kind, answer) is not None else None


def _row(kind: str, payload: str, campaign: str = "", test: str = "", rank: int | None = None) -> dict[str, Any]:
    return {"campaign": campaign, "test": test, "kind": kind, "rank": rank, "payload": payload}


def _replace_findings(store: Store, model: str, kinds: Sequence[str], rows: Sequence[Mapping[str, Any]]) -> None:
    """In place of all of these kinds. StoreError where the model is gone."""
    at = utc_now()
    with store.write(views=False) as con:
        _must_exist(con, model)
        con.execute(f"delete from finding where model = ? and kind in ({', '.join('?' * len(kinds))})", [model, *kinds])
        insert(con, "finding", [{**row, "model": model, "created_at": at} for row in rows])


def _must_exist(con: duckdb.DuckDBPyConnection, model: str) -> None:
    if not con.execute("select 1 from model where model = ?", [model]).fetchone():
        raise StoreError(f"model '{model}' is not in the store any more", hint="fit it again")
