"""How a test's slips are named to `add`: by one id a test, whatever was told of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import Artefact, Diagnosis

STEP = "step"


def slips_of(found: Diagnosis) -> list[Artefact]:
    """Steps of a probe whose size is known, each in its test."""
    return [a for a in found.artefacts if a.kind == STEP and a.size_um is not None]


def named_slips(found: Diagnosis) -> list[tuple[str, Artefact]]:
    """Each with its id: 'step:t05', or 'step:campaign/t05' where the tests are of several campaigns."""
    slips = slips_of(found)
    campaigns = {one.campaign for c in found.candidates for one in c.left_out} | {a.campaign for a in slips}
    return [(f"{STEP}:{a.campaign}/{a.test}" if len(campaigns) > 1 else f"{STEP}:{a.test}", a) for a in slips]


def slip_ids(found: Diagnosis) -> list[str]:
    """Of each test with slips once."""
    return list(dict.fromkeys(name for name, _ in named_slips(found)))
