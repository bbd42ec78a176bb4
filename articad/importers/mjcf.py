"""Reads MJCF: articad's own files by their records, any other as MuJoCo compiles it, with its defaults, includes and frames resolved."""

from __future__ import annotations

import math
import re
from copy import deepcopy
from pathlib import Path
from typing import Any, Final

import numpy as np
from lxml import etree

from articad.arrays import FloatArray
from articad.assembly import Assembly, Kept
from articad.connectors.se3 import SE3
from articad.export.mjcf import mechanism_elements, rewritten
from articad.findings import Finding
from articad.geometry.mass import MassProperties
from articad.geometry.mesh import TriMesh
from articad.geometry.part import DEFAULT_COLOR, Primitive, Shape
from articad.geometry.shapes import primitive_mesh
from articad.importers.described import OTHER, Meshes
from articad.importers.fusing import fused, with_chains_named
from articad.importers.mjcf_carried import Carrier
from articad.importers.mjcf_compiled import Compiled, compiled_mjcf
from articad.importers.mjcf_kept import kept_attributes, section_elements, with_includes
from articad.importers.raw import ENDLESS, IDENTITY, RawJoint, RawLink, RawModel, RawTie, aligned, assemble, require_links
from articad.importers.reading import MM_PER_M, Folder, color_text, read_xml, unreadable
from articad.importers.records import unedited
from articad.importers.referenced_files import require_closed
from articad.kinematics.joints import JointType

_RECORD_PREFIX = "articad."

COUNTED: Final = {
    "actuator": {"actuator": "nactuator"},
    "sensor": {"sensor": "nsensor"},
    "tendon": {"tendon": "ntendon"},
    "equality": {"equality": "neq"},
    "keyframe": {"key": "nkey"},
    "contact": {"pair": "npair", "exclude": "nexclude"},
    "custom": {"numeric": "nnumeric", "text": "ntext", "tuple": "ntuple"},
}
"""Sections, and the names of MuJoCo's counts for each kind of their elements."""


def read_mjcf(path: str | Path, *, root: str | Path | None = None, metadata: bool = True, fuse: bool = False) -> Assembly:
    """Read an MJCF file.

    Bodies become parts in their own frames, the world is the ground; joints keep their names and values, several joints of one body
    become a chain over bare parts. Equality constraints of points, bodies and joints close loops and couple joints; then joints with
    actuators are the drivers.

    Args:
        path: The file.
        root: Folder that meshes and includes may be read from; the file's own by default.
        metadata: Use the records that articad left in its own files, so that they come back as they were.
        fuse: Without metadata, replace chains over bare links, and the constraints of a loop, by one joint where articad has it.

    Raises:
        ReadError: If the file is not MJCF, names files outside the root, or is not a mechanism.
    """
    path = Path(path)
    folder = Folder.of(path, None if root is None else Path(root))
    document = read_xml(path)
    if document.tag != "mujoco":
        raise unreadable(path, f"line {document.sourceline}", f"The root element is <{document.tag}>, not <mujoco>.")
    texts = [text.get("data", "") for text in document.iterfind("custom/text") if text.get("name", "").startswith(_RECORD_PREFIX)]
    written = [*document.iterfind("worldbody"), *document.iterfind("equality")]
    own, edited = unedited(
        texts if metadata else (), written, folder, path, mechanism_elements(document), rewritten, _meshes(document, folder)
    )
    if own is not None:
        return own
    require_closed(path, folder.root)
    whole = with_includes(document, path)
    compiled = compiled_mjcf(path, folder.root)
    model = _Reader(compiled, document.get("model") or path.stem, whole).model()
    model.findings += edited
    for text in dict.fromkeys(compiled.warnings):
        hint = "Correct what the warning names: simulators read the file in the same way."
        model.findings.append(Finding(code="W_IMPORT_MUJOCO", where=path.name, message=f"MuJoCo warns: {text}", hint=hint))
    require_links(model, path)
    return assemble(fused(model) if fuse else with_chains_named(model), path)


def _meshes(document: Any, folder: Folder) -> Meshes:
    """Return a function that looks up the meshes of assets by name, `OTHER` for one that is not in mm or is moved: articad writes none."""
    assets = {asset.get("name"): asset for asset in document.iterfind("asset/mesh")}

    def mesh(name: str) -> TriMesh | None:
        asset = assets.get(name)
        if asset is None or not set(asset.attrib) <= {"name", "file", "scale", "inertia"}:
            return OTHER
        scale = (asset.get("scale") or "1 1 1").split()
        return folder.unscaled(asset.get("file", "")) if scale == ["0.001"] * 3 else OTHER

    return mesh


