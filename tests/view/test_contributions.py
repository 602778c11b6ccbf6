"""Contributions of several models beside each other: what differs, by how much, how long the bands are apart."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from thermodata.errors import UsageError
from thermodata.schema.agreed.effect_ids import ids_of
from thermodata.view.curves.contributions import contributions, open_test
from thermodata.view.lists.models import model_rows, term_order

from .conftest import NOW, Builder

N, STEP = 120, 60.0
T_S = np.arange(N) * STEP
RISE = 10 * (1 - np.exp(-T_S / 1800))


def model(
    builder: Builder,
    identity: str,
    contributed: Mapping[str, np.ndarray],
    deviations: Mapping[str, np.ndarray] | None = None,
    *,
    t_s: np.ndarray = T_S,
    parent: str | None = None,
    tests: tuple[str, ...] = ("warm",),
) -> None:
    """A model with a stored prediction of tests, as a fit leaves it."""
    builder.add(
        "model",
        model=identity,
        name="m",
        parent=parent,
        campaigns=["lab"],
        response="dZ",
        spec=json.dumps({"effects": [{"effect": name} for name in contributed]}),
        data_version="v1",
        stale=False,
        created_at=NOW.replace(hour=len(builder.rows.get("model", []))),
        result="{}",
    )
    zero = np.zeros(len(t_s))
    columns = {"t_s": t_s, "measured": zero, "predicted": zero, "residual": zero, "valid": np.ones(len(t_s), bool)}
    columns |= {f"c__{k}": v for k, v in contributed.items()} | {f"sd__{k}": v for k, v in (deviations or {}).items()}
    for test in tests:
        path = f"model/{identity}-{test}.parquet"
        (builder.folder / "model").mkdir(exist_ok=True, parents=True)
        pq.write_table(pa.table(columns), builder.folder / path)
        builder.add("prediction", campaign="lab", test=test, model=identity, response="dZ", path=path, rows=len(t_s))


@pytest.fixture
def builder(tmp_path: Path) -> Builder:
    made = Builder(tmp_path / "store")
    for test in ("warm", "cold"):
        made.test("lab", test)
    return made


def test_an_effect_that_gave_way_to_another_is_told(builder: Builder) -> None:
    """'column' falls from 10 to 6 um, 'coolant' takes 4: sure where the bands leave each other."""
    sd = np.full(N, 0.5)
    model(builder, "aa", {"column": RISE, "nut": 0.3 * RISE}, {"column": sd, "nut": sd})
    model(
        builder,
        "bb",
        {"column": 0.6 * RISE, "nut": 0.3 * RISE, "coolant": 0.4 * RISE},
        {"column": sd, "nut": sd, "coolant": sd},
        parent="aa",
    )
    (found,) = contributions(builder.store(), ["aa", "bb"], "lab", "warm")
    column, nut, coolant = found.effects
    assert [e.effect for e in found.effects] == ["column", "nut", "coolant"]
    assert [e.differs for e in found.effects] == [True, False, True]
    last = RISE[-1]
    assert column.peaks[0].value == pytest.approx(last)
    assert column.peaks[0].t_s == T_S[-1]
    assert (column.peaks[0].low, column.peaks[0].high) == pytest.approx((last - 0.98, last + 0.98))
    # the difference has the sum of both half widths, 2 * 1.96 * 0.5
    assert column.apart[0].peak.value == pytest.approx(-0.4 * last)
    assert column.apart[0].peak.high == pytest.approx(-0.4 * last + 1.96)
    assert column.apart[0].apart_s == STEP * np.count_nonzero(0.4 * RISE > 1.96)
    # what a model lacks is exactly nothing: only the other's band counts
    assert coolant.peaks[0] is None
    assert coolant.apart[0].apart_s == STEP * np.count_nonzero(0.4 * RISE > 0.98)
    assert nut.apart[0].apart_s == 0
    rows = found.to_json()
    assert [(r["effect"], r["model"]) for r in rows][:2] == [("column", "aa"), ("column", "bb")]
    assert rows[4] | {"largest": None} == rows[4]
    assert json.loads(json.dumps(rows)) == rows


def test_a_difference_within_the_bands_is_none(builder: Builder) -> None:
    wide = np.full(N, 3.0)
    model(builder, "aa", {"column": RISE}, {"column": wide})
    model(builder, "bb", {"column": 0.6 * RISE}, {"column": wide})
    (found,) = contributions(builder.store(), ["aa", "bb"], "lab", "warm")
    assert not found.effects[0].differs
    assert found.effects[0].apart[0].apart_s == 0


def test_without_stored_deviations_nothing_is_called_sure(builder: Builder) -> None:
    model(builder, "aa", {"column": RISE})
    model(builder, "bb", {"column": 0.6 * RISE}, {"column": np.full(N, 0.1)})
    (found,) = contributions(builder.store(), ["aa", "bb"], "lab", "warm")
    (column,) = found.effects
    assert column.apart[0].apart_s is None
    assert column.apart[0].peak.low is None
    assert column.differs  # by its size
    assert column.peaks[1].low is not None


def test_models_on_other_steps_and_tests_meet_on_the_first_ones_times(builder: Builder) -> None:
    model(builder, "aa", {"column": RISE}, tests=("warm", "cold"))
    coarse = T_S[::5]
    model(builder, "bb", {"column": 2 * np.interp(coarse, T_S, RISE)}, t_s=coarse)
    store = builder.store()
    (found,) = contributions(store, ["aa", "bb"], "lab", "warm")
    curve = found.effects[0].apart[0].curve
    assert curve.shape == (N,)
    assert np.nanmax(np.abs(curve - RISE)) < 0.1
    assert np.isnan(curve[coarse[-1] < T_S]).all()  # nobody predicted there
    (alone,) = contributions(store, ["aa", "bb"], "lab", "cold")
    assert alone.models == ("aa",)
    assert open_test(store, "aa", "lab/cold") == ("lab", "cold")
    with pytest.raises(UsageError, match="cald"):
        open_test(store, "aa", "cald")


def test_an_effect_keeps_its_place_when_another_is_taken_out(builder: Builder) -> None:
    model(builder, "aa", {"column": RISE, "nut": RISE, "hall": RISE})
    model(builder, "bb", {"column": RISE, "hall": RISE}, parent="aa")
    model(builder, "cc", {"coolant": RISE})
    rows = model_rows(builder.store())
    assert term_order(rows, ["bb"]) == ["column", "nut", "hall"]
    # a model of another family comes where its version does, and moves nothing of this one's order
    assert [t for t in term_order(rows, ["cc", "bb"]) if t != "coolant"] == ["column", "nut", "hall"]
    assert ids_of([("lag", None), ("lag", None), ("lag", "lag_3"), ("lag", None)]) == ["lag", "lag_2", "lag_3", "lag_4"]
