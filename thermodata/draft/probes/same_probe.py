"""Whose jump test it is: of the probe that is called as the one that moved, whatever stands before its name.

A logger calls its groups after their rates: 'Displacements_1Hz/Z' in the tests is 'Displacements_10Hz/Z' in the jump
test, which may have been recorded with another program, too.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from thermodata.draft.folder.into_sources.one_signal import joined_over_units
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.draft.probes.jumps import JumpTest
from thermodata.draft.signals.guess import guess_of
from thermodata.draft.words.naming import parts_of, words
from thermodata.reader.text import split_unit

PROBES = ("displacement", "voltage")


def own_name(signal: str) -> str:
    """What is left of a signal's name without its groups and its unit: 'z 1 tcp' of 'Fast/Z1 tcp [V]'."""
    return words(parts_of(split_unit(signal)[0])[-1]) or signal


def with_their_probes(jumps: Sequence[JumpTest], groups: Sequence[Group]) -> dict[str, list[JumpTest]]:
    """Source -> the jump tests of its probes, each under the name that the tests have for its probe."""
    found: dict[str, list[JumpTest]] = {g.source: [] for g in groups}
    for jump in jumps:
        home = next(g for g in groups if jump.file in g.calibrations)
        jump = replace(jump, source=home.source)
        others = _called_alike(jump, groups)
        if jump.signal is None or _has_probe(home, jump) or len(others) != 1:
            found[home.source].append(jump)
            continue
        ((source, probe),) = others
        found[source].append(replace(jump, signal=probe, written=jump.signal[1]))
    return found


def names_in_tests(groups: Iterable[Group]) -> set[str]:
    """The own names of all signals that tests have."""
    return {own_name(s.name) for g in groups for f in g.files for s in f.signals}


def _has_probe(group: Group, jump: JumpTest) -> bool:
    """Whether tests of this source have the probe under the very name that the jump test has for it."""
    return any(jump.is_of(s.stream, s.name) for f in group.files for s in f.signals)


def _called_alike(jump: JumpTest, groups: Sequence[Group]) -> list[tuple[str, tuple[str, str]]]:
    """(source, (stream, signal)) of the probes of tests whose own name is that of the one that moved."""
    if jump.signal is None:
        return []
    wanted = own_name(jump.signal[1])
    return [
        (g.source, (one.signal.stream, one.signal.name))
        for g in groups
        for one in joined_over_units(g.signals)
        if own_name(one.signal.name) == wanted
        and guess_of(one.signal).quantity in PROBES
        and any(f in g.files for f in one.files)
    ]
