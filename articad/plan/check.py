"""Checking: everything that is wrong with a plan, all at once, before any geometry exists.

`check_plan` returns findings; `admitted` is the gate before any part script runs: it accepts plans without errors.
"""

from __future__ import annotations

import math

import numpy as np

from articad.errors import ArticadError, PlanError
from articad.findings import Finding, Findings
from articad.kinematics.graph import JointGraph
from articad.kinematics.mechanism import Mechanism
from articad.plan.draft import Draft
from articad.plan.resolve import ResolvedPlan, resolved_from
from articad.plan.rest import rest_findings
from articad.plan.schema import AssemblyPlan
from articad.plan.usage import scale_findings, usage_findings

_MOVING_KINDS = ("hinge_axis", "slide_axis", "thread_axis", "gear_axis", "ball_centre", "shaft_axis", "bore_axis")  # of connectors
_SHOWN_AT_BOUND = 3  # findings reported in full for one bound of one parameter


def check_plan(plan: AssemblyPlan, /, **parameters: float) -> Findings:
    """Return everything that is wrong with a plan; it never raises.

    It checks numbers, names, axes and limits, the joint graph, the rest pose of every joint and the declared freedoms, and all of it
    again with each parameter at its min and max.

    Args:
        plan: The plan.
        **parameters: Values that replace those of parameters: mm, degrees.
    """
    draft = Draft(plan, parameters)
    found, _ = _judged(draft)
    return Findings([*found, *_range_findings(draft, found)])


def admitted(plan: AssemblyPlan, /, **parameters: float) -> tuple[ResolvedPlan, Findings]:
    """Return the plan with its numbers, and its warnings and notes; a plan with an error is refused.

    Args:
        plan: The plan.
        **parameters: Values that replace those of parameters: mm, degrees.

    Raises:
        PlanError: With every finding, if one of them is an error.
    """
    found, resolved = _judged(Draft(plan, parameters))
    findings = Findings(found)
    if resolved is None or not findings.ok:
        raise PlanError("\n".join(map(str, findings.errors)), findings=findings)
    return resolved, findings


def _judged(draft: Draft) -> tuple[list[Finding], ResolvedPlan | None]:
    """Return all findings at the draft's own parameter values, and its numbers if these have no errors."""
    stated = draft.findings()
    resolved = resolved_from(draft, stated) if stated.ok else None
    found = [*stated, *rest_findings(draft), *usage_findings(draft)]
    found += _structure_findings(draft, resolved if Findings(found).ok else None)
    return found, resolved


# ---------------------------------------------------------------- mechanism


def _structure_findings(draft: Draft, resolved: ResolvedPlan | None) -> list[Finding]:
    """Check loops, freedoms and drivers; loops and couplings only if the parts meet at rest (`resolved`)."""
    if not draft.graph_findings.ok:
        return []
    tree, loop_joints = draft.graph.spanning_tree()
    found = []
    if draft.plan.tree:
        for joint in loop_joints:
            loop = tree.path(joint.parent, joint.child)
            message = f"The plan asserts a tree, but joint {joint.name!r} closes the loop {'-'.join(loop)}."
            hint = "Remove one joint of the loop, or drop 'tree': true."
            found.append(Finding(code="E_NOT_TREE", where=f"joints.{joint.name}", message=message, hint=hint, parts=loop))
    if len(draft.lines) < len(draft.plan.joints):
        return found  # a joint without a type has unknown freedoms
    if not loop_joints and not draft.plan.couplings:
        freedoms = [(joint.name, joint.type.freedoms) for joint in draft.graph.joints]
        account = ", ".join(f"{name} {count}" for name, count in freedoms if count) or "no joint moves"
        found += _freedom_findings(draft, sum(count for _, count in freedoms), account)
        found += _idle_marks(draft.graph)
        return found
    return found if resolved is None else found + _mechanism_findings(draft, resolved)


def _mechanism_findings(draft: Draft, resolved: ResolvedPlan) -> list[Finding]:
    """Return the mechanism's findings about loops, couplings and drivers, and whether its mobility is the declared one."""
    try:
        mechanism = resolved.mechanism
        found = list(mechanism.findings())
        if not any(finding.code == "E_LOOP_OPEN" for finding in found):
            found += _freedom_findings(draft, mechanism.mobility, _account(mechanism))
            found += mechanism.motion_findings()
    except (ArticadError, np.linalg.LinAlgError) as error:
        return list(getattr(error, "findings", ())) or [_not_supported(str(error))]
    return found


