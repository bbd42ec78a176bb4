"""Named fits are measured on the diameters of bore and pin, closer than meshes could tell."""

from __future__ import annotations

import numpy as np
import pytest

from articad.certificates.fits import check_fits
from articad.geometry import cylinder
from articad.interference.scene import Scene
from articad.plan.resolve import Fit
from articad.realisation.bores import bore_of
from tests.interference.mechanisms import at, block_with_bore, fixed, joint, random_rotation

MESHED = 0.01  # mm: the meshes stand for solids with true cylinders
LINK = joint("j", "revolute", "a", "b")


def scene(bore: float, pin: float, fit: Fit | None = None, *, aside: float = 0.0, deflection: float = MESHED) -> Scene:
    meshes = {
        "a": block_with_bore(60, 20, bore / 2, 128),
        "b": cylinder(pin / 2, 40, 128, phase=0.02).transformed(at(aside)),
    }
    return Scene.of(meshes, [LINK], deflection=deflection, fits={} if fit is None else {"j": fit})


@pytest.mark.parametrize("seed", range(5))
def test_diameters_are_found_wherever_the_joint_stands(seed: int) -> None:
    rng = np.random.default_rng(seed)
    P, C = (at(*rng.uniform(-99, 99, 3)) @ random_rotation(rng) for _ in range(2))
    pin, play = rng.uniform(2, 30), rng.uniform(0.001, 0.5)
    link = joint("j", "revolute", "a", "b", at_parent=P, at_child=C)
    meshes = {"a": block_with_bore(60, 20, pin / 2 + play, 96).transformed(P), "b": cylinder(pin / 2, 40, 96).transformed(C)}
    found = bore_of(Scene.of(meshes, [link], deflection=MESHED), link)

    assert found is not None
    assert (found.bore, found.pin) == pytest.approx((pin + 2 * play, pin), abs=1e-6)
    assert found.play == pytest.approx(play, abs=1e-6)
    assert bore_of(Scene.of(meshes, [link], deflection=0.0), link) is None  # then the facets are the surface


@pytest.mark.parametrize(
    ("bore", "pin", "codes"),
    [
        (25.010, 24.985, ()),
        (25.010, 25.004, ("E_FIT_TIGHT",)),
        (25.010, 24.960, ("E_FIT_LOOSE",)),
        (25.000, 24.993, ()),  # the tightest that H7/g6 permits
        (25.021, 24.980, ()),  # the loosest
    ],
)
@pytest.mark.parametrize("name", ["25 H7/g6", "H7/g6"])
def test_an_iso_fit_is_measured_to_micrometres(name: str, bore: float, pin: float, codes: tuple[str, ...]) -> None:
    report = check_fits(scene(bore, pin, Fit.named(name)))
    (row,) = report.rows
    assert report.findings.codes == codes
    assert row.play == pytest.approx((bore - pin) / 2, abs=1e-6)
    assert row.to_json()["bore_mm"] == pytest.approx(bore)
    assert row.to_json()["declared"]["nominal_mm"] == 25.0


def test_a_pin_that_lies_against_its_bore_has_the_same_play() -> None:
    report = check_fits(scene(25.01, 24.985, Fit.named("25 H7/g6"), aside=0.011))
    assert report.ok
    assert report.rows[0].play == pytest.approx(0.0125, abs=1e-6)


def test_what_stops_the_pin_before_its_bore_decides() -> None:
    """A second ring, narrower and not a cylinder, holds the pin: the diameters of the bore say nothing."""
    loose = scene(25.4, 25.0, Fit.named("loose"))
    ring = block_with_bore(60, 4, 12.55, 6).transformed(at(z=14))  # six sides
    meshes = {**loose.meshes, "ring": ring}
    held = Scene.of(meshes, [LINK, fixed("glue", "a", "ring")], deflection=MESHED, fits=loose.fits)
    (row,) = check_fits(held).rows
    assert row.bore is None


def test_a_fit_for_another_diameter_is_reported() -> None:
    assert check_fits(scene(10.005, 9.985, Fit.named("25 H7/g6"))).findings.codes == ("W_FIT_NOMINAL",)


def test_a_name_without_a_bore_asks_for_a_diameter() -> None:
    report = check_fits(scene(25.01, 24.985, Fit.named("H7/g6"), deflection=0.0))
    assert report.findings.codes == ("E_NOT_CHECKED",)
    assert "nominal_mm" in report.findings[0].hint


def test_a_gap_that_meshes_cannot_resolve_is_measured_on_diameters() -> None:
    assert check_fits(scene(25.01, 24.985, Fit(0.01, 0.02, contact="allowed"))).findings.codes == ()
    assert check_fits(scene(25.01, 24.985, Fit(0.015, 0.03, contact="allowed"))).findings.codes == ("E_FIT_TIGHT",)
