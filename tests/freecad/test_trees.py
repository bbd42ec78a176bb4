"""Feature trees of build123d scripts: random scripts, edited in FreeCAD, against the script built again."""

from __future__ import annotations

import json
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import articad as ac
from articad.export.freecad import write_freecad
from articad.kernels import freecad_install
from articad.kernels.freecad_install import FreeCAD, FreeCADLimits
from articad.runs.pull import compared, pull
from tests.freecad import opened

pytestmark = [pytest.mark.freecad, opened.needs_freecad]
FREECADS = [freecad_install.find, pytest.param(opened.newer, marks=pytest.mark.freecad_next)]
BEFORE, AFTER = {"a": 40.0, "b": 24.0, "c": 10.0, "t_deg": 20.0}, {"a": 43.0, "b": 22.5, "c": 10.75, "t_deg": 26.0}
HEAD = """from math import cos, radians, sin
from build123d import *

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    a, b, c, t = (part.dimensions[name] for name in ("a", "b", "c", "t_deg"))
"""
END = '\n    return it, {"here": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}\n'
BASES = (
    "    it = Box(a, b, c, align=LOW)",
    "    it = Cylinder(b / 2 + 4, c, align=LOW)",
    "    it = extrude(Pos(a / 4, 0) * SlotCenterToCenter(a / 2, b) - Circle(c / 4), c)",
    "    it = extrude(Polygon((-a / 2, -b / 2), (a / 2, -b / 2), (a / 3, b / 2), (-a / 3, b / 2), align=None), c)",
    "    it = extrude(Rectangle(a, b) & Circle(a / 2.2), c)",
    "    it = extrude(RectangleRounded(a, b, c / 3), c)",
    "    it = extrude(make_hull([e for x in (-a / 4, a / 4) for e in (Pos(x, 0) * Circle(b / 2)).edges()]), c)",
    "    it = revolve(Plane.XZ * Polygon((c / 4, 0), (b / 2 + 4, 0), (b / 2 + 4, c), (c / 4, c), align=None), Axis.Z)",
)
STEPS = (
    "    it += Pos(a / 8, 0, c / 2) * Cylinder(c / 2, 2 * c, align=LOW)",
    "    it -= Pos(a / 9, b / 9, 0) * Cylinder(c / 5, 8 * c)",
    "    it -= Rot(X=90) * Pos(0, c / 2, 0) * Cylinder(c / 6, 4 * b)",
    "    it += Pos(0, 0, c) * Rot(Z=t) * Box(b / 3, c / 3, c / 2)",
    "    it += Pos(b / 5 * cos(radians(t)), b / 5 * sin(radians(t)), c * 0.8) * Sphere(c / 2)",
    "    it -= [Pos(x, 0, c) * Cone(c / 5, c / 3, c / 2) for x in (-b / 4, b / 4)]",
    "    it &= Pos(0, 0, -c) * Box(max(a, b) * 3, b * 3, c * 2.7, align=LOW)",
    "    it += mirror(Pos(a / 10, 0, c * 0.9) * Box(c, c / 2, c / 2), about=Plane.YZ)",
    "    it = Rot(Y=90) * it",
    "    it += Plane.XZ.offset(c / 9) * extrude(Circle(c / 3), b / 2)",
)
EDGES = "    it = {}(it.edges().group_by(Axis.Z)[0], c / 12)"


def script(seed: int) -> str:
    """Return a random script; its connector is where the plan has it."""
    rng = random.Random(seed)
    body = [BASES[seed % len(BASES)]]
    if rng.random() < 0.5:
        body.append(EDGES.format(rng.choice(("fillet", "chamfer"))))
    body += rng.sample(STEPS, rng.randint(1, 3))
    return HEAD + "\n".join(body) + END


def plan() -> ac.AssemblyPlan:
    connector = {"name": "here", "o": [0, 0, 0], "z": [0, 0, 1], "x": [1, 0, 0], "label": "origin"}
    part = {"name": "it", "material": "steel", "description": "Anything.", "dimensions": {key: key for key in BEFORE}}
    return ac.AssemblyPlan.model_validate(
        {
            "schema": "articad.plan/1",
            "name": "trees",
            "ground": "it",
            "parameters": [{"name": key, "value": number, "unit": "deg" if key == "t_deg" else "mm"} for key, number in BEFORE.items()],
            "materials": [{"name": "steel", "density_kg_m3": 7850, "color": "#808080"}],
            "parts": [part | {"connectors": [connector]}],
            "joints": [],
            "freedoms": 0,
        }
    )


def written(text: str, folder: Path) -> tuple[ac.Assembly, bytes, tuple[Any, ...]]:
    made = ac.build(plan(), _with(text, folder))
    bundle = write_freecad(made, trees=True)
    assert bundle.findings.ok, bundle.findings
    return made, bundle.files[bundle.main], bundle.losses


