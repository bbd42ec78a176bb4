"""Hints about frames and values of parameters, followed literally: what is given is changed as the hint says, and the error is gone."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from articad.connectors import SE3
from articad.errors import ArticadError, did_you_mean
from articad.findings import Finding, Findings
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from tests.obedience import assert_heals
from tests.plan.samples import chest

TURNED = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
MATRIX = np.block([[TURNED, np.zeros((3, 1))], [np.ones((1, 4))]])
CODES = {"E_NOT_ROTATION", "E_QUAT_NORM", "E_LEFT_HANDED", "E_PARAMETER_UNKNOWN"}


def said(make: Callable[[], object]) -> Findings:
    try:
        make()
    except ArticadError as error:
        return error.findings
    return Findings()


def orthonormal(rotation: np.ndarray) -> np.ndarray:
    u, _, v = np.linalg.svd(rotation)
    return np.asarray(u @ v)


def with_last_row(matrix: np.ndarray) -> np.ndarray:
    return np.vstack([matrix[:3], [0.0, 0.0, 0.0, 1.0]])


def of_unit_length(pose: np.ndarray) -> np.ndarray:
    return np.concatenate([pose[:3], pose[3:] / np.linalg.norm(pose[3:])])


CASES = [
    ("E_NOT_ROTATION", "Give orthonormal columns", SE3.from_rotation, 1.1 * TURNED, orthonormal),
    ("E_NOT_ROTATION", "Give a rigid motion", SE3.from_matrix, MATRIX, with_last_row),
    ("E_QUAT_NORM", "Give a unit quaternion", SE3, np.array([0, 0, 0, 0, 0, 1.0, 1.0]), of_unit_length),
]


@pytest.mark.parametrize(("code", "words", "make", "wrong", "right"), CASES, ids=lambda value: value if isinstance(value, str) else "")
def test_a_pose_that_is_given_as_the_hint_says_is_one(
    code: str, words: str, make: Callable[[object], object], wrong: np.ndarray, right: Callable[[np.ndarray], np.ndarray]
) -> None:
    before = said(lambda: make(wrong))
    (finding,) = before.of(code)
    assert words in finding.hint
    assert_heals(finding, before, said(lambda: make(right(wrong))))


def test_a_mirrored_frame_is_a_mirrored_part_of_a_plan() -> None:
    before = said(lambda: SE3.from_rotation(np.diag([-1.0, 1.0, 1.0])))
    (finding,) = before.of("E_LEFT_HANDED")
    assert "Use derive: mirror for mirrored parts" in finding.hint
    plan = chest()
    plane = {"point": [0, 0, 0], "normal": [1, 0, 0]}
    plan["parts"].append({"name": "twin", "derive": {"from": "box", "op": "mirror", "plane": plane}})
    plan["joints"].append({"name": "join", "type": "fixed", "parent": "box.hinge", "child": "twin.hinge"})
    assert_heals(finding, before, said(lambda: resolve(AssemblyPlan.from_json(plan))))


@pytest.mark.parametrize("name", ["widht", "depth"])
def test_a_value_for_a_parameter_that_the_hint_lists_is_taken(name: str) -> None:
    def resolved(given: str) -> Findings:
        return said(lambda: resolve(AssemblyPlan.from_json(chest()), **{given: 300}))

    before = resolved(name)
    finding: Finding = before.of("E_PARAMETER_UNKNOWN")[0]
    listed = finding.hint.partition("Parameters: ")[2].rstrip(".").split(", ")
    assert (did_you_mean(name, listed).strip() in finding.hint) or name == "depth"
    for right in listed:
        assert_heals(finding, before, resolved(right))
