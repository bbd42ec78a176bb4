"""Bounds before work: what a file asks for is counted before a parser or an engine does it."""

from __future__ import annotations

import base64
import contextlib
import time
import tracemalloc
import zipfile
import zlib
from collections.abc import Callable
from pathlib import Path

import pytest

from articad.auditing.examine import audit_file
from articad.errors import ReadError
from articad.export.freecad_content import unpacked_content
from articad.importers import freecad
from articad.importers.freecad import read_freecad
from articad.importers.freecad_document import MAX_MEMBERS
from articad.importers.mjcf import read_mjcf
from articad.importers.reading import Folder
from articad.importers.referenced_files import require_closed
from articad.importers.sdf import read_sdf
from articad.importers.urdf import read_urdf
from tests.hostile_files import archive, listing_document, robot

WORLD = "<mujoco><worldbody>{}</worldbody></mujoco>"
GEOM = '<geom size="0.1"/>'


def never(*_words: object, **_more: object) -> None:
    raise AssertionError("the work was begun")


@pytest.fixture
def idle(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have the parser of trees and the compiler of MuJoCo fail the test."""
    monkeypatch.setattr("articad.importers.reading.etree.fromstring", never)


MANY = " ".join(f'a{number}="1"' for number in range(30_000))
XMLS = {
    "attributes": (f"<robot {MANY}/>", "30000 attributes"),
    "attributes, one twice": (f'<robot {MANY} a1="2"/>', "duplicate attribute"),
    "attributes with brackets": ("<robot " + MANY.replace('"1"', '">"') + "/>", "30000 attributes"),
    "attributes in an encoding of several bytes": (f'<?xml version="1.0" encoding="gb18030"?><robot {MANY}/>', "30000 attributes"),
    "attributes in no encoding": (f'<?xml version="1.0" encoding="none"?><robot {MANY}/>', "unknown encoding"),
    "levels": ("<a>" * 60_000, "nested deeper than 50000"),
    "elements": ("<a>" + "<b/>" * 1_000_001 + "</a>", "more than 1000000 elements"),
    "entities": ('<!DOCTYPE r [<!ENTITY a "b">]><robot name="&a;"/>', "declares entities"),
}


@pytest.mark.usefixtures("idle")
@pytest.mark.parametrize("name", XMLS)
def test_xml_is_counted_before_a_tree_is_built(name: str, tmp_path: Path) -> None:
    text, reason = XMLS[name]
    path = tmp_path / "a.urdf"
    path.write_text(text)
    with pytest.raises(ReadError, match=reason):
        read_urdf(path)


MORE = "more than 10 elements"


@pytest.mark.usefixtures("idle")
@pytest.mark.parametrize(
    ("encoding", "reason"),
    [
        ("utf-8", MORE),
        ("gb18030", MORE),
        ("euc-jp", MORE),
        ("utf-7", "not XML"),
        ("utf-32", "not XML"),
        ("cp037", "not XML"),
        ("zlib", "not XML"),
    ],
)
def test_elements_are_counted_in_every_encoding(encoding: str, reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.importers.reading.MAX_ELEMENTS", 10)
    text = f'<?xml version="1.0" encoding="{encoding}"?><robot>' + "<a/>" * 10 + "</robot>"
    path = tmp_path / "a.urdf"
    path.write_bytes(text.encode(encoding if encoding in {"utf-32", "cp037"} else "ascii"))
    with pytest.raises(ReadError, match=reason):
        read_urdf(path)


@pytest.mark.usefixtures("idle")
def test_a_declaration_without_end_takes_linear_time(tmp_path: Path) -> None:
    path = tmp_path / "a.urdf"
    path.write_text("<?xml " + 'version="0.1" ' * 300_000)
    began = time.process_time()
    with pytest.raises(ReadError, match="not XML"):
        read_urdf(path)
    assert time.process_time() - began < 2


@pytest.mark.usefixtures("idle")
def test_a_name_is_short(tmp_path: Path) -> None:
    path = tmp_path / "a.urdf"
    path.write_text(f'<robot name="r"><link name="{"a" * 4001}"/></robot>')
    with pytest.raises(ReadError, match="more than 4000 characters"):
        read_urdf(path)


@pytest.mark.parametrize("name", ["a/" * 33 + "b.stl", "a" * 4001, "../" * 40 + "etc/passwd"])
def test_a_long_name_of_a_file_is_not_looked_up(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = Folder.of(tmp_path / "a.urdf", None)
    monkeypatch.setattr(Path, "resolve", never)
    with pytest.raises(ReadError, match="not a file name"):
        folder.find(name)
    (tmp_path / "a.urdf").write_text(
        f'<robot name="r"><link name="a"><visual><geometry><mesh filename="{name}"/></geometry></visual></link></robot>'
    )
    monkeypatch.undo()
    with pytest.raises(ReadError, match="not a file name"):
        require_closed(tmp_path / "a.urdf")


def test_included_files_are_counted_together(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.importers.referenced_files.MAX_ELEMENTS", 10)
    for number in range(3):
        (tmp_path / f"{number}.urdf").write_text(robot("<a/>" * 4))
    (tmp_path / "a.urdf").write_text(robot("".join(f'<include file="{number}.urdf"/>' for number in range(3))))
    with pytest.raises(ReadError, match="14 elements; the maximum is 10"):
        require_closed(tmp_path / "a.urdf")


SDF = '<sdf version="1.9"><world name="w">{}</world></sdf>'
MODEL = '<model name="{}"><link name="a">{}</link></model>'


@pytest.mark.parametrize(
    ("bound", "most", "inside", "reason"),
    [
        ("MAX_ELEMENTS", 15, "<include><uri>b.sdf</uri></include><include><uri>b.sdf</uri><name>c</name></include>", "21 elements; the maximum"),
        ("MAX_ALL_XML", 900, "<include><uri>b.sdf</uri></include><include><uri>b.sdf</uri><name>c</name></include>", "bytes of XML; the"),
        ("MAX_LINKS", 3, MODEL.format("m", "") + '<joint name="j{0}" type="fixed"><parent>world</parent><child>m::a</child></joint>' * 4, "joints"),
        ("MAX_SHAPES", 3, MODEL.format("m", "<visual/>" * 4), "4 elements in one link; the maximum is 3"),
        ("MAX_NAME", 5, MODEL.format("z", "") + f'<model name="aaa">{MODEL.format("bb", "")}</model>', "more than 5 characters"),
    ],
)  # fmt: skip
def test_a_world_is_counted_before_its_frames_are_placed(
    bound: str, most: int, inside: str, reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(f"articad.importers.sdf.{bound}", most)
    (tmp_path / "b.sdf").write_text(f'<sdf version="1.9">{MODEL.format("b", "<visual/>" * 4)}</sdf>' + " " * 400)
    for number in range(4):
        inside = inside.replace("j{0}", f"j{number}", 1)
    (tmp_path / "a.sdf").write_text(SDF.format(inside))
    with pytest.raises(ReadError, match=reason):
        read_sdf(tmp_path / "a.sdf")


@pytest.mark.parametrize("version", ["1.²", "9" * 5000, "1.x", ""])
def test_a_strange_version_in_the_list_of_a_model_is_the_least(version: str, tmp_path: Path) -> None:
    (tmp_path / "m").mkdir()
    rows = f'<sdf version="{version}">old.sdf</sdf><sdf version="1.2">new.sdf</sdf>'
    (tmp_path / "m/model.config").write_text(f"<model>{rows}</model>")
    (tmp_path / "m/new.sdf").write_text('<sdf version="1.9"><model name="m"><link name="a"/></model></sdf>')
    (tmp_path / "a.sdf").write_text(SDF.format("<include><uri>model://m</uri></include>"))
    assert not read_sdf(tmp_path / "a.sdf").findings


@pytest.mark.parametrize("number", ["pose", "plugin", "diffuse"])
def test_no_list_is_made_of_a_text_of_many_words(number: str, tmp_path: Path) -> None:
    """A word in a list takes 60 bytes, twenty times its place in the file."""
    words = "11 " * 1_000_000
    inside = {"pose": f"<pose>{words}</pose>", "plugin": f"<plugin>{words}</plugin>"}.get(
        number,
        f"<visual name='v'><geometry><box/></geometry><material><diffuse>{words}</diffuse></material></visual>",
    )
    (tmp_path / "a.sdf").write_text(f'<sdf version="1.9"><model name="m"><link name="a">{inside}</link></model></sdf>')
    tracemalloc.start()
    try:
        with contextlib.suppress(ReadError):
            read_sdf(tmp_path / "a.sdf")
        assert tracemalloc.get_traced_memory()[1] < 40e6
    finally:
        tracemalloc.stop()


def test_an_encoding_of_several_bytes_is_read(tmp_path: Path) -> None:
    path = tmp_path / "a.urdf"
    path.write_bytes('<?xml version="1.0" encoding="gb18030"?><robot name="r"><link name="手臂"/></robot>'.encode("gb18030"))
    assert "手臂" in read_urdf(path).parts


@pytest.mark.parametrize("count", ["1000000000", "1e9", "1001", "-5 1e9", "40 40", "nan", "inf", "0x7fffffff", "9" * 5000, "many"])
@pytest.mark.parametrize("tag", ["replicate", "composite", "flexcomp"])
def test_copies_are_counted_before_they_are_made(tag: str, count: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.importers.mjcf.compiled_mjcf", never)
    path = tmp_path / "a.xml"
    path.write_text(WORLD.format(f'<{tag} count="{count}">{GEOM}</{tag}>'))
    with pytest.raises(ReadError, match=r"copies; the maximum is 1000|not a valid number of copies"):
        read_mjcf(path)


def nested(depth: int, count: int) -> str:
    return WORLD.format(f'<replicate count="{count}">' * depth + GEOM + "</replicate>" * depth)


def beside(number: int, count: int) -> str:
    return WORLD.format(f'<replicate count="{count}">{GEOM * 10}</replicate>' * number)


@pytest.mark.parametrize(
    ("text", "reason"), [(nested(2, 40), "1600 copies"), (nested(40, 2), "copies"), (beside(30, 1000), "330031 elements|elements")]
)
def test_products_and_sums_of_copies_are_bounded(text: str, reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.importers.mjcf.compiled_mjcf", never)
    path = tmp_path / "a.xml"
    path.write_text(text)
    with pytest.raises(ReadError, match=reason):
        read_mjcf(path)


@pytest.mark.parametrize(
    "asset",
    [
        '<texture type="2d" builtin="gradient" width="26000" height="26000" name="t"/>',
        '<texture type="cube" builtin="flat" width="2000" height="2000" name="t"/>',
        '<texture type="2d" builtin="flat" width="3000" height="3000" name="t"/>' * 2,
        '<hfield name="h" nrow="40000" ncol="1e5" size="1 1 1 1"/>',
    ],
)
def test_points_of_textures_and_height_fields_are_counted_before_they_are_made(
    asset: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("articad.importers.mjcf.compiled_mjcf", never)
    path = tmp_path / "a.xml"
    path.write_text(f"<mujoco><asset>{asset}</asset><worldbody>{GEOM}</worldbody></mujoco>")
    with pytest.raises(ReadError, match=r"points without a file; the maximum is"):
        read_mjcf(path)


@pytest.mark.parametrize("size", ["nkey", "nuserdata", "nuser_body"])
def test_numbers_that_an_engine_reserves_are_counted_before(size: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.importers.mjcf.compiled_mjcf", never)
    path = tmp_path / "a.xml"
    path.write_text(f'<mujoco><size {size}="1000000000"/><worldbody>{GEOM}</worldbody></mujoco>')
    with pytest.raises(ReadError, match=rf"{size} is 1000000000; the maximum is"):
        read_mjcf(path)


@pytest.mark.parametrize(
    ("inside", "reason"),
    [
        ("<material name='m'/>" * 80_001 + "<link name='a'/>", "elements; the maximum is 80000"),
        ("<link name='a'>" + "<visual/>" * 2001 + "</link>", "2001 elements in one link; the maximum is 2000"),
    ],
)
def test_a_file_beyond_the_bounds_is_not_given_to_engines(
    inside: str, reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("articad.auditing.examine.load_in_all", never)
    path = tmp_path / "a.urdf"
    path.write_text(f"<robot name='r'>{inside}</robot>")
    assert reason in str(audit_file(path).findings)
    with pytest.raises(ReadError, match=reason):
        read_urdf(path)


@pytest.mark.parametrize("count", [3000, 10_000])
def test_loops_are_counted_before_their_equations_are_made(count: int, tmp_path: Path) -> None:
    joint = '<joint name="{}" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/><limit lower="0" upper="1" effort="1" velocity="1"/></joint>'
    path = tmp_path / "a.urdf"
    path.write_text(f'<robot name="r"><link name="a"/><link name="b"/>{"".join(joint.format(i) for i in range(count))}</robot>')
    with pytest.raises(ReadError, match=rf"{count - 1} loops and 0 couplings"):
        read_urdf(path)


def test_copies_of_an_include_count_with_those_around_it(tmp_path: Path) -> None:
    (tmp_path / "inner.xml").write_text(f'<mujoco><replicate count="40">{GEOM}</replicate></mujoco>')
    path = tmp_path / "a.xml"
    path.write_text(WORLD.format('<replicate count="40"><include file="inner.xml"/></replicate>'))
    with pytest.raises(ReadError, match="1600 copies"):
        read_mjcf(path)


def test_a_few_copies_are_read(tmp_path: Path) -> None:
    path = tmp_path / "a.xml"
    path.write_text(WORLD.format(f'<replicate count="5" offset="1 0 0"><body><joint/>{GEOM}</body></replicate>'))
    assert len(read_mjcf(path).parts) == 6


def with_objects(path: Path, objects: dict[str, tuple[str, str]], shown: bytes = b"<Document/>") -> Path:
    """Write a document of objects with types and properties, of which the part P is grounded."""
    objects = {"P": ("App::Part", ""), "G": ("App::FeaturePython", held("ObjectToGround", "P"))} | objects
    rows = "".join(f'<Object name="{name}" type="{kind}"/>' for name, (kind, _) in objects.items())
    data = "".join(f'<Object name="{name}"><Properties>{inside}</Properties></Object>' for name, (_, inside) in objects.items())
    text = f"<Document><Objects>{rows}</Objects><ObjectData>{data}</ObjectData></Document>"
    path.write_bytes(archive(Document_xml=text.encode(), GuiDocument_xml=shown))
    return path


def held(key: str, *names: str) -> str:
    return f'<Property name="{key}"><LinkList>{"".join(f"<Link value={name!r}/>" for name in names)}</LinkList></Property>'


FLEXIBLE = '<Property name="Rigid"><Bool value="false"/></Property>'


@pytest.mark.parametrize(
    ("kind", "more", "last"),
    [
        ("Assembly::AssemblyLink", FLEXIBLE, "App::Part"),
        ("App::DocumentObjectGroup", "", "App::DocumentObjectGroup"),
        ("App::Part", "", "App::Part"),
    ],
)
def test_groups_that_show_others_twice_are_counted(kind: str, more: str, last: str, tmp_path: Path) -> None:
    groups = {f"x{n}": (kind, more + held("Group", f"x{n + 1}", f"x{n + 1}")) for n in range(15)} | {"x15": (last, "")}
    path = with_objects(tmp_path / "a.FCStd", {"A": ("Assembly::AssemblyObject", held("Group", "x0", "P", "G"))} | groups)
    with pytest.raises(ReadError, match=rf"more than {MAX_MEMBERS}"):
        read_freecad(path)


def test_a_reference_leads_through_few_objects(tmp_path: Path) -> None:
    sides = "".join(
        f'<Property name="Reference{side}"><XLink file="" name="P"><Sub value="{"P." * 51}"/></XLink></Property>' for side in (1, 2)
    )
    kind = '<Property name="JointType"><Integer value="0"/><Enum value="Fixed"/></Property>'
    objects = {"A": ("Assembly::AssemblyObject", held("Group", "P", "G", "J")), "J": ("App::FeaturePython", kind + sides)}
    with pytest.raises(ReadError, match="through more than 50 objects"):
        read_freecad(with_objects(tmp_path / "a.FCStd", objects))


def test_what_a_window_stored_counts_with_the_document(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.importers.freecad_document.MAX_ELEMENTS", 1000)
    path = with_objects(tmp_path / "a.FCStd", {}, b"<Document>" + b"<a/>" * 1000 + b"</Document>")
    with pytest.raises(ReadError, match="elements; the maximum is 1000"):
        read_freecad(path)


def test_values_of_records_are_counted_before_they_are_made(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.importers.records.json.loads", never)
    (tmp_path / "a.urdf").write_text(robot('<link name="a"/><articad>{"kind": "part", "x": [' + "[]," * 2_000_001 + "[]]}</articad>"))
    with pytest.raises(ReadError, match="4000006 values; the maximum is 4000000"):
        read_urdf(tmp_path / "a.urdf")
    packed = base64.b64encode(zlib.compress(b'{"a": [' + b"{}," * 2_000_001 + b"{}]}")).decode()
    assert unpacked_content(packed) is None


def test_names_in_an_expression_are_found_in_linear_time() -> None:
    assert freecad._NAMED.findall("3 mm * Long name.x + 2a.b - \u00e9c.d + Last") == ["Long name", "a", "c"]
    began = time.process_time()
    assert not freecad._NAMED.findall("a" * 300_000 + " " * 300_000)
    assert time.process_time() - began < 2


def stored(path: Path) -> None:
    with zipfile.ZipFile(path, "w") as archive:
        for number in range(20_001):
            archive.writestr(str(number), "")


def bomb(path: Path) -> None:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("Document.xml", bytes(65 << 20))


def boasting(path: Path) -> None:
    """Write a bomb whose header says that it is small."""
    bomb(path)
    content = path.read_bytes()
    path.write_bytes(content.replace((65 << 20).to_bytes(4, "little"), (100).to_bytes(4, "little")))


@pytest.mark.parametrize("write", [stored, bomb, boasting])
def test_archives_are_unpacked_within_bounds(write: Callable[[Path], None], tmp_path: Path) -> None:
    path = tmp_path / "a.FCStd"
    write(path)
    with pytest.raises(ReadError, match=r"too large|cannot be unpacked|not XML"):
        read_freecad(path)


def test_a_urdf_has_no_attribute_of_a_megabyte(tmp_path: Path) -> None:
    path = tmp_path / "a.urdf"
    path.write_text(f'<robot name="r"><link name="a"><inertial><origin xyz="{"1 " * 40_000}"/></inertial></link></robot>')
    with pytest.raises(ReadError, match="80000 characters; the maximum is 65536"):
        read_urdf(path)


def test_a_mesh_in_mjcf_may_have_long_attributes(tmp_path: Path) -> None:
    corners = " ".join(f"{x} {y} {z}" for x in range(40) for y in range(40) for z in (0, 1, 2, 3))
    path = tmp_path / "a.xml"
    assert len(corners) > 1 << 15
    path.write_text(
        f'<mujoco><asset><mesh name="m" vertex="{corners}"/></asset><worldbody><geom type="mesh" mesh="m"/></worldbody></mujoco>'
    )
    assert read_mjcf(path).parts


def test_elements_of_an_srdf_are_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("articad.importers.srdf.MAX_KEPT", 10)
    (tmp_path / "a.urdf").write_text('<robot name="r"><link name="a"/></robot>')
    for count in (10, 11):
        (tmp_path / "a.srdf").write_text(robot('<disable_collisions link1="a" link2="b"/>' * count))
        if count == 10:
            assert len(read_urdf(tmp_path / "a.urdf").kept) == 10
        else:
            with pytest.raises(ReadError, match="11 elements; the maximum is 10"):
                read_urdf(tmp_path / "a.urdf")


@pytest.mark.parametrize("kind", ["one file", "all files", "groups"])
def test_files_that_an_engine_would_open_are_measured_before(kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Their sizes, and the groups of an OBJ: PyBullet took more than a minute of the processor for half a million of them."""
    monkeypatch.setattr("articad.auditing.examine.load_in_all", never)
    written, reason = {
        "one file": ({"a.stl": 129 << 20}, "135266304 bytes; the maximum is 134217728"),
        "all files": ({f"{number}.stl": 120 << 20 for number in range(5)}, "629145600 bytes; the maximum is 536870912"),
        "groups": ({"a.obj": 0}, "10001 groups and changes of material; the maximum is 10000"),
    }[kind]
    for name, size in written.items():
        with (tmp_path / name).open("wb") as file:
            file.write(b"\ng a" * 10_001 if kind == "groups" else b"")
            file.truncate(size or file.tell())
    meshes = "".join(f'<collision><geometry><mesh filename="{name}"/></geometry></collision>' for name in written)
    (tmp_path / "a.urdf").write_text(f'<robot name="r"><link name="a">{meshes}</link></robot>')
    audit = audit_file(tmp_path / "a.urdf")
    assert reason in " ".join(finding.message for finding in audit.findings)
    assert not audit.findings.ok


@pytest.mark.parametrize(
    ("bound", "most", "reason"),
    [
        ("MAX_ALL_XML", 2000, "bytes of XML; the maximum is 2000"),
        ("MAX_ELEMENTS", 12, "14 elements; the maximum is 12"),
        ("MAX_ALL_BYTES", 500, "bytes; the maximum is 500"),
    ],
)
def test_documents_are_measured_together_with_those_that_they_list(
    bound: str, most: int, reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(f"articad.importers.freecad_document.{bound}", most)
    for number in range(3):
        text = b"<Document><Objects/><ObjectData/>" + b" " * 600 + b"</Document>"
        (tmp_path / f"{number}.FCStd").write_bytes(archive(Document_xml=text))
    (tmp_path / "a.FCStd").write_bytes(archive(Document_xml=listing_document(["0.FCStd", "1.FCStd", "2.FCStd"])))
    with pytest.raises(ReadError, match=reason):
        read_freecad(tmp_path / "a.FCStd")
