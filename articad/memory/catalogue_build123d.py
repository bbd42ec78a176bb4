"""Extract build123d's own documentation: run in a process of its own, because the kernel takes seconds to import.

Prints one JSON object: name, signature, summary and text of everything that a part script may use. The package documents
names and arguments but says little about what designers use them for: PURPOSES adds that.
"""

from __future__ import annotations

import enum
import inspect
import json
import re
import sys
from collections.abc import Iterator
from typing import Any, Final

import build123d

from articad.aliases import Json

# Not for parts: builder contexts, files, drawings, joints, units.
_OTHERS: Final = re.compile(
    r"(import_|export_|Export|Build(Line|Part|Sketch)|Base\w+Object|\w*Joint$|Arrow|Dimension|Extension|Technical|Draft\b|DraftAngle|Page|"
    r"Number|Position|Geom(Encoder)|Font|available_fonts|Line(Type)|Dot|Mesher|MeshType|Approx|Unit$|Head|topo_|detect_|add$|insert$|pack$|"
    r"delta$|edges_to_wires|new_edges|FrameMethod|Convexity|Extrinsic|Intrinsic|Sagitta$|LengthMode|PrecisionMode|trace$|Color)"
)
_METHODS_OF: Final = ("Shape", "ShapeList", "Plane", "Location", "Edge", "Face", "Wire", "Solid", "BoundBox")
_METHODS: Final = re.compile(
    r"(export|import|to_|from_|make_|show|wrapped|mesh|copy|is_(type|null)|downcast|cast|entities|get_type|get_top)"
)

PURPOSES: Final = {
    "Axis": "A line in space to turn, pattern, sort or filter by: Axis.X, Axis.Y, Axis.Z.",
    "Box": "Block, cuboid, plate, from its three sides.",
    "Circle": "Round outline, to be extruded, swept or revolved.",
    "Cone": "Round body that tapers: a pin or nozzle with a bottom and a top radius; a countersink when cut.",
    "CounterBoreHole": "Stepped hole: a wider flat-bottomed part above takes the head of a socket screw.",
    "CounterSinkHole": "Hole with a conical recess for a flat-head screw.",
    "Cylinder": "Round rod, disc, boss; a drilled bore when cut.",
    "FilletPolyline": "Path or outline of straight lines with rounded corners: a bent wire or pipe.",
    "GridLocations": "Rows and columns: places in a rectangular grid to repeat a feature at.",
    "Helix": "Curve round an axis: path of a coil spring or a screw thread, for sweep.",
    "HexLocations": "Places in a honeycomb pattern.",
    "Hole": "Drilled round hole, through or to a depth.",
    "Line": "Straight edge of an outline or a path.",
    "Location": "A place and direction in space; frame of a connection; moves what it is multiplied with.",
    "Plane": "Working plane or frame, at an offset, from a face or from origin and axes, to put sketches on and cut with.",
    "PolarLocations": "Places evenly round a centre, on a bolt circle: several equal holes or spokes in a ring.",
    "Polygon": "Closed flat outline from corner points.",
    "Polyline": "Chain of straight edges through points, closed if asked, for make_face or as a path.",
    "Pos": "Move, translate a shape by x, y, z.",
    "Rectangle": "Rectangular outline.",
    "RectangleRounded": "Rectangular outline whose corners are rounded.",
    "RegularPolygon": "Outline of equal sides: triangle, square, hexagon of a nut or bolt head.",
    "Rot": "Turn, rotate a shape about the axes by degrees.",
    "Shape.bounding_box": "Extents, overall size of a shape in x, y and z: how large it is.",
    "Shape.is_valid": "Whether a solid is sound.",
    "Shape.volume": "Volume, how much material.",
    "ShapeList.filter_by": "Keep edges or faces that are parallel to an axis or of one geometry type.",
    "ShapeList.group_by": "Sort edges or faces into groups along an axis: the topmost, the lowest.",
    "ShapeList.sort_by": "Sort edges or faces along an axis: the topmost face is the last.",
    "SlotArc": "Curved long hole with round ends.",
    "SlotCenterPoint": "Long hole with round ends, given by its middle and one end.",
    "SlotCenterToCenter": "Long hole with round ends, by the distance of the ends' centres, in which a pin slides.",
    "SlotOverall": "Long hole with round ends, by its whole length and width.",
    "Sphere": "Ball.",
    "Spline": "Smooth free curve through given points.",
    "Text": "Lettering as an outline: extrude it to raise or engrave letters.",
    "ThreePointArc": "Arc of a circle through three given points.",
    "Torus": "Ring of round cross-section: an O-ring, a doughnut.",
    "Wedge": "Block with slanted sides.",
    "chamfer": "Bevel edges or corners: a flat cut along an edge.",
    "draft": "Slant walls by an angle, so that a moulded or cast part comes out of its mould.",
    "extrude": "Raise a flat outline into a solid of a height or thickness; with taper, slanted walls.",
    "fillet": "Round edges or corners with a radius.",
    "loft": "Smooth transition between outlines at different heights, such as square to circle.",
    "make_face": "Fill closed edges to a face that can be extruded.",
    "make_hull": "Outline that wraps tightly round others, such as a belt round pulleys.",
    "mirror": "The mirror image: the other half of a symmetric part.",
    "offset": "Hollow a solid out to thin walls, with openings left open; grow or shrink an outline.",
    "revolve": "Turn an outline about an axis: a lathe-turned, rotationally symmetric body.",
    "scale": "Make larger or smaller.",
    "section": "Flat cross-section of a solid at a plane.",
    "split": "Cut a shape in two with a plane, and keep one side or both.",
    "sweep": "Carry an outline along a path, straight or bent: pipe, wire, handle, moulding.",
    "thicken": "Give a face or shell a wall thickness.",
}


