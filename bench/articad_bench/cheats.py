"""Cheats: products that look right to the checks of a task and are not what was asked for. None may pass.

Most are made of a task's reference: its joints stay and its bodies go. Discs are made of the checks alone. A cheat that equals the reference,
such as the mirror image of a symmetric product, is not counted.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import manifold3d
import numpy as np

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.connectors import SE3
from articad.geometry import Part, TriMesh, box, cylinder, sphere
from articad.kinematics.joints import Coupling, Joint, JointLimits, JointType
from articad.plan.resolve import Waiver
from articad_bench.bindings import shows_hands
from articad_bench.checks import Freedoms, Joints, Loops, Parts, PartSize, Size
from articad_bench.likeness_checks import Upright
from articad_bench.subject import Subject
from articad_bench.task import Task
from articad_bench.trick_cheats import TRICKS

__all__ = ["CHEATS", "Cheat", "cheats_of"]

WIRE_MM: Final = 0.06
SHELL: Final = 0.98  # of the size of a body, its hollow
FACTOR: Final = 10.0
DENSITY: Final = 1000.0  # kg/m³
DISC_MM: Final = 20.0
HARDLY: Final = 0.01  # rad or mm
MIRROR: Final = np.diag([1.0, -1.0, 1.0, 1.0])
_OF_MORE_WAYS: Final = frozenset({JointType.CYLINDRICAL, JointType.UNIVERSAL, JointType.PLANAR})
_SIDES: Final = frozenset(
    [
        "left",
        "right",
        "front",
        "back",
        "rear",
        "upper",
        "lower",
        "top",
        "bottom",
        "inner",
        "outer",
        "first",
        "second",
        "third",
        "fourth",
        "tip",
        "end",
        "side",
    ]
)
"""Words of a part's name that say which of several it is, or where."""


@dataclass(frozen=True)
class Cheat:
    """A product that must not pass.

    Attributes:
        kind: Of the cheat, a key of `CHEATS`.
        assembly: The product.
    """

    kind: str
    assembly: Assembly


def cheats_of(task: Task, reference: Assembly, kinds: Sequence[str] = (), *, other: Assembly | None = None) -> Iterator[Cheat]:
    """Yield the cheats that a task can be tried with.

    Args:
        task: The task.
        reference: Its reference solution.
        kinds: Keys of `CHEATS`; all by default.
        other: The reference of another task.
    """
    for kind in kinds or (*CHEATS, "other"):
        if kind == "other":
            if other is not None:
                yield Cheat(kind, other)
            continue
        made = CHEATS[kind](task, reference)
        if made is not None:
            yield Cheat(kind, made)


# ---------------------------------------------------------------------- of the checks alone


