"""The other formats: MJCF with its filters, STEP with its products, and our own assemblies and exports."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.auditing.examine import AuditOptions, audit_assembly, audit_file
from articad.auditing.many import audit_folder, models_below
from articad.auditing.mesh_references import MeshReferences
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.export.freecad import write_freecad
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part
from articad.geometry.shapes import box
from articad.importers.reading import Folder
from articad.importers.step import read_step
from articad.kernels.step_assembly import StepPart, StepReader, _parts
from articad.kinematics import declare
from articad.plan.resolve import Waiver
from tests.assemblies import all_joint_kinds
from tests.audit import defects

PLACES = {"a": SE3.identity(), "b": SE3.trans(-10, 0, 0)}
QUICK = AuditOptions(engines=False, budget=5.0)
FULL = AuditOptions(budget=5.0)

MJCF = """<mujoco><compiler angle="radian" autolimits="true"/><worldbody>
<body name="a" pos="0 0 0.1"><joint name="slide" type="slide" axis="1 0 0" range="-0.01 0.01"/><geom name="box" type="box" size="0.05 0.05 0.05"/></body>
<body name="b" pos="{x} 0 0.1"><joint name="turn" type="hinge" axis="1 0 0" range="-1 1"/>{b}</body>
</worldbody>{rest}</mujoco>"""
BALL = '<geom type="sphere" size="0.05" {mask}/>'


def mjcf(folder: Path, *, x: float, mask: str = "", rest: str = "") -> Path:
    path = folder / "model.xml"
    path.write_text(MJCF.format(x=x, b=BALL.format(mask=mask), rest=rest))
    return path


def test_mjcf_overlap_is_found_and_its_sound_twin_is_clean(tmp_path: Path) -> None:
    assert not audit_file(mjcf(tmp_path, x=0.115), FULL).findings

    (finding,) = audit_file(mjcf(tmp_path, x=0.08), FULL).findings

    assert finding.code == "E_OVERLAP"
    assert finding.parts == ("a", "b")
    assert finding.value == pytest.approx(20.0, rel=0.05)


def test_what_overlaps_at_rest_is_told_of_motion_only_where_that_makes_it_much_deeper(tmp_path: Path) -> None:
    """The slide drives the ball 10 mm further in: from 20 mm to 30 mm in one model, from 4 mm to 14 mm in the other."""
    assert audit_file(mjcf(tmp_path, x=0.08), FULL).findings.codes == ("E_OVERLAP",)
    assert set(audit_file(mjcf(tmp_path, x=0.096), FULL).findings.codes) == {"E_OVERLAP", "E_MOTION_COLLISION"}


def test_mjcf_first_contact_along_a_slide(tmp_path: Path) -> None:
    found = audit_file(mjcf(tmp_path, x=0.105), FULL).findings

    assert found.codes == ("E_MOTION_COLLISION",)
    assert found[0].value == pytest.approx(5.0, abs=0.2)  # the ball stands 5 mm off; it is drawn with facets
    assert found[0].unit == "mm"


@pytest.mark.parametrize(
    "how", [{"mask": 'contype="2" conaffinity="4"'}, {"rest": '<contact><exclude body1="a" body2="b"/></contact>'}], ids=["mask", "exclude"]
)
def test_what_mjcf_never_lets_collide_is_a_note(how: dict[str, str], tmp_path: Path) -> None:
    found = audit_file(mjcf(tmp_path, x=0.09, **how), FULL)

    assert found.ok
    assert set(found.findings.codes) <= {"I_AUDIT_SHARED"}


def test_mjcf_that_mujoco_refuses_says_so_in_its_words(tmp_path: Path) -> None:
    path = tmp_path / "model.xml"
    path.write_text('<mujoco><worldbody><body name="bare"><joint/></body></worldbody></mujoco>')

    (finding,) = audit_file(path, FULL).findings

    assert finding.code == "E_READ"
    assert "mass and inertia" in finding.message


def test_an_engine_that_refuses_a_urdf_is_quoted_with_the_cause(tmp_path: Path) -> None:
    root = defects.stand(tmp_path)
    defects.removing("link[@name='arm']/inertial", "link[@name='arm']/collision", "link[@name='arm']/visual")(root, tmp_path)

    found = audit_file(defects.write(root, tmp_path), FULL).findings

    (refusal,) = [finding for finding in found.of("W_AUDIT_ENGINE") if finding.where == "mujoco"]
    assert refusal.cause == "no_inertia"
    assert "mass and inertia of moving bodies" in refusal.message


BALLS = """<robot name="figure"><link name="chest">{0}</link><link name="head">{0}</link>
<joint name="neck" type="fixed"><origin xyz="0 0 0.3"/><parent link="chest"/><child link="head"/></joint></robot>"""


@pytest.mark.parametrize(
    ("shape", "floats"), [('<sphere radius="0.1"/>', False), ('<box size="0.2 0.2 0.2"/>', True)], ids=["balls", "boxes"]
)
def test_balls_stand_for_limbs_and_need_not_touch(shape: str, floats: bool, tmp_path: Path) -> None:
    path = tmp_path / "figure.urdf"
    path.write_text(BALLS.format(f"<visual><geometry>{shape}</geometry></visual><collision><geometry>{shape}</geometry></collision>"))

    found = audit_file(path, QUICK).findings

    assert ("E_NOT_TOUCHING" in found.codes) == floats


def test_time_that_runs_out_is_told(tmp_path: Path) -> None:
    found = audit_file(defects.write(defects.stand(tmp_path), tmp_path), AuditOptions(engines=False, budget=0.0))

    (finding,) = found.findings
    assert finding.code == "W_AUDIT_NOT_CHECKED"
    assert finding.value == 2
    assert not found.ok


def test_a_proof_replaces_the_samples(tmp_path: Path) -> None:
    sound = audit_file(defects.write(defects.stand(tmp_path), tmp_path), AuditOptions(engines=False, certified=30.0))

    assert sound.motion == "certified"
    assert not sound.findings

    root = defects.with_post(tmp_path)
    defects.post_in_the_way(root, tmp_path)
    spoiled = audit_file(defects.write(root, tmp_path), AuditOptions(engines=False, certified=30.0))

    assert "E_MOTION_COLLISION" in spoiled.findings.codes
    free = {r.joint: r for r in spoiled_ranges(spoiled)}
    assert math.degrees(free["turn"].upper) == pytest.approx(defects.FIRST_CONTACT_DEG, abs=0.05)


def test_a_proof_that_is_not_finished_is_told_once(tmp_path: Path) -> None:
    found = audit_file(defects.write(defects.stand(tmp_path), tmp_path), AuditOptions(engines=False, certified=1e-9))

    (finding,) = found.findings
    assert finding.code == "W_AUDIT_NOT_CHECKED"
    assert finding.value == len(found.undone)
    assert found.motion == "certified in part"


def spoiled_ranges(found: Any) -> Any:
    assert found.certificate is not None
    return found.certificate.ranges


@pytest.mark.parametrize("text", ["<robot", "<other/>", ""], ids=["truncated", "another root", "empty"])
def test_what_is_no_urdf_is_told(text: str, tmp_path: Path) -> None:
    path = tmp_path / "model.urdf"
    path.write_text(text)

    (finding,) = audit_file(path, FULL).findings

    assert finding.code == "E_READ"


# ---------------------------------------------------------------------- STEP


def step_file(
    folder: Path, parts: dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]], *, surface: bool = False
) -> Path:
    """Write boxes `{name: (size, place)}` as an assembly of products."""
    from build123d import Box, Compound, Face, Pos, export_step

    children: list[Any] = []
    for name, (size, place) in parts.items():
        solid = Pos(*place) * Box(*size)
        solid.label = name
        children.append(solid)
    if surface:
        sheet = Pos(0, 0, 200) * Face.make_rect(10, 10)
        sheet.label = "sheet"
        children.append(sheet)
    export_step(Compound(children=children, label="thing"), str(folder / "thing.step"))
    return folder / "thing.step"


TABLE = {"top": ((100.0, 60.0, 10.0), (0.0, 0.0, 45.0)), "leg": ((10.0, 10.0, 40.0), (0.0, 0.0, 20.0))}


def test_a_sound_step_assembly_gives_nothing_and_keeps_its_names(tmp_path: Path) -> None:
    found = audit_file(step_file(tmp_path, TABLE), QUICK)

    assert not found.findings
    assert found.links == 2


def test_step_overlap_floating_names_and_surfaces(tmp_path: Path) -> None:
    overlapping = TABLE | {"leg": ((10.0, 10.0, 40.0), (0.0, 0.0, 23.0))}
    floating = TABLE | {"leg": ((10.0, 10.0, 40.0), (0.0, 0.0, -20.0))}
    unnamed = {"SOLID": TABLE["top"], "leg": TABLE["leg"]}

    (overlap,) = audit_file(step_file(tmp_path, overlapping), QUICK).findings
    (loose,) = audit_file(step_file(tmp_path, floating), QUICK).findings
    (name,) = audit_file(step_file(tmp_path, unnamed), QUICK).findings
    sheet = audit_file(step_file(tmp_path, TABLE, surface=True), QUICK).findings

    assert overlap.code == "E_OVERLAP"
    assert overlap.value == pytest.approx(3.0)
    assert set(overlap.parts) == {"top", "leg"}
    assert (loose.code, loose.cause) == ("E_FLOATING", "floating")
    assert loose.value == pytest.approx(40.0)
    assert (name.code, name.value) == ("W_AUDIT_UNNAMED", 1)
    assert sheet.codes == ("E_AUDIT_NOT_SOLID",)


def test_a_solid_whose_mesh_has_gaps_is_said_not_to_be_checked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """OpenCASCADE meshes some valid solids with gaps, such as a helical sweep that touches a cylinder along a line. No small one is known."""
    read = StepReader.read_assembly

    def opened(self: StepReader, path: Path, *, deflection: float = 0.05) -> tuple[StepPart, ...]:
        return tuple(
            replace(part, mesh=TriMesh(part.mesh.vertices, part.mesh.triangles[1:]))
            if part.name == "leg" and part.mesh is not None
            else part
            for part in read(self, path, deflection=deflection)
        )

    monkeypatch.setattr(StepReader, "read_assembly", opened)
    file = step_file(tmp_path, TABLE | {"leg": ((10.0, 10.0, 40.0), (0.0, 0.0, 23.0))})  # they overlap

    (unchecked,) = audit_file(file, QUICK).findings
    (finding,) = read_step(file).findings

    assert (unchecked.code, unchecked.parts) == ("W_AUDIT_NOT_CHECKED", ("leg",))
    assert "leg 3" in unchecked.message
    assert (finding.code, finding.where.split("/")[-1]) == ("W_IMPORT_DROPPED", "leg")


def test_a_step_file_that_is_none_is_told(tmp_path: Path) -> None:
    (tmp_path / "thing.step").write_text("ISO-10303-21;\nnonsense")

    (finding,) = audit_file(tmp_path / "thing.step", QUICK).findings

    assert finding.code == "E_READ"


# ---------------------------------------------------------------------- our own


@pytest.mark.parametrize("write", [write_urdf, write_mjcf, write_freecad], ids=["urdf", "mjcf", "freecad"])
def test_our_own_files_are_judged_like_what_they_were_made_of(write: Any, tmp_path: Path) -> None:
    assembly = all_joint_kinds()
    bundle = write(assembly)
    bundle.write(tmp_path)

    direct = audit_assembly(assembly, "kinds", "plan", QUICK).findings
    read = audit_file(tmp_path / bundle.main, QUICK).findings

    contact = {"E_OVERLAP", "E_STATIC_OVERLAP", "E_FLOATING"}
    pairs = {(finding.code, finding.parts) for finding in direct if finding.code in contact}
    assert pairs
    if write is not write_freecad:  # parts without B-rep have no shape in a FreeCAD file
        assert {(finding.code, finding.parts) for finding in read if finding.code in contact} == pairs


def test_a_folder_gives_a_scoreboard(tmp_path: Path) -> None:
    for name in ("sound", "spoiled"):
        (tmp_path / name).mkdir()
        root = defects.stand(tmp_path / name)
        if name == "spoiled":
            defects.removing("link[@name='arm']/inertial")(root, tmp_path)
        defects.write(root, tmp_path / name)
    mjcf(tmp_path, x=0.115)
    (tmp_path / "package.xml").write_text("<package/>")
    (tmp_path / "part.xml").write_text('<mujoco><worldbody><geom type="box" size="1 1 1"/></worldbody></mujoco>')
    (tmp_path / "whole.xml").write_text('<mujoco><include file="part.xml"/></mujoco>')

    assert [path.name for path in models_below(tmp_path)] == ["model.xml", "model.urdf", "model.urdf", "whole.xml"]
    board = audit_folder(tmp_path, QUICK)

    assert not board.ok
    assert [audit.ok for audit in board.audits] == [True, True, False, True]
    assert board.codes == [("E_AUDIT_NO_INERTIA", 1, 1)]
    assert board.to_json()["schema"] == "articad.scoreboard/1"


@pytest.mark.parametrize("write", [write_urdf, write_mjcf])
def test_an_audit_of_a_file_states_that_only_records_waive_an_overlap(write: Any, tmp_path: Path) -> None:
    parts = [
        Part.from_mesh(name, box(20, 20, 20), density=1000.0, connectors={"o": Connector("o", place)}) for name, place in PLACES.items()
    ]
    joint = declare.fixed("held", parts[1]["o"], parts[0]["o"])
    waived = Assembly.from_parts("waived", parts=parts, joints=[joint], ground="a", waivers=[Waiver(("a", "b"), 12.0, "pressed")])

    for folder, assembly in (("waived", waived), ("not", replace(waived, waivers=()))):
        found = audit_file(write(assembly).write(tmp_path / folder)[0], QUICK).findings
        assert bool(found.of("E_STATIC_OVERLAP")) == (folder == "not")
        if folder == "waived":
            (told,) = found.of("I_WAIVED")
            assert "pressed" in told.message
            assert "only" in told.message.lower()
            assert "records" in told.message


def test_no_link_that_leads_out_of_a_folder_is_followed(tmp_path: Path) -> None:
    folder, other = tmp_path / "models", tmp_path / "others"
    for made in (folder / "inner", other):
        made.mkdir(parents=True)
    for suffix in ("urdf", "xml"):
        (other / f"secret.{suffix}").write_text("<mujoco/>" if suffix == "xml" else '<robot name="secret"><link name="a"/></robot>')
        (folder / f"linked.{suffix}").symlink_to(other / f"secret.{suffix}")
    (folder / "away").symlink_to(other)
    (folder / "inner/own.urdf").write_text('<robot name="r"><link name="a"/></robot>')
    (folder / "near.urdf").symlink_to(folder / "inner/own.urdf")
    assert [path.name for path in models_below(folder)] == ["own.urdf", "near.urdf"]


def test_a_missing_mesh_is_looked_for_beside_the_file_and_through_no_link(tmp_path: Path) -> None:
    (tmp_path / "others").mkdir()
    (tmp_path / "others/Gone.STL").write_text("")
    (tmp_path / "in/meshes").mkdir(parents=True)
    (tmp_path / "in/away").symlink_to(tmp_path / "others")
    (tmp_path / "in/meshes/Near.STL").write_text("")
    references = MeshReferences(Folder.of(tmp_path / "in/a.urdf", None))
    assert references.mesh("near.stl", (1, 1, 1))[2] == "there is no such file, but there is meshes/Near.STL"
    assert references.mesh("gone.stl", (1, 1, 1))[2] == "there is no such file"


def test_no_part_of_a_step_file_hides_behind_a_name_that_looks_numbered() -> None:
    whole = TriMesh(
        np.random.default_rng(1).random((12, 3)), np.arange(12, dtype=np.int32).reshape(4, 3), face=np.arange(4, dtype=np.int32)
    )
    parts = _parts([{"product": name, "valid": True} for name in ("a", "a", "a (2)", "a")], whole)
    assert [part.name for part in parts] == ["a", "a (2)", "a (2) (2)", "a (3)"]
