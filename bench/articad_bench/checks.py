"""The checks of a task: data that says what must hold, judged by measurement alone, whichever tool made the assembly.

Nothing is looked up by name, because each tool chooses its own names: a joint is identified by its type, its axis and its range,
a part by its size. Each judgement says what was wanted and what was measured.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from typing import Annotated, Any, Final, Literal

import numpy as np
from pydantic import Field

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.certificates.fits import CONTACT_MM
from articad.connectors import SE3, Mate
from articad.disassembly.ways import Ways, ways_of
from articad.interference.freedoms import freedoms
from articad.interference.gauge import Gauge, placed
from articad.kinematics.joints import Joint, JointLimits, JointType
from articad.plan.resolve import Fit
from articad.simulation.examine import simulate_assembly, simulate_file
from articad_bench.around import share_around
from articad_bench.bodies import carried, moved_bodies, moving, parts_of
from articad_bench.check import Bounds, Vector, in_words, within
from articad_bench.check import Check as Check  # noqa: PLC0414  (others take them from here)
from articad_bench.check import Judgement as Judgement  # noqa: PLC0414
from articad_bench.edit_checks import Shifted
from articad_bench.function_checks import Effort, Folds, Passes, PutTogether
from articad_bench.gear_checks import Meshes
from articad_bench.likeness_checks import Arranged, Handed, Matter, Upright
from articad_bench.machined_checks import Machined, Toleranced
from articad_bench.module_checks import Fitted, Ordered, Spaced, Turned
from articad_bench.outline_checks import Outlined
from articad_bench.path_checks import PATH, Floor, Level, Straight, Turns
from articad_bench.proofs import proven
from articad_bench.room_checks import Room, Weighs
from articad_bench.section_checks import Section
from articad_bench.shape_checks import Holds, Holes, Passage, Stands, Studs, Symmetric, Volume, Wall
from articad_bench.solids import wall_thickness
from articad_bench.spacing_checks import Links, Square
from articad_bench.stack_checks import Stack
from articad_bench.strength_checks import Carries
from articad_bench.subject import Subject
from articad_bench.wanted import JointWanted as JointWanted  # noqa: PLC0414
from articad_bench.wanted import in_numbers, parallel
from articad_bench.whole_checks import Extent, Threads

_ABOUT_LINE: Final = frozenset({JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW})
STROKE: Final = 9  # values of a driver at which what follows it is measured
TURN: Final = 73  # the same, of one that turns without end: every five degrees, wherever it is at rest
CLOSED_MM: Final = 1e-6
LEAST_WALL_MM: Final = 0.2  # a wire or a foil is no part
WALL_SAMPLES: Final = 60
SAME_LINE_MM: Final = 0.1


class Parts(Check):
    """The number of parts that have a shape."""

    kind: Literal["parts"] = "parts"
    number: Bounds

    @property
    def wanted(self) -> str:
        return f"{in_words(self.number)} parts"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        count = len(subject.shaped)
        return self.number[0] <= count <= self.number[1], f"{count} parts"


class Freedoms(Check):
    """The number of independent motions."""

    kind: Literal["freedoms"] = "freedoms"
    number: int

    @property
    def wanted(self) -> str:
        return f"{self.number} freedoms"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        mobility = subject.assembly.mechanism.mobility
        return mobility == self.number, f"{mobility} freedoms"


class Joints(Check):
    """The number of joints of a kind."""

    kind: Literal["joints"] = "joints"
    joint: JointWanted
    number: Bounds

    @property
    def wanted(self) -> str:
        return f"{in_words(self.number)} joints: {self.joint}"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        found = self.joint.found(subject)
        others = [f"{joint.name} {joint.type} {in_numbers(subject.axis(joint))} {subject.span(joint):.4g}" for joint in moving(subject)]
        return self.number[0] <= len(found) <= self.number[1], f"{len(found)} ({'; '.join(others[:8]) or 'no joint moves'})"


class Size(Check):
    """Sides of the bounding box at rest; None where any length is accepted."""

    kind: Literal["size"] = "size"
    mm: tuple[float | None, float | None, float | None]
    tolerance: float = 0.02

    @property
    def wanted(self) -> str:
        return f"{' x '.join('any' if side is None else f'{side:g}' for side in self.mm)} mm within {100 * self.tolerance:g} %"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        size = subject.size
        ok = all(side is None or abs(found - side) <= self.tolerance * side for side, found in zip(self.mm, size, strict=True))
        return ok, f"{_by(size)} mm"


class PartSize(Check):
    """A number of parts with these sides, in any order; None where any length is accepted.

    Attributes:
        above: How high the lowest point of such a part lies above that of the whole, at rest [mm].
        fill: Least share of its box that such a part fills: a board has no window; or least and greatest share: a channel is not solid.
    """

    kind: Literal["part_size"] = "part_size"
    mm: tuple[float | None, float | None, float | None]
    number: Bounds = (1, 999)
    tolerance: float = 0.02
    above: Bounds | None = None
    fill: float | Bounds | None = None

    @property
    def wanted(self) -> str:
        sides = " x ".join("any" if side is None else f"{side:g}" for side in self.mm)
        above = "" if self.above is None else f", {in_words(self.above)} mm above the ground"
        low, high = self._filling
        fill = "" if self.fill is None else f", filling {100 * low:g} %{f' to {100 * high:g} %' if high < 1 else ' or more'} of their boxes"
        return f"{in_words(self.number)} parts of {sides} mm within {100 * self.tolerance:g} %{above}{fill}"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        found = [name for name in subject.of_size(self.mm, self.tolerance) if self._lies(subject, name) and self._fills(subject, name)]
        sizes = ", ".join(f"{name} {_by(subject.extents(name))}" for name in subject.shaped[:12])
        return self.number[0] <= len(found) <= self.number[1], f"{len(found)} ({sizes})"

    def _lies(self, subject: Subject, name: str) -> bool:
        low, ground = (float(subject.corners(subject.rest, parts)[0, 2]) for parts in ([name], None))
        return self.above is None or within(low - ground, self.above)

    def _fills(self, subject: Subject, name: str) -> bool:
        mesh = subject.assembly.parts[name].mesh
        assert mesh is not None
        return self.fill is None or within(abs(mesh.volume) / float(np.prod(subject.boxes(name), axis=1).min()), self._filling)

    @property
    def _filling(self) -> Bounds:
        return self.fill if isinstance(self.fill, tuple) else (self.fill or 0.0, 1.0)


class Mass(Check):
    """Mass of the whole."""

    kind: Literal["mass"] = "mass"
    kg: Bounds

    @property
    def wanted(self) -> str:
        return f"{in_words(self.kg)} kg"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        mass = subject.assembly.mass().mass
        return within(mass, self.kg), f"{mass:.4g} kg"


class Solids(Check):
    """Every part is one closed solid, at least 0.2 mm thick under most of its surface."""

    kind: Literal["solids"] = "solids"

    @property
    def wanted(self) -> str:
        return f"every part is one closed solid, {LEAST_WALL_MM:g} mm thick or more"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        wrong = []
        for name in subject.shaped:
            mesh = subject.assembly.parts[name].mesh
            if mesh is None or not mesh.welded().is_closed or len(mesh.welded().components()) != 1:
                wrong.append(name)
            elif (thick := float(np.median(wall_thickness(mesh, WALL_SAMPLES)))) < LEAST_WALL_MM:
                wrong.append(f"{name}, {thick:.2g} mm thick")
        return bool(subject.shaped) and not wrong, f"not: {', '.join(wrong)}" if wrong else f"all {len(subject.shaped)} are"


class ClearAtRest(Check):
    """No two parts share volume at rest."""

    kind: Literal["clear_at_rest"] = "clear_at_rest"

    @property
    def wanted(self) -> str:
        return "no overlap at rest"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        wrong = [pair for pair in subject.at_rest.pairs if pair.verdict in {"overlap", "unknown"}]
        told = ", ".join(f"{' and '.join(pair.parts)} {pair.depth:.3g} mm" for pair in wrong[:5])
        return not wrong and bool(subject.shaped), told or "none"


class Joined(Check):
    """Every part touches, or is held by, another: nothing floats."""

    kind: Literal["joined"] = "joined"

    @property
    def wanted(self) -> str:
        return "no part floats"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        wrong = [finding.message for finding in subject.at_rest.findings if finding.code in {"E_FLOATING", "E_NOT_TOUCHING"}]
        return not wrong, " ".join(wrong[:3]) or "none"


class ClearInMotion(Check):
    """Nothing collides while each driver goes over its range; sampled."""

    kind: Literal["clear_in_motion"] = "clear_in_motion"
    steps: int = 24

    @property
    def wanted(self) -> str:
        return f"no collision at {self.steps} poses of each driver"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        found = _bare(subject.assembly).check_motion(steps=self.steps)
        return found.ok and bool(moving(subject)), "; ".join(finding.message for finding in found.findings.errors[:3]) or "none"


def _bare(assembly: Assembly) -> Assembly:
    """Return an assembly without its declared fits: collisions are asked for, and a fit is its author's own promise."""
    return replace(assembly, fits={})