def _discs(task: Task, _reference: Assembly) -> Assembly | None:
    """Return a plate with a disc for every joint that is asked for: of no shape but with the right types, axes, ranges and numbers."""
    wanted = [check for check in task.checks if isinstance(check, Joints)]
    if not wanted:
        return None
    loops = next((int(check.number[0]) for check in task.checks if isinstance(check, Loops)), 0)
    freedoms = next((check.number for check in task.checks if isinstance(check, Freedoms)), None)
    sides = [side for check in task.checks if isinstance(check, PartSize) for side in [check.mm] * int(check.number[0])]
    size = next((check.mm for check in task.checks if isinstance(check, Size)), (None, None, None))
    joints = _disc_joints(wanted)
    if any(check.number[0] < check.number[1] for check in wanted):  # there may be more: what closes loops need not be among them
        joints += [next((row for row in joints if row[0] is JointType.REVOLUTE), joints[0])] * loops
    cut = max(len(joints) - loops, 1)
    joints, closing = joints[:cut], joints[cut:]
    least = next((int(check.number[0]) for check in task.checks if isinstance(check, Parts)), 1)
    pitch = max([2 * DISC_MM, *(1.5 * max((x or 0.0) for x in row) for row in sides)])
    count = max(len(joints), least - 1)
    plate = box(size[0] or pitch * (count + 1), size[1] or 2 * DISC_MM, 5.0)
    parts, made = [Part.from_mesh("plate", plate, density=DENSITY)], []
    for number in range(count):
        joint = joints[number] if number < len(joints) else None
        place = SE3.from_translation(np.array([(number - (count - 1) / 2) * pitch, 0.0, 2.5]))
        flat = sides[number] if number < len(sides) else None
        mesh = cylinder(DISC_MM / 2, 4.0, 32) if number % 2 == 0 else sphere(DISC_MM / 4, 16)
        mesh = mesh if flat is None else box(*((side or 4.0) for side in flat))
        low = float(mesh.bounds[0, 2])
        name = f"disc_{number}"
        parts.append(Part.from_mesh(name, mesh.transformed(SE3.from_translation(np.array([0.0, 0.0, 0.02 - low]))), density=DENSITY))
        kind, axis, limits = joint or (JointType.FIXED, None, JointLimits())
        turn = _along(axis)
        made.append(_joint(f"j{number}", kind, "plate", name, place @ turn, turn, limits))
    for number, (kind, _, _) in enumerate(closing):  # what closes "loops": the same pin once more
        alike = [joint for joint in made[: len(joints)] if joint.type is kind] or made[:1]
        made.append(_doubled(alike[number % len(alike)], f"again{number}", number))
    couplings = _coupled(made[:count], freedoms)
    return Assembly.from_parts("discs", parts=parts, joints=made, ground="plate", couplings=couplings)


def _disc_joints(wanted: Sequence[Joints]) -> list[tuple[JointType, FloatArray | None, JointLimits]]:
    """Return type, axis and limits of as many joints as the checks ask for, the narrowest demands first."""
    rows: list[tuple[JointType, FloatArray | None, JointLimits]] = []
    for check in sorted(wanted, key=lambda check: check.joint.span is None):
        kind, axis = check.joint.type, None if check.joint.axis is None else np.array(check.joint.axis)
        there = sum(row[0] is kind for row in rows) if check.joint.span is None else 0
        rows += [(kind, axis, _limits(kind, check.joint.span))] * (int(check.number[0]) - there)
    return rows


def _limits(kind: JointType, span: object) -> JointLimits:
    if kind in {JointType.BALL, JointType.FIXED, JointType.FREE}:
        return JointLimits()
    slides = kind is JointType.SLIDER
    if span == "endless":
        return JointLimits((-math.inf,) * len(kind.neutral), (math.inf,) * len(kind.neutral))
    width = float(np.mean(span)) if isinstance(span, tuple) and span[1] < 1e6 else float(span[0]) if isinstance(span, tuple) else 30.0
    width = width if slides else math.radians(width)
    return JointLimits((0.0,) * len(kind.neutral), (width,) * len(kind.neutral))


def _coupled(joints: Sequence[Joint], freedoms: int | None) -> list[Coupling]:
    """Return couplings that leave as many freedoms as are asked for."""
    columns = [(joint.name, joint.limits) for joint in joints if len(joint.type.coordinates) == 1]
    surplus = 0 if freedoms is None else sum(joint.type.freedoms for joint in joints) - freedoms
    rows = []
    for number in range(min(max(surplus, 0), max(len(columns) - 1, 0))):
        (a, first), (b, second) = columns[0], columns[number + 1]
        spans = [limits.upper[0] - limits.lower[0] for limits in (first, second)]
        ratio = spans[1] / spans[0] if all(math.isfinite(span) and span > 0 for span in spans) else 1.0
        rows.append(Coupling(f"c{number}", "linear", a, b, ratio))
    return rows


def _along(axis: FloatArray | None) -> SE3:
    """Return a rotation that brings z along an axis."""
    z = np.array([0.0, 0.0, 1.0]) if axis is None else axis / np.linalg.norm(axis)
    across = np.cross([0.0, 0.0, 1.0], z)
    angle = math.atan2(float(np.linalg.norm(across)), float(z[2]))
    return (
        SE3.identity() if angle < 1e-9 else SE3.from_axis_angle(across if np.linalg.norm(across) > 1e-9 else np.array([1.0, 0, 0]), angle)
    )


