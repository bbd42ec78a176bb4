"""The contract of a part script: compares what was promised with what was built, and reports all breaches at once."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from articad.arrays import FloatArray
from articad.connectors.connector import Connector, Drift
from articad.connectors.se3 import SE3, axis_findings
from articad.errors import ConnectorError, did_you_mean
from articad.findings import Finding, Findings
from articad.kernels.dimensions import is_out_of_time
from articad.kernels.failures import scrubbed
from articad.kernels.results import PoisonedError, number, numbers
from articad.plan.fields import lengths_in
from articad.plan.resolve import ResolvedPart
from articad.plan.signatures import functions_in
from articad.plan.standard_joints import CUT, FEATURES, feature_of

ENVELOPE_TOLERANCE = 0.02  # of each side: the contract's 2 %
EMPTY_MM3 = 1e-3  # below this a solid has no volume
LONGEST_OF_PART = 3.0  # the longest dimension over the diagonal of its part; among 172 sound products the greatest is 1.27
THICKEST = 2.0  # a thickness over the second longest side of its part
THINNEST_SHARE = 1.0 / 500.0  # the thickness of a wall over the diagonal of its part, unless it is of metal or stone
LIGHT = 2000.0  # kg/m³: wood and plastics, what is printed among them, are lighter
_THICKNESS = re.compile(r"(?:^|_)(?:thickness|thick|wall|board|sheet)$")
DRIFT_RADIAL_MM, DRIFT_RADIAL_SHARE = 0.2, 0.002  # drift below the larger of both passes; the share is of the part's diagonal
DRIFT_ALONG_MM, DRIFT_ALONG_SHARE = 0.5, 0.005
DRIFT_ANGLE = math.radians(0.25)  # 2.2 mm at a reach of 500 mm
TOLD_EXTRAS = 20  # unrequested connectors that get a finding each; a script may return any number
_NAME_CHARACTERS = 60  # of a name that a script chose
DRIFT_ERROR = 10.0  # up to this multiple of these bounds, drift is a warning

Json = Mapping[str, Any]


def solid_findings(brief: Json, shape: Json) -> Iterator[Finding]:
    """Yield what is wrong with the measured solid; `shape` is the worker's report."""
    name, solids, loose = brief["name"], int(number(shape.get("solids"))), int(number(shape.get("loose", 0)))
    if solids == 0 and loose == 0:
        yield _finding("E_EMPTY_SOLID", name, "The shape is empty.", "Check that cuts do not remove everything.")
    elif solids != 1 or loose:
        beside = f" and {loose} loose faces or edges" if loose else ""
        yield _finding(
            "E_NOT_ONE_SOLID",
            name,
            f"The shape has {solids} solids{beside}, not one solid.",
            "Fuse bodies so that they overlap by at least 0.01 mm, and return the solid alone.",
            value=solids,
            limit=1,
        )
    if solids != 1:
        return
    volume = number(shape.get("volume_mm3"))
    if volume < EMPTY_MM3:
        hint = "Check that cuts do not remove everything, and that extrusions have a positive height."
        yield _finding("E_EMPTY_SOLID", name, f"The solid's volume is {volume:.3g} mm³.", hint, value=volume, limit=EMPTY_MM3, unit="mm^3")
        return
    advice = "Avoid features that cross themselves, walls of no thickness, and faces that only touch along an edge."
    if shape.get("valid") is not True:
        yield _finding("E_INVALID_SOLID", name, "The kernel's own check finds the solid invalid.", advice)
    elif shape.get("intersects_itself") is True:
        near = shape.get("near_mm")
        where = "" if near is None else f" near {_tuple(numbers(near, 3))}"
        yield _finding("E_INVALID_SOLID", name, f"The solid's faces cut each other{where}.", advice)
    elif shape.get("closed") is not True:
        yield _finding("E_INVALID_SOLID", name, "The solid's surface cannot be meshed without gaps.", advice)
    elif shape.get("intersects_itself") is None:
        message = "Whether the solid's faces cut each other could not be determined."
        yield _finding("I_BUILD_UNCHECKED", name, message, "Simplify swept, lofted and lettered features if overlap volumes seem wrong.")
    if shape.get("valid") is True and shape.get("valid_in_step") is False:
        yield _finding(
            "W_PART_STEP",
            name,
            "The solid is valid here, but not once it is written as STEP: programs that read the file may drop or change it.",
            "Do not let a round face only touch another face: move one of them, or change its radius, by 0.1 mm or more.",
        )
    yield from _envelope_findings(name, brief.get("envelope_mm"), numbers(shape.get("bbox_mm"), 2, 3))


