"""The clocks of sources on that of one of them."""

from __future__ import annotations

from thermodata.draft.times.clocks import Alignment
from thermodata.draft.times.one_clock import OneClock, on_one_clock


def _aligned(source: str, there: str, offset_s: float | None) -> Alignment:
    return Alignment(source, there, ("a", "b"), offset_s, 1.0, "t", None if offset_s is not None else "thin")


def test_clocks_are_known_beside_each_other_over_a_third() -> None:
    aligned = {"nc": _aligned("nc", "daq", -468.3), "hall": _aligned("hall", "nc", 60.0)}
    clocks = on_one_clock(["daq", "nc", "hall", "other"], aligned)
    assert clocks["hall"] == OneClock("daq", -408_300_000_000)
    assert clocks["daq"].to(clocks["nc"]) == 468_300_000_000  # a time of daq is that much later by nc
    assert clocks["nc"].to(clocks["hall"]) == -60_000_000_000
    assert clocks["daq"].to(clocks["other"]) is None


def test_what_could_not_be_had_and_what_goes_round_says_nothing() -> None:
    clocks = on_one_clock(["daq", "nc"], {"nc": _aligned("nc", "daq", None)})
    assert clocks["nc"].to(clocks["daq"]) is None
    round_and_round = {"a": _aligned("a", "b", 1.0), "b": _aligned("b", "a", 1.0)}
    assert on_one_clock(["a"], round_and_round)["a"].of == "b"
