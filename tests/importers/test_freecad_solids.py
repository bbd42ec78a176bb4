"""FreeCAD parts of several solids, without FreeCAD: a file of XML and B-rep."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path

import numpy as np
import pytest
from OCP.BRep import BRep_Builder
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.BRepTools import BRepTools
from OCP.gp import gp_Pnt
from OCP.TopAbs import TopAbs_FACE
from OCP.TopExp import TopExp_Explorer
from OCP.TopoDS import TopoDS_Compound

from articad.importers.freecad import read_freecad

STEEL = "6894c597-5771-4b56-825f-ce7d5e4689f4"  # 28Mn6 of FreeCAD's library: 7800 kg/m³
BOXES = ((10.0, 20.0, 30.0), (4.0, 5.0, 6.0), (1.0, 2.0, 8.0))


def compound(sheets: int) -> bytes:
    """Return three boxes apart from each other, and some faces beside them."""
    builder, made = BRep_Builder(), TopoDS_Compound()
    builder.MakeCompound(made)
    for place, size in enumerate(BOXES):
        builder.Add(made, BRepPrimAPI_MakeBox(gp_Pnt(50.0 * place, 0.0, 0.0), *size).Shape())
    for _ in range(sheets):
        builder.Add(made, TopExp_Explorer(BRepPrimAPI_MakeBox(1.0, 1.0, 1.0).Shape(), TopAbs_FACE).Current())
    stream = io.BytesIO()
    BRepTools.Write_s(made, stream)
    return stream.getvalue()


def document(path: Path, sheets: int, material: str) -> Path:
    types = {"Assembly": "Assembly::AssemblyObject", "Lump": "Part::Feature", "Held": "App::FeaturePython"}
    properties = {
        "Assembly": '<Property name="Group"><Link value="Lump"/><Link value="Held"/></Property>',
        "Lump": '<Property name="Shape"><Part file="Lump.brp"/></Property>'
        f'<Property name="ShapeMaterial"><PropertyMaterial uuid="{material}"/></Property>',
        "Held": '<Property name="ObjectToGround"><Link value="Lump"/></Property>',
    }
    objects = "".join(f'<Object type="{kind}" name="{name}"/>' for name, kind in types.items())
    rows = "".join(f'<Object name="{name}"><Properties>{row}</Properties></Object>' for name, row in properties.items())
    with zipfile.ZipFile(path / "lump.FCStd", "w") as archive:
        archive.writestr("Document.xml", f"<Document><Objects>{objects}</Objects><ObjectData>{rows}</ObjectData></Document>")
        archive.writestr("Lump.brp", compound(sheets))
    return path / "lump.FCStd"


@pytest.mark.parametrize("sheets", [0, 2])
def test_a_shape_of_several_solids_is_several_shapes_with_their_mass(sheets: int, tmp_path: Path) -> None:
    read = read_freecad(document(tmp_path, sheets, STEEL))
    part = read.parts["lump"]
    volumes = [float(np.prod(size)) for size in BOXES]
    assert part.solid is None
    assert [shape.mesh.volume for shape in part.visuals] == pytest.approx(volumes)
    assert part.mass is not None
    assert part.mass.mass == pytest.approx(sum(volumes) * 1e-9 * 7800.0)
    assert part.mass.com[0] == pytest.approx(
        sum(v * (50.0 * place + size[0] / 2) for place, (v, size) in enumerate(zip(volumes, BOXES, strict=True))) / sum(volumes)
    )
    assert [finding.code for finding in read.findings] == ["W_FREECAD_SHAPE"] * (sheets > 0)
    assert all("2 loose" in finding.message for finding in read.findings)


def test_a_material_without_a_density_gives_no_mass(tmp_path: Path) -> None:
    assert read_freecad(document(tmp_path, 0, "7f9fd73b-50c9-41d8-b7b2-575a030c1eeb")).parts["lump"].mass is None
