"""Probes of a nest that is turned are moved by the jump tests of two axes: asked, and calibrated along none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.draft.labs import numbers, staircase, text
from thermodata.draft.make import draft_files

MOVES = (-40.0, 40.0, 40.0, -40.0)


def write(folder: Path, turned_deg: float) -> None:
    turn = np.radians(turned_deg)
    for k, (axis, a, b) in enumerate((("X", np.cos(turn), -np.sin(turn)), ("Y", np.sin(turn), np.cos(turn)))):
        probes = [staircase([m * share for m in MOVES], 100.0, 20.0, 5.0, 10 * k + i) for i, share in enumerate((a, b))]
        t = np.arange(len(probes[0])) / 5.0
        columns = [numbers(t, 1), *(numbers(p, 4) for p in probes)]
        text(folder / f"salto_{axis}.csv", ["t [s]", "Probe A [V]", "Probe B [V]"], columns, mark=",")
    t = np.arange(1500) * 10.0
    heat = 1 - np.exp(-t / 3000)
    for test in ("prova1", "prova2"):
        columns = [numbers(t, 0), numbers(5 + 0.4 * heat, 4), numbers(5 - 0.2 * heat, 4), numbers(21 + 9 * heat, 2)]
        text(folder / f"{test}.csv", ["t [s]", "Probe A [V]", "Probe B [V]", "Bearing [°C]"], columns, mark=",")


@pytest.mark.parametrize(("turned_deg", "asked"), [(45.0, True), (35.0, True), (5.0, False), (0.0, False)])
def test_a_nest_that_is_turned_is_asked(tmp_path: Path, turned_deg: float, asked: bool) -> None:
    write(tmp_path, turned_deg)
    draft = draft_files(tmp_path).draft
    probes = {c.name: c.said for c in draft.channels if c.name.startswith("Probe")}
    between = {n: q for n, s in probes.items() for q in s.questions if "both move it" in q}
    assert sorted(between) == (["Probe_A", "Probe_B"] if asked else [])
    assert len(draft.jumps) == (0 if asked else 2)
    assert {s.axis for s in probes.values()} == ({None} if asked else {"X", "Y"})
    if asked:
        derived = [f'd{axis}: {{derive: "(Probe_A {sign} the other)' for axis, sign in (("X", "-"), ("Y", "+"))]
        assert any(d in between["Probe_A"] for d in derived)
        assert all("looks between two axes" in why for path, why in draft.not_used if "salto" in path)
