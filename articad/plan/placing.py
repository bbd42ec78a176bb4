"""Placing: the pose of every part at rest, and the orientation of every connector."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from articad.connectors import SE3, Mate, child_pose, parent_pose
from articad.kinematics.tree import KinematicTree
from articad.plan import frames
from articad.plan.derive import DraftPart, JointLine, inherit, place
from articad.plan.evaluation import Evaluation
from articad.plan.motions import JointNumbers
from articad.plan.schema import PartSpec, Pose


class Placing:
    """Places parts by their stated poses, as images of others, and by the joint that carries them.

    Args:
        parts: By name.
        in_order: The parts with a root, each after its source.
        lines: Joints with a type.
        motions: Joint name -> motion, for joints with valid numbers.
        ground: The part that does not move.
        tree: The spanning tree; None if the joints form none, so that no joint can place a part.
        evaluation: The plan's numbers.

    Attributes:
        auto_joints: Joint -> the part that it places (`rest_pose: "auto"`).
    """

    def __init__(
        self,
        parts: Mapping[str, DraftPart],
        in_order: Sequence[DraftPart],
        lines: Sequence[JointLine],
        motions: Mapping[str, JointNumbers],
        ground: str,
        tree: KinematicTree | None,
        evaluation: Evaluation,
    ) -> None:
        self.parts, self.in_order, self.lines = parts, in_order, lines
        self.motions, self.ground, self.tree, self.evaluation = motions, ground, tree, evaluation
        self.auto_joints: dict[str, str] = {}

    def place_parts(self) -> None:
        """Place every part: stated poses first, then images and parts placed by a joint, each after those that it needs."""
        for part in self.in_order:
            if isinstance(part.form, PartSpec) and isinstance(part.form.rest_pose, Pose):
                part.T = self.evaluation.pose(part.form.rest_pose, f"{part.where}.rest_pose")
                frames.read_frames(part, self.evaluation)
        placed: set[str] = set()
        for part in self.in_order:
            self._place(part, placed, ())

    def _place(self, part: DraftPart, placed: set[str], path: tuple[str, ...]) -> None:
        if part.name in placed:
            return
        if part.name in path:
            circle = " -> ".join((*path[path.index(part.name) :], part.name))
            hint = f"Give {part.name} a rest_pose with numbers."
            message = f"Parts wait for each other to be placed: {circle}."
            self.evaluation.report("E_REST_AUTO", f"{part.where}.rest_pose", message, hint, parts=(part.name,))
            return
        if part.source is not None:
            source = self.parts[part.source]
            self._place(source, placed, (*path, part.name))
            place(part, source, self.evaluation)
        elif part.auto:
            self._place_by_joint(part, placed, (*path, part.name))
        placed.add(part.name)

    def _place_by_joint(self, part: DraftPart, placed: set[str], path: tuple[str, ...]) -> None:
        """Place a part with `rest_pose: "auto"` from the joint to its parent in the tree."""
        where = f"{part.where}.rest_pose"
        if part.name == self.ground:
            message = "The ground cannot be placed by a joint: everything else is measured from it."
            self.evaluation.report("E_REST_AUTO", where, message, "Give the ground a rest_pose, or leave it out.", parts=(part.name,))
        edge = None if self.tree is None else self.tree.edge(part.name)
        if edge is None:
            frames.read_frames(part, self.evaluation)  # reports its own faults; the part stays unplaced
            return
        near = self.parts[edge.parent]
        self._place(near, placed, path)
        name = edge.joint.name
        own, other = (
            (edge.joint.parent_connector, edge.joint.child_connector)
            if edge.reversed
            else (edge.joint.child_connector, edge.joint.parent_connector)
        )
        spec = next((spec for spec in part.connector_specs if spec.name == own), None)
        if spec is not None and spec.frame == "assembly":
            message = f"{part.name} is placed by joint {name!r}, but its connector {own!r} is given in the assembly's frame."
            hint = f'Give {own!r} in the part\'s own frame ("frame": "part"), or give {part.name} a rest_pose.'
            self.evaluation.report("E_REST_AUTO", where, message, hint, parts=(part.name,))
            return
        frames.read_frames(part, self.evaluation)
        frames.settle_alone(part, [own])
        C_near, C_own, known = self._connector_pose(near, other), self._connector_pose(part, own), self.motions.get(name)
        if near.T is not None and C_near is not None and C_own is not None and known is not None:
            J, mate = known.type.motion(known.rest, known.lead), self._mate(name)
            if edge.reversed:
                part.T = parent_pose(near.T, C_own, J, mate, C_near)
            else:
                part.T = child_pose(near.T, C_near, J, mate, C_own)
            frames.read_frames(part, self.evaluation)  # now connectors in the assembly's frame can be read as well
        self.auto_joints[name] = part.name

    def _connector_pose(self, part: DraftPart, name: str) -> SE3 | None:
        """Return a connector in its part's frame before all frames are settled: a missing x is the world axis."""
        root = part
        while root.source is not None:
            root = self.parts[root.source]
        frames.settle_alone(root, [name])
        frame = root.frames.get(name)
        if frame is None or frame.x is None:
            return None
        pose = SE3.from_rotation(np.stack([frame.x, np.cross(frame.z, frame.x), frame.z], axis=-1), frame.o)
        return self._image(part, pose)

    def _image(self, part: DraftPart, pose: SE3) -> SE3 | None:
        """Return a frame of the root part as transformed to an image of that part."""
        if part.source is None:
            return pose
        inner = self._image(self.parts[part.source], pose)
        if inner is None or part.op != "mirror":
            return inner
        return None if part.S is None else SE3.from_matrix(part.S @ inner.matrix @ np.diag([1.0, -1.0, 1.0, 1.0]))

    def settle_frames(self) -> None:
        """Choose every x that is not stated, and finish all connectors."""
        links = {line.name: self._link(line) for line in self.lines}
        plain: list[frames.RestLink] = []
        rest: list[frames.RestLink] = []
        for line in self.lines:
            ends = line.ends
            derived = any(part in self.parts and self.parts[part].derived for part, _ in ends)
            (rest if derived else plain).append(links[line.name])
        frames.settle(plain, self.parts)
        for part in self.in_order:
            if part.source is not None and not self.parts[part.source].derived:
                frames.settle_alone(self.parts[part.source])
        own = [part for part in self.in_order if not part.derived]
        sources = {part.source for part in self.in_order if part.source is not None}
        frames.finish(part for part in own if part.name in sources)
        for part in self.in_order:
            if part.source is not None:
                inherit(part, self.parts[part.source])
        frames.settle(rest, self.parts)
        others = [part for part in own if part.name not in sources]
        for part in others:
            frames.settle_alone(part)
        frames.finish(others)

    def _link(self, line: JointLine) -> frames.RestLink:
        parent, child = line.ends
        known = self.motions.get(line.name)
        return frames.RestLink(parent, child, known.turn_at_rest if known else 0.0)

    def _mate(self, joint: str) -> Mate:
        return Mate(next(line.root.mate for line in self.lines if line.name == joint))