class Certified(Check):
    """It is proven that nothing collides while each driver goes over its range."""

    kind: Literal["certified"] = "certified"
    seconds: float = 60.0
    pairs: bool = False

    @property
    def wanted(self) -> str:
        return f"motion proven free within {self.seconds:g} s"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        ok, told = proven(subject, _bare(subject.assembly), pairs=self.pairs, seconds=self.seconds)
        return ok and bool(moving(subject)), told


class Loops(Check):
    """The number of loops; they are closed at every value of the drivers. Joints about one line, and parallel slides, form no loop."""

    kind: Literal["loops"] = "loops"
    number: Bounds

    @property
    def wanted(self) -> str:
        return f"{in_words(self.number)} closed loops"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        mechanism = subject.assembly.mechanism
        count = len(mechanism.loop_joints) - _trivial_loops(subject)
        if not self.number[0] <= count <= self.number[1]:
            return False, f"{count} loops"
        gap = max((_closing_error(subject, driver.name) for driver in subject.assembly.drivers), default=0.0)
        return gap <= CLOSED_MM, f"{count} loops, open by at most {gap:.3g} mm"


class Ratio(Check):
    """One joint follows another: its change over that of the other's [deg/deg, mm/deg, deg/mm or mm/mm]."""

    kind: Literal["ratio"] = "ratio"
    driver: JointWanted
    follower: JointWanted
    ratio: float
    tolerance: float = 0.01

    @property
    def wanted(self) -> str:
        return f"{self.follower} changes by ±{abs(self.ratio):g} when {self.driver} changes by 1, within {100 * self.tolerance:g} %"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        found = [
            ratio
            for leader in self.driver.found(subject)
            for joint in self.follower.found(subject)
            if joint.name != leader.name and (ratio := _ratio(subject, leader, joint)) is not None
        ]
        ok = any(abs(abs(ratio) - abs(self.ratio)) <= self.tolerance * abs(self.ratio) for ratio in found)
        return ok, ", ".join(f"{ratio:.4g}" for ratio in found[:6]) or "no two such joints are coupled"


