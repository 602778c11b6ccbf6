"""Units that are written out with their prefix: 'Micrometers', 'Millivolt', 'mVolts', 'kWatt'."""

from __future__ import annotations

import re

# LabVIEW and others write them out, one or many; lengths in their languages: 'micrometri', 'milímetros', 'mikrometr'
_PREFIX = {
    **{"nano": "n", "micro": "u", "mikro": "u", "milli": "m", "mili": "m", "centi": "c", "zenti": "c"},
    **{"kilo": "k", "mega": "M", "micró": "u", "milí": "m", "centí": "c", "nanó": "n"},
}
_WRITTEN_OUT = re.compile(
    rf"(?P<prefix>{'|'.join(_PREFIX)})(?:(?P<m>m[eè]t(?:ers?|ern|res?|ro|ri|ros|r))|(?P<V>volts?)|(?P<A>amp(?:[eè]re)?s?)|(?P<W>watts?)|"
    r"(?P<N>newtons?)|(?P<Pa>pascals?)|(?P<K>kelvins?)|(?P<ohm>ohms?)|(?P<rad>radians?))",
    re.IGNORECASE,
)
# loggers put the letter of a prefix before the word, where its case counts: mVolts and MVolts, mVDC, kWatt
_LETTER_FIRST = re.compile(
    r"(?P<prefix>[nuμmkM])(?i:(?P<V>volts?|v[ad]c)|(?P<A>amp(?:ere)?s?|a[ad]c)|(?P<W>watts?)|(?P<ohm>ohms?))"
)


def in_words(bare: str) -> str | None:
    """Pint's spelling of a unit without blanks whose prefix stands before a word; None where it is no such."""
    said = _WRITTEN_OUT.fullmatch(bare) or _LETTER_FIRST.fullmatch(bare)
    if said is None:
        return None
    prefix = said["prefix"]
    unit = next(k for k, v in said.groupdict().items() if v and k != "prefix")
    return (_PREFIX.get(prefix.lower()) or prefix.replace("μ", "u")) + unit