def _joint(name: str, kind: JointType, parent: str, child: str, T_parent: SE3, T_child: SE3, limits: JointLimits) -> Joint:
    return Joint(
        name=name,
        type=kind,
        parent=parent,
        child=child,
        parent_connector=f"{name}_p",
        child_connector=f"{name}_c",
        T_parent_connector=T_parent,
        T_child_connector=T_child,
        limits=limits,
        rest=kind.neutral,
        lead=1.0 if kind is JointType.SCREW else 0.0,
    )


# ---------------------------------------------------------------------- of the reference


def _wires(_task: Task, reference: Assembly) -> Assembly:
    """Return the reference with every body a skeleton of wire between its joints and its six farthest points."""
    return _reshaped(reference, lambda name, mesh: _skeleton(mesh, _connectors(reference, name)))


def _skeleton(mesh: TriMesh, points: Sequence[FloatArray]) -> TriMesh:
    middle = mesh.bounds.mean(axis=0)
    ends = [mesh.vertices[pick] for axis in range(3) for pick in (mesh.vertices[:, axis].argmin(), mesh.vertices[:, axis].argmax())]
    rods = [_rod(middle, end) for end in (*ends, *points) if float(np.linalg.norm(end - middle)) > WIRE_MM]
    return _united(rods) or mesh


def _rod(start: FloatArray, end: FloatArray) -> TriMesh:
    length = float(np.linalg.norm(end - start))
    way = SE3.from_translation((start + end) / 2) @ _along(end - start)
    return box(WIRE_MM, WIRE_MM, length + WIRE_MM).transformed(way)


def _shells(_task: Task, reference: Assembly) -> Assembly:
    """Return the reference with every body hollow, and a pinhole, so that it is one surface."""

    def hollow(_name: str, mesh: TriMesh) -> TriMesh:
        middle = SE3.from_translation(mesh.bounds.mean(axis=0))
        inner = mesh.transformed(middle.inverse()).scaled(SHELL).transformed(middle)
        return _cut(mesh, [inner, _rod(mesh.bounds.mean(axis=0), mesh.vertices[mesh.vertices[:, 2].argmax()] + [0, 0, 1.0])]) or mesh

    return _reshaped(reference, hollow)


def _mirrored(task: Task, reference: Assembly) -> Assembly | None:
    """Return the mirror image of the reference across the plane y = 0, threads included, if the task says which hand is meant."""
    mechanism = reference.mechanism
    if not (shows_hands(task) or any(joint.lead for joint in reference.joints)):
        return None
    joints = []
    for joint in reference.joints:
        frames = [SE3.from_matrix(MIRROR @ T.matrix @ MIRROR) for T in (joint.T_parent_connector, joint.T_child_connector)]
        names = {"name": joint.name, "parent": joint.parent, "child": joint.child}
        named = {"parent_connector": joint.parent_connector, "child_connector": joint.child_connector}
        mirrored = joint.mirrored(**names, **named, T_parent_connector=frames[0], T_child_connector=frames[1])
        joints.append(replace(mirrored, driver=joint.driver))
    signs = {name: sign for joint in reference.joints for name, sign in zip(joint.column_names, joint.type.mirror_signs(), strict=False)}
    couplings = [replace(c, ratio=c.ratio * signs[c.a] * signs[c.b], offset=c.offset * signs[c.b]) for c in mechanism.couplings]
    parts = [_with_mesh(part, part.mesh.reflected(MIRROR)) if part.mesh is not None else part for part in reference.parts.values()]
    T_ground = SE3.from_matrix(MIRROR @ mechanism.T_ground.matrix @ MIRROR)
    return _changed(reference, parts=parts, joints=joints, couplings=couplings, T_ground=T_ground)


def _misplaced(_task: Task, reference: Assembly) -> Assembly | None:
    """Return the reference with a moving body beside its joint, by a quarter of the product's size."""
    name = _a_moved_part(reference)
    if name is None:
        return None
    aside = SE3.from_translation(np.array([0.0, 0.0, 0.25 * float(Subject(reference).size.max())]))
    return _reshaped(reference, lambda part, mesh: mesh.transformed(aside) if part == name else mesh)


