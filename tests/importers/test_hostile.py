"""Hostile and broken files: a named error, nothing outside the folder, bounded time."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from articad.errors import ReadError
from articad.export.mjcf import write_mjcf
from articad.export.sdf import write_sdf
from articad.export.urdf import write_urdf
from articad.findings import MOST_CHARACTERS
from articad.importers import reading, urdf
from articad.importers.mjcf import read_mjcf
from articad.importers.sdf import read_sdf
from articad.importers.urdf import read_urdf
from tests.assemblies import geared_pair
from tests.importers.test_doors import EVERYTHING

LINKS = '<link name="a"/><link name="b"/>'
BOMB = '<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>'


def robot(body: str) -> str:
    return f'<robot name="r">{body}</robot>'


def joint(inside: str, kind: str = "revolute", ends: str = '<parent link="a"/><child link="b"/>') -> str:
    return robot(f'{LINKS}<joint name="j" type="{kind}">{ends}{inside}</joint>')


URDFS = {
    "empty": ("", "not XML"),
    "truncated": ("<robot name='r'><link name='a'>", "not XML"),
    "another root": ("<mujoco/>", "not <robot>"),
    "entities": (f"{BOMB}<robot name='r'><link name='&b;'/></robot>", "entities"),
    "no link": (robot(""), "0 root links"),
    "two roots": (robot(LINKS), "2 root links"),
    "a circle": (robot(f'{LINKS}<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>'
                       '<joint name="k" type="fixed"><parent link="b"/><child link="a"/></joint>'), "0 root links"),
    "a circle beside the tree": (
        robot(f'{LINKS}<link name="c"/><joint name="j" type="fixed"><parent link="b"/><child link="c"/></joint>'
              '<joint name="k" type="fixed"><parent link="c"/><child link="b"/></joint>'),
        "not a valid mechanism",
    ),
    "a link twice": (robot('<link name="a"/><link name="a"/>'), "Two links|root links"),
    "an unknown link": (joint("", ends='<parent link="a"/><child link="nowhere"/>'), "Its link 'nowhere' is not in the file"),
    "an unknown type": (joint("", "helical"), "not one of"),
    "no axis": (joint('<axis xyz="0 0 0"/><limit lower="0" upper="1"/>'), "no direction"),
    "NaN": (joint('<origin xyz="nan 0 0"/><limit lower="0" upper="1"/>'), "not a plausible number"),
    "a huge number": (joint('<origin xyz="1e300 0 0"/><limit lower="0" upper="1"/>'), "not a plausible number"),
    "not a number": (joint('<origin xyz="x 0 0"/>'), "not a number"),
    "two numbers": (joint('<origin xyz="1 2"/>'), "has 2 numbers"),
    "two frictions": (joint('<limit lower="0" upper="1"/><dynamics friction="1 2"/>'), "has 2 numbers"),
    "a damping for each axis": (joint('<limit lower="0" upper="1"/><dynamics damping="0 0 0"/>'), "has 3 numbers"),
    "two bounds": (joint('<limit lower="0 1" upper="1"/>'), "has 2 numbers"),
    "no bound": (joint('<limit lower="" upper="1"/>'), "has 0 numbers"),
    "records of no form": (robot("<articad>{}</articad>"), "no object with a kind|not an object"),
    "records that are not JSON": (robot("<articad>[</articad>"), "not JSON"),
    "records with NaN": (robot('<articad>{"kind": "part", "x": NaN}</articad>'), "not JSON"),
    "deep records": (robot("<articad>" + "[" * 100_000 + "</articad>"), "not JSON"),
    "records without an assembly": (robot('<articad>{"kind": "part"}</articad>'), "incomplete"),
    "records of the future": (robot('<articad>{"kind": "assembly", "version": 9}</articad>'), "newer"),
}  # fmt: skip


@pytest.mark.parametrize("name", URDFS)
def test_a_broken_urdf_is_a_named_error(name: str, tmp_path: Path) -> None:
    text, reason = URDFS[name]
    path = tmp_path / "a.urdf"
    path.write_text(text)

    with pytest.raises(ReadError, match=reason) as error:
        read_urdf(path)
    assert error.value.findings.codes == ("E_READ",)


MJCFS = {
    "another root": ("<robot/>", "not <mujoco>"),
    "not MJCF": ("<mujoco><nonsense/></mujoco>", "MuJoCo refuses it"),
    "a file outside": ('<mujoco><asset><mesh name="m" file="../../etc/passwd"/></asset></mujoco>', "leads out"),
    "an absolute file": ('<mujoco><asset><hfield name="m" file="/etc/passwd"/></asset></mujoco>', "leads out"),
    "an outside folder": ('<mujoco><compiler meshdir="../.."/><asset><mesh name="m" file="x.stl"/></asset></mujoco>', "leads out"),
    "an outside include": ('<mujoco><include file="../b.xml"/></mujoco>', "leads out"),
    "an include of itself": ('<mujoco><include file="a.xml"/></mujoco>', "must not form a cycle"),
    "many copies": ('<mujoco><worldbody><replicate count="1000000"><body/></replicate></worldbody></mujoco>', "copies"),
    "many copies in three directions": ('<mujoco><worldbody><flexcomp count="100 100 100"/></worldbody></mujoco>', "copies"),
}


@pytest.mark.parametrize("name", MJCFS)
def test_a_broken_mjcf_is_a_named_error(name: str, tmp_path: Path) -> None:
    text, reason = MJCFS[name]
    path = tmp_path / "a.xml"
    path.write_text(text)

    with pytest.raises(ReadError, match=reason):
        read_mjcf(path)


def test_what_mujoco_warns_of_is_a_finding_and_leaves_no_log(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    twice = tmp_path / "twice.xml"  # two hinges on one axis: what they carry has no inertia of its own for each
    twice.write_text('<mujoco><worldbody><body><joint/><joint/><geom size="1"/></body></worldbody></mujoco>')
    said = read_mjcf(twice).findings.of("W_IMPORT_MUJOCO")
    assert len(said) == 1
    assert "singular" in said[0].message
    assert capfd.readouterr().out == ""
    assert [path.name for path in tmp_path.iterdir()] == ["twice.xml"]


def test_includes_are_followed(tmp_path: Path) -> None:
    (tmp_path / "b.xml").write_text(
        '<mujoco><worldbody><body name="b"><geom size="1"/><joint name="j" axis="0 0 1"/></body></worldbody></mujoco>'
    )
    (tmp_path / "a.xml").write_text('<mujoco><include file="b.xml"/></mujoco>')

    assert list(read_mjcf(tmp_path / "a.xml").parts) == ["world", "b"]


@pytest.mark.parametrize("name", ["../out.stl", "/etc/hosts", "package://x/../../../../etc/hosts", "file:///etc/hosts"])
def test_a_mesh_outside_is_refused_not_read(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "in"
    folder.mkdir()
    (tmp_path / "out.stl").write_text("solid")
    (folder / "a.urdf").write_text(robot(f'<link name="a"><visual><geometry><mesh filename="{name}"/></geometry></visual></link>'))

    with pytest.raises(ReadError, match="leads out") as error:
        read_urdf(folder / "a.urdf")
    assert error.value.findings.codes == ("E_UNSAFE_PATH",)


@pytest.mark.parametrize("write", [write_urdf, write_mjcf])
def test_records_cannot_name_files_outside(write: Any, tmp_path: Path) -> None:
    bundle = write(geared_pair())
    text = bundle.files[bundle.main].decode().replace("meshes/rack.stl", "../../rack.stl")
    (tmp_path / "a").mkdir()
    path = tmp_path / "a" / bundle.main
    path.write_text(text)

    with pytest.raises(ReadError, match="leads out"):
        (read_urdf if write is write_urdf else read_mjcf)(path)


def test_a_missing_mesh_is_left_out_with_a_finding(tmp_path: Path) -> None:
    path = tmp_path / "a.urdf"
    path.write_text(robot('<link name="a"><visual><geometry><mesh filename="nothing.stl"/></geometry></visual></link>'))
    assembly = read_urdf(path)

    assert assembly.findings.codes == ("W_IMPORT_MESH",)
    assert not assembly.parts["a"].visuals


LONG = "n" * 60_000
NAMED = {
    "a mesh": ("a.urdf", robot(f'<link name="a"><visual><geometry><mesh filename="{LONG}.stl"/></geometry></visual></link>')),
    "a mesh of SDF": (
        "a.sdf",
        f'<sdf version="1.9"><model name="m"><link name="a"><visual name="v"><geometry><mesh><uri>{LONG * 30}.stl</uri></mesh></geometry></visual></link></model></sdf>',
    ),
}


@pytest.mark.parametrize("what", NAMED)
def test_a_name_of_many_characters_is_not_repeated(what: str, tmp_path: Path) -> None:
    file, content = NAMED[what]
    (tmp_path / file).write_text(content)
    findings = (read_sdf if file.endswith(".sdf") else read_urdf)(tmp_path / file).findings
    assert findings
    assert all(len(str(finding)) <= 3 * MOST_CHARACTERS for finding in findings)
    assert any("characters are left out" in str(finding) for finding in findings)


def test_packages_are_looked_up_below_the_root(tmp_path: Path) -> None:
    bundle = write_urdf(geared_pair())
    text = bundle.files[bundle.main].replace(b"meshes/", b"package://my_robot/meshes/")
    root = tmp_path / "my_robot"
    bundle.write(root)
    (root / "urdf").mkdir()
    (root / "urdf" / "a.urdf").write_bytes(text)

    assembly = read_urdf(root / "urdf" / "a.urdf", root=tmp_path, metadata=False)
    assert not assembly.findings.of("W_IMPORT_MESH")
    assert all(part.visuals for part in assembly.parts.values())


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match="No such file"):
        read_urdf(tmp_path / "a.urdf")


def test_a_file_that_is_too_large(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(reading, "MAX_XML_BYTES", 10)
    (tmp_path / "a.urdf").write_text(robot(LINKS))

    with pytest.raises(ReadError, match="larger than"):
        read_urdf(tmp_path / "a.urdf")


def test_a_hundred_thousand_links(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(urdf, "MAX_LINKS", 1000)
    (tmp_path / "a.urdf").write_text(robot("".join(f'<link name="l{i}"/>' for i in range(100_000))))

    with pytest.raises(ReadError, match="the maximum is"):
        read_urdf(tmp_path / "a.urdf")


@pytest.mark.parametrize("ends", [None, (1, -1), ("inf", "inf"), ("-inf", "-inf"), (1e13, 1e14), (-1e21, -1e20)])
@pytest.mark.parametrize("kind", ["revolute", "prismatic"])
def test_limits_that_are_missing_reversed_or_unreachable_are_endless_with_a_finding(kind: str, ends: Any, tmp_path: Path) -> None:
    limit = "" if ends is None else '<limit lower="{}" upper="{}" effort="1" velocity="1"/>'.format(*ends)
    (tmp_path / "a.urdf").write_text(joint(f'<axis xyz="0 0 1"/>{limit}', kind))
    made = [read_urdf(tmp_path / "a.urdf")]
    assert made[0].findings.codes == ("W_IMPORT_LIMITS",)
    if ends is not None:
        limit = "<limit><lower>{}</lower><upper>{}</upper></limit>".format(*ends)
        inside = f"<parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz>{limit}</axis>"
        (tmp_path / "a.sdf").write_text(
            f'<sdf version="1.9"><model name="r">{LINKS}<joint name="j" type="{kind}">{inside}</joint></model></sdf>'
        )
        made.append(read_sdf(tmp_path / "a.sdf"))

    for assembly in made:
        assert "W_IMPORT_LIMITS" in assembly.findings.codes
        assert (assembly.joints[0].limits.lower, assembly.joints[0].limits.upper) == ((-math.inf,), (math.inf,))


def test_a_changed_record_is_refused_by_the_mechanism(tmp_path: Path) -> None:
    bundle = write_urdf(geared_pair())
    record = {"kind": "coupling", "name": "x", "type": "gear", "a": "nobody", "b": "a", "ratio": 1.0, "offset": 0.0}
    text = bundle.files[bundle.main].replace(b"</robot>", f"<articad>{json.dumps(record)}</articad></robot>".encode())
    (tmp_path / "a.urdf").write_bytes(text)

    with pytest.raises(ReadError, match="do not form an assembly"):
        read_urdf(tmp_path / "a.urdf")


LACKING = {
    "a joint's child": ('<child link="b"/>', "", "Joint 'j' lacks its <child>"),
    "a joint's name": ('<joint name="k" ', "<joint ", "<joint> lacks 'name'"),
    "a link's name": ('<link name="b">', "<link>", "<link> lacks 'name'"),
    "a size": ('size="1 1 1"', "", "<box> lacks 'size'"),
}


@pytest.mark.parametrize("first", LACKING)
@pytest.mark.parametrize("second", LACKING)
def test_what_a_urdf_lacks_is_named_with_its_line_all_at_once(first: str, second: str, tmp_path: Path) -> None:
    text = (
        '<robot name="r">\n<link name="a"/>\n<link name="b"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
        '</inertial><visual><geometry><box size="1 1 1"/></geometry></visual></link>\n<link name="c"/>'
        '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint><joint name="k" type="fixed"><parent link="a"/><child link="c"/></joint></robot>'
    )
    for name in {first, second}:
        text = text.replace(*LACKING[name][:2])
    (tmp_path / "a.urdf").write_text(text)

    with pytest.raises(ReadError) as refused:
        read_urdf(tmp_path / "a.urdf")
    messages = [finding.message for finding in refused.value.findings]
    assert len(messages) == len({first, second})
    assert all(any(LACKING[name][2] in message for message in messages) for name in (first, second)), messages
    assert all("line " in finding.where for finding in refused.value.findings)


@pytest.mark.parametrize("wrong", ["", " ", "\t\n", "x", "1e999", "0 0", "-1"])
@pytest.mark.parametrize("form", ["urdf", "sdf"])
def test_any_statement_may_be_blank_or_wrong(form: str, wrong: str, tmp_path: Path) -> None:
    """A file in which one attribute or one text is blank or wrong is read, or refused by its name."""
    read, text = {"urdf": (read_urdf, EVERYTHING), "sdf": (read_sdf, _sdf(tmp_path))}[form]
    file, refusals = tmp_path / f"changed.{form}", []
    for changed in _each_changed(etree.fromstring(text.encode()), wrong):
        file.write_bytes(changed)
        try:
            read(file)
        except ReadError as error:
            refusals.append(str(error))
    assert refusals
    assert [text for text in refusals if file.name not in text] == []


def _sdf(folder: Path) -> str:
    bundle = write_sdf(geared_pair())
    bundle.write(folder)
    return (folder / bundle.main).read_text()


def _each_changed(document: etree._Element, wrong: str) -> Iterator[bytes]:
    for element in document.iter("*"):
        for name, value in element.attrib.items():
            element.set(name, wrong)
            yield etree.tostring(document)
            element.set(name, value)
        if (text := element.text) and text.strip():
            element.text = wrong
            yield etree.tostring(document)
            element.text = text
