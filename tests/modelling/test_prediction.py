"""Another program's model is imported, scored and corrected like any other."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from thermodata.errors import SpecError
from thermodata.modelling import fit_model
from thermodata.modelling.model_file.prediction.as_effect import read_prediction
from thermodata.modelling.predictions.predict import predict
from thermodata.modelling.predictions.score import scores
from thermodata.modelling.versions.result import model_id
from thermodata.view.grid.dataset import Dataset

from .conftest import EFFECTS, Spec


@pytest.fixture
def theirs(world: Dataset, spec: Spec, tmp_path: Path) -> Path:
    """A good model's prediction, every third sample, with an offset of its own; test t6 is not in it."""
    response = fit_model(spec(*EFFECTS), world).responses[0]
    lines = ["test,t_s,predicted"]
    for test in world.tests[:6]:
        y = response.predict(test) + 1000.0
        lines += [f"{test.test},{t},{v:.6f}" for t, v in zip(test.t_s[::3], y[::3], strict=True)]
    path = tmp_path / "theirs.csv"
    path.write_text("\n".join(lines))
    return path


def test_a_prediction_is_scored(world: Dataset, spec: Spec, theirs: Path) -> None:
    model = spec({"effect": "prediction", "file": "theirs.csv", "fixed": {"gain": 1.0}})
    rows = [s for s in scores(fit_model(model, world, base=theirs.parent), world, "m") if s.phase == "all"]
    assert [s.test for s in rows] == [f"t{k}" for k in range(6)]
    assert all(s.fit is not None and s.fit > 90 for s in rows)


def test_an_effect_can_be_added_to_it(world: Dataset, spec: Spec, theirs: Path) -> None:
    model = spec({"effect": "prediction", "file": "theirs.csv", "fixed": {"gain": 0.5}}, *EFFECTS)
    fitted = fit_model(model, world, base=theirs.parent)
    # half the truth is theirs, the effects bring the other half
    assert fitted.parameters()["coolant.gain"].value == pytest.approx(3.0, rel=0.1)
    assert fitted.responses[0].noise == pytest.approx(0.3, abs=0.1)


def test_beyond_its_end_a_prediction_says_nothing(world: Dataset, tmp_path: Path, spec: Spec) -> None:
    path = tmp_path / "short.csv"
    path.write_text("\n".join(["test,t,predicted", *(f"t{k},{t},{t / 100}" for k in range(5) for t in (0, 9000))]))
    fitted = fit_model(spec({"effect": "prediction", "file": str(path)}), world).responses[0]
    mask = fitted.mask(world.tests[0])
    assert mask.sum() == (world.tests[0].t_s <= 9000).sum()


def test_before_its_start_a_prediction_says_nothing(world: Dataset, tmp_path: Path, spec: Spec) -> None:
    path = tmp_path / "late.csv"
    rows = [f"t{k},{t},{t / 100}" for k in range(5) for t in (3000, 90000)]
    path.write_text("\n".join(["test,t_s,predicted", *rows]))
    fitted = fit_model(spec({"effect": "prediction", "file": str(path)}), world).responses[0]
    test = world.tests[0]
    assert np.array_equal(fitted.mask(test), test.t_s >= 3000)


@pytest.mark.parametrize(
    ("header", "minutes", "um"),
    [
        ("test,t [min],predicted [um]", 60.0, 1.0),
        ("test,t_s [s],predicted [mm]", 1.0, 1e-3),
        ("test,t,predicted", 1, 1),
    ],
)
def test_times_and_values_are_converted_by_the_units_of_their_header(
    tmp_path: Path, header: str, minutes: float, um: float
) -> None:
    path = tmp_path / "theirs.csv"
    path.write_text("\n".join([header, *(f"a,{30 * k / minutes},{2 * k * um}" for k in range(9))]))
    t, y = read_prediction(path, {"c": "dZ"}, "um").tables["a"]
    assert t.tolist() == [30.0 * k for k in range(9)]
    assert y == pytest.approx([2.0 * k for k in range(9)])


def test_rows_without_a_value_say_nothing_and_are_told(world: Dataset, tmp_path: Path, spec: Spec) -> None:
    test = world.tests[0]
    holes = (0, 10, 11)
    rows = [
        f"t{k},{t},{'' if i == 10 else 'NaN' if i in holes else t / 100}"
        for k in range(5)
        for i, t in enumerate(test.t_s)
    ]
    path = tmp_path / "holes.csv"
    path.write_text("\n".join(["test,t_s,predicted", *rows, "t5,0,nan"]))
    fitted = fit_model(spec({"effect": "prediction", "file": str(path)}), world).responses[0]
    assert np.array_equal(np.flatnonzero(~fitted.mask(test)), holes)
    prediction = read_prediction(path)
    (note,) = prediction.notes
    assert note.startswith(f"holes.csv: 16 of {len(rows) + 1} rows have no predicted value (the first at line 2)")
    assert "nothing is left of t5" in note
    assert not prediction.has(world.tests[5])


def test_a_row_that_stands_twice_counts_once(tmp_path: Path) -> None:
    path = tmp_path / "twice.csv"
    path.write_text("test,t_s,predicted\na,0,1\na,30,2\na,30,2.0\nb,30,5\n")
    assert read_prediction(path).tables["a"].t_s.tolist() == [0.0, 30.0]


