"""Run inside FreeCAD: edit a document of articad's as a person does, each edit in a copy of its own."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import FreeCAD as App
import JointObject


def main() -> None:
    """Make `<edit>.FCStd` for each edit that the job names."""
    wanted = json.loads(Path("job.json").read_text())["edits"]
    for name in wanted:
        document = App.openDocument(str(Path("it.FCStd").resolve()))
        EDITS[name](document)
        document.recompute()
        document.recompute()
        document.saveAs(str(Path(f"{name}.FCStd").resolve()))
        App.closeDocument(document.Name)
    Path("done.json").write_text(json.dumps({"version": list(App.Version()[:3])}))


def nothing(document: Any) -> None:
    """Only recompute and save."""
    for item in document.Objects:
        item.touch()


def parameter(document: Any) -> None:
    document.Parameters.p_width = 520.0


def dimension(document: Any) -> None:
    values = of(document, "knob dimensions")
    values.setExpression("d_radius", None)
    values.d_radius = 11.0


def expression(document: Any) -> None:
    of(document, "door_left dimensions").setExpression("d_wall", "Parameters.p_wall * 1.5")


def feature(document: Any) -> None:
    pad = next(item for item in document.Objects if item.TypeId == "PartDesign::Pad" and item.Label.startswith("Stem"))
    pad.setExpression("Length", None)
    pad.Length = 33.0


def constraint(document: Any) -> None:
    sketch = next(item for item in document.Objects if item.TypeId == "Sketcher::SketchObject" and item.Label.startswith("Window"))
    number = next(place for place, row in enumerate(sketch.Constraints) if row.Type == "Radius")
    name = sketch.Constraints[number].Name
    sketch.setExpression(f"Constraints.{name}", None)
    sketch.setDatum(number, App.Units.Quantity("15 mm"))


def feature_added(document: Any) -> None:
    body = of(document, "tray body")
    body.newObject("PartDesign::AdditiveSphere", "Bump").Radius = 14.0


def feature_deleted(document: Any) -> None:
    body = of(document, "door_left body")
    pocket = body.Tip
    body.Tip = pocket.BaseFeature
    body.removeObject(pocket)
    document.removeObject(pocket.Name)


def part_added(document: Any) -> None:
    assembly, joints = document.Assembly, document.Joints
    box = assembly.newObject("Part::Box", "Lamp")
    box.Label, box.Length, box.Width, box.Height = "Lamp", 30, 20, 10
    box.Placement.Base = App.Vector(0, 50, 400)
    document.recompute()
    joint = joints.newObject("App::FeaturePython", "LampMount")
    JointObject.Joint(joint, JointObject.JointTypes.index("Fixed"))
    joint.Label = "lamp mount"
    joint.Proxy.setJointConnectors(joint, [ref(document, "cabinet.cabinet__rail."), ref(document, "Lamp.")])


def part_deleted(document: Any) -> None:
    document.removeObject("grip")
    document.removeObject("knob")


def joint_added(document: Any) -> None:
    document.removeObject("slide")
    joint = document.Joints.newObject("App::FeaturePython", "Mount")
    JointObject.Joint(joint, JointObject.JointTypes.index("Fixed"))
    joint.Label = "mount"
    joint.Proxy.setJointConnectors(joint, [ref(document, "cabinet.cabinet__rail."), ref(document, "tray.tray__rail.")])


def joint_deleted(document: Any) -> None:
    document.removeObject("slide")


def joint_type(document: Any) -> None:
    document.slide.JointType = "Fixed"


def joint_suppressed(document: Any) -> None:
    joint = document.slide
    if hasattr(joint, "Suppressed"):
        joint.Suppressed = True
    else:
        joint.Activated = False


def limits(document: Any) -> None:
    document.slide.setExpression("LengthMax", None)
    document.slide.LengthMax = 120.0


def limit_off(document: Any) -> None:
    document.flap_hinge.EnableAngleMax = False


def offset(document: Any) -> None:
    document.slide.Offset1 = App.Placement(App.Vector(5, 0, 0), App.Rotation())


def part_label(document: Any) -> None:
    document.tray.Label = "Keyboard tray"


def joint_label(document: Any) -> None:
    document.slide.Label = "Runner"


def connector(document: Any) -> None:
    system = document.tray__rail
    system.Placement.Base = App.Vector(0, 0, 4)


def material(document: Any) -> None:
    document.tray.ArticadMaterial = "brass"


def sheet_added(document: Any) -> None:
    document.addObject("Spreadsheet::Sheet", "Notes").set("A1", "hello")


def part_taken_out(document: Any) -> None:
    """Take a part out of the assembly and leave it in the document."""
    document.removeObject("slide")
    document.Assembly.removeObject(document.tray)


def described(document: Any) -> None:
    document.tray.Label2 = "for letters"


def library_material(document: Any) -> None:
    import Materials

    steel = next(item for item in Materials.MaterialManager().Materials.values() if item.Name.startswith("Steel"))
    of(document, "tray body").ShapeMaterial = steel


def parameter_added(document: Any) -> None:
    document.Parameters.addProperty("App::PropertyFloat", "p_spare", "Parameters")
    document.Parameters.p_spare = 7.0


def ref(document: Any, path: str) -> list[Any]:
    """Return a reference in the form of this version of FreeCAD."""
    if tuple(map(int, App.Version()[:2])) >= (1, 1):
        head, tail = path.split(".", 1)
        return [document.getObject(head), [tail, tail]]
    return [document.Assembly, [path, path]]


def of(document: Any, label: str) -> Any:
    (found,) = document.getObjectsByLabel(label)
    return found


EDITS = {name: value for name, value in dict(globals()).items() if callable(value) and name not in ("main", "ref", "of", "Any", "Path")}
main()
