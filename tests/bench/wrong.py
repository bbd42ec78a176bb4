"""Assemblies made wrong on purpose: for each kind of check a variant of a sound assembly that it must refuse."""

from __future__ import annotations

import atexit
import re
import shutil
import tempfile
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.connectors import SE3
from articad.export.urdf import write_urdf
from articad.geometry import MassProperties, Part, TriMesh, box, merged
from articad.geometry.part import Solid
from articad.kinematics.joints import Coordinate, Joint, JointLimits, JointType
from articad_bench.checks import Check, Joints, Ratio
from articad_bench.section_checks import Section
from articad_bench.subject import Subject


def wrong_for(check: Check, assembly: Assembly) -> Subject:
    """Return a variant of a sound assembly that a check must refuse."""
    return VARIANTS[check.kind](check, Subject(assembly))


def changed(assembly: Assembly, parts: Sequence[Part] | None = None, joints: Sequence[Joint] | None = None, **options: object) -> Assembly:
    mechanism = assembly.mechanism
    rows = {"couplings": mechanism.couplings, "fits": assembly.fits, "T_ground": mechanism.T_ground} | options
    return Assembly.from_parts(
        assembly.name,
        parts=list(assembly.parts.values()) if parts is None else parts,
        joints=assembly.joints if joints is None else joints,
        ground=assembly.ground,
        **rows,  # type: ignore[arg-type]
    )


def shaped_as(part: Part, mesh: TriMesh | None) -> Part:
    if mesh is None:
        return Part.without_geometry(part.name, part.connectors, part.mass)
    solid = Solid.from_mesh(mesh)
    dense = 1000.0 if part.mass is None or part.mesh is None else 1e9 * part.mass.mass / abs(part.mesh.volume)
    mass = None if part.mass is None else MassProperties.from_solid(abs(solid.volume), solid.com, solid.inertia_mm5, dense)
    return replace(part, solid=solid, visuals=(), collisions=(), mass=mass)


def _bare(check: Check, subject: Subject) -> Subject:
    """Too few parts have a shape."""
    keep = set(subject.shaped[: int(check.number[0]) - 1])  # type: ignore[attr-defined]
    parts = [part if name in keep else shaped_as(part, None) for name, part in subject.assembly.parts.items()]
    return Subject(changed(subject.assembly, parts))


def _welded(check: Check, subject: Subject) -> Subject:
    """What drives, is fixed; what should not move or go by itself, does."""
    if check.number == 0:  # type: ignore[attr-defined]
        return Subject(changed(subject.assembly, joints=[_loose(joint) for joint in subject.assembly.joints]))
    if subject.assembly.mechanism.couplings and not subject.assembly.mechanism.loop_joints:
        return Subject(changed(subject.assembly, couplings=()))  # what follows goes its own way
    columns = [column for coupling in subject.assembly.mechanism.couplings for column in (coupling.a, coupling.b)]
    drivers = {driver.joint for driver in subject.assembly.drivers} | {column.split(".")[0] for column in columns}
    return Subject(changed(subject.assembly, joints=[_fixed(j) if j.name in drivers else j for j in subject.assembly.joints], couplings=()))


def _fixed(joint: Joint) -> Joint:
    held = joint.T_parent_connector @ joint.motion(joint.rest)
    return replace(
        joint, type=JointType.FIXED, T_parent_connector=held, limits=JointLimits(), rest=(), effort=(), velocity=(), driver=False
    )


def _loose(joint: Joint) -> Joint:
    return replace(joint, type=JointType.REVOLUTE, limits=JointLimits((-1.0,), (1.0,)), rest=(0.0,), effort=(), velocity=())


def _other_joints(check: Check, subject: Subject) -> Subject:
    """The joints that are meant have another axis."""
    assert isinstance(check, Joints)
    names = {joint.name for joint in check.joint.found(subject)}
    if check.number[0] == 0:
        return _none(check, subject)
    turn = SE3.from_axis_angle(np.array([0.6, 0.5, 0.4]), 0.6)

    def leaning(joint: Joint) -> Joint:
        if check.joint.axis is None:
            return _plain(joint)
        return replace(
            joint, T_parent_connector=joint.T_parent_connector @ turn, T_child_connector=joint.T_child_connector @ turn, rest=joint.rest
        )

    joints = [leaning(joint) if joint.name in names else joint for joint in subject.assembly.joints]
    return Subject(changed(subject.assembly, joints=joints, couplings=()))


