"""What an answer is worth: claims given to causes, refinements, broken channels, what is right where nothing is."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import permutations

import pytest

from thermodata.schema.answers.candidate import Candidate
from thermodata.schema.answers.diagnosis import Diagnosis
from thermodata.virtual.lathe.right_names import RIGHT
from thermodata.virtual.truth.marking import Key, claims_of, head_of, outcome_of, refinements_of
from thermodata.virtual.truth.marking import marks_of as marked_by

FAMILY = {"feed_screw": "feed_z", "ambient_frame": "ambient", "lag": "", "hydraulics": "hydraulics"}


def said(name: str, rank: int = 1, **more: object) -> Candidate:
    effect, _, channels = name.partition(":")
    blank = dict.fromkeys(("p_value", "rmse_um_before", "rmse_um_after", "fit_before", "fit_after"))
    given = {"family": FAMILY.get(effect, "other"), "claimed": True, **blank, **more}
    return Candidate.model_validate(
        {"rank": rank, "id": name, "effect": effect, "drivers": channels.split(","), **given}
    )


def answered(verdict: str, *candidates: Candidate) -> Diagnosis:
    blank = dict.fromkeys(("noise_um", "rmse_um", "explainable"))
    return Diagnosis.model_validate(
        {
            "model": "m",
            "response": "dZ",
            "verdict": verdict,
            **blank,
            "weak_spots": [],
            "candidates": list(candidates),
            "artefacts": [],
        }
    )


def marks_of(
    hidden: Sequence[str], claims: Sequence[Candidate], broken: str | None = None, alike: Sequence[tuple[str, str]] = ()
) -> tuple[list[str], int]:
    return marked_by(Key(tuple(hidden), RIGHT, broken, frozenset(alike)), claims)


SCREW, AIR, OIL = said("feed_screw:C01_nutZ"), said("ambient_frame:A2_low"), said("hydraulics:C11_oil")
NUT_LAG, RIB_LAG = said("lag:C01_nutZ"), said("lag:C07_rib")
TWIN = said("lag:C13", equivalent=["lag:A4_rh", "feed_screw:C01_nutZ"])
OTHER_SCREW = said("feed_screw:T_mot_Z")
HIDDEN = ("nut_z", "hall_air", "hydraulic_oil")


@pytest.mark.parametrize(
    ("hidden", "claims", "marks", "outcome"),
    [
        (("nut_z",), [SCREW], ["exact"], "right"),
        (("nut_z",), [NUT_LAG], ["equivalent"], "equivalent"),
        (("nut_z",), [TWIN], ["told"], "told"),
        (("nut_z",), [OTHER_SCREW], ["family"], "family"),
        (("nut_z",), [RIB_LAG], ["wrong"], "wrong"),
        (("nut_z",), [], [], "abstained"),
        (HIDDEN[:2], [AIR, SCREW], ["exact", "exact"], "right"),
        (HIDDEN, [AIR, SCREW], ["exact", "exact"], "some"),
        (HIDDEN, [RIB_LAG, AIR, NUT_LAG], ["equivalent", "exact", "equivalent"], "equivalent"),
        (HIDDEN[:2], [SCREW, OTHER_SCREW], ["exact", "wrong"], "wrong"),
        (HIDDEN[:2], [OTHER_SCREW, AIR], ["family", "exact"], "family"),
        # one cause claimed twice is one found, and no second one
        (("nut_z",), [SCREW, NUT_LAG], ["exact", "again"], "equivalent"),
        (HIDDEN[:2], [SCREW, NUT_LAG], ["exact", "again"], "some"),
        # a claim that fits two causes goes where the other claims leave one open
        (("nut_z", "nut_x"), [said("lag:C13", equivalent=["feed_screw:C01_nutZ", "feed_screw:C02_nutX"]), SCREW],
         ["told", "exact"], "told"),
    ],
)  # fmt: skip
def test_claims_of_one_answer_are_given_to_causes(
    hidden: tuple[str, ...], claims: list[Candidate], marks: list[str], outcome: str
) -> None:
    found, missed = marks_of(hidden, claims)
    assert found == marks
    assert outcome_of("effect" if claims else "unknown", found, missed, nothing=False) == outcome


def test_the_order_of_claims_does_not_change_what_is_found() -> None:
    claims = [NUT_LAG, SCREW, AIR, RIB_LAG]
    for order in permutations(claims):
        marks, missed = marks_of(HIDDEN, order)
        by_id = {c.id: m for c, m in zip(order, marks, strict=True)}
        assert missed == 0
        assert by_id == {SCREW.id: "exact", NUT_LAG.id: "again", AIR.id: "exact", RIB_LAG.id: "equivalent"}


@pytest.mark.parametrize("verdict", ["none", "refine", "unknown", "not_testable"])
def test_where_nothing_is_hidden_every_verdict_without_a_claim_is_right(verdict: str) -> None:
    offered = said("feed_screw:C01_nutZ", claimed=False, refinement=True)
    found = answered(verdict, offered)
    assert outcome_of(verdict, *marks_of((), claims_of(found)), nothing=True) == "silent"


def test_where_nothing_is_hidden_a_claim_is_false_whatever_the_verdict() -> None:
    for verdict in ("effect", "refine", "unknown"):
        found = answered(verdict, SCREW)
        assert outcome_of(verdict, *marks_of((), claims_of(found)), nothing=True) == "false claim"
    assert outcome_of("effect", [], 0, nothing=True) == "false claim"


def test_a_cause_that_is_not_logged_may_be_told_by_its_family_only() -> None:
    assert outcome_of("effect", *marks_of(("nut_z",), [OTHER_SCREW]), nothing=True) == "family"
    assert outcome_of("effect", *marks_of(("nut_z",), [AIR]), nothing=True) == "false claim"


def test_a_claim_that_names_the_part_tells_it() -> None:
    """For nothing that is logged tells the guideway from the nut, and the answer says so."""
    nut = said("feed_screw:C01_nutZ", unread=["axis.z.guide"])
    assert marks_of(("guide_friction",), [nut]) == (["told"], 0)
    assert marks_of(("guide_friction",), [SCREW]) == (["wrong"], 1)
    assert marks_of(("nut_x",), [nut]) == (["wrong"], 1), "another axis"
    holder = said("probe_temperature:C09_bracket", unread=["hall"])
    assert marks_of(("hall_air",), [holder]) == (["told"], 0), "each air of the hall"
    assert marks_of(("lost_stretch",), [said("guideway:C03_guide", unread=["axis.z.nut"])]) == (["wrong"], 1), "unknown"
    assert marks_of(("guide_friction",), [said("lag:v_Z", unread=["axis.z.nut", "axis.z.guide"])]) == (["told"], 0)
    assert outcome_of("effect", *marks_of(("guide_friction",), [nut]), nothing=True) == "family"


def test_a_refinement_is_neither_claimed_nor_ranked_first() -> None:
    better = said("spindle_friction:n_S", 1, refinement=True, probability=0.99)
    found = answered("refine", better, said("feed_screw:C01_nutZ", 2, claimed=False))
    assert claims_of(found) == []
    assert [c.id for c in refinements_of(found)] == ["spindle_friction:n_S"]
    head = head_of(found)
    assert head is not None
    assert head.id == "feed_screw:C01_nutZ"
    assert refinements_of(answered("unknown", said("lag:n_S", claimed=False, refinement=True))) == []


def test_the_first_is_the_likeliest_where_probabilities_are_stated() -> None:
    ranked = [said("lag:C13", 1, probability=0.2), said("feed_screw:C01_nutZ", 2, probability=0.7), said("lag:n_S", 3)]
    head = head_of(answered("effect", *ranked))
    assert head is not None
    assert head.id == "feed_screw:C01_nutZ"
    unstated = head_of(answered("effect", *(c.model_copy(update={"probability": None}) for c in ranked)))
    assert unstated is not None
    assert unstated.id == "lag:C13"
    assert head_of(answered("none")) is None


def test_a_broken_channel_names_nothing_whatever_it_is_a_twin_of() -> None:
    assert marks_of(("nut_z",), [TWIN], broken="C13") == (["wrong"], 1)
    assert marks_of(("nut_z",), [SCREW], broken="C13") == (["exact"], 0)


def test_what_does_on_the_open_tests_what_the_cause_does_is_neither_wrong_nor_right() -> None:
    alike = [(RIB_LAG.id, "nut_z")]
    assert marks_of(("nut_z",), [RIB_LAG]) == (["wrong"], 1)
    marks, missed = marks_of(("nut_z",), [RIB_LAG], alike=alike)
    assert (marks, missed) == (["alike"], 0)
    assert outcome_of("effect", marks, missed, nothing=False) == "alike"
    assert marks_of(("nut_z",), [RIB_LAG], broken="C07_rib", alike=alike) == (["wrong"], 1)


def test_beside_the_cause_itself_its_imitator_is_a_wrong_name() -> None:
    alike = [(RIB_LAG.id, "nut_z")]
    assert marks_of(("nut_z",), [SCREW, RIB_LAG], alike=alike) == (["exact", "wrong"], 0)
    marks, missed = marks_of(HIDDEN[:2], [AIR, RIB_LAG], alike=alike)
    assert (marks, missed) == (["exact", "alike"], 0)
    assert outcome_of("effect", marks, missed, nothing=False) == "alike"
