"""What is said of an MDF file whose blocks contradict each other, whichever block it is."""

from __future__ import annotations

from thermodata.errors import FormatError

_MEND = "copy it anew from where it was recorded, or save it anew as MDF 4 in the program that reads it"


def damaged(what: str, where: str, *, expected: str | None = None, got: str | None = None) -> FormatError:
    """The error; all of them are mended alike."""
    return FormatError(what, where=where, expected=expected, got=got, hint=_MEND)
