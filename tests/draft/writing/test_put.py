"""What a page proposes goes into a test's own line, and what stood there stays."""

from __future__ import annotations

from pathlib import Path

import pytest

from thermodata.draft.make import first_model, modelled, write_answered
from thermodata.draft.writing.baseline import model_text_of
from thermodata.draft.writing.fill_in import filled_in
from thermodata.draft.writing.put import EVERY, put
from thermodata.draft.writing.questions import only_in_file, questions
from thermodata.errors import UsageError
from thermodata.schema.files.load import load_campaign, load_model, parse_campaign

TEXT = """\
schema: thermodata/campaign/1
id: lab
machine: {id: M1}
sources:
  log: {reader: table, files: "{test}.csv"}
channels:
  dZ: {source: log, signal: dZ, quantity: displacement, unit: um, axis: Z, at: tcp, relative_to: table}
  T1: {source: log, signal: T1, quantity: temperature, unit: degC}   # ? at: where on the machine? (name)
  T2: {source: log, signal: T2, quantity: temperature, unit: degC, at: axis.z.nut}
  p: {source: log, signal: p, quantity: temperature, unit: degC}   # ? quantity: 3 to 5: a temperature in degC? (values)
  # v_Z: {source: log, signal: v_Z, quantity: ?, unit: ?}   # ? quantity and unit? (values 0 to 20)
tests:
  - {id: day, kind: mixed, role: verification}   # ? kind?
  - {id: warm, kind: mixed, role: none, measuring: "T1 < 30 or T2 < 30", phases: {idle: [0 s, 60 s]}}
  - {id: own, kind: mixed, role: none, measuring: {when: "T1 < 30", settle: 10 s}}
  - {id: range, kind: mixed, role: none, measuring: in_range}
"""


def by_id(text: str) -> dict[str, object]:
    return {t.id: t for t in parse_campaign(text).tests}


def test_a_rule_stands_beside_the_one_that_was_there() -> None:
    text = put(TEXT, "day", 'measuring: "T2 == 3"')
    assert by_id(text)["day"].measuring == "T2 == 3"  # type: ignore[attr-defined]
    assert "# ? kind?" in text  # another question of the line is still open
    twice = put(text, "day", 'measuring: "T1 > 5"')
    assert by_id(twice)["day"].measuring == "T2 == 3 and T1 > 5"  # type: ignore[attr-defined]
    assert put(twice, "day", 'measuring: "T1 > 5"') == twice
    bracketed = put(TEXT, "warm", 'measuring: "T2 == 3"')
    assert by_id(bracketed)["warm"].measuring == "(T1 < 30 or T2 < 30) and T2 == 3"  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("before", "rule", "after"),
    [
        ("T2 == 3.5", "T2 == 3", "T2 == 3.5 and T2 == 3"),
        ("T1 > 5 or T2 == 3", "T2 == 3", "(T1 > 5 or T2 == 3) and T2 == 3"),
        ("T1 > 5 and T2 == 3", "T2 == 3", "T1 > 5 and T2 == 3"),
    ],
)
def test_a_rule_is_there_already_only_as_a_whole_condition(before: str, rule: str, after: str) -> None:
    text = put(put(TEXT, "day", f'measuring: "{before}"'), "day", f'measuring: "{rule}"')
    assert by_id(text)["day"].measuring == after  # type: ignore[attr-defined]


def test_a_range_stands_beside_an_expression() -> None:
    text = put(put(TEXT, "day", 'measuring: "T2 == 3"'), "day", "measuring: {in_range: {dZ: [-50 um, 90 um]}}")
    rule = by_id(text)["day"].measuring  # type: ignore[attr-defined]
    assert rule.when == "T2 == 3"
    assert rule.in_range == {"dZ": ("-50 um", "90 um")}
    own = by_id(put(TEXT, "own", 'measuring: "T2 == 3"'))["own"].measuring  # type: ignore[attr-defined]
    assert (own.when, own.settle) == ("T1 < 30 and T2 == 3", 10.0)


