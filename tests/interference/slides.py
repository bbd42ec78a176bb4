"""Telescopic slides of a drawer: three nested C profiles on the left and on the right, a constant gap between them."""

from __future__ import annotations

from dataclasses import dataclass, field

import manifold3d as m3
import numpy as np

from articad.connectors import SE3
from articad.geometry import TriMesh, box
from articad.kinematics.joints import Coupling, Joint
from articad.kinematics.mechanism import Mechanism
from tests.interference.mechanisms import at, joint, manifold_mesh, random_rotation

LENGTH = 400.0  # mm, of each profile
STAGE = 200.0  # mm, that each stage slides
WIDTH = 460.0  # mm, between the two outer profiles
GAP = 0.4  # mm, between nested profiles all round
WALL = 1.2  # mm
DEEP, TALL, NECK, RADIUS = 16.0, 45.0, 20.0, 0.3  # mm, of the outer profile and of what passes through its opening


@dataclass
class Cabinet:
    """A mechanism with its meshes."""

    meshes: dict[str, TriMesh]
    joints: list[Joint]
    couplings: list[Coupling] = field(default_factory=list)

    @property
    def mechanism(self) -> Mechanism:
        """All of it, on the cabinet."""
        return Mechanism(tuple(self.meshes), "cabinet", self.joints, self.couplings)


def profile(nested: int, segments: int) -> m3.CrossSection:
    """Return a C that opens to +x, or the rail inside two of them; one inside the other leaves `GAP`.

    Args:
        nested: 0 for the outer, 1 for the middle one, 2 for the rail inside both.
        segments: Of a full circle of the rounded corners; 0 for sharp ones.
    """
    low, high = nested * (WALL + GAP), DEEP - nested * (WALL + GAP)
    half, mouth = TALL / 2 - low, NECK / 2 + GAP
    whole = block(low, high, -half, half)
    if nested < 2:
        whole -= block(low + WALL, high - WALL, -half + WALL, half - WALL) + block(high - 2 * WALL, high + 1, -mouth, mouth)
    else:
        whole += block(high - 1.0, DEEP + 4.0, -NECK / 2, NECK / 2)  # reaches out to the drawer
    if segments:
        whole = whole.offset(-RADIUS, m3.JoinType.Round, 2.0, segments).offset(RADIUS, m3.JoinType.Round, 2.0, segments)
    return whole


def block(x0: float, x1: float, y0: float, y1: float) -> m3.CrossSection:
    """Return a rectangle."""
    return m3.CrossSection.square([x1 - x0, y1 - y0]).translate([x0, y0])


def extruded(section: m3.CrossSection, start: float, length: float) -> m3.Manifold:
    """Return a section's x across, its y upwards, along y."""
    return section.extrude(length).translate([0, 0, start]).transform([[1.0, 0, 0, 0], [0, 0, 1.0, 0], [0, 1.0, 0, 0]])


def cabinet(
    segments: int = 8,
    *,
    turned: int | None = None,
    closing: str = "loop",
    too_thick: float | None = None,
) -> Cabinet:
    """Return a drawer on two telescopic slides.

    Args:
        segments: Of a full circle of the profiles' rounded corners; 0 for sharp ones.
        turned: Seed of a rotation of each part's own frame; None for frames along the slides.
        closing: How the right side is tied: "loop" joins the middle profile to the rail and couples one stage, "both" couples the right
            stages as well, "tree" couples it to the left one instead.
        too_thick: By how much a lump on the outer left lip and one on the rail's neck are thicker together than the gap between them [mm].
            They pass each other at the end of travel; None for no lumps.
    """
    meshes = {"cabinet": box(WIDTH + 80.0, 20.0, 200.0).transformed(at(0.0, -30.0, 0.0))}
    for nested, name in enumerate(("outer", "middle", "inner")):
        solid = extruded(profile(nested, segments), 0.0, LENGTH)
        meshes[f"{name}_right"] = manifold_mesh(solid.mirror([1, 0, 0])).transformed(at(WIDTH / 2 + DEEP, 0.0, 0.0))
        if too_thick is not None and name == "outer":  # at the front of the outer lip
            top = NECK / 2 + GAP
            solid += extruded(block(DEEP - WALL, DEEP, top - GAP / 2 - too_thick, top + 1), LENGTH - 10.0, 10.0)
        if too_thick is not None and name == "inner":  # at the rear of the rail
            solid += extruded(block(DEEP - WALL, DEEP, 0.0, NECK / 2 + GAP / 2), 0.0, 10.0)
        meshes[f"{name}_left"] = manifold_mesh(solid).transformed(at(-WIDTH / 2 - DEEP, 0.0, 0.0))
    meshes["drawer"] = box(WIDTH - 8.0, LENGTH, 100.0).transformed(at(0.0, LENGTH / 2, 0.0))
    rng = np.random.default_rng(turned)
    own = {name: SE3.identity() if turned is None else random_rotation(rng) for name in meshes}
    meshes = {name: mesh.transformed(own[name].inverse()) for name, mesh in meshes.items()}
    forth = SE3.rot_x(-np.pi / 2)  # z of the joints along +y

    def slide(name: str, parent: str, child: str, end: float = STAGE) -> Joint:
        ends = own[parent].inverse() @ forth, own[child].inverse() @ forth
        return joint(name, "slider", parent, child, at_parent=ends[0], at_child=ends[1], lower=(0.0,), upper=(end,))

    def held(name: str, parent: str, child: str) -> Joint:
        return joint(name, "fixed", parent, child, at_parent=own[parent].inverse(), at_child=own[child].inverse())

    joints = [
        held("screw_left", "cabinet", "outer_left"),
        held("screw_right", "cabinet", "outer_right"),
        slide("left_1", "outer_left", "middle_left"),
        slide("left_2", "middle_left", "inner_left"),
        held("side_left", "inner_left", "drawer"),
        held("side_right", "drawer", "inner_right"),
        slide("right_1", "outer_right", "middle_right"),
    ]
    couplings = [Coupling("stages", "linear", "left_1", "left_2", 1.0, 0.0)]
    if closing == "tree":
        couplings.append(Coupling("sides", "linear", "left_1", "right_1", 1.0, 0.0))
    else:
        joints.append(slide("right_2", "middle_right", "inner_right"))
        if closing == "both":
            couplings.append(Coupling("sides", "linear", "right_1", "right_2", 1.0, 0.0))
    return Cabinet(meshes, joints, couplings)
