"""The sign of a displacement is asked and told until something turns it; a second jump test is named as one."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest
import yaml

from thermodata.draft.make import draft_files
from thermodata.draft.probes.jumps import JumpTest
from thermodata.schema.files.campaign import Campaign
from thermodata.store.ingest.told.declared.unanswered import unanswered


def log(path: Path, column: str, values: list[float]) -> None:
    path.parent.mkdir(exist_ok=True)
    rows = "".join(f"{i},{v:.4f},22.0\n" for i, v in enumerate(values))
    path.write_text(f"time [s],{column},T1 [degC]\n{rows}")


def staircase(height: float) -> list[float]:
    return [5.0 + 0.0003 * (i % 3) + height * ((i // 20) % 2) for i in range(200)]


def test_the_sign_of_a_displacement_in_micrometres_is_asked(tmp_path: Path) -> None:
    log(tmp_path / "lab" / "S3000.csv", "dZ [um]", [i / 10 for i in range(100)])
    made = draft_files(tmp_path / "lab").draft
    (asked,) = [q for c in made.channels if c.name == "dZ" for q in c.said.questions]
    assert "which way does it count?" in asked
    assert "axis: Z, gain: 1 um/um, facing: ?, increases_with: ?" in asked
    assert "the machine's sign already, + where the tool goes towards +Z: facing: +Z, increases_with: gap" in asked


def test_no_axis_is_offered_to_a_displacement_whose_name_has_none(tmp_path: Path) -> None:
    log(tmp_path / "lab" / "S3000.csv", "Taster [um]", [i / 10 for i in range(100)])
    made = draft_files(tmp_path / "lab").draft
    (asked,) = [q for c in made.channels for q in c.said.questions if "which way" in q]
    assert "'calibration: sign' stands here, and sign: {kind: scale, axis: ?," in asked


@pytest.mark.parametrize(
    ("calibration", "told"),
    [
        (None, True),
        ({"kind": "scale", "axis": "Z", "gain": "1 um/um"}, True),
        ({"kind": "scale", "axis": "Z", "gain": "1 um/um", "facing": "-Z"}, False),
        ({"kind": "linear", "gain": 1, "offset": "1 um"}, True),
    ],
)
def test_it_is_told_with_every_ingest_until_something_turns_it(
    calibration: dict[str, object] | None, told: bool
) -> None:
    channel = {"source": "log", "signal": "dZ", "quantity": "displacement", "unit": "um", "axis": "Z", "at": "tcp"}
    campaign = {
        "schema": "thermodata/campaign/1",
        "id": "lab",
        "sources": {"log": {"reader": "table", "files": "{test}.csv"}},
        "channels": {"dZ": channel | ({"calibration": "z"} if calibration else {})},
        "calibrations": {"z": calibration} if calibration else {},
        "tests": [{"id": "a", "kind": "mixed", "role": "none"}],
    }
    said = [
        s for s in unanswered(Campaign.model_validate(yaml.safe_load(yaml.safe_dump(campaign)))) if "sign unknown" in s
    ]
    assert bool(said) is told
    assert all("dZ" in s and "facing" in s for s in said)


def test_a_second_jump_test_of_a_probe_is_named_with_the_steps_of_both(tmp_path: Path) -> None:
    log(tmp_path / "lab" / "S3000.csv", "Probe Z [V]", [5 + i / 10_000 for i in range(3000)])
    log(tmp_path / "lab" / "jump_Z_after.csv", "Probe Z [V]", staircase(2.12))
    log(tmp_path / "lab" / "jump_Z_before.csv", "Probe Z [V]", staircase(2.0))
    ((path, why),) = [x for x in draft_files(tmp_path / "lab").draft.not_used if "jump" in x[0]]
    assert path == "jump_Z_before.csv"
    assert "a second jump test of 'Probe Z [V]', beside jump_Z_after.csv" in why
    assert "-5.7 %" in why


@pytest.mark.parametrize(("factor", "said"), [(-1.0, True), (-2.0, True), (1.0, False)])
def test_a_second_jump_test_of_the_opposite_sign_is_told_as_one(tmp_path: Path, factor: float, said: bool) -> None:
    for name, steps in (("a", staircase(2.0)), ("b", [10 + factor * (v - 10) for v in staircase(2.0)])):
        log(tmp_path / "lab" / f"jump_Z_{name}.csv", "Probe Z [V]", steps)
    log(tmp_path / "lab" / "S3000.csv", "Probe Z [V]", [5 + i / 10_000 for i in range(3000)])
    ((path, why),) = [x for x in draft_files(tmp_path / "lab").draft.not_used if "jump" in x[0]]
    assert path == "jump_Z_b.csv"
    assert ("of opposite signs" in why) is said
    assert ("so much, and in sign," in why) is said
    assert "channels: {Probe_Z: {calibration: ...}}" in why


def test_a_jump_test_in_which_nothing_moves_is_named_as_such(tmp_path: Path) -> None:
    log(tmp_path / "lab" / "S3000.csv", "dZ [um]", [i / 10 for i in range(3000)])
    log(tmp_path / "lab" / "jump_Z.csv", "dZ [um]", [5.0 + 0.01 * (i % 3) for i in range(200)])
    draft = draft_files(tmp_path / "lab").draft
    ((_, why),) = [x for x in draft.not_used if "jump" in x[0]]
    assert why == "taken for a jump test by its name, and nothing is seen to move in it"
    assert any("which way does it count?" in q for c in draft.channels for q in c.said.questions)


def test_a_probe_without_a_unit_is_one_by_its_name_and_has_its_jump_test(tmp_path: Path) -> None:
    log(tmp_path / "lab" / "S3000.csv", "probe.x", [5.0 + i / 100 for i in range(200)])
    log(tmp_path / "lab" / "S6000.csv", "probe.x", [5.0 - i / 100 for i in range(200)])
    log(tmp_path / "lab" / "jump_X.csv", "probe.x", staircase(2.0))
    made = draft_files(tmp_path / "lab").draft
    (probe,) = [c for c in made.channels if c.signal == "probe.x"]
    assert (probe.said.quantity, probe.said.axis, probe.calibration) == ("displacement", "X", "jump_probe_x")
    assert any("unit" in q for q in probe.said.questions)
    assert [t.id for t in made.tests] == ["S3000", "S6000"], "a jump test is no test"


def test_a_test_says_how_long_it_is_beside_its_kind(tmp_path: Path) -> None:
    log(tmp_path / "lab" / "idle.csv", "dZ [um]", [i / 10 for i in range(2401)])
    log(tmp_path / "lab" / "spindle.csv", "dZ [um]", [i / 10 for i in range(9001)])
    made = draft_files(tmp_path / "lab")
    text = made.campaign.read_text(encoding="utf-8")
    lines = {t.id: line for t in made.draft.tests for line in text.splitlines() if f"{{id: {t.id}," in line}
    assert lines["idle"].endswith("; 40 min")
    assert lines["spindle"].endswith("; 2.5 h")


def test_a_jump_test_finds_its_probe_where_each_signal_has_a_stream() -> None:
    def jump(*signals: str) -> JumpTest:
        file = SimpleNamespace(signals=[SimpleNamespace(stream=f"s{i}", name=n) for i, n in enumerate(signals)])
        return JumpTest(file, ("s0", signals[0]), (), 10.0, True)  # type: ignore[arg-type]

    assert jump("Y").is_of("s0", "Y")
    assert jump("Y").is_of("s1", "Y"), "the second signal of the tests, and the first here"
    assert not jump("Y").is_of("s0", "X")
    assert not jump("Y", "Y").is_of("s1", "Y"), "two of one name are told apart by their streams"


def beside(path: Path, y: list[float], z: list[float]) -> None:
    path.parent.mkdir(exist_ok=True)
    rows = "".join(f"{i},{a:.4f},{b:.4f},22.0\n" for i, (a, b) in enumerate(zip(y, z, strict=True)))
    path.write_text(f"time [s],Probe Y [V],Probe Z [V],T1 [degC]\n{rows}")


@pytest.mark.parametrize(
    ("name", "height", "both"),
    [
        ("jump", 1.7, True),
        ("jump", -1.7, True),
        ("jump", 0.5, False),  # across the axis
        ("jump_Y", 1.7, False),  # of one axis by its name
    ],
)
def test_a_jump_test_that_moves_the_probes_of_two_axes_is_of_both(
    tmp_path: Path, name: str, height: float, both: bool
) -> None:
    """Whether the other axis was moved, too, is asked beside it."""
    still = [5 + i / 10_000 for i in range(3000)]
    beside(tmp_path / "lab" / "S3000.csv", still, still)
    beside(tmp_path / "lab" / f"{name}.csv", staircase(2.0), staircase(height))
    made = draft_files(tmp_path / "lab").draft
    assert [j.signal for j in made.jumps] == ["Probe Y [V]", "Probe Z [V]"][: 1 + both]
    (other,) = [c for c in made.channels if c.name == "Probe_Z"]
    assert (other.calibration == "jump_Probe_Z") is both
    asked = "; ".join(other.said.questions)
    assert ("did the axis Z move in jump.csv? 'Probe Y [V]' moved at the same time" in asked) is both
    assert ("calibration? a jump test" in asked) is not both


@pytest.mark.parametrize("name", ["jump", "jump_X"])
@pytest.mark.parametrize("height", [1.7, -1.7, 0.5])
def test_two_probes_along_one_axis_that_a_jump_test_moves_have_it_both(
    tmp_path: Path, name: str, height: float
) -> None:
    """height: of the second one, which looks the other way, or is moved by too little to be it."""
    still = [5 + i / 10_000 for i in range(3000)]
    for path, first, second in (("S3000", still, still), (name, staircase(2.0), staircase(height))):
        beside(tmp_path / "lab" / f"{path}.csv", first, second)
        log = tmp_path / "lab" / f"{path}.csv"
        log.write_text(log.read_text().replace("Probe Y", "Probe X1").replace("Probe Z", "Probe X2"))
    made = draft_files(tmp_path / "lab").draft
    both = abs(height) > 1
    assert [(j.signal, j.axis) for j in made.jumps] == [("Probe X1 [V]", "X"), ("Probe X2 [V]", "X")][: 1 + both]
    assert [c.calibration for c in made.channels if c.name == "Probe_X2"] == ["jump_Probe_X2" if both else None]
    assert [j.question.endswith("V; the same as for 'Probe X1 [V]'") for j in made.jumps] == [False, True][: 1 + both]