class Rise(Check):
    """While the drivers move one by one, the bounding box grows or moves by this much along an axis."""

    kind: Literal["rise"] = "rise"
    axis: Literal["x", "y", "z"] = "z"
    mm: Bounds

    @property
    def wanted(self) -> str:
        return f"the end along {self.axis} moves by {in_words(self.mm)} mm"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        column = "xyz".index(self.axis)
        best = 0.0
        for driver in subject.assembly.drivers:
            ends = [subject.corners(poses)[:, column] for poses in _stroke_poses(subject, driver.name)]
            best = max(best, float(np.ptp([end[1] for end in ends])), float(np.ptp([end[0] for end in ends]))) if ends else best
        return within(best, self.mm), f"{best:.4g} mm"


class Travel(Check):
    """A number of joints move by at least this much while the drivers go over their ranges, one by one [deg or mm]; an endless driver, one turn."""

    kind: Literal["travel"] = "travel"
    joint: JointWanted
    by: Bounds
    number: Bounds = (1, 999)

    @property
    def wanted(self) -> str:
        return f"{in_words(self.number)} joints ({self.joint}) that move by {in_words(self.by)} in all"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        moved = [_travel(subject, joint) for joint in self.joint.found(subject)]
        count = sum(within(travel, self.by) for travel in moved)
        return self.number[0] <= count <= self.number[1], f"{count} ({', '.join(f'{travel:.4g}' for travel in moved) or 'no such joint'})"


