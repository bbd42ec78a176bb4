"""Assembly: parts, the mechanism that moves them, and the fits declared between them."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, Self, get_args

import numpy as np
from numpy.typing import ArrayLike

from articad.aliases import Fastening, Progress
from articad.arrays import FloatArray
from articad.certificates.certificate import DEFAULT_BUDGET_S, DEFAULT_EPSILON_MM, Certificate, certify, constrained_joints
from articad.certificates.fits import PROOF_SECONDS, FitReport, certified_fits, check_fits, followed
from articad.connectors.se3 import SE3
from articad.disassembly.order import assembly_order
from articad.disassembly.poses import end_poses
from articad.disassembly.steps import AssemblyOrder
from articad.errors import ArticadError, KinematicsError, LimitError, PlanError, UnknownJointError, did_you_mean
from articad.findings import Findings
from articad.geometry.mesh import TriMesh
from articad.geometry.part import MassProperties, Part
from articad.interference.check import Checks, check_scene
from articad.interference.clearance import Clearance, least_clearances, searched
from articad.interference.following import ROWS, Following, what_follows
from articad.interference.report import PairCheck
from articad.interference.scene import Scene
from articad.interference.sweep import DEFAULT_STEPS, MotionSampler
from articad.kernels.choice import kernel_named
from articad.kernels.kernel import BuildCache, PartKernel
from articad.kernels.parts import RealisedPart, build_parts, find_scripts
from articad.kinematics.configuration import Configuration
from articad.kinematics.dynamics import GRAVITY, Dynamics
from articad.kinematics.joints import Coordinate, Coupling, Joint, JointType
from articad.kinematics.mechanism import Mechanism
from articad.kinematics.motion import DrivenMotion, FeasibleRange
from articad.kinematics.reach import Reach
from articad.kinematics.solution import Solution
from articad.plan.amending import amended
from articad.plan.check import admitted
from articad.plan.iso2768 import ToleranceClass
from articad.plan.resolve import Fit, Material, ResolvedPart, ResolvedPlan, Waiver
from articad.plan.schema import AssemblyPlan
from articad.realisation.meshing import lost_meshes
from articad.realisation.verdicts import Realisation, check_joints
from articad.support.check import Support, check_support

if TYPE_CHECKING:
    from PIL import Image

JointValue = float | Sequence[float]

DEFLECTION_MM = 0.01  # meshes stay this close to their solids; interference tolerances are derived from it
_FOLD_BUDGET_S = 60.0  # nominal seconds for the proof of a motion in an order of assembly
_LIMIT_SLACK = 1e-9  # rad or mm: a value computed to be at its limit is at its limit


class Poses(Mapping[str, SE3]):
    """Pose of each part in the ground frame, by the part's name."""

    def __init__(self, names: Sequence[str], stacked: SE3) -> None:
        self._names = tuple(names)
        self.stacked = stacked

    def __getitem__(self, part: str) -> SE3:
        return self.stacked[self._places[part]]

    @cached_property
    def _places(self) -> dict[str, int]:
        return {name: place for place, name in enumerate(self._names)}

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return f"Poses({', '.join(self._names)})"


@dataclass(frozen=True)
class Kept:
    """Data of a file for which an assembly has no field.

    Attributes:
        format: Format of the file, such as "urdf".
        where: What it belongs to: `joints.elbow`, `parts.arm`, or `model`.
        what: In words, for reports.
        xml: The element, to be written below `where` into a file of the same format; empty where that is not possible.
    """

    format: str
    where: str
    what: str
    xml: str = ""


