"""Tests that are windows of one recording, and what a test kept out of the fit says where it holds fitted samples."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from thermodata.diagnosis.locked.copies import as_artefacts, copies
from thermodata.modelling import run
from thermodata.schema.answers.result import FitResult
from thermodata.schema.files.model import Model
from thermodata.store import Store
from thermodata.store.ingest.run import ingest
from thermodata.view.grid.dataset import TestData
from thermodata.view.grid.load import load_dataset

ROWS = 720  # of 10 s


def lab(folder: Path, tests: list[dict[str, Any]], *, dated: bool = False) -> Store:
    """Recordings a and b of 2 h each, and copy, which has the bytes of a."""
    (folder / "raw").mkdir()
    rng = np.random.default_rng(3)
    for day, name in enumerate(("a", "b")):
        heat = np.cumsum(rng.normal(size=ROWS)) * 0.1 + 20
        shift = 2 * heat + rng.normal(size=ROWS) * 0.05
        seconds = 10 * np.arange(ROWS)
        times = [
            f"2026-03-0{day + 2}T{8 + s // 3600:02d}:{s // 60 % 60:02d}:{s % 60:02d}Z" if dated else str(s)
            for s in seconds.tolist()
        ]
        lines = ["time;p;T" if dated else "time [s];p;T"]
        lines += [f"{t};{d:.5f};{T:.5f}" for t, d, T in zip(times, shift, heat, strict=True)]
        (folder / "raw" / f"{name}.csv").write_text("\n".join(lines) + "\n")
    (folder / "raw" / "copy.csv").write_bytes((folder / "raw" / "a.csv").read_bytes())
    campaign = {
        "schema": "thermodata/campaign/1",
        "id": "c",
        "machine": {"id": "m"},
        "sources": {"log": {"reader": "table", "files": "raw/{test}.csv", "timezone": "UTC"}},
        "channels": {
            "dZ": {"source": "log", "signal": "p", "quantity": "displacement", "unit": "um", "axis": "Z", "at": "tcp"},
            "T_a": {"source": "log", "signal": "T", "quantity": "temperature", "unit": "degC", "at": "spindle"},
        },
        "tests": [{"kind": "spindle", "role": "calibration", **test} for test in tests],
    }
    (folder / "campaign.yaml").write_text(yaml.safe_dump(campaign))
    store = Store(folder / "store", create=True)
    ingest(store, folder / "campaign.yaml")
    return store


def cut(name: str, role: str, window: list[str] | None, file: str = "a") -> dict[str, Any]:
    window_of = {} if window is None else {"window": window}
    return {"id": name, "role": role, "files": {"log": f"raw/{file}.csv"}, **window_of}


def fitted(store: Store) -> FitResult:
    spec = {
        "schema": "thermodata/model/1",
        "name": "m",
        "campaign": "c",
        "response": {"channel": "dZ"},
        "step": "60 s",
        "effects": [{"effect": "lag", "drivers": {"u": "T_a"}}],
    }
    return run.fit(store, Model.model_validate(spec))


def told(result: FitResult) -> dict[str, str]:
    return {c.name: c.advice for c in result.checks if c.name.startswith("overlap:")}


@pytest.mark.parametrize("dated", [False, True])
@pytest.mark.parametrize(
    ("window", "file", "said"),
    [
        (["1 h", "2 h"], "a", None),  # meets the calibrated window at its edge
        (["59.8 min", "2 h"], "a", None),  # one sample
        (["59.6 min", "2 h"], "a", "0 to 0.00389 h"),  # two
        (["1805 s", "2 h"], "a", "0 to 0.496 h"),  # at no multiple of the step
        (["1805 s", "2 h"], "copy", "0 to 0.496 h"),
        (["30 min", "2 h"], "b", None),
        (None, "copy", "0 to 0.997 h"),
    ],
)
def test_a_verification_test_with_fitted_samples_is_told_and_is_in_sample(
    tmp_path: Path, window: list[str] | None, file: str, said: str | None, dated: bool
) -> None:
    tests = [cut("first", "calibration", ["0 h", "1 h"]), cut("later", "verification", window, file)]
    store = lab(tmp_path, [*tests, {"id": "b"}] if file != "b" else tests, dated=dated)
    result = fitted(store)
    (role,) = {s.role for s in result.scores if s.test == "later"}
    if said is None:
        assert (told(result), role) == ({}, "verification")
    else:
        assert role == "verification (in-sample)"
        assert told(result)["overlap:c/later"].startswith(f"{said}")
        assert "of this verification test are samples of c/first" in told(result)["overlap:c/later"]


def test_a_locked_test_with_open_samples_is_told_at_the_fit_and_confirms_nothing(tmp_path: Path) -> None:
    tests = [
        cut("first", "calibration", ["0 h", "1 h"]),
        cut("apart", "locked", ["1 h", "2 h"]),
        cut("again", "locked", ["1805 s", "90 min"]),
        {"id": "b"},
    ]
    store = lab(tmp_path, tests)
    assert list(told(fitted(store))) == ["overlap:c/again"]
    data = load_dataset(store, "c", 60.0)
    locked, opened = ([t for t in data.tests if (t.role == "locked") is side] for side in (True, False))
    found = copies(locked, opened, "dZ")
    assert [(one.test, other.test) for one, other in found] == [("again", "first")]
    (artefact,) = as_artefacts(found, "dZ")
    assert (artefact.kind, artefact.test) == ("copy", "again")
    assert artefact.why.startswith("0 to 0.496 h of it are samples of the open test 'first'")


def test_where_the_shared_samples_lie_counts_from_the_test_and_ignores_its_history(tmp_path: Path) -> None:
    late = {**cut("late", "verification", ["90 min", "2 h"]), "history": "recording"}
    store = lab(tmp_path, [cut("first", "calibration", ["0 h", "1 h"]), late, cut("whole", "calibration", None)])
    data = load_dataset(store, "c", 60.0)

    def shared(one: str, other: str) -> tuple[float, float] | None:
        from thermodata.view.grid.shared_samples import shared_samples

        a, b = (the_one(data.tests, name) for name in (one, other))
        return shared_samples(a, b, "dZ")

    assert shared("late", "first") is None
    assert shared("late", "whole") == (0.0, 1790.0)
    assert shared("whole", "late") == (5400.0, 7190.0)


def the_one(tests: tuple[TestData, ...], name: str) -> TestData:
    return next(t for t in tests if t.test == name)


def test_two_machines_in_one_log_are_two_measurements(tmp_path: Path) -> None:
    """One logger may serve both: what stands in another column of its file was not measured twice."""
    from thermodata.view.grid.shared_samples import shared_samples

    store = lab(tmp_path, [cut("a", "calibration", None)])
    text = (tmp_path / "campaign.yaml").read_text().replace("id: c\n", "id: d\n", 1)
    (tmp_path / "campaign.yaml").write_text(text.replace("signal: p", "signal: T"))
    ingest(store, tmp_path / "campaign.yaml")
    one, other = load_dataset(store, ["c", "d"], 60.0).tests
    assert shared_samples(one, other, "dZ") is None
    assert shared_samples(one, other, "T_a") is not None
