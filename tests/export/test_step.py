"""STEP assemblies are read back by OpenCASCADE: names, places, colours, volumes."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.errors import ExportError, UnrepresentableError
from articad.export.step import write_step
from articad.geometry.mesh import TriMesh, merged
from articad.geometry.part import Part, Solid
from articad.geometry.shapes import box, sphere
from articad.kinematics import declare
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan

pytestmark = pytest.mark.engines


@pytest.fixture(scope="module")
def assembly(tmp_path_factory: Any) -> Assembly:
    import build123d as bd

    folder = tmp_path_factory.mktemp("step")
    shapes = {"base": bd.Box(40, 30, 20), "arm": bd.Cylinder(5, 40), "it's ä \\ hollow": bd.Box(9, 9, 9) - bd.Sphere(3)}
    parts = []
    for index, (name, shape) in enumerate(shapes.items()):
        path = folder / f"{index}.step"
        bd.export_step(shape, path)
        mesh = box(*shape.bounding_box().size)
        solid = replace(Solid.from_mesh(mesh), step=path, volume=shape.volume)
        connectors = {
            key: Connector(key, T) for key, T in (("a", SE3.trans(3, 2, 1) @ SE3.rot_x(0.3)), ("b", SE3.trans(0, 0, 40) @ SE3.rot_y(0.5)))
        }
        parts.append(Part.from_solid(name, solid, density=1000.0, connectors=connectors, color=f"#{index * 3}08040"))
    joints = [
        declare.revolute("j", parts[0]["b"], parts[1]["a"], limits=(-1, 1), rest=0.4),
        declare.fixed("k", parts[1]["b"], parts[2]["a"], mate="opposed"),
    ]
    return Assembly.from_parts("step 'test'", parts=parts, joints=joints, ground="base", T_ground=SE3.trans(100, 0, 0))


def test_every_part_is_a_named_coloured_solid_where_it_rests(assembly: Assembly, tmp_path: Path) -> None:
    import build123d as bd

    bundle = write_step(assembly)
    bundle.write(tmp_path)
    read = bd.import_step(tmp_path / bundle.main)
    rest = assembly.mechanism.rest_poses()

    assert read.label == "step_'test'"  # build123d shows spaces as underscores
    assert [child.label for child in read.children] == ["base", "arm_group"]
    leaves = [read.children[0], *read.children[1].children]
    assert [child.label for child in leaves] == [name.replace(" ", "_") for name in assembly.parts]
    for child, (name, part) in zip(leaves, assembly.parts.items(), strict=True):
        matrix = np.array(
            [[child.global_location.wrapped.Transformation().Value(row, column) for column in (1, 2, 3, 4)] for row in (1, 2, 3)]
        )
        assert part.solid is not None
        assert child.volume == pytest.approx(part.solid.volume, rel=1e-9)
        assert np.allclose(matrix, rest[name].matrix[:3], atol=1e-9)
        assert next(iter(child.color)) == pytest.approx(int(part.color[1:3], 16) / 255, abs=1e-6)


def test_parts_that_are_fixed_together_are_a_sub_assembly_and_the_file_is_ap242(assembly: Assembly, tmp_path: Path) -> None:
    bundle = write_step(assembly)
    bundle.write(tmp_path)

    assert instances_in(tmp_path / bundle.main)[1] == {"base": "", "arm": "arm_group", "it's ä \\ hollow": "arm_group"}
    content = bundle.files[bundle.main]
    assert b"AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF" in content
    assert (content.count(b"APPLICATION_PROTOCOL_DEFINITION"), content.count(b"AUTOMOTIVE_DESIGN")) == (1, 0)
    from articad.importers.step import read_step

    assert [name.replace("_", " ") for name in read_step(tmp_path / bundle.main).parts] == list(assembly.parts)


def test_a_flat_file_has_all_parts_side_by_side_where_they_rest(assembly: Assembly, tmp_path: Path) -> None:
    import build123d as bd

    bundle = write_step(assembly, flat=True)
    bundle.write(tmp_path)
    read, rest = bd.import_step(tmp_path / bundle.main), assembly.mechanism.rest_poses()

    assert [child.label for child in read.children] == [name.replace(" ", "_") for name in assembly.parts]
    for child, name in zip(read.children, assembly.parts, strict=True):
        placed = child.location.wrapped.Transformation()
        matrix = np.array([[placed.Value(row, column) for column in (1, 2, 3, 4)] for row in (1, 2, 3)])
        assert np.allclose(matrix, rest[name].matrix[:3], atol=1e-9)


def test_the_same_assembly_is_the_same_bytes(assembly: Assembly) -> None:
    assert write_step(assembly).files == write_step(assembly).files


def test_losses_are_told_and_strict_refuses(assembly: Assembly) -> None:
    losses = write_step(assembly).losses

    assert [(loss.where, loss.refused) for loss in losses][:2] == [("joints.j", True), ("parts.base", False)]
    with pytest.raises(UnrepresentableError):
        write_step(assembly, strict=True)


def test_nothing_to_write_is_an_error() -> None:
    with pytest.raises(ExportError, match="No part"):
        write_step(joined(Part.without_geometry("a"), Part.without_geometry("b")))


@pytest.mark.parametrize(
    ("text", "reason"), [("not STEP at all", "product with a shape"), ("DATA;\n#1 = PRODUCT_DEFINITION('',#9);", "does not hold")]
)
def test_a_file_that_is_not_step_is_an_error(text: str, reason: str, assembly: Assembly, tmp_path: Path) -> None:
    path = tmp_path / "a.step"
    path.write_text(text)
    first = next(iter(assembly.parts.values()))
    assert first.solid is not None
    broken = replace(first, solid=replace(first.solid, step=path))

    with pytest.raises(ExportError, match=reason):
        write_step(Assembly.from_parts("b", parts=[broken], joints=[], ground="base"))


def joined(*parts: Part) -> Assembly:
    """Return parts that are fixed to the first one at its origin."""
    held = [replace(part, connectors={"o": Connector("o", SE3.identity())}) for part in parts]
    joints = [declare.fixed(f"j{i}", held[0]["o"], part["o"]) for i, part in enumerate(held[1:])]
    return Assembly.from_parts("joined", parts=held, joints=joints, ground=held[0].name)


def read_by_occt(assembly: Assembly, folder: Path) -> dict[str, Any]:
    """Write an assembly and return what OpenCASCADE reads: instance name -> its placed shape and colour, and the product's shape."""
    bundle = write_step(assembly)
    bundle.write(folder)
    return instances_in(folder / bundle.main)[0]


