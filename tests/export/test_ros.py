"""ROS 2 packages, SRDF and ros2_control around a URDF."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree

from articad.errors import ExportError
from articad.export.urdf import write_urdf
from articad.importers.urdf import read_urdf
from tests.assemblies import all_joint_kinds, geared_pair
from tests.engines import PinocchioUrdf, joint_values, largest_difference, our_poses


def test_a_package_is_laid_out_and_names_its_meshes_by_package(tmp_path: Path) -> None:
    bundle = write_urdf(geared_pair(), package="my_rack", srdf=True)
    bundle.write(tmp_path / "my_rack")
    root = etree.fromstring(bundle.files["urdf/geared.urdf"])

    assert bundle.main == "urdf/geared.urdf"
    assert {"package.xml", "CMakeLists.txt", "srdf/geared.srdf", "meshes/base.stl"} <= set(bundle.files)
    assert root.find("link/visual/geometry/mesh").get("filename") == "package://my_rack/meshes/base.stl"
    assert etree.fromstring(bundle.files["package.xml"]).find("name").text == "my_rack"
    assert b"urdf srdf meshes" in bundle.files["CMakeLists.txt"]


@pytest.mark.parametrize("metadata", [True, False])
def test_a_package_is_read_back_with_its_meshes(metadata: bool, tmp_path: Path) -> None:
    write_urdf(geared_pair(), package="my_rack").write(tmp_path / "my_rack")
    again = read_urdf(tmp_path / "my_rack" / "urdf" / "geared.urdf", root=tmp_path / "my_rack", metadata=metadata)

    assert not again.findings.of("W_IMPORT_MESH")
    assert all(part.visuals for part in again.parts.values())


@pytest.mark.engines
def test_pinocchio_reads_a_package_unchanged(tmp_path: Path) -> None:
    assembly = all_joint_kinds()
    bundle = write_urdf(assembly, package="kinds", ros2_control=True)
    bundle.write(tmp_path / "kinds")
    rest = assembly.mechanism.rest

    assert (
        largest_difference(our_poses(assembly, rest), PinocchioUrdf(tmp_path / "kinds" / bundle.main).poses(joint_values(assembly, rest)))
        < 1e-9
    )


@pytest.mark.parametrize("name", ["My_Rack", "a__b", "1a", "", "a-b", "a/b"])
def test_names_that_ros_does_not_take_are_refused(name: str) -> None:
    with pytest.raises(ExportError, match="not a valid name for a ROS package"):
        write_urdf(geared_pair(), package=name)


def test_srdf_disables_neighbours_rigid_pairs_and_overlapping_hulls() -> None:
    assembly = all_joint_kinds()
    bundle = write_urdf(assembly, srdf=True)
    pairs = {
        frozenset((pair.get("link1"), pair.get("link2"))): pair.get("reason")
        for pair in etree.fromstring(bundle.files["all_kinds.srdf"]).iterfind("disable_collisions")
    }

    assert pairs[frozenset(("base", "hinge"))] == "Adjacent"
    assert pairs[frozenset(("base", "fixed"))] == "Adjacent"
    assert pairs[frozenset(("base", "arm"))] == "Default"
    assert {loss.where for loss in bundle.losses if "hulls" in loss.kept} >= {"parts.base+arm"}


def test_controllers_command_every_driver_from_its_rest_value() -> None:
    root = etree.fromstring(write_urdf(all_joint_kinds(), ros2_control=True).files["all_kinds.urdf"])
    joints = {joint.get("name"): joint for joint in root.iterfind("ros2_control/joint")}

    assert {"hinge", "rod__t", "rod__r", "head__rx", "nut__r"} <= joints.keys()
    assert "nut__t" not in joints
    assert joints["hinge"].find("state_interface/param").text == "0.5"
    geared = etree.fromstring(write_urdf(geared_pair(), ros2_control=True).files["geared.urdf"])
    assert [joint.get("name") for joint in geared.iterfind("ros2_control/joint")] == ["a"]
