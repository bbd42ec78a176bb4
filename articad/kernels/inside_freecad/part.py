"""Run one part script inside FreeCAD: untrusted code, in a confined process of its own that does nothing else.

Arguments: the numbers of open files: `job` to read, `report` and `document` to write. The result is a report, one JSON object per line,
    and the document. Whoever reads them must not trust them. Scripts work with `Authoring`.
"""

from __future__ import annotations

import copy
import difflib
import json
import math
import os
import re
import traceback
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import FreeCAD as App
import Part
import Sketcher
from numbered import FIRST_OF_PART, numbered_document  # type: ignore[import-not-found]

FILE = "part.py"  # the file name of a script's code: tracebacks are cut down to it
SAVED = "/tmp/part.FCStd"  # noqa: S108 - private to this process
_PLANES = {"XY": "XY_Plane", "XZ": "XZ_Plane", "YZ": "YZ_Plane"}
_AXES = {"X": "X_Axis", "Y": "Y_Axis", "Z": "Z_Axis"}
_SIDES = {"X": App.Vector(1, 0, 0), "Y": App.Vector(0, 1, 0), "Z": App.Vector(0, 0, 1)}
_FUNCTIONS = {"abs", "acos", "asin", "atan", "atan2", "ceil", "cos", "floor", "hypot", "max", "min", "sin", "sqrt", "tan", "pi"}
_NAME = re.compile(r"(?<![\w.])[A-Za-z_]\w*")
_THROUGH, _BEYOND = 1e4, 0.5  # mm: half the length of a rod that has none, and how far the cutter of a groove stands out of its shaft

Json = dict[str, Any]
Value = float | str
"""A number, or arithmetic over the names of dimensions, such as "width / 2 - inset"."""


class _Dimensions(dict[str, float]):
    """Dimensions by name; a name that is none of them is told with the nearest one."""

    def __missing__(self, name: str) -> float:
        close = difflib.get_close_matches(str(name), self, n=1)
        meant = f" Did you mean {close[0]!r}?" if close else ""
        raise KeyError(f"The part has no dimension {name!r}.{meant} It has {', '.join(self) or 'none'}.")


class NotAPartError(Exception):
    """What the script returned is not a part; the message says why."""


