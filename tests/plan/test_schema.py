"""The form of a plan: what is read, what is written, and how a wrong one is answered."""

from __future__ import annotations

import contextlib
import json
import re
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from articad.errors import PlanError, ReadError
from articad.findings import Finding
from articad.plan.fields import is_name
from articad.plan.schema import AssemblyPlan, ConnectorSpec, DerivedPart, MirrorDerivation, MirrorPlane, Parameter, PartSpec, Pose
from tests.plan.samples import FILES, Json, chest, connector, document, gears, joint, pair, part

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted(path for path in (ROOT / "examples").glob("*/plan.json"))


def refused(plan: Any) -> dict[tuple[str, str], Finding]:
    """Return the findings of a document that is not a plan, by code and place."""
    with pytest.raises(PlanError) as error:
        AssemblyPlan.from_json(plan)
    return {(finding.code, finding.where): finding for finding in error.value.findings}


def one(plan: Any) -> Finding:
    """Return the only finding of a document that is not a plan."""
    found = refused(plan)
    assert len(found) == 1, found
    return next(iter(found.values()))


# ---------------------------------------------------------------- reading and writing


@pytest.mark.parametrize("name", FILES)
def test_the_plans_of_the_contract_are_read_and_written(name: str) -> None:
    plan = AssemblyPlan.from_json(document(name))
    assert AssemblyPlan.loads(plan.dumps()) == plan


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.parent.name)
def test_every_example_is_a_plan(path: Path) -> None:
    assert AssemblyPlan.load(path.parent) == AssemblyPlan.load(path)


def test_defaults_are_those_of_the_contract() -> None:
    plan = AssemblyPlan.from_json(chest())
    assert (plan.tree, plan.kernel, plan.couplings, plan.allow, plan.assumptions, plan.description) == (False, "build123d", (), (), (), "")
    box = plan.parts[0]
    assert isinstance(box, PartSpec)
    assert (box.rest_pose, box.envelope_mm, box.color, box.kernel, box.role, box.orientation) == (Pose(), None, None, None, "", "")
    assert (plan.materials[0].friction, plan.parameters[0].unit, box.connectors[0].frame) == (0.6, "mm", "part")
    assert box.connectors[0].kind == "frame"
    pose = Pose()
    assert (pose.at, pose.about, pose.axis, pose.angle_deg) == ((0, 0, 0), (0, 0, 0), (0, 0, 1), 0)


def test_stating_a_default_changes_no_byte() -> None:
    stated = chest()
    stated |= {"tree": False, "kernel": "build123d", "couplings": [], "allow": [], "assumptions": [], "description": ""}
    part(stated, "box").update({"rest_pose": {}, "envelope_mm": None, "color": None, "kernel": None, "role": "", "orientation": ""})
    connector(stated, "box", "hinge").update({"kind": "frame", "frame": "part"})
    joint(stated, "hinge").update({"mate": "aligned", "driver": False, "fit": None, "effort_n_mm": None, "rest_deg": 0})
    assert AssemblyPlan.from_json(stated).dumps() == AssemblyPlan.from_json(chest()).dumps()


def test_whole_numbers_are_written_without_a_point_and_minus_zero_as_zero() -> None:
    plan = chest()
    connector(plan, "box", "hinge")["o"] = [-0.0, 100.0, 80.5]
    written = AssemblyPlan.from_json(plan).dumps()
    assert '"o": [0, 100, 80.5]' in written


def test_the_order_of_keys_does_not_matter() -> None:
    turned = {key: chest()[key] for key in reversed(list(chest()))}
    assert AssemblyPlan.from_json(turned).dumps() == AssemblyPlan.from_json(chest()).dumps()


def test_long_values_are_broken_and_short_ones_are_not() -> None:
    written = AssemblyPlan.from_json(document("wardrobe")).dumps()
    assert '  {"name": "height", "value": 1800, "min": 1200, "max": 2400},\n' in written
    assert written.endswith("}\n")
    assert json.loads(written)["parts"][1]["name"] == "door_left"


