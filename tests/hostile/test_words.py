"""What was said too quietly: moves, places, times and names that are wrong end as an error, or as a line."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import h5py
import numpy as np
import pytest

from tests.stored_fits import score_of
from thermodata.errors import UsageError
from thermodata.report.text.added import before_after_text, made_worse
from thermodata.report.words.numbers import in_units
from thermodata.schema.answers.result import FitResult, Score
from thermodata.schema.files.campaign import Campaign
from thermodata.store.ingest.told.declared.unanswered import unanswered
from thermodata.view import StoreView

from .conftest import Lab
from .test_times import T1, rows, stamps

DZ = {"signal": "Z", "quantity": "displacement", "unit": "V", "axis": "Z", "at": "tcp", "calibration": "jump_z"}
JUMP = {"kind": "jump", "axis": "Z", "source": "log", "file": "cal/jump.csv", "signal": "Z", "dwell": "10 s"}


def jump(moves: list[float], volts_per_um: float = 0.02) -> str:
    """A log at 10 Hz of a probe that is moved, 10 s at each place."""
    levels = np.repeat(5 + np.concatenate([[0.0], np.cumsum(moves)]) * volts_per_um, 100)
    noise = 1e-4 * np.random.default_rng(1).standard_normal(levels.size)
    return "time [s],Z [V]\n" + "".join(f"{i / 10:.1f},{v:.6f}\n" for i, v in enumerate(levels + noise))


def test_moves_that_leave_out_steps_are_said(lab: Lab) -> None:
    lab.write("raw/a.csv", jump([0.5, 0.5]))
    lab.write("cal/jump.csv", jump([100, -50, 60, 100, -50]))
    said = lab.ingest({"dZ": DZ}, calibrations={"jump_z": {**JUMP, "moves": ["100 um", "-50 um", "60 um"]}})
    assert said.code == 3
    assert "2 more steps as large as the 3 commanded moves" in said.out + said.err
    whole = {**JUMP, "moves": ["100 um", "-50 um", "60 um", "100 um", "-50 um"]}
    said = lab.ingest({"dZ": DZ}, calibrations={"jump_z": whole})
    assert "more steps as large" not in said.out + said.err


def test_a_mistyped_jump_file_is_not_replaced_by_an_older_copy(lab: Lab) -> None:
    lab.write("raw/a.csv", jump([0.5, 0.5]))
    lab.write("cal/jump.csv", jump([100, -100]))
    moves = {"moves": ["100 um", "-100 um"]}
    assert lab.ingest({"dZ": DZ}, calibrations={"jump_z": {**JUMP, **moves}}).code == 0
    said = lab.ingest({"dZ": DZ}, calibrations={"jump_z": {**JUMP, **moves, "file": "cal/jmp.csv"}})
    assert said.code == 3
    assert "no such file: the calibration can't be evaluated; did you mean 'jump.csv'?" in said.out + said.err
    assert np.isnan(lab.values("dZ")[1]).all()


def test_a_time_beyond_a_test_is_refused(lab: Lab) -> None:
    lab.write("raw/a.csv", "time;T\n" + rows(stamps("2026-03-02 08:00:00", 10, 361)))
    assert lab.ingest(T1).code == 0
    for at in ("25 h", "-1 h"):
        said = lab("trace", "odd", "one", "T1", f"--at={at}")
        assert said.code == 2
        assert "expected: a time from 0 s to 3600 s (1 h)" in said.err
    assert lab("trace", "odd", "one", "T1", "--at", "1 h").code == 0
    assert lab("trace", "odd", "one", "T1", "--at", "3 s").code == 0


def test_a_wrong_place_is_answered_with_the_nearest_and_open_questions_are_listed(lab: Lab) -> None:
    lab.write("raw/a.csv", "time;T\n" + rows(stamps("2026-03-02 08:00:00", 10, 40)))
    said = lab.ingest({"T1": {**T1["T1"], "at": "spindle.bearng.front"}})
    assert "no place 'spindle.bearng.front' is known; did you mean 'spindle.bearing.front'?" in said.out
    said = lab.ingest(T1)
    assert "without a place (at: ...): T1; no effect that needs one there will be tried" in said.out
    assert "no test has a role" in said.out
    said = lab.ingest({"T1": {**T1["T1"], "at": "spindle.bearing.front"}}, tests=[{"id": "one", "role": "calibration"}])
    assert "did you mean" not in said.out
    assert "without a place" not in said.out
    assert "no test has a role" not in said.out
    # places of a lab's own are allowed: what is near to none is left alone
    assert "no place" not in lab.ingest({"T1": {**T1["T1"], "at": "quill.xyzzy"}}).out


@pytest.mark.parametrize(
    ("at", "meant"),
    [
        ("frame", "did you mean 'bed' or 'column'?"),
        ("Frame.top", "did you mean 'bed.top' or 'column.top'?"),
        ("crossrail.left", "did you mean 'crossbeam.left'?"),
        ("oil", "did you mean 'hydraulics' or 'lubrication' or 'coolant'?"),
        ("rams", "did you mean 'ram'?"),
    ],
)
def test_a_place_by_another_word_is_answered_with_ours(at: str, meant: str) -> None:
    channel = {"source": "daq", "signal": "T", "quantity": "temperature", "unit": "degC", "at": at}
    campaign = {
        "schema": "thermodata/campaign/1",
        "id": "c",
        "sources": {"daq": {"reader": "table", "files": "*.csv"}},
        "channels": {"T1": channel},
    }
    (said,) = [s for s in unanswered(Campaign.model_validate(campaign)) if "no place" in s]
    assert said == f"channel 'T1': no place '{at}' is known; {meant}"


def test_a_residual_of_an_unknown_test_names_the_nearest(story: Path) -> None:
    view = StoreView(story)
    assert view.residual("baseline", test="day1").fetchall()
    with pytest.raises(UsageError, match="no test in the predictions of baseline 'dayx'") as caught:
        view.residual("baseline", test="dayx")
    assert "day" in str(caught.value.hint)
    with pytest.raises(UsageError, match="no response"):
        view.residual("baseline", response="dQ")


@pytest.fixture
def story(lab: Lab) -> Path:
    body = "".join(
        f"{i * 60},{20 + 5 * (1 - np.exp(-i / 60)):.4f},{3 * (1 - np.exp(-i / 90)):.4f}\n" for i in range(300)
    )
    for test in ("heat1", "day1"):
        lab.write(f"raw/{test}.csv", f"time [s],T1 [degC],dZ [um]\n{body}")
    said = lab.ingest(
        {
            "T1": {"signal": "T1", "quantity": "temperature", "at": "spindle.bearing.front"},
            "dZ": {"signal": "dZ", "quantity": "displacement", "axis": "Z", "at": "tcp", "calibration": "probe"},
        },
        {"files": "raw/{test}.csv"},
        tests=[{"id": "heat1", "role": "calibration"}, {"id": "day1", "role": "verification"}],
        calibrations={
            "probe": {"kind": "scale", "axis": "Z", "gain": "1 um/um", "facing": "-Z", "increases_with": "approach"}
        },
    )
    assert said.code == 0, said.out + said.err
    lab.write(
        "model.yaml",
        "schema: thermodata/model/1\nname: baseline\ncampaign: odd\nresponse: {axis: Z, at: tcp}\nstep: 60 s\n"
        "effects: [{effect: spindle_bearing, drivers: {temperature: T1}}]\n",
    )
    assert lab("fit", lab.folder / "model.yaml").code == 0
    return lab.folder / "store"


def score(role: str, rmse_um: float) -> Score:
    return score_of(role, role=role, rmse_um=rmse_um)


@pytest.mark.parametrize(("after", "worse"), [(3.0, False), (3.61, False), (3.84, True)])
def test_an_effect_that_makes_a_model_worse_is_said(after: float, worse: bool) -> None:
    result = FitResult(
        model="m", name="m", parent=None, campaigns=["c"], response="dZ", parameters={}, checks=[],
        scores=[score("verification", after)], before=[score("verification", 3.61)],
    )  # fmt: skip
    assert (made_worse(result, {}) is not None) is worse


@pytest.mark.parametrize(
    ("locked", "told"), [((1.84, 5.01), True), ((1.84, 1.84), False), ((1.84, 1.2), False), ((None, None), False)]
)
def test_locked_tests_that_a_claim_makes_worse_come_before_the_errors_that_it_makes_better(
    locked: tuple[float | None, float | None], told: bool
) -> None:
    result = FitResult(
        model="m", name="m", parent=None, campaigns=["c"], response="dZ", parameters={}, checks=[],
        scores=[score("verification", 0.3)], before=[score("verification", 3.0)],
        locked_rmse_um_before=locked[0], locked_rmse_um_after=locked[1],
    )  # fmt: skip
    text = before_after_text(result)
    worse = (
        "the locked tests get worse with what the diagnosis claims: 1.84 -> 5.01 um, 2.7 times as much, as its answer"
    )
    assert text.startswith(f"as they are scored, from their first samples on, {worse} says, which judges by") is told
    assert ("get worse" in text) is told
    own = f"locked tests, opened for what the diagnosis claims: 1.84 -> {locked[1]:.2f} um" if locked[1] else "locked"
    assert (own in text) is (locked[1] is not None and not told)


@pytest.mark.parametrize(("fitted", "told"), [(6.0, False), (2.0, True)])
def test_locked_tests_get_worse_beside_the_model_as_it_is_fitted_not_beside_a_refit(fitted: float, told: bool) -> None:
    result = FitResult(
        model="m", name="m", parent=None, campaigns=["c"], response="dZ", parameters={}, checks=[],
        scores=[score("verification", 0.3)], before=[score("verification", 3.0)],
        locked_rmse_um_before=1.84, locked_rmse_um_after=5.01, locked_rmse_um_fitted=fitted,
    )  # fmt: skip
    assert ("get worse with what the diagnosis claims: 2.00 -> 5.01 um, 2.5 times" in before_after_text(result)) is told


def test_of_several_responses_no_figure_stands_in_the_unit_of_another() -> None:
    """Which of them was diagnosed, and in which unit, no result of a fit says."""
    result = FitResult(
        model="m", name="m", parent=None, campaigns=["c"], response=["dZ", "T_nut"], parameters={}, checks=[],
        scores=[score("verification", 0.3)], before=[score("verification", 3.0)],
        locked_rmse_um_before=0.2, locked_rmse_um_after=0.4,
    )  # fmt: skip
    text = in_units(before_after_text(result), {"dZ": "um", "T_nut": "K"})
    assert "the locked tests get worse with what the diagnosis claims: 2.0 times as much, as its answer says" in text


def test_a_response_that_gets_worse_is_said_in_its_own_unit_beside_one_that_gets_better() -> None:
    before, after = {"dZ": 9.0, "T_nut": 0.2}, {"dZ": 3.0, "T_nut": 0.4}
    result = FitResult(
        model="m", name="m", parent=None, campaigns=["c"], response=["dZ", "T_nut"], parameters={}, checks=[],
        scores=[score("verification", e).model_copy(update={"response": n}) for n, e in after.items()],
        before=[score("verification", e).model_copy(update={"response": n}) for n, e in before.items()],
    )  # fmt: skip
    said = str(made_worse(result, {"dZ": "um", "T_nut": "K"}))
    assert "an error rises with it: T_nut verification 0.2 -> 0.4 K;" in said
    assert "dZ" not in said


@pytest.mark.parametrize("kind", ["link", "external", "virtual"])
def test_an_hdf5_file_that_reads_others_is_refused(lab: Lab, kind: str) -> None:
    secret = lab.folder / "secret.mat"
    secret.parent.mkdir(parents=True, exist_ok=True)
    values = np.arange(50.0)[None, :]
    with h5py.File(secret, "w") as file:
        file["T1"] = values
        file["T1"].attrs["MATLAB_class"] = np.bytes_("double")
    (lab.folder / "secret.bin").write_bytes(values.tobytes())
    path = lab.write("raw/a.mat", b"")
    with h5py.File(path, "w", userblock_size=512) as file:
        file["time"] = values
        file["T2"] = values
        if kind == "link":
            file["T1"] = h5py.ExternalLink(os.fspath(secret), "/T1")
        elif kind == "external":
            file.create_dataset("T1", (1, 50), "<f8", external=[(os.fspath(lab.folder / "secret.bin"), 0, 400)])
        else:
            layout = h5py.VirtualLayout((1, 50), "<f8")
            layout[:] = h5py.VirtualSource(os.fspath(secret), "T1", (1, 50))
            file.create_virtual_dataset("T1", layout)
        for name in ("time", "T2", *(() if kind == "link" else ("T1",))):
            file[name].attrs["MATLAB_class"] = np.bytes_("double")
    head = b"MATLAB 7.3 MAT-file".ljust(116) + bytes(8) + b"\x00\x02IM"
    with path.open("r+b") as raw:
        raw.write(head)
    found = lab("preview", path)
    assert "another file" in found.out + found.err, (found.code, found.out[-800:], found.err)
    assert "T1  " not in found.out
    shutil.rmtree(lab.folder / "raw")


def test_a_file_whose_name_is_no_utf8_is_named_and_the_others_are_drafted(lab: Lab) -> None:
    rows = "".join(f"2026-03-02 08:{i:02d}:00,{20 + i / 10}\n" for i in range(40))
    lab.write("raw/b.csv", "time,T_spindle [degC]\n" + rows)
    with open(os.fsencode(lab.folder) + b"/raw/caf\xe9.csv", "wb") as file:
        file.write(b"time,T_spindle [degC]\n" + rows.encode())
    assert lab("init", lab.folder).code == 0
    drafted = (lab.folder / "campaign.yaml").read_text(encoding="utf-8")
    assert "# not used: raw/caf .csv: its name is no UTF-8" in drafted
    assert "another name" in drafted
    assert lab("ingest", lab.folder / "campaign.yaml").code == 0
    assert lab.values("T_spindle", "b")[1].size == 40


@pytest.mark.parametrize("line", ['- {id: "caf\\udce9"}', '- {id: a, conditions: {"\\udce9": 1}}'])
def test_half_a_letter_in_a_campaign_file_is_refused_with_its_line(lab: Lab, line: str) -> None:
    lab.write("campaign.yaml", "schema: thermodata/campaign/1\nid: odd\nsources: {}\nchannels: {}\ntests:\n  " + line)
    said = lab("ingest", lab.folder / "campaign.yaml")
    assert said.code == 2
    assert "a text that is no UTF-8" in said.err
    assert "campaign.yaml:6" in said.err


@pytest.mark.parametrize(
    ("content", "name", "what"),
    [
        (b'[{"time": 0, "T": 20.5},\n {"time": 1, "T": 20.6}]\n', "a.json", "or export it as CSV"),
        (b"<html><table><tr><td>time</td><td>T</td></tr></table></html>", "a.xls", "save it as XLSX"),
        ("time,T\n0,20.5\n1,20.6\n".encode("utf-32"), "a.csv", "save it as UTF-8"),
    ],
)
def test_what_no_declaration_would_read_gets_no_such_advice(lab: Lab, content: bytes, name: str, what: str) -> None:
    said = lab("sniff", lab.write(f"raw/{name}", content))
    assert said.code == 2
    assert what in said.out
    assert "declare" not in said.out.split("  try ")[-1] or "  try " not in said.out


def test_a_line_of_json_above_a_table_does_not_hide_it(lab: Lab) -> None:
    path = lab.write("raw/a.csv", '{"machine": "M"}\ntime;T\n' + rows(stamps("2026-03-02 08:00:00", 10, 40)))
    said = lab("sniff", path)
    assert said.code == 0
    assert "export it as CSV" not in said.out


def test_row_numbers_without_a_name_shift_no_column(lab: Lab) -> None:
    """As R writes a table: its header has a cell less than the rows."""
    times = stamps("2026-03-02 08:00:00", 10, 40)
    lines = "".join(f'"{i + 1}","{t}",{20 + i / 8},{i}.5\n' for i, t in enumerate(times))
    lab.write("raw/a.csv", '"time","T_spindle [degC]","X [um]"\n' + lines)
    assert lab("init", lab.folder).code == 0
    assert lab("ingest", lab.folder / "campaign.yaml").code == 0
    np.testing.assert_allclose(lab.values("T_spindle", "a")[1], 20 + np.arange(40) / 8)
    np.testing.assert_allclose(lab.values("X", "a")[1], np.arange(40) + 0.5)


@pytest.mark.parametrize("name", ["2026_03_02", "1_2", "010", "1.50", "0x1F", "12:30", "1e3", "no", "on", "+5"])
def test_an_id_is_what_stands_there_and_no_number_of_yaml(lab: Lab, name: str) -> None:
    lab.write(f"raw/{name}.csv", "time;T\n" + rows(stamps("2026-03-02 08:00:00", 10, 40)))
    lab.write(
        "campaign.yaml",
        "schema: thermodata/campaign/1\nid: odd\nsources: {log: {reader: table, files: 'raw/{test}.csv'}}\n"
        "channels: {T1: {source: log, signal: T, quantity: temperature, unit: degC}}\n"
        f"tests:\n  - {{id: {name}}}\n",
    )
    said = lab("ingest", lab.folder / "campaign.yaml")
    assert said.code == 0, said.out + said.err
    assert lab.values("T1", name)[1].size == 40


@pytest.mark.parametrize(
    "key", ["clock: {offset: 1e300 s}", "clock: {offset: -300 year}", "table: {time: {period: 1e12 s}}"]
)
def test_a_time_of_centuries_is_refused_with_its_line(lab: Lab, key: str) -> None:
    lab.write("raw/a.csv", "time;T\n" + rows(stamps("2026-03-02 08:00:00", 10, 40)))
    lab.write(
        "campaign.yaml",
        f"schema: thermodata/campaign/1\nid: odd\nsources: {{log: {{reader: table, files: 'raw/*', {key}}}}}\n"
        "channels: {T1: {source: log, signal: T, quantity: temperature, unit: degC}}\ntests: [{id: a}]\n",
    )
    said = lab("ingest", lab.folder / "campaign.yaml")
    assert said.code == 2
    assert "292 years" in said.err
    assert "campaign.yaml:3" in said.err
