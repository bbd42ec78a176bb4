"""Run inside FreeCAD: what FreeCAD finds in an assembly document: parts, poses, volumes, densities, joints. `job.json` in, `report.json` out."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import FreeCAD as App
import Part
import UtilsAssembly

Json = dict[str, Any]
_DEFAULT = "7f9fd73b-50c9-41d8-b7b2-575a030c1eeb"  # the material of a shape that was given none: its density of 1 kg/m³ is a placeholder
_NO_PARTS = (
    "Assembly::JointGroup",
    "Assembly::BomGroup",
    "Assembly::ViewGroup",
    "Assembly::SimulationGroup",
    "App::Origin",
    "App::FeaturePython",
)


def main() -> None:
    """Open the document, report it as it is, solve it, and report where the parts are then."""
    job = json.loads(Path("job.json").read_text())
    document = App.openDocument(str(Path(job["file"]).resolve()), True)  # noqa: FBT003 - hidden
    (assembly,) = [item for item in document.Objects if item.TypeId == "Assembly::AssemblyObject" and not _is_inside(item)][:1]
    parts = list(_components(assembly, assembly.Placement))
    report: Json = {
        "version": list(App.Version()[:3]),
        "broken": [item.Name for item in document.Objects if "Invalid" in item.State],
        "parts": [_part(item, T) for item, T in parts],
        "joints": [_joint(item, assembly, [part.Name for part, _ in parts]) for item in _joints(assembly)],
    }
    report["code"] = assembly.solve()
    report["solved"] = [_matrix(T * item.Placement) for item, T in _components(assembly, assembly.Placement)]
    Path("report.json").write_text(json.dumps(report))


def _is_inside(item: Any) -> bool:
    return any(other.TypeId == "Assembly::AssemblyObject" for other in item.InList if item in getattr(other, "Group", ()))


def _components(group: Any, T: Any) -> Iterator[tuple[Any, Any]]:
    """Yield the parts of an assembly with the placement of what contains them; those of flexible sub-assemblies one by one."""
    for item in group.Group:
        if item.TypeId == "App::DocumentObjectGroup":
            yield from _components(item, T)
        elif item.TypeId == "Assembly::AssemblyLink" and not item.Rigid and item.Group:
            yield from _components(item, T * item.Placement)
        elif item.TypeId not in _NO_PARTS and hasattr(item, "Placement"):
            yield item, T


def _part(item: Any, T: Any) -> Json:
    shape = Part.getShape(item)
    solids = shape.Solids
    return {
        "label": item.Label,
        "pose": _matrix(T * item.Placement),
        "solids": [_solid(solid, T) for solid in solids],
        "faces": len(shape.Faces),
        "densities": sorted(set(_densities(item.getLinkedObject(), set()))),
    }


def _solid(solid: Any, T: Any) -> Json:
    """Return a solid's volume [mm³], its centre [mm] and its inertia about that [mm⁵], in the frame of the document."""
    rotation = T.toMatrix()
    rotation.A14 = rotation.A24 = rotation.A34 = 0.0
    inertia = rotation * solid.MatrixOfInertia * rotation.transposed()
    rows = list(inertia.A)
    return {"volume": solid.Volume, "center": list(T.multVec(solid.CenterOfMass)), "inertia": [rows[0:3], rows[4:7], rows[8:11]]}


def _densities(item: Any, seen: set[str]) -> Iterator[float]:
    """Yield the density of each shape below an object [kg/m³], 0 where its material states none."""
    if item is None or item.FullName in seen:
        return
    seen.add(item.FullName)
    if "ShapeMaterial" in item.PropertiesList and (item.TypeId == "PartDesign::Body" or not hasattr(item, "Group")):
        material = item.ShapeMaterial
        stated = material.UUID != _DEFAULT and material.hasPhysicalProperty("Density")
        yield material.getPhysicalValue("Density").getValueAs("kg/m^3").Value if stated else 0.0
        return
    for member in getattr(item, "Group", ()):
        if member.Visibility and (hasattr(member, "Shape") or hasattr(member, "Group")):
            yield from _densities(member.getLinkedObject(), seen)


def _joints(assembly: Any) -> Iterator[Any]:
    """Yield the active joints of the assembly, and those of the flexible assemblies in it."""
    for item in assembly.Group:
        if item.TypeId == "Assembly::JointGroup":
            yield from (joint for joint in item.Group if _is_active(joint))
        elif item.TypeId == "Assembly::AssemblyLink" and not item.Rigid:
            yield from _joints(item)


def _is_active(joint: Any) -> bool:
    return hasattr(joint, "JointType") and getattr(joint, "Activated", True) and not getattr(joint, "Suppressed", False)


def _joint(joint: Any, assembly: Any, names: list[str]) -> Json:
    """Return a joint's type, its two frames in the frame of the document, and the numbers of its two parts, where FreeCAD tells them."""
    references = [getattr(joint, f"Reference{side}") for side in (1, 2)]
    frames = [
        _matrix(UtilsAssembly.getJcsGlobalPlc(getattr(joint, f"Placement{side}"), reference))
        for side, reference in enumerate(references, start=1)
    ]
    new = tuple(map(int, App.Version()[:2])) >= (1, 1)
    moving = [UtilsAssembly.getMovingPart(*(() if new else (assembly,)), reference) for reference in references]
    parts = [names.index(item.Name) if item is not None and item.Name in names else None for item in moving]
    return {"label": joint.Label, "type": str(joint.JointType), "frames": frames, "parts": parts}


def _matrix(placement: Any) -> list[list[float]]:
    rows = list(placement.toMatrix().A)
    return [rows[0:4], rows[4:8], rows[8:12], rows[12:16]]


main()
