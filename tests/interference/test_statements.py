"""What is said about reports covers what was checked, and no more."""

from __future__ import annotations

import itertools
from typing import Any

import pytest

from articad.interference.statements import about_fits, about_motion, about_rest, statements

SAMPLED = {"kind": "sampled", "poses": 1, "step": None}
CERTIFIED = {"kind": "certified", "epsilon_mm": 0.02}
WAIVED = {"kind": "waived", "reason": "felt"}
UNCHECKED = {"kind": "not_checked", "reason": "open mesh"}


def pair(
    verdict: str = "clear", *, over: Any = "rest", strength: Any = SAMPLED, relation: str = "mating", depth: float = 0.0
) -> dict[str, Any]:
    return {
        "parts": ["a", "b"],
        "relation": relation,
        "over": over,
        "strength": strength,
        "verdict": verdict,
        "depth_mm": depth,
        "allowed_mm": 0.04,
    }


def checks(*pairs: dict[str, Any], fits: list[dict[str, Any]] | None = None) -> dict[str, Any]:
    return {"ok": True, "findings": [], "pairs": list(pairs), "fits": fits or []}


def fit(verdict: str = "ok", strength: Any = SAMPLED) -> dict[str, Any]:
    return {"joint": "j", "verdict": verdict, "strength": strength}


def test_what_can_meet_within_tolerance_is_not_called_proven() -> None:
    loose = certificate(*[pair(strength=CERTIFIED)] * 3, ok=False) | {"findings": [{"code": "E_TOLERANCE"}] * 2}
    said = about_motion(None, loose)

    assert said.badge == "2 pairs can meet within tolerance"
    assert said.sentence == "Motion NOT proven within tolerance: 2 pairs can meet. As modelled, 3 of 3 cases certified."
    assert said.state == "bad"
    collides = certificate(pair("overlap", strength=CERTIFIED), ok=False) | {"findings": [{"code": "E_TOLERANCE"}]}
    assert "NOT free" in about_motion(None, collides).sentence


def certificate(
    *pairs: dict[str, Any], ok: bool = True, covers: str = "proven while all of these joints move at once, each over its whole range: j."
) -> dict[str, Any]:
    return {"ok": ok, "pairs": list(pairs), "covers": covers}


def test_one_pose_is_said_to_be_one_pose_and_the_motion_not_to_be_proven() -> None:
    rest, motion = statements(checks(*[pair()] * 9, *[pair("contact", relation="rigid")] * 5), None, certify="articad certify out")

    assert rest.sentence == "No interference at rest (14 nearby pairs: 9 clear, 5 touching by design)."
    assert motion.sentence == "Motion not proven: articad certify out."
    assert (rest.badge, motion.badge) == ("clear at rest", "motion not proven")
    assert (rest.state, motion.state) == ("good", "warn")


def test_only_parts_that_a_joint_connects_touch_by_design() -> None:
    said = about_rest(checks(pair("contact", relation="unrelated"), pair("contact")))

    assert said.sentence == "No interference at rest (2 nearby pairs: 1 touching by design, 1 touching, with no joint between them)."


def test_an_overlap_is_counted_and_the_deepest_named() -> None:
    said = about_rest(checks(pair(), pair("overlap", depth=1.25), pair("overlap", depth=0.2), pair("overlap", depth=9, strength=WAIVED)))

    assert said.state == "bad"
    assert said.badge == "2 overlaps at rest"
    assert said.sentence == (
        "Interference at rest (4 nearby pairs: 2 overlapping, 1 clear, 1 overlapping as the plan allows; deepest 1.25 mm: a and b, 0.04 mm allowed)."
    )


@pytest.mark.parametrize(
    "verdicts", [list(chosen) for size in range(4) for chosen in itertools.product(("clear", "contact", "overlap", "unknown"), repeat=size)]
)
def test_rest_is_good_only_if_no_pair_overlaps_and_every_pair_was_checked(verdicts: list[str]) -> None:
    said = about_rest(checks(*[pair(verdict, strength=UNCHECKED if verdict == "unknown" else SAMPLED) for verdict in verdicts]))

    assert (said.state == "good") == (not {"overlap", "unknown"} & set(verdicts))
    assert (said.badge == "clear at rest") == (said.state == "good")
    assert said.sentence.startswith("No interference at rest (") == (said.state == "good")


def test_a_sampled_motion_is_called_sampled_and_not_proven() -> None:
    said = about_motion(checks(pair(), pair(over=["j"], strength={"kind": "sampled", "poses": 13, "step": 0.1})), None)

    assert said.badge == "motion sampled"
    assert said.sentence == "No collision at up to 13 sampled poses of 1 case of pairs and joints. Motion not proven: articad certify RUN."
    assert about_motion(checks(pair("overlap", over=["j"])), None).state == "bad"
    assert about_motion(checks(), None, moves=False).sentence == "Nothing moves."


@pytest.mark.parametrize(
    ("given", "badge", "state"),
    [
        (certificate(*[pair(strength=CERTIFIED)] * 106), "motion certified 106 of 106", "good"),
        (
            certificate(*[pair(strength=CERTIFIED)] * 3, pair("overlap", strength=WAIVED)),
            "motion certified 3 of 4, 1 allowed by the plan",
            "good",
        ),
        (
            certificate(
                pair(strength=CERTIFIED),
                covers="proven for every joint alone and every two together: j; three or more at once: not covered for a/b.",
            ),
            "motion certified 1 of 1, not all joints at once",
            "good",
        ),
        (
            certificate(
                pair(strength=CERTIFIED),
                covers="proven while all of these joints move at once, each over its whole range: j. Not covered: free joints stay at rest throughout (f).",
            ),
            "motion certified 1 of 1, free joints at rest",
            "good",
        ),
        (
            certificate(pair(strength=CERTIFIED), pair(strength=UNCHECKED), ok=False, covers="not everything"),
            "motion certified 1 of 2 only",
            "bad",
        ),
        (
            certificate(pair(strength=CERTIFIED), pair("overlap"), ok=False, covers="not everything"),
            "motion collides in 1 of 2 cases",
            "bad",
        ),
    ],
)
def test_a_certificate_is_quoted_with_what_it_leaves_out(given: dict[str, Any], badge: str, state: str) -> None:
    said = about_motion(None, given)

    assert (said.badge, said.state) == (badge, state)
    assert ("certified" in said.sentence) or state == "bad"


def test_fits_are_certified_measured_wrong_or_not_checked() -> None:
    assert about_fits([fit(strength=CERTIFIED), fit(strength=CERTIFIED)]).badge == "2 fits certified"
    assert about_fits([fit(strength=CERTIFIED), fit()]).badge == "2 fits measured"
    assert about_fits([fit(), fit("tight")]).sentence == "Fits: 1 of 2 wrong (1 tight)."
    assert about_fits([fit(), fit("not_checked")]).state == "warn"


def test_the_certificate_speaks_of_the_fits_if_there_is_one() -> None:
    said = statements(checks(fits=[fit()]), certificate(pair(strength=CERTIFIED)) | {"fits": [fit(strength=CERTIFIED)]})

    assert [each.badge for each in said] == ["clear at rest", "motion certified 1 of 1", "1 fit certified"]
