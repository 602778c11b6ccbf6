"""What `diagnose` prints: every claim and refinement with its evidence, the probability where one is stated."""

from __future__ import annotations

from typing import Any

from thermodata.report.text.diagnosis import diagnosis_text
from thermodata.report.text.fit import spots_text
from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.diagnosis import Unknown, WeakSpot
from thermodata.schema.answers.result import Parameter

from ..answers import candidate, diagnosis


def ranked(rank: int, effect: str, **more: Any) -> Candidate:
    figures = {"p_value": 0.005, "rmse_um_before": 4.0, "rmse_um_after": 1.0, "fit_before": None, "fit_after": None}
    return candidate(f"{effect}:T", **{"rank": rank, "why": f"because of {effect}", **figures, **more})


def text(verdict: Any, *candidates: Candidate, top: int = 8, unknown: Unknown | None = None) -> str:
    found = diagnosis(*candidates, verdict=verdict, noise_um=0.2, rmse_um=4.0, unknown=unknown)
    return diagnosis_text(found, top)


def test_each_claim_and_refinement_has_its_row_and_its_reason() -> None:
    said = text(
        "effect",
        ranked(1, "screw", claimed=True, probability=0.94),
        ranked(2, "sun", claimed=True, probability=0.7),
        ranked(3, "mode", refinement=True),
        ranked(4, "rest"),
    )
    head = said.partition("\n\n")[0].splitlines()
    assert head[0] == "missing: screw (T), probability 94 %, and sun (T), probability 70 %"
    assert head[-1] == "  what the model has can be refined by mode (T)"
    rows = {line.split()[1]: line for line in said.splitlines() if line.split()[1:2] and line.split()[1].endswith(":T")}
    assert "yes      94 %" in rows["screw:T"]
    assert "yes      70 %" in rows["sun:T"]
    assert "refines  -" in rows["mode:T"]
    told = [line for line in said.splitlines() if line.startswith("why ")]
    assert told == [f"why {e}:T: because of {e}" for e in ("screw", "sun", "mode")]


def test_a_claim_beyond_the_table_still_has_its_row_and_its_reason() -> None:
    claims = ranked(1, "screw", claimed=True), ranked(3, "sun", claimed=True)
    said = text("effect", claims[0], ranked(2, "rest"), claims[1], top=1)
    assert "why sun:T: because of sun" in said
    rows = [line.split()[:2] for line in said.splitlines() if line.split()[1:2] and line.split()[1].endswith(":T")]
    assert rows == [["1", "screw:T"], ["3", "sun:T"]]


def test_names_of_twins_are_whole_and_those_that_have_no_room_are_counted() -> None:
    twins = [f"feed_motor:T_motor_of_axis_{axis}" for axis in "XYZAB"]
    said = text("effect", ranked(1, "screw", claimed=True, equivalent=twins))
    assert "…" not in said
    joined = "".join(said.split())
    assert "T_motor_of_axis_X" in joined
    assert "T_motor_of_axis_Z,and2more" in joined


def test_what_the_machine_did_where_a_model_fails_is_not_cut() -> None:
    state = ", ".join(f"feed_{axis} 0 to 14 m/min, T_motor_{axis} rising" for axis in "XYZABC")
    spot = WeakSpot(campaign="c", test="a", from_s=0.0, to_s=3600.0, rmse_um=2.0, state=state)
    said = spots_text([spot])
    assert "…" not in said
    assert all(f"T_motor_{axis}" in said for axis in "XYZABC")
    assert said.startswith("where the model fails, the most squared error first\n")


def test_a_parameter_without_a_unit_is_one_number() -> None:
    exponent = Parameter(value=1.43, unit="1", low=None, high=None)
    said = text("effect", ranked(1, "screw", claimed=True, parameters={"exponent": exponent}))
    assert "screw:T: exponent 1.43\n" in said


def test_parameters_are_told_with_interval_bound_and_what_a_gain_is_of() -> None:
    """What a turret takes in a minute is at the least that a fit may reach; a feed gives its gain at 10 m/min."""
    tau = Parameter(value=1.0, unit="min", low=None, high=4.1157)
    gain = Parameter(value=8.59, unit="um", low=7.99, high=9.195)
    told = {"feed_screw.tau": tau, "feed_screw.gain": gain}
    said = text("effect", ranked(1, "feed_screw", claimed=True, parameters=told))
    assert "feed_screw:T: feed_screw.tau 1.00 min (at its bound; up to 4.12), feed_screw.gain 8.59 um (7.99 to" in said
    behind = "; what stands at its bound may be the work of another effect"
    assert (
        f"; in brackets intervals of 95 %{behind}\nfeed_screw.gain is displacement at rest a kelvin (um at 10 m/min"
        in said
    )
    inside = tau.model_copy(update={"value": 2.0})
    alike = ranked(1, "feed_screw", claimed=True, parameters={"feed_screw.tau": inside})
    assert "feed_screw.tau 2.00 min (up to 4.12)" in text("effect", alike)
    assert behind not in text("effect", alike)
    per_kelvin = ranked(
        1, "feed_screw", claimed=True, parameters={"feed_screw.gain": Parameter(value=1.0, unit="um/K")}
    )
    assert "is displacement" not in text("effect", per_kelvin), "its unit says it"