def _envelope_findings(name: str, envelope: Sequence[float] | None, bbox: FloatArray) -> Iterator[Finding]:
    for axis, stated, size in zip("xyz", envelope or (), bbox[1] - bbox[0], strict=False):
        if abs(size - stated) > ENVELOPE_TOLERANCE * stated:
            yield _finding(
                "E_ENVELOPE",
                name,
                f"The bounding box along {axis} is {size:.6g} mm, but the plan states {stated:.6g} mm.",
                f"Make the part {abs(size - stated):.3g} mm {'shorter' if size > stated else 'longer'} along {axis}.",
                value=float(size),
                limit=float(stated),
                unit="mm",
            )


def dimension_findings(target: ResolvedPart, bbox: FloatArray) -> Iterator[Finding]:
    """Yield what is wrong with the size of a part beside its dimensions.

    One length far longer than the part is probably in another unit (W_SCALE, a fault of the plan). If several are, then the part is:
    its script builds in another unit (W_PART_SCALE).
    """
    diagonal = float(np.linalg.norm(bbox[1] - bbox[0]))
    lengths = lengths_in(target.dimensions)
    long = {name: value for name, value in lengths.items() if abs(value) > LONGEST_OF_PART * diagonal > 0.0}
    if len(set(long.values())) > 1:
        longest = max(long, key=lambda name: abs(long[name]))
        yield _finding(
            "W_PART_SCALE",
            target.name,
            f"{target.name} is only {diagonal:.4g} mm across, but {len(long)} of its dimensions are far longer, {longest!r} "
            f"{long[longest]:.6g} mm.",
            "Build the part in millimetres, with the dimensions as they are given: was it scaled to inches or metres?",
            value=diagonal,
            limit=abs(long[longest]) / LONGEST_OF_PART,
            unit="mm",
        )
        return
    yield from _thickness_findings(target, bbox, {name: value for name, value in lengths.items() if name not in long})
    for name, value in long.items():
        yield _finding(
            "W_SCALE",
            target.name,
            f"Dimension {name!r} of {target.name} is {value:.6g} mm, but the part is only {diagonal:.4g} mm across.",
            f"Lengths are millimetres: were micrometres given? {_then(target, name, value / 1000.0)}",
            dimension=name,
            value=abs(value),
            limit=LONGEST_OF_PART * diagonal,
            unit="mm",
        )


def _thickness_findings(target: ResolvedPart, bbox: FloatArray, lengths: Mapping[str, float]) -> Iterator[Finding]:
    """Yield W_SCALE for a thickness that is the longest side of its part by far, and for a wall of wood or plastic like foil."""
    second, diagonal = float(np.sort(bbox[1] - bbox[0])[1]), float(np.linalg.norm(bbox[1] - bbox[0]))
    for name, value in lengths.items():
        if not _THICKNESS.search(name):
            continue
        if value > THICKEST * second > 0.0:
            limit, compared = THICKEST * second, f"its second longest side only {second:.4g} mm"
            hint = f"Lengths are millimetres: were micrometres given? {_then(target, name, value / 1000.0)}"
        elif 0.0 < value < THINNEST_SHARE * diagonal and target.material.density < LIGHT:
            limit, compared = THINNEST_SHARE * diagonal, f"the part is {diagonal:.4g} mm across, of {target.material.name}"
            hint = f"Make it at least {limit:.2g} mm, or of sheet metal. Were inches given? {_then(target, name, 25.4 * value)}"
        else:
            continue
        message = f"Dimension {name!r} of {target.name} is {value:.4g} mm, but {compared}."
        yield _finding("W_SCALE", target.name, message, hint, dimension=name, value=value, limit=limit, unit="mm")


