"""A step where an axis goes from one place to another (steps/commanded.py): its screw grows by how warm it is times
where it stands, and a probe that slips knows of neither."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from thermodata.diagnosis.steps.artefact import as_artefacts, find_steps
from thermodata.diagnosis.steps.places_that_tell import places_that_tell
from thermodata.diagnosis.steps.step import Step
from thermodata.plugin import Float1D
from thermodata.view.grid.dataset import ChannelInfo

from .hand_made import Parts, problem

N = 400
ROW = np.arange(N)
EVERY = 50  # samples of 60 s that the axis stands at one place
TO_AND_FRO = (150.0, 650.0, 400.0, 650.0, 150.0, 650.0, 400.0, 150.0)
GROWS = 0.0006  # um/mm/K: 6 um over 500 mm at 20 K


def rough(seed: int = 0) -> Float1D:
    return 0.05 * np.random.default_rng(seed).normal(size=N)


def placed(places: Sequence[float], first: int = 0) -> Float1D:
    """The axis goes to the next place every 50 samples, from 400 mm on."""
    course = np.full(N, 400.0)
    for k, place in enumerate(places):
        course[first + EVERY * k :] = place
    return course


def warmed(by: float = 20.0, since: int = 0) -> Float1D:
    """The nut of a screw that is moved from a sample on, and rests for the last hours."""
    rising = by * (1 - np.exp(-np.maximum(ROW - since, 0) / 40))
    return 21.0 + np.where(ROW < 250, rising, rising[249] * np.exp(-(ROW - 249) / 90))


def of(place: Float1D, nut: Float1D, grows: float = GROWS, slip: float = 0.0, at: int = 0, seed: int = 0) -> Parts:
    """A test: the screw grows, the probe slips."""
    residual = rough(seed) + grows * (place - 400.0) * (nut - nut[0]) + slip * (at <= ROW)
    return Parts(residual, values={"pos": place, "T": nut}, channels=axis())


def axis(at: str = "axis.z.nut") -> dict[str, ChannelInfo]:
    return {
        "pos": ChannelInfo("pos", "position", "mm", at="axis.z"),
        "T": ChannelInfo("T", "temperature", "degC", at=at),
    }


def steps(*tests: Parts) -> list[Step]:
    return find_steps(problem(*tests, noise=0.05))


def told(*tests: Parts) -> list[tuple[str, float, int]]:
    return sorted((s.test.test, s.at_s / 60 + 0.5, round(s.size)) for s in steps(*tests))


def test_what_grows_with_the_place_by_how_warm_the_screw_is_slips_nowhere() -> None:
    assert told(of(placed(TO_AND_FRO), warmed())) == []


def test_it_is_told_where_nobody_logged_the_place() -> None:
    whole = of(placed(TO_AND_FRO), warmed())
    assert len(told(Parts(whole.residual, values={"T": whole.values["T"]}, channels={"T": axis()["T"]}))) == 3


@pytest.mark.parametrize(("at", "found"), [("axis.z.nut", 0), ("axis.z", 0), ("axis.y.nut", 1), ("column", 1)])
def test_moves_of_a_cold_screw_do_not_tell_of_a_warm_one(at: str, found: int) -> None:
    """Twice a programme, cold, in which it does nothing: a line through how far it moves foretells too little."""
    cold = [of(placed(TO_AND_FRO), np.full(N, 21.0), seed=k) for k in (1, 2)]
    warm = of(placed((650.0, 150.0), first=100), warmed())
    asked = [Parts(p.residual, values=p.values, channels=axis(at)) for p in (warm, *cold)]
    assert (len(told(*asked)) > 0) is bool(found)


@pytest.mark.parametrize("at", [70, 121, 177, 290])
@pytest.mark.parametrize("slip", [4.0, -4.0])
def test_a_slip_between_two_moves_of_a_screw_that_grows_is_one(at: int, slip: float) -> None:
    assert told(of(placed(TO_AND_FRO), warmed(), slip=slip, at=at)) == [("t0", at, slip)]


@pytest.mark.parametrize("at", [70, 100, 150, 200, 250])
def test_a_slip_in_a_programme_of_moves_that_do_nothing_is_one(at: int) -> None:
    """At a move, too: the axis goes as far elsewhere, as warm, without a step. It is told with the place."""
    [step] = steps(of(placed(TO_AND_FRO), warmed(), grows=0.0, slip=4.0, at=at))
    assert (step.at_s / 60 + 0.5, round(step.size)) == (at, 4)
    assert step.beside == (("pos",) if at % EVERY == 0 else ())
    [artefact] = as_artefacts([step], "um")
    assert ("pos changes just then and makes no such step elsewhere" in artefact.why) is (at % EVERY == 0)


def test_a_slip_against_what_the_screw_does_is_one_where_it_moves() -> None:
    """At 150 the others foretell -3 um, and it is +5."""
    [step] = steps(of(placed(TO_AND_FRO), warmed(), slip=8.0, at=100))
    assert (step.at_s / 60 + 0.5, step.beside) == (100, ("pos",))


@pytest.mark.parametrize(("at", "found"), [(100, 0), (104, 1), (140, 1)])
def test_where_every_other_move_is_cold_a_warm_one_explains_what_happens_just_then(at: int, found: int) -> None:
    """Nobody can tell; before and after, it is a slip."""
    cold = [of(placed(TO_AND_FRO), np.full(N, 21.0), seed=k) for k in (1, 2)]
    once = of(placed((650.0,), first=100), warmed(), grows=0.0, slip=4.0, at=at)
    assert len(told(once, *cold)) == found


@pytest.mark.parametrize(("share", "found"), [(0.45, 0), (0.55, 1)])
def test_a_move_half_as_far_times_warm_tells_of_another(share: float, found: int) -> None:
    nut = np.where(ROW < 60, 21.0, 31.0)
    once = of(placed((650.0,), first=100), nut, grows=0.0, slip=4.0, at=100)
    other = of(placed((400.0 + 250.0 * share,), first=200), nut, grows=0.0, seed=1)
    assert len(told(once, other)) == found


def test_what_a_move_does_warm_or_cold_is_its_doing() -> None:
    """A scale that is off by as much at the same place, each time."""
    place = placed(TO_AND_FRO)
    off = Parts(rough() + 0.01 * (place - 400.0), values={"pos": place}, channels={"pos": axis()["pos"]})
    assert told(off) == []


def test_an_axis_that_goes_to_and_fro_all_the_time_explains_nothing_and_is_not_told() -> None:
    place = np.random.default_rng(3).uniform(150.0, 650.0, N)
    slipped = of(place, warmed(), grows=0.0, slip=4.0, at=150)
    [step] = steps(slipped)
    assert (step.at_s / 60 + 0.5, step.beside) == (150, ())


def telling(*tests: Parts, noise: float = 0.05) -> list[str]:
    return places_that_tell(problem(*tests, noise=noise))


@pytest.mark.parametrize(("stands", "moved"), [(4, []), (5, ["pos"])])
def test_an_axis_stands_five_minutes_before_and_after_a_move(stands: int, moved: list[str]) -> None:
    place = np.where((ROW >= 20) & (20 + stands > ROW), 650.0, 150.0)
    off = Parts(rough() + 0.01 * (place - 150.0), values={"pos": place}, channels=axis())
    assert telling(off) == moved


@pytest.mark.parametrize(("far", "moved"), [(0.9, []), (1.1, ["pos"]), (-500.0, ["pos"])])
def test_a_move_is_a_millimetre_at_least(far: float, moved: list[str]) -> None:
    place = placed((400.0 + far,), first=100)
    assert telling(Parts(rough() + 4.0 * (ROW >= 100), values={"pos": place}, channels=axis())) == moved


@pytest.mark.parametrize(("grows", "places"), [(0.0, []), (GROWS / 20, []), (GROWS / 5, ["pos"]), (-GROWS, ["pos"])])
def test_the_place_of_a_screw_tells_where_its_moves_make_steps(grows: float, places: list[str]) -> None:
    """Half a um at least, three times the noise, and a tread beyond that."""
    assert telling(of(placed(TO_AND_FRO), warmed(), grows=grows)) == places
    assert telling(of(placed((400.0,)), warmed(), grows=grows)) == [], "it moves nowhere"
    assert telling(of(placed(TO_AND_FRO), warmed(), grows=grows), noise=3.0) == []


def test_a_slip_at_one_of_many_moves_does_not_make_its_place_tell() -> None:
    assert telling(of(placed(TO_AND_FRO), warmed(), grows=0.0, slip=4.0, at=150)) == []
    assert telling(Parts(rough())) == [], "nobody logged it"


def in_windows(
    visited: Sequence[float], grows: float = GROWS, noise: float = 0.05, *, nut: float | None = None
) -> list[str]:
    """Two samples every six minutes at one place after the other, between which the axis goes to and fro."""
    many, pause = 60, 4
    minute = np.concatenate([k * (2 + pause) + np.arange(2) for k in range(many)])
    place = np.repeat([visited[k % len(visited)] for k in range(many)], 2).astype(float)
    warm = 21.0 + 20.0 * (1 - np.exp(-minute / 100)) if nut is None else np.full(len(minute), nut)
    drawn = noise * np.random.default_rng(1).normal(size=len(minute))
    found = problem(
        Parts(drawn + grows * (place - 400.0) * (warm - 21.0), values={"pos": place, "T": warm}, channels=axis()),
        noise=noise,
    )
    [block] = found.blocks
    t_s = minute * 60.0
    return places_that_tell(replace(found, blocks=(replace(block, t_s=t_s, test=replace(block.test, t_s=t_s)),)))


@pytest.mark.parametrize("visited", [(150, 650), (150, 650, 400), (150,) * 10 + (650,) * 10])
def test_a_place_tells_from_one_window_of_measuring_to_the_next(visited: Sequence[float]) -> None:
    assert in_windows(visited) == ["pos"]
    assert in_windows(visited, grows=0.0) == [], "it does nothing"
    assert in_windows(visited, nut=21.0) == [], "the screw is cold"
    assert in_windows(visited, noise=3.0) == [], "less than a step that could be seen"


def test_one_place_in_all_windows_tells_nothing() -> None:
    assert in_windows((650,)) == []
