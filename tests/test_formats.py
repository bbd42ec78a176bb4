"""What the table of formats says of itself is true: what is read, what is put back, and what to do with other files."""

from __future__ import annotations

from pathlib import Path

import pytest

from articad.errors import ReadError
from articad.export.urdf import write_urdf
from articad.formats import ADVICE, FORMATS, NAMED, format_of, read, readable
from tests.assemblies import geared_pair

SAMPLES = {
    "urdf": '<robot name="r"><link name="a"/><transmission name="t"/></robot>',
    "mjcf": '<mujoco><worldbody><body name="a"><geom size="1"/></body></worldbody><sensor><framepos name="t" objtype="body" objname="a"/></sensor></mujoco>',
    "sdf": '<sdf version="1.9"><model name="m"><link name="a"><sensor name="t" type="imu"/></link></model></sdf>',
}


@pytest.mark.parametrize("row", FORMATS, ids=lambda row: row.name)
def test_a_format_puts_back_what_it_says_and_every_other_one_reports_it(row: object, tmp_path: Path) -> None:
    assert isinstance(row, type(FORMATS[0]))
    assert row.holds
    assert bool(row.keeps) == (row.name in SAMPLES)
    for source, text in SAMPLES.items():
        path = tmp_path / f"a{NAMED[source].suffixes[0]}"
        path.write_text(text)
        if row.name in {"step", "3mf"} and source != "mjcf":
            continue  # no part has a shape
        bundle = row.write(read(path))
        lost = any(" t" in loss.lost or "'t'" in loss.lost for loss in bundle.losses)
        assert lost == (row.name != source), (source, [loss.lost for loss in bundle.losses])


def test_what_is_not_read_is_refused_with_what_to_do(tmp_path: Path) -> None:
    for endings, text in ADVICE.items():
        for ending in endings:
            assert ending not in set(readable())
            (tmp_path / f"a{ending}").touch()
            with pytest.raises(ReadError) as refused:
                read(tmp_path / f"a{ending}")
            assert text in {finding.hint for finding in refused.value.findings}, ending
    (tmp_path / "a.unknown").touch()
    with pytest.raises(ReadError, match="not one of"):
        read(tmp_path / "a.unknown")


def test_the_advice_for_meshes_and_srdf_works(tmp_path: Path) -> None:
    from articad.geometry.mesh_files import write_stl
    from articad.geometry.part import Part
    from articad.geometry.shapes import box

    (tmp_path / "a.stl").write_bytes(write_stl(box(1, 2, 3)))
    assert Part.from_mesh("a", tmp_path / "a.stl").mesh is not None
    write_urdf(geared_pair(), srdf=True).write(tmp_path)
    assert list(read(tmp_path / "geared.urdf").parts) == list(geared_pair().parts)
    world = format_of("a.world")
    assert world is not None
    assert world.name == "sdf"
