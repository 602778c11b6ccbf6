"""Flagged stretches that are alike are one row, and none of them is lost."""

from __future__ import annotations

from thermodata.view.lists.alike import folded
from thermodata.view.lists.events import Flagged


def at(from_s: float, channel: str = "dX", flag: str = "saturated", why: str = "the end of its range") -> Flagged:
    return Flagged(channel, "daq", flag, from_s, from_s + 60.0, 12, why)


def test_a_probe_at_its_limit_a_hundred_times_is_a_row_that_holds_each() -> None:
    stretches = [at(300.0 * i) for i in range(109)]
    (row,) = folded(stretches)
    assert row.channels == ("dX",)
    assert row.stretches == tuple(stretches)
    assert (row.from_s, row.to_s, row.total_s, row.n) == (0.0, 300.0 * 108 + 60, 109 * 60.0, 109 * 12)


def test_channels_that_share_their_stretches_share_a_row_and_others_do_not() -> None:
    gap, other = [at(60.0, name, "gap", "1500 s") for name in ("T_a", "T_b")], at(60.0, "T_c", "gap", "9 s")
    rows = folded([*gap, other, at(60.0)])
    assert [(r.channels, r.flag) for r in rows] == [
        (("T_a", "T_b"), "gap"),
        (("T_c",), "gap"),
        (("dX",), "saturated"),
    ]
    assert rows[0].n == 24, "of both"


def test_what_a_source_has_is_of_no_channel_and_each_reason_stands_once() -> None:
    rows = folded([at(0.0, ""), at(120.0, "", why="another"), at(240.0, "")])
    assert [(r.channels, r.source, r.details) for r in rows] == [((), "daq", ("the end of its range", "another"))]
