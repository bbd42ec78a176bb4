"""Which bodies their weight can move: a linear program over the displacements of all bodies, to first order.

A body is a set of parts that are fixed to each other. Contacts limit how bodies move, as in `articad.realisation.room`. A joint that is made
holds all six components of the motion of its two sides, since its drivers hold their values; one that is not made holds only its own. A body is carried if its
centre of mass cannot go down.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Final, NamedTuple

import numpy as np
from scipy.optimize import linprog
from scipy.sparse import csr_array

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.geometry.faces import faces_of
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint
from articad.realisation.contacts import FaceReach, pairs
from articad.realisation.room import FAR_RAD, GROUND, Touch, far_mm, rows
from articad.realisation.sides import PartFace, Sides
from articad.realisation.verdicts import OWN

__all__ = ["Bodies", "Sinking"]

REACH: Final = FaceReach(0.5, 0.5, 0.1)  # contacts from which a body may be a little apart at rest
_ALL: Final = tuple(range(6))


class Sinking(NamedTuple):
    """A body that its weight moves.

    Attributes:
        parts: Its parts.
        drop: By how much its centre of mass sinks, as far as the contacts near it tell [mm].
    """

    parts: tuple[str, ...]
    drop: float


class Bodies:
    """The bodies of a scene at one pose, and what holds them.

    Args:
        scene: Parts and relations.
        poses: `T_ground_part`.
        ground: A part of the body that stands still.
        made: Names of the joints that surfaces make, or of which that is not known.
    """

    def __init__(self, scene: Scene, poses: Mapping[str, SE3], ground: str, made: Collection[str]) -> None:
        self.scene, self.poses = scene, poses
        groups: dict[str, list[str]] = {}
        for name in scene.bodies:
            if name not in scene.environment and name in poses:
                groups.setdefault(scene.relations.rigid.leader(name), []).append(name)
        still = scene.relations.rigid.leader(ground)
        self.ground = tuple(groups.pop(still, []))
        self.bodies = [tuple(parts) for parts in groups.values()]
        self.number = {part: at for at, parts in enumerate(self.bodies) for part in parts} | dict.fromkeys(self.ground, GROUND)
        self.centres = [self._centre(parts) for parts in self.bodies]
        self.touches = self._touches()
        self._held = self._joint_rows(
            [joint for joint in scene.relations.joints if joint.parent in self.number and joint.child in self.number], made
        )

    def moved_by(self, gravity: FloatArray) -> list[Sinking]:
        """Return the bodies that a weight along a unit vector `(3,)` moves farther than play."""
        if not self.bodies:
            return []
        far = far_mm(self.touches)
        limits = np.tile([far] * 3 + [FAR_RAD] * 3, len(self.bodies))
        contacts = [rows(touch, self.centres) for touch in self.touches]
        left = csr_array(np.concatenate(contacts)) if contacts else None
        gaps = np.concatenate([touch.gaps for touch in self.touches]) if contacts else None
        held = csr_array(self._held) if len(self._held) else None
        found = []
        for at, parts in enumerate(self.bodies):
            goal = np.zeros(6 * len(self.bodies))
            goal[6 * at : 6 * at + 3] = -gravity
            result = linprog(
                goal,
                A_ub=left,
                b_ub=gaps,
                A_eq=held,
                b_eq=None if held is None else np.zeros(len(self._held)),
                bounds=np.column_stack([-limits, limits]),
                method="highs",
            )
            if result.status == 0 and -result.fun >= far * 0.5:
                found.append(Sinking(parts, float(-result.fun)))
        return found

    def below(self, at: int, up: FloatArray) -> tuple[str, ...]:
        """Return the parts on which a body rests: those that it touches with a surface that faces down."""
        found = set()
        for touch, names in zip(self.touches, self._names, strict=True):
            for body, own, sign in ((touch.second, 1, 1.0), (touch.first, 0, -1.0)):
                if body == at and bool((sign * (touch.normals @ up) < -0.3).any()):
                    found.add(names[1 - own])
        return tuple(sorted(found))

    def _centre(self, parts: Sequence[str]) -> FloatArray:
        volumes = np.array([max(self.scene.bodies[name].volume, 1e-9) for name in parts])
        centres = np.array([self.poses[name].apply(self.scene.bodies[name].mesh.centroid) for name in parts])
        return np.asarray(volumes @ centres / volumes.sum())

    def _touches(self) -> list[Touch]:
        self._names: list[tuple[str, str]] = []
        near = self.scene.at(self.poses).candidates(REACH.flat)
        found = []
        for a, b in near:
            if a not in self.number or b not in self.number or self.number[a] == self.number[b]:
                continue
            faces = [self._faces(name) for name in (a, b)]
            for pair in pairs(Sides(faces[0], faces[1]), REACH):
                found.append(Touch(self.number[a], self.number[b], pair.points, pair.normals, pair.gaps, 0.0))
                self._names.append((a, b))
        return found

    def _faces(self, name: str) -> tuple[PartFace, ...]:
        T = np.asarray(self.poses[name].matrix)
        return tuple(PartFace(name, face.moved(T)) for face in faces_of(self.scene.meshes[name]))

    def _joint_rows(self, joints: Sequence[Joint], made: Collection[str]) -> FloatArray:
        """Return the equations of the components that joints hold, `(n, 6 bodies)`."""
        found = [np.zeros((0, 6 * len(self.bodies)))]
        for joint in joints:
            frame = self.poses[joint.parent] @ joint.T_parent_connector
            components = (
                _ALL if joint.name in made else np.flatnonzero(OWN.get(joint.type, ())).tolist()
            )  # drivers hold what the joint moves along
            axes, point = np.asarray(frame.rotation).T, np.asarray(frame.translation)
            for component in components:
                row = np.zeros((1, 6 * len(self.bodies)))
                axis = axes[component % 3]
                for part, sign in ((joint.child, 1.0), (joint.parent, -1.0)):
                    body = self.number[part]
                    if body == GROUND:
                        continue
                    if component < 3:  # axis · (v + ω x (point - centre))
                        row[0, 6 * body : 6 * body + 3] += sign * axis
                        row[0, 6 * body + 3 : 6 * body + 6] += sign * np.cross(point - self.centres[body], axis)
                    else:
                        row[0, 6 * body + 3 : 6 * body + 6] += sign * axis
                found.append(row)
        return np.concatenate(found)
