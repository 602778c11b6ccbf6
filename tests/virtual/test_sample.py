"""A small sample of the blind benchmark: what no rule may get wrong, on development seeds."""

from __future__ import annotations

from thermodata.virtual.blind.goals import overall
from thermodata.virtual.blind.run import run
from thermodata.virtual.blind.tally import WITH_A_CAUSE, WITHOUT, rows
from thermodata.virtual.truth.strata import DEVELOPMENT

SAMPLE = {76: ("strong",), 72: ("none_full", "sensor_fault")}


def test_a_small_sample_is_without_a_wrong_claim_and_names_what_is_plain() -> None:
    """Three machines. What may be asserted is what every good rule keeps: silence is allowed but where the cause is
    strong and the model knows four others."""
    assert set(SAMPLE) <= set(DEVELOPMENT)
    trials = [t for seed, strata in SAMPLE.items() for t in run(strata, [seed], rivals=False)]
    for t in trials:
        where = f"{t['stratum']} {t['seed']}: {t['hidden']} hidden, claimed {t['claims']}"
        assert t["outcome"] not in ("wrong", "false claim"), where
        assert not t["broken_claimed"], where
        for said in t["stated"]:
            assert said["probability"] is None or 0 <= said["probability"] <= 1, where
    strong = trials[0]
    assert len(strong["base"]) == 4, "the sample's strong machine has a full base"
    assert strong["outcome"] in ("right", "equivalent")
    assert strong["first_mark"] in ("exact", "equivalent")
    assert strong["share"] > 0.8
    counted = {r["stratum"]: r["machines"] for r in rows(trials)}
    assert (counted[WITH_A_CAUSE], counted[WITHOUT]) == (2, 1)
    assert {r["question"]: r["value"]["of"] for r in overall(trials)}["a broken channel is claimed"] == 1
