"""The content of a FreeCAD document as data: written by FreeCAD, or by articad if FreeCAD is not installed.

Every part is an App::Part with its shape and a coordinate system per connector; joints refer to these, so that no face
or edge is named. Derived parts follow their source. Each placement is computed by articad.
"""

from __future__ import annotations

import json
import math
import shutil
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from articad.aliases import Json
from articad.arrays import FloatArray
from articad.connectors.mate import FLIP, Mate
from articad.connectors.se3 import SE3
from articad.errors import PlanError
from articad.export.bundle import Loss
from articad.export.features import joint_features
from articad.export.freecad_expressions import Followed, Number, names_in
from articad.export.freecad_file import mesh_kernel
from articad.export.freecad_materials import card
from articad.export.losses import Feature, kept_losses, losses_of
from articad.export.lowering import lower
from articad.export.meshes import MeshFiles
from articad.export.metadata import dumps, records
from articad.export.names import FileNames, Names
from articad.geometry.part import Part
from articad.kernels.freecad_file import bounded
from articad.kernels.trees import PartTree
from articad.kinematics.joints import Coupling, Joint, JointType
from articad.plan.resolve import ResolvedPart, ResolvedPlan, resolve

if TYPE_CHECKING:
    from articad.assembly import Assembly

_TURNED = {  # rotations from z to another axis of a connector
    "x": SE3.from_rotation([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]),
    "y": SE3.from_rotation([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]),
}
_TYPES = {
    JointType.FIXED: "Fixed",
    JointType.REVOLUTE: "Revolute",
    JointType.SLIDER: "Slider",
    JointType.CYLINDRICAL: "Cylindrical",
    JointType.BALL: "Ball",
    JointType.SCREW: "Cylindrical",  # together with a coupling of type Screw
    JointType.PLANAR: "Distance",  # of two coordinate systems: keeps their planes together
    JointType.UNIVERSAL: "Ball",  # together with a Perpendicular
}
_COUPLINGS = {"gear": "Gears", "belt": "Belt", "rack": "RackPinion", "screw": "Screw"}

_STEP = 1e-3  # relative change of a parameter, to see what it turns
PLACED_MM, PLACED_RAD = 1e-7, 1e-10  # by which a placement may differ from its expression
BILL_COLUMNS = {"Material": "ArticadMaterial", "Mass": "ArticadMass", "Description": "Label2"}
"""Columns that FreeCAD's bill of materials has beside its own, and the properties of parts that they show."""
_TAKEN = ("Assembly", "Parameters", "Joints", "GroundedJoint", "Dimensions")  # names of objects that every document may have
_FROZEN = ("shape", "mesh", "empty")  # kinds of geometry without a feature tree