def test_the_least_p_that_can_come_out_is_called_that() -> None:
    said = text("effect", ranked(1, "screw", claimed=True), ranked(2, "sun"), ranked(3, "mill", p_value=0.13))
    assert "0.00500" not in said
    assert "0.005 is the least that can come out, so rows that have it are told apart by their errors" in said
    assert "p: of responses in which nothing is missing, the share on which chance does as well;" in said
    assert "the least that can" not in text("effect", ranked(1, "screw", claimed=True))


def test_what_stands_beside_and_has_no_row_was_among_what_was_asked() -> None:
    beside = ["oil:T", "sun:T"]
    said = text("effect", ranked(1, "screw", claimed=True, beside=beside), ranked(2, "sun"))
    assert "the model's own. oil:T has no row here: it was among what was asked" in said
    assert "no row" not in text("effect", ranked(1, "screw", beside=["sun:T"]), ranked(2, "sun"))


def test_without_a_claim_the_first_candidate_has_its_reason_and_nothing_is_promised() -> None:
    said = text("unknown", ranked(1, "screw", probability=0.35), ranked(2, "sun"))
    assert "why screw:T: because of screw" in said
    assert "why sun:T" not in said
    assert "could be explained" not in said
    assert "nothing logged explains" not in said
    assert "the best candidate alone takes away 90 % of the squared residual, which by itself names no cause" in said


def test_errors_that_are_not_of_the_users_own_model_say_what_stands_beside() -> None:
    why = "where it acts (1 of 2 tests), beside sun:T, the error falls (5.00 -> 1.00 um)"
    said = text("effect", ranked(1, "screw", claimed=True, rmse_um_before=5.0, why=why), ranked(2, "rest"))
    assert "both with" in said
    assert "sun:T" in next(line for line in said.splitlines() if line.startswith("1 "))
    assert "both with" not in text("effect", ranked(1, "screw", claimed=True), ranked(2, "rest"))


def test_left_out_errors_say_by_what_they_are_foretold() -> None:
    """A plain refit to the other tests gives other figures: effects are free, samples weighed, tests alike."""
    said = text("effect", ranked(1, "screw", claimed=True)).splitlines()
    line = next(line for line in said if line.startswith("left-out: "))
    assert "foretold from the others" in line
    assert "free to act faster and slower than by one lag each" in line
    assert "weighed by the noise that is left" in line
    assert "all tests count alike" in line
    assert "a plain refit" in line


def test_parts_of_tests_are_not_called_tests() -> None:
    part = {"campaign": "c", "test": "a", "from_s": 0.0, "to_s": 1.0, "acts": True}
    parts = [{**part, "rmse_um_before": 2.0, "rmse_um_after": 1.0}] * 2
    said = text("effect", ranked(1, "screw", left_out=parts)).splitlines()[-1]
    assert said.startswith("left-out: parts of the open tests in turn, foretold from the others: ")
    assert "1 open test is too few to leave one out, so 2 parts of it are" in said


def test_states_have_commas_within_and_are_parted_otherwise() -> None:
    hints = Unknown(time_constants_h=[1.4], hours_of_day=[], states=["at rest, A rising", "n 800 rpm, A falling"])
    said = text("unknown", unknown=hints)
    assert "  states: at rest, A rising; n 800 rpm, A falling" in said
    assert "  memory (its autocorrelation falls to 1/e) [h]: 1.40" in said


def test_a_claim_has_its_parameters_and_the_command_that_takes_it_in() -> None:
    tau = Parameter(value=49.7, unit="min", low=None, high=None)
    said = text("effect", ranked(1, "screw", claimed=True, parameters={"tau": tau}), ranked(2, "rest"))
    assert "screw:T: tau 49.7 min\nto have it: thermodata add m 1" in said
    assert "add m 2" not in said
    several = [ranked(k, name, claimed=True) for k, name in enumerate(("screw", "motor", "oil"), start=1)]
    assert "to have both: thermodata add m 1 2" in text("effect", *several[:2])
    assert "to have all: thermodata add m 1 2 3" in text("effect", *several)


def test_what_refines_the_model_has_its_command_too() -> None:
    modes = [ranked(k, name, refinement=True) for k, name in enumerate(("mode", "switch"), start=1)]
    assert "\nto have mode:T and switch:T: thermodata add m 1 2\n" in text("refine", *modes, ranked(3, "rest"))
    assert "to have mode" not in text("refine", ranked(1, "mode", refinement=True, as_modelled=True))


def test_where_no_test_could_be_left_out_none_is_said_to_have_been() -> None:
    said = text("not_testable")
    assert "left-out" not in said
    assert "as it is fitted the model leaves 4.00 um" in said
    assert said.splitlines()[1].endswith("one is claimed only where it also foretells a test that it was not fitted to")
    assert said.splitlines()[-1].startswith("fitted: calibration tests, which the model was fitted to")


def test_that_no_locked_test_was_opened_is_said_where_none_was() -> None:
    said = "no locked test was opened for this answer"
    assert said in text("none", ranked(1, "screw"))
    assert said in text("unknown")
    assert said not in text("unknown", ranked(1, "screw", locked_tests_asked=1))
    assert said not in text("effect", ranked(1, "screw", claimed=True))
    looked = {"locked_tests_asked": 2, "locked_shape_um_before": 1.6, "locked_shape_um_after": 1.2}
    mode = text("unknown", ranked(1, "sun"), ranked(2, "mode", refinement=True, **looked))
    assert "on locked tests, opened for it, about each one's mean: mode:T 1.60 -> 1.20 um" in mode
    assert said not in mode
