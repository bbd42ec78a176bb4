"""Everything that shows, samples, proves, animates or exports a pose says the same at the same values of the drivers.

Mechanisms whose loops and couplings stand on joints that drive; all drivers at once wherever the consumer can. Pinocchio and MuJoCo
read the files that are written, with the joint values of our configuration.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from articad.assembly import Assembly
from articad.certificates.certificate import constrained_joints, driver_names, mechanism_json
from articad.certificates.linkage import DriverTrack
from articad.certificates.verifier import PROOF, Checker
from articad.connectors.se3 import SE3
from articad.export.gltf import FAR_RAD, FRAMES, write_glb
from articad.interference import sweep as sampled
from articad.render.pictures import motion_frames
from articad.simulation import film
from articad.simulation.verdict import FilmFrame
from tests import moving_bases
from tests.engines import disagreement
from tests.export.test_gltf import parts_of, values
from tests.kinematics.linkages import mismatch

FloatArray = NDArray[np.float64]
SAME = 1e-9
each = pytest.mark.parametrize("make", moving_bases.ALL.values(), ids=moving_bases.ALL)


def some(assembly: Assembly, count: int = 4) -> FloatArray:
    """Return values of all drivers at once, within every limit."""
    rng, found = np.random.default_rng(5), list[FloatArray]()
    while len(found) < count:
        q = assembly.mechanism.rest + 0.4 * rng.uniform(-1, 1, assembly.mechanism.nq)
        if not assembly.mechanism.configuration(q).violations():
            found.append(q)
    return np.array(found)


def apart(T: SE3, other: SE3) -> float:
    return float(np.abs(T.matrix - other.matrix).max())


@each
def test_all_that_python_asks_agrees(make: Callable[[], Assembly]) -> None:
    assembly = make()
    mechanism, names = assembly.mechanism, [driver.name for driver in assembly.drivers]
    q = some(assembly)
    poses = assembly.poses(q)
    assert apart(assembly.solve(q).poses, poses) == 0.0
    for row, T in zip(q, poses, strict=True):
        assert max(mismatch(mechanism, row)) < SAME  # every joint meets, by arithmetic of the test's own
        by_name = dict(zip(names, row.tolist(), strict=True))
        assert apart(assembly.at(**by_name).stacked, T) < SAME
        for name, value in by_name.items():
            swept = assembly.drive(name, value, value, steps=1, at={k: v for k, v in by_name.items() if k != name})
            assert apart(swept.poses()[0], T) < SAME
        sampler = sampled.MotionSampler(assembly.scene(), mechanism)
        assert apart(assembly.poses(sampler.columns(by_name)), T) < SAME
        in_metres = {d.name: v / 1000 if d.unit == "mm" else v for d, v in zip(assembly.drivers, row.tolist(), strict=True)}
        shown = {item.name: item.T_ground for item in film._scene(assembly, FilmFrame(names[0], in_metres)).items}
        assert all(apart(shown[part], T[i]) < SAME for i, part in enumerate(mechanism.parts))


@each
def test_middles_of_certified_pieces_are_the_assemblys_configurations(make: Callable[[], Assembly]) -> None:
    mechanism = make().mechanism
    constrained = constrained_joints(mechanism)
    document = {
        "mechanism": mechanism_json(mechanism),
        "linkage": sorted(constrained),
        "drivers": driver_names(mechanism, constrained),
    }
    for k, driver in enumerate(mechanism.drivers):
        if driver.joint not in constrained:
            continue
        values = mechanism.rest[k] + np.array([-0.15, 0.1])
        way = DriverTrack(Checker(document, {PROOF: {}}), (driver.name,), ((float(values[0]), float(values[1])),))
        assert way.whole is not None
        for value in values.tolist():
            q = mechanism.rest.copy()
            q[k] = value
            wanted = dict(zip((c.name for c in mechanism.coordinates), mechanism.configuration(q).columns.tolist(), strict=True))
            found = way.at(np.array([value]))
            assert found is not None
            assert max(abs(wanted[name] - at) for name, at in found.items()) < SAME


@each
def test_pictures_and_animations_show_the_assemblys_poses(make: Callable[[], Assembly]) -> None:
    assembly = make()
    first = assembly.drivers[0]
    _, rows = motion_frames(assembly, first.joint, 3)
    assert rows[:, 0] == pytest.approx([first.lower, first.rest, first.upper])
    document, binary = parts_of(write_glb(assembly).files["gripper_arm.glb" if assembly.name == "gripper_arm" else f"{assembly.name}.glb"])
    (animation,) = (one for one in document["animations"] if one["name"] == first.joint)
    quarter = (FRAMES - 1) // 4  # of a whole wave from rest: the upper limit
    q = assembly.mechanism.rest.copy()
    q[0] = min(first.upper, first.rest + FAR_RAD)
    T = assembly.poses(q)
    nodes = [dict(node) for node in document["nodes"]]
    for channel in animation["channels"]:
        at = values(document, binary, animation["samplers"][channel["sampler"]]["output"])[quarter]
        nodes[channel["target"]["node"]][channel["target"]["path"]] = at.tolist()
    placed: dict[str, SE3] = {}

    def place(index: int, carrier: SE3) -> None:
        """Place a node and what it carries; lengths are m."""
        node = nodes[index]
        own = SE3.from_rotation(Rotation.from_quat(node.get("rotation", [0, 0, 0, 1])).as_matrix())
        here = carrier @ SE3.trans(*node.get("translation", [0, 0, 0])) @ own
        placed[node.get("name", "")] = here
        for child in node.get("children", []):
            place(child, here)

    first_part = next(i for i, node in enumerate(nodes) if node.get("name") == assembly.mechanism.ground)
    place(first_part, SE3.identity())
    for name, wanted in zip(assembly.parts, T, strict=True):
        in_ground = T[list(assembly.parts).index(assembly.mechanism.ground)].inverse() @ wanted
        assert np.abs(placed[name].translation - in_ground.translation / 1000).max() < 1e-6  # numbers of a GLB have 24 bits
        assert np.abs(placed[name].rotation - in_ground.rotation).max() < 1e-6


@each
def test_pinocchio_and_mujoco_read_the_same_poses_from_the_files(make: Callable[[], Assembly], tmp_path: Path) -> None:
    assembly = make()
    assert disagreement(assembly, tmp_path, some(assembly)) < SAME
