"""STEP assemblies are read back by OpenCASCADE: names, places, colours, volumes."""

from __future__ import annotations

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
from articad.geometry.part import Part, Solid
from articad.geometry.shapes import box
from articad.kinematics import declare
from tests.assemblies import geared_pair

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
    assert [child.label for child in read.children] == [name.replace(" ", "_") for name in assembly.parts]
    for child, (name, part) in zip(read.children, assembly.parts.items(), strict=True):
        matrix = np.array([[child.location.wrapped.Transformation().Value(row, column) for column in (1, 2, 3, 4)] for row in (1, 2, 3)])
        assert part.solid is not None
        assert child.volume == pytest.approx(part.solid.volume, rel=1e-9)
        assert np.allclose(matrix, rest[name].matrix[:3], atol=1e-9)
        assert next(iter(child.color)) == pytest.approx(int(part.color[1:3], 16) / 255, abs=1e-6)


def test_the_same_assembly_is_the_same_bytes(assembly: Assembly) -> None:
    assert write_step(assembly).files == write_step(assembly).files


def test_losses_are_told_and_strict_refuses(assembly: Assembly) -> None:
    losses = write_step(assembly).losses

    assert [(loss.where, loss.refused) for loss in losses][:2] == [("joints.j", True), ("parts.base", False)]
    with pytest.raises(UnrepresentableError):
        write_step(assembly, strict=True)


def test_a_part_without_a_brep_is_left_out(assembly: Assembly) -> None:
    first, *others = assembly.parts.values()
    parts = [replace(first, solid=None), *others]
    lean = Assembly.from_parts("lean", parts=parts, joints=assembly.joints, ground="base")
    bundle = write_step(lean)

    assert [loss.where for loss in bundle.losses if "B-rep" in loss.lost] == ["parts.base"]
    assert b"PRODUCT('base'" not in bundle.files["lean.step"]


def test_nothing_to_write_is_an_error() -> None:
    with pytest.raises(ExportError, match="No part"):
        write_step(geared_pair())


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