class Job:
    """The content of a document; the files that it needs are written beside it.

    Args:
        assembly: The assembly, written at rest.
        folder: Folder for the files.
        features: Whether to keep the bodies of the FreeCAD kernel with all their features, which only FreeCAD can copy.
        trees: Feature trees of parts that another kernel built, by name.

    Attributes:
        name: Name of the document.
        names: Names of its objects that are taken so far.
    """

    def __init__(self, assembly: Assembly, folder: Path, *, features: bool = True, trees: Mapping[str, PartTree] | None = None) -> None:
        self.assembly, self.folder, self.features, self.trees = assembly, folder, features, trees or {}
        self._told = [feature for joint in assembly.joints for feature in joint_features(joint)]
        self._told += [Feature("fit", f"joints.{joint}") for joint in assembly.fits]
        self._told += [Feature("fastening", f"joints.{joint.name}") for joint in assembly.joints if joint.fastening]
        self.model = lower(assembly)
        self.name = self.model.name
        names = Names(_TAKEN)
        self.names = names
        files = FileNames(_TAKEN)  # an object of a part also names a file of its own: here, and where each part has its document
        self.objects = {name: names.claim(files.claim(name)) for name in assembly.parts}
        self.systems = {
            (name, connector): names.claim(f"{self.objects[name]}__{connector}")
            for name, part in assembly.parts.items()
            for connector in part.connectors
        }
        self.followed = Followed(assembly.resolved)
        self._unplaced: set[str] = set()
        self._turned: set[tuple[str, str]] = set()  # connectors with an expression of their whole frame
        self._stiff: dict[str, list[Number]] = {}  # numbers of connectors that FreeCAD does not follow
        self._drawn: dict[str, Json] = {}  # volume and centre of the meshes that stand for parts

    @cached_property
    def _poses(self) -> Mapping[str, SE3]:
        """Poses of the parts at rest."""
        return self.assembly.at()

    def to_json(self) -> Json:
        """Return the document's parameters, parts and joints, as JSON."""
        poses = self._poses
        parts = [self._part(name, part, poses[name]) for name, part in self.assembly.parts.items()]
        by_name = {part["name"]: part for part in parts}
        for part in parts:
            source = part
            while source["kind"] in ("mirror", "link"):
                source = by_name[source["source"]]
            part["frozen"] = source["kind"] in _FROZEN
        parameters = list(self._parameters(parts))
        live = sum(row["live"] for row in parameters)
        split = "all fixed" if not live else f"{live} live, {len(parameters) - live} fixed"
        return {
            "schema": "articad.job/1",
            "task": "freecad",
            "name": self.assembly.name,
            "ground": self.assembly.ground,
            "records": [
                dumps(record | self._drawn.get(record.get("name", ""), {}) if record["kind"] == "part" else record)
                for record in records(self.assembly, self.model, MeshFiles(), ())
            ],
            "parameters": parameters,
            "parameters_label": "Parameters" if live == len(parameters) else f"Parameters ({split})",
            "parts": parts,
            "joints": [*self._joints(), *self._couplings()],
            "bill": {"group": self.names.claim("Bills"), "object": self.names.claim("Bill"), "columns": BILL_COLUMNS},
        }

    # ------------------------------------------------------------------ parameters

    def _parameters(self, parts: Sequence[Json]) -> Iterator[Json]:
        """Yield the parameters. A parameter is fixed if something that it drives cannot follow it in FreeCAD.

        Args:
            parts: The parts as JSON.
        """
        resolved = self.assembly.resolved
        if resolved is None:
            return
        frozen_things = (
            ("it shapes {}, which cannot follow", self.followed.needed(self._shaping(parts))),
            ("it places {} at rest, which cannot follow", self.followed.placing(self._unplaced)),
            ("it turns the connector {}, which cannot follow", self._turning(resolved)),
        )
        given = {parameter.name: resolved.overrides.get(parameter.name, parameter.value) for parameter in resolved.plan.parameters}
        fixed = {name: [text.format(", ".join(sorted(held[name])[:5])) for text, held in frozen_things if name in held] for name in given}
        followed = {name: [other for other in names_in(number) if other in given] for name, number in given.items()}
        order = list(given)
        while order:  # a value that follows only fixed values is fixed
            order = [name for name in given if not fixed[name] and followed[name] and all(fixed[other] for other in followed[name])]
            for name in order:
                fixed[name].append(f"it follows {', '.join(followed[name][:5])}, which cannot be edited here")
        for parameter in resolved.plan.parameters:
            reasons = fixed[parameter.name]
            why = f"Fixed: {'; '.join(reasons)}. Change it in the plan and export again." if reasons else ""
            yield {
                "live": not reasons,
                "why": why,
                "name": parameter.name,
                "value": float(resolved.parameters[parameter.name]),
                "unit": parameter.unit,
                "description": parameter.description,
                "expression": self.followed.number(given[parameter.name]),
            }

    def _shaping(self, parts: Sequence[Json]) -> dict[str, list[Number]]:
        """Return the numbers of the plan that shape what cannot follow: all of a frozen part, and the fixed dimensions of another."""
        found: dict[str, list[Number]] = {}
        for part in parts:
            held = (
                {}
                if self.assembly.resolved is None or not part["dimensions"]
                else self.assembly.resolved.parts[part["name"]].spec.dimensions
            )
            if part["kind"] in _FROZEN:
                found[part["name"]] = list(held.values())
            elif part["kind"] == "body":
                found |= {f"{row['name']} of {part['name']}": [held[row["name"]]] for row in part["dimensions"] if not row["live"]}
        return found

    def _turning(self, resolved: ResolvedPlan) -> dict[str, set[str]]:
        """Return the connectors that each parameter turns although no expression turns them in FreeCAD.

        Some are known by their numbers. An x axis that the plan leaves out is chosen by rule from the connectors that meet there, so
        the plan is resolved with each parameter changed by a thousandth.
        """
        found = self.followed.needed(self._stiff)
        for parameter in resolved.plan.parameters:
            value = float(resolved.parameters[parameter.name])
            if self.followed.number(resolved.overrides.get(parameter.name, parameter.value)) is not None:
                continue  # it follows others
            for step in (_STEP * max(abs(value), 1.0), -_STEP * max(abs(value), 1.0)):
                try:
                    other = resolve(resolved.plan, **{**resolved.overrides, parameter.name: value + step})
                except PlanError:
                    continue  # beyond its bounds
                turned = {
                    f"{name}.{key}"
                    for name, part in resolved.parts.items()
                    for key, connector in part.connectors.items()
                    if (name, key) not in self._turned and not _same_rotation(connector.frame, other.parts[name].connectors[key].frame)
                }
                if turned:
                    found.setdefault(parameter.name, set()).update(turned)
                break
        return found

    # ------------------------------------------------------------------ parts

    def _part(self, name: str, part: Part, T: SE3) -> Json:
        resolved = self.assembly.resolved
        target = None if resolved is None else resolved.parts.get(name)
        form: Json = {
            "name": name,
            "object": self.objects[name],
            "color": part.color,
            "material": part.material,
            "mass": (mass := _mass(part)),
            "card": card(part.material, None if mass is None else mass["density"]),
            "description": "" if target is None else target.description,
            "placement": _seven(T),
            "placed": self._placed(name, T),
            "dimensions": [] if target is None else list(self._dimensions(target)),
            "connectors": [self._connector(name, connector, target) for connector in part.connectors],
        }
        return form | self._geometry(name, part, target)

    def _geometry(self, name: str, part: Part, target: ResolvedPart | None) -> Json:
        realised = self.assembly.realised.get(name)
        if realised is None or target is None:
            return self._loose(name, part)
        derivation = target.derivation
        if derivation is not None and derivation.S is None:
            recolored = part.color != self.assembly.parts[derivation.source].color
            return {"kind": "link", "source": derivation.source, "recolored": recolored}
        if derivation is not None:
            point, normal = _plane(np.asarray(derivation.S, dtype=np.float64))
            return {
                "kind": "mirror",
                "source": derivation.source,
                "plane": {"point": point, "normal": normal},
                "expressions": (expressions := self.followed.mirror(name)),
                "reflected": _reflected(normal, turns="Normal" in expressions),
            } | ({} if self.features else {"file": self._file(realised.built.folder / "part.brep", f"{self.objects[name]}.brep")})
        document = realised.built.folder / "part.FCStd"
        if document.is_file() and self.features:
            seated = realised.built.folder / "seat.json"
            seat = json.loads(seated.read_text()) if seated.is_file() else _seven(SE3.identity())
            return {"kind": "body", "file": self._file(document, f"{self.objects[name]}.FCStd"), "body": "Body", "seat": seat}
        tree = self.trees.get(name)
        if tree is not None and tree.document is not None:
            return {
                "kind": "body",
                "file": self._file(tree.document, f"{self.objects[name]}.FCStd"),
                "body": "Body",
                "seat": _seven(tree.seat),
            }
        why = "" if tree is None else tree.reason
        self._tell("freecad.features" if document.is_file() else "freecad.brep", f"parts.{name}", why)
        return {"kind": "shape", "file": self._file(realised.built.folder / "part.brep", f"{self.objects[name]}.brep"), "why": why}

    def _loose(self, name: str, part: Part) -> Json:
        """Return the geometry of a part that no script built."""
        if part.solid is not None and part.solid.brep is not None and part.solid.brep.is_file():
            return {"kind": "shape", "file": self._file(part.solid.brep, f"{self.objects[name]}.brep")}
        if part.mesh is None:
            return {"kind": "empty"}
        self._tell("freecad.mesh", f"parts.{name}")
        (self.folder / f"{self.objects[name]}.bms").write_bytes(mesh_kernel(part.mesh))
        if part.mesh.is_closed and part.mesh.volume > 0:
            volume, com, *_ = part.mesh.solid_integrals()
            self._drawn[name] = {"drawn": {"volume": volume, "com": com.tolist()}}
        return {"kind": "mesh", "file": f"{self.objects[name]}.bms"}

    def _file(self, path: Path, name: str) -> str:
        if path.suffix == ".brep":
            (self.folder / name).write_bytes(bounded(path.read_bytes()))
        else:
            shutil.copyfile(path, self.folder / name)
        return name

    def _dimensions(self, target: ResolvedPart) -> Iterator[Json]:
        tree = self.trees.get(target.name)
        fixed = {} if tree is None else tree.fixed
        for name, value in target.dimensions.items():
            if name in fixed:
                self._tell("freecad.dimension", f"parts.{target.name}.dimensions.{name}", fixed[name])
            yield {
                "name": name,
                "value": float(value),
                "expression": self.followed.number(target.spec.dimensions[name]),
                "live": name not in fixed,
                "why": f"Fixed: {fixed[name]}. Change it in the plan and export again." if name in fixed else "",
            }

    def _connector(self, part: str, connector: str, target: ResolvedPart | None) -> Json:
        held = self.assembly.parts[part].connectors[connector]
        expressions: dict[str, str] = {}
        if target is not None and target.derivation is None:
            expressions = self._follows(target, connector)
            if "Placement" in expressions:
                self._turned.add((part, connector))
        elif target is not None and target.derivation is not None and target.derivation.S is not None:
            (form,) = [spec for spec in target.spec.connectors if spec.name == connector]
            if self.followed.follows(*form.z, *(form.x or ())):  # the image follows only the origin of its source's connector
                self._tell("freecad.direction", f"parts.{part}.connectors.{connector}")
                self._stiff[f"{part}.{connector}"] = [*form.z, *(form.x or ())]
        return {
            "name": connector,
            "object": self.systems[part, connector],
            "label": held.label,
            "placement": _seven(held.frame),
            "expressions": expressions,
        }

    def _follows(self, target: ResolvedPart, connector: str) -> dict[str, str]:
        """Return the expressions of a connector: of its origin, or of all of its frame."""
        where = f"parts.{target.name}.connectors.{connector}"
        (form,) = [spec for spec in target.spec.connectors if spec.name == connector]
        turns = self.followed.follows(*form.z, *(form.x or ()))
        if form.frame != "part":
            text = None if form.x is None else self.followed.local(target.name, self.followed.frame(form.o, form.z, form.x))
            if text is not None and "Parameters." in text:
                return {"Placement": text}
            if turns or self.followed.follows(*form.o):
                self._tell("freecad.frame", where)
                self._stiff[f"{target.name}.{connector}"] = [*form.o, *form.z, *(form.x or ())]
            return {}
        if turns and form.x is not None:
            return {"Placement": self.followed.frame(form.o, form.z, form.x)}
        if turns:
            self._tell("freecad.direction", where)
            self._stiff[f"{target.name}.{connector}"] = list(form.z)
        found = {f"Placement.Base.{axis}": self.followed.number(number, "mm") for axis, number in zip("xyz", form.o, strict=True)}
        return {name: text for name, text in found.items() if text is not None}

    def _placed(self, name: str, T: SE3) -> str:
        """Return the expression of a part's placement at rest, or an empty text if nothing moves it or no expression gives it.

        A part with a `rest_pose` has that pose. A part that a joint places has T_p C_p J(q_rest) F C_c⁻¹ of live objects.
        """
        resolved = self.assembly.resolved
        if resolved is None or name not in resolved.parts or not resolved.parameters:
            return ""
        if not resolved.parts[name].T_rest.allclose(T, mm=PLACED_MM, rad=PLACED_RAD):
            self._tell("freecad.placement", f"parts.{name}")  # closing a loop has moved it
            self._unplaced.add(name)
            return ""
        moves, root = self.followed.motions(name)
        if root is None:
            text = " * ".join(moves)
            return text if "Parameters." in text else ""
        if root != name:
            return " * ".join([*moves, f"{self.objects[root]}.Placement"])
        text = self._placed_by_joint(resolved.parts[name].parent_joint, name)
        if not text:
            self._tell("freecad.placement", f"parts.{name}")
            self._unplaced.add(name)
        return text

    def _placed_by_joint(self, joint_name: str | None, name: str) -> str:
        """Return the placement that a joint gives a part, as an expression of its other part and its connectors."""
        joint = next((joint for joint in self.assembly.joints if joint.name == joint_name), None)
        motion = None if joint is None else self._motion(joint)
        if joint is None or motion is None:
            return ""
        near, far = ((joint.parent, joint.parent_connector), (joint.child, joint.child_connector))
        turned = [motion, *([_placement(FLIP)] if joint.mate is Mate.OPPOSED else [])]
        if joint.child != name:
            near, far = far, near
            turned = [f"minvert({text})" for text in reversed(turned)]
        frames = [f"{self._system(*side)}.Placement" for side in (near, far)]
        return " * ".join([f"{self.objects[near[0]]}.Placement", frames[0], *turned, f"minvert({frames[1]})"])

    def _system(self, part: str, connector: str) -> str:
        """Return the object of a connector: a link shows those of its source."""
        realised = self.assembly.resolved.parts[part].derivation if self.assembly.resolved is not None else None
        while realised is not None and realised.S is None:
            part = realised.source
            realised = self.assembly.resolved.parts[part].derivation if self.assembly.resolved is not None else None
        return self.systems[part, connector]

    def _motion(self, joint: Joint) -> str | None:
        """Return the motion J(q_rest) of a joint as an expression, or None if none gives it."""
        resolved = self.assembly.resolved
        form = next((row for row in resolved.plan.joints if row.name == joint.name), None) if resolved is not None else None
        slide, turn = (getattr(form, field, None) for field in ("rest_mm", "rest_deg"))
        if not self.followed.follows(*(number for number in (slide, turn) if number is not None)):
            return _placement(joint.motion(joint.rest))
        if joint.type not in (JointType.REVOLUTE, JointType.SLIDER, JointType.CYLINDRICAL):
            return None
        along, about = (self.followed.always(number or 0.0) for number in (slide, turn))
        return f"create(<<placement>>; vector(0; 0; {along}); create(<<rotation>>; vector(0; 0; 1); {about}))"

    # ------------------------------------------------------------------ joints and couplings

    def _joints(self) -> Iterator[Json]:
        for joint in self.assembly.joints:
            if joint.type is JointType.FREE:  # FreeCAD has no such joint: its part is loose
                continue
            form = self._joint(joint)
            yield form
            if joint.type is JointType.UNIVERSAL:
                near, far = self._offsets(joint)
                turned = {"type": "Perpendicular", "offset_1": _seven(near @ _TURNED["x"]), "offset_2": _seven(far @ _TURNED["y"])}
                yield form | turned | {"object": self.names.claim(f"{joint.name}__axes"), "label": f"{joint.name} axes", "limits": {}}
            if joint.type is JointType.SCREW:
                yield (
                    form
                    | {"type": "Screw", "object": self.names.claim(f"{joint.name}__thread"), "label": f"{joint.name} thread"}
                    | {
                        "limits": {},
                        "distances": {"Distance": joint.lead},
                        "active": False,
                    }
                )

    def _joint(self, joint: Joint) -> Json:
        turned, (near, far) = self._limit_expressions(joint), self._offsets(joint)
        return {
            "name": joint.name,
            "object": self.names.claim(joint.name),
            "label": self._shown(joint.name),
            "type": _TYPES[joint.type],
            "active": True,
            "parent": joint.parent,
            "parent_connector": joint.parent_connector,
            "child": joint.child,
            "child_connector": joint.child_connector,
            "offset_1": _seven(near),
            "offset_2": _seven(far),
            "limits": _limits(joint),
            "distances": {"Distance": 0.0} if joint.type is JointType.PLANAR else {},
            "expressions": turned,
        }

    def _offsets(self, joint: Joint) -> tuple[SE3, SE3]:
        """Return the poses of a joint's two frames in the coordinate systems of its connectors: loops may have moved them."""
        used = (
            (joint.parent, joint.parent_connector, joint.T_parent_connector),
            (joint.child, joint.child_connector, joint.T_child_connector),
        )
        near, far = (_offset(self.assembly.parts[part].connectors[name].frame, frame) for part, name, frame in used)
        return near, far @ _flip(joint)

    def _shown(self, name: str) -> str:
        """Return the label of a joint: FreeCAD would append a number to a label that a part already has."""
        return f"{name} joint" if name in self.assembly.parts else name

    def _limit_expressions(self, joint: Joint) -> dict[str, str]:
        """Return the expressions of a joint's limits, if the plan states them as such."""
        resolved = self.assembly.resolved
        if resolved is None:
            return {}
        held = _limits(joint)
        found: dict[str, str] = {}
        for spec in resolved.plan.joints:
            if spec.name != joint.name:
                continue
            for field, name in (("angle_deg", "Angle"), ("travel_mm", "Length")):
                bounds = getattr(spec, field, None)
                if not isinstance(bounds, (tuple, list)):
                    continue
                for end, bound in zip(("Min", "Max"), bounds, strict=True):
                    text = self.followed.number(bound)
                    if text is not None and f"{name}{end}" in held:
                        found[f"{name}{end}"] = text
        return found

    def _couplings(self) -> Iterator[Json]:
        joints, poses = {joint.name: joint for joint in self.assembly.joints}, self._poses
        for coupling in self.assembly.mechanism.couplings:
            where, kind = f"couplings.{coupling.name}", _COUPLINGS.get(coupling.kind)
            if kind is None:
                self._tell("freecad.coupling", where, coupling.kind)
                continue
            a, b = (joints[column.partition(".")[0]] for column in (coupling.a, coupling.b))
            self._tell("coupling", where, coupling.kind)
            yield {
                "name": coupling.name,
                "object": self.names.claim(coupling.name),
                "label": self._shown(coupling.name),
                "type": kind,
                "active": False,  # if active, its references would be solved as something else
                "parent": a.child,
                "parent_connector": a.child_connector,
                "child": b.child,
                "child_connector": b.child_connector,
                "offset_1": _seven(_flip(a)),
                "offset_2": _seven(_flip(b)),
                "limits": {},
                "distances": _distances(coupling, *(_axis(joint, poses) for joint in (a, b))),
                "expressions": {},
            }

    def _tell(self, key: str, where: str, detail: str = "") -> None:
        self._told.append(Feature(key, where, detail))

    @property
    def losses(self) -> tuple[Loss, ...]:
        """Losses of what FreeCAD cannot represent; complete after the conversion to JSON."""
        return (*losses_of("freecad", self._told), *kept_losses("freecad", self.assembly.kept))


