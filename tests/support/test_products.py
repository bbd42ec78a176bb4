"""Products on a floor that tilts: they fall in MuJoCo at the angle that is stated, and not before."""

from __future__ import annotations

import math
from functools import cache

import mujoco
import numpy as np
import pytest
from scipy.spatial import ConvexHull

import articad
from articad import examples
from articad.assembly import Assembly
from articad_bench.task import TASKS

WITHIN = math.radians(2.0)
SURFACE = 'friction="8 0 0" solref="0.004 1"'
LOWEST_MM = 0.1
FEET = 60
EXAMPLES = ("desk_lamp", "four_bar", "geared_four_bar", "jansen_leg", "scissor_lift", "table_football", "wardrobe")
TASKED = (
    *("bed_hospital", "bookcase_low", "cabinet_filing", "clock_tower", "fan_desk", "grinder_coffee", "microscope_school"),
    *(
        "stand_music",
        "stool_piano",
        "stool_step_two",
        "stool_three_legs",
        "table_bistro",
        "trophy_two_handles",
        "wheel_ferris",
        "windmill_garden",
    ),
)


@cache
def product(name: str) -> Assembly:
    return articad.read(examples.folder(name) if name in EXAMPLES else TASKS / name / "reference").product()


@cache
def feet_and_centre(name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return corners of what touches the floor `(n, 3)`, and the centre of mass `(3,)` over it [mm], from the triangles of the meshes."""
    made = product(name)
    poses, points, moments, mass = made.at(), [], np.zeros(3), 0.0
    for part, mesh in ((part, one.mesh) for part, one in made.parts.items() if one.mesh is not None and one.mass is not None):
        points.append(poses[part].apply(mesh.vertices))
        a, b, c = (points[-1][mesh.triangles[:, corner]] for corner in range(3))
        sixths = np.einsum("ij,ij->i", a, np.cross(b, c))
        weight = made.parts[part].mass.mass  # type: ignore[union-attr]
        moments += weight * (sixths[:, None] * (a + b + c) / 4).sum(axis=0) / sixths.sum()
        mass += weight
    every = np.concatenate(points)
    low = every[every[:, 2] < every[:, 2].min() + LOWEST_MM]
    corners = low[ConvexHull(low[:, :2]).vertices]
    return corners[:: -(-len(corners) // FEET)] - (0, 0, every[:, 2].min()), moments / mass - (0, 0, every[:, 2].min())


def topples(name: str, tilt: float, towards: np.ndarray) -> bool:
    """Return whether a product falls over, as one body on its corners, with gravity tilted by an angle [rad] towards a direction `(2,)`."""
    feet, centre = feet_and_centre(name)
    geoms = "".join(f'<geom type="sphere" pos="{x / 1000} {y / 1000} {0.001}" size="0.001" {SURFACE}/>' for x, y, _ in feet)
    pull = 9.81 * np.array([*(math.sin(tilt) * towards), -math.cos(tilt)])
    inertia = (centre[2] / 1000) ** 2 / 3  # of no influence on whether it falls
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco><option timestep="0.001" gravity="{" ".join(map(str, pull))}" cone="elliptic" impratio="10"/><worldbody>'
        f'<geom type="plane" size="9 9 1" {SURFACE}/><body><freejoint/><inertial pos="{" ".join(map(str, centre / 1000))}" mass="1" '
        f'diaginertia="{inertia} {inertia} {inertia}"/>{geoms}</body></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    for _ in range(4000):
        mujoco.mj_step(model, data)
        if data.xmat[1][8] < math.cos(math.radians(12)):
            return True
    return False


@pytest.mark.soak
@pytest.mark.parametrize("name", [*EXAMPLES, *TASKED])
def test_a_product_tips_over_in_mujoco_at_the_angle_that_is_stated(name: str) -> None:
    rest = product(name).check_support().stances[0]
    assert rest.at == {}
    if not rest.stands:
        assert topples(name, 0.0, rest.towards)
        return
    assert topples(name, rest.tip + WITHIN, rest.towards)
    assert rest.tip < WITHIN or not topples(name, rest.tip - WITHIN, rest.towards)