def instances_in(path: Path) -> tuple[dict[str, Any], dict[str, str]]:
    """Return what OpenCASCADE reads of a STEP file: its instances of shapes, and the sub-assembly that each stands in."""
    from OCP.collections import Sequence_TDF_Label
    from OCP.Quantity import Quantity_Color
    from OCP.STEPCAFControl import STEPCAFControl_Reader
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDataStd import TDataStd_Name
    from OCP.TDF import TDF_Label
    from OCP.TDocStd import TDocStd_Document
    from OCP.TopLoc import TopLoc_Location
    from OCP.TopoDS import TopoDS_Iterator
    from OCP.XCAFDoc import XCAFDoc_ColorGen, XCAFDoc_ColorSurf, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

    document = TDocStd_Document(TCollection_ExtendedString("XCAF"))
    reader = STEPCAFControl_Reader()
    reader.SetNameMode(namemode=True)
    reader.SetColorMode(colormode=True)
    reader.ReadFile(str(path))
    reader.Transfer(document)
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    colors = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    free = Sequence_TDF_Label()
    tool.GetFreeShapes(free)
    assert free.Length() == 1
    found: dict[str, Any] = {}
    above: dict[str, str] = {}

    def walk(assembly: Any, group: str, place: Any) -> None:
        components = Sequence_TDF_Label()
        XCAFDoc_ShapeTool.GetComponents_s(assembly, components)
        for index in range(1, components.Length() + 1):
            label, product, text, color = components.Value(index), TDF_Label(), TDataStd_Name(), Quantity_Color()
            XCAFDoc_ShapeTool.GetReferredShape_s(label, product)
            assert label.FindAttribute(TDataStd_Name.GetID_s(), text)
            name = str(text.Get().ToExtString())
            if XCAFDoc_ShapeTool.IsAssembly_s(product):
                walk(product, name, place.Multiplied(XCAFDoc_ShapeTool.GetLocation_s(label)))
                continue
            solid = XCAFDoc_ShapeTool.GetShape_s(product)
            # several solids of one product have a colour each
            pieces = [solid, TopoDS_Iterator(solid).Value()]
            assert any(colors.GetColor(piece, kind, color) for piece in pieces for kind in (XCAFDoc_ColorGen, XCAFDoc_ColorSurf))
            assert name not in found
            found[name] = (XCAFDoc_ShapeTool.GetShape_s(label).Moved(place), color.Red(), solid)
            above[name] = group

    walk(free.Value(1), "", TopLoc_Location())
    return found, above