class Authoring:
    """The `part` of a part script: its brief, its document, and short ways to features that follow the dimensions.

    Every length may be a number or a text over the names of dimensions, such as `"width / 2 - inset"`; a text is tied: an
    edit of the dimension moves the feature. Trigonometric functions take degrees.

    Attributes:
        name, description, material: As in the plan.
        dimensions: Name -> number, mm, degrees, counts.
        connectors: Name -> object with `o`, `z`, `x`, `label`, `joints`.
        document: The open FreeCAD document; its VarSet `Dimensions` holds `d_<name>`.
        body: The PartDesign::Body, made when first used.
    """

    def __init__(self, brief: Json, document: Any) -> None:
        self.name, self.description, self.material = brief["name"], brief["description"], brief["material"]
        self.dimensions = _Dimensions(brief["dimensions"])
        self.connectors = {
            name: SimpleNamespace(**{key: tuple(frame[key]) for key in ("o", "z", "x")}, label=frame["label"], joints=frame["joints"])
            for name, frame in copy.deepcopy(brief["connectors"]).items()
        }
        self.document = document
        self._body: Any = None

    # ------------------------------------------------------------------ numbers

    def expression(self, name: str) -> str:
        """Return the expression that binds a length, an angle or a count to one dimension.

        Example:
            plate = part.box((0, 0, 0), ("width", "depth", 1))
            plate.setExpression("Length", part.expression("height"))
        """
        if name not in self.dimensions:
            raise ValueError(f"There is no dimension {name!r}; there are {', '.join(self.dimensions) or 'none'}")
        unit = "" if name.endswith("_count") else " * 1 deg" if name.endswith("_deg") else " * 1 mm"
        return f"Dimensions.d_{name}{unit}"

    def length(self, value: Value) -> str:
        """Return FreeCAD's expression of a length.

        Example:
            plate = part.box((0, 0, 0), ("width", "depth", 1))
            plate.setExpression("Length", part.length("height / 2"))
        """
        return f"({self._arithmetic(value)}) * 1 mm"

    def angle(self, value: Value) -> str:
        """Return FreeCAD's expression of an angle in degrees.

        Example:
            outline = part.sketch("XZ")
            part.rectangle(outline, "radius", 0, 4, "height")
            ring = part.revolution(outline)
            ring.setExpression("Angle", part.angle("turn_deg"))
        """
        return f"({self._arithmetic(value)}) * 1 deg"

    def number(self, value: Value) -> float:
        """Return the present value of a number, or of a text over dimensions.

        Example:
            part.box((0, 0, 0), ("width", "depth", max(part.number("height / 5"), 3)))
        """
        if not isinstance(value, str):
            return float(value)
        degrees = {
            "sin": lambda a: math.sin(math.radians(a)),
            "cos": lambda a: math.cos(math.radians(a)),
            "tan": lambda a: math.tan(math.radians(a)),
            "asin": lambda a: math.degrees(math.asin(a)),
            "acos": lambda a: math.degrees(math.acos(a)),
            "atan": lambda a: math.degrees(math.atan(a)),
            "atan2": lambda a, b: math.degrees(math.atan2(a, b)),
        }
        plain = {"abs": abs, "min": min, "max": max, "sqrt": math.sqrt, "hypot": math.hypot, "ceil": math.ceil, "floor": math.floor}
        self._arithmetic(value)
        return float(eval(value, {"__builtins__": {}}, {**self.dimensions, **plain, **degrees, "pi": math.pi}))  # noqa: S307 - a script is code

    def _arithmetic(self, value: Value) -> str:
        if not isinstance(value, str):
            return repr(float(value))

        def tied(match: re.Match[str]) -> str:
            name = match[0]
            if name in self.dimensions:
                return f"Dimensions.d_{name}"
            if name in _FUNCTIONS or name in ("e", "E"):
                return name
            raise ValueError(f"{value!r} names {name!r}, which is not a dimension; there are {', '.join(self.dimensions) or 'none'}")

        return _NAME.sub(tied, value).replace(",", ";")

    def tie(self, item: Any, name: str, value: Value) -> None:
        """Bind a property of a feature to a number, or to arithmetic over dimensions.

        Example:
            plate = part.box((0, 0, 0), ("width", "depth", 1))
            part.tie(plate, "Length", "height - radius")
        """
        text = self.angle(value) if name.endswith(("Angle", "Angle2")) else self.length(value)
        item.setExpression(name, text)

    # ------------------------------------------------------------------ sketches

    @property
    def body(self) -> Any:
        """The part's body."""
        if self._body is None:
            self._body = self.document.addObject("PartDesign::Body", "Body")
        return self._body

    def sketch(self, plane: str = "XY", at: Sequence[Value] = (0, 0, 0), name: str = "Sketch") -> Any:
        """Start a sketch on a plane of the body.

        Args:
            plane: XY: x right, y up, normal +Z. XZ: x = X, y = Z, normal -Y. YZ: x = Y, y = Z, normal +X.
            at: Where its origin is, in the part's frame.
            name: In the tree.

        Example:
            outline = part.sketch("XZ", at=(0, "depth", 0))
            part.circle(outline, 0, 0, "radius")
            part.pad(outline, "depth")
        """
        sketch = self.body.newObject("Sketcher::SketchObject", name)
        (origin,) = [item for item in self.body.Origin.OriginFeatures if item.Role == _PLANES[plane]]
        sketch.AttachmentSupport = [(origin, "")]
        sketch.MapMode = "FlatFace"
        x, y, z = at
        local = {"XY": (x, y, z), "XZ": (x, z, _negative(y)), "YZ": (y, z, x)}[plane]
        for axis, value in zip("xyz", local, strict=True):
            if value != 0:
                self.tie(sketch, f"AttachmentOffset.Base.{axis}", value)
        return sketch

    def polygon(self, sketch: Any, points: Sequence[tuple[Value, Value]]) -> None:
        """Draw a closed outline through points.

        Example:
            outline = part.sketch()
            part.polygon(outline, [(0, 0), ("width", 0), (0, "depth")])
            part.pad(outline, "height")
        """
        here = [App.Vector(self.number(x), self.number(y), 0) for x, y in points]
        first = sketch.GeometryCount
        count = len(points)
        for number in range(count):
            sketch.addGeometry(Part.LineSegment(here[number], here[(number + 1) % count]))
        for number in range(count):
            sketch.addConstraint(Sketcher.Constraint("Coincident", first + number, 2, first + (number + 1) % count, 1))
        for number, (x, y) in enumerate(points):
            self._fix(sketch, first + number, 1, x, y, f"corner{number + 1}")

    def path(self, sketch: Any, points: Sequence[tuple[Value, Value]]) -> None:
        """Draw straight lines from point to point, for a sweep; at least two points, and no outline.

        Example:
            outline, line = part.sketch("XY"), part.sketch("XZ")
            part.circle(outline, 0, 0, "radius")
            part.path(line, [(0, 0), (0, "height"), ("width", "height")])
            part.sweep(outline, line)
        """
        here = [App.Vector(self.number(x), self.number(y), 0) for x, y in points]
        first = sketch.GeometryCount
        for number in range(len(points) - 1):
            sketch.addGeometry(Part.LineSegment(here[number], here[number + 1]))
        for number in range(len(points) - 2):
            sketch.addConstraint(Sketcher.Constraint("Coincident", first + number, 2, first + number + 1, 1))
        for number, (x, y) in enumerate(points):
            last = number == len(points) - 1
            self._fix(sketch, first + number - last, 2 if last else 1, x, y, f"point{number + 1}")

    def rectangle(self, sketch: Any, x: Value, y: Value, width: Value, height: Value) -> None:
        """Draw a rectangle from its lower left corner.

        Example:
            outline = part.sketch()
            part.rectangle(outline, "-width / 2", 0, "width", "depth")
            part.pad(outline, "height")
        """
        right, top = _sum(x, width), _sum(y, height)
        self.polygon(sketch, [(x, y), (right, y), (right, top), (x, top)])

    def circle(self, sketch: Any, x: Value, y: Value, radius: Value) -> None:
        """Draw a circle.

        Example:
            outline = part.sketch()
            part.circle(outline, "width / 2", 0, "radius")
            part.pad(outline, "height")
        """
        center = App.Vector(self.number(x), self.number(y), 0)
        index = sketch.addGeometry(Part.Circle(center, App.Vector(0, 0, 1), self.number(radius)))
        self._fix(sketch, index, 3, x, y, "center")
        self._dimension(sketch, Sketcher.Constraint("Radius", index, self.number(radius)), radius, "radius")

    def slot(self, sketch: Any, start: tuple[Value, Value], end: tuple[Value, Value], radius: Value) -> None:
        """Draw a slot along x or y from the centre of one round end to that of the other.

        Example:
            outline = part.sketch()
            part.slot(outline, (0, 0), ("width", 0), "radius")
            part.pad(outline, "height")
        """
        a, b = (App.Vector(self.number(x), self.number(y), 0) for x, y in (start, end))
        r = self.number(radius)
        angle = math.atan2(b.y - a.y, b.x - a.x)
        side = App.Vector(-math.sin(angle), math.cos(angle), 0) * r
        up = App.Vector(0, 0, 1)
        one = sketch.addGeometry(Part.ArcOfCircle(Part.Circle(a, up, r), angle + math.pi / 2, angle + 3 * math.pi / 2))
        other = sketch.addGeometry(Part.ArcOfCircle(Part.Circle(b, up, r), angle - math.pi / 2, angle + math.pi / 2))
        low = sketch.addGeometry(Part.LineSegment(a - side, b - side))
        high = sketch.addGeometry(Part.LineSegment(b + side, a + side))
        for first, end_1, second, end_2 in ((one, 2, low, 1), (low, 2, other, 1), (other, 2, high, 1), (high, 2, one, 1)):
            sketch.addConstraint(Sketcher.Constraint("Tangent", first, end_1, second, end_2))
        sketch.addConstraint(Sketcher.Constraint("Equal", one, other))  # else the other end keeps a radius of its own
        self._fix(sketch, one, 3, *start, "start")
        self._fix(sketch, other, 3, *end, "end")
        self._dimension(sketch, Sketcher.Constraint("Radius", one, r), radius, "radius")

    def axis(self, sketch: Any, start: tuple[Value, Value], end: tuple[Value, Value]) -> str:
        """Draw a line that is no outline; return the name by which a revolution turns about it.

        Example:
            outline = part.sketch("XZ")
            part.rectangle(outline, "radius", 0, 4, "height")
            turned_about = part.axis(outline, (0, 0), (0, "height"))
            part.revolution(outline, turned_about)
        """
        a, b = (App.Vector(self.number(x), self.number(y), 0) for x, y in (start, end))
        count = sum(sketch.getConstruction(number) for number in range(sketch.GeometryCount))
        line = sketch.addGeometry(Part.LineSegment(a, b), True)
        self._fix(sketch, line, 1, *start, "axis_start")
        self._fix(sketch, line, 2, *end, "axis_end")
        return f"Axis{count}"

    def _fix(self, sketch: Any, index: int, position: int, x: Value, y: Value, name: str) -> None:
        """Hold a point at a place measured from the sketch's origin."""
        for kind, value in (("DistanceX", x), ("DistanceY", y)):
            constraint = Sketcher.Constraint(kind, -1, 1, index, position, self.number(value))
            self._dimension(sketch, constraint, value, f"{name}_{kind[-1].lower()}")

    def _dimension(self, sketch: Any, constraint: Any, value: Value, wanted: str) -> None:
        """Add a constraint with a value, named after what it measures: `corner2_x`, and `corner2_x_2` for the next outline's."""
        taken, name, count = {row.Name for row in sketch.Constraints}, wanted, 2
        while name in taken:
            name, count = f"{wanted}_{count}", count + 1
        number = sketch.addConstraint(constraint)
        sketch.renameConstraint(number, name)
        if isinstance(value, str):
            sketch.setExpression(f"Constraints.{name}", self.length(value))

    # ------------------------------------------------------------------ features; each becomes the tip

    def pad(self, sketch: Any, length: Value, *, both: bool = False, back: bool = False, name: str = "Pad") -> Any:
        """Add material along the sketch's normal: `both` half to each side, `back` against it.

        Example:
            outline = part.sketch()
            part.rectangle(outline, 0, 0, "width", "depth")
            part.pad(outline, "height", both=True)
        """
        pad = self.body.newObject("PartDesign::Pad", name)
        pad.Profile, pad.Midplane, pad.Reversed = sketch, both, back
        self.tie(pad, "Length", length)
        return self._done(pad)

    def pocket(self, sketch: Any, length: Value | None = None, *, both: bool = False, back: bool = False, name: str = "Pocket") -> Any:
        """Cut against the sketch's normal, `back` along it; through everything, to both sides, if no length is given.

        Example:
            part.box((0, 0, 0), ("width", "depth", "height"))
            hole = part.sketch(at=(0, 0, "height"))
            part.circle(hole, "width / 2", "depth / 2", "radius")
            part.pocket(hole)
        """
        pocket = self.body.newObject("PartDesign::Pocket", name)
        pocket.Profile, pocket.Midplane, pocket.Reversed = sketch, both or length is None, back
        if length is None:
            pocket.Type = "ThroughAll"
        else:
            self.tie(pocket, "Length", length)
        return self._done(pocket)

    def revolution(self, sketch: Any, axis: str = "V", *, cut: bool = False, name: str = "Revolution") -> Any:
        """Turn a sketch fully about its vertical ("V") or horizontal ("H") axis, or one that `axis` drew; `cut` takes away.

        Example:
            outline = part.sketch("XZ")
            part.rectangle(outline, 0, 0, "radius", "height")
            part.revolution(outline)
        """
        feature = self.body.newObject("PartDesign::Groove" if cut else "PartDesign::Revolution", name)
        feature.Profile = sketch
        feature.ReferenceAxis = (sketch, [axis if axis.startswith("Axis") else f"{axis}_Axis"])
        feature.Angle = 360.0
        return self._done(feature)

    def loft(self, sketch: Any, *others: Any, cut: bool = False, name: str = "Loft") -> Any:
        """Span straight faces from one sketch to the next, each of one outline with as many corners; `cut` takes away.

        Example:
            low, high = part.sketch(), part.sketch(at=(0, 0, "height"))
            part.rectangle(low, 0, 0, "width", "depth")
            part.rectangle(high, 0, 0, "width / 2", "depth / 2")
            part.loft(low, high)
        """
        loft = self.body.newObject("PartDesign::SubtractiveLoft" if cut else "PartDesign::AdditiveLoft", name)
        loft.Profile, loft.Sections, loft.Ruled = sketch, list(others), True
        for other in others:
            other.Visibility = False
        return self._done(loft)

    def sweep(self, sketch: Any, path: Any, *, cut: bool = False, name: str = "Sweep") -> Any:
        """Move an outline along a path, with mitred corners; the path starts in the outline's plane. `cut` takes away.

        Example:
            outline, line = part.sketch("XY"), part.sketch("XZ")
            part.rectangle(outline, "-radius", "-radius", "2 * radius", "2 * radius")
            part.path(line, [(0, 0), (0, "height"), ("width", "height")])
            part.sweep(outline, line)
        """
        sweep = self.body.newObject("PartDesign::SubtractivePipe" if cut else "PartDesign::AdditivePipe", name)
        sweep.Profile, sweep.Spine = sketch, (path, [f"Edge{number + 1}" for number in range(path.GeometryCount)])
        sweep.Transition = "Right corner"
        path.Visibility = False
        return self._done(sweep)

    def sphere(self, center: Sequence[Value], radius: Value, *, cut: bool = False, name: str = "Sphere") -> Any:
        """Add or cut a sphere.

        Example:
            part.sphere((0, 0, "height"), "radius")
        """
        sphere = self.body.newObject("PartDesign::SubtractiveSphere" if cut else "PartDesign::AdditiveSphere", name)
        self.tie(sphere, "Radius", radius)
        for axis, value in zip("xyz", center, strict=True):
            self.tie(sphere, f"Placement.Base.{axis}", value)
        return self._done(sphere)

    def fillet(self, side: str, radius: Value, *, name: str = "Fillet") -> Any:
        """Round all edges of the outermost flat face that looks along +X, -X, +Y, -Y, +Z or -Z.

        Example:
            part.box((0, 0, 0), ("width", "depth", "height"))
            part.fillet("+Z", "radius / 2")
        """
        return self._dressed("PartDesign::Fillet", side, "Radius", radius, name)

    def chamfer(self, side: str, size: Value, *, name: str = "Chamfer") -> Any:
        """Bevel all edges of the outermost flat face that looks along +X, -X, +Y, -Y, +Z or -Z.

        Example:
            part.box((0, 0, 0), ("width", "depth", "height"))
            part.chamfer("+Z", "radius / 2")
        """
        return self._dressed("PartDesign::Chamfer", side, "Size", size, name)

    def cylinder(self, at: Sequence[Value], axis: str, radius: Value, length: Value, *, cut: bool = False, name: str = "Cylinder") -> Any:
        """Add or cut a cylinder that starts at a point and runs along +X, +Y, +Z, -X, -Y or -Z.

        Example:
            part.box((0, 0, 0), ("width", "depth", "height"))
            part.cylinder(("width / 2", "depth / 2", 0), "+Z", "radius", "height", cut=True)
        """
        plane, forward = {"Z": ("XY", True), "Y": ("XZ", False), "X": ("YZ", True)}[axis[-1]]
        sketch = self.sketch(plane, at, name=f"{name}Sketch")
        self.circle(sketch, 0, 0, radius)
        return self._extruded(sketch, length, along=forward != axis.startswith("-"), cut=cut, name=name)

    def box(self, corner: Sequence[Value], size: Sequence[Value], *, cut: bool = False, name: str = "Box") -> Any:
        """Add or cut a box from its corner of smallest coordinates.

        Example:
            part.box(("-width / 2", 0, 0), ("width", "depth", "height"))
        """
        sketch = self.sketch("XY", (0, 0, corner[2]), name=f"{name}Sketch")
        self.rectangle(sketch, corner[0], corner[1], size[0], size[1])
        return self._extruded(sketch, size[2], along=True, cut=cut, name=name)

    def linear_pattern(self, features: Sequence[Any], axis: str, length: Value, count: Value) -> Any:
        """Repeat features along X, Y or Z of the body over a length, the first included.

        Example:
            part.box((0, 0, 0), ("width", "depth", "height"))
            hole = part.cylinder(("radius + 1", "depth / 2", 0), "+Z", "radius", "height", cut=True)
            part.linear_pattern([hole], "X", "width - 2 * radius - 2", 3)
        """
        pattern = self.body.newObject("PartDesign::LinearPattern", "LinearPattern")
        pattern.Originals, pattern.Direction = list(features), (self._axis(axis), [""])
        self.tie(pattern, "Length", length)
        return self._counted(pattern, count)

    def polar_pattern(self, features: Sequence[Any], axis: str, count: Value) -> Any:
        """Repeat features evenly round X, Y or Z of the body, the first included.

        Example:
            part.cylinder((0, 0, 0), "+Z", "depth", "height")
            hole = part.cylinder(("depth / 2", 0, 0), "+Z", "radius", "height", cut=True)
            part.polar_pattern([hole], "Z", 4)
        """
        pattern = self.body.newObject("PartDesign::PolarPattern", "PolarPattern")
        pattern.Originals, pattern.Axis = list(features), (self._axis(axis), [""])
        pattern.Angle = 360.0
        return self._counted(pattern, count)

    def connector(self, name: str, o: Sequence[Value], z: Sequence[Value], x: Sequence[Value] | None = None) -> Any:
        """Put a coordinate system into the body, tied to the dimensions; return it for the dict of connectors.

        Example:
            part.box((0, 0, 0), ("width", "depth", "height"))
            connectors = {"hinge": part.connector("hinge", (0, "depth", "height"), (-1, 0, 0), (0, -1, 0))}
        """
        system = self.body.newObject("PartDesign::CoordinateSystem", f"connector_{name}")
        right = x if x is not None else self.connectors[name].x
        if not any(isinstance(value, str) for value in (*z, *right)):
            forward, turned = App.Vector(*z), App.Vector(*right)
            system.Placement = App.Placement(App.Vector(), App.Rotation(turned, forward.cross(turned), forward, "ZXY"))
            for axis, value in zip("xyz", o, strict=True):
                self.tie(system, f"Placement.Base.{axis}", value)
            return system
        axes = [f"vector({'; '.join(map(self._arithmetic, values))})" for values in (right, z)]
        base = f"vector({'; '.join(map(self.length, o))})"
        turn = f"create(<<rotation>>; {axes[0]}; vector(0; 0; 0); {axes[1]}; <<ZXY>>)"
        system.setExpression("Placement", f"placement({base}; {turn})")
        return system

    def made(self, body: Any = None) -> tuple[Any, dict[str, Json]]:
        """Add what standard joints need, at each connector by the names of its dimensions; return what `build(part)` returns.

        The features are those of `part.made` of the other kernel: `<connector>_pin` and `_bore`, `_bar_x` and `_slot_x`, `_ball` and
        `_socket`, `_gap` and `_groove`. They stand where the plan puts the connector.

        Args:
            body: `part.body`; None for a part of such features alone, such as a pin.

        Example:
            part.box((0, 0, 0), ("width", "depth", "height"))
            body, connectors = part.made(part.body)
        """
        if body is not None:
            for name in self._having("gap"):  # first, so that no fork loses its pin
                self.pocket(self._disc(name, "reach", 1), f"{name}_gap", both=True, name="Fork")
        for name in self._having("span"):  # the pin of a fork
            self.pad(self._disc(name, "pin"), f"{name}_span", both=True, name="Pin")
        self._ends("pin", "bar", "ball", "length", cut=False, without=self._having("span"))
        for name in self._having("head"):
            self.pad(self._disc(name, "head"), f"{name}_thick", back=True, name="Head")
        for name in self._having("tail"):
            behind = f"{name}_tail + {name}_thick" if f"{name}_thick" in self.dimensions else f"{name}_tail"
            self.pad(self._disc(name, "pin"), behind, back=True, name="Tail")
        for name in self._having("groove"):
            ring = self._disc(name, "groove")
            self.circle(ring, 0, 0, f"{name}_shaft / 2 + {_BEYOND}")
            self.pocket(ring, f"{name}_width", both=True, name="Groove")
        self._ends("bore", "slot", "socket", "depth", cut=True)  # last, so that no pin fills a bore
        return self.body, {name: {axis: getattr(frame, axis) for axis in "ozx"} for name, frame in self.connectors.items()}

    def _ends(self, rod: str, bar: str, ball: str, length: str, *, cut: bool, without: Sequence[str] = ()) -> None:
        """Add, or cut, the rods, bars and balls of one side of standard joints."""
        for name in self._having(rod):
            if name not in without:
                self._long(self._disc(name, rod), f"{name}_{length}", cut=cut, name=rod.capitalize())
        for name in self._having(f"{bar}_x"):
            outline = self._at_connector(name)
            x, y = f"{name}_{bar}_x", f"{name}_{bar}_y"
            self.rectangle(outline, f"-{x} / 2", f"-{y} / 2", x, y)
            self._long(outline, f"{name}_{length}", cut=cut, name=bar.capitalize())
        for name in self._having(ball):
            self.sphere(self.connectors[name].o, f"{name}_{ball} / 2", cut=cut, name=ball.capitalize())

    def _long(self, outline: Any, length: str, *, cut: bool, name: str) -> None:
        """Add or cut an outline along its normal over a length, or without one far to both sides."""
        known = length in self.dimensions
        if cut:
            self.pocket(outline, length if known else None, back=known, name=name)
        else:
            self.pad(outline, length if known else 2 * _THROUGH, both=not known, name=name)

    def _having(self, size: str) -> list[str]:
        """Return the connectors that have a dimension of this kind."""
        return [name for name in self.connectors if f"{name}_{size}" in self.dimensions]

    def _disc(self, name: str, size: str, share: int = 2) -> Any:
        """Return a sketch at a connector with a circle about its axis: a dimension over 2 is the radius, over 1 the radius itself."""
        sketch = self._at_connector(name)
        self.circle(sketch, 0, 0, f"{name}_{size} / {share}")
        return sketch

    def _at_connector(self, name: str) -> Any:
        """Start a sketch in a connector's plane: its x and y are the connector's, its normal is the connector's z."""
        frame, sketch = self.connectors[name], self.sketch(name=f"At_{name}")
        x, z = App.Vector(*frame.x), App.Vector(*frame.z)
        sketch.AttachmentOffset = App.Placement(App.Vector(*frame.o), App.Rotation(x, z.cross(x), z, "ZXY"))
        return sketch

    def settle(self) -> None:
        """Recompute until the names of edges stay: call it before a fillet or chamfer names any.

        Example:
            block = part.box((0, 0, 0), ("width", "depth", "height"))
            part.settle()
            edge = part.body.newObject("PartDesign::Chamfer", "Edge")
            edge.Base = (block, ["Edge1"])
            part.tie(edge, "Size", 2)
            part.body.Tip = edge
        """
        for _ in range(2):
            for item in self.document.Objects:
                item.touch()
            self.document.recompute()

    def _extruded(self, sketch: Any, length: Value, *, along: bool, cut: bool, name: str) -> Any:
        if cut:
            return self.pocket(sketch, length, back=along, name=name)
        return self.pad(sketch, length, back=not along, name=name)

    def _dressed(self, kind: str, side: str, key: str, value: Value, name: str) -> Any:
        self.settle()
        below, outwards = self.body.Tip, _SIDES[side[-1]] * (-1 if side.startswith("-") else 1)
        flat = []
        for number, face in enumerate(below.Shape.Faces, start=1):
            if isinstance(face.Surface, Part.Plane) and face.normalAt(0, 0).dot(outwards) > 1 - 1e-9:
                flat.append((face.CenterOfMass.dot(outwards), f"Face{number}"))
        if not flat:
            raise ValueError(f"No flat face of the body looks along {side}")
        feature = self.body.newObject(kind, name)
        feature.Base = (below, [max(flat)[1]])
        self.tie(feature, key, value)
        return self._done(feature)

    def _axis(self, axis: str) -> Any:
        (found,) = [item for item in self.body.Origin.OriginFeatures if item.Role == _AXES[axis]]
        return found

    def _counted(self, pattern: Any, count: Value) -> Any:
        pattern.Occurrences = round(self.number(count))
        if isinstance(count, str):
            pattern.setExpression("Occurrences", self._arithmetic(count))
        return self._done(pattern)

    def _done(self, feature: Any) -> Any:
        """Make a feature the tip, whatever its kind: a pattern that is not the tip drops out of the solid unseen."""
        self.body.Tip = feature
        self.document.recompute()
        profile = getattr(feature, "Profile", None)
        if profile:
            profile[0].Visibility = False
        return feature


