"""articad's own files come back: with their records as they were, without them by fusing chains."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given as drawn
from hypothesis import settings
from hypothesis import strategies as st

from articad.assembly import Assembly
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.importers.mjcf import read_mjcf
from articad.importers.urdf import read_urdf
from articad.kinematics import declare
from articad.kinematics.configuration import Configuration
from articad.kinematics.joints import JointType
from articad.plan.resolve import Fit, Material, Waiver
from tests.assemblies import all_joint_kinds, closed, four_bar, geared_pair, random_configurations, random_tree

PAIRS: dict[str, tuple[Any, Any]] = {"urdf": (write_urdf, read_urdf), "mjcf": (write_mjcf, read_mjcf)}

ASSEMBLIES = {
    "all kinds": all_joint_kinds(),
    "geared": geared_pair(),
    "four-bar": four_bar((-3.0, 3.0)),
    "closed by a cylindrical": closed(lambda a, b: declare.cylindrical("d", a, b, travel=(-9, 9), angle="endless"), turned=True),
    "with promises": replace(
        geared_pair(),
        materials={"steel": Material("steel", 7850.0, "#8a9299", 0.6)},
        fits={"a": Fit(0.1, 0.4, None, "allowed")},
        waivers=(Waiver(("wheel_a", "rack"), 0.1, "teeth"),),
    ),
}


def round_trip(assembly: Assembly, form: str, folder: Path, **options: Any) -> Assembly:
    write, read = PAIRS[form]
    bundle = write(assembly, meshes="obj")
    bundle.write(folder)
    again: Assembly = read(folder / bundle.main, **options)
    return again


def assert_same(first: Assembly, again: Assembly) -> None:
    assert (again.name, again.ground, again.deflection) == (first.name, first.ground, first.deflection)
    assert list(again.parts) == list(first.parts)
    assert again.joints == first.joints
    assert again.mechanism.couplings == first.mechanism.couplings
    assert again.mechanism.T_ground == first.mechanism.T_ground
    assert (dict(again.materials), dict(again.fits), again.waivers) == (dict(first.materials), dict(first.fits), first.waivers)
    for name, part in first.parts.items():
        other = again.parts[name]
        assert dict(other.connectors) == dict(part.connectors)
        assert (other.color, other.material) == (part.color, part.material)
        assert [(shape.frame, shape.color) for shape in other.visuals] == [(shape.frame, shape.color) for shape in part.visuals]
        for shape, given in zip(other.visuals, part.visuals, strict=True):
            assert (shape.mesh.triangles == given.mesh.triangles).all()
            assert np.allclose(shape.mesh.vertices, given.mesh.vertices, rtol=1e-8, atol=1e-7)  # files hold nine digits
        assert other.mass is not None
        assert part.mass is not None
        assert other.mass.mass == part.mass.mass
        assert (other.mass.inertia == part.mass.inertia).all()
        assert other.solid is not None
        assert part.solid is not None
        assert (other.solid.volume, other.solid.area) == (part.solid.volume, part.solid.area)


@pytest.mark.parametrize("form", PAIRS)
@pytest.mark.parametrize("name", ASSEMBLIES)
def test_an_assembly_comes_back_identical(name: str, form: str, tmp_path: Path) -> None:
    first = ASSEMBLIES[name]
    again = round_trip(first, form, tmp_path)

    assert_same(first, again)
    q = first.mechanism.rest
    assert (again.poses(q).data == first.poses(q).data).all()


@settings(max_examples=20, deadline=None)
@drawn(seed=st.integers(0, 2**32 - 1), count=st.integers(2, 8), form=st.sampled_from(sorted(PAIRS)))
def test_random_trees_come_back_identical(seed: int, count: int, form: str, tmp_path_factory: Any) -> None:
    first = random_tree(seed, count)

    assert_same(first, round_trip(first, form, tmp_path_factory.mktemp("own")))


@pytest.mark.parametrize("form", PAIRS)
def test_what_comes_back_is_written_as_the_same_bytes(form: str, tmp_path: Path) -> None:
    write, _ = PAIRS[form]
    first = all_joint_kinds()

    assert dict(write(round_trip(first, form, tmp_path), meshes="obj").files) == dict(write(first, meshes="obj").files)


def same_places(first: Assembly, again: Assembly, q: Any, again_q: Any) -> float:
    """Largest difference of where the parts' meshes are; parts of foreign files keep other frames."""
    here = dict(zip(first.parts, first.poses(q), strict=True))
    there = dict(zip(again.parts, again.poses(again_q), strict=True))
    worst = 0.0
    for name, part in first.parts.items():
        a = (here[name] @ part.visuals[0].frame).apply(part.visuals[0].mesh.vertices)
        shape = (again.parts[name].visuals or again.parts[name].collisions)[0]
        b = (there[name] @ shape.frame).apply(shape.mesh.vertices)
        low, high = (np.array([f(points, axis=0) for f in (np.min, np.max)]) for points in (a, b))
        worst = max(worst, float(np.abs(low - high).max()))
    return worst


