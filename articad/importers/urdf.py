"""Reads URDF: articad's own files by their records, any other by its links and joints."""

from __future__ import annotations

import io
import logging
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from lxml import etree

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.errors import InvalidSolidError, ReadError
from articad.export.urdf import mechanism_elements, rewritten
from articad.findings import Finding
from articad.geometry.mass import MassProperties
from articad.geometry.mesh import TriMesh
from articad.geometry.part import DEFAULT_COLOR, Primitive, Shape
from articad.geometry.shapes import primitive_mesh
from articad.importers.fusing import fused, with_chains_named
from articad.importers.raw import ENDLESS, IDENTITY, RawJoint, RawLink, RawModel, RawTie, aligned, assemble, require_links
from articad.importers.reading import MAX_LINKS, MAX_SHAPES, MM_PER_M, Folder, color_text, parse_xml, read_xml, unreadable
from articad.importers.records import unedited
from articad.importers.referenced_files import package_of
from articad.importers.srdf import kept_semantics, semantics_beside
from articad.importers.urdf_kept import kept_elements
from articad.importers.xacro import expanded
from articad.kinematics.joints import JointType

EXPAND = "Run `xacro FILE.urdf.xacro > FILE.urdf` (pip install xacro) and read its output."
_XACRO = {"http://www.ros.org/wiki/xacro", "http://ros.org/wiki/xacro", "http://wiki.ros.org/xacro"}
_CAPSULE = "capsule:"  # prefix of the name of a capsule shape
_SHAPES = {"box", "cylinder", "sphere", "mesh"}
_JOINT_TYPES = {"fixed", "revolute", "continuous", "prismatic", "planar", "floating", "spherical"}


def read_urdf(
    path: str | Path, *, root: str | Path | None = None, metadata: bool = True, fuse: bool = False, srdf: str | Path | None = None
) -> Assembly:
    """Read a URDF file, and the SRDF of the same name beside it.

    Links become parts in their own frames, joints keep their names and values. `mimic` becomes a coupling, `planar` a planar joint,
    `floating` a free joint. Missing meshes are left out with a finding.

    Args:
        path: The file; one that ends in `.xacro` is expanded first (`articad.importers.xacro`).
        root: Folder that meshes may be read from; by default the file's own, for a xacro file its ROS package. `package://name/…` is
            looked for in it, upwards from the file, and then in the packages of `$ROS_PACKAGE_PATH` and `$AMENT_PREFIX_PATH`.
        metadata: Use the records that articad left in its own files, so that they come back as they were.
        fuse: Without metadata, replace chains over bare links of small mass by one joint: cylindrical, screw, universal, planar, ball.
        srdf: The SRDF; by default `NAME.srdf` beside the file, or in the folder `srdf` beside its folder.

    Raises:
        ReadError: If the file is not URDF, names files outside the root, or is not a mechanism.
    """
    path = Path(path)
    is_xacro = path.suffix.lower() == ".xacro"
    folder = Folder.of(path, Path(root) if root is not None else package_of(path) if is_xacro else None)
    document = parse_xml(expanded(path, folder.root), path) if is_xacro else read_xml(path)
    beside = semantics_beside(path, folder) if srdf is None else Path(srdf)
    if document.tag != "robot":
        raise unreadable(path, f"line {document.sourceline}", f"The root element is <{document.tag}>, not <robot>.")
    texts = [element.text or "" for element in document.iterfind("articad")]
    written = mechanism_elements(document)
    own, edited = unedited(texts if metadata else (), written, folder, path, written, rewritten)
    if own is not None:
        if beside is None:
            return own
        stated = kept_semantics(beside, own=True)  # the file's present content counts
        return replace(own, kept=(*(item for item in own.kept if item.format != "srdf"), *stated))
    model = _model(document, folder, path)
    model.kept += [] if beside is None else kept_semantics(beside)
    model.findings += edited
    require_links(model, path)
    return assemble(fused(model) if fuse else with_chains_named(model), path)


def _model(document: Any, folder: Folder, path: Path) -> RawModel:
    if not document.get("name"):
        raise unreadable(path, f"line {document.sourceline}", "The robot has no name.")
    _require_expanded(document, path)
    _require_numbers(document, path)
    kept = kept_elements(document)
    _quaternions_to_angles(document, path)
    findings = _strip(document, path)
    robot = _parse(document, path)
    model = RawModel(robot.name or path.stem, _root(robot, path), findings=[*findings, *_several_parents(robot)], kept=kept)
    colors = {material.name: _color(material) for material in robot.materials}
    for link in robot.links:
        if link.name in model.links:
            raise unreadable(path, f"link {link.name!r}", "Two links have this name.")
        model.links[link.name] = _link(link, colors, folder)
    types = {joint.name: joint.type for joint in robot.joints}
    for joint in robot.joints:
        _add_joint(model, joint, types, path)
    model.findings += folder.findings
    model.kept += folder.kept
    return model


