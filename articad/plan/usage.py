"""How a plan uses its connectors and derivations: findings for what is legal but hardly intended."""

from __future__ import annotations

import math
import re
from collections import Counter, defaultdict
from collections.abc import Collection, Sequence

import numpy as np

from articad.connectors import SE3
from articad.findings import Finding
from articad.kinematics.joints import Joint, JointLimits, JointType
from articad.plan.derive import JointLine
from articad.plan.draft import Draft
from articad.plan.fields import lengths_in
from articad.plan.motions import AXES
from articad.plan.rest import OFFSET_MM
from articad.plan.schema import TURNING_KINDS, DerivedJoint

SMALLEST_MM = 0.5  # a smaller assembly is in metres or inches
LARGEST_MM = 1e6  # a kilometre
THINNEST_MM = 0.05  # a smaller dimension of a part is in metres or inches, unless it is a clearance
LEAST_CLEARANCE_MM, NOISE_MM = 1e-3, 1e-9  # below the second, a number is a rounded zero
LONGEST_SHARE = 50.0  # the longest dimension of a plan over the next shorter one; among 181 sound plans the greatest is 13
_FLAT = 0.4  # an extent of connectors over the longest one: a shorter one may be the thickness of their part
LIGHTEST, HEAVIEST = 10.0, 23000.0  # kg/m³: foam and osmium
_SUITABLE = {  # a type that is not listed accepts any kind: a pin, a hub or a bracket is fixed on an axis as well as on a face
    JointType.REVOLUTE: TURNING_KINDS,
    JointType.SLIDER: ("slide_axis", "shaft_axis", "bore_axis"),
    JointType.CYLINDRICAL: ("shaft_axis", "bore_axis", "slide_axis"),
    JointType.SCREW: ("thread_axis", "shaft_axis", "bore_axis"),
    JointType.BALL: ("ball_centre",),
}
_AXLE_KIND = "shaft_axis"  # an axle carries several parts on one axis
_CHIRAL = re.compile(
    r"\b(threads?|threaded|helix|helical|worm|spiral|bevel|lettering|inscription|logo|(?:left|right)-hand(?:ed)?)\b", re.IGNORECASE
)
_SIDE = re.compile(r"(?:\b|_)(left|right)(?:\b|_)", re.IGNORECASE)
CLEARANCE = re.compile(r"clearance|play|gap|slack|tolerance|allowance")
"""What a dimension that states a clearance has in its name."""
SIZE = re.compile(r"(?:^|_)(?:radius|diameter|length|width|height|depth|thickness|thick|wide|bore|hole|wall|size|pitch)$")
"""How the names of dimensions end that are sizes, not places."""
_SAME = 1e-9  # rad or mm: limits computed to be the same are the same

Ends = dict[tuple[str, str], list[str]]


def usage_findings(draft: Draft) -> list[Finding]:
    """Return warnings about connectors, mirrored parts and the size of the assembly."""
    ends = _joints_at(draft)
    return [
        *_environment(draft),
        *_unused(draft, ends),
        *_shared(draft, ends),
        *_kinds(draft),
        *_placed_by_joint(draft),
        *_chiral(draft),
        *_sided(draft),
        *_mirrored_limits(draft),
        *_densities(draft),
        *_dimensions(draft),
        *scale_findings(draft),
    ]


def _joints_at(draft: Draft) -> Ends:
    """Return the names of the joints at each (part, connector), from names alone."""
    ends: Ends = defaultdict(list)
    for form in draft.plan.joints:
        for reference in (form.parent, form.child):
            part, connector = reference.split(".")
            ends[part, connector].append(form.name)
    return ends


def _environment(draft: Draft) -> list[Finding]:
    """Find parts of the environment that are more than bodies fixed to a part of the product: exports leave them out."""
    outside = {name for name, part in draft.parts.items() if part.spec is not None and part.spec.environment}
    found = []
    for name in (name for name in draft.parts if name in outside):
        holding = [line for line in draft.lines if any(part == name for part, _ in line.ends)]
        fault = _fault_outside(name, holding, draft, outside)
        if fault:
            hint = f"Make {name} the child of one fixed joint to a part of the product, or remove 'environment'."
            found.append(Finding(code="E_ENVIRONMENT", where=f"parts.{name}.environment", message=fault, hint=hint, parts=(name,)))
    return found


def _fault_outside(name: str, holding: Sequence[JointLine], draft: Draft, outside: Collection[str]) -> str:
    """Return why a part cannot be part of the environment; empty if it can."""
    if draft.plan.ground == name:
        return f"{name} is part of the environment, which is not exported, but it is the ground."
    for line in holding:
        (parent, _), (child, _) = line.ends
        if child != name:
            return f"{name} is part of the environment, which is not exported, but it carries {child} by joint {line.name!r}."
        if parent in outside:
            return f"{name} is part of the environment, but so is {parent}, which holds it: neither is exported."
        if line.root.type != "fixed":
            return f"{name} is part of the environment, but joint {line.name!r}, which holds it, is not fixed."
    return f"{name} is part of the environment, but {len(holding)} joints hold it." if len(holding) > 1 else ""


