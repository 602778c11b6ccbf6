"""What a campaign file leaves open, or spells in a way that no effect knows: said with every ingest, for a diagnosis
that never tried the true effect looks like one that found none."""

from __future__ import annotations

from collections.abc import Sequence

from thermodata.schema.files.campaign import Campaign
from thermodata.schema.files.campaign_channels import Calibration, Channel
from thermodata.schema.units.conversion import converts
from thermodata.schema.units.quantity import PROBED
from thermodata.schema.words.places import called_here, is_known, nearest_place
from thermodata.schema.words.sentences import with_count

_PLACED = ("temperature", "rotational_speed", "feed", "power", "load", "current", "torque", "flow")
_SHOWN = 6


def unanswered(campaign: Campaign) -> list[str]:
    """Sentences for the summary of an ingest."""
    said = unknown_places(campaign)
    nowhere = [n for n, c in campaign.channels.items() if c.at is None and c.quantity in _PLACED]
    if nowhere:
        said.append(
            f"without a place (at: ...): {_listed(nowhere)}; no effect that needs one there will be tried with them"
        )
    open_signs = [n for n, c in campaign.channels.items() if _unoriented(c, campaign)]
    volts = [n for n in open_signs if _wants_a_gain(campaign.channels[n])]
    if volts:
        said.append(
            f"no length before a calibration: {_listed(volts)}. A jump test gives gain and sign, or the data sheet: "
            f"{_sign([campaign.channels[n].axis for n in volts], f'? um/{campaign.channels[volts[0]].unit}')}"
        )
    turned = [n for n in open_signs if n not in volts]
    if turned:
        said.append(
            f"sign unknown, which way they count: {_listed(turned)}; kept as the file has them"
            f"{_by_gain(turned, campaign)}. A jump test tells it, or the way the probe looks: "
            f"{_sign([campaign.channels[n].axis for n in turned])}"
        )
    grows = [n for n, c in campaign.calibrations.items() if _grows_unsaid(c)]
    if grows:
        said.append(
            f"increases_with is not said: {_listed(grows)}; the reading is taken to grow with the gap, as that of an "
            "eddy-current probe. Many contact probes grow with the approach, which is the other sign: write "
            "increases_with: gap, or approach"
        )
    if campaign.tests and all(t.role == "none" for t in campaign.tests):
        said.append("no test has a role: write role: calibration, verification or locked, or name tests in the model")
    return said


def unknown_places(campaign: Campaign) -> list[str]:
    """A sentence for each channel whose place is a slip of one that is known."""
    said = []
    for name, channel in campaign.channels.items():
        if channel.at and not is_known(channel.at):
            near = nearest_place(channel.at)
            meant = called_here(channel.at) or ((near,) if near is not None else ())
            if meant:
                choices = " or ".join(f"'{m}'" for m in meant)
                said.append(f"channel '{name}': no place '{channel.at}' is known; did you mean {choices}?")
    return said


def _sign(axes: Sequence[str | None], gain: str = "1 um/um") -> str:
    """The calibration that says which way a probe looks, of the first of these axes, and what differs of the others."""
    first, *others = dict.fromkeys(axes)

    def name(axis: str | None) -> str:
        return f"sign_{axis.lower()}" if axis else "sign"

    more = "".join(f", and {name(a)} with axis: {a or '?'}" for a in others)
    return (
        f"calibrations: {{{name(first)}: {{kind: scale, axis: {first or '?'}, gain: {gain}, facing: ?, "
        f"increases_with: ?}}}}{more} ({f'+{first} or -{first}' if first else '+ or - of its axis'}; gap or approach; "
        f"a reading that has the machine's sign already: {f'+{first}' if first else '+ of its axis'}, gap)"
    )


def _wants_a_gain(channel: Channel) -> bool:
    """Whether what a probe sends is no length, and no calibration makes it one."""
    return channel.calibration is None and channel.unit is not None and not converts(channel.unit, "um")


def _unoriented(channel: Channel, campaign: Campaign) -> bool:
    """Whether nothing says which way a displacement counts: no jump test, and no probe whose facing is declared."""
    if channel.quantity not in PROBED or channel.derive is not None:
        return False
    own = [campaign.calibrations[n] for n in _listed_of(channel.calibration) if n in campaign.calibrations]
    return not any(c.kind == "jump" or (c.kind == "scale" and c.axis and c.facing) for c in own)


def _by_gain(names: Sequence[str], campaign: Campaign) -> str:
    """What turns some of these channels: a gain below 0 of a calibration that says no facing."""
    turned = {n for n, c in campaign.calibrations.items() if c.kind == "scale" and str(c.gain).lstrip().startswith("-")}
    own = [n for n in names if turned & {*_listed_of(campaign.channels[n].calibration)}]
    return f", but for {_listed(own)}, turned by the gain below 0 of their calibration" if own else ""


def _listed_of(names: str | Sequence[str] | None) -> Sequence[str]:
    return [names] if isinstance(names, str) else names or []


def _grows_unsaid(calibration: Calibration) -> bool:
    """Whether the sign of a data sheet's gain hangs on what makes the reading grow, and nobody says it."""
    return (
        calibration.kind == "scale"
        and calibration.facing is not None
        and "increases_with" not in calibration.model_fields_set
    )


def _listed(names: list[str]) -> str:
    return with_count(names, _SHOWN)
