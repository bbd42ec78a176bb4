"""Random variants of products, each surface point within its part's tolerance of its nominal place, and random products to vary."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from articad.certificates.certificate import Certificate
from articad.certificates.clearing import shortest_between
from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder, sphere
from articad.interference.body import body_of
from articad.interference.overlap import measured
from articad.interference.scene import Scene, relatives
from articad.interference.sweep import MotionSampler
from articad.kinematics.joints import Joint
from articad.kinematics.mechanism import Mechanism
from tests.interference.mechanisms import at, fixed, joint, random_rotation

FloatArray = NDArray[np.float64]

SURE_MM3 = 1e-6  # common volume that rounding does not explain
PURE, COMMON = 0.6, 0.7  # shares: of variants that move one way and as far as possible, and of products whose parts move along one line


@dataclass(frozen=True)
class Hit:
    """Two parts of a variant that overlap, and the pose."""

    parts: tuple[str, str]
    pose: Mapping[str, float]
    volume: float


def varied(mesh: TriMesh, share: float, way: FloatArray, rng: np.random.Generator) -> TriMesh:
    """Move every vertex by at most `share` [mm]: the part shifted or stretched along a way, grown or shrunk, and waves, in random parts.

    Points between the vertices move by no more, since they move linearly between these.
    """
    normals = np.zeros_like(mesh.vertices)
    for corner in range(3):
        np.add.at(normals, mesh.triangles[:, corner], mesh.normals_of_twice_area)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    along = mesh.vertices @ way
    middle = (along.min() + along.max()) / 2
    sides = np.sign(along - middle) if rng.random() < 0.5 else np.ones(len(along))
    waves = np.sin(mesh.vertices @ (rng.normal(size=3) * 3 / np.ptp(along)) + rng.uniform(0, 2 * np.pi))
    parts = np.array([1.0, 0.0, 0.0]) if rng.random() < PURE else rng.dirichlet([0.8, 0.4, 0.4])
    size, grown = (1.0 if rng.random() < PURE else rng.uniform()), rng.choice([-1.0, 1.0], size=2)
    moved = size * (parts[0] * grown[0] * sides[:, None] * way + (parts[1] * grown[1] + parts[2] * waves[:, None]) * normals)
    return TriMesh(mesh.vertices + share * moved, mesh.triangles)


def hits(certificate: Certificate, mechanism: Mechanism, count: int, seed: int, *, poses: int = 4) -> list[Hit]:
    """Return what collides in so many random variants of a whole product, each at random poses of any two drivers.

    Pairs of which the certificate claims something else than clearance are left out.
    """
    assert certificate.tolerances is not None
    rng, shares = np.random.default_rng(seed), certificate.tolerances.shares
    ruled = set(certificate.tolerances.rows)
    sampler = MotionSampler(Scene.of(certificate.meshes, mechanism.joints), mechanism)
    ranges, found = sampler.ranges(), list[Hit]()
    _, rest, _ = sampler.placed([{}])
    turned = {name: rest[0, mechanism.parts.index(name), :3, :3] for name in certificate.meshes}
    for _ in range(count):
        line = _line(rng) if rng.random() < COMMON else None
        meshes = {
            name: varied(mesh, shares[name], _line(rng) if line is None else line @ turned[name], rng)
            for name, mesh in certificate.meshes.items()
        }
        scene = Scene.of(meshes, mechanism.joints)
        points = []
        for _ in range(poses if ranges else 1):
            chosen = rng.permutation(len(ranges))[:2]
            ends = rng.random() < 0.3
            points.append({ranges[n].name: _drawn(rng, ranges[n].lower, ranges[n].upper, ends=bool(ends)) for n in chosen.tolist()})
        kept, matrices, _ = sampler.placed(points)
        names = [name for name in mechanism.parts if name in meshes]
        at_parts = [mechanism.parts.index(name) for name in names]
        for row, point in enumerate(kept.tolist()):
            if not _inside(sampler, points[point]):
                continue
            placed = scene.at({name: SE3.from_matrix(matrices[row, column]) for name, column in zip(names, at_parts, strict=True)})
            for (a, b), T, is_apart in placed.near():
                if frozenset((a, b)) in ruled or is_apart:
                    continue
                common = measured(scene.bodies[a], scene.bodies[b], T)
                if common.volume > SURE_MM3:
                    found.append(Hit((a, b), points[point], common.volume))
    return found


def _line(rng: np.random.Generator) -> FloatArray:
    """Return a random direction, half of the time an axis."""
    way = np.eye(3)[rng.integers(3)] if rng.random() < 0.5 else rng.normal(size=3)
    return np.asarray(way / np.linalg.norm(way))


def _drawn(rng: np.random.Generator, low: float, high: float, *, ends: bool) -> float:
    return float(rng.choice([low, high])) if ends else float(rng.uniform(low, high))


def _inside(sampler: MotionSampler, point: Mapping[str, float]) -> bool:
    """Return whether a pose keeps every ball within its cone."""
    ranges = [freedom for freedom in sampler.ranges() if freedom.name in point]
    if not ranges:
        return True
    return bool(sampler.within_cones(ranges, np.array([[point[freedom.name] for freedom in ranges]]))[0])


def met(certificate: Certificate, mechanism: Mechanism, parts: tuple[str, str], pose: Mapping[str, float]) -> float:
    """Return the common volume of two parts at a pose, in the variant that moves each by its tolerance towards the other [mm³]."""
    assert certificate.tolerances is not None
    shares = certificate.tolerances.shares
    sampler = MotionSampler(Scene.of(certificate.meshes, mechanism.joints), mechanism)
    _, matrices, _ = sampler.placed([dict(pose)])
    A, B = (matrices[:, mechanism.parts.index(name), :3] for name in parts)
    T = relatives(A, B)[0]
    a, b = (certificate.meshes[name] for name in parts)
    P, Q = a.vertices[a.triangles], (b.vertices @ T[:, :3].T + T[:, 3])[b.triangles]
    i, j = (index.ravel() for index in np.meshgrid(np.arange(len(P)), np.arange(len(Q)), indexing="ij"))
    gaps, ways = shortest_between(P[i], Q[j])
    way = ways[int(np.argmin(gaps))]
    nearer = a.transformed(at(*(shares[parts[0]] * way)))
    other = TriMesh(b.vertices - shares[parts[1]] * (way @ T[:, :3]), b.triangles)
    return measured(body_of(nearer), body_of(other), T).volume


def random_product(seed: int) -> tuple[dict[str, TriMesh], list[Joint]]:
    """Return a block with two or three solids close to it and to each other, on random joints with short ranges, one perhaps fixed."""
    rng = np.random.default_rng(seed)
    meshes = {"block": _random_solid(rng)}
    joints: list[Joint] = []
    for n in range(int(rng.integers(2, 4))):
        name, parent = f"part_{n}", str(rng.choice(list(meshes)))
        solid = _random_solid(rng).transformed(random_rotation(rng))
        way = rng.normal(size=3)
        way /= np.linalg.norm(way)
        gap, far = float(rng.uniform(0.3, 2.5)), 400.0
        low, high = 0.0, far
        while high - low > 1e-3:  # the nearest place along a line at which it keeps the gap to everything
            middle = (low + high) / 2
            near = solid.transformed(at(*(middle * way)))
            low, high = (low, middle) if all(_apart(near, other, gap) for other in meshes.values()) else (middle, high)
        meshes[name] = solid.transformed(at(*(high * way)))
        kind = str(rng.choice(["revolute", "slider", "cylindrical", "ball", "fixed"]))
        where = SE3.from_translation(rng.uniform(-30, 30, size=3)) @ random_rotation(rng)
        if kind == "fixed":
            joints.append(fixed(f"joint_{n}", parent, name))
            continue
        turn, slide = float(rng.uniform(0.002, 0.05)), float(rng.uniform(0.05, 1.0))
        spans = {"revolute": (turn,), "slider": (slide,), "cylindrical": (slide, turn), "ball": ()}[kind]
        cone = turn if kind == "ball" else None
        joints.append(
            joint(
                f"joint_{n}", kind, parent, name, at_parent=where, at_child=where,
                lower=tuple(-span for span in spans), upper=spans, cone=cone,
            )
        )  # fmt: skip
    return meshes, joints


def _random_solid(rng: np.random.Generator) -> TriMesh:
    a, b, c = rng.uniform(8, 60, size=3)
    return [box(a, b, c), cylinder(a / 2, b, 12), sphere(a / 2, 10)][int(rng.integers(3))]


def _apart(a: TriMesh, b: TriMesh, gap: float) -> bool:
    from articad.interference.surface import surface_distance, whole_surface

    if measured(body_of(a), body_of(b), np.eye(4)[:3]).volume > 0:
        return False
    return surface_distance(whole_surface(a), whole_surface(b), np.eye(4)) > gap
