from __future__ import annotations

import math
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.errors import UnrepresentableError
from articad.export.convex import whole_hull
from articad.export.features import features_of, solid_enough
from articad.export.freecad_job import Job
from articad.export.losses import MECHANISM_FORMATS, TABLE, losses_of
from articad.export.mjcf import write_mjcf
from articad.export.plan import write_plan
from articad.export.sdf import write_sdf
from articad.export.urdf import write_urdf
from articad.export.usd import write_usd
from articad.geometry.mass import MassProperties
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part, Shape
from articad.geometry.shapes import box, tube
from articad.kinematics import declare
from articad.kinematics.joints import Coupling, JointType
from articad.plan.resolve import Material
from tests.assemblies import all_joint_kinds, block, frame, geared_pair

WRITERS: dict[str, Any] = {"urdf": write_urdf, "mjcf": write_mjcf, "sdf": write_sdf, "usd": write_usd}


def pair(joint: Any, **child: Any) -> Assembly:
    base, part = block("base", a=frame()), block("part", a=frame(at=(0, 0, 100)))
    return Assembly.from_parts("pair", parts=[base, replace(part, **child)], joints=[joint(base["a"], part["a"])], ground="base")


def losses(assembly: Assembly, writer: str) -> list[str]:
    return [f"{loss.where}: {loss.lost}" for loss in WRITERS[writer](assembly).losses]


JOINTS: dict[str, Any] = {
    "fixed": lambda a, b: declare.fixed("j", a, b),
    "revolute": lambda a, b: declare.revolute("j", a, b, limits=(-1, 1)),
    "revolute.endless": lambda a, b: declare.revolute("j", a, b, limits="endless"),
    "slider": lambda a, b: declare.slider("j", a, b, limits=(-1, 1)),
    "cylindrical": lambda a, b: declare.cylindrical("j", a, b, travel=(-1, 1), angle=(-1, 1)),
    "ball": lambda a, b: declare.ball("j", a, b, cone=1.0, twist=(-1, 1)),
    "ball.free": lambda a, b: declare.ball("j", a, b, cone=math.pi),
    "ball.wide": lambda a, b: declare.ball("j", a, b, cone=1.5),
    "screw": lambda a, b: declare.screw("j", a, b, lead=1.0, limits=(-1, 1)),
    "planar": lambda a, b: declare.planar("j", a, b, x=(-1, 1), y=(-1, 1), angle="endless"),
    "universal": lambda a, b: declare.universal("j", a, b, a=(-1, 1), b=(-1, 1)),
}


def test_the_table_has_every_joint_kind_and_every_format() -> None:
    assert set(JointType) <= TABLE.keys()
    assert all(set(MECHANISM_FORMATS) <= row.keys() or not set(MECHANISM_FORMATS) & row.keys() for row in TABLE.values())
    assert set(MECHANISM_FORMATS) == WRITERS.keys()
    assert all(TABLE[kind].keys() >= {"freecad", "plan"} for kind in JOINTS)
    assert all(row.becomes for rows in TABLE.values() for row in rows.values())


@pytest.mark.parametrize(("kind", "writer"), list(product(JOINTS, WRITERS)))
def test_a_loss_of_a_joint_kind_is_always_reported(kind: str, writer: Any) -> None:
    row = TABLE[kind][writer]

    assert losses(pair(JOINTS[kind]), writer) == ([f"joints.j: {row.lost}"] if row.lost else [])


@pytest.mark.parametrize("kind", JOINTS)
def test_a_loss_of_a_joint_kind_in_freecad_is_always_reported(kind: str, tmp_path: Path) -> None:
    job = Job(pair(JOINTS[kind]), tmp_path)
    job.to_json()
    row = TABLE[kind]["freecad"]
    meshes = [f"parts.{part}: {TABLE['freecad.mesh']['freecad'].lost}" for part in ("base", "part")]

    found = [f"{loss.where}: {loss.lost}" for loss in job.losses]
    assert found == [*([f"joints.j: {row.lost}"] if row.lost else []), *meshes]


def test_a_coupling_of_freecad_is_a_loss(tmp_path: Path) -> None:
    job = Job(geared_pair(), tmp_path)
    job.to_json()

    assert [loss.where for loss in job.losses if loss.refused] == ["couplings.mesh", "couplings.pinion"]


@pytest.mark.parametrize(("kind", "writer"), list(product(JOINTS, WRITERS)))
def test_strict_refuses_what_changes_motion(kind: str, writer: Any) -> None:
    row = TABLE[kind][writer]
    if not row.refused:
        WRITERS[writer](pair(JOINTS[kind]), strict=True)
        return
    with pytest.raises(UnrepresentableError) as error:
        WRITERS[writer](pair(JOINTS[kind]), strict=True)
    assert error.value.joint == "joints.j"
    assert error.value.findings.codes == ("E_UNREPRESENTABLE",)


