"""Frames: connectors from origin, z and x, and a rule that chooses x where none is stated.

The rule goes through the joints, first those between parts that are not derived, then the rest, each in the order in which they are
declared. If one side has an x, the other takes the x for which the roll at rest is zero. If neither has, the parent takes the world axis
least parallel to its z, and the child follows. Choosing the world axis on both sides would turn a mirrored door by 180° without notice.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.connectors import SE3, Connector, axis_findings, world_x
from articad.connectors.se3 import project_across
from articad.plan.derive import DraftConnector, DraftPart
from articad.plan.evaluation import Evaluation, Triple

_ACROSS_ZERO = 1e-9  # length below which a projected x has no direction; happens only where the two z axes differ by much
_PLAIN_LENGTH = 1e-3  # an axis this long is certainly valid; shorter ones are examined


class RestLink(NamedTuple):
    """A joint as far as rule 3 needs it.

    Attributes:
        parent: Part and connector name.
        child: Part and connector name.
        turn: Angle about the parent's z at rest [rad].
    """

    parent: tuple[str, str]
    child: tuple[str, str]
    turn: float


def read_frames(part: DraftPart, evaluation: Evaluation) -> None:
    """Evaluate the connectors of a part that is not derived; report invalid axes and leave these out of `part.frames`.

    Connectors stated in the assembly's frame are transformed to the part's; without a rest pose they are left out.
    """
    assert part.spec is not None
    for spec in part.spec.connectors:
        if spec.name in part.frames:
            continue  # reported as E_DUP_NAME; the first counts
        where = f"{part.where}.connectors.{spec.name}"
        o, z = evaluation.triple(spec.o, where, "o"), evaluation.triple(spec.z, where, "z")
        x = None if spec.x is None else evaluation.triple(spec.x, where, "x")
        if math.isnan(sum(o) + sum(z) + (sum(x) if x else 0.0)):
            continue
        if not _plainly_good(z, x):
            findings = axis_findings(o, z, x, where=where)
            evaluation.findings.extend(findings)
            if not findings.ok:
                continue
        frame = DraftConnector(spec, where, np.array(o), _unit(np.array(z)), None if x is None else np.array(x))
        if spec.frame == "assembly":
            if part.T is None:
                continue
            into_part = part.T.inverse()
            frame.o, frame.z = into_part.apply(frame.o), into_part.rotate(frame.z)
            frame.x = None if frame.x is None else into_part.rotate(frame.x)
        if frame.x is not None:
            frame.x = project_across(frame.x, frame.z)
        part.frames[spec.name] = frame


def _plainly_good(z: Triple, x: Triple | None) -> bool:
    """Return whether axes need no further check: far from zero length, and x exactly perpendicular to z."""
    if math.hypot(*z) < _PLAIN_LENGTH:
        return False
    return x is None or (math.hypot(*x) >= _PLAIN_LENGTH and x[0] * z[0] + x[1] * z[1] + x[2] * z[2] == 0.0)


def settle(links: Iterable[RestLink], parts: Mapping[str, DraftPart]) -> None:
    """Give an x to the connectors of these joints that have none, joint by joint in the order given."""
    for link in links:
        parent, child = (_side(part, connector, parts) for part, connector in (link.parent, link.child))
        if parent is None or child is None or (parent.x is not None and child.x is not None):
            continue
        if parent.x is None and child.x is None:
            parent.choose()
        if child.x is None:
            child.take(_turned(parent.world_x, parent.world_z, link.turn))
        else:
            parent.take(_turned(child.world_x, parent.world_z, -link.turn))


def settle_alone(part: DraftPart, names: Iterable[str] | None = None) -> None:
    """Give the world axis to the connectors of a part that still have no x; its own axes if it has no rest pose yet."""
    for name in part.frames if names is None else names:
        frame = part.frames.get(name)
        if frame is not None and frame.x is None:
            _Side(part, frame).choose()


def finish(parts: Iterable[DraftPart]) -> None:
    """Make the connectors of all frames, in one batch."""
    slots = [(part, name, frame) for part in parts for name, frame in part.frames.items() if frame.x is not None]
    if not slots:
        return
    z, x = np.array([frame.z for _, _, frame in slots]), np.array([frame.x for _, _, frame in slots])
    rotations = np.stack([x, np.cross(z, x), z], axis=-1)
    poses = SE3.from_rotation(rotations, np.array([frame.o for _, _, frame in slots]))
    for index, (part, name, frame) in enumerate(slots):
        spec = frame.spec
        part.connectors[name] = Connector(name, poses[index], label=spec.label, kind=spec.kind, roll_free=spec.x is None)


class _Side:
    """One connector of a joint, in the frame of the assembly at rest."""

    def __init__(self, part: DraftPart, frame: DraftConnector | Connector) -> None:
        self.T = SE3.identity() if part.T is None else part.T
        self.frame = frame

    @property
    def x(self) -> FloatArray | None:
        return self.frame.x if isinstance(self.frame, DraftConnector) else self.frame.frame.x_axis

    @property
    def world_x(self) -> FloatArray:
        assert self.x is not None
        return self.T.rotate(self.x)

    @property
    def world_z(self) -> FloatArray:
        return self.T.rotate(self.frame.z if isinstance(self.frame, DraftConnector) else self.frame.frame.z_axis)

    def choose(self) -> None:
        """Take the world axis least parallel to z as x."""
        self.take(world_x(self.world_z))

    def take(self, x: FloatArray) -> None:
        """Take this direction of the assembly's frame, projected across z; the world axis if nothing is left of it."""
        assert isinstance(self.frame, DraftConnector)
        z = self.world_z
        across = x - (x @ z) * z
        self.frame.x = project_across(self.T.inverse().rotate(x if across @ across > _ACROSS_ZERO**2 else world_x(z)), self.frame.z)


def _side(part: str, connector: str, parts: Mapping[str, DraftPart]) -> _Side | None:
    draft = parts.get(part)
    if draft is None or draft.T is None:
        return None
    frame = draft.connectors.get(connector, draft.frames.get(connector))
    return None if frame is None else _Side(draft, frame)


def _turned(x: FloatArray, z: FloatArray, angle: float) -> FloatArray:
    """Turn x about the unit vector z by an angle [rad]."""
    if angle == 0.0:
        return x
    turned: FloatArray = math.cos(angle) * x + math.sin(angle) * np.cross(z, x) + (1.0 - math.cos(angle)) * (x @ z) * z
    return turned


def _unit(v: FloatArray) -> FloatArray:
    unit: FloatArray = v / np.sqrt(v @ v)
    return unit