def _omitted(task: Task, reference: Assembly) -> Assembly | None:
    """Return the reference without one body that the request is about, and without its joint and what is fixed to it.

    The request is about what moves, and what its text names: a nut or a foot that nobody asks for may be missing.
    """
    ends = _ends(reference, with_fixed=True)
    asked = [joint for joint in ends if joint.type is not JointType.FIXED or _is_named(joint.child, task.prompt)]
    if not asked or len(reference.parts) < 2:
        return None
    return _without(reference, asked[-1])


def _swapped(_task: Task, reference: Assembly) -> Assembly | None:
    """Return the reference with the shapes of two bodies exchanged."""
    shapes = {name: part.mesh for name, part in reference.parts.items() if part.mesh is not None}
    moved = [name for name in shapes if name != reference.ground]
    pairs = [(a, b) for a in moved for b in moved if a < b and shapes[a].digest != shapes[b].digest]
    if not pairs:
        return None
    a, b = pairs[0]
    exchanged = {a: shapes[b], b: shapes[a]}
    return _reshaped(reference, exchanged.get)


def _scaled(_task: Task, reference: Assembly) -> Assembly:
    """Return the reference ten times as large."""

    def far(T: SE3) -> SE3:
        return SE3.from_rotation(T.rotation, T.translation * FACTOR)

    def long(joint: Joint, values: Sequence[float]) -> tuple[float, ...]:
        return tuple(value * FACTOR if unit == "mm" else value for value, unit in zip(values, joint.type.units, strict=False))

    joints = [
        replace(
            joint,
            T_parent_connector=far(joint.T_parent_connector),
            T_child_connector=far(joint.T_child_connector),
            rest=long(joint, joint.rest),
            limits=replace(joint.limits, lower=long(joint, joint.limits.lower), upper=long(joint, joint.limits.upper)),
            lead=joint.lead * FACTOR,
        )
        for joint in reference.joints
    ]
    units = {name: unit for joint in reference.joints for name, unit in zip(joint.column_names, joint.type.units, strict=False)}
    factor = {name: FACTOR if unit == "mm" else 1.0 for name, unit in units.items()}
    couplings = [
        replace(c, ratio=c.ratio * factor[c.b] / factor[c.a], offset=c.offset * factor[c.b]) for c in reference.mechanism.couplings
    ]
    parts = [_with_mesh(part, part.mesh.scaled(FACTOR)) if part.mesh is not None else part for part in reference.parts.values()]
    return _changed(reference, parts=parts, joints=joints, couplings=couplings, T_ground=far(reference.mechanism.T_ground))


def _merged(_task: Task, reference: Assembly) -> Assembly | None:
    """Return the reference with a moving body united with what carries it."""
    shapes = {name: part.mesh for name, part in reference.parts.items()}
    ends = [joint for joint in _ends(reference) if joint.type is not JointType.FIXED]
    ends = [joint for joint in ends if shapes[joint.parent] is not None and shapes[joint.child] is not None]
    if not ends:
        return None
    leaf, rest = ends[-1], Subject(reference).rest
    carried = shapes[leaf.child].transformed(rest[leaf.parent].inverse() @ rest[leaf.child])  # type: ignore[union-attr]
    whole = _united([shapes[leaf.parent], carried])  # type: ignore[list-item]
    return None if whole is None else _without(_reshaped(reference, lambda name, mesh: whole if name == leaf.parent else mesh), leaf)


def _waived(_task: Task, reference: Assembly) -> Assembly | None:
    """Return the reference with a moving body that runs through its neighbours, and waivers for every two parts."""
    name = _a_moved_part(reference)
    if name is None:
        return None

    def thick(part: str, mesh: TriMesh) -> TriMesh:
        if part != name:
            return mesh
        middle = SE3.from_translation(mesh.bounds.mean(axis=0))
        return mesh.transformed(middle.inverse()).scaled(1.3).transformed(middle)

    names = list(reference.parts)
    waivers = [Waiver((a, b), 1e6, "It is meant.") for i, a in enumerate(names) for b in names[i + 1 :]]
    return replace(_reshaped(reference, thick), waivers=tuple(waivers))