def _mass(part: Part) -> Json | None:
    """Return a part's mass [kg], and the density that gives it for the volume of its solid [kg/m³]; None for a part without mass."""
    if part.mass is None:
        return None
    volume = 0.0 if part.solid is None else part.solid.volume * 1e-9
    return {"kg": float(part.mass.mass), "density": float(part.mass.mass) / volume if volume > 0 else None}


def _axis(joint: Joint, poses: Mapping[str, SE3]) -> FloatArray:
    """Return the direction along and about which the child of a joint moves, in the assembly at rest."""
    axis: FloatArray = (poses[joint.parent] @ joint.T_parent_connector).rotation[:, 2]
    return axis


def _distances(coupling: Coupling, a: FloatArray, b: FloatArray) -> dict[str, float]:
    """Return the radii, pitch radius or lead of a coupling: for a gear and a belt only their ratio is known; a left-handed lead is negative.

    Args:
        coupling: The coupling.
        a: Direction of the first joint's axis `(3,)`.
        b: Of the second's.
    """
    ratio = abs(coupling.ratio)
    if coupling.kind in ("gear", "belt"):
        return {"Distance": 10.0 * ratio, "Distance2": 10.0}
    return {"Distance": ratio if coupling.kind == "rack" else math.tau * coupling.ratio * math.copysign(1.0, float(a @ b))}