def _unused(draft: Draft, ends: Ends) -> list[Finding]:
    used = {(part.spec.name, connector) for (name, connector) in ends if (part := draft.parts.get(name)) and part.spec}
    found = []
    for part in draft.parts.values():
        if part.derived or len(draft.parts) == 1:
            continue
        for spec in part.connector_specs:
            if (part.name, spec.name) not in used:
                message = f"No joint uses connector {spec.name!r} of {part.name}."
                where = f"{part.where}.connectors.{spec.name}"
                found.append(
                    Finding(
                        code="W_CONNECTOR_UNUSED", where=where, message=message, hint="Use it in a joint, or remove it.", parts=(part.name,)
                    )
                )
    return found


def _shared(draft: Draft, ends: Ends) -> list[Finding]:
    found = []
    for (name, connector), joints in ends.items():
        part = draft.parts.get(name)
        spec = next((spec for spec in part.connector_specs if spec.name == connector), None) if part else None
        if spec is None or len(joints) == 1 or spec.kind == _AXLE_KIND:
            continue
        message = f"Joints {' and '.join(joints)} share connector {name}.{connector}."
        on_axle = all(_AXLE_KIND in _SUITABLE.get(type_, (_AXLE_KIND,)) for type_ in _types(draft, joints))
        hint = "Declare a connector for each joint."
        if on_axle:
            hint = f"Set its kind to '{_AXLE_KIND}' if these parts are on one axle; otherwise declare a connector for each joint."
        where = f"parts.{name}.connectors.{connector}"
        found.append(
            Finding(code="W_DUP_CONNECTOR_USE", where=where, message=message, hint=hint, parts=(name,), value=len(joints), limit=1)
        )
    return found


def _types(draft: Draft, joints: Sequence[str]) -> set[JointType]:
    """Return the types of the named joints, as far as they are known."""
    return {JointType(line.root.type) for line in draft.lines if line.name in joints}


def _kinds(draft: Draft) -> list[Finding]:
    found = []
    for line in draft.lines:
        suitable = _SUITABLE.get(JointType(line.root.type))
        if suitable is None:
            continue
        for name, connector in line.ends:
            part = draft.parts.get(name)
            if part is None or part.derived:
                continue
            spec = next((spec for spec in part.connector_specs if spec.name == connector), None)
            if spec is not None and spec.kind != "frame" and spec.kind not in suitable:
                message = f"Connector {name}.{connector} is a {spec.kind}, but joint {line.name!r} is {_an(line.root.type)}."
                hint = f"Use kind {', '.join(map(repr, suitable))} or 'frame'."
                where = f"parts.{name}.connectors.{connector}.kind"
                found.append(Finding(code="W_CONNECTOR_KIND", where=where, message=message, hint=hint, parts=(name,)))
    return found


def _an(noun: str) -> str:
    return f"{'an' if noun[0] in 'aeio' else 'a'} {noun} joint"


def _placed_by_joint(draft: Draft) -> list[Finding]:
    """Return one note for all parts that joints place."""
    joints, parts = list(draft.auto_joints), tuple(draft.auto_joints.values())
    if not joints:
        return []
    where = f"joints.{joints[0]}"
    message = f"{parts[0]} is placed by joint {joints[0]!r}, so that joint's rest check always passes."
    hint = f"Give {parts[0]} a rest_pose with numbers if the check is wanted."
    if len(joints) > 1:
        where = "joints"
        placed = ", ".join(f"{part} ({joint})" for joint, part in draft.auto_joints.items())
        message = f"{len(parts)} parts are placed by their joints, so the rest checks of these joints always pass: {placed}."
        hint = "Give a part a rest_pose with numbers if the check is wanted."
    return [Finding(code="I_REST_AUTO", where=where, message=message, hint=hint, parts=parts)]