def holds(text: str, folder: Path, freecad: FreeCAD) -> bool:
    """Edit the live parameters of a script's document in FreeCAD, compare it with the script at these values; return whether any is live."""
    made, content, losses = written(text, folder)
    (look,) = opened.steps(content, {"do": "look"}, freecad=freecad)
    live = {name[2:] for name, (_, _, editable) in look["parameters"].items() if editable}
    frozen = any("(frozen)" in label for label in look["labels"].values())
    if frozen:
        assert not live
        assert any(loss.where == "parts.it" and loss.kept != "its B-rep" for loss in losses), losses
        return False
    values = {name: AFTER[name] for name in live}
    (after,) = opened.steps(content, {"do": "set", "values": values}, freecad=freecad)
    solid = made.with_parameters(**values).parts["it"].solid
    assert solid is not None
    assert after["invalid"] == []
    assert after["volumes"]["it"] == pytest.approx(solid.volume, rel=1e-6)
    assert np.asarray(after["boxes"]["it"]) == pytest.approx(solid.bbox, abs=2e-3)
    return bool(live)


@pytest.mark.parametrize("freecad", FREECADS, ids=["1.0", "next"])
def test_a_traced_part_follows_an_edit_as_its_script_does(freecad: Callable[[], FreeCAD], tmp_path: Path) -> None:
    body = (BASES[3], EDGES.format("chamfer"), STEPS[0], STEPS[1], STEPS[4])
    assert holds(HEAD + "\n".join(body) + END, tmp_path, freecad())


def test_what_the_tree_does_not_follow_is_fixed_with_the_reason(tmp_path: Path) -> None:
    text = HEAD + "    it = Box(float(f'{a}'), b, c)" + END.replace("it,", "Rot(Z=t) * it,")
    _, content, losses = written(text, tmp_path)
    (look,) = opened.steps(content, {"do": "look"})
    editable = {name: row[2] for name, row in look["parameters"].items()}
    assert editable == {"p_a": False, "p_b": True, "p_c": True, "p_t_deg": True}
    assert "a of it" in look["parameters"]["p_a"][1]
    assert [loss.where for loss in losses] == ["parts.it.dimensions.a"]
    assert any("(a fixed)" in label for label in look["labels"].values())


def test_a_part_that_cannot_be_traced_is_frozen_with_the_reason(tmp_path: Path) -> None:
    text = HEAD + "    it = extrude(Ellipse(a, b), c)" + END
    _, content, losses = written(text, tmp_path)
    (look,) = opened.steps(content, {"do": "look"})
    assert not any(row[2] for row in look["parameters"].values())
    assert any("(frozen" in label for label in look["labels"].values())
    (loss,) = [loss for loss in losses if loss.where == "parts.it"]
    assert "line 9: Ellipse is not recorded" in loss.kept


@pytest.mark.parametrize("split", [False, True], ids=["one", "split"])
@pytest.mark.parametrize("freecad", FREECADS, ids=["1.0", "next"])
def test_an_edited_parameter_is_pulled_and_an_edited_feature_is_named(freecad: Callable[[], FreeCAD], split: bool, tmp_path: Path) -> None:
    text = HEAD + "\n".join((BASES[0], STEPS[0])) + END
    bundle = write_freecad(ac.build(plan(), _with(text, tmp_path)), trees=True, split=split)
    assert not bundle.findings, bundle.findings
    main = bundle.write(tmp_path / "document")[0]
    (main.parent / "job.json").write_text(json.dumps({"file": main.name}))
    program = Path(__file__).with_name("tree_edits_by_freecad.py")
    ended = freecad().run(program, folder=main.parent, limits=FreeCADLimits(seconds=300.0))
    assert (main.parent / "done.json").is_file(), ended.said
    cylinder = json.loads((main.parent / "done.json").read_text())
    pulled = pull(plan(), main)
    assert pulled.changes == {"parameters.a.value": 43.0}
    named = pulled.findings.of("W_FREECAD_EDIT")
    assert any("Radius" in finding.message and "7" in finding.message for finding in named)
    assert all(finding.where == f"objects.{cylinder}" for finding in named), list(map(str, named))
    (other,) = compared(ac.build(pulled.plan, tmp_path), main)  # the plan has the script's radius
    assert other.where == "parts.it"


@pytest.mark.soak
def test_random_scripts_follow_an_edit(tmp_path: Path) -> None:
    assert sum(_holds_if_it_builds(seed, tmp_path / str(seed)) for seed in range(40)) >= 20


def _holds_if_it_builds(seed: int, folder: Path) -> bool:
    folder.mkdir()
    try:
        ac.build(plan(), _with(script(seed), folder))
    except ac.ArticadError:  # a random script may build no one solid
        return False
    return holds(script(seed), folder, freecad_install.find())


def _with(text: str, folder: Path) -> Path:
    (folder / "it.py").write_text(text)
    return folder
