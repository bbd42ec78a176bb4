"""Every part of an assembly is in every format, under its name, where another program reads the file; or the export is not ok.

A part without a shape is a frame: formats of mechanisms and GLB have it as a frame, STEP and 3MF name it in their losses.
"""

from __future__ import annotations

import io
import json
import re
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree

from articad.agents.pipeline import replay
from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.errors import ExportError
from articad.export.bundle import Bundle
from articad.export.names import valid_name
from articad.export.threemf import write_3mf
from articad.formats import NAMED
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part, Shape
from articad.geometry.shapes import box, cylinder
from articad.kinematics import declare
from articad.plan.schema import AssemblyPlan
from articad.runs.record import assembly_of
from articad.runs.run import Run
from tests.assemblies import all_joint_kinds, block, four_bar, frame, geared_pair
from tests.export.test_step import instances_in, volume_and_centre

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = [*sorted(path.parent for path in ROOT.glob("examples/*/plan.json")), ROOT / "tests/fixtures/five_joints"]
RECORDED = sorted(path.parent for path in ROOT.glob("examples/*/recording/request.json"))
ANSWERED = sorted({path.parent for path in (ROOT / "tests" / "recordings").rglob("request.json")})
WITHIN = 0.02  # of a volume: facets of round faces

pytestmark = [pytest.mark.engines, pytest.mark.filterwarnings("ignore::DeprecationWarning:yourdfpy")]

Shapes = dict[str, int]  # parts that another program finds, by valid name, and how many shapes each is drawn with


def in_pinocchio(path: Path, _bundle: Bundle) -> Shapes:
    import pinocchio as pin

    model = pin.buildModelFromUrdf(str(path))
    drawn = pin.buildGeomFromUrdf(model, str(path), pin.GeometryType.VISUAL, package_dirs=[str(path.parent)])
    found = {frame.name: 0 for frame in model.frames if frame.type == pin.BODY}
    for shape in drawn.geometryObjects:
        found[model.frames[shape.parentFrame].name] += 1
    return found


def in_mujoco(path: Path, _bundle: Bundle) -> Shapes:
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(path))
    return {model.body(index).name: int(model.body_geomnum[index]) for index in range(model.nbody)}


def in_xml(path: Path, _bundle: Bundle) -> Shapes:
    """SDFormat by its text: links with visuals whose mesh files are there."""
    found = {}
    for link in etree.parse(path).getroot().find("model").iterfind("link"):
        meshes = [uri.text for uri in link.iterfind("visual/geometry/mesh/uri")]
        assert all((path.parent / name).is_file() for name in meshes)
        found[link.get("name")] = len(link.findall("visual/geometry"))
    return found


def in_usd(path: Path, _bundle: Bundle) -> Shapes:
    """Visual shapes of each body, which are in a scope of their own."""
    usd, geom = pytest.importorskip("pxr.Usd"), pytest.importorskip("pxr.UsdGeom")
    stage = usd.Stage.Open(str(path))
    return {
        prim.GetName(): sum(below.IsA(geom.Gprim) for below in usd.PrimRange(prim.GetChild("visuals"))) if prim.GetChild("visuals") else 0
        for prim in stage.Traverse()
        if prim.IsA(geom.Xform)
    }


def in_trimesh(path: Path, _bundle: Bundle) -> Shapes:
    import trimesh

    scene = trimesh.load_scene(path)
    own = set(scene.graph.nodes_geometry)
    below = scene.graph.transforms.children
    # trimesh names the primitives of a node with several after it, and puts them below
    return {
        str(node): sum(other in own and str(other).startswith(str(node)) for other in (node, *below.get(node, ())))
        for node in scene.graph.nodes
    }


def in_occt(path: Path, _bundle: Bundle) -> Shapes:
    return {valid_name(name): 1 for name in instances_in(path)[0]}


def in_print_pack(path: Path, bundle: Bundle) -> Shapes:
    import trimesh

    found = {}
    for name, content in bundle.files.items():
        scene = trimesh.load_scene(path.parent / name)
        with zipfile.ZipFile(io.BytesIO(content)) as package:
            (label,) = re.findall(r'<object [^>]*name="([^"]*)"', package.read("3D/3dmodel.model").decode())
        found[valid_name(label)] = len(scene.geometry)
    return found


