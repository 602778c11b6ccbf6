"""Carrying a model to other machines."""

from __future__ import annotations

import csv
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest

from thermodata.modelling import fit_model
from thermodata.modelling.compare.portability import classify, portability
from thermodata.view.grid.dataset import Dataset

from .conftest import EFFECTS, Spec

PUBLISHED = Path(__file__).parent / "printed" / "portability.csv"  # [straka2021]


def test_the_rule_gives_the_printed_counts() -> None:
    found: Counter[str] = Counter()
    with PUBLISHED.open() as file:
        for row in csv.DictReader(file):
            numbers = [
                float(row[k]) if row[k] else None for k in ("g", "fit_n", "fit_c", "ptp_mea", "ptp_res_n", "ptp_res_c")
            ]
            if row["machine"] in ("79", "103", "118"):
                g, fit_n, fit_c, *ptp = numbers
                found[classify(g, fit_n, fit_c, *(p or 0.0 for p in ptp))] += 1
    assert found == {"portable": 1, "with_correction": 18, "not_portable": 17}


@pytest.mark.parametrize(
    ("g", "fit_n", "fit_c", "ptp", "verdict"),
    [
        (1.0, 90.0, 90.0, (50.0, 8.0, 8.0), "portable"),
        (1.1, 85.0, 90.0, (50.0, 8.0, 8.0), "portable"),
        (1.0, 79.0, 90.0, (50.0, 8.0, 8.0), "with_correction"),
        (1.5, 40.0, 88.0, (50.0, 25.0, 8.0), "with_correction"),
        (0.2, 40.0, 88.0, (50.0, 25.0, 8.0), "not_portable"),
        (1.5, 40.0, 10.0, (50.0, 25.0, 8.0), "not_portable"),
        (1.5, 40.0, 88.0, (50.0, 25.0, 51.0), "not_portable"),
        (None, None, None, (50.0, 50.0, 50.0), "not_portable"),
    ],
)
def test_the_rule(
    g: float | None, fit_n: float | None, fit_c: float | None, ptp: tuple[float, float, float], verdict: str
) -> None:
    assert classify(g, fit_n, fit_c, *ptp) == verdict


def test_another_machine_shows_its_gain(world: Dataset, spec: Spec) -> None:
    tests = list(world.tests)
    tests[5] = replace(tests[5], machine="m2", values={**tests[5].values, "dZ": tests[5].values["dZ"] * 1.6})
    tests[6] = replace(tests[6], role="none")
    data = replace(world, tests=tuple(tests))
    rows = portability(fit_model(spec(*EFFECTS), data), data)
    other = next(r for r in rows if r.machine == "m2")
    assert other.g == pytest.approx(1.6, rel=0.03)
    assert other.g_end is not None
    assert (other.verdict, rows[0].verdict) == ("with_correction", "portable")
    assert other.fit_n is not None
    assert other.fit_c is not None
    assert other.fit_c > other.fit_n
    # tests without a role are what another machine's tests often are; locked ones stay closed
    assert [r.test for r in rows] == [f"t{k}" for k in range(7)]
    assert other.to_json()["machine"] == "m2"
