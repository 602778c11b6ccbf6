"""Calibration tests that a model was not fitted to, for they came after it, or their role did: it is not stale by them,
and a fit takes them in."""

from __future__ import annotations

from thermodata.store.base.connection import fetch
from thermodata.store.catalogue.models.fits import StoredModel
from thermodata.store.catalogue.store import Store

# of tests that the fit knew and has no errors of
_KNOWN = ("skipped:", "not_predicted:", "not_scored:")


def came_after(store: Store, stored: StoredModel) -> list[str]:
    """campaign/test, in the order of the store: what the model's roles calibrate on now, with data, and its fit did
    not know."""
    spec = stored.spec
    known = {f"{s.campaign}/{s.test}" for s in stored.result.scores}
    known |= {c.name.split(":")[1] for c in stored.result.checks if c.name.startswith(_KNOWN)}
    with store.reader() as con:
        rows = fetch(
            con,
            "select campaign, test, role from test where list_contains(?, campaign) and exists (select 1 from file f "
            "where f.campaign = test.campaign and f.test = test.test and f.layer = 'tidy') order by rowid",
            [list(spec.campaign_ids)],
        )
    elsewhere = {*(spec.verify_on or ()), *(spec.locked or ())}

    def calibrates(test: str, full: str, role: str) -> bool:
        if spec.calibrate_on is not None:
            return bool({test, full} & {*spec.calibrate_on})
        return role == "calibration" and not {test, full} & elsewhere

    of = {f"{r['campaign']}/{r['test']}": r for r in rows}
    return [full for full, r in of.items() if full not in known and calibrates(r["test"], full, r["role"])]
