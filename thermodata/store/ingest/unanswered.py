"""What a campaign file leaves open, or spells in a way that no effect knows: said with every ingest, for a diagnosis
that never tried the true effect looks like one that found none."""

from __future__ import annotations

from thermodata.errors import nearest
from thermodata.schema.campaign import Campaign
from thermodata.schema.places import PLACES, is_known

_PLACED = ("temperature", "rotational_speed", "feed", "power", "load", "current", "torque", "flow")
_SHOWN = 6


def unanswered(campaign: Campaign) -> list[str]:
    """Sentences for the summary of an ingest."""
    said = []
    for name, channel in campaign.channels.items():
        if channel.at and not is_known(channel.at):
            near = nearest(channel.at, [p for p in PLACES if "*" not in p])
            if near is not None:
                said.append(f"channel '{name}': no place '{channel.at}' is known; did you mean '{near}'?")
    nowhere = [n for n, c in campaign.channels.items() if c.at is None and c.quantity in _PLACED]
    if nowhere:
        said.append(
            f"without a place (at: ...): {_listed(nowhere)}; no effect that needs one there will be tried with them"
        )
    if campaign.tests and all(t.role == "none" for t in campaign.tests):
        said.append("no test has a role: write role: calibration, verification or locked, or name tests in the model")
    return said


def _listed(names: list[str]) -> str:
    return ", ".join(names[:_SHOWN]) + (f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else "")
