"""The tool of a test and whether coolant flowed, where a name, a note or the head of a log says so in words:
'toolA', 'Werkzeug: HSK63 D50', 'coolant off', 'ohne KSS', 'dry'."""

from __future__ import annotations

import re
from collections.abc import Sequence

from thermodata.draft.words.naming import without_marks

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
_OFF = r"(?:off|no|none|aus|nein|vyp|vypnuto|ne|arret|non|uit|nie|0|false|关|without|ohne|bez)"
_STATED = re.compile(rf"(?i){_START}{_COOLANT}\s*[-=:;,\t|]?\s*[\"']?(?:(?P<on>{_ON})|(?P<off>{_OFF})){_END}")
_BEFORE = re.compile(
    rf"(?i){_START}(?:(?P<off>wo|without|no|ohne|bez|sans|sin|senza|sem|zonder|utan|keine?)|"
    rf"(?P<on>with|mit|s|se|avec|con|com|met|med|z)) ?{_COOLANT}{_END}"
)
_CUT = re.compile(rf"(?i){_START}(?:(?P<off>dry|trocken|nasucho|a sec|seco|a secco)|(?P<on>wet|nass)){_END}")


def tool_and_coolant(texts: Sequence[str]) -> dict[str, str]:
    """Conditions by the first text that says each: {'tool': 'A', 'coolant': 'off'}."""
    found: dict[str, str] = {}
    for text in texts:
        plain = without_marks(text).replace("_", " ").strip()
        told = _TOLD_TOOL.match(plain) or _NAMED_TOOL.search(plain)
        if told is not None:
            name = told["id"].strip()
            found.setdefault("tool", name.upper() if len(name) == 1 else name)
        state = next((m for p in (_STATED, _BEFORE, _CUT) if (m := p.search(plain)) is not None), None)
        if state is not None:
            found.setdefault("coolant", "on" if state["on"] else "off")
    return found
