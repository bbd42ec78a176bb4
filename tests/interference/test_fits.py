"""Fits: declared against measured, at rest and over the motion."""

from __future__ import annotations

import json
import math

import pytest

import articad
from articad.certificates.fits import FitReport, check_fits
from articad.connectors import SE3
from articad.geometry import TriMesh, box, cylinder, merged, sphere
from articad.interference.scene import Scene
from articad.kinematics.joints import Joint
from tests.interference.mechanisms import Fit, at, block_with_bore, fixed, joint, without_triangle

HINGE = joint("hinge", "revolute", "block", "pin")


def fits(a: TriMesh, b: TriMesh, connection: Joint, fit: Fit, deflection: float = 0.0) -> FitReport:
    meshes = {connection.parent: a, connection.child: b}
    return check_fits(Scene.of(meshes, [connection], deflection=deflection, fits={connection.name: fit}))


def pin_in_bore(clearance: float) -> tuple[TriMesh, TriMesh]:
    """In phase, so that the flats of pin and bore are parallel: the gap is clearance times the cosine of half a segment."""
    return block_with_bore(40, 10, 5 + clearance, 64), cylinder(5, 20, 64)


@pytest.mark.parametrize(
    ("clearance", "declared", "codes"),
    [
        (0.2, (0.1, 0.4), ()),
        (0.05, (0.1, 0.4), ("E_FIT_TIGHT",)),
        (0.6, (0.1, 0.4), ("E_FIT_LOOSE",)),
        (0.6, (0.1, None), ()),
        (0.05, (None, 0.4), ()),
    ],
)
def test_a_gap_is_held_to_its_range(clearance: float, declared: tuple[float | None, float | None], codes: tuple[str, ...]) -> None:
    report = fits(*pin_in_bore(clearance), joint("hinge", "revolute", "block", "pin", lower=(-0.001,), upper=(0.001,)), Fit(*declared))
    assert report.findings.codes == codes
    assert report.rows[0].rest == pytest.approx(clearance * math.cos(math.pi / 64), abs=1e-3)


def test_the_hint_says_by_how_much_to_change_the_gap() -> None:
    (finding,) = fits(*pin_in_bore(0.05), joint("hinge", "revolute", "block", "pin", lower=(-1e-9,), upper=(1e-9,)), Fit(0.1, 0.4)).findings
    assert finding.value == pytest.approx(0.05, abs=1e-3)
    assert "by 0.05" in finding.hint
    assert (finding.route, finding.where) == ("code", "joints.hinge.fit")


def test_the_lower_bound_holds_over_the_motion_and_the_upper_at_rest() -> None:
    slide = joint("slide", "slider", "a", "b", lower=(0.0,), upper=(9.95,))
    cube = box(10, 10, 10)
    report = fits(cube, cube.transformed(at(z=-20)), slide, Fit(0.1, 12.0))
    (finding,) = report.findings
    assert finding.code == "E_FIT_TIGHT"
    assert finding.pose == {"slide": 9.95}
    assert report.rows[0].rest == pytest.approx(10)
    assert report.rows[0].least == pytest.approx(0.05)


def test_a_joint_that_follows_is_held_to_what_it_reaches_not_to_what_it_declares() -> None:
    slide = joint("slide", "slider", "a", "b", lower=(0.0,), upper=(9.95,))
    meshes = {"a": box(10, 10, 10), "b": box(10, 10, 10).transformed(at(z=-20))}
    scene = Scene.of(meshes, [slide], fits={"slide": Fit(0.1, 12.0)})

    assert check_fits(scene).findings.codes == ("E_FIT_TIGHT",)
    assert check_fits(scene, {"slide": (0.0, 6.0)}).rows[0].least == pytest.approx(4)
    assert check_fits(scene, {"slide": (0.0, 6.0)}).ok


def test_deflection_is_no_breach() -> None:
    report = fits(*pin_in_bore(0.095), HINGE, Fit(0.1, 0.4), deflection=0.0125)
    assert report.ok  # 0.095 less a sagitta, measured on meshes that may be off by 0.0125 each
    assert not fits(*pin_in_bore(0.05), HINGE, Fit(0.1, 0.4), deflection=0.0125).ok


@pytest.mark.parametrize("segments", [16, 24, 48, 96, 384])
def test_a_close_fit_on_coarse_meshes_is_measured_on_diameters_or_said_to_be_unresolved(segments: int) -> None:
    """A true gap of 0.05 mm. Facets of the bore stand into it by r (1 − cos(π/n)), those of the pin fall back by as much."""
    sagitta = 10.05 * (1 - math.cos(math.pi / segments))
    turned = cylinder(10.0, 20, segments, phase=0.4)
    hinge = joint("hinge", "revolute", "block", "pin", lower=(-1e-3,), upper=(1e-3,))
    report = fits(block_with_bore(40, 10, 10.05, segments), turned, hinge, Fit(0.04, 0.06, contact="allowed"), deflection=sagitta)
    (row,) = report.rows
    if row.play is not None:  # the pin's corners may stand in the bore's facets
        assert abs(row.play - 0.05) <= 2 * sagitta + 1e-3
    assert row.tolerance == pytest.approx(2 * sagitta)
    if row.bore is not None:
        assert row.play == pytest.approx(0.05, abs=1e-6)
    assert ("W_FIT_UNRESOLVED" in report.findings.codes) == (row.verdict == "ok" and row.bore is None and 2 * sagitta > 0.01)
    if segments == 384:
        assert row.verdict == "ok"
        assert report.findings.codes == ()


