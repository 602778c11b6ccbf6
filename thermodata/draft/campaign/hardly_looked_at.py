"""Files that the time for a folder did not suffice for: what is told of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from thermodata.draft.files.raw_file import RawFile
from thermodata.schema.words.sentences import counted


def hardly_looked_at(logs: Sequence[RawFile]) -> Iterator[str]:
    """What is told of files for which there was no time, or not enough."""
    if like := [f for f in logs if f.like]:
        yield (
            f"{counted(len(like), 'file', 'was', 'were')} not opened (the folder's time was up): taken to be like "
            f"others of their name, e.g. {like[0].path} like {like[0].like}"
        )
    if unseen := [f for f in logs if not (f.like or f.sample.whole or f.sample.rows or f.sample.losses)]:
        yield (
            f"{counted(len(unseen), 'file', 'was', 'were')} opened, and no values looked at (the folder's time was "
            f"up): their tests are drafted from their names alone, e.g. {unseen[0].path}; check these lines"
        )
    if hurried := [f for f in logs if f.sample.hurried]:
        yield (
            f"{counted(len(hurried), 'file', 'was', 'were')} looked at in the first rows only (the time for each was "
            f"up): what their tests did later is not in this draft, e.g. {hurried[0].path} after "
            f"{counted(hurried[0].sample.rows, 'row')}; check these lines"
        )
