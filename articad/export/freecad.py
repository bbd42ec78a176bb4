"""FreeCAD out: a native, editable Assembly document.

Every part is an App::Part with its shape and a coordinate system per connector; joints refer to these, so that no face
or edge is named. Where the FreeCAD kernel built a part, its body comes with all features, and its dimensions follow the
plan's parameters by expressions; other parts come as the B-rep that they are. Derived parts follow their source. Each
placement is ours: FreeCAD's solver is asked only whether it agrees (it does not hold limits, and couplings neither).
"""

from __future__ import annotations

import json
import math
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from articad.connectors.mate import FLIP, Mate
from articad.connectors.se3 import SE3
from articad.errors import ExportError
from articad.export.bundle import Bundle, Loss
from articad.export.freecad_expressions import Followed
from articad.export.freecad_file import Look, normalised
from articad.export.losses import refuse
from articad.export.lowering import lower
from articad.export.metadata import dumps, records
from articad.export.names import Names
from articad.findings import Finding, Findings
from articad.geometry.mesh_files import write_stl
from articad.geometry.part import Part
from articad.kernels import freecad_install
from articad.kernels.freecad_install import FreeCAD, Limits
from articad.kinematics.joints import Coupling, Joint, JointType
from articad.plan.resolve import ResolvedPart

if TYPE_CHECKING:
    from articad.assembly import Assembly

PROGRAM = Path(freecad_install.__file__).parent / "inside_freecad" / "document.py"
SOLVED_MM, SOLVED_RAD = 1e-6, 1e-8  # by which FreeCAD's solver may move a part: contracts of the FreeCAD round trip
_SECONDS, _SECONDS_A_PART = 120.0, 5.0
_TURNED = {  # what turns z into another axis of a connector
    "x": SE3.from_rotation([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]),
    "y": SE3.from_rotation([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]),
}
_COUPLINGS = {"gear": "gear", "belt": "belt", "rack": "rack", "screw": "thread"}

Json = dict[str, Any]


def write_freecad(assembly: Assembly, *, strict: bool = False, freecad: FreeCAD | None = None) -> Bundle:
    """Write an assembly as a FreeCAD 1.0 document; FreeCAD 1.1 opens it as well.

    Args:
        assembly: At rest.
        strict: Refuse what FreeCAD cannot hold.
        freecad: The FreeCAD that writes it; by default the one that is found.

    Returns:
        One file, `<name>.FCStd`, the same bytes each time on the same FreeCAD; in the findings, whether its solver agrees.

    Raises:
        KernelUnavailableError: If there is no FreeCAD 1.0 or later.
        UnrepresentableError: If `strict` and something is lost.
        ExportError: If FreeCAD fails.
    """
    freecad = freecad or freecad_install.find()
    with tempfile.TemporaryDirectory(prefix="articad-freecad-") as scratch:
        folder = Path(scratch)
        writer = _Job(assembly, folder)
        job = writer.job()
        if strict:
            refuse(writer.losses)
        (folder / "job.json").write_text(json.dumps(job))
        seconds = _SECONDS + _SECONDS_A_PART * len(assembly.parts)
        ended = freecad.run(PROGRAM, folder=folder, limits=Limits(seconds=seconds))
        if not ended.ok or not (folder / "report.json").is_file():
            raise _failed(ended.said, late=ended.late)
        report = json.loads((folder / "report.json").read_text())
        content = (folder / "assembly.FCStd").read_bytes()
    look = Look(report["colors"], tuple(report["hidden"]), tuple(report["joints"]), report["grounded"], tuple(report["tips"]))
    return Bundle({f"{writer.name}.FCStd": normalised(content, look)}, tuple(writer.losses), _opinion(report))