class Reaches(Check):
    """A number of joints bring what they move so far toward a side [mm], seen from rest, while the drivers go over their ranges, one by one.

    What a joint moves is the body beyond it, as `Moves` says; its centre of matter counts, and how far it comes along the vector `toward`.
    """

    kind: Literal["reaches"] = "reaches"
    joint: JointWanted
    toward: Vector
    mm: Bounds
    number: Bounds = (1, 999)

    @property
    def wanted(self) -> str:
        return (
            f"{in_words(self.number)} joints ({self.joint}) that bring their body {in_words(self.mm)} mm toward {in_numbers(self.toward)}"
        )

    def measured(self, subject: Subject) -> tuple[bool, str]:
        joints = self.joint.found(subject)
        bodies = {joint.name: moved_bodies(subject, joint) for joint in joints}
        reached = _reached(subject, {body for each in bodies.values() for body in each}, np.array(self.toward))
        ways = [[reached[body] for body in bodies[joint.name]] for joint in joints]
        count = sum(any(within(mm, self.mm) for mm in way) for way in ways)
        told = ", ".join(" or ".join(f"{mm:.4g}" for mm in way) for way in ways[:12])
        return self.number[0] <= count <= self.number[1], f"{count} ({told or 'no such joint'} mm)"


class Moves(Check):
    """A number of joints move bodies of this share of all matter and of this size, as a share of the whole's.

    What a joint moves is the body beyond it, seen from the ground, whichever side is called its child. A joint of a loop moves either body that is not the ground:
    it counts if one of them is within the bounds. A body is all that is fixed together. Size is the diagonal of the box at rest.
    """

    kind: Literal["moves"] = "moves"
    joint: JointWanted
    volume: Bounds
    size: Bounds
    number: Bounds = (1, 999)

    @property
    def wanted(self) -> str:
        volume, size = (f"{100 * low:.3g} to {100 * high:.3g} %" for low, high in (self.volume, self.size))
        return f"{in_words(self.number)} joints ({self.joint}) that move {volume} of the matter, {size} of the size"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        found = [moved_shares(subject, joint) for joint in self.joint.found(subject)]
        count = sum(any(self._are(*shares) for shares in sides) for sides in found)
        told = ", ".join(" or ".join(f"{100 * volume:.2g} % {100 * size:.3g} %" for volume, size in sides) for sides in found[:8])
        return self.number[0] <= count <= self.number[1], f"{count} ({told or 'no such joint'})"

    def _are(self, volume: float, size: float) -> bool:
        return within(volume, self.volume) and within(size, self.size)


