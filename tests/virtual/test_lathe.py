"""The turning centre: its heat goes where heat goes, and each stratum makes what it says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from thermodata.cli import main
from thermodata.errors import UsageError
from thermodata.view.grid.load import load_dataset
from thermodata.virtual.lathe.causes import CAUSES, bend, growth, play
from thermodata.virtual.lathe.data import STEP_S, contribution, model_of, to_dataset
from thermodata.virtual.lathe.heat.fields import STACK, Fields
from thermodata.virtual.lathe.heat.hall import Air, Hall
from thermodata.virtual.lathe.heat.losses import bearing_w, film_of, forced_cubed, motor_w, sliding_w
from thermodata.virtual.lathe.heat.march import Task, solve, solve_all
from thermodata.virtual.lathe.heat.rods import STEEL, Body, Stack
from thermodata.virtual.lathe.logged.sensors import BY_NAME
from thermodata.virtual.lathe.logs import simulate_lathe
from thermodata.virtual.lathe.programme import DT_S, Work, work
from thermodata.virtual.lathe.right_names import RIGHT
from thermodata.virtual.lathe.strata import STRATA
from thermodata.virtual.lathe.world import DECOY, World, correlation, make_world
from thermodata.virtual.truth.strata import DEVELOPMENT, SEALED

SEED = 90
ROD = Stack((Body("rod", 0.3, 9, 0.01, 0.1, STEEL), Body("other", 0.3, 9, 0.01, 0.1, STEEL)))


def calm(n: int, T: float = 20.0) -> Air:
    return Air(np.full(n, T), np.full(n, T), np.full(n, T), np.full(n, 0.1), np.full(n, 45.0))


def turning(n: int, rpm: float) -> Work:
    zero = np.zeros(n)
    return Work("step", np.arange(n) * DT_S / 3600, np.full(n, rpm), zero, zero, zero, zero, zero, zero, zero)


def small(stratum: str, seed: int = SEED, **more: object) -> World:
    return make_world(stratum, seed, hours=2.0, **more)  # type: ignore[arg-type]


# the rods


def test_what_is_put_into_a_closed_rod_stays_in_it() -> None:
    T, power = np.full(18, 20.0), np.zeros(18)
    power[3] = 50.0
    for _ in range(40):
        T = ROD.step(T, 30.0, np.zeros(18), np.zeros(18), power)
    assert np.sum(ROD.capacity * (T - 20.0)) == pytest.approx(40 * 30.0 * 50.0, rel=1e-9)
    assert np.allclose(T[9:], 20.0), "heat crossed from one body to the next"
    assert T[3] == T.max()
    assert T[0] > T[8]


def test_heat_put_in_the_middle_goes_both_ways_alike() -> None:
    T, power = np.full(18, 20.0), np.zeros(18)
    power[4] = 50.0
    for _ in range(40):
        T = ROD.step(T, 30.0, 0.2 * np.ones(18), np.full(18, 20.0), power)
    assert np.allclose(T[:9], T[8::-1])


def test_at_steady_state_all_heat_leaves_by_the_skin() -> None:
    T, power, leak = np.full(18, 20.0), np.zeros(18), 8.0 * ROD.skin
    power[0] = 30.0
    for _ in range(4000):
        T = ROD.step(T, 300.0, leak, np.full(18, 20.0), power)
    assert float(np.sum(leak * (T - 20.0))) == pytest.approx(30.0, rel=1e-6)


# losses


def test_losses_rise_with_speed_and_warm_oil_rubs_less() -> None:
    assert 0 == bearing_w(0, 20) < bearing_w(500, 20) < bearing_w(4000, 20)
    assert bearing_w(3000, 50) < bearing_w(3000, 20)
    assert motor_w(0, 5.0) == 0.0
    assert motor_w(1000, 6.0) > motor_w(1000, 1.0)
    assert sliding_w(-5, 35, 70, 80) == sliding_w(5, 35, 70, 80) > 0


def test_stribeck_friction_falls_before_it_rises() -> None:
    force = [sliding_w(v, 35, 70, 80) / (v / 60) for v in (0.1, 3.0, 60.0)]
    assert force[0] > force[1] < force[2]


def test_a_draught_and_a_larger_difference_take_more_heat() -> None:
    still, draught, hot = (
        float(film_of(np.array([T]), 20.0, forced_cubed(v))[0]) for T, v in ((25.0, 0.05), (25.0, 2.0), (60.0, 0.05))
    )
    assert 3 < still < hot < 20
    assert still < draught < 25


# the machine


def solved(rpm: float, T: float = 20.0, working: bool = True, dt_s: float = DT_S, hours: float = 2.0) -> Fields:
    n = int(hours * 3600 / DT_S)
    return solve(turning(n, rpm), calm(n, T), calm(40, T), working, dt_s)


def test_a_machine_that_rests_in_still_air_stays_as_it_is() -> None:
    rest = solved(0.0)
    inner = [b.name for b in STACK.bodies if b.name not in ("bed",)]  # the coolant is kept below the floor
    assert all(np.ptp(rest.of(b)) < 0.1 for b in inner)


def test_a_turning_spindle_heats_the_nose_first_and_then_the_headstock() -> None:
    rise = solved(3000.0)
    nose, tall = rise.at("quill", 0.85), rise.at("headstock", 0.95)
    early = int(0.25 * 3600 / DT_S)
    assert nose[early] - nose[0] > 3 * (tall[early] - tall[0]) > 0
    assert nose[-1] > tall[-1] > tall[0]
    assert np.allclose(solved(3000.0, working=False).rods, solved(0.0).rods)


def test_the_courses_do_not_hang_on_the_step() -> None:
    coarse, fine = solved(3000.0), solved(3000.0, dt_s=DT_S / 3)
    rise = coarse.at("quill", 0.85) - 20.0
    assert np.max(np.abs(coarse.rods - fine.rods)) < 0.02 * np.max(rise)


def test_machines_that_are_solved_side_by_side_know_nothing_of_each_other() -> None:
    rng = np.random.default_rng(4)
    hall = Hall.draw(rng)
    tasks = []
    for kind, hours in (("day", 1.0), ("wet", 2.0), ("stroke_z", 1.5), ("tools", 1.0), ("idle", 2.5)):
        job = work(kind, rng, hours)  # type: ignore[arg-type]
        before, air = hall.air(np.linspace(job.hour[0] - 30, job.hour[0], 40), rng), hall.air(job.hour, rng)
        tasks += [Task(job, air, before, on) for on in (True, False)]
    for task, together in zip(tasks, solve_all(tasks), strict=True):
        alone = solve(task.work, task.air, task.before, task.working)
        assert np.array_equal(alone.rods, together.rods)
        assert np.array_equal(alone.inside, together.inside)
        assert all(np.array_equal(x, together.tanks[name]) for name, x in alone.tanks.items())
        assert len(together.inside) == task.work.n
    with pytest.raises(ValueError, match="differ in length"):
        solve_all([tasks[0], Task(tasks[0].work, tasks[0].air, calm(41))])


def test_growth_and_bending_are_those_of_textbooks() -> None:
    even, slope = np.full((1, 10), 3.0), np.linspace(-1.0, 1.0, 10)[None, :]
    assert growth("bed", even)[0] == pytest.approx(1e6 * 10.5e-6 * 0.30 * 3.0)
    assert growth("bed", even, 0.5)[0] == pytest.approx(growth("bed", even)[0] / 2)
    assert bend("bed", even)[0] == pytest.approx(0.0, abs=1e-9)
    # a linear profile of 2 K between the outer cells' centres, 9/10 of the thickness apart: kappa = alpha dT / d
    kappa = 10.5e-6 * 2.0 / 0.27
    assert bend("bed", slope, 0.4)[0] == pytest.approx(1e6 * kappa * 0.4**2 / 2, rel=0.02)


def test_play_follows_late_and_never_by_more_than_half_its_width() -> None:
    course = np.concatenate([np.linspace(0, 4, 50), np.linspace(4, 0, 50)])
    held = play(course, 1.0)
    assert np.max(np.abs(held - course)) <= 0.5 + 1e-12
    assert held[60] != pytest.approx(held[39], abs=0.2), "no hysteresis"


# worlds and strata


def test_a_seed_is_one_machine_and_another_seed_another() -> None:
    one, again, other = small("strong"), small("strong"), small("strong", SEED + 1)
    assert (one.hidden, one.base, dict(one.scale)) == (again.hidden, again.base, dict(again.scale))
    assert all(np.array_equal(a.displacement, b.displacement) for a, b in zip(one.runs, again.runs, strict=True))
    assert dict(one.scale) != dict(other.scale)


def test_weak_strata_are_the_strong_machine_with_less_of_its_cause() -> None:
    strong, half, quarter = (small(s) for s in ("strong", "weak_half", "weak_quarter"))
    (cause,) = strong.hidden
    assert half.hidden == quarter.hidden == (cause,)
    assert half.scale[cause] == pytest.approx(strong.scale[cause] / 2)
    assert quarter.scale[cause] == pytest.approx(strong.scale[cause] / 4)
    assert all(half.scale[c] == strong.scale[c] for c in strong.base)
    best = max(
        v
        for t, v in strong.rms_um[cause].items()
        if t in {r.stretch.id for r in strong.runs if r.stretch.role != "locked"}
    )
    assert 5.0 <= best <= 12.0


@pytest.mark.parametrize("seed", range(SEED, SEED + 4))
def test_a_decoy_goes_with_the_driver_and_sits_elsewhere(seed: int) -> None:
    world = small("decoy", seed)
    assert world.decoy_of in CAUSES[world.hidden[0]].sensors
    assert 0.97 < correlation(world.runs, world.decoy_of, DECOY) < 0.9999
    decoy = next(s for s in world.sensors if s.name == DECOY)
    assert decoy.at != BY_NAME[world.decoy_of].at
    assert RIGHT[world.hidden[0]].mark("hydraulics", [DECOY], "hydraulics") in ("wrong", "family")


def test_with_nothing_hidden_the_truth_is_what_the_model_names() -> None:
    for stratum, size in (("none_thin", 1), ("none_full", 4)):
        world = small(stratum)
        assert world.hidden == ()
        assert len(world.base) == len(model_of(world).effects) == size
        assert all(np.all(contribution(world, r) == 0) for r in world.runs)


def test_two_and_three_are_hidden_and_none_of_them_is_known() -> None:
    for stratum, count in (("two", 2), ("three", 3)):
        world = small(stratum)
        assert len(set(world.hidden)) == count
        assert not set(world.hidden) & set(world.base)


@pytest.mark.parametrize("seed", range(SEED, SEED + 4))
def test_what_is_not_logged_has_no_sensor(seed: int) -> None:
    world = small("not_logged", seed)
    logged = {s.name for s in world.sensors}
    assert not logged & set(CAUSES[world.hidden[0]].sensors)
    assert logged >= {c for e in model_of(world).effects for c in map(str, e.drivers.values())}


def test_physics_outside_has_no_right_name() -> None:
    world = small("outside")
    assert not CAUSES[world.hidden[0]].known
    assert RIGHT[world.hidden[0]].exact == ()


def test_slips_stand_in_the_displacement_and_nowhere_else() -> None:
    world, clean = small("steps"), small("gaps")
    row = "XZ".index(world.axis)
    assert world.faults
    assert clean.faults == ()
    clean_left = [r.displacement - sum(r.contributions.values()) for r in clean.runs]
    assert max(float(np.abs(np.diff(x)).max()) for x in clean_left) < 1.5
    for fault in world.faults:
        run = next(r for r in world.runs if r.stretch.id == fault.test)
        at = int((fault.at_s or 0) / DT_S)
        left = run.displacement[row] - sum(c[row] for c in run.contributions.values())
        jump = left[at] - left[at - 1]
        assert run.stretch.role != "locked"
        assert 3.0 <= abs(fault.size) <= 16.0
        assert jump == pytest.approx(fault.size, abs=1.0)


def test_a_broken_sensor_is_named_and_is_not_the_causes_own() -> None:
    world = small("sensor_fault")
    (fault,) = world.faults
    assert fault.channel not in CAUSES[world.hidden[0]].sensors
    assert fault.channel in {s.name for s in world.sensors}


def test_the_controls_clock_is_off_and_the_others_are_not() -> None:
    late = small("clock")
    (fault,) = late.faults
    rows = round(fault.size / DT_S)
    assert 120 <= abs(fault.size) <= 480
    name = next(s.name for s in late.sensors if s.source == "plc" and s.quantity == "temperature")
    run = late.runs[0]
    true = BY_NAME[name].true(run.stretch.heat.work, run.stretch.air, run.stretch.heat.full)
    on_time = BY_NAME[name].read(true, np.random.default_rng(0))
    moved = np.roll(run.readings[name], -rows)[20:-20]
    assert np.corrcoef(moved, on_time[20:-20])[0, 1] > 0.98


def test_treads_kelvins_and_gaps_are_in_the_logs() -> None:
    treads, kelvins, gaps = small("staircase"), small("coarse"), small("gaps")
    assert np.allclose(np.unique(treads.runs[0].displacement) % 2.0, 0.0)
    warm = [s.name for s in kelvins.sensors if s.quantity == "temperature"]
    assert all(np.allclose(kelvins.runs[0].readings[n] % 1.0, 0.0) for n in warm)
    data = to_dataset(gaps)
    holes = [int((~t.valid["dX"]).sum()) for t in data.tests]
    assert min(holes) >= 5
    assert all(np.isnan(t.values["dX"]).sum() == h for t, h in zip(data.tests, holes, strict=True))


def test_the_number_of_tests_and_the_share_of_idle_ones() -> None:
    for stratum, count in (("tests_3", 3), ("tests_5", 5), ("tests_16", 16), ("strong", 8)):
        opened = [r for r in make_world(stratum, SEED, hours=1.0).runs if r.stretch.role != "locked"]
        assert len(opened) == count
    idle = make_world("idle", SEED, hours=1.0)
    opened = [r.stretch.heat.work.kind for r in idle.runs if r.stretch.role != "locked"]
    assert opened.count("idle") >= 0.6 * len(opened)


def test_development_and_sealed_seeds_never_meet() -> None:
    assert not set(DEVELOPMENT) & set(SEALED)


def test_an_idle_test_moves_nothing() -> None:
    idle = work("idle", np.random.default_rng(1), 2.0)
    assert not any(np.any(getattr(idle, n)) for n in ("speed", "tool_speed", "feed_x", "feed_z", "cutting", "coolant"))


def test_an_unknown_stratum_is_answered_with_the_nearest() -> None:
    with pytest.raises(UsageError, match="stratum"):
        make_world("weak_haf", SEED)
    assert all(len(s.meaning) > 9 for s in STRATA.values())


def test_every_cause_can_be_marked_and_a_wrong_place_is_wrong() -> None:
    assert set(RIGHT) == set(CAUSES)
    assert RIGHT["nut_z"].mark("feed_screw", ["C01_nutZ"], "feed_z") == "exact"
    assert RIGHT["nut_z"].mark("lag", ["v_Z"], "generic") == "equivalent"
    assert RIGHT["nut_z"].mark("feed_motor", ["T_mot_Z"], "feed_z") == "family"
    assert RIGHT["nut_z"].mark("feed_screw", ["C02_nutX"], "feed_x") == "wrong"


def test_the_written_campaign_comes_back_as_the_dataset_in_memory(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("THERMODATA_STORE", str(tmp_path / "store"))
    folder = tmp_path / "c"
    truth = simulate_lathe(folder, "strong", SEED, hours=1.0, tests=3)
    text = (folder / "campaign.yaml").read_text(encoding="utf-8")
    assert not any(cause in text for cause in truth["hidden"]), "the campaign file tells the truth"
    assert main(["ingest", str(folder / "campaign.yaml")]) == 0, capsys.readouterr().err
    world = make_world("strong", SEED, hours=1.0, tests=3)
    ours = to_dataset(world)
    theirs = load_dataset(tmp_path / "store", world.campaign, STEP_S)
    for test in ours.tests:
        other = theirs.test(*test.key)
        n = min(len(test.t_s), len(other.t_s)) - 1
        assert n > 0.9 * len(test.t_s)
        for name in ("dX", "dZ", "TS_brg_f"):
            assert np.max(np.abs(test.values[name][:n] - other.values[name][:n])) < 0.5


def test_an_axis_that_rests_in_all_open_tests_moves_no_machine_by_kilometres() -> None:
    """A seed whose Z axis does: its screw was scaled by what it does there, which is nothing."""
    world = make_world("idle", 200153)
    role = {r.stretch.id: r.stretch.role for r in world.runs}
    opened = max(v for test, v in world.rms_um["nut_z"].items() if role[test] != "locked")
    assert opened < 1e-3
    assert 5.0 / 3 < max(max(of.values()) for of in world.rms_um.values()) <= 3 * 12.0
