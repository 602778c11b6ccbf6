"""A file that is wanted of the raw layer, for a source of a test or for a jump test."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from thermodata.plugin import Source
from thermodata.schema.files.campaign import SourceSpec
from thermodata.store.ingest.told.losses import FileRead
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.raw.streams import declared


@dataclass(frozen=True, slots=True)
class WantedFile:
    """path: as the campaign file has it. asker: the test, or 'calibration' with its name. kept_as: test and source of
    its rows in the store. before: what the store holds of it already. gone: it is not there any more."""

    path: str
    source: str
    spec: SourceSpec
    asker: str
    kept_as: tuple[str, str]
    before: Sequence[RawStream]
    gone: bool

    @property
    def declaration(self) -> Source:
        """What its reader is told of it."""
        return declared(self.source, self.spec)

    @property
    def as_read(self) -> FileRead:
        """As losses name it."""
        return FileRead(self.asker, self.source, self.path)
