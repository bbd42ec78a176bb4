"""An excavator with three cylinders and a four-bar: certified for every two drivers together, or the two that collide are named."""

from __future__ import annotations

import json
import math
from itertools import combinations

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.certificates.certificate import Certificate
from tests.interference.excavator import CROWD, DRIVERS, ELBOW, LIFT, SHOULDER, excavator
from tests.interference.mechanisms import verified

SHORT, LONG = 90.0, 120.0  # mm: buckets


@pytest.fixture(scope="module")
def short() -> tuple[Assembly, Certificate]:
    assembly = excavator(SHORT)
    return assembly, assembly.certify(budget=60)


def test_a_short_bucket_is_certified_for_every_two_drivers_together(short: tuple[Assembly, Certificate]) -> None:
    assembly, certificate = short
    assert len(assembly.parts) == 13
    assert assembly.mechanism.mobility == len(DRIVERS)
    assert certificate.ok, str(certificate.findings)
    assert verified(json.loads(json.dumps(certificate.to_json())), certificate) == []
    moved = {frozenset(pair.over) for pair in certificate.pairs}
    for two in combinations(DRIVERS, 2):
        assert any(set(two) <= over for over in moved), two
    assert not assembly.check(motion=True).findings.of("E_MOTION_COLLISION")


def test_a_long_bucket_meets_the_boom_and_the_two_cylinders_that_bring_it_there_are_named() -> None:
    assembly = excavator(LONG)
    assert not assembly.check_motion().findings.errors  # no driver alone brings them together
    certificate = assembly.certify(budget=60)
    assert not certificate.ok
    (collision,) = certificate.findings.of("E_MOTION_COLLISION")
    assert set(collision.parts) == {"boom", "bucket"}
    assert collision.pose is not None
    assert set(collision.pose) == {"crowd", "curl"}
    assert verified(json.loads(json.dumps(certificate.to_json())), certificate) == []  # what is claimed nevertheless holds
    (seen,) = {frozenset(finding.parts) for finding in assembly.check(motion=True).findings.of("E_MOTION_COLLISION")}
    assert seen == {"boom", "bucket"}


def test_clearances_and_tables_stand_beside_the_verdict(short: tuple[Assembly, Certificate]) -> None:
    _, certificate = short
    rows = {frozenset(row.parts): row for row in certificate.clearances}
    assert certificate.clearances[0].gap == min(row.gap for row in certificate.clearances)
    nearest = rows[frozenset({"boom", "bucket"})]
    assert nearest.gap > 0
    assert {"crowd", "curl"} <= set(nearest.pose)
    report = json.loads(json.dumps(certificate.to_json()))
    assert report["clearances"][0]["strength"]["kind"] == "sampled"
    assert {table["driver"] for table in report["follows"]} == {"lift", "crowd", "curl"}


@pytest.mark.parametrize(("driver", "hinge", "at", "ends"), [("lift", "shoulder", SHOULDER, LIFT), ("crowd", "elbow", ELBOW, CROWD)])
def test_a_hinge_follows_its_cylinder_as_the_law_of_cosines_says(
    driver: str, hinge: str, at: tuple[float, float], ends: tuple[tuple[float, float], tuple[float, float]]
) -> None:
    (table,) = (one for one in excavator(SHORT).follows() if one.driver == driver)
    a, b, rest = (float(np.hypot(*np.subtract(*two))) for two in ((ends[0], at), (ends[1], at), ends))
    lengths = rest + np.array(table.values)
    angles = np.arccos((a**2 + b**2 - lengths**2) / (2 * a * b))
    at_rest = math.acos((a**2 + b**2 - rest**2) / (2 * a * b))
    turned = np.array(table.followers[hinge])
    assert np.abs(np.abs(turned) - np.abs(angles - at_rest)).max() < 1e-9
    assert table.units == {**dict.fromkeys(table.followers, "rad"), driver: "mm"}
