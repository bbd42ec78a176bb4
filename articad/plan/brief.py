"""Briefs: the input of a part's script, and the digests that show when the script or its geometry is out of date.

The brief digest covers what the part is, without numbers and without its place; while it stays the same, the script is kept. The build
digest covers the numbers, the script and the kernel; while it stays the same, the geometry is kept. Moving or repainting a part changes
neither.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Mapping
from typing import Any

from articad.aliases import Json
from articad.connectors import Connector, world_x
from articad.kinematics.joints import Joint, JointType
from articad.plan.motions import AXES
from articad.plan.resolve import Fit, ResolvedPart, ResolvedPlan

_DIGITS = 12  # decimals of mm: rounding of frames and of degrees must not show in a script or a digest


def brief(resolved: ResolvedPlan, part: str) -> Json:
    """Return the input of a part's script: the JSON `part` of a job.

    Args:
        resolved: The plan with its numbers.
        part: Name of the part.

    Returns:
        `name`, `description`, `material`, `dimensions`, `envelope_mm`, and `connectors`: by name `o`, `z`, `x` in the part's
        frame, `label` and the `joints` at it. If the plan leaves x to a rule, x is the world axis least parallel to z in the part's own
        frame; only origin and z of such a connector are compared with what is built.

    Raises:
        KeyError: If there is no such part.
    """
    target = resolved.parts[part]
    return {
        "name": target.name,
        "description": target.description,
        "material": target.material.name,
        "dimensions": {name: _plain(value) for name, value in target.dimensions.items()},
        "envelope_mm": None if target.envelope is None else [_plain(side) for side in target.envelope],
        "connectors": {
            name: {**_axes(connector), "label": connector.label, "joints": _joints(resolved, part, name)}
            for name, connector in target.connectors.items()
        },
    }


def brief_digest(resolved: ResolvedPlan, part: str) -> str:
    """Return the sha256 of what the part is, without numbers, rest pose and colour."""
    target = resolved.parts[part]
    return _digest(
        {
            "name": target.name,
            "material": target.material.name,
            "role": target.role,
            "description": target.description,
            "orientation": target.orientation,
            "dimensions": sorted(target.dimensions),
            "envelope": target.envelope is not None,
            "kernel": _kernel(resolved, target),
            "connectors": {
                name: {
                    "kind": connector.kind,
                    "label": connector.label,
                    "x": not connector.roll_free,
                    "joints": [
                        {key: joint[key] for key in ("type", "side", "mate")} | {"contact": (joint["fit"] or {}).get("contact")}
                        for joint in _joints(resolved, part, name)
                    ],
                }
                for name, connector in target.connectors.items()
            },
        }
    )


def build_digest(resolved: ResolvedPlan, part: str, script: bytes, kernel: str, version: str, deflection: float) -> str:
    """Return the sha256 of everything that a part's geometry depends on.

    Args:
        resolved: The plan with its numbers.
        part: Name of the part.
        script: Its source.
        kernel: Name of the kernel.
        version: Its version.
        deflection: Largest distance of the mesh from the solid [mm].
    """
    return _digest(
        {
            "brief": brief(resolved, part),
            "script": hashlib.sha256(script).hexdigest(),
            "kernel": kernel,
            "version": version,
            "deflection": float(deflection),
        }
    )


def _kernel(resolved: ResolvedPlan, part: ResolvedPart) -> str:
    return part.kernel or resolved.plan.kernel


def _axes(connector: Connector) -> Json:
    frame = connector.frame
    z = frame.z_axis
    x = world_x(z) if connector.roll_free else frame.x_axis
    return {key: [_plain(float(c)) for c in vector] for key, vector in (("o", frame.translation), ("z", z), ("x", x))}


def _joints(resolved: ResolvedPlan, part: str, connector: str) -> list[Json]:
    """Return the joints at a connector as a script sees them, in the order in which they are declared."""
    found = []
    for joint, side in resolved.joints_at.get((part, connector), ()):
        parent, child = f"{joint.parent}.{joint.parent_connector}", f"{joint.child}.{joint.child_connector}"
        fit = resolved.fits.get(joint.name)
        found.append(
            {
                "name": joint.name,
                "type": str(joint.type),
                "side": side,
                "mate": str(joint.mate),
                "limits": _limits(joint),
                "fit": None if fit is None else _fit(fit),
                "other": child if side == "parent" else parent,
            }
        )
    return found


def _fit(fit: Fit) -> Json:
    gap = None if fit.gap_min is None or fit.gap_max is None else [_plain(fit.gap_min), _plain(fit.gap_max)]
    named = {} if fit.name is None else {"name": fit.name, "nominal_mm": fit.nominal}
    return {"gap_mm": gap, "within_mm": fit.within, "contact": fit.contact, **named}


def _limits(joint: Joint) -> Json:
    """Return a joint's limits by the plan's names and in its units."""
    if joint.type is JointType.BALL:
        cone, twist = joint.limits.cone, joint.limits.twist
        return {
            "cone_deg": None if cone is None else _plain(math.degrees(cone)),
            "twist_deg": None if twist is None else [_plain(math.degrees(bound)) for bound in twist],
        }
    limits: Json = {}
    for axis, low, high in zip(AXES[joint.type], joint.limits.lower, joint.limits.upper, strict=True):
        if math.isinf(low) and math.isinf(high):
            limits[axis.range] = "endless"
        else:
            scale = math.degrees(1.0) if axis.unit == "deg" else 1.0
            limits[axis.range] = [_plain(low * scale), _plain(high * scale)]
    return limits


def _plain(value: float) -> float | int:
    """Return a number rounded to remove the noise of its last bits; whole dimensions become integers."""
    return value if isinstance(value, int) else round(value, _DIGITS) + 0.0


def _digest(value: Mapping[str, Any]) -> str:
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()
