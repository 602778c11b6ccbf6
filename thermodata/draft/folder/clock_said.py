"""What texts beside the logs say of a clock that is slow or fast, with the offset that declares it: which sign that has
is what people guess wrong."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from thermodata.draft.folder.notes import text_of_notes

_AMOUNT = r"(?P<by>\d+(?:[.,]\d+)?)\s*(?P<unit>s|sec|seconds?|sekund\w*|min|minutes?|minut\w*|h|hours?|stund\w*)\b"
_CLOCK = r"\b(?:clocks?|uhr|systemuhr|hodiny|horloge|orologio|reloj)\b"
_SLOW = r"slow|behind|(?:geht|ging|gehen)[^.;\n]*\bnach|pozadu|zpozd\w+|retard|ritardo|atras\w+"
_FAST = r"fast|ahead|(?:geht|ging|gehen)[^.;\n]*\bvor|napred|napřed|avance|anticipo|adelant\w+"
_UNITS = {"s": "s", "m": "min", "h": "h"}


def clocks_said(folder: Path, texts: Sequence[str]) -> list[str]:
    """A note on each line that says by how much a clock is wrong, and in which way."""
    found = []
    for path in texts:
        for line in text_of_notes(folder, path).splitlines():
            for sentence in re.split(r"(?<=[.;!])\s+", line):
                if (offset := offset_of(sentence)) is not None:
                    found.append(
                        f"{path} says '{sentence.strip(' .;')}': at the source of that clock, clock: "
                        f"{{offset: {offset}}}, for an offset is added to its times: that of a clock that is slow is "
                        "positive, of one that is ahead negative"
                    )
    return list(dict.fromkeys(found))


def offset_of(sentence: str) -> str | None:
    """'37 min' of a clock that is 37 min slow, '-37 min' of one that is fast; None where it is not said, or both."""
    amounts = re.findall(_AMOUNT, sentence, re.IGNORECASE)
    slow, fast = (re.search(rf"\b(?:{some})\b", sentence, re.IGNORECASE) for some in (_SLOW, _FAST))
    if len(set(amounts)) != 1 or not re.search(_CLOCK, sentence, re.IGNORECASE) or bool(slow) == bool(fast):
        return None
    by, unit = amounts[0]
    unit = "h" if unit.lower().startswith("st") else _UNITS[unit[0].lower()]
    return f"{'-' if fast else ''}{float(by.replace(',', '.')):g} {unit}"


__all__ = ["clocks_said", "offset_of"]
