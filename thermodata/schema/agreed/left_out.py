"""Files that a draft leaves out and why, as comments at the end of a campaign file; who writes and reads them shares
this."""

from __future__ import annotations

from collections.abc import Collection

from thermodata.schema.words.sentences import with_count

NOT_USED = "# not used: "
CANT_READ = "claims it and can't read it"
_SHOWN = 6


def left_out(path: str, why: str) -> str:
    """The comment, on one line. path: of the file; why: it is not used."""
    return f"{NOT_USED}{path}: {why}"


def left_out_for_a_fault(text: str, used: Collection[str]) -> str | None:
    """What an ingest says of the files that a draft left out because their reader failed; None where there are none.
    text: of the campaign file; used: paths of the files of all tests, which somebody may have mended."""
    found = [line.removeprefix(NOT_USED) for line in text.splitlines() if line.startswith(NOT_USED)]
    paths = [line.partition(": ")[0] for line in found if CANT_READ in line]
    left = [path for path in paths if path not in used]
    if not left:
        return None
    shown = with_count(left, _SHOWN)
    them = "them" if len(left) > 1 else "it"
    return (
        f"in no test, for the draft could not read {them}: {shown}; the end of the campaign file says why: mend it and "
        "draft again, or delete the line there"
    )
