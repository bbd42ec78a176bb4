"""Exports have the same bytes on processors that round otherwise, although symmetric solids offer many equally good choices."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import manifold3d
import numpy as np
import pytest

from articad.assembly import Assembly
from articad.connectors.connector import Connector, Plane
from articad.connectors.se3 import SE3
from articad.export.gltf import write_glb
from articad.export.mjcf import write_mjcf
from articad.export.sdf import write_sdf
from articad.export.urdf import Loops, write_urdf
from articad.export.usd import write_usd
from articad.geometry.inscribed import inscribed
from articad.geometry.inscribed.surface import mesh_of
from articad.geometry.mass import MassProperties
from articad.geometry.part import Part
from articad.kernels.cache import BuildCache
from articad.kinematics import declare
from tests.assemblies import all_joint_kinds, four_bar, frame

ROOT = Path(__file__).resolve().parents[2]
Manifold = manifold3d.Manifold
OTHERS = (
    {"OPENBLAS_CORETYPE": "Prescott", "NPY_DISABLE_CPU_FEATURES": "X86_V3"},  # no AVX2 and no fused multiply-add
    {"OPENBLAS_CORETYPE": "Sandybridge"},
)
"""Variables by which the libraries of linear algebra and of arrays use the instructions of other processors."""
MASS = MassProperties(
    0.12, np.array([3.0, 1.0, 2.0]), np.array([[11.1022441, 1e-7, 2e-7], [1e-7, 11.1022440, 3e-7], [2e-7, 3e-7, 14.4413934]])
)
"""Of each part: nearly equal moments, whose axes any rounding turns."""


def solids() -> Iterator[tuple[str, manifold3d.Manifold]]:
    """Yield symmetric solids, as they are and turned; manifold3d computes them alike everywhere."""
    cylinder, cube = partial(Manifold.cylinder, center=True), partial(Manifold.cube, center=True)
    hole, post = cylinder(30, 3, 3, circular_segments=24), cube((8, 8, 40))
    plate = cube((60, 60, 8))
    for x in (-20, 20):
        for y in (-20, 20):
            plate -= hole.translate((x, y, 0))
    whole = {
        "plate": plate,
        "tray": cube((60, 40, 20)) - cube((54, 34, 20)).translate((0, 0, 4)),
        "cross": cube((60, 8, 8)) + cube((8, 60, 8)) + post,
        "cup": cylinder(30, 14, 14, circular_segments=48) - cylinder(30, 12, 12, circular_segments=48).translate((0, 0, 3)),
        "knob": Manifold.cylinder(12, 14, 11, 48) + Manifold.sphere(9, 32).translate((0, 0, 12)),
        "ring": cylinder(8, 20, 20, circular_segments=6) - cylinder(30, 9, 9, circular_segments=6),
    }
    for name, solid in whole.items():
        yield name, solid
        yield f"{name}_turned", solid.rotate((20, 35, 50)).translate((7, -3, 11))


def frames() -> Iterator[SE3]:
    """Yield frames that are given by random axes, mirrored in random planes, moved and drawn between."""
    rng = np.random.default_rng(3)
    for _ in range(300):
        o, z, x, n = rng.normal(size=(4, 3)) * 10.0
        given = SE3.from_axes(o, z, x - (x * z).sum() / (z * z).sum() * z)
        plane = Plane(o, n)
        mirrored = Connector("at", given).mirrored(plane.matrix).frame
        yield from (SE3.from_axes(o, z), given, mirrored, given @ mirrored.inverse(), SE3.from_axis_angle(n, 0.7, about=o))


def digests() -> dict[str, str]:
    """Return the digest of the pieces of each solid, and of the files of an assembly of all."""
    found, parts = {}, []
    for name, solid in solids():
        mesh = mesh_of(solid)
        made = inscribed(mesh)
        assert made is not None
        content = [piece.mesh.vertices.round(9).tobytes() + piece.mesh.triangles.tobytes() for piece in made.pieces]
        found[name] = hashlib.sha256(b"".join(content)).hexdigest()
        part = Part.from_mesh(name, mesh, connectors={"at": Connector("at", frame(at=(1, 2, 3), z=(1, 2, 3)))})
        parts.append(replace(part, solid=None, mass=MASS))
    base, *others = parts
    joints = [declare.revolute(f"turn_{one.name}", base["at"], one["at"], limits=(-1.0, 1.0)) for one in others]
    assembly = Assembly.from_parts("solids", parts=parts, joints=joints, ground=base.name)
    for product in (assembly, all_joint_kinds()):
        for write in (write_mjcf, write_urdf, write_usd, write_sdf):
            for file, written in write(product, cache=BuildCache(None)).files.items():
                found[f"{product.name} {write.__name__} {file}"] = hashlib.sha256(written).hexdigest()
        scene = write_glb(product)
        found[f"{product.name} write_glb"] = hashlib.sha256(scene.files[scene.main]).hexdigest()
    found["frames"] = hashlib.sha256(b"".join(frame.data.tobytes() for frame in frames())).hexdigest()
    loops: Loops
    for loops in ("isaac", "drake"):
        tree = write_urdf(four_bar(), loops=loops)
        found[loops] = hashlib.sha256(tree.files[tree.main]).hexdigest()
    return found


@pytest.fixture(scope="module")
def here() -> dict[str, str]:
    return digests()


@pytest.mark.parametrize("other", OTHERS, ids=lambda other: other["OPENBLAS_CORETYPE"])
def test_other_instructions_give_the_same_files(other: dict[str, str], here: dict[str, str]) -> None:
    command = [sys.executable, "-c", f"import json; from {__name__} import digests; print(json.dumps(digests()))"]
    done = subprocess.run(command, cwd=ROOT, env=os.environ | other, check=True, capture_output=True, text=True)
    there = json.loads(done.stdout)
    assert there.keys() == here.keys()
    assert [name for name in here if there[name] != here[name]] == []
