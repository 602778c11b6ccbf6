"""A test whose measurement holds the moves of a jump test is told, with the window that leaves them out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from store_fakes import daq, write_log

from thermodata.store import Store
from thermodata.store.ingest.run import ingest

JUMP = (
    "calibrations:\n  jump: {kind: jump, axis: Z, source: daq, file: raw/one_a.npz, signal: Z, "
    "moves: [100 um, -100 um], dwell: 20 s}\n"
)


def with_a_jump(campaign: Path, at_s: int, said: str) -> None:
    """The jump test lies in the log of the test 'one', at a time. said: in the line of that test, besides."""
    log, t = daq(), np.arange(1200)
    log["main"]["Z"] += 1.0 * ((t >= at_s) & (t < at_s + 50))
    write_log(campaign.parent / "raw/one_a.npz", log)
    text = campaign.read_text(encoding="utf-8").replace("calibrations:\n", JUMP)
    text = text.replace("calibration: lvdt}", "calibration: jump}").replace(
        "speed: 9000 rpm}", "speed: 9000 rpm}" + said
    )
    campaign.write_text(text, encoding="utf-8")


def test_moves_that_measuring_may_leave_out_are_no_loss(store: Store, campaign: Path) -> None:
    with_a_jump(campaign, 30, ', measuring: "speed > 100"')
    summary = ingest(store, campaign)
    assert not any("the moves of the jump test" in x["reason"] for x in summary.losses)
    (told,) = [x for x in summary.notes if "the moves of the jump test" in x]
    assert "test 'one'" in told
    assert "but for what its measuring leaves out" in told


@pytest.mark.parametrize(
    ("at_s", "window", "proposed"),
    [
        (30, "", "[80 s, 1199 s]"),
        (1000, "", "[0 s, 1000 s]"),
        (30, ", window: [80 s, 1199 s]", None),
        (30, ", window: [20 s, 1199 s]", "[80 s, 1199 s]"),
        (30, ", window: [0 s, 25 s]", None),
    ],
)
def test_the_moves_of_a_jump_test_in_a_test(
    store: Store, campaign: Path, at_s: int, window: str, proposed: str | None
) -> None:
    with_a_jump(campaign, at_s, window)
    told = [
        x for x in ingest(store, campaign).losses if "the moves of the jump test jump lie in this test" in x["reason"]
    ]
    assert [x["test"] for x in told] == (["one"] if proposed else [])
    if proposed:
        numbers = [float(n) for n in told[0]["reason"].rpartition("window: [")[2].split(" s")[0:1]]
        assert numbers[0] == pytest.approx(float(proposed[1:].split(" s")[0]), abs=2)


@pytest.mark.parametrize(
    ("size", "length_s", "window", "told"),
    [
        (1.0, 50, "", True),
        (1.0, 50, ", window: [90 s, 1199 s]", False),
        (0.8, 50, "", False),  # the same probe shows the same moves
        (-1.0, 50, "", False),
        (1.0, 1100, "", False),  # comes back long after the jump test that is known
    ],
)
def test_moves_that_come_again_at_the_head_of_another_test(
    store: Store, campaign: Path, size: float, length_s: int, window: str, told: bool
) -> None:
    with_a_jump(campaign, 30, ", window: [81 s, 1199 s]")
    log, t = daq(), np.arange(1200)
    log["main"]["Z"] += size * ((t >= 35) & (t < 35 + length_s))
    write_log(campaign.parent / "raw/two_a.npz", log)
    text = campaign.read_text(encoding="utf-8")
    assert "{id: two" in text
    campaign.write_text(text.replace("{id: two", "{id: two" + window), encoding="utf-8")
    found = [x for x in ingest(store, campaign).losses if "of the jump test jump lie in this test" in x["reason"]]
    assert [x["test"] for x in found] == (["two"] if told else [])
    if told:
        assert found[0]["reason"].startswith("moves as those of the jump test jump lie in this test")
        assert "in raw/two_a.npz" in found[0]["reason"]
        assert float(found[0]["reason"].rpartition("window: [")[2].split(" s")[0]) == pytest.approx(85, abs=2)
