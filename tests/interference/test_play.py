"""Play and fits of random joints against closed formulas and manifold3d: pins, balls and carriages, wherever they lie."""

from __future__ import annotations

import json
import math

import manifold3d as m3
import numpy as np
import pytest

import articad
from articad.certificates.fits import FitReport, check_fits
from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder, merged, sphere
from articad.interference.gauge import Gauge
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint
from articad.plan.resolve import Fit
from tests.interference.mechanisms import at, block_with_bore, fixed, joint, manifold_mesh, random_rotation, verified

SEEDS = range(8)
EXACT = 3e-3  # mm: two stops, each found to 1e-3


def anywhere(rng: np.random.Generator) -> SE3:
    return at(*rng.uniform(-50, 50, 3)) @ random_rotation(rng)


def mirrored(mesh: TriMesh) -> TriMesh:
    return TriMesh(mesh.vertices * [-1.0, 1.0, 1.0], mesh.triangles[:, ::-1].copy())


def play_of(rng: np.random.Generator, kind: str, parent: TriMesh, child: TriMesh, **limits: tuple[float, ...]) -> float | None:
    """Return the play where both connectors stand anywhere in their parts; sometimes of mirror images."""
    if rng.random() < 0.5:
        parent, child = mirrored(parent), mirrored(child)
    P, C = anywhere(rng), anywhere(rng)
    link = joint("j", kind, "a", "b", at_parent=P, at_child=C, **limits)  # type: ignore[arg-type]
    scene = Scene.of({"a": parent.transformed(P), "b": child.transformed(C)}, [link])
    return Gauge(scene, link, Fit(gap_max=1.0)).play()


def sagitta(radius: float, segments: int) -> float:
    return radius * (1 - math.cos(math.pi / segments))


@pytest.mark.parametrize("kind", ["revolute", "cylindrical", "screw"])
@pytest.mark.parametrize("seed", SEEDS)
def test_the_play_of_a_pin_is_half_the_difference_of_diameters_wherever_it_lies(kind: str, seed: int) -> None:
    rng = np.random.default_rng([seed, len(kind)])
    radius, clearance, segments = rng.uniform(2, 8), rng.uniform(0.05, 2.0), int(rng.integers(48, 160))
    off, angle = rng.uniform(0, 0.98) * clearance, rng.uniform(-math.pi, math.pi)
    bore = block_with_bore(40, 10, radius + clearance, segments, phase=rng.uniform(0, 1))
    pin = cylinder(radius, 20, segments).transformed(at(off * math.cos(angle), off * math.sin(angle), rng.uniform(-4, 4)))
    found = play_of(rng, kind, bore, pin)

    assert found is not None
    assert clearance - sagitta(radius + clearance, segments) - EXACT <= found <= clearance + sagitta(radius, segments) + EXACT


@pytest.mark.parametrize("seed", SEEDS)
def test_the_play_of_a_ball_is_the_difference_of_radii(seed: int) -> None:
    rng = np.random.default_rng([seed, 7])
    radius, clearance = rng.uniform(3, 8), rng.uniform(0.1, 1.0)
    way = rng.normal(size=3)
    off = way / np.linalg.norm(way) * rng.uniform(0, 0.9) * clearance
    socket = merged([sphere(radius + clearance, 48).flipped(), sphere(radius + 5, 48)])
    found = play_of(rng, "ball", socket, sphere(radius, 48).transformed(at(*off)))

    assert found is not None
    assert abs(found - clearance) <= 2 * sagitta(radius + clearance, 24) + EXACT


@pytest.mark.parametrize("seed", SEEDS)
def test_the_play_of_a_carriage_is_that_of_its_wider_side(seed: int) -> None:
    rng = np.random.default_rng([seed, 9])
    (w, h), (cx, cy) = rng.uniform(5, 15, 2), rng.uniform(0.05, 1.5, 2)
    guide = m3.Manifold.cube([w + 20, h + 20, 60], center=True) - m3.Manifold.cube([w + 2 * cx, h + 2 * cy, 80], center=True)
    carriage = box(w, h, 20).transformed(at(rng.uniform(-1, 1) * cx, rng.uniform(-1, 1) * cy))

    assert play_of(rng, "slider", manifold_mesh(guide), carriage) == pytest.approx(max(cx, cy), abs=EXACT)


