"""Refuses a `measuring` that could be evaluated in no test: what it should have masked would count."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from thermodata.calibration.expression.parser import parse
from thermodata.calibration.measuring import long_form
from thermodata.errors import UsageError, unknown_channel
from thermodata.schema.files.campaign import Campaign, Channel, Test
from thermodata.schema.units.quantity import canonical
from thermodata.store.tidy.check_derived import names_in
from thermodata.store.tidy.plan import effective


def check_measuring(campaign: Campaign) -> None:
    """UsageError at the first that is no expression, names no channel of the campaign, or compares what has no unit in
    common. A channel that is only absent in a test is there: that test then measures nowhere, and says so."""
    for i, test in enumerate(campaign.tests):
        if test.measuring is not None:
            _check(campaign, effective(campaign, test), test, f"tests[{i}].measuring")


def _check(campaign: Campaign, channels: Mapping[str, Channel], test: Test, where: str) -> None:
    spec = long_form(test.measuring)
    if spec.when is not None:
        place = where if isinstance(test.measuring, str) else f"{where}.when"
        for name in sorted(names_in(spec.when, place)):
            _known(name, campaign, place)
        _compares(spec.when, channels, place)
    place = f"{where}.in_range"
    for name in [spec.in_range] if isinstance(spec.in_range, str) else spec.in_range or {}:
        if name != "in_range" or name in campaign.channels:
            _known(name, campaign, place)


def _known(name: str, campaign: Campaign, where: str) -> None:
    if name not in campaign.channels:
        raise unknown_channel(name, list(campaign.channels), where=where)


def _compares(text: str, channels: Mapping[str, Channel], where: str) -> None:
    tree = parse(text)
    named = {n: channels[n].quantity for n in tree.names if n in channels}
    if len(named) < len(tree.names) or "label" in named.values():
        return  # a word is a number only once it is read
    try:
        tree.evaluate_bool({n: np.zeros(1) for n in named}, {n: canonical(q) for n, q in named.items()})
    except UsageError as error:
        raise error.at(f"{where}, {error.where}" if error.where else where) from error
