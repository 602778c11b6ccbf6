"""What hangs on a clock that could not be aligned is said by each fit (modelling/seen/doubtful_clocks.py)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from thermodata.modelling.fit.model import fit_model
from thermodata.modelling.seen.doubtful_clocks import doubtful_clocks
from thermodata.modelling.versions.result import make_result
from thermodata.view.grid.dataset import ChannelInfo, Dataset, TestData

from .conftest import Spec

Change = Callable[[ChannelInfo], ChannelInfo]


def _logged(data: Dataset, tests: set[str], source: dict[str, str], **more: str) -> Dataset:
    """source: channel -> whose clock is doubtful in these tests. more: channel -> 'measuring', where that reads it."""

    def of(test: TestData) -> TestData:
        infos = {
            name: replace(
                info,
                source=source.get(name, "daq"),
                clock_doubtful=name in source and test.test in tests,
                in_measuring=more.get(name) == "measuring",
            )
            for name, info in test.channels.items()
        }
        return replace(test, channels=infos)

    return replace(data, tests=tuple(of(t) for t in data.tests))


@pytest.mark.parametrize(
    ("source", "measuring", "drivers", "hangs"),
    [
        ({"T_nut": "nc"}, {}, (), ()),  # which the model does not read
        ({"T_nut": "nc"}, {}, ("T_nut",), ("T_nut",)),
        ({"T_nut": "nc"}, {"T_nut": "measuring"}, (), ("measuring",)),
        ({"T_hall": "nc"}, {}, (), ("T_hall",)),
    ],
)
def test_what_is_read_and_when_was_measured_hang_on_a_clock(
    world: Dataset,
    spec: Spec,
    source: dict[str, str],
    measuring: dict[str, str],
    drivers: tuple[str, ...],
    hangs: tuple[str, ...],
) -> None:
    data = _logged(world, {"t0", "t1"}, source, **measuring)
    fitted = fit_model(spec("ambient_frame"), data)
    found = doubtful_clocks(fitted, data, drivers)
    assert [(one.source, one.tests, one.hangs) for one in found] == ([("nc", ("t0", "t1"), hangs)] if hangs else [])
    checks = [c for c in make_result(fitted, data, "m").checks if c.name == "clock_doubtful:nc"]
    assert len(checks) == (1 if hangs and not drivers else 0)
    for check in checks:
        comes = f"{hangs[0]} comes from it"
        assert check.advice.startswith(f"the clock of nc is doubtful in t0, t1: {comes}; it may lie minutes off")
        assert not check.passed


def test_clocks_that_were_aligned_are_not_told(world: Dataset, spec: Spec) -> None:
    data = _logged(world, set(), {"T_hall": "nc"})
    assert doubtful_clocks(fit_model(spec("ambient_frame"), data), data) == []
