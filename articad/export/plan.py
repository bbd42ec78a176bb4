"""A plan for any assembly: `plan.json` with its parts' connectors and its joints, also for files that articad did not write.

For an assembly made from a plan, this is that plan with the parameters that it was built with. For any other, a new plan is written:
names become plan names, radians degrees, poses axes and angles. A plan contains no shapes, since scripts build them.
"""

from __future__ import annotations

import keyword
import math
import re
from collections.abc import Iterable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, get_args

from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.errors import KinematicsError, UnrepresentableError
from articad.export.bundle import Bundle
from articad.export.features import features_of
from articad.export.losses import Feature, kept_losses, losses_of, refuse
from articad.findings import Finding
from articad.geometry.part import Part
from articad.kinematics.joints import Joint, JointType
from articad.kinematics.mechanism import Mechanism
from articad.plan.fields import MAX_NAME, is_name
from articad.plan.motions import AXES
from articad.plan.resolve import Material
from articad.plan.schema import PLAN_FILE, SCHEMA, AssemblyPlan, ConnectorKind

if TYPE_CHECKING:
    from articad.assembly import Assembly

FAR_MM, FAR_DEG = 1e6, 36_000.0  # limits that replace an endless coordinate where a plan cannot have one
UNKNOWN_DENSITY = 1000.0  # kg/m³: water
MM3_PER_M3 = 1e9

_RESTS_AT_ZERO = (JointType.BALL, JointType.PLANAR, JointType.UNIVERSAL, JointType.FREE)


def write_plan(assembly: Assembly, *, strict: bool = False) -> Bundle:
    """Write an assembly as a plan.

    Args:
        assembly: What to write.
        strict: Refuse what a plan holds only with a loss of motion, mass or shape.

    Returns:
        `plan.json` and the losses.

    Raises:
        UnrepresentableError: If `strict` and there is such a loss, or if a plan cannot express the rest pose of a loop.
    """
    plan, features = plan_of(assembly)
    losses = (*losses_of("plan", features), *kept_losses("plan", assembly.kept))
    if strict:
        refuse(losses)
    return Bundle({PLAN_FILE: plan.dumps().encode()}, losses)


def plan_of(assembly: Assembly) -> tuple[AssemblyPlan, list[Feature]]:
    """Return the plan of an assembly, and its features that a plan may not hold.

    Raises:
        UnrepresentableError: If a ball, planar or universal joint of a loop does not rest at zero.
    """
    if assembly.resolved is not None:
        given = assembly.resolved.overrides
        plan = assembly.resolved.plan
        parameters = tuple(one.model_copy(update={"value": given[one.name]}) if one.name in given else one for one in plan.parameters)
        return plan.model_copy(update={"parameters": parameters}), []
    teller = _Teller(assembly)
    return AssemblyPlan.from_json(teller.document()), teller.features


class _Names:
    """Plan names for given names, each once; `changed` records those that differ."""

    def __init__(self, wanted: Iterable[str]) -> None:
        self._names: dict[str, str] = {}
        self._taken: set[str] = set()
        self._numbers: dict[str, int] = {}  # the next number to try for a name that is taken
        for name in wanted:
            self._names[name] = self._free(plan_name(name))

    def _free(self, name: str) -> str:
        number, free = self._numbers.get(name, 2), name
        while free in self._taken:
            tail = f"_{number}"
            free, number = name[: MAX_NAME - len(tail)].rstrip("_") + tail, number + 1
        self._taken.add(free)
        self._numbers[name] = number
        return free

    def __getitem__(self, name: str) -> str:
        return self._names[name]

    @property
    def changed(self) -> list[tuple[str, str]]:
        return [(old, new) for old, new in self._names.items() if old != new]