def in_zip(path: Path, _bundle: Bundle) -> Shapes:
    """A FreeCAD document by its XML: the parts of the assembly, and links to others of them."""
    with zipfile.ZipFile(path) as package:
        document = etree.fromstring(package.read("Document.xml"))
    parts = [item.get("name") for item in document.iterfind("Objects/Object") if item.get("type") in {"App::Part", "App::Link"}]
    labels = {
        item.get("name"): item.find("Properties/Property[@name='Label']/String").get("value")
        for item in document.iterfind("ObjectData/Object")
    }
    return {valid_name(labels[name]): 1 for name in parts}


def in_json(path: Path, _bundle: Bundle) -> Shapes:
    """A plan: its parts, those of a pattern by their numbers."""
    found: Shapes = {}
    for part in json.loads(path.read_text())["parts"]:
        count = part.get("derive", {}).get("count")
        found |= {f"{part['name']}_{number}" if count else part["name"]: 1 for number in range(1, (count or 1) + 1)}
    return found


READERS: dict[str, Callable[[Path, Bundle], Shapes]] = {
    "urdf": in_pinocchio,
    "mjcf": in_mujoco,
    "sdf": in_xml,
    "usd": in_usd,
    "glb": in_trimesh,
    "step": in_occt,
    "3mf": in_print_pack,
    "freecad": in_zip,
    "plan": in_json,
}
LEAVES_OUT = {"step", "3mf"}  # parts without a shape, each with a row


def shaped(assembly: Assembly) -> set[str]:
    return {name for name, part in assembly.parts.items() if part.solid is not None or part.visuals or part.collisions}


def assert_every_part_is_there(assembly: Assembly, name: str, folder: Path, **options: Any) -> Bundle:
    """Write an assembly, let another program read the file, and hold it to the assembly's parts."""
    bundle = NAMED[name].write(assembly, **options)
    bundle.write(folder / name)
    found = READERS[name](folder / name / bundle.main, bundle)
    kept = {loss.where.partition(".")[2]: loss for loss in bundle.losses if loss.where.startswith("parts.") and "shape" in loss.lost}
    names = {loss.where.partition(".")[2]: loss.kept for loss in bundle.losses if loss.lost.startswith("the name as given")}
    renamed = {part: kept.rpartition("(")[2].rstrip(")") for part, kept in names.items()}
    for part in assembly.parts:
        label = next((one for one in (renamed.get(part, ""), valid_name(part), valid_name(part).lower()) if one in found), None)
        if name == "sdf" and part == "world" and part not in shaped(assembly):
            assert b"<parent>world</parent>" in bundle.files[bundle.main]  # the world of SDFormat itself: no link of the model
            continue
        if part not in shaped(assembly) and name in LEAVES_OUT:
            assert label is None
            assert kept[part].kept == "nothing"
            continue
        assert label is not None, (name, part, sorted(found))
        if part in shaped(assembly):
            assert found[label] > 0, (name, part)
    return bundle


@pytest.mark.parametrize("name", READERS)
def test_the_walk_has_a_reader_for_every_format(name: str) -> None:
    assert READERS.keys() == NAMED.keys()
    assert name in NAMED


def frames_and_shapes() -> Assembly:
    """Return a world without a shape, a mirrored part, one that is only drawn, one that only collides, and a frame at the end."""
    world = Part.without_geometry("world", block("w", o=frame()).connectors)
    arm = block("arm", (9, 8, 30), root=frame(at=(0, 0, -10)), tip=frame(at=(1, 2, 15), z=(1, 0, 0)))
    S = np.diag([-1.0, 1.0, 1.0, 1.0])
    parts = [world, arm, arm.mirrored("mra", S)]
    for name in ("drawn", "hit"):
        shapes = Shape(cylinder(3.0, 20.0), SE3.trans(1, 0, 4), name=name), Shape(box(2, 3, 4), SE3.trans(0, 0, 20))
        part = replace(block(name, root=frame(), tip=frame(at=(0, 0, 30))), solid=None, visuals=(), collisions=())
        parts.append(replace(part, visuals=shapes) if name == "drawn" else replace(part, collisions=shapes))
    parts.append(Part.without_geometry("tcp", block("t", root=frame()).connectors))
    joints = [
        declare.fixed("stand", parts[0]["o"], parts[1]["root"]),
        declare.revolute("turn", parts[1]["tip"], parts[2]["root"], limits=(-1, 1)),
        declare.slider("slide", parts[2]["tip"], parts[3]["root"], limits=(0, 30)),
        declare.fixed("hold", parts[3]["tip"], parts[4]["root"]),
        declare.fixed("flange", parts[4]["tip"], parts[5]["root"]),
    ]
    return Assembly.from_parts("frames", parts=parts, joints=joints, ground="world")


