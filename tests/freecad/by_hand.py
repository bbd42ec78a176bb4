"""Run inside FreeCAD: an assembly as a person makes it, with solids and bodies, faces and edges picked, and joints between them."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import FreeCAD as App
import JointObject
import Part
import Sketcher
import UtilsAssembly


def main() -> None:
    """Make a bracket that carries a lever that carries a weight; leave the file and what FreeCAD thinks of it."""
    document = App.newDocument("Press")
    assembly = document.addObject("Assembly::AssemblyObject", "Assembly")
    assembly.Type = "Assembly"
    joints = assembly.newObject("Assembly::JointGroup", "Joints")
    bracket, lever, weight = _bracket(document, assembly), _lever(assembly), _weight(document, assembly)
    document.recompute()

    grounded = joints.newObject("App::FeaturePython", "GroundedJoint")
    JointObject.GroundedJoint(grounded, bracket)
    mouth = _element(document.Drilled.Shape.Edges, "Edge", _circle(5.0, 20.0))
    root = _element(document.PinPad.Shape.Edges, "Edge", _circle(4.8, 0.0))
    top = _element(document.PinPad.Shape.Faces, "Face", lambda face: isinstance(face.Surface, Part.Plane) and face.CenterOfMass.z > 5.9)
    foot = _element(document.WeightSource.Shape.Faces, "Face", lambda face: face.CenterOfMass.z < 0.1)
    limits = {"EnableAngleMin": True, "AngleMin": -30.0, "EnableAngleMax": True, "AngleMax": 75.0}
    _joint(assembly, joints, "Lever_Hinge", "Revolute", (f"Bracket.Drilled.{mouth}", f"Lever.PinPad.{root}"), limits)
    limits = {"EnableLengthMax": True, "LengthMax": 25.0}
    _joint(assembly, joints, "Weight_Slide", "Slider", (f"Lever.PinPad.{top}", f"Weight.{foot}"), limits)
    document.recompute()

    told: dict[str, Any] = {"code": assembly.solve(), "joints": {}, "parts": {}}
    assembly.Placement = App.Placement(App.Vector(3, -2, 52), App.Rotation(App.Vector(0, 1, 0), 20))
    document.recompute()
    document.saveAs("/work/hand.FCStd")
    for item in (item for item in joints.Group if hasattr(item, "JointType")):
        sides = ((item.Placement1, item.Reference1), (item.Placement2, item.Reference2))
        told["joints"][item.Label] = [_seven(UtilsAssembly.getJcsGlobalPlc(placement, reference)) for placement, reference in sides]
    told["parts"] = {item.Name.lower(): _seven(assembly.Placement * item.Placement) for item in (bracket, lever, weight)}
    Path("/work/hand.json").write_text(json.dumps(told))


def _bracket(document: Any, assembly: Any) -> Any:
    """Make a part of a block with a bore."""
    bracket = assembly.newObject("App::Part", "Bracket")
    block, bore = document.addObject("Part::Box", "Block"), document.addObject("Part::Cylinder", "Bore")
    block.Length, block.Width, block.Height = 60, 40, 20
    bore.Radius, bore.Height, bore.Placement.Base = 5, 20, App.Vector(15, 20, 0)
    drilled = document.addObject("Part::Cut", "Drilled")
    drilled.Base, drilled.Tool = block, bore
    bracket.addObject(drilled)
    bracket.Placement = App.Placement(App.Vector(5, -3, 2), App.Rotation(App.Vector(0, 0, 1), 30))
    return bracket


def _lever(assembly: Any) -> Any:
    """Make a body straight in the assembly: a bar with a pin under it."""
    lever = assembly.newObject("PartDesign::Body", "Lever")
    bar, ring = _sketch(lever, "BarSketch"), _sketch(lever, "PinSketch")
    corners = [App.Vector(-8, -8), App.Vector(70, -8), App.Vector(70, 8), App.Vector(-8, 8)]
    for number in range(4):
        bar.addGeometry(Part.LineSegment(corners[number], corners[(number + 1) % 4]))
    for number in range(4):
        bar.addConstraint(Sketcher.Constraint("Coincident", number, 2, (number + 1) % 4, 1))
    ring.addGeometry(Part.Circle(App.Vector(0, 0, 0), App.Vector(0, 0, 1), 4.8))
    pad, pin = lever.newObject("PartDesign::Pad", "BarPad"), lever.newObject("PartDesign::Pad", "PinPad")
    pad.Profile, pad.Length = bar, 6
    pin.Profile, pin.Length, pin.Reversed = ring, 20, True
    lever.Tip = pin
    return lever


def _sketch(body: Any, name: str) -> Any:
    sketch = body.newObject("Sketcher::SketchObject", name)
    (plane,) = [item for item in body.Origin.OriginFeatures if item.Role == "XY_Plane"]
    sketch.AttachmentSupport, sketch.MapMode = [(plane, "")], "FlatFace"
    sketch.AttachmentOffset = App.Placement(App.Vector(4, -3, 0), App.Rotation(App.Vector(0, 0, 1), 40))  # features have placements
    return sketch


def _weight(document: Any, assembly: Any) -> Any:
    """Make a link to a solid that stands outside the assembly."""
    source = document.addObject("Part::Cylinder", "WeightSource")
    source.Radius, source.Height = 7, 12
    weight = assembly.newObject("App::Link", "Weight")
    weight.LinkedObject = source
    return weight


def _circle(radius: float, z: float) -> Callable[[Any], bool]:
    def is_it(edge: Any) -> bool:
        return isinstance(edge.Curve, Part.Circle) and abs(edge.Curve.Radius - radius) < 1e-6 and abs(edge.Curve.Center.z - z) < 1e-6

    return is_it


def _element(elements: list[Any], kind: str, is_it: Callable[[Any], bool]) -> str:
    return f"{kind}{next(number for number, element in enumerate(elements, start=1) if is_it(element))}"


def _joint(assembly: Any, group: Any, name: str, kind: str, sides: tuple[str, str], limits: dict[str, Any]) -> None:
    item = group.newObject("App::FeaturePython", name)
    JointObject.Joint(item, JointObject.JointTypes.index(kind))
    item.Label = name.replace("_", " ")
    for key, value in limits.items():
        setattr(item, key, value)
    item.Proxy.setJointConnectors(item, [[assembly, [side, side]] for side in sides])


def _seven(placement: Any) -> list[float]:
    return [*placement.Base, *placement.Rotation.Q]


main()
