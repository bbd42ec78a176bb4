"""Interference, mass and mesh files beside their peers: one full check, a 60-step sweep, mass properties, writing meshes.

    python benchmarks/interference.py [--parts 10] [--triangles 2000] [--curved] [--out FILE]

The scene is a chain of links with pins in bores, 0.1 mm clear: neighbours are always near and never overlap. Its flat faces are cut
into as many triangles as are asked for, far more than they need, and articad makes use of that; with `--curved` all faces are waved
by a hundredth of a millimetre, so that every triangle is needed. Raw FCL is given the meshes as they are.
"""

from __future__ import annotations

import argparse
import math
import sys
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path

import fcl
import manifold3d as m3
import numpy as np
import trimesh

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from articad.connectors import SE3
from articad.geometry import TriMesh, write_glb, write_obj, write_stl
from articad.interference.body import make_bvh
from articad.interference.check import check_scene
from articad.interference.overlap import volume
from articad.interference.scene import Scene
from articad.interference.sweep import MotionSampler
from articad.kinematics.joints import Joint, JointLimits, JointType
from articad.kinematics.mechanism import Mechanism
from benchmarks.timing import Goal, Table, measure, report

STEPS = 60
LINK_MM, BORE_MM, CLEAR_MM, HEIGHT_MM = 100.0, 6.0, 0.1, 8.0
WAVE_MM = 0.01  # of a curved link's faces: links of neighbouring layers are 0.05 mm apart


def link(triangles: int, *, pins: bool, curved: bool = False) -> TriMesh:
    """Return a link with two pins or two bores, refined to about so many triangles."""
    solid = m3.Manifold.cube([LINK_MM, 21, HEIGHT_MM]).translate([0, -10.5, 0])
    for x in (0.0, LINK_MM):
        solid += m3.Manifold.cylinder(HEIGHT_MM, 15, 15, 48).translate([x, 0, 0])
    for x in (0.0, LINK_MM):
        if pins:
            solid += m3.Manifold.cylinder(2 * HEIGHT_MM, BORE_MM - CLEAR_MM, BORE_MM - CLEAR_MM, 48).translate([x, 0, 0])
        else:
            solid -= m3.Manifold.cylinder(3 * HEIGHT_MM, BORE_MM, BORE_MM, 48).translate([x, 0, -HEIGHT_MM])
    low, high = 0.1, 60.0
    for _ in range(18):
        middle = math.sqrt(low * high)
        low, high = (middle, high) if solid.refine_to_length(middle).num_tri() > triangles else (low, middle)
    mesh = solid.refine_to_length(high).to_mesh64()
    vertices = np.array(mesh.vert_properties)[:, :3]
    if curved:
        vertices += WAVE_MM * np.sin(3.0 * vertices[:, [1, 2, 0]] + 2.0 * vertices[:, [2, 0, 1]])
    return TriMesh(vertices, np.array(mesh.tri_verts).astype(np.int32))


def chain(parts: int, triangles: int, *, curved: bool = False) -> tuple[Scene, Mechanism]:
    shapes = [link(triangles, pins=True, curved=curved), link(triangles, pins=False, curved=curved)]
    names = [f"p{i}" for i in range(parts)]
    joints = []
    for i in range(1, parts):
        frame = SE3.from_translation([LINK_MM, 0.0, (HEIGHT_MM + 0.05) * (1 if i % 2 else -1)])
        rest = 0.0 if i == 1 else 0.9 * math.sin(1.7 * i) + (0.6 if parts <= 10 else 0.15 if parts <= 50 else 0.0)  # none curls up
        limits = JointLimits((0.0,), (2 * math.pi * (STEPS - 1) / STEPS,)) if i == 1 else JointLimits((-3.0,), (3.0,))
        joints.append(
            Joint(
                name=f"j{i}",
                type=JointType.REVOLUTE,
                parent=names[i - 1],
                child=names[i],
                parent_connector="p",
                child_connector="c",
                T_parent_connector=frame,
                T_child_connector=SE3.identity(),
                limits=limits,
                rest=(rest,),
            )
        )
    scene = Scene.of({name: shapes[i % 2] for i, name in enumerate(names)}, joints, deflection=0.01)
    return scene, Mechanism(tuple(names), names[0], joints)


def raw_fcl(scene: Scene, mechanism: Mechanism, count: int = STEPS) -> list[list[tuple[object, object]]]:
    """Return for each step the pairs of FCL objects whose boxes meet, placed beforehand."""
    q = np.tile(mechanism.rest, (STEPS, 1))
    q[:, 0] = np.linspace(0, 2 * math.pi * (STEPS - 1) / STEPS, STEPS)
    models = {mesh: make_bvh(mesh.vertices, mesh.triangles) for mesh in set(scene.meshes.values())}
    steps = []
    for at in range(count):
        poses = dict(zip(mechanism.parts, mechanism.poses(q[at]), strict=True))
        placed = {
            name: fcl.CollisionObject(models[mesh], fcl.Transform(poses[name].rotation, poses[name].translation))
            for name, mesh in scene.meshes.items()
        }
        steps.append([(placed[a], placed[b]) for a, b in scene.candidates(poses)])
    return steps


