"""Columns that are called otherwise from some test on are asked once, with what makes one channel of both; columns that
stand beside each other, or are of other axes or places, are not."""

from __future__ import annotations

import re
from datetime import timedelta
from pathlib import Path

import pytest
import yaml

from tests.commands import Say
from tests.draft.labs import START, local, numbers, speeds, text, warm, workbook

N = 360


def _write(
    folder: Path, day: int, names: list[str], order: list[int] | None = None, stem: str = "P", more: float = 0
) -> None:
    columns = [numbers(warm(N, low + more, rise, 0.3, 1), 3) for low, rise in ((0, 30), (21, 6), (20, 2))]
    columns += [numbers(speeds(N, [3000]), 0)]
    times = local(N, 10, START + timedelta(days=day), "UTC", "%Y-%m-%dT%H:%M:%SZ")
    order = order or list(range(len(names)))
    text(folder / f"{stem}{day}.csv", ["time", *(names[i] for i in order)], [times, *(columns[i] for i in order)])


BEFORE = ["probe_Z [um]", "T_bearing_front [degC]", "T_bed [degC]", "spindle_speed [rpm]"]
AFTER = ["dZ [um]", "Lager vorn [degC]", "Bett [degC]", "Drehzahl [rpm]"]


def _question(folder: Path, say: Say) -> str:
    assert say("init", folder).code == 0
    draft = (folder / "campaign.yaml").read_text(encoding="utf-8")
    return next((line for line in draft.splitlines() if "under two names?" in line), "")


def test_what_is_of_one_axis_or_place_may_be_one_channel(tmp_path: Path, say: Say) -> None:
    for day in range(4):
        _write(tmp_path, day, BEFORE if day < 2 else AFTER, None if day < 3 else [3, 1, 2, 0])
    asked = _question(tmp_path, say)
    assert "'dZ' and 'probe_Z', 'Lager_vorn' and 'T_bearing_front', 'Bett' and 'T_bed'" in asked
    keys = re.search(r"in P2, P3: (channels: \{.*?\}\})", asked)
    assert keys is not None
    draft = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    lines = [x for x in draft.splitlines() if not re.match(r"  (dZ|Lager_vorn|Bett|Drehzahl): ", x)]
    lines = [x.replace(", kind:", f", {keys[1]}, kind:") if re.match(r"  - \{id: P[23],", x) else x for x in lines]
    (tmp_path / "campaign.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    store = tmp_path / "store"
    assert "losses" not in say("--store", store, "ingest", tmp_path / "campaign.yaml").out
    query = "select channel, count(distinct test) from sample group by channel order by channel"
    shown = say("--store", store, "sql", query, "--csv").out.splitlines()[1:]
    assert shown == ["T_bearing_front,4", "T_bed,4", "probe_Z,4", "spindle_speed,4"]


def test_columns_without_names_are_told_by_their_places(tmp_path: Path, say: Say) -> None:
    for day in range(4):
        names, stem = ([""] * 4, "lauf") if day < 2 else (["Z", "T1", "T2", "n"], "P")
        _write(tmp_path, day, names, stem=stem)
    asked = _question(tmp_path, say)
    assert "'column_3' and 'T1', 'column_4' and 'T2'" in asked


def test_what_stands_beside_the_other_or_is_of_another_place_is_not_asked(tmp_path: Path, say: Say) -> None:
    for day in range(4):
        _write(tmp_path, day, ["dX [um]", "T_bed [degC]"] if day < 2 else ["dY [um]", "T_column [degC]"])
    assert not _question(tmp_path, say)
    for day in range(4):
        _write(tmp_path / "b", day, BEFORE if day else BEFORE[:2])
    assert not _question(tmp_path / "b", say)
    assert "under two names" not in str(yaml.safe_load((tmp_path / "b" / "campaign.yaml").read_text("utf-8")))


@pytest.mark.parametrize(("apart_h", "sheets"), [(24, True), (0, False)])
def test_sheets_whose_columns_are_called_otherwise_are_tests_unless_they_ran_at_once(
    tmp_path: Path, say: Say, apart_h: int, sheets: bool
) -> None:
    heads = [["dZ [µm]", "T_bed [°C]", "T_hall [°C]"], ["Z [µm]", "Bett [°C]", "Halle [°C]"], BEFORE[:3]]
    book: dict[str, list[list[object]]] = {}
    for k, head in enumerate(heads):
        times = local(60, 60, START + timedelta(hours=apart_h * k), "UTC", "%Y-%m-%d %H:%M:%S")
        columns = [numbers(warm(60, low, 3, 0.3, k), 2) for low in (0, 21, 20)]
        rows = [[t, *map(float, row)] for t, *row in zip(times, *columns, strict=True)]
        book[f"V{k + 1}"] = [["Zeit", *head], *rows]
    workbook(tmp_path / "Messung.xlsx", book)
    assert say("init", tmp_path).code == 0
    made = yaml.safe_load((tmp_path / "campaign.yaml").read_text("utf-8"))
    assert [t["id"] for t in made["tests"]] == (["V1", "V2", "V3"] if sheets else ["Messung"])
    (source,) = made["sources"].values()
    assert (source.get("table") == {"sheet": "{test}"}) is sheets
    asked = "'Z' and 'dZ', 'Bett' and 'T_bed', 'Halle' and 'T_hall'"
    assert (asked in (tmp_path / "campaign.yaml").read_text("utf-8")) is sheets


def test_of_two_loggers_each_is_asked_of_itself(tmp_path: Path, say: Say) -> None:
    """Both call their columns otherwise from the third day on: what one logger has is no channel of the other."""
    for day in range(6):
        for k, stem in enumerate(("logA_S", "logB_S")):
            _write(tmp_path, day, BEFORE if day < 3 else AFTER, stem=stem, more=k)
    assert say("init", tmp_path).code == 0
    draft = (tmp_path / "campaign.yaml").read_text(encoding="utf-8")
    first, second = [line for line in draft.splitlines() if "under two names?" in line]
    assert "'dZ' and 'probe_Z'," in first
    assert "in logA_S3, logA_S4, logA_S5: channels:" in first
    assert "'dZ_2' and 'probe_Z_2'," in second
    assert "in logB_S3, logB_S4, logB_S5: channels:" in second
