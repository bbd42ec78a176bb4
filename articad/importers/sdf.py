"""Reads SDFormat: articad's own files by their records, any other by its models, links and joints."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np
from lxml import etree

from articad.arrays import FloatArray
from articad.assembly import Assembly, Kept
from articad.connectors.se3 import SE3
from articad.errors import InvalidSolidError, ReadError
from articad.export.sdf import mechanism_elements, rewritten
from articad.findings import Finding
from articad.geometry.mass import MassProperties
from articad.geometry.mesh import TriMesh
from articad.geometry.part import DEFAULT_COLOR, Primitive, Shape
from articad.geometry.shapes import primitive_mesh
from articad.importers.fusing import fused, with_chains_named
from articad.importers.raw import ENDLESS, IDENTITY, RawJoint, RawLink, RawModel, RawTie, aligned, assemble, require_links
from articad.importers.reading import (
    LARGEST_MM,
    MAX_LINKS,
    MAX_NAME,
    MAX_SHAPES,
    MAX_XML_BYTES,
    MM_PER_M,
    Folder,
    color_text,
    read_xml,
    unreadable,
)
from articad.importers.records import unedited
from articad.importers.sdf_frames import MODEL, WORLD, Scope, numbers_of, pose_of
from articad.importers.sdf_kept import kept_of
from articad.kinematics.joints import JointType

__all__ = ["read_sdf"]


MAX_DEPTH: Final = 20  # of nested models
MAX_FILES: Final = 200  # largest number of included files
MAX_ELEMENTS: Final = 500_000  # of a file and all that it includes, each counted as often as it is included
MAX_ALL_XML: Final = 2 * MAX_XML_BYTES  # the same for bytes
NO_BOUND: Final = 1e16  # SDFormat's value for a bound, an effort or a velocity that is not stated
_ACROSS: Final = 1e-9  # largest deviation of the axes of a universal joint from a right angle
_NAMED_IN_MODEL: Final = ("link", "joint", "frame", "model", "include")
_TYPES: Final = {"fixed", "revolute", "continuous", "prismatic", "ball", "universal", "revolute2", "screw"}


def read_sdf(path: str | Path, *, root: str | Path | None = None, metadata: bool = True, fuse: bool = False) -> Assembly:
    """Read an SDFormat file: one model, or all models of one world.

    Links become parts in their own frames; the ground is the world, a part without a shape. Joints keep their names, `revolute2` becomes
    two revolute joints over a bare part. A model is free in the world unless it is static or a joint holds it. Nested models, and
    several models of a world, have names such as `arm::hand`. `<include>` is read if the file is below the root.

    Args:
        path: The file.
        root: Folder that meshes and included models may be read from; the file's own by default. `model://name/…` is looked for in it.
        metadata: Use the records that articad left in its own files, so that they come back as they were.
        fuse: Without metadata, replace chains over bare links of small mass by one joint.

    Raises:
        ReadError: If the file is not SDFormat, names files outside the root, or is not a mechanism.
    """
    path = Path(path)
    folder = Folder.of(path, None if root is None else Path(root))
    document = _document(path)
    texts = [element.text or "" for element in document.iterfind("model/{*}records/{*}record")]
    written = [*document.iterfind("model/link"), *document.iterfind("model/joint")]
    own, edited = unedited(texts if metadata else (), written, folder, path, mechanism_elements(document), rewritten)
    if own is not None:
        return own
    model = _Reader(folder, path).model(document)
    model.findings += [*edited, *folder.findings]
    model.kept += folder.kept
    require_links(model, path)
    return assemble(fused(model) if fuse else with_chains_named(model), path)


def _document(path: Path) -> Any:
    document = read_xml(path)
    if document.tag != "sdf":
        raise unreadable(path, f"line {document.sourceline}", f"The root element is <{document.tag}>, not <sdf>.")
    return document


def _version(document: Any, path: Path) -> tuple[int, ...]:
    text = document.get("version", "")
    try:
        return tuple(int(word) for word in text.split("."))
    except ValueError:
        raise unreadable(path, f"line {document.sourceline}", f"{text!r} is not a version of SDFormat.") from None


class _Reader:
    """Collects links and joints of all models."""

    def __init__(self, folder: Folder, path: Path) -> None:
        self.folder, self.path = folder, path
        self.raw = RawModel(path.stem, WORLD)
        self.joints: list[tuple[Scope, Any]] = []
        self.links: dict[str, tuple[Scope, Any]] = {}
        self.leaders: dict[str, Any] = {}  # the joints by their full names
        self.files = self.bytes = self.elements = 0

    def model(self, document: Any) -> RawModel:
        """Return the content of the document."""
        self._count(document, self.path)
        version = _version(document, self.path)
        worlds, models = document.findall("world"), document.findall("model")
        if len(worlds) + len(models) != 1:
            what = f"It has {len(worlds)} worlds and {len(models)} models; exactly one world or model is needed."
            raise unreadable(self.path, f"line {document.sourceline}", what)
        self._beside(document, {"world", "model"})
        top = Scope(worlds[0] if worlds else document, self.path, version=version)
        self.raw.name = (worlds or models)[0].get("name") or self.path.stem
        self._models(top, 0, alone=True)
        if len(top.models) == 1:
            self.raw.name = next(iter(top.models))
        if worlds:
            self._beside(worlds[0], {"model", "include", "frame", "joint"})
            self._frames(top)
        if not self.links:
            raise unreadable(self.path, "", "It has no link.")
        for name, (scope, element) in self.links.items():
            self._link(name, scope, element)
        while self.raw.ground in self.raw.links:
            self.raw.ground += "_"
        self.raw.links = {self.raw.ground: RawLink(self.raw.ground)} | self.raw.links
        for scope, element in self.joints:
            self._joint(scope, element)
        self._hold()
        return self.raw

    def _count(self, document: Any, path: Path) -> None:
        """Add a file to those that were read, and refuse it if they are too large together."""
        self.bytes += path.stat().st_size
        self.elements += sum(1 for _ in document.iter())
        for number, most, what in ((self.bytes, MAX_ALL_XML, "bytes of XML"), (self.elements, MAX_ELEMENTS, "elements")):
            if number > most:
                raise unreadable(path, "", f"With the files that are included there are {number} {what}; the maximum is {most}.")

    # ------------------------------------------------------------------ models

    def _beside(self, element: Any, read: set[str]) -> None:
        """Keep by name the elements of the world, or beside the model, that are not read."""
        for below in element:
            if below.tag not in read:
                name = f" {below.get('name')}" if below.get("name") else ""
                self.raw.kept.append(Kept("sdf", "model", f"<{below.tag}{name}> of <{element.tag}>"))

    def _models(self, scope: Scope, depth: int, *, alone: bool = False) -> None:
        """Add the models in a scope, with those that it includes."""
        if depth > MAX_DEPTH:
            raise unreadable(scope.path, "", f"Its models are nested deeper than {MAX_DEPTH}.")
        found = [*scope.element.iterfind("model"), *scope.element.iterfind("include")]
        prefix = "" if alone and len(found) == 1 else None  # the names of a single model need no prefix
        for element in found:
            inner, path, version, place = element, scope.path, scope.version, element
            if element.tag == "include":
                opened = self._included(scope, element)
                if opened is None:
                    continue
                inner, path, version = opened
            name = inner.get("name") or ""
            if not name:
                raise scope.fault(element, "A <model> has no name.")
            static = scope.static or _flag(inner, "static") or _flag(place, "static")
            if len(scope.prefix) + len(name) > MAX_NAME:
                raise scope.fault(element, f"The name of a model, with those of the models around it, has more than {MAX_NAME} characters.")
            own = Scope(inner, path, f"{scope.prefix}{name}::" if prefix is None else prefix, scope, static, version)
            if name in scope.models:
                raise scope.fault(element, f"Two models have the name {name!r}.")
            self._models(own, depth + 1)
            self._frames(own)
            scope.models[name] = own
            pose, relative_to = pose_of(place if place.find("pose") is not None else inner, scope)
            at = place.findtext("placement_frame") or inner.get("placement_frame")
            if at:
                pose = pose @ own.local(at.strip(), element).inverse()
            scope.add(element, name, relative_to or MODEL, pose, MODEL)
            self.raw.kept += kept_of(inner, "", "model")
            if place is not inner:
                self.raw.kept += [
                    Kept("sdf", "model", f"<{etree.QName(below).localname}> of <include {name}>")
                    for below in place
                    if below.tag not in _OF_INCLUDE
                ]
            self.raw.kept += [Kept("sdf", "model", f"<frame {frame.get('name')}>") for frame in inner.iterfind("frame")]

    def _included(self, scope: Scope, element: Any) -> tuple[Any, Path, tuple[int, ...]] | None:
        """Return the model that an include names, under the name that it gives; None and a finding if it cannot be read."""
        uri = (element.findtext("uri") or "").strip()
        self.files += 1
        if self.files > MAX_FILES:
            raise scope.fault(element, f"More than {MAX_FILES} models are included.")
        if element.get("merge", "").strip() in {"true", "1"}:
            raise scope.fault(element, f"The model {uri!r} is to be merged, which is not supported. Include it without merge.")
        try:
            path = self._file_of(uri, scope)
            document = _document(path)
        except ReadError as error:
            if "E_UNSAFE_PATH" in error.findings.codes:
                raise
            message = f"The model {uri!r} is left out: {error.message}"
            hint = "Put it below the folder of the file, or name a folder above both as the root (--root)."
            self.raw.findings.append(Finding(code="W_IMPORT_DROPPED", where="model", message=message, hint=hint))
            return None
        self._count(document, path)
        inner = document.find("model")
        if inner is None:
            raise unreadable(path, f"line {document.sourceline}", "The included file has no model.")
        if name := (element.findtext("name") or "").strip():
            inner.set("name", name)
        return inner, path, _version(document, path)

    def _file_of(self, uri: str, scope: Scope) -> Path:
        """Return the file of a model: the named file, or the latest one that `model.config` in the named folder lists."""
        folder = Folder(self.folder.root, scope.path.resolve().parent)
        if uri.endswith((".sdf", ".world")):
            return folder.find(uri)
        try:
            config = folder.find(f"{uri.rstrip('/')}/model.config")
        except ReadError as error:
            if "E_UNSAFE_PATH" in error.findings.codes:
                raise
            return folder.find(f"{uri.rstrip('/')}/model.sdf")
        listed = [(element.get("version", ""), (element.text or "").strip()) for element in read_xml(config).iterfind("sdf")]
        if not listed:
            raise unreadable(config, "", "It lists no SDFormat file.")
        return Folder(self.folder.root, config.parent).find(
            max(listed, key=lambda one: [int(n) for n in one[0].split(".") if n.isdecimal() and len(n) < 10])[1]
        )

    def _require_bounded(self, scope: Scope) -> None:
        """Refuse a model with which there are too many joints, or with a link that has too many shapes."""
        joints = len(self.joints) + len(scope.element.findall("joint"))
        shapes = max((len(link) for link in scope.element.iterfind("link")), default=0)
        for number, most, what in ((joints, MAX_LINKS, "joints"), (shapes, MAX_SHAPES, "elements in one link")):
            if number > most:
                raise unreadable(scope.path, "", f"It has {number} {what}; the maximum is {most}.")

    def _frames(self, scope: Scope) -> None:
        """Add the links, joints and frames of a model, after those of its nested models."""
        self._require_bounded(scope)
        for element in scope.element:
            if element.tag in _NAMED_IN_MODEL and element.tag != "include" and not element.get("name"):
                raise scope.fault(element, f"A <{element.tag}> has no name.")
        for element in scope.element.iterfind("link"):
            pose, relative_to = pose_of(element, scope)
            scope.add(element, element.get("name"), relative_to or MODEL, pose, element.get("name"))
            if scope.prefix + element.get("name") in self.links:
                raise scope.fault(element, f"Two links have the name {element.get('name')!r}.")
            self.links[scope.prefix + element.get("name")] = scope, element
            if len(self.links) > MAX_LINKS:
                raise unreadable(self.path, "", f"It has more than {MAX_LINKS} links.")
        links = {element.get("name") for element in scope.element.iterfind("link")}
        for element in scope.element.iterfind("joint"):
            pose, relative_to = pose_of(element, scope)
            child = (element.findtext("child") or "").strip()
            name = element.get("name")
            if scope.version >= (1, 7) or name not in links:  # before 1.7 a joint could have a link's name, and nothing referred to it
                scope.add(element, name, relative_to or child, pose, child)
            self.joints.append((scope, element))
            self.leaders.setdefault(scope.prefix + name, element)
        for element in scope.element.iterfind("frame"):
            pose, relative_to = pose_of(element, scope)
            attached_to = element.get("attached_to") or MODEL
            scope.add(element, element.get("name"), relative_to or attached_to, pose, attached_to)

    # ------------------------------------------------------------------ links

    def _link(self, name: str, scope: Scope, element: Any) -> None:
        where = f"parts.{name}"
        self.raw.kept += kept_of(element, "link", where)
        visuals = tuple(self._shapes(element, "visual", scope, where))
        collisions = tuple(self._shapes(element, "collision", scope, where))
        color = next((shape.color for shape in visuals if shape.color), DEFAULT_COLOR)
        self.raw.links[name] = RawLink(name, self._mass(element, scope, where), visuals, collisions, color)

    def _mass(self, link: Any, scope: Scope, where: str) -> MassProperties | None:
        """Return the mass; 1 kg with moments of 1 kg·m² if none is stated, as SDFormat specifies."""
        inertial = link.find("inertial")
        if inertial is None:
            return MassProperties(1.0, np.zeros(3), np.eye(3) * MM_PER_M**2)
        if inertial.get("auto", "").strip() in {"true", "1"}:
            self._drop(where, "Its mass is to be computed from its collisions, which is not supported; it has none.")
            return None
        pose, _ = pose_of(inertial, scope)
        mass = _number(inertial, "mass", 1.0, scope)
        if mass < 0:
            self._drop(where, f"A mass of {mass:g} kg is left out.")
            return None
        moments = inertial.find("inertia")
        I = np.zeros((3, 3))
        for name, usual in (("ixx", 1.0), ("ixy", 0.0), ("ixz", 0.0), ("iyy", 1.0), ("iyz", 0.0), ("izz", 1.0)):
            i, j = ("xyz".index(axis) for axis in name[1:])
            I[i, j] = I[j, i] = usual if moments is None else _number(moments, name, usual, scope)
        return MassProperties(mass, np.zeros(3), I * MM_PER_M**2).moved(pose)

    def _drop(self, where: str, message: str) -> None:
        self.raw.findings.append(
            Finding(code="W_IMPORT_DROPPED", where=where, message=message, hint="Nothing needs to be done if it is not needed.")
        )

    def _shapes(self, link: Any, tag: str, scope: Scope, where: str) -> Iterator[Shape]:
        place = 0
        for element in link.iterfind(tag):
            name = element.get("name") or ""
            try:
                mesh, form = self._mesh(element, scope, where)
            except InvalidSolidError as error:
                self._drop(where, f"The {tag} {name!r} is left out: {error.message}")
                continue
            if mesh is None:
                continue
            pose, relative_to = pose_of(element, scope)
            if relative_to:
                pose = scope.local(link.get("name"), element).inverse() @ scope.local(relative_to, element) @ pose
            self.raw.kept += kept_of(element, f"link/{tag}", f"{where}.{tag}s.{place}")
            place += 1
            diffuse = element.find("material/diffuse")
            rgba = None if diffuse is None else [float(word) for word in (diffuse.text or "").split(None, 4) if _is_number(word)]
            if rgba is not None and len(rgba) == 4 and rgba[3] != 1:
                self.raw.kept.append(Kept("sdf", where, f"transparency: alpha {rgba[3]:g} of {name!r}"))
            color = color_text(rgba) if rgba and len(rgba) >= 3 else None
            if tag == "visual" and form is None and color is None:
                self._beside_file(scope).keep_colors((element.findtext("geometry/mesh/uri") or "").strip(), where)
            yield Shape(mesh, pose, color, name, form)

    def _beside_file(self, scope: Scope) -> Folder:
        """Return the folder of the scope's file, with what the reader collects."""
        return replace(self.folder, here=scope.path.resolve().parent)

    def _mesh(self, element: Any, scope: Scope, where: str) -> tuple[TriMesh | None, Primitive | None]:
        """Return a shape's mesh, and the primitive that it represents; None and a finding for a shape that an assembly cannot have."""
        geometry = element.find("geometry")
        shape: Any = None if geometry is None or not len(geometry) else geometry[0]
        kind: Any = "nothing" if shape is None else shape.tag

        def size(tag: str, count: int, usual: float) -> list[float]:
            found = shape.find(tag)
            return [usual * MM_PER_M] * count if found is None else [MM_PER_M * value for value in numbers_of(found, count, scope)]

        if kind in _FORMS:
            form = Primitive(kind, tuple(value for tag, count, usual in _FORMS[kind] for value in size(tag, count, usual)))
            return primitive_mesh(form), form
        if kind == "mesh" and shape.find("submesh") is None:
            x, y, z = size("scale", 3, 1.0)
            return self._beside_file(scope).mesh((shape.findtext("uri") or "").strip(), (x, y, z), where), None
        if kind != "empty":
            what = "mesh with a submesh" if kind == "mesh" else kind
            self._drop(where, f"The {element.tag} {element.get('name')!r} of type {what} is not a shape of the assembly.")
        return None, None

    # ------------------------------------------------------------------ joints

    def _joint(self, scope: Scope, element: Any) -> None:
        name, kind = scope.prefix + element.get("name"), element.get("type") or ""
        where = f"joints.{name}"
        if kind not in _TYPES:
            self._drop(where, f"A joint of type {kind!r} is left out; it is not one of {', '.join(sorted(_TYPES))}.")
            return
        ends = [(element.findtext(tag) or "").strip() for tag in ("parent", "child")]
        if not all(ends):
            raise scope.fault(element, f"Joint {name!r} lacks its parent or its child.")
        parent, child = (scope.body(end, element) or self.raw.ground for end in ends)
        if parent == child:
            raise scope.fault(element, f"Joint {name!r} connects {parent!r} with itself.")
        pose, relative_to = pose_of(element, scope)
        T = scope.world(relative_to or ends[1], element) @ pose
        near, far = (self._pose_of(link).inverse() @ T for link in (parent, child))
        kept = list(kept_of(element, "joint", where))
        self.raw.kept += kept
        self.raw.kept += _without_effect(element, kind, where)
        if kind in {"fixed", "ball"}:
            joint_type, cone = (JointType.BALL, math.pi) if kind == "ball" else (JointType.FIXED, None)
            self.raw.joints.append(RawJoint(name, joint_type, parent, child, near, far, cone=cone))
            return
        need = 2 if kind in {"universal", "revolute2"} else 1
        axes = [axis for tag in ("axis", "axis2")[:need] if (axis := element.find(tag)) is not None]
        if len(axes) < need:
            raise scope.fault(element, f"Joint {name!r} of type {kind} has {len(axes)} axes; it needs {need}.")
        vectors = [self._axis(scope, element, axis, T) for axis in axes]
        if kind == "universal" and abs(float(vectors[0] @ vectors[1])) <= _ACROSS:
            W = SE3.from_axes(np.zeros(3), np.cross(vectors[0], vectors[1]), vectors[0])
            self.raw.joints.append(RawJoint(name, JointType.UNIVERSAL, parent, child, near @ W, far @ W, **self._loads(axes, scope, where)))
            for mimic in element.iterfind("*/mimic"):
                self._drop(where, f"A <mimic> is left out: an axis of a universal joint cannot follow {mimic.get('joint')!r}.")
            return
        if need == 2:
            message = f"the fact that {name!r} of type {kind} is one joint: it is read as {name}__1 and {name}__2 over a bare link"
            self.raw.kept.append(Kept("sdf", where, message))
        self._about_axes(name, kind, scope, element, list(zip(axes, vectors, strict=True)), (parent, child), (near, far))

    def _about_axes(
        self,
        name: str,
        kind: str,
        scope: Scope,
        element: Any,
        axes: list[tuple[Any, FloatArray]],
        ends: tuple[str, str],
        frames: tuple[SE3, SE3],
    ) -> None:
        """Add a joint for each axis, over bare links if there are several."""
        (parent, child), (near, far) = ends, frames
        for place, (axis, vector) in enumerate(axes):
            last = place == len(axes) - 1
            one = name if len(axes) == 1 else f"{name}__{place + 1}"
            end = child if last else self.raw.bare_link(f"{name}__d1")
            R = aligned(vector)
            joint_type = {"prismatic": JointType.SLIDER, "screw": JointType.SCREW}.get(kind, JointType.REVOLUTE)
            more = self._loads([axis], scope, f"joints.{one}", slides=kind == "prismatic", endless=kind == "continuous")
            if kind == "screw":
                more["lead"] = self._lead(element, scope)
            self.raw.joints.append(RawJoint(one, joint_type, parent, end, near @ R, (far if last else IDENTITY) @ R, **more))
            self._tie(one, axis, scope, slides=kind == "prismatic")
            parent, near = end, IDENTITY

    def _pose_of(self, link: str) -> SE3:
        """Return the pose of a link in the world [mm]."""
        if link not in self.links:
            return IDENTITY
        scope, element = self.links[link]
        return scope.world(element.get("name"), element)

    def _axis(self, scope: Scope, joint: Any, axis: Any, T: SE3) -> FloatArray:
        """Return an axis as a unit vector in the joint's frame; T is that frame in the world.

        Up to 1.4 it is stated in the model's frame, in 1.5 and 1.6 if `use_parent_model_frame` says so, from 1.7 on in `expressed_in`.
        """
        xyz = axis.find("xyz")
        vector = np.array([0.0, 0.0, 1.0] if xyz is None else numbers_of(xyz, 3, scope))
        length = float(np.linalg.norm(vector))
        if not length > 1e-9:
            raise scope.fault(axis, f"The axis of joint {joint.get('name')!r} has no direction.")
        stated = "" if xyz is None else xyz.get("expressed_in") or ""
        if scope.version < (1, 5) or _flag(axis, "use_parent_model_frame"):
            stated = stated or MODEL
        if stated:
            vector = T.rotation.T @ scope.world(stated, axis).rotation @ vector
        whole = np.round(vector / length)
        unit = vector / length
        return np.asarray(np.where(np.abs(unit - whole) < 1e-15, whole, unit)) + 0.0

    def _loads(self, axes: list[Any], scope: Scope, where: str, *, slides: bool = False, endless: bool = False) -> dict[str, Any]:
        """Return limits, effort, velocity, damping and friction of axes, in N, mm, rad and s."""
        unit, force = (MM_PER_M, 1.0) if slides else (1.0, MM_PER_M)
        found: dict[str, list[Any]] = {name: [] for name in ("ranges", "effort", "velocity", "damping", "friction")}
        for axis in axes:
            limit, dynamics = axis.find("limit"), axis.find("dynamics")
            low, high = (_number(limit, name, usual, scope) for name, usual in (("lower", -math.inf), ("upper", math.inf)))
            bounds = (-math.inf if low <= -NO_BOUND else low * unit, math.inf if high >= NO_BOUND else high * unit)
            if bounds[0] > bounds[1] or low > LARGEST_MM or high < -LARGEST_MM:
                fault = "are reversed" if bounds[0] > bounds[1] else "are beyond any position"
                message = f"The limits [{low:g}, {high:g}] {'m' if slides else 'rad'} {fault}; the joint is treated as endless."
                self.raw.findings.append(
                    Finding(
                        code="W_IMPORT_LIMITS",
                        where=where,
                        message=message,
                        hint="State lower and upper limits in the file, the lower one first.",
                    )
                )
                bounds = ENDLESS
            found["ranges"].append(ENDLESS if endless else bounds)
            for name, factor in (("effort", force), ("velocity", unit)):
                value = _number(limit, name, math.inf, scope)
                found[name].append(value * factor if 0 <= value < NO_BOUND else None)  # a negative value means none
            found["damping"].append(_number(dynamics, "damping", 0.0, scope) * force / unit)
            found["friction"].append(_number(dynamics, "friction", 0.0, scope) * force)
        return {name: tuple(values) for name, values in found.items()}

    def _lead(self, joint: Any, scope: Scope) -> float:
        """Return the advance of a screw per turn [mm]: `screw_thread_pitch` in m, or the older `thread_pitch`, left-handed rad per m."""
        old = joint.find("thread_pitch")
        if joint.find("screw_thread_pitch") is None and old is not None:
            pitch = numbers_of(old, 1, scope)[0]
            if pitch == 0:
                raise scope.fault(old, "A screw needs a thread pitch other than zero.")
            return -math.tau / pitch * MM_PER_M
        lead = _number(joint, "screw_thread_pitch", 1.0, scope) * MM_PER_M
        if lead == 0:
            raise scope.fault(joint, "A screw needs a thread pitch other than zero.")
        return lead

    def _tie(self, follower: str, axis: Any, scope: Scope, *, slides: bool) -> None:
        """Add `<mimic>`: value = multiplier · (leader − reference) + offset."""
        mimic = axis.find("mimic")
        if mimic is None:
            return
        leader = scope.prefix + (mimic.get("joint") or "")
        other = self.leaders.get(leader)
        if other is not None and other.get("type") == "revolute2":
            leader = f"{leader}__{2 if mimic.get('axis') == 'axis2' else 1}"
        mine, its = (MM_PER_M if yes else 1.0 for yes in (slides, other is not None and other.get("type") == "prismatic"))
        ratio, offset, reference = (
            _number(mimic, tag, usual, scope) for tag, usual in (("multiplier", 1.0), ("offset", 0.0), ("reference", 0.0))
        )
        self.raw.ties.append(RawTie(follower, leader, ratio * mine / its, (offset - ratio * reference) * mine))

    def _hold(self) -> None:
        """Connect links without a joint to the world: static ones are fixed, all others are free."""
        group = {name: name for name in self.raw.links}

        def of(name: str) -> str:
            while group[name] != name:
                group[name] = group[group[name]]
                name = group[name]
            return name

        for joint in self.raw.joints:
            group[of(joint.child)] = of(joint.parent)
        taken = {joint.name for joint in self.raw.joints}
        canonical = {scope.body(MODEL, scope.element) for scope, _ in self.links.values()}
        carried = {joint.child for joint in self.raw.joints}  # a tree begins at a link that no joint carries
        for name in sorted(self.links, key=lambda one: (self.links[one][1].get("name") != WORLD, one in carried, one not in canonical)):
            if of(name) == of(self.raw.ground):
                continue
            scope, _ = self.links[name]
            reserved = self.links[name][1].get("name") == WORLD
            if reserved:
                message = f"The link {name!r} has the name of the world, so it is fixed to the world."
                hint = "Give the link another name, and fix it to the world."
                self.raw.findings.append(Finding(code="W_IMPORT_LIMITS", where=f"parts.{name}", message=message, hint=hint))
            kind, word = (JointType.FIXED, "fixed") if scope.static or reserved else (JointType.FREE, "free")
            joint_name = f"{name}_{word}"
            while joint_name in taken:
                joint_name += "_"
            taken.add(joint_name)
            self.raw.joints.append(RawJoint(joint_name, kind, self.raw.ground, name, self._pose_of(name), IDENTITY))
            group[of(name)] = of(self.raw.ground)
        static = dict.fromkeys(
            scope.element.get("name") for scope, element in self.joints if scope.static and element.get("type") != "fixed"
        )
        if static:
            self.raw.kept.append(Kept("sdf", "model", f"<static> of {', '.join(map(str, static))}: that its joints do not move"))


