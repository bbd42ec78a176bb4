"""Shapes: whether mesh files exist, meshes are solids, visible links have collision shapes, and sizes are consistent."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from articad.auditing.declared import Declared, DeclaredLink, DeclaredShape, Role
from articad.auditing.mesh_references import READABLE
from articad.auditing.wording import counted, listed
from articad.connectors.se3 import SE3
from articad.findings import Finding
from articad.geometry.capping import without_gaps
from articad.geometry.mesh import TriMesh
from articad.interference.body import Body, body_of
from articad.interference.overlap import distance, surfaces_touch
from articad.interference.relations import Groups

APART_MM = 0.1  # pieces of one link that are farther apart are not connected
MOST_PIECES = 60  # of a link; a mesh with more is a drawing and not a body: its pieces are not compared
MOST_PIECE_TRIANGLES = 60_000
FLAT_MM3 = 1e-3
SCALE_RATIO = 50.0  # a larger ratio of visual and collision shapes means another unit
UNIT_RATIO = 100.0  # a mesh larger than the rest of its robot by this factor was drawn in another unit
LARGEST_MM = 1e5  # 100 m, for models with joints
GROUND_MM = 1e6  # 1 km, for a floor or a landscape
SMALLEST_MM = 1.0
BELOW_MM = 1.0

_IDENTITY = SE3.identity()


def unread_meshes(declared: Declared) -> Iterator[Finding]:
    """Mesh files that are missing, lead out of the folder, or contain no mesh."""
    for (problem, _), users in _by_file(declared).items():
        shape = users[0][1]
        names = tuple(dict.fromkeys(user.name for user, _ in users))
        used = f"The {shape.kind}{f' {shape.file!r}' if shape.file else ''}, which {listed(names)} {'uses' if len(names) == 1 else 'use'},"
        if shape.kind != "mesh":
            code, hint = "E_AUDIT_NUMBER", "Give it a positive size, or leave the shape out."
        elif problem == "absent":
            code, hint = "E_AUDIT_MESH_ABSENT", "Add the file, correct the name, or give the folder of packages with --root."
        elif problem == "unsafe":
            code, hint = "W_AUDIT_MESH_OUTSIDE", "Keep meshes below the file's own folder, or name the folder that holds both with --root."
        elif problem == "format":
            code, hint = (
                "I_AUDIT_MESH_FORMAT",
                f"Convert it to one of {', '.join(READABLE)}; simulators differ in the other formats they read.",
            )
        else:
            code, hint = "E_AUDIT_MESH_UNREADABLE", "Export the mesh again."
        yield Finding(
            code=code,
            where=shape.where,
            parts=names,
            message=f"{used} {'is not read' if problem == 'format' else 'cannot be read' if shape.kind == 'mesh' else 'is not valid'}: {shape.reason.rstrip('.')}.",
            hint=hint,
            value=len(users),
            limit=0,
        )


def no_collision(declared: Declared) -> Iterator[Finding]:
    """Links with visual but no collision shapes."""
    if not declared.states_collision:
        return
    drawn = [link for link in declared.links if link.of("visual")]
    bare = [link for link in drawn if not any(other.of("collision") for other in _rigid_with(declared, link))]
    if bare:
        names = tuple(link.name for link in bare)
        yield Finding(
            code="W_AUDIT_NO_COLLISION",
            where=bare[0].where,
            parts=names,
            message=f"{len(bare)} of {counted(len(drawn), 'drawn link')} {'has' if len(bare) == 1 else 'have'} no collision shape, so everything passes through: {listed(names)}.",
            hint="Use the same mesh or a simpler one for collision; --fix adds the closed visual meshes.",
            value=len(bare),
            limit=0,
            cause="no_collision",
        )


def broken_meshes(declared: Declared) -> Iterator[Finding]:
    """Meshes that are open, inside out or flat: each file once, with all links that use it."""
    users: dict[tuple[str, tuple[float, ...]], list[tuple[DeclaredLink, DeclaredShape]]] = {}
    for link, shape in _meshes(declared):
        assert shape.mesh is not None
        if shape.kind != "mesh" or (shape.role == "visual" and link.of("collision") and not _closed(shape.mesh).is_closed):
            continue  # if visual and collision shapes differ, the latter are checked
        users.setdefault((shape.file or shape.where, shape.scale), []).append((link, shape))
    for (name, _), rows in users.items():
        link, shape = rows[0]
        links = tuple(dict.fromkeys(user.name for user, _ in rows))
        what = (shape.file and name) or f"The {shape.role} mesh of {link.name}"
        found = _broken(shape, what if len(links) == 1 else f"{what}, which {listed(links)} use,")
        if found is not None:
            yield replace(found, parts=links)


def _broken(shape: DeclaredShape, what: str) -> Finding | None:
    assert shape.mesh is not None
    mesh = _closed(shape.mesh)
    if not mesh.is_closed:
        gaps = "; where overlap and hulls are compared, these gaps are closed" if without_gaps(mesh).is_closed else ""
        return Finding(
            code="W_AUDIT_MESH_OPEN",
            where=shape.where,
            message=f"{what} is open: {mesh.open_edges} edges of {len(mesh.triangles)} triangles belong to only one triangle, "
            f"so it has no volume{gaps}.",
            hint="Close the mesh: every edge must belong to two triangles.",
            value=mesh.open_edges,
            limit=0,
            unit="edges",
        )
    if abs(mesh.volume) < FLAT_MM3:
        return Finding(
            code="W_AUDIT_MESH_FLAT",
            where=shape.where,
            message=f"{what} encloses {abs(mesh.volume):.3g} mm³: it is a surface, not a body.",
            hint="Give it a thickness.",
            value=abs(mesh.volume),
            limit=FLAT_MM3,
            unit="mm³",
        )
    if mesh.volume < 0:
        return Finding(
            code="W_AUDIT_MESH_INSIDE_OUT",
            where=shape.where,
            message=f"{what} is inside out: its volume is {mesh.volume:.6g} mm³.",
            hint="Reverse the order of the corners of all its triangles"
            + ("; check for a negative scale factor." if min(shape.scale) < 0 else "."),
            value=mesh.volume,
            limit=0.0,
            unit="mm³",
        )
    return None


def pieces(declared: Declared) -> Iterator[Finding]:
    """Links whose shapes are several bodies that do not touch, or that touch without being fused."""
    seen: set[tuple[object, ...]] = set()
    for link in declared.links:
        shapes = link.of("visual") or link.of("collision")
        key = tuple((shape.file or shape.where, shape.scale) for shape in shapes)
        if key in seen or any(shape.mesh is None or shape.kind == "geom" for shape in shapes):
            continue
        bodies = _solid_pieces(shapes)
        if bodies is not None and len(bodies) > 1:
            finding = _apart(link, bodies, _fixed_to(declared, link), whole=len(shapes) == 1)
            if finding is not None:
                seen.add(key)
                yield finding


def _apart(link: DeclaredLink, own: list[Body], fixed: list[Body], *, whole: bool) -> Finding | None:
    """Return the fault of a link with several bodies; several shapes may touch, but one mesh should be one body.

    Links fixed to it may hold its bodies together.
    """
    alone = len(_touching(own)) == 1
    sets = [[0]] if alone else [kept for group in _touching([*own, *fixed]) if (kept := [at for at in group if at < len(own)])]
    if len(sets) > 1:
        largest = max(sets, key=lambda group: sum(own[at].volume for at in group))
        gap = max(min(distance(own[a], own[b], _IDENTITY) for a in group for b in largest) for group in sets if group is not largest)
        return Finding(
            code="W_AUDIT_PIECES",
            where=link.where,
            parts=(link.name,),
            message=f"{link.name} consists of {len(sets)} bodies that do not touch each other; the farthest is {gap:.4g} mm from the largest.",
            hint="Make each body a separate link, or join them; unconnected bodies cannot be one rigid link.",
            value=gap,
            limit=APART_MM,
            unit="mm",
            cause="multi_solid",
        )
    if whole and alone:
        return Finding(
            code="I_AUDIT_UNFUSED",
            where=link.where,
            parts=(link.name,),
            message=f"The mesh of {link.name} consists of {len(own)} bodies that touch or overlap but are not fused: where they overlap, its volume counts twice.",
            hint="Fuse the bodies into one.",
            value=len(own),
            limit=1,
            unit="bodies",
            cause="multi_solid",
        )
    return None


def _touching(bodies: list[Body]) -> list[list[int]]:
    """Return the sets of bodies that touch directly or through others."""
    names = [str(at) for at in range(len(bodies))]
    groups = Groups(names)
    for i, a in enumerate(bodies):
        for j in range(i + 1, len(bodies)):
            if not groups.together(names[i], names[j]) and _near(a, bodies[j]):
                groups.join(names[i], names[j])
    return [[int(name) for name in group] for group in groups.sets()]


def scale(declared: Declared) -> Iterator[Finding]:
    """A robot of implausible size, or a mesh that does not fit the rest of its robot: another unit."""
    sizes = {link.name: min(_sizes(link)) for link in declared.links if len(link.points)}
    if not sizes:
        return
    largest, smallest = max(sizes.values()), min(sizes.values())
    most = LARGEST_MM if any(joint.moves for joint in declared.joints) else GROUND_MM
    if largest > most or largest < SMALLEST_MM:
        big = largest > most
        limit = most if big else SMALLEST_MM
        name = max(sizes, key=lambda key: sizes[key])
        yield Finding(
            code="W_AUDIT_SCALE",
            where=declared.by_name[name].where,
            parts=(name,),
            message=f"The largest link, {name}, is {largest / 1000:.4g} m in size.",
            hint=f"URDF and MJCF are in metres; scale its mesh by {'0.001, if it was drawn in millimetres' if big else '1000'}.",
            value=largest,
            limit=limit,
            unit="mm",
            cause="units",
        )
        return
    offsets = [float(np.linalg.norm(joint.frame.translation)) for joint in declared.joints if joint.frame is not None]
    reach = max(offsets, default=0.0)
    if len(sizes) < 2 or reach == 0.0:
        return
    for name, size in sizes.items():
        rest = sorted(other for key, other in sizes.items() if key != name)
        typical = max(reach, rest[len(rest) // 2])
        ratio = size / typical
        link = declared.by_name[name]
        if ratio > UNIT_RATIO and any(shape.kind == "mesh" for shape in link.shapes) and smallest > 0:
            yield Finding(
                code="W_AUDIT_UNITS",
                where=link.where,
                parts=(name,),
                message=f"{name} is {size / 1000:.4g} m in size, {ratio:.0f} times the other links and the distances between joints ({typical / 1000:.4g} m).",
                hint='Its mesh was drawn in millimetres: add scale="0.001 0.001 0.001".',
                value=ratio,
                limit=UNIT_RATIO,
                cause="units",
            )


def visual_against_collision(declared: Declared) -> Iterator[Finding]:
    """Visual and collision shapes that differ by the factor of a unit."""
    for link in declared.links:
        drawn, touched = (
            np.concatenate([shape.mesh.vertices for shape in link.of(role) if shape.mesh is not None] or [np.empty((0, 3))])
            for role in _ROLES
        )
        if not len(drawn) or not len(touched) or any(shape.mesh is None for shape in link.shapes):
            continue
        ratio = _diagonal(drawn) / max(_diagonal(touched), 1e-12)
        factor = max(ratio, 1 / ratio) if ratio > 0 else 1.0
        if factor > SCALE_RATIO:
            larger = "drawn" if ratio > 1 else "collided with"
            yield Finding(
                code="W_AUDIT_UNITS",
                where=link.where,
                parts=(link.name,),
                message=f"{link.name} is {larger} {factor:.4g} times as large as its {'collision shape' if ratio > 1 else 'visual shape'}.",
                hint="Give both meshes the same unit by their scale.",
                value=factor,
                limit=SCALE_RATIO,
                cause="units",
            )


def base_below(declared: Declared) -> Iterator[Finding]:
    """A robot that reaches below the origin of its base: spawned at z = 0, it penetrates the floor."""
    if declared.format != "urdf" or declared.states_frames or len(declared.roots) != 1 or len(declared.by_name) < 2:
        return
    lowest = (0.0, "")
    for name, T in declared.poses().items():
        points = declared.by_name[name].points
        if len(points):
            lowest = min(lowest, (float(T.apply(points)[:, 2].min()), name))
    below = -lowest[0]
    if below > BELOW_MM:
        yield Finding(
            code="I_AUDIT_BASE",
            where=declared.by_name[declared.roots[0]].where,
            parts=(lowest[1],),
            message=f"{lowest[1]} reaches {below:.4g} mm below the origin of the base {declared.roots[0]}: spawned at z = 0, it penetrates the floor.",
            hint=f"Add a base link {below / 1000:.6g} m below it (--fix does), or spawn the robot that high.",
            value=below,
            limit=BELOW_MM,
            unit="mm",
        )


def gltf_units(declared: Declared) -> Iterator[Finding]:
    """Meshes of glTF in millimetres: the standard is metres, and importers that follow it scale again."""
    files = {}
    for link, shape in _meshes(declared):
        if shape.file and shape.file.lower().endswith((".glb", ".gltf")) and math.isclose(shape.scale[0], 1e-3, rel_tol=1e-6):
            files[shape.file] = link
    if files:
        first = next(iter(files))
        yield Finding(
            code="W_AUDIT_GLTF",
            where=files[first].where,
            parts=tuple(dict.fromkeys(link.name for link in files.values())),
            message=f"{counted(len(files), 'glTF mesh', 'glTF meshes')} in millimetres with scale 0.001, such as {first!r}; glTF is in metres, Y up.",
            hint="Write STL or OBJ, or glTF in metres; MuJoCo does not read glTF.",
            value=len(files),
            limit=0,
            cause="units",
        )


def _sizes(link: DeclaredLink) -> list[float]:
    """Return the sizes of visual and of collision shapes [mm]; if they differ, `visual_against_collision` reports it."""
    found = [[shape.mesh.vertices for shape in link.of(role) if shape.mesh is not None] for role in _ROLES]
    return [_diagonal(np.concatenate(points)) for points in found if points]


def _by_file(declared: Declared) -> dict[tuple[str, str], list[tuple[DeclaredLink, DeclaredShape]]]:
    found: dict[tuple[str, str], list[tuple[DeclaredLink, DeclaredShape]]] = {}
    for link in declared.links:
        for shape in link.shapes:
            if shape.problem:
                found.setdefault((shape.problem, shape.file or shape.where), []).append((link, shape))
    return found


def _meshes(declared: Declared) -> Iterator[tuple[DeclaredLink, DeclaredShape]]:
    for link in declared.links:
        for shape in link.shapes:
            if shape.mesh is not None:
                yield link, shape


def _rigid_with(declared: Declared, link: DeclaredLink) -> Iterator[DeclaredLink]:
    """Yield the links that are fixed to this one at the same pose: their shapes may be meant as its own."""
    yield link
    for joint in declared.joints:
        if joint.type == "fixed" and link.name in {joint.parent, joint.child}:
            other = joint.child if joint.parent == link.name else joint.parent
            if other in declared.by_name and not declared.by_name[other].of("visual"):
                yield declared.by_name[other]


def _fixed_to(declared: Declared, link: DeclaredLink) -> list[Body]:
    """Return the solids, in the link's frame, of the links to which it is fixed."""
    poses = declared.fixed_poses(link.name)
    meshes = [
        shape.mesh.transformed(T)
        for name, T in poses.items()
        if name != link.name
        for shape in (declared.by_name[name].of("visual") or declared.by_name[name].of("collision"))
        if shape.mesh is not None and len(shape.mesh.triangles) <= MOST_PIECE_TRIANGLES
    ]
    return [body for mesh in meshes[:MOST_PIECES] if (body := body_of(_closed(mesh))).fault is None]


