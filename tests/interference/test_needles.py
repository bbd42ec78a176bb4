"""Needles, triangles whose corners lie on a line but for rounding, as Booleans leave them: prover and checker agree about what they prove.

The normal of a needle is rounding and nothing else. It separates other surfaces as well as any direction, if it is the same one in both.
"""

from __future__ import annotations

from itertools import product

import manifold3d as m3
import numpy as np
import pytest

from articad.certificates.certificate import certify
from articad.geometry import TriMesh
from articad.kinematics.joints import Joint
from articad.kinematics.mechanism import Mechanism
from tests.interference.mechanisms import at, joint, manifold_mesh, verified

GAP_MM = 0.3
KINDS = {
    "revolute": {"lower": (-0.1,), "upper": (0.1,)},
    "slider": {"lower": (-2.0,), "upper": (2.0,)},
    "cylindrical": {"lower": (-2.0, -0.1), "upper": (2.0, 0.1)},
    "ball": {"cone": 0.05},
}


def with_needles(mesh: TriMesh, rng: np.random.Generator, share: float) -> TriMesh:
    """Return a closed mesh in which triangles ABC are AMC, MBC and the needle ABM, with M on AB within rounding."""
    vertices, triangles = [*mesh.vertices], []
    for a, b, c in mesh.triangles.tolist():
        if rng.random() > share:
            triangles.append((a, b, c))
            continue
        start, end = mesh.vertices[a], mesh.vertices[b]
        near = 10.0 ** rng.uniform(-8, -0.5)
        vertices.append(start + near * (end - start))
        middle = len(vertices) - 1
        triangles += [(a, middle, c), (middle, b, c), (a, b, middle)]
    return TriMesh(np.array(vertices), np.array(triangles, dtype=np.int32))


def body(rng: np.random.Generator) -> m3.Manifold:
    """Return a random convex body of about 20 mm around the origin."""
    directions = rng.normal(size=(24, 3))
    return m3.Manifold.hull_points(rng.uniform(8, 12, (24, 1)) * directions / np.linalg.norm(directions, axis=1, keepdims=True))


@pytest.mark.parametrize(("kind", "seed"), [*product(KINDS, range(8))])
def test_the_checker_confirms_proofs_about_needles(kind: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    one, other = body(rng), body(rng)
    apart = other.translate([30.0, 0.0, 0.0])
    near = apart.translate([GAP_MM - one.min_gap(apart, 50.0), 0.0, 0.0])
    meshes = {"base": with_needles(manifold_mesh(one), rng, 0.5), "arm": with_needles(manifold_mesh(near), rng, 0.5)}
    middle = at(*(float(value) for value in near.to_mesh64().vert_properties[:, :3].mean(axis=0)))
    moving: Joint = joint("moves", kind, "base", "arm", at_parent=middle, at_child=middle, **KINDS[kind])  # type: ignore[arg-type]

    certificate = certify(meshes, Mechanism(("base", "arm"), "base", [moving]))

    assert not certificate.findings.of("E_CERTIFICATE_REFUTED"), certificate.findings
    assert verified(certificate.to_json(), certificate) == []
