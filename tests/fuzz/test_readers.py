"""Whatever a file holds, its reader gives what it means or an error with a name, in bounded time and memory."""

from __future__ import annotations

import io
import json
import math
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from articad.connectors.mate import Mate
from articad.connectors.se3 import SE3
from articad.errors import KinematicsError, PlanError, ReadError
from articad.importers import mjcf_compiled
from articad.importers.freecad import read_freecad
from articad.importers.mjcf import read_mjcf
from articad.importers.reading import color_text
from articad.importers.urdf import read_urdf
from articad.kernels.archive import Archive, BadArchiveError, packed
from articad.kernels.freecad import tree_findings
from articad.kernels.results import PoisonedError, number, read_mesh
from articad.kinematics.joints import Coupling, Joint, JointLimits, JointType
from articad.kinematics.mechanism import Mechanism
from articad.plan.check import check_plan
from articad.plan.schema import AssemblyPlan
from tests.fuzz.mutations import HOSTILE, mutated
from tests.fuzz.readers import CORPUS, READERS, attempt, plan, seeds

BOUNDED = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large])
INPUTS = sorted(path.relative_to(CORPUS).as_posix() for path in CORPUS.rglob("*") if path.is_file())


def test_every_reader_has_a_corpus() -> None:
    assert {name.partition("/")[0] for name in INPUTS} == set(READERS)
    assert sum((CORPUS / name).stat().st_size for name in INPUTS) < 2**18


@pytest.mark.parametrize("name", INPUTS)
def test_the_corpus_holds_no_fault(name: str) -> None:
    attempt(name.partition("/")[0], (CORPUS / name).read_bytes())


@pytest.mark.parametrize("reader", [name for name in READERS if name != "xacro"])  # which starts a process for each input
@BOUNDED
@given(content=st.binary(max_size=400))
def test_any_bytes(reader: str, content: bytes) -> None:
    attempt(reader, content)


@pytest.mark.parametrize("reader", [name for name in READERS if name != "xacro"])  # which starts a process for each input
@BOUNDED
@given(seed=st.integers(0, 2**31), which=st.integers(0, 2**10))
def test_a_file_changed_in_a_few_places(reader: str, seed: int, which: int) -> None:
    known = seeds(reader)
    attempt(reader, mutated(known[which % len(known)], seed))


PLAN = json.loads((CORPUS / "plan" / "five_joints.json").read_bytes())
SCHEMA = AssemblyPlan.model_json_schema(by_alias=True)


def values_of(schema: dict[str, Any], depth: int = 0) -> st.SearchStrategy[Any]:
    """Return values of a JSON schema, and now and then one that is not of it."""
    if "$ref" in schema:
        definition = SCHEMA["$defs"][schema["$ref"].rpartition("/")[2]]
        return st.builds(lambda: None).flatmap(lambda _: values_of(definition, depth + 1))
    if depth > 12:
        return st.none()
    if "enum" in schema or "const" in schema:
        made: st.SearchStrategy[Any] = st.sampled_from(schema.get("enum") or [schema["const"]])
    elif options := schema.get("anyOf") or schema.get("oneOf"):
        made = st.one_of([values_of(option, depth + 1) for option in options])
    else:
        made = _KINDS.get(schema.get("type", ""), _anything)(schema, depth)
    return st.one_of(made, made, made, made, made, made, made, st.sampled_from(HOSTILE)) if depth > 1 else made


def _anything(_schema: dict[str, Any], _depth: int) -> st.SearchStrategy[Any]:
    return st.sampled_from(HOSTILE)


def _object(schema: dict[str, Any], depth: int) -> st.SearchStrategy[Any]:
    fields = {name: values_of(form, depth + 1) for name, form in schema.get("properties", {}).items()}
    required = {name: fields.pop(name) for name in schema.get("required", ()) if name in fields}
    return st.fixed_dictionaries(required, optional=fields)