def test_saving_and_loading_a_folder(tmp_path: Path) -> None:
    plan = AssemblyPlan.from_json(chest())
    assert plan.save(tmp_path) == tmp_path / "plan.json"
    assert plan.save(tmp_path / "other.json") == tmp_path / "other.json"
    assert AssemblyPlan.load(tmp_path) == AssemblyPlan.load(str(tmp_path / "other.json")) == plan
    assert sorted(path.name for path in tmp_path.iterdir()) == ["other.json", "plan.json"]


def test_a_save_that_fails_leaves_what_was_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = AssemblyPlan.from_json(chest())
    plan.save(tmp_path)
    before = (tmp_path / "plan.json").read_bytes()

    def full(*_: object) -> None:
        raise OSError("disk full")

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(OSError, match="disk full"):
        plan.save(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["plan.json"]
    assert (tmp_path / "plan.json").read_bytes() == before


def test_a_file_that_is_not_there_is_a_read_error(tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=r"plan\.json cannot be read: No such file"):
        AssemblyPlan.load(tmp_path)


def test_a_plan_made_in_python_is_the_plan_of_its_json() -> None:
    lid = DerivedPart(
        name="lid_right",
        derive=MirrorDerivation(source="lid", op="mirror", plane=MirrorPlane(point=(0, 0, 0), normal=(1, 0, 0))),
    )
    plan = AssemblyPlan.from_json(chest())
    both = plan.model_copy(update={"parts": (*plan.parts, lid)})
    written = both.to_json()
    assert written["parts"][2] == {
        "name": "lid_right",
        "derive": {"from": "lid", "op": "mirror", "plane": {"point": [0, 0, 0], "normal": [1, 0, 0]}},
    }
    assert AssemblyPlan.from_json(written) == both
    again = AssemblyPlan(
        form="articad.plan/1",
        name=both.name,
        ground=both.ground,
        freedoms=both.freedoms,
        parameters=both.parameters,
        materials=both.materials,
        parts=both.parts,
        joints=both.joints,
    )
    assert again == both


def test_a_plan_is_frozen() -> None:
    plan = AssemblyPlan.from_json(chest())
    with pytest.raises(ValidationError):
        plan.name = "other"  # type: ignore[misc]


# ---------------------------------------------------------------- round trip of any plan

plan_names = st.from_regex(r"[a-z][a-z0-9]{0,5}(_[a-z0-9]{1,4}){0,2}", fullmatch=True).filter(is_name)
numbers = st.one_of(
    st.integers(-(10**6), 10**6).map(float), st.floats(allow_nan=False, allow_infinity=False), st.sampled_from(["width / 2", "2 * pi"])
)
vectors = st.tuples(numbers, numbers, numbers)
texts = st.text(st.characters(exclude_categories=["Cc", "Cs"], include_characters="\t\n", exclude_characters="\ufffe\uffff"), max_size=30)
poses = st.builds(Pose, at=vectors, about=vectors, axis=vectors, angle_deg=numbers)
specs = st.builds(
    ConnectorSpec,
    name=plan_names,
    o=vectors,
    z=vectors,
    x=st.none() | vectors,
    frame=st.sampled_from(["part", "assembly"]),
    kind=st.sampled_from(["frame", "hinge_axis"]),
    label=texts,
)
parts = st.builds(
    PartSpec,
    name=plan_names,
    material=plan_names,
    description=texts,
    dimensions=st.dictionaries(plan_names, numbers, max_size=3),
    envelope_mm=st.none() | vectors,
    rest_pose=poses | st.just("auto"),
    connectors=st.lists(specs, max_size=2).map(tuple),
)
parameters = st.builds(Parameter, name=plan_names, value=numbers, unit=st.sampled_from(["mm", "deg", "1"]), min=st.none() | numbers)


@given(st.lists(parts, max_size=3), st.lists(parameters, max_size=3), st.integers(0, 9), plan_names)
def test_any_plan_comes_back_from_its_text(some: list[PartSpec], values: list[Parameter], freedoms: int, name: str) -> None:
    plan = AssemblyPlan(
        form="articad.plan/1",
        name=name,
        ground=name,
        freedoms=freedoms,
        parameters=tuple(values),
        materials=(),
        parts=tuple(some),
        joints=(),
    )
    assert AssemblyPlan.loads(plan.dumps()) == plan
    assert AssemblyPlan.loads(plan.dumps().encode()).dumps() == plan.dumps()


# ---------------------------------------------------------------- what is refused

EVERY_JOINT: list[Json] = [
    {"type": "fixed"},
    {"type": "revolute", "angle_deg": "endless", "rest_deg": "1 + 1"},
    {"type": "slider", "travel_mm": [0, "10"], "rest_mm": 1},
    {"type": "cylindrical", "travel_mm": "endless", "angle_deg": [-1, 1], "rest_mm": 0, "rest_deg": 0},
    {"type": "ball", "cone_deg": 30, "twist_deg": [-10, 10]},
    {"type": "ball", "cone_deg": 30, "twist_deg": None},
    {"type": "screw", "lead_mm": 2, "angle_deg": "endless", "rest_deg": 0},
    {"type": "planar", "x_mm": [0, 1], "y_mm": [0, 1], "angle_deg": "endless"},
    {"type": "universal", "a_deg": [-40, 40], "b_deg": [-40, 40]},
]
EVERY_COUPLING: list[Json] = [
    {"type": "gear", "joints": ["turn_small", "turn_large"], "teeth": [20, "40"], "internal": True},
    {"type": "belt", "joints": ["turn_small", "turn_large"], "radii_mm": [10, 20]},
    {"type": "rack", "joints": ["turn_small", "slide"], "module_mm": 2, "teeth": 20},
    {"type": "screw", "joints": ["turn_small", "slide"], "lead_mm": 4},
    {"type": "linear", "joints": ["turn_small", "slide.travel"], "ratio": 2, "offset": 0},
]


@pytest.mark.parametrize("form", EVERY_JOINT, ids=lambda form: form["type"])
def test_every_joint_of_the_contract_is_read(form: Json) -> None:
    everything = {
        **form,
        "mate": "opposed",
        "driver": True,
        "fit": {"gap_mm": [0, "0.5"], "within_mm": 3, "contact": "required"},
        "effort_n_mm": 1,
        "velocity_deg_s": 2,
        "effort_n": 3,
        "velocity_mm_s": "4",
    }
    plan = AssemblyPlan.from_json(pair(everything, 1))
    assert AssemblyPlan.loads(plan.dumps()) == plan


@pytest.mark.parametrize("form", EVERY_COUPLING, ids=lambda form: form["type"])
def test_every_coupling_of_the_contract_is_read(form: Json) -> None:
    plan = AssemblyPlan.from_json(gears(**form))
    assert AssemblyPlan.loads(plan.dumps()) == plan


def changed(*path: str | int, value: Any) -> Json:
    """Return the chest with one value replaced, or removed if the value is ..."""
    plan = chest()
    node: Any = plan
    for step in path[:-1]:
        node = node[step]
    if value is ...:
        del node[path[-1]]
    else:
        node[path[-1]] = value
    return plan


@pytest.mark.parametrize(
    ("plan", "code", "where", "words"),
    [
        (changed("schema", value="articad.plan/2"), "E_SCHEMA", "schema", 'Give "articad.plan/1"'),
        (changed("name", value="Chest"), "E_NAME", "name", "lower_snake_case"),
        (changed("name", value="a" * 41), "E_NAME", "name", "at most 40"),
        (changed("name", value="class"), "E_NAME", "name", "no Python keyword"),
        (changed("name", value="box\n"), "E_NAME", "name", "lower_snake_case"),
        (changed("parts", 0, "name", value="../box"), "E_NAME", "parts[0].name", "lower_snake_case"),
        (changed("name", value="b\u043ex"), "E_NAME", "name", "lower_snake_case"),
        (changed("name", value="a__b"), "E_NAME", "name", "single underscores"),
        (changed("name", value=3), "E_SCHEMA", "name", "a name in quotes"),
        (changed("ground", value=...), "E_SCHEMA", "ground", "Add 'ground': The part that does not move."),
        (changed("materials", value=...), "E_SCHEMA", "materials", "Add 'materials'."),
        (changed("freedoms", value=1.5), "E_SCHEMA", "freedoms", "a whole number of at least 0"),
        (changed("freedoms", value=-1), "E_SCHEMA", "freedoms", "at least 0"),
        (changed("freedoms", value=True), "E_SCHEMA", "freedoms", "cannot be true"),
        (changed("tree", value="yes"), "E_SCHEMA", "tree", "Give true or false."),
        (changed("parts", value={}), "E_SCHEMA", "parts", "a list"),
        (changed("parts", 0, value=5), "E_SCHEMA", "parts[0]", "an object"),
        (changed("description", value=None), "E_SCHEMA", "description", "text in quotes"),
        (changed("kernel", value="openscad"), "E_SCHEMA", "kernel", '"build123d" or "freecad"'),
        (changed("materials", 0, "color", value="brown"), "E_SCHEMA", "materials.wood.color", "#rrggbb"),
        (changed("parameters", 0, "unit", value="cm"), "E_SCHEMA", "parameters.width.unit", '"mm", "deg" or "1"'),
        (changed("parameters", 0, "value", value=[1]), "E_SCHEMA", "parameters.width.value", "an expression in quotes"),
        (changed("parameters", 0, "value", value=True), "E_SCHEMA", "parameters.width.value", "cannot be true"),
        (changed("parameters", 0, "value", value=float("nan")), "E_NONFINITE", "parameters.width.value", "NaN"),
        (changed("parameters", 0, "value", value=10**400), "E_NONFINITE", "parameters.width.value", "finite"),
        (changed("parameters", 0, "value", value="1+" * 100 + "1"), "E_EXPRESSION", "parameters.width.value", "longer than 200"),
        (changed("parts", 0, "connectors", 0, "z", value=[0, 1]), "E_SCHEMA", "parts.box.connectors.hinge.z", "three numbers [x, y, z]"),
        (changed("parts", 0, "connectors", 0, "o", 2, value=None), "E_SCHEMA", "parts.box.connectors.hinge.o[2]", "cannot be null"),
        (changed("parts", 0, "connectors", 0, "kind", value="hinge"), "E_SCHEMA", "parts.box.connectors.hinge.kind", "Did you mean"),
        (changed("parts", 0, "connectors", 0, "label", value=...), "E_SCHEMA", "parts.box.connectors.hinge.label", "is missing"),
        (changed("parts", 0, "connectors", 0, "naem", value="x"), "E_SCHEMA", "parts.box.connectors.hinge.naem", "Did you mean 'name'?"),
        (changed("parts", 0, "rest_pose", value=4), "E_SCHEMA", "parts.box.rest_pose", 'or "auto"'),
        (changed("parts", 0, "rest_pose", value="automatic"), "E_SCHEMA", "parts.box.rest_pose", 'or "auto"'),
        (changed("parts", 0, "rest_pose", value={"angle": 3}), "E_SCHEMA", "parts.box.rest_pose.angle", "Did you mean 'angle_deg'?"),
        (changed("parts", 0, "dimensions", value={"Width": 3}), "E_NAME", "parts.box.dimensions.Width", '"Width"'),
        (changed("parts", 0, "dimensions", value={"width": "a" * 201}), "E_EXPRESSION", "parts.box.dimensions.width", "longer"),
        (changed("parts", 0, "dimensions", value=[]), "E_SCHEMA", "parts.box.dimensions", "an object"),
        (changed("joints", 0, "parent", value="box"), "E_SCHEMA", "joints.hinge.parent", "part.connector"),
        (changed("joints", 0, "parent", value=7), "E_SCHEMA", "joints.hinge.parent", "part.connector"),
        (changed("joints", 0, "parent", value="box.Hinge"), "E_NAME", "joints.hinge.parent", "lower_snake_case"),
        (changed("joints", 0, "mate", value="opposite"), "E_SCHEMA", "joints.hinge.mate", "Did you mean 'opposed'?"),
        (changed("joints", 0, "type", value="revolve"), "E_SCHEMA", "joints.hinge.type", "Did you mean 'revolute'?"),
        (changed("joints", 0, "type", value="prismatic"), "E_SCHEMA", "joints.hinge.type", "Here it is called slider."),
        (changed("joints", 0, "type", value="continuous"), "E_SCHEMA", "joints.hinge.type", '"angle_deg": "endless"'),
        (changed("joints", 0, "type", value=...), "E_SCHEMA", "joints.hinge.type", "Valid: fixed, revolute"),
        (changed("joints", 0, "type", value="slider"), "E_LIMITS_KIND", "joints.hinge.angle_deg", "A slider joint has travel_mm, rest_mm."),
        (changed("joints", 0, "type", value="fixed"), "E_LIMITS_KIND", "joints.hinge.angle_deg", "A fixed joint has no limits"),
        (changed("joints", 0, "angle_deg", value=90), "E_SCHEMA", "joints.hinge.angle_deg", '[lower, upper] or "endless"'),
        (changed("joints", 0, "angle_deg", value=[0, 1, 2]), "E_SCHEMA", "joints.hinge.angle_deg", "[lower, upper]"),
        (changed("joints", 0, "angle_deg", value=[0, None]), "E_SCHEMA", "joints.hinge.angle_deg[1]", "cannot be null"),
        (changed("joints", 0, "angle_deg", value=[0, float("inf")]), "E_NONFINITE", "joints.hinge.angle_deg[1]", "Infinity"),
        (changed("joints", 0, "fit", value={"contact": "no"}), "E_SCHEMA", "joints.hinge.fit.contact", '"forbidden"'),
        (changed("joints", 0, "fit", value={"gap_mm": 1}), "E_SCHEMA", "joints.hinge.fit.gap_mm", "[lower, upper]"),
        (changed("joints", 0, "fit", value={"gap": 1}), "E_SCHEMA", "joints.hinge.fit.gap", "Did you mean 'gap_mm'?"),
        (
            changed("joints", 0, "derive", value={"from": "x", "op": "mirror"}),
            "E_SCHEMA",
            "joints.hinge.type",
            "Allowed here: name, derive",
        ),
        (changed("assumptions", value=[1]), "E_SCHEMA", "assumptions[0]", "text in quotes"),
        (changed("units", value="mm"), "E_SCHEMA", "units", "Allowed here: schema, name"),
        (changed("allow", value=[{"parts": ["a"], "max_depth_mm": 1, "reason": ""}]), "E_SCHEMA", "allow[0].parts", "two parts"),
        (changed("allow", value=[{"parts": ["a", "b"], "reason": ""}]), "E_ALLOW", "allow[0].max_depth_mm", "the largest depth in mm"),
    ],
)
def test_a_wrong_value_is_answered_at_its_path(plan: Json, code: str, where: str, words: str) -> None:
    found = refused(plan)
    assert (code, where) in found, list(found)
    finding = found[code, where]
    assert words in f"{finding.message} {finding.hint}"
    assert finding.hint


def test_all_faults_are_answered_at_once() -> None:
    plan = chest()
    plan["freedoms"] = "one"
    plan["colour"] = "red"
    part(plan, "lid")["connectors"][0]["z"] = "up"
    joint(plan, "hinge")["angel_deg"] = [0, 1]
    assert set(refused(plan)) == {
        ("E_SCHEMA", "freedoms"),
        ("E_SCHEMA", "colour"),
        ("E_SCHEMA", "parts.lid.connectors.hinge.z"),
        ("E_SCHEMA", "joints.hinge.angel_deg"),
    }


def test_the_error_itself_shows_the_first_faults_and_how_many_more() -> None:
    plan = chest() | {f"key_{index}": 0 for index in range(9)}
    with pytest.raises(PlanError) as error:
        AssemblyPlan.from_json(plan)
    assert str(error.value).count("\n") == 5
    assert str(error.value).endswith("… and 4 more.")


@pytest.mark.parametrize("joint_type", ["slider", "ball", "universal", "planar"])
def test_what_cannot_be_endless_says_so(joint_type: str) -> None:
    key = {"slider": "travel_mm", "ball": "twist_deg", "universal": "a_deg", "planar": "x_mm"}[joint_type]
    finding = one(pair({"type": joint_type, key: "endless"}, 1))
    assert (finding.code, finding.where) == ("E_LIMITS_KIND", f"joints.j.{key}")
    assert "Give [lower, upper]" in finding.hint


def test_derivations_are_answered_in_their_own_terms() -> None:
    plan = document("wardrobe")
    part(plan, "door_right")["derive"]["op"] = "mirorr"
    part(plan, "drawer_upper")["derive"]["plane"] = {}
    joint(plan, "hinge_right")["derive"]["op"] = "pattern"
    joint(plan, "slide_upper")["derive"]["form"] = "x"
    part(plan, "drawer_lower")["derive"] = {"from": "door_left", "op": "pattern", "count": 2}
    found = refused(plan)
    assert "Did you mean 'mirror'?" in found["E_SCHEMA", "parts.door_right.derive.op"].hint
    assert "Allowed here: from, op, move." in found["E_SCHEMA", "parts.drawer_upper.derive.plane"].hint
    assert '"mirror" or "rigid"' in found["E_SCHEMA", "joints.hinge_right.derive.op"].hint
    assert "Did you mean 'from'?" in found["E_SCHEMA", "joints.slide_upper.derive.form"].hint
    assert found["E_SCHEMA", "parts.drawer_lower.derive.step"].message == "'step' is missing."
    assert "Allowed here: name, description, color, derive." in found["E_SCHEMA", "parts.drawer_lower.material"].hint


def test_a_derivation_that_is_no_object_says_so() -> None:
    plan = document("wardrobe")
    part(plan, "door_right")["derive"] = "door_left"
    assert "an object" in one(plan).hint
    del part(plan, "drawer_upper")["derive"]["op"]
    assert refused(plan)["E_SCHEMA", "parts.drawer_upper.derive.op"].message == "'op' is missing."


def test_couplings_are_answered_in_their_own_terms() -> None:
    finding = one(gears(type="gaer", joints=["turn_small", "turn_large"]))
    assert (finding.where, finding.hint) == ("couplings.tie.type", "Did you mean 'gear'? Valid: gear, belt, rack, screw, linear.")
    finding = one(gears(type="gear", joints=["turn_small", "a.b.c"], teeth=[1, 2]))
    assert finding.where == "couplings.tie.joints[1]"
    finding = one(gears(type="gear", joints=["turn_small"], teeth=[1, 2]))
    assert "two joints" in finding.hint


@pytest.mark.parametrize(
    ("text", "where", "words"),
    [
        ("{", "line 1 column 2", "in double quotes"),
        ("", "line 1 column 1", "This is not JSON"),
        ('{"name": "x",\n}', "line 2 column 1", "no comma before"),
        ("[1]", "plan", "not [1]"),
        ("null", "plan", "not null"),
        ('{"a": 1, "b": {"c": 1, "c": 2}}', "plan", "The key 'c' occurs twice"),
        ("[" * 100_000, "plan", "nested too deeply"),
        (b"\xff\xfe\xff", "plan", "UTF-8"),
        ("1" * 5000, "plan", "This is not JSON"),
    ],
)
def test_what_is_not_json_says_where(text: str | bytes, where: str, words: str) -> None:
    with pytest.raises(PlanError) as error:
        AssemblyPlan.loads(text)
    (finding,) = (found for found in error.value.findings if found.where == where)  # what is JSON has findings about its fields, too
    assert finding.code == "E_SCHEMA"
    assert words in f"{finding.message} {finding.hint}"


@pytest.mark.parametrize("constant", ["NaN", "Infinity", "-Infinity"])
def test_json_constants_that_are_not_numbers_are_refused(constant: str) -> None:
    text = json.dumps(chest()).replace("[0, 100, 80]", f"[{constant}, 100, 80]", 1)
    with pytest.raises(PlanError) as error:
        AssemblyPlan.loads(text)
    assert error.value.findings.codes == ("E_NONFINITE",)
    assert constant in error.value.findings[0].message


@given(st.recursive(st.none() | st.booleans() | st.floats() | st.text(max_size=5), lambda inner: st.lists(inner, max_size=3)))
def test_no_value_anywhere_escapes_as_another_error(value: Any) -> None:
    for path in (
        ("name",),
        ("parts",),
        ("parts", 0),
        ("parts", 0, "connectors", 0, "z"),
        ("joints", 0),
        ("joints", 0, "angle_deg"),
        ("allow",),
    ):
        with contextlib.suppress(PlanError):
            AssemblyPlan.from_json(changed(*path, value=value))


def test_a_thousand_faults_are_put_into_words_and_the_rest_counted() -> None:
    """A plan of 100,000 empty parts has 300,000 faults."""
    with pytest.raises(PlanError) as caught:
        AssemblyPlan.from_json({"name": "a", "parts": [{"name": f"p{number}"} for number in range(2000)], "joints": []})
    assert len(caught.value.findings) == 1001
    assert any(re.search(r"There are \d+ more errors", finding.message) for finding in caught.value.findings)
