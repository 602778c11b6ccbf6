"""The declared names of the columns of a file without a header."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.errors import FormatError


def declared_names(names: Sequence[str], width: int, where: str) -> list[str]:
    """What the columns of a file without a header are called."""
    if len(names) != width:
        raise FormatError(
            "a file without a header has other columns than are declared",
            where=where,
            expected=f"{len(names)} columns: {', '.join(names)}",
            got=f"{width} columns",
            hint="a source of its own for it, with table: {names: [...]} that names each of its columns",
        )
    return list(names)