_NAMES = st.sampled_from(["a", "b", "case", "lid", "hinge", "oak", "width"])
_KINDS: dict[str, Callable[[dict[str, Any], int], st.SearchStrategy[Any]]] = {
    "object": _object,
    "array": lambda schema, depth: st.lists(values_of(schema.get("items", {}), depth + 1), max_size=3),
    "string": lambda _schema, _depth: st.one_of(
        _NAMES, _NAMES, st.sampled_from(["width * 2", "1 / 0", "sqrt(-1)", "#ffffff"]), st.text(max_size=8)
    ),
    "number": lambda _schema, _depth: st.floats(),
    "integer": lambda _schema, _depth: st.integers(-3, 2**40),
    "boolean": lambda _schema, _depth: st.booleans(),
}


@settings(BOUNDED, max_examples=100)
@given(document=values_of(SCHEMA))
def test_a_plan_of_the_schema_is_checked_without_stumbling(document: Any) -> None:
    text = json.dumps(document).encode()
    attempt("plan", text)


@settings(BOUNDED, max_examples=100)
@given(part=values_of(SCHEMA["properties"]["parts"]["items"]), joint=values_of(SCHEMA["properties"]["joints"]["items"]))
def test_a_sound_plan_with_one_strange_part_and_joint(part: Any, joint: Any) -> None:
    document = {**PLAN, "parts": [*PLAN["parts"], part], "joints": [*PLAN["joints"], joint]}
    attempt("plan", json.dumps(document).encode())


# ---------------------------------------------------------------------- what fuzzing found, with its answer


def test_a_sound_plan_is_sound() -> None:
    plan((CORPUS / "plan" / "five_joints.json").read_bytes())
    assert check_plan(AssemblyPlan.from_json(PLAN)).ok


def test_a_mesh_whose_name_is_too_long_is_an_error_of_ours(tmp_path: Path) -> None:
    name = "a" * 300
    path = tmp_path / "a.urdf"
    path.write_text(f'<robot name="r"><link name="a"><visual><geometry><mesh filename="{name}"/></geometry></visual></link></robot>')
    assert read_urdf(path).findings.codes == ("W_IMPORT_MESH",)
    path = tmp_path / "a.xml"
    path.write_text(f'<mujoco><asset><mesh name="m" file="{name}"/></asset></mujoco>')
    with pytest.raises(ReadError, match="is not a file name"):
        read_mjcf(path)


@pytest.mark.parametrize("spoil", [b"\xff" * 30, b"", b"PK\x05\x06" + b"\xff" * 18], ids=["stream", "nothing", "table"])
def test_a_spoiled_freecad_file_is_an_error_of_ours(tmp_path: Path, spoil: bytes) -> None:
    content = (CORPUS / "fcstd" / "packed.FCStd").read_bytes()
    path = tmp_path / "a.FCStd"
    path.write_bytes(content[:60] + spoil + content[60 + len(spoil) :] if len(spoil) == 30 else spoil)
    with pytest.raises(ReadError, match="not a FreeCAD file"):
        read_freecad(path)


def test_a_freecad_number_that_is_none_is_an_error_of_ours(tmp_path: Path) -> None:
    document = (CORPUS / "fcstd" / "foreign.xml").read_bytes()
    assert document.count(b'<Integer value="')
    path = tmp_path / "a.FCStd"
    path.write_bytes(packed({"Document.xml": document.replace(b'<Integer value="', b'<Integer value="x')}))
    with pytest.raises(ReadError, match="not a whole number"):
        read_freecad(path)


def test_a_header_that_numpy_cannot_parse_is_poison() -> None:
    arrays = (CORPUS / "worker" / "arrays.npy3").read_bytes().split(b"\x93NUMPY")[1:]
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        for name, piece in zip(("vertices", "triangles", "face"), arrays, strict=True):
            archive.writestr(f"{name}.npy", b"\x93NUMPY" + piece.replace(b"'shape': (", b"'shape': (((L"))
    with pytest.raises(PoisonedError):
        read_mesh(stream.getvalue())


