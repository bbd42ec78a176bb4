"""Hulls that jam: the audit predicts what simulators find, and convex pieces mend it."""

from __future__ import annotations

from pathlib import Path

import pytest
from lxml import etree

from articad.auditing.examine import AuditOptions, audit_file
from articad.auditing.mend import mend
from articad.export.urdf import write_urdf
from articad.simulation.examine import simulate_file
from tests.export.test_collisions import sledge

QUICK = AuditOptions(engines=False)


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


def test_what_encloses_nothing_is_not_said_to_be_free_of_jams(tmp_path: Path) -> None:
    """Meshes of public robots are often open: the audit says that it does not know, and the repair that it leaves them."""
    path = foreign(tmp_path, from_outside=True)
    mesh = path.parent / "meshes/rail.stl"
    content = mesh.read_bytes()
    mesh.write_bytes(
        content[:80] + (int.from_bytes(content[80:84], "little") - 1).to_bytes(4, "little") + content[84:-50]
    )  # a triangle less

    audit = audit_file(path, QUICK)

    assert not audit.findings.of("W_AUDIT_HULL_JAM")
    assert "hulls: the collision meshes of rail are open, so whether their hulls jam is not known" in audit.undone
    mended = mend(path, tmp_path / "pieces", collision="pieces", choices=QUICK)
    assert "left 1 collision mesh that enclose nothing: rail" in mended.done


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
