"""Tests that move alike have one rule of when is measured; which differs is said."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say
from tests.draft.labs import numbers, text
from thermodata.schema.files.load import load_campaign


def _log(path: Path, *, moves: bool = True, gone: str = "away", middle: float = 210.0, seed: int = 1) -> None:
    """A machine that comes to its probe for 2 of 12 minutes. moves: or stands there; gone: when the probe has no
    reading: while the machine is away, never, or otherwise."""
    n = 720
    at_probe = (np.arange(n) // 12) % 6 == 0 if moves else np.ones(n, dtype=bool)
    rng = np.random.default_rng(seed)
    z = 40 * (1 - np.exp(-np.arange(n) / 200)) + rng.normal(0, 0.2, n)
    lost = {"away": ~at_probe, "never": np.zeros(n, dtype=bool), "otherwise": np.roll(at_probe, 30)}[gone]
    shown = ["1999" if x else f"{v:.2f}" for v, x in zip(z, lost, strict=True)]
    position = np.where(at_probe, middle, 400 + 150 * np.sin(np.arange(n) / 3))
    text(
        path,
        ["t [s]", "Z [um]", "pos Z [mm]"],
        [numbers(np.arange(n) * 10.0, 0), shown, numbers(position, 3)],
        mark=",",
    )


@pytest.mark.parametrize(
    ("third", "ruled", "asked"),
    [
        ({}, True, ""),
        ({"gone": "never"}, True, ""),  # as where a probe has no rail
        ({"gone": "otherwise"}, False, "the axes move alike, but here the probes are "),
        ({"moves": False, "gone": "never"}, False, ""),  # it measures all along
        ({"middle": 100.0}, None, "measuring: otherwise than in lauf_a, lauf_b, where it is abs(pos_Z - 210) < "),
    ],
)
def test_one_rule_for_all_that_move_alike(
    tmp_path: Path, say: Say, third: dict[str, object], ruled: bool | None, asked: str
) -> None:
    for k in (1, 2):
        _log(tmp_path / f"lauf_{chr(96 + k)}.csv", seed=k)
    _log(tmp_path / "lauf_c.csv", **third, seed=3)  # type: ignore[arg-type]
    say("init", tmp_path)
    path = tmp_path / "campaign.yaml"
    first, second, last = (t.measuring for t in load_campaign(path).tests)
    assert isinstance(first, str)
    assert first == second
    assert first.startswith("abs(pos_Z - 210) < ")
    line = next(x for x in path.read_text("utf-8").splitlines() if "{id: lauf_c," in x)
    if ruled is None:
        assert str(last).startswith("abs(pos_Z - 100) < ")
    else:
        assert last == (first if ruled else None)
    assert ("? " in line.partition("#")[2] and asked in line) if asked else "measuring:" not in line.partition("#")[2]
    assert ("as in lauf_a, lauf_b, which move alike" in line) is (third == {"gone": "never"})


def test_a_rule_has_a_line_of_its_own_where_one_pattern_would_say_the_conditions(tmp_path: Path, say: Say) -> None:
    for feed in (5, 10, 20):
        _log(tmp_path / f"F{feed}.csv", seed=feed)
    say("init", tmp_path)
    tests = load_campaign(tmp_path / "campaign.yaml").tests
    assert [str(t.measuring)[:18] for t in tests] == ["abs(pos_Z - 210) <"] * 3
