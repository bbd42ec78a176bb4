"""Meshes that ROS names by package, and the SRDF beside a URDF."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from articad import cli
from articad.errors import ReadError
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.formats import read
from articad.geometry.mesh_files import write_stl
from articad.geometry.shapes import box
from articad.importers.urdf import read_urdf
from tests.assemblies import all_joint_kinds

ROBOT = '<robot name="r"><link name="l"><visual><geometry><mesh filename="{}"/></geometry></visual></link></robot>'


def package(folder: Path, name: str, mesh: str = "", urdf: str = "") -> Path:
    """A ROS package whose folder need not have its name; return its URDF."""
    (folder / "meshes").mkdir(parents=True)
    (folder / "urdf").mkdir()
    (folder / "package.xml").write_text(f'<?xml version="1.0"?><package format="3"><name> {name} </name></package>')
    if mesh:
        (folder / "meshes" / mesh).write_bytes(write_stl(box(0.1, 0.2, 0.3)))
    if urdf:
        (folder / "urdf/r.urdf").write_text(ROBOT.format(urdf))
    return folder / "urdf/r.urdf"


def extents(assembly: Any) -> list[float]:
    (shape,) = assembly.parts["l"].visuals
    return [float(x) for x in shape.mesh.bounds[1] - shape.mesh.bounds[0]]


def test_a_package_is_the_folder_above_whose_manifest_has_the_name_if_the_root_allows_it(tmp_path: Path) -> None:
    path = package(tmp_path / "a-checkout", "my_robot", "b.stl", "package://my_robot/meshes/b.stl")

    (finding,) = read_urdf(path).findings.of("W_IMPORT_MESH")  # the file's own folder does not have it
    assert "--root" in finding.hint
    assert extents(read_urdf(path, root=tmp_path / "a-checkout")) == pytest.approx([100, 200, 300])
    assert extents(read_urdf(path, root=tmp_path)) == pytest.approx([100, 200, 300])


def test_a_package_beside_is_found_below_the_root(tmp_path: Path) -> None:
    package(tmp_path / "src/meshes_of_robots", "meshes_of_robots", "b.stl")
    path = package(tmp_path / "src/robot", "robot", urdf="package://meshes_of_robots/meshes/b.stl")

    assert extents(read(path, root=tmp_path / "src")) == pytest.approx([100, 200, 300])
    assert read(path, root=tmp_path / "src/robot").findings.codes == ("W_IMPORT_MESH",)


@pytest.mark.parametrize(
    ("variable", "entry", "place"),
    [
        ("ROS_PACKAGE_PATH", "ws", "ws/other"),
        ("ROS_PACKAGE_PATH", "ws/elsewhere", "ws/elsewhere"),  # its folder has another name
        ("AMENT_PREFIX_PATH", "ws", "ws/share/other"),
    ],
)
def test_the_environment_names_packages(variable: str, entry: str, place: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package(tmp_path / place, "other", "b.stl")
    path = package(tmp_path / "robot", "robot", urdf="package://other/meshes/b.stl")
    assert read(path).findings.codes == ("W_IMPORT_MESH",)

    monkeypatch.setenv(variable, os.pathsep.join([str(tmp_path / "nothing"), str(tmp_path / entry)]))

    assert extents(read(path)) == pytest.approx([100, 200, 300])


def test_no_name_leads_out_of_a_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "ws"))
    package(tmp_path / "ws/other", "other")
    (tmp_path / "secret.stl").write_bytes(write_stl(box(1, 1, 1)))
    (tmp_path / "ws/other/meshes/link.stl").symlink_to(tmp_path / "secret.stl")

    for name in ("package://other/../../secret.stl", "package://other/meshes/link.stl", "package://../secret.stl"):
        path = tmp_path / "r.urdf"
        path.write_text(ROBOT.format(name))
        with pytest.raises(ReadError) as refused:
            read(path, root=tmp_path / "ws")
        assert set(refused.value.findings.codes) == {"E_UNSAFE_PATH"}


def test_a_pipe_as_manifest_does_not_stop_the_reader(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "package.xml")
    (tmp_path / "r.urdf").write_text(ROBOT.format("package://other/b.stl"))

    assert read(tmp_path / "r.urdf").findings.codes == ("W_IMPORT_MESH",)


# ---------------------------------------------------------------------- SRDF

ARM = """<robot name="arm"><link name="base"/><link name="rod"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
</inertial></link><link name="tip"/><joint name="lift" type="revolute"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="3" velocity="2"/></joint><joint name="end" type="fixed"><parent link="rod"/><child link="tip"/></joint></robot>"""
SRDF = """<?xml version="1.0"?><robot name="arm"><!-- by hand -->
<group name="arm"><chain base_link="base" tip_link="tip"/><joint name="lift"/></group>
<group_state name="home" group="arm"><joint name="lift" value="0.5"/></group_state>
<end_effector name="hand" parent_link="tip" group="arm"/>
<virtual_joint name="world" type="fixed" parent_frame="map" child_link="base"/>
<passive_joint name="world"/>
<joint_property joint_name="lift" property_name="angle_wraparound" value="false"/>
<link_sphere_approximation link="rod"><sphere center="0 0 0" radius="0.1"/></link_sphere_approximation>
<disable_collisions link1="base" link2="rod" reason="Adjacent"/>
<disable_collisions link1="base" link2="tip" reason="Never"/>
<disable_collisions link1="gone" link2="tip" reason="User"/></robot>"""


def elements(content: str | bytes) -> list[str]:
    root = etree.fromstring(
        content.encode() if isinstance(content, str) else content, etree.XMLParser(remove_comments=True, remove_blank_text=True)
    )
    return [etree.tostring(element, with_tail=False).decode() for element in root]


@pytest.mark.parametrize("place", ["arm.srdf", "../srdf/arm.srdf", "elsewhere/x.srdf"])
def test_an_srdf_comes_back_word_for_word_with_the_urdf_and_is_lost_elsewhere(place: str, tmp_path: Path) -> None:
    path = tmp_path / "urdf/arm.urdf"
    path.parent.mkdir()
    path.write_text(ARM)
    beside = path.parent / place
    beside.parent.mkdir(exist_ok=True)
    beside.write_text(SRDF)

    assembly = read_urdf(path, root=tmp_path, srdf=beside if "x.srdf" in place else None)
    bundle = write_urdf(assembly)
    written = elements(bundle.files["arm.srdf"])

    assert written == elements(SRDF)[:-1]
    assert [loss.lost for loss in bundle.losses if "SRDF" in loss.lost] == ["<disable_collisions gone tip> of the SRDF"]
    lost = " ".join(loss.lost for loss in write_mjcf(assembly).losses)
    assert all(
        f"<{tag}" in lost for tag in ("group arm", "group_state home", "end_effector hand", "virtual_joint world", "disable_collisions")
    )
    bundle.write(tmp_path / "again")
    assert elements("<robot>" + "".join(item.xml for item in read_urdf(tmp_path / "again/arm.urdf").kept) + "</robot>") == [
        row for row in written if "Adjacent" not in row and "Never" not in row
    ]
    assert len(elements(write_urdf(assembly, srdf=True).files["arm.srdf"])) == len(written) + 1  # rod and tip are neighbours, too


def test_an_srdf_outside_the_root_is_not_looked_for_and_another_file_is_refused(tmp_path: Path) -> None:
    for folder in ("urdf", "srdf"):
        (tmp_path / folder).mkdir()
    (tmp_path / "urdf/arm.urdf").write_text(ARM)
    (tmp_path / "srdf/arm.srdf").write_text(SRDF)
    assert not read_urdf(tmp_path / "urdf/arm.urdf").kept

    (tmp_path / "x.srdf").write_text("<sdf/>")
    with pytest.raises(ReadError, match="not SRDF"):
        read_urdf(tmp_path / "urdf/arm.urdf", srdf=tmp_path / "x.srdf")
    assert (
        cli.main(["convert", str(tmp_path / "urdf/arm.urdf"), str(tmp_path / "out/b.urdf"), "--srdf", str(tmp_path / "srdf/arm.srdf")]) == 0
    )
    assert (tmp_path / "out/arm.srdf").is_file()


def test_pairs_that_articad_computes_are_not_taken_for_a_users(tmp_path: Path) -> None:
    bundle = write_urdf(all_joint_kinds(), srdf=True)
    bundle.write(tmp_path)

    assert not read_urdf(tmp_path / bundle.main).kept
    beside = tmp_path / "all_kinds.srdf"
    beside.write_text(beside.read_text().replace("</robot>", '<group name="g"><link name="hand"/></group></robot>'))
    assert [item.what for item in read_urdf(tmp_path / bundle.main).kept] == ["<group g> of the SRDF"]