def _not_supported(reason: str) -> Finding:
    """Return the finding for a plan that is valid but that this version cannot solve."""
    hint = "Simplify the loops and couplings, or report this plan."
    return Finding(code="E_NOT_SUPPORTED", where="plan", message=f"The mechanism cannot be solved: {reason}", hint=hint)


def _account(mechanism: Mechanism) -> str:
    """Say where freedoms come from and which constraints remove them."""
    total = sum(joint.type.freedoms for joint in mechanism.joints)
    account = [f"sum of joint freedoms {total}"]
    if mechanism.loop_joints:
        loops = ", ".join("-".join(mechanism.tree.path(joint.parent, joint.child)) for joint in mechanism.loop_joints)
        rank = total - mechanism.mobility - len(mechanism.couplings)
        account.append(f"loop constraints of rank {rank}: loop{'s' * (len(mechanism.loop_joints) > 1)} {loops}")
    if mechanism.couplings:
        account.append(f"couplings {len(mechanism.couplings)}")
    return ", ".join(account)


def _freedom_findings(draft: Draft, freedoms: int, account: str) -> list[Finding]:
    declared = draft.plan.freedoms
    if declared == freedoms:
        return []
    message = f"Declared freedoms {declared}, but the assembly has {freedoms} ({account})."
    hint = f"Set freedoms to {freedoms}, or change the joints if {declared} is meant."
    held = _fixed_at_axes(draft) if declared > freedoms else []
    if held:
        hint += f" These joints are fixed although their connectors suggest a motion: {', '.join(name for name, _ in held)}."
    parts = tuple(dict.fromkeys(part for _, ends in held for part in ends))
    return [Finding(code="E_DOF_MISMATCH", where="freedoms", message=message, hint=hint, parts=parts, value=declared, limit=freedoms)]


def _fixed_at_axes(draft: Draft) -> list[tuple[str, tuple[str, str]]]:
    """Return the fixed joints, with their two parts, both of whose connectors have a kind that is for a motion."""
    kinds = {(name, spec.name): spec.kind for name, part in draft.parts.items() for spec in part.connector_specs}
    return [
        (line.name, (line.ends[0][0], line.ends[1][0]))
        for line in draft.lines
        if line.root.type == "fixed" and all(kinds.get(end) in _MOVING_KINDS for end in line.ends)
    ]


def _idle_marks(graph: JointGraph) -> list[Finding]:
    return [
        Finding(
            code="W_DRIVER",
            where=f"joints.{joint.name}.driver",
            message=f"Joint {joint.name!r} is marked as a driver, but without loops and couplings every joint is a driver.",
            hint="Remove the driver mark.",
        )
        for joint in graph.joints
        if joint.driver
    ]


# ---------------------------------------------------------------- parameters at their bounds


def _range_findings(draft: Draft, found: list[Finding]) -> list[Finding]:
    """Check the plan with every parameter at its min and at its max; return the findings that it does not have otherwise."""
    known = {(finding.code, finding.where) for finding in found}
    reported = []
    for parameter in draft.plan.parameters:
        value = draft.evaluation.values[parameter.name]
        for name, bound in zip(("min", "max"), draft.evaluation.bounds(parameter), strict=True):
            if not math.isfinite(bound) or not math.isfinite(value) or bound == value:
                continue
            tried = Draft(draft.plan, {**draft.overrides, parameter.name: bound})
            broken = Findings([*tried.findings(), *rest_findings(tried), *scale_findings(tried)]).errors
            fresh = [finding for finding in broken if (finding.code, finding.where) not in known]
            for finding in fresh[:_SHOWN_AT_BOUND]:
                more = f" (and {len(fresh) - _SHOWN_AT_BOUND} more)" if len(fresh) > _SHOWN_AT_BOUND and finding is fresh[0] else ""
                reported.append(
                    Finding(
                        code="W_PARAMETER_RANGE",
                        where=f"parameters.{parameter.name}.{name}",
                        message=f"At {parameter.name} = {bound:.6g}, its {name}, the plan breaks{more}: {finding.code} {finding.where}: {finding.message}",
                        hint=f"Narrow the {name} of {parameter.name}, or replace numbers by expressions that follow it. At this value alone: {finding.hint}",
                        parts=finding.parts,
                        value=bound,
                        limit=value,
                        unit=None if parameter.unit == "1" else parameter.unit,
                    )
                )
    return reported
