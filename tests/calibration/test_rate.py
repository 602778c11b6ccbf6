"""The rate of what was logged: between its own samples, over no gap, and the same wherever a log is cut."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from thermodata.calibration.expression.evaluation import rate_of
from thermodata.calibration.expression.parser import parse
from thermodata.calibration.rate import NONE, PAUSES, lost_in_turns, rates, stood_in_pauses, stretches, usual_step_ns
from thermodata.errors import UsageError
from thermodata.plugin import Float1D
from thermodata.store.tidy.values.rated import LEAST_LEG

S = 10**9
LONGEST = 3_500_000_000


def rate(t_s: list[float], values: list[float], doubted: list[int] | None = None, on_change: bool = False) -> list:
    t_ns, x = np.array([round(t * S) for t in t_s], np.int64), np.array(values, float)
    marks = None if doubted is None else np.isin(np.arange(len(x)), doubted)
    found = stretches(t_ns, x, longest_ns=LONGEST, doubted=marks, on_change=on_change)
    return rates(t_ns, x, *found).tolist()


def test_a_sample_has_the_rate_to_the_next_one_and_the_last_that_before_it() -> None:
    assert rate([0, 1, 2, 4], [0, 10, 5, 6]) == [10, -5, 0.5, 0.5]


def test_nothing_is_drawn_over_a_gap() -> None:
    np.testing.assert_array_equal(rate([0, 1, 5, 6, 20], [0, 1, 300, 301, 7]), [1, 1, 1, 1, np.nan])


def test_a_missing_value_has_no_rate_and_those_about_it_have_theirs() -> None:
    np.testing.assert_array_equal(rate([0, 1, 2, 3], [0, np.nan, 4, 5]), [2, np.nan, 1, 1])


def test_rows_at_one_time_are_one_sample() -> None:
    # stamps of whole seconds over rows that came ten a second
    t_s, x = np.repeat([0.0, 1.0, 2.0], 10), np.arange(30) * 0.1
    np.testing.assert_allclose(rate(t_s.tolist(), x.tolist()), 1.0)


def test_a_stretch_to_a_time_that_was_made_tells_nothing() -> None:
    assert rate([0, 1, 2, 3], [0, 1, 50, 51], doubted=[2])[:2] == [1, 1]
    np.testing.assert_array_equal(rate([0, 1, 2, 3], [0, 1, 50, 51], doubted=[2])[2:], [np.nan, np.nan])


def test_what_is_written_on_change_stood_while_nobody_wrote() -> None:
    # an axis that went by 20 mm/s for two seconds, stood for an hour, and went back
    found = rate([0, 1, 2, 3602, 3603, 3604], [0, 20, 40, 40.01, 20, 0], on_change=True)
    assert found == pytest.approx([20, 20, 0, -20.01, -20, 0])
    assert rate([0, 1200, 2400], [0, 300, 0], on_change=True) == [0, 0, 0]


def test_of_one_sample_or_none_there_is_no_rate() -> None:
    assert rate([], []) == []
    assert np.isnan(rate([0], [1])).all()
    assert rate([0], [1], on_change=True) == [0]
    assert stretches(np.array([0]), np.array([1.0]), longest_ns=1)[1].tolist() == [NONE]


def test_the_usual_step_is_of_rows_that_have_a_value() -> None:
    t_ns = np.arange(11) * S
    assert usual_step_ns(t_ns, np.where(np.arange(11) % 5 == 0, 1.0, np.nan)) == 5 * S
    assert usual_step_ns(t_ns[:1], np.ones(1)) == 0


def test_a_log_that_goes_on_from_where_it_was_stood_in_its_pauses() -> None:
    moving = np.arange(0, 2, 0.1)
    t_ns = np.round(np.concatenate([60 * k + moving for k in range(PAUSES + 1)]) * S).astype(np.int64)
    to, fro = 100 * moving, 100 * moving[::-1]
    rests = np.concatenate([to if k % 2 == 0 else fro for k in range(PAUSES + 1)])
    elsewhere = np.concatenate([to] * (PAUSES + 1))
    assert stood_in_pauses(t_ns, rests, LONGEST)
    assert not stood_in_pauses(t_ns, elsewhere, LONGEST)
    assert not stood_in_pauses(t_ns[: -moving.size], rests[: -moving.size], LONGEST)  # a pause too few
    assert not stood_in_pauses(t_ns, np.round(rests, -2), LONGEST)  # steps as large as the range
    assert not stood_in_pauses(t_ns[:1], rests[:1], LONGEST)


def lost_of(t_s: Float1D, x: Float1D, speed: float) -> float:
    """What the rates of a position lack of an even speed."""
    t_ns = np.round(t_s * S).astype(np.int64)
    return 1 - float(np.abs(rates(t_ns, x, *stretches(t_ns, x, longest_ns=LONGEST))).mean()) / speed


@pytest.mark.parametrize("stroke_s", [2.2, 4.7, 11.3, 31.7])
def test_what_turns_between_samples_is_told(stroke_s: float) -> None:
    t_s = np.arange(0, 4000.0)
    x = 300 * np.abs(t_s / stroke_s % 2 - 1)
    lost, leg = lost_in_turns((t_s * S).astype(np.int64), x, LONGEST)
    assert lost == pytest.approx(lost_of(t_s, x, 300 / stroke_s), rel=0.15)
    assert leg == pytest.approx(stroke_s, rel=0.1)


@pytest.mark.parametrize(("late", "lost"), [(0.0, 0.0), (0.1, 0.1), (0.25, 0.25), (0.5, 0.5), (0.75, 0.25)])
@pytest.mark.parametrize("stroke_s", [2.0, 4.0])
def test_an_axis_that_keeps_step_with_its_logger_loses_what_its_turns_are_late(
    late: float, lost: float, stroke_s: float
) -> None:
    """From nothing to one stretch in each stroke, which only where the turns lie tells."""
    t_s = np.arange(0, 4000.0)
    x = 300 * np.abs((t_s + late) / stroke_s % 2 - 1)
    told, leg = lost_in_turns((t_s * S).astype(np.int64), x, LONGEST)
    assert told == pytest.approx(2 * lost / stroke_s, abs=0.01)
    assert told == pytest.approx(lost_of(t_s, x, 300 / stroke_s), abs=0.01)
    assert leg == pytest.approx(stroke_s, rel=0.01)


@pytest.mark.parametrize("stroke_s", [1.2, 1.7])
def test_strokes_of_less_than_two_samples_tell_no_speed(stroke_s: float) -> None:
    t_s = np.arange(0, 4000.0)
    assert lost_in_turns((t_s * S).astype(np.int64), 300 * np.abs(t_s / stroke_s % 2 - 1), LONGEST)[1] < LEAST_LEG


def test_what_rests_where_it_turns_loses_nothing() -> None:
    way = np.concatenate([np.arange(0, 300.0, 30), np.full(5, 300.0), np.arange(300, 0, -30.0), np.zeros(5)])
    x = np.tile(way, 50)
    assert lost_in_turns(np.arange(len(x)) * S, x, LONGEST)[0] == 0


def test_nothing_is_lost_of_what_does_not_move() -> None:
    noise = np.random.default_rng(1).normal(0, 0.001, 500)
    t_ns = np.arange(500) * S
    assert lost_in_turns(t_ns, np.where(t_ns < 250 * S, 0.0, 100.0) + noise, LONGEST) == (0, np.inf)
    assert lost_in_turns(t_ns[:0], noise[:0], LONGEST) == (0, np.inf)


@given(st.data())
@settings(deadline=None)
def test_a_row_hangs_on_those_near_it_alone(data: st.DataObject) -> None:
    steps = data.draw(st.lists(st.sampled_from([0, 100_000_000, S, 3 * S, 4 * S, 60 * S]), min_size=1, max_size=40))
    t_ns = np.cumsum(np.array(steps, np.int64))
    value = st.one_of(st.just(np.nan), st.integers(-50, 50).map(float))
    x = np.array(data.draw(st.lists(value, min_size=len(steps), max_size=len(steps))))
    doubted = np.array(data.draw(st.lists(st.booleans(), min_size=len(steps), max_size=len(steps))))
    on_change = data.draw(st.booleans())

    def of(low: int, high: int) -> np.ndarray:
        found = stretches(
            t_ns[low:high], x[low:high], longest_ns=LONGEST, doubted=doubted[low:high], on_change=on_change
        )
        return rates(t_ns[low:high], x[low:high], *found)

    whole = of(0, len(steps))
    start = data.draw(st.integers(0, len(steps) - 1))
    stop = data.draw(st.integers(start + 1, len(steps)))
    low = int(np.searchsorted(t_ns, t_ns[start] - LONGEST))
    high = int(np.searchsorted(t_ns, t_ns[stop - 1] + LONGEST + 1))
    np.testing.assert_array_equal(of(low, high)[start - low : stop - low], whole[start:stop])


def test_a_rate_has_the_unit_of_its_channel_by_the_second() -> None:
    values = {"x_pos": np.zeros(2), rate_of("x_pos"): np.array([-50.0, 100.0]), "F": np.array([2.0, 2.0])}
    units = {"x_pos": "mm", "F": "N m"}
    for text, wanted in (("rate(x_pos)", [-3, 6]), ("abs(rate(x_pos))", [3, 6]), ("2 * rate( x_pos )", [-6, 12])):
        tree = parse(text, rates=True)
        assert tree.names == tree.rated == {"x_pos"}
        np.testing.assert_allclose(tree.evaluate_in(values, units, "m/min"), wanted)
    assert parse("rate(x_pos) > 2 m/min", rates=True).evaluate(values, units).tolist() == [False, True]
    assert parse("rate(x_pos)", rates=True).unit(units) == "millimeter / second"
    with pytest.raises(UsageError, match="the expression gives"):
        parse("rate(x_pos)", rates=True).evaluate_in(values, units, "rpm")


@pytest.mark.parametrize(
    "text", ["rate(rate(x))", "rate(x + y)", "rate(abs(x))", "rate(2)", "rate()", "rate(x", "rate(-x)"]
)
def test_a_rate_is_of_one_channel_as_it_was_logged(text: str) -> None:
    with pytest.raises(UsageError, match="a rate is of one channel"):
        parse(text, rates=True)


def test_only_derive_has_the_samples_of_a_channel() -> None:
    with pytest.raises(UsageError, match="only 'derive' has") as refused:
        parse("abs(rate(x_pos)) < 1")
    assert "column 5" in str(refused.value)
    assert "derive a channel" in str(refused.value)


def test_a_channel_may_be_called_rate() -> None:
    assert parse("rate * 2").evaluate({"rate": np.array([2.0])}).tolist() == [4.0]
    assert parse("rate(rate)", rates=True).rated == {"rate"}
