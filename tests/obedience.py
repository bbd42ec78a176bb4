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
    """Return the errors that were not there before: no error of that code was about the place, or about the same parts."""
    known = [(one.code, _LINE.sub("", one.where), one.parts) for one in before]
    return [
        one
        for one in after
        if one.severity == "error"
        and not any(
            one.code == code and (_LINE.sub("", one.where) == where or (parts and set(one.parts) == set(parts)))
            for code, where, parts in known
        )
    ]


def assert_heals(finding: Finding, before: Iterable[Finding], after: Iterable[Finding]) -> None:
    """A hint that was followed ends or changes its finding, and brings no error."""
    left = list(after)
    assert not [one for one in left if same(one, finding)], f"not healed: {finding}"
    assert not worse(before, left), f"{finding}\nnew: {worse(before, left)}"
