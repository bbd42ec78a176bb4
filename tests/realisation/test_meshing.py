"""Gears and racks that leave each other: a round body that rolls along a bar of random length."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh

from articad.connectors import SE3
from articad.geometry import TriMesh
from articad.interference.scene import Scene
from articad.kinematics.joints import Coupling
from articad.kinematics.mechanism import Mechanism
from articad.realisation.meshing import lost_meshes
from tests.interference.mechanisms import at, joint

LEVEL = SE3.from_axes(np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))  # z along x


def mesh_of(shape: trimesh.Trimesh, T: SE3) -> TriMesh:
    return TriMesh(T.apply(shape.vertices), np.asarray(shape.faces, dtype=np.int32))


def lost(radius: float, length: float, travel: float, gap: float, *, driver: str = "roll") -> list[str]:
    """Return the couplings that are lost when a wheel about y above a bar along x moves it to both sides by `travel` [mm]."""
    shapes = {
        "base": mesh_of(trimesh.creation.box((10, 10, 10)), at(0, 500, 0)),
        "wheel": mesh_of(trimesh.creation.cylinder(radius, 10, sections=64), SE3.rot_x(np.pi / 2)),
        "bar": mesh_of(trimesh.creation.box((length, 10, 4)), SE3.identity()),
    }
    centre = at(0, 0, radius + gap + 2)
    turn = travel / radius
    joints = [
        joint(
            "roll",
            "revolute",
            "base",
            "wheel",
            at_parent=centre @ SE3.rot_x(-np.pi / 2),
            at_child=SE3.rot_x(-np.pi / 2),
            lower=(-turn,),
            upper=(turn,),
        ),
        joint("run", "slider", "base", "bar", at_parent=LEVEL, at_child=LEVEL, lower=(-travel,), upper=(travel,)),
    ]
    joints = [one.__class__(**{**one.__dict__, "driver": one.name == driver}) for one in joints]
    mechanism = Mechanism(["base", "wheel", "bar"], "base", joints, [Coupling("teeth", "rack", "roll", "run", radius)])
    found = list(lost_meshes(Scene.of(shapes, joints, deflection=0.01), mechanism))
    assert all(one.code == "W_JOINT_LEAVES" and set(one.parts) == {"wheel", "bar"} for one in found)
    return [one.where for one in found]


@pytest.mark.parametrize("driver", ["roll", "run"])
@pytest.mark.parametrize("seed", range(4))
def test_a_rack_that_is_too_short_for_its_travel_is_left(seed: int, driver: str) -> None:
    rng = np.random.default_rng(seed)
    radius, travel, gap = rng.uniform(8, 20), rng.uniform(40, 90), rng.uniform(0.05, 0.9)
    least = 2 * travel  # the bar reaches the wheel's lowest point to both sides

    assert lost(radius, 1.05 * least, travel, gap, driver=driver) == []
    assert lost(radius, 0.3 * least, travel, gap, driver=driver) == ["couplings.teeth"]


def test_parts_that_a_belt_couples_need_not_touch() -> None:
    assert lost(10, 20, 60, 5.0) == []
