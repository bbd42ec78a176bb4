"""Files that are large or wrong all over: an audit of them ends soon, whatever is in them."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from articad.auditing import contact
from articad.auditing.examine import AuditOptions, audit_file
from articad.importers import reading

COUNT = 4000
LONGEST_S = 15.0  # of the processor; whatever grows with the square of COUNT takes minutes
QUIET = AuditOptions(engines=False, budget=1.0)


def joint(name: int | str, parent: int | str, child: int | str, kind: str = "revolute", more: str = "") -> str:
    return (
        f'<joint name="j{name}" type="{kind}"><parent link="l{parent}"/><child link="l{child}"/><axis xyz="0 0 1"/>'
        f'<limit lower="-1" upper="1" effort="0" velocity="1"/>{more}</joint>'
    )


def robot(joints: list[str], count: int = COUNT) -> str:
    return f'<robot name="r">{"".join(f"""<link name="l{i}"/>""" for i in range(count))}{"".join(joints)}</robot>'


ROBOTS: dict[str, tuple[Callable[[], str], str]] = {
    "a star": (lambda: robot([joint(i, 0, i) for i in range(1, COUNT)]), "W_AUDIT_NO_EFFORT"),
    "a chain, its end first": (lambda: robot([joint(i, i - 1, i) for i in range(COUNT - 1, 0, -1)]), "W_AUDIT_NO_EFFORT"),
    "a stack, its top first": (lambda: robot([joint(i, i - 1, i, "fixed") for i in range(COUNT - 1, 0, -1)]), ""),
    "no link is there": (lambda: robot([joint(i, f"x{i}", f"y{i}") for i in range(COUNT)]), "E_AUDIT_LINK_UNKNOWN"),
    "every joint twice": (lambda: robot([joint(i // 2, 0, i) for i in range(1, COUNT)]), "E_AUDIT_NAME_TWICE"),
    "every link carried twice": (lambda: robot([joint(i, 0, i // 2) for i in range(2, COUNT)]), "E_AUDIT_TWO_PARENTS"),
    "all mimic nobody": (
        lambda: robot([joint(i, 0, i, more=f'<mimic joint="nobody{i}"/>') for i in range(1, COUNT)]),
        "E_AUDIT_MIMIC",
    ),
    "nothing is connected": (lambda: robot([]), "E_AUDIT_ROOTS"),
}


@pytest.mark.parametrize("name", ROBOTS)
def test_an_audit_of_thousands_of_links_ends_soon(name: str, tmp_path: Path) -> None:
    make, code = ROBOTS[name]
    (tmp_path / "a.urdf").write_text(make())
    before = time.process_time()

    found = audit_file(tmp_path / "a.urdf", QUIET)

    assert time.process_time() - before < LONGEST_S
    assert found.links == COUNT
    assert not code or code in found.findings.codes


def piled(count: int) -> str:
    shape = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
    return re.sub(r'(<link name="l\d+")/>', rf"\1>{shape}</link>", robot([joint(i, 0, i) for i in range(1, count)], count))


def test_pairs_at_rest_that_there_is_no_time_for_are_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contact, "REST_S", 0.0)
    (tmp_path / "a.urdf").write_text(piled(30))

    left = audit_file(tmp_path / "a.urdf", QUIET).findings.of("W_AUDIT_NOT_CHECKED")
    assert [finding.value for finding in left if "Overlap at rest" in finding.message] == [30 * 29 / 2]


def test_of_too_many_shapes_no_pair_is_looked_at(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contact, "MOST_BODIES", 20)
    (tmp_path / "a.urdf").write_text(piled(30))

    found = audit_file(tmp_path / "a.urdf", QUIET)
    assert "E_OVERLAP" not in found.findings.codes
    assert found.findings.of("W_AUDIT_NOT_CHECKED")[0].limit == 20
    assert found.motion == "none"


def test_more_links_than_are_read_are_one_finding(tmp_path: Path) -> None:
    (tmp_path / "a.urdf").write_text(robot([], reading.MAX_LINKS + 1))

    (finding,) = audit_file(tmp_path / "a.urdf", QUIET).findings
    assert finding.code == "E_READ"
    assert "the maximum is" in finding.message