def test_a_rule_of_the_machine_goes_into_every_test_also_those_that_are_locked() -> None:
    text = TEXT.replace('  - {id: own, kind: mixed, role: none, measuring: {when: "T1 < 30", settle: 10 s}}\n', "")
    found = by_id(put(text, EVERY, 'measuring: "T2 == 3"'))
    assert found["day"].measuring == "T2 == 3"  # type: ignore[attr-defined]
    assert found["warm"].measuring == "(T1 < 30 or T2 < 30) and T2 == 3"  # type: ignore[attr-defined]
    with pytest.raises(UsageError, match="belongs to one test"):
        put(text, EVERY, "window: [0 s, 60 s]")


def test_a_window_is_replaced_and_a_phase_added() -> None:
    text = put(put(TEXT, "warm", "window: [0 s, 500 s]"), "warm", "window: [0 s, 400 s]")
    assert by_id(text)["warm"].window == (0.0, 400.0)  # type: ignore[attr-defined]
    text = put(put(text, "warm", "phases: {stretch: [5 s, 6 s]}"), "warm", "phases: {stretch: [7 s, 8 s]}")
    phases = by_id(text)["warm"].phases  # type: ignore[attr-defined]
    assert phases == {"idle": (0.0, 60.0), "stretch": (5.0, 6.0), "stretch2": (7.0, 8.0)}


@pytest.mark.parametrize(
    ("test", "line", "told"),
    [
        ("nobody", 'measuring: "T1 < 3"', "no line of its own"),
        ("range", "measuring: {in_range: {T1: [0 degC, 3 degC]}}", "another form"),
        ("day", "role: locked", "put into no test"),
        ("day", "a: 1\nb: 2", "put into no test"),
    ],
)
def test_what_cannot_be_put_is_said(test: str, line: str, told: str) -> None:
    with pytest.raises(UsageError, match=told):
        put(TEXT, test, line)


def test_a_signal_without_a_quantity_comes_to_life_with_one() -> None:
    asked = {q.name: q for q in questions(TEXT)}
    assert asked["unread.v_Z"].open
    assert asked["channels.p.quantity"].value == "temperature [degC]"
    text = filled_in(TEXT, {"unread.v_Z": "feed [m/min]", "channels.p.quantity": "pressure [bar]"})
    channels = parse_campaign(text).channels
    assert (channels["v_Z"].quantity, channels["v_Z"].unit) == ("feed", "m/min")
    assert (channels["p"].quantity, channels["p"].unit) == ("pressure", "bar")
    after = {q.name: q for q in questions(text)}
    assert after["channels.v_Z.at"].open  # its place is the next question
    assert "unread.v_Z" not in after


@pytest.mark.parametrize("answer", ["feed", "[m/min]", "fead [m/min]", "feed [degC]", "feed [m/min], at: x"])
def test_an_answer_that_is_no_quantity_with_its_unit_is_refused(answer: str) -> None:
    with pytest.raises(UsageError):
        filled_in(TEXT, {"unread.v_Z": answer})


def test_a_first_model_follows_the_answers_until_somebody_changes_it(tmp_path: Path) -> None:
    path, model = tmp_path / "campaign.yaml", tmp_path / "model.yaml"
    path.write_text(TEXT)
    drafted = model_text_of(load_campaign(path))
    assert drafted is not None
    assert "feed_screw" in drafted
    model.write_text(drafted)
    answered = filled_in(TEXT, {"channels.T1.at": "spindle.bearing.front"})
    kept, followed = write_answered(path, answered)
    assert kept.read_text() == TEXT
    assert followed
    assert "spindle_bearing, drivers: {temperature: T1}" in model.read_text()
    model.write_text(own := model.read_text().replace("60 s", "30 s"))
    assert write_answered(path, put(answered, "day", "window: [1 s, 2 s]"))[1] is False
    assert write_answered(path, TEXT)[1] is False
    assert model.read_text() == own


