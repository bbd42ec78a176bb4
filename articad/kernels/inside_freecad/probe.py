"""Open the document of a part script, check it as a document that people edit, and change each of its dimensions.

Arguments: the numbers of open files: `job` and `document` to read, `report` and `shape` to write. No script runs here, but the document
    is untrusted, so this process is confined as well. The report has one JSON object per line.
"""

from __future__ import annotations

import json
import math
import os
import time
from pathlib import Path
from typing import Any

import FreeCAD as App

STEP, ZERO_MM, ZERO_DEG = 0.02, 0.1, 1.0  # steps by which a dimension is changed; the latter two if it is zero
SAME = 1e-9  # relative change that is rounding; a sketch that is solved anew differs by about a hundredth of that
_OPENED, _SHAPE = "/tmp/part.FCStd", "/tmp/part.brep"  # noqa: S108 - private to this process

Json = dict[str, Any]


def main(job: int, document: int, report: int, shape: int) -> None:
    """Open, judge, write the shape, probe."""
    told = json.loads(os.pread(job, os.fstat(job).st_size, 0))
    Path(_OPENED).write_bytes(os.pread(document, os.fstat(document).st_size, 0))
    opened = App.openDocument(_OPENED, True)
    bodies = [item for item in opened.Objects if item.TypeId == "PartDesign::Body"]
    if len(bodies) != 1:
        _say(report, {"ok": False, "bodies": len(bodies)})
        return
    body = bodies[0]
    body.Shape.exportBrep(_SHAPE)
    content = Path(_SHAPE).read_bytes()
    while content:
        content = content[os.write(shape, content) :]
    systems = {name: entry["object"] for name, entry in told["connectors"].items() if "object" in entry}
    try:
        judged = _judged(opened, body)
    except Exception as error:  # noqa: BLE001 - for whatever a script has left; FreeCAD raises its own types
        problem = "; ".join([str(error), *_invalid(opened)])
        _say(report, {"ok": False, "problem": problem})
        return
    _say(report, judged | {"connectors": _frames(opened, systems)})
    until = time.process_time() + told["seconds"]  # so that the result does not depend on what else the machine does
    if told["seconds"] > 0:
        for outcome in _probe(opened, body, systems, told["dimensions"], until):
            _say(report, {"probe": outcome})
        _say(report, {"probed": True})


def _judged(document: Any, body: Any) -> Json:
    """Return the composition of the tree, and the features that do not reach the solid."""
    history, current = [], body.Tip
    while current is not None and current not in history:
        history.append(current)
        current = getattr(current, "BaseFeature", None)
    solid = [item for item in body.Group if item.isDerivedFrom("PartDesign::Feature")]
    used = {item.Name for feature in history for item in feature.OutListRecursive} | {item.Name for item in history}
    engine = {item.Name: [text for _, text in item.ExpressionEngine] for item in document.Objects if item.ExpressionEngine}
    values = document.getObject("Dimensions")
    texts = [text for rows in engine.values() for text in rows]
    return {
        "ok": True,
        "tip": None if body.Tip is None else body.Tip.Name,
        "sketched": any(getattr(item, "Profile", None) for item in history),
        "frozen": [item.Name for item in history if item.isDerivedFrom("PartDesign::FeatureBase")],
        "off_tip": [item.Name for item in solid if item.Name not in used],
        "invalid": _invalid(document),
        "untied": [] if values is None else [n[2:] for n in values.PropertiesList if n.startswith("d_") and not any(n in t for t in texts)],
        "features": [item.TypeId for item in reversed(history)],
        "volume": body.Shape.Volume,
    }


def _invalid(document: Any) -> list[str]:
    """Return the objects that could not be recomputed, with FreeCAD's message about them."""
    return [f"{item.Name} ({item.getStatusString()})" for item in document.Objects if "Invalid" in item.State]


def _frames(document: Any, systems: dict[str, str]) -> Json:
    frames = {}
    for name, system in systems.items():
        item = document.getObject(system)
        if item is None:
            continue
        placement = item.Placement
        turn = placement.Rotation.multVec
        frames[name] = {"o": list(placement.Base), "z": list(turn(App.Vector(0, 0, 1))), "x": list(turn(App.Vector(1, 0, 0)))}
    return frames


def _probe(document: Any, body: Any, systems: dict[str, str], dimensions: Json, until: float) -> Any:
    """Increase each dimension and, if that changes nothing or fails, decrease it, as a person would in the document."""
    values = document.getObject("Dimensions")
    before = _fingerprint(document, body, systems)
    for name, value in dimensions.items():
        outcomes: list[Json] = []
        for moved in _moves(name, value):
            if time.process_time() > until:
                return
            setattr(values, f"d_{name}", float(moved))
            outcomes.append(_tried(document, body, systems, before))
            setattr(values, f"d_{name}", float(value))  # recomputed together with the next one: a third of the time
            if outcomes[-1]["outcome"] == "changed":
                break
        best = min(outcomes, key=lambda outcome: ("changed", "unused", "broken").index(outcome["outcome"]))
        if best["outcome"] == "broken" or name == list(dimensions)[-1]:
            document.recompute()
            if not _same(_fingerprint(document, body, systems), before):
                best = _broken("the part does not return to its shape when the dimensions are reset")
        yield {"dimension": name} | best


def _moves(name: str, value: float) -> tuple[float, ...]:
    if name.endswith("_count"):
        return (value + 1, value - 1) if value > 1 else (value + 1,)
    step = abs(value) * STEP or (ZERO_DEG if name.endswith("_deg") else ZERO_MM)
    return (value + step, value - step)


def _tried(document: Any, body: Any, systems: dict[str, str], before: list[float]) -> Json:
    document.recompute()
    invalid = [item.Name for item in document.Objects if "Invalid" in item.State]
    if invalid:
        return _broken(f"{', '.join(invalid[:5])} cannot be recomputed")
    if len(body.Shape.Solids) != 1 or not body.Shape.isValid():
        return _broken(f"the body has {len(body.Shape.Solids)} solids, not one that is valid")
    return {"outcome": "unused" if _same(_fingerprint(document, body, systems), before) else "changed"}


def _broken(message: str) -> Json:
    return {"outcome": "broken", "error": {"type": "", "message": message, "line": None}}


def _fingerprint(document: Any, body: Any, systems: dict[str, str]) -> list[float]:
    shape = body.Shape
    box = shape.BoundBox
    center = shape.CenterOfGravity if shape.Solids else App.Vector()
    frames = [number for frame in _frames(document, systems).values() for axis in ("o", "z", "x") for number in frame[axis]]
    # Radii of gyration: holes that move together, as on a bolt circle, change neither the volume nor its centre.
    inertia = shape.Solids[0].MatrixOfInertia if shape.Solids else App.Matrix()
    spread = [math.sqrt(abs(entry) / max(shape.Volume, 1e-9)) for entry in (inertia.A11, inertia.A22, inertia.A33)]
    return [shape.Volume, *center, *spread, box.XMin, box.YMin, box.ZMin, box.XMax, box.YMax, box.ZMax, *frames]


def _same(after: list[float], before: list[float]) -> bool:
    size = max(map(abs, before[1:13]))  # lengths alone: centre, radii of gyration, box
    pairs = zip(after, before, strict=False)
    return len(after) == len(before) and all(abs(a - b) <= SAME * max(abs(b), size) for a, b in pairs)


def _say(report: int, line: Json) -> None:
    os.write(report, json.dumps(line).encode() + b"\n")


main(*map(int, ARGUMENTS))  # type: ignore[name-defined]  # noqa: F821 - given by whoever starts this