def _plain(joint: Joint) -> Joint:
    """Return a joint of another type that carries its child as it rests."""
    if joint.type is not JointType.BALL:
        return _fixed(joint)
    held = joint.T_parent_connector @ joint.motion(joint.rest)
    return replace(
        joint, type=JointType.REVOLUTE, T_parent_connector=held, limits=JointLimits((-1.0,), (1.0,)), rest=(0.0,), effort=(), velocity=()
    )


def _none(_check: Check, _subject: Subject) -> Subject:
    raise NotImplementedError("A check for no joints needs a variant of its own.")


def _larger(_check: Check, subject: Subject) -> Subject:
    """Everything is a thousand times as large, millimetres taken for metres: no other side has the length that is asked for."""
    factor = 1000.0

    def scaled(T: SE3) -> SE3:
        return SE3.from_rotation(T.rotation, T.translation * factor)

    parts = [shaped_as(part, mesh.scaled(factor)) if (mesh := part.mesh) is not None else part for part in subject.assembly.parts.values()]
    joints = [
        replace(
            j,
            T_parent_connector=scaled(j.T_parent_connector),
            T_child_connector=scaled(j.T_child_connector),
            rest=_long(j, j.rest, factor),
            limits=replace(j.limits, lower=_long(j, j.limits.lower, factor), upper=_long(j, j.limits.upper, factor)),
        )
        for j in subject.assembly.joints
    ]
    return Subject(changed(subject.assembly, parts, joints, couplings=(), T_ground=scaled(subject.assembly.mechanism.T_ground)))


def _long(joint: Joint, values: Sequence[float], factor: float) -> tuple[float, ...]:
    return tuple(value * factor if unit == "mm" else value for value, unit in zip(values, joint.type.units, strict=False))


def _two_solids(_check: Check, subject: Subject) -> Subject:
    """A part comes in two pieces."""
    name = subject.shaped[-1]
    mesh = subject.assembly.parts[name].mesh
    assert mesh is not None
    crumb = box(1, 1, 1).transformed(SE3.from_translation(mesh.bounds[1] + 5))
    return _with_mesh(subject, name, merged([mesh, crumb]))


def _crowded(_check: Check, subject: Subject) -> Subject:
    """One part fills the box of the whole."""
    low, high = subject.corners(subject.rest)
    name = subject.shaped[0]
    block = box(*(high - low).tolist()).transformed(subject.rest[name].inverse() @ SE3.from_translation((low + high) / 2))
    parts = [shaped_as(part, block) if part.name == name else part for part in subject.assembly.parts.values()]
    return Subject(changed(subject.assembly, parts))