@pytest.mark.parametrize("value", [5, "abc", {"a": 1}, [None, {"a": [1]}], True])
def test_a_report_of_another_form_is_a_finding(value: Any) -> None:
    tree = {"ok": True, "off_tip": value, "invalid": value, "untied": value, "sketched": True}
    for finding in tree_findings("part", tree):
        assert finding.code in {"E_NOT_EDITABLE", "E_FEATURE_OFF_TIP"}


@pytest.mark.parametrize("text", ["[\n", "\n", "{\x1e", "[\x0b\n\n"])
def test_json_that_ends_on_an_empty_line_is_an_error_of_ours(text: str) -> None:
    with pytest.raises(PlanError, match="This is not JSON"):
        AssemblyPlan.loads(text)


@pytest.mark.parametrize("count", [10**400, -(10**400), 1e300, 2**40, -1, 0.5])
def test_a_count_beyond_reason_is_a_finding(count: float) -> None:
    with pytest.raises(PlanError, match="whole number"):
        AssemblyPlan.from_json({**PLAN, "freedoms": count})


def test_a_colour_that_is_no_number_counts_as_dark(tmp_path: Path) -> None:
    assert color_text([float("nan"), 2.0, -1.0, 1.0]) == "#00ff00"
    assert color_text([0.5, float("inf"), 0.2]) == "#80ff33"
    path = tmp_path / "a.urdf"
    path.write_text('<robot name="r"><material name="m"><color rgba="nan 0 0 1"/></material><link name="a"/></robot>')
    assert list(read_urdf(path).parts) == ["a"]


def test_bodies_beyond_reason_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.xml"
    bodies = (
        '<body name="a" pos="1e300 0 0"><joint name="j"/><geom size="1"/></body><body name="b"><joint name="k"/><geom size="1"/></body>'
    )
    path.write_text(f'<mujoco><worldbody>{bodies}</worldbody><equality><connect body1="a" body2="b" anchor="0 0 0"/></equality></mujoco>')
    with pytest.raises(ReadError, match="not plausible"):
        read_mjcf(path)


def test_a_joint_to_a_link_that_is_not_there_is_named(tmp_path: Path) -> None:
    path = tmp_path / "a.urdf"
    turn = (
        '<joint name="{}" type="revolute"><parent link="{}"/><child link="{}"/><axis xyz="0 0 1"/><limit lower="0" upper="1" {}/></joint>'
    )
    effort = 'effort="1" velocity="1"'
    joints = turn.format("j", "a", "b", effort) + turn.format("k", "b", "nowhere", effort)
    path.write_text(f'<robot name="r"><link name="a"/><link name="b"/>{joints}</robot>')
    with pytest.raises(ReadError, match="nowhere"):
        read_urdf(path)


