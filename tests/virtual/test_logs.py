"""The logs: what a lab would have, readable by the usual packages, and the truth apart."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from thermodata.errors import UsageError
from thermodata.schema.files.load import load_campaign, load_model
from thermodata.virtual import World, make_world, simulate
from thermodata.virtual.gantry.logs.logbook import Logbook


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, World]:
    folder = tmp_path_factory.mktemp("lab")
    said: list[str] = []
    truth = simulate(folder, "feed_screw", 11, tests=5, hours=3, progress=said.append)
    assert truth.hidden == "feed_screw"
    assert truth.family in ("feed_z", "feed_y")
    assert len(said) == 5
    return folder, make_world("feed_screw", 11, tests=5, hours=3)


def test_the_campaign_and_model_files_load_strictly(lab: tuple[Path, World]) -> None:
    folder, world = lab
    campaign = load_campaign(folder / "campaign.yaml")
    model = load_model(folder / "model.yaml")
    assert [t.id for t in campaign.tests] == [r.op.id for r in world.runs]
    assert model == world.baseline()
    assert {e.effect for e in model.effects} == set(world.present) - {"feed_screw"}
    for source in campaign.sources.values():
        assert isinstance(source.files, str)
        assert all((folder / source.files.replace("{test}", t.id)).is_file() for t in campaign.tests)


def test_nothing_that_the_lab_has_tells_the_truth(lab: tuple[Path, World]) -> None:
    folder, _ = lab
    text = (folder / "campaign.yaml").read_text(encoding="utf-8") + (folder / "model.yaml").read_text("utf-8")
    assert "truth" not in text
    assert "feed_screw" not in text
    truth = json.loads((folder / "truth" / "truth.json").read_text(encoding="utf-8"))
    assert truth["hidden"] == "feed_screw"
    assert set(truth["rms_um"]) == set(truth["present"])


def test_tdms_holds_volts_that_a_signed_sensitivity_turns_into_the_truth(lab: tuple[Path, World]) -> None:
    from nptdms import TdmsFile

    folder, world = lab
    book = Logbook.draw(world)
    truth = json.loads((folder / "truth" / "truth.json").read_text(encoding="utf-8"))
    for run in world.runs:
        file = TdmsFile.read(folder / "raw" / f"{run.op.id}.tdms")
        for i, probe in enumerate(book.probes):
            channel = file["Eddy"][probe.axis]
            assert channel.properties["unit_string"] == "V"
            assert channel.properties["wf_increment"] == 2.0
            start = np.datetime64(round(run.start_unix_s), "s")
            assert abs(np.datetime64(channel.properties["wf_start_time"], "s") - start) == np.timedelta64(0, "s")
            volts = channel[:]
            assert len(volts) == run.op.n * 5
            free = np.repeat(run.op.measuring, 5)
            assert np.all(volts[~free] == 20.0)  # rails while the axis is away
            um = truth["probes_um_per_v"][probe.axis] * (volts - probe.zero_v)
            expected = np.repeat(run.displacement[i], 5)
            assert np.median(np.abs(um - expected)[free]) < 1.0
        assert {c.name[0] for c in file["Temp"].channels()} == {"T"}


def test_the_jump_test_moves_by_what_the_campaign_file_says(lab: tuple[Path, World]) -> None:
    from nptdms import TdmsFile

    folder, world = lab
    for probe in Logbook.draw(world).probes:
        file = TdmsFile.read(folder / "raw" / f"jump_{probe.axis}.tdms")
        um = probe.um_per_v * (file["Eddy"][probe.axis][:] - probe.zero_v)
        levels = [np.median(um[k * 120 + 20 : (k + 1) * 120 - 20]) for k in range(7)]
        np.testing.assert_allclose(np.diff(levels), [0, 100, 50, -200, -50, 100], atol=3.0)


def test_the_jump_test_gives_back_the_probes_signed_sensitivity(lab: tuple[Path, World]) -> None:
    from nptdms import TdmsFile

    from thermodata.calibration.jump.evaluate import evaluate_jump
    from thermodata.schema.files.campaign import JumpCalibration

    folder, world = lab
    campaign = load_campaign(folder / "campaign.yaml")
    for probe in Logbook.draw(world).probes:
        spec = campaign.calibrations[f"jump_{probe.axis}"]
        assert isinstance(spec, JumpCalibration)
        channel = TdmsFile.read(folder / spec.file)["Eddy"][probe.axis]
        t_ns = (np.arange(len(channel)) * channel.properties["wf_increment"] * 1e9).astype(np.int64)
        found = evaluate_jump("jump", spec, t_ns, channel[:])
        assert found.gain == pytest.approx(probe.um_per_v, rel=0.02)


def test_the_control_writes_local_time_decimal_commas_and_cp1250(lab: tuple[Path, World]) -> None:
    folder, world = lab
    book = Logbook.draw(world)
    run = world.runs[-1]
    path = folder / "raw" / f"{run.op.id}.csv"
    with pytest.raises(UnicodeDecodeError):
        path.read_bytes().decode("utf-8")
    table = pd.read_csv(path, sep=";", decimal=",", encoding="cp1250", header=[0, 1])
    table.columns = table.columns.get_level_values(0)
    assert len(table) == run.op.n
    np.testing.assert_allclose(table[book.names["spindle_speed"]], run.op.speed)
    local = pd.to_datetime(table["Datum a čas"], format="%d.%m.%Y %H:%M:%S").dt.tz_localize("Europe/Prague")
    first = local.iloc[0].timestamp() + book.nc_offset_s
    assert first == pytest.approx(run.start_unix_s, abs=1.0)


def test_the_recorder_writes_mcap_with_json(lab: tuple[Path, World]) -> None:
    from mcap.reader import make_reader

    folder, world = lab
    book = Logbook.draw(world)
    run = world.runs[0]
    with (folder / "raw" / f"{run.op.id}.mcap").open("rb") as stream:
        rows = [(m.publish_time, json.loads(m.data)) for _, _, m in make_reader(stream).iter_messages()]
    assert len(rows) == run.op.n
    np.testing.assert_allclose([r["top"] for _, r in rows], run.readings["T_hall_top"], atol=1e-3)
    assert rows[0][0] / 1e9 + book.rec_offset_s == pytest.approx(run.start_unix_s, abs=0.01)


def test_the_truth_of_each_test_is_a_table(lab: tuple[Path, World]) -> None:
    folder, world = lab
    run = world.runs[2]
    table = pd.read_parquet(folder / "truth" / f"{run.op.id}.parquet")
    parts = sum(table[f"{e}_{world.axis}"] for e in world.present)
    assert np.std(table[world.response] - parts) < 3 * world.noise_um


def test_a_folder_with_a_campaign_is_left_alone(lab: tuple[Path, World]) -> None:
    folder, _ = lab
    before = (folder / "campaign.yaml").read_bytes()
    with pytest.raises(UsageError, match="holds a campaign"):
        simulate(folder, "coolant", 1)
    assert (folder / "campaign.yaml").read_bytes() == before


def test_the_same_seed_writes_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        simulate(tmp_path / name, "hydraulics", 5, tests=2, hours=2)
    for path in sorted((tmp_path / "a").rglob("*")):
        if path.is_file() and path.suffix != ".parquet":
            assert path.read_bytes() == (tmp_path / "b" / path.relative_to(tmp_path / "a")).read_bytes(), path.name
