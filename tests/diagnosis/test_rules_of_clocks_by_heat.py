"""Logs that disagree about the time, told by heat (clocks/by_heat.py), just inside and outside each limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from thermodata.diagnosis.answer import answer
from thermodata.diagnosis.clocks import logs_compared
from thermodata.diagnosis.clocks.by_heat import as_artefact, late_in_one, late_logs
from thermodata.diagnosis.clocks.heat_balance import Disagreement, Pair
from thermodata.diagnosis.clocks.logs_compared import compared
from thermodata.diagnosis.clocks.timings import Timing
from thermodata.diagnosis.sound import not_refuted
from thermodata.diagnosis.steps.commanded import is_command
from thermodata.effect import effects
from thermodata.effect.lag import lag
from thermodata.modelling.fit.model import fit_model
from thermodata.schema.answers.diagnosis import ClockMoved
from thermodata.schema.files.model import Model
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

from .conftest import make_data

STEP_S = 60.0
CHANNELS = {
    "dZ": ChannelInfo("dZ", "displacement", "um", source="daq"),
    "n": ChannelInfo("n", "rotational_speed", "rpm", source="nc"),
    "v": ChannelInfo("v", "feed", "m/min", source="nc"),
    "T_front": ChannelInfo("T_front", "temperature", "degC", source="log"),
    "T_nut": ChannelInfo("T_nut", "temperature", "degC", source="log"),
    "T_hall": ChannelInfo("T_hall", "temperature", "degC", source="log"),
}
RNG = 7


def later(values: np.ndarray, minutes: float) -> np.ndarray:
    t = np.arange(len(values)) * STEP_S
    return np.asarray(np.interp(t - minutes * 60, t, values))


def logged(
    minutes: dict[str, float] | None = None, tests: int = 4, heat: float = 1.0, only: tuple[int, ...] | None = None
) -> list[TestData]:
    """Tests of nine hours in which a bearing follows the speed, a nut the feed, and the displacement both; minutes: by
    which sources are late, in all tests or in some only."""
    rng, made = np.random.default_rng(RNG), []
    for k in range(tests):
        n = np.repeat(rng.choice([0.0, 3000.0, 6000.0, 9000.0], 18), 30)
        v = np.repeat(rng.choice([0.0, 0.0, 10.0], 18), 30)
        t = np.arange(len(n)) * STEP_S
        front = heat * lag(n / 500, 1200, STEP_S) + 0.1 * rng.normal(size=len(n))
        nut = heat * lag(v, 2400, STEP_S) + 0.1 * rng.normal(size=len(n))
        hall = np.sin(t / 20_000 + k) + 0.05 * rng.normal(size=len(n))
        moved = lag(front, 900, STEP_S) + lag(nut, 900, STEP_S)
        values = {"dZ": moved, "n": n, "v": v, "T_front": 20 + front, "T_nut": 20 + nut, "T_hall": 20 + hall}
        off = (minutes or {}) if only is None or k in only else {}
        late = {name: off.get(str(CHANNELS[name].source), 0.0) for name in values}
        values = {name: later(x, late[name]) for name, x in values.items()}
        valid = {name: np.ones(len(n), bool) for name in values}
        made.append(TestData("c", f"t{k}", "mixed", "calibration", t, values, valid, np.ones(len(n), bool)))
    return made


def plain(tests: list[TestData]) -> list[tuple[str, str, float]]:
    return [
        (d.warmed, d.by, d.shift_s / 60) for d in compared(tests, CHANNELS, "dZ", STEP_S).disagreements() if d.plain
    ]


@pytest.mark.parametrize("minutes", [-120, -60, -40, 40, 60, 120])
def test_temperatures_that_are_late_are_told_by_the_commands_that_warm_them(minutes: float) -> None:
    [(warmed, by, shift)] = plain(logged({"log": minutes}))
    assert (warmed, by) == ("log", "nc")
    assert shift == pytest.approx(minutes, abs=4)


@pytest.mark.parametrize("minutes", [-4, 0, 4])
def test_logs_that_agree_are_left_alone(minutes: float) -> None:
    assert plain(logged({"log": minutes})) == []


def test_what_does_not_warm_tells_nothing() -> None:
    assert plain(logged({"log": 60}, heat=0.0)) == []


@pytest.mark.parametrize(("step_s", "asked"), [(240.0, True), (241.0, False)])
def test_a_coarse_grid_tells_nothing(step_s: float, asked: bool) -> None:
    """One sample of it is as much as bodies are late by."""
    assert bool(compared(logged({"log": 15}), CHANNELS, "dZ", step_s).disagreements()) is asked  # so many samples


def test_three_tests_are_needed() -> None:
    assert len(plain(logged({"log": 60}, tests=3))) == 1
    assert compared(logged({"log": 60}, tests=2), CHANNELS, "dZ", STEP_S).disagreements() == []


def test_one_temperature_alone_tells_nothing() -> None:
    tests = [replace(t, values={n: v for n, v in t.values.items() if n != "T_nut"}) for t in logged({"log": 60})]
    [found] = compared(tests, CHANNELS, "dZ", STEP_S).disagreements()
    assert found.telling == 1
    assert not found.plain


@pytest.mark.parametrize(
    ("changed", "is_plain"),
    [
        ({}, True),
        ({"share": 0.301, "unmoved": 0.0}, True),
        ({"share": 0.299, "unmoved": 0.0}, False),
        ({"unmoved": 0.151}, False),
        ({"unmoved": 0.149}, True),
        ({"telling": 1}, False),
        ({"shift_s": -600.0}, True),
        ({"shift_s": 540.0}, False),
        ({"own": 0.499}, True),
        ({"own": 0.501}, False),
        ({"tell": 0.251}, True),
        ({"tell": 0.249}, False),  # a clock moves all temperatures of a log alike
        ({"rest": 0.399}, True),
        ({"rest": 0.401}, False),
    ],
)
def test_a_disagreement_is_plain_where_much_more_is_foretold_once_it_is_mended(
    changed: dict[str, float], is_plain: bool
) -> None:
    found = {"shift_s": 3600.0, "share": 0.6, "unmoved": 0.1, "telling": 2, **changed}
    assert Disagreement("log", "nc", **found).plain is is_plain  # type: ignore[arg-type]


@pytest.mark.parametrize(("hours", "asked"), [(4.5, True), (3.5, False)])
def test_a_shift_leaves_nearly_half_of_a_test_at_least(hours: float, asked: bool) -> None:
    """Two hours of three and a half are moved beyond the log's end: what is left is another test."""
    rows = round(hours * 3600 / STEP_S)
    cut = {"values": lambda v: v[:rows], "valid": lambda v: v[:rows]}
    tests = logged({"log": 120}, only=(1,))
    short = replace(
        tests[1],
        t_s=tests[1].t_s[:rows],
        in_window=tests[1].in_window[:rows],
        **{k: {n: f(x) for n, x in getattr(tests[1], k).items()} for k, f in cut.items()},
    )
    logs = compared([tests[0], short, *tests[2:]], CHANNELS, "dZ", STEP_S)
    [found] = [d for d in logs.in_one() if d.test == "t1"]
    assert (abs(found.shift_s - 7200) < 300) is asked