def test_a_write_that_dies_leaves_the_campaign_file_whole(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "campaign.yaml"
    path.write_text(TEXT)
    answered = filled_in(TEXT, {"channels.T1.at": "spindle.bearing.front"})

    def die(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as change:
        change.setattr("thermodata.store.base.files.publish", die)
        with pytest.raises(KeyboardInterrupt):
            write_answered(path, answered)
    assert path.read_text() == TEXT
    assert [p.name for p in tmp_path.iterdir() if p.suffix != ".yaml"] == [], "nothing half-written stays"
    kept, _ = write_answered(path, answered)
    assert path.read_text() == answered
    assert kept.name == "campaign.2.yaml", "an earlier copy is not written over"


SEVERAL = """schema: thermodata/campaign/1
id: two
machine: {id: "1"}
sources: {log: {reader: table, files: "{test}.csv"}}
channels:
  dX: {source: log, signal: x, quantity: displacement, unit: um, axis: X, at: tcp}
  dZ: {source: log, signal: z, quantity: displacement, unit: um, axis: Z, at: tcp}
  dX_low: {source: log, signal: x2, quantity: displacement, unit: um, axis: X, at: tcp}
  p5: {source: log, signal: p5, quantity: displacement, unit: um, at: tcp}
  T_nut_X: {source: log, signal: a, quantity: temperature, unit: degC, at: axis.x.nut}
  T_nut_Z: {source: log, signal: b, quantity: temperature, unit: degC, at: axis.z.nut}
  T_front: {source: log, signal: c, quantity: temperature, unit: degC}
tests:
  - {id: day, kind: mixed, role: calibration}
"""


def test_a_first_model_is_of_the_displacement_that_was_chosen(tmp_path: Path) -> None:
    path, model = tmp_path / "campaign.yaml", tmp_path / "model.yaml"
    path.write_text(SEVERAL)
    assert modelled(path) is None
    made = first_model(path)
    assert (made.response, made.responses, made.kept) == ("dZ", ("dZ", "dX", "dX_low", "p5"), None)
    assert load_model(model).name == "baseline"
    assert "T_nut_Z" in model.read_text()
    # two probes along X: the axis alone would not say which; the screw of Z moves nothing there
    made = first_model(path, "dX_low")
    assert (made.kept, made.replaced) == (None, "dZ")  # what is as drafted can be had again
    spec = load_model(model)
    assert (spec.name, spec.responses[0].channel) == ("baseline_dX_low", "dX_low")
    assert "T_nut_X" in model.read_text()
    assert not any("T_nut_Z" in e.drivers.values() for e in spec.effects)
    assert modelled(path) == "dX_low"
    # it follows the answers, and stays the model of what was chosen
    _, followed = write_answered(path, filled_in(SEVERAL, {"channels.T_front.at": "spindle.bearing.front"}))
    assert followed
    assert modelled(path) == "dX_low"
    assert "T_front" in model.read_text()


def test_a_first_model_that_somebody_changed_is_kept(tmp_path: Path) -> None:
    path, model = tmp_path / "campaign.yaml", tmp_path / "model.yaml"
    path.write_text(SEVERAL)
    first_model(path)
    model.write_text(own := model.read_text().replace("60 s", "30 s"))
    assert modelled(path) is None
    made = first_model(path, "dX")
    assert made.kept == tmp_path / "model.1.yaml"
    assert made.kept.read_text() == own
    with pytest.raises(UsageError, match="dY"):
        first_model(path, "dY")
    path.write_text("".join(line for line in SEVERAL.splitlines(keepends=True) if "T_" not in line))
    with pytest.raises(UsageError, match="no sensor"):
        first_model(path, "dX")


def test_a_first_model_that_nobody_changed_is_not_kept_whatever_became_of_the_campaign_file(tmp_path: Path) -> None:
    path, model = tmp_path / "campaign.yaml", tmp_path / "model.yaml"
    path.write_text(SEVERAL)
    first_model(path, "dX")
    path.write_text(
        SEVERAL.replace("quantity: temperature, unit: degC}", "quantity: temperature, unit: degC, at: hall}")
    )
    assert modelled(path) == "dX"
    assert first_model(path, "dX").kept is None
    assert "ambient_frame, drivers: {temperature: T_front}" in model.read_text()
    # an answer is followed from there too
    path.write_text(SEVERAL)
    _, followed = write_answered(path, filled_in(SEVERAL, {"channels.T_front.at": "spindle.bearing.front"}))
    assert followed
    assert "spindle_bearing, drivers: {temperature: T_front}" in model.read_text()
    assert [p.name for p in tmp_path.glob("model*")] == ["model.yaml"]


def test_a_displacement_without_an_axis_is_modelled_by_its_name(tmp_path: Path) -> None:
    path = tmp_path / "campaign.yaml"
    path.write_text(
        SEVERAL.replace(
            "T_front: {source: log, signal: c, quantity: temperature, unit: degC}",
            "T_front: {source: log, signal: c, quantity: temperature, unit: degC, at: spindle.bearing.front}",
        )
    )
    first_model(path, "p5")
    spec = load_model(path.with_name("model.yaml"))
    assert spec.responses[0].channel == "p5"
    # which screw moves it nobody knows: only what acts whatever the axis is drafted
    assert [e.effect for e in spec.effects] == ["spindle_bearing"]


def test_a_model_file_in_another_encoding_is_one_that_somebody_wrote(tmp_path: Path) -> None:
    path, model = tmp_path / "campaign.yaml", tmp_path / "model.yaml"
    path.write_text(TEXT)
    first_model(path)
    model.write_bytes(own := model.read_bytes() + "# für die Spindel\n".encode("latin-1"))
    assert modelled(path) is None
    answered = filled_in(TEXT, {"channels.T1.at": "spindle.bearing.front"})
    assert write_answered(path, answered)[1] is False
    assert model.read_bytes() == own
    kept = first_model(path).kept
    assert kept is not None
    assert kept.read_bytes() == own, "the copy keeps its bytes"


@pytest.mark.parametrize(("answer", "by_hand"), [("displacement [V]", True), ("displacement [um]", False)])
def test_a_probe_that_comes_to_life_is_asked_for_its_place_and_axis(answer: str, by_hand: bool) -> None:
    text = filled_in(TEXT, {"unread.v_Z": answer})
    fields = {q.name: q for q in questions(text)}
    assert fields["channels.v_Z.at"].open
    assert fields["channels.v_Z.axis"].open
    assert any(q.asks.startswith("calibration?") for q in only_in_file(text)) is by_hand
    text = filled_in(text, {"channels.v_Z.at": "tcp", "channels.v_Z.axis": "Z"})
    channel = parse_campaign(text).channels["v_Z"]
    assert (channel.at, channel.axis) == ("tcp", "Z")
    asked = {q.name for q in questions(text) if q.open}
    assert not {"channels.v_Z.at", "channels.v_Z.axis"} & asked


def test_a_voltage_is_asked_what_it_measures_and_where() -> None:
    asks = "# ? what does it measure? then: quantity, calibration (unit only)"
    text = TEXT.replace(
        "channels:\n", f"channels:\n  U: {{source: log, signal: U, quantity: voltage, unit: V}}   {asks}\n"
    )
    assert {q.name: q for q in questions(text)}["channels.U.quantity"].open
    after = filled_in(text, {"channels.U.quantity": "displacement [V]"})
    assert {q.name for q in questions(after) if q.open} >= {"channels.U.at", "channels.U.axis"}
    assert "channels.U.quantity" not in {q.name for q in questions(after) if q.open}