def test_an_open_guide_has_the_play_between_its_sides() -> None:
    channel = m3.Manifold.cube([30, 20, 60], center=True) - m3.Manifold.cube([10.6, 20, 80], center=True).translate([0, 5, 0])
    carriage = box(10, 10, 20).transformed(at(0.2))
    assert play_of(np.random.default_rng(1), "slider", manifold_mesh(channel), carriage) == pytest.approx(0.3, abs=EXACT)


def test_where_nothing_stops_the_child_there_is_no_play_and_the_smallest_gap_counts() -> None:
    link = joint("j", "revolute", "a", "b")
    scene = Scene.of({"a": box(10, 10, 10), "b": box(10, 10, 10).transformed(at(z=10.3))}, [link], fits={"j": Fit(gap_max=0.4)})
    assert check_fits(scene).rows[0].play is None
    assert check_fits(scene).ok
    scene = Scene.of({"a": box(10, 10, 10), "b": box(10, 10, 10).transformed(at(z=10.5))}, [link], fits={"j": Fit(gap_max=0.4)})
    assert check_fits(scene).findings.codes == ("E_FIT_LOOSE",)


def test_a_collar_that_touches_the_block_does_not_hide_a_wide_hole() -> None:
    pin = merged([cylinder(5, 20, 96), cylinder(9, 2, 96).transformed(at(z=6))])  # the collar stands on the block
    solid = manifold_mesh(m3.Manifold.cylinder(20, 5, 5, 96, center=True) + m3.Manifold.cylinder(2, 9, 9, 96).translate([0, 0, 5]))
    assert pin.bounds[1][2] == pytest.approx(solid.bounds[1][2])
    play = play_of(np.random.default_rng(3), "revolute", block_with_bore(40, 10, 6, 96), solid)
    assert play == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("seed", range(10))
def test_edges_in_the_seat_of_a_part_stop_nothing(seed: int) -> None:
    """A strap on a post sits on a bracket, or between two cheeks; a pocket's rim is nearer to its side than the post to its bore."""
    rng = np.random.default_rng([seed, 11])
    radius, clearance, high = rng.uniform(2, 4), rng.uniform(0.3, 1.0), rng.uniform(3, 8)
    wider = rng.uniform(0.0, 0.8) if seed % 3 else 0.0  # a bore that is long across the strap
    beyond, cube = rng.uniform(0.2, 0.8) * clearance, m3.Manifold.cube
    bracket = cube([60, 60, 10], center=True).translate([0, 0, -5])
    if seed % 2:
        bracket += cube([60, 60, 10], center=True).translate([0, 0, high + 5])
    bracket -= cube([30, 10, 3], center=True).translate([0, 1 + beyond, 0])  # its rim lies `beyond` from the strap's side
    bracket += m3.Manifold.cylinder(40, radius, radius, 96, center=True)
    bore = m3.Manifold.cylinder(40, radius + clearance, radius + clearance, 96, center=True)
    long = m3.Manifold.batch_hull([bore.translate([0, side * wider, 0]) for side in (-1, 1)])
    strap = cube([44, 12, high], center=True).translate([0, 0, high / 2]) - long
    found = play_of(rng, "revolute", manifold_mesh(bracket), manifold_mesh(strap))

    assert found is not None
    assert clearance + wider - sagitta(radius + 1, 96) - EXACT <= found <= clearance + wider + sagitta(radius, 96) + EXACT