def _flip(joint: Joint) -> SE3:
    return FLIP if joint.mate is Mate.OPPOSED else SE3.identity()


def _limits(joint: Joint) -> dict[str, float]:
    """Return FreeCAD's limit properties: degrees and mm, along and about the parent's z."""
    names = {
        JointType.REVOLUTE: ("Angle",),
        JointType.SLIDER: ("Length",),
        JointType.CYLINDRICAL: ("Length", "Angle"),
        JointType.SCREW: ("Angle",),
    }.get(joint.type, ())
    limits: dict[str, float] = {}
    for name, lowest, highest in zip(names, joint.limits.lower, joint.limits.upper, strict=False):
        scale = math.degrees(1.0) if name == "Angle" else 1.0
        for end, bound in (("Min", lowest), ("Max", highest)):
            if math.isfinite(bound):
                limits[f"{name}{end}"] = float(f"{bound * scale:.16g}")  # degrees without the dust of radians
    return limits


def _plane(S: np.ndarray[Any, np.dtype[np.float64]]) -> tuple[list[float], list[float]]:
    """Return a point and the unit normal of the plane of a reflection `(4, 4)`."""
    values, vectors = np.linalg.eigh((S[:3, :3] + S[:3, :3].T) / 2)
    normal = vectors[:, int(np.argmin(values))]
    normal = normal * np.sign(normal[int(np.argmax(np.abs(normal)))])
    normal = np.where(np.abs(normal) < 1e-12, 0.0, normal)
    normal /= np.linalg.norm(normal)
    return (S[:3, 3] / 2).tolist(), normal.tolist()