class _Job:
    """What FreeCAD is told to write; the files that it needs are put beside it."""

    def __init__(self, assembly: Assembly, folder: Path) -> None:
        self.assembly, self.folder = assembly, folder
        self.losses: list[Loss] = []
        self.model = lower(assembly)
        self.name = self.model.name
        names = Names()
        for taken in ("Assembly", "Parameters", "Joints", "GroundedJoint", "Dimensions"):
            names.claim(taken)
        self.names = names
        self.objects = {name: names.claim(name) for name in assembly.parts}
        self.followed = Followed(assembly.resolved)

    def job(self) -> Json:
        poses = self.assembly.at()
        parts = [self._part(name, part, poses[name]) for name, part in self.assembly.parts.items()]
        return {
            "schema": "articad.job/1",
            "task": "freecad",
            "name": self.assembly.name,
            "ground": self.assembly.ground,
            "records": [dumps(record) for record in records(self.assembly, self.model, {}, ())],
            "parameters": list(self._parameters()),
            "parts": parts,
            "joints": [*self._joints(), *self._couplings()],
        }

    # ------------------------------------------------------------------ parameters

    def _parameters(self) -> Iterator[Json]:
        resolved = self.assembly.resolved
        if resolved is None:
            return
        for parameter in resolved.plan.parameters:
            given = resolved.overrides.get(parameter.name, parameter.value)
            yield {
                "name": parameter.name,
                "value": float(resolved.parameters[parameter.name]),
                "unit": parameter.unit,
                "description": parameter.description,
                "expression": self.followed.number(given),
            }

    # ------------------------------------------------------------------ parts

    def _part(self, name: str, part: Part, T: SE3) -> Json:
        resolved = self.assembly.resolved
        target = None if resolved is None else resolved.parts.get(name)
        form: Json = {
            "name": name,
            "object": self.objects[name],
            "color": part.color,
            "material": part.material,
            "placement": _seven(T),
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
            if part.color != self.assembly.parts[derivation.source].color:
                self._lose(f"parts.{name}", "a link to its source", f"its colour {part.color}; it has its source's", refused=False)
            return {"kind": "link", "source": derivation.source}
        if derivation is not None:
            point, normal = _plane(np.asarray(derivation.S, dtype=np.float64))
            return {
                "kind": "mirror",
                "source": derivation.source,
                "plane": {"point": point, "normal": normal},
                "expressions": self.followed.mirror(name),
            }
        document = realised.built.folder / "part.FCStd"
        if document.is_file():
            seated = realised.built.folder / "seat.json"
            seat = json.loads(seated.read_text()) if seated.is_file() else _seven(SE3.identity())
            return {"kind": "body", "file": self._file(document, f"{name}.FCStd"), "body": "Body", "seat": seat}
        self._lose(
            f"parts.{name}", "its B-rep", "its features: it follows no parameter; build with the FreeCAD kernel to keep them", refused=False
        )
        return {"kind": "shape", "file": self._file(realised.built.folder / "part.brep", f"{name}.brep")}

    def _loose(self, name: str, part: Part) -> Json:
        """Return the geometry of a part that no script built."""
        if part.solid is not None and part.solid.brep is not None and part.solid.brep.is_file():
            return {"kind": "shape", "file": self._file(part.solid.brep, f"{name}.brep")}
        if part.mesh is None:
            self._lose(f"parts.{name}", "an empty part", "nothing: it has no shape", refused=False)
            return {"kind": "empty"}
        self._lose(f"parts.{name}", "a mesh", "coordinates beyond single precision, and a solid to edit", refused=False)
        (self.folder / f"{self.objects[name]}.stl").write_bytes(write_stl(part.mesh))
        return {"kind": "mesh", "file": f"{self.objects[name]}.stl"}

    def _file(self, path: Path, name: str) -> str:
        shutil.copyfile(path, self.folder / name)
        return name

    def _dimensions(self, target: ResolvedPart) -> Iterator[Json]:
        for name, value in target.dimensions.items():
            yield {"name": name, "value": float(value), "expression": self.followed.number(target.spec.dimensions[name])}

    def _connector(self, part: str, connector: str, target: ResolvedPart | None) -> Json:
        held = self.assembly.parts[part].connectors[connector]
        expressions: dict[str, str] = {}
        if target is not None and target.derivation is None:
            expressions = self._follows(target, connector)
        return {
            "name": connector,
            "object": f"{self.objects[part]}__{connector}",
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
                self._lose(where, "a fixed frame", "that it follows parameters", refused=False)
            return {}
        if turns and form.x is not None:
            return {"Placement": self.followed.frame(form.o, form.z, form.x)}
        if turns:
            self._lose(where, "a fixed direction", "that its direction follows parameters: its x is chosen by rule", refused=False)
        found = {f"Placement.Base.{axis}": self.followed.number(number, "mm") for axis, number in zip("xyz", form.o, strict=True)}
        return {name: text for name, text in found.items() if text is not None}

    # ------------------------------------------------------------------ joints and couplings

    def _joints(self) -> Iterator[Json]:
        for joint in self.assembly.joints:
            form = self._joint(joint)
            yield form
            where = f"joints.{joint.name}"
            if joint.type is JointType.UNIVERSAL:
                turned = {
                    "type": "perpendicular",
                    "offset_1": _seven(_TURNED["x"]),
                    "offset_2": _seven(_flip(joint) @ _TURNED["y"]),
                }
                yield form | turned | {"object": self.names.claim(f"{joint.name}__axes"), "label": f"{joint.name} axes", "limits": {}}
                self._lose(where, "a ball and a perpendicular joint", "its two limits", refused=True)
            if joint.type is JointType.SCREW:
                yield (
                    form
                    | {"type": "thread", "object": self.names.claim(f"{joint.name}__thread"), "label": f"{joint.name} thread"}
                    | {
                        "limits": {},
                        "distances": {"Distance": abs(joint.lead)},
                        "active": False,
                    }
                )
                self._lose(where, "a cylindrical joint and a thread", "FreeCAD's solver does not hold the thread's lead", refused=True)
            if joint.type is JointType.BALL and (joint.limits.cone is not None or joint.limits.twist is not None):
                self._lose(where, "a ball", "its cone and twist: FreeCAD has no limits of a ball", refused=False)
            if joint.type is JointType.PLANAR:
                self._lose(where, "a distance of zero between two planes", "its limits", refused=False)

    def _joint(self, joint: Joint) -> Json:
        turned = self._limit_expressions(joint)
        return {
            "name": joint.name,
            "object": self.names.claim(joint.name),
            "label": joint.name,
            "type": str(joint.type),
            "active": True,
            "parent": joint.parent,
            "parent_connector": joint.parent_connector,
            "child": joint.child,
            "child_connector": joint.child_connector,
            "offset_1": _seven(SE3.identity()),
            "offset_2": _seven(_flip(joint)),
            "limits": _limits(joint),
            "distances": {"Distance": 0.0} if joint.type is JointType.PLANAR else {},
            "expressions": turned,
        }

    def _limit_expressions(self, joint: Joint) -> dict[str, str]:
        """Return the expressions of a joint's limits, where the plan gives them as such."""
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
        joints = {joint.name: joint for joint in self.assembly.joints}
        for coupling in self.assembly.mechanism.couplings:
            where, kind = f"couplings.{coupling.name}", _COUPLINGS.get(coupling.kind)
            if kind is None:
                self._lose(where, "a record", "FreeCAD has no such coupling", refused=True)
                continue
            a, b = (joints[column.partition(".")[0]] for column in (coupling.a, coupling.b))
            self._lose(where, f"a joint of its kind ({coupling.kind}), switched off", "FreeCAD's solver does not hold it", refused=True)
            yield {
                "name": coupling.name,
                "object": self.names.claim(coupling.name),
                "label": coupling.name,
                "type": kind,
                "active": False,  # switched on, its references would be solved as what they are not
                "parent": a.child,
                "parent_connector": a.child_connector,
                "child": b.child,
                "child_connector": b.child_connector,
                "offset_1": _seven(_flip(a)),
                "offset_2": _seven(_flip(b)),
                "limits": {},
                "distances": _distances(coupling),
                "expressions": {},
            }

    def _lose(self, where: str, kept: str, lost: str, *, refused: bool) -> None:
        self.losses.append(Loss("freecad", where, kept, lost, refused))


def _distances(coupling: Coupling) -> dict[str, float]:
    """Return the radii, pitch radius or lead of a coupling: of a gear and a belt only their ratio is known."""
    ratio = abs(coupling.ratio)
    if coupling.kind in ("gear", "belt"):
        return {"Distance": 10.0 * ratio, "Distance2": 10.0}
    return {"Distance": ratio if coupling.kind == "rack" else 2 * math.pi * ratio}


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
                limits[f"{name}{end}"] = bound * scale
    return limits


def _plane(S: np.ndarray[Any, np.dtype[np.float64]]) -> tuple[list[float], list[float]]:
    """Return a point and the unit normal of the plane of a reflection `(4, 4)`."""
    values, vectors = np.linalg.eigh((S[:3, :3] + S[:3, :3].T) / 2)
    normal = vectors[:, int(np.argmin(values))]
    normal = normal * np.sign(normal[int(np.argmax(np.abs(normal)))])
    normal = np.where(np.abs(normal) < 1e-12, 0.0, normal)
    normal /= np.linalg.norm(normal)
    return (S[:3, 3] / 2).tolist(), normal.tolist()


def _seven(T: SE3) -> list[float]:
    return [float(number) for number in T.data]


def _opinion(report: Mapping[str, Any]) -> Findings:
    """Return what FreeCAD's solver had to say about placements that are ours."""
    found = []
    if report["invalid"]:
        found.append(
            Finding(
                code="E_FREECAD",
                where="assembly",
                message=f"FreeCAD finds objects invalid: {', '.join(report['invalid'][:10])}.",
                hint="Open the document and look at the marked objects.",
            )
        )
    moved = {part: row for part, row in report["moved"].items() if row[0] > SOLVED_MM or row[1] > SOLVED_RAD}
    if report["solve"] != 0 or moved:
        said = f"returns {report['solve']}" if report["solve"] else f"moves {', '.join(sorted(moved)[:10])}"
        worst = max((row[0] for row in report["moved"].values()), default=0.0)
        found.append(
            Finding(
                code="W_FREECAD_SOLVER",
                where="assembly",
                message=f"FreeCAD's solver {said} at the placements of the plan, which are exact and were kept.",
                hint="Nothing in the file is wrong for that: the solver gives up on long chains, and takes redundant loops for conflicts.",
                value=worst,
                limit=SOLVED_MM,
                unit="mm",
            )
        )
    return Findings(found)


def _failed(said: str, *, late: bool) -> ExportError:
    words = "it ran out of time" if late else (said.strip().splitlines() or ["it left no word"])[-1][:300]
    finding = Finding(
        code="E_FREECAD", where="assembly", message=f"FreeCAD could not write the document: {words}.", hint="Run articad doctor."
    )
    return ExportError(str(finding), findings=[finding])
