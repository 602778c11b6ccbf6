"""What texts beside the logs say of a clock that is slow or fast, with the offset that declares it: which sign that has
is what people guess wrong."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from pathlib import Path, PurePosixPath

from thermodata.draft.folder.beside.notes import text_of_notes
from thermodata.draft.folder.beside.numbers_in_words import in_digits
from thermodata.reader.text.tables.sample.zone_named import named_in

_AMOUNT = re.compile(
    r"(?P<by>\d+(?:[.,]\d+)?)\s*"
    r"(?P<unit>s|sec|seconds?|sekund\w*|second[ei]|min|minutes?|minut\w*|h|hours?|stund\w*|heures?|or[ae])\b",
    re.IGNORECASE,
)
# '2:30 min', '0:02:30 h', '3m05s' are one amount; what stands before '/day', or behind a stroke, a dash or 'bis', is
# none
_CLOCKED = re.compile(
    r"(?<![\d:.,/])(?P<a>\d{1,3}):(?P<b>[0-5]\d)(?::(?P<c>[0-5]\d))?\s*(?P<unit>h|hours?|stund\w*|std|min|minut\w*)\b",
    re.IGNORECASE,
)
_COMPACT = re.compile(r"(?<!\w)(?P<m>\d{1,3})\s?(?:m|'|′)\s?(?P<s>[0-5]?\d)\s?(?:s|\"|″|'')(?!\w)", re.IGNORECASE)
_PART = re.compile(
    r"(?:\d\s*[:/\-–]|\d\s+\d+/|\d[.,a-z]|±\s*|\d\s*(?:to|bis|or|oder|až|à|ou|a|o|and|und)\s*)$", re.IGNORECASE
)
_RATE = re.compile(
    r"\s*(?:/\s*|\b(?:pro|per|je|al|par|por|za|an?)\s+)(?:d|day|tag|h|hour|stunde|giorno|jour|d[ií]a|den|week|woche)\b",
    re.IGNORECASE,
)
_NO_AMOUNT = "part of something else"
_BEHIND = r"(?=\s*(?:$|[.,;)]|geg|vs\b))"  # 'vor' and 'nach' that lead to nothing: '5 min vor dem Start'
# what has a clock, or verbs that only clocks have: 'GL840 geht 2 min vor'
_CLOCK = (
    r"\b(?:clocks?|uhr|systemuhr|hodiny|horloge|orologio|reloj|\w*logger|recorder|enregistreur|registratore)\b"
    r"|\b(?:nc|cnc|plc|sps|pc|control|steuerungs?|system|machine|maschinen|logger)[- ]?(?:zeit|time)\b"
    rf"|\b(?:geht|ging|gehen)\b[^.;\n]*\d[^.;\n]*\b(?:vor|nach)\b{_BEHIND}|\bjd(?:e|ou)\s+o\b"
)
_OF_UHR = r"(?:uhr|zeit)\b[^.;\n]*\d\s*(?:s|sec|sek\w*|min\w*|h|std|stunden?)\s+"
_IN_SIGNS = {"時計": "clock", "遅れ": "slow", "進ん": "fast", "時間": "h", "分": "min", "秒": "s"}
_SLOW = (
    rf"slow|behind|{_OF_UHR}nach{_BEHIND}|(?:geht|ging|gehen)[^.;\n]*\bnach|"
    r"pozadu|zpozd\w+|retard|ritardo|indietro|atras\w+"
)
_FAST = (
    rf"fast|ahead|{_OF_UHR}vor{_BEHIND}|(?:geht|ging|gehen)[^.;\n]*\bvor|"
    r"napred|napřed|avance|anticipo|avanti|adelant\w+"
)
# what is not so, or no longer; and what is slow or fast of how often it measures
_NOT_SO = (
    r"\b(?:not|never|no longer|isn't|wasn't|nicht|nie|kein\w*|pas|non|no es|corrected|adjusted|reset|synchroni[sz]ed|"
    r"korrigiert|gestellt|synchronisiert|corrigée?|corretto|seřízen\w*)\b"
)
# ... but what was not put right is so still
_STILL = (
    r"\b(?:not|never|wasn't|isn't|nicht|nie|pas|non|no)\s+(?:\w+\s+){0,2}(?:corrected|adjusted|reset|"
    r"synchroni[sz]ed|korrigiert|gestellt|synchronisiert|corrigée?|corretto|seřízen\w*)\b"
)
_HOW_OFTEN = (
    r"\b(?:interval\w*|period\w*|sampl\w*|rate|abtast\w*|takt\w*)\b|"
    r"\b(?:every|alle|toutes les|ogni|cada|každ\w+)\s+\d"
)
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
    for sign, word in _IN_SIGNS.items():
        sentence = sentence.replace(sign, f" {word} ")
    sentence = in_digits(sentence.strip(" .;"))
    amounts = set(_amounts(sentence))
    slow, fast = (re.search(rf"\b(?:{some})\b", sentence, re.IGNORECASE) for some in (_SLOW, _FAST))
    of_clock = re.search(_CLOCK, sentence, re.IGNORECASE) is not None
    as_said = re.sub(_STILL, "", sentence, flags=re.IGNORECASE)
    if re.search(f"{_NOT_SO}|{_HOW_OFTEN}", as_said, re.IGNORECASE):
        return None
    if len(amounts) != 1 or _NO_AMOUNT in amounts or not of_clock or bool(slow) == bool(fast):
        return None
    return f"{'-' if fast else ''}{amounts.pop()}"


def _amounts(sentence: str) -> Iterator[str]:
    """The lengths of time that a sentence says, each of its parts: '12 min 50 s'."""
    sentence = _COMPACT.sub(lambda m: f"{m['m']} min {m['s']} s", _CLOCKED.sub(_spelled, sentence))
    parts: list[tuple[str, str]] = []
    end = 0
    for found in _AMOUNT.finditer(sentence):
        part = _PART.search(sentence[: found.start()]) or re.fullmatch(r"\d{1,3}[.,]\d{3}", found["by"])
        if part or _RATE.match(sentence[found.end() :]):
            yield _NO_AMOUNT
            continue
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


def _spelled(found: re.Match[str]) -> str:
    """'2 min 30 s' of '2:30 min', '1 h 5 min' of '1:05 h', '2 min 30 s' of '0:02:30 h'."""
    first = ("h", "min", "s") if found["c"] or found["unit"][0].lower() in "hs" else ("min", "s")
    said = [(int(n), u) for n, u in zip([found["a"], found["b"], found["c"]], first, strict=False) if n is not None]
    return " ".join(f"{n} {u}" for n, u in said if n) or "0 s"


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
