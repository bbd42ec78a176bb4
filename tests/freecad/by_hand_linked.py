"""Run inside FreeCAD: an assembly of links into another file, with gears; and the same with a joint that articad has not."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD as App
import JointObject


def main() -> None:
    """Write parts.FCStd, and beside it assembled.FCStd and distance.FCStd, which link to it."""
    library = App.newDocument("parts")
    for name, size in (("Frame", (100, 20, 10)), ("WheelA", (30, 30, 5)), ("WheelB", (20, 20, 5))):
        box = library.addObject("Part::Box", name)
        box.Length, box.Width, box.Height = size
    library.recompute()
    library.saveAs(str(Path("parts.FCStd").resolve()))
    for name in ("assembled", "distance"):
        document = App.newDocument(name)
        document.saveAs(str(Path(f"{name}.FCStd").resolve()))
        _assembled(document, library, "Gears" if name == "assembled" else "Distance")
        document.save()


def _assembled(document: Any, library: Any, kind: str) -> None:
    assembly = document.addObject("Assembly::AssemblyObject", "Assembly")
    assembly.Type = "Assembly"
    joints = assembly.newObject("Assembly::JointGroup", "Joints")
    links = {}
    for name in ("Frame", "WheelA", "WheelB"):
        links[name] = assembly.newObject("App::Link", name)
        links[name].LinkedObject = library.getObject(name)
    links["WheelA"].Placement.Base, links["WheelB"].Placement.Base = App.Vector(10, 0, 10), App.Vector(60, 0, 10)
    document.recompute()
    grounded = joints.newObject("App::FeaturePython", "GroundedJoint")
    JointObject.GroundedJoint(grounded, links["Frame"])
    for wheel in ("WheelA", "WheelB"):
        seat = App.Placement(links[wheel].Placement.Base, App.Rotation())
        _joint(assembly, joints, f"Axis{wheel}", "Revolute", (links["Frame"], seat), (links[wheel], App.Placement()))
    pair = _joint(assembly, joints, "Pair", kind, (links["WheelA"], App.Placement()), (links["WheelB"], App.Placement()))
    pair.Distance = 30.0
    if kind == "Gears":
        pair.Distance2 = 20.0
    document.recompute()


def _joint(assembly: Any, group: Any, name: str, kind: str, one: tuple[Any, Any], other: tuple[Any, Any]) -> Any:
    joint = group.newObject("App::FeaturePython", name)
    JointObject.Joint(joint, JointObject.JointTypes.index(kind))
    joint.Offset1, joint.Offset2 = one[1], other[1]
    for number, (link, seat) in enumerate((one, other), start=1):
        path = f"{link.Name}."
        new = tuple(map(int, App.Version()[:2])) >= (1, 1)
        setattr(joint, f"Reference{number}", [link, ["", ""]] if new else [assembly, [path, path]])
        setattr(joint, f"Placement{number}", seat)
    return joint


main()
