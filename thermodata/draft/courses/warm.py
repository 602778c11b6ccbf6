"""Tests that began before the machine had cooled: what is warm at their first row, against what nothing heats and other
tests."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.times.clocks import Named
from thermodata.errors import UsageError
from thermodata.plugin import Signal
from thermodata.schema.units.conversion import linear_conversion
from thermodata.schema.words.places import is_spindle
from thermodata.schema.words.sentences import listed

_WARMER_K = 3.0
_FEWEST = 3  # tests, of which the coolest tells what the machine at rest reads
_HEATED = ("axis.", "table", "rotary", "turret")
# what follows the air, and hardly the machine's work
_UNHEATED = ("hall", "floor", "fixture", "workpiece", "column", "bed", "crossbeam")


def warm_starts(tests: Mapping[str, Sequence[RawFile]], named: Mapping[int, Named]) -> dict[str, str]:
    """test -> what to ask of its start, where a part that the machine heats begins far above air and castings.

    tests: test -> its files. named: id of a file -> (stream, signal) -> (quantity, place, channel). Sensors have
    offsets, so the coolest start of all tests counts as at rest; without the air's temperature nothing is said.
    """
    above = {test: _above_the_rest(files, named) for test, files in tests.items()}
    found: dict[str, tuple[float, str]] = {}
    for part in {p for parts in above.values() for p in parts}:
        starts = {test: parts[part] for test, parts in above.items() if part in parts}
        rest = min(starts.values())
        for test, kelvin in starts.items() if len(starts) >= _FEWEST else ():
            if kelvin - rest > max(_WARMER_K, found.get(test, (0.0, ""))[0]):
                found[test] = (kelvin - rest, part)
    return _asked({t: found[t] for t in tests if t in found}, len(above))


def _asked(found: Mapping[str, tuple[float, str]], tests: int) -> dict[str, str]:
    """Of each test by how much which part is warmer, as questions. Where one part is so in most tests, it follows the
    air late after each night, or the machine was never cold: one answer holds for all of them, and it is asked once."""
    asked: dict[str, str] = {}
    for part in dict.fromkeys(part for _, part in found.values()):
        by = {test: kelvin for test, (kelvin, own) in found.items() if own == part}
        above = "K further above air and castings than in the coolest test"
        if 2 * len(by) <= tests:
            asked |= {test: f"start_state: warm? {part} begins {kelvin:.1f} {above}" for test, kelvin in by.items()}
            continue
        first, *others = by
        asked[first] = (
            f"start_state: warm? {part} begins {min(by.values()):.1f} to {max(by.values()):.1f} {above} here and in "
            f"{listed(others)}: warm in all of these where the machine had run before, not where {part} only follows "
            "the air late"
        )
    return asked


def _above_the_rest(files: Sequence[RawFile], named: Mapping[int, Named]) -> dict[str, float]:
    """Channel -> its first reading above those of what nothing heats [K], of the parts that the machine heats. Air lies
    in layers and castings lag behind it: within their range a part is as cold as they are."""
    heated: dict[str, _Begin] = {}
    unheated: dict[str, _Begin] = {}
    air = False
    for file in files:
        for signal in file.signals:
            quantity, at, channel = named.get(id(file), {}).get((signal.stream, signal.name), ("", None, ""))
            if quantity != "temperature" or not at or signal.scaling:
                continue
            begin = _Begin(file.start_ns or 0, _first_degrees(file, signal))
            air |= at.startswith("hall") and begin.degrees is not None
            if at.startswith(_UNHEATED):
                unheated[channel] = begin.or_earlier(unheated.get(channel))
            elif is_spindle(at) or at.startswith(_HEATED):
                heated[channel] = begin.or_earlier(heated.get(channel))
    around = [b.degrees for b in unheated.values() if b.degrees is not None]
    if not air or not around:
        return {}
    low, high = min(around), max(around)
    known = {c: b.degrees for c, b in heated.items() if b.degrees is not None}
    return {c: max(t - high, 0.0) + min(t - low, 0.0) for c, t in known.items()}


@dataclass(frozen=True, slots=True)
class _Begin:
    """Where a file of a channel begins. degrees: before its first row [degC], None where nobody looked at it: what a
    later part of the test reads first is no beginning of the test."""

    at_ns: int
    degrees: float | None

    def or_earlier(self, other: _Begin | None) -> _Begin:
        """Of the parts of a test the first one; without a clock, the one that was listed first."""
        return self if other is None or self.at_ns < other.at_ns else other


def _first_degrees(file: RawFile, signal: Signal) -> float | None:
    seen = file.sample.values.get((signal.stream, signal.name))
    if seen is None:
        return None
    try:
        factor, offset = linear_conversion(signal.unit or "degC", "degC")
    except UsageError:
        return None
    # what warms from row to row was warmed by this test, and cooler before
    return factor * (seen.first - max(seen.second - seen.first, 0.0)) + offset