def test_of_those_that_tell_elsewhere_a_share_tells_in_the_test() -> None:
    """The hall tells nowhere; a bearing that follows its drive here, and a nut that does not, are a half."""
    tests = logged({"log": 60}, only=(1,))
    [whole] = [d for d in compared(tests, CHANNELS, "dZ", STEP_S).in_one() if d.test == "t1"]
    assert (whole.telling, whole.tell) == (2, 1.0)
    rng = np.random.default_rng(RNG)
    noise = {**tests[1].values, "T_nut": 20 + np.cumsum(rng.normal(size=len(tests[1].t_s)))}
    tests[1] = replace(tests[1], values=noise)
    [half] = [d for d in compared(tests, CHANNELS, "dZ", STEP_S).in_one() if d.test == "t1"]
    assert (half.telling, half.tell) == (1, 0.5)


def test_what_no_other_test_foretells_tells_no_clock() -> None:
    """In one test a hall and a bed rise with the feed of an hour before; in the others they hardly do, for all else
    that moves them there. The bearing and the nut, which do, are not late."""
    rng, tests = np.random.default_rng(RNG), logged()
    channels = {**CHANNELS, "T_bed": replace(CHANNELS["T_hall"], name="T_bed")}
    for k, test in enumerate(tests):
        warmed = lag(test.values["v"], 2400, STEP_S)
        drift = np.cumsum(rng.normal(size=(2, len(warmed))), axis=1)
        hall, bed = (later(warmed, 60), later(warmed, 60)) if k == 1 else (warmed + drift[0], warmed + drift[1])
        values = {**test.values, "T_hall": 20 + hall, "T_bed": 20 + bed}
        tests[k] = replace(test, values=values, valid={**test.valid, "T_bed": test.valid["T_hall"]})
    found = [d for d in compared(tests, channels, "dZ", STEP_S).in_one() if d.test == "t1"]
    assert [d.telling for d in found] == [2], "bearing and nut"
    assert not [d for d in found if d.plain]


