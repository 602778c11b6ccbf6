"""Folders whose tables hold several sensors below each other: from the draft to what the store says."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.commands import Say
from thermodata.schema.files.load import load_campaign

N = 60


@pytest.mark.parametrize("apart", [0, 3])
@pytest.mark.parametrize(("column", "names"), [("sensor", ("bed", "column")), ("Sensor-ID", ("1", "2"))])
def test_sensors_below_each_other_are_drafted_and_stored_apart(
    tmp_path: Path, say: Say, column: str, names: tuple[str, str], apart: int
) -> None:
    for test in ("run_a", "run_b"):
        lines = [f"time,{column},temperature"]
        for k in range(N):
            lines += [
                f"2026-03-02 08:{k // 6:02d}:{k % 6 * 10 + d * apart:02d},{names[d]},{20 + 10 * d + k / 8}"
                for d in (0, 1)
            ]
        (tmp_path / f"{test}.csv").write_text("\n".join(lines) + "\n")
    assert say("init", tmp_path).code == 0
    path = tmp_path / "campaign.yaml"
    drafted = path.read_text()
    assert "period" not in drafted
    campaign = load_campaign(path)
    assert [t.id for t in campaign.tests] == ["run_a", "run_b"], "a stream is no sheet that is a test"
    called = [n if n.isalpha() else f"Sensor_ID_{n}" for n in names]
    assert list(campaign.channels) == [f"{c}_temperature" for c in called]
    if column == "sensor":
        assert [c.at for c in campaign.channels.values()] == ["bed", "column"]
    store = ("--store", tmp_path / "s")
    found = json.loads(say(*store, "ingest", path, "--json").out)
    assert found["losses"] == []
    asked = "select channel, min(value) as low, max(value) as high, sum((flag = 0)::int) as n from sample group by 1"
    rows = json.loads(say(*store, "sql", f"{asked} order by 1", "--json").out)
    assert [(r["low"], r["high"], r["n"]) for r in rows] == [
        (20 + 10 * d, 20 + 10 * d + (N - 1) / 8, 2 * N) for d in (0, 1)
    ]
