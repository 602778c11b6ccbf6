"""What a test consists of: which raw streams, and which channel is which signal of which stream."""

from __future__ import annotations

from dataclasses import dataclass, field

from thermodata.plugin import Signal
from thermodata.schema.files.campaign import Campaign, Channel, SourceSpec, Test
from thermodata.schema.units.quantity import MEASURED, PROBED
from thermodata.store.raw.raw_stream import RawStream
from thermodata.store.tidy.rows.in_parts import InPart
from thermodata.store.tidy.rows.on_change import step_beside

SCHEDULE = "schedule"


@dataclass(frozen=True, slots=True)
class Bound:
    """A channel of a test and where its values come from. signal is None for derived and scheduled channels;
    unit: of the raw signal, as declared or as the file says. on_change: whether its rows show that they were written
    when something changed."""

    name: str
    channel: Channel
    source: str
    stream: str
    signal: Signal | None = None
    unit: str | None = None
    on_change: bool = False

    @property
    def is_text(self) -> bool:
        return self.channel.quantity == "label"

    @property
    def is_held(self) -> bool:
        """Whether its log is written on change. What a model explains is never made up between two rows."""
        return self.channel.held if self.channel.held is not None else self._by_file or self.on_change

    @property
    def is_said(self) -> bool:
        """Whether the campaign file or the log itself says whether it is held."""
        return self.channel.held is not None or self._by_file

    @property
    def _by_file(self) -> bool:
        return self.signal is not None and self.signal.held and self.channel.quantity not in MEASURED


@dataclass(slots=True)
class SourcePlan:
    """The raw streams that a source contributes to a test, and what is known about its files. parts: see `in_parts`."""

    name: str
    spec: SourceSpec
    raws: list[RawStream] = field(default_factory=list)
    shared: bool = False
    parts: dict[tuple[str, str], InPart] = field(default_factory=dict)

    @property
    def is_dated(self) -> bool:
        """Whether a file says when it was recorded."""
        return not all(raw.is_undated for raw in self.raws)

    @property
    def streams(self) -> dict[str, list[RawStream]]:
        streams: dict[str, list[RawStream]] = {}
        for raw in self.raws:
            streams.setdefault(raw.stream, []).append(raw)
        return streams


@dataclass(slots=True)
class TestPlan:
    """A test with its sources and its channels. problems: what could not be bound, for the summary."""

    __test__ = False
    campaign: Campaign
    test: Test
    sources: dict[str, SourcePlan] = field(default_factory=dict)
    bound: dict[str, Bound] = field(default_factory=dict)
    problems: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    def members(self) -> dict[tuple[str, str], list[Bound]]:
        """(source, stream) -> its channels, in the campaign's order."""
        members: dict[tuple[str, str], list[Bound]] = {}
        for bound in self.bound.values():
            members.setdefault((bound.source, bound.stream), []).append(bound)
        return members

    @property
    def reference(self) -> list[SourcePlan]:
        """The sources whose beginning is the beginning of the recording: those that carry displacements.

        A control's or a hall logger's clock may be hours off, and its log may run for days; the probes' record
        is what the test is about. Where no source carries displacements, all of them count; and where those that do
        run through many tests, as a table of all results does, what has a file of this test tells when it was."""
        with_data = [s for s in self.sources.values() if s.raws]
        chosen = [s for s in with_data if s.name in self._of_displacements] or with_data
        alone = self.test.window is not None or len(self.campaign.tests) < 2
        if alone or not all(s.shared and s.is_dated for s in chosen):
            return chosen
        return [s for s in with_data if not s.shared and s.is_dated] or chosen

    def step_beside(self, bound: Bound) -> int:
        """The time between rows of the densest log beside that of a channel [ns]; 0 where none is much denser."""
        every = {(s.name, stream): raws for s in self.sources.values() for stream, raws in s.streams.items()}
        return step_beside(every, (bound.source, bound.stream))

    @property
    def _of_displacements(self) -> set[str]:
        return {
            b.source for b in self.bound.values() if b.signal is not None and b.channel.quantity in PROBED
        } | self.campaign.begun_by

    @property
    def cut_by(self) -> list[str]:
        """The sources that tell when the test was, where the displacements run through many tests; else none."""
        return [s.name for s in self.reference if self._of_displacements and s.name not in self._of_displacements]