@pytest.mark.parametrize(
    ("text", "line", "got"),
    [
        ("test,t_s,predicted [K]\na,0,1\n", 1, "K"),
        ("test,t [um],predicted\na,0,1\n", 1, "um"),
        ("test,t_s [min],predicted\na,0,1\n", 1, "t_s [min]"),
        ("test,t_s,predicted [um],predicted [mm]\na,0,1,2\n", 1, "predicted [um], predicted [mm]"),
        ("test,t_s,predicted\na,0,1\na,30,2\na,0,3\n", 4, "3"),
        ("test,t_s,predicted\na,0,1\na,nan,2\n", 3, "nan"),
        ("test,t_s,predicted\na,0,1\na,30,inf\n", 3, "inf"),
        ("test,t_s,predicted\na,0,nan\na,30,\n", 2, "none in 2 rows"),
        ("test,t_s,predicted\n", 1, "none in 0 rows"),
        ("test,response,t_s,predicted\na,dX,0,1\n", 2, "dX"),
        ("campaign,test,response,t_s,predicted\nc,a,dZ,0,1\nd,a,dZ,0,1\n", 3, "dZ"),
    ],
)
def test_what_contradicts_itself_or_the_model_is_refused_with_its_line(
    tmp_path: Path, text: str, line: int, got: str
) -> None:
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(SpecError) as caught:
        read_prediction(path, {"c": "dZ", "d": "Z1"}, "um")
    assert (caught.value.where or "").endswith(f"bad.csv:{line}")
    assert caught.value.got == got


def test_each_campaign_names_the_response_as_it_does(tmp_path: Path) -> None:
    path = tmp_path / "both.csv"
    path.write_text("campaign,test,response,t_s,predicted\nc,a,dZ,0,1\nd,a,Z1,0,1\n")
    assert list(read_prediction(path, {"c": "dZ", "d": "Z1"}, "um").tables) == ["c/a", "d/a"]


def test_a_model_refuses_the_prediction_of_another_response(world: Dataset, tmp_path: Path, spec: Spec) -> None:
    path = tmp_path / "dX.csv"
    path.write_text("test,response,t_s,predicted\nt0,dX,0,1\nt0,dX,9000,2\n")
    with pytest.raises(SpecError, match="of the model's") as caught:
        fit_model(spec({"effect": "prediction", "file": str(path)}), world)
    assert caught.value.expected == "dZ"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("test,time,predicted\na,0,1\n", "no column 't_s'"),
        ("test,t_s,predicted\na,0,x\n", ":2"),
        ("", "no column 'test'"),
        ("test,time [s],predicted [um]\na,0,1\n", "no column 't_s'"),
        ("test,response,t_s,predicted\na,dX,0,1\na,dZ,0,1\n", "of one response"),
    ],
)
def test_a_file_that_is_none_is_refused(tmp_path: Path, text: str, says: str) -> None:
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(SpecError, match=says):
        read_prediction(path)


def test_a_missing_file_is_an_error_with_its_name(tmp_path: Path) -> None:
    with pytest.raises(SpecError, match=r"gone\.csv"):
        read_prediction(tmp_path / "gone.csv")


def test_the_id_follows_the_content_of_the_file(spec: Spec, theirs: Path) -> None:
    model = spec({"effect": "prediction", "file": "theirs.csv"})
    before = model_id(model, "v", theirs.parent)
    theirs.write_text(theirs.read_text() + "\nt6,0,1")
    assert model_id(model, "v", theirs.parent) != before
    assert np.char.isalnum(before)


def test_another_programs_prediction_keeps_its_scale_unless_its_gain_is_freed() -> None:
    from thermodata.modelling.model_file.resolve import as_it_was_made
    from thermodata.schema.files.model import EffectSpec

    assert as_it_was_made(EffectSpec(effect="prediction", file="a.csv")).fixed == {"gain": 1.0}
    assert as_it_was_made(EffectSpec(effect="prediction", file="a.csv", bounds={"gain": (0, 3)})).fixed == {}
    assert as_it_was_made(EffectSpec(effect="lag")).fixed == {}


def test_what_predict_writes_is_read(tmp_path: Path) -> None:
    """Units stand in brackets behind its names, and each test's campaign in a column."""
    path = tmp_path / "out.csv"
    path.write_text(
        '"campaign","test","response","t_s [s]","predicted [um]","measured [um]","known"\n'
        '"c","a","dZ",30,1.5,,true\n"c","a","dZ",0,0.5,,true\n'
    )
    t, y = read_prediction(path).tables["c/a"]
    assert t.tolist() == [0.0, 30.0]
    assert y.tolist() == [0.5, 1.5]


def test_a_prediction_file_that_is_not_there_is_told_with_what_it_should_be(tmp_path: Path) -> None:
    with pytest.raises(SpecError, match="no such prediction file") as caught:
        read_prediction(tmp_path / "theirs.csv")
    assert caught.value.got == "theirs.csv"
    assert "test, t_s, predicted" in (caught.value.expected or "")


def test_a_condition_that_a_test_lacks_is_told_with_how_to_say_it(world: Dataset, spec: Spec) -> None:
    tests = [replace(t, conditions={"tool": "short" if i % 2 else "long"}) for i, t in enumerate(world.tests)]
    fitted = fit_model(spec({"effect": "spindle_bearing", "gain_by": "tool"}), replace(world, tests=tuple(tests)))
    bare = replace(world, tests=tuple(replace(t, conditions={}) for t in world.tests[:1]))
    made, left_out = predict(fitted, bare)
    assert not made
    (reason,) = left_out
    assert "no condition 'tool'" in reason
    assert reason.endswith("predict --set tool=long says it of all tests (conditions={'tool': 'long'} in Python)")
