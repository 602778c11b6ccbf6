"""A campaign with the id of another one that the store holds is refused; the same one may move and be edited."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from store_fakes import CAMPAIGN, daq, times, write_campaign, write_log

from thermodata.errors import UsageError
from thermodata.store import Store
from thermodata.store.ingest.run import ingest

OTHERS = CAMPAIGN.replace('"138"', '"HMC01"')


def others(folder: Path, text: str = OTHERS) -> Path:
    """A colleague's campaign of the same id: other logs of another machine, but for the control's."""
    path = write_campaign(folder, text)
    for i, log in enumerate(sorted(folder.glob("raw/*_a.npz"))):
        write_log(log, daq(seed=50 + i))
    return path


def held(store: Store) -> list[tuple[object, ...]]:
    with store.reader() as con:
        return con.execute("select path, sha256, added_at from file order by all").fetchall()


def test_another_campaign_of_that_id_is_refused_before_anything_is_written(filled: Store, tmp_path: Path) -> None:
    campaign = others(tmp_path / "messung")
    before, files = held(filled), sorted(filled.path.rglob("*"))
    with pytest.raises(UsageError) as refused:
        ingest(filled, campaign)
    told = str(refused.value)
    assert "another campaign with the id 'shop'" in told
    assert "campaign.yaml:3" in told
    assert "machine 138" in told
    assert "lab/campaign.yaml" in told
    assert "2 tests: one, two" in told
    assert "shop-HMC01" in told
    assert "--replace" in told
    assert held(filled) == before
    assert sorted(filled.path.rglob("*")) == files


def test_no_test_in_common_is_another_campaign_of_the_same_machine_too(filled: Store, tmp_path: Path) -> None:
    text = CAMPAIGN.replace("id: one", "id: june").replace("id: two", "id: july")
    folder = tmp_path / "messung"
    write_log(folder / "raw/june_a.npz", daq(seed=70))
    with pytest.raises(UsageError, match="another campaign"):
        ingest(filled, write_campaign(folder, text, logs=False))


def test_the_same_tests_of_another_month_are_another_campaign_of_the_same_machine(
    filled: Store, tmp_path: Path
) -> None:
    """A template that was copied: T1 to T5 of each winter."""
    campaign, before = winter(tmp_path / "winter", days=60), held(filled)
    with pytest.raises(UsageError, match="the tests one, two with other logs") as no:
        ingest(filled, campaign)
    assert "'shop-2'" in str(no.value)
    assert held(filled) == before
    assert ingest(filled, campaign, in_its_place=True).read == 4


def test_logs_without_dates_that_are_all_other_ones_are_of_another_campaign(store: Store, tmp_path: Path) -> None:
    ingest(store, winter(tmp_path / "autumn", days=0, clock="relative"))
    with pytest.raises(UsageError, match="of other days or of none"):
        ingest(store, winter(tmp_path / "winter", days=0, seed=7, clock="relative"))


def test_exported_anew_and_moved_it_is_the_same_as_long_as_the_days_are(filled: Store, tmp_path: Path) -> None:
    assert ingest(filled, winter(tmp_path / "archive", days=0.3)).read == 4


def winter(folder: Path, days: float, seed: int = 0, text: str = CAMPAIGN, **meta: str) -> Path:
    """The same machine and the same names, recorded so many days later."""
    path = write_campaign(folder, text)
    for i, log in enumerate(sorted(folder.glob("raw/*.npz"))):
        nc = log.name.endswith(".nc.npz")
        streams = daq(130, seed=90 + seed + i, start_s=86_400 * days)
        t_ns = streams["main"]["t_ns"]
        values = {"n": np.full(130, 3000.0 + i + seed), "msg": np.full(130, "RUN")}
        write_log(log, {"nc": {"t_ns": t_ns, **values}} if nc else streams, **meta)
    return path


def test_a_copied_file_whose_logs_are_to_come_takes_no_place(filled: Store, tmp_path: Path) -> None:
    folder = tmp_path / "winter"
    ingest(filled, write_campaign(folder, CAMPAIGN, logs=False))
    before = held(filled)
    campaign = winter(folder, days=60)  # measured since
    with pytest.raises(UsageError, match="another campaign with the id 'shop'"):
        ingest(filled, campaign)
    assert held(filled) == before


def test_it_takes_the_place_where_that_is_said(filled: Store, tmp_path: Path) -> None:
    summary = ingest(filled, others(tmp_path / "messung"), in_its_place=True)
    assert summary.changed
    assert summary.read == 2
    with filled.reader() as con:
        assert con.execute("select distinct machine from machine").fetchall() == [("HMC01",)]


def test_one_that_comes_meanwhile_is_not_replaced(
    store: Store, campaign: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from thermodata.store.ingest import run

    made, mine = run.make_layers, others(tmp_path / "messung")

    def slow(*given: object) -> object:
        monkeypatch.setattr(run, "make_layers", made)
        ingest(store, campaign)
        return made(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(run, "make_layers", slow)
    with pytest.raises(UsageError, match="another campaign"):
        ingest(store, mine)
    with store.reader() as con:
        assert con.execute("select distinct machine from machine").fetchall() == [("138",)]


def test_one_that_moved_and_whose_tests_are_renamed_goes_on(filled: Store, campaign: Path, tmp_path: Path) -> None:
    moved = shutil.copytree(campaign.parent, tmp_path / "archive")
    path = moved / "campaign.yaml"
    path.write_text(CAMPAIGN.replace("id: one", "id: june").replace("id: two", "id: july"))
    for log in sorted((moved / "raw").iterdir()):
        log.rename(log.with_name(log.name.replace("one", "june").replace("two", "july")))
    assert ingest(filled, path).read == 0


def test_one_that_moved_and_whose_machine_is_renamed_goes_on(filled: Store, campaign: Path, tmp_path: Path) -> None:
    path = shutil.copytree(campaign.parent, tmp_path / "archive") / "campaign.yaml"
    path.write_text(OTHERS)
    assert ingest(filled, path).read == 0


def test_without_its_logs_the_machine_must_be_the_same(filled: Store, campaign: Path, tmp_path: Path) -> None:
    path = shutil.copytree(campaign.parent, tmp_path / "archive") / "campaign.yaml"
    shutil.rmtree(path.parent / "raw")
    path.write_text(OTHERS)
    with pytest.raises(UsageError, match=r"the machine only got another name: thermodata ingest --replace"):
        ingest(filled, path)
    path.write_text(CAMPAIGN)
    assert ingest(filled, path).read == 0


def test_another_machine_at_the_same_path_is_another_campaign(store: Store, campaign: Path) -> None:
    """A store on a share, and C:/messung of two computers."""
    ingest(store, campaign)
    others(campaign.parent)
    before = held(store)
    with pytest.raises(UsageError, match="that file, of another machine"):
        ingest(store, campaign)
    assert held(store) == before


def test_a_machine_may_be_renamed_where_its_logs_stay(store: Store, campaign: Path) -> None:
    ingest(store, campaign)
    campaign.write_text(OTHERS)
    assert ingest(store, campaign).read == 0


def test_a_log_of_several_tests_proves_nothing(filled: Store, tmp_path: Path) -> None:
    campaign = others(tmp_path / "messung")
    (campaign.parent / "raw/one_a.npz").unlink()
    with pytest.raises(UsageError, match="another campaign"):
        ingest(filled, campaign)


def grown(folder: Path) -> None:
    for i, log in enumerate(sorted(folder.glob("raw/*_a.npz"))):
        write_log(log, daq(seed=60 + i))


def test_one_that_moved_is_the_same_though_all_its_logs_changed(filled: Store, campaign: Path, tmp_path: Path) -> None:
    moved = shutil.copytree(campaign.parent, tmp_path / "archive") / "gantry.yaml"
    moved.with_name("campaign.yaml").rename(moved)
    grown(moved.parent)
    assert ingest(filled, moved).read == 2


def test_no_draft_is_taken_for_another_by_its_unknown_machine(store: Store, tmp_path: Path) -> None:
    draft = CAMPAIGN.replace('"138"', "unknown")
    ingest(store, write_campaign(tmp_path / "lab", draft))
    with pytest.raises(UsageError, match="another campaign"):
        ingest(store, others(tmp_path / "messung", draft))


def test_where_it_stands_is_kept_though_nothing_else_changed(filled: Store, campaign: Path, tmp_path: Path) -> None:
    moved = shutil.copytree(campaign.parent, tmp_path / "archive") / "campaign.yaml"
    assert ingest(filled, moved).changed is False
    with filled.reader() as con:
        assert con.execute("select path from campaign").fetchall() == [(str(moved),)]
    assert ingest(filled, moved).changed is False
    moved.write_text(CAMPAIGN.replace("id: one", "id: june").replace("id: two", "id: july"))
    for test, name in (("one", "june"), ("two", "july")):
        (moved.parent / f"raw/{test}_a.npz").unlink()
        write_log(moved.parent / f"raw/{name}_a.npz", daq(seed=70 + len(name)))
    link = tmp_path / "link"
    link.symlink_to(moved.parent)
    assert ingest(filled, link / ".." / "archive" / "campaign.yaml").tests == 2


def test_one_at_the_same_place_may_change_its_tests_one_by_one(filled: Store, campaign: Path) -> None:
    ingest(filled, campaign)  # it is there now, and not where the store was made
    for test, seed in (("one", 81), ("two", 82)):
        write_log(campaign.parent / f"raw/{test}_a.npz", daq(seed=seed))
        assert ingest(filled, campaign).read == 1
    campaign.write_text(campaign.read_text().replace("id: one", "id: three"))
    write_log(campaign.parent / "raw/three_a.npz", daq(seed=83))
    assert ingest(filled, campaign).read == 1
    campaign.write_text(campaign.read_text().replace("id: two", "id: four"))
    write_log(campaign.parent / "raw/four_a.npz", daq(seed=84))
    assert ingest(filled, campaign).tests == 2


def test_one_that_was_forgotten_leaves_its_id(filled: Store, tmp_path: Path) -> None:
    from thermodata.store.keep.forget import forget

    forget(filled, "shop")
    assert ingest(filled, others(tmp_path / "messung")).tests == 2


def hall(start_s: float = -3600.0, n: int = 200) -> dict[str, dict[str, Any]]:
    """The log of a hall, which begins before all tests."""
    t_ns = times(n, 60.0, start_s)
    return {"main": {"t_ns": t_ns, "T1": 20 + np.arange(n) / 600}}


HALL = CAMPAIGN.replace(
    "channels:\n",
    '  hall: {reader: npz, files: "raw/hall.npz"}\nchannels:\n  T_h: {source: hall, signal: T1, unit: degC}\n',
    1,
)


@pytest.fixture
def halled(store: Store, tmp_path: Path) -> Store:
    """The campaign with a log of the hall that its tests share."""
    path = write_campaign(tmp_path / "lab", HALL)
    write_log(path.parent / "raw/hall.npz", hall())
    ingest(store, path)
    return store


def test_a_test_that_is_not_measured_yet_lets_no_other_campaign_through(filled: Store, tmp_path: Path) -> None:
    """A template that was copied while measuring goes on."""
    campaign, before = winter(tmp_path / "winter", days=60), held(filled)
    for log in campaign.parent.glob("raw/two*"):
        log.unlink()
    with pytest.raises(UsageError, match="the test one with other logs, of other days"):
        ingest(filled, campaign)
    assert held(filled) == before


@pytest.mark.parametrize("rows", [200, 260], ids=["the same", "grown"])
def test_the_log_of_a_hall_lets_no_other_campaign_through(halled: Store, tmp_path: Path, rows: int) -> None:
    campaign, before = winter(tmp_path / "winter", days=60, text=HALL), held(halled)
    write_log(campaign.parent / "raw/hall.npz", hall(n=rows))
    for measured in ("one", "two"):  # all of them, and one while the other is not measured yet
        with pytest.raises(UsageError, match="with other logs, of other days"):
            ingest(halled, campaign)
        for log in campaign.parent.glob(f"raw/{measured}*"):
            log.unlink()
        if measured == "two":
            break
    with pytest.raises(UsageError, match="with other logs, of other days or of none"):
        ingest(halled, campaign)
    assert held(halled) == before


ONE = HALL.replace("  - {id: two, kind: spindle, role: verification, phases: {heating: [0 s, 600 s]}}\n", "")


def test_the_log_of_a_hall_lets_no_other_campaign_of_one_test_through(store: Store, tmp_path: Path) -> None:
    """Each of which has no other test that would show whose log it is."""
    path = write_campaign(tmp_path / "lab", ONE)
    write_log(path.parent / "raw/hall.npz", hall())
    ingest(store, path)
    campaign, before = winter(tmp_path / "winter", days=60, text=ONE), held(store)
    write_log(campaign.parent / "raw/hall.npz", hall())
    with pytest.raises(UsageError, match="the test one with other logs, of other days"):
        ingest(store, campaign)
    assert held(store) == before
    moved = shutil.copytree(tmp_path / "lab", tmp_path / "archive") / "campaign.yaml"
    write_log(moved.parent / "raw/one_a.npz", daq(seed=60))  # exported anew
    assert ingest(store, moved).tests == 1


def test_a_log_that_was_left_from_the_template_lets_no_other_campaign_through(
    filled: Store, campaign: Path, tmp_path: Path
) -> None:
    other, before = winter(tmp_path / "winter", days=60), held(filled)
    shutil.copy(campaign.parent / "raw/one_a.npz", other.parent / "raw/one_a.npz")
    with pytest.raises(UsageError, match="the test two with other logs"):
        ingest(filled, other)
    assert held(filled) == before


def test_moved_with_a_hall_log_that_grew_and_one_log_exported_anew_it_goes_on(halled: Store, tmp_path: Path) -> None:
    path = shutil.copytree(tmp_path / "lab", tmp_path / "archive") / "campaign.yaml"
    write_log(path.parent / "raw/hall.npz", hall(n=260))
    write_log(path.parent / "raw/one_a.npz", daq(seed=60))
    path.write_text(path.read_text() + "  - {id: three, kind: spindle}\n")
    write_log(path.parent / "raw/three_a.npz", daq(seed=61, start_s=86_400 * 60))
    assert ingest(halled, path).tests == 3


def test_tests_that_are_cut_out_of_one_recording_are_known_by_its_days(store: Store, tmp_path: Path) -> None:
    text = CAMPAIGN.replace("raw/{test}_*.npz", "raw/all.npz").replace(
        "kind: spindle, role", "window: [0 s, 600 s], role"
    )

    def recorded(folder: str, days: float, seed: int) -> Path:
        path = write_campaign(tmp_path / folder, text.replace("role:", "kind: spindle, role:"), logs=False)
        write_log(path.parent / "raw/all.npz", daq(seed=seed, start_s=86_400 * days))
        return path

    ingest(store, recorded("lab", 0, 1))
    with pytest.raises(UsageError, match="of other days"):
        ingest(store, recorded("winter", 60, 2))
    assert ingest(store, recorded("archive", 0, 3)).read == 1


@pytest.mark.parametrize("months", [0, 2])
def test_logs_without_dates_are_of_the_start_of_their_test(store: Store, tmp_path: Path, months: int) -> None:
    def begun(month: int) -> str:
        text = CAMPAIGN.replace("id: one,", f"id: one, start: '2026-0{month}-02 08:00',")
        return text.replace("id: two,", f"id: two, start: '2026-0{month}-03 08:00',")

    ingest(store, winter(tmp_path / "autumn", days=0, text=begun(2), clock="relative"))
    anew = winter(tmp_path / "archive", days=0, seed=7, text=begun(2 + months), clock="relative")
    if months:
        with pytest.raises(UsageError, match="of other days"):
            ingest(store, anew)
    else:
        assert ingest(store, anew).read == 4
