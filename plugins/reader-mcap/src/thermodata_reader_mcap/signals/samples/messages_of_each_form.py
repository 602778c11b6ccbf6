"""Some messages of a topic that show all arrays which its messages hold, also those that come late, or seldom."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence

_ARRAY = re.compile(rb'"((?:[^"\\]|\\.)*)"\s*:\s*\[\s*[^\]\s]')  # a key and an array that is not empty


def messages_of_each_form(payloads: Sequence[bytes], many: int) -> list[int]:
    """The places of the first messages in JSON, and of the first that hold an array called each name, so many of
    both."""
    met = Counter[bytes]()
    chosen: list[int] = []
    for place, payload in enumerate(payloads):
        names = set(_ARRAY.findall(payload)) if b"[" in payload else set[bytes]()
        if place < many or any(met[name] < many for name in names):
            chosen.append(place)
            met.update(names)
    return chosen
