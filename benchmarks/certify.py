"""What certified motion costs: distance queries and seconds on the scenes of the design, beside the theoretical minimum.

    python benchmarks/certify.py

Each scene is proven twice: as `certify` does it, which looks at pairs of pieces of the two surfaces and cuts pieces and range, and
by whole distances alone. For a line at distance d(q) and reach R, two-sided intervals need at least ∫ R dq / 2 d(q) distances; the
goal is 1.3 times that. Seconds are of the process, so that others on the machine count little. The checker's time stands beside.
"""

from __future__ import annotations

import json
import math
import resource
import tempfile
import time
from dataclasses import replace
from pathlib import Path

import manifold3d as m3
import numpy as np

from articad.certificates.certificate import Certificate, certify
from articad.certificates.verifier import verify_file
from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder, tube
from articad.interference.check import check_pose
from articad.interference.cover import cover_line
from articad.interference.motion import Chain, Route
from articad.interference.surface import Surface, surface_distance
from articad.interference.work import WorkBudget
from articad.kinematics.joints import Joint, JointLimits, JointType
from articad.kinematics.mechanism import Mechanism

GIB = 2**30
RATIO = 1.3  # of queries to the least that could be: the goal


def revolute(name: str, parent: str, child: str, lower: float = -math.pi, upper: float = math.pi) -> Joint:
    frame = SE3.identity()
    return Joint(
        name=name,
        type=JointType.REVOLUTE,
        parent=parent,
        child=child,
        parent_connector="p",
        child_connector="c",
        T_parent_connector=frame,
        T_child_connector=frame,
        limits=JointLimits((lower,), (upper,)),
        rest=(max(lower, min(0.0, upper)),),
    )


def mesh_of(manifold: m3.Manifold) -> TriMesh:
    mesh = manifold.to_mesh64()
    return TriMesh(np.array(mesh.vert_properties)[:, :3], np.array(mesh.tri_verts).astype(np.int32))


def by_distances(a: TriMesh, b: TriMesh, joint: Joint) -> tuple[float, int, float, float]:
    """Walk the whole range with distances alone; return seconds, queries, the least that could be, and how far it came."""
    chain = Chain(Route(("a", "b"), (joint,)), [joint.name])
    here, there = Surface.of(a), Surface.of(b)
    reach = float(chain.reach(here.points, there.points)[0])
    (freedom,) = chain.freedoms

    def distance(values: object) -> float:
        return surface_distance(here, there, chain.matrix(values))  # type: ignore[arg-type]

    budget = WorkBudget(600.0)
    started = time.perf_counter()
    cover = cover_line(distance, (freedom.lower, freedom.upper), freedom.rest, reach=reach, budget=budget)
    seconds = time.perf_counter() - started
    # only between what was reached, so that a contact does not make the integral infinite
    samples = np.linspace(cover.lower, cover.upper, 400)
    gaps = np.maximum([distance((q,)) for q in samples], 1e-3)
    return seconds, budget.queries, float(np.trapezoid(reach / (2 * gaps), samples)), math.degrees(cover.upper)


def scenes() -> dict[str, tuple[TriMesh, TriMesh, Joint, float]]:
    """Return scenes with the seconds that each may take."""
    bar = box(200, 10, 10, center=False).transformed(SE3.from_translation([0.0, -5, -5]))
    post = cylinder(0.1, 60, 64).transformed(SE3.from_axis_angle([0, 0, 1], 0.8) @ SE3.from_translation([150.0, 0, 0]))
    rotor, ring = mesh_of(m3.Manifold.cylinder(20, 100, 100, 256, center=True)), tube(100.5, 120, 20, 256)
    bush = mesh_of(m3.Manifold.cube([30, 30, 12], center=True) - m3.Manifold.cylinder(40, 8.25, 8.25, 64, center=True))
    rod = m3.Manifold.cylinder(400, 8, 8, 64, center=True)
    for z in (-120, 0, 120):
        player = m3.Manifold.cube([22, 90, 22], center=True).translate([0, -30, z + 30])
        rod += player
    return {
        "bar against a post of 0.2 mm": (post, bar, revolute("turn", "a", "b", 0.0, 2.0), 2.0),
        "football rod, full turn": (bush, mesh_of(rod), revolute("spin", "a", "b"), 2.0),
        "rotor in a ring, R 100, gap 0.5": (ring, rotor, revolute("spin", "a", "b"), 20.0),
    }


