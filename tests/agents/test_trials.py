"""Changes that are offered for the faults of a built product were tried: each ends all of them."""

from __future__ import annotations

from typing import Any

import pytest

from articad.agents.evidence import examine
from articad.assembly import Assembly
from articad.findings import Finding
from articad.plan.amending import amended
from articad.plan.schema import AssemblyPlan
from articad_bench.obeying import followed
from tests.agents import stories
from tests.agents.test_orders import carriage_on_a_rail, plan, wheel_on_a_pin


def told(assembly: Assembly) -> Finding:
    """Return the finding whose hint states the changes."""
    return next(finding for finding in examine(assembly).findings if "change" in (finding.hint or "") and "end" in (finding.hint or ""))


@pytest.mark.parametrize("name", ["bore", "clearance"])
def test_a_dimension_in_inches_is_told_in_millimetres(name: str) -> None:
    meant = {"bore": 4.0, "clearance": 0.2}[name]
    document, made = wheel_on_a_pin(fit=None, **{name: meant / 25.4})
    finding = told(made)

    assert finding.route == "design"
    assert f'.dimensions.{name}": {meant}' in finding.hint
    first = followed(finding, document)[0]
    own = {key: value for part in first["parts"] for key, value in part["dimensions"].items()}
    assert own == {"plate": 5, "pin": 4, "clearance": 0.2, "radius": 12, "bore": 4}
    assert examine(wheel_on_a_pin(**own)[1]).findings.ok


@pytest.mark.parametrize("gap", [[1, 2], [0.35, 3], [0.01, 0.15]], ids=str)
@pytest.mark.parametrize("kind", ["bore", "slot"])
def test_a_fit_that_the_parts_do_not_keep_is_told_as_it_was_built(kind: str, gap: list[float]) -> None:
    if kind == "bore":
        document, made = wheel_on_a_pin(fit={"gap_mm": gap, "contact": "forbidden"})
    else:
        document, made = carriage_on_a_rail(gap=(gap[0], gap[1]))
    first = followed(told(made), document)[0]["joints"][0]["fit"]["gap_mm"]

    assert first[0] <= 0.2 <= first[1]
    assert gap[0] in first or gap[1] in first  # the bound that was kept stays
    if kind == "bore":
        assert examine(wheel_on_a_pin(fit={"gap_mm": first, "contact": "forbidden"})[1]).findings.ok
    else:
        assert examine(carriage_on_a_rail(gap=(first[0], first[1]))[1]).findings.ok


# A sleeve on a square rail. The rail has a collar on one side, as far from the sleeve as `free`.
RAIL = """
from build123d import Box, Pos

def build(part):
    d = part.dimensions
    return Box(300, 10, 10) + Pos(d["free"] + 10, 0, 0) * Box(10, 20, 20), dict(part.connectors)
"""
SLEEVE = """
from build123d import Box

def build(part):
    d = part.dimensions
    return Box(d["length"], 20, 20) - Box(d["length"], 10.2, 10.2), dict(part.connectors)
"""


def sleeve_on_a_rail(travel: list[float], free: float) -> tuple[dict[str, Any], Assembly]:
    axis = {"name": "axis", "o": [0, 0, 0], "z": [1, 0, 0], "x": [0, 1, 0], "label": "axis"}
    rail = {"name": "rail", "description": "rail", "dimensions": {"free": free}, "connectors": [axis]}
    sleeve = {"name": "sleeve", "description": "sleeve", "dimensions": {"length": 10}, "connectors": [axis], "rest_pose": {"at": [0, 0, 0]}}
    slide = {"name": "slide", "type": "slider", "parent": "rail.axis", "child": "sleeve.axis", "travel_mm": travel}
    document = plan("slide", [rail, sleeve], slide)
    made = Assembly.from_plan(
        AssemblyPlan.from_json(document), {"rail": RAIL, "sleeve": SLEEVE}, kernel=stories.kernel(), cache=stories.shared_cache(), jobs=1
    )
    return document, made


@pytest.mark.parametrize("free", [20, 33])
@pytest.mark.parametrize("reach", [60, 85])
def test_a_travel_into_a_stop_is_told_the_range_that_is_free(free: float, reach: float) -> None:
    document, made = sleeve_on_a_rail([-reach, reach], free)
    finding = told(made)
    first = followed(finding, document)[0]

    low, high = first["joints"][0]["travel_mm"]
    assert (finding.code, finding.where, low) == ("E_MOTION_COLLISION", "joints.slide", -reach)
    assert free - 0.05 * reach < high < free
    assert examine(sleeve_on_a_rail([low, high], free)[1]).findings.ok


@pytest.mark.parametrize("reach", [60, 85])
def test_limits_with_the_wrong_sign_are_told_with_the_other(reach: float) -> None:
    document, made = sleeve_on_a_rail([0, reach], 20)
    offered = followed(told(made), document)

    assert offered[0] == amended(document, {"joints.slide.travel_mm": [-reach, 0]})
    assert 15 < offered[1]["joints"][0]["travel_mm"][1] < 20


def test_a_product_without_faults_is_told_nothing() -> None:
    _, made = sleeve_on_a_rail([-60, 15], 20)
    assert not examine(made).findings