def _massless(_check: Check, subject: Subject) -> Subject:
    """The file states no mass and no shape that a simulator could take one from."""
    folder = Path(tempfile.mkdtemp(prefix="articad-massless-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    (file,) = (path for path in write_urdf(subject.assembly).write(folder) if path.suffix == ".urdf")
    file.write_text(re.sub(r"<(inertial|collision)>.*?</\1>", "", file.read_text(), flags=re.DOTALL))
    return Subject(subject.assembly, file=file)


def _overlapping(_check: Check, subject: Subject) -> Subject:
    """A part fills its neighbour's place."""
    a, b = subject.shaped[-1], subject.shaped[0]
    other = subject.assembly.parts[b].mesh
    assert other is not None
    return _with_mesh(subject, a, other.transformed(subject.rest[a].inverse() @ subject.rest[b]))


def _adrift(_check: Check, subject: Subject) -> Subject:
    """A part is far from all others."""
    name = subject.shaped[-1]
    mesh = subject.assembly.parts[name].mesh
    assert mesh is not None
    return _with_mesh(subject, name, mesh.transformed(SE3.from_translation(np.array([0.0, 0.0, 20 * float(subject.size.max())]))))


def _in_the_way(_check: Check, subject: Subject) -> Subject:
    """Something stands where a moving part comes by."""
    assembly = subject.assembly
    on_ground = {joint.name for joint in assembly.joints if joint.parent == assembly.ground}
    for driver in sorted(assembly.drivers, key=lambda driver: driver.joint in on_ground):  # no ghost in a bearing, if there is a choice
        q = _on_its_way(subject, driver)
        poses = dict(zip(assembly.mechanism.parts, assembly.poses(q), strict=True))
        joint = next(joint for joint in assembly.joints if joint.name == driver.joint)
        goes = [end for end in (joint.child, joint.parent) if np.abs(poses[end].matrix - subject.rest[end].matrix).max() > 1e-9]
        mover = next(  # a screw that has turned thirty-five times is where it was: what it drives has gone
            (end for end in goes if end in subject.shaped),
            next((name for name in subject.shaped if poses[name].distance_to(subject.rest[name]) > 1), joint.child),
        )
        stands = next(name for name in subject.shaped if float(poses[name].distance_to(subject.rest[name])) < 1e-9)
        ghost, mesh = assembly.parts[mover].mesh, assembly.parts[stands].mesh
        assert ghost is not None
        assert mesh is not None
        return _with_mesh(subject, stands, merged([mesh, ghost.transformed(poses[stands].inverse() @ poses[mover])]))
    raise AssertionError("Nothing moves.")


def _on_its_way(subject: Subject, driver: Coordinate) -> FloatArray:
    """Return all drivers at rest but one, which is at seven tenths of its range; a ball joint leans by as much of its cone."""
    q = np.array(subject.assembly.mechanism.rest)
    column = [each.name for each in subject.assembly.drivers].index(driver.name)
    joint = next(joint for joint in subject.assembly.joints if joint.name == driver.joint)
    if joint.type is JointType.BALL:
        assert joint.limits.cone is not None
        q[column : column + 4] = SE3.rot_x(0.7 * joint.limits.cone).quaternion
        return q
    reached = subject.driver_range(driver.name)
    assert reached is not None
    q[column] = reached[0] + 0.7 * (reached[1] - reached[0])
    return q


def _unclosed(_check: Check, subject: Subject) -> Subject:
    """A loop is left open, and what was coupled goes its own way."""
    loops = {joint.name for joint in subject.assembly.mechanism.loop_joints}
    return Subject(changed(subject.assembly, joints=[j for j in subject.assembly.joints if j.name not in loops], couplings=()))


def _uncoupled(check: Check, subject: Subject) -> Subject:
    assert isinstance(check, Ratio)
    return _unclosed(check, subject)


def _short(_check: Check, subject: Subject) -> Subject:
    """Hardly anything may move."""

    def narrowed(joint: Joint) -> Joint:
        rest = joint.rest
        limits = (
            replace(joint.limits, lower=tuple(x - 1e-3 for x in rest), upper=tuple(x + 1e-3 for x in rest))
            if joint.limits.lower
            else joint.limits
        )
        return replace(joint, limits=limits)

    return Subject(changed(subject.assembly, joints=[narrowed(joint) for joint in subject.assembly.joints]))


def _mispinned(_check: Check, subject: Subject) -> Subject:
    """A pin that closes a loop sits elsewhere on both of its parts: links are longer or shorter than they should be."""
    mechanism = subject.assembly.mechanism
    aside = SE3.from_translation(np.array([0.06, 0.04, 0.0]) * float(subject.size.max()))
    moved = next((joint for joint in mechanism.loop_joints if joint.type is JointType.REVOLUTE), None)
    if moved is None:  # couplings alone make it so
        return _unclosed(_check, subject)
    turn = moved.motion(moved.rest)
    joints = [
        replace(j, T_parent_connector=j.T_parent_connector @ aside, T_child_connector=j.T_child_connector @ turn.inverse() @ aside @ turn)
        if j.name == moved.name
        else j
        for j in subject.assembly.joints
    ]
    return Subject(changed(subject.assembly, joints=joints))


def _leaning(check: Check, subject: Subject) -> Subject:
    """A pin that closes a loop leans, in both of its parts.

    In a delta robot, a misplaced pin leaves the platform level: parallel axes alone keep its attitude. A mechanism with redundant
    constraints, such as a planar one, would be blocked by a leaning pin; there the pin is misplaced instead.
    """
    mechanism = subject.assembly.mechanism
    closing = next((joint for joint in mechanism.loop_joints if joint.type is JointType.REVOLUTE), None)
    generic = 6 * (len(mechanism.parts) - 1) - sum(6 - joint.type.freedoms for joint in mechanism.joints)
    if closing is None or generic != mechanism.mobility:
        return _mispinned(check, subject)
    lean, turn = SE3.rot_x(0.2), closing.motion(closing.rest)
    leaning = replace(
        closing,
        T_parent_connector=closing.T_parent_connector @ lean,
        T_child_connector=closing.T_child_connector @ turn.inverse() @ lean @ turn,
    )
    return Subject(
        changed(subject.assembly, joints=[leaning if joint.name == closing.name else joint for joint in subject.assembly.joints])
    )


def _of_another_wall(check: Check, subject: Subject) -> Subject:
    """Walls of another thickness; where none may be thin, all are foils."""
    if check.number[1] > 0:  # type: ignore[attr-defined]
        return _larger(check, subject)
    thick = 0.5 * sum(check.mm)  # type: ignore[attr-defined]
    parts = [
        part if (mesh := part.mesh) is None else shaped_as(part, mesh.scaled(thick / float(np.ptp(mesh.bounds, axis=0).min())))
        for part in subject.assembly.parts.values()
    ]
    return Subject(changed(subject.assembly, parts))


def _thin(check: Check, subject: Subject) -> Subject:
    """What a joint carries is too small for it."""
    names = {joint.child for joint in check.joint.found(subject)}  # type: ignore[attr-defined]
    parts = []
    for name, part in subject.assembly.parts.items():
        mesh = part.mesh
        if name in names and mesh is not None:
            middle = SE3.from_translation(mesh.bounds.mean(axis=0))
            mesh = mesh.transformed(middle.inverse()).scaled(0.5).transformed(middle)
        parts.append(part if mesh is part.mesh else shaped_as(part, mesh))
    return Subject(changed(subject.assembly, parts))


def _crumbs(_check: Check, subject: Subject) -> Subject:
    """All that moves is a hundredth as large."""
    parts = []
    for name, part in subject.assembly.parts.items():
        mesh = part.mesh
        if mesh is not None and subject.rigid[name] != subject.rigid[subject.assembly.ground]:
            middle = SE3.from_translation(mesh.bounds.mean(axis=0))
            mesh = mesh.transformed(middle.inverse()).scaled(0.01).transformed(middle)
        parts.append(part if mesh is part.mesh else shaped_as(part, mesh))
    return Subject(changed(subject.assembly, parts))


def _corners(_check: Check, subject: Subject) -> Subject:
    """Of every body two crumbs are left, at opposite corners of its box."""
    parts = []
    for part in subject.assembly.parts.values():
        mesh = part.mesh
        if mesh is not None:
            mesh = merged([box(0.1, 0.1, 0.1).transformed(SE3.from_translation(corner)) for corner in mesh.bounds])
        parts.append(part if mesh is None else shaped_as(part, mesh))
    return Subject(changed(subject.assembly, parts))


def _cut_otherwise(check: Check, subject: Subject) -> Subject:
    """Each part is the block of the whole: of another size where sizes are asked for, else hollow where nothing may be open, in too many where one piece may be."""
    assert isinstance(check, Section)
    if check.piece or check.clear or check.apart or check.area:
        return _larger(check, subject)
    ends = subject.corners(subject.rest)
    middle, sides = ends.mean(axis=0), np.ptp(ends, axis=0)
    aside = 2 * sides * ([0, 1, 0] if check.axis == "x" else [1, 0, 0])

    def block(place: int, share: float) -> TriMesh:
        return box(share * sides[0], share * sides[1], share * sides[2]).transformed(SE3.from_translation(middle + place * aside))

    if check.openings == (0, 0):
        blocks = [block(0, 1.0), block(0, 0.9).flipped()]
    else:
        many = int(check.pieces[1]) + 1 if check.pieces and check.pieces[0] <= 1 else 1
        blocks = [block(place, 1.0) for place in range(many)]
    whole = merged(blocks)
    parts = [
        part if part.mesh is None else shaped_as(part, whole.transformed(subject.rest[part.name].inverse()))
        for part in subject.assembly.parts.values()
    ]
    return Subject(changed(subject.assembly, parts))


def _one_aside(_check: Check, subject: Subject) -> Subject:
    """The last part lies far beside its place."""
    last = subject.shaped[-1]
    aside = SE3.from_translation(np.array([0.0, 0.0, float(np.linalg.norm(subject.size))]))
    parts = [
        shaped_as(part, part.mesh.transformed(aside)) if name == last and part.mesh is not None else part
        for name, part in subject.assembly.parts.items()
    ]
    return Subject(changed(subject.assembly, parts))


def _with_a_mast(_check: Check, subject: Subject) -> Subject:
    """A thin mast stands on it, as high as the whole is large."""
    last, tall = subject.shaped[-1], float(np.linalg.norm(subject.size))
    low, high = subject.corners(subject.rest)
    foot = SE3.from_translation(np.array([*(low + high)[:2] / 2, high[2] + tall / 2]))
    mast = box(0.02 * tall, 0.02 * tall, tall).transformed(subject.rest[last].inverse() @ foot)
    parts = [
        shaped_as(part, merged([part.mesh, mast])) if name == last and part.mesh is not None else part
        for name, part in subject.assembly.parts.items()
    ]
    return Subject(changed(subject.assembly, parts))


def _mirror_image(_check: Check, subject: Subject) -> Subject:
    """Every body is where its mirror image would be."""
    parts = []
    for name, part in subject.assembly.parts.items():
        mirror = subject.rest[name].inverse().matrix @ np.diag([1.0, -1.0, 1.0, 1.0]) @ subject.rest[name].matrix
        parts.append(part if part.mesh is None else shaped_as(part, part.mesh.reflected(mirror)))
    return Subject(changed(subject.assembly, parts))


def _upside_down(_check: Check, subject: Subject) -> Subject:
    """It lies on its head, or faces the other way."""
    T = subject.assembly.mechanism.T_ground
    turns = (SE3.rot_x(np.pi), SE3.rot_z(np.pi))
    found = [Subject(changed(subject.assembly, T_ground=turn @ T)) for turn in turns]
    return next((each for each in found if not _check.judge(each).ok), found[0])


def _longer(check: Check, subject: Subject) -> Subject:
    """A rod reaches far beyond what is allowed, to all sides."""
    reach = 3 * check.mm[1]  # type: ignore[attr-defined]
    name = subject.shaped[0]
    return _with_mesh(subject, name, box(reach, reach, reach))


def _nothing_around(_check: Check, subject: Subject) -> Subject:
    """Parts that could hold others have no shape."""
    moving = {joint.child for joint in subject.assembly.joints if joint.type is not JointType.FIXED}
    last = next(name for name in reversed(subject.shaped) if name in moving)
    return Subject(
        changed(subject.assembly, [part if name == last else shaped_as(part, None) for name, part in subject.assembly.parts.items()])
    )


def _all_new(_check: Check, subject: Subject) -> Subject:
    """Every part was rebuilt."""
    return Subject(subject.assembly, before=_larger(_check, subject).assembly)


def _with_mesh(subject: Subject, name: str, mesh: TriMesh) -> Subject:
    parts = [shaped_as(part, mesh) if part.name == name else part for part in subject.assembly.parts.values()]
    return Subject(changed(subject.assembly, parts))


def _heavy_beside(_check: Check, subject: Subject) -> Subject:
    """A lump hangs out on one side, well above the ground."""
    low, high = subject.corners(subject.rest)
    side = float((high - low).max())
    lump = box(side, side, side).transformed(SE3.from_translation(np.array([high[0] + side, high[1] + side, high[2] + side])))
    name = subject.shaped[0]
    mesh = subject.assembly.parts[name].mesh
    assert mesh is not None
    return _with_mesh(subject, name, merged([mesh, lump.transformed(subject.rest[name].inverse())]))


def _other_lead(_check: Check, subject: Subject) -> Subject:
    """Screws are twice as steep, and of the other hand."""
    return Subject(changed(subject.assembly, joints=[replace(joint, lead=-2 * joint.lead) for joint in subject.assembly.joints]))


def _tipping(_check: Check, subject: Subject) -> Subject:
    """All is fixed but for a long rod that lies level and tips."""
    low, high = subject.corners(subject.rest)
    frame = SE3.from_translation((low + high) / 2) @ SE3.rot_y(np.pi / 2)
    ground, name = subject.assembly.ground, next(name for name in reversed(subject.shaped) if name != subject.assembly.ground)
    mesh = subject.assembly.parts[name].mesh
    assert mesh is not None
    rod = box(1, 10 * float((high - low).max()), 1).transformed(subject.rest[name].inverse() @ SE3.from_translation((low + high) / 2))
    parts = [
        shaped_as(part, merged([mesh, rod])) if part.name == name else part
        for part in subject.assembly.parts.values()
        if part.name in {*subject.shaped, ground}
    ]
    joints = [
        Joint(
            name=f"to_{part.name}",
            type=JointType.REVOLUTE if part.name == name else JointType.FIXED,
            parent=ground,
            child=part.name,
            parent_connector=f"for_{part.name}",
            child_connector="held",
            T_parent_connector=subject.rest[ground].inverse() @ frame,
            T_child_connector=subject.rest[part.name].inverse() @ frame,
            limits=JointLimits((-1.0,), (1.0,)) if part.name == name else JointLimits(),
            rest=(0.0,) if part.name == name else (),
        )
        for part in parts
        if part.name != ground
    ]
    return Subject(changed(subject.assembly, parts, joints, couplings=(), fits={}))


def _locked(_check: Check, subject: Subject) -> Subject:
    """A shell around the product that nothing gets into."""
    low, high = subject.corners(subject.rest)
    outer, inner = (box(*(high - low + 2 * reach)).transformed(SE3.from_translation((low + high) / 2)) for reach in (20.0, 10.0))
    shell = merged([outer, TriMesh(inner.vertices, inner.triangles[:, ::-1])])
    mesh = subject.assembly.parts[subject.assembly.ground].mesh
    assert mesh is not None
    return _with_mesh(subject, subject.assembly.ground, merged([mesh, shell.transformed(subject.rest[subject.assembly.ground].inverse())]))


def _foil(_check: Check, subject: Subject) -> Subject:
    """Every part is a hundredth as high, from its upper face."""
    parts = []
    for name, part in subject.assembly.parts.items():
        if part.mesh is not None:
            placed = part.mesh.transformed(subject.rest[name])
            top = placed.bounds[1, 2]
            vertices = placed.vertices * [1, 1, 0.01] + [0, 0, 0.99 * top]
            part = shaped_as(part, TriMesh(vertices, placed.triangles).transformed(subject.rest[name].inverse()))  # noqa: PLW2901
        parts.append(part)
    return Subject(changed(subject.assembly, parts))


def _undeclared(check: Check, subject: Subject) -> Subject:
    """No fit is declared, and every piece is a thousand times as long."""
    return Subject(changed(_larger(check, subject).assembly, fits={}))


def _one_turned_round(check: Check, subject: Subject) -> Subject:
    """One of the parts that are meant is upside down and back to front."""
    name = subject.of_size(check.mm, check.tolerance)[0]  # type: ignore[attr-defined]
    mesh = subject.assembly.parts[name].mesh
    assert mesh is not None
    middle = SE3.from_translation(mesh.bounds.mean(axis=0))
    turned = mesh
    for turn in (SE3.rot_x(np.pi), SE3.rot_z(np.pi), SE3.rot_y(np.pi / 2)):  # a shape may be its own image by one of them
        turned = turned.transformed(middle @ turn @ middle.inverse())
        found = _with_mesh(subject, name, turned)
        if not check.judge(found).ok:
            return found
    return found


VARIANTS: dict[str, Callable[[Check, Subject], Subject]] = {
    "parts": _bare,
    "freedoms": _welded,
    "joints": _other_joints,
    "size": _larger,
    "part_size": _larger,
    "mass": _larger,
    "solids": _two_solids,
    "clear_at_rest": _overlapping,
    "joined": _adrift,
    "clear_in_motion": _in_the_way,
    "certified": _in_the_way,
    "simulates": _massless,
    "loops": _unclosed,
    "ratio": _uncoupled,
    "rise": _short,
    "travel": _short,
    "straight": _mispinned,
    "level": _leaning,
    "floor": _tipping,
    "turns": _unclosed,
    "meshes": _crumbs,
    "gap": _thin,
    "captive": _nothing_around,
    "made": _nothing_around,
    "moves": _crumbs,
    "matter": _corners,
    "extent": _longer,
    "threads": _other_lead,
    "links": _larger,
    "square": _larger,
    "machined": _larger,
    "toleranced": _larger,
    "spaced": _larger,
    "ordered": _larger,
    "turned": _one_turned_round,
    "reaches": _short,
    "fitted": _larger,
    "weighs": _larger,
    "room": _crowded,
    "arranged": _one_aside,
    "outlined": _with_a_mast,
    "handed": _mirror_image,
    "upright": _upside_down,
    "unchanged": _all_new,
    "shifted": _all_new,
    "holes": _larger,
    "passage": _larger,
    "section": _cut_otherwise,
    "studs": _larger,
    "wall": _of_another_wall,
    "volume": _larger,
    "holds": _larger,
    "stands": _heavy_beside,
    "symmetric": _heavy_beside,
    "lead": _other_lead,
    "put_together": _locked,
    "effort": _larger,
    "carries": _foil,
    "folds": _larger,
    "passes": _larger,
    "stack": _undeclared,
}
