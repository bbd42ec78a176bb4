"""USD is read back by usd-core where it is installed: bodies, masses, limits, and frames that meet as the joints say."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.export.usd import write_usd
from articad.geometry.part import Part
from articad.geometry.shapes import sphere
from articad.kernels.cache import BuildCache
from articad.kinematics import declare
from articad.kinematics.joints import Coupling, JointType
from articad.plan.resolve import Material
from tests.assemblies import all_joint_kinds, block, closed, four_bar, frame, geared_pair

ASSEMBLIES = {
    "all kinds": all_joint_kinds(),
    "four-bar": four_bar((-3.0, 3.0)),
    "closed by a planar": closed(lambda a, b: declare.planar("d", a, b, x=(-9, 9), y=(-9, 9), angle="endless")),
}


def text_of(assembly: Assembly) -> str:
    bundle = write_usd(assembly)
    return bundle.files[bundle.main].decode()


def test_every_part_is_a_body_and_every_joint_a_prim() -> None:
    assembly = all_joint_kinds()
    text = text_of(assembly)

    assert all(f'def Xform "{name}" (' in text for name in assembly.parts)
    assert all(f' "{joint.name}"' in text for joint in assembly.joints)
    assert text.count("PhysicsArticulationRootAPI") == 1
    assert text.count("excludeFromArticulation") == 0
    assert text_of(four_bar()).count("excludeFromArticulation") == 1


def test_limits_are_degrees_and_metres_and_other_degrees_are_locked() -> None:
    text = text_of(all_joint_kinds())
    hinge = text.partition('def PhysicsRevoluteJoint "hinge"')[2].partition("}")[0]
    drawer = text.partition('def PhysicsPrismaticJoint "drawer"')[2].partition("}")[0]
    rod = text.partition('def PhysicsJoint "rod"')[2].partition("}")[0]
    wheel = text.partition('def PhysicsRevoluteJoint "wheel"')[2].partition("}")[0]

    assert f"lowerLimit = {math.degrees(-1.0)!r}" in hinge
    assert "lowerLimit = 0.01\n" in drawer
    assert "lowerLimit = -inf" in wheel
    assert "limit:transX:physics:low = 1\n" in rod
    assert "limit:transZ:physics:low = -0.05" in rod
    assert "limit:rotZ:physics:high = inf" in rod


@pytest.mark.parametrize("lead", [2.0, -2.0])
def test_the_slide_of_a_screw_has_the_travel_of_its_turn(lead: float) -> None:
    """Newton locks the degrees of a joint that have no limit, and with it the whole loop of a screw jack."""
    bed, nut = block("bed", on=frame()), block("nut", on=frame())
    screw = declare.screw("screw", bed["on"], nut["on"], lead=lead, limits=(-3 * math.tau, 5 * math.tau))
    text = text_of(Assembly.from_parts("press", parts=[bed, nut], joints=[screw], ground="bed"))
    rows = text.partition('def PhysicsJoint "screw"')[2].partition("\n        }")[0]
    limits = {key: float(value) for key, value in re.findall(r"limit:(\w+:physics:\w+) = (\S+)", rows)}

    assert len(limits) == 12
    assert (limits["rotZ:physics:low"], limits["rotZ:physics:high"]) == pytest.approx((-1080.0, 1800.0))
    assert (limits["transZ:physics:low"], limits["transZ:physics:high"]) == pytest.approx(sorted((-0.003 * lead, 0.005 * lead)))


def test_losses_of_couplings_and_screws_are_refused() -> None:
    """NewtonMimicAPI holds the wheels, which both turn; a pinion turns while its rack slides."""
    assert {loss.where for loss in write_usd(geared_pair()).losses if loss.refused} == {"couplings.pinion"}
    assert {loss.where for loss in write_usd(all_joint_kinds()).losses if loss.refused} == {"joints.nut", "joints.bolt"}


@pytest.mark.parametrize("seed", range(12))
def test_chains_and_stars_of_couplings_lead_from_what_follows_nothing(seed: int) -> None:
    """Newton refuses a leader that follows another. The relations are those of the mechanism, a coupling of an angle and a length apart."""
    random = np.random.default_rng(seed)
    count = 7
    base = block("base", (10.0, 10.0, 10.0), **{f"seat_{i}": frame(at=(100.0 * i, 0, 0)) for i in range(count)})
    parts = [block(f"part_{i}", root=frame()) for i in range(count)]
    kinds = random.permutation(["revolute"] * 4 + ["slider"] * 3)
    joints = [
        getattr(declare, kind)(f"joint_{i}", base[f"seat_{i}"], part["root"], limits=(-0.5, 0.5))
        for i, (kind, part) in enumerate(zip(kinds, parts, strict=True))
    ]
    couplings = []
    for i in range(1, count):  # a random tree, each edge in a random direction
        a, b = random.permutation([f"joint_{random.integers(i)}", f"joint_{i}"])
        couplings.append(
            Coupling(f"coupling_{i}", "gear", str(a), str(b), float(random.choice([-2, -0.5, 0.5, 2])), float(random.normal()))
        )
    assembly = Assembly.from_parts("coupled", parts=[base, *parts], joints=joints, ground="base", couplings=couplings)

    bundle = write_usd(assembly)

    text = bundle.files[bundle.main].decode()
    rows = {}
    for name, kind in zip((f"joint_{i}" for i in range(count)), kinds, strict=True):
        prim = text.partition(f'Joint "{name}"')[2].partition("\n        }")[0]
        if "NewtonMimicAPI" in prim:
            offset, ratio = (float(prim.partition(f"mimicCoef{i} = ")[2].split()[0]) for i in (0, 1))
            unit = math.pi / 180 if kind == "revolute" else 1000.0
            rows[name] = (prim.partition("joints/")[2].partition(">")[0], ratio, offset * unit)
    assert not {leader for leader, _, _ in rows.values()} & rows.keys()
    mixed = {f"couplings.{c.name}" for c in couplings if kinds[int(c.a[6:])] != kinds[int(c.b[6:])]}
    assert {loss.where for loss in bundle.losses if loss.refused} == mixed
    assert len(rows) == len(couplings) - len(mixed)
    configuration = assembly.mechanism.configuration(random.normal(size=len(assembly.drivers)))
    for name, (leader, ratio, offset) in rows.items():
        assert configuration[name][0] == pytest.approx(ratio * configuration[leader][0] + offset, abs=1e-6)


def test_parts_without_mass_or_shape_and_names_that_change(tmp_path: Path) -> None:
    base, bare = block("Base 1", a=frame()), Part.without_geometry("b", block("b", a=frame()).connectors)
    assembly = Assembly.from_parts(
        "x y", parts=[base, bare], joints=[declare.revolute("j", base["a"], bare["a"], limits=(0, 1))], ground="Base 1"
    )
    bundle = write_usd(assembly)

    assert bundle.main == "x_y.usda"
    assert {"parts.Base 1", "name", "parts.b"} <= {loss.where for loss in bundle.losses}
    assert "float physics:mass = 0.0001" in text_of(assembly)


def test_the_same_assembly_is_the_same_bytes() -> None:
    assert write_usd(all_joint_kinds()).files == write_usd(all_joint_kinds()).files


@pytest.mark.engines
@pytest.mark.parametrize("name", ASSEMBLIES)
def test_usd_core_reads_bodies_masses_and_joints_that_meet_at_rest(name: str, tmp_path: Path) -> None:
    Usd: Any = pytest.importorskip("pxr.Usd", reason="usd-core is an extra")
    UsdGeom: Any = pytest.importorskip("pxr.UsdGeom")
    UsdPhysics: Any = pytest.importorskip("pxr.UsdPhysics")
    assembly = ASSEMBLIES[name]
    bundle = write_usd(assembly)
    bundle.write(tmp_path)
    stage = Usd.Stage.Open(str(tmp_path / bundle.main))
    root = stage.GetDefaultPrim().GetPath()
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0
    rest = assembly.mechanism.rest_poses()
    bodies = {}
    for part_name, part in assembly.parts.items():
        prim = stage.GetPrimAtPath(root.AppendChild(part_name))
        matrix = np.array(UsdGeom.Xformable(prim).ComputeLocalToWorldTransform(Usd.TimeCode.Default())).T
        bodies[part_name] = matrix
        assert prim.HasAPI(UsdPhysics.RigidBodyAPI)
        assert part.mass is not None
        assert UsdPhysics.MassAPI(prim).GetMassAttr().Get() == pytest.approx(part.mass.mass, rel=1e-6)
        assert np.allclose(matrix[:3, :3], rest[part_name].rotation, atol=1e-9)
        assert np.allclose(matrix[:3, 3], rest[part_name].translation / 1000, atol=1e-9)
    configuration = assembly.mechanism.configuration(assembly.mechanism.rest)
    above = {edge.part: edge.parent for edge in assembly.mechanism.tree.edges}
    for joint in assembly.joints:
        prim = UsdPhysics.Joint(stage.GetPrimAtPath(root.AppendPath(f"joints/{joint.name}")))
        first, second = (relation.GetTargets()[0].name for relation in (prim.GetBody0Rel(), prim.GetBody1Rel()))
        assert {first, second} == {joint.parent, joint.child}
        if joint not in assembly.mechanism.loop_joints:
            assert above[second] == first  # Newton loads no other tree
        near, far = (
            bodies[first] @ matrix_of(prim.GetLocalPos0Attr().Get(), prim.GetLocalRot0Attr().Get()),
            bodies[second] @ matrix_of(prim.GetLocalPos1Attr().Get(), prim.GetLocalRot1Attr().Get()),
        )
        motion = joint.motion(configuration[joint.name]).matrix
        motion[:3, 3] /= 1000
        if joint.type is JointType.BALL and first == joint.child:  # its frames are not turned, so its quaternion is the inverse
            motion = np.asarray(np.linalg.inv(motion), dtype=np.float64)
        assert np.allclose(near @ motion, far, atol=1e-6)  # local frames are single precision in UsdPhysics


@pytest.fixture
def stage(tmp_path: Path) -> Any:
    """A hinge with velocity, damping and friction, a wheel that turns with it, and a drawer of another material, as usd-core reads them."""
    Usd: Any = pytest.importorskip("pxr.Usd", reason="usd-core is an extra")
    steel, rubber = Material("steel", 7850.0, "#888888", 0.2), Material("rubber", 1100.0, "#222222", 0.9)
    base = block("base", a=frame(), b=frame(at=(100, 0, 0)), c=frame(at=(0, 100, 0)))
    arm, wheel, drawer = (block(name, a=frame()) for name in ("arm", "wheel", "drawer"))
    ball = Part.from_mesh("ball", sphere(10, 24), density=7850.0, connectors={"a": Connector("a", SE3.identity())})
    joints = [
        declare.revolute("arm", base["a"], arm["a"], limits=(-1, 2)),
        declare.revolute("wheel", base["b"], wheel["a"], limits="endless"),
        declare.slider("drawer", base["c"], drawer["a"], limits=(0, 50)),
        declare.fixed("knob", arm["a"], ball["a"]),
    ]
    joints[0] = replace(joints[0], velocity=(1.5,), damping=(0.4,), friction=(3.0,))
    joints[2] = replace(joints[2], velocity=(250.0,))
    parts = [replace(one, material="rubber" if one is drawer else "steel") for one in (base, arm, wheel, drawer, ball)]
    assembly = Assembly.from_parts(
        "model",
        parts=parts,
        joints=joints,
        ground="base",
        couplings=[Coupling("mesh", "gear", "arm", "wheel", -2.0, 0.5)],
    )
    assembly = replace(assembly, materials={"steel": steel, "rubber": rubber})
    bundle = write_usd(assembly, cache=BuildCache(tmp_path / "cache"))
    bundle.write(tmp_path)
    return Usd.Stage.Open(str(tmp_path / bundle.main))


@pytest.mark.engines
def test_surfaces_have_their_friction_and_pictures_one_material(stage: Any) -> None:
    from pxr import UsdPhysics, UsdShade

    frictions = {}
    for prim in stage.Traverse():
        if prim.HasAPI(UsdPhysics.CollisionAPI):
            material = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial("physics")[0]
            surface = UsdPhysics.MaterialAPI(material)
            frictions[prim.GetPath().pathString.split("/")[2]] = (
                surface.GetDynamicFrictionAttr().Get(),
                surface.GetStaticFrictionAttr().Get(),
            )
        elif prim.GetTypeName() == "Mesh":
            assert prim.HasAPI(UsdShade.MaterialBindingAPI)
            material, relationship = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()
            assert len(relationship.GetTargets()) == 1
            assert material.ComputeSurfaceSource()[0].GetShaderId() == "UsdPreviewSurface"

    assert frictions.keys() == {"base", "arm", "wheel", "drawer", "ball"}
    assert frictions["drawer"] == pytest.approx((0.9, 0.9))
    assert frictions["arm"] == pytest.approx((0.2, 0.2))


@pytest.mark.engines
def test_couplings_velocities_damping_and_friction_of_joints_are_in_their_units(stage: Any) -> None:
    def value(joint: str, name: str) -> Any:
        return stage.GetPrimAtPath(f"/model/joints/{joint}").GetAttribute(name).Get()

    wheel = stage.GetPrimAtPath("/model/joints/wheel")
    assert "NewtonMimicAPI" in wheel.GetMetadata("apiSchemas").GetAppliedItems()
    assert [str(path) for path in wheel.GetRelationship("newton:mimicJoint").GetTargets()] == ["/model/joints/arm"]
    assert value("wheel", "newton:mimicCoef1") == -2.0
    assert value("wheel", "newton:mimicCoef0") == pytest.approx(math.degrees(0.5))
    assert value("arm", "newton:velocityLimit") == pytest.approx(math.degrees(1.5))
    assert value("arm", "physxJoint:maxJointVelocity") == pytest.approx(math.degrees(1.5))
    assert value("arm", "newton:damping") == pytest.approx(0.4 / 1000 / math.degrees(1.0))  # N·mm·s/rad to N·m·s/°
    assert value("arm", "newton:friction") == pytest.approx(3.0 / 1000)
    assert value("drawer", "newton:velocityLimit") == pytest.approx(0.25)


@pytest.mark.engines
def test_every_shape_has_an_extent_and_meshes_have_normals_that_point_out(stage: Any) -> None:
    from pxr import UsdGeom, UsdPhysics

    shapes = [prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Gprim)]
    for prim in shapes:
        boundable = UsdGeom.Boundable(prim)
        wanted = UsdGeom.Boundable.ComputeExtentFromPlugins(boundable, 0.0)
        assert np.allclose(boundable.GetExtentAttr().Get(), wanted, atol=1e-7)
        assert prim.GetParent().GetName() == ("collisions" if prim.HasAPI(UsdPhysics.CollisionAPI) else "visuals")
        if not prim.IsA(UsdGeom.Mesh):
            continue
        primvar = UsdGeom.PrimvarsAPI(prim).GetPrimvar("normals")
        points, places = np.array(prim.GetAttribute("points").Get()), np.array(prim.GetAttribute("faceVertexIndices").Get())
        normals = np.array(primvar.ComputeFlattened())
        corners = points[places].reshape(-1, 3, 3)
        flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        drawn = prim.GetParent().GetName() == "visuals"
        assert primvar.GetInterpolation() == ("faceVarying" if drawn else "uniform")
        normals = normals if drawn else np.repeat(normals, 3, axis=0)
        assert len(normals) == len(places)
        assert np.allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-3)
        assert ((normals.reshape(-1, 3, 3) * flat[:, None]).sum(axis=2) > 0).all()

    assert {prim.GetTypeName() for prim in shapes} >= {"Mesh", "Cube"}


@pytest.mark.engines
def test_parts_and_materials_have_labels_and_equal_meshes_are_written_once(tmp_path: Path) -> None:
    """Two balls of one mesh: usd-core composes the points of both from one abstract prim, which no traversal meets."""
    from pxr import Usd

    base = block("base", a=frame(), b=frame(at=(100, 0, 0)))
    balls = [replace(Part.from_mesh(name, sphere(10, 24), density=7850.0, connectors=base.connectors), material="steel") for name in "pq"]
    joints = [declare.revolute(ball.name, base[at], ball["a"], limits=(-1, 2)) for at, ball in zip("ab", balls, strict=True)]
    bundle = write_usd(
        Assembly.from_parts("model", parts=[base, *balls], joints=joints, ground="base"), cache=BuildCache(tmp_path / "cache")
    )
    bundle.write(tmp_path)
    stage = Usd.Stage.Open(str(tmp_path / bundle.main))
    one, other = (stage.GetPrimAtPath(f"/model/{name}/visuals/visual_0") for name in "pq")

    assert np.array_equal(one.GetAttribute("points").Get(), other.GetAttribute("points").Get())
    assert len(one.GetAttribute("points").Get()) > 100
    assert bundle.files[bundle.main].count(b"point3f[] points") < sum(prim.GetTypeName() == "Mesh" for prim in stage.Traverse())
    assert not [prim for prim in stage.Traverse() if prim.GetPath().HasPrefix("/model/meshes")]
    assert list(stage.GetPrimAtPath("/model/p").GetAttribute("semantics:labels:class").Get()) == ["p"]
    bound = one.GetRelationship("material:binding").GetTargets()[0]
    assert list(stage.GetPrimAtPath(bound).GetAttribute("semantics:labels:material").Get()) == ["steel"]


def matrix_of(position: Any, rotation: Any) -> Any:
    x, y, z = rotation.GetImaginary()
    T = SE3.from_quaternion(np.array([x, y, z, rotation.GetReal()]) / math.hypot(x, y, z, rotation.GetReal()), [float(p) for p in position])
    return T.matrix
