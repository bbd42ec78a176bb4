"""Hulls that jam: the audit predicts what simulators find, and convex pieces mend it."""

from __future__ import annotations

import shutil
from pathlib import Path

import numpy as np
import pytest
from lxml import etree

from articad.auditing.examine import AuditOptions, audit_file
from articad.auditing.mend import mend
from articad.export.urdf import write_urdf
from articad.geometry.mesh_files import read_mesh, write_stl
from articad.simulation.examine import simulate_file
from tests.export.test_collisions import sledge
from tests.geometry.test_capping import fine, without

QUICK = AuditOptions(engines=False)
NAMING = {"W_AUDIT_HULL_JAM", "E_OVERLAP", "E_STATIC_OVERLAP", "W_STATIC_OVERLAP", "E_MOTION_COLLISION"}


def foreign(folder: Path, *, from_outside: bool) -> Path:
    """A block in a channel of an unrelated part, as another program would write it: one mesh per part, without articad's records."""
    bundle = write_urdf(sledge(from_outside=from_outside), collision="solid")
    bundle.write(folder)
    path = folder / bundle.main
    root = etree.parse(str(path)).getroot()
    for record in root.findall("articad"):
        root.remove(record)
    base = root.find("link[@name='base']")
    base.remove(base.find("collision"))
    path.write_bytes(etree.tostring(root))
    return path


def jams(path: Path) -> list[tuple[str, ...]]:
    return [finding.parts for finding in audit_file(path, QUICK).findings.of("W_AUDIT_HULL_JAM")]


@pytest.mark.parametrize("from_outside", [True, False])
def test_pieces_on_request_mend_a_jam(from_outside: bool, tmp_path: Path) -> None:
    path = foreign(tmp_path / "bare", from_outside=from_outside)

    assert jams(path) == [("rail", "slider")]
    assert jams(mend(path, tmp_path / "plain", choices=QUICK).file) == [("rail", "slider")]
    mended = mend(path, tmp_path / "pieces", collision="pieces", choices=QUICK)
    assert any("divided 1 collision mesh into convex pieces: rail (3, " in one for one in mended.done)
    assert jams(mended.file) == []


@pytest.mark.engines
def test_the_simulator_agrees_about_the_jam_and_its_repair(tmp_path: Path) -> None:
    path = foreign(tmp_path / "bare", from_outside=True)

    assert not simulate_file(path, engines=("mujoco",)).ok
    verdict = simulate_file(mend(path, tmp_path / "pieces", collision="pieces", choices=QUICK).file, engines=("mujoco",))
    assert verdict.ok, str(verdict.findings)


def opened(path: Path, gone: list[int], times: int = 0) -> Path:
    """The file with a rail that lacks triangles, quartered a few times before."""
    mesh = path.parent / "meshes/rail.stl"
    whole = fine(read_mesh(mesh), times)
    mesh.write_bytes(write_stl(without(whole, np.isin(np.arange(len(whole.triangles)), gone))))
    return path


def test_a_rail_with_a_slit_jams_and_is_mended_as_if_it_were_closed(tmp_path: Path) -> None:
    path = opened(foreign(tmp_path / "bare", from_outside=True), [3, 40, 41], times=3)

    audit = audit_file(path, QUICK)
    assert [finding.parts for finding in audit.findings.of("W_AUDIT_HULL_JAM")] == [("rail", "slider")]
    assert not [one for one in audit.undone if "open" in one]
    (finding,) = audit.findings.of("W_AUDIT_MESH_OPEN")
    assert "these gaps are closed" in finding.message
    mended = mend(path, tmp_path / "pieces", collision="pieces", choices=QUICK)
    assert "closed gaps of at most 5 % of the surface in 1 collision mesh first: rail" in mended.done
    assert jams(mended.file) == []


@pytest.mark.engines
def test_a_rail_without_an_end_jams_by_its_hull_as_the_simulator_finds(tmp_path: Path) -> None:
    """Meshes of public robots are often open: engines use their hulls all the same. The repair leaves them."""
    path = foreign(tmp_path / "bare", from_outside=True)
    whole = read_mesh(path.parent / "meshes/rail.stl")
    ends = np.flatnonzero(np.ptp(whole.vertices[whole.triangles][:, :, 0], axis=1) == 0)
    opened(path, ends.tolist())

    audit = audit_file(path, QUICK)

    assert [finding.parts for finding in audit.findings.of("W_AUDIT_HULL_JAM")] == [("rail", "slider")]
    assert "hulls: the collision meshes of rail are open: a jam is not found where their surfaces touch others" in audit.undone
    (found,) = simulate_file(path, engines=("mujoco",)).findings.of("E_SIM_RANGE")
    assert set(found.parts) == {"rail", "slider"}
    mended = mend(path, tmp_path / "pieces", collision="pieces", choices=QUICK)
    assert "left 1 collision mesh that enclose nothing: rail" in mended.done


