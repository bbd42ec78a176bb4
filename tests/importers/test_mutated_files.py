"""Every kind of statement in a file with records, and every mesh of it, is changed, with a fingerprint that fits: reading notices."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from copy import deepcopy
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree

from articad.assembly import Assembly
from articad.errors import ReadError
from articad.formats import NAMED, read
from articad.geometry.mesh import TriMesh
from articad.geometry.mesh_files import read_mesh, write_stl
from articad.geometry.shapes import cylinder
from articad.importers import mjcf
from articad.importers.mjcf import read_mjcf
from articad.importers.mjcf_compiled import Compiled
from articad.importers.sdf import read_sdf
from articad.importers.urdf import read_urdf
from tests.assemblies import random_tree
from tests.importers.test_described import FORMATS, elements, forged

READERS = {".urdf": read_urdf, ".xml": read_mjcf, ".sdf": read_sdf}
Change = tuple[str, str, int]
"""What is done, to which attribute or "" for the text, and where: the place among all elements."""

FREE = {"effort", "velocity", "damping", "friction", "frictionloss", "actuatorfrcrange"}
"""Attributes and elements that writers derive: documented as not compared."""
LOOKS = {"material", "rgba", "ambient", "diffuse"}
"""Colours, which no check uses."""
IDLE = {("geom", "name"), ("site", "name"), ("visual", "name"), ("collision", "name"), ("geom", "friction"), ("geom", "group")}
"""Names that nothing refers to, and what belongs to contacts."""
REDUNDANT = {("joint", "limited"), ("joint", "type"), ("inertial", "quat"), ("geom", "quat"), ("body", "quat")}
"""Statements whose absence means the same, or nearly."""

FOREIGN = """<robot name="a">
<link name="base"><inertial><origin xyz="0 0 .1" rpy=".1 .2 .3"/><mass value="2"/>
  <inertia ixx=".01" ixy="0" ixz="0" iyy=".02" iyz="0" izz=".025"/></inertial>
 <visual><geometry><box size="1 .2 .3"/></geometry></visual>
 <collision><origin xyz="0 .1 0" rpy="1 2 3"/><geometry><box size="1 .2 .3"/></geometry></collision></link>
<link name="arm"><inertial><mass value="1"/><inertia ixx=".01" ixy="0" ixz="0" iyy=".02" iyz="0" izz=".025"/></inertial>
 <visual><geometry><mesh filename="m.stl" scale=".001 .001 .001"/></geometry></visual>
 <collision><geometry><mesh filename="m.stl" scale=".001 .001 .001"/></geometry></collision>
 <collision><origin xyz="0 0 .3"/><geometry><cylinder radius=".1" length=".3"/></geometry></collision></link>
