"""Tests whose logs have a channel already in its unit, where others have volts: a program that scaled from some day on.
A calibration that takes volts is not theirs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from thermodata.draft.campaign.parts import DraftChannel, DraftJump, OwnChannel
from thermodata.draft.files.raw_file import RawFile
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.signals.units import converts
from thermodata.draft.times.clocks import Named
from thermodata.schema.units.conversion import converts as converts_to

_AS_IT_STANDS: Mapping[str, object] = {"calibration": []}


def own_calibrations(
    groups: Sequence[Group],
    keyed: Mapping[str, Named],
    channels: Sequence[DraftChannel],
    jumps: Sequence[DraftJump],
) -> dict[str, dict[str, OwnChannel]]:
    """Test -> channel -> what it is there: without the calibration of the others. keyed: source -> its channels, by
    (stream, signal) of the files."""
    jump_files = {j.name: j.file for j in jumps}
    found: dict[str, dict[str, OwnChannel]] = {}
    for channel in channels:
        quantity = channel.said.quantity
        if quantity is None or channel.said.unit is not None:
            continue
        group = next(g for g in groups if g.source == channel.source)
        in_tests, in_files = _units(channel.name, group, keyed[channel.source])
        raw = [u for u in in_files.values() if not converts(u, quantity)]
        taken = in_files.get(jump_files.get(channel.calibration or "", ""), raw[0] if raw else None)
        for test, unit in in_tests.items():
            if taken is not None and converts(unit, quantity) and not converts_to(unit, taken):
                found.setdefault(test, {})[channel.name] = OwnChannel(_AS_IT_STANDS, _asked(channel, unit, taken))
    return found


def _units(channel: str, group: Group, named: Named) -> tuple[dict[str, str], dict[str, str]]:
    """(test -> the unit that its logs state of a channel, path of each log -> the one that it states)."""

    def unit_in(file: RawFile) -> str | None:
        own = (s.unit for s in file.signals if (k := (s.stream, s.name)) in named and named[k][2] == channel)
        return next(filter(None, own), None)

    in_files = {str(f.path): unit for f in (*group.files, *group.calibrations) if (unit := unit_in(f))}
    in_tests = {t: unit for t, fs in group.tests.items() if (unit := next(filter(None, map(unit_in, fs)), None))}
    return in_tests, in_files


def _asked(channel: DraftChannel, unit: str, taken: str) -> str:
    said = f"{channel.name} is in {unit} here, and in {taken} elsewhere: taken without the calibration of the others"
    if channel.said.quantity != "displacement":
        return said
    return f"{said}; which way does it count? in place of [] a calibration (kind: scale) that takes {unit}"
