"""What must come of following a hint literally, whatever it is about."""

from __future__ import annotations

import re
from collections.abc import Iterable

from articad.findings import Finding

_LINE = re.compile(r" \(line \d+\)$")


def same(a: Finding, b: Finding) -> bool:
    """True if two findings say the same of the same place; the lines of files do not count."""
    return (a.code, _LINE.sub("", a.where), a.message) == (b.code, _LINE.sub("", b.where), b.message)


def worse(before: Iterable[Finding], after: Iterable[Finding]) -> list[Finding]:
    """Return the errors that were not there before, by code and place."""
    known = {(finding.code, _LINE.sub("", finding.where)) for finding in before}
    return [one for one in after if one.severity == "error" and (one.code, _LINE.sub("", one.where)) not in known]


def assert_heals(finding: Finding, before: Iterable[Finding], after: Iterable[Finding]) -> None:
    """A hint that was followed ends or changes its finding, and brings no error."""
    left = list(after)
    assert not [one for one in left if same(one, finding)], f"not healed: {finding}"
    assert not worse(before, left), f"{finding}\nnew: {worse(before, left)}"