_FORMS: Final[dict[Any, tuple[tuple[str, int, float], ...]]] = {
    "box": (("size", 3, 1.0),),
    "sphere": (("radius", 1, 1.0),),
    "cylinder": (("radius", 1, 1.0), ("length", 1, 1.0)),
    "capsule": (("radius", 1, 0.5), ("length", 1, 1.0)),
    "ellipsoid": (("radii", 3, 1.0),),
}
"""Elements with the sizes of primitives, how many numbers they have, and SDFormat's default [m]."""


def _without_effect(joint: Any, kind: str, where: str) -> Iterator[Kept]:
    """Yield what a joint states and its type does not use."""
    read = {"fixed": (), "ball": (), "universal": ("axis", "axis2"), "revolute2": ("axis", "axis2")}.get(kind, ("axis",))
    said = [below.tag for below in joint if below.tag in {"axis", "axis2"} and below.tag not in read]
    said += [below.tag for below in joint if below.tag in {"thread_pitch", "screw_thread_pitch"} and kind != "screw"]
    if kind == "continuous":
        said += [
            below.tag for below in joint.iterfind("axis/limit/*") if below.tag in {"lower", "upper"} and abs(_value_of(below)) < NO_BOUND
        ]
    if said and kind != "fixed":
        yield Kept("sdf", where, f"{', '.join(f'<{tag}>' for tag in said)} of a joint of type {kind}")


def _value_of(element: Any) -> float:
    return float(element.text) if _is_number(element.text or "") else math.inf


_OF_INCLUDE: Final = frozenset({"uri", "name", "pose", "static", "placement_frame"})


def _flag(element: Any, tag: str) -> bool:
    return (element.findtext(tag) or "").strip() in {"true", "1"}


def _is_number(word: str) -> bool:
    try:
        return math.isfinite(float(word))
    except ValueError:
        return False


def _number(above: Any, tag: str, usual: float, scope: Scope) -> float:
    """Return the number in an element below another; `usual` if there is none. Only what is usually infinite may be infinite or huge.

    Raises:
        ReadError: If it is not a plausible number.
    """
    element = None if above is None else above.find(tag)
    if element is None or not (element.text or "").strip():
        return usual
    try:
        value = float(element.text)
    except ValueError:
        value = math.nan
    if math.isnan(value) or (abs(value) > LARGEST_MM and math.isfinite(usual)):
        raise scope.fault(element, f"<{tag}> holds {element.text.strip()[:60]!r}, not a plausible number.")
    return value