def test_what_is_fixed_to_a_part_holds_with_it() -> None:
    """A pin that is pressed into one leaf of a hinge holds the other leaf, which that leaf alone does not."""
    hinge = joint("hinge", "revolute", "leaf", "other")
    meshes = {
        "leaf": block_with_bore(40, 10, 5, 64).transformed(at(z=10.1)),
        "other": block_with_bore(40, 10, 5.2, 64),
        "pin": cylinder(5, 40, 64).transformed(at(1, 2, 3)),
    }
    press = fixed("press", "leaf", "pin")
    press = Joint(**{**press.__dict__, "T_child_connector": at(1, 2, 3)})
    alone, held = (Scene.of(meshes, joints, fits={"hinge": Fit(gap_max=0.3)}) for joints in ([hinge], [hinge, press]))
    assert check_fits(alone).rows[0].play is None
    assert check_fits(held).rows[0].play == pytest.approx(0.2, abs=0.01)


# ------------------------------------------------------------------ over the motion


def bumpy(rng: np.random.Generator, where: float, height: float, gap: float) -> tuple[TriMesh, TriMesh]:
    """A block with a bore and a pin of radius 5, each with a bump of 0.02 rad; they face each other when the pin has turned by `where`."""
    phi = np.arange(1024) * 2 * math.pi / 1024
    start = rng.uniform(-math.pi, math.pi)

    def bump(angle: float) -> np.ndarray:
        return height * np.exp(-((((phi - angle + math.pi) % (2 * math.pi) - math.pi) / 0.02) ** 2))

    def prism(radii: np.ndarray, length: float) -> m3.Manifold:
        outline = m3.CrossSection([np.c_[radii * np.cos(phi), radii * np.sin(phi)]])
        return m3.Manifold.extrude(outline, length).translate([0, 0, -length / 2])

    pin = prism(5 + bump(start), 30)
    block = m3.Manifold.cube([30, 30, 20], center=True) - prism(5 + gap - bump(start + where), 24)
    return manifold_mesh(block), manifold_mesh(pin)


def built(block: TriMesh, pin: TriMesh, fit: Fit, lower: float, upper: float) -> articad.Assembly:
    frame = articad.Connector("axis", SE3.identity())
    parts = [articad.Part.from_mesh(name, mesh, connectors={"axis": frame}) for name, mesh in (("block", block), ("pin", pin))]
    hinge = articad.revolute("hinge", parts[0]["axis"], parts[1]["axis"], limits=(lower, upper))
    return articad.Assembly.from_parts("bumps", parts=parts, ground="block", joints=[hinge], fits={"hinge": fit})


@pytest.mark.parametrize("seed", range(4))
def test_a_bump_between_two_samples_is_found_by_all_three(seed: int) -> None:
    rng = np.random.default_rng([seed, 11])
    where = rng.uniform(0.3, 2.8) * rng.choice([-1, 1])
    block, pin = bumpy(rng, where, 0.035, 0.05)
    still, turned = (m3.Manifold(m3.Mesh64(np.array(mesh.vertices), np.array(mesh.triangles, dtype=np.uint64))) for mesh in (block, pin))
    assert (still ^ turned.rotate([0, 0, math.degrees(where)])).volume() > 0.01

    assembly = built(block, pin, Fit(gap_min=0.01, gap_max=0.06), -math.pi, math.pi)
    for report in (assembly.check(), assembly.check_motion(), assembly.certify()):
        assert not report.ok
        assert "E_FIT_TIGHT" in report.findings.codes
        (row,) = report.fits
        assert row.at["hinge"] == pytest.approx(where, abs=0.06)  # type: ignore[attr-defined]


@pytest.mark.parametrize("seed", range(2))
def test_a_bump_beyond_the_limits_breaks_nothing_and_the_fit_is_proven(seed: int) -> None:
    rng = np.random.default_rng([seed, 12])
    where = rng.uniform(2.0, 2.8)
    assembly = built(*bumpy(rng, where, 0.02, 0.05), Fit(gap_min=0.01, gap_max=0.06), -math.pi / 2, where - 0.2)
    for report in (assembly.check(), assembly.check_motion()):
        assert report.ok
        assert report.fits[0].strength.kind == "certified"  # type: ignore[attr-defined]
    certificate = assembly.certify()
    assert certificate.ok
    document = json.loads(json.dumps(certificate.to_json()))
    assert document["fits"][0]["verdict"] == "ok"
    assert any(claim["clear_mm"] >= 0.01 for claim in document["claims"])
    assert verified(document, certificate) == []