class _Reader:
    """Converts a compiled model to links and joints."""

    def __init__(self, compiled: Compiled, name: str, document: Any) -> None:
        self.m = compiled
        self.bodies = self._unique("BODY", compiled.nbody)
        self.joints = self._unique("JOINT", compiled.njnt)
        self.raw = RawModel(name, self.bodies[0])
        self.carrier = Carrier(compiled, self.bodies, self.joints)
        self.document = document

    def model(self) -> RawModel:
        """Return everything that the compiled model contains."""
        self._keep_sections()
        for body in range(self.m.nbody):
            self.raw.kept += self.carrier.body(body)
            self.raw.links[self.bodies[body]] = self._link(body)
        for body in range(1, self.m.nbody):
            self._add_joints(body)
        for row in range(self.m.neq):
            self._add_equality(row)
        actuators = [element.get("joint") or element.get("jointinparent") for element in self.document.iterfind("actuator/*")]
        self.raw.driven = frozenset(name for name in actuators if name)
        return self.raw

    def _unique(self, kind: str, count: int) -> list[str]:
        names = [self.m.name(kind, index) for index in range(count)]
        taken = set(names)
        for index, name in enumerate(names):
            if not name:
                free = f"{kind.lower()}_{index}"
                while free in taken:
                    free += "_"
                names[index] = free
                taken.add(free)
        return names

    def _drop(self, where: str, message: str) -> None:
        hint = "Nothing needs to be done if it is not needed."
        self.raw.findings.append(Finding(code="W_IMPORT_DROPPED", where=where, message=message, hint=hint))

    # ------------------------------------------------------------------ what is kept

    def _keep_sections(self) -> None:
        """Keep the document's data beyond bodies, section by section, where its elements are those of the compiled model.

        Copies of `<replicate>`, models of `<attach>` and flexible bodies add elements that no document has in this form; the elements of
        such a section are kept by name only.
        """
        self.raw.kept.append(Kept("mjcf", "model", "", "<mujoco/>"))  # that it came from MJCF, even if it says nothing else
        copied = [section for section in COUNTED if len(section_elements(self.document, section)) != self._count(section)]
        if "keyframe" in copied and self._count("keyframe") == _stated_keys(self.document):
            copied.remove("keyframe")  # those without an element are as MuJoCo makes them
        for item in kept_attributes(self.document):
            section = etree.fromstring(item.xml).tag if item.xml else ""
            if section not in {*copied, "equality"}:
                self.raw.kept.append(item)
        for section in copied:
            for word, count in COUNTED[section].items():
                kind = {"eq": "EQUALITY"}.get(count[1:], count[1:].upper())
                for index in range(_number_of(self.m, count)):
                    name = self.m.name(kind, index)
                    if not name.startswith(_RECORD_PREFIX):
                        self.raw.kept.append(
                            Kept(
                                "mjcf",
                                "model",
                                f"{word} {name or f'{word}_{index}'!r} (the file makes others by <replicate>, <attach> or <flexcomp>)",
                            )
                        )

    def _count(self, section: str) -> int:
        """Return how many elements of a section the compiled model has, without articad's own records."""
        count = sum(_number_of(self.m, count) for count in COUNTED[section].values())
        if section == "custom":
            texts = (self.m.name("TEXT", index) for index in range(self.m.ntext))
            count -= sum(name.startswith(_RECORD_PREFIX) for name in texts)
        return count

    def _keep_equality(self, row: int, name: str, *, joint: str = "") -> None:
        """Keep an equality verbatim; for one that the assembly holds as a joint or a coupling, only its softness is kept."""
        elements = section_elements(self.document, "equality")
        if len(elements) != self.m.neq:
            return
        element = elements[row]
        soft = ", ".join(f"{key} {value}" for key, value in element.attrib.items() if key in {"solref", "solimp", "torquescale"})
        ends = " and ".join(value for key, value in element.attrib.items() if key[-1:] in {"1", "2"})
        what = f"equality {name!r} ({element.tag} of {ends})"
        wrapped = etree.Element("equality")
        wrapped.append(deepcopy(element))
        xml = etree.tostring(wrapped, encoding="unicode")
        self.raw.kept.append(Kept("mjcf", joint or "model", (f"{soft} of {what}" if soft else "") if joint else what, xml))

    # ------------------------------------------------------------------ links

    def _link(self, body: int) -> RawLink:
        m, name = self.m, self.bodies[body]
        mass = None
        if body and m.body_mass[body] > 0:
            principal = MassProperties(float(m.body_mass[body]), np.zeros(3), np.diag(m.body_inertia[body]) * MM_PER_M**2)
            mass = principal.moved(_pose(m.body_ipos[body], m.body_iquat[body]))
        visuals: list[Shape] = []
        collisions: list[Shape] = []
        color = DEFAULT_COLOR
        for geom in range(m.body_geomadr[body], m.body_geomadr[body] + m.body_geomnum[body]):
            shape = self._shape(geom, name)
            if shape is not None:
                kind, shapes = ("collisions", collisions) if m.geom_contype[geom] or m.geom_conaffinity[geom] else ("visuals", visuals)
                self.raw.kept.append(self.carrier.geom(geom, f"parts.{name}.{kind}.{len(shapes)}"))
                shapes.append(shape)
                color = shape.color or color
        return RawLink(name, mass, tuple(visuals), tuple(collisions), color)

    def _shape(self, geom: int, body: str) -> Shape | None:
        mesh, form = self._mesh(geom)
        if mesh is None:
            name = self.m.name("GEOM", geom)
            kind = self.m.word("GEOM", int(self.m.geom_type[geom]))
            if kind == "plane":
                self.raw.kept.append(self.carrier.plane(geom, f"parts.{body}"))
            else:
                self.raw.kept.append(Kept("mjcf", f"parts.{body}", f"the {kind} geom {name!r}"))
            self._drop(f"parts.{body}", f"A geom of type {kind} is not a shape of the assembly.")
            return None
        material = self.m.geom_matid[geom]
        rgba = self.m.mat_rgba[material] if material >= 0 else self.m.geom_rgba[geom]
        color = color_text(rgba)
        name = self.m.name("GEOM", geom)
        return Shape(mesh, _pose(self.m.geom_pos[geom], self.m.geom_quat[geom]), color, name, form)

    def _mesh(self, geom: int) -> tuple[TriMesh | None, Primitive | None]:
        """Return a geom's mesh, and the primitive that it represents."""
        m = self.m
        a, b, c = (float(size) * MM_PER_M for size in self.m.geom_size[geom])
        kind = int(self.m.geom_type[geom])
        forms = {
            int(m.mjGEOM_BOX): Primitive("box", (2 * a, 2 * b, 2 * c)),
            int(m.mjGEOM_SPHERE): Primitive("sphere", (a,)),
            int(m.mjGEOM_CYLINDER): Primitive("cylinder", (a, 2 * b)),
            int(m.mjGEOM_CAPSULE): Primitive("capsule", (a, 2 * b)),
            int(m.mjGEOM_ELLIPSOID): Primitive("ellipsoid", (a, b, c)),
        }
        if kind in forms:
            return primitive_mesh(forms[kind]), forms[kind]
        if kind != m.mjGEOM_MESH:
            return None, None
        mesh = self.m.geom_dataid[geom]
        vertices = self.m.mesh_vert[self.m.mesh_vertadr[mesh] :][: self.m.mesh_vertnum[mesh]]
        triangles = self.m.mesh_face[self.m.mesh_faceadr[mesh] :][: self.m.mesh_facenum[mesh]]
        return TriMesh(vertices.astype(np.float64) * MM_PER_M, triangles), None

    # ------------------------------------------------------------------ joints

    def _add_joints(self, body: int) -> None:
        """Add the joints between a body and its parent: a chain over bare links if there are several."""
        m = self.m
        start = _pose(m.body_pos[body], m.body_quat[body])
        parent, child = self.bodies[m.body_parentid[body]], self.bodies[body]
        indices = list(range(m.body_jntadr[body], m.body_jntadr[body] + m.body_jntnum[body])) if m.body_jntnum[body] else []
        if not indices:
            self.raw.joints.append(
                RawJoint(self._free_name(re.sub(r"[^A-Za-z0-9_]+", "_", f"{child}_fixed")), JointType.FIXED, parent, child, start, IDENTITY)
            )
            return
        for place, index in enumerate(indices):
            last = place == len(indices) - 1
            far = child if last else self.raw.bare_link(f"{child}__d{place + 1}")
            self._add_joint(index, parent, far, start)
            parent, start = far, IDENTITY

    def _add_joint(self, index: int, parent: str, child: str, start: SE3) -> None:
        m, name = self.m, self.joints[index]
        kind, at = m.jnt_type[index], m.jnt_qposadr[index]
        qpos, reference = m.qpos, m.qpos0
        if kind == m.mjJNT_FREE:  # its values are a pose in the world; articad's are relative to the body's pose in the file
            moved = not np.array_equal(qpos[at : at + 7], reference[at : at + 7])
            home = start.inverse() @ _pose(qpos[at : at + 3], qpos[at + 3 : at + 7]) if moved else IDENTITY
            self.raw.joints.append(RawJoint(name, JointType.FREE, parent, child, start, IDENTITY, rest=tuple(home.data.tolist())))
            self.raw.kept += self.carrier.joint(index)
            return
        anchor = SE3.from_translation(m.jnt_pos[index] * MM_PER_M)
        limited = bool(m.jnt_limited[index])
        low, high = (float(bound) for bound in m.jnt_range[index])
        if kind == m.mjJNT_BALL:
            reach = min(high, math.pi) if limited else math.pi
            if limited:
                self._drop(
                    f"joints.{name}", f"The limit of {high:.6g} rad on the total rotation of ball {name!r} becomes its cone and its twist."
                )
            twist = (-reach, reach) if limited else None
            rest = _xyzw(qpos[at : at + 4])
            self.raw.joints.append(
                RawJoint(
                    name, JointType.BALL, parent, child, start @ anchor, anchor, cone=reach, twist=twist, rest=rest, **self._dynamics(index)
                )
            )
            return
        slides = kind == m.mjJNT_SLIDE
        unit = MM_PER_M if slides else 1.0
        R = anchor @ aligned(m.jnt_axis[index])
        zero = float(reference[at]) * unit  # the value in the file's own pose
        back = SE3.trans(0.0, 0.0, -zero) if slides else SE3.rot_z(-zero)
        bounds = (low * unit, high * unit) if limited else ENDLESS
        joint_type = JointType.SLIDER if slides else JointType.REVOLUTE
        value = (float(qpos[at]) * unit,)
        self.raw.joints.append(
            RawJoint(name, joint_type, parent, child, start @ R @ back, R, (bounds,), rest=value, **self._dynamics(index))
        )

    def _dynamics(self, index: int) -> dict[str, Any]:
        """Return a joint's effort, damping and friction, in N, mm and s; a ball is like a hinge."""
        m = self.m
        slides = m.jnt_type[index] == m.mjJNT_SLIDE
        force, length = (1.0, MM_PER_M) if slides else (MM_PER_M, 1.0)
        at = m.jnt_dofadr[index]
        effort = None
        if m.jnt_actfrclimited[index]:
            low, high = (float(bound) for bound in m.jnt_actfrcrange[index])
            effort = max(-low, high) * force
        self.raw.kept += self.carrier.joint(index)
        damping, friction = float(m.dof_damping[at]) * force / length, float(m.dof_frictionloss[at]) * force
        return {"effort": (effort,), "damping": (damping,), "friction": (friction,)}

    def _free_name(self, wanted: str) -> str:
        taken = {*self.joints, *(joint.name for joint in self.raw.joints)}
        while wanted in taken:
            wanted += "_"
        return wanted

    # ------------------------------------------------------------------ constraints

    def _add_equality(self, row: int) -> None:
        m = self.m
        name = self._free_name(self.m.name("EQUALITY", row) or f"equality_{row}")
        kind = int(m.eq_type[row])
        if not m.eq_active0[row]:
            held, reason = "", f"Equality {name!r} is switched off (active=false); it is left out."
        elif kind == m.mjEQ_JOINT:
            held, reason = self._add_tie(row, name)
        elif kind in {m.mjEQ_CONNECT, m.mjEQ_WELD}:
            held, reason = self._add_closing(row, name)
        else:
            held, reason = "", f"An equality of type {m.word('EQ', kind)} is left out."
        if not held:
            self._drop(f"equality.{name}", reason)
        self._keep_equality(row, name, joint=held)

    def _add_tie(self, row: int, name: str) -> tuple[str, str]:
        """Add a linear relation between two joints; return what represents it, or why it is left out."""
        m = self.m
        first, second = m.eq_obj1id[row], m.eq_obj2id[row]
        c0, c1, *higher = (float(c) for c in m.eq_data[row][:5])
        if second < 0 or any(higher):
            return "", f"Equality {name!r} is not a linear relation between two joints; it is left out."
        zero1, zero2 = (float(m.qpos0[m.jnt_qposadr[joint]]) for joint in (first, second))
        unit1, unit2 = (MM_PER_M if m.jnt_type[joint] == m.mjJNT_SLIDE else 1.0 for joint in (first, second))
        offset = (zero1 + c0 - c1 * zero2) * unit1
        tie = RawTie(self.joints[first], self.joints[second], c1 * unit1 / unit2, offset)
        self.raw.ties.append(tie)
        return f"couplings.{tie.name}", ""

    def _add_closing(self, row: int, name: str) -> tuple[str, str]:
        """Add a point or a body that two bodies share; return what represents it, or why it is left out.

        A connect shares the point `anchors`. A weld of sites makes their frames coincide. A weld of bodies enforces, with the compiled
        data anchor a (in body 2), position p and quaternion Q (in body 1): T₁⁻¹ T₂ = trans(p) · Q · trans(−a); the compiler computes p
        and Q from the file's own pose if the file gives no `relpose` (MuJoCo: mj_instantiateEquality). Without torque it shares the
        point only.
        """
        m = self.m
        sites = m.eq_objtype[row] == m.mjOBJ_SITE
        ids = [int(m.eq_obj1id[row]), int(m.eq_obj2id[row])]
        bodies = [int(m.site_bodyid[index]) for index in ids] if sites else ids
        if bodies[0] == bodies[1]:
            return "", f"Equality {name!r} ties a body to itself; it is left out."
        if any(m.body_mocapid[body] >= 0 for body in bodies):
            return "", f"Equality {name!r} ties a mocap body, which a simulation's user moves by hand; it is left out."
        first, second = (self.bodies[body] for body in bodies)
        weld, data = m.eq_type[row] == m.mjEQ_WELD, m.eq_data[row]
        if sites:
            near, far = (_pose(m.site_pos[index], m.site_quat[index]) for index in ids)
        elif weld:
            near, far = _pose(data[3:6], data[6:10]), SE3.from_translation(data[:3] * MM_PER_M)
        else:
            near, far = (SE3.from_translation(data[at : at + 3] * MM_PER_M) for at in (0, 3))
        if weld and data[10] > 0:
            self.raw.joints.append(RawJoint(name, JointType.FIXED, first, second, near, far, closing=True))
            return f"joints.{name}", ""
        # a point: its frames are oriented so that the ball rests at zero in the file's own pose
        turns = [_rotation_pose(m.xpos[body], m.xmat[body]).inverse().quaternion for body in bodies]
        near, far = (SE3.from_quaternion(turn, frame.translation) for turn, frame in zip(turns, (near, far), strict=True))
        self.raw.joints.append(RawJoint(name, JointType.BALL, first, second, near, far, cone=math.pi, closing=True))
        return f"joints.{name}", ""


def _stated_keys(document: Any) -> int:
    """Return how many keys a file has room for (`nkey`)."""
    stated = [element.get("nkey", "") for element in document.iterfind("size")]
    return max((int(text) for text in stated if text.isdigit()), default=0)


def _number_of(compiled: Compiled, count: str) -> int:
    """Return a count of a compiled model; before MuJoCo 4 every actuator had one control."""
    return int(getattr(compiled, count, 0) or (compiled.nu if count == "nactuator" else 0))


def _pose(position: FloatArray, wxyz: FloatArray) -> SE3:
    return SE3.from_quaternion(_xyzw(wxyz), np.asarray(position, dtype=np.float64) * MM_PER_M)


def _rotation_pose(position: FloatArray, matrix: FloatArray) -> SE3:
    return SE3.from_rotation(np.asarray(matrix).reshape(3, 3), np.asarray(position) * MM_PER_M)


def _xyzw(wxyz: FloatArray) -> tuple[float, float, float, float]:
    w, x, y, z = (float(value) for value in wxyz)
    return x, y, z, w
