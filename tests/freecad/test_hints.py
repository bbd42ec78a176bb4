"""Hints about documents of FreeCAD, followed literally: the document is changed as the hint says; its finding is gone, and no error has come.

What FreeCAD would do to a document, such as solving it, is done in the file.
"""

from __future__ import annotations

import re
import zipfile
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from articad.connectors.se3 import SE3
from articad.errors import ArticadError
from articad.export.freecad import write_freecad_alone
from articad.findings import Finding, Findings
from articad.importers.freecad import read_freecad
from tests.assemblies import four_bar, random_tree
from tests.freecad import opened
from tests.freecad.test_kernel import GOOD, OFF_TIP, build
from tests.freecad.test_reading import with_part_moved, without_records
from tests.obedience import assert_heals

CODES = {"W_FREECAD_APART", "W_FREECAD_ELSEWHERE", "W_FREECAD_SHAPE", "W_FREECAD_LOOSE", "E_FREECAD_JOINT", "E_FEATURE_OFF_TIP"}


def found(path: Path, **options: Any) -> Findings:
    try:
        return read_freecad(path, **options).findings
    except ArticadError as error:
        return error.findings


def of(findings: Findings, code: str, words: str) -> Finding:
    return next(finding for finding in findings.of(code) if re.search(words, finding.hint))


def rewritten(path: Path, name: str, change: Any) -> Path:
    """Write a copy of a document whose XML is changed."""
    copy = path.with_name(name)
    with zipfile.ZipFile(path) as before, zipfile.ZipFile(copy, "w") as after:
        for entry in before.infolist():
            content = before.read(entry)
            if entry.filename == "Document.xml":
                document = etree.fromstring(content)
                change(document)
                content = etree.tostring(document)
            after.writestr(entry, content)
    return copy


@pytest.fixture
def document(tmp_path: Path) -> Path:
    (path,) = write_freecad_alone(four_bar()).write(tmp_path)
    return path


def test_a_loop_that_is_solved_holds_in_the_document(document: Path) -> None:
    before = found(with_part_moved(document, "coupler__tip", SE3.trans(0.0, 0.0, 2.0)), metadata=False)
    finding = of(before, "W_FREECAD_APART", "solve the assembly in FreeCAD")
    assert_heals(finding, before, found(document, metadata=False))


def test_a_part_that_is_solved_stands_where_its_joints_put_it(tmp_path: Path) -> None:
    """Of an assembly that articad wrote, the joints say where parts stand."""
    (path,) = write_freecad_alone(random_tree(0, 8)).write(tmp_path)
    before = found(with_part_moved(path, "part_2", SE3.trans(0.0, 0.3, 0.0)))
    finding = of(before, "W_FREECAD_ELSEWHERE", "Solve the assembly in FreeCAD and save it")
    assert_heals(finding, before, found(path))


OBJECTS = {
    "Assembly": (
        "Assembly::AssemblyObject",
        '<Property name="Group"><Link value="One"/><Link value="Two"/><Link value="Held"/></Property>',
    ),
    "Source": ("Part::Feature", '<Property name="Shape"><Part file="Source.brp"/></Property>'),
    "One": ("App::Link", '<Property name="LinkedObject"><XLink file="" name="Source"/></Property>'),
    "Two": ("App::Link", '<Property name="LinkedObject"><XLink file="" name="Source"/></Property>'),
    "Held": ("App::FeaturePython", '<Property name="ObjectToGround"><Link value="One"/></Property>'),
}
GROUNDED = {"Held_2": ("App::FeaturePython", '<Property name="ObjectToGround"><Link value="Two"/></Property>')}


def twice(folder: Path, shape: str, objects: dict[str, tuple[str, str]]) -> Path:
    """Write a document with two links to one shape."""
    kinds = "".join(f'<Object type="{kind}" name="{name}"/>' for name, (kind, _) in objects.items())
    rows = "".join(f'<Object name="{name}"><Properties>{row}</Properties></Object>' for name, (_, row) in objects.items())
    with zipfile.ZipFile(folder / "twice.FCStd", "w") as archive:
        archive.writestr("Document.xml", f"<Document><Objects>{kinds}</Objects><ObjectData>{rows}</ObjectData></Document>")
        archive.writestr("Source.brp", shape)
    return folder / "twice.FCStd"


def a_box(folder: Path) -> str:
    from build123d import Box, export_brep

    export_brep(Box(10, 10, 10), str(folder / "box.brep"))
    return (folder / "box.brep").read_text()


def test_a_shape_that_is_repaired_is_read(tmp_path: Path) -> None:
    before = found(twice(tmp_path, "no shape", OBJECTS))
    finding = of(before, "W_FREECAD_SHAPE", "Give it a body or a solid")
    assert_heals(finding, before, found(twice(tmp_path, a_box(tmp_path), OBJECTS)))


def test_a_part_that_is_grounded_is_not_loose(tmp_path: Path) -> None:
    shape = a_box(tmp_path)
    before = found(twice(tmp_path, shape, OBJECTS))
    finding = of(before, "W_FREECAD_LOOSE", "Connect it with a joint in FreeCAD, or ground it there")
    group = OBJECTS["Assembly"][1].replace('<Link value="Held"/>', '<Link value="Held"/><Link value="Held_2"/>')
    assert_heals(finding, before, found(twice(tmp_path, shape, OBJECTS | GROUNDED | {"Assembly": (OBJECTS["Assembly"][0], group)})))


@pytest.mark.parametrize("way", ["Use .*Revolute", "or suppress the joint in FreeCAD"])
def test_a_joint_of_an_unknown_type_gets_one_of_the_hint_or_is_suppressed(way: str, document: Path) -> None:
    stranger = without_records(document)

    def kinds(tree: Any) -> list[Any]:
        return list(tree.xpath("//Property[@name='JointType']//Integer"))

    names = re.findall(r'<Enum value="(\w+)"', zipfile.ZipFile(stranger).read("Document.xml").decode())
    assert "Revolute" in names

    def angled(tree: Any) -> None:
        kinds(tree)[0].set("value", str(list(dict.fromkeys(names)).index("Angle")))

    def suppressed(tree: Any) -> None:
        angled(tree)
        joint = kinds(tree)[0].getparent().getparent()
        for value in joint.xpath("./Property[@name='Activated']/Bool"):
            value.set("value", "false")

    before = found(rewritten(stranger, "angled.FCStd", angled))
    finding = of(before, "E_FREECAD_JOINT", way)
    after = stranger if way.startswith("Use") else rewritten(stranger, "suppressed.FCStd", suppressed)
    assert_heals(finding, before, found(after))


@pytest.mark.freecad
@opened.needs_freecad
@pytest.mark.parametrize(
    ("words", "script"),
    [
        (
            "set body.Tip to it",
            OFF_TIP.replace("part.linear_pattern", "pattern = part.linear_pattern").replace("Tip = hole", "Tip = pattern"),
        ),
        ("or use the functions of `part`, which do", GOOD),
    ],
    ids=["tip", "functions"],
)
def test_a_pattern_that_is_made_the_tip_is_in_the_solid(words: str, script: str) -> None:
    def built(script: str) -> Findings:
        try:
            return build(script, probe=False).findings
        except ArticadError as error:
            return error.findings

    before = built(OFF_TIP)
    finding = of(before, "E_FEATURE_OFF_TIP", words)
    assert_heals(finding, before, built(script))