@pytest.mark.parametrize("form", PAIRS)
def test_chains_are_fused_back_without_records(form: str, tmp_path: Path) -> None:
    first = all_joint_kinds()
    again = round_trip(first, form, tmp_path, metadata=False, fuse=True)
    types = {joint.name: joint.type for joint in again.joints}
    expected = {joint.name: joint.type for joint in first.joints if joint.type is not JointType.FIXED}

    assert types | expected == types
    if form == "urdf":
        assert list(again.parts) == [link for link in again.parts if "__" not in link]
    for q in random_configurations(first, 4, 5):
        values = dict(first.mechanism.configuration(q).values)
        x, y, z, w = values["knob"]
        # a ball that is crossed backwards is written as its inverse: about turned axes in URDF, as the conjugate in MJCF
        values["knob"] = (z, y, x, w) if form == "urdf" else (-x, -y, -z, w)
        again_q = Configuration.of(again.joints, {name: value for name, value in values.items() if value}).columns
        assert same_places(first, again, q, again_q) < 1e-5  # MuJoCo keeps meshes in single precision


@pytest.mark.parametrize("form", PAIRS)
def test_masses_survive_without_records(form: str, tmp_path: Path) -> None:
    first = all_joint_kinds()
    again = round_trip(first, form, tmp_path, metadata=False, fuse=True)
    total = sum(part.mass.mass for part in first.parts.values() if part.mass)

    assert again.mass().mass == pytest.approx(total, rel=1e-9)
    for name in ("rod", "head", "nut"):
        mass, other = first.parts[name].mass, again.parts[name].mass
        assert mass is not None
        assert other is not None
        assert other.mass == pytest.approx(mass.mass, rel=1e-9)
        assert np.linalg.eigvalsh(other.inertia) == pytest.approx(np.linalg.eigvalsh(mass.inertia), rel=1e-6)


def test_couplings_come_back_from_mimics_and_equalities(tmp_path: Path) -> None:
    for form in PAIRS:
        again = round_trip(geared_pair(), form, tmp_path, metadata=False, fuse=True)
        q = np.array([0.4])
        assert len(again.drivers) == 1
        configuration = again.mechanism.configuration(q)
        a, b, s = (float(configuration[name][0]) for name in "abs")
        assert b == pytest.approx(-0.5 * a)
        assert s == pytest.approx(20 * b + 1)


def test_a_loop_closed_by_points_comes_back_as_a_loop(tmp_path: Path) -> None:
    again = round_trip(four_bar(), "mjcf", tmp_path, metadata=False, fuse=True)

    assert [joint.type for joint in again.mechanism.loop_joints] == [JointType.REVOLUTE]  # two points on one axis
    assert again.mechanism.mobility == 1