def _parse(document: Any, path: Path) -> Any:
    """Let yourdfpy read the cleaned document; any exception means that the file is invalid."""
    import yourdfpy  # noqa: PLC0415 - half a second, and only readers need it

    content = etree.tostring(document)
    logger = logging.getLogger("yourdfpy.urdf")
    level = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        return yourdfpy.URDF.load(
            io.BytesIO(content), build_scene_graph=False, build_collision_scene_graph=False, load_meshes=False, load_collision_meshes=False
        ).robot
    except Exception as error:
        if not (lacking := _lacking(document)):
            raise unreadable(path, "", f"It is not URDF: {type(error).__name__} {error}.") from error
        findings = [finding for line, reason in lacking for finding in unreadable(path, f"line {line}", reason).findings]
        line, reason = lacking[0]
        raise ReadError(f"{path}: line {line}: {reason}", path=str(path), where=f"line {line}", findings=findings) from None
    finally:
        logger.setLevel(level)


_NEEDED = {
    "robot/link": ("name",),
    "robot/joint": ("name", "type"),
    "robot/material": ("name",),
    "joint/parent": ("link",),
    "joint/child": ("link",),
    "joint/mimic": ("joint",),
    "inertial/mass": ("value",),
    "geometry/box": ("size",),
    "geometry/sphere": ("radius",),
    "geometry/cylinder": ("radius", "length"),
    "geometry/mesh": ("filename",),
    "inertial/inertia": ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"),
}
"""Attributes that an element must have, by parent and tag."""


def _lacking(document: Any) -> list[tuple[int, str]]:
    """Return the line and the reason for each element without an attribute or element that URDF demands."""
    found = []
    for element in document.iter():
        parent = element.getparent()
        for name in _NEEDED.get(f"{'' if parent is None else parent.tag}/{element.tag}", ()):
            if element.get(name) is None:
                said = f" {element.get('name')!r}" if element.get("name") else ""
                found.append((element.sourceline, f"<{element.tag}>{said} lacks {name!r}."))
    for joint in document.iterfind("joint"):
        found += [
            (joint.sourceline, f"Joint {joint.get('name')!r} lacks its <{tag}>.") for tag in ("parent", "child") if joint.find(tag) is None
        ]
    return sorted(found)


def require_bounded(document: Any, path: Path) -> None:
    """Refuse a URDF document with more links, joints, shapes of a link or elements than are read, before anything reads it.

    Raises:
        ReadError: Naming the number and the maximum.
    """
    count = max(len(document.findall("link")), len(document.findall("joint")))
    shapes = max((len(link) for link in document.iterfind("link")), default=0)
    for number, most, what in (
        (count, MAX_LINKS, "links or joints"),
        (shapes, MAX_SHAPES, "elements in one link"),
        (len(document), 8 * MAX_LINKS, "elements"),
    ):
        if number > most:
            raise unreadable(path, "", f"It has {number} {what}; the maximum is {most}.")


def _strip(document: Any, path: Path) -> list[Finding]:
    """Remove elements of other programs, and shapes without a mesh; return findings about the losses."""
    require_bounded(document, path)
    findings = []
    for element in list(document):
        if element.tag not in {"link", "joint", "material"}:
            document.remove(element)
    for shape in [*document.iterfind("link/visual"), *document.iterfind("link/collision")]:
        geometry = shape.find("geometry")
        if geometry is not None and len(geometry) and geometry[0].tag == "capsule":
            # yourdfpy does not support capsules; it reads a cylinder with a mark
            geometry[0].tag = "cylinder"
            shape.set("name", _CAPSULE + shape.get("name", ""))
        elif geometry is None or not len(geometry) or geometry[0].tag not in _SHAPES:
            what = geometry[0].tag if geometry is not None and len(geometry) else "nothing"
            where = f"links.{shape.getparent().get('name')}"
            message = f"A shape of {what} is left out."
            findings.append(Finding(code="W_IMPORT_DROPPED", where=where, message=message, hint="Use a box, cylinder, sphere or mesh."))
            shape.getparent().remove(shape)
    return findings


