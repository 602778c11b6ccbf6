"""Keeping a store that others use, too: ids of campaigns, and what another version has left in it."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

from thermodata.store import Store

from .conftest import Said, write_campaign

Say = Callable[..., Said]


def test_a_colleagues_campaign_of_the_same_id_is_refused_or_replaced_on_demand(
    say: Say, campaign: Path, tmp_path: Path
) -> None:
    store = shutil.copytree(campaign / "thermodata.store", tmp_path / "own.store")
    theirs = write_campaign(tmp_path / "messung")
    theirs.write_text(theirs.read_text().replace('id: "138"', "id: HMC01"))
    for log in (tmp_path / "messung/raw").iterdir():
        log.write_text(log.read_text() + "21600.0000,1.0,21.0,21.0,21.0,0.0,0.0\n")
    said = say("--store", store, "ingest", theirs)
    assert said.code == 2
    assert said.out == ""
    assert "machine 138" in said.err
    assert "heat1" in said.err
    assert "--replace" in said.err
    assert '"138"' in say("--store", store, "sql", "select distinct machine from machine", "--json").out
    assert say("--store", store, "ingest", theirs, "--replace").code == 0
    assert "HMC01" in say("--store", store, "sql", "select distinct machine from machine", "--json").out


def test_init_says_that_another_campaign_has_the_folders_name(say: Say, campaign: Path, tmp_path: Path) -> None:
    write_campaign(tmp_path / "hall/small")
    (tmp_path / "hall/small/campaign.yaml").unlink()
    said = say("--store", campaign / "thermodata.store", "init", tmp_path / "hall/small")
    assert said.code == 0
    assert "its id is 'hall-small': the store holds another campaign 'small'" in said.err
    assert "\nid: hall-small" in (tmp_path / "hall/small/campaign.yaml").read_text()


def test_a_fit_of_another_version_is_no_defect(say: Say, campaign: Path, tmp_path: Path) -> None:
    store = shutil.copytree(campaign / "thermodata.store", tmp_path / "own.store")
    with Store(store).write() as con:
        con.execute("update model set result = json_merge_patch(result, '{\"newest_key\": 1}')")
    said = say("--store", store, "history", "baseline")
    assert said.code == 4
    assert "defect" not in said.err
    assert "another version of thermodata wrote it" in said.err
    assert "newest_key" in said.err