def _negative(value: Value) -> Value:
    return f"-({value})" if isinstance(value, str) else -value


def _sum(a: Value, b: Value) -> Value:
    if isinstance(a, str) or isinstance(b, str):
        return f"({a}) + ({b})"
    return a + b


def main(job: int, report: int, document: int) -> None:
    """Run the script of a job; leave its document and a report."""
    told = json.loads(os.pread(job, os.fstat(job).st_size, 0))
    try:
        connectors = _built(told["script"], told["part"])
    except NotAPartError as wrong:
        _say(report, {"ok": False, "problems": [str(problem) for problem in wrong.args]})
        return
    except BaseException as error:  # noqa: BLE001 - a script may raise anything
        _say(report, {"ok": False, "error": _described(error)})
        return
    content = Path(SAVED).read_bytes()
    while content:
        content = content[os.write(document, content) :]
    _say(report, {"ok": True, "connectors": connectors})


def _built(script: str, brief: Json) -> dict[str, Json]:
    document = numbered_document(SAVED, "part", "Dimensions", FIRST_OF_PART)
    document.UndoMode = 0
    values = document.getObject("Dimensions")
    for name, value in brief["dimensions"].items():
        values.addProperty("App::PropertyFloat", f"d_{name}", "Dimensions", name)
        setattr(values, f"d_{name}", float(value))
    namespace: Json = {"__name__": "part", "__builtins__": __builtins__}
    exec(compile(script, FILE, "exec"), namespace)  # noqa: S102 - this is what the sandbox is for
    build = namespace.get("build")
    if not callable(build):
        raise NotAPartError("The script defines no function build(part)")
    result = build(Authoring(brief, document))
    if not (isinstance(result, (tuple, list)) and len(result) == 2):
        raise NotAPartError("The function build(part) did not return (shape, connectors)")
    body, entries = result
    if getattr(body, "TypeId", "") != "PartDesign::Body":
        raise NotAPartError(f"The shape is a {getattr(body, 'TypeId', type(body).__name__)}, not a PartDesign::Body; return part.body")
    for _ in range(2):  # the names of edges settle
        for item in document.Objects:
            item.touch()
        document.recompute()
    connectors = _connectors(entries)
    document.saveAs(SAVED)
    return connectors


