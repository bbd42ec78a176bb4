"""Scene: the items to draw, placed in the ground frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part
from articad.kinematics.joints import Joint
from articad.render.simplify import simplified

Manner = Literal["solid", "faded", "glass", "highlight"]


@dataclass(frozen=True, eq=False)
class DrawnMesh:
    """One mesh in the ground frame.

    Attributes:
        name: Name of the part.
        mesh: Its surface in its own frame [mm].
        T_ground: Pose of that frame.
        color: "#rrggbb".
        manner: solid; faded for context; glass is faded and hides nothing; highlight is drawn over everything in front of it.
        smooth: Whether normals are interpolated over smooth surfaces; otherwise each triangle is drawn flat.
        material: The declared material, for its look.
    """

    name: str
    mesh: TriMesh
    T_ground: SE3
    color: str
    manner: Manner = "solid"
    smooth: bool = False
    material: str = ""

    @cached_property
    def vertices(self) -> FloatArray:
        """Vertices in the ground frame [mm], `(V, 3)`."""
        return self.T_ground.apply(self.mesh.vertices)


@dataclass(frozen=True)
class Section:
    """A cutting plane; what lies on the side of its normal is removed.

    Attributes:
        point: A point of the plane [mm].
        normal: Towards the removed side; need not be of unit length.
    """

    point: tuple[float, float, float]
    normal: tuple[float, float, float]

    @classmethod
    def parse(cls, text: str, bounds: FloatArray) -> Section:
        """Parse `x`, `-y`, `z=12.5` …: the axis of the normal, and the position of the cut (the middle of `bounds` by default).

        Raises:
            ValueError: If the text does not have this form.
        """
        axis, _, offset = text.partition("=")
        sign = -1.0 if axis.startswith("-") else 1.0
        index = "xyz".find(axis.lstrip("-"))
        if len(axis.lstrip("-")) != 1 or index < 0:
            raise ValueError(f"A section is x, y or z, optionally with a sign and '=mm', such as -y=12.5; not {text!r}.")
        point = bounds.mean(axis=0)
        if offset:
            point[index] = float(offset)
        normal = np.zeros(3)
        normal[index] = sign
        return cls((float(point[0]), float(point[1]), float(point[2])), (float(normal[0]), float(normal[1]), float(normal[2])))


@dataclass(frozen=True)
class AxisMark:
    """A joint's axis to draw.

    Attributes:
        name: Name of the joint.
        point: A point of the axis [mm].
        direction: Unit vector along it.
        turns: Whether the joint turns.
        across: Unit vector perpendicular to the axis that turns with the joint.
        hand: Length of the hand that is drawn along `across` [mm]; 0 for none.
    """

    name: str
    point: tuple[float, float, float]
    direction: tuple[float, float, float]
    turns: bool
    across: tuple[float, float, float] = (0.0, 0.0, 0.0)
    hand: float = 0.0


@dataclass(frozen=True)
class DrawnScene:
    """Items, and what is drawn over them.

    Attributes:
        items: Meshes with their poses and colours.
        axes: Joint axes to draw.
        section: Cutting plane, or None.
    """

    items: tuple[DrawnMesh, ...]
    axes: tuple[AxisMark, ...] = ()
    section: Section | None = field(default=None)

    @cached_property
    def bounds(self) -> FloatArray:
        """Smallest and largest coordinates of all items [mm], `(2, 3)`; a unit box if there are none."""
        corners = [item.vertices for item in self.items if len(item.mesh.vertices)]
        if not corners:
            return np.array([[-0.5] * 3, [0.5] * 3])
        return np.array([np.min([c.min(axis=0) for c in corners], axis=0), np.max([c.max(axis=0) for c in corners], axis=0)])

    def simplified(self, tolerance: float) -> DrawnScene:
        """Return the scene with lighter meshes within `tolerance` [mm] of its own, drawn with smooth normals."""
        return replace(self, items=tuple(replace(item, mesh=simplified(item.mesh, tolerance), smooth=True) for item in self.items))


def scene_of(
    parts: Mapping[str, Part],
    poses: Mapping[str, SE3],
    *,
    joints: Sequence[Joint] = (),
    only: Sequence[str] | None = None,
    highlights: Sequence[TriMesh] = (),
) -> DrawnScene:
    """Return the scene of parts in their poses.

    Args:
        parts: By name.
        poses: `T_ground_part` by name.
        joints: Joints whose axes are drawn.
        only: Parts to show in full; the others are faded. All by default.
        highlights: Meshes in the ground frame that are drawn over everything, such as overlaps.
    """

    def manner(name: str) -> Manner:
        return "solid" if only is None or name in only else "faded"

    items = [
        DrawnMesh(name, shape.mesh, poses[name] @ shape.frame, shape.color or part.color, manner(name), material=part.material or "")
        for name, part in parts.items()
        for shape in part.visuals or part.collisions
    ]
    items += [DrawnMesh(f"overlap {index + 1}", mesh, SE3.identity(), "#e5383b", "highlight") for index, mesh in enumerate(highlights)]
    return DrawnScene(tuple(items), axes=tuple(_axis(joint, poses) for joint in joints if joint.type.freedoms))


def _axis(joint: Joint, poses: Mapping[str, SE3]) -> AxisMark:
    frame = poses[joint.parent] @ joint.T_parent_connector
    return AxisMark(
        joint.name,
        tuple(map(float, frame.translation)),  # type: ignore[arg-type]
        tuple(map(float, frame.z_axis)),  # type: ignore[arg-type]
        turns="rad" in joint.type.units or "1" in joint.type.units,
        across=tuple(map(float, (poses[joint.child] @ joint.T_child_connector).x_axis)),  # type: ignore[arg-type]
    )