def _require_expanded(document: Any, path: Path) -> None:
    """Refuse xacro instructions: the content of the file is known only after they are executed.

    Properties and arguments alone change nothing, and are kept like any foreign element.
    """
    for element in document.iter():
        namespace, _, name = str(element.tag).removeprefix("{").rpartition("}")
        if (namespace in _XACRO or name.startswith("xacro:")) and (name := name.rpartition(":")[2]) not in {"property", "arg"}:
            said = " ".join(f'{key}="{value}"' for key, value in element.attrib.items())
            raise unreadable(
                path,
                f"line {element.sourceline}",
                f"<xacro:{name}{f' {said}' if said else ''}> is not expanded. {EXPAND}",
            )


def _quaternions_to_angles(document: Any, path: Path) -> None:
    """Convert the quat_xyzw of an origin, which URDF has since 1.1, to angles, which every reader supports."""
    if document.get("version", "") in {"", "1", "1.0"}:
        return  # urdfdom reads it in later versions only; it is reported as kept
    for origin in document.iter("origin"):
        text = origin.get("quat_xyzw")
        if text is None:
            continue
        if origin.get("rpy") is not None:
            raise unreadable(path, f"line {origin.sourceline}", "An origin has both rpy and quat_xyzw; only one is allowed.")
        xyzw = [float(word) for word in text.split()]
        length = math.hypot(*xyzw)
        if not length > 1e-9:
            raise unreadable(path, f"line {origin.sourceline}", f"quat_xyzw={text!r} is not a rotation.")
        origin.set("rpy", " ".join(repr(angle) for angle in _angles(SE3.from_quaternion([number / length for number in xyzw]).rotation)))


def _angles(R: FloatArray) -> tuple[float, float, float]:
    """Return roll, pitch and yaw [rad] with R = Rz(yaw) · Ry(pitch) · Rx(roll); the roll is that of R with yaw removed."""
    yaw = math.atan2(R[1, 0], R[0, 0])
    s, c = math.sin(yaw), math.cos(yaw)
    return math.atan2(s * R[0, 2] - c * R[1, 2], c * R[1, 1] - s * R[0, 1]), math.atan2(-R[2, 0], math.hypot(R[0, 0], R[1, 0])), yaw


def _require_numbers(document: Any, path: Path) -> None:
    """Refuse NaN, infinities and implausible numbers anywhere; yourdfpy would accept them."""
    names = (
        "xyz",
        "rpy",
        "quat_xyzw",
        "value",
        "size",
        "radius",
        "length",
        "scale",
        "lower",
        "upper",
        "effort",
        "velocity",
        "multiplier",
        "offset",
        "damping",
        "friction",
    )
    moments = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    for element in document.iter():
        for name in (*names, *moments):
            text = element.get(name)
            if text is None or element.tag in {"gazebo", "articad"}:
                continue
            try:
                numbers = [float(word) for word in (text.replace(",", " ") if name in {"size", "scale"} else text).split()]
            except ValueError:
                if element.tag in _MEASURED:
                    raise unreadable(path, f"line {element.sourceline}", f"{name}={text[:60]!r} is not a number.") from None
                continue
            if element.tag in _MEASURED and len(numbers) not in _COUNTS.get(name, (1,)) and (numbers or element.tag != "dynamics"):
                raise unreadable(
                    path,
                    f"line {element.sourceline}",
                    f"{name}={text[:60]!r} has {len(numbers)} numbers, not {' or '.join(map(str, _COUNTS.get(name, (1,))))}.",
                )
            infinite_limit = element.tag == "limit"  # an infinite limit means none
            if any(math.isnan(number) or (abs(number) > _LARGEST and not infinite_limit) for number in numbers):
                raise unreadable(path, f"line {element.sourceline}", f"{name}={text!r} is not a plausible number.")


_MEASURED = frozenset(
    ("origin", "axis", "limit", "dynamics", "mass", "inertia", "mimic", "box", "cylinder", "sphere", "capsule", "mesh")
)  # elements whose attributes are numbers; an empty one of <dynamics> counts as none
_COUNTS = {"xyz": (3,), "rpy": (3,), "quat_xyzw": (4,), "size": (3,), "scale": (1, 3)}
_LARGEST = 1e12  # m, kg, N: beyond it arithmetic on poses loses all precision