def volume_and_centre(shape: Any) -> tuple[float, list[float]]:
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, properties)
    centre = properties.CentreOfMass()
    return properties.Mass(), [centre.X(), centre.Y(), centre.Z()]


def hooked(size: Any, hook: Any) -> TriMesh:
    """Return a block with a smaller one off its centre: no plane of symmetry, two solids that do not touch."""
    small = box(*hook)
    return merged([box(*size), TriMesh(small.vertices + np.asarray(size) + np.asarray(hook), small.triangles)])


@pytest.mark.parametrize("seed", range(5))
def test_a_part_without_a_brep_is_plane_faces_of_its_mesh(seed: int, tmp_path: Path) -> None:
    random = np.random.default_rng(seed)
    parts = []
    for index in range(6):
        size, hook = random.uniform(5, 40, 3), random.uniform(1, 4, 3)
        mesh = hooked(size, hook)
        if index == 2:
            mesh = merged([mesh, sphere(2.0).flipped()])  # a void
        if index == 3:
            turned = SE3.rot_x(random.uniform(0, 3)) @ SE3.trans(*random.uniform(-9, 9, 3))
            mesh = mesh.transformed(turned)
        if index == 4:
            normal = random.normal(size=3)
            S = np.eye(4)
            S[:3, :3] -= 2 * np.outer(normal, normal) / (normal @ normal)
            mesh = mesh.reflected(S)
        parts.append(Part.from_mesh(f"p{index}", mesh, color=f"#{16 * index + 9:02x}8040"))
    assembly = joined(*parts)

    read = read_by_occt(assembly, tmp_path)

    assert list(read) == [part.name for part in parts]
    for part, (shape, red, _) in zip(parts, read.values(), strict=True):
        assert part.mesh is not None
        volume, centre = volume_and_centre(shape)
        # the divergence theorem over the triangles, by this test itself
        a, b, c = (part.mesh.vertices[part.mesh.triangles[:, k]] for k in range(3))
        tetrahedra = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
        assert volume == pytest.approx(tetrahedra.sum(), rel=1e-9)
        assert centre == pytest.approx((tetrahedra[:, None] * (a + b + c) / 4).sum(axis=0) / tetrahedra.sum(), abs=1e-7)
        assert red == pytest.approx(((int(part.color[1:3], 16) / 255 + 0.055) / 1.055) ** 2.4, abs=1e-3)  # OCCT's colours are linear


def test_an_open_mesh_is_a_surface_and_a_part_without_shape_is_a_row(tmp_path: Path) -> None:
    whole = box(7, 8, 9)
    opened = Part.from_mesh("open", TriMesh(whole.vertices, whole.triangles[:-2]))
    assembly = joined(Part.from_mesh("base", box(10, 10, 10)), opened, Part.without_geometry("tip"))

    read = read_by_occt(assembly, tmp_path)

    assert list(read) == ["base", "open"]
    assert abs(opened.visuals[0].mesh.area - area(read["open"][0])) < 1e-9
    assert ("parts.tip", "nothing") in [(loss.where, loss.kept) for loss in write_step(assembly).losses]


def area(shape: Any) -> float:
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(shape, properties)
    return float(properties.Mass())


def test_parts_of_one_shape_and_colour_are_instances_of_one_product(assembly: Assembly, tmp_path: Path) -> None:
    first = next(iter(assembly.parts.values()))
    twins = [replace(first, name=name) for name in ("left", "right")]
    other = replace(first, name="painted", color="#00ff00")
    lean = joined(first, *twins, other)

    read = read_by_occt(lean, tmp_path)

    assert list(read) == ["base", "left", "right", "painted"]
    assert read["left"][2].IsSame(read["base"][2])
    assert not read["painted"][2].IsSame(read["base"][2])
    assert write_step(lean).files["joined.step"].count(b"MANIFOLD_SOLID_BREP") == 2
    from articad.importers.step import read_step

    assert list(read_step(tmp_path / "joined.step").parts) == ["base", "left", "right", "painted"]


