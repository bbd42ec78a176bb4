"""FreeCAD documents of loops with rounded connectors: joints stand where the mechanism has them, not where the connectors are."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.connectors import SE3, Connector
from articad.export.freecad_job import Job
from articad.export.plan import plan_of
from articad.geometry.part import Part
from articad.geometry.shapes import box
from articad.kinematics import Mechanism
from articad.plan.resolve import resolve
from tests.kinematics.linkages import four_bar
from tests.kinematics.test_inexact import reframed, with_digits


def assembled(mechanism: Mechanism) -> Assembly:
    """Return an assembly of small boxes with the connectors as they are given."""
    connectors: dict[str, dict[str, Connector]] = {part: {} for part in mechanism.parts}
    for joint in mechanism.given_joints:
        for part, name, frame in (
            (joint.parent, joint.parent_connector, joint.T_parent_connector),
            (joint.child, joint.child_connector, joint.T_child_connector),
        ):
            connectors[part][name] = Connector(name, frame)
    parts = {name: Part.from_mesh(name, box(1, 1, 1), density=1000, connectors=held) for name, held in connectors.items()}
    return Assembly("bars", mechanism, parts)


def placed(numbers: list[float]) -> SE3:
    return SE3.from_quaternion(np.array(numbers[3:]), np.array(numbers[:3]))


@pytest.mark.parametrize("seed", range(3))
def test_joints_of_a_document_fit_the_places_of_its_parts(seed: int, tmp_path: Path) -> None:
    assembly = assembled(with_digits(reframed(four_bar(), seed), 3, 4))
    assert assembly.mechanism.correction is not None
    told = Job(assembly, tmp_path).to_json()
    places = {part["name"]: placed(part["placement"]) for part in told["parts"]}
    systems = {(part["name"], one["name"]): placed(one["placement"]) for part in told["parts"] for one in part["connectors"]}
    for joint in told["joints"]:
        near, far = (
            places[joint[end]] @ systems[joint[end], joint[f"{end}_connector"]] @ placed(joint[offset])
            for end, offset in (("parent", "offset_1"), ("child", "offset_2"))
        )
        assert near.distance_to(far) < 1e-9
        assert np.linalg.norm(np.cross(near.z_axis, far.z_axis)) < 1e-9


def test_exact_connectors_have_no_offsets(tmp_path: Path) -> None:
    told = Job(assembled(reframed(four_bar(), 0)), tmp_path).to_json()
    assert all(placed(joint["offset_1"]) == SE3.identity() for joint in told["joints"])


@pytest.mark.parametrize("seed", range(3))
def test_a_plan_of_rounded_connectors_is_the_same_mechanism(seed: int) -> None:
    assembly = assembled(with_digits(reframed(four_bar(), seed), 3, 4))
    again = resolve(plan_of(assembly)[0]).mechanism
    q = assembly.mechanism.rest + 0.2
    assert again.poses(q).distance_to(assembly.poses(q)).max() < 1e-7