def entries() -> Iterator[Json]:
    """Yield an entry for each name of the algebra that makes parts, and for the methods of the resulting shapes."""
    for name in build123d.__all__:
        item = getattr(build123d, name)
        if _OTHERS.match(name) or not callable(item):
            continue
        target = item.__init__ if inspect.isclass(item) and not issubclass(item, enum.Enum) else item
        yield _entry(name, item, f"{name}{_signature(target)}" if not _is_enum(item) else f"{name}: {', '.join(item.__members__)}")
    for kind in _METHODS_OF:
        owner: Any = getattr(build123d, kind, None) or getattr(build123d.topology, kind)
        for name, item in vars(owner).items():
            if name.startswith("_") or _METHODS.match(name) or not inspect.getdoc(item):
                continue
            if isinstance(item, property):
                yield _entry(f"{kind}.{name}", item, f"{kind}.{name}")
            elif callable(item):
                yield _entry(f"{kind}.{name}", item, f"{kind}.{name}{_signature(item)}")


def _entry(name: str, item: Any, signature: str) -> Json:
    text = inspect.getdoc(item) or ""
    paragraphs = [" ".join(part.split()) for part in re.split(r"\n\s*\n", text)]
    # A first line such as "Part Object: Box" or "Generic Operation: fillet" names the kind; what follows says what it does.
    said = [part for part in paragraphs if not re.match(r"(\w+ )*(Object|Operation): |Applies to |(Args|Raises|Returns|Example)", part)]
    summary = PURPOSES.get(name) or " ".join(said[:2])[:400]
    return {"name": name, "signature": signature, "summary": summary, "text": text[:2000]}


def _signature(item: Any) -> str:
    try:
        signature = inspect.signature(item)
    except (TypeError, ValueError):
        return "(...)"
    kept = [
        parameter.replace(annotation=_plain(parameter.annotation), default=_default(parameter.default))
        for name, parameter in signature.parameters.items()
        if name not in {"self", "mode", "clean"}
    ]
    return str(signature.replace(parameters=kept, return_annotation=inspect.Signature.empty)).replace("'", "")


def _plain(annotation: Any) -> Any:
    if annotation is inspect.Parameter.empty:
        return annotation
    return _Word(re.sub(r"(\w+\.)+(?=\w)", "", annotation.__name__ if inspect.isclass(annotation) else str(annotation)))


def _default(default: Any) -> Any:
    if isinstance(default, tuple):
        return _Word(f"({', '.join(repr(_default(item)) for item in default)})")
    return _Word(str(default)) if isinstance(default, enum.Enum) else default


class _Word:
    """Shows a text without quotation marks."""

    def __init__(self, text: str) -> None:
        self.text = text

    def __repr__(self) -> str:
        return self.text


def _is_enum(item: Any) -> bool:
    return inspect.isclass(item) and issubclass(item, enum.Enum)


if __name__ == "__main__":
    json.dump({"version": build123d.__version__, "entries": list(entries())}, sys.stdout)
