"""Hints of readers, followed literally: the file is changed as the hint says and nothing else; its finding is gone, and no error has come."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from lxml import etree

from articad.assembly import Assembly
from articad.errors import ArticadError, KernelError
from articad.export.urdf import write_urdf
from articad.findings import Finding, Findings
from articad.formats import read
from articad.geometry.mesh_files import write_stl
from articad.geometry.shapes import box
from articad.plan.check import check_plan
from articad.plan.schema import AssemblyPlan
from articad.runs.adopt import adopt
from tests.agents import stories
from tests.assemblies import geared_pair
from tests.chains import chain
from tests.importers.test_adopt import star
from tests.importers.test_described import forged, numbers, written
from tests.importers.test_doors import three
from tests.importers.test_hostile import joint, robot
from tests.obedience import assert_heals

TURN = '<axis xyz="0 0 1"/>'
LIMIT = '<limit lower="-1" upper="1" effort="1" velocity="1"/>'
MESH = '<link name="a"><visual><geometry><mesh filename="{}"/></geometry></visual></link>'
SHAPE = '<link name="a"><visual><geometry>{}</geometry></visual></link>'
MASS = '<link name="a"><inertial><mass value="{}"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>'
TWO = '<body name="b" pos="0 0 3"><joint name="k"/><geom size="1"/></body>'
MJCF = '<mujoco><worldbody><body name="a"><joint name="j"{range}/>{more}<geom size="1"/></body>{two}</worldbody>{rest}</mujoco>'
TIE = '<equality><joint joint1="j" joint2="k" polycoef="0 {} 0 0 0"/></equality>'
SDF = '<sdf version="1.9"><model name="m"><link name="{0}"/><link name="b"/><joint name="j" type="revolute"><parent>{0}</parent><child>b</child><axis><xyz>0 0 1</xyz><limit><lower>{1}</lower><upper>{2}</upper></limit></axis></joint></model></sdf>'  # fmt: skip


def plain(**fields: str) -> str:
    return MJCF.format(**{"range": "", "more": "", "two": "", "rest": ""} | fields)


def mesh_at(name: str) -> Callable[[Path], None]:
    def put(folder: Path) -> None:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(write_stl(box(10, 10, 10)))

    return put


def other_model(folder: Path) -> None:
    (folder / "other.sdf").write_text('<sdf version="1.9"><model name="o"><link name="x"/></model></sdf>')


def nothing(_folder: Path) -> None:
    """Leave the folder as it is."""


@dataclass(frozen=True)
class Case:
    """A file with a fault, what its hint says, and the file as a reader of the hint makes it."""

    code: str
    name: str
    fault: str
    words: str
    mended: str
    place: Callable[[Path], None] = nothing
    before: Callable[[Path], None] = nothing
    root: str = "."


CASES = [
    Case("W_IMPORT_LIMITS", "a.urdf", joint(TURN), "State lower and upper limits in the file, the lower one first", joint(TURN + LIMIT)),
    Case("W_IMPORT_LIMITS", "a.urdf", joint(TURN + LIMIT.replace('"-1" upper="1"', '"1" upper="-1"')), "the lower one first", joint(TURN + LIMIT)),
    Case("W_IMPORT_LIMITS", "a.urdf", three((-1, 1), (-1, 1), (-1, 1), efforts=(5, -6, 5)), "Give a positive one", three((-1, 1), (-1, 1), (-1, 1), efforts=(5, 6, 5))),
    Case("W_IMPORT_LIMITS", "a.sdf", SDF.format("a", 1, -1), "the lower one first", SDF.format("a", -1, 1)),
    Case("W_IMPORT_LIMITS", "a.sdf", SDF.format("world", -1, 1), "Give the link another name", SDF.format("a", -1, 1)),
    Case("W_IMPORT_LOOP", "a.urdf", robot('<link name="a"/><link name="b"/><link name="c"/>' + "".join(f'<joint name="{n}" type="continuous"><parent link="{p}"/><child link="{c}"/></joint>' for n, p, c in (("j", "a", "b"), ("k", "a", "c"), ("l", "b", "c")))), "Keep one of these joints in the URDF", robot('<link name="a"/><link name="b"/><link name="c"/>' + "".join(f'<joint name="{n}" type="continuous"><parent link="{p}"/><child link="{c}"/></joint>' for n, p, c in (("j", "a", "b"), ("k", "a", "c"))))),
    Case("W_IMPORT_MESH", "a.urdf", robot(MESH.format("part.stl")), "Put the mesh where the file names it", robot(MESH.format("part.stl")), place=mesh_at("part.stl")),
    Case("W_IMPORT_MESH", "in/a.urdf", robot(MESH.format("package://robot/part.stl")), "or name a folder above both as the root", robot(MESH.format("package://robot/part.stl")), before=mesh_at("robot/part.stl"), root=".."),
    Case("W_IMPORT_DROPPED", "a.urdf", robot(SHAPE.format('<cone radius="1"/>')), "Use a box, cylinder, sphere or mesh", robot(SHAPE.format('<sphere radius="1"/>'))),
    Case("W_IMPORT_DROPPED", "a.urdf", robot(MASS.format(-1)), "Give a positive mass", robot(MASS.format(1))),
    Case("W_IMPORT_DROPPED", "a.urdf", robot(SHAPE.format('<sphere radius="0"/>')), "Give it a size", robot(SHAPE.format('<sphere radius="1"/>'))),
    Case("W_IMPORT_DROPPED", "a.sdf", '<sdf version="1.9"><model name="m"><link name="base"/><include><uri>other.sdf</uri></include></model></sdf>', "Put it below the folder of the file", '<sdf version="1.9"><model name="m"><link name="base"/><include><uri>other.sdf</uri></include></model></sdf>', place=other_model),
    Case("W_IMPORT_MUJOCO", "a.xml", plain(more="<joint/>"), "Correct what the warning names", plain()),
    Case("E_READ", "a.urdf", "<robot name='r'><link name='a'>", "Correct the file at the named place", "<robot name='r'><link name='a'/></robot>"),
    Case("E_READ", "a.urdf", joint(f'<origin xyz="x 0 0"/>{LIMIT}'), "Correct the file at the named place", joint(f'<origin xyz="0 0 0"/>{LIMIT}')),
    Case("E_READ", "a.xml", '<mujoco><worldbody><body name="bare"><joint/></body></worldbody></mujoco>', "Correct the file at the named place", '<mujoco><worldbody><body name="bare"><joint/><geom size="1"/></body></worldbody></mujoco>'),
    Case("E_UNSAFE_PATH", "in/a.urdf", robot(MESH.format("../part.stl")), "Keep the named file below the folder of the file that names it", robot(MESH.format("part.stl")), before=mesh_at("part.stl"), place=mesh_at("in/part.stl")),
    Case("E_UNSAFE_PATH", "in/a.urdf", robot(MESH.format("../part.stl")), r"or name a folder above both as the root \(--root\)", robot(MESH.format("../part.stl")), before=mesh_at("part.stl"), root=".."),
]  # fmt: skip
CODES = {case.code for case in CASES} | {"W_IMPORT_STALE", "I_IMPORT_CHAIN", "I_IMPORT_FUSED", "I_ADOPT_MERGED", "I_ADOPT_FITS"}
CODES |= {"W_ADOPT_PLACEHOLDER", "W_ADOPT_SHAPE", "W_ADOPT_UNTRIED"}


def found(path: Path, **options: Any) -> Findings:
    """Return what reading a file says, as an error or beside the assembly."""
    try:
        return read(path, **options).findings
    except ArticadError as error:
        return error.findings


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.code}-{case.words[:30]}")
def test_a_file_changed_as_the_hint_says_is_read_without_the_finding(case: Case, tmp_path: Path) -> None:
    path = tmp_path / case.name
    path.parent.mkdir(exist_ok=True)
    path.write_text(case.fault)
    case.before(tmp_path)
    before = found(path)
    assert before.of(case.code), before
    finding = before.of(case.code)[0]
    assert re.search(case.words, finding.hint), finding.hint
    path.write_text(case.mended)
    case.place(tmp_path)
    options = {} if case.root == "." else {"root": path.parent / case.root}
    assert_heals(finding, before, found(path, **options))


def test_a_chain_is_merged_or_kept_apart_as_the_hints_of_both_say(tmp_path: Path) -> None:
    path = tmp_path / "a.urdf"
    path.write_text(three((-1, 1), (-1, 1), (-1, 1)))
    for fuse, code, words in ((False, "I_IMPORT_CHAIN", "Read with fuse to merge them"), (True, "I_IMPORT_FUSED", "Read without fuse")):
        before = found(path, fuse=fuse)
        (finding,) = before.of(code)
        assert words in finding.hint
        assert_heals(finding, before, found(path, fuse=not fuse))


def edited(folder: Path) -> tuple[Path, str]:
    """Return a file that was changed after articad wrote it, and its text."""
    bundle = write_urdf(geared_pair())
    bundle.write(folder)
    path = folder / bundle.main
    text = path.read_text().replace('lower="-0.1"', 'lower="-0.05"')
    path.write_text(text)
    return path, text


@pytest.mark.parametrize("words", ["Edit the plan instead and export again", "or remove the <articad> records from the file"])
def test_an_edited_file_is_written_again_or_loses_its_records(words: str, tmp_path: Path) -> None:
    path, text = edited(tmp_path)
    before = found(path)
    (finding,) = before.of("W_IMPORT_STALE")
    assert words in finding.hint
    if words.startswith("Edit"):
        write_urdf(geared_pair()).write(tmp_path)
    else:
        path.write_text(re.sub(r"<articad[ >].*?</articad>", "", text, flags=re.DOTALL))
    assert_heals(finding, before, found(path))


def test_records_that_do_not_describe_their_file_are_exported_again(tmp_path: Path) -> None:
    """A pose was changed, and the fingerprint with it."""
    path = written(chain(3), "urdf", tmp_path)
    root = etree.fromstring(path.read_bytes())
    element, name = next((element, name) for element, name in numbers(root, "urdf") if name == "xyz")
    element.set(name, "0 0 7")
    path.write_bytes(forged(root, "urdf"))
    before = found(path)
    finding = next(one for one in before.of("W_IMPORT_STALE") if "Export it again from its plan or run" in one.hint)
    assert_heals(finding, before, found(written(chain(3), "urdf", tmp_path)))


# ---------------------------------------------------------------------- adopted folders

BODY = '<link name="body"><visual><geometry><box size=".1 .2 .3"/></geometry></visual></link>'
SMALL = '<visual><origin xyz="0 0 .2"/><geometry><box size=".02 .02 .02"/></geometry></visual>'
ROBOT = f'<robot name="a">{BODY}<link name="hand">{{hand}}</link><link name="tip">{{tip}}</link><joint name="j" type="continuous"><parent link="body"/><child link="hand"/></joint><joint name="g" type="fixed"><origin xyz="0 1 0"/><parent link="body"/><child link="tip"/></joint></robot>'  # fmt: skip


def adopted(folder: Path, text: str, **options: Any) -> tuple[Path, Findings]:
    """Adopt a file and return the folder of its plan."""
    (folder / "a.urdf").write_text(text)
    _, bundle = adopt(folder / "a.urdf", **options)
    bundle.write(folder / "out")
    return folder / "out", bundle.findings


def built(folder: Path) -> Assembly:
    return Assembly.from_plan(AssemblyPlan.load(folder), folder / "parts", kernel=stories.kernel())


def named(findings: Findings, code: str, words: str) -> Finding:
    return next(finding for finding in findings.of(code) if words in finding.hint)


def test_a_frame_that_gets_a_shape_is_kept_apart(tmp_path: Path) -> None:
    _, before = adopted(tmp_path, ROBOT.format(hand=SMALL, tip=""))
    finding = named(before, "I_ADOPT_MERGED", "Give it a shape in the file to keep it apart")
    _, after = adopted(tmp_path, ROBOT.format(hand=SMALL, tip=SMALL))
    assert_heals(finding, before, after)


def test_joints_that_are_given_a_fit_lack_none(tmp_path: Path) -> None:
    out, before = adopted(tmp_path, ROBOT.format(hand=SMALL, tip=SMALL))
    named(before, "I_ADOPT_FITS", 'Give each a "fit" with gap_mm and contact')
    document = json.loads((out / "plan.json").read_text())
    for one in document["joints"]:
        if one["type"] != "fixed":
            one["fit"] = {"gap_mm": [0.1, 0.4], "contact": "forbidden"}
    after = check_plan(AssemblyPlan.from_json(document))
    assert after.ok
    assert not after.of("I_ADOPT_FITS", "E_FIT")


@pytest.mark.slow
def test_a_placeholder_is_drawn_in_the_script_that_the_hint_names(tmp_path: Path) -> None:
    out, before = adopted(tmp_path, ROBOT.format(hand="", tip=SMALL))
    finding = named(before, "W_ADOPT_PLACEHOLDER", "Draw it in parts/hand.py")
    script = out / re.findall(r"parts/\w+\.py", finding.hint)[0]
    script.write_text(re.sub(r"shape = .*", "shape = Box(20, 20, 20)", script.read_text()).replace("import Sphere", "import Box"))
    document = json.loads((out / "plan.json").read_text())
    next(one for one in document["parts"] if one["name"] == "hand").update(envelope_mm=[20, 20, 20], dimensions={})
    (out / "plan.json").write_text(json.dumps(document))
    part = built(out).parts["hand"]
    assert part.solid is not None
    assert part.solid.volume == pytest.approx(8000)


@pytest.mark.slow
def test_a_mesh_of_many_facets_is_drawn_anew_in_the_script_that_the_hint_names(tmp_path: Path) -> None:
    """The star is open, and becomes a solid of few facets; a reader draws its box instead."""
    (tmp_path / "star.stl").write_bytes(write_stl(star(open_=True)))
    mesh = '<visual><geometry><mesh filename="star.stl" scale=".001 .001 .001"/></geometry></visual>'
    out, before = adopted(tmp_path, ROBOT.format(hand=mesh, tip=SMALL))
    finding = named(before, "W_ADOPT_SHAPE", "Draw it anew in parts/hand.py, after meshes/hand.stl")
    for name in re.findall(r"(?:parts|meshes)/\w+\.\w+", finding.hint):
        assert (out / name).is_file()
    document = json.loads((out / "plan.json").read_text())
    hand = next(one for one in document["parts"] if one["name"] == "hand")
    x, y, z = hand["envelope_mm"]
    return_line = next(line for line in (out / "parts/hand.py").read_text().splitlines() if line.strip().startswith("return shape"))
    (out / "parts/hand.py").write_text(f"from build123d import Box\n\n\ndef build(part):\n    shape = Box({x}, {y}, {z})\n{return_line}\n")
    part = built(out).parts["hand"]
    assert part.solid is not None
    assert part.solid.volume == pytest.approx(x * y * z)


@pytest.mark.slow
def test_a_folder_that_was_not_tried_out_builds_when_it_is_built(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The kernel fails while the file is adopted, and works when the folder is built."""

    def fails(*_given: Any, **_options: Any) -> Assembly:
        raise KernelError("The kernel has stopped.")

    with monkeypatch.context() as patched:
        patched.setattr(Assembly, "from_plan", fails)
        out, before = adopted(tmp_path, ROBOT.format(hand=SMALL, tip=SMALL), kernel=stories.kernel())
    named(before, "W_ADOPT_UNTRIED", "Build the folder to see whether they build")
    assert set(built(out).parts) == {"body", "hand", "tip"}