def collide(steps: list[list[tuple[object, object]]]) -> None:
    for step in steps:
        for a, b in step:
            fcl.collide(a, b, fcl.CollisionRequest(), fcl.CollisionResult())


def fresh(scene: Scene) -> Scene:
    """Return the scene with nothing made yet of its meshes."""
    copies = {mesh: TriMesh(mesh.vertices, mesh.triangles) for mesh in set(scene.meshes.values())}
    return replace(scene, meshes={name: copies[mesh] for name, mesh in scene.meshes.items()})


def booleans(scene: Scene, poses: Mapping[str, SE3]) -> None:
    """Measure the common volume of every pair whose turned boxes meet: what a check by booleans alone would cost at least."""
    for (a, b), T_a_b, apart in scene.at(poses).near():
        if not apart:
            volume(scene.bodies[a], scene.bodies[b], T_a_b)


def interference(parts: int, triangles: int, *, curved: bool = False) -> list[Table]:
    scene, mechanism = chain(parts, triangles, curved=curved)
    poses = mechanism.rest_poses()
    steps = raw_fcl(scene, mechanism)
    count = max(len(mesh.triangles) for mesh in scene.meshes.values())
    large = triangles > 5000
    one = measure(
        {
            "articad": lambda: check_scene(scene, poses),
            "raw fcl": partial(collide, steps[:1]),
            "booleans of all pairs that are near": lambda: booleans(scene, poses),
            "articad, meshes it has not seen": lambda: check_scene(fresh(scene), poses),
            "raw fcl, meshes it has not seen": lambda: collide(raw_fcl(scene, mechanism, 1)),
        },
        rounds=7,
    )
    asked = {body.manifold_triangles for body in scene.bodies.values()}
    turn = measure(
        {
            "articad": lambda: MotionSampler(scene, mechanism).run(["j1"], steps=STEPS, together=False, samples=0),
            "raw fcl": partial(collide, steps),
        },
        rounds=3,
    )
    check_goal = 0.7 if parts <= 10 and not large else 1.1
    sweep_goal = 0.27 if large else 0.15 if parts <= 10 else 0.09
    title = f"{parts} links of {count} triangles{', curved' if curved else ''}"
    note = f"articad asks solids of {' and '.join(map(str, sorted(asked)))} triangles"
    return [
        Table(f"one full check, {title}", one, (Goal("articad", "raw fcl", at_most=check_goal),), (note,)),
        Table(
            f"{STEPS}-step sweep, {title}, with volumes and containment",
            turn,
            () if curved else (Goal("articad", "raw fcl", at_most=sweep_goal),),
        ),
    ]


def geometry() -> list[Table]:
    mesh = link(20000, pins=True)
    v, f = mesh.vertices, mesh.triangles

    def theirs() -> trimesh.Trimesh:
        return trimesh.Trimesh(v, f, process=False)

    def their_mass() -> object:
        peer = theirs()
        return peer.volume, peer.center_mass, peer.moment_inertia

    mass = measure({"articad": lambda: TriMesh(v, f).solid_integrals(), "trimesh": their_mass})
    tables = [Table(f"mass properties, {len(f)} triangles", mass, (Goal("articad", "trimesh", at_least=6.0),))]
    for kind, write, goal in (("stl", write_stl, 0.8), ("obj", write_obj, 0.25), ("glb", write_glb, 0.8)):
        seconds = measure({"articad": partial(_written, write, v, f), "trimesh": partial(_exported, theirs, kind)})
        tables.append(Table(f"writing {kind}, {len(f)} triangles", seconds, (Goal("articad", "trimesh", at_most=goal),)))
    return tables


def _written(write: object, v: np.ndarray, f: np.ndarray) -> object:
    return write(TriMesh(v, f))  # type: ignore[operator]


def _exported(make: object, kind: str) -> object:
    return make().export(file_type=kind)  # type: ignore[operator]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--parts", type=int, default=10)
    parser.add_argument("--triangles", type=int, default=2000)
    parser.add_argument("--curved", action="store_true")
    parser.add_argument("--out")
    options = parser.parse_args()
    tables = interference(options.parts, options.triangles, curved=options.curved)
    return report(tables if options.curved else [*tables, *geometry()], options.out)


if __name__ == "__main__":
    main()
