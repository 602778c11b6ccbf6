"""Archives that end without their end mark, as of a logger that was switched off."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path

from thermodata.archive.members import archive_of, is_archive, listed
from thermodata.errors import FormatError
from thermodata.store.ingest.told.losses import Losses, loss_row


def cut_archives(paths: Iterable[str], full: Callable[[str], Path]) -> Losses:
    """A loss for each archive that a file is read from and behind whose last one more may have stood. paths: of the
    source files; full: where one stands on the disk."""
    found: Losses = []
    asked: set[Path] = set()
    for path in paths:
        inside = archive_of(full(path))
        archive = full(path) if inside is None else inside[0]
        if archive in asked:
            continue
        asked.add(archive)
        with suppress(FormatError, OSError):
            lost = listed(archive).lost if inside is not None or is_archive(archive) else None
            if lost is not None:
                named = path if inside is None else path.removesuffix(f"/{inside[1]}")
                found.append(loss_row(lost, file=named))
    return found