class Gap(Check):
    """Parts that a joint connects keep this distance at rest; `within` counts only surface this close to the joint's axis [mm].

    With `bodies`, what is fixed to the parts counts as well: the cap of a bearing with its base. Where a shoulder or a washer lies closer,
    or a pin that is a part of its own carries the joint, the least play across the joint counts: an eye that rests on its bracket has the
    gap of its pin. `around` is the share of a turn about the joint's axis in which the bodies keep this distance, at least: a bearing is
    not open to its sides.
    """

    kind: Literal["gap"] = "gap"
    joint: JointWanted
    mm: Bounds
    within: float | None = None
    number: Bounds = (1, 999)
    bodies: bool = False
    around: float | None = None

    @property
    def wanted(self) -> str:
        between = " between bodies" if self.bodies else ""
        around = "" if self.around is None else f", over {100 * self.around:g} % of a turn about their axis"
        return f"{in_words(self.number)} joints ({self.joint}) with a gap of {in_words(self.mm)} mm{between}{around}"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        joints = [joint for joint in self.joint.found(subject) if _shaped(subject, joint)]
        gaps = [self._gap(subject, joint) for joint in joints]
        shares = [1.0 if self.around is None else share_around(subject, joint, self.mm) for joint in joints]
        count = sum(within(gap, self.mm) and share >= (self.around or 0.0) for gap, share in zip(gaps, shares, strict=True))
        told = ", ".join(f"{gap:.3g}" for gap in gaps)
        around = "" if self.around is None else f", over {', '.join(f'{100 * share:.0f}' for share in shares)} % of a turn"
        return self.number[0] <= count <= self.number[1], f"{count} ({told} mm{around})"

    def _gap(self, subject: Subject, joint: Joint) -> float:
        near = Fit(within=self.within)
        gap = _between_bodies(subject, joint) if self.bodies else Gauge(subject.scene, joint, near).rest()
        if -CONTACT_MM <= gap < 0:
            gap = 0.0  # the rounded numbers of a file let bodies that touch overlap by less than a contact
        if gap < 0 or within(gap, self.mm):
            return gap
        plays = (_least_play(subject, joint, near, place) for place in _places(joint))
        return max((play for play in plays if play is not None), default=gap)


def _places(joint: Joint) -> Iterator[SE3]:
    """Yield poses of a joint's child in its parent's frame at which its play counts, rest first.

    A little off its seat to either side, edges that cross each other do not touch; half-way, a cone has left its seat.
    """
    ranges, axis = freedoms(joint), joint.T_parent_connector
    rest = SE3.from_matrix(placed(joint, [one.rest for one in ranges]))
    yield rest
    for lifted in (CONTACT_MM, -CONTACT_MM):
        yield axis @ SE3.trans(0, 0, lifted) @ axis.inverse() @ rest
    if joint.type in (JointType.SLIDER, JointType.CYLINDRICAL, JointType.SCREW):
        yield SE3.from_matrix(placed(joint, [(one.lower + one.upper) / 2 for one in ranges]))


def _ways_across(kind: JointType) -> list[SE3]:
    """Return turns of the z axis into the directions in which a joint holds its child."""
    sideways = [] if kind is JointType.PLANAR else [SE3.rot_y(np.pi / 2), SE3.rot_x(np.pi / 2)]
    return [*sideways, *([SE3.identity()] if kind in (JointType.PLANAR, JointType.BALL) else [])]


def _least_play(subject: Subject, joint: Joint, fit: Fit, place: SE3) -> float | None:
    """Return the least play over directions across a joint [mm], its child at a pose; None if nothing stops it, or it overlaps there."""
    plays = []
    for turned in _ways_across(joint.type):
        frame = joint.T_parent_connector @ turned
        along = replace(
            joint,
            type=JointType.PLANAR,
            T_parent_connector=frame,
            T_child_connector=place.inverse() @ frame,
            mate=Mate.ALIGNED,
            rest=JointType.PLANAR.neutral,
            limits=JointLimits((0.0,) * 3, (0.0,) * 3),
            lead=0.0,
        )
        gauge = Gauge(subject.scene, along, fit)
        if gauge.rest() < -CONTACT_MM:
            return None
        plays.append(gauge.play())
    return min((play for play in plays if play is not None), default=None)


def _between_bodies(subject: Subject, joint: Joint) -> float:
    """Return the distance of the two bodies that a joint connects, with all that is fixed to them [mm]."""
    bodies = [parts_of(subject, subject.rigid[end]) for end in (joint.parent, joint.child)]
    return min(subject.apart(a, b) for a in bodies[0] for b in bodies[1])


