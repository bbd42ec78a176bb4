"""Names that simulators and ROS accept as they are."""

from __future__ import annotations

from collections.abc import Iterator

from articad.auditing.declared import Declared
from articad.auditing.wording import counted, listed
from articad.export.names import valid_name
from articad.findings import Finding

MOST_CHARACTERS = 64  # of a robot's name: longer ones have been whole prompts


def awkward_names(declared: Declared) -> Iterator[Finding]:
    """Names with spaces or characters that USD prims, ROS topics and ros2_control do not accept."""
    for kind, items in (("links", declared.links), ("joints", declared.joints)):
        bad = [item.name for item in items if _is_awkward(item.name)]
        if bad:
            yield Finding(
                code="W_AUDIT_NAME",
                where=kind,
                parts=tuple(bad),
                message=f"{len(bad)} of {counted(len(items), kind[:-1])} have names that ROS and USD do not accept: {listed(bad)}.",
                hint=f"Use letters, digits and underscores, such as {valid_name(bad[0])!r}; --fix does.",
                value=len(bad),
                limit=0,
            )


def unnamed(declared: Declared) -> Iterator[Finding]:
    """Links and joints without a name."""
    for kind, items in (("links", declared.links), ("joints", declared.joints)):
        bad = [item.where for item in items if not item.name.strip()]
        if bad:
            yield Finding(
                code="E_AUDIT_NO_NAME",
                where=kind,
                message=f"{counted(len(bad), kind[:-1])} without a name: {listed(bad)}.",
                hint="Give each a unique name.",
                value=len(bad),
                limit=0,
            )


def long_name(declared: Declared) -> Iterator[Finding]:
    """A robot whose name is a whole text."""
    if len(declared.name) > MOST_CHARACTERS:
        yield Finding(
            code="W_AUDIT_LONG_NAME",
            where="robot",
            message=f"The name has {len(declared.name)} characters: {declared.name[:40]!r}…",
            hint="Give it a short name; --fix shortens it.",
            value=len(declared.name),
            limit=MOST_CHARACTERS,
            unit="characters",
        )


def _is_awkward(name: str) -> bool:
    return bool(name.strip()) and (not name.isascii() or any(not (sign.isalnum() or sign in "_-./") for sign in name))


CHECKS = (awkward_names, unnamed, long_name)
