"""Distilling: makes a case from a plan, its scripts and the measurements of the checks."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from articad.connectors import SE3
from articad.kinematics.joints import Joint
from articad.memory.case import Case, PartExample
from articad.plan.entry import specification
from articad.plan.resolve import ResolvedPlan


def case_of(
    resolved: ResolvedPlan,
    scripts: Mapping[str, bytes],
    *,
    kernel: str,
    prompt: str,
    requirements: str = "",
    defects: Sequence[str] = (),
    repairs: Sequence[str] = (),
    scores: Mapping[str, float] | None = None,
    lessons: Sequence[str] = (),
    version: str = "",
) -> Case:
    """Return the case of a finished assembly: an issue if it has a defect, else a good one.

    Args:
        resolved: The plan with its numbers.
        scripts: Source of each part that has one.
        kernel: The kernel, which determines their dialect.
        prompt: The request.
        requirements: The analysis of the request.
        defects: Errors that were found at the end.
        repairs: Faults that were corrected on the way.
        scores: Numbers of the review.
        lessons: The review's advice to the next designer.
        version: Version of articad.
    """
    parts = [PartExample(name, specification(resolved, name), kernel, scripts[name].decode(errors="replace")) for name in sorted(scripts)]
    return Case(
        kind="issue" if defects else "good",
        prompt=prompt,
        requirements=requirements,
        design=design_in_words(resolved),
        parts=tuple(parts),
        repairs=tuple(repairs),
        defects=tuple(defects),
        scores=dict(scores or {}),
        lessons=tuple(lessons),
        articad=version,
    )


def design_in_words(resolved: ResolvedPlan) -> str:
    """Return a plan's parts, joints and couplings, one per line, as an example for designers."""
    lines = [f"Ground: {resolved.ground}. Parameters: {', '.join(f'{name} = {value:.6g}' for name, value in resolved.parameters.items())}."]
    for name, part in resolved.parts.items():
        source = f", {part.derivation.op} of {part.derivation.source}" if part.derivation else ""
        lines.append(f"Part {name} ({part.material.name}{source}): {part.description or part.role}")
    lines += [_joint_in_words(joint) for joint in resolved.joints]
    lines += [f"Coupling {coupling.name}: {coupling.b} = {coupling.ratio:.6g} {coupling.a}" for coupling in resolved.couplings]
    return "\n".join(lines)


def _joint_in_words(joint: Joint) -> str:
    at = _point(joint.T_parent_connector)
    ends = f"{joint.parent}.{joint.parent_connector} {at} to {joint.child}.{joint.child_connector} {_point(joint.T_child_connector)}"
    ranges = [
        f"{name} from {low:.4g} to {high:.4g} {unit}"
        for name, low, high, unit in zip(joint.column_names, joint.limits.lower, joint.limits.upper, joint.type.units, strict=False)
    ]
    return f"Joint {joint.name} ({joint.type.value}): {ends}{'; ' if ranges else ''}{', '.join(ranges)}"


def _point(frame: SE3) -> str:
    return f"({', '.join(f'{value:.4g}' for value in frame.translation)})"
