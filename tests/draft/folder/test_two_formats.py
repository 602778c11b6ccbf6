"""One instrument whose tests stand in two formats is asked about: two sources would have each channel twice."""

from __future__ import annotations

from datetime import datetime, timedelta
from pathlib import Path

import pytest
import yaml

from tests.draft.labs import workbook
from thermodata.draft.make import draft_files
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

HEAD = ["Time", "dZ [um]", "T_bed [degC]"]


def _day(path: Path, day: int, head: list[str] = HEAD) -> None:
    moments = [datetime(2026, 5, day, 6) + timedelta(seconds=10 * i) for i in range(120)]
    rows = [(m, i * day / 100, 21 + i / 1000) for i, m in enumerate(moments)]
    if path.suffix == ".xlsx":
        workbook(path, [head, *map(list, rows)])
    else:
        lines = [f"{m:%Y-%m-%d %H:%M:%S};{z:.2f};{t:.3f}" for m, z, t in rows]
        path.write_text("\n".join([";".join(head), *lines, ""]), "utf-8")


def _asked(folder: Path) -> list[str]:
    return [q for s in draft_files(folder).draft.sources for q in s.questions if "in another format" in q]


def test_other_tests_of_the_same_signals_in_a_workbook_are_asked_and_one_source_reads_both(tmp_path: Path) -> None:
    for day in (11, 12, 13, 14):
        _day(tmp_path / f"day{day}.{'csv' if day % 2 else 'xlsx'}", day)
    [asked] = _asked(tmp_path)
    assert asked.startswith("is it the instrument of 'nc' in another format? It has the same 2 signals, and no test")
    line = asked[asked.index("{reader") : asked.rindex("}") + 1]
    source = yaml.safe_load(line)
    assert source == {"reader": "table", "files": ["{test}.csv", "{test}.xlsx"]}
    channel = {"source": "log", "signal": "T_bed [degC]", "quantity": "temperature", "unit": "degC", "at": "bed"}
    campaign = {
        "schema": "thermodata/campaign/1",
        "id": "lab",
        "machine": {"id": "m"},
        "sources": {"log": yaml.safe_load(line)},
        "channels": {"T_bed": channel},
        "tests": [{"id": f"day{day}", "kind": "other", "role": "calibration"} for day in (11, 12, 13, 14)],
    }
    (tmp_path / "campaign.yaml").write_text(yaml.safe_dump(campaign))
    store = Store(tmp_path / "s.store", create=True)
    ingest(store, tmp_path / "campaign.yaml")
    with store.reader() as con:
        rows = con.execute("select test, count(*) from temperature group by all order by 1").fetchall()
    assert rows == [(f"day{day}", 120) for day in (11, 12, 13, 14)]


@pytest.mark.parametrize("other", ["same test", "other signals", "at once"])
def test_two_instruments_are_not(tmp_path: Path, other: str) -> None:
    for day in (11, 13):
        _day(tmp_path / f"day{day}.csv", day)
        name = f"day{day}" if other == "same test" else f"hall{day + 1}"
        head = ["Time", "hall [degC]", "floor [degC]"] if other == "other signals" else HEAD
        _day(tmp_path / f"{name}.xlsx", day if other == "at once" else day + 1, head)
    assert not _asked(tmp_path)
