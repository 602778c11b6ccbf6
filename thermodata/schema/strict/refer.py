"""Refusals of a name that refers to nothing, and of a path that leads out of the campaign's folder."""

from __future__ import annotations

import re
from collections.abc import Collection
from pathlib import PurePosixPath, PureWindowsPath

from thermodata.errors import SpecError, nearest
from thermodata.schema.strict.lines import Document, Place

_FIELD = re.compile(r"\{([A-Za-z_]\w*)\}")


def must_be(kind: str, name: str, choices: Collection[str], document: Document, place: Place) -> None:
    """SpecError where the name is none of those declared."""
    if name in choices:
        return
    close = nearest(name, list(choices))
    raise SpecError(
        f"no {kind} '{name}'",
        where=document.where(place),
        expected="one of " + ", ".join(sorted(choices)) if choices else f"a {kind} declared in this file",
        got=name,
        hint=f"did you mean '{close}'?" if close else f"declare it, or correct the {kind}'s name",
    )


def inside(text: str, document: Document, place: Place) -> None:
    """Refuses a path that leaves the campaign's folder."""
    pure = PurePosixPath(text.replace("\\", "/"))
    if pure.is_absolute() or ".." in pure.parts or PureWindowsPath(text).drive:
        raise SpecError(
            "a path that leaves the campaign's folder",
            where=document.where(place),
            expected="a path below the folder of the campaign file",
            got=text,
            hint="move the file below the campaign file, or the campaign file above it",
        )


def only_known_fields(text: str, document: Document, place: Place) -> None:
    """SpecError for a field in braces that nothing fills: a pattern of a source knows {test} alone."""
    for field in _FIELD.findall(text):
        if field != "test":
            raise SpecError(
                f"nothing fills the field {{{field}}}",
                where=document.where(place),
                expected="{test}, which is the test's id, and * for what else varies",
                got=text,
                hint="did you mean {test}?"
                if nearest(field, ["test"])
                else "fields of another name belong to tests_from",
            )