@pytest.mark.parametrize(
    ("hole", "off", "fit", "code"),
    [
        (6.0, 0.0, Fit(gap_min=0.04, gap_max=0.06), "E_FIT_LOOSE"),
        (4.95, 0.0, Fit(gap_min=0.04, contact="forbidden"), "E_FIT_CONTACT"),
        (6.0, 0.97, Fit(gap_min=0.0, gap_max=0.06), "E_FIT_LOOSE"),
        (5.05, 0.045, Fit(gap_min=0.04, gap_max=0.06), "E_FIT_TIGHT"),
        (5.02, 0.0, Fit(gap_min=0.04, gap_max=0.06, contact="allowed"), "E_FIT_TIGHT"),
        (5.05, 0.045, Fit(gap_min=0.04, gap_max=0.06, contact="allowed"), None),
        (5.05, 0.0, Fit(gap_min=0.04, gap_max=0.06, contact="forbidden"), None),
    ],
)
def test_a_fit_counts_in_check_sweep_and_certify(hole: float, off: float, fit: Fit, code: str | None) -> None:
    block, pin = block_with_bore(40, 20, hole, 256), cylinder(5, 30, 256).transformed(at(off))
    assembly = built(block, pin, fit, -math.pi, math.pi)
    assert assembly.check().ok is (code is None)
    assert assembly.check_motion().ok is (code is None)
    if code is not None:
        assert code in assembly.check().findings.codes
        assert not assembly.certify().ok


def test_a_fit_that_only_samples_speak_for_is_not_certified() -> None:
    link = joint("j", "slider", "a", "b", lower=(-math.inf,), upper=(math.inf,))
    guide = manifold_mesh(m3.Manifold.cube([20, 20, 900], center=True) - m3.Manifold.cube([10.4, 10.4, 999], center=True))
    scene = Scene.of({"a": guide, "b": box(10, 10, 20)}, [link], fits={"j": Fit(0.1, 0.4)})
    report: FitReport = check_fits(scene)
    assert report.ok
    assert report.rows[0].strength.kind == "sampled"
    from articad.certificates.fits import certified_fits

    assert certified_fits(report).findings.codes == ("W_NOT_CERTIFIED",)


@pytest.mark.parametrize("limits", [(-math.inf, math.inf), (-1.0, math.inf), (-math.inf, 2.0)])
@pytest.mark.parametrize("lead", [-10.0, 3.0, 25.0])
def test_a_screw_without_limits_is_followed_beyond_one_turn(lead: float, limits: tuple[float, float]) -> None:
    """A collar stands further away than one turn carries it, on the side that the screw is free to go to."""
    up = 1.0 if (lead > 0) == math.isinf(limits[0]) else -1.0
    start = up * (abs(lead) + 12.0)
    block = block_with_bore(40, 10, 6.0, 64)
    spindle = m3.Manifold.cylinder(400, 5, 5, 64, center=True)
    link = joint("j", "screw", "a", "b", lead=lead, lower=limits[:1], upper=limits[1:])

    collar = m3.Manifold.cylinder(12, 9, 9, 64, center=True).translate([0, 0, start])
    scene = Scene.of({"a": block, "b": manifold_mesh(spindle + collar)}, [link], fits={"j": Fit(0.5)})
    assert check_fits(scene).findings.codes == ("E_FIT_TIGHT",)

    scene = Scene.of({"a": block, "b": manifold_mesh(spindle)}, [link], fits={"j": Fit(0.5)})
    (row,) = check_fits(scene).rows
    assert (row.verdict, row.strength.kind) == ("ok", "sampled")
