"""What an address names and the store does not know is refused with what there is, and never another model shown."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.store import Store
from thermodata.view.lists.models import model_rows

from .client import Client

PAGES = [
    "/?",
    "/missing?",
    "/compare?",
    "/report?",
    "/test?campaign=small&test=heat1&",
    "/test/data?campaign=small&test=heat1&",
    "/test/range?campaign=small&test=heat1&from=0&to=3600&",
]


@pytest.mark.parametrize("page", PAGES)
def test_an_unknown_model_is_refused_with_the_models_that_there_are(reader: Client, page: str) -> None:
    answer = reader.get(page + "model=zzz")
    assert answer.status == 400
    assert "No model &#39;zzz&#39;" in answer.text
    assert "baseline" in answer.text
    assert "model=zzz" not in answer.text, "no link leads on to it"


@pytest.mark.parametrize("page", PAGES)
def test_a_model_is_known_by_id_name_or_the_beginning_of_its_id(reader: Client, made_lab: Path, page: str) -> None:
    (model,) = model_rows(Store(made_lab / "thermodata.store"))
    for named in (model.model, "baseline", model.model[:6], "", "none"):
        assert reader.get(f"{page}model={named}").status == 200


def test_one_unknown_among_models_that_are_compared_is_refused(reader: Client) -> None:
    assert reader.get("/compare?model=baseline&model=zzz").status == 400
    assert reader.get("/compare?model=baseline&pin=zzz").status == 400
    assert reader.get("/compare?model=baseline&pin=baseline").status == 200


@pytest.mark.parametrize("candidate", ["zz", "99", "feed_screw:T_nope", "gain_by:zz,conditions.speed"])
def test_a_candidate_that_there_is_not_cannot_be_added(reader: Client, candidate: str) -> None:
    answer = reader.get(f"/add?model=baseline&candidate={candidate}")
    assert answer.status == 400
    assert "Add it" not in answer.text


def test_a_candidate_of_ones_own_can(reader: Client) -> None:
    assert reader.get("/add?model=baseline&candidate=1").status == 200
    own = reader.get("/add?model=baseline&candidate=spindle_motor:T_bearing")
    assert own.status == 200, own.text
    assert "a choice of your own" in own.text
