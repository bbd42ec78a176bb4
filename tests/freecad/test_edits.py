"""Edits that FreeCAD makes in a document come back: taken over, or named one by one; none in silence."""

from __future__ import annotations

import json
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import articad as ac
from articad.export.freecad import write_freecad
from articad.findings import Findings
from articad.importers.freecad import read_freecad
from articad.kernels import freecad_install
from articad.kernels.freecad_install import FreeCAD, FreeCADLimits
from articad.kinematics.joints import Joint
from articad.runs.pull import compared, pull
from tests.freecad import cupboard, opened

pytestmark = [pytest.mark.freecad, opened.needs_freecad]
VERSIONS = [
    pytest.param(freecad_install.find if not opened.WHY_NOT else None, id="1.0"),
    pytest.param(opened.newer, id="1.1", marks=pytest.mark.freecad_next),
]
EDITS = [
    "nothing",
    "parameter",
    "dimension",
    "expression",
    "feature",
    "constraint",
    "feature_added",
    "feature_deleted",
    "part_added",
    "part_deleted",
    "joint_added",
    "joint_deleted",
    "joint_type",
    "joint_suppressed",
    "limits",
    "limit_off",
    "offset",
    "part_label",
    "joint_label",
    "connector",
    "material",
    "sheet_added",
    "part_taken_out",
    "described",
    "library_material",
    "parameter_added",
]


@cache
def content() -> bytes:
    bundle = write_freecad(cupboard.assembly())
    assert not bundle.findings
    return bundle.files[bundle.main]


@pytest.fixture(scope="session")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("edits")


def edited(folder: Path, freecad: FreeCAD, name: str) -> Path:
    """Return the document with one edit; all of them are made in one start of FreeCAD."""
    here = folder / freecad.version_text
    if not (here / "done.json").is_file():
        here.mkdir(exist_ok=True)
        (here / "it.FCStd").write_bytes(content())
        (here / "job.json").write_text(json.dumps({"edits": EDITS}))
        program = Path(__file__).with_name("edits_by_freecad.py")
        ended = freecad.run(program, folder=here, limits=FreeCADLimits(seconds=600.0))
        assert (here / "done.json").is_file(), ended.said
    return here / f"{name}.FCStd"


def named(findings: Findings, *words: str) -> bool:
    """Return whether one finding of an edit says all of these words."""
    said = [finding.message for finding in findings if finding.code in ("I_FREECAD_EDIT", "W_FREECAD_EDIT")]
    return any(all(word in message for word in words) for message in said)


NAMED = {  # words of the finding that names the edit
    "parameter": ("Parameters", "p_width", "400", "520"),
    "dimension": ("knob dimensions", "d_radius", "8", "11"),
    "expression": ("door_left dimensions", "d_wall", "* 1.5"),
    "feature": ("Stem", "Length", "33"),
    "constraint": ("Window", "Constraints", "15"),
    "feature_added": ("Bump", "added"),
    "feature_deleted": ("Window", "deleted"),
    "part_added": ("Lamp", "added"),
    "part_deleted": ("knob", "deleted"),
    "joint_added": ("mount", "added"),
    "joint_deleted": ("slide", "deleted"),
    "joint_type": ("slide", "JointType", "Slider", "Fixed"),
    "joint_suppressed": ("slide", "active"),
    "limits": ("slide", "LengthMax", "170", "120"),
    "limit_off": ("flap_hinge", "EnableAngleMax"),
    "offset": ("slide", "Offset1", "5"),
    "part_label": ("tray", "Keyboard tray"),
    "joint_label": ("slide", "Runner"),
    "connector": ("tray.rail", "Placement.Base.z", "4"),
    "material": ("tray", "ArticadMaterial", "brass"),
    "sheet_added": ("Notes", "added", "not adopted"),
    "part_taken_out": ("tray", "left the group"),
    "described": ("tray", "Label2", "for letters", "not adopted"),
    "library_material": ("tray body", "ShapeMaterial", "not adopted"),
    "parameter_added": ("Parameters", "p_spare", "7", "not adopted"),
}


@pytest.mark.parametrize("version", VERSIONS)
def test_a_document_that_freecad_only_recomputes_has_no_edits(version: object, folder: Path) -> None:
    read = read_freecad(edited(folder, version(), "nothing"))  # type: ignore[operator]
    assert not read.findings, read.findings
    made = cupboard.assembly()
    for name, part in made.parts.items():
        assert part.mass is not None
        mass = read.parts[name].mass
        assert mass is not None
        assert mass.mass == pytest.approx(part.mass.mass, rel=1e-9)
        assert read.parts[name].color == part.color


@pytest.mark.parametrize("name", sorted(NAMED))
@pytest.mark.parametrize("version", VERSIONS)
def test_an_edit_is_named_and_in_the_assembly(name: str, version: object, folder: Path) -> None:
    read = read_freecad(edited(folder, version(), name))  # type: ignore[operator]
    assert named(read.findings, *NAMED[name]), list(map(str, read.findings))
    right(name, read)