class Lead(Check):
    """The number of screws with this lead [mm/turn]; `hand` requires that their thread is right-handed or left-handed."""

    kind: Literal["lead"] = "lead"
    joint: JointWanted = JointWanted(type=JointType.SCREW)
    mm: float
    number: Bounds = (1, 999)
    tolerance: float = 0.01
    hand: Literal["right", "left"] | None = None

    @property
    def wanted(self) -> str:
        return f"{in_words(self.number)} {f'{self.hand}-handed ' if self.hand else ''}screws of {self.mm:g} mm a turn"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        leads = [joint.lead for joint in self.joint.found(subject)]
        meant = [lead for lead in leads if self.hand is None or (lead > 0) == (self.hand == "right")]
        count = sum(abs(abs(lead) - self.mm) <= self.tolerance * self.mm for lead in meant)
        return self.number[0] <= count <= self.number[1], f"{count} ({', '.join(f'{lead:.4g}' for lead in leads[:8]) or 'no screw'})"


class Made(Check):
    """Surfaces of both bodies make every joint: no body can leave its pin, bore or guide sideways. A number of joints may be made otherwise."""

    kind: Literal["made"] = "made"
    except_for: int = 0

    @property
    def wanted(self) -> str:
        return "surfaces of both bodies make every joint" + (f", up to {self.except_for}" if self.except_for else "")

    def measured(self, subject: Subject) -> tuple[bool, str]:
        wrong = subject.unmade
        return bool(moving(subject)) and len(wrong) <= self.except_for, f"not: {', '.join(wrong)}" if wrong else "all are"


class Captive(Check):
    """The number of moving parts that cannot be removed in a straight line, regardless of their limits: neither alone nor with what they carry."""

    kind: Literal["captive"] = "captive"
    number: Bounds

    @property
    def wanted(self) -> str:
        return f"{in_words(self.number)} moving parts are held by shape"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        ways = Ways(subject.scene, subject.rest)
        children = {joint.child: joint for joint in moving(subject)}
        parts = [name for name in subject.shaped if name in children]
        free = [name for name in parts if self._leaves(subject, ways, name, children[name])]
        held = len(parts) - len(free)
        return self.number[0] <= held <= self.number[1], f"{held}" + (f" (free: {', '.join(free)})" if free else "")

    @staticmethod
    def _leaves(subject: Subject, ways: Ways, name: str, joint: Joint) -> bool:
        """Return whether a part leaves alone, with its body, or with all that its joint carries."""
        body = [each for each in ways.parts if subject.rigid[each] == subject.rigid[name]]
        beyond = [each for each in carried(subject, joint) if each in ways.parts]
        directions = ways_of(ways.scene, ways.poses, name)
        for together in dict.fromkeys((frozenset([name]), frozenset(body), frozenset(beyond))):
            staying = [each for each in ways.parts if each not in together]
            if any(math.isinf(ways.stop(sorted(together), staying, direction).travel) for direction in directions):
                return True
        return False


class Simulates(Check):
    """Simulators load it, hold it, and bring every joint to its ends."""

    kind: Literal["simulates"] = "simulates"

    @property
    def wanted(self) -> str:
        return "stands and moves in MuJoCo"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        if subject.file is not None:
            verdict = simulate_file(subject.file, engines=("mujoco",))
        else:
            verdict = simulate_assembly(subject.assembly, subject.assembly.name, engines=("mujoco",))
        return verdict.ok, "; ".join(finding.message for finding in verdict.findings.errors[:3]) or "it does"


class Unchanged(Check):
    """After an edit, the number of parts whose mesh is that of one from before, whatever their names and wherever they lie.

    Attributes:
        of: Whether parts are counted or bodies, that is, what is fixed together; a body is unchanged if all its parts are, so a crumb that stays
            counts for nothing. What is fixed to the ground is not among those that move.
    """

    kind: Literal["unchanged"] = "unchanged"
    number: Bounds
    of: Literal["parts", "bodies", "moving parts", "moving bodies"] = "parts"

    @property
    def wanted(self) -> str:
        return f"{in_words(self.number)} {self.of} are unchanged"

    def measured(self, subject: Subject) -> tuple[bool, str]:
        if subject.before is None:
            return False, "nothing was there before"
        before, after = (self._shapes(each) for each in (Subject(subject.before), subject))
        return self.number[0] <= (same := (before & after).total()) <= self.number[1], f"{same} of {after.total()}"

    def _shapes(self, subject: Subject) -> Counter[tuple[str, ...]]:
        """Return what is counted, each by the shapes of its parts."""
        left_out = subject.rigid[subject.assembly.ground] if self.of.startswith("moving") else None
        found: dict[str, list[str]] = {}
        for name in subject.shaped:
            if (body := subject.rigid[name]) != left_out:
                found.setdefault(name if self.of.endswith("parts") else body, []).append(subject.form(name))
        return Counter(tuple(sorted(shapes)) for shapes in found.values())


