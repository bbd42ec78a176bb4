"""FreeCAD documents come back as the assemblies that they were."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

import articad as ac
from articad.errors import ReadError
from articad.export.freecad import write_freecad
from articad.importers.freecad import read_freecad
from tests.freecad import opened

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


@cache
def assembly(name: str) -> ac.Assembly:
    return ac.build(ac.AssemblyPlan.load(EXAMPLES / name / "plan.json"), EXAMPLES / name / "parts")


def same_mechanism(one: ac.Assembly, other: ac.Assembly, *, mm: float, rad: float) -> None:
    assert list(one.parts) == list(other.parts)
    assert one.ground == other.ground
    assert one.mechanism.couplings == other.mechanism.couplings
    for a, b in zip(one.joints, other.joints, strict=True):
        assert (a.name, a.type, a.parent, a.child, a.mate, a.lead, a.driver) == (
            b.name,
            b.type,
            b.parent,
            b.child,
            b.mate,
            b.lead,
            b.driver,
        )
        assert (a.parent_connector, a.child_connector) == (b.parent_connector, b.child_connector)
        assert a.limits == b.limits
        assert a.rest == b.rest
        assert a.T_parent_connector.allclose(b.T_parent_connector, mm=mm, rad=rad)
        assert a.T_child_connector.allclose(b.T_child_connector, mm=mm, rad=rad)


@pytest.mark.freecad
@opened.needs_freecad
@pytest.mark.parametrize("name", ["wardrobe", "four_bar"])
def test_writing_reading_and_writing_again_keeps_the_mechanism(name: str, tmp_path: Path) -> None:
    made = assembly(name)
    bundle = write_freecad(made)
    (path,) = bundle.write(tmp_path / "once")
    once = read_freecad(path)
    mesh = made.parts[made.ground].mesh
    assert mesh is not None
    diagonal = float(np.linalg.norm(mesh.bounds[1] - mesh.bounds[0]))
    same_mechanism(made, once, mm=1e-9 * diagonal, rad=1e-9)
    (again,) = write_freecad(once).write(tmp_path / "twice")
    same_mechanism(once, read_freecad(again), mm=1e-9 * diagonal, rad=1e-9)
    for part, solid in ((name, part.solid) for name, part in made.parts.items()):
        read = once.parts[part].solid
        if solid is not None and read is not None:
            assert read.volume == pytest.approx(solid.volume, rel=1e-6), part
    assert opened.moved(dict(made.at()), dict(once.at())) == pytest.approx((0, 0), abs=1e-9)


@pytest.mark.freecad
@opened.needs_freecad
def test_a_document_without_our_records_has_the_same_poses(tmp_path: Path) -> None:
    made = assembly("metronome")
    (path,) = write_freecad(made).write(tmp_path)
    foreign = read_freecad(path, metadata=False)
    assert foreign.mechanism.mobility == made.mechanism.mobility
    mm, rad = opened.moved(dict(made.at()), dict(foreign.at()))
    assert mm < 1e-9
    assert rad < 1e-9


@pytest.mark.parametrize("content", [b"", b"PK\x03\x04 no zip", b"<xml/>"])
def test_what_is_no_freecad_file_is_refused(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "x.FCStd"
    path.write_bytes(content)
    with pytest.raises(ReadError):
        read_freecad(path)