def test_what_makes_mujoco_stumble_is_an_error_of_ours(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What the process does that compiles, done here; it would confine itself first."""

    def stumbles(_: str) -> None:
        raise RuntimeError("Caught an unknown exception!")

    monkeypatch.setattr("mujoco.MjModel.from_xml_path", stumbles)
    monkeypatch.setattr("articad.kernels.sandbox.keep_to", lambda *_: None)
    monkeypatch.chdir(tmp_path)
    assert mjcf_compiled.main(["a.xml", "."]) == 0
    with pytest.raises(ReadError, match="MuJoCo refuses it: Caught an unknown exception!"):
        mjcf_compiled._read((tmp_path / "model").read_bytes(), Path("a.xml"))


def test_an_integer_beyond_every_float_is_poison() -> None:
    with pytest.raises(PoisonedError, match="finite number"):
        number(10**400)


# ---------------------------------------------------------------------- zip files


def test_an_archive_comes_back_and_has_one_spelling() -> None:
    entries = {"b": b"1" * 5000, "a": b""}
    content = packed(entries)
    archive = Archive(content, entries=2, unpacked=5000)
    assert archive.names == ("b", "a")
    assert {name: archive.read(name) for name in archive.names} == entries
    assert packed(entries) == content


def test_an_entry_that_unpacks_to_more_than_it_says_is_stopped() -> None:
    """A bomb whose table of contents says 10 bytes: 64 MiB of zeros in 64 kB."""
    content = bytearray(packed({"Document.xml": bytes(64 << 20)}))
    true, small = (64 << 20).to_bytes(4, "little"), (10).to_bytes(4, "little")
    assert content.count(true) == 2
    with pytest.raises(BadArchiveError):
        Archive(bytes(content.replace(true, small)), entries=1, unpacked=1 << 20).read("Document.xml")
    with pytest.raises(BadArchiveError, match="too large"):
        Archive(bytes(content), entries=1, unpacked=1 << 20)
    archive = Archive(packed({"a": bytes(1000), "b": bytes(1000)}), entries=2, unpacked=2000)
    assert archive.read("a") == archive.read("b")
    with pytest.raises(BadArchiveError, match="too large"):
        archive.read("a")


def test_two_entries_of_one_name_are_refused() -> None:
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("Document.xml", b"<a/>")
        archive.writestr("Document.xmm", b"<b/>")
    with pytest.raises(BadArchiveError, match="two entries"):
        Archive(stream.getvalue().replace(b".xmm", b".xml"), entries=5, unpacked=100)


def test_a_spoiled_entry_is_named() -> None:
    content = packed({"a": b"hello" * 100})
    at = content.index(b"a", 26) + 1
    with pytest.raises(BadArchiveError, match="a cannot be unpacked"):
        Archive(content[:at] + b"\xff\xff" + content[at + 2 :], entries=5, unpacked=1000).read("a")


@pytest.mark.parametrize("value", ["1e300", "-1e13"])
def test_a_place_beyond_reason_is_refused(tmp_path: Path, value: str) -> None:
    """A loop over it had no singular values: its equations overflowed."""
    text = (CORPUS / "fcstd" / "foreign.xml").read_text()
    far = re.sub(r'Px="60\.0+"', f'Px="{value}"', text)
    assert far != text
    path = tmp_path / "a.FCStd"
    path.write_bytes(packed({"Document.xml": far.encode()}))
    with pytest.raises(ReadError, match=r"Placement: Its position is not plausible"):
        read_freecad(path)


def test_records_of_frames_beyond_reason_are_refused(tmp_path: Path) -> None:
    text = (CORPUS / "urdf" / "own.urdf").read_text()
    far, changed = re.subn(r'("parent_frame": ?\[)[^,]*', r"\g<1>1e300", text.replace("&quot;", '"'), count=1)
    assert changed == 1
    path = tmp_path / "a.urdf"
    path.write_text(far)
    with pytest.raises(ReadError, match="not plausible"):
        read_urdf(path)


def test_lengths_whose_squares_overflow_are_an_error_of_ours() -> None:
    """A rack that is farther away than numbers reach from its pinion."""
    far = SE3.from_translation((1e308, 1e308, 0.0))
    endless = JointLimits((-math.inf,), (math.inf,))
    joints = [
        Joint(
            name=child,
            type=kind,
            parent="ground",
            child=child,
            parent_connector=child,
            child_connector="c",
            T_parent_connector=frame,
            T_child_connector=SE3.identity(),
            mate=Mate.ALIGNED,
            limits=endless,
            rest=(0.0,),
        )
        for child, kind, frame in (("rack", JointType.SLIDER, SE3.identity()), ("pinion", JointType.REVOLUTE, far))
    ]
    rack = Coupling("teeth", "rack", "pinion", "rack", 10.0, 0.0)
    with pytest.raises(KinematicsError, match="E_NONFINITE"):
        _ = Mechanism(("ground", "rack", "pinion"), "ground", joints, [rack]).mobility


def test_a_short_joint_whose_side_is_a_list_is_an_error_of_ours() -> None:
    document = json.loads((CORPUS / "plan" / "short.json").read_bytes())
    joints = document["joints"].values() if isinstance(document["joints"], dict) else document["joints"]
    for joint in joints:
        if isinstance(joint, dict):
            joint["pin_on"] = ["parent"]
    with pytest.raises(PlanError, match=r"pin_on"):
        AssemblyPlan.from_json(document)