def right(name: str, read: ac.Assembly) -> None:
    """Hold an edited assembly to what the edit means, by arithmetic of our own."""
    joints = {joint.name: joint for joint in read.joints}
    volumes = {part.name: part.solid.volume for part in read.parts.values() if part.solid is not None}
    for part, volume in VOLUMES.get(name, {}).items():
        assert volumes[part] == pytest.approx(volume, rel=1e-9)
    for joint, kind in TYPES.get(name, {}).items():
        assert (joints[joint].type if joint in joints else None) == kind
    if name in JOINTS:
        assert JOINTS[name](joints)
    if name == "part_deleted":  # a link to the part that was deleted
        assert read.parts["stop"].mass is None
        assert [finding.parts for finding in read.findings.of("W_FREECAD_SHAPE")] == [("stop",)]
    elif name not in ("part_added", "material"):
        masses_are_of_shapes(read)


SLAB = 198 * 300
VOLUMES: dict[str, dict[str, float]] = {
    "parameter": {"cabinet": 520 * 16 * 300, "tray": 480 * 200 * 12},
    "dimension": {"knob": np.pi * 11**2 * 20, "stop": np.pi * 11**2 * 20},
    "expression": dict.fromkeys(("door_left", "door_right"), 24 * (SLAB - np.pi * 100)),
    "feature": {"knob": np.pi * 8**2 * 33},
    "constraint": dict.fromkeys(("door_left", "door_right"), 16 * (SLAB - np.pi * 225)),
    "feature_deleted": {"door_left": 16 * SLAB},
    "part_added": {"lamp": 30 * 20 * 10},
}
TYPES: dict[str, dict[str, str | None]] = {
    "part_added": {"lamp_mount": "fixed"},
    "part_deleted": {"grip": None},
    "joint_added": {"mount": "fixed", "slide": None},
    "joint_deleted": {"slide": None, "tray_loose": "free"},
    "joint_suppressed": {"slide": None, "tray_loose": "free"},
    "joint_type": {"slide": "fixed"},
    "joint_label": {"runner": "slider", "slide": None},
    "part_taken_out": {"slide": None},
}
JOINTS: dict[str, Callable[[dict[str, Joint]], bool]] = {
    "limits": lambda joints: joints["slide"].limits.upper == (120.0,),
    "limit_off": lambda joints: joints["flap_hinge"].limits.upper == (np.inf,),
    "offset": lambda joints: np.allclose(joints["slide"].T_parent_connector.translation, [5.0, 16.0, 300.0]),
    "part_label": lambda joints: joints["slide"].child == "keyboard_tray",
    "connector": lambda joints: np.allclose(joints["slide"].T_child_connector.translation, [0.0, 0.0, 4.0]),
}


def test_a_material_that_was_changed_gives_its_mass(folder: Path) -> None:
    read = read_freecad(edited(folder, freecad_install.find(), "material"))
    tray = read.parts["tray"]
    assert tray.mass is not None
    assert tray.mass.mass == pytest.approx(360 * 200 * 12 * 8500e-9, rel=1e-9)


def masses_are_of_shapes(read: ac.Assembly) -> None:
    """Hold mass, centre and inertia of each part to its shape and material; a mirror image's to the mirrored ones."""
    for part in read.parts.values():
        assert part.mass is not None
        assert part.solid is not None
        density = read.materials[str(part.material)].density
        assert part.mass.mass == pytest.approx(part.solid.volume * density * 1e-9, rel=1e-9), part.name
        assert part.mass.com == pytest.approx(part.solid.com, abs=1e-9), part.name
    left, image = (np.append(read.parts[name].mass.com, 1.0) for name in ("door_left", "door_right"))  # type: ignore[union-attr]
    stands = read.at()  # the plane of the mirror is x = 0 of the assembly
    assert (stands["door_right"].matrix @ image)[:3] == pytest.approx((stands["door_left"].matrix @ left)[:3] * [-1, 1, 1], abs=1e-6)


@pytest.mark.parametrize("version", VERSIONS)
def test_a_parameter_taken_home_gives_what_set_gives(version: object, folder: Path) -> None:
    path = edited(folder, version(), "parameter")  # type: ignore[operator]
    pulled = pull(cupboard.plan(), path)
    assert pulled.changes == {"parameters.width.value": 520.0}
    made = ac.Assembly.from_plan(pulled.plan, cupboard.SCRIPTS)
    wanted = cupboard.assembly(width=520.0)
    assert not compared(made, path)
    for name, part in wanted.parts.items():
        other = made.parts[name]
        assert part.mass is not None
        assert other.mass is not None
        assert (other.mass.mass, *other.mass.com) == pytest.approx((part.mass.mass, *part.mass.com), rel=1e-6, abs=1e-6)
    assert opened.small(opened.moved(dict(wanted.at()), dict(made.at())), 1e-6, 1e-6)


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("dimension", {"parts.knob.dimensions.radius": 11.0}),
        ("limits", {"joints.slide.travel_mm": [0, 120.0]}),
        ("feature", {}),
        ("joint_type", {}),
    ],
)
def test_what_a_plan_has_a_place_for_is_taken_home_and_the_rest_is_named(name: str, changes: dict[str, object], folder: Path) -> None:
    path = edited(folder, freecad_install.find(), name)
    pulled = pull(cupboard.plan(), path)
    assert pulled.changes == changes
    assert named(pulled.findings, *NAMED[name])
    assert ("W_FREECAD_EDIT" in pulled.findings.codes) is (not changes)
    if name == "feature":
        assert "parts.knob" in {finding.where for finding in compared(cupboard.assembly(), path)}