def plan_name(wanted: str) -> str:
    """Return a valid plan name: lower-case words with single underscores, at most 40 characters, not a keyword."""
    name = re.sub(r"[^a-z0-9]+", "_", wanted.lower()).strip("_")[:MAX_NAME].strip("_")
    if not name[:1].isalpha():
        name = f"n{name}"[:MAX_NAME].rstrip("_")
    if keyword.iskeyword(name):
        name = f"{name}_"[: MAX_NAME - 1] + "1"
    assert is_name(name)
    return name


class _Teller:
    """Converts an assembly to a plan; `features` collects what the plan leaves out."""

    def __init__(self, assembly: Assembly) -> None:
        self.assembly, self.mechanism = assembly, _rested(assembly.mechanism)
        self.features = [feature for feature in features_of(assembly) if feature.key not in {"limits.open", "slide.endless"}]
        self.features.append(Feature("plan.shape", "parts"))
        self.parts, self.joints = _Names(assembly.parts), _Names(joint.name for joint in assembly.joints)
        self.couplings = _Names(coupling.name for coupling in self.mechanism.couplings)
        self.connectors = {name: _Names(part.connectors) for name, part in assembly.parts.items()}
        self.materials: dict[str, Material] = {}
        for kind, names in (("parts", self.parts), ("joints", self.joints), ("couplings", self.couplings)):
            self.features += [Feature("name", f"{kind}.{old}", new) for old, new in names.changed]
        if plan_name(assembly.name) != assembly.name:
            self.features.append(Feature("name", "name", plan_name(assembly.name)))

    def document(self) -> dict[str, Any]:
        assembly = self.assembly
        rest = self.mechanism.rest_poses()
        parts = [self._part(name, part, rest[name]) for name, part in assembly.parts.items()]
        joints = [self._joint(old, new) for old, new in zip(assembly.joints, self.mechanism.joints, strict=True)]
        materials = [
            {"name": name, "density_kg_m3": one.density, "color": one.color, "friction": one.friction}
            for name, one in self.materials.items()
        ]
        return {
            "schema": SCHEMA,
            "name": plan_name(assembly.name),
            "ground": self.parts[assembly.ground],
            "freedoms": self.mechanism.mobility,
            "tree": not self.mechanism.loop_joints,
            "materials": materials,
            "parts": parts,
            "joints": joints,
            "couplings": [self._coupling(index) for index in range(len(self.mechanism.couplings))],
            "allow": [
                {"parts": [self.parts[part] for part in waiver.parts], "max_depth_mm": waiver.max_depth, "reason": waiver.reason}
                for waiver in assembly.waivers
            ],
        }

    def _part(self, name: str, part: Part, T: SE3) -> dict[str, Any]:
        connectors = [self._connector(name, connector) for connector in part.connectors.values()]
        found: dict[str, Any] = {
            "name": self.parts[name],
            "material": self._material(name, part),
            "description": _described(part),
            "connectors": connectors,
            "color": part.color.lower(),
        }
        if part.mesh is not None and (part.mesh.bounds[1] - part.mesh.bounds[0] > 0).all():
            found["envelope_mm"] = (part.mesh.bounds[1] - part.mesh.bounds[0]).tolist()
        return found | ({} if (T.data == SE3.identity().data).all() else {"rest_pose": _pose(T)})

    def _connector(self, part: str, connector: Connector) -> dict[str, Any]:
        frame = connector.frame
        return {
            "name": self.connectors[part][connector.name],
            "o": frame.translation.tolist(),
            "z": frame.z_axis.tolist(),
            "x": frame.x_axis.tolist(),
            "kind": connector.kind if connector.kind in get_args(ConnectorKind) else "frame",
            "label": connector.label,
        }

    def _material(self, name: str, part: Part) -> str:
        """Return the material of a part: its own, or one with the density that gives its mass."""
        known = self.assembly.materials.get(part.material or "")
        if known is None:
            solid = part.solid.volume if part.solid is not None else 0.0
            mesh = part.mesh.volume if part.mesh is not None and part.mesh.is_closed else 0.0
            volume, mass = solid or mesh, 0.0 if part.mass is None else part.mass.mass
            density = mass / volume * MM3_PER_M3 if mass > 0 and volume > 0 else UNKNOWN_DENSITY
            if part.mass is not None:
                key = "plan.mass" if mass > 0 and volume > 0 else "plan.density"
                self.features.append(Feature(key, f"parts.{name}", f"{density:.6g} kg/m³"))
            known = Material(part.material or "material", density, part.color.lower(), 0.6)
        for taken, one in self.materials.items():
            if (one.density, one.friction) == (known.density, known.friction) and (one.name == known.name):
                return taken
        wanted, number = plan_name(known.name), 2
        while wanted in self.materials:
            wanted, number = f"{plan_name(known.name)[: MAX_NAME - 6]}_{number}", number + 1
        self.materials[wanted] = known
        return wanted

    def _joint(self, old: Joint, joint: Joint) -> dict[str, Any]:
        where = f"joints.{joint.name}"
        ends = ((joint.parent, joint.parent_connector), (joint.child, joint.child_connector))
        parent, child = (f"{self.parts[part]}.{self.connectors[part][connector]}" for part, connector in ends)
        found: dict[str, Any] = {"name": self.joints[joint.name], "type": str(joint.type), "parent": parent, "child": child}
        found |= {"mate": str(joint.mate), "driver": joint.driver}
        if old.rest != joint.rest:
            self.features.append(Feature("plan.rest", where))
        if joint.type is JointType.BALL:
            cone = math.pi if joint.limits.cone is None else joint.limits.cone
            found["cone_deg"] = min(degrees(cone), 180.0)
            found["twist_deg"] = None if joint.limits.twist is None else [degrees(bound) for bound in joint.limits.twist]
        for axis, lower, upper, rest in zip(AXES[joint.type], joint.limits.lower, joint.limits.upper, joint.rest, strict=False):
            found[axis.range] = self._range(joint, axis.range, (lower, upper), where)
            if axis.rest is not None:
                found[axis.rest] = degrees(rest) if axis.unit == "deg" else rest
        if joint.type is JointType.SCREW:
            found["lead_mm"] = joint.lead
        fastening = {} if joint.fastening is None else {"fastening": joint.fastening}
        return found | self._capacity(joint, where) | self._fit(joint) | fastening

    def _range(self, joint: Joint, field: str, bounds: tuple[float, float], where: str) -> Any:
        turns = field.endswith("_deg")
        if math.isinf(bounds[0]) and math.isinf(bounds[1]) and (field == "angle_deg" or joint.type is JointType.CYLINDRICAL):
            return "endless"
        if not all(map(math.isfinite, bounds)):
            self.features.append(Feature("plan.endless", where))
        far = FAR_DEG if turns else FAR_MM
        return [min(max(degrees(bound) if turns else bound, -far), far) if math.isinf(bound) else degrees(bound) if turns else bound
                for bound in bounds]  # fmt: skip

    def _capacity(self, joint: Joint, where: str) -> dict[str, float]:
        """Return effort and velocity: a plan states one of each for rotation and one for translation."""
        found: dict[str, float] = {}
        turning = {"1": "rad"}
        for values, keys in ((joint.effort, ("effort_n_mm", "effort_n")), (joint.velocity, ("velocity_deg_s", "velocity_mm_s"))):
            for unit, key in zip(("rad", "mm"), keys, strict=True):
                own = [value for value, u in zip(values, joint.type.units, strict=False) if turning.get(u, u) == unit]
                stated = [value for value in own if value is not None and value > 0]
                if stated:
                    found[key] = degrees(stated[0]) if key == "velocity_deg_s" else stated[0]
                if len(set(own)) > 1:
                    self.features.append(Feature("plan.capacity", where))
        return found

    def _fit(self, joint: Joint) -> dict[str, Any]:
        fit = self.assembly.fits.get(joint.name)
        if fit is None:
            return {}
        gap = None if fit.gap_min is None or fit.gap_max is None else [fit.gap_min, fit.gap_max]
        kept = {"within_mm": fit.within, "contact": fit.contact}
        if fit.name is not None:
            return {"fit": {**kept, "name": fit.name, "nominal_mm": fit.nominal}}
        return {"fit": {"gap_mm": gap, **kept}}

    def _coupling(self, index: int) -> dict[str, Any]:
        """Return a coupling as a linear relation, in degrees and mm."""
        row = self.mechanism.couplings[index]
        units = {coordinate.name: coordinate.unit for coordinate in self.mechanism.coordinates}
        scale = {"rad": math.radians(1.0), "mm": 1.0}
        a, b = scale[units[row.a]], scale[units[row.b]]
        names = [".".join((self.joints[joint], *rest)) for joint, *rest in (self._column(name) for name in (row.a, row.b))]
        return {
            "name": self.couplings[row.name],
            "type": "linear",
            "joints": names,
            "ratio": row.ratio * a / b,
            "offset": row.offset / b,
        }

    def _column(self, name: str) -> tuple[str, ...]:
        """Return the joint of a column, and its coordinate where the joint has several."""
        joint = next(coordinate.joint for coordinate in self.mechanism.coordinates if coordinate.name == name)
        return (joint,) if name == joint else (joint, name.removeprefix(f"{joint}."))