def _solid_pieces(shapes: tuple[DeclaredShape, ...]) -> list[Body] | None:
    """Return the solid pieces of shapes; None if they are too many, or not solids, so that nothing can be concluded."""
    found: list[TriMesh] = []
    for shape in shapes:
        assert shape.mesh is not None
        mesh = _closed(shape.mesh)
        if not mesh.is_closed or len(mesh.triangles) > MOST_PIECE_TRIANGLES:
            return None
        found += mesh.components()
        if len(found) > MOST_PIECES:
            return None
    solids = [mesh for mesh in found if mesh.volume > FLAT_MM3]
    return [body_of(mesh) for mesh in solids if body_of(mesh).fault is None]


def _near(a: Body, b: Body) -> bool:
    low, high = np.maximum(a.mesh.bounds[0], b.mesh.bounds[0]), np.minimum(a.mesh.bounds[1], b.mesh.bounds[1])
    if (low - high > APART_MM).any():
        return False
    if surfaces_touch(a, b, _IDENTITY) or distance(a, b, _IDENTITY) <= APART_MM:
        return True
    return float((a.manifold ^ b.manifold).volume()) > FLAT_MM3  # one inside the other does not touch its surface


def _closed(mesh: TriMesh) -> TriMesh:
    """Return the mesh, welded if that is needed to close it."""
    return body_of(mesh).mesh


def _diagonal(points: np.ndarray) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))


_ROLES: Final[tuple[Role, ...]] = ("visual", "collision")
CHECKS = (unread_meshes, no_collision, broken_meshes, pieces, scale, visual_against_collision, base_below, gltf_units)
