"""An axis of which only the position is logged: its feed is proposed where it moves, and only there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.draft.campaign.parts import DerivedChannel
from thermodata.draft.make import draft_files
from thermodata.draft.writing.answer import as_json
from thermodata.draft.writing.baseline import model_text_of
from thermodata.schema.files.load import load_campaign

ROWS = 900
AT_REST = np.full(ROWS, 120.0)
TO_AND_FRO = np.abs(np.arange(ROWS) * 37.31 % 800 - 400)
NOISE = np.random.default_rng(1).normal(0, 0.002, ROWS)


def _log(folder: Path, columns: dict[str, np.ndarray], step_s: float = 1.0) -> None:
    begin = np.datetime64("2026-05-11T06:00:00.000")
    t = begin + np.round(np.arange(ROWS) * step_s * 1000).astype("timedelta64[ms]")
    rows = (f"{t[i]}Z;" + ";".join(f"{c[i]:.4f}" for c in columns.values()) for i in range(ROWS))
    folder.mkdir(exist_ok=True)
    (folder / "V1_plc.csv").write_text("timestamp;" + ";".join(columns) + "\n" + "\n".join(rows) + "\n")


def _derived(folder: Path, columns: dict[str, np.ndarray], step_s: float = 1.0) -> tuple[DerivedChannel, ...]:
    _log(folder, columns, step_s)
    return draft_files(folder).draft.derived


def test_the_feed_of_a_position_is_proposed_with_its_reason(tmp_path: Path) -> None:
    found = _derived(tmp_path, {"X actual position [mm]": TO_AND_FRO + NOISE, "Y actual position [m]": AT_REST})
    (v,) = found
    why = "no feed of X is logged; it is the rate of its position"
    assert v == DerivedChannel("v_x", "rate(X_actual_position)", "feed", "m/min", "axis.x", why)
    text = (tmp_path / "campaign.yaml").read_text()
    assert (
        f'  v_x: {{derive: "rate(X_actual_position)", quantity: feed, unit: m/min, at: axis.x}}   # proposed: {why}'
        in (text)
    )
    assert load_campaign(tmp_path / "campaign.yaml").channels["v_x"].derive == v.derive
    drafted = draft_files(tmp_path, force=True)
    assert as_json(drafted.draft, drafted.campaign, 1, 0, None)["derived"] == [
        {"name": "v_x", "derive": v.derive, "quantity": "feed", "unit": "m/min", "at": "axis.x", "why": why}
    ]


def test_it_drives_the_first_model(tmp_path: Path) -> None:
    _log(tmp_path, {"dX TCP [um]": 0.01 * np.arange(ROWS) + NOISE, "X pos [m]": 1e-3 * (TO_AND_FRO + NOISE)})
    made = draft_files(tmp_path)
    assert made.model is not None
    assert "{effect: feed_screw, drivers: {feed: v_x}}" in made.model.read_text()
    # or an answer would take the model for one that somebody changed
    assert made.model.read_text() == model_text_of(load_campaign(made.campaign))


@pytest.mark.parametrize(
    ("columns", "step_s"),
    [
        ({"X pos [mm]": TO_AND_FRO, "feed X [m/min]": TO_AND_FRO / 100}, 1.0),
        ({"X pos [mm]": TO_AND_FRO + NOISE}, 10.0),
        ({"X pos [mm]": 120 + NOISE}, 1.0),
        ({"X pos [mm]": 100.0 * (np.arange(ROWS) // 150)}, 1.0),
        ({"X pos [mm]": np.interp(np.arange(ROWS), [0, 300, 309, 600, 609], [0, 0, 90, 90, 0])}, 1.0),
        ({"T_hall [degC]": 20 + NOISE}, 1.0),
    ],
    ids=["a feed is logged", "too slow", "held in place", "where the tool stands", "two moves", "no position"],
)
def test_where_nothing_is_proposed(tmp_path: Path, columns: dict[str, np.ndarray], step_s: float) -> None:
    assert _derived(tmp_path, columns, step_s) == ()


def test_each_axis_has_one(tmp_path: Path) -> None:
    columns = {"X pos [mm]": TO_AND_FRO, "X pos set [mm]": TO_AND_FRO, "Z pos [mm]": TO_AND_FRO / 2}
    found = _derived(tmp_path, columns)
    assert [(v.name, v.derive) for v in found] == [("v_x", "rate(X_pos)"), ("v_z", "rate(Z_pos)")]


def test_a_feed_of_no_one_axis_is_named_as_that_of_the_path(tmp_path: Path) -> None:
    (v,) = _derived(tmp_path, {"X pos [mm]": TO_AND_FRO, "path feed [mm/min]": np.abs(TO_AND_FRO)})
    assert (
        v.why
        == "no feed of X is logged (path_feed may be that of the path of all axes); it is the rate of its position"
    )


def test_strokes_that_keep_step_with_the_logger_are_seen_at_few_places(tmp_path: Path) -> None:
    strokes = np.where(np.arange(ROWS) < 400, -100.0, 100.0 * np.array([-1.0, 0.0, 1.0, 0.0])[np.arange(ROWS) % 4])
    (v,) = _derived(tmp_path, {"X pos [mm]": strokes}, 2.0)
    assert v.derive == "rate(X_pos)"
    assert v.why.endswith("seen at 3 places only: its strokes keep step with the logger, and the rate is too small")


def test_places_where_the_tool_stands_for_some_rows_are_no_strokes(tmp_path: Path) -> None:
    stands = 100.0 * (np.arange(ROWS) // 10 % 2)
    assert _derived(tmp_path, {"X pos [mm]": stands}, 2.0) == ()
