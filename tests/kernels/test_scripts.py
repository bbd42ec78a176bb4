"""One script may build several parts: those that have no script of their own."""

from __future__ import annotations

from pathlib import Path

import pytest

from articad import Assembly
from articad.commands.watching import fingerprint
from articad.errors import ContractError, ReadError
from articad.kernels.parts import find_scripts
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan

COMMON = """
from build123d import Box, Cylinder

def build(part):
    d = part.dimensions
    return part.made(Cylinder(d.radius, d.high) if part.name == "post" else Box(d.wide, d.wide, d.high))
"""
OWN = "from build123d import Box\n\ndef build(part):\n    return part.made(Box(1, 2, part.dimensions.high))\n"


@pytest.fixture
def design(tmp_path: Path) -> Path:
    connector = {"name": "face", "kind": "mount_face", "z": [0, 0, 1], "x": [1, 0, 0]}
    parts = [
        {"name": "plate", "dimensions": {"wide": 40, "high": 4}, "connectors": [{**connector, "o": [0, 0, 2], "label": "top"}]},
        {
            "name": "post",
            "rest_pose": "auto",
            "dimensions": {"radius": 5, "high": 20},
            "connectors": [{**connector, "o": [0, 0, -10], "label": "foot"}],
        },
    ]
    plan = AssemblyPlan.from_json(
        {
            "schema": "articad.plan/1",
            "name": "stand",
            "ground": "plate",
            "freedoms": 0,
            "materials": [{"name": "steel", "density_kg_m3": 7850, "color": "#888888"}],
            "parts": [{**part, "material": "steel", "description": "Plain."} for part in parts],
            "joints": [{"name": "weld", "type": "fixed", "parent": "plate.face", "child": "post.face"}],
        }
    )
    (tmp_path / "plan.json").write_text(plan.dumps())
    (tmp_path / "parts.py").write_text(COMMON)
    return tmp_path


def test_one_script_beside_the_folder_builds_all_parts(design: Path) -> None:
    assembly = Assembly.from_plan(AssemblyPlan.load(design), design / "parts")
    masses = {name: part.mass.mass for name, part in assembly.parts.items() if part.mass}
    assert masses == pytest.approx({"plate": 7850e-9 * 6400, "post": 7850e-9 * 1570.8}, rel=1e-4)


def test_a_part_with_a_script_of_its_own_uses_that(design: Path) -> None:
    (design / "parts").mkdir()
    (design / "parts" / "plate.py").write_text(OWN)
    found = find_scripts(design / "parts", resolve(AssemblyPlan.load(design)), "build123d")
    assert found == {"plate": OWN.encode(), "post": COMMON.encode()}


def test_a_missing_script_is_reported_with_both_ways_to_write_it(design: Path) -> None:
    (design / "parts.py").unlink()
    with pytest.raises(ContractError) as caught:
        find_scripts(design / "parts", resolve(AssemblyPlan.load(design)), "build123d")
    assert [finding.where for finding in caught.value.findings] == ["parts.plate", "parts.post"]
    assert "plate.py" in caught.value.findings[0].hint
    assert "parts.py beside parts/" in caught.value.findings[0].hint


def test_a_common_script_that_is_a_link_is_refused(design: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    secret = tmp_path_factory.mktemp("other") / "secret.py"
    secret.write_text(COMMON)
    (design / "parts.py").unlink()
    (design / "parts.py").symlink_to(secret)
    with pytest.raises(ReadError, match="a link leads to it"):
        find_scripts(design / "parts", resolve(AssemblyPlan.load(design)), "build123d")


def test_a_change_of_the_common_script_is_seen_by_watch(design: Path) -> None:
    before = fingerprint(design)
    (design / "parts.py").write_text(COMMON + "\n")
    assert fingerprint(design) != before


@pytest.mark.parametrize("name", ["clear", "values", "items", "get"])
def test_a_dimension_may_have_the_name_of_a_method(name: str, design: Path) -> None:
    file = design / "plan.json"
    file.write_text(file.read_text().replace('"high"', f'"{name}"'))
    (design / "parts.py").write_text(COMMON.replace("d.high", f"d.{name}"))
    assembly = Assembly.from_plan(AssemblyPlan.load(design), design / "parts")
    assert assembly.parts["plate"].mass is not None