@pytest.mark.parametrize("writer", WRITERS)
def test_half_open_and_endless_slides_are_reported(writer: str) -> None:
    half = replace(declare.revolute("j", *_ends(), limits=(0, 1)), limits=replace(JOINTS["slider"](*_ends()).limits, upper=(math.inf,)))
    endless = declare.cylindrical("j", *_ends(), travel="endless", angle=(0, 1))

    assert losses(pair(lambda *_: half), writer) == (
        ["joints.j: the joint is endless in that direction"] if writer in {"urdf", "mjcf"} else []
    )
    assert losses(pair(lambda *_: endless), writer) == ([f"joints.j: {TABLE['slide.endless']['urdf'].lost}"] if writer == "urdf" else [])


def _ends() -> Any:
    return block("base", a=frame())["a"], block("part", a=frame(at=(0, 0, 100)))["a"]


def test_a_stated_velocity_is_lost_in_mjcf_only() -> None:
    assembly = pair(lambda a, b: replace(JOINTS["revolute"](a, b), velocity=(1.0,)))

    assert not losses(assembly, "urdf")
    assert losses(assembly, "mjcf") == ["joints.j: MJCF has no limit on a joint's velocity"]


@pytest.mark.parametrize("writer", WRITERS)
def test_a_moving_part_without_mass_is_reported_and_refused(writer: Any) -> None:
    assembly = pair(JOINTS["revolute"], mass=None)

    assert losses(assembly, writer) == ["parts.part: the mass of a moving part is not known"]
    with pytest.raises(UnrepresentableError):
        WRITERS[writer](assembly, strict=True)
    assert not losses(pair(JOINTS["fixed"], mass=None), writer)


@pytest.mark.parametrize("writer", WRITERS)
def test_a_part_without_shape_loses_nothing(writer: Any) -> None:
    base, part = block("base", a=frame()), block("part", a=frame())
    bare = Part.without_geometry("part", part.connectors, part.mass)
    assembly = Assembly.from_parts("p", parts=[base, bare], joints=[JOINTS["revolute"](base["a"], part["a"])], ground="base")

    assert not losses(assembly, writer)


def test_friction_is_lost_in_urdf_and_written_in_mjcf() -> None:
    assembly = pair(JOINTS["revolute"], material="rubber")
    assembly = replace(assembly, materials={"rubber": Material("rubber", 1000.0, "#000000", 0.9)})

    assert [loss.where for loss in write_urdf(assembly).losses] == ["parts.part"]
    assert not write_mjcf(assembly).losses
    assert b'friction="0.9 0.005 0.0001"' in write_mjcf(assembly).files["pair.xml"]


@pytest.mark.parametrize("writer", WRITERS)
def test_names_that_change_are_reported(writer: Any) -> None:
    base, part = block("Base!", a=frame()), block("a/b", a=frame(at=(0, 0, 100)))
    joint = replace(JOINTS["revolute"](base["a"], part["a"]), name="j <1>")
    assembly = Assembly.from_parts('my "arm"', parts=[base, part], joints=[joint], ground="Base!")

    bundle = WRITERS[writer](assembly)

    assert [loss.where for loss in bundle.losses] == ["parts.Base!", "parts.a/b", "joints.j <1>", "name"]
    assert bundle.main.startswith("my_arm.")
    assert set(bundle.files) - {bundle.main} == (set() if writer == "usd" else {"meshes/Base.stl"})  # both blocks are one mesh


def test_hulls_that_overlap_at_rest_are_excluded_in_mjcf_and_reported_in_both() -> None:
    """Two cups, one around the other without touching: their hulls overlap."""
    base = block("base", a=frame(), b=frame())
    outer, inner = block("outer", (100, 100, 100), a=frame()), block("inner", (50, 50, 50), a=frame())
    joints = [declare.revolute("o", base["a"], outer["a"], limits=(-1, 1)), declare.revolute("i", base["b"], inner["a"], limits=(-1, 1))]
    assembly = Assembly.from_parts("cups", parts=[base, outer, inner], joints=joints, ground="base")

    mjcf = write_mjcf(assembly)

    assert [loss.where for loss in mjcf.losses] == ["parts.outer+inner"]
    assert b'<exclude body1="outer" body2="inner"/>' in mjcf.files["cups.xml"]
    assert [loss.where for loss in write_urdf(assembly).losses] == ["parts.outer+inner"]


def test_carriers_stand_between_a_pair_that_urdf_readers_would_skip() -> None:
    base, part = block("base", a=frame()), block("part", a=frame())
    assembly = Assembly.from_parts("p", parts=[base, part], joints=[JOINTS["cylindrical"](base["a"], part["a"])], ground="base")

    assert [loss.where for loss in write_urdf(assembly).losses] == ["parts.base+part"]
    assert not write_mjcf(assembly).losses


def test_couplings_that_tie_twice_are_lost_in_urdf() -> None:
    geared = geared_pair()
    mechanism = geared.mechanism
    twice = Assembly.from_parts(
        "twice",
        parts=geared.parts.values(),
        joints=mechanism.joints,
        couplings=[*mechanism.couplings, Coupling("again", "linear", "a", "s", -10.0, 1.0)],
        ground="base",
    )

    assert [(loss.where, loss.refused) for loss in write_urdf(twice).losses] == [
        ("couplings.mesh", False),
        ("couplings.pinion", False),
        ("couplings.again", True),
    ]


