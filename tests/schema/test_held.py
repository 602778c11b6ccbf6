"""`held` of a channel: for what was logged and drives something, never for what a model explains."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import ValidationError

from thermodata.schema.files.campaign_channels import Channel

LOGGED: dict[str, Any] = {"source": "plc", "signal": "n", "quantity": "rotational_speed", "unit": "rpm"}


def test_a_logged_driver_may_be_held_or_run_on() -> None:
    assert Channel(**LOGGED, held=True).held
    assert Channel(**LOGGED).held is None
    assert "held" not in Channel(**LOGGED).model_dump()


@pytest.mark.parametrize(
    "channel",
    [LOGGED | {"quantity": "displacement", "unit": "um"}, {"quantity": "rotational_speed", "schedule": [(0, "1 rpm")]}],
)
def test_what_is_modelled_or_not_logged_is_never_held(channel: dict[str, Any]) -> None:
    with pytest.raises(ValidationError, match="'held' is for a logged channel"):
        Channel(**channel, held=True)