def _chiral(draft: Draft) -> list[Finding]:
    found = []
    for part in draft.parts.values():
        if part.op != "mirror" or part.spec is None:
            continue
        texts = [part.spec.description, part.spec.role, *(spec.label for spec in part.connector_specs)]
        words = [match.group(0) for text in texts if (match := _CHIRAL.search(text))]
        words += [spec.kind for spec in part.connector_specs if spec.kind == "thread_axis"]
        if words:
            message = f"{part.name} mirrors {part.source}, which seems to have a handedness ({', '.join(dict.fromkeys(words))})."
            hint = (
                "Make it a part of its own, or derive it with op 'rigid' and place it and its joints anew, unless the other hand is meant."
            )
            found.append(Finding(code="W_CHIRAL", where=f"{part.where}.derive", message=message, hint=hint, parts=(part.name,)))
    for line in draft.lines:
        if isinstance(line.form, DerivedJoint) and line.form.derive.op == "mirror" and line.root.type == "screw":
            known = draft.motions.get(line.name)
            lead = f": its lead is {known.lead:.6g} mm" if known else ""
            message = f"Joint {line.name!r} mirrors a screw, so its thread has the other hand{lead}."
            hint = "Declare the joint in full with the hand that the part has, unless the other hand is meant."
            found.append(Finding(code="W_CHIRAL", where=f"joints.{line.name}.derive", message=message, hint=hint))
    return found


def _sided(draft: Draft) -> list[Finding]:
    found = []
    for part in draft.parts.values():
        if part.op != "mirror":
            continue
        sided = [spec.name for spec in part.connector_specs if _SIDE.search(spec.name) or _SIDE.search(spec.label)]
        if sided:
            message = f"{part.name} mirrors {part.source} and keeps connectors that say left or right: {', '.join(sided)}."
            hint = f"Name or label the connectors of {part.source} without a side, or accept that they mean those of the source."
            found.append(Finding(code="I_MIRROR_SIDE", where=f"{part.where}.derive", message=message, hint=hint, parts=(part.name,)))
    return found


def _mirrored_limits(draft: Draft) -> list[Finding]:
    """Find joints of mirrored parts that repeat the limits of the source's joint although they are not derived from it."""
    stated = {line.name for line in draft.lines if not isinstance(line.form, DerivedJoint)}
    by_child = {(joint.child, joint.child_connector): joint for joint in draft.joints}
    found = []
    for joint in draft.joints:
        part = draft.parts[joint.child]
        if joint.name not in stated or part.op != "mirror" or part.source is None:
            continue
        original = by_child.get((part.source, joint.child_connector))
        if original is None or original.type is not joint.type or not _equal(original.limits, joint.limits):
            continue
        symmetric = draft.motions[original.name].mirrored().limits
        if _equal(symmetric, joint.limits):
            continue
        message = f"{part.name} mirrors {part.source}, but the limits of {joint.name!r} equal those of {original.name!r}."
        needed = _limits_text(joint, symmetric)
        hint = f'A symmetric motion needs {needed}; or derive the joint: {{"from": "{original.name}", "op": "mirror"}}.'
        found.append(
            Finding(code="W_MIRROR_LIMITS", where=f"joints.{joint.name}", message=message, hint=hint, parts=(part.name, part.source))
        )
    return found


def _equal(a: JointLimits, b: JointLimits) -> bool:
    rows = [*a.lower, *a.upper, *(a.twist or ())], [*b.lower, *b.upper, *(b.twist or ())]
    return len(rows[0]) == len(rows[1]) and np.allclose(*rows, rtol=0.0, atol=_SAME)


def _limits_text(joint: Joint, limits: JointLimits) -> str:
    rows = [
        (axis.range, low, high, axis.unit == "deg")
        for axis, low, high in zip(AXES[joint.type], limits.lower, limits.upper, strict=True)
        if math.isfinite(low) and math.isfinite(high)
    ]
    if limits.twist is not None:
        rows.append(("twist_deg", *limits.twist, True))
    texts = []
    for name, low, high, turns in rows:
        scale = math.degrees(1.0) if turns else 1.0
        texts.append(f"{name} [{low * scale + 0.0:.6g}, {high * scale + 0.0:.6g}]")
    return ", ".join(texts)


def _densities(draft: Draft) -> list[Finding]:
    """Find densities that no material has: they are probably in g/cm³."""
    found = []
    for name, (_, density, _) in draft.materials.items():
        if 0.0 < density < LIGHTEST or density > HEAVIEST:
            meant = density * 1000.0 if density < LIGHTEST else density / 1000.0
            found.append(
                Finding(
                    code="W_DENSITY",
                    where=f"materials.{name}.density_kg_m3",
                    message=f"{name} has a density of {density:.6g} kg/m³; real materials have {LIGHTEST:g} to {HEAVIEST:g} kg/m³.",
                    hint=f"If another unit was meant, set density_kg_m3 to {meant:.6g}; steel is 7850, oak 700.",
                    value=density,
                    limit=LIGHTEST if density < LIGHTEST else HEAVIEST,
                    unit="kg/m^3",
                )
            )
    return found