def _root(robot: Any, path: Path) -> str:
    links = {link.name for link in robot.links}
    for joint in robot.joints:
        for link in (joint.parent, joint.child):
            if link not in links:
                raise unreadable(path, f"joint {joint.name!r}", f"Its link {link!r} is not in the file.")
    children = {joint.child for joint in robot.joints}
    roots = [link.name for link in robot.links if link.name not in children]
    if len(roots) != 1:
        raise unreadable(path, "", f"It has {len(roots)} root links ({', '.join(map(str, roots[:5]))}); exactly one is needed.")
    return str(roots[0])


def _several_parents(robot: Any) -> list[Finding]:
    """Return a finding for each link that several joints name as their child: URDF holds trees only, and other readers take one joint."""
    names: dict[str, list[str]] = {}
    for joint in robot.joints:
        names.setdefault(joint.child, []).append(joint.name)
    hint = "Keep one of these joints in the URDF, and state the loop in MJCF or SDF."
    return [
        Finding(
            code="W_IMPORT_LOOP",
            where=f"parts.{link}",
            message=f"Link {link!r} is the child of {len(joints)} joints ({', '.join(map(repr, joints))}); they are read as a loop.",
            hint=hint,
        )
        for link, joints in names.items()
        if len(joints) > 1
    ]


def _link(link: Any, colors: dict[str, str], folder: Folder) -> RawLink:
    where = f"parts.{link.name}"
    visuals = _shapes(link.visuals, colors, folder, where, seen=True)
    collisions = _shapes(link.collisions, colors, folder, where)
    color = next((shape.color for shape in visuals if shape.color), DEFAULT_COLOR)
    return RawLink(link.name, _mass(link.inertial, where, folder.findings), visuals, collisions, color)


def _mass(inertial: Any, where: str, findings: list[Finding]) -> MassProperties | None:
    if inertial is None or inertial.mass is None:
        return None
    T = _pose(inertial.origin)
    inertia = np.zeros((3, 3)) if inertial.inertia is None else np.array(inertial.inertia, dtype=np.float64)
    if inertial.mass < 0:
        message = f"A mass of {inertial.mass} kg is left out."
        findings.append(Finding(code="W_IMPORT_DROPPED", where=where, message=message, hint="Give a positive mass."))
        return None
    return MassProperties(inertial.mass, np.zeros(3), (inertia + inertia.T) / 2 * MM_PER_M**2).moved(T)


def _shapes(rows: Any, colors: dict[str, str], folder: Folder, where: str, *, seen: bool = False) -> tuple[Shape, ...]:
    shapes = []
    for row in rows:
        try:
            capsule = (row.name or "").startswith(_CAPSULE)
            mesh, form = _mesh(row.geometry, folder, where, capsule=capsule)
        except InvalidSolidError as error:
            message = f"A shape is left out: {error.message}"
            folder.findings.append(Finding(code="W_IMPORT_DROPPED", where=where, message=message, hint="Give it a size."))
            continue
        if mesh is not None:
            material = getattr(row, "material", None)
            color = None if material is None else _color(material) or colors.get(material.name) or None
            if seen and not color and row.geometry.mesh is not None:
                folder.keep_colors(row.geometry.mesh.filename, where)
            shapes.append(Shape(mesh, _pose(row.origin), color or None, (row.name or "").removeprefix(_CAPSULE), form))
    return tuple(shapes)


def _mesh(geometry: Any, folder: Folder, where: str, *, capsule: bool) -> tuple[TriMesh | None, Primitive | None]:
    """Return a shape's mesh, and the primitive that it represents."""
    form: Primitive | None = None
    if geometry.box is not None:
        form = Primitive("box", tuple(float(size) * MM_PER_M for size in geometry.box.size))
    elif geometry.cylinder is not None:
        sizes = (float(geometry.cylinder.radius) * MM_PER_M, float(geometry.cylinder.length) * MM_PER_M)
        form = Primitive("capsule" if capsule else "cylinder", sizes)
    elif geometry.sphere is not None:
        form = Primitive("sphere", (float(geometry.sphere.radius) * MM_PER_M,))
    if form is not None:
        return primitive_mesh(form), form
    scale = np.ones(3) if geometry.mesh.scale is None else np.broadcast_to(geometry.mesh.scale, 3)
    x, y, z = (float(factor) * MM_PER_M for factor in scale)
    return folder.mesh(geometry.mesh.filename or "", (x, y, z), where), None


def _color(material: Any) -> str:
    color = getattr(material, "color", None)
    if color is None or color.rgba is None:
        return ""
    return color_text(color.rgba)


def _pose(matrix: FloatArray | None) -> SE3:
    """Return a pose in mm from one in m; its rotation comes from angles, so it is valid."""
    if matrix is None:
        return IDENTITY
    return SE3.from_rotation(matrix[:3, :3], matrix[:3, 3] * MM_PER_M)