@pytest.mark.parametrize(
    ("home", "right", "late", "source", "shift"),
    [
        ("nc", (), {"log": 60}, "log", -60),
        ("log", (), {"nc": 60}, "nc", -60),
        ("daq", ("nc",), {"log": 60}, "log", -60),
        ("daq", (), {"log": 60}, "log", -60),
        ("daq", (), {"nc": 60}, "nc", -60),
    ],
)
def test_the_log_that_disagrees_with_the_displacement_too_is_late(
    home: str, right: tuple[str, ...], late: dict[str, float], source: str, shift: float
) -> None:
    """By its own source, by what commands move at once, or by its own heat."""
    channels = {**CHANNELS, "dZ": replace(CHANNELS["dZ"], source=home)}
    [found] = late_logs(compared(logged(late), channels, "dZ", STEP_S), right)
    assert found.source == source
    assert found.shift_s / 60 == pytest.approx(shift, abs=4)
    assert f"the choice is made with '{source}' moved by" in as_artefact(found, "c").why


def in_one(tests: list[TestData]) -> list[tuple[str, str | None, float]]:
    return [(f.of.test, f.source, f.shift_s / 60) for f in late_in_one(compared(tests, CHANNELS, "dZ", STEP_S), {})]


@pytest.mark.parametrize("minutes", [-120, -60, -40, 40, 60, 120])
@pytest.mark.parametrize("source", ["log", "nc"])
def test_a_log_that_is_late_in_one_test_is_told_by_the_others(source: str, minutes: float) -> None:
    assert in_one(logged({source: minutes}, only=(2,))) == [("t2", source, pytest.approx(-minutes, abs=4))]


@pytest.mark.parametrize(
    ("late", "test", "minutes", "as_logged"),
    [
        ({}, 2, 40, True),  # what commands move at once met it by chance
        ({"nc": 40.0}, 2, -40, False),
        ({"nc": 40.0}, 1, -40, True),
        ({"nc": 40.0, "log": 40.0}, 2, -40, False),  # of the displacement's own log: its heat says so
        ({"nc": 40.0}, 2, -330, False),  # too little of the test is left to say
    ],
)
def test_heat_says_of_a_test_whether_its_commands_are_right_as_they_were_logged(
    late: dict[str, float], test: int, minutes: float, as_logged: bool
) -> None:
    logs = compared(logged(late, only=(2,)), CHANNELS, "dZ", STEP_S)
    assert logs.comes_as_logged("nc", ("c", f"t{test}"), 60 * minutes) is as_logged


def test_where_nothing_warms_heat_refutes_no_clock() -> None:
    logs = compared(logged(heat=0.0), CHANNELS, "dZ", STEP_S)
    assert not logs.comes_as_logged("nc", ("c", "t2"), 2400.0)


@pytest.mark.parametrize(
    ("told", "stays"),
    [
        ([Timing("nc", 2400.0, 0.3, 0.0, "c", "t2")], False),
        ([Timing("nc", 2400.0, 0.3, 0.0)], True),  # of all tests
        ([Timing("nc", 2400.0, 0.3, 0.0), Timing("nc", 1200.0, 0.3, 0.0, "c", "t2", all_s=2400.0)], True),
    ],
)
def test_a_clock_of_one_test_is_moved_where_heat_does_not_refute_it(told: list[Timing], stays: bool) -> None:
    assert not_refuted(told, compared(logged(), CHANNELS, "dZ", STEP_S)) == (told if stays else [])


def test_of_a_test_in_which_the_machine_waits_nothing_is_said() -> None:
    """What was warm before cools, and that is foretold whatever the commands do; a pump runs at hours of its own."""
    tests = logged()
    t = tests[2].t_s
    n = 500.0 * ((t > 9000) & (t < 12_000))
    cooling = {name: 20 + 15 * np.exp(-t / tau) for name, tau in (("T_front", 1200.0), ("T_nut", 2400.0))}
    waits = replace(tests[2], values={**tests[2].values, "n": n, "v": np.zeros(len(t)), **cooling})
    assert in_one([*tests[:2], waits, *tests[3:]]) == []