def test_ball_limits_come_back_as_the_cone(tmp_path: Path) -> None:
    again = round_trip(all_joint_kinds(), "urdf", tmp_path, metadata=False, fuse=True)
    head = next(joint for joint in again.joints if joint.name == "head")

    assert head.limits.cone == pytest.approx(math.pi / 3)


def test_welds_and_bodies_that_are_tied_come_back(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text("""<mujoco><worldbody><geom type="plane" size="1 1 1"/>
      <body name="a" pos="1 0 0"><geom size=".1"/><joint name="ja" axis="0 0 1"/></body>
      <body name="b" pos="1 1 0"><geom size=".1"/><joint name="jb" axis="0 0 1"/><joint name="kb" type="slide" axis="0 0 1" ref="0.5"/></body>
      <body name="c" pos="0 0 2"><geom type="ellipsoid" size=".1 .2 .3"/><joint name="jc" type="ball" range="0 1"/></body>
      </worldbody><equality>
      <weld body1="a" body2="b" name="w"/><connect body1="a" body2="c" anchor="0 0 0.1" name="p"/>
      <joint joint1="ja" polycoef="0.1 0 0 0 0"/><joint joint1="ja" joint2="jb" polycoef="0 0 1 0 0"/>
      <weld body1="a" body2="b" active="false"/>
      </equality></mujoco>""")
    again = read_mjcf(tmp_path / "a.xml", fuse=True)
    types = {joint.name: joint.type for joint in again.joints}

    assert (types["w"], types["p"], types["jc"]) == (JointType.FIXED, JointType.BALL, JointType.BALL)
    assert types["kb"] is JointType.CYLINDRICAL
    assert again.mechanism.rest_poses()["b"].translation == pytest.approx([1000, 1000, 0])
    assert [finding.where for finding in again.findings.of("W_IMPORT_DROPPED")] == [
        "equality.equality_2",
        "equality.equality_3",
        "equality.equality_4",
        "joints.jc",
        "parts.world",
    ]


def test_reference_values_are_kept(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text("""<mujoco><compiler angle="radian"/><worldbody><body name="a" pos="0 0 1"><geom size=".1"/>
      <joint name="j" type="slide" axis="0 0 1" ref="0.5" range="0.2 0.9" limited="true"/></body></worldbody></mujoco>""")
    again = read_mjcf(tmp_path / "a.xml")

    assert again.mechanism.rest == pytest.approx([500.0])
    assert again.at()["a"].translation == pytest.approx([0, 0, 1000])
    assert again.at(j=600.0)["a"].translation == pytest.approx([0, 0, 1100])


@pytest.mark.parametrize("form", PAIRS)
def test_an_edited_file_speaks_for_itself(form: str, tmp_path: Path) -> None:
    write, read = PAIRS[form]
    bundle = write(geared_pair())
    bundle.write(tmp_path)
    path = tmp_path / bundle.main
    text = path.read_text()
    old, new = ('lower="-0.1"', 'lower="-0.05"') if form == "urdf" else ('range="-0.1 0.1"', 'range="-0.05 0.1"')
    path.write_text(text.replace(old, new))
    edited = read(path)
    slide = next(joint for joint in edited.joints if joint.name == "s")

    assert edited.findings.codes == ("W_IMPORT_STALE",)
    assert slide.limits.lower == (-50.0,)
    path.write_text(text.replace("\n", "\n  ").replace("meshes/", "./meshes/"))
    assert not read(path).findings  # layout and file names say nothing


def test_what_is_tied_to_a_mocap_body_stays_free(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text("""<mujoco><worldbody><body name="hand" mocap="true" pos="1 0 0"/>
      <body name="a"><geom size=".1"/><joint name="j" axis="0 0 1"/></body></worldbody>
      <equality><weld body1="hand" body2="a" name="held"/></equality></mujoco>""")
    again = read_mjcf(tmp_path / "a.xml")

    assert [driver.name for driver in again.drivers] == ["j"]
    assert [finding.where for finding in again.findings.of("W_IMPORT_DROPPED")] == ["equality.held"]
