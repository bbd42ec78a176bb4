"""Small joints and bodies for the tests of interference."""

from __future__ import annotations

import io
import json
import math
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from articad.certificates.certificate import Certificate
from articad.certificates.verifier import PROOF, verify_file
from articad.connectors import SE3
from articad.geometry import TriMesh
from articad.kinematics.joints import Joint, JointLimits, JointType

IDENTITY = SE3.identity()


@dataclass(frozen=True)
class Waiver:
    parts: tuple[str, str]
    max_depth: float
    reason: str


@dataclass(frozen=True)
class Fit:
    gap_min: float | None = None
    gap_max: float | None = None
    within: float | None = None
    contact: str | None = None


def at(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> SE3:
    return SE3.from_translation(np.array([x, y, z]))


def joint(
    name: str,
    kind: str,
    parent: str,
    child: str,
    *,
    at_parent: SE3 = IDENTITY,
    at_child: SE3 = IDENTITY,
    lower: tuple[float, ...] = (),
    upper: tuple[float, ...] = (),
    rest: tuple[float, ...] | None = None,
    cone: float | None = None,
    lead: float = 0.0,
) -> Joint:
    joint_type = JointType(kind)
    count = 0 if joint_type is JointType.BALL else len(joint_type.coordinates)
    return Joint(
        name=name,
        type=joint_type,
        parent=parent,
        child=child,
        parent_connector="p",
        child_connector="c",
        T_parent_connector=at_parent,
        T_child_connector=at_child,
        limits=JointLimits(lower or (-math.pi,) * count, upper or (math.pi,) * count, cone=cone),
        rest=joint_type.neutral if rest is None else rest,
        lead=lead,
    )


def fixed(name: str, parent: str, child: str) -> Joint:
    return joint(name, "fixed", parent, child)


def random_rotation(rng: np.random.Generator) -> SE3:
    q = rng.normal(size=4)
    return SE3.from_quaternion(q / np.linalg.norm(q))


def manifold_mesh(manifold: object) -> TriMesh:
    """Turn a manifold3d solid into a mesh."""
    mesh = manifold.to_mesh64()  # type: ignore[attr-defined]
    return TriMesh(np.array(mesh.vert_properties)[:, :3], np.array(mesh.tri_verts).astype(np.int32))


def block_with_bore(side: float, height: float, radius: float, segments: int, *, phase: float = 0.0) -> TriMesh:
    """A square block about z with a prismatic bore whose vertices lie on `radius`."""
    import manifold3d as m3

    bore = m3.Manifold.cylinder(3 * height, radius, radius, segments, center=True).rotate([0, 0, math.degrees(phase)])
    return manifold_mesh(m3.Manifold.cube([side, side, height], center=True) - bore)


def soup(mesh: TriMesh) -> TriMesh:
    return TriMesh(mesh.vertices[mesh.triangles].reshape(-1, 3), np.arange(3 * len(mesh.triangles), dtype=np.int32).reshape(-1, 3))


def without_triangle(mesh: TriMesh, which: int = 0) -> TriMesh:
    return TriMesh(mesh.vertices, np.delete(mesh.triangles, which, axis=0))


def placed(T: SE3, points: ArrayLike) -> np.ndarray:
    return T.apply(np.asarray(points, dtype=np.float64))


def verified(document: Mapping[str, Any], certificate: Certificate, **changed: bytes) -> list[str]:
    """Return why a certificate is refuted that says `document`, beside the certificate's own meshes and proof, some of them changed."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, content in {**certificate.mesh_files(), **{f"{part}.npz": other for part, other in changed.items()}}.items():
            (folder / file).write_bytes(content)
        (folder / "certificate.json").write_text(json.dumps(document))
        return verify_file(folder / "certificate.json", folder)


def saved(**arrays: Any) -> bytes:
    """Return a file of arrays."""
    stream = io.BytesIO()
    np.savez(stream, **arrays)
    return stream.getvalue()


def proof_of(certificate: Certificate) -> dict[str, Any]:
    """Return the arrays of a certificate's proof."""
    with np.load(io.BytesIO(certificate.mesh_files()[f"{PROOF}.npz"])) as arrays:
        return dict(arrays)
