"""Every code of a finding: where its hint is followed literally, or why it cannot be.

`FOLLOWED` are the codes of the rooms' own `test_hints.py`: what is planted there is changed as the hint says and nothing else; then the
finding is gone, and no error has come that was not there before (`tests/obedience.py`). `PAIRS` are tests of the same fault before and after
what its hint says. What is left asks for nothing, or for something that no rule can do, and says so in `NOTHING_TO_DO` and `WITHOUT`.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from articad.findings.codes import CODES
from tests.agents import test_hints as models
from tests.audit import test_hints as audits
from tests.connectors import test_hints as frames
from tests.export import test_hints as exports
from tests.freecad import test_hints as documents
from tests.importers import test_hints as files
from tests.interference import test_hints as geometry
from tests.kernels import test_hints as scripts
from tests.kinematics import test_hints as loops
from tests.plan import test_hints as plans
from tests.realisation import test_hints as joints
from tests.simulate import test_hints as simulations

TESTS = Path(__file__).parent
ROOMS = (audits, simulations, files, exports, documents, models, frames)

FOLLOWED = (
    {case.code for case in plans.ALL}
    | {case.code for case in geometry.CASES}
    | {case.code for case in scripts.CASES}
    | {case[0] for case in joints.CASES}
    | {case.code for case in loops.CASES}
    | {code for room in ROOMS for code in room.CODES}
    | loops.QUESTIONS
    | {"E_SCHEMA", "W_FIT_NOMINAL", "E_CONNECTOR_DRIFT", "W_CONNECTOR_DRIFT"}
)

PAIRS = {
    "W_CONNECTOR_FEATURE": "kernels/test_features.py::test_an_axis_needs_something_round_about_it",
    "W_MOTION_RANGE": "agents/test_ranges.py::test_drawers_that_open_a_tenth_as_far_as_the_analysis_says_are_asked_about_and_corrected",
    "W_RADIUS_MISTAKEN": "kernels/test_radii.py::test_twice_or_half_of_one_radius_is_named_and_is_gone_as_the_hint_says",
    "W_BORE_NARROW": "kernels/test_features.py::test_a_bore_like_a_needle_cannot_be_made",
    "W_PART_STEP": "kernels/test_contract.py::test_a_solid_that_step_does_not_keep_is_told",
    "W_PART_SCALE": "kernels/test_seating.py::test_one_dimension_far_longer_than_the_part_is_the_plans_fault_and_several_are_the_scripts",
    "W_NOT_CARRIED": "support/test_support.py::test_a_shelf_beside_its_pegs_falls_and_is_named",
    "W_TIPS_OVER": "support/test_support.py::test_a_product_that_is_made_as_the_hint_says_tips_over_no_more",
    "W_NOT_INSERTABLE": "disassembly/test_order.py::test_a_part_that_no_order_takes_is_taken_when_its_hint_is_followed",
    "E_TOLERANCE": "interference/test_tolerance.py::test_the_hint_of_a_refutation_heals",
    "I_REDUNDANT": "kinematics/test_motion.py::test_a_released_loop_closes_in_spite_of_a_tilted_axis",
    "E_REPLACES": "test_convert.py::test_a_mesh_of_somebody_else_is_not_replaced_and_the_advice_works",
    "E_EDIT_REACH": "agents/test_edit.py::test_an_answer_that_reaches_more_than_it_names_goes_back",
}
NOTHING_TO_DO = {
    *("I_WAIVED", "I_NOT_SAMPLED", "W_IDLE_FREEDOM", "I_BUILD_UNCHECKED", "I_FREECAD_EDIT", "W_FREECAD_SOLVER"),
    *("I_LOOK_UNSEEN", "I_OVERRULED", "I_ABSORBED", "I_EDITED", "I_PART_EDITED", "W_REPLAY_DRIFT", "E_REPLY_SCHEMA"),
}
"""Their hints tell a fact: the finding is right as it stands, or what follows from it has been done already, as a wrong reply is asked for again."""
WITHOUT = {
    **dict.fromkeys(
        ["E_SANDBOX", "E_KERNEL_UNAVAILABLE", "E_SCRIPT_MISSING", "I_FREECAD_UNSEEN"], "A program or a file has to be installed or written."
    ),
    **dict.fromkeys(["E_CERTIFICATE_REFUTED", "E_FREECAD"], "A defect of articad or of FreeCAD, to be reported."),
    "E_NOT_FOLLOWED": "The solver's own limits, which no small linkage reaches; the hint is about the next question.",
    "E_NOT_SUPPORTED": "A plan that no test can write is solved by no version; the hint asks for a report.",
    **dict.fromkeys(
        ["E_ORDER_REFUSED", "E_CONNECTOR_FEATURE", "W_FREECAD_EDIT", "W_STALLED", "W_ALTERNATIVES"],
        "The author of a script or the designer decides.",
    ),
    **dict.fromkeys(
        ["E_SCRIPT_TIMEOUT", "W_BUILD_UNCHECKED", "E_INVALID_SOLID"],
        "It says what to look for in geometry; which operation it is, only its author knows.",
    ),
    **dict.fromkeys(
        ["W_LOOK_SHAPE", "W_LOOK_PROPORTION", "W_LOOK_ORIENTATION", "E_VERDICT_PLACEMENT", "E_VERDICT_INTERFERENCE", "E_VERDICT_MOTION"],
        "The hint is the text of the model that looked.",
    ),
    "W_OBSERVER_UNSEEN": "Somebody has to look.",
    "E_EDIT_UNEQUAL": "Another machine, or hands, changed the files of a run.",
}


def test_every_code_has_its_hint_followed_or_a_reason() -> None:
    known = FOLLOWED | set(PAIRS) | set(WITHOUT) | NOTHING_TO_DO
    assert known == set(CODES)
    assert not (set(WITHOUT) | NOTHING_TO_DO) & (FOLLOWED | set(PAIRS))
    assert not set(WITHOUT) & NOTHING_TO_DO


def test_those_that_no_rule_can_follow_are_few() -> None:
    assert len(WITHOUT) < len(CODES) / 8


@pytest.mark.parametrize("code", PAIRS)
def test_the_test_of_a_pair_exists(code: str) -> None:
    file, _, name = PAIRS[code].partition("::")
    assert re.search(rf"def {name}", (TESTS / file).read_text()), PAIRS[code]
    assert code in (TESTS / file).read_text() or code == "I_REDUNDANT"


@pytest.mark.parametrize("room", ROOMS)
def test_a_code_that_a_room_lists_is_planted_there(room: object) -> None:
    """As the code of a case, or by its name, which then stands in the list and in a test."""
    cases = getattr(room, "CASES", ())
    planted = {getattr(case, "code", "") for case in (cases.values() if isinstance(cases, dict) else cases)}
    text = Path(str(getattr(room, "__file__", ""))).read_text()
    for code in room.CODES - planted:  # type: ignore[attr-defined]
        assert text.count(f'"{code}"') >= 2, code
