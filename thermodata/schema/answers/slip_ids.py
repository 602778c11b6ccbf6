"""How a test's slips are named to `add`: by one id a test, whatever was told of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from thermodata.schema.answers.diagnosis import Artefact, Diagnosis

STEP = "step"


def slips_of(found: Diagnosis) -> list[Artefact]:
    """Steps of a probe whose size is known, each in its test."""
    return [a for a in found.artefacts if a.kind == STEP and a.size_um is not None]


def slip_ids(found: Diagnosis) -> list[str]:
    """'step:t05', once for each test with slips; 'step:campaign/t05' where the tests are of several campaigns."""
    slips = slips_of(found)
    campaigns = {one.campaign for c in found.candidates for one in c.left_out} | {a.campaign for a in slips}
    names = [f"{a.campaign}/{a.test}" if len(campaigns) > 1 else a.test for a in slips]
    return list(dict.fromkeys(f"{STEP}:{name}" for name in names))
