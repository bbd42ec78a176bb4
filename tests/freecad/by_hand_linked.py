"""Run inside FreeCAD: an assembly of links into another file, with gears; the same with a joint that articad has not; and as a sub-assembly."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import FreeCAD as App
import JointObject


def main() -> None:
    """Write parts.FCStd; beside it assembled.FCStd and distance.FCStd, which link to it; and nested.FCStd, which links to wheels.FCStd."""
    library = App.newDocument("parts")
    for name, size in (("Frame", (100, 20, 10)), ("WheelA", (30, 30, 5)), ("WheelB", (20, 20, 5))):
        box = library.addObject("Part::Box", name)
        box.Length, box.Width, box.Height = size
    library.recompute()
    library.saveAs(str(Path("parts.FCStd").resolve()))
    for name, kind in (("assembled", "Gears"), ("distance", "Distance"), ("wheels", "")):
        document = App.newDocument(name)
        document.saveAs(str(Path(f"{name}.FCStd").resolve()))
        _assembled(document, library, kind)
        document.save()
    _nested()


def _nested() -> None:
    """Write nested.FCStd: a base that carries wheels.FCStd twice, as a flexible sub-assembly and, by its second wheel, as a rigid one."""
    document = App.newDocument("nested")
    document.saveAs(str(Path("nested.FCStd").resolve()))
    assembly = document.addObject("Assembly::AssemblyObject", "Assembly")
    assembly.Type = "Assembly"
    joints = assembly.newObject("Assembly::JointGroup", "Joints")
    base = assembly.newObject("Part::Box", "Base")
    seats = {}
    for name in ("Flexible", "Rigid"):
        inner = assembly.newObject("Assembly::AssemblyLink", name)
        inner.LinkedObject = App.getDocument("wheels").getObject("Assembly")
        inner.Rigid = name == "Rigid"
        seats[name] = inner
    document.recompute()
    (frame,) = [item for item in seats["Flexible"].Group if item.Label.startswith("Frame")]
    (wheel,) = [item for item in seats["Rigid"].Group if item.Label.startswith("WheelB")]
    grounded = joints.newObject("App::FeaturePython", "GroundedJoint")
    JointObject.GroundedJoint(grounded, base)
    for name, height, part in (("Flexible", 10, frame), ("Rigid", 40, wheel)):
        seat = App.Placement(App.Vector(0, 0, height), App.Rotation())
        _joint(assembly, joints, f"Mount{name}", "Fixed", (base, seat), (part, App.Placement()), seats[name])
    document.recompute()
    assembly.solve()
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
    if not kind:
        document.recompute()
        return
    pair = _joint(assembly, joints, "Pair", kind, (links["WheelA"], App.Placement()), (links["WheelB"], App.Placement()))
    pair.Distance = 30.0
    if kind == "Gears":
        pair.Distance2 = 20.0
    document.recompute()


def _joint(assembly: Any, group: Any, name: str, kind: str, one: tuple[Any, Any], other: tuple[Any, Any], within: Any = None) -> Any:
    joint = group.newObject("App::FeaturePython", name)
    JointObject.Joint(joint, JointObject.JointTypes.index(kind))
    joint.Offset1, joint.Offset2 = one[1], other[1]
    for number, (link, seat) in enumerate((one, other), start=1):
        inside = f"{within.Name}." if within is not None and number == 2 else ""
        path = f"{inside}{link.Name}."
        moving, rest = (within, f"{link.Name}.") if inside and within.Rigid else (link, "")
        new = tuple(map(int, App.Version()[:2])) >= (1, 1)
        setattr(joint, f"Reference{number}", [moving, [rest, rest]] if new else [assembly, [path, path]])
        setattr(joint, f"Placement{number}", seat)
    return joint


main()
