"""The tool of a test and whether coolant flowed, where a name, a note or the head of a log says so in words:
'toolA', 'Werkzeug: HSK63 D50', 'coolant off', 'ohne KSS', 'dry'."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence

from thermodata.draft.words.naming import without_marks

_Finds = Callable[[str], re.Match[str] | None]
_TOOL = (
    r"(?:tool|werkzeug|wkz|wz|nastroj|narzedzie|outil|herramienta|utensile|ferramenta|gereedschap|verktyg|takim|"
    r"刀具|工具)"
)
_COOLANT = (
    r"(?:coolant|kss|kuehlmittel|kuhlmittel|kuhlschmierstoff|kuehlschmierstoff|chladivo|chlazeni|kapalina|"
    r"chlodziwo|emulsion|emulsja|emulze|arrosage|refrigerante|taladrina|koelmiddel|koelvloeistof|kylvatska|"
    r"切削液|冷却液)"
)
_NUMBER = r"(?: ?(?:nr|no|num|number|id)\.?)?"
_START, _END = r"(?<![^\W_])", r"(?![^\W_])"
# in a name a tool is a letter or a number: 'tooling', 'tool change' are none
_NAMED_TOOL = re.compile(
    rf"(?i)(?<![^\W\d_]){_TOOL}{_NUMBER}(?: ?[-=:#] ?| )?(?P<id>[a-z]?\d{{1,4}}[a-z]?|[a-z]){_END}"
)
_TOLD_TOOL = re.compile(rf"(?i)^\W*{_TOOL}{_NUMBER}\s*[:=;,\t|]\s*[\"']?(?P<id>[^\s\"';,|][^\"';,|\t]{{0,40}})")
_ON = r"(?:on|yes|an|ein|ja|zap|zapnuto|ano|marche|oui|si|aan|tak|1|true|开)"
_OFF = r"(?:off|no(?!\. ?\d)|none|aus|nein|vyp|vypnuto|ne|arret|non|uit|nie|0|false|关|without|ohne|bez)"
_STATED = re.compile(rf"(?i){_START}{_COOLANT}\s*[-=:;,\t|]?\s*[\"']?(?:(?P<on>{_ON})|(?P<off>{_OFF})){_END}")
_BEFORE = re.compile(
    rf"(?i){_START}(?:(?P<off>wo|without|no|ohne|bez|sans|sin|senza|sem|zonder|utan|keine?)|"
    rf"(?P<on>with|mit|s|se|avec|con|com|met|med|z)) ?{_COOLANT}{_END}"
)
_CUT = re.compile(rf"(?i){_START}(?:(?P<off>dry|trocken|nasucho|a sec|seco|a secco)|(?P<on>wet|nass)){_END}")
# of a head: what its line is about, and no channel of it ('Kanal 2: KSS ein', 'coolant_on;0') or amount ('0.5 l/min')
_IN_HEAD = re.compile(
    rf"(?i)\W*{_COOLANT}(?:\s*[:=;,\t|]\s*[\"']?|\s+(?!(?:1|0|ein|aus|an|no){_END}))"
    rf"(?:(?P<on>{_ON})|(?P<off>{_OFF}))[\"']?(?=\W*$|\s*[,;|\t(](?!\s*\d+\W*$|\d))"
)


def tool_and_coolant(texts: Sequence[str]) -> dict[str, str]:
    """Conditions by the first text that says each: {'tool': 'A', 'coolant': 'off'}."""
    return _said(texts, (_TOLD_TOOL.match, _NAMED_TOOL.search), (_STATED.search, _BEFORE.search, _CUT.search))


def tool_and_coolant_of_head(lines: Sequence[str]) -> dict[str, str]:
    """The same by lines above the rows of a log, some of which name its channels: by those alone that begin with the
    tool or the coolant."""
    return _said(lines, (_TOLD_TOOL.match, _NAMED_TOOL.match), (_IN_HEAD.match,))


def _said(texts: Sequence[str], tools: Sequence[_Finds], states: Sequence[_Finds]) -> dict[str, str]:
    found: dict[str, str] = {}
    for text in texts:
        plain = without_marks(text).replace("_", " ").strip()
        if (told := _first(tools, plain)) is not None:
            name = told["id"].strip()
            found.setdefault("tool", name.upper() if len(name) == 1 else name)
        if (state := _first(states, plain)) is not None:
            found.setdefault("coolant", "on" if state["on"] else "off")
    return found


def _first(ways: Sequence[_Finds], text: str) -> re.Match[str] | None:
    return next((m for find in ways if (m := find(text)) is not None), None)
