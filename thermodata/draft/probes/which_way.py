"""The sign of a displacement that no calibration turns: '-Z, gap' as one answer, for a probe that looks along -Z and
reads more as the gap grows. It becomes a calibration of its own, which the channel names."""

from __future__ import annotations

from collections.abc import Container, Mapping
from itertools import chain, count
from typing import Any

from thermodata.errors import UsageError

ASKED = "which way does it count?"
CALIBRATION_ASKED = "calibration? a jump test, or kind: scale with a gain in um/V"
_WAYS = ("gap", "approach")
_AXES = ("X", "Y", "Z")


def ways(axis: object) -> tuple[str, ...]:
    """What can be answered for a displacement of this axis; of one whose axis nobody knows, of any."""
    axes = (str(axis),) if axis in _AXES else _AXES
    return tuple(f"{sign}{a}, {way}" for a in axes for sign in "+-" for way in _WAYS)


def may_be_asked(channel: Mapping[str, Any], calibrations: Mapping[str, Any]) -> bool:
    """Whether nothing turns a channel yet but what this answer becomes: a jump test, or several calibrations, do."""
    named = channel.get("calibration")
    return named is None or (isinstance(named, str) and _kind(calibrations.get(named)) in ("scale", None))


def _kind(calibration: object) -> object:
    return calibration.get("kind") if isinstance(calibration, dict) else None


def way_of(channel: Mapping[str, Any], calibrations: Mapping[str, Any]) -> str:
    """What stands there already: '' where nothing does."""
    found = calibrations.get(str(channel.get("calibration")))
    if not isinstance(found, dict) or _kind(found) != "scale":
        return ""
    return f"{found.get('facing', '?')}, {found.get('increases_with', '?')}"


def facing_and_way(answer: str, where: str, axis: object) -> tuple[str, str]:
    """('-Z', 'gap') of '-Z, gap'. UsageError for another form, or for another axis than the channel's."""
    if answer not in ways(axis):
        raise UsageError(
            "the way that a displacement counts",
            where=where,
            expected=" or ".join(ways(axis)),
            got=answer,
            hint="push the probe, or read its manual: does its number grow as the tool comes nearer, or "
            "as it goes away?",
        )
    facing, _, way = answer.partition(", ")
    return facing, way


def calibration_for(axis: str, facing: str, way: str) -> str:
    """The calibration as a flow mapping: the reading as it is, turned. In micrometres, whatever length the channel is
    in: what a calibration takes is converted to its unit first."""
    return f"{{kind: scale, axis: {axis}, gain: 1 um/um, facing: {facing}, increases_with: {way}}}"


def its_name(name: str, facing: str, calibrations: Container[str]) -> str:
    """A free name: 'sign_z', as the draft proposes it, or with the channel's own where that one is taken."""
    wished = chain((f"sign_{facing[1:].lower()}", f"sign_{name}"), (f"sign_{name}_{k}" for k in count(2)))
    return next(w for w in wished if w not in calibrations)
