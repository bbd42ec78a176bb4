"""The environment is checked and certified against, and stands in no file and in no mass."""

from __future__ import annotations

import copy
import json
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.export.bundle import Bundle
from articad.export.freecad import write_freecad_alone
from articad.export.gltf import write_glb
from articad.export.mjcf import write_mjcf
from articad.export.sdf import write_sdf
from articad.export.step import write_step
from articad.export.threemf import write_3mf
from articad.export.urdf import write_urdf
from articad.export.usd import write_usd
from articad.formats import FORMATS
from articad.plan.schema import AssemblyPlan

Json = dict[str, Any]
BLOCK = """from build123d import Align, Box
def build(part):
    d = part.dimensions
    return Box(d["x"], d["y"], d["z"], align=(Align.MIN, Align.CENTER, Align.MIN)), part.connectors
"""
WALL = "wall_to_stay_clear_of"
HAND = "room_for_a_hand"


def flap(wall_at: float) -> Json:
    """Return a post with an arm that turns about z, a wall beside it, which the arm meets if it is near, and room carried by the arm."""
    steel = {"material": "steel", "description": ""}
    up = {"z": [0, 0, 1], "x": [1, 0, 0], "label": ""}
    return {
        "schema": "articad.plan/1",
        "name": "flap",
        "ground": "post",
        "freedoms": 1,
        "materials": [{"name": "steel", "density_kg_m3": 7850, "color": "#8a9299"}],
        "parts": [
            {
                "name": "post",
                **steel,
                "dimensions": {"x": 20, "y": 20, "z": 30},
                "connectors": [{"name": "top", "o": [10, 0, 30], **up}, {"name": "site", "o": [0, wall_at, 0], **up}],
            },
            {
                "name": "arm",
                **steel,
                "rest_pose": "auto",
                "dimensions": {"x": 100, "y": 10, "z": 8},
                "connectors": [{"name": "axis", "o": [5, 0, 0], **up}, {"name": "tip", "o": [90, 0, 40], **up}],
            },
            {
                "name": WALL,
                **steel,
                "environment": True,
                "rest_pose": "auto",
                "dimensions": {"x": 200, "y": 5, "z": 200},
                "connectors": [{"name": "foot", "o": [100, 0, 0], **up}],
            },
            {
                "name": HAND,
                **steel,
                "environment": True,
                "rest_pose": "auto",
                "dimensions": {"x": 20, "y": 20, "z": 20},
                "connectors": [{"name": "middle", "o": [10, 0, 0], **up}],
            },
        ],
        "joints": [
            {"name": "turn", "type": "revolute", "parent": "post.top", "child": "arm.axis", "angle_deg": [0, 90]},
            {"name": "stand", "type": "fixed", "parent": "post.site", "child": f"{WALL}.foot"},
            {"name": "hold", "type": "fixed", "parent": "arm.tip", "child": f"{HAND}.middle"},
        ],
    }


def built(wall_at: float, *, environment: bool = True) -> Assembly:
    plan = flap(wall_at)
    if not environment:
        plan = copy.deepcopy(plan)
        for name in (WALL, HAND):
            plan["parts"] = [part for part in plan["parts"] if part["name"] != name]
        plan["joints"] = plan["joints"][:1]
    loaded = AssemblyPlan.loads(json.dumps(plan))
    return Assembly.from_plan(loaded, {part.name: BLOCK for part in loaded.parts})


@pytest.fixture(scope="module")
def clear() -> Assembly:
    return built(-60.0)


WRITERS_OF: dict[str, Callable[[Assembly], Bundle]] = {
    "urdf": write_urdf,
    "mjcf": write_mjcf,
    "sdf": write_sdf,
    "usd": write_usd,
    "step": write_step,
    "glb": write_glb,
    "3mf": write_3mf,
    "freecad": write_freecad_alone,
}


@pytest.mark.parametrize("name", WRITERS_OF)
def test_no_format_holds_the_environment(name: str, clear: Assembly) -> None:
    """The bytes of every file, and the losses, name no part of the environment."""
    bundle = WRITERS_OF[name](clear)
    assert bundle.files
    for file, content in bundle.files.items():
        assert not [word for word in (WALL, HAND) if word in file or word.encode() in content], file
    assert not any(WALL in row.where or HAND in row.where for row in bundle.losses)


def test_a_model_weighs_and_moves_as_if_there_was_no_environment(clear: Assembly) -> None:
    alone = built(-60.0, environment=False)
    assert clear.mass().mass == pytest.approx(alone.mass().mass)
    assert np.allclose(clear.mass().com, alone.mass().com)
    ours, theirs = write_urdf(clear), write_urdf(alone)
    (main,) = (name for name in ours.files if name.endswith(".urdf"))
    assert ours.files[main] == theirs.files[main]


def test_it_need_not_touch_and_is_collided_with() -> None:
    """The arm reaches 95 mm: it meets a wall at 60 mm on its way to 90 degrees, and not one at -60 mm."""
    for wall_at, free in ((-60.0, True), (60.0, False)):
        assembly = built(wall_at)
        assert assembly.check().ok, assembly.check().findings
        moved = assembly.check_motion()
        assert moved.ok == free
        proof = assembly.certify(budget=60.0)
        assert proof.ok == free
        assert (WALL in json.dumps(proof.to_json())) is True
        if not free:
            assert any(WALL in finding.parts for finding in moved.findings)


def test_room_that_a_moving_part_carries_is_kept_free() -> None:
    """The room stands 40 to 60 mm above the arm, at z from 70 to 90: a roof there is met at rest."""
    plan = flap(-60.0)
    plan["parts"][0]["connectors"].append({"name": "roof", "o": [0, 0, 75], "z": [0, 0, 1], "x": [1, 0, 0], "label": ""})
    roof = {**plan["parts"][2], "name": "roof", "environment": False, "dimensions": {"x": 200, "y": 50, "z": 5}}
    plan["parts"].append(roof | {"connectors": [{**roof["connectors"][0], "o": [0, 0, 0]}]})
    plan["joints"].append({"name": "span", "type": "fixed", "parent": "post.roof", "child": "roof.foot"})
    loaded = AssemblyPlan.loads(json.dumps(plan))
    found = Assembly.from_plan(loaded, {part.name: BLOCK for part in loaded.parts}).check().findings
    assert any(finding.code == "E_OVERLAP" and set(finding.parts) == {HAND, "roof"} for finding in found)
    assert "E_NOT_TOUCHING" in found.codes  # the roof itself is of the product: it has to be held


def test_every_writer_is_walked() -> None:
    assert set(WRITERS_OF) == {row.name for row in FORMATS} - {"plan"}  # a plan is the design itself