MADE: dict[str, Callable[[], Assembly]] = {"frames": frames_and_shapes, "kinds": all_joint_kinds, "gears": geared_pair, "loop": four_bar}


@pytest.mark.parametrize("made", MADE)
@pytest.mark.parametrize("name", READERS)
def test_every_part_is_in_every_format(name: str, made: str, tmp_path: Path) -> None:
    bundle = assert_every_part_is_there(MADE[made](), name, tmp_path)

    assert bundle.findings.ok


def test_what_has_no_shape_at_all_is_no_print_and_no_step() -> None:
    frames = Assembly.from_parts("frames", parts=[Part.without_geometry("a")], joints=[], ground="a")

    for name in ("3mf", "step"):
        with pytest.raises(ExportError, match="No part of 'frames' has a shape"):
            NAMED[name].write(frames)


def test_an_open_mesh_is_no_print_and_the_export_is_not_ok() -> None:
    whole = box(7, 8, 9)
    opened = Part.from_mesh("opened", TriMesh(whole.vertices, whole.triangles[:-2]), connectors=block("b", o=frame()).connectors)
    base = block("base", o=frame())
    bundle = write_3mf(Assembly.from_parts("box", parts=[base, opened], joints=[declare.fixed("j", base["o"], opened["o"])], ground="base"))

    assert [finding.code for finding in bundle.findings] == ["E_MESH_OPEN"]
    assert not bundle.to_json()["ok"]
    assert list(bundle.files) == ["base.3mf"]


def assert_exports_are_whole(assembly: Assembly, folder: Path) -> None:
    """Compare all exports with their parts, those of shapes also with the parts' volumes, and OBJ meshes with STL meshes."""
    import trimesh

    bodies = {name: [part.solid] if part.solid else part.visuals or part.collisions for name, part in assembly.parts.items()}
    volumes = {name: sum(body.mesh.volume for body in found) for name, found in bodies.items() if found}
    for name in READERS:
        bundle = assert_every_part_is_there(assembly, name, folder)
        if name == "step":
            read = {part: volume_and_centre(shape)[0] for part, (shape, _, _) in instances_in(folder / name / bundle.main)[0].items()}
            assert read == pytest.approx(volumes, rel=WITHIN)
        elif name == "glb":
            scene = trimesh.load_scene(folder / name / bundle.main)
            assert scene.to_geometry().volume == pytest.approx(sum(volumes.values()) * 1e-9, rel=WITHIN)
        elif name == "3mf":
            read = {path.removesuffix(".3mf"): trimesh.load_scene(folder / name / path).to_geometry().volume for path in bundle.files}
            assert read == pytest.approx({valid_name(part): volume for part, volume in volumes.items()}, rel=1e-6)
    whole = assert_every_part_is_there(assembly, "urdf", folder / "obj", meshes="obj")
    for path in (path for path in whole.files if path.endswith(".obj")):
        assert not trimesh.load_scene(folder / "obj" / "urdf" / path).is_empty


@pytest.mark.parametrize("made", ["frames", "kinds"])
def test_volumes_are_there_too(made: str, tmp_path: Path) -> None:
    assert_exports_are_whole(MADE[made](), tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.name)
def test_every_export_of_an_example_has_every_part(example: Path, tmp_path: Path) -> None:
    assert_exports_are_whole(Assembly.from_plan(AssemblyPlan.load(example), example / "parts"), tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("recording", RECORDED, ids=lambda path: path.parent.name)
def test_the_recorded_exports_of_a_recorded_example_have_every_part(recording: Path) -> None:
    """Nothing is built: the files lie beside the recording."""
    parts = {part["name"] for part in json.loads((recording / "plan.json").read_text())["parts"]}
    for folder in sorted((recording / "export").iterdir()):
        files = {
            str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file() and path.name != "losses.json"
        }
        main = next(path for path in files if "/" not in path)
        found = READERS[folder.name](folder / main, Bundle({main: files[main], **files}))
        assert {valid_name(part) for part in parts} <= {*found}, folder.name
        assert all(found[valid_name(part)] for part in parts)


@pytest.mark.soak
@pytest.mark.parametrize("recording", ANSWERED, ids=lambda path: path.name)
def test_every_export_of_a_recorded_run_has_every_part(recording: Path, tmp_path: Path) -> None:
    made = replay(recording, out=tmp_path / "run")
    with Run.view(made.run.path) as run:
        assert_exports_are_whole(assembly_of(run), tmp_path / "exports")