def test_a_mesh_too_fine_for_plane_faces_is_an_error() -> None:
    n = 200
    grid = np.array([[i, j, 0.0] for i in range(n) for j in range(n)])
    i, j = np.meshgrid(np.arange(n - 1), np.arange(n - 1), indexing="ij")
    corner = (i * n + j).ravel()
    triangles = np.concatenate([np.stack([corner, corner + n, corner + 1], 1), np.stack([corner + 1, corner + n, corner + n + 1], 1)])

    with pytest.raises(ExportError, match="79202 triangles"):
        write_step(joined(Part.from_mesh("sheet", TriMesh(grid, triangles))))


PLATE = """
from build123d import *

def build(part):
    shape = Box(30, 20, 4) + Pos(10, 5, 6) * Cylinder(3, 10) + Pos(-9, -7, 4) * Box(5, 3, 9)
    return shape, CONNECTORS
"""
IMAGES = ["b", "c", "d", "e_1", "e_2", "f"]


def mirrored_plan(seed: int) -> dict[str, Any]:
    """Return a plan: a part without symmetry, mirrored in a random plane, that image mirrored again, moved and repeated."""
    random = np.random.default_rng(seed)

    def vector(size: float) -> list[float]:
        return [round(float(x), 3) for x in random.uniform(-size, size, 3)]

    def derived(name: str, source: str, op: str, **how: Any) -> dict[str, Any]:
        return {"name": name, "derive": {"from": source, "op": op, **how}}

    def plane() -> dict[str, Any]:
        return {"point": vector(50), "normal": [0.3, *vector(1)[1:]]}

    step = {"at": [40, 7, 3], "axis": [0.2, 0.3, 1], "angle_deg": 25}
    parts = [
        {"name": "a", "material": "steel", "description": "Plate.", "connectors": []},
        derived("b", "a", "mirror", plane=plane()),
        derived("c", "b", "mirror", plane=plane()),
        derived("d", "b", "rigid", move={"at": vector(90)}),
        derived("e", "d", "pattern", count=2, step=step),
        derived("f", "d", "mirror", plane=plane()),
    ]
    joints = [{"name": f"to_{name}", "type": "fixed", "parent": f"a.to_{name}", "child": f"{name}.o"} for name in IMAGES]
    connectors: list[dict[str, Any]] = [
        {"name": name, "o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "label": name} for name in ("o", *(f"to_{n}" for n in IMAGES))
    ]
    parts[0]["connectors"] = connectors
    plan: dict[str, Any] = {
        "schema": "articad.plan/1",
        "name": "images",
        "description": "Images of one part.",
        "ground": "a",
        "freedoms": 0,
        "materials": [{"name": "steel", "density_kg_m3": 7850, "color": "#8a9299"}],
        "parts": parts,
        "joints": joints,
    }
    # the plate has a connector for each image, where the image's own connector is at rest
    images = resolve(AssemblyPlan.loads(json.dumps(plan))).parts
    for connector in connectors[1:]:
        image = images[connector["name"].removeprefix("to_")]
        T = image.T_rest @ image.connectors["o"].frame
        connector |= {"o": T.translation.tolist(), "z": T.z_axis.tolist(), "x": T.x_axis.tolist()}
    return plan


@pytest.mark.parametrize("seed", range(3))
def test_mirror_images_are_written_as_mirrored_brep(seed: int, tmp_path: Path) -> None:
    plan = mirrored_plan(seed)
    held = {item["name"]: {axis: item[axis] for axis in "ozx"} for item in plan["parts"][0]["connectors"]}
    (tmp_path / "a.py").write_text(PLATE.replace("CONNECTORS", repr(held)))
    assembly = Assembly.from_plan(AssemblyPlan.loads(json.dumps(plan)), tmp_path)
    rest = assembly.mechanism.rest_poses()

    read = read_by_occt(assembly, tmp_path)

    assert list(read) == list(assembly.parts)
    assert not [loss for loss in write_step(assembly).losses if "mesh" in loss.lost]
    for name, (shape, _, _) in read.items():
        mesh = assembly.parts[name].mesh  # a mirrored mesh is the source's, reflected by numpy
        assert mesh is not None
        volume, centre = volume_and_centre(shape)
        assert volume == pytest.approx(mesh.volume, rel=2e-3)
        assert centre == pytest.approx(rest[name].apply(mesh.centroid), abs=0.02)
    assert read["d"][2].IsSame(read["e_1"][2])
    assert write_step(assembly).files["images.step"].count(b"MANIFOLD_SOLID_BREP") == 4  # a, b, c, f; d and e_* are b again