@pytest.mark.parametrize("minutes", [-4, 0, 4])
def test_a_test_whose_logs_agree_is_left_alone(minutes: float) -> None:
    assert in_one(logged({"log": minutes}, only=(2,))) == []


def test_of_half_of_the_tests_nobody_can_say_which_are_right() -> None:
    """By shifts of their own; what is off alike is a part of the tests (test_rules_of_clocks_in_part.py)."""

    def two_off(tests: int) -> list[TestData]:
        return [
            logged({"log": 60}, tests)[0],
            logged({"log": -60}, tests)[1],
            *logged(tests=tests)[2:],
        ]

    assert len(in_one(two_off(7))) == 2
    assert in_one(two_off(4)) == []


@pytest.mark.parametrize(("told", "source"), [(True, "log"), (False, None)])
def test_of_one_test_a_clock_that_is_known_there_is_not_moved(told: bool, source: str | None) -> None:
    tests = without_a_word(logged({"log": 60}, only=(2,)))
    right = {("c", "t2"): {"nc"}} if told else {("c", "t1"): {"nc"}}
    [found] = late_in_one(compared(tests, CHANNELS, "dZ", STEP_S), right)
    assert found.source == source
    said = as_artefact(found, "other")
    assert (said.campaign, said.test) == ("c", "t2")
    assert "as they do in the other tests" in said.why


@pytest.mark.parametrize("place", ["hall", "hall.top", "floor", "outside", None])
def test_what_follows_the_air_tells_no_clock(place: str | None) -> None:
    """In one test bearing and nut rise as commands an hour earlier would warm them, and as the air around does."""

    def with_air(test: TestData) -> TestData:
        rises = {f"A_{n}": np.gradient(test.values[n], STEP_S) * 600 for n in ("T_front", "T_nut")}
        return replace(
            test, values={**test.values, **rises}, valid={**test.valid, **dict.fromkeys(rises, test.valid["n"])}
        )

    air = {n: ChannelInfo(n, "temperature", "degC", at=place, source="log") for n in ("A_T_front", "A_T_nut")}
    tests = [with_air(t) for t in logged({"log": -60}, only=(2,))]
    found = late_in_one(compared(tests, {**CHANNELS, **air}, "dZ", STEP_S), {})
    assert [f.of.test for f in found] == ([] if place else ["t2"])


@pytest.mark.parametrize(
    ("source", "minutes", "late", "borne_out"),
    [
        ("nc", 26, {"nc": 26.0}, True),
        ("log", 26, {"log": 26.0}, False),  # the response is in daq: between daq and log nothing was commanded
        ("nc", 26, {}, False),  # switched on late, by a clock that was right
        ("nc", 26, {"nc": -26.0}, False),
        ("nc", 90, {"nc": 90.0}, False),  # no such shift is asked
    ],
)
def test_heat_bears_out_that_a_log_stands_elsewhere(
    source: str, minutes: float, late: dict[str, float], borne_out: bool
) -> None:
    logs = compared(logged(late, only=(2,)), CHANNELS, "dZ", STEP_S)
    assert logs.bears_out([ClockMoved(source=source, campaign="c", test="t2", moved_s=-60 * minutes)]) is borne_out
    assert not logs.bears_out([ClockMoved(source=source, campaign="c", test="t9", moved_s=-60 * minutes)])


