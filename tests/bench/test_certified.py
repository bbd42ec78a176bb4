"""A lid lies on its frame and turns on it, whether the joint names the lid or an arm that is fixed to it; what collides is not proven."""

from __future__ import annotations

import math

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.connectors import SE3
from articad.geometry import Part, Solid, TriMesh, box
from articad_bench.subject import Subject
from tests.bench.test_checks import form
from tests.bench.test_function_checks import LEVEL, fixed, placed
from tests.kinematics.linkages import joint

AXIS = SE3.trans(120, 0, 10) @ LEVEL
BUILT_MM = 0.01  # by which the meshes of built parts may be off
CHECK = form({"kind": "certified", "seconds": 60})


def recess(low: float) -> TriMesh:
    """A frame with a rim before the lid: the lid lies in the corner of both."""
    outline = np.array([(-120, -20), (120, -20), (120, 0), (-103, 0), (-103, 20), (-120, 20)], dtype=float)
    ends = [np.column_stack([outline[:, 0], np.full(6, y), outline[:, 1] + low]) for y in (-70.0, 70.0)]
    cap = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 5), (5, 3, 4)])
    sides = [[(k, n, n + 6), (k, n + 6, k + 6)] for k, n in ((k, (k + 1) % 6) for k in range(6))]
    return TriMesh(np.concatenate(ends), np.concatenate([cap, cap[:, ::-1] + 6, *(np.array(pair)[:, ::-1] for pair in sides)]))


def lid(*, through: str, sunk: float = 0.0) -> Subject:
    """A lid of 200 x 100 x 20 mm on a frame with a rim, with an arm on it that reaches to a pin along y; the joint names one of both."""
    bodies = [
        ("frame", recess(sunk)),
        ("lid", placed(box(200, 100, 20), 0, 0, 10)),
        ("arm", placed(box(60, 10, 20), 110, 0, 30)),
    ]
    pin = joint("pin", "revolute", ("frame", AXIS), (through, AXIS), limits=[(0.0, math.radians(80))])
    parts = [Part.from_solid(name, Solid.from_mesh(mesh, deflection=BUILT_MM), density=700) for name, mesh in bodies]
    return Subject(Assembly.from_parts("made", parts=parts, joints=[pin, fixed("lid", "arm")], ground="frame"))


@pytest.mark.parametrize("through", ["lid", "arm"])
def test_what_lies_on_a_frame_that_it_turns_on_is_proven(through: str) -> None:
    judged = CHECK.judge(lid(through=through))

    assert judged.ok, judged.measured


@pytest.mark.parametrize("through", ["lid", "arm"])
def test_what_is_sunk_into_its_frame_is_not(through: str) -> None:
    judged = CHECK.judge(lid(through=through, sunk=0.5))

    assert not judged.ok
    assert judged.measured != "proven"
