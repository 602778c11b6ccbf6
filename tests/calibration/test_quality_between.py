from __future__ import annotations

import numpy as np

from thermodata.calibration.quality_between import POINTS, Levels, offsets_between_tests

DAY = 86_400.0


def day(
    number: int, *, hours: float = 8.0, heat: float = 20.0, start_h: float = 8.0, warm: bool = False, **off: float
) -> Levels:
    """A day's test: a bearing that heats up, four parts that hardly do."""
    h = np.linspace(0, hours, POINTS)
    rise = np.ones(POINTS) if warm else 1 - np.exp(-h / 0.8)
    rng = np.random.default_rng(number)
    gains = {"T_bearing": heat, "T_column": 2.0, "T_bed": 1.0, "T_hall": 0.5, "T_motor": 12.0}
    start = number * DAY + start_h * 3600
    return Levels(
        f"day{number}",
        start,
        start + hours * 3600,
        {name: 22 + gain * rise + rng.normal(0, 0.05, POINTS) + off.get(name, 0.0) for name, gain in gains.items()},
    )


def test_sound_days_are_left_alone_however_hot() -> None:
    assert offsets_between_tests([day(1, heat=0), day(2, heat=0), day(3, heat=35), day(4, heat=40)]) == {}


def test_a_sensor_that_reads_30_kelvin_more_from_one_day_on() -> None:
    tests = [day(1), day(2, heat=0), day(3, T_column=30.0), day(4, heat=5, T_column=30.0)]
    found = offsets_between_tests(tests)
    assert sorted(found) == [("day3", "T_column"), ("day4", "T_column")]
    assert all(abs(size - 30) < 2 for size in found.values())
    assert offsets_between_tests([day(1), day(2, T_bed=-15.0)]).keys() == {("day2", "T_bed")}


def test_a_sensor_that_recovers_is_not_condemned() -> None:
    assert offsets_between_tests([day(1), day(2, T_column=30.0), day(3)]) == {}


def test_a_part_that_stays_hot_without_a_rest_is_not_told_from_a_failure() -> None:
    tests = [day(1, heat=0, hours=2), day(1, heat=30, hours=2, start_h=10.1, warm=True)]
    assert offsets_between_tests([tests[0], Levels("hot", *[tests[1].start_s, tests[1].end_s], tests[1].series)]) == {}


def test_too_few_neighbours_and_no_data() -> None:
    lone = [
        Levels(t.test, t.start_s, t.end_s, {k: t.series[k] for k in ("T_column", "T_bed", "T_hall")})
        for t in (day(1), day(2, T_column=30.0))
    ]
    assert offsets_between_tests(lone) == {}
    assert offsets_between_tests([]) == {}
    empty = Levels("none", 0.0, 1.0, {"T_column": np.full(POINTS, np.nan)})
    assert offsets_between_tests([empty, day(1), day(2, T_column=30.0)]).keys() == {("day2", "T_column")}


def by_brute_force(tests: list[Levels]) -> dict[tuple[str, str], float]:
    """The same, test by test and split by split."""
    ordered = sorted(tests, key=lambda t: t.start_s)
    rested = [i > 0 and ordered[i].start_s - max(t.end_s for t in ordered[:i]) >= 4 * 3600 for i in range(len(ordered))]
    found = {}
    for channel in {c for t in ordered for c in t.series}:
        spans = {}
        for i, test in enumerate(ordered):
            others = [x for name, x in test.series.items() if name != channel]
            if channel not in test.series or len(others) < 3:
                continue
            own, stacked = test.series[channel], np.stack(others)
            at = np.isfinite(own) & (np.isfinite(stacked).sum(axis=0) >= 3)
            if at.any():
                d = own[at] - np.nanmedian(stacked[:, at], axis=0)
                spans[i] = d.min(), d.max(), np.median(d)
        told, best, widest = list(spans), None, 8.0
        for split in range(1, len(told)):
            before, after = [spans[i] for i in told[:split]], [spans[i] for i in told[split:]]
            gap = max(
                min(s[0] for s in after) - max(s[1] for s in before),
                min(s[0] for s in before) - max(s[1] for s in after),
            )
            if any(rested[i] for i in told[split:]) and gap > widest:
                widest = gap
                best = told[split:], np.median([s[2] for s in after]) - np.median([s[2] for s in before])
        if best is not None:
            found |= {(ordered[i].test, channel): float(best[1]) for i in best[0]}
    return found


def test_all_tests_at_once_say_what_each_test_and_split_says() -> None:
    rng = np.random.default_rng(1)
    told = 0
    for _ in range(40):
        tests = [
            day(n, heat=rng.uniform(0, 30), start_h=rng.uniform(0, 20), hours=rng.uniform(1, 12))
            for n in range(1, int(rng.integers(2, 9)))
        ]
        broken, since = rng.choice(["T_column", "T_bed", "T_motor"]), int(rng.integers(1, 8))
        for test in tests[since:]:
            test.series[broken][:] += rng.choice([-30.0, 30.0])  # type: ignore[index]
        for test in tests:
            for values in test.series.values():
                values[rng.random(POINTS) < rng.choice([0.0, 0.5])] = np.nan
            for name in rng.choice(list(test.series), int(rng.integers(0, 3)), replace=False):
                del test.series[name]  # type: ignore[attr-defined]
        wanted = by_brute_force(tests)
        told += bool(wanted)
        assert offsets_between_tests(tests) == wanted
    assert told > 5