<joint name="j" type="revolute"><origin xyz="0 0 .4" rpy="0 .1 0"/><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/>
 <limit lower="-1" upper="1" effort="5" velocity="2"/></joint></robot>"""


def foreign(folder: Path) -> Assembly:
    (folder / "m.stl").write_bytes(write_stl(cylinder(20, 50)))
    (folder / "a.urdf").write_text(FOREIGN)
    return read(folder / "a.urdf")


def from_mjcf(folder: Path) -> Assembly:
    foreign(folder)
    (folder / "a.xml").write_text("""<mujoco><default><geom friction=".7 .01 .01"/></default>
      <asset><mesh name="m" file="m.stl" scale=".001 .001 .001"/></asset><worldbody><geom type="plane" size="1 1 .1"/>
      <body name="base"><geom type="box" size=".1 .2 .3" euler="10 20 30"/><geom type="mesh" mesh="m" contype="0" conaffinity="0"/>
      <body name="arm" pos="0 0 .5"><joint name="j" axis="0 1 0" range="-50 50"/><geom type="mesh" mesh="m"/>
      <geom type="capsule" size=".05 .2" contype="2"/></body></body></worldbody></mujoco>""")
    return read(folder / "a.xml")


SOURCES: dict[str, Callable[[Path], Assembly]] = {"own": lambda _: random_tree(1, 3), "foreign": foreign}


@cache
def written(source: str, form: str, base: Path) -> Path:
    """Return a file with records, once for all tests."""
    folder = base / source
    folder.mkdir(exist_ok=True)
    return Path(NAMED[form].write(SOURCES[source](folder)).write(folder / form)[0])


@pytest.fixture(scope="module")
def base(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("written")


def below(root: Any, form: str) -> list[Any]:
    return [one for element in elements(root, form) for one in element.iter(etree.Element)]


def kind_of(element: Any, name: str) -> tuple[str, ...]:
    """Return the kind of a statement: the tags above it, and its attribute."""
    tags = [element.tag, *(above.tag for above in element.iterancestors())][:3]
    shape = element.get("class") or element.get("type") or ""
    return (*tags, shape, name)


def is_compared(element: Any, name: str) -> bool:
    tags = {element.tag, *(above.tag for above in element.iterancestors())}
    words = {element.tag, name}
    return not (tags & LOOKS or words & (FREE | LOOKS) or "dynamics" in tags or "surface" in tags or (element.tag, name) in IDLE)


def changes(root: Any, form: str) -> Iterator[Change]:
    """Yield each kind of change once: to the first statement of its kind."""
    known = set()
    for place, element in enumerate(below(root, form)):
        for name in [*element.attrib, *([""] if (element.text or "").strip() else [])]:
            if is_compared(element, name) and (kind := ("change", *kind_of(element, name))) not in known:
                known.add(kind)
                yield "change", name, place
                if name and (element.tag, name) not in REDUNDANT:
                    yield "omit", name, place
        for what in ("remove", "repeat"):
            if is_compared(element, "") and (kind := (what, *kind_of(element, ""))) not in known:
                known.add(kind)
                yield what, "", place


def changed(value: str, share: float) -> str:
    """Return a value that says something else."""
    try:
        numbers = [float(word) for word in value.split()]
    except ValueError:
        return "prismatic" if value == "revolute" else f"{value}_other"
    return " ".join(repr(number * (1 + share) + share * (-1) ** place) for place, number in enumerate(numbers))


def share_of(element: Any) -> float:
    """Return the share by which a number is changed: more than rounding, and for collision shapes more than pieces leave out."""
    above = [element, *element.iterancestors()]
    return 0.5 if any(one.tag == "collision" or one.get("class") == "collision" for one in above) else 0.01


def apply(root: Any, form: str, change: Change) -> str:
    """Change a document; return what was changed."""
    what, name, place = change
    element = below(root, form)[place]
    said = f"{what} {name} of {etree.tostring(element).decode()[:150]}"
    if what == "omit":
        del element.attrib[name]
    elif what == "remove":
        element.getparent().remove(element)
    elif what == "repeat":
        element.addnext(deepcopy(element))
    elif name:
        element.set(name, changed(element.get(name), share_of(element)))
    else:
        element.text = changed(element.text, share_of(element))
    return said


def notices(path: Path) -> bool:
    """Return whether reading a file gives a finding, or refuses it."""
    try:
        return bool(read(path).findings)
    except ReadError:
        return True


def refused(path: Path, _: Path) -> Compiled:
    raise ReadError(str(path), path=str(path), where="", findings=[])


def means_the_same(path: Path, before: Path) -> bool:
    """Return whether a reader without records sees no difference between two files: masses, inertias and shapes of links at rest."""
    try:
        one, other = (READERS[path.suffix](file, metadata=False) for file in (path, before))
    except ReadError:
        return False
    rows = seen(one), seen(other)
    return list(one.parts) == list(other.parts) and len(rows[0]) == len(rows[1]) and all(map(alike, *rows))


def seen(assembly: Assembly) -> list[Any]:
    rows: list[Any] = [[[joint.limits.lower, joint.limits.upper] for joint in assembly.joints if joint.type.steps]]
    for part, T in zip(assembly.parts.values(), assembly.poses(assembly.mechanism.rest), strict=True):
        rows.append([] if part.mass is None else [part.mass.mass, *part.mass.com, *part.mass.inertia.flat])
        rows += [(T @ shape.frame).apply(shape.mesh.vertices) for shape in part.visuals]
        corners = [(T @ shape.frame).apply(shape.mesh.vertices) for shape in part.collisions]  # a piece may be there twice
        rows.append([(np.min(corner, axis=0), np.max(corner, axis=0)) for corner in [np.concatenate(corners)]] if corners else [])
    return rows


def alike(one: Any, other: Any) -> bool:
    a, b = np.ravel(np.array(one, dtype=float)), np.ravel(np.array(other, dtype=float))
    return a.shape == b.shape and bool(np.isclose(a, b, rtol=1e-6, atol=1e-6).all())


@pytest.mark.parametrize("source", SOURCES)
@pytest.mark.parametrize("form", FORMATS)
def test_each_kind_of_statement_is_noticed(form: str, source: str, base: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = written(source, form, base)
    assert not notices(path)
    monkeypatch.setattr(mjcf, "compiled_mjcf", refused)  # a second each; a file whose records count does not get there
    original = path.read_bytes()
    other = path.with_name(f"other{path.suffix}")
    missed, count = [], 0
    for change in list(changes(etree.fromstring(original), form)):
        root = etree.fromstring(original)
        said = apply(root, form, change)
        other.write_bytes(forged(root, form))
        count += 1
        if not notices(other):
            missed.append((said, other.read_bytes()))
    assert count > 30
    monkeypatch.undo()
    really = [said for said, content in missed if other.write_bytes(content) and not means_the_same(other, path)]
    assert not really, "\n".join(really)


@pytest.mark.parametrize("source", SOURCES)
@pytest.mark.parametrize("form", FORMATS)
def test_each_mesh_that_shrinks_is_noticed_or_seen(form: str, source: str, base: Path) -> None:
    """What is read is what the file shows without its records: also where a primitive stands for the mesh."""
    path = written(source, form, base)
    for file in sorted(path.parent.glob("meshes/*.stl")):
        content, mesh = file.read_bytes(), read_mesh(file)
        try:
            file.write_bytes(write_stl(TriMesh(mesh.vertices * 0.01, mesh.triangles)))
            if not notices(path):
                shown = reaches(READERS[path.suffix](path, metadata=False))
                found = {name: reach for name, reach in reaches(read(path)).items() if name in shown}
                assert found == pytest.approx({name: shown[name] for name in found}, rel=1e-6), file
        finally:
            file.write_bytes(content)


def reaches(assembly: Assembly) -> dict[str, float]:
    """Return the diagonal of each visible part [mm]; frames of links may differ."""
    found = {}
    for name, part in assembly.parts.items():
        if part.visuals:
            points = np.concatenate([shape.frame.apply(shape.mesh.vertices) for shape in part.visuals])
            found[name] = float(np.linalg.norm(np.ptp(points, axis=0)))
    return found


@pytest.mark.parametrize("form", FORMATS)
def test_shapes_are_compared_though_another_mesh_is_missing(form: str, tmp_path: Path) -> None:
    path = Path(NAMED[form].write(random_tree(1, 3)).write(tmp_path)[0])
    first, second, *_ = sorted(path.parent.glob("meshes/*.stl"))
    first.unlink()
    assert read(path).findings.codes == ("W_IMPORT_MESH",) * len(read(path).findings)
    mesh = read_mesh(second)
    second.write_bytes(write_stl(TriMesh(mesh.vertices * 0.01, mesh.triangles)))
    if form == "mjcf":  # the records count for nothing, and MuJoCo wants every mesh
        with pytest.raises(ReadError, match=first.name):
            read(path)
    else:
        assert "W_IMPORT_STALE" in read(path).findings.codes


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("collision", ["pieces", "solid", "hull"])
@pytest.mark.parametrize("source", [*SOURCES.values(), from_mjcf], ids=[*SOURCES, "mjcf"])
def test_chosen_collision_shapes_are_no_edit(source: Callable[[Path], Assembly], collision: str, form: str, tmp_path: Path) -> None:
    path = Path(NAMED[form].write(source(tmp_path), collision=collision).write(tmp_path / "out")[0])
    assert "W_IMPORT_STALE" not in read(path).findings.codes
