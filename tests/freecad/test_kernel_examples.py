"""Every example of the FreeCAD kernel's functions builds the solid that its words mean."""

from __future__ import annotations

import ast
import json
import textwrap
from collections.abc import Callable
from math import pi
from pathlib import Path

import pytest

from articad.kernels import freecad_install
from articad.kernels.freecad_install import FreeCAD, FreeCADLimits
from tests.freecad import opened

pytestmark = [pytest.mark.freecad, opened.needs_freecad]
KERNEL = Path(freecad_install.__file__).parent / "inside_freecad" / "part.py"
DIMENSIONS = {"width": 60.0, "depth": 40.0, "height": 20.0, "radius": 5.0, "turn_deg": 90.0}
BLOCK, BORE = 60 * 40 * 20.0, pi * 5**2 * 20
VOLUMES = {  # mm³, in closed form
    "expression": BLOCK,
    "length": BLOCK / 2,
    "angle": pi * (9**2 - 5**2) * 20 / 4,
    "number": 60 * 40 * 4,
    "tie": 60 * 40 * 15,
    "sketch": pi * 5**2 * 40,
    "polygon": BLOCK / 2,
    "path": pi * 5**2 * 80,
    "rectangle": BLOCK,
    "circle": BORE,
    "slot": (60 * 10 + pi * 5**2) * 20,
    "axis": pi * (9**2 - 5**2) * 20,
    "pad": BLOCK,
    "pocket": BLOCK - BORE,
    "revolution": BORE,
    "loft": 20 / 3 * (60 * 40 + 30 * 20 + 60 * 20),
    "sweep": 10 * 10 * 80,
    "sphere": 4 / 3 * pi * 5**3,
    "fillet": BLOCK - 2 * (60 + 40) * 2.5**2 * (1 - pi / 4) + 4 * 2.5**3 * (5 / 3 - pi / 2),
    "chamfer": BLOCK - 2 * (60 + 40) * 2.5**2 / 2 + 4 / 3 * 2.5**3,
    "cylinder": BLOCK - BORE,
    "box": BLOCK,
    "linear_pattern": BLOCK - 3 * BORE,
    "polar_pattern": pi * 40**2 * 20 - 4 * BORE,
    "connector": BLOCK,
    "made": BLOCK,
    "settle": BLOCK - 2**2 / 2 * 20,
}


def examples() -> dict[str, str]:
    (offered,) = [node for node in ast.parse(KERNEL.read_text()).body if isinstance(node, ast.ClassDef) and node.name == "Authoring"]
    functions = [node for node in offered.body if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")]
    told = {node.name: ast.get_docstring(node) or "" for node in functions if not node.decorator_list}
    return {name: textwrap.dedent(text.partition("\n\nExample:\n")[2]) for name, text in told.items()}


@pytest.mark.parametrize("freecad", [freecad_install.find, pytest.param(opened.newer, marks=pytest.mark.freecad_next)], ids=["1.0", "next"])
def test_every_example_calls_its_function_and_builds_its_solid(freecad: Callable[[], FreeCAD], tmp_path: Path) -> None:
    assert set(examples()) == set(VOLUMES)
    assert all(f"part.{name}(" in text for name, text in examples().items())
    kernel = KERNEL.read_text().rpartition("\nmain(")[0]
    (tmp_path / "job.json").write_text(json.dumps({"kernel": kernel, "examples": examples(), "dimensions": DIMENSIONS}))
    program = Path(__file__).with_name("examples_by_freecad.py")
    ended = freecad().run(program, folder=tmp_path, limits=FreeCADLimits(seconds=300.0))
    assert (tmp_path / "report.json").is_file(), ended.said
    for name, made in json.loads((tmp_path / "report.json").read_text()).items():
        assert (made["solids"], made["valid"], made["invalid"]) == (1, True, []), name
        assert made["volume"] == pytest.approx(VOLUMES[name], rel=1e-9), name
