"""What an ingest says to do next."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from ..commands import Say
from .conftest import write_campaign


def test_after_nothing_was_read_no_model_is_proposed(say: Say, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    whole = {log: log.read_bytes() for log in (tmp_path / "lab/raw").iterdir()}
    for log in whole:
        log.write_bytes(b"\x00\x01\x02" * 50)
    done = say("--store", tmp_path / "s", "ingest", path)
    assert done.code == 3
    assert done.err.splitlines()[-1] == f"next: mend what was lost, then thermodata ingest {path} again"
    for log, content in list(whole.items())[:1]:
        log.write_bytes(content)
    done = say("--store", tmp_path / "s", "ingest", path)
    assert done.code == 3, "but there is a test to fit"
    assert "next: thermodata first-model" in done.err.splitlines()[-1]


def test_without_roles_there_is_nothing_to_fit(say: Say, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    path.write_text(re.sub("role: [a-z]+", "role: none", path.read_text()))
    model = path.with_name("model.yaml")

    def step() -> str:
        done = say("--store", tmp_path / "s", "ingest", path)
        assert done.code == 0
        return str(done.err.splitlines()[-1])

    said = step()
    assert said.startswith(f"next: give the tests roles in {path}, for none has 'role: calibration'")
    assert said.endswith(f"thermodata first-model {path} drafts {model}; thermodata fit {model}")
    baseline = path.with_name("baseline.yaml").read_text()
    model.write_text(baseline)
    assert "give the tests roles" in step()
    model.write_text(baseline + "calibrate_on: [heat1]\n")
    assert step() == f"next: thermodata fit {model}"
    assert say("--store", tmp_path / "s", "fit", model).code == 0


def test_a_model_of_no_campaign_of_the_store_is_not_put_down_to_the_roles(say: Say, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    model = path.with_name("model.yaml")
    baseline = path.with_name("baseline.yaml").read_text()
    model.write_text(re.sub("^campaign: .*$", "campaign: before", baseline, flags=re.M))
    line = next(i for i, text in enumerate(baseline.splitlines(), 1) if text.startswith("campaign:"))
    name = str(re.search("^id: (.*)$", path.read_text(), re.M)[1])  # type: ignore[index]
    said = say("--store", tmp_path / "s", "ingest", path).err.splitlines()[-1]
    assert said == (
        f"next: write '{name}' in place of 'before' at model.yaml:{line} (campaign), for the store has '{name}', then "
        f"thermodata fit {model}"
    )


@pytest.mark.parametrize(("signal", "read"), [("dZ", True), ("T_bearing", True), ("T_nut_Z", False)])
def test_a_channel_that_every_test_lost_is_mended_first_where_the_model_reads_it(
    say: Say, tmp_path: Path, signal: str, read: bool
) -> None:
    path = write_campaign(tmp_path / "lab")
    logs = sorted((tmp_path / "lab/raw").iterdir())
    whole = logs[0].read_text()
    for log in logs:
        log.write_text(log.read_text().replace(f"{signal} [", "other ["))

    def step() -> str:
        done = say("--store", tmp_path / "s", "ingest", path)
        assert done.code == 3
        return str(done.err.splitlines()[-1])

    model = path.with_name("model.yaml")
    again = f"then thermodata ingest {path} again"
    assert step() == f"next: mend {signal}, which a first model reads and every test lost, {again}"
    model.write_text(path.with_name("baseline.yaml").read_text())
    mend = f"next: mend {signal}, which {model} reads and every test lost, {again}"
    assert step() == (mend if read else f"next: thermodata fit {model}")
    logs[0].write_text(whole)  # one test has it
    assert step() == f"next: thermodata fit {model}"


def test_a_channel_without_a_unit_has_none_and_is_mended_first(say: Say, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    for log in (tmp_path / "lab/raw").iterdir():
        log.write_text(re.sub(r"dZ \[\w+\]", "dZ", log.read_text()))
    path.write_text(re.sub(r"(dZ: \{.*?), unit: um(.*), calibration: \w+", r"\1\2", path.read_text()))
    model = path.with_name("model.yaml")
    model.write_text(path.with_name("baseline.yaml").read_text())
    done = say("--store", tmp_path / "s", "ingest", path)
    assert done.code == 3
    assert "no unit is known of channels.dZ" in done.err + done.out
    assert done.err.splitlines()[-1].startswith(f"next: mend dZ, which {model} reads and every test lost")
    asked = "select distinct channel, unit from channel where channel in ('dZ', 'T_bearing') order by channel"
    assert say("--store", tmp_path / "s", "sql", asked, "--csv").out.splitlines()[1:] == ["T_bearing,degC", "dZ,"]


def test_a_lost_channel_that_a_first_model_does_without_stops_nothing(say: Say, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    for log in (tmp_path / "lab/raw").iterdir():
        log.write_text(log.read_text().replace("feed_Z [", "other ["))
    model = path.with_name("model.yaml")
    done = say("--store", tmp_path / "s", "ingest", path)
    assert done.code == 3
    fit = f"thermodata fit {model}"
    assert done.err.splitlines()[-1] == f"next: thermodata first-model {path} drafts {model}; {fit}"
    assert say("first-model", path).code == 0
    assert say("--store", tmp_path / "s", "fit", model).code == 0


@pytest.mark.parametrize(
    ("drivers", "lost", "read"),
    [
        ("{effect: coolant, drivers: {state: feed_Z}}", "feed_Z", True),
        ("{effect: lag, drivers: {u: spindle_speed - feed_Z}}", "feed_Z", True),
        ("{effect: lag, drivers: {u: {at: axis.z.nut}}}", "T_nut_Z", True),
        ("{effect: lag, drivers: {u: {at: axis.z}}}", "T_hall", False),
        ("{effect: lag, id: T_hall, drivers: {u: T_bearing}}", "T_hall", False),
        ("{effect: coolant, drivers: {state: feed_Z}, fixed: {gain: 1}}", "gain", False),
        ("{effect: coolant, drivers: {state: feed_Z}}", "state", False),
        ("{effect: coolant, drivers: {state: feed_Z}}", "coolant", False),
    ],
)
def test_a_model_reads_what_its_drivers_name_and_what_lies_at_their_places(
    say: Say, tmp_path: Path, drivers: str, lost: str, read: bool
) -> None:
    path = write_campaign(tmp_path / "lab")
    for log in (tmp_path / "lab/raw").iterdir():
        log.write_text(log.read_text().replace(f"{lost} [", "other ["))
    if f"  {lost}:" not in path.read_text():
        more = f"  {lost}: {{source: log, signal: {lost}, quantity: state, at: coolant}}"
        path.write_text(path.read_text().replace("calibrations:", f"{more}\ncalibrations:"))
    model = path.with_name("model.yaml")
    base = path.with_name("baseline.yaml").read_text()
    model.write_text(f"{base[: base.index('effects:')]}effects:\n  - {drivers}\n")
    done = say("--store", tmp_path / "s", "ingest", path)
    assert done.code == 3
    assert (f"mend {lost}, which" in done.err.splitlines()[-1]) is read


def test_a_model_that_was_drafted_before_places_were_answered_is_drafted_anew(say: Say, tmp_path: Path) -> None:
    path = write_campaign(tmp_path / "lab")
    model, answered = path.with_name("model.yaml"), path.read_text()

    def step() -> str:
        return str(say("--store", tmp_path / "s", "ingest", path).err.splitlines()[-1])

    assert "at: axis.z.nut" in answered
    path.write_text(answered.replace("at: axis.z.nut", "at: unused"))
    assert say("first-model", path).code == 0
    assert step() == f"next: thermodata fit {model}"
    path.write_text(answered)
    assert step() == f"next: thermodata first-model {path} drafts {model}; thermodata fit {model}"
    model.write_text(model.read_text().replace("step: 60 s", "step: 30 s"))
    assert step() == f"next: thermodata fit {model}", "what somebody changed is theirs"
    assert say("first-model", path).code == 0
    assert step() == f"next: thermodata fit {model}"
