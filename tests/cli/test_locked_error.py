"""`confirm MODEL` without an effect: the error of a model as it stands on the locked tests, a counted look."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import thermodata

from .conftest import Said

Say = Callable[..., Said]


def looks(say: Say, store: Path) -> int:
    return int(json.loads(say("--store", store, "sql", "select count(*) as n from locked_look", "--json").out)[0]["n"])


def test_a_finished_model_is_asked_on_the_locked_tests_and_each_look_is_counted(say: Say, own: Path) -> None:
    store = own / "thermodata.store"
    (row,) = json.loads(say("--store", store, "confirm", "baseline", "--json").out)
    (test,) = row["tests"]
    assert (test["test"], row["response"], row["unit"], row["looks"]) == ("day2", "dZ", "um", 1)
    assert test["rmse_um"] == row["rmse_um"] > test["shape_um"] > 0.3
    assert looks(say, store) == 1

    again = say("--store", store, "confirm", "baseline")
    assert again.code == 0
    assert "from the store" in again.err
    assert "as it stands" in again.out
    assert "opened 1 time so far" in again.out
    assert looks(say, store) == 1

    better = json.loads(say("--store", store, "add", "baseline", "feed_screw:T_nut_Z", "--json").out)["model"]
    both = json.loads(say("--store", store, "confirm", row["model"], better, "--json").out)
    assert [r["model"] for r in both] == [row["model"], better]
    assert both[1]["rmse_um"] < both[0]["rmse_um"] / 3
    assert looks(say, store) == 2, "the first was looked at before"
    assert thermodata.open(store).model(better).locked()[0].rmse_um == both[1]["rmse_um"]
    assert looks(say, store) == 2


def test_the_error_is_that_of_the_stored_parameters(say: Say, own: Path) -> None:
    store = own / "thermodata.store"
    (row,) = json.loads(say("--store", store, "confirm", "baseline", "--json").out)
    opened = thermodata.open(store)
    made = {p.test: p for p in opened.model("baseline").predict("campaign:small")}["day2"]
    measured = opened.binned("small", "day2", step="60 s").df()["dZ"].to_numpy()
    gap = measured - made.predicted
    assert row["shape_um"] == pytest.approx(np.std(gap), rel=0.02)
    assert row["rmse_um"] == pytest.approx(np.sqrt(np.mean((gap - gap[:10].mean()) ** 2)), rel=0.02)


def test_an_effect_is_still_an_effect_and_another_response_is_refused(say: Say, own: Path) -> None:
    store = own / "thermodata.store"
    held = json.loads(say("--store", store, "confirm", "baseline", "feed_screw:T_nut_Z", "--json").out)
    assert held["candidate"] == "feed_screw:T_nut_Z"
    assert say("--store", store, "confirm", "baseline", "1").code == 2
    assert say("--store", store, "confirm", "baseline", "--response", "dY").code == 2
    assert say("--store", store, "confirm", "baseline", "nobody", "baseline").code == 2


def test_predict_says_that_a_test_is_locked_and_which_command_tells_its_error(say: Say, own: Path) -> None:
    store = own / "thermodata.store"
    told = say("--store", store, "predict", "baseline", "campaign:small", "--test", "day2")
    assert "small/day2 is locked" in told.out
    assert "thermodata confirm" in told.out
    assert "is locked" not in say("--store", store, "predict", "baseline", "campaign:small", "--test", "day1").out
    answer = json.loads(say("--store", store, "predict", "baseline", "campaign:small", "--test", "day2", "--json").out)
    assert len(answer["locked"]) == 1
    assert looks(say, store) == 0


def test_without_a_locked_test_it_is_refused(say: Say, own: Path) -> None:
    store, path = own / "thermodata.store", own / "campaign.yaml"
    path.write_text(path.read_text().replace("role: locked", "role: verification"))
    say("--store", store, "ingest", path)
    model = json.loads(say("--store", store, "fit", own / "baseline.yaml", "--json").out)["model"]
    told = say("--store", store, "confirm", model)
    assert told.code == 2
    assert "no locked test" in told.err