@dataclass(frozen=True, eq=False)
class Assembly:
    """Parts, the mechanism that moves them, and the fits and waivers that were declared.

    Attributes:
        name: Name of the product.
        mechanism: Parts, joints and couplings as mathematics.
        parts: Geometry, mass and connectors by part name, in the order of `mechanism.parts`.
        materials: By name.
        fits: Declared fits by joint name.
        waivers: Overlaps that the plan allows.
        resolved: The plan with its numbers; None when made in Python or imported.
        realised: How each part was built; empty when made in Python or imported.
        findings: Warnings of the plan's check and of the builds.
        deflection: Largest distance of meshes from their solids [mm].
        foreign: True when it was read from a file that articad did not write. The pose of its base and the rest values of its joints are
            then whatever the file happened to have.
        kept: Data of that file for which an assembly has no field.
    """

    name: str
    mechanism: Mechanism
    parts: Mapping[str, Part]
    materials: Mapping[str, Material] = field(default_factory=dict)
    fits: Mapping[str, Fit] = field(default_factory=dict)
    waivers: tuple[Waiver, ...] = ()
    resolved: ResolvedPlan | None = None
    realised: Mapping[str, RealisedPart] = field(default_factory=dict)
    findings: Findings = field(default_factory=Findings)
    deflection: float = DEFLECTION_MM
    foreign: bool = False
    kept: tuple[Kept, ...] = ()
    _kernel: PartKernel | None = None
    _cache: BuildCache | None = None  # a temporary cache; it and its B-rep files are deleted with the last object that refers to it

    def __post_init__(self) -> None:
        for attribute in ("parts", "materials", "fits", "realised"):
            object.__setattr__(self, attribute, MappingProxyType(dict(getattr(self, attribute))))

    def __reduce__(self) -> tuple[object, ...]:
        """Support pickling. The kernel and the cache are not copied; the copy builds parts with the default ones."""
        given = {entry.name: getattr(self, entry.name) for entry in fields(self) if entry.name not in {"_kernel", "_cache"}}
        return _restored, (
            type(self),
            {name: dict(value) if isinstance(value, MappingProxyType) else value for name, value in given.items()},
        )

    # ------------------------------------------------------------------ making one

    @classmethod
    def from_plan(
        cls,
        plan: AssemblyPlan,
        parts: str | Path | Mapping[str, str | bytes],
        *,
        kernel: PartKernel | None = None,
        sandbox: Literal["strict", "weak"] = "strict",
        jobs: int | None = None,
        deflection: float = DEFLECTION_MM,
        cache: BuildCache | None = None,
        progress: Progress | None = None,
        parameters: Mapping[str, float] | None = None,
    ) -> Self:
        """Build every part script of a plan in the sandbox and assemble the result.

        Args:
            plan: A valid plan.
            parts: Folder of part scripts, or source by part name.
            kernel: Builds the scripts; the plan's own choice by default.
            sandbox: "weak" accepts less isolation than landlock or bwrap give.
            jobs: How many parts at once; by default the number of processors.
            deflection: Largest distance of a mesh from its solid [mm].
            cache: Keeps built parts; by default `$ARTICAD_CACHE` or `~/.cache/articad`.
            progress: Called with the outcome of each part.
            parameters: Values that replace the plan's own [mm, degrees].

        Raises:
            PlanError: With every finding of `check_plan` if one is an error; no script has run then.
            ContractError: If a part cannot be built; holds the findings of all that failed.
            SandboxError: If the requested isolation is not available.
        """
        resolved, findings = admitted(plan, **dict(parameters or {}))
        kernel = kernel or kernel_named(resolved.plan.kernel, sandbox=sandbox)
        if isinstance(parts, Mapping):
            scripts = {name: text.encode() if isinstance(text, str) else text for name, text in parts.items()}
        else:
            scripts = find_scripts(Path(parts), resolved, kernel.name)
        cache = cache or BuildCache()
        realised = build_parts(resolved, scripts, kernel=kernel, cache=cache, deflection=deflection, jobs=jobs, progress=progress)
        warnings = Findings(finding for finding in findings if finding.severity == "warning")  # notes are returned by `check_plan` only
        return cls.from_realised(resolved, realised, kernel=kernel, cache=cache, deflection=deflection, findings=warnings)

    @classmethod
    def from_realised(
        cls,
        resolved: ResolvedPlan,
        realised: Mapping[str, RealisedPart],
        *,
        kernel: PartKernel | None = None,
        cache: BuildCache | None = None,
        deflection: float = DEFLECTION_MM,
        findings: Findings = Findings(),  # noqa: B008 - immutable
    ) -> Self:
        """Assemble parts that are already built; this calls no model and no kernel.

        Args:
            resolved: The plan with its numbers.
            realised: Its parts, by name.
            kernel: Rebuilds parts when parameters change.
            cache: Holds the files of these parts and of rebuilt ones.
            deflection: Largest distance of their meshes from the solids [mm].
            findings: Findings about the plan.
        """
        mechanism = resolved.mechanism
        return cls(
            name=resolved.plan.name,
            mechanism=mechanism,
            parts={name: _weighed(realised[name].part, resolved.parts[name]) for name in mechanism.parts},
            materials=resolved.materials,
            fits=resolved.fits,
            waivers=resolved.waivers,
            resolved=resolved,
            realised=realised,
            findings=Findings([*findings, *(finding for part in realised.values() for finding in part.findings)]),
            deflection=deflection,
            _kernel=kernel,
            _cache=cache,
        )

    @classmethod
    def from_parts(
        cls,
        name: str,
        *,
        parts: Iterable[Part],
        joints: Iterable[Joint],
        ground: str,
        couplings: Iterable[Coupling] = (),
        fits: Mapping[str, Fit] | None = None,
        waivers: Iterable[Waiver] = (),
        T_ground: SE3 | None = None,
    ) -> Self:
        """Assemble parts and joints made in Python, without a plan.

        Args:
            name: Name of the product.
            parts: From a mesh, a STEP file, a script, or without geometry.
            joints: As `articad.revolute(...)` and its siblings make them.
            ground: Name of the part that stands still.
            couplings: Between joints.
            fits: By joint name.
            waivers: Overlaps to allow.
            T_ground: Pose of the ground part; the identity by default.

        Raises:
            PlanError: With every finding about names, joints and structure.
        """
        by_name = {part.name: part for part in parts}
        mechanism = Mechanism(
            tuple(by_name), ground, tuple(joints), tuple(couplings), T_ground=SE3.identity() if T_ground is None else T_ground
        )
        return cls(name=name, mechanism=mechanism, parts=by_name, fits=fits or {}, waivers=tuple(waivers))

    def with_parameters(self, **values: float) -> Assembly:
        """Return the assembly with other parameter values; only parts whose numbers changed are built again.

        Args:
            values: By name, in the unit that the plan gives them: mm, degrees or none.

        Raises:
            PlanError: If there is no plan, a parameter is unknown, or the plan is not valid at these values.
        """
        if self.resolved is None:
            raise PlanError("This assembly was not made from a plan, so it has no parameters.")
        return self._rebuilt(self.resolved.plan, {**self.resolved.overrides, **values})

    def with_changes(self, changes: Mapping[str, Any], *, build: bool = True) -> Assembly:
        """Return the assembly of the plan with some of its values replaced; only parts whose numbers changed are built again.

        Args:
            changes: New values by address, as `articad.plan.amending.amended` takes them.
            build: Whether to build parts again; without it they stay as they are, as befits changes of limits and couplings.

        Raises:
            PlanError: If there is no plan, or the changed one is not valid.
            ReadError: If the plan has nothing at an address.
            ContractError: If a part cannot be built.
        """
        if self.resolved is None:
            raise PlanError("This assembly was not made from a plan, so nothing of it can be changed.")
        plan = AssemblyPlan.from_json(amended(self.resolved.plan.to_json(), changes))
        overrides = {name: value for name, value in self.resolved.overrides.items() if f"parameters.{name}.value" not in changes}
        if not build:
            resolved, _ = admitted(plan, **overrides)
            return Assembly.from_realised(
                resolved, self.realised, kernel=self._kernel, cache=self._cache, deflection=self.deflection, findings=self.findings
            )
        return self._rebuilt(plan, overrides)

    def _rebuilt(self, plan: AssemblyPlan, parameters: Mapping[str, float]) -> Assembly:
        """Build a plan with the scripts of this assembly."""
        scripts = {name: part.script for name, part in self.realised.items() if part.script is not None}
        return Assembly.from_plan(plan, scripts, kernel=self._kernel, cache=self._cache, deflection=self.deflection, parameters=parameters)

    @property
    def environment(self) -> frozenset[str]:
        """Names of the parts that are checked against but not exported: a floor, a wall, room for a hand."""
        return frozenset() if self.resolved is None else frozenset(name for name, part in self.resolved.parts.items() if part.environment)

    def product(self) -> Assembly:
        """Return the assembly without its environment, as every export writes it; the assembly itself if it has none."""
        if self.resolved is None or not self.environment:
            return self
        resolved = self.resolved.product()
        mechanism = resolved.mechanism
        return replace(
            self,
            mechanism=mechanism,
            parts={name: self.parts[name] for name in mechanism.parts},
            fits=resolved.fits,
            waivers=resolved.waivers,
            resolved=resolved,
            realised={name: part for name, part in self.realised.items() if name in resolved.parts},
        )

    # ------------------------------------------------------------------ structure

    @property
    def plan(self) -> AssemblyPlan | None:
        """The plan it was made from."""
        return None if self.resolved is None else self.resolved.plan

    @property
    def ground(self) -> str:
        """Name of the part that stands still."""
        return self.mechanism.ground

    @property
    def joints(self) -> tuple[Joint, ...]:
        """All joints, in the order of declaration."""
        return self.mechanism.joints

    @property
    def drivers(self) -> tuple[Coordinate, ...]:
        """The columns of `q`."""
        return self.mechanism.drivers

    # ------------------------------------------------------------------ poses

    def q(self, **by_joint: JointValue) -> FloatArray:
        """Return the configuration with these joints set and all other drivers at rest; limits of joints that follow are checked.

        Args:
            by_joint: A number for a joint of one coordinate, else a sequence in the order of its coordinates [rad, mm];
                a ball takes a quaternion (x, y, z, w).

        Returns:
            `q`, `(nq,)`.

        Raises:
            UnknownJointError: If a name is not that of a joint that drives.
            LimitError: If a value is outside its limits or moves a following joint outside its own; the message says how far the driver
                may go.
            DeadPointError: If a loop cannot be closed there.
            PlanError: If a joint gets more or fewer values than it has coordinates.
        """
        q = np.array(self.mechanism.rest, dtype=np.float64)
        columns: dict[str, list[int]] = {}
        for index, driver in enumerate(self.drivers):
            columns.setdefault(driver.joint, []).append(index)
        for name, value in by_joint.items():
            if name not in columns:
                raise UnknownJointError(name, columns)
            values = np.atleast_1d(np.asarray(value, dtype=np.float64))
            if values.shape != (len(columns[name]),):
                wanted = ", ".join(self.drivers[index].name for index in columns[name])
                raise PlanError(f"Joint {name!r} takes {len(columns[name])} number(s) ({wanted}), not {values.size}.")
            q[columns[name]] = values
        self._refuse_outside_limits(q, by_joint)
        self._refuse_followers_outside_limits(q, by_joint)
        return q

    def at(self, **by_joint: JointValue) -> Poses:
        """Place every part with these joints set and all other drivers at rest.

        See `q` for the arguments and errors.
        """
        q = self.q(**by_joint)
        return Poses(self.mechanism.parts, self.poses(q) if by_joint else self.mechanism.at_rest)

    def poses(self, q: ArrayLike) -> SE3:
        """Place every part in the ground frame. Limits of joints are not checked here; `q` and `at` check them.

        Args:
            q: Coordinates of the drivers [rad, mm], `(*batch, nq)`.

        Returns:
            `T_ground_part` of all parts in the order of `parts`, `(*batch, N, 7)` [mm, quaternion xyzw].

        Raises:
            KinematicsError: If loops cannot be closed; for a batch, the message names the rows. `solve` returns the rows that can.
        """
        return self.mechanism.poses(np.asarray(q, dtype=np.float64))

    def solve(self, q: ArrayLike) -> Solution:
        """Place every part, and mark the configurations in which loops cannot be closed; see `Mechanism.solve`.

        Args:
            q: Coordinates of the drivers [rad, mm], `(*batch, nq)`.
        """
        return self.mechanism.solve(q)

    def path(self, start: ArrayLike, goal: ArrayLike, *, clear: bool = False) -> FloatArray:
        """Return waypoints of the drivers from one configuration to another; straight lines between them keep to branch and limits.

        Args:
            start: Values of the drivers `(nq,)` [rad, mm].
            goal: Values of the drivers `(nq,)` [rad, mm].
            clear: Whether the path must also be free of collisions; this is sampled every 0.1 rad or 0.1 lengths of a link, not proven.

        Returns:
            `(n, nq)`, start and goal included.

        Raises:
            LimitError: If start or goal is outside limits, followers included.
            KinematicsError: E_NO_PATH if no path was found.
        """
        return self.mechanism.path(start, goal, accept=self._is_clear if clear else None)

    def jacobian(self, q: ArrayLike, part: str, frame: SE3 | str | None = None) -> FloatArray:
        """Return how fast a frame of a part moves with each driver.

        Args:
            q: Coordinates of the drivers [rad, mm], `(nq,)`.
            part: Name of the part that carries the frame.
            frame: Frame in the part, or the name of one of its connectors; the part's own frame by default.

        Returns:
            `(6, nv)`: velocity of the frame's origin [mm] over angular velocity [rad], both in the ground frame.
        """
        return self.mechanism.jacobian(np.asarray(q, dtype=np.float64), part, self._frame(part, frame))

    def drive(self, driver: str, lower: float, upper: float, *, steps: int = 60, at: Mapping[str, float] | None = None) -> DrivenMotion:
        """Move one driver evenly while the rest of the mechanism follows; see `Mechanism.drive`.

        Args:
            driver: Name of a driver.
            lower: First value [rad, mm].
            upper: Last value [rad, mm].
            steps: How many values, both ends included.
            at: Values of other drivers [rad, mm]; at rest by default.

        Raises:
            UnknownJointError: If there is no such driver.
            LoopError: If the loops do not close at rest.
        """
        return self.mechanism.drive(driver, lower, upper, steps, at=at)

    def motion(self, *args: Any, **options: Any) -> DrivenMotion:
        """Deprecated name of `drive`."""
        warnings.warn("Assembly.motion is named Assembly.drive.", DeprecationWarning, stacklevel=2)
        return self.drive(*args, **options)

    def feasible_range(self, driver: str, *, at: Mapping[str, float] | None = None) -> FeasibleRange:
        """Return how far a driver can go from rest before a limit, a dead point or a singular pose stops it.

        Args:
            driver: Name of a driver.
            at: Values of other drivers [rad, mm]; at rest by default.
        """
        return self.mechanism.feasible_range(driver, at=at)

    def reach(self, part: str, target: SE3 | ArrayLike, frame: SE3 | str | None = None, *, clear: bool = False) -> Reach:
        """Return a configuration within limits that brings a frame to a target, or how near it comes and what stops it.

        Starts from rest, then from random configurations, always the same ones.

        Args:
            part: Name of the part that carries the frame.
            target: A pose in the ground frame, or a point `(3,)` [mm], which leaves the orientation free.
            frame: Frame in the part, or the name of one of its connectors; the part's own frame by default.
            clear: Whether parts must also be free of collisions in the configuration.

        Raises:
            KinematicsError: E_REACH_BARRED if parts collide in every configuration found that reaches the target.
        """
        accept = (lambda q: self._is_clear(self.mechanism.configuration(q))) if clear else None
        return self.mechanism.reach(part, target, self._frame(part, frame), accept=accept)

    # ------------------------------------------------------------------ checks and proofs

    def check(
        self,
        q: ArrayLike | None = None,
        *,
        motion: bool = False,
        steps: int = DEFAULT_STEPS,
        known: Mapping[tuple[str, str], PairCheck] | None = None,
    ) -> Checks:
        """Check one pose for overlap, floating parts and broken meshes; at rest also the declared fits, over the motion of their joints.

        Args:
            q: Configuration `(nq,)` [rad, mm]; the rest pose by default.
            motion: Whether to sample the motion as well: each driver alone, every two on a grid, all together at scattered poses, then a
                search for the closest pose of every two parts. Nothing is proven between two samples; `certify` proves.
            steps: Poses per driver, with `motion`.
            known: Verdicts of an earlier check by pair of parts; they are reused without measurement and without findings.

        Raises:
            PlanError: If both a configuration and `motion` are given.
        """
        if motion:
            if q is not None:
                raise PlanError("A check of the motion starts at rest; leave out the configuration.")
            moved = self._moved()
            checks = self._checked_at(None, known) + moved.run(None, steps=steps, together=True, samples=steps)
            return self._with_fits(checks + searched(moved, checks))
        checks = self._checked_at(q, known)
        return self._with_fits(checks) if q is None else checks

    def _checked_at(self, q: ArrayLike | None, known: Mapping[tuple[str, str], PairCheck] | None) -> Checks:
        poses = Poses(self.mechanism.parts, self.mechanism.at_rest if q is None else self.poses(q))
        return check_scene(self.scene(), poses, over="rest" if q is None else "pose", ground=self.ground, known=known)

    def _moved(self) -> MotionSampler:
        return MotionSampler(self.scene(), self.mechanism)

    def check_motion(
        self, joints: Sequence[str] | None = None, *, steps: int = DEFAULT_STEPS, together: bool = False, samples: int = 0
    ) -> Checks:
        """Sample the motion of every driver over its range, the others at rest; a sample proves nothing between two poses.

        Declared fits are also checked over the motion of their joints; each row of `fits` says whether it is proven or sampled.

        Args:
            joints: Names of the joints to move; all that drive by default.
            steps: Poses per coordinate.
            together: Whether to move every two coordinates on a grid as well.
            samples: Further poses, scattered over all coordinates at once.
        """
        checks = self._moved().run(joints, steps=steps, together=together, samples=samples)
        return self._with_fits(checks, joints)

    def sweep(self, *args: Any, **options: Any) -> Checks:
        """Deprecated name of `check_motion`."""
        warnings.warn("Assembly.sweep is named Assembly.check_motion.", DeprecationWarning, stacklevel=2)
        return self.check_motion(*args, **options)

    def clearances(self, joints: Sequence[str] | None = None, *, together: bool = True) -> tuple[Clearance, ...]:
        """Return the smallest distance found between every two parts that move relative to each other, with its pose, the nearest first.

        Poses are sampled and searched, so the true minimum may be smaller; `certify` proves that parts do not meet.

        Args:
            joints: Names of the joints to move; all that drive by default.
            together: Whether to move several drivers at once, too.
        """
        return least_clearances(self._moved(), joints, together=together)

    def follows(self, joints: Sequence[str] | None = None, *, rows: int = ROWS) -> tuple[Following, ...]:
        """Return a table of the joints that loops and couplings move with each driver, the other drivers at rest.

        Args:
            joints: Names of the joints that drive; all by default.
            rows: Values of each driver, evenly over its range, in addition to the rest value.
        """
        return what_follows(self._moved(), joints, rows=rows)

    def check_joints(self, joints: Sequence[str] | None = None) -> Realisation:
        """Judge how each joint is made: which surfaces of its parts make it, and which freedoms they leave that it should remove.

        Couplings whose parts touch, such as gears, are sampled over the ranges of the drivers: do these parts stay together? Joints are examined at rest and, where no other parts hold them, at the ends of their ranges, to first order; nothing is proven between. All findings are warnings.

        Args:
            joints: Names of the joints to judge; all by default.
        """
        poses = Poses(self.mechanism.parts, self.mechanism.at_rest)
        scene = self.scene()
        made = check_joints(scene, poses, reached=followed(self.mechanism), joints=joints)
        if joints is not None:
            return made
        return replace(made, findings=made.findings + Findings(lost_meshes(scene, self.mechanism)))

    def assembly_order(self, fastenings: Mapping[str, Fastening] | None = None) -> AssemblyOrder:
        """Find an order in which the parts go together at rest, with a proven path for each, or the parts that block each other.

        Paths are straight; each step's `strength` says whether it is proven. The environment is not in the way.

        Args:
            fastenings: By joint name how it is fastened, in place of what the joint states. Two parts that snap, are pressed together or
                held by a circlip do not stop each other, and the step that joins them is permitted, not proven. A purchased pair stays
                together. A screw or adhesive is only named.

        Raises:
            UnknownJointError: If there is no joint of a name.
            ArticadError: If there is no such fastening.
        """
        for how in (fastenings or {}).values():
            if how not in get_args(Fastening):
                kinds = ", ".join(get_args(Fastening))
                raise ArticadError(f"{how!r} is not a fastening.{did_you_mean(how, get_args(Fastening))} Known: {kinds}.")
        known = [joint.name for joint in self.joints]
        for name in fastenings or {}:
            if name not in known:
                raise UnknownJointError(name, known)
        product = self.product()
        poses = Poses(product.mechanism.parts, product.mechanism.at_rest)
        return assembly_order(
            product.scene(),
            poses,
            product.ground,
            name=product.name,
            others=end_poses(product.mechanism),
            fastenings=fastenings,
            mechanism=product.mechanism,
            proof=product._proven,  # noqa: SLF001 - of the same class
        )

    def _proven(self, mechanism: Mechanism, joint: str) -> bool:
        """Return whether it is proven that no parts of a mechanism of these parts meet while a joint moves over its whole range."""
        meshes = {name: mesh for name, mesh in self._meshes().items() if name in mechanism.parts}
        waivers = [waiver for waiver in self.waivers if set(waiver.parts) <= set(meshes)]
        deflections = {name: value for name, value in self._deflections().items() if name in meshes}
        return certify(meshes, mechanism, joints=[joint], pairs=False, budget=_FOLD_BUDGET_S, deflection=deflections, waivers=waivers).ok

    def check_support(self) -> Support:
        """Examine whether the product stands, whether each part is carried, and what falls out when it is turned over.

        At rest and at both ends of each driver's range, the other drivers at rest; nothing is proven between. Joints that `check_joints` does not
        find unmade hold their parts; how far a part falls and which ways it has out is exact. All findings are warnings.
        """
        product = self.product()
        scene, poses = product.scene(), dict(Poses(product.mechanism.parts, product.mechanism.at_rest))
        rows = check_joints(scene, poses, reached=followed(product.mechanism)).rows
        made = {row.joint for row in rows if row.verdict not in ("not made", "partly")}

        def centre(placed: Mapping[str, SE3]) -> FloatArray | None:
            masses = [part.mass.moved(placed[name]) for name, part in product.parts.items() if part.mass is not None]
            return MassProperties.combined(masses).com if masses else None

        others = end_poses(product.mechanism, middle=False)
        return check_support(scene, poses, product.ground, others=others, made=made, centre_of_mass=centre)

    def certify(
        self,
        joints: Sequence[str] | None = None,
        *,
        pairs: bool = True,
        epsilon: float = DEFAULT_EPSILON_MM,
        budget: float = DEFAULT_BUDGET_S,
        tolerance: ToleranceClass | None = None,
        check: bool = True,
    ) -> Certificate:
        """Prove that no parts meet while joints move over their whole ranges; what the budget does not cover is "not checked".

        Declared fits are proven, too. A fit that was only sampled gives `W_NOT_CERTIFIED`, which is not ok.

        Args:
            joints: Names of the joints to be proven; all that move by default.
            pairs: Whether joints are also moved two at a time.
            epsilon: Distances up to this count as contact [mm].
            budget: Nominal seconds of work, the same amount on every machine; claims that are not proven by then are "not checked",
                which is not ok. Each declared fit has the same budget again for itself.
            tolerance: Class of ISO 2768-1, such as "m", within which the claims are to hold: for all parts whose surfaces lie anywhere
                within their general tolerance and declared fits. None: for parts as they are modelled.
            check: Whether the independent checker reads the proof. Without it the certificate is not to be trusted before
                `articad.certificates.verifier.verify_file` has accepted its files.
        """
        certificate = certify(
            self._meshes(),
            self.mechanism,
            joints=joints,
            pairs=pairs,
            epsilon=epsilon,
            budget=budget,
            deflection=self._deflections(),
            waivers=self.waivers,
            fits=self.fits,
            tolerance=tolerance,
            check=check and not self.fits,
        )
        if not self.fits:
            return certificate
        fits = certified_fits(self._held_fits(joints, certificate.spans, seconds=budget))
        certificate = replace(
            certificate,
            findings=certificate.findings + fits.findings,
            claims=(*certificate.claims, *fits.claims),
            fits=fits.rows,
            queries=certificate.queries + fits.queries,
            work=certificate.work + fits.work,
        )
        return certificate.checked() if check else certificate

    def mass(self, q: ArrayLike | None = None) -> MassProperties:
        """Return mass, centre of mass and inertia of the whole in the ground frame; parts without mass count as massless.

        Args:
            q: Configuration `(nq,)` [rad, mm]; the rest pose by default.
        """
        poses = Poses(self.mechanism.parts, self.mechanism.at_rest if q is None else self.poses(q))
        return MassProperties.combined([part.mass.moved(poses[name]) for name, part in self.parts.items() if part.mass is not None])

    def dynamics(self, *, gravity: Sequence[float] = GRAVITY) -> Dynamics:
        """Return the rigid-body dynamics: mass matrix, bias, inverse and forward dynamics, with loops and couplings closed.

        Parts without mass count as massless. Configurations are in mm and rad; velocities, efforts and inertias in SI units.

        Args:
            gravity: Acceleration [m/s²] in the ground frame.
        """
        masses = {name: part.mass for name, part in self.parts.items() if part.mass is not None}
        return Dynamics(self.mechanism, masses, gravity=gravity)

    def to_plan(self) -> AssemblyPlan:
        """Return the plan it was made from with the current parameters, or else a newly written plan that describes it.

        `articad.export.plan.write_plan` lists what such a plan cannot hold, shapes above all.

        Raises:
            UnrepresentableError: If a plan cannot express its rest pose.
        """
        from articad.export.plan import plan_of  # noqa: PLC0415 - above this module

        return plan_of(self)[0]

    def render(self, views: Sequence[str] = ("iso",), **options: Any) -> dict[str, Image.Image]:
        """Draw the assembly from several sides; see `articad.render.render_views` for the options."""
        from articad.render import render_views  # noqa: PLC0415 - pictures are not needed to assemble

        return render_views(self, views, **options)

    def _repr_html_(self) -> str:
        """Return the HTML by which a notebook shows the assembly: the page of a report, with a slider for each driver."""
        from articad.report import notebook_page  # noqa: PLC0415 - only where one looks

        return notebook_page(self)

    def _repr_mimebundle_(self, **_wanted: object) -> dict[str, str]:
        """Return the forms a notebook may choose from: the page, and plain text if nothing can be drawn."""
        return {"text/plain": repr(self), "text/html": self._repr_html_()}

    def __repr__(self) -> str:
        joints = ", ".join(f"{joint.name}: {joint.type}" for joint in self.joints if joint.type is not JointType.FIXED)
        return f"<Assembly {self.name}: {len(self.parts)} parts, {self.mechanism.mobility} freedoms ({joints})>"

    def scene(self) -> Scene:
        """Return bodies, relations and fits, for measurements of interference beyond `check`, `check_motion` and `certify`."""
        return Scene.of(
            self._meshes(), self.joints, waivers=self.waivers, deflection=self._deflections(), fits=self.fits, environment=self.environment
        )

    def _with_fits(self, checks: Checks, joints: Sequence[str] | None = None) -> Checks:
        if not self.fits:
            return checks
        fits = self._held_fits(joints)
        return replace(checks, findings=checks.findings + fits.findings, fits=fits.rows)

    def _held_fits(
        self, joints: Sequence[str] | None, spans: Mapping[str, tuple[float, float]] | None = None, *, seconds: float = PROOF_SECONDS
    ) -> FitReport:
        """Check the fits of some joints and of those that move with them in loops and couplings; by default of all joints."""
        if joints is not None:
            tied = constrained_joints(self.mechanism)
            joints = [*joints, *(sorted(tied) if tied & set(joints) else ())]
        return check_fits(self.scene(), lambda: followed(self.mechanism), proven=spans, joints=joints, seconds=seconds)

    def _meshes(self) -> dict[str, TriMesh]:
        return {name: mesh for name, part in self.parts.items() if (mesh := part.mesh) is not None}

    def _deflections(self) -> dict[str, float]:
        return {name: part.deflection for name, part in self.parts.items()}

    def _frame(self, part: str, frame: SE3 | str | None) -> SE3:
        if isinstance(frame, str):
            return self.parts[part][frame].connector.frame
        return SE3.identity() if frame is None else frame

    def _is_clear(self, configuration: Configuration) -> bool:
        """Return whether no two parts overlap in a configuration beyond what joints, fits and waivers allow."""
        poses = Poses(self.mechanism.parts, self.mechanism.arrays.poses(configuration.columns))
        checks = check_scene(self.scene(), poses, over="pose", ground=self.ground)
        return all(pair.verdict in {"clear", "contact"} for pair in checks.pairs)

    def _refuse_followers_outside_limits(self, q: FloatArray, names: Iterable[str]) -> None:
        if self.mechanism.is_tree:
            return
        mine = [group for group in self.mechanism.branch.groups if {c.joint for c in group.drivers} & set(names)]
        followers = {joint.name: group for group in mine for joint in group.joints}
        for error in self.mechanism.configuration(q).violations() if mine else ():
            group = followers.get(error.joint.split(".")[0])
            if group is None or error.joint in {c.name for c in group.drivers}:
                continue
            driver = next(c for c in group.drivers if c.joint in set(names))
            raise LimitError(error.joint, error.value, error.lower, error.upper, error.unit, self._advice(driver, q, names))

    def _advice(self, driver: Coordinate, q: FloatArray, names: Iterable[str]) -> str:
        """Say how far a driver may go while the other drivers that were set keep their values."""
        if driver.unit == "1":
            return f"It follows {driver.joint!r}."
        others = {
            c.name: float(v) for c, v in zip(self.drivers, q, strict=True) if c.joint in set(names) - {driver.joint} and c.unit != "1"
        }
        try:
            feasible = self.mechanism.feasible_range(driver.name, at=others)
        except KinematicsError:  # without this driver, the values of the others cannot be reached
            return f"It follows {driver.name!r}."
        return f"It follows {driver.name!r}, which may go from {feasible.lower:.6g} to {feasible.upper:.6g} {driver.unit} there."

    def _refuse_outside_limits(self, q: FloatArray, names: Iterable[str]) -> None:
        asked = set(names)
        for value, driver in zip(q, self.drivers, strict=True):
            if driver.joint not in asked or (math.isinf(driver.lower) and math.isinf(driver.upper)):
                continue
            if not driver.lower - _LIMIT_SLACK <= value <= driver.upper + _LIMIT_SLACK:
                raise LimitError(driver.name, float(value), driver.lower, driver.upper, driver.unit)


def _weighed(part: Part, planned: ResolvedPart) -> Part:
    """Return the part as it counts in an assembly: the environment has no mass."""
    return replace(part, mass=None) if planned.environment else part


def _restored(kind: type[Assembly], given: dict[str, Any]) -> Assembly:
    return kind(**given)


def build(
    plan: AssemblyPlan,
    parts: str | Path | Mapping[str, str | bytes],
    *,
    kernel: PartKernel | None = None,
    sandbox: Literal["strict", "weak"] = "strict",
    jobs: int | None = None,
    deflection: float = DEFLECTION_MM,
) -> Assembly:
    """Build every part script of a plan in the sandbox and assemble the result; see `Assembly.from_plan`.

    Args:
        plan: The plan.
        parts: Folder of the part scripts, or their sources by part.
        kernel: Builds them; the plan's own choice by default.
        sandbox: "weak" runs scripts with less isolation than Landlock or bubblewrap give.
        jobs: Parts built at once; all processors by default.
        deflection: Largest distance of the meshes from the solids [mm].
    """
    return Assembly.from_plan(plan, parts, kernel=kernel, sandbox=sandbox, jobs=jobs, deflection=deflection)