@pytest.mark.parametrize(("moved", "borne_out"), [(0.401, True), (0.399, False)])
def test_a_third_of_what_is_left_goes_where_a_log_was_moved(
    moved: float, borne_out: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(logs_compared, "either", lambda *_: (0.1, moved))
    logs = compared(logged(), CHANNELS, "dZ", STEP_S)
    assert logs.bears_out([ClockMoved(source="nc", campaign="c", test="t2", moved_s=-1560.0)]) is borne_out


def without_a_word(tests: list[TestData]) -> list[TestData]:
    """Their displacement is noise."""
    rng = np.random.default_rng(1)
    return [replace(t, values={**t.values, "dZ": rng.normal(size=len(t.t_s))}) for t in tests]


def test_the_log_of_the_displacement_is_right_whatever_that_says() -> None:
    channels = {**CHANNELS, "dZ": replace(CHANNELS["dZ"], source="log")}
    [found] = late_logs(compared(without_a_word(logged({"nc": 60})), channels, "dZ", STEP_S))
    assert found.source == "nc"


@pytest.mark.parametrize(
    ("said", "source"),
    [((0.16, 0.0), "log"), ((0.0, 0.16), "nc"), ((0.14, -1.0), None), ((0.4, 0.26), None), ((0.42, 0.26), "log")],
)
def test_the_displacement_decides_where_it_says_more_of_one_time_than_of_the_other(
    said: tuple[float, float], source: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """said: what is foretold of its rises with the commands where they are, and moved."""
    monkeypatch.setattr(Pair, "foretold", lambda *_: said)
    [found] = late_logs(compared(logged({"log": 60}), CHANNELS, "dZ", STEP_S))
    assert found.source == source


def test_where_the_displacement_says_nothing_neither_log_is_moved() -> None:
    [found] = late_logs(compared(without_a_word(logged({"log": 60})), CHANNELS, "dZ", STEP_S))
    assert found.source is None
    assert as_artefact(found, "c").why.endswith(
        "nothing tells which; check the time zone and the clocks. Declare what holds at both sources, clock: "
        "{offset: ...}, 0 s for the one that is right"
    )
    in_one = replace(found, of=replace(found.of, campaign="c", test="day1"))
    assert as_artefact(in_one, "c").why.endswith(
        ". Declare what holds at the test, clocks: {nc: ..., log: ...}, 0 s for one that was right"
    )


def test_the_choice_is_made_with_the_log_moved(spec: Model) -> None:
    """Temperatures an hour late: the cause is named as where they are not, and the clock is said."""

    def nut(channels: dict[str, np.ndarray], t: np.ndarray) -> np.ndarray:
        return np.asarray(lag(9 * (channels["T_nut_X"] - channels["T_nut_X"][0]), 1200, 120.0))

    data = make_data(nut)
    rng = np.random.default_rng(5)
    feeds = [np.repeat(rng.choice([0.0, 1.0], 36), 10) for _ in data.tests]
    tests = []
    for test, feed in zip(data.tests, feeds, strict=True):
        warm = 22 + lag(feed * 8, 2400, 120.0)
        values = {**test.values, "T_nut_X": warm, "feed_X": feed}
        values["dZ"] = test.values["dZ"] - nut(test.values, test.t_s) + nut(values, test.t_s)
        late = {n: np.interp(test.t_s - 3600, test.t_s, v) if n.startswith("T_") else v for n, v in values.items()}
        tests.append(replace(test, values=late, valid={**test.valid, "feed_X": test.valid["dZ"]}))
    channels = {**data.channels, "feed_X": ChannelInfo("feed_X", "feed", "m/min", at="axis.x", axis="X")}
    channels = {n: replace(c, source="log" if n.startswith("T_") else "nc") for n, c in channels.items()}
    off = Dataset(data.step_s, tuple(tests), channels)
    found = answer(fit_model(spec, off, uncertainty=False), off, effects(), "m").diagnosis
    assert [a.kind for a in found.artefacts] == ["clock_offset"]
    assert "'log' moved by -58 min" in found.artefacts[0].why
    assert found.put_right is not None
    [clock] = found.put_right.clocks
    assert (clock.source, clock.test) == ("log", "")
    assert clock.moved_s == pytest.approx(-58 * 60, abs=31)
    assert [c.family for c in found.candidates if c.claimed] == ["feed_x"]
    # what the campaign file says of its clock stays
    declared = {n: replace(c, clock_declared=c.source == "log") for n, c in channels.items()}
    kept = Dataset(data.step_s, tuple(replace(t, channels=declared) for t in tests), declared)
    found = answer(fit_model(spec, kept, uncertainty=False), kept, effects(), "m").diagnosis
    assert found.put_right is None
    assert "clock_offset" not in [a.kind for a in found.artefacts]


@pytest.mark.parametrize(("at", "told"), [("coolant", True), ("hall.door", False), (None, True)])
def test_the_door_of_the_hall_commands_nothing(at: str | None, told: bool) -> None:
    assert is_command(ChannelInfo("open", "state", "1", at=at)) is told
    assert not is_command(ChannelInfo("open", "temperature", "degC", at=at))