AnyCheck = Annotated[
    Parts
    | Freedoms
    | Joints
    | Size
    | PartSize
    | Mass
    | Solids
    | ClearAtRest
    | Joined
    | ClearInMotion
    | Certified
    | Loops
    | Ratio
    | Rise
    | Travel
    | Straight
    | Level
    | Floor
    | Turns
    | Meshes
    | Gap
    | Captive
    | Simulates
    | Unchanged
    | Shifted
    | Holes
    | Passage
    | Studs
    | Wall
    | Volume
    | Holds
    | Stands
    | Symmetric
    | Lead
    | Made
    | Moves
    | Arranged
    | Outlined
    | Handed
    | Upright
    | Matter
    | Extent
    | Threads
    | Links
    | Square
    | PutTogether
    | Effort
    | Carries
    | Folds
    | Passes
    | Stack
    | Machined
    | Toleranced
    | Spaced
    | Ordered
    | Turned
    | Reaches
    | Fitted
    | Weighs
    | Room
    | Section,
    Field(discriminator="kind"),
]


def moved_shares(subject: Subject, joint: Joint) -> list[tuple[float, float]]:
    """Return the share of the whole's volume, and of the diagonal of its box, of what a joint moves at rest: one body, or two in a loop."""
    volumes = {name: abs(subject.assembly.parts[name].mesh.volume) for name in subject.shaped}  # type: ignore[union-attr]
    shares = []
    for body in moved_bodies(subject, joint):
        parts = parts_of(subject, body)
        side = float(np.linalg.norm(np.ptp(subject.corners(subject.rest, parts), axis=0))) if parts else 0.0
        shares.append((sum(volumes[name] for name in parts) / sum(volumes.values()), side / float(np.linalg.norm(subject.size))))
    return shares


def _travel(subject: Subject, joint: Joint) -> float:
    """Return how far a joint goes while one driver moves, the most that any of them makes it [deg or mm]."""
    strokes = [(driver.name, subject.stroke(driver.name, PATH)) for driver in subject.assembly.drivers]
    ranges = [float(np.ptp(subject.values(joint.name, driver, points))) for driver, points in strokes if len(points)]
    return max(ranges, default=0.0) * subject.per_unit(joint)


def _stroke_poses(subject: Subject, driver: str) -> Iterator[Any]:
    assembly = subject.assembly
    column = [coordinate.name for coordinate in assembly.drivers].index(driver)
    endless = np.isinf(assembly.drivers[column].upper - assembly.drivers[column].lower)
    for point in subject.stroke(driver, TURN if endless else STROKE):
        q = np.array(assembly.mechanism.rest)
        q[column] = point
        yield dict(zip(assembly.mechanism.parts, assembly.poses(q), strict=True))


def _reached(subject: Subject, bodies: Collection[str], toward: FloatArray) -> dict[str, float]:
    """Return how far the centre of matter of each body comes toward a side, seen from rest, the most that any driver makes it [mm]."""
    parts = {body: parts_of(subject, body) for body in bodies}
    weights, centres = {}, {}
    for name in {name for members in parts.values() for name in members}:
        mesh = subject.assembly.parts[name].mesh
        assert mesh is not None
        weights[name], centres[name] = abs(mesh.volume), mesh.solid_integrals()[1]
    unit = toward / np.linalg.norm(toward)

    def place(poses: Any, members: Sequence[str]) -> float:
        return float(np.average([unit @ poses[name].apply(centres[name]) for name in members], weights=[weights[name] for name in members]))

    held = {body: members for body, members in parts.items() if members}
    rest = {body: place(subject.rest, members) for body, members in held.items()}
    reached = dict.fromkeys(bodies, 0.0)
    for driver in subject.assembly.drivers:
        for poses in _stroke_poses(subject, driver.name):
            for body, members in held.items():
                reached[body] = max(reached[body], place(poses, members) - rest[body])
    return reached


