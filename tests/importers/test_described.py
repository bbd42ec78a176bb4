"""Records that do not describe the file that holds them count for nothing, also with a fingerprint that fits."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from articad.assembly import Assembly
from articad.errors import ExportError
from articad.export import mjcf, sdf, urdf
from articad.export.fingerprint import fingerprint
from articad.formats import NAMED, read
from articad.geometry.mesh import TriMesh
from articad.geometry.mesh_files import read_mesh, write_stl
from articad.importers.described import describes
from tests.assemblies import all_joint_kinds, four_bar, geared_pair, random_tree, rigid_ring, walker
from tests.chains import chain

FORMATS = {
    "urdf": (".urdf", ("link", "joint")),
    "mjcf": (".xml", ("worldbody", "equality")),
    "sdf": (".sdf", ("model/link", "model/joint")),
}
STATED = {"urdf": urdf.mechanism_elements, "mjcf": mjcf.mechanism_elements, "sdf": sdf.mechanism_elements}
REWRITTEN = {"urdf": urdf.rewritten, "mjcf": mjcf.rewritten, "sdf": sdf.rewritten}
DERIVED = {"collision", "dynamics", "effort", "velocity", "friction", "damping", "material", "ambient", "diffuse", "scale"}
"""What records are not compared with: what a writer derives, or chooses from its settings."""


def elements(root: Any, form: str) -> list[Any]:
    return [element for tag in FORMATS[form][1] for element in root.iterfind(tag)]


def forged(root: Any, form: str) -> bytes:
    """Return the file with the fingerprint of its present elements in its records."""
    text = etree.tostring(root).decode()
    now = fingerprint(elements(root, form))
    found = re.subn(r'(fingerprint(?:"|&quot;): (?:"|&quot;))[0-9a-f]{64}', rf"\g<1>{now}", text)
    assert found[1] == 1
    return found[0].encode()


def numbers(root: Any, form: str) -> Iterator[tuple[Any, str]]:
    """Yield each attribute, "" for the text, of the elements that states numbers and is compared."""
    for element in elements(root, form):
        for below in element.iter(etree.Element):
            if {above.tag for above in (below, *below.iterancestors())} & DERIVED or below.get("class") == "collision":
                continue
            for name, value in [*below.attrib.items(), ("", below.text or "")]:
                if name not in {"effort", "velocity", "damping", "frictionloss", "actuatorfrcrange", "rgba"} and re.fullmatch(
                    r"[-+.\de ]*\d[-+.\de ]*", value.strip()
                ):
                    yield below, name


def changed(value: str) -> str:
    """Return numbers of which the last differs."""
    *others, last = value.split()
    return " ".join([*others, repr(float(last) * 1.5 + 0.125)])


def change(element: Any, name: str, value: str) -> None:
    """Set an attribute, or the text."""
    if name:
        element.set(name, value)
    else:
        element.text = value


def written(assembly: Assembly, form: str, folder: Path) -> Path:
    return Path(NAMED[form].write(assembly).write(folder)[0])


@pytest.fixture(scope="module")
def made() -> list[Assembly]:
    return [all_joint_kinds(), walker(), geared_pair(), four_bar((-0.2, 0.2)), rigid_ring(), *map(random_tree, range(8))]


def files_of(path: Path) -> Callable[[str], TriMesh]:
    """Return what looks up the meshes of a file by the name of a file or an asset."""
    return lambda name: read_mesh(path.parent / "meshes" / f"{Path(name).stem}.stl")


def codes(path: Path) -> Sequence[str]:
    return read(path).findings.codes


@pytest.mark.parametrize("form", FORMATS)
def test_each_number_of_a_mechanism_is_compared(form: str, tmp_path: Path) -> None:
    """Each in turn is changed: the records no longer describe the file, whatever its fingerprint."""
    path = written(random_tree(1, 3), form, tmp_path)  # no part is symmetric
    assert "W_IMPORT_STALE" not in codes(path)
    own, before = read(path), path.read_bytes()
    assert describes(own, STATED[form](etree.fromstring(before)), files_of(path), REWRITTEN[form])
    count = len(list(numbers(etree.fromstring(before), form)))
    assert count > 20
    for place in range(count):
        root = etree.fromstring(before)
        element, name = list(numbers(root, form))[place]
        change(element, name, changed(element.get(name) if name else element.text))
        assert not describes(own, STATED[form](root), files_of(path), REWRITTEN[form]), (etree.tostring(element), name)


@pytest.mark.parametrize("form", FORMATS)
def test_rounding_is_no_edit(form: str, tmp_path: Path) -> None:
    path = written(chain(2), form, tmp_path)
    root = etree.fromstring(path.read_bytes())
    for element, name in numbers(root, form):
        value = element.get(name) if name else element.text
        change(element, name, " ".join(f"{float(word):.12g}" for word in value.split()))
    path.write_bytes(forged(root, form))
    assert "W_IMPORT_STALE" not in codes(path)


@pytest.mark.parametrize("form", FORMATS)
def test_an_audit_does_not_believe_records_of_another_assembly(form: str, tmp_path: Path) -> None:
    """The elements of one file with the records of another one, whose name and parts are the same."""
    good, bad = written(chain(3), form, tmp_path / "good"), written(chain(3), form, tmp_path / "bad")
    root = etree.fromstring(bad.read_bytes())
    element, name = next((e, n) for e, n in numbers(root, form) if n in {"xyz", "pos"} or e.tag == "pose")
    change(element, name, "0 0 7" if name else "0 0 7 0 0 0")
    bad.write_bytes(forged(root, form))
    assert codes(good) == ()
    assert "W_IMPORT_STALE" in codes(bad)


@pytest.mark.parametrize("options", [{}, {"keep_frames": True}, {"loops": "mimic"}, {"package": "robot"}, {"meshes": "obj"}], ids=str)
def test_what_options_change_is_described(options: dict[str, Any], made: list[Assembly], tmp_path: Path) -> None:
    for number, assembly in enumerate(made):
        with suppress(ExportError):  # not every loop is linear
            path = Path(NAMED["urdf"].write(assembly, **options).write(tmp_path / str(number))[0])
            assert "W_IMPORT_STALE" not in codes(path), assembly.name


@pytest.mark.parametrize("form", FORMATS)
@pytest.mark.parametrize("options", [{"meshes": "obj"}, {"collision": "hull"}, {"actuators": "position"}, {"actuators": "motor"}], ids=str)
def test_meshes_hulls_and_actuators_are_described(options: dict[str, Any], form: str, tmp_path: Path) -> None:
    if "actuators" in options and form != "mjcf":
        options = {}
    for number, assembly in enumerate([geared_pair(), four_bar((-0.2, 0.2))]):
        path = Path(NAMED[form].write(assembly, **options).write(tmp_path / str(number))[0])
        assert "W_IMPORT_STALE" not in codes(path), assembly.name


@pytest.mark.parametrize("form", FORMATS)
def test_every_kind_of_joint_loop_and_coupling_is_described(form: str, made: list[Assembly], tmp_path: Path) -> None:
    for number, assembly in enumerate(made):
        assert "W_IMPORT_STALE" not in codes(written(assembly, form, tmp_path / str(number))), assembly.name


@pytest.mark.parametrize("form", ["urdf", "sdf"])
def test_records_name_the_meshes_that_links_show(form: str, tmp_path: Path) -> None:
    """The elements show one mesh, the records another of the same mass."""
    path = written(chain(2), form, tmp_path)
    shown = min(path.parent.glob("meshes/*.stl"))
    shutil.copy(shown, shown.with_name("other.stl"))
    text = path.read_text()
    path.write_text(text.replace(f'"file": "meshes/{shown.name}"', '"file": "meshes/other.stl"'))
    assert path.read_text() != text
    assert "W_IMPORT_STALE" in codes(path)


def small(path: Path) -> None:
    """Write a mesh beside each one of a file: that of its first part at a hundredth of its size."""
    mesh = read_mesh(min(path.parent.glob("meshes/*.stl")))
    for file in [*path.parent.glob("meshes/*.stl"), path.parent / "small.stl"]:
        other = path.parent / "other" / file.name
        other.parent.mkdir(exist_ok=True)
        other.write_bytes(write_stl(TriMesh(mesh.vertices * 0.01, mesh.triangles)))


QUOTE = '(?:"|&quot;)'
FORGED = {
    "the solid is another mesh": (rf"({QUOTE}solid{QUOTE}: {{{QUOTE}file{QUOTE}: {QUOTE})meshes/[^.]+", r"\g<1>other/small", ""),
    "links show meshes of another folder": (r'( filename="|<uri>| file=")meshes/', r"\g<1>other/", ""),
    "meshes are scaled": (r'scale="0.001 0.001 0.001"', 'scale="0.1 0.1 0.1"', "urdf mjcf"),
    "a mesh is moved": (r' scale="0.001 0.001 0.001"', r'\g<0> refpos="0 0 1"', "mjcf"),
    "joints have other defaults": ("<default>", '<default><joint pos="0 0 5"/>', "mjcf"),
    "angles have another unit": ('angle="radian"', 'angle="degree"', "mjcf"),
    "another file is included": ("<worldbody>", '<include file="more.xml"/><worldbody>', "mjcf"),
    "there is one more model": (r"</model>", r'<model name="m"><link name="l"/></model></model>', "sdf"),
    "the model is moved": (r"<model [^>]*>", r"\g<0><pose>0 0 1 0 0 0</pose>", "sdf"),
}


@pytest.mark.parametrize(
    ("form", "forgery"), [(form, name) for name, row in FORGED.items() for form in FORMATS if form in (row[2] or form)]
)
def test_what_other_programs_see_is_compared(form: str, forgery: str, tmp_path: Path) -> None:
    """What surrounds links and joints, and the contents of meshes, belong to the mechanism."""
    path = written(chain(2), form, tmp_path)
    small(path)
    path.with_name("more.xml").write_text('<mujoco><option gravity="0 0 -1"/></mujoco>')
    pattern, other, _ = FORGED[forgery]
    text, count = re.subn(pattern, other, path.read_text())
    assert count
    path.write_bytes(forged(etree.fromstring(text.encode()), form))
    assert "W_IMPORT_STALE" in codes(path)
