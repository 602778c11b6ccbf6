"""The designation of an amplifier and its channel at the head of a name: 'MX840_CH2 Weg Z' is 'Weg Z' for who reads it.

Its letters and numbers look like what a name says, an axis X in MX, and mean the rack only.
"""

from __future__ import annotations

import re

from thermodata.draft.words.naming import words
from thermodata.draft.words.vocabulary import places_in, quantities_in

_CHANNEL = r"CH[ _]?\d+(?![^\W_])[ _:.-]*"
_HEAD = re.compile(rf"([^\W\d_]{{2,}}\d{{2,}}[^\W\d_]?)[ _-]+(?:\d+[ _-]+)?{_CHANNEL}", re.IGNORECASE)


def without_amplifier(name: str) -> str:
    """A name without the designation at its head, '' where nothing else stands in it. What says more than a rack,
    'Pt100_CH2' or 'Lager01_CH2', stays."""
    match = _HEAD.match(name.lstrip())
    if match is None:
        return name
    said = words(match[1])
    # a side alone is no place: 'dx' of DX100 is right in Italian
    speaks = "temperature" in quantities_in(said) or places_in(said) - {"left", "right"}
    return name if speaks else name.lstrip()[match.end() :]