def _dimensions(draft: Draft) -> list[Finding]:
    """Find sizes with the wrong sign, and lengths that are probably in another unit: too thin to be made, or far longer than all others."""
    lengths = [
        (abs(value), part, name)
        for part, dimensions in draft.dimensions.items()
        for name, value in lengths_in(dimensions).items()
        if math.isfinite(value)
    ]
    found = [
        _negative(part, name, value)
        for part, dimensions in draft.dimensions.items()
        for name, value in dimensions.items()
        if SIZE.search(name) and value < -NOISE_MM
    ]
    for length, part, name in lengths:
        least = LEAST_CLEARANCE_MM if CLEARANCE.search(name) or "offset" in name else THINNEST_MM
        if NOISE_MM < length < least:
            message = f"Dimension {name!r} of {part} is {length:.6g} mm."
            hint = (
                f"Lengths are millimetres: were metres given? Then it is {length * 1000.0:.6g}; {_as_elsewhere(draft, part, name, least)}"
                f"or make it at least {least:g} mm."
            )
            found.append(_dimension_finding(part, name, message, hint, value=length, limit=least))
    longest = max((length for length, _, _ in lengths), default=0.0)
    next_longest = max((length for length, _, _ in lengths if length * LONGEST_SHARE < longest), default=0.0)
    alone = [one for one in lengths if one[0] * LONGEST_SHARE >= longest]
    if next_longest > 0.0 and len({length for length, _, _ in alone}) == 1:
        for _, part, name in alone:
            message = f"Dimension {name!r} of {part} is {longest:.6g} mm; all others of the plan are at most {next_longest:.6g} mm."
            hint = f"Lengths are millimetres: were micrometres given? Then it is {longest / 1000.0:.6g}."
            found.append(_dimension_finding(part, name, message, hint, value=longest, limit=LONGEST_SHARE * next_longest))
    return found


def _as_elsewhere(draft: Draft, part: str, name: str, least: float) -> str:
    """Return the advice to give a dimension the value of one of this name elsewhere, or the shortest extent of its part's connectors."""
    joined = {end for joint in draft.joints for end in (joint.parent, joint.child) if part in (joint.parent, joint.child)}
    others = {one: abs(held[name]) for one, held in draft.dimensions.items() if one != part and abs(held.get(name, 0.0)) >= least}
    counts = Counter(others.values())
    if others:
        nearest = min(others, key=lambda one: (one not in joined, -counts[others[one]]))
        return f"or make it {others[nearest]:.6g}, as {name!r} of {nearest} is; "
    held = draft.parts.get(part)
    places = np.array([connector.frame.translation for connector in held.connectors.values()] if held else []).reshape(-1, 3)
    extents = [float(np.ptp([0.0, *column])) for column in places.T]
    reach = min((extent for extent in extents if least <= extent < _FLAT * max(extents)), default=0.0)
    axis = "xyz"[extents.index(reach)] if reach else ""
    return f"or make it {reach:.6g}, as far as the connectors of {part} reach along {axis}; " if reach else ""


def _negative(part: str, name: str, value: float) -> Finding:
    return Finding(
        code="W_DIMENSION_SIGN",
        where=f"parts.{part}.dimensions.{name}",
        message=f"Dimension {name!r} of {part} is {value:.6g} mm, but a size is positive.",
        hint=f"Make it {-value:.6g}; or name a place as one, such as {name}_z.",
        parts=(part,),
        value=float(value),
        limit=0.0,
        unit="mm",
    )


def _dimension_finding(part: str, name: str, message: str, hint: str, *, value: float, limit: float) -> Finding:
    where = f"parts.{part}.dimensions.{name}"
    return Finding(code="W_SCALE", where=where, message=message, hint=hint, parts=(part,), value=value, limit=limit, unit="mm")


def scale_findings(draft: Draft) -> list[Finding]:
    """Return E_SCALE if the assembly's diagonal is outside the plausible range."""
    at = [(part.T, connector.frame) for part in draft.parts.values() if part.T is not None for connector in part.connectors.values()]
    origins = SE3.stack([T for T, _ in at]).apply(np.array([frame.translation for _, frame in at])) if at else np.zeros((1, 3))
    diagonals = [math.hypot(*sides) for sides in draft.envelopes.values() if not any(map(math.isnan, sides))]
    size = max([float(np.linalg.norm(np.ptp(origins, axis=0))), *diagonals])
    if size <= OFFSET_MM or SMALLEST_MM <= size <= LARGEST_MM:  # all connectors in one point say nothing about the size
        return []
    small = size < SMALLEST_MM
    hint = "Lengths are millimetres: were metres given?" if small else "Lengths are millimetres: were micrometres given?"
    message = f"The assembly is {size:.6g} mm across."
    limit = SMALLEST_MM if small else LARGEST_MM
    return [Finding(code="E_SCALE", where="plan", message=message, hint=hint, value=size, limit=limit, unit="mm")]