def _then(target: ResolvedPart, name: str, value: float) -> str:
    """Return the advice to correct a dimension, or the parameter that it repeats."""
    written = target.spec.dimensions.get(name)
    if isinstance(written, str) and written.isidentifier():
        return f"Set parameters.{written} to {value:.6g}, which it follows."
    return f"Then it is {value:.6g}."


def lengths_of(target: ResolvedPart) -> dict[str, float]:
    """Return the lengths of a part by their addresses in the plan [mm]."""
    return {f"parts.{target.spec.name}.dimensions.{name}": value for name, value in lengths_in(target.dimensions).items()}


def read_connectors(brief: Json, entries: object, findings: list[Finding]) -> dict[str, Connector]:
    """Return the connectors that a script stated, in the plan's order, and add their faults to `findings`.

    Raises:
        PoisonedError: If the entries do not have the form that the worker gives them.
    """
    if not isinstance(entries, dict):
        raise PoisonedError("connectors are missing")
    name, planned = brief["name"], brief["connectors"]
    for missing in (key for key in planned if key not in entries):
        hint = f'Return "{missing}": {{"o": …, "z": …, "x": …}} where the feature is; the plan has it at {_tuple(planned[missing]["o"])}.'
        findings.append(_finding("E_CONNECTOR_MISSING", name, f"Connector {missing!r} is not returned.", hint, at=missing))
    extras, hint = [key for key in entries if key not in planned], f"Return only {', '.join(planned) or 'an empty dict'}."
    for extra in (scrubbed(key, _NAME_CHARACTERS) for key in extras[:TOLD_EXTRAS]):
        message = f"Connector {extra!r} is not in the plan.{did_you_mean(extra, planned)}"
        findings.append(_finding("E_CONNECTOR_EXTRA", name, message, hint))
    if len(extras) > TOLD_EXTRAS:
        findings.append(_finding("E_CONNECTOR_EXTRA", name, f"{len(extras) - TOLD_EXTRAS} more connectors are not in the plan.", hint))
    connectors: dict[str, Connector] = {}
    for key, reference in planned.items():
        if key not in entries:
            continue
        entry = entries[key]
        if not isinstance(entry, dict):
            raise PoisonedError("a connector is missing")
        o, z = numbers(entry.get("o"), 3), numbers(entry.get("z"), 3)
        x = reference["x"] if entry.get("x") is None else numbers(entry["x"], 3)
        where = f"parts.{name}.connectors.{key}"
        try:
            connectors[key] = Connector(key, SE3.from_axes(o, z, x, where=where), label=reference["label"])
        except ConnectorError:
            wrong = axis_findings(o, z, x, where=where).errors
            findings += [_finding("E_NO_BUILD", name, finding.message, finding.hint, at=key) for finding in wrong]
    return connectors


def primary_connector(target: ResolvedPart, brief: Json) -> str | None:
    """Return the connector that joins a part to its parent in the tree; None for the ground."""
    for name, connector in brief.get("connectors", {}).items():
        if any(joint["name"] == target.parent_joint for joint in connector["joints"]):
            return str(name)
    return None


def seating(target: ResolvedPart, realised: Mapping[str, Connector], primary: str | None) -> SE3:
    """Return the motion that moves the realised primary connector to its place in the plan: C*·C⁻¹.

    If nothing states the angle about its axis, the part is not turned.
    """
    if primary is None or primary not in realised or primary not in target.connectors:
        return SE3.identity()
    planned, frame = target.connectors[primary], realised[primary].frame
    if not planned.roll_free:
        return planned.frame @ frame.inverse()
    return planned.frame @ SE3.rot_z(planned.drift(frame).roll) @ frame.inverse()


def drift_findings(target: ResolvedPart, brief: Json, realised: Mapping[str, Connector], bbox: FloatArray) -> Findings:
    """Return how far connectors are from the plan after the part is seated (connector drift)."""
    diagonal = float(np.linalg.norm(bbox[1] - bbox[0]))
    primary = primary_connector(target, brief)
    T = seating(target, realised, primary)
    found: list[Finding] = []
    for name, connector in realised.items():
        if name not in target.connectors:
            continue
        planned = target.connectors[name]
        roll_matters = not planned.roll_free and not _only_ball(brief, name)
        if name == primary:
            found += _moved_finding(target.name, name, planned.drift(connector.frame), diagonal, roll_matters=roll_matters)
            continue
        drift = planned.drift(T @ connector.frame)
        worst = max(_shares(drift, diagonal, roll_matters=roll_matters))
        if worst > 1.0:
            found.append(_drift_finding(target, name, drift, error=worst > DRIFT_ERROR, bound=worst))
    return Findings(found)


