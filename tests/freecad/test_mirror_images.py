"""A mirror image of a part stands where the part's shape is placed, however its script turns and moves that shape."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import articad as ac
from articad.export.freecad import write_freecad
from articad.kernels import freecad_install
from articad.kernels.freecad_install import FreeCAD
from tests.freecad import opened

pytestmark = [pytest.mark.freecad, opened.needs_freecad]

SCRIPT = """
from build123d import Align, Box, Cylinder, Location

def build(part):
    d = part.dimensions
    if part.name == "base":
        return part.made(Box(d.wide, d.wide, d.wide))
    shape = Box(d.wide, 2 * d.wide, 3 * d.wide, align=(Align.MIN, Align.CENTER, Align.CENTER)) - Cylinder(d.wide / 4, 9 * d.wide)
    return part.made(Location(({at}), ({turn})) * shape)
"""


def plan(normal: list[float]) -> dict[str, object]:
    plane = {"point": [0, 0, 0], "normal": normal}
    return {
        "schema": "articad.short/1",
        "name": "mirrored",
        "ground": "base",
        "freedoms": 0,
        "parameters": {},
        "parts": {
            "base": {"material": "steel", "dimensions": "wide=5"},
            "left": {"material": "steel", "dimensions": "wide=8", "rest_pose": {"at": [-50, 10, 20]}},
            "right": {"derive": {"from": "left", "op": "mirror", "plane": plane}},
        },
        "joints": {
            "weld_l": {"type": "fixed", "parent": "base", "child": "left", "at": [[-50, 0, 0], [-1, 0, 0]]},
            "weld_r": {"derive": {"from": "weld_l", "op": "mirror"}, "parent": "base", "child": "right"},
        },
    }


@pytest.mark.parametrize("freecad", [freecad_install.find, pytest.param(opened.newer, marks=pytest.mark.freecad_next)], ids=["1.0", "next"])
@pytest.mark.parametrize("seed", range(3))
def test_a_mirror_image_of_a_turned_shape_is_where_the_part_is(seed: int, freecad: Callable[[], FreeCAD], tmp_path: Path) -> None:
    rng = np.random.default_rng(seed)
    numbers = [", ".join(map(str, rng.uniform(-scale, scale, 3).round(2))) for scale in (40, 180)]
    (tmp_path / "parts.py").write_text(SCRIPT.format(at=numbers[0], turn=numbers[1]))
    (tmp_path / "plan.json").write_text(json.dumps(plan(np.eye(3)[seed].tolist())))
    assembly = ac.build(ac.AssemblyPlan.load(tmp_path), tmp_path / "parts")
    bundle = write_freecad(assembly)
    assert not bundle.findings, bundle.findings
    (look,) = opened.steps(bundle.files[bundle.main], {"do": "look"}, freecad=freecad())
    for part in assembly.parts.values():
        assert part.solid is not None
        assert look["volumes"][part.name] == pytest.approx(part.solid.volume, rel=1e-6)
        assert np.asarray(look["boxes"][part.name]) == pytest.approx(part.solid.bbox, abs=2e-3), part.name
