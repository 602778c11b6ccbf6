"""What the beginnings and ends of a campaign's logs say of their clocks, and of what is known at the end of a test."""

from __future__ import annotations

from thermodata.schema.files.campaign import Campaign
from thermodata.store.ingest.told.clocks.beside_each_other import odd_clocks
from thermodata.store.ingest.told.clocks.ends import Rows, with_lengths, with_pauses
from thermodata.store.ingest.told.clocks.ends_apart import ends_apart
from thermodata.store.ingest.told.clocks.offset_apart import offsets_apart
from thermodata.store.ingest.told.clocks.whole_hours import whole_hours


def how_logs_stand(campaign: Campaign, sources: Rows, events: Rows, files: Rows) -> list[str]:
    """A sentence each. sources, events, files: test -> its rows of the tables `source`, `quality_event` and `file`, of
    all tests."""
    rows = with_lengths(with_pauses(sources, events), files)
    clocks = {t.id: t.clocks for t in campaign.tests}
    # what logs the displacement: another log is whole where it lasts as long as that
    probes = {c.source for c in campaign.channels.values() if c.quantity == "displacement" and c.source}
    said_of = {n for n, s in campaign.sources.items() if s.clock.offset is not None or s.clock.align_to is not None}
    declared = {test: said_of.union(own) for test, own in clocks.items()}
    hours = [one for one in whole_hours(rows, declared) if {one.late, one.early} & probes]
    offsets = {name: by_s for name, s in campaign.sources.items() if (by_s := s.clock.offset)}
    begun = {t.id for t in campaign.tests if t.start is not None}
    dated = {test: [{**r, "clock": "absolute"} if test in begun else r for r in own] for test, own in rows.items()}
    moved, odd = offsets_apart(dated, offsets), odd_clocks(rows)
    otherwise = {test for one in odd for test in one.tests}
    whole = {t.id: rows[t.id] for t in campaign.tests if t.window is None and t.id not in otherwise}
    apart = [] if hours or moved else ends_apart(whole, probes)  # logs whole hours apart do not end early
    return [*map(str, moved), *map(str, hours), *(said for one in odd for said in one.beside(clocks)), *apart]
