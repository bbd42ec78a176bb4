"""Briefs and digests: what a script sees, and when it or its geometry is out of date."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable
from typing import Any

import pytest

from articad.plan.brief import brief, brief_digest, build_digest
from articad.plan.resolve import ResolvedPlan, resolve
from articad.plan.schema import AssemblyPlan
from tests.plan.samples import Json, chest, connector, document, joint, pair, part

SCRIPT = b"def build(part): ..."


def resolved(plan: Json) -> ResolvedPlan:
    return resolve(AssemblyPlan.from_json(plan))


def digests(plan: Json, name: str) -> tuple[str, str]:
    result = resolved(plan)
    return brief_digest(result, name), build_digest(result, name, SCRIPT, "build123d", "0.13", 0.01)


def test_a_script_is_told_what_the_contract_says() -> None:
    told = brief(resolved(document("wardrobe")), "door_left")
    assert told == {
        "name": "door_left",
        "description": document("wardrobe")["parts"][1]["description"],
        "material": "lacquer",
        "dimensions": {"width": 448.5, "height": 1355.0, "thickness": 18.0, "inset": 6.0},
        "envelope_mm": [448.5, 18.0, 1355.0],
        "connectors": {
            "hinge": {
                "o": [0.0, 0.0, 0.0],
                "z": [0.0, 0.0, 1.0],
                "x": [1.0, 0.0, 0.0],
                "label": "hinge axis at the foot of the bore",
                "joints": [
                    {
                        "name": "hinge_left",
                        "type": "revolute",
                        "side": "child",
                        "mate": "aligned",
                        "limits": {"angle_deg": [-110.0, 0.0]},
                        "fit": {"gap_mm": [0.1, 0.4], "within_mm": None, "contact": "allowed"},
                        "other": "cabinet.hinge_left",
                    }
                ],
            }
        },
    }
    json.dumps(told, allow_nan=False)


def test_the_parents_side_and_several_joints_are_told() -> None:
    told = brief(resolved(document("wardrobe")), "cabinet")["connectors"]
    assert [(j["name"], j["side"], j["other"]) for j in told["runner_upper"]["joints"]] == [("slide_upper", "parent", "drawer_upper.slide")]
    assert told["hinge_right"]["joints"][0]["limits"] == {"angle_deg": [0.0, 110.0]}  # of the derived joint, mirrored
    assert told["runner_lower"]["joints"][0]["limits"] == {"travel_mm": [0.0, 359.25]}


@pytest.mark.parametrize(
    ("form", "limits"),
    [
        ({"type": "fixed"}, {}),
        ({"type": "revolute", "angle_deg": "endless"}, {"angle_deg": "endless"}),
        ({"type": "ball", "cone_deg": 35}, {"cone_deg": 35.0, "twist_deg": None}),
        ({"type": "ball", "cone_deg": 35, "twist_deg": [-10, 20]}, {"cone_deg": 35.0, "twist_deg": [-10.0, 20.0]}),
        ({"type": "universal", "a_deg": [-1, 1], "b_deg": [-2, 2]}, {"a_deg": [-1.0, 1.0], "b_deg": [-2.0, 2.0]}),
        ({"type": "cylindrical", "travel_mm": "endless", "angle_deg": [0, 9]}, {"travel_mm": "endless", "angle_deg": [0.0, 9.0]}),
    ],
)
def test_limits_are_told_under_the_plans_names_and_in_its_units(form: Json, limits: Json) -> None:
    assert brief(resolved(pair(form, 0)), "b")["connectors"]["c"]["joints"][0]["limits"] == limits
    assert brief(resolved(pair(form, 0)), "b")["connectors"]["c"]["joints"][0]["fit"] is None
    assert brief(resolved(pair(form, 0)), "b")["envelope_mm"] is None


def test_a_fit_without_a_gap_says_so() -> None:
    form = {"type": "revolute", "angle_deg": [0, 1], "fit": {"contact": "required", "within_mm": 4}}
    told = brief(resolved(pair(form, 1)), "a")["connectors"]["c"]["joints"][0]
    assert told["fit"] == {"gap_mm": None, "within_mm": 4.0, "contact": "required"}


def test_an_x_that_the_plan_leaves_open_does_not_depend_on_where_the_part_stands() -> None:
    plan = pair({"type": "revolute", "angle_deg": [0, 90]}, 1)
    for name in ("a", "b"):
        part(plan, name)["rest_pose"] = {"axis": [0, 0, 1], "angle_deg": 30}
    assert resolved(plan).parts["a"].connectors["c"].roll_free
    assert brief(resolved(plan), "a")["connectors"]["c"]["x"] == [1.0, 0.0, 0.0]
    before = digests(plan, "a")
    for name in ("a", "b"):
        part(plan, name)["rest_pose"]["angle_deg"] = 55
    assert digests(plan, "a") == before


# ---------------------------------------------------------------- digests


def moved(plan: Json) -> None:
    part(plan, "lid")["rest_pose"] = {"at": [1, 2, 3], "angle_deg": 20}


def repainted(plan: Json) -> None:
    part(plan, "lid")["color"] = "#000000"
    plan["materials"][0].update(color="#111111", density_kg_m3=1, friction=0.1)


def resized(plan: Json) -> None:
    part(plan, "lid")["dimensions"]["width"] = 301


def parameter_moved(plan: Json) -> None:
    plan["parameters"][0]["value"] = 301


def connector_moved(plan: Json) -> None:
    connector(plan, "lid", "hinge")["o"] = [1, 0, 0]


def limits_widened(plan: Json) -> None:
    joint(plan, "hinge")["angle_deg"] = [0, 120]


def gap_changed(plan: Json) -> None:
    joint(plan, "hinge")["fit"]["gap_mm"] = [0.1, 0.6]


def envelope_changed(plan: Json) -> None:
    part(plan, "lid")["envelope_mm"] = [1, 2, 4]


def neighbour_renamed(plan: Json) -> None:
    part(plan, "box")["name"] = plan["ground"] = "crate"
    joint(plan, "hinge")["parent"] = "crate.hinge"


def described(plan: Json) -> None:
    part(plan, "lid")["description"] = "A vaulted lid."


def dimension_added(plan: Json) -> None:
    part(plan, "lid")["dimensions"]["vault"] = 30


def relabelled(plan: Json) -> None:
    connector(plan, "lid", "hinge")["label"] = "axis of the barrel"


def mate_turned(plan: Json) -> None:
    joint(plan, "hinge")["mate"] = "opposed"


def contact_changed(plan: Json) -> None:
    joint(plan, "hinge")["fit"]["contact"] = "forbidden"


def retyped(plan: Json) -> None:
    joint(plan, "hinge").update(type="fixed")
    del joint(plan, "hinge")["angle_deg"]


def remade(plan: Json) -> None:
    plan["materials"].append({"name": "steel", "density_kg_m3": 7850, "color": "#888888"})
    part(plan, "lid")["material"] = "steel"


def rekerneled(plan: Json) -> None:
    part(plan, "lid")["kernel"] = "freecad"


def unrelated(plan: Json) -> None:
    part(plan, "box")["dimensions"]["depth"] = 5
    part(plan, "box")["connectors"].append({"name": "foot", "o": [0, 0, 0], "z": [0, 0, 1], "label": ""})
    plan["description"] = plan["assumptions"] = []
    plan["description"] = "x"


@pytest.mark.parametrize(
    ("change", "same_brief", "same_build"),
    [
        (moved, True, True),
        (repainted, True, True),
        (unrelated, True, True),
        (resized, True, False),
        (parameter_moved, True, False),
        (connector_moved, True, False),
        (limits_widened, True, False),
        (gap_changed, True, False),
        (envelope_changed, True, False),
        (neighbour_renamed, True, False),
        (described, False, False),
        (dimension_added, False, False),
        (relabelled, False, False),
        (mate_turned, False, False),
        (contact_changed, False, False),
        (retyped, False, False),
        (remade, False, False),
    ],
)
def test_which_change_outdates_what(change: Callable[[Json], Any], same_brief: bool, same_build: bool) -> None:
    plan = chest()
    part(plan, "lid").update(dimensions={"width": "width"}, envelope_mm=[1, 2, 3])
    joint(plan, "hinge")["fit"] = {"gap_mm": [0.1, 0.5], "contact": "allowed"}
    before = digests(plan, "lid")
    change(plan)
    after = digests(plan, "lid")
    assert (after[0] == before[0], after[1] == before[1]) == (same_brief, same_build)


def test_another_kernel_for_the_part_outdates_its_script() -> None:
    plan = chest()
    before = digests(plan, "lid")
    rekerneled(plan)
    assert digests(plan, "lid")[0] != before[0]


def test_the_build_digest_covers_script_kernel_version_and_deflection() -> None:
    result = resolved(chest())
    usual: dict[str, Any] = {"script": SCRIPT, "kernel": "build123d", "version": "0.13", "deflection": 0.01}
    changes: list[dict[str, Any]] = [{"script": SCRIPT + b"\n"}, {"kernel": "freecad"}, {"version": "0.14"}, {"deflection": 0.02}]
    all_digests = [build_digest(result, "lid", **{**usual, **change}) for change in [{}, *changes]]
    assert len(set(all_digests)) == 5
    assert all(len(digest) == 64 for digest in all_digests)


def test_the_build_digest_is_the_sha256_of_canonical_json() -> None:
    result = resolved(chest())
    told = {
        "brief": brief(result, "lid"),
        "script": hashlib.sha256(SCRIPT).hexdigest(),
        "kernel": "build123d",
        "version": "0.13",
        "deflection": 0.01,
    }
    text = json.dumps(told, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    assert build_digest(result, "lid", SCRIPT, "build123d", "0.13", 0.01) == hashlib.sha256(text.encode()).hexdigest()


def test_an_override_is_a_change_of_numbers() -> None:
    plan = AssemblyPlan.from_json(document("wardrobe"))
    wide = resolve(plan, width=1000.0)
    usual = resolve(plan)
    assert brief_digest(wide, "door_left") == brief_digest(usual, "door_left")
    assert build_digest(wide, "door_left", b"", "k", "1", 0.01) != build_digest(usual, "door_left", b"", "k", "1", 0.01)


def test_an_unknown_part_is_a_key_error() -> None:
    with pytest.raises(KeyError):
        brief(resolved(chest()), "drawer")
