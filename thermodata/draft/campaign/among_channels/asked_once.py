"""Questions of the sources of one kind, as of loggers with a file a sensor: written out once, for one answer holds for
all of them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from thermodata.draft.campaign.parts import DraftSource
from thermodata.draft.folder.into_sources.sources import Group
from thermodata.schema.words.sentences import with_dots

_SHOWN = 4
_FIRST = re.compile(r"(?P<what>[^?;:(]+)[?:]")  # "timezone" of "timezone? it logs local times"


def asked_once(sources: Sequence[DraftSource], groups: Sequence[Group]) -> tuple[DraftSource, ...]:
    """The sources; of those with a file a sensor, the later ones refer to the first for what is asked in its words."""
    kinds = {g.source: g.reader for g in groups if g.files and all(f.sensor for f in g.files)}
    first: dict[tuple[str, str], str] = {}
    others: dict[tuple[str, str], list[str]] = {}
    for source in sources:
        for question in source.questions if source.name in kinds else ():
            key = kinds[source.name], question
            if _FIRST.match(question) is None:
                continue
            if first.setdefault(key, source.name) != source.name:
                others.setdefault(key, []).append(source.name)

    def told(source: DraftSource, question: str) -> str:
        key = kinds.get(source.name, ""), question
        if key not in others:
            return question
        if source.name in others[key] and (match := _FIRST.match(question)) is not None:
            return f"{match['what']}? as in '{first[key]}'"
        shown = with_dots(others[key], _SHOWN)
        return f"{question}; the same in each of {shown}"

    return tuple(replace(s, questions=tuple(told(s, q) for q in s.questions)) for s in sources)
