"""An order of assembly: take everything apart, one set of parts after the other, and read that backwards.

Parts that block each other along a direction form a graph (Wilson and Latombe 1994, directional blocking graphs). A set that blocks itself
only, a strongly connected component from which no edge leaves, can be removed in that direction as a whole. So sub-assemblies need no
search: they are components of more than one part. If nothing leaves, one or two sets move aside as far as others let them, stay there, and
the search goes on from there: read backwards, they wait beside their places until others are in. Each removal, and each move aside, is proven
all along its path by `Ways`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from articad.aliases import Fastening
from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.disassembly.blocking import Blocking
from articad.disassembly.opened import Proof, folded
from articad.disassembly.poses import OtherPose
from articad.disassembly.screwing import ScrewOut, screw_out
from articad.disassembly.steps import AssemblyOrder, AssemblyStep, Blocked, Move, StopRow, Vector3
from articad.disassembly.ways import CLEAR_MM, Ways, distinct, ways_of
from articad.geometry.faces import faces_of
from articad.interference.relations import Groups
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism

__all__ = ["assembly_order"]

_ROUND: Final = (JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW, JointType.BALL, JointType.UNIVERSAL)
_BY_FORCE: Final[frozenset[Fastening]] = frozenset({"snap", "press", "circlip"})  # shapes pass through each other when these are joined
_MOST_WAYS: Final = 24  # further directions that are tried for parts that no joint's axis frees
_ROUNDED: Final = 6  # digits of numbers in the result

_FURTHER: Final = 4  # turns of directions that are tried in other configurations than rest
_STEPS: Final = (0.98, 0.94, 0.85, 0.7, 0.5, 0.25)  # of the travel in a first direction, after which a second is tried
_HALVINGS: Final = 8  # of a first move
_PARALLEL: Final = 1e-9  # of a cosine
_FAR: Final = 0.5  # of its size: a way that is longer is compared with others
_NEARER: Final = 0.5  # of that way: only a way as short replaces it
_GENTLER: Final = 0.9  # of the material that is pushed through others: only a way with less replaces it
_FLAT: Final = 1e-6  # of a unit vector's height
_LEAST_MM: Final = 0.3  # of the travel in a first direction: less is play
_ASIDE: Final = 2  # atoms that move aside for others
_MOST_ASIDE: Final = 6  # moves aside that are tried of each state, the farthest
_LIKELY: Final = 2  # parts that bound how far another one moves, before all others are asked
_MOST_COMPARED: Final = 50_000_000  # triangles of pairs of parts, in a minute or so; from there on only straight ways at rest are tried

Atom = tuple[str, ...]  # parts that stay together for now


def assembly_order(
    scene: Scene,
    poses: Mapping[str, SE3],
    ground: str,
    *,
    name: str = "assembly",
    others: Sequence[OtherPose] = (),
    fastenings: Mapping[str, Fastening] | None = None,
    mechanism: Mechanism | None = None,
    proof: Proof | None = None,
) -> AssemblyOrder:
    """Return the order in which the parts go together.

    Args:
        scene: Bodies and relations of the product.
        poses: `T_ground_part` of all parts, with z up.
        ground: The part that everything is put onto.
        name: Of the product.
        others: Further configurations in which parts may be put in place, such as a door that stands open.
        fastenings: By joint name how it is fastened, where a joint does not state it or another fastening is to be tried. Two parts that
            snap, are pressed together or held by a circlip do not stop each other. Purchased pairs are never taken apart. Screws and
            adhesive are only named.
        mechanism: Places the parts. If it is given with `proof`, what remains of a loop that was opened is moved beyond the range that it
            has in the whole product, as far as its parts let it.
        proof: Proves such a motion; what it does not prove is not done.
    """
    return _Taking(scene, poses, ground, name, others, fastenings or {}, None if proof is None else mechanism, proof).order()


@dataclass(frozen=True)
class _Aside:
    """An atom that moves aside and stays there.

    Attributes:
        atom: The atom.
        offset: Of where it stays, from its place `(3,)` [mm].
        ways: All parts before it moves.
    """

    atom: Atom
    offset: FloatArray
    ways: Ways = field(compare=False)

    @property
    def after(self) -> Ways:
        """All parts after it has moved."""
        return self.ways.beside({**self.ways.offsets, **dict.fromkeys(self.atom, self.offset)})


@dataclass(frozen=True)
class _Removal:
    """A set of atoms that leaves along a direction, after a first move if there is one, and after others have moved aside."""

    atoms: tuple[Atom, ...]
    way: FloatArray
    ways: Ways = field(compare=False)
    at: dict[str, float]
    first: FloatArray
    key: tuple[float, ...] = field(compare=False)
    opened: bool = False
    aside: tuple[_Aside, ...] = ()
    screw: ScrewOut | None = field(default=None, compare=False)

    @property
    def parts(self) -> tuple[str, ...]:
        return tuple(name for atom in self.atoms for name in atom)


class _Taking:
    """Takes an assembly apart."""

    def __init__(
        self,
        scene: Scene,
        poses: Mapping[str, SE3],
        ground: str,
        name: str,
        others: Sequence[OtherPose],
        fastenings: Mapping[str, Fastening],
        mechanism: Mechanism | None,
        proof: Proof | None,
    ) -> None:
        self.scene, self.name, self.poses = scene, name, poses
        self.mechanism, self.proof = mechanism, proof
        self.joints = tuple(joint for joint in scene.relations.joints if joint.type is not JointType.FREE)
        stated = {joint.name: joint.fastening for joint in self.joints if joint.fastening is not None}
        self.fastenings: dict[str, Fastening] = {**stated, **fastenings}
        pairs = {joint.name: frozenset((joint.parent, joint.child)) for joint in self.joints}
        self.forced = {pairs[joint]: how for joint, how in self.fastenings.items() if how in _BY_FORCE}
        self.ways = Ways(scene, poses, self.forced)
        self.open = [(Ways(scene, other.poses, self.forced, self.ways.outlines), other.at) for other in others]
        self.parts = tuple(name for name in self.ways.parts if name not in scene.environment)
        self.left_out = tuple(sorted(scene.broken))
        self.units = Groups(self.parts)  # parts that are bought as one
        for joint in self.joints:
            if self.fastenings.get(joint.name) == "purchased" and {joint.parent, joint.child} <= set(self.parts):
                self.units.join(joint.parent, joint.child)
        self.base = ground if ground in self.parts else self._heaviest(self.parts)
        self.height = {name: float(self.ways.points(name)[:, 2].mean()) for name in self.parts}
        self.declared = {name: at for at, name in enumerate(self.parts)}
        self.hops = self._hops()
        self.blocked: list[Blocked] = []

    def order(self) -> AssemblyOrder:
        """Return the order."""
        together, first = Groups(self.parts), dict[str, str]()
        for part in self.parts:
            for whole in (self.scene.relations.rigid.leader(part), f"unit {self.units.leader(part)}"):
                together.join(first.setdefault(whole, part), part)
        steps = list(self._steps(together.sets(), self.base, self.name))
        numbered = tuple(step.model_copy(update={"number": at + 1}) for at, step in enumerate(steps))
        return AssemblyOrder(
            schema="articad.order/1",
            name=self.name,
            base=self.base,
            steps=numbered,
            blocked=tuple(self.blocked),
            left_out=self.left_out,
        )

    def _steps(self, atoms: Sequence[Atom], base: str, name: str) -> Iterator[AssemblyStep]:
        """Yield the steps that put atoms together."""
        left, removed, ways = self._taken_apart(atoms, base)
        placed = [part for atom in left for part in atom]
        yield from self._start(left, placed, base, name, ways)
        named: dict[Atom, str] = {}
        for removal in reversed(removed):
            if isinstance(removal, _Aside):
                yield self._back(removal, placed, name, named.get(removal.atom))
                continue
            moving, own = removal.parts, None
            if len(moving) > 1:
                first = min(moving, key=lambda part: (self.hops.get(part, len(self.parts)), self.declared[part]))
                own = named[moving] = f"{first}_assembly"
                inner = removal.atoms if len(removal.atoms) > 1 else self._split(moving)
                yield from self._steps(inner, first, own)
            yield self._step(removal, placed, name, own)
            placed += moving

    def _taken_apart(self, atoms: Sequence[Atom], base: str) -> tuple[list[Atom], list[_Removal | _Aside], Ways]:
        """Return what of some atoms stays, what was done to take the others away, and all parts as they stand then."""
        left, ways = list(atoms), self.ways
        removed: list[_Removal | _Aside] = []
        while len(left) > 1:
            if not any(part in ways.offsets for atom in left for part in atom):
                ways = self.ways
            found = self._next(left, base, ways)
            if found is None:
                apart = self._split(part for atom in left for part in atom)  # perhaps only single parts can leave
                if len(apart) == len(left):
                    self._report(left, ways)
                    break
                left = apart
                continue
            found = self._nearer(found, [part for atom in left if atom not in found.atoms for part in atom])
            removed += [*found.aside, found]
            ways = found.aside[-1].after if found.aside else ways
            left = [atom for atom in left if atom not in found.atoms]
        return left, removed, ways

    def _start(self, left: Sequence[Atom], placed: Sequence[str], base: str, name: str, ways: Ways) -> Iterator[AssemblyStep]:
        """Yield the steps that lay down what all else is put onto."""
        if len(left) == 1 and len(self._split(placed)) > 1:  # the base is itself several parts
            yield from self._steps(self._split(placed), base, name)
        elif len(left) == 1 and len(placed) > 1:
            bought = tuple(
                (joint.parent, joint.child, "purchased")
                for joint in self.joints
                if self.fastenings.get(joint.name) == "purchased" and {joint.parent, joint.child} <= set(placed)
            )
            whole = f"{base}_as_bought"
            yield AssemblyStep(
                number=0, assembly=name, parts=tuple(placed), subassembly=whole, onto=(), moves=(), strength="permitted", permitted=bought
            )
        elif len(placed) > 1:
            yield AssemblyStep(
                number=0,
                assembly=name,
                parts=tuple(placed),
                subassembly=f"{base}_and_others",
                onto=(),
                moves=(),
                beside=_beside(ways, placed),
            )
        else:
            yield AssemblyStep(number=0, assembly=name, parts=tuple(placed), onto=(), moves=())

    def _split(self, parts: Iterable[str]) -> list[Atom]:
        """Return parts one by one, but for those that are bought as one."""
        units: dict[str, list[str]] = {}
        for part in parts:
            units.setdefault(self.units.leader(part), []).append(part)
        return [tuple(unit) for unit in units.values()]

    def _step(self, removal: _Removal, placed: Sequence[str], name: str, own: str | None) -> AssemblyStep:
        moving = removal.parts
        joints = self._between(moving, placed)
        partners = [part for part in placed if any(part in (joint.parent, joint.child) for joint in joints)]
        ways, way, first = removal.ways, removal.way, removal.first
        joints = [joint for joint in joints if not ways.apart(joint.parent, joint.child).any()]
        forced = tuple(
            (a, b, self.forced[frozenset((a, b))])
            for a in moving
            for b in placed
            if frozenset((a, b)) in self.forced and (ways.meets(a, b, way, first) or (first.any() and ways.meets(a, b, _unit(first))))
        )
        along = float(first @ way)
        moves = [
            Move(
                direction=_vector(-way),
                length_mm=round(max(0.0, ways.clear_length(moving, placed, way) - along), _ROUNDED),
                apart_mm=round(max(0.0, ways.clear_length(moving, partners or placed, way) - along), _ROUNDED),
            )
        ]
        if first.any():
            moves.append(_first_move(first, removal.screw))
        if removal.screw is not None:
            forced += ((*removal.screw.pair, "screw"),)
        return AssemblyStep(
            number=0,
            assembly=name,
            parts=moving,
            subassembly=own,
            onto=tuple(placed),
            moves=tuple(moves),
            at=removal.at,
            beside=_beside(ways, [*moving, *placed]),
            opened=removal.opened,
            joints=tuple(joint.name for joint in joints),
            fastened={joint.name: self.fastenings[joint.name] for joint in joints if joint.name in self.fastenings},
            strength="permitted" if forced else "proven",
            permitted=forced,
            forced_mm=round(self._overlap(moving, placed, way, ways), _ROUNDED) if forced and not first.any() else 0.0,
        )

    def _between(self, moving: Sequence[str], staying: Sequence[str]) -> list[Joint]:
        """Return the joints of which one part moves and the other one stays."""
        there = {*moving, *staying}
        across = (joint for joint in self.joints if (joint.parent in moving) != (joint.child in moving))
        return [joint for joint in across if {joint.parent, joint.child} <= there]

    def _back(self, aside: _Aside, placed: Sequence[str], name: str, own: str | None) -> AssemblyStep:
        """Return the step that moves parts, which wait beside their place, to it."""
        moving, staying, way = aside.atom, [part for part in placed if part not in aside.atom], _unit(aside.offset)
        length, after = float(np.linalg.norm(aside.offset)), aside.after
        joints = [joint for joint in self._between(moving, staying) if after.apart(joint.parent, joint.child).any()]
        joints = [joint for joint in joints if not aside.ways.apart(joint.parent, joint.child).any()]
        pairs = [(a, b) for a in moving for b in staying if frozenset((a, b)) in self.forced and aside.ways.travel(a, b, way) < length]
        return AssemblyStep(
            number=0,
            assembly=name,
            parts=moving,
            subassembly=own,
            onto=tuple(staying),
            moves=(Move(direction=_vector(-way), length_mm=round(length, _ROUNDED), apart_mm=round(length, _ROUNDED)),),
            slides=True,
            beside=_beside(aside.ways, placed),
            joints=tuple(joint.name for joint in joints),
            fastened={joint.name: self.fastenings[joint.name] for joint in joints if joint.name in self.fastenings},
            strength="permitted" if pairs else "proven",
            permitted=tuple((a, b, self.forced[frozenset((a, b))]) for a, b in pairs),
        )

    # ------------------------------------------------------------------ what can be removed

    def _next(self, left: Sequence[Atom], base: str, ways: Ways) -> _Removal | None:
        """Return what leaves next, or None. While parts are aside, the others stay at rest."""
        if ways.offsets:
            return self._removable(left, base, ways) or self._in_two_moves(left, base, ways) or self._after_others(left, base, ways)
        return (
            self._removable(left, base)
            or self._unscrewed(left, base)
            or self._elsewhere(left, base)
            or self._in_two_moves(left, base, ways)
            or self._folded(left, base)
            or self._after_others(left, base, ways)
        )

    def _is_late(self) -> bool:
        """Return whether so much was compared that only straight ways at rest are still tried."""
        return self.ways.outlines.compared > _MOST_COMPARED

    def _after_others(self, left: Sequence[Atom], base: str, ways: Ways) -> _Removal | None:
        """Return what can leave when one or two atoms have moved aside, each in a straight line as far as others let it."""
        states: list[tuple[_Aside, ...]] = [()]
        for _ in range(_ASIDE):
            further: dict[frozenset[tuple[float | str, ...]], tuple[_Aside, ...]] = {}
            for state in states:
                for aside in [] if self._is_late() else self._asides(left, base, state[-1].after if state else ways):
                    chosen = (*state, aside)
                    further.setdefault(frozenset((*each.atom, *each.offset.tolist()) for each in chosen), chosen)
            states = list(further.values())
            for state in states:
                if self._is_late():
                    return None
                after = state[-1].after
                found = self._removable(left, base, after) or self._in_two_moves(left, base, after)
                if found is not None:
                    return replace(found, aside=state)
        return None

    def _asides(self, left: Sequence[Atom], base: str, ways: Ways) -> list[_Aside]:
        """Return the moves aside of atoms that are at their places, the farthest first."""
        found: list[tuple[float, _Aside]] = []
        for atom in left:
            if base in atom or any(part in ways.offsets for part in atom):
                continue
            rest = [name for other in left if other != atom for name in other]
            for way in distinct([*np.eye(3), *self._joint_axes(atom, ways)]):
                travel = ways.stop(atom, rest, way, least=CLEAR_MM).travel
                if CLEAR_MM < travel < np.inf:
                    found.append((travel, _Aside(atom, _STEPS[0] * travel * way, ways)))
        return [aside for _, aside in sorted(found, key=lambda row: -row[0])[:_MOST_ASIDE]]

    def _removable(
        self, left: Sequence[Atom], base: str, ways: Ways | None = None, at: Mapping[str, float] | None = None
    ) -> _Removal | None:
        """Return the best set of atoms that can leave in a straight line, or None.

        Sets that leave the rest connected come first, then those of which least material is pushed through what they are joined to by
        force, then those that leave upwards, so that parts are lowered into place, then sideways.

        Args:
            left: The atoms.
            base: The part that stays.
            ways: The parts at one pose; at rest by default.
            at: Values of the drivers of that pose.
        """
        ways, best = ways or self.ways, None
        for rank, directions in enumerate(self._directions(left, ways)):
            if rank >= _FURTHER and (ways is not self.ways or (best is not None and best.key[0] == 0)):
                break
            for way in directions:
                for atoms, direction in self._leaving(left, base, way, ways):
                    moving = [name for atom in atoms for name in atom]
                    if any(ways.apart(moving[0], name).any() for name in moving):
                        continue  # their sub-assembly is made at rest
                    key = self._key(atoms, left, direction, rank, self._met(atoms, left, direction, ways))
                    found = _Removal(atoms, direction, ways, dict(at or {}), np.zeros(3), key)
                    if best is None or found.key < best.key:
                        best = found
            if best is not None and best.key[:2] == (0.0, 0.0):
                return best
        return best

    def _elsewhere(self, left: Sequence[Atom], base: str) -> _Removal | None:
        """Return what can leave in another configuration."""
        for ways, at in self.open:
            if self._is_late():
                return None
            found = self._removable(left, base, ways, at)
            if found is not None:
                return found
        return None

    def _folded(self, left: Sequence[Atom], base: str) -> _Removal | None:
        """Return what can leave when the rest of a loop that was opened is moved beyond the range that it has in the whole product."""
        if self.mechanism is None or self.proof is None:
            return None
        parts = [name for atom in left for name in atom]
        for pose in folded(self.scene, self.mechanism, parts, base):
            if self._is_late():
                return None
            ways = Ways(self.scene, {**self.poses, **pose.poses}, self.forced, self.ways.outlines)
            found = self._removable(left, base, ways, {pose.joint: pose.value})
            if found is not None and self.proof(pose.mechanism, pose.joint):
                return replace(found, opened=True)
        return None

    def _unscrewed(self, left: Sequence[Atom], base: str) -> _Removal | None:
        """Return an atom that is turned out of a thread, and then leaves along its axis."""
        for joint in (each for each in self.joints if each.type is JointType.SCREW):
            for atom in left:
                rest = [name for other in left if other != atom for name in other]
                if base in atom or (joint.parent in atom) == (joint.child in atom) or not {joint.parent, joint.child} <= {*atom, *rest}:
                    continue
                for sense in (1.0, -1.0):
                    out = None if self._is_late() else screw_out(self.ways, joint, atom, rest, sense)
                    if out is not None and self.ways.free(atom, rest, _unit(out.offset), offset=out.offset):
                        key = self._key((atom,), left, out.offset, 0)
                        return _Removal((atom,), _unit(out.offset), self.ways, {}, out.offset, key, screw=out)
        return None

    def _nearer(self, found: _Removal, staying: Sequence[str]) -> _Removal:
        """Return the removal in a direction in which it is clear of its partners much sooner, if its way is long for its size.

        A handle comes from the front of its door, not from above, all along the door.
        """
        moving, ways = found.parts, found.ways
        if found.screw is not None:
            return found
        if any(frozenset((a, b)) in self.forced for a in moving for b in staying):
            return self._gentlest(found, staying)
        joined = {end for joint in self.joints for end in (joint.parent, joint.child) if {joint.parent, joint.child} & set(moving)}
        partners = [name for name in staying if name in joined] or staying
        points = np.concatenate([ways.points(name) for name in moving])
        size, length = float(np.linalg.norm(np.ptp(points, axis=0))), ways.clear_length(moving, partners, found.way)
        if found.first.any() or length <= _FAR * size:
            return found
        best = (_NEARER * length, found.way)
        for way in distinct([axis for name in moving for axis in ways_of(self.scene, ways.poses, name)]):
            away = ways.clear_length(moving, partners, way)
            rises = float(way[2]) >= -_FLAT or float(found.way[2]) < -_FLAT  # nothing comes from below that can come from elsewhere
            if away < best[0] and rises and ways.free(moving, staying, way):
                best = (away, way)
        return replace(found, way=best[1])

    def _gentlest(self, found: _Removal, staying: Sequence[str]) -> _Removal:
        """Return the removal in the direction in which least material is pushed through what the parts are joined to by force."""
        if found.first.any():
            return found
        moving, ways = found.parts, found.ways
        best = (self._met([moving], [moving, tuple(staying)], found.way, ways), found.way)
        for way in distinct([*np.eye(3), *(axis for name in moving for axis in ways_of(self.scene, ways.poses, name))]):
            if best[0] > 0.0 and ways.free(moving, staying, way):
                met = self._met([moving], [moving, tuple(staying)], way, ways)
                if met < _GENTLER * best[0]:
                    best = (met, way)
        return replace(found, way=best[1])

    def _met(self, atoms: Sequence[Atom], left: Sequence[Atom], way: FloatArray, ways: Ways) -> float:
        """Return how much material of atoms is pushed through parts that they are joined to by force, to two digits [mm³]."""
        moving = [name for atom in atoms for name in atom]
        pairs = [(a, b) for a in moving for atom in left for b in atom if b not in moving and frozenset((a, b)) in self.forced]
        return float(f"{sum(ways.met(a, b, way) for a, b in pairs if ways.meets(a, b, way)):.2g}")

    def _overlap(self, moving: Sequence[str], staying: Sequence[str], way: FloatArray, ways: Ways) -> float:
        """Return how far from its place a pair that is joined by force first meets when it comes from outside [mm]."""
        far = ways.clear_length(moving, staying, way)
        pairs = [(a, b) for a in moving for b in staying if frozenset((a, b)) in self.forced and ways.meets(a, b, way)]
        return max((far - ways.travel(a, b, -way, far * way) for a, b in pairs), default=0.0)

    def _in_two_moves(self, left: Sequence[Atom], base: str, ways: Ways) -> _Removal | None:
        """Return an atom that leaves after a first move in another direction: out of a keyhole, over a lip."""
        for atom in sorted((atom for atom in left if base not in atom), key=len):
            rest = [name for other in left if other != atom for name in other]
            directions = distinct([*np.eye(3), *self._joint_axes(atom, ways)])
            for first in directions:
                if self._is_late():
                    return None
                travel = ways.stop(atom, rest, first, least=_LEAST_MM).travel
                if not _LEAST_MM < travel < np.inf:
                    continue
                for share in _STEPS:
                    moved = share * travel * first
                    for way in directions:
                        if abs(float(way @ first)) < 1 - _PARALLEL and ways.free(atom, rest, way, offset=moved):
                            moved = self._shortened(atom, rest, moved, way, ways)
                            return _Removal((atom,), way, ways, {}, moved, self._key((atom,), left, way, 0))
        return None

    def _shortened(self, atom: Atom, rest: Sequence[str], moved: FloatArray, way: FloatArray, ways: Ways) -> FloatArray:
        """Return a first move, halved as often as the second one stays free after it."""
        for _ in range(_HALVINGS):
            half = moved / 2
            if float(np.linalg.norm(half)) < _LEAST_MM or not ways.free(atom, rest, way, offset=half):
                break
            moved = half
        return moved

    def _joint_axes(self, names: Iterable[str], ways: Ways) -> list[FloatArray]:
        inside = set(names)
        return [ways.poses[j.parent].rotation @ j.T_parent_connector.z_axis for j in self.joints if {j.parent, j.child} & inside]

    def _directions(self, left: Sequence[Atom], ways: Ways) -> Iterator[FloatArray]:
        """Yield directions in turns: up, sideways, down, along axes of joints, along normals and axes of faces."""
        known = [*np.eye(3)]
        yield np.array([[0.0, 0.0, 1.0]])
        yield distinct(known[:2])
        yield np.array([[0.0, 0.0, -1.0]])
        names = sorted(name for atom in left for name in atom)
        axes = self._joint_axes(names, ways)
        yield _new(axes, known)
        known += axes
        yield _new([way for name in names for way in ways_of(self.scene, ways.poses, name)], known)[:_MOST_WAYS]
        yield _new([axis for name in names for axis in self._face_axes(name, ways)], known)[:_MOST_WAYS]

    def _face_axes(self, name: str, ways: Ways) -> list[FloatArray]:
        faces = [face for face in faces_of(self.scene.bodies[name].mesh) if face.kind in ("cylinder", "plane")]
        faces.sort(key=lambda face: -len(face.corners))
        return [ways.poses[name].rotation @ face.axis for face in faces[:_MOST_WAYS]]

    def _leaving(self, left: Sequence[Atom], base: str, way: FloatArray, ways: Ways) -> Iterator[tuple[tuple[Atom, ...], FloatArray]]:
        """Yield the smallest sets that leave along a direction, the base not among them, and their direction."""
        blocking = Blocking(
            len(left),
            lambda i, j: any(ways.blocks(p, q, way) for p in left[i] for q in left[j]),
            lambda i, j: sum(ways.often(p, q) for p in left[i] for q in left[j]),
        )
        for inside in blocking.closed(range(len(left))):
            if not any(base in left[at] for at in inside):
                yield tuple(left[at] for at in inside), way
                continue
            others = [at for at in range(len(left)) if at not in inside]
            if others and blocking.closed(others) == [others]:  # all others leave the base together, the opposite way
                yield tuple(left[at] for at in others), -way

    def _key(self, atoms: tuple[Atom, ...], left: Sequence[Atom], way: FloatArray, rank: int, met: float = 0.0) -> tuple[float, ...]:
        names = [name for atom in atoms for name in atom]
        rest = [name for atom in left if atom not in atoms for name in atom]
        loose = self._pieces(rest) + self._pieces(names) - 1 > self._pieces([*names, *rest])
        sinks = float(way[2]) < -_FLAT  # it would be put in place from below
        return (
            float(loose),
            met,
            float(sinks),
            float(rank),
            float(len(names)),
            -max(self.height[n] for n in names),
            -self.declared[names[-1]],
        )

    def _pieces(self, names: Iterable[str]) -> int:
        """Return how many pieces joints leave of some parts."""
        groups = Groups(names)
        inside = set(names)
        for joint in self.joints:
            if {joint.parent, joint.child} <= inside:
                groups.join(joint.parent, joint.child)
        return len({groups.leader(name) for name in inside})

    def _hops(self) -> dict[str, int]:
        """Return over how many joints each part hangs from the base; a sub-assembly begins with the part that hangs nearest."""
        hops, todo = {self.base: 0}, [self.base]
        for name in todo:
            for joint in self.joints:
                if name in (joint.parent, joint.child):
                    other = joint.child if name == joint.parent else joint.parent
                    if other not in hops:
                        hops[other] = hops[name] + 1
                        todo.append(other)
        return hops

    def _heaviest(self, names: Sequence[str]) -> str:
        return max(names, key=lambda name: (self.scene.bodies[name].volume, name))

    # ------------------------------------------------------------------ what cannot

    def _report(self, left: Sequence[Atom], ways: Ways) -> None:
        """Record parts that hold each other, with what stops each."""
        names = tuple(name for atom in left for name in atom)
        rows = (self._farthest(name, [other for other in names if other != name], ways) for name in names)
        stops = tuple(row for row in rows if row is not None)
        self.blocked.append(Blocked(parts=names, stops=stops, remedy=self._remedy(names), ended=self._is_late()))

    def _farthest(self, name: str, others: Sequence[str], ways: Ways) -> StopRow | None:
        """Return in which of its directions a part moves farthest before another one stops it; None if nothing stops it in any."""
        directions, best = distinct([*np.eye(3), *self._joint_axes([name], ways)]), None
        likely = sorted(others, key=lambda other: -ways.often(name, other))[:_LIKELY]
        bounds = np.array([ways.stop([name], likely, way).travel for way in directions])
        for at in np.argsort(-bounds, kind="stable").tolist():
            known = -np.inf if best is None else best.travel_mm
            if bounds[at] <= known:
                break
            stop = ways.stop([name], others, directions[at], least=known)
            if stop.by is not None and stop.travel > known:
                best = StopRow(part=name, direction=_vector(directions[at]), travel_mm=round(stop.travel, _ROUNDED), by=stop.by)
        return best

    def _remedy(self, names: Sequence[str]) -> str:
        joints = [joint for joint in self.joints if {joint.parent, joint.child} <= set(names)]
        round_one = next((joint for joint in joints if joint.type in _ROUND), None)
        if round_one is not None:
            return (
                f"Split the bearing of {round_one.name!r}, open its side to a slot, or make its pin a part of its own; if it snaps or is "
                f"pressed into place, set joints.{round_one.name}.fastening to 'snap' or 'press', or try assembly_order(fastenings={{{round_one.name!r}: 'snap'}})."
            )
        return f"Open one side of {names[0]}, make one of the parts as two, or set the fastening of the joint that snaps, is pressed or is bought as one piece."


def _first_move(first: FloatArray, screw: ScrewOut | None) -> Move:
    """Return the move to its place of a part that leaves it by an offset `(3,)` [mm] first, perhaps along a thread."""
    length, direction = round(float(np.linalg.norm(first)), _ROUNDED), _vector(-_unit(first))
    if screw is None:
        return Move(direction=direction, length_mm=length, apart_mm=length)
    return Move(
        kind="screw", direction=direction, length_mm=length, apart_mm=length, turns=float(screw.turns), axis_point=_offset(screw.point)
    )


def _new(axes: Iterable[FloatArray], known: Sequence[FloatArray]) -> FloatArray:
    """Return axes and their opposites, without those that are known."""
    rows = [axis for axis in distinct(list(axes)) if not any(min(np.linalg.norm(axis - k), np.linalg.norm(axis + k)) < 1e-6 for k in known)]
    return np.array(rows).reshape(-1, 3)


def _beside(ways: Ways, parts: Iterable[str]) -> dict[str, Vector3]:
    """Return by how much some parts are beside their places [mm], those that are."""
    inside = set(parts)
    return {name: _offset(offset) for name, offset in ways.offsets.items() if name in inside and offset.any()}


def _offset(offset: FloatArray) -> Vector3:
    x, y, z = (round(float(value), _ROUNDED) + 0.0 for value in offset)
    return (x, y, z)


def _unit(way: FloatArray) -> FloatArray:
    return np.asarray(way / np.linalg.norm(way))


def _vector(way: FloatArray) -> Vector3:
    x, y, z = (round(float(value), 9) + 0.0 for value in way)
    return (x, y, z)