def main() -> None:
    """Print a row per scene, then the memory that many large parts take."""
    columns = f"{'certify s':>10}{'goal s':>7}{'pieces':>9}{'checker s':>10}{'distances s':>12}{'queries':>8}{'least':>7}{'ratio':>6}{'goal':>5}{'to deg':>10}"
    print(f"{'scene':<32}{columns}")
    for name, (a, b, joint, goal) in scenes().items():
        mechanism = Mechanism(("a", "b"), "a", [joint])
        started = time.process_time()
        certificate = certify({"a": a, "b": b}, mechanism)
        seconds = time.process_time() - started
        refuted, checked = followed(certificate)
        walked, queries, least, reached = by_distances(a, b, joint)
        print(
            f"{name:<32}{seconds:>10.3f}{goal:>7.0f}{certificate.queries:>9}{checked:>10.3f}{walked:>12.3f}{queries:>8}{least:>7.0f}"
            f"{queries / max(least, 1.0):>6.2f}{RATIO:>5}{reached:>10.4f}"
        )
        for line in [*map(str, certificate.findings), *refuted]:
            print(f"    {line}")
    memory()


def followed(certificate: Certificate) -> tuple[list[str], float]:
    """Have the checker follow a certificate; return why it is refuted, and the seconds that took."""
    with tempfile.TemporaryDirectory() as name:
        file = Path(name) / "certificate.json"
        file.write_text(json.dumps(certificate.to_json()))
        for mesh, content in certificate.mesh_files().items():
            file.with_name(mesh).write_bytes(content)
        started = time.process_time()
        return verify_file(file, file.parent), time.process_time() - started


def memory() -> None:
    """Check 50 different parts of 20k triangles each at rest, then certify 49 of them on hinges of the first; print the peak."""
    meshes, poses = {}, {}
    for k in range(50):
        solid = m3.Manifold.cube([20, 20, 20], center=True) - m3.Manifold.cylinder(40, 5 + 0.01 * k, 5 + 0.01 * k, 64, center=True)
        meshes[f"p{k}"] = mesh_of(solid.refine_to_length(0.74))
        poses[f"p{k}"] = SE3.from_translation([20.0 * (k % 10), 20.0 * (k // 10), 0.0])
    count = sum(len(mesh.triangles) for mesh in meshes.values()) // len(meshes)
    started = time.process_time()
    report = check_pose(meshes, poses, joints=[])
    seconds = time.process_time() - started
    print(f"\n50 parts of {count} triangles, touching: {len(report.pairs)} pairs in {seconds:.1f} s, ok {report.ok}, {peak()}")
    joints = []
    for k in range(1, 50):
        hinge = revolute(f"j{k}", "p0", f"p{k}")
        joints.append(replace(hinge, T_parent_connector=SE3.from_translation([32.0 * (k % 10), 32.0 * (k // 10), 0.0])))
    started = time.process_time()
    certificate = certify(meshes, Mechanism(tuple(meshes), "p0", joints))
    seconds = time.process_time() - started
    print(f"49 of them on hinges: {len(certificate.claims)} claims in {seconds:.1f} s, ok {certificate.ok}, {peak()}")


def peak() -> str:
    """Return the most memory that the process held so far."""
    return f"peak {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / GIB:.2f} GiB (goal < 1)"


if __name__ == "__main__":
    main()
