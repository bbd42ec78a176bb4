"""Hints about geometry, followed literally: each number that a hint states is applied to the planted fault, and its finding is gone.

As for the hints of plans (`tests/plan/test_hints.py`), the repairer reads nothing but the hint. A hint with alternatives has a rule for each.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import manifold3d as m3
import numpy as np
import pytest

from articad.certificates.certificate import certify
from articad.certificates.fits import certified_fits, check_fits
from articad.findings import Finding, Findings
from articad.geometry import box, cylinder, merged, sphere
from articad.interference.scene import Scene
from articad.kinematics.mechanism import Mechanism
from tests.interference.mechanisms import IDENTITY, Fit, at, block_with_bore, fixed, joint, manifold_mesh, without_triangle
from tests.interference.test_certificate import arm
from tests.interference.test_check import check
from tests.interference.test_diagnosis import FORK_HINGE, OUT, PANELS, PINS, TONGUE, cabinet, findings, flap, fork, rods
from tests.obedience import worse

Knobs = dict[str, Any]
NUMBER = r"(-?[\d.]+(?:e-?\d+)?)"
TRIPLE = r"\((\S+), (\S+), (\S+)\)"


@dataclass(frozen=True)
class Case:
    """A planted fault of some size, and for each wording of its hint what a reader changes."""

    code: str
    made: Callable[[Knobs], Findings]
    knobs: Knobs
    rules: list[tuple[str, Callable[[Knobs, re.Match[str]], Knobs]]] = field(default_factory=list)


def to(knob: str) -> Callable[[Knobs, re.Match[str]], Knobs]:
    return lambda _knobs, match: {knob: float(match[1])}


def by(knob: str, share: float = 1.0) -> Callable[[Knobs, re.Match[str]], Knobs]:
    return lambda knobs, match: {knob: knobs[knob] + share * float(match[1])}


def bored(knobs: Knobs) -> Findings:
    """A pin that turns in a block with a bore of some diameter, or none."""
    block = block_with_bore(40, 10, knobs["bore"] / 2, 64) if knobs["bore"] else box(40, 40, 10)
    return findings({"block": block, "pin": cylinder(knobs["pin"] / 2, 30, 64)}, [joint("turn", "revolute", "block", "pin")])


def slotted(knobs: Knobs) -> Findings:
    """A tongue in a fork that has no slot; `cut` is removed from the fork."""
    body = fork(0)
    if knobs["cut"]:
        low, high = np.array(knobs["cut"]).reshape(3, 2).T
        solid = m3.Manifold(m3.Mesh(np.asarray(body.vertices, np.float32), np.asarray(body.triangles, np.uint32)))
        body = manifold_mesh(solid - m3.Manifold.cube((high - low).tolist()).translate(low.tolist()))
    return findings({"fork": body, "tongue": TONGUE}, [FORK_HINGE])


def cut(knobs: Knobs, match: re.Match[str]) -> Knobs:
    """Remove the stated extent, as wide along the axis (y) as the slot is to be."""
    width, *extent = (float(text) for text in match.groups())
    return {"cut": [*extent[:2], -width / 2, width / 2, *extent[4:]]}


def drawn(knobs: Knobs) -> Findings:
    """A drawer whose front is flush; it may be too long, or travel too far in."""
    length = knobs["long"]
    drawer = box(88, length, 38).transformed(at(y=-47.5 + length / 2 + knobs["shift"]))
    rail = joint("slide", "slider", "cabinet", "drawer", at_parent=OUT, at_child=OUT, lower=(knobs["lower"],), upper=(40.0,))
    return findings({"cabinet": cabinet(90), "drawer": drawer}, [rail])


def apart(knobs: Knobs) -> Findings:
    part = manifold_mesh(
        m3.Manifold.cube([10, 10, 10], center=True) + m3.Manifold.cube([10, 10, 10], center=True).translate([10 + knobs["gap"], 0, 0])
    )
    meshes = {"base": box(40, 40, 4).transformed(at(z=-7)), "part": part}
    return findings(meshes, [joint("lift", "slider", "base", "part", lower=(0.0,), upper=(5.0,))])


def glued(knobs: Knobs) -> Findings:
    meshes = {"base": box(40, 40, 4 + 2 * knobs["more"]), "part": box(10, 10, 10).transformed(at(z=10))}
    return findings(meshes, [fixed("glue", "base", "part")])


def lifted(knobs: Knobs) -> Findings:
    meshes = {"base": box(40, 40, 4 + 2 * knobs["more"]), "part": box(10, 10, 10).transformed(at(z=27))}
    return findings(meshes, [joint("lift", "slider", "base", "part", lower=(0.0,), upper=(5.0,))])


def meeting(knobs: Knobs) -> Findings:
    """Two bodies without a joint between them, each fixed on a plate, that overlap along x, y and z by different depths."""
    first, second = box(20, 20, 20), box(20, 20, 20).transformed(at(*np.array([17.0, 3.0, 2.0]) + knobs["shift"]))
    plate = box(90, 90, 5).transformed(at(z=-12.5))
    return findings({"plate": plate, "first": first, "second": second}, [fixed("one", "plate", "first"), fixed("two", "plate", "second")])


def moved_some_way(knobs: Knobs, match: re.Match[str]) -> Knobs:
    """The hint leaves the direction open; the least way out is along x here."""
    return {"shift": np.array([float(match[1]) + 0.01, 0, 0])}


def flapping(knobs: Knobs) -> Findings:
    """A flap whose axis is in the face that it opens away from, or is moved as the hint says."""
    x, y, _ = np.array([0.0, 5.0, 0.0]) + knobs["shift"]
    return findings(PANELS, [flap(x, y, 0.0, 1.5)])


def turning(knobs: Knobs) -> Findings:
    return findings(PINS, rods(knobs["pitch"]))


def certified(knobs: Knobs) -> Findings:
    """A bar that turns against a post, over a range that is proven."""
    frame = joint("turn", "revolute", "base", "bar", lower=(math.radians(knobs["low"]),), upper=(math.radians(knobs["high"]),))
    meshes = {
        "base": merged([box(40, 40, 4).transformed(at(z=-8)), box(6, 6, 20).transformed(at(40 * math.cos(0.9), 40 * math.sin(0.9)))]),
        "bar": box(60, 6, 6, center=False).transformed(at(-5, -3, -3)),
    }
    return certify(meshes, Mechanism(tuple(meshes), "base", [frame])).findings


def fitted(knobs: Knobs) -> Findings:
    """A pin in a bore with a stated fit; facets are in phase, so that the gap is the clearance."""
    meshes = {"block": block_with_bore(40, 10, knobs["bore"] / 2, 256), "pin": cylinder(knobs["pin"] / 2, 20, 256)}
    still = joint("hinge", "revolute", "block", "pin", lower=(-1e-9,), upper=(1e-9,))
    deflection = knobs.get("deflection", 0.0)
    return check_fits(
        Scene.of(meshes, [still], deflection=deflection, fits={"hinge": Fit(0.1, 0.4, contact=knobs.get("contact"))})
    ).findings


def touching(knobs: Knobs) -> Findings:
    cube, glue = box(10, 10, 10), fixed("glue", "a", "b")
    scene = Scene.of({"a": cube, "b": cube.transformed(at(10 + knobs["gap"]))}, [glue], fits={"glue": Fit(contact=knobs["contact"])})
    return check_fits(scene).findings


def facing(knobs: Knobs) -> Findings:
    """Two flat faces that slide upon each other, so that only their distance says whether the fit is kept."""
    plane = joint("slide", "planar", "a", "b", lower=(0.0, 0.0, 0.0), upper=(1.0, 1.0, 0.0))
    meshes = {"a": box(10, 10, 10), "b": box(10, 10, 10).transformed(at(z=10.25))}
    return check_fits(Scene.of(meshes, [plane], deflection=knobs["deflection"], fits={"slide": Fit(0.1, 0.4)})).findings


def widened(knobs: Knobs, match: re.Match[str]) -> Knobs:
    return {"bore": knobs["bore"] + 2 * float(match[1])}


def forced(knobs: Knobs) -> Findings:
    """A long pin of 10.26 mm in a bore."""
    turn = joint("turn", "revolute", "a", "b")
    return check(block_with_bore(40, 10, knobs["bore"] / 2, 96), cylinder(5.13, 100, 96), IDENTITY, (turn,), deflection=0.003).findings


def open_or_closed(knobs: Knobs) -> Findings:
    """A block beside a mesh that lacks a triangle, or is whole."""
    other = box(10, 10, 10)
    body = other if knobs["closed"] else without_triangle(other)
    return findings({"base": body, "arm": box(10, 10, 10).transformed(at(10))}, [fixed("glue", "base", "arm")])


def proven_closed(knobs: Knobs) -> Findings:
    body = box(10, 10, 10) if knobs["closed"] else without_triangle(box(10, 10, 10))
    frame = joint("turn", "revolute", "base", "arm", lower=(-0.5,), upper=(0.5,))
    return certify({"base": body, "arm": box(10, 10, 10).transformed(at(50))}, Mechanism(("base", "arm"), "base", [frame])).findings


def spent(knobs: Knobs) -> Findings:
    meshes, joints = arm(260.0)
    more = {} if knobs["budget"] is None else {"budget": knobs["budget"]}
    return certify(meshes, Mechanism(tuple(meshes), "base", joints), **more).findings


def pressed(knobs: Knobs) -> Findings:
    meshes = {"block": block_with_bore(40, 10, 5, 48), "pin": cylinder(knobs["pin"], 20, 48)}
    turn = joint("turn", "revolute", "block", "pin", lower=(-0.5,), upper=(0.5,))
    return certify(meshes, Mechanism(tuple(meshes), "block", [turn])).findings


def sliding(knobs: Knobs) -> Findings:
    """A block in a long guide, with a slide that has limits or none."""
    link = joint("j", "slider", "a", "b", lower=(-knobs["far"],), upper=(knobs["far"],))
    bore = m3.Manifold.cube([knobs["bore"], knobs["bore"], 999], center=True)
    guide = manifold_mesh(m3.Manifold.cube([20, 20, 900], center=True) - bore)
    return certified_fits(check_fits(Scene.of({"a": guide, "b": box(10, 10, 20)}, [link], fits={"j": Fit(0.1, 0.4)}))).findings


CASES = [
    *(
        Case("E_STATIC_OVERLAP", bored, {"pin": pin, "bore": 0.0}, [(rf"Bore block .* diameter of {NUMBER} mm", to("bore"))])
        for pin in (4.0, 10.0, 17.3)
    ),
    Case("E_STATIC_OVERLAP", bored, {"pin": 10.0, "bore": 9.5}, [(rf"Remove {NUMBER} mm from one of them", by("bore", 2.0))]),
    Case(
        "E_STATIC_OVERLAP",
        slotted,
        {"cut": None},
        [(rf"slot {NUMBER} mm wide into fork .* x {NUMBER} to {NUMBER}, y {NUMBER} to {NUMBER}, z {NUMBER} to {NUMBER} mm", cut)],
    ),
    *(
        Case(
            "E_STATIC_OVERLAP",
            drawn,
            {"long": long, "shift": 0.0, "lower": 0.0},
            [
                (rf"Shorten drawer by {NUMBER} mm along its y", by("long", -1.0)),
                (rf"drawer by {NUMBER} mm .*move it by the same", by("shift", -1.0)),
            ],
        )
        for long in (92.0, 94.5)
    ),
    Case("E_MOTION_COLLISION", drawn, {"long": 90.0, "shift": 0.0, "lower": -4.0}, [(rf"Shorten the travel by {NUMBER} mm", by("lower"))]),
    Case(
        "E_MOTION_COLLISION",
        drawn,
        {"long": 90.0, "shift": 0.0, "lower": -4.0},
        [(rf"travel by {NUMBER} mm, or shorten drawer", by("long", -1.0))],
    ),
    Case("E_NOT_ONE_SOLID", apart, {"gap": 2.0}, [(rf"bring them {NUMBER} mm closer", by("gap", -1.0))]),
    Case("E_NOT_TOUCHING", glued, {"more": 0.0}, [(rf"Extend one of them by {NUMBER} mm towards", by("more"))]),
    Case("E_FLOATING", lifted, {"more": 0.0}, [(rf"extend one of the two by about {NUMBER} mm", by("more"))]),
    Case("E_OVERLAP", meeting, {"shift": np.zeros(3)}, [(rf"(?:Move one of them|Shorten \w+) by {NUMBER} mm", moved_some_way)]),
    Case(
        "E_MOTION_COLLISION",
        flapping,
        {"shift": np.zeros(3)},
        [(rf"Move the axis by {TRIPLE} mm", lambda _knobs, match: {"shift": np.array([float(number) for number in match.groups()])})],
    ),
    *(
        Case("E_MOTION_COLLISION", turning, {"pitch": pitch}, [(rf"Move the axes {NUMBER} mm further apart", by("pitch", 1.0005))])
        for pitch in (50.0, 57.0)
    ),
    Case(
        "E_MOTION_COLLISION",
        certified,
        {"low": -60.0, "high": 80.0},
        [(rf"limits of turn to \[{NUMBER}, {NUMBER}\]°", lambda _knobs, match: {"low": float(match[1]), "high": float(match[2])})],
    ),
    Case("E_FIT_TIGHT", fitted, {"pin": 10.0, "bore": 10.1}, [(rf"Widen the gap by {NUMBER} mm: enlarge the bore", by("bore", 2.002))]),
    Case("E_FIT_TIGHT", fitted, {"pin": 10.0, "bore": 10.1}, [(rf"Widen the gap by {NUMBER} mm: .* thin the pin", by("pin", -2.002))]),
    Case("E_FIT_LOOSE", fitted, {"pin": 10.0, "bore": 11.4}, [(rf"Narrow the gap by {NUMBER} mm: narrow the bore", by("bore", -2.002))]),
    Case("E_FIT_LOOSE", fitted, {"pin": 10.0, "bore": 11.4}, [(rf"Narrow the gap by {NUMBER} mm: .* thicken the pin", by("pin", 2.002))]),
    Case(
        "E_FIT_CONTACT", touching, {"gap": 0.5, "contact": "required"}, [(rf"Bring the two surfaces {NUMBER} mm closer", by("gap", -1.0))]
    ),
    Case("E_FIT_CONTACT", touching, {"gap": 0.0, "contact": "forbidden"}, [(r"Move the two surfaces apart", lambda _k, _m: {"gap": 0.5})]),
    Case("W_STATIC_OVERLAP", forced, {"bore": 10.0}, [(rf"Remove {NUMBER} mm from one of them where they meet", widened)]),
    Case("E_MESH_OPEN", open_or_closed, {"closed": False}, [("[Rr]epair|[Cc]lose", lambda _k, _m: {"closed": True})]),
    Case("E_NOT_CHECKED", spent, {"budget": 0.0, "lower": -0.5}, [("Raise the budget", lambda _k, _m: {"budget": None})]),
    Case("E_NOT_CHECKED", proven_closed, {"closed": False}, [("Repair the named cause", lambda _k, _m: {"closed": True})]),
    Case("W_NOT_CERTIFIED", pressed, {"pin": 5.1}, [("Add clearance to allow a proof", lambda _k, _m: {"pin": 4.9})]),
    Case(
        "W_NOT_CERTIFIED",
        sliding,
        {"far": math.inf, "bore": 10.4},
        [("Give limits to a slide that has none", lambda _k, _m: {"far": 30.0})],
    ),
    Case("W_FIT_UNRESOLVED", facing, {"deflection": 0.2}, [(rf"deflection of {NUMBER} mm", to("deflection"))]),
]


def said(findings: Findings, finding: Finding) -> bool:
    return any((each.code, each.where) == (finding.code, finding.where) for each in findings)


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case.code}-{case.made.__name__}")
def test_each_number_of_a_hint_heals_its_finding(case: Case) -> None:
    found = case.made(case.knobs).of(case.code)
    assert found, f"{case.code} is not planted: {case.made(case.knobs)}"
    for words, change in case.rules:
        match = re.search(words, found[0].hint)
        assert match, found[0].hint
        after = case.made({**case.knobs, **change(case.knobs, match)})
        assert not said(after, found[0]), f"{found[0].hint}\n{after}"
        assert not worse(case.made(case.knobs), after), f"{found[0].hint}\n{after}"


def test_a_ball_too_large_for_its_socket_is_thinned_as_the_hint_says() -> None:
    """The number of a fit's hint is that of the gap: for round surfaces, of the radius."""
    shell = merged([sphere(8.3, 128).flipped(), sphere(14, 128)])

    def gaps(radius: float) -> Findings:
        knuckle = joint("knuckle", "ball", "a", "b", cone=0.01)
        return check_fits(Scene.of({"a": shell, "b": sphere(radius, 128)}, [knuckle], fits={"knuckle": Fit(0.2, 0.4)})).findings

    (finding,) = gaps(8.2)
    match = re.search(rf"Widen the gap by {NUMBER} mm", finding.hint)
    assert match
    assert not gaps(8.2 - float(match[1]) - 1e-2)  # facets of two balls that are not in phase
