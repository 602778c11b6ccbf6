"""What numeric times count from, where a line above the table says it: 'time: seconds since 2000-01-01', 'epoch:
2001-01-01T00:00:00Z', 'Time base: seconds since 01.01.2000', 'time scale: GPS'."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from thermodata.reader.since import Zero, moment_in, since
from thermodata.reader.time_units import EPOCHS, SECONDS

_MARKS = "#%;*'\"/!<> \t"
_LABEL = re.compile(
    r"(?i)^(?:time[ _-]?|zeit[ _-]?)?(?:epoch(?:[ _-]?(?:date|time|start))?|epoche|base|basis|"
    r"basis der zeit|origin|ursprung|nullpunkt|scale|skala)(?: of (?:the )?times?)?\s*(?:[:=]|\s(?=\d))\s*"
    r"(?P<value>\S.*)$"
)
_SCALE = re.compile(r"(?i)^(?P<scale>gps|tai|ntp|unix|posix|labview)\b")
# scales that count leap seconds, and where they begin; clocks that go by PTP count these or UTC
PTP = "ptp"
_LEAPING = re.compile(r"(?i)(?<![a-z])(?:(?P<tai>tai)|(?P<gps>gps)|(?P<ptp>ptp))(?![a-z])")
_ZERO_S = {"tai": 0, "gps": 315_964_800, PTP: 0}
_UTC = re.compile(r"(?i)(?<![a-z])(?:utc|gmt|unix|posix)(?![a-z])|\d\s*z(?![a-z])")
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
        own = _plain(unit) if unit is not None else self.unit
        if own is None or (self.unit is not None and own != self.unit):
            return None
        if self.zero is not None:
            return self.zero.unit(own)
        return f"{self.scale}{_BEHIND[own]}" if own in _BEHIND and f"{self.scale}{_BEHIND[own]}" in EPOCHS else None

    def note(self, unit: str) -> str:
        return f"times count from a date by a line above the rows: '{self.line[:60]}' ({unit})"

    def not_used(self) -> str:
        return (
            f"the head says '{self.line[:60]}', by which the times are of no year that is logged: not used; declare "
            "table: {time: {unit: ...}}"
        )


def epoch_said(lines: Iterable[Sequence[str]]) -> SaidEpoch | None:
    """What lines above a table, each as its cells, say that its times count from; None where they say nothing, or
    several things."""
    found: list[SaidEpoch] = []
    for cells in lines:
        text = " ".join(" ".join(cells).strip(_MARKS).split())
        if len(text) > 200 or (said := _said(text)) is None:
            continue
        found.append(said)
    return found[0] if len({(s.unit, s.zero, s.scale) for s in found}) == 1 else None


def _said(text: str) -> SaidEpoch | None:
    if (counted := since(text)) is not None:
        leaping = _leaping(text, counted[1])
        return SaidEpoch(*counted, "", text) if leaping is None else SaidEpoch(counted[0], None, leaping, text)
    match = _LABEL.match(text)
    if match is None:
        return None
    if (zero := moment_in(match["value"])) is not None:
        return SaidEpoch(None, zero, "", text)
    scale = _SCALE.match(match["value"])
    return None if scale is None else SaidEpoch(None, None, scale["scale"].lower(), text)


def _leaping(text: str, zero: Zero) -> str | None:
    """'tai' of 'PTP (TAI), ns since 1970-01-01': the scale with leap seconds that a count from its zero is said to be
    of; None where the text says UTC, too, or another zero."""
    named = {str(m.lastgroup) for m in _LEAPING.finditer(text)}
    fitting = [scale for scale in _ZERO_S if scale in named and _ZERO_S[scale] == zero.zero_s]
    return fitting[0] if fitting and _UTC.search(text) is None else None


def _plain(unit: str) -> str | None:
    """'s' of 'Sekunden'."""
    seconds = SECONDS.get(unit.strip().lower())
    return next((u for u in _PLAIN if seconds is not None and SECONDS[u] == seconds), None)
