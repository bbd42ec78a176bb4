"""Every code of a finding that a plan or a part script can raise: where its hint is followed literally, or why it cannot be.

`FOLLOWED` are the repairers that read nothing but hints. `PAIRS` are tests of the same fault before and after what its hint says. What is
left tells a fact, or asks for something that no rule can write, and says so in `WITHOUT`; or its hint is followed by no test yet (`OPEN`).
"""

from __future__ import annotations

import re
from pathlib import Path

from articad.findings.codes import CODES
from tests.interference import test_hints as geometry
from tests.kernels import test_hints as scripts
from tests.plan import test_hints as plans
from tests.realisation import test_hints as joints

TESTS = Path(__file__).parent
STAGES = ("plan", "build", "interference", "motion", "fit")

FOLLOWED = (
    {case.code for case in plans.ALL}
    | {case.code for case in geometry.CASES}
    | {case.code for case in scripts.CASES}
    | {case[0] for case in joints.CASES}
    | {"W_FIT_NOMINAL", "E_CONNECTOR_DRIFT", "W_CONNECTOR_DRIFT"}
)

PAIRS = {
    "W_CONNECTOR_FEATURE": "kernels/test_features.py::test_an_axis_needs_something_round_about_it",
    "W_BORE_NARROW": "kernels/test_features.py::test_a_bore_like_a_needle_cannot_be_made",
    "W_PART_SCALE": "kernels/test_seating.py::test_one_dimension_far_longer_than_the_part_is_the_plans_fault_and_several_are_the_scripts",
    "W_NOT_CARRIED": "support/test_support.py::test_a_shelf_beside_its_pegs_falls_and_is_named",
    "W_NOT_INSERTABLE": "disassembly/test_order.py::test_a_part_that_no_order_takes_is_taken_when_its_hint_is_followed",
    "E_TOLERANCE": "interference/test_tolerance.py::test_the_hint_of_a_refutation_heals",
    "I_REDUNDANT": "kinematics/test_motion.py::test_a_released_loop_closes_in_spite_of_a_tilted_axis",
}
WITHOUT = {
    **dict.fromkeys(["I_WAIVED", "I_NOT_SAMPLED", "W_IDLE_FREEDOM", "I_BUILD_UNCHECKED"], "It tells a fact; nothing has to change."),
    **dict.fromkeys(
        ["E_SANDBOX", "E_KERNEL_UNAVAILABLE", "E_SCRIPT_MISSING"], "A program or a file is missing, not a fault of what is there."
    ),
    **dict.fromkeys(["E_CERTIFICATE_REFUTED"], "A defect of articad, to be reported."),
    **dict.fromkeys(
        ["E_LEFT_HANDED", "E_NOT_ROTATION", "E_QUAT_NORM", "E_PARAMETER_UNKNOWN"],
        "Of the Python interface and of files of runs; plans cannot say it.",
    ),
    **dict.fromkeys(
        ["E_NO_PATH", "E_REACH_BARRED", "E_NOT_FOLLOWED", "E_SINGULAR"],
        "Of a question of a caller in Python; the hint is about the next question.",
    ),
    **dict.fromkeys(["E_ORDER_REFUSED", "E_CONNECTOR_FEATURE"], "The author of a script or the designer decides."),
    **dict.fromkeys(["E_MESH_OPEN", "E_NOT_SUPPORTED"], "Of foreign files: their author has to make them anew."),
    **dict.fromkeys(
        ["E_SCRIPT_TIMEOUT", "W_BUILD_UNCHECKED", "E_INVALID_SOLID"],
        "It says what to look for in geometry; which operation it is, only its author knows.",
    ),
    "W_STATIC_OVERLAP": "Of the same hint as E_STATIC_OVERLAP; only the amount differs.",
}
OPEN = {
    *("E_SCHEMA", "E_LOOP_OPEN", "W_LOOP_INEXACT", "E_LOOP_LOCKED", "W_NEAR_SINGULAR", "W_SHAKY"),
    *("E_FEATURE_OFF_TIP", "E_NOT_CHECKED", "W_NOT_CERTIFIED", "W_TIPS_OVER"),
}
"""Codes whose hints could be followed and are not yet, in any test. The set may only become smaller."""


def test_every_code_that_a_product_can_raise_has_its_hint_followed_or_a_reason() -> None:
    codes = {code for code, entry in CODES.items() if entry.stage in STAGES}
    known = FOLLOWED | set(PAIRS) | set(WITHOUT) | OPEN
    assert codes - known == set()
    assert not (set(WITHOUT) | OPEN) & (FOLLOWED | set(PAIRS))


def test_the_tests_that_are_named_exist() -> None:
    for code, place in PAIRS.items():
        file, _, name = place.partition("::")
        assert re.search(rf"def {name}", (TESTS / file).read_text()), place
        assert code in (TESTS / file).read_text() or code == "I_REDUNDANT"
