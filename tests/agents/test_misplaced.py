"""A shape that a script built elsewhere is its author's."""

from __future__ import annotations

from typing import Any

import pytest

from articad.agents.evidence import examine
from articad.assembly import Assembly
from articad.findings import Finding
from articad.plan.schema import AssemblyPlan
from tests.agents import stories

WIDTH, RADIUS, PIN = 6.0, 12.0, 4.0
POST = f"""
from build123d import Align, Box, Cylinder, Pos

def build(part):
    low = (Align.CENTER, Align.CENTER, Align.MIN)
    return Pos(0, 0, -5) * Box(30, 30, 5, align=low) + Cylinder({PIN}, 24, align=low), dict(part.connectors)
"""
WHEEL = """
from build123d import Align, Box, Cylinder, Pos, Rot, mirror, Plane

def build(part):
    d = part.dimensions
    low = (Align.CENTER, Align.CENTER, Align.MIN)
    shape = Cylinder(d["radius"], d["width"], align=low) + Pos(d["radius"], 0, 0) * Box(6, 4, d["width"], align=low)
    shape -= Cylinder(d["bore"], d["width"], align=low)
    return MOVED, dict(part.connectors)
"""


def product(moved: str, names: tuple[str, ...] = ("low", "middle", "high")) -> Assembly:
    """Wheels above each other on a pin; the script of the one named "middle" moves its shape."""
    axis: dict[str, Any] = {"z": [0, 0, 1], "x": [1, 0, 0], "label": "axis"}
    heights = {name: 0.1 + (WIDTH + 0.2) * at for at, name in enumerate(names)}
    wheels = [
        {
            "name": name,
            "material": "steel",
            "description": "A wheel.",
            "dimensions": {"radius": RADIUS, "width": WIDTH, "bore": PIN + 0.2},
            "rest_pose": {"at": [0, 0, height]},
            "connectors": [axis | {"name": "bore", "o": [0, 0, 0]}],
        }
        for name, height in heights.items()
    ]
    post = {
        "name": "post",
        "material": "steel",
        "description": "A pin on a plate.",
        "connectors": [axis | {"name": f"at_{name}", "o": [0, 0, height]} for name, height in heights.items()],
    }
    document = {
        "schema": "articad.plan/1",
        "name": "wheels",
        "ground": "post",
        "freedoms": len(names),
        "materials": [{"name": "steel", "density_kg_m3": 7850, "color": "#8a9299"}],
        "parts": [post, *wheels],
        "joints": [
            {"name": name, "type": "revolute", "parent": f"post.at_{name}", "child": f"{name}.bore", "angle_deg": "endless"}
            for name in names
        ],
    }
    scripts = {"post": POST} | {name: WHEEL.replace("MOVED", moved if name == "middle" else "shape") for name in names}
    return Assembly.from_plan(AssemblyPlan.from_json(document), scripts, kernel=stories.kernel(), cache=stories.shared_cache(), jobs=1)


def errors(assembly: Assembly) -> list[Finding]:
    return list(examine(assembly).findings.errors)


@pytest.mark.parametrize("moved", ["Rot(X=90) * shape", "mirror(shape, Plane.XY)"], ids=["turned", "mirrored"])
def test_a_shape_that_is_right_when_it_is_moved_as_a_whole_is_its_authors(moved: str) -> None:
    found = errors(product(moved))

    assert found
    assert {(finding.route, finding.where) for finding in found} == {("code", "parts.middle")}
    assert moved.startswith("Rot") or all("mirrored at z = 0" in finding.hint for finding in found)


def test_wheels_as_they_were_ordered_have_no_fault() -> None:
    assert errors(product("shape")) == []