def _coaxial(_task: Task, reference: Assembly) -> Assembly | None:
    """Return the reference with its loops left open, and as many pins doubled in their place."""
    closing = list(reference.mechanism.loop_joints)
    open_ = [joint for joint in reference.joints if joint.name not in {each.name for each in closing}]
    pins = [joint for joint in open_ if joint.type is JointType.REVOLUTE]
    if not closing or not pins:
        return None
    doubled = [_doubled(pins[number % len(pins)], joint.name, number + 1) for number, joint in enumerate(closing)]
    return _changed(reference, joints=[*open_, *doubled], couplings=())


def _stuck(_task: Task, reference: Assembly) -> Assembly | None:
    """Return the reference with sleeves, plane slides and universal joints that go as far as before one way, and hardly at all the other ways."""
    stuck = {joint.name: replace(joint, limits=_main_alone(joint)) for joint in reference.joints if joint.type in _OF_MORE_WAYS}
    return _changed(reference, joints=[stuck.get(joint.name, joint) for joint in reference.joints]) if stuck else None


def _main_alone(joint: Joint) -> JointLimits:
    lower, upper = ([rest + off for rest in joint.rest[1:]] for off in (-HARDLY, HARDLY))
    return replace(joint.limits, lower=(joint.limits.lower[0], *lower), upper=(joint.limits.upper[0], *upper))


def _overturned(task: Task, reference: Assembly) -> Assembly | None:
    """Return the reference upside down, or facing the other way, if the task says which side is up, or the front."""
    check = next((check for check in task.checks if isinstance(check, Upright)), None)
    if check is None:
        return None
    turn = SE3.rot_z(math.pi) if check.over is None else SE3.rot_x(math.pi)
    return _changed(reference, T_ground=turn @ reference.mechanism.T_ground)


CHEATS: Final[Mapping[str, Callable[[Task, Assembly], Assembly | None]]] = {
    "discs": _discs,
    "wires": _wires,
    "shells": _shells,
    "mirrored": _mirrored,
    "misplaced": _misplaced,
    "omitted": _omitted,
    "swapped": _swapped,
    "scaled": _scaled,
    "merged": _merged,
    "waived": _waived,
    "coaxial": _coaxial,
    "stuck": _stuck,
    "overturned": _overturned,
    **TRICKS,
}
"""Makers of cheats; "other", the reference of another task, is one more."""


# ---------------------------------------------------------------------- tools


def _ends(reference: Assembly, *, with_fixed: bool = False) -> list[Joint]:
    """Return the joints of bodies that no coupling moves, and that nothing hangs from, or nothing but what is fixed to them."""
    coupled = {column.split(".")[0] for coupling in reference.mechanism.couplings for column in (coupling.a, coupling.b)}
    return [
        joint
        for joint in reference.joints
        if joint.name not in coupled and (below := _below(reference, joint)) is not None and (with_fixed or len(below) == 1)
    ]


def _below(reference: Assembly, joint: Joint) -> set[str] | None:
    """Return what goes with the child of a joint: itself and what is fixed to it; None if more hangs from it, or it is the ground."""
    gone, joints = {joint.child}, [each for each in reference.joints if each.name != joint.name]
    while True:
        around = [each for each in joints if {each.parent, each.child} & gone]
        if any(each.type is not JointType.FIXED or (each.child in gone and each.parent not in gone) for each in around):
            return None
        more = {each.child for each in around} - gone
        if not more:
            return None if reference.ground in gone else gone
        gone |= more


def _without(reference: Assembly, gone: Joint) -> Assembly:
    below = _below(reference, gone) or {gone.child}
    return _changed(
        reference,
        parts=[part for part in reference.parts.values() if part.name not in below],
        joints=[joint for joint in reference.joints if not {joint.parent, joint.child} & below],
    )


