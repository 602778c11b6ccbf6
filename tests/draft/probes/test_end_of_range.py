"""A probe at the end of its range with its converter's noise is asked; a machine at rest or in balance is not."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from thermodata.calibration.quality.ends.range import plateau_at_extreme
from thermodata.draft.make import draft_files

T = np.arange(0.0, 4 * 3600, 10.0)
FROM, TO = 1800.0, 10_800.0  # the spindle turns


def warms(tau_s: float, most: float = 6.0) -> np.ndarray:
    """Of a probe [V], at rest in balance before, and cooling behind."""
    up = 1 - np.exp(-np.clip(T - FROM, 0, TO - FROM) / tau_s)
    return 5.0 - most * up * np.exp(-np.clip(T - TO, 0, None) / tau_s)


def noisy(x: np.ndarray, noise: float = 6e-4) -> np.ndarray:
    return np.round(x + noise * np.random.default_rng(4).standard_normal(x.size), 4)


def speed(at: float = FROM) -> np.ndarray:
    return np.where((at <= T) & (T < TO), 10_000.0, 0.0)


COURSES: dict[str, tuple[Callable[[], np.ndarray], int | None]] = {
    "the lower end": (lambda: noisy(np.maximum(warms(1500), 1.2)), -1),
    "the upper end": (lambda: noisy(np.minimum(10 - warms(1500), 8.8)), 1),
    "in balance": (lambda: noisy(warms(400)), None),
    "in balance at once": (lambda: noisy(warms(60)), None),
    "warms": (lambda: noisy(warms(3000)), None),
    "for a few minutes": (lambda: noisy(np.maximum(warms(1500), warms(1500)[900] - 2e-3)), None),
    "hardly moves": (lambda: noisy(np.maximum(warms(1500, 0.02), 4.985)), None),
    "rests": (lambda: noisy(np.full(T.size, 5.0)), None),
}


@pytest.mark.parametrize("course", COURSES)
def test_a_plateau_at_the_extreme_begins_at_a_corner(course: str) -> None:
    make, side = COURSES[course]
    found = plateau_at_extreme(T, make())
    assert (None if found is None else found.side) == side
    if found is not None:
        assert found.level == pytest.approx(1.2 if side == -1 else 8.8, abs=1e-3)
        assert T[found.stop - 1] - T[found.start] > 3600


def asked(folder: Path, probe: np.ndarray, turns: np.ndarray | None) -> list[str]:
    rows = [
        f"{np.datetime64('2026-03-02T08:00:00') + int(t)}Z,{z:.4f},{20 + t / 9000:.2f}"
        for t, z in zip(T, probe, strict=True)
    ]
    head = "time,Probe Z [V],T_bed [degC]"
    if turns is not None:
        head, rows = f"{head},Spindle speed [rpm]", [f"{row},{n:.0f}" for row, n in zip(rows, turns, strict=True)]
    (folder / "a.csv").write_text("\n".join([head, *rows, ""]))
    (test,) = draft_files(folder).draft.tests
    return [q for q in test.doubts if "the end of its range?" in q]


def test_it_is_asked_while_the_spindle_turns(tmp_path: Path) -> None:
    (question,) = asked(tmp_path, noisy(np.maximum(warms(1500), 1.2)), speed())
    assert question.startswith("Probe Z [V] stands at 1.2 V, its lowest, within its noise for 2 h ")
    assert "sensor: {range: [1.2 V, ...]}" in question


@pytest.mark.parametrize(
    ("probe", "turns"),
    [
        (noisy(np.maximum(warms(1500), 1.2)), None),  # nobody knows whether the machine went on
        (noisy(np.maximum(warms(1500), 1.2)), np.where(T < 600, 3000.0, 0.0)),  # at rest
        (noisy(np.where(speed() > 0, 4.5, 5.0)), speed()),  # a shift with the speed
        (noisy(warms(400)), speed()),
    ],
)
def test_of_a_machine_at_rest_or_in_balance_nothing_is_asked(
    tmp_path: Path, probe: np.ndarray, turns: np.ndarray | None
) -> None:
    assert asked(tmp_path, probe, turns) == []
