"""What one line of notes says of several tests: 'P1, P2: calibration; P3: verification', and of their roles without a
colon too: 'P1, P2 calibration, P3 verification.'"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from thermodata.draft.words.roles import said_by_list

_MARKS = " \t-*•#>"
_BETWEEN = re.compile(r"\s*[,&+/、和及]\s*|\s+(?:and|und|en|et|e|y|i|a|og|och)\s+", re.IGNORECASE)
_NAME = r"[^\s,;:&+/、和及]+"  # without what stands between names: a text can be parted in one way only
# names with what stands between them, at the end of a text
_NAMES = re.compile(rf"{_NAME}(?:(?:{_BETWEEN.pattern}){_NAME})*\s*$", re.IGNORECASE)
_ENDS = ".;,|。；，–-"  # what may stand before the next names
_TRIM = " \t;,.。；，=-–"


def statements(line: str, called: Mapping[str, str]) -> list[tuple[str, str]]:
    """(test, what is said of it), where a line names several tests, each with a colon behind it or behind them all;
    empty for a line of one. called: name in small letters -> test."""
    text = line.strip().strip(_MARKS)
    return _behind_colons(text, called) or _roles(text, called)


def _roles(text: str, called: Mapping[str, str]) -> list[tuple[str, str]]:
    """Of names with a role behind them, of which one may stand behind several names."""
    found: list[tuple[str, str]] = []
    waiting: list[str] = []
    for piece in _parts(text):
        name, _, rest = piece.partition(" ")
        test = called.get(name.casefold())
        waiting = [*waiting, test] if test is not None else []
        if rest.strip():
            is_role = said_by_list({"": rest}) is not None
            found += [(one, rest.strip()) for one in waiting if is_role]
            waiting = []
    return found if len({test for test, _ in found}) > 1 else []


def _parts(text: str) -> Iterator[str]:
    """What stands between the marks and the words between names."""
    for sentence in re.split(r"[.;。；](?:\s+|$)", text):
        yield from (piece.strip(" \t'\"`") for piece in _BETWEEN.split(sentence) if piece.strip())


def _behind_colons(text: str, called: Mapping[str, str]) -> list[tuple[str, str]]:
    heads: list[tuple[int, int, list[str]]] = []
    for colon in re.finditer(r"[:：]", text):
        begin = heads[-1][1] if heads else 0
        names = _NAMES.search(text[begin : colon.start()])
        if names is None:
            continue
        # of what stands there the last words that are all names
        found, at = list[str](), begin + names.start()
        pieces = _pieces(names[0])
        while pieces and pieces[-1][1] in called:
            offset, name = pieces.pop()
            found.insert(0, called[name])
            at = begin + names.start() + offset
        before = text[:at].rstrip()
        if found and (not before or before[-1] in _ENDS):
            heads.append((at, colon.end(), found))
    if sum(len(tests) for _, _, tests in heads) < 2:
        return []
    ends = [at for at, _, _ in heads[1:]] + [len(text)]
    said = [(tests, text[behind:end].strip(_TRIM)) for (_, behind, tests), end in zip(heads, ends, strict=True)]
    return [(test, rest) for tests, rest in said if rest for test in tests]


def _pieces(names: str) -> list[tuple[int, str]]:
    """(where it stands, name in small letters) of names with something between them."""
    found, at = [], 0
    for between in [*_BETWEEN.finditer(names), None]:
        end = len(names) if between is None else between.start()
        found.append((at, names[at:end].strip(" '\"`").casefold()))
        at = end if between is None else between.end()
    return found
