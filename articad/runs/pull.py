"""Pull: the edits of a run's FreeCAD document become a new version of the run's plan.

Changed values of the VarSets, limits and colours become a new plan. Every other edit is named, because a plan cannot represent it, or only a
part script can. `compared` then compares each shape and place of the document with the ones that the new plan gives.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.errors import ReadError
from articad.findings import Finding, Findings
from articad.importers.freecad import EditedDocument, read_document, read_freecad
from articad.importers.freecad_edits import Edit
from articad.plan.amending import amended
from articad.plan.schema import AssemblyPlan

STANDS_MM, STANDS_RAD = 1e-4, 1e-5  # tolerance for the place of a part at rest
SAME = 1e-6  # of a volume, relative; of a centre, relative to the part's diagonal

Json = dict[str, Any]


@dataclass(frozen=True)
class Pulled:
    """A plan with the edits of a document.

    Attributes:
        plan: The new plan.
        changes: New values by address in the plan.
        findings: `I_FREECAD_EDIT` for each edit that is in the plan, `W_FREECAD_EDIT` for each that is not.
    """

    plan: AssemblyPlan
    changes: Mapping[str, Any]
    findings: Findings


def pull(plan: AssemblyPlan, path: str | Path) -> Pulled:
    """Return the plan with the edits of a document that articad wrote from it.

    Args:
        plan: The plan of the run from which the document was exported.
        path: The document, `.FCStd`.

    Raises:
        ReadError: If it is not a FreeCAD file, or articad did not write it, or it belongs to another plan.
        PlanError: If the plan is not valid with the new values.
    """
    path = Path(path)
    document = read_document(path)
    if document.edits is None:
        message = f"{path} does not carry the content that articad wrote, so its edits cannot be found."
        hint = "Export the run again with this version, and edit that document; or use articad adopt for a document made by hand."
        raise ReadError(message, path=str(path), findings=[Finding(code="E_READ", where=str(path), message=message, hint=hint)])
    base = plan.to_json()
    names = {part["name"] for part in base["parts"]}
    strangers = sorted(
        {name.rpartition("_")[0] if name.rpartition("_")[2].isdigit() and name not in names else name for name in document.parts.values()}
        - names
    )
    if strangers:
        message = f"{path} has parts that are not in the plan: {', '.join(strangers[:5])}. It belongs to another run."
        raise ReadError(
            message,
            path=str(path),
            findings=[Finding(code="E_READ", where=str(path), message=message, hint="Name the run that it belongs to.")],
        )
    changes: Json = {}
    rows = [(edit, _change(edit, document, base)) for edit in document.edits if edit.kind != "moved"]  # `compared` judges where parts stand
    for _, change in rows:
        changes |= change
    found = [_finding(edit, change) for edit, change in rows]
    for part, color in document.colors.items():
        address = f"parts.{part}.color"
        if part in names:
            changes[address] = color
            found.append(
                _said("I_FREECAD_EDIT", f"parts.{part}", f"The colour of part {part!r} is now {color}; the plan has it at {address}.")
            )
        else:
            found.append(
                _said(
                    "W_FREECAD_EDIT",
                    f"parts.{part}",
                    f"The colour of part {part!r} is now {color}. The copies of a pattern share one colour.",
                )
            )
    return Pulled(AssemblyPlan.from_json(amended(base, changes)) if changes else plan, changes, Findings(found))


def compared(assembly: Assembly, path: str | Path) -> Findings:
    """Return `W_FREECAD_EDIT` for each part whose shape or place in the document differs from the plan's.

    Args:
        assembly: The assembly that the new plan builds.
        path: The document.
    """
    read = read_freecad(path)
    rest, stands = assembly.at(), read.at()
    found: list[Finding] = []
    for name, part in assembly.parts.items():
        found += _moved(name, rest[name], stands[name]) if name in stands else []
        solid, theirs = part.solid, read.parts[name].solid if name in read.parts else None
        if solid is None or theirs is None:
            continue
        diagonal = float(np.linalg.norm(solid.bbox[1] - solid.bbox[0]))
        off, far = abs(theirs.volume - solid.volume) / solid.volume, float(np.linalg.norm(theirs.com - solid.com)) / diagonal
        if max(off, far) > SAME:
            message = f"The shape of part {name!r} in the document differs from the one that the plan builds: {theirs.volume:.9g} and {solid.volume:.9g} mm³."
            hint = "Recompute the document, or make the change in the part's script. articad convert takes the document's shapes."
            found.append(
                Finding(
                    code="W_FREECAD_EDIT", where=f"parts.{name}", parts=(name,), message=message, hint=hint, value=max(off, far), limit=SAME
                )
            )
    return Findings(found)


def _moved(name: str, planned: SE3, stands: SE3) -> list[Finding]:
    """Return a finding if the place of a part in the document differs from its rest in the plan."""
    D = planned.inverse() @ stands
    far, turned = float(np.linalg.norm(D.translation)), float(np.linalg.norm(D.log()[3:]))
    if far <= STANDS_MM and turned <= STANDS_RAD:
        return []
    message = f"Part {name!r} is {far:.4g} mm and {np.degrees(turned):.3g}° away from its rest in the plan. The plan keeps its rest."
    hint = "Change the part's rest_pose or its joint's rest in the plan, if it is to rest there."
    return [
        Finding(
            code="W_FREECAD_EDIT", where=f"parts.{name}", parts=(name,), message=message, hint=hint, value=far, limit=STANDS_MM, unit="mm"
        )
    ]


def _change(edit: Edit, document: EditedDocument, plan: Json) -> Json:
    """Return the values that an edit changes in the plan, by address; none if a plan cannot represent the edit."""
    if edit.kind == "parameter" or (edit.kind == "expression" and edit.object == "Parameters"):
        return _value(edit, document, "parameters", "p_", plan)
    if edit.type == "App::VarSet" and edit.kind in ("dimension", "expression") and edit.label.endswith(" dimensions"):
        return _value(edit, document, f"parts.{edit.label.removesuffix(' dimensions')}.dimensions", "d_", plan)
    if edit.kind == "limit" or (edit.kind == "expression" and edit.type == "App::FeaturePython"):
        return dict(_limits(edit, document, plan))
    return {}


def _value(edit: Edit, document: EditedDocument, where: str, prefix: str, plan: Json) -> Json:
    """Return the new value of a parameter or dimension, if it is a plain number now."""
    held, name = document.now[edit.object], edit.key.removeprefix(prefix)
    value = held["values"].get(edit.key)
    if not edit.key.startswith(prefix) or edit.key in held["expressions"] or not isinstance(value, float):
        return {}
    if where == "parameters":
        return {f"parameters.{name}.value": value} if name in {row["name"] for row in plan.get("parameters", [])} else {}
    part = where.split(".")[1]
    known: Json = next((row.get("dimensions", {}) for row in plan["parts"] if row["name"] == part), {})
    return {f"{where}.{name}": value} if name in known else {}


def _limits(edit: Edit, document: EditedDocument, plan: Json) -> Iterator[tuple[str, Any]]:
    """Yield the new limits of a joint, if the plan states them as two bounds."""
    joint: Json = next((row for row in plan["joints"] if row["name"] == document.joints.get(edit.object)), {})
    kind = "Angle" if "Angle" in edit.key else "Length"
    key, values = {"Angle": "angle_deg", "Length": "travel_mm"}[kind], document.now[edit.object]["values"]
    bounds = joint.get(key)
    if not isinstance(bounds, list):
        return
    now: list[Any] = []
    changed = {row.key for row in document.edits or () if row.object == edit.object}
    expressions = document.now[edit.object]["expressions"]
    for end, bound in zip(("Min", "Max"), bounds, strict=True):
        if not values.get(f"Enable{kind}{end}", False) or (f"{kind}{end}" in changed and f"{kind}{end}" in expressions):
            return
        value = values.get(f"{kind}{end}")
        if value is None:  # the document lost the property
            return
        now.append(value if changed & {f"{kind}{end}", f"Enable{kind}{end}"} else bound)
    yield f"joints.{joint['name']}.{key}", now


def _finding(edit: Edit, change: Json) -> Finding:
    if change:
        return _said("I_FREECAD_EDIT", f"objects.{edit.object}", f"{edit} The plan has it at {', '.join(change)}.")
    return _said("W_FREECAD_EDIT", f"objects.{edit.object}", f"{edit} A plan cannot represent it.")


def _said(code: str, where: str, message: str) -> Finding:
    hint = (
        "Nothing needs to be done." if code.startswith("I_") else "Make the change in the plan or the part's script, or keep the document."
    )
    return Finding(code=code, where=where, message=message, hint=hint)