def _trivial_loops(subject: Subject) -> int:
    """Return the number of independent loops that joints about one line, or slides along one direction, form among themselves.

    A door with two hinges is such a loop. In a graph of E joints between V bodies in C pieces, E - V + C loops are independent.
    """
    kinds: dict[int, list[tuple[FloatArray, FloatArray | None, Joint]]] = {0: [], 1: []}
    for joint in moving(subject):
        frame = subject.rest[joint.parent] @ joint.T_parent_connector
        if joint.type in _ABOUT_LINE:
            kinds[0].append((frame.z_axis, frame.translation, joint))
        elif joint.type is JointType.SLIDER:
            kinds[1].append((frame.z_axis, None, joint))
    return sum(_cycles(subject, group) for rows in kinds.values() for group in _alike(rows))


def _alike(rows: list[tuple[FloatArray, FloatArray | None, Joint]]) -> list[list[Joint]]:
    """Return joints in groups of the same line, or of the same direction where they have no point."""
    groups: list[tuple[FloatArray, FloatArray | None, list[Joint]]] = []
    for axis, point, joint in rows:
        for other, foot, members in groups:
            beside = 0.0 if point is None or foot is None else float(np.linalg.norm(np.cross(point - foot, other)))
            if parallel(axis, other) and beside <= SAME_LINE_MM:
                members.append(joint)
                break
        else:
            groups.append((axis, point, [joint]))
    return [members for _, _, members in groups]


def _cycles(subject: Subject, joints: list[Joint]) -> int:
    leader = {subject.rigid[part]: subject.rigid[part] for joint in joints for part in (joint.parent, joint.child)}

    def top(name: str) -> str:
        while leader[name] != name:
            name = leader[name]
        return name

    cycles = 0
    for joint in joints:
        a, b = top(subject.rigid[joint.parent]), top(subject.rigid[joint.child])
        cycles += a == b
        leader[a] = b
    return cycles


def _closing_error(subject: Subject, driver: str) -> float:
    """Return by how much the connectors of loop joints lie apart where they should not [mm]."""
    worst = 0.0
    mechanism = subject.assembly.mechanism
    column = [coordinate.name for coordinate in subject.assembly.drivers].index(driver)
    for point in subject.stroke(driver, STROKE):
        q = np.array(mechanism.rest)
        q[column] = point
        values, poses = mechanism.configuration(q), dict(zip(mechanism.parts, mechanism.poses(q), strict=True))
        for joint in mechanism.loop_joints:
            here = poses[joint.parent] @ joint.T_parent_connector @ joint.motion(values[joint.name])
            worst = max(worst, float(here.distance_to(poses[joint.child] @ joint.T_child_connector)))
    return worst


def _ratio(subject: Subject, leader: Joint, follower: Joint) -> float | None:
    """Return the change of one joint by that of another over a small stroke of each driver, in degrees and mm; None if it does not follow."""
    for driver in subject.assembly.drivers:
        points = subject.stroke(driver.name, STROKE)
        if not len(points):
            continue
        led, followed = subject.values(leader.name, driver.name, points), subject.values(follower.name, driver.name, points)
        if np.ptp(led) > 1e-6 and np.ptp(followed) > 1e-6:
            slope, _ = np.polyfit(led, followed, 1)
            if float(np.abs(followed - np.polyval(np.polyfit(led, followed, 1), led)).max()) > 1e-3 * float(np.ptp(followed)):
                continue  # it follows, but not by a ratio
            return float(slope * subject.per_unit(follower) / subject.per_unit(leader))
    return None


def _shaped(subject: Subject, joint: Joint) -> bool:
    return {joint.parent, joint.child} <= set(subject.shaped) - set(subject.scene.broken)


def _by(sides: FloatArray) -> str:
    return " x ".join(f"{float(side):.4g}" for side in sides)
