"""What somebody deleted from a campaign file stays out when it is drafted anew, and is said; what is new comes in."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.commands import Say
from thermodata.schema.files.load import load_campaign

_NAMES = ["dZ [um]", "T_hall [degC]", "T_bed [degC]"]


def _log(path: Path, names: list[str] = _NAMES) -> None:
    t = np.arange(0, 3600, 10.0)
    rows = [f"{x:.0f}," + ",".join(f"{20 + i + 5 * x / (x + 900):.3f}" for i in range(len(names))) for x in t]
    path.write_text("\n".join([f"t [s],{','.join(names)}", *rows, ""]), encoding="utf-8")


def _without(path: Path, *marks: str) -> None:
    lines = path.read_text("utf-8").splitlines()
    kept = [x for x in lines if not any(m in x for m in marks)]
    assert len(kept) == len(lines) - len(marks)
    path.write_text("\n".join(kept) + "\n", encoding="utf-8")


@pytest.fixture
def path(tmp_path: Path, say: Say) -> Path:
    for name in ("lauf_a", "lauf_b", "lauf_c"):
        _log(tmp_path / f"{name}.csv")
    assert say("init", tmp_path).code == 0
    return tmp_path / "campaign.yaml"


def test_a_test_and_a_channel_that_were_deleted_stay_out_however_often_it_is_drafted(path: Path, say: Say) -> None:
    _without(path, "{id: lauf_b,", "  T_bed: ")
    for _ in range(2):
        assert say("init", "--force", path.parent).code == 0
        campaign = load_campaign(path)
        assert [t.id for t in campaign.tests] == ["lauf_a", "lauf_c"]
        assert set(campaign.channels) == {"dZ", "T_hall"}
        text = path.read_text("utf-8")
        assert "# note: left out, as deleted from the campaign file before: T_bed, lauf_b; to have one again" in text


def test_logs_and_columns_that_came_since_come_in(path: Path, say: Say) -> None:
    _without(path, "{id: lauf_b,")
    _log(path.parent / "lauf_d.csv", [*_NAMES, "T_oil [degC]"])
    assert say("init", "--force", path.parent).code == 0
    campaign = load_campaign(path)
    assert [t.id for t in campaign.tests] == ["lauf_a", "lauf_c", "lauf_d"]
    assert "T_oil" in campaign.channels


def test_a_line_that_is_written_again_is_there_again(path: Path, say: Say) -> None:
    _without(path, "{id: lauf_b,")
    say("init", "--force", path.parent)
    path.write_text(path.read_text("utf-8").replace("  - {id: lauf_c,", "  - {id: lauf_b}\n  - {id: lauf_c,"), "utf-8")
    say("init", "--force", path.parent)
    assert [t.id for t in load_campaign(path).tests] == ["lauf_a", "lauf_b", "lauf_c"]
    assert "left out, as deleted" not in path.read_text("utf-8")


def test_nothing_is_left_out_of_a_file_without_its_last_line(path: Path, say: Say) -> None:
    _without(path, "{id: lauf_b,", "# as drafted, so that what is deleted")
    say("init", "--force", path.parent)
    assert [t.id for t in load_campaign(path).tests] == ["lauf_a", "lauf_b", "lauf_c"]