def _only_ball(brief: Json, name: str) -> bool:
    joints = brief.get("connectors", {}).get(name, {}).get("joints", ())
    return bool(joints) and all(joint["type"] == "ball" for joint in joints)


def _shares(drift: Drift, diagonal: float, *, roll_matters: bool) -> tuple[float, ...]:
    """Return each component of a drift as a multiple of what passes without a finding."""
    return (
        drift.radial / max(DRIFT_RADIAL_MM, DRIFT_RADIAL_SHARE * diagonal),
        drift.along / max(DRIFT_ALONG_MM, DRIFT_ALONG_SHARE * diagonal),
        drift.axis / DRIFT_ANGLE,
        abs(drift.roll) / DRIFT_ANGLE if roll_matters else 0.0,
    )


def _components(drift: Drift) -> str:
    return (
        f"{drift.radial:.3g} mm off the axis, {drift.along:.3g} mm along it, "
        f"axis tilted {math.degrees(drift.axis):.3g}°, turned {math.degrees(drift.roll):.3g}° about it"
    )


def _drift_finding(target: ResolvedPart, name: str, drift: Drift, *, error: bool, bound: float) -> Finding:
    frame = target.connectors[name].frame
    return _finding(
        "E_CONNECTOR_DRIFT" if error else "W_CONNECTOR_DRIFT",
        target.name,
        f"Connector {name!r} is {_components(drift)}, compared with the plan.",
        f"Build the feature at o {_tuple(frame.translation)}, z {_tuple(frame.z_axis)}, x {_tuple(frame.x_axis)}.",
        at=name,
        value=bound,
        limit=DRIFT_ERROR if error else 1.0,
        unit="tolerances",
    )


def _moved_finding(part: str, name: str, drift: Drift, diagonal: float, *, roll_matters: bool) -> list[Finding]:
    """The primary connector is at its place in the plan because the part was moved; report it if it was moved far."""
    worst = max(_shares(drift, diagonal, roll_matters=roll_matters))
    if worst <= 1.0:
        return []
    message = f"Connector {name!r} was built {_components(drift)}; the whole part was moved so that it is where the plan has it."
    hint = "Build the part in the frame that the plan's connectors are given in."
    return [_finding("W_CONNECTOR_DRIFT", part, message, hint, at=name, value=worst, limit=1.0, unit="tolerances")]


def probe_findings(brief: Json, outcomes: Iterable[Json], *, ended: bool, crashed: str, script: str = "") -> Iterator[Finding]:
    """Yield the findings of the dimension probe.

    Args:
        brief: Input of the script.
        outcomes: The worker's reports, one for each dimension.
        ended: Whether the probe ended regularly, though perhaps without all dimensions.
        crashed: The signal that ended it, or empty.
        script: The part's script; it tells a dimension that it never names from one that it reads without effect.
    """
    name, reached = brief["name"], set()
    for outcome in outcomes:
        dimension, kind = str(outcome.get("dimension")), outcome.get("outcome")
        if dimension not in brief["dimensions"]:
            raise PoisonedError("the probe reports a dimension that the part does not have")
        if dimension in reached:
            raise PoisonedError("the probe reports a dimension twice")
        reached.add(dimension)
        step = "1" if dimension.endswith("_count") else "2 %"
        if kind == "unused":
            yield from _unused_findings(brief, dimension, step, script)
        elif kind == "refused":
            message = f"The script rejects dimension {dimension!r} moved by {step} either way: {_why(outcome)}."
            hint = "Let the script accept what can be built, or derive the dependent dimensions in the plan."
            yield _finding("W_DIMENSION_REFUSED", name, message, hint, dimension=dimension)
        elif kind == "broken":
            message = f"The script fails when dimension {dimension!r} is moved by {step} either way: {_why(outcome)}."
            hint = "Write the geometry so that it follows its dimensions; pick edges and faces by position relative to them."
            yield _finding("E_NOT_EDITABLE", name, message, hint, dimension=dimension)
        elif kind == "crashed":
            message = f"The kernel crashes ({scrubbed(outcome.get('signal'))}) when dimension {dimension!r} is moved by {step}."
            yield _finding("E_NOT_EDITABLE", name, message, "Write the geometry so that it follows its dimensions.", dimension=dimension)
    missed = [dimension for dimension in brief["dimensions"] if dimension not in reached]
    if crashed and not is_out_of_time(crashed, late=False) and missed:
        message = f"The kernel crashes ({crashed}) when dimension {missed[0]!r} is moved by 2 %."
        yield _finding("E_NOT_EDITABLE", name, message, "Write the geometry so that it follows its dimensions.", dimension=missed[0])
        missed = missed[1:]
    if missed and (ended or crashed):
        message = f"The probe ended before dimensions {', '.join(missed)} were moved."
        yield _finding("W_BUILD_UNCHECKED", name, message, "Simplify the script, so that it can be run once for each dimension.")