def _is_named(name: str, text: str) -> bool:
    """Return whether a text names a part, in the singular or plural, whatever it says of its side."""
    said = set(re.split(r"[^a-z]+", text.lower()))
    words = [word for word in re.split(r"[^a-z]+", name.lower()) if len(word) > 1 and word not in _SIDES]
    return bool(words) and all({word, f"{word}s", f"{word}es"} & said for word in words)


def _doubled(pin: Joint, name: str, number: int) -> Joint:
    """Return the same joint once more, some millimetres along its axis."""
    along = SE3.from_translation(np.array([0.0, 0.0, 5.0 + number]))
    return replace(
        pin,
        name=name,
        parent_connector=f"{name}_p",
        child_connector=f"{name}_c",
        T_parent_connector=pin.T_parent_connector @ along,
        T_child_connector=pin.T_child_connector @ along,
        closing=True,
        driver=False,
    )


def _a_moved_part(reference: Assembly) -> str | None:
    moved = [
        joint.child for joint in reference.joints if joint.type is not JointType.FIXED and reference.parts[joint.child].mesh is not None
    ]
    others = [name for name in reference.parts if name != reference.ground and reference.parts[name].mesh is not None]
    return next(iter([*moved, *others]), None)


def _connectors(reference: Assembly, part: str) -> list[FloatArray]:
    ends = [(joint.parent, joint.T_parent_connector) for joint in reference.joints]
    ends += [(joint.child, joint.T_child_connector) for joint in reference.joints]
    return [np.asarray(T.translation) for name, T in ends if name == part]


def _reshaped(reference: Assembly, shape: Callable[[str, TriMesh], TriMesh]) -> Assembly:
    parts = [_with_mesh(part, shape(name, part.mesh)) if part.mesh is not None else part for name, part in reference.parts.items()]
    return _changed(reference, parts=parts)


def _with_mesh(part: Part, mesh: TriMesh) -> Part:
    return part if mesh is part.mesh else replace(Part.from_mesh(part.name, mesh, density=DENSITY), color=part.color)


def _changed(
    reference: Assembly,
    *,
    parts: Sequence[Part] | None = None,
    joints: Sequence[Joint] | None = None,
    couplings: Sequence[Coupling] | None = None,
    T_ground: SE3 | None = None,
) -> Assembly:
    mechanism = reference.mechanism
    joints = reference.joints if joints is None else joints
    names = {joint.name for joint in joints}
    return Assembly.from_parts(
        reference.name,
        parts=list(reference.parts.values()) if parts is None else parts,
        joints=joints,
        ground=reference.ground,
        couplings=mechanism.couplings if couplings is None else couplings,
        fits={name: fit for name, fit in reference.fits.items() if name in names},
        T_ground=mechanism.T_ground if T_ground is None else T_ground,
    )


def _united(meshes: Sequence[TriMesh]) -> TriMesh | None:
    return _mesh_of(manifold3d.Manifold.batch_boolean([_manifold(mesh) for mesh in meshes], manifold3d.OpType.Add)) if meshes else None


def _cut(mesh: TriMesh, tools: Sequence[TriMesh]) -> TriMesh | None:
    return _mesh_of(manifold3d.Manifold.batch_boolean([_manifold(each) for each in (mesh, *tools)], manifold3d.OpType.Subtract))


def _manifold(mesh: TriMesh) -> manifold3d.Manifold:
    welded = mesh.welded(1e-6)
    return manifold3d.Manifold(manifold3d.Mesh64(np.array(welded.vertices, dtype=np.float64), np.array(welded.triangles, dtype=np.uint64)))


def _mesh_of(body: manifold3d.Manifold) -> TriMesh | None:
    """Return the largest piece of a body; None if there is none."""
    pieces = [piece for piece in body.decompose() if piece.volume() > 0]
    if body.status() != manifold3d.Error.NoError or not pieces:
        return None
    found = max(pieces, key=lambda piece: piece.volume()).to_mesh64()
    return TriMesh(np.asarray(found.vert_properties)[:, :3].astype(np.float64), np.asarray(found.tri_verts).astype(np.int32))
