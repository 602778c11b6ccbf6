"""What earlier claims left on the locked tests speaks against "nothing is missing" (locked/left_on_locked.py)."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from thermodata.diagnosis.locked.left_on_locked import contradicted, left_on_locked, shape_left_on_locked
from thermodata.diagnosis.verdict.judged import Judgement
from thermodata.schema.answers.diagnosis import ClockMoved, PutRight
from thermodata.schema.files.model import EffectSpec, Model
from thermodata.store.catalogue.models import findings
from thermodata.store.catalogue.models import fits as catalogue
from thermodata.view.grid.dataset import ChannelInfo

CHANNELS = {n: ChannelInfo(n, "temperature", "degC") for n in ("T_a", "T_b")}
BASE = Model.model_validate(
    {
        "schema": "thermodata/model/1",
        "name": "base",
        "campaign": "shop",
        "response": {"axis": "Z", "at": "tcp"},
        "step": "30 s",
        "effects": [{"effect": "lag", "drivers": {"u": "T_b"}}],
    }
)
ADDED = EffectSpec(effect="lag", drivers={"u": "T_a"})


def judged(verdict: Any) -> Judgement:
    return Judgement(verdict, (), (), (), "as it was")


@pytest.mark.parametrize(
    ("verdict", "left", "expected"),
    [
        ("none", 4.9, "none"),  # of 10 um that the locked tests do, each about its own mean
        ("none", 5.1, "unknown"),
        ("refine", 4.9, "refine"),
        ("refine", 5.1, "unknown"),
        ("none", None, "none"),
        ("unknown", 9.0, "unknown"),
    ],
)
def test_nothing_is_missing_only_where_the_locked_tests_say_so_too(
    verdict: str, left: float | None, expected: str
) -> None:
    swing = np.where(np.arange(100) % 2, 10.0, -10.0)
    courses = [swing, swing + 500.0, np.full(100, np.nan)]
    response: Any = SimpleNamespace(unit="um", measured=lambda t: courses[t], mask=lambda t: np.isfinite(courses[t]))
    locked: Any = [0, 1, 2]
    found = contradicted(judged(verdict), left, response, locked)
    assert found.verdict == expected
    assert (found.reason == "as it was") is (verdict == expected)
    if verdict != expected:
        assert f"were left with {left:.2g} um of 10 um" in found.reason


def claims(*ids: str, after: float | None = 3.0, version: str | None = "v1", put_right: Any = None) -> Any:
    return SimpleNamespace(
        response="dZ",
        data_version=version,
        put_right=put_right,
        candidates=[
            *(SimpleNamespace(id=i, claimed=True, locked_rmse_um_after=after) for i in ids),
            SimpleNamespace(id="lag:T_c", claimed=False, locked_rmse_um_after=None),
        ],
    )


def of_role(name: str, role: str) -> Any:
    return SimpleNamespace(test=name, campaign="shop", key=("shop", name), role=role)


DATA: Any = SimpleNamespace(
    channels=CHANNELS,
    data_version="v1",
    tests=(of_role("a", "calibration"), of_role("b", "verification"), of_role("c", "locked")),
)


def asked(monkeypatch: pytest.MonkeyPatch, spec: Model, diagnoses: list[Any]) -> dict[str, float]:
    """Of a model at the end of a chain whose earlier versions, all of them the base, were given these diagnoses."""
    chain = [SimpleNamespace(model=str(i), spec=BASE) for i in range(len(diagnoses))]
    monkeypatch.setattr(catalogue, "model_chain", lambda store, model: [*chain, SimpleNamespace(model="last")])
    monkeypatch.setattr(findings, "load_diagnosis", lambda store, model: diagnoses[int(model)])
    loaded: Any = SimpleNamespace(identity="last", data=DATA, fitted=SimpleNamespace(spec=spec))
    return left_on_locked(Path("store"), loaded)  # type: ignore[arg-type]


def grown(*effects: EffectSpec, **more: Any) -> Model:
    return BASE.model_copy(update={"effects": [*BASE.effects, *effects], "in_sample": True, **more})


@pytest.mark.parametrize(
    ("effects", "diagnoses", "expected"),
    [
        ([ADDED], [claims("lag:T_a")], {"dZ": 3.0}),
        ([ADDED.model_copy(update={"id": "lag_2"})], [claims("lag:T_a")], {"dZ": 3.0}),
        ([ADDED], [claims("lag:T_a"), None], {"dZ": 3.0}),  # an effect was taken back in between
        ([ADDED], [claims("lag:T_a"), claims("lag:T_a", after=2.0)], {"dZ": 2.0}),
        ([], [claims("lag:T_a")], {}),  # the claim was not added
        ([ADDED], [claims("lag:T_a", "feed_screw:T_a")], {}),  # one of two was
        ([ADDED], [claims("lag:T_a", after=None)], {}),  # there was no locked test
        ([ADDED], [claims()], {}),
        ([ADDED], [claims("lag:T_gone")], {}),
        ([ADDED], [], {}),
    ],
)
def test_it_is_known_of_a_model_that_has_all_that_was_claimed(
    monkeypatch: pytest.MonkeyPatch, effects: list[EffectSpec], diagnoses: list[Any], expected: dict[str, float]
) -> None:
    assert asked(monkeypatch, grown(*effects), diagnoses) == expected


MOVED = PutRight(clocks=[ClockMoved(source="daq", moved_s=600.0)])
TURNED = PutRight(left_out=[("shop", "b")])


@pytest.mark.parametrize(
    ("spec", "found", "known"),
    [
        (grown(ADDED), claims("lag:T_a", version="v0"), False),  # the data changed, or there are more tests
        (grown(ADDED), claims("lag:T_a", version=None), False),  # an answer of an older version
        (grown(ADDED, ADDED.model_copy(update={"id": "lag2"})), claims("lag:T_a"), False),  # a second lag
        (grown(ADDED, verify_on=[]), claims("lag:T_a"), False),  # fitted to fewer tests
        (grown(ADDED, in_sample=False), claims("lag:T_a"), False),
        (grown(ADDED, in_sample_on=["shop/a"]), claims("lag:T_a"), False),  # b came since
        (grown(ADDED, locked=["b"]), claims("lag:T_a"), False),  # other tests are locked
        (grown(ADDED), claims("lag:T_a", put_right=MOVED), False),  # the model is fitted to the logs as they are
        (grown(ADDED), claims("lag:T_a", put_right=TURNED), False),
        (grown(ADDED, verify_on=[]), claims("lag:T_a", put_right=TURNED), True),
        (grown(ADDED, verify_on=["b"], calibrate_on=["a"]), claims("lag:T_a"), True),
    ],
)
def test_it_is_known_only_of_the_same_data_tests_and_fit(
    monkeypatch: pytest.MonkeyPatch, spec: Model, found: Any, known: bool
) -> None:
    assert bool(asked(monkeypatch, spec, [found])) is known


def test_the_error_with_a_free_level_is_known_with_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Errors on left-out tests have their level free: only the like is held against them."""
    one = SimpleNamespace(id="lag:T_a", claimed=True, locked_rmse_um_after=3.0, locked_shape_um_after=1.0)
    chain = [SimpleNamespace(model="0", spec=BASE), SimpleNamespace(model="last")]
    monkeypatch.setattr(catalogue, "model_chain", lambda store, model: chain)
    found = SimpleNamespace(response="dZ", candidates=[one], data_version="v1", put_right=None)
    monkeypatch.setattr(findings, "load_diagnosis", lambda store, model: found)
    loaded: Any = SimpleNamespace(identity="last", data=DATA, fitted=SimpleNamespace(spec=grown(ADDED)))
    store: Any = Path("store")
    assert (left_on_locked(store, loaded), shape_left_on_locked(store, loaded)) == ({"dZ": 3.0}, {"dZ": 1.0})