@pytest.mark.parametrize("writer", ["mjcf", "sdf"])
def test_a_part_named_like_the_root_of_a_format_gets_another_name(writer: str) -> None:
    base, part = block("world", a=frame()), block("part", a=frame(at=(0, 0, 100)))
    assembly = Assembly.from_parts("p", parts=[base, part], joints=[JOINTS["revolute"](base["a"], part["a"])], ground="world")
    bundle = WRITERS[writer](assembly)

    assert [loss.where for loss in bundle.losses] == ["parts.world"]
    assert b'name="world_2"' in bundle.files[bundle.main]
    assert not write_urdf(assembly).losses


@pytest.mark.parametrize("writer", WRITERS)
def test_an_inertia_that_no_body_has_is_reported_and_the_nearest_is_written(writer: str) -> None:
    needle = MassProperties(2.0, np.zeros(3), np.diag([1.0, 1.0, 9.0]))
    assembly = pair(JOINTS["revolute"], mass=needle)

    assert losses(assembly, writer) == ["parts.part: the inertia as given, which is physically impossible and which engines refuse"]
    with pytest.raises(UnrepresentableError):
        WRITERS[writer](assembly, strict=True)


@pytest.mark.parametrize("writer", WRITERS)
def test_what_is_flat_is_thickened_to_collide_with(writer: str) -> None:
    square = TriMesh(np.array([[0, 0, 0], [9, 0, 0], [9, 9, 0], [0, 9, 0]], dtype=float), np.array([[0, 1, 2], [0, 2, 3]]))
    assembly = pair(JOINTS["revolute"], visuals=(), collisions=(Shape(square),))

    assert losses(assembly, writer) == ["parts.part: a surface without thickness, with which engines cannot collide"]
    (thick,) = solid_enough(assembly.parts["part"])
    assert thick.mesh.volume == pytest.approx(10 * 10 * 1)
    assert solid_enough(assembly.parts["base"]) == assembly.parts["base"].visuals


def test_features_without_loss_report_nothing() -> None:
    assert losses_of("mjcf", []) == ()


@pytest.mark.parametrize("writer", ["urdf", "mjcf"])
def test_hulls_to_collide_with_are_written_and_their_error_told(writer: str) -> None:
    base = replace(block("base", a=frame()), visuals=(Shape(tube(20, 30, 10)),), collisions=(Shape(tube(20, 30, 10)),))
    part = block("part", a=frame(at=(0, 0, 100)))
    assembly = Assembly.from_parts("p", parts=[base, part], joints=[JOINTS["revolute"](base["a"], part["a"])], ground="base")
    bundle = WRITERS[writer](assembly, collision="hull")

    assert [(loss.where, loss.kept) for loss in bundle.losses] == [("parts.base", "a convex hull for collision (80 % more volume)")]
    assert len([path for path in bundle.files if path.endswith(".stl")]) == 4
    with pytest.raises(UnrepresentableError):
        WRITERS[writer](assembly, collision="hull", strict=True)


def test_the_hull_of_an_open_mesh_has_no_known_error() -> None:
    solid = box(10, 10, 10)

    assert whole_hull(TriMesh(solid.vertices, solid.triangles[:-1])).more == 0
    assert whole_hull(solid).pieces[0].mesh.volume == pytest.approx(1000)


@pytest.mark.parametrize("kind", JOINTS)
def test_a_plan_holds_every_joint_kind(kind: str) -> None:
    assert TABLE[kind]["plan"].lost == ""
    assert [loss.where for loss in write_plan(pair(JOINTS[kind])).losses] == ["parts", "parts.base", "parts.part"]


def test_a_plan_tells_what_it_has_no_words_for() -> None:
    endless = replace(JOINTS["slider"](*_ends()), limits=declare.revolute("j", *_ends(), limits="endless").limits)
    capable = replace(JOINTS["universal"](*_ends()), effort=(1.0, 2.0))

    assert ("joints.j", TABLE["plan.endless"]["plan"].lost) in [
        (loss.where, loss.lost) for loss in write_plan(pair(lambda *_: endless)).losses
    ]
    assert ("joints.j", TABLE["plan.capacity"]["plan"].lost) in [
        (loss.where, loss.lost) for loss in write_plan(pair(lambda *_: capable)).losses
    ]
    with pytest.raises(UnrepresentableError, match="shapes"):
        write_plan(pair(JOINTS["fixed"]), strict=True)


def test_every_feature_of_an_assembly_has_a_row_for_a_plan() -> None:
    plan_only = {key for key in TABLE if key.startswith("plan.")}

    assert all(
        "plan" in TABLE[feature.key] for feature in features_of(all_joint_kinds()) if not feature.key.startswith(("limits", "slide"))
    )
    assert all(set(TABLE[key]) == {"plan"} for key in plan_only)