def _add_joint(model: RawModel, joint: Any, types: dict[str, str], path: Path) -> None:
    if joint.type not in _JOINT_TYPES:
        raise unreadable(path, f"joint {joint.name!r}", f"Type {joint.type!r} is not one of {', '.join(sorted(_JOINT_TYPES))}.")
    origin = _pose(joint.origin)
    axis = np.array([1.0, 0.0, 0.0] if joint.axis is None else joint.axis, dtype=np.float64)
    if joint.type == "floating":
        model.joints.append(RawJoint(joint.name, JointType.FREE, joint.parent, joint.child, origin, IDENTITY))
        return
    if joint.type == "spherical":  # not URDF, but some programs write and read it
        model.joints.append(RawJoint(joint.name, JointType.BALL, joint.parent, joint.child, origin, IDENTITY, cone=math.pi))
        return
    if joint.type == "fixed":
        model.joints.append(RawJoint(joint.name, JointType.FIXED, joint.parent, joint.child, origin, IDENTITY))
        return
    if not np.linalg.norm(axis) > 1e-9:
        raise unreadable(path, f"joint {joint.name!r}", "Its axis has no direction.")
    R = aligned(axis)
    ends = (joint.parent, joint.child, origin @ R, R)
    if joint.type == "planar":
        model.joints.append(RawJoint(joint.name, JointType.PLANAR, *ends, (ENDLESS, ENDLESS, ENDLESS)))
        return
    slides = joint.type == "prismatic"
    unit = MM_PER_M if slides else 1.0
    limit = joint.limit
    for name in ("effort", "velocity"):
        value = None if limit is None else getattr(limit, name)
        if value is not None and value < 0:
            message = f"Joint {joint.name!r} has the {name} {value:g}; {-value:g} is used."
            model.findings.append(
                Finding(code="W_IMPORT_LIMITS", where=f"joints.{joint.name}", message=message, hint="Give a positive one.")
            )
    force = 1.0 if slides else MM_PER_M  # N·mm or N per N·m or N
    dynamics = joint.dynamics
    bounds = _range(model, joint, unit)
    model.joints.append(
        RawJoint(
            joint.name,
            JointType.SLIDER if slides else JointType.REVOLUTE,
            *ends,
            (bounds,),
            effort=(None if limit is None or limit.effort is None else abs(limit.effort) * force,),
            velocity=(None if limit is None or limit.velocity is None else abs(limit.velocity) * unit,),
            damping=(_resistance(dynamics, "damping") * force / unit,),
            friction=(_resistance(dynamics, "friction") * force,),
        )
    )
    if joint.mimic is not None:
        model.ties.append(_tie(joint, types))


def _resistance(dynamics: Any, name: str) -> float:
    """Return the damping or friction of a joint in SI units; zero where the file states none, or an empty one."""
    text = (dynamics and getattr(dynamics, name)) or ""
    return float(text.strip() or 0.0)


def _range(model: RawModel, joint: Any, unit: float) -> tuple[float, float]:
    limit = joint.limit
    if joint.type == "continuous":
        return ENDLESS
    stated = (None, None) if limit is None else (limit.lower, limit.upper)
    lower, upper = (value or 0.0 for value in stated)
    told = f"[{lower:g}, {upper:g}] {'rad' if unit == 1 else 'm'}; it is treated as endless."
    if stated == (None, None):
        message = f"Joint {joint.name!r} has no limits; it is treated as endless."
    elif lower > upper:
        message = f"Joint {joint.name!r} has reversed limits {told}"
    elif lower > _LARGEST or upper < -_LARGEST:
        message = f"Joint {joint.name!r} has limits beyond any position, {told}"
    else:
        return lower * unit, upper * unit
    model.findings.append(
        Finding(
            code="W_IMPORT_LIMITS",
            where=f"joints.{joint.name}",
            message=message,
            hint="State lower and upper limits in the file, the lower one first.",
        )
    )
    return ENDLESS


def _tie(joint: Any, types: dict[str, str]) -> RawTie:
    """Return the relation of a mimic joint, in mm and rad on both sides."""
    mimic = joint.mimic
    ratio = 1.0 if mimic.multiplier is None else mimic.multiplier
    offset = 0.0 if mimic.offset is None else mimic.offset
    mine, its = (MM_PER_M if types.get(name) == "prismatic" else 1.0 for name in (joint.name, mimic.joint))
    return RawTie(joint.name, mimic.joint, ratio * mine / its, offset * mine)
