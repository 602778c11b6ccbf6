"""Logs that stand elsewhere beside each other in some tests than in most: told with the answer, as at ingest.

Nothing is moved for it: the ends of two logs say that one of two clocks is off, and not which.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from thermodata.schema.diagnosis import Artefact

if TYPE_CHECKING:
    from collections.abc import Sequence

    from thermodata.modelling.run import Loaded
    from thermodata.store import Store


def odd_ends(store: Store, model: Loaded, told: Sequence[Artefact]) -> list[Artefact]:
    """Of the tests of a model, but for those whose clock is told already. told: the faults that the answer has."""
    from thermodata.store.ingest.beside_each_other import odd_clocks

    here = {(t.campaign, t.test) for t in model.data.tests}
    known = {(a.campaign, a.test) for a in told if a.kind == "clock_offset"}
    declared = {
        (t.campaign, t.test, c.source) for t in model.data.tests for c in t.channels.values() if c.clock_declared
    }
    return [
        Artefact(
            kind="clock_offset",
            campaign=campaign,
            test=test,
            at_s=None,
            size_um=None,
            why=f"{odd}. Nothing was moved for it here",
        )
        for campaign in sorted({c for c, _ in here})
        for odd in odd_clocks(_sources(store, campaign))
        for test in odd.tests
        if (campaign, test) in here - known
        and declared.isdisjoint((campaign, test, source) for source in (odd.late, odd.early))
    ]


def _sources(store: Store, campaign: str) -> dict[str, list[dict[str, object]]]:
    """Test -> its rows of the table `source`."""
    found: dict[str, list[dict[str, object]]] = {}
    with store.reader() as con:
        rows = con.execute(
            "select test, source, start_ns, step_s, rows from source where campaign = ? order by rowid", [campaign]
        ).fetchall()
    for test, source, start_ns, step_s, count in rows:
        found.setdefault(test, []).append({"source": source, "start_ns": start_ns, "step_s": step_s, "rows": count})
    return found