def test_only_surface_near_the_axis_counts_when_the_fit_says_so() -> None:
    block, pin = pin_in_bore(0.2)
    far_touch = merged([pin, box(5, 5, 10).transformed(at(22.5))])  # touches the block's side, 20 mm from the axis
    still = joint("hinge", "revolute", "block", "pin", lower=(-1e-6,), upper=(1e-6,))
    assert not fits(block, far_touch, still, Fit(0.1, 0.4)).ok
    assert fits(block, far_touch, still, Fit(0.1, 0.4, within=8.0)).ok


def test_near_a_ball_surface_is_counted_from_its_centre() -> None:
    shell = merged([sphere(8.3, 48).flipped(), sphere(14, 48)])
    rod = merged([sphere(8, 48), box(1, 1, 1).transformed(at(13.5))])
    knuckle = joint("knuckle", "ball", "a", "b", cone=0.01)
    assert fits(shell, rod, knuckle, Fit(0.2, 0.4, within=9.0)).ok
    assert not fits(shell, rod, knuckle, Fit(0.2, 0.4)).ok


def test_forbidden_contact_is_found_in_motion_and_at_rest() -> None:
    slide = joint("slide", "slider", "a", "b", lower=(0.0,), upper=(10.0,))
    cube = box(10, 10, 10)
    report = fits(cube, cube.transformed(at(z=-20)), slide, Fit(contact="forbidden"))
    assert report.findings.codes == ("E_FIT_CONTACT",)
    assert report.rows[0].verdict == "contact"
    assert fits(cube, cube.transformed(at(z=-20.5)), slide, Fit(contact="forbidden")).ok


def test_required_contact_must_be_there_at_rest() -> None:
    glue = fixed("glue", "a", "b")
    cube = box(10, 10, 10)
    assert fits(cube, cube.transformed(at(10)), glue, Fit(contact="required")).ok
    report = fits(cube, cube.transformed(at(10.5)), glue, Fit(contact="required"))
    assert report.findings.codes == ("E_FIT_CONTACT",)
    assert "0.5 mm closer" in report.findings[0].hint


def test_contact_that_is_allowed_is_not_tight_but_overlap_is() -> None:
    cube = box(10, 10, 10)
    slide = joint("slide", "slider", "a", "b", lower=(0.0,), upper=(1.0,))
    assert fits(cube, cube.transformed(at(10)), slide, Fit(0.1, 0.4, contact="allowed")).ok
    report = fits(cube, cube.transformed(at(9.5)), slide, Fit(0.1, 0.4, contact="allowed"))
    assert report.findings.codes == ("E_FIT_TIGHT",)
    assert report.rows[0].rest == pytest.approx(-0.5)


@pytest.mark.parametrize("mate", ["aligned", "opposed"])
def test_the_gap_is_measured_where_the_joint_puts_the_child(mate: str) -> None:
    from dataclasses import replace

    from articad.connectors import Mate

    frame = at(3, 4, 5) @ SE3.rot_x(0.4)
    slide = joint("slide", "slider", "a", "b", at_parent=frame, lower=(0.0,), upper=(1.0,))
    slide = replace(slide, mate=Mate(mate))
    up = 1 if mate == "aligned" else -1
    child = box(4, 4, 4).transformed(at(z=12 * up))
    report = fits(box(20, 20, 20).transformed(frame), child, slide, Fit(0.0, 0.1))
    assert report.rows[0].rest == pytest.approx(0.0, abs=1e-9)


def test_a_part_without_a_closed_mesh_is_not_checked() -> None:
    block, pin = pin_in_bore(0.2)
    report = fits(block, without_triangle(pin), HINGE, Fit(0.1, 0.4))
    assert report.findings.codes == ("E_NOT_CHECKED",)
    assert report.rows[0].verdict == "not_checked"
    assert not report.ok


def test_the_table_is_json() -> None:
    (row,) = json.loads(json.dumps(fits(*pin_in_bore(0.2), HINGE, Fit(0.1, 0.4, 8.0, "allowed")).to_json()))["rows"]
    assert row["declared"] == {"gap_mm": [0.1, 0.4], "within_mm": 8.0, "contact": "allowed"}
    assert row["verdict"] == "ok"


def test_the_work_of_a_certificate_includes_that_of_its_fits() -> None:
    block, pin = pin_in_bore(0.2)
    hinge = joint("hinge", "revolute", "block", "pin", lower=(-0.3,), upper=(0.3,))
    held = check_fits(Scene.of({"block": block, "pin": pin}, [hinge], fits={"hinge": Fit(0.1, 0.4)}))
    assert held.work > 0
    assert held.queries > 0
    parts = [articad.Part.from_mesh(name, mesh) for name, mesh in (("block", block), ("pin", pin))]
    both: list[dict[str, Fit]] = [{}, {"hinge": Fit(0.1, 0.4)}]
    plain, fitted = (
        articad.Assembly.from_parts("hinged", parts=parts, ground="block", joints=[hinge], fits=some).certify()  # type: ignore[arg-type]
        for some in both
    )
    assert fitted.work > plain.work
    assert fitted.queries > plain.queries
