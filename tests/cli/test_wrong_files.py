"""A wrong file leaves nothing behind, and a store of several campaigns says whose a row is."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from ..commands import Said
from .conftest import MODEL


@pytest.mark.parametrize("text", [None, MODEL, "schema: thermodata/campaign/1\nid: c\ntests: []\n"])
def test_a_wrong_campaign_file_makes_no_store(say: Callable[..., Said], tmp_path: Path, text: str | None) -> None:
    path = tmp_path / "wrong.yaml"
    if text is not None:
        path.write_text(text)
    assert say("--store", tmp_path / "s", "ingest", path).code == 2
    assert not (tmp_path / "s").exists()
    said = say("--store", tmp_path / "s", "tests")
    assert (said.code, "there is no store here" in said.err) == (2, True)


def test_calibrations_of_several_campaigns_say_whose_they_are(
    say: Callable[..., Said], campaign: Path, tmp_path: Path
) -> None:
    shutil.copytree(campaign, tmp_path / "lab")
    store = tmp_path / "lab/thermodata.store"
    assert "campaign" not in say("--store", store, "calibrations").out
    other = tmp_path / "lab/other.yaml"
    other.write_text((campaign / "campaign.yaml").read_text().replace("id: small", "id: other"))
    assert say("--store", store, "ingest", other).code in (0, 3)
    said = say("--store", store, "calibrations").out
    assert " not measured" in said  # a gain of a data sheet: no jump test has seen it
    assert "campaign" in said
    assert "other" in said
    assert "small" in said
