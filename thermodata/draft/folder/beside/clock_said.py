"""What texts beside the logs say of a clock that is slow or fast, with the offset that declares it: which sign that has
is what people guess wrong."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path, PurePosixPath

from thermodata.draft.folder.beside.notes import text_of_notes
from thermodata.reader.text.tables.sample.zone_named import named_in

_AMOUNT = re.compile(
    r"(?P<by>\d+(?:[.,]\d+)?)\s*"
    r"(?P<unit>s|sec|seconds?|sekund\w*|second[ei]|min|minutes?|minut\w*|h|hours?|stund\w*|heures?|or[ae])\b",
    re.IGNORECASE,
)
_CLOCK = r"\b(?:clocks?|uhr|systemuhr|hodiny|horloge|orologio|reloj)\b"
_SLOW = r"slow|behind|(?:geht|ging|gehen)[^.;\n]*\bnach|pozadu|zpozd\w+|retard|ritardo|indietro|atras\w+"
_FAST = r"fast|ahead|(?:geht|ging|gehen)[^.;\n]*\bvor|napred|napřed|avance|anticipo|avanti|adelant\w+"
_SHOWN = 80  # letters of a sentence
_LONGEST = 600  # letters of a sentence that says it: the patterns take the square of them
_UNITS = {"s": "s", "m": "min", "h": "h", "o": "h"}
_LENGTHS = ("h", "min", "s")  # the parts of an amount, in their order
_ABOUT = re.compile(r"\b(env|ca|cca|approx|circ|abt|ungef|etw|asi|aprox)\.", re.IGNORECASE)  # whose dot ends nothing


def clocks_said(folder: Path, texts: Sequence[str]) -> list[str]:
    """A note on each line that says by how much a clock is wrong, and in which way."""
    found = []
    for path in texts:
        for line in text_of_notes(folder, path).splitlines():
            for sentence in re.split(r"(?<=[.;!])\s+", _ABOUT.sub(r"\1", line)):
                if (offset := offset_of(sentence)) is not None:
                    found.append(
                        f"{path} says '{sentence.strip(' .;')}': at the source of that clock, clock: "
                        f"{{offset: {offset}}}, for an offset is added to its times: that of a clock that is slow is "
                        "positive, of one that is ahead negative"
                    )
    return list(dict.fromkeys(found))


def offset_of(sentence: str) -> str | None:
    """'37 min' of a clock that is 37 min slow, '-37 min' of one that is fast; None where it is not said, or both."""
    if len(sentence) > _LONGEST:
        return None
    amounts = set(_amounts(sentence))
    slow, fast = (re.search(rf"\b(?:{some})\b", sentence, re.IGNORECASE) for some in (_SLOW, _FAST))
    if len(amounts) != 1 or not re.search(_CLOCK, sentence, re.IGNORECASE) or bool(slow) == bool(fast):
        return None
    return f"{'-' if fast else ''}{amounts.pop()}"


def _amounts(sentence: str) -> Iterator[str]:
    """The lengths of time that a sentence says, each of its parts: '12 min 50 s'."""
    parts: list[tuple[str, str]] = []
    end = 0
    for found in _AMOUNT.finditer(sentence):
        word = found["unit"].lower()
        unit = "h" if word.startswith("st") else _UNITS[word[0]]
        goes_on = parts and re.fullmatch(r"\s*(?:e|et|und|and|y|a|,)?\s*", sentence[end : found.start()], re.IGNORECASE)
        if parts and not (goes_on and _LENGTHS.index(unit) > _LENGTHS.index(parts[-1][1])):
            yield " ".join(map(" ".join, parts))
            parts = []
        parts.append((f"{float(found['by'].replace(',', '.')):g}", unit))
        end = found.end()
    if parts:
        yield " ".join(map(" ".join, parts))


def zone_said(folder: Path, logs: Collection[PurePosixPath]) -> str:
    """How the question of a zone goes on where a text beside the logs says which zone a clock stands in: 'Uhr: MEZ
    (keine Sommerzeit)'; '' where none does, or several say others."""
    found: dict[str, str] = {}
    for path in sorted(p for p in folder.iterdir() if p.is_file() and not p.is_symlink()):
        name = PurePosixPath(path.name)
        for line in [] if name in logs else text_of_notes(folder, path.name).splitlines():
            for sentence in re.split(r"(?<=[.;!])\s+", _ABOUT.sub(r"\1", line)):
                if re.search(_CLOCK, sentence, re.IGNORECASE) and (named := named_in([sentence])) is not None:
                    found.setdefault(
                        named[0], f"; {name} says '{sentence.strip(' .;')[:_SHOWN]}': timezone: {named[0]}?"
                    )
    return next(iter(found.values())) if len(found) == 1 else ""


__all__ = ["clocks_said", "offset_of", "zone_said"]