def _offset(given: SE3, used: SE3) -> SE3:
    """Return the pose of a frame in another one; exactly the identity if they are equal up to rounding."""
    return SE3.identity() if given.allclose(used, mm=1e-9, rad=1e-12) else given.inverse() @ used


def _same_rotation(one: SE3, other: SE3) -> bool:
    return bool(np.linalg.norm((one.inverse() @ other).log()[3:]) < PLACED_RAD)


def _placement(T: SE3) -> str:
    """Return a constant placement as an expression."""
    x, y, z = (repr(float(number)) for number in T.translation)
    turn = T.log()[3:]
    angle = float(np.linalg.norm(turn))
    axis = turn / angle if angle else np.array([0.0, 0.0, 1.0])
    about = "; ".join(repr(float(number)) for number in axis)
    turned = f"create(<<rotation>>; vector({about}); {math.degrees(angle)!r})"
    return f"create(<<placement>>; vector({x}; {y}; {z}); {turned})"


def _seven(T: SE3) -> list[float]:
    return [float(number) for number in T.data]


def _reflected(normal: list[float], *, turns: bool) -> list[str]:
    """Return the origin of a source's connector, reflected, as expressions: it follows an edit of the source.

    `{source}` and `{image}` stand for the names of the source's connector and of the mirror image.
    """
    factors = {
        axis: f"({{image}}.Normal.{axis} / 1 mm)" if turns else f"({n!r})" for axis, n in zip("xyz", normal, strict=True) if n or turns
    }
    along = " + ".join(f"{n} * ({{source}}.Placement.Base.{axis} - {{image}}.Base.{axis})" for axis, n in factors.items())
    return [f"{{source}}.Placement.Base.{axis}" + (f" - 2 * {factors[axis]} * ({along})" if axis in factors else "") for axis in "xyz"]
