"""Write an assembly as a FreeCAD document: `job.json` in, `assembly.FCStd` and `report.json` out, in the working folder.

Runs inside FreeCAD 1.0 or later and never imports articad. Every placement is given; FreeCAD's solver is called only at the end, to see
whether it agrees. The references of joints are written in the form of FreeCAD 1.0: 1.1 migrates them when it opens the file, while 1.0
cannot read those of 1.1.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import FreeCAD as App
import JointObject
import Part
from numbered import FIRST_OF_ASSEMBLY, numbered_document  # type: ignore[import-not-found]

Json = dict[str, Any]

_KINDS = {"mm": "Distance", "deg": "Angle", "1": "Float"}  # FreeCAD's properties for the units of parameters
_OWN_COLUMNS = ("Index", "Name", "Quantity")  # of a bill of materials
_DENSITY = "Density of the material when articad wrote the document"
_FIXED_MASS = "Mass when articad wrote the document; it does not follow the shape"


def main() -> None:
    """Read the job, write the document, report."""
    job = json.loads(Path("job.json").read_text())
    # every placement is given, and the solver takes more than the square of the number of joints
    App.ParamGet("User parameter:BaseApp/Preferences/Mod/Assembly").SetBool("SolveOnRecompute", False)
    writer = _Writer(job)
    report = writer.write()
    Path("report.json").write_text(json.dumps(report))


def placement(numbers: list[float]) -> Any:
    """Return the placement of seven numbers: mm, quaternion xyzw."""
    return App.Placement(App.Vector(*numbers[:3]), App.Rotation(*numbers[3:]))


class _Writer:
    def __init__(self, job: Json) -> None:
        self.job = job
        self.document = numbered_document(str(Path("seed.FCStd").resolve()), "fresh", "Parameters", FIRST_OF_ASSEMBLY)
        self.document.Label = job["name"]
        self.document.UndoMode = 0
        self.parts: dict[str, Any] = {}  # part -> its object in the assembly
        self.containers: dict[str, Any] = {}  # part -> the App::Part that contains its shape and connectors, shared by links
        self.shapes: dict[str, Any] = {}  # part -> the object with its shape
        self.connectors: dict[tuple[str, str], Any] = {}
        self.colors: dict[str, str] = {}  # object -> colour
        self.hidden: list[str] = []

    def write(self) -> Json:
        self._parameters()
        self.assembly = self.document.addObject("Assembly::AssemblyObject", "Assembly")
        self.assembly.Type = "Assembly"
        self.assembly.Label = self.job["name"]
        _text(self.assembly, "ArticadRecords", "\n".join(self.job["records"]), "articad's records, for the way back", hidden=True)
        _text(self.assembly, "ArticadWritten", "", "The content of the document when articad wrote it", hidden=True)
        for part in self.job["parts"]:
            self._part(part)
        self._group(self.assembly, list(self.parts.values()))
        for part in self.job["parts"]:
            if part["placed"]:
                self.parts[part["name"]].setExpression("Placement", part["placed"])
        self.document.recompute()
        self._place()
        group = self.assembly.newObject("Assembly::JointGroup", "Joints")
        grounded = group.newObject("App::FeaturePython", "GroundedJoint")
        JointObject.GroundedJoint(grounded, self.parts[self.job["ground"]])
        self.joints = [self.document.addObject("App::FeaturePython", joint["object"]) for joint in self.job["joints"]]
        self._group(group, self.joints)
        self._group(self.assembly, self.joints)
        for item, joint in zip(self.joints, self.job["joints"], strict=True):
            self._joint(item, joint)
        self._bill()
        self.document.recompute()
        self.document.recompute()
        self._place()
        self._touch_nothing()
        self.document.saveAs(str(Path("assembly.FCStd").resolve()))
        invalid = [item.Name for item in self.document.Objects if "Invalid" in item.State]
        return {
            "version": list(App.Version()[:3]),
            "invalid": invalid,
            "colors": self.colors,
            "hidden": self.hidden,
            "tips": [item.Tip.Name for item in self.document.Objects if item.TypeId == "PartDesign::Body" and item.Tip is not None],
            "parts": {name: item.Name for name, item in self.parts.items()},
            "joints": [joint.Name for joint in self.joints],
            "grounded": grounded.Name,
        }

    # ------------------------------------------------------------------ parameters

    def _parameters(self) -> None:
        values = self.document.getObject("Parameters")
        if not self.job["parameters"]:
            self.document.removeObject("Parameters")
            return
        values.Label = self.job["parameters_label"]
        for row in self.job["parameters"]:
            note = f"{row['description']} [{row['unit']}] {row['why']}".strip()
            group = "Parameters" if row["live"] else "Fixed parameters"
            _number(values, f"p_{row['name']}", row["value"], group, note, live=row["live"], kind=_KINDS[row["unit"]])
        for row in self.job["parameters"]:
            if row["expression"]:
                values.setExpression(f"p_{row['name']}", row["expression"])
        self.document.recompute()

    def _dimensions(self, part: Json, container: Any, values: Any) -> None:
        if not part["dimensions"]:
            return
        if values is None:
            values = self.document.addObject("App::VarSet", f"Dimensions_{part['object']}")
        body = part["kind"] == "body"  # a mirror image has the dimensions of its source
        fixed = [row["name"] for row in part["dimensions"] if not row["live"]] if body else []
        some = f" ({', '.join(fixed)} fixed)" if fixed else ""
        values.Label = (
            f"{part['name']} dimensions{some if body else ' (frozen shape)' if part['frozen'] else ' (of ' + part['source'] + ')'}"
        )
        for row in part["dimensions"]:
            name, live = f"d_{row['name']}", body and row["live"]
            if name not in values.PropertiesList:
                _number(values, name, row["value"], "Dimensions" if live else "Fixed dimensions", row["why"] if body else "", live=live)
            elif not live:
                values.setGroupOfProperty(name, "Fixed dimensions")
                values.setDocumentationOfProperty(name, row["why"])
                values.setEditorMode(name, ["ReadOnly"])
            setattr(values, name, row["value"])
            if row["expression"]:
                values.setExpression(name, row["expression"])
        container.addObject(values)

    # ------------------------------------------------------------------ parts

    def _part(self, part: Json) -> None:
        name = part["name"]
        if part["kind"] == "link":
            link = self.document.addObject("App::Link", part["object"])
            link.LinkedObject = self.containers[part["source"]]
            self.parts[name], self.containers[name] = link, self.containers[part["source"]]
            self.shapes[name] = self.shapes[part["source"]]
            if part["recolored"]:
                self.colors[link.Name] = part["color"]
            for connector in part["connectors"]:
                self.connectors[name, connector["name"]] = self.connectors[part["source"], connector["name"]]
        else:
            container = self.document.addObject("App::Part", part["object"])
            self.parts[name] = self.containers[name] = container
            self.shapes[name] = self._shape(part, container)
            self.colors[self.shapes[name].Name] = part["color"]
            if part["kind"] == "body":  # a body shows its tip
                self.colors[self.shapes[name].Tip.Name] = part["color"]
            for connector in part["connectors"]:
                self._connector(part, container, connector)
        item = self.parts[name]
        item.Label = name
        item.Placement = placement(part["placement"])
        item.Label2 = part["description"]
        _text(item, "ArticadPart", name, "Name of the part")
        _text(item, "ArticadMaterial", part["material"] or "", "Name of its material")
        self._mass(part, item)

    def _shape(self, part: Json, container: Any) -> Any:
        kind = part["kind"]
        if kind == "body":
            return self._body(part, container)
        if kind == "mirror":
            self._dimensions(part, container, None)
            source = container.newObject("App::Link", f"{part['object']}_source")
            source.LinkedObject = self.shapes[part["source"]]
            source.LinkTransform = True  # with the placement of the shape, which a link leaves out otherwise
            self.hidden.append(source.Name)
            image = container.newObject("Part::Mirroring", f"{part['object']}_body")
            image.Source = source
            image.Base, image.Normal = App.Vector(*part["plane"]["point"]), App.Vector(*part["plane"]["normal"])
            image.Label = f"{part['name']} body{' (frozen)' if part['frozen'] else ''}"
            for name, expression in part["expressions"].items():
                image.setExpression(name, expression)
            return image
        if kind == "mesh":
            import Mesh  # noqa: PLC0415 - only if a part is a mesh

            feature = container.newObject("Mesh::Feature", f"{part['object']}_body")
            feature.Mesh = Mesh.Mesh(part["file"])
            feature.Label = f"{part['name']} body (frozen)"
            return feature
        feature = container.newObject("Part::Feature", f"{part['object']}_body")
        if kind == "shape":
            self._dimensions(part, container, None)
            shape = Part.Shape()
            shape.importBrep(part["file"])
            feature.Shape = shape
            feature.Label = f"{part['name']} body (frozen)"
            feature.Label2 = f"Frozen: {part['why']}" if part.get("why") else ""
        return feature

    def _body(self, part: Json, container: Any) -> Any:
        """Copy a body with its features, and the dimensions that drive it, from the document of a part script."""
        source = App.openDocument(str(Path(part["file"]).resolve()), True)
        new = self.document.copyObject([source.getObject(part["body"])], True, True)  # with all that it needs, and all of it told
        App.closeDocument(source.Name)
        copied = sorted(new, key=lambda item: item.ID)  # as they were made
        (body,) = [item for item in copied if item.TypeId == "PartDesign::Body"]
        values = [item for item in copied if item.TypeId == "App::VarSet"]
        body.Label = f"{part['name']} body"
        body.Placement = placement(part["seat"]) * body.Placement
        container.addObject(body)
        grouped = {member.Name for member in body.Group}
        for item in copied:  # what a body is made of beside its own features, and sheets that a script made
            beside = item.TypeId.startswith("Part::") or item.TypeId == "Spreadsheet::Sheet"
            if item is not body and item.Name not in grouped and beside:
                container.addObject(item)
        copied = [item for item in copied if not self._is_spare(item, body)]
        self.hidden += [item.Name for item in copied if item.TypeId in ("PartDesign::CoordinateSystem", "Part::Mirroring")]
        self._dimensions(part, container, values[0] if values else None)
        for item in copied:  # unchanged: a sketch that is solved again may differ in its last bits
            item.purgeTouched()
        return body

    def _is_spare(self, item: Any, body: Any) -> bool:
        """Remove a connector of the script from its body, if nothing else needs it: the part has its own; return whether it was one."""
        if item.TypeId != "PartDesign::CoordinateSystem" or any(other is not body for other in item.InList):
            return False
        body.removeObject(item)
        self.document.removeObject(item.Name)
        return True

    def _connector(self, part: Json, container: Any, connector: Json) -> None:
        system = container.newObject("PartDesign::CoordinateSystem", connector["object"])
        system.Label = f"{part['name']}.{connector['name']}"
        system.Placement = placement(connector["placement"])
        _text(system, "ArticadConnector", connector["name"], "Name of the connector")
        _text(system, "ArticadLabel", connector["label"], "What it is on the part")
        self.connectors[part["name"], connector["name"]] = system
        if part["kind"] == "mirror":
            names = {"source": self.connectors[part["source"], connector["name"]].Name, "image": self.shapes[part["name"]].Name}
            for axis, expression in zip("xyz", part["reflected"], strict=True):
                system.setExpression(f"Placement.Base.{axis}", expression.format(**names))
        for name, expression in connector["expressions"].items():
            system.setExpression(name, expression)

    def _mass(self, part: Json, item: Any) -> None:
        """Give a part its mass, which follows the volume of its shape."""
        mass = part["mass"]
        if mass is None:
            return
        shape = self.shapes[part["name"]]
        if part["card"] and part["kind"] != "link" and "ShapeMaterial" in shape.PropertiesList:
            import Materials  # noqa: PLC0415 - reads the whole library

            shape.ShapeMaterial = Materials.MaterialManager().getMaterial(part["card"])
            for touched in (shape, *getattr(shape, "Group", ())):  # computed again, a shape may differ in its last bits
                touched.purgeTouched()
        if mass["density"] is not None and hasattr(shape, "Shape"):
            _number(item, "ArticadDensity", mass["density"] * 1e-9, "articad", _DENSITY, live=False, kind="Density")  # kg/mm³
            _number(item, "ArticadMass", mass["kg"], "articad", "Volume times density", live=False, kind="Mass")
            item.setExpression("ArticadMass", f"{shape.Name}.Shape.Volume * 1 mm^3 * ArticadDensity")
        else:
            _number(item, "ArticadMass", mass["kg"], "articad", _FIXED_MASS, live=False, kind="Mass")

    def _bill(self) -> None:
        """Add FreeCAD's own bill of materials; FreeCAD fills in its own columns and keeps the expressions in the others."""
        bill = self.job["bill"]
        group = self.assembly.newObject("Assembly::BomGroup", bill["group"])
        group.Label = "Bills of materials"
        item = group.newObject("Assembly::BomObject", bill["object"])
        item.Label = "Bill of materials"
        item.columnsNames = [*_OWN_COLUMNS, *bill["columns"]]
        item.detailParts = False
        self.document.recompute()
        labelled = {self.parts[part["name"]].Label: self.parts[part["name"]] for part in self.job["parts"]}
        used = set(item.getUsedCells())
        for row in range(2, 2 + len(labelled)):
            part = labelled.get(str(item.get(f"B{row}"))) if f"B{row}" in used else None
            for place, key in enumerate(bill["columns"].values()):
                if part is not None and key in part.PropertiesList:
                    item.set(f"{chr(ord('A') + len(_OWN_COLUMNS) + place)}{row}", f"={part.Name}.{key}")

    @staticmethod
    def _group(group: Any, items: list[Any]) -> None:
        """Add objects to a group, all at once: FreeCAD looks at all of a group's objects whenever one is added."""
        group.Group = [*group.Group, *items]

    def _place(self) -> None:
        for part in self.job["parts"]:
            self.parts[part["name"]].Placement = placement(part["placement"])

    # ------------------------------------------------------------------ joints

    def _joint(self, item: Any, joint: Json) -> None:
        JointObject.Joint(item, JointObject.JointTypes.index(joint["type"]))
        item.Label = joint["label"]
        if not joint["active"]:
            _switch_off(item)
        _text(item, "ArticadJoint", joint["name"], "Name of the joint or coupling")
        item.Offset1, item.Offset2 = placement(joint["offset_1"]), placement(joint["offset_2"])  # before the references: see solve
        for name, value in joint["limits"].items():
            setattr(item, f"Enable{name}", True)
            if name in joint["expressions"]:
                _with_unit(item, name)
            setattr(item, name, value)
        for name, value in joint["distances"].items():
            setattr(item, name, value)
        item.Reference1 = self._reference(joint["parent"], joint["parent_connector"])
        item.Reference2 = self._reference(joint["child"], joint["child_connector"])
        item.Proxy.updateJCSPlacements(item)
        for name, expression in joint["expressions"].items():
            item.setExpression(name, expression)

    def _reference(self, part: str, connector: str) -> list[Any]:
        head, tail = self.parts[part].Name, f"{self.connectors[part, connector].Name}."
        if tuple(map(int, App.Version()[:2])) >= (1, 1):
            return [self.parts[part], [tail, tail]]
        path = f"{head}.{tail}"
        return [self.assembly, [path, path]]

    def _touch_nothing(self) -> None:
        for item in self.document.Objects:
            item.purgeTouched()


def _switch_off(joint: Any) -> None:
    if hasattr(joint, "Suppressed"):  # the name in FreeCAD 1.1
        joint.Suppressed = True
    else:
        joint.Activated = False


def _with_unit(joint: Any, name: str) -> None:
    """Give a limit the unit that it has in FreeCAD 1.1, which replaces plain numbers when it opens the file, and loses their expressions."""
    if joint.getTypeIdOfProperty(name) == "App::PropertyFloat":
        joint.removeProperty(name)
        joint.addProperty(
            "App::PropertyAngle" if name.startswith("Angle") else "App::PropertyDistance", name, "Limits", "A limit of the joint"
        )


def _number(item: Any, name: str, value: float, group: str, note: str, *, live: bool = True, kind: str = "Float") -> None:
    item.addProperty(f"App::Property{kind}", name, group, note)
    setattr(item, name, value)
    if not live:
        item.setEditorMode(name, ["ReadOnly"])


def _text(item: Any, name: str, value: str, note: str, *, hidden: bool = False) -> None:
    item.addProperty("App::PropertyString", name, "articad", note, 4 if hidden else 0)
    setattr(item, name, value)


main()