def degrees(radians: float) -> float:
    """Return an angle in degrees that a plan converts back to exactly the same float, if there is one."""
    scale = math.radians(1.0)
    near = radians / scale
    for value in (near, round(near, 9), math.nextafter(near, math.inf), math.nextafter(near, -math.inf)):
        if value * scale == radians:
            return value
    return near


def _rested(mechanism: Mechanism) -> Mechanism:
    """Return the mechanism with balls, planar and universal joints at rest at zero, as a plan requires."""
    moved = {joint.name for joint in mechanism.joints if joint.type in _RESTS_AT_ZERO and joint.rest != joint.type.neutral}
    if not moved:
        return mechanism
    first = min(moved)
    joints = [replace(joint, rest=joint.type.neutral) if joint.name in moved else joint for joint in mechanism.joints]
    outside = [joint.name for joint in joints if joint.name in moved and not _holds_zero(joint)]
    loops = {joint.name for joint in mechanism.loop_joints}
    for loop in mechanism.loop_joints:
        loops |= {joint.name for joint in mechanism.tree.joints_between(loop.parent, loop.child)}
    if not outside and not loops & moved:
        try:
            return mechanism.changed(joints=joints)
        except KinematicsError:
            pass
    lost = "a ball, planar or universal joint of a plan rests at zero, but this one cannot"
    finding = Finding(code="E_UNREPRESENTABLE", where=f"joints.{first}", message=f"plan: {lost}.", hint="Let it rest at zero.")
    raise UnrepresentableError(f"joints.{first}", "plan", lost, findings=[finding])


def _holds_zero(joint: Joint) -> bool:
    limits = joint.limits
    ranges = [*zip(limits.lower, limits.upper, strict=True), *([] if limits.twist is None else [limits.twist])]
    return all(lower <= 0 <= upper for lower, upper in ranges)


def _pose(T: SE3) -> dict[str, Any]:
    x, y, z, w = (float(number) for number in T.quaternion)
    sine = math.hypot(x, y, z)
    found: dict[str, Any] = {"at": T.translation.tolist()}
    if sine > 0:
        found |= {"axis": [x / sine, y / sine, z / sine], "angle_deg": math.degrees(2 * math.atan2(sine, w))}
    return found


def _described(part: Part) -> str:
    if part.mesh is None:
        return "No shape: a frame for joints."
    sides = " x ".join(f"{side:.6g}" for side in part.mesh.bounds[1] - part.mesh.bounds[0])
    return f"As it was read: a mesh of {len(part.mesh.triangles)} triangles, {sides} mm."
