"""What numeric times count from, where a line above the table says it: 'time: seconds since 2000-01-01', 'epoch:
2001-01-01T00:00:00Z', 'Time base: seconds since 01.01.2000', 'time scale: GPS'."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from thermodata.plugin import Array
from thermodata.reader.times.since import Zero, leaping, moment_in, since
from thermodata.reader.times.time_units import EPOCHS, SECONDS, is_logged

_MARKS = "#%;*'\"/!<> \t"
_LABEL = re.compile(
    r"(?i)^(?:time[ _-]?|zeit[ _-]?)?(?:epoch(?:[ _-]?(?:date|time|start))?|epoche|base|basis|"
    r"basis der zeit|origin|ursprung|nullpunkt|scale|skala)(?: of (?:the )?times?)?\s*(?:[:=]|\s(?=\d))\s*"
    r"(?P<value>\S.*)$"
)
_SCALE = re.compile(r"(?i)^(?P<scale>gps|tai|ntp|unix|posix|labview)\b")
_FROM_START_S = 2.8e8
_PLAIN = frozenset({"s", "min", "h", "d", "ms", "us", "ns"})
_BEHIND = {"s": "", "ms": "_ms", "us": "_us", "ns": "_ns"}


@dataclass(frozen=True, slots=True)
class SaidEpoch:
    """unit: of the count, None where the line leaves it to the column; zero: None where it names a scale; scale: `PTP`
    where that leaves it open; line: as it stands."""

    unit: str | None
    zero: Zero | None
    scale: str
    line: str

    def of(self, unit: str | None) -> str | None:
        """The unit with its epoch of a column of times in 's', 'min', ...; None where the two don't go together."""
        own = _plain_time_unit(unit) if unit is not None else self.unit
        if own is None or (self.unit is not None and own != self.unit):
            return None
        if self.zero is not None:
            return self.zero.unit(own)
        return f"{self.scale}{_BEHIND[own]}" if own in _BEHIND and f"{self.scale}{_BEHIND[own]}" in EPOCHS else None

    def fitting(self, unit: str | None, values: Array) -> str | None:
        """The same for times, shape (n,), that are of a year then that is logged; where nothing names their unit, in
        the only one in which they are, or in seconds if these began long before."""
        tried = [unit] if unit is not None or self.unit is not None else ["s", *sorted(_PLAIN - {"s"})]
        found = [full for one in tried if (full := self.of(one)) is not None and is_logged(values, full)]
        large = bool(values.size) and float(np.nanmin(values)) > _FROM_START_S
        return found[0] if len(found) == 1 or (found and large and found[0] == self.of("s")) else None

    def note(self, unit: str, by: str = "a line above the rows") -> str:
        return f"times count from a date by {by}: '{self.line[:60]}' ({unit})"

    def not_used(self, by: str = "the head") -> str:
        return (
            f"{by} says '{self.line[:60]}', by which the times are of no year that is logged, or of one in several "
            "units: not used; declare table: {time: {unit: ...}}"
        )


def epoch_said(lines: Iterable[Sequence[str]]) -> SaidEpoch | None:
    """What lines above a table, each as its cells, say that its times count from; None where they say nothing, or
    several things."""
    found: list[SaidEpoch] = []
    for cells in lines:
        filled = [c for c in cells if c.strip(_MARKS)]
        label = ": " if len(filled) == 2 and not filled[0].rstrip().endswith((":", "=")) else " "
        text = " ".join(label.join(filled).strip(_MARKS).split())
        if len(text) <= 200 and (said := _epoch_in(text)) is not None:
            found.append(said)
    return found[0] if len({(s.unit, s.zero, s.scale) for s in found}) == 1 else None


def _epoch_in(text: str) -> SaidEpoch | None:
    if (counted := since(text)) is not None:
        scale = leaping(text, counted[1])
        return SaidEpoch(*counted, "", text) if scale is None else SaidEpoch(counted[0], None, scale, text)
    match = _LABEL.match(text)
    if match is None:
        return None
    if (zero := moment_in(match["value"])) is not None:
        return SaidEpoch(None, zero, "", text)
    named = _SCALE.match(match["value"])
    return None if named is None else SaidEpoch(None, None, named["scale"].lower(), text)


def _plain_time_unit(unit: str) -> str | None:
    """'s' of 'Sekunden'."""
    seconds = SECONDS.get(unit.strip().lower())
    return next((u for u in _PLAIN if seconds is not None and SECONDS[u] == seconds), None)