def _unused_findings(brief: Json, dimension: str, step: str, script: str) -> Iterator[Finding]:
    """Report a dimension without effect, and why: the script does not name it, or what it sizes does not show on the surface."""
    message = f"Moving dimension {dimension!r} by {step} changes neither volume, centre, bounding box nor connectors."
    found, named = feature_of(dimension, brief["dimensions"], brief["connectors"]), _named_in(script)
    if found is not None:
        connector, feature = found
        if feature == "shaft":
            return  # only the cutter of the groove has it, in the air
        joints = " and ".join(repr(joint["name"]) for joint in brief["connectors"][connector]["joints"]) or repr(connector)
        message += f" It is {FEATURES[feature]} of standard joint {joints}."
        if not named & {"made", dimension} and not functions_in(script):
            message += " The script does not make it."
            hint = "Return part.made(shape): it adds the features of the part's standard joints."
        elif feature == "depth":
            message += " The hole ends in the air."
            hint = "State a smaller depth, or none: the hole then goes through."
        elif feature in CUT:
            message += " What it cuts is only air: the part has no material there."
            hint = f"Let the body of the part reach across the place of joint {joints}, or correct that place or its axis."
        else:
            message += " It lies inside the part's own body."
            hint = f"Let it stand out of the body, correct the place of joint {joints}, or let the body end there."
    elif dimension in named:
        message += " The script names it, but what it sizes does not show: it is inside another body of the part, or cuts only air there."
        hint = "Let what it sizes reach the surface, or remove it from the plan's dimensions."
    else:
        message += " The script does not name it."
        hint = "Use it in the geometry, perhaps where a literal number stands, or remove it from the plan's dimensions."
    yield _finding("W_DIMENSION_UNUSED", brief["name"], message, hint, dimension=dimension)


def _named_in(script: str) -> set[str]:
    """Return what may name a dimension in a script: words within string literals, also in expressions, attributes, and names that are used."""
    try:
        nodes = list(ast.walk(ast.parse(script)))
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return set()
    texts = [node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)]
    texts += [node.attr for node in nodes if isinstance(node, ast.Attribute)]
    texts += [node.id for node in nodes if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)]
    return {word for text in texts for word in _WORD.findall(text)}


_WORD = re.compile(r"\w+")


def _why(outcome: Json) -> str:
    error = outcome.get("error")
    if not isinstance(error, dict):
        return "it failed"
    line = f"line {error['line']}: " if isinstance(error.get("line"), int) else ""
    kind = f"{error['type']}: " if error.get("type") else ""
    return scrubbed(f"{line}{kind}{error.get('message')}").rstrip(".")


def _finding(code: str, part: str, message: str, hint: str, *, at: str = "", dimension: str = "", **measured: Any) -> Finding:
    where = f"parts.{part}" + (f".connectors.{at}" if at else "") + (f".dimensions.{dimension}" if dimension else "")
    return Finding(code=code, where=where, parts=(part,), message=message, hint=hint, **measured)


def _tuple(vector: Iterable[float]) -> str:
    return "(" + ", ".join(f"{value:.6g}" for value in vector) + ")"