def _connectors(entries: Any) -> dict[str, Json]:
    if not isinstance(entries, dict):
        raise NotAPartError(f"The connectors are a {type(entries).__name__}, not a dict")
    found: dict[str, Json] = {}
    for name, entry in entries.items():
        if getattr(entry, "TypeId", "") == "PartDesign::CoordinateSystem":
            found[str(name)[:60]] = {"object": entry.Name}
        elif isinstance(entry, dict) and {"o", "z"} <= set(entry) <= {"o", "z", "x"}:
            found[str(name)[:60]] = {key: [float(number) for number in entry[key]] for key in ("o", "z", "x") if entry.get(key) is not None}
        else:
            raise NotAPartError(f"Connector {name!r} is neither a coordinate system nor a dict with 'o', 'z' and perhaps 'x'")
    return found


def _described(error: BaseException) -> Json:
    """Return an exception as data: type, message, and the frames of the script only, outermost first."""
    frames = [(line, frame.f_code.co_name) for frame, line in traceback.walk_tb(error.__traceback__) if frame.f_code.co_filename == FILE]
    line = frames[-1][0] if frames else None
    if isinstance(error, SyntaxError) and error.filename == FILE:
        line = error.lineno
    return {
        "type": type(error).__name__[:100],
        "message": str(error)[:2000],
        "line": line,
        "frames": frames[-20:],
        "denied": isinstance(error, OSError),
        "module": error.name if isinstance(error, ImportError) else None,
        "refused": isinstance(error, (ValueError, AssertionError)),
    }


def _say(report: int, line: Json) -> None:
    os.write(report, json.dumps(line).encode() + b"\n")


main(*map(int, ARGUMENTS))  # type: ignore[name-defined]  # noqa: F821 - given by whoever starts this
