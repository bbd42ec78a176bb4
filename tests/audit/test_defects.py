"""Every defect is found with its number and its cause; the sound twin gives nothing."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from articad.auditing.examine import AuditOptions, audit_file
from articad.findings import Findings
from tests.audit import defects
from tests.audit.defects import DEFECTS, Defect

QUICK = AuditOptions(engines=False, budget=5.0)


def findings(root: Any, folder: Path) -> Findings:
    return audit_file(defects.write(root, folder), QUICK).findings


def test_there_are_enough_defects() -> None:
    assert len(DEFECTS) >= 25
    assert len({defect.code for defect in DEFECTS}) >= 25


@pytest.mark.parametrize(
    "base", [defects.stand, defects.three_turns, defects.glb_in_metres, defects.with_post, defects.two_arms, defects.held_together]
)
def test_the_sound_twin_gives_nothing(base: Any, tmp_path: Path) -> None:
    assert not findings(base(tmp_path), tmp_path)


@pytest.mark.parametrize("defect", DEFECTS, ids=lambda defect: defect.name)
def test_a_defect_is_found_with_its_number_and_cause(defect: Defect, tmp_path: Path) -> None:
    root = (defect.base or defects.stand)(tmp_path)
    defect.spoil(root, tmp_path)

    found = findings(root, tmp_path)

    assert defect.code in found.codes
    assert set(found.codes) <= {defect.code} | defect.also
    named = found.of(defect.code)[0]
    assert named.hint
    if defect.value is not None:
        assert named.value == pytest.approx(defect.value, rel=defect.relative, abs=1e-9)
    if defect.cause is not None:
        assert named.cause == defect.cause