def test_an_open_rail_whose_surface_meets_the_slider_s_is_no_jam_of_hulls(tmp_path: Path) -> None:
    """Both collide as they are, so pieces would mend nothing: no solid encloses the rail, and its surface decides."""
    path = foreign(tmp_path / "bare", from_outside=False)
    whole = read_mesh(path.parent / "meshes/rail.stl")
    opened(path, np.flatnonzero(np.ptp(whole.vertices[whole.triangles][:, :, 0], axis=1) == 0).tolist())
    assert jams(path) == [("rail", "slider")]

    root = etree.parse(str(path)).getroot()
    root.find("link[@name='slider']/collision/origin").set("xyz", "0.006 0 0")  # sideways, 1 mm into a wall of the channel
    path.write_bytes(etree.tostring(root))

    assert jams(path) == []


@pytest.mark.soak
@pytest.mark.parametrize("robot", ["kuka_iiwa/model.urdf", "franka_panda/panda.urdf"])
def test_audit_and_simulator_name_the_same_pairs_of_a_public_robot(robot: str, tmp_path: Path) -> None:
    """What stops a joint in MuJoCo was named by the audit, and the repair mends it where the solids are apart.

    All eight collision meshes of the Kuka have gaps; its links 0 and 1 overlap as solids, links 5 and 7 only as hulls. The Panda's link 1
    meets link 7 as a solid in motion, and its hand is inside link 5 at rest. MuJoCo does not find its meshes before they are mended.
    """
    folder, _, file = robot.partition("/")
    shutil.copytree(Path(pytest.importorskip("pybullet_data").getDataPath()) / folder, tmp_path / folder)
    path = tmp_path / folder / file
    for step in ("as it is", "mended"):
        findings = [finding for finding in audit_file(path, QUICK).findings if finding.code in NAMING]
        named, solid = ({frozenset(finding.parts) for finding in findings if finding.code != code} for code in ("", "W_AUDIT_HULL_JAM"))
        verdict = simulate_file(path, engines=("mujoco",), seconds=900)
        # MuJoCo joins a base without joints to the world
        blocked = {
            frozenset(part.replace("world", "lbr_iiwa_link_0") for part in finding.parts) for finding in verdict.findings.of("E_SIM_RANGE")
        }

        assert bool(verdict.findings.of("E_SIM_LOAD")) == (folder == "franka_panda" and step == "as it is")
        assert blocked <= named
        assert (frozenset({"lbr_iiwa_link_5", "lbr_iiwa_link_7"}) in blocked) == (folder == "kuka_iiwa" and step == "as it is")
        if step == "mended":
            assert blocked
            assert blocked <= solid
        path = mend(path, tmp_path / "pieces", collision="pieces", choices=QUICK).file


def test_neighbours_of_the_world_jam_and_other_neighbours_do_not(tmp_path: Path) -> None:
    """Engines skip neighbours, but not those of a part that is fixed to the world."""
    box = '<collision><geometry><mesh filename="meshes/rail.stl" scale="0.001 0.001 0.001"/></geometry></collision>'
    foreign(tmp_path, from_outside=True)
    bead = '<collision><origin xyz="0 0 0.025"/><geometry><sphere radius="0.01"/></geometry></collision>'
    mass = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'

    def chain(*shapes: str) -> Path:
        links = "".join(f'<link name="l{i}">{mass}{shape}</link>' for i, shape in enumerate(shapes))
        limit = '<limit lower="-0.01" upper="0.01" effort="1" velocity="1"/>'
        joints = "".join(
            f'<joint name="j{i}" type="prismatic"><parent link="l{i}"/><child link="l{i + 1}"/><axis xyz="1 0 0"/>{limit}</joint>'
            for i in range(len(shapes) - 1)
        )
        path = tmp_path / "chain.urdf"
        path.write_text(f'<robot name="chain">{links}{joints}</robot>')
        return path

    assert jams(chain(box, bead)) == [("l0", "l1")]
    assert jams(chain("", box, bead)) == []
    assert jams(chain("", box, "", bead)) == [("l1", "l3")]


def test_what_is_convex_or_too_large_to_compare_is_left_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from articad.auditing import jams as module

    path = foreign(tmp_path, from_outside=True)
    monkeypatch.setattr(module, "MOST_TRIANGLES", 10)
    audit = audit_file(path, QUICK)

    assert not audit.findings.of("W_AUDIT_HULL_JAM")
    assert any("hulls: 2 parts have collision shapes" in one for one in audit.undone)
