"""build123d for a traced run: constructors and operations that record what they do, over traced numbers.

A recorded shape is a tree of operations, each with its place; a real one is made of plain numbers only where the script asks for its edges
or its size. Sketches stay trees of outlines: the extrusion of a union is the union of the extrusions. What is not recorded raises
`NotRecordedError` with its name and line.
"""

from __future__ import annotations

import enum
import math
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import ModuleType
from typing import Any, Final

import build123d as real

from articad.kernels.part_script import FILE
from articad.kernels.traced_numbers import plain, traced_math, without_dust

__all__ = ["NotRecordedError", "TracedOperation", "TracedShape", "flat", "recorded_build123d", "solid_node"]

_math: Final[Any] = traced_math()
_PASSED: Final = ("Align", "Axis", "Mode", "ShapeList", "Vector")  # used as they are
_IDENTITY: Final = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class NotRecordedError(Exception):
    """The script does something that is not recorded."""


def _line() -> int:
    """Return the line of the script that is being run."""
    frame: Any = sys._getframe(1)  # noqa: SLF001 - the documented way to the caller's frame
    while frame is not None and frame.f_code.co_filename != FILE:
        frame = frame.f_back
    return 0 if frame is None else int(frame.f_lineno)


def _refused(what: str) -> NotRecordedError:
    return NotRecordedError(f"line {_line()}: {what} is not recorded")


# ---------------------------------------------------------------------- places


class Frame:
    """A rigid motion: `turn (3, 3)` as rows, `at (3,)`, of traced or plain numbers [mm]."""

    def __init__(self, turn: Sequence[Sequence[Any]] = _IDENTITY, at: Sequence[Any] = (0.0, 0.0, 0.0)) -> None:
        self.turn = tuple(tuple(map(without_dust, row)) for row in turn)
        self.at = tuple(at)

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Frame):
            return self._then(other)
        if isinstance(other, TracedShape):
            return other.moved(self)
        if isinstance(other, (list, tuple)):
            return [self * item for item in other]
        return NotImplemented

    def apply(self, point: Sequence[Any]) -> tuple[Any, ...]:
        """Return a point moved by this motion."""
        return tuple(_dot(row, point) + offset for row, offset in zip(self.turn, self.at, strict=True))

    def direct(self, direction: Sequence[Any]) -> tuple[Any, ...]:
        """Return a direction turned by this motion."""
        return tuple(_dot(row, direction) for row in self.turn)

    @property
    def real(self) -> Any:
        """The motion as build123d's location."""
        columns = list(zip(*self.turn, strict=True))
        x, z = (tuple(map(plain, column)) for column in (columns[0], columns[2]))
        return real.Plane(tuple(map(plain, self.at)), x_dir=x, z_dir=z).location

    @property
    def x_dir(self) -> tuple[Any, ...]:
        """The x axis."""
        return tuple(row[0] for row in self.turn)

    @property
    def y_dir(self) -> tuple[Any, ...]:
        """The y axis."""
        return tuple(row[1] for row in self.turn)

    @property
    def z_dir(self) -> tuple[Any, ...]:
        """The z axis."""
        return tuple(row[2] for row in self.turn)

    @property
    def origin(self) -> tuple[Any, ...]:
        """The origin."""
        return self.at

    position = origin

    @property
    def location(self) -> Frame:
        """The plane as a location."""
        return self

    def inverse(self) -> Frame:
        """Return the inverse motion."""
        back = Frame(list(zip(*self.turn, strict=True)))
        return Frame(back.turn, tuple(-number for number in back.apply(self.at)))

    def offset(self, amount: Any) -> Frame:
        """Return a plane moved along its normal."""
        return self._then(Frame(at=(0.0, 0.0, amount)))

    def moved(self, other: Frame) -> Frame:
        """Return this plane moved in its own frame."""
        return self._then(other)

    def rotated(self, angles: Sequence[Any] = (0, 0, 0)) -> Frame:
        """Return this plane turned in its own frame."""
        return self._then(rotation(*angles))

    def _then(self, other: Frame) -> Frame:
        columns = list(zip(*other.turn, strict=True))
        return Frame([[_dot(row, column) for column in columns] for row in self.turn], self.apply(other.at))

    def __getattr__(self, name: str) -> Any:
        raise _refused(f"{name!r} of a plane or location")


def _dot(a: Iterable[Any], b: Iterable[Any]) -> Any:
    terms = [x * y for x, y in zip(a, b, strict=True)]
    return terms[0] + terms[1] + terms[2]


def _cross(a: Sequence[Any], b: Sequence[Any]) -> tuple[Any, ...]:
    return tuple(a[i] * b[j] - a[j] * b[i] for i, j in ((1, 2), (2, 0), (0, 1)))


def _unit(vector: Sequence[Any]) -> tuple[Any, ...]:
    if sum(number != 0 for number in vector) == 1 and not any(hasattr(number, "formula") for number in vector):
        return tuple(math.copysign(1.0, number) if number else 0.0 for number in vector)
    length = _math.sqrt(_dot(vector, vector))
    return tuple(number / length for number in vector)


def _three(value: Any) -> tuple[Any, ...]:
    numbers = tuple(value) if not isinstance(value, real.Vector) else (value.X, value.Y, value.Z)
    return (*numbers, *(0.0,) * (3 - len(numbers)))


def position(*args: Any, **kwargs: Any) -> Frame:
    """Record build123d's `Pos`."""
    given = _three(args[0]) if len(args) == 1 and not isinstance(args[0], (int, float)) else _three(args)
    return Frame(at=tuple(kwargs.pop(axis, number) for axis, number in zip("XYZ", given, strict=True)))


def _turned(axis: int, degrees: Any) -> Frame:
    if not hasattr(degrees, "formula") and degrees == 0:
        return Frame()
    angle = _math.radians(degrees)
    c, s = _math.cos(angle), _math.sin(angle)
    a, b = (axis + 1) % 3, (axis + 2) % 3
    rows = [list(row) for row in _IDENTITY]
    rows[a][a], rows[a][b], rows[b][a], rows[b][b] = c, -s, s, c
    return Frame(rows)


def rotation(*args: Any, **kwargs: Any) -> Frame:
    """Record build123d's `Rot` and `Rotation`: turns about x, then the new y, then the new z [deg]."""
    if len(args) == 1 and isinstance(args[0], (tuple, list)):
        args = tuple(args[0])
    if len(args) == 1 and isinstance(args[0], Frame):
        return args[0]
    if set(kwargs) - {"X", "Y", "Z"} or not all(isinstance(number, (int, float)) for number in args):
        raise _refused("this form of a rotation")
    x, y, z = (kwargs.pop(axis, number) for axis, number in zip("XYZ", _three(args), strict=True))
    turned: Frame = _turned(0, x) * _turned(1, y) * _turned(2, z)
    return turned


def location(*args: Any, **kwargs: Any) -> Frame:
    """Record build123d's `Location`."""
    if kwargs or len(args) > 2:
        raise _refused("this form of a location")
    if args and isinstance(args[0], Frame):
        return args[0]
    turned = Frame() if len(args) < 2 else rotation(*args[1]) if isinstance(args[1], (tuple, list)) else _turned(2, args[1])
    placed: Frame = (position(args[0]) if args else Frame()) * turned
    return placed


class PlaneType:
    """Record build123d's `Plane`."""

    def __call__(self, origin: Any = (0, 0, 0), x_dir: Any = None, z_dir: Any = (0, 0, 1)) -> Frame:
        """Return a plane from its origin and directions."""
        if isinstance(origin, Frame):
            return origin
        if isinstance(origin, (TracedShape, Picks)):
            raise _refused("a plane on a face")
        z = _unit(_three(z_dir))
        x = _unit(_three(x_dir)) if x_dir is not None else self._right(z)
        y = _cross(z, x)
        return Frame(list(zip(x, y, z, strict=True)), _three(origin))

    @staticmethod
    def _right(z: Sequence[Any]) -> tuple[Any, ...]:
        """Return the x direction that OCCT chooses for a normal (gp_Ax2): a quarter turn of z in one of the coordinate planes."""
        a, b, c = z
        held = real.Plane((0, 0, 0), z_dir=tuple(map(plain, z))).x_dir
        for choice in ((-c, 0.0, a), (c, 0.0, -a), (0.0, -c, b), (0.0, c, -b), (-b, a, 0.0), (b, -a, 0.0)):
            if any(choice):
                right = _unit(choice)
                if all(abs(plain(mine) - theirs) < 1e-9 for mine, theirs in zip(right, (held.X, held.Y, held.Z), strict=True)):
                    return right
        raise _refused("the x direction of this plane")

    def __getattr__(self, name: str) -> Frame:
        held = getattr(real.Plane, name)
        if not isinstance(held, real.Plane):
            raise _refused(f"Plane.{name}")
        axes = [(axis.X, axis.Y, axis.Z) for axis in (held.x_dir, held.y_dir, held.z_dir)]
        return Frame(list(zip(*axes, strict=True)))


class _Places(list[Frame]):
    """Several places: times a shape gives the shape at each."""

    def __mul__(self, other: Any) -> Any:
        return [place * other for place in self]

    @property
    def locations(self) -> list[Frame]:
        """The places."""
        return list(self)


def polar_locations(
    radius: Any, count: int, start_angle: Any = 0.0, angular_range: Any = 360.0, rotate: bool = True, endpoint: bool = False
) -> _Places:
    """Record build123d's `PolarLocations`."""
    step = 0.0 if count == 1 else angular_range / (count - int(endpoint))
    places = _Places()
    for number in range(count):
        turned = _turned(2, start_angle + step * number)
        places.append(turned * Frame(at=(radius, 0.0, 0.0)) * (Frame() if rotate else turned.inverse()))
    return places


def grid_locations(x_spacing: Any, y_spacing: Any, x_count: int, y_count: int) -> _Places:
    """Record build123d's `GridLocations`, centred."""
    return _Places(
        Frame(at=((column - (x_count - 1) / 2) * x_spacing, (row - (y_count - 1) / 2) * y_spacing, 0.0))
        for column in range(x_count)
        for row in range(y_count)
    )


def locations(*places: Any) -> _Places:
    """Record build123d's `Locations`."""
    rows = places[0] if len(places) == 1 and isinstance(places[0], list) else places
    return _Places(row if isinstance(row, Frame) else position(row) for row in rows)


# ---------------------------------------------------------------------- shapes


@dataclass(frozen=True, eq=False)
class TracedOperation:
    """An operation: its kind, its numbers, its operands with their places, the line that ordered it, and what else it needs."""

    kind: str
    numbers: tuple[Any, ...] = ()
    operands: tuple[tuple[TracedOperation, Frame], ...] = ()
    line: int = 0
    points: tuple[tuple[Any, Any], ...] = ()
    edges: tuple[Any, ...] = ()  # real edges, of a fillet or chamfer
    vectors: tuple[tuple[Any, ...], ...] = ()
    ruled: bool = False


@dataclass(eq=False)
class TracedShape:
    """A recorded shape: `dimension` 3 for solids, 2 for sketches, 1 for lines; `make` gives the real one without its place."""

    dimension: int
    node: TracedOperation
    make: Callable[[], Any] = field(repr=False)
    frame: Frame = field(default_factory=Frame)

    @cached_property
    def real(self) -> Any:
        """The real shape, of plain numbers."""
        return self.frame.real * self.make()

    def moved(self, frame: Frame) -> TracedShape:
        """Return the shape moved."""
        return TracedShape(self.dimension, self.node, self.make, frame * self.frame)

    def translate(self, vector: Any) -> TracedShape:
        """Return the shape shifted."""
        return self.moved(Frame(at=_three(vector)))

    def __add__(self, other: Any) -> TracedShape:
        return self._with("fuse", other, lambda a, b: a + b)

    def __radd__(self, other: Any) -> TracedShape:
        if other is None or (isinstance(other, (int, list)) and not other):
            return self
        return _fused(other) + self

    def __sub__(self, other: Any) -> TracedShape:
        return self._with("cut", other, lambda a, b: a - b)

    def __and__(self, other: Any) -> TracedShape:
        return self._with("common", other, lambda a, b: a & b)

    def _with(self, kind: str, other: Any, operation: Callable[[Any, Any], Any]) -> TracedShape:
        others = list(flat(other))
        if not others:
            return self
        if any(item.dimension != self.dimension for item in others):
            raise _refused("an operation of a solid with a sketch")
        node = TracedOperation(kind, operands=tuple((item.node, item.frame) for item in (self, *others)), line=_line())
        return TracedShape(self.dimension, node, lambda: operation(self.real, [item.real for item in others]))

    def edges(self, *args: Any) -> Picks:
        """Return the real edges."""
        return Picks(self, self.real.edges(*args))

    def faces(self, *args: Any) -> Picks:
        """Return the real faces."""
        return Picks(self, self.real.faces(*args))

    def vertices(self, *args: Any) -> Picks:
        """Return the real corners."""
        return Picks(self, self.real.vertices(*args))

    def __getattr__(self, name: str) -> Any:
        if name in ("volume", "area", "bounding_box", "center"):  # measured: what is made of it no longer follows
            return getattr(self.real, name)
        if name in ("part", "sketch"):
            return self
        raise _refused(f"{name!r} of a shape")


class Picks:
    """Real edges, faces or corners of a recorded shape, as the script selects them."""

    def __init__(self, owner: TracedShape, held: Any) -> None:
        self.owner, self.held = owner, held

    def _wrapped(self, value: Any) -> Any:
        if isinstance(value, (real.ShapeList, real.Edge, real.Face, real.Vertex)) or hasattr(value, "groups"):
            return Picks(self.owner, value)
        return value

    def __getattr__(self, name: str) -> Any:
        value = getattr(self.held, name)
        if not callable(value):
            return self._wrapped(value)
        return lambda *args, **kwargs: self._wrapped(
            value(*(item.held if isinstance(item, Picks) else item for item in plain(list(args))), **kwargs)
        )

    def __getitem__(self, key: Any) -> Any:
        return self._wrapped(self.held[key])

    def __iter__(self) -> Iterator[Any]:
        return (self._wrapped(item) for item in self.held)

    def __len__(self) -> int:
        return len(self.held)

    def _joined(self, other: Any, *, before: bool = False) -> Picks:
        rows = [item.held if isinstance(item, Picks) else item for item in ([other] if isinstance(other, Picks) else other)]
        mine = list(self.held) if isinstance(self.held, (list, tuple)) else [self.held]
        theirs = [shape for row in rows for shape in (row if isinstance(row, (list, tuple)) else [row])]
        return Picks(self.owner, real.ShapeList(theirs + mine if before else mine + theirs))

    def __add__(self, other: Any) -> Picks:
        return self._joined(other)

    def __radd__(self, other: Any) -> Picks:
        return self._joined(other, before=True)

    def __or__(self, other: Any) -> Picks:
        return Picks(self.owner, self.held | plain(other))

    def __lt__(self, other: Any) -> Picks:
        return Picks(self.owner, self.held < other)

    def __gt__(self, other: Any) -> Picks:
        return Picks(self.owner, self.held > other)

    def __rshift__(self, other: Any) -> Picks:
        return Picks(self.owner, self.held >> other)

    def __lshift__(self, other: Any) -> Picks:
        return Picks(self.owner, self.held << other)

    def each(self) -> list[Any]:
        """Return the real shapes."""
        return list(self.held) if isinstance(self.held, (list, tuple)) else [self.held]


def flat(value: Any) -> Iterator[TracedShape]:
    """Yield the recorded shapes of a value: one, or nested lists.

    Raises:
        NotRecordedError: If something else is among them.
    """
    if isinstance(value, TracedShape):
        yield value
    elif isinstance(value, (list, tuple)):
        for item in value:
            yield from flat(item)
    elif value is not None:
        raise _refused(f"a shape of type {type(value).__name__}")


def _fused(value: Any) -> TracedShape:
    shapes = list(flat(value))
    if not shapes:
        raise _refused("a shape without anything")
    return shapes[0] + shapes[1:] if len(shapes) > 1 else shapes[0]


def _aligned(align: Any, low: Sequence[Any], high: Sequence[Any]) -> tuple[Any, ...]:
    """Return the shift that aligns a box from `low` to `high`; where `low` is None, it is the opposite of `high`."""
    words = tuple(align) if isinstance(align, (tuple, list)) else (align,) * len(low)
    return tuple(_shift(word, a, b) for word, a, b in zip(words, low, high, strict=True))


def _shift(word: Any, low: Any, high: Any) -> Any:
    if word == real.Align.MAX:
        return -high
    if word == real.Align.MIN:
        return high if low is None else -low
    return 0.0 if low is None or word != real.Align.CENTER else -(low + high) / 2


_MIDDLE: Final = (real.Align.CENTER,) * 3


def _primitive(
    kind: str, numbers: tuple[Any, ...], low: Sequence[Any], high: Sequence[Any], align: Any, turned: Any, make: Callable[..., Any]
) -> TracedShape:
    """Record a solid: with its corner or centre where it stands by nature, aligned, then turned."""
    frame = (turned if isinstance(turned, Frame) else rotation(*turned)) * Frame(at=_aligned(align, low, high))
    node = TracedOperation(kind, tuple(numbers), line=_line())
    return TracedShape(3, node, lambda: make(*map(plain, numbers), align=None), frame)


def box(length: Any, width: Any, height: Any, rotation: Any = (0, 0, 0), align: Any = _MIDDLE) -> TracedShape:
    """Record build123d's `Box`."""
    return _primitive("box", (length, width, height), (0.0, 0.0, 0.0), (length, width, height), align, rotation, real.Box)


def cylinder(radius: Any, height: Any, arc_size: Any = 360, rotation: Any = (0, 0, 0), align: Any = _MIDDLE) -> TracedShape:
    """Record build123d's `Cylinder`."""
    if arc_size != 360:
        raise _refused("a part of a cylinder")
    return _primitive("cylinder", (radius, height), (None, None, 0.0), (radius, radius, height), align, rotation, real.Cylinder)


def cone(
    bottom_radius: Any, top_radius: Any, height: Any, arc_size: Any = 360, rotation: Any = (0, 0, 0), align: Any = _MIDDLE
) -> TracedShape:
    """Record build123d's `Cone`."""
    if arc_size != 360:
        raise _refused("a part of a cone")
    wide = bottom_radius if plain(bottom_radius) >= plain(top_radius) else top_radius
    return _primitive("cone", (bottom_radius, top_radius, height), (None, None, 0.0), (wide, wide, height), align, rotation, real.Cone)


def sphere(radius: Any, *parts: Any, rotation: Any = (0, 0, 0), align: Any = _MIDDLE) -> TracedShape:
    """Record build123d's `Sphere`."""
    if parts:
        raise _refused("a part of a sphere")
    return _primitive("sphere", (radius,), (None,) * 3, (radius,) * 3, align, rotation, real.Sphere)


def torus(major_radius: Any, minor_radius: Any, *parts: Any, rotation: Any = (0, 0, 0), align: Any = _MIDDLE) -> TracedShape:
    """Record build123d's `Torus`."""
    if parts:
        raise _refused("a part of a torus")
    wide = (major_radius + minor_radius, major_radius + minor_radius, minor_radius)
    return _primitive("torus", (major_radius, minor_radius), (None,) * 3, wide, align, rotation, real.Torus)


# ---------------------------------------------------------------------- sketches


def _outline(node: TracedOperation, frame: Frame, make: Callable[[], Any]) -> TracedShape:
    return TracedShape(2, node, make, frame)


def circle(radius: Any, align: Any = (real.Align.CENTER,) * 2) -> TracedShape:
    """Record build123d's `Circle`."""
    x, y = _aligned(align, (None,) * 2, (radius,) * 2)
    return _outline(TracedOperation("circle", (radius,), line=_line()), Frame(at=(x, y, 0.0)), lambda: real.Circle(plain(radius)))


def rectangle(width: Any, height: Any, rotation: Any = 0, align: Any = (real.Align.CENTER,) * 2) -> TracedShape:
    """Record build123d's `Rectangle`."""
    x, y = _aligned(align, (None,) * 2, (width / 2, height / 2))
    frame = _turned(2, rotation) * Frame(at=(x, y, 0.0))
    return _outline(TracedOperation("rectangle", (width, height), line=_line()), frame, lambda: real.Rectangle(plain(width), plain(height)))


def polygon(*points: Any, rotation: Any = 0, align: Any = None) -> TracedShape:
    """Record build123d's `Polygon`; its face looks down if the points run clockwise."""
    rows = points[0] if len(points) == 1 and isinstance(points[0], (list, tuple)) and isinstance(points[0][0], (list, tuple)) else points
    held = [_three(point)[:2] for point in rows]
    if len(held) > 1 and plain(held[0]) == plain(held[-1]):
        held = held[:-1]
    ends = [(min((point[axis] for point in held), key=plain), max((point[axis] for point in held), key=plain)) for axis in (0, 1)]
    x, y = _aligned(align, *zip(*ends, strict=True))
    frame = _turned(2, rotation) * Frame(at=(x, y, 0.0))
    return _outline(TracedOperation("polygon", points=tuple(held), line=_line()), frame, lambda: real.Polygon(*plain(held), align=None))


def regular_polygon(
    radius: Any, side_count: int, major_radius: bool = True, rotation: Any = 0, align: Any = (real.Align.CENTER,) * 2
) -> TracedShape:
    """Record build123d's `RegularPolygon`."""
    count = plain(side_count)
    reach = radius if major_radius else radius / math.cos(math.pi / count)
    turn = _math.radians(rotation)
    points = [(reach * _math.cos(turn + 2 * math.pi * n / count), reach * _math.sin(turn + 2 * math.pi * n / count)) for n in range(count)]
    words = align if isinstance(align, (tuple, list)) else (align, align)
    if all(word == real.Align.CENTER for word in words):  # about its own centre, not that of its box
        return polygon(*points)
    return polygon(*points, align=align)


def slot_center_to_center(center_separation: Any, height: Any, rotation: Any = 0) -> TracedShape:
    """Record build123d's `SlotCenterToCenter`: a rectangle and a circle at each of its ends."""
    x, radius = center_separation / 2, height / 2
    made = rectangle(center_separation, height) + [Frame(at=(side * x, 0.0, 0.0)) * circle(radius) for side in (-1, 1)]
    return made.moved(_turned(2, rotation))


def slot_overall(width: Any, height: Any, rotation: Any = 0, align: Any = None) -> TracedShape:
    """Record build123d's `SlotOverall`."""
    if align is not None and any(word != real.Align.CENTER for word in (align if isinstance(align, (tuple, list)) else (align,))):
        raise _refused("a slot that is not centred")
    return slot_center_to_center(width - height, height, rotation)


def rectangle_rounded(width: Any, height: Any, radius: Any, rotation: Any = 0, align: Any = None) -> TracedShape:
    """Record build123d's `RectangleRounded`: two rectangles and a circle at each corner."""
    if align is not None and any(word != real.Align.CENTER for word in (align if isinstance(align, (tuple, list)) else (align,))):
        raise _refused("a rounded rectangle that is not centred")
    x, y = width / 2 - radius, height / 2 - radius
    corners = [Frame(at=(a * x, b * y, 0.0)) * circle(radius) for a in (-1, 1) for b in (-1, 1)]
    return _fused([rectangle(2 * x, height), rectangle(width, 2 * y), *corners]).moved(_turned(2, rotation))


def make_hull(edges: Any) -> TracedShape:
    """Record build123d's `make_hull` of circles, rectangles and polygons in one plane.

    The hull is the polygon through the points where its straight sides touch, and the circles. The side from circle i to circle j, which
    runs counter-clockwise about both, touches each at the angle φ - acos((r_i - r_j)/|c_j - c_i|), where φ is the direction from c_i to c_j.
    """
    owners: list[TracedShape] = []
    for pick in [edges] if isinstance(edges, Picks) else edges:
        if not isinstance(pick, Picks) or pick.owner.dimension != 2:
            raise _refused("a hull of these edges")
        if not any(pick.owner is owner for owner in owners):
            owners.append(pick.owner)
    rounds: list[tuple[Any, Any, Any]] = []
    for owner in owners:
        node, frame = owner.node, owner.frame
        if node.kind == "circle":
            rounds.append((*frame.apply((0.0, 0.0, 0.0))[:2], node.numbers[0]))
        elif node.kind in ("rectangle", "polygon"):
            rounds += [(*frame.apply((*point, 0.0))[:2], 0.0) for point in _corners(node)]
        else:
            raise _refused(f"a hull of a {node.kind}")
    order = _hull_order([plain(row) for row in rounds])
    points: list[tuple[Any, Any]] = []
    for (x, y, r), (u, v, s) in zip(order_of(rounds, order), order_of(rounds, [*order[1:], order[0]]), strict=True):
        length, along = _math.hypot(u - x, v - y), _math.atan2(v - y, u - x)
        angle = along - _math.acos((r - s) / length)
        c, n = _math.cos(angle), _math.sin(angle)
        points += [(x + r * c, y + r * n), (u + s * c, v + s * n)]
    kept = [point for number, point in enumerate(points) if math.dist(plain(point), plain(points[number - 1])) > 1e-9]
    made = polygon(*kept)
    discs = [Frame(at=(x, y, 0.0)) * circle(r) for x, y, r in order_of(rounds, order) if plain(r) > 0]
    return made + discs if discs else made


def order_of(rows: Sequence[Any], order: Sequence[int]) -> list[Any]:
    """Return rows in an order."""
    return [rows[place] for place in order]


def _hull_order(rounds: Sequence[Sequence[float]]) -> list[int]:
    """Return the circles that touch the hull, counter-clockwise: the farthest along each of many directions."""
    order: list[int] = []
    for step in range(7200):
        angle = math.pi * step / 3600
        c, s = math.cos(angle), math.sin(angle)
        best = max(range(len(rounds)), key=lambda place: rounds[place][0] * c + rounds[place][1] * s + rounds[place][2])
        if not order or order[-1] != best:
            order.append(best)
    if len(order) > 1 and order[0] == order[-1]:
        order.pop()
    if len(set(order)) != len(order) or len(order) < 2:
        raise _refused("a hull of circles inside each other")
    return order


def _corners(node: TracedOperation) -> list[tuple[Any, Any]]:
    if node.kind == "polygon":
        return list(node.points)
    x, y = node.numbers[0] / 2, node.numbers[1] / 2
    return [(-x, -y), (x, -y), (x, y), (-x, y)]


def polyline(*points: Any, close: bool = False) -> TracedShape:
    """Record build123d's `Polyline`."""
    rows = points[0] if len(points) == 1 and isinstance(points[0], (list, tuple)) else points
    held = [_three(point)[:2] for point in rows]
    held += [held[0]] if close else []
    return TracedShape(1, TracedOperation("line", points=tuple(held), line=_line()), lambda: real.Polyline(*plain(held)))


def make_face(edges: Any) -> TracedShape:
    """Record build123d's `make_face` of a closed polyline."""
    lines = list(flat(edges))
    if len(lines) != 1 or lines[0].dimension != 1 or lines[0].node.kind != "line":
        raise _refused("make_face of anything but one polyline")
    points = lines[0].node.points
    if math.dist(plain(points[0]), plain(points[-1])) > 1e-9:
        raise _refused("make_face of an open polyline")
    area = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(plain(list(points)), plain(list(points[1:])), strict=False))
    made = polygon(*(points[:-1] if area > 0 else points[:0:-1]))  # build123d turns a face that looks down
    return made.moved(lines[0].frame)


# ---------------------------------------------------------------------- solids of sketches


def extrude(to_extrude: Any = None, amount: Any = None, both: bool = False, **other: Any) -> TracedShape:
    """Record build123d's `extrude` along the normal of a sketch."""
    if amount is None or other or isinstance(to_extrude, Picks):
        raise _refused("this form of extrude")
    sketch = _fused(to_extrude)
    if sketch.dimension != 2:
        raise _refused("an extrusion of anything but a sketch")
    normal = sketch.real.faces()[0].normal_at()
    low, high = (-amount, amount) if both else (0.0, amount)
    if plain(amount) < 0:
        low, high = high, low
    node = _extruded(sketch.node, sketch.frame, (normal.X, normal.Y, normal.Z), low, high, _line())
    return TracedShape(3, node, lambda: real.extrude(sketch.real, plain(amount), both=both))


def _extruded(node: TracedOperation, frame: Frame, normal: Sequence[float], low: Any, high: Any, line: int) -> TracedOperation:
    """Return the solid of an outline between two heights along a normal, as an operation with the place inside."""
    if node.operands:
        held = tuple((_extruded(inner, frame * place, normal, low, high, line), Frame()) for inner, place in node.operands)
        return TracedOperation(node.kind, operands=held, line=line)
    side = plain(_dot(frame.z_dir, normal))
    if abs(abs(side) - 1.0) > 1e-6:
        raise _refused("an extrusion of outlines in different planes")
    height, start = high - low, low if side > 0 else -high
    if node.kind == "circle":
        made, place = TracedOperation("cylinder", (node.numbers[0], height), line=line), Frame(at=(0.0, 0.0, start))
    elif node.kind == "rectangle":
        width, depth = node.numbers
        made, place = TracedOperation("box", (width, depth, height), line=line), Frame(at=(-width / 2, -depth / 2, start))
    else:
        made, place = TracedOperation("prism", (height,), points=node.points, line=line), Frame(at=(0.0, 0.0, start))
    return TracedOperation("at", operands=((made, frame * place),))


def revolve(profiles: Any = None, axis: Any = real.Axis.Z, revolution_arc: Any = 360.0) -> TracedShape:
    """Record build123d's full `revolve` about an axis."""
    sketch = _fused(profiles)
    if revolution_arc != 360 or sketch.dimension != 2:
        raise _refused("this form of revolve")
    base, direction = axis.position, axis.direction
    vectors = ((base.X, base.Y, base.Z), (direction.X, direction.Y, direction.Z))
    node = _revolved(sketch.node, sketch.frame, vectors, _line())
    return TracedShape(3, node, lambda: real.revolve(sketch.real, axis))


def _revolved(node: TracedOperation, frame: Frame, vectors: tuple[tuple[Any, ...], ...], line: int) -> TracedOperation:
    if node.operands:
        return TracedOperation(
            node.kind,
            operands=tuple((_revolved(inner, frame * place, vectors, line), Frame()) for inner, place in node.operands),
            line=line,
        )
    back = frame.inverse()
    local = (back.apply(vectors[0]), back.direct(vectors[1]))
    kind, numbers, points = ("ring", node.numbers, ()) if node.kind == "circle" else ("revolution", (), tuple(_corners(node)))
    return TracedOperation("at", operands=((TracedOperation(kind, numbers, points=points, vectors=local, line=line), frame),))


def loft(sections: Any = None, ruled: bool = False) -> TracedShape:
    """Record build123d's ruled `loft` of polygons and rectangles."""
    held = list(flat(sections))
    if not ruled or len(held) < 2 or any(row.dimension != 2 or row.node.kind not in ("polygon", "rectangle") for row in held):
        raise _refused("a loft of anything but polygons with straight faces")
    sides = tuple((TracedOperation("wire", points=tuple(_corners(row.node)), line=row.node.line), row.frame) for row in held)
    return TracedShape(
        3, TracedOperation("loft", operands=sides, line=_line(), ruled=True), lambda: real.loft([row.real for row in held], ruled=True)
    )


def mirror(objects: Any = None, about: Any = None) -> TracedShape:
    """Record build123d's `mirror` of a solid about a plane."""
    shape, plane = _fused(objects), about if about is not None else PlaneType().XZ
    if shape.dimension != 3 or not isinstance(plane, Frame):
        raise _refused("a mirror image of anything but a solid about a plane")
    node = TracedOperation("mirror", operands=((shape.node, shape.frame),), vectors=(plane.at, plane.z_dir), line=_line())
    x, z, o = (tuple(map(plain, row)) for row in (plane.x_dir, plane.z_dir, plane.at))
    return TracedShape(3, node, lambda: real.mirror(shape.real, real.Plane(o, x_dir=x, z_dir=z)))


def fillet(objects: Any, radius: Any) -> TracedShape:
    """Record build123d's `fillet` of edges of a solid."""
    return _dressed("fillet", objects, radius, lambda edges: real.fillet(edges, plain(radius)))


def chamfer(objects: Any, length: Any, length2: Any = None, angle: Any = None, reference: Any = None) -> TracedShape:
    """Record build123d's `chamfer` of edges of a solid, as wide on both sides."""
    if length2 is not None or angle is not None or reference is not None:
        raise _refused("a chamfer with two sizes")
    return _dressed("chamfer", objects, length, lambda edges: real.chamfer(edges, plain(length)))


def _dressed(kind: str, objects: Any, size: Any, make: Callable[[Any], Any]) -> TracedShape:
    picks = [objects] if isinstance(objects, Picks) else list(objects)
    if not picks or not all(isinstance(pick, Picks) for pick in picks) or any(pick.owner is not picks[0].owner for pick in picks):
        raise _refused(f"a {kind} of these edges")
    owner, edges = picks[0].owner, [edge for pick in picks for edge in pick.each()]
    if owner.dimension != 3 or not all(isinstance(edge, real.Edge) for edge in edges):
        raise _refused(f"a {kind} of corners")
    node = TracedOperation(kind, (size,), ((owner.node, owner.frame),), _line(), edges=tuple(edges))
    return TracedShape(3, node, lambda: make(edges))


def solid_node(value: Any) -> TracedShape:
    """Return the one recorded solid that a script returned.

    Raises:
        NotRecordedError: If it is none.
    """
    shape = _fused(value)
    if shape.dimension != 3:
        raise NotRecordedError("the part is not a solid")
    return shape


def recorded_build123d() -> ModuleType:
    """Return the module `build123d` for a traced script."""
    recorded: dict[str, Any] = {
        "Box": box, "Cylinder": cylinder, "Cone": cone, "Sphere": sphere, "Torus": torus, "Pos": position, "Rot": rotation,
        "Rotation": rotation, "Location": location, "Plane": PlaneType(), "PolarLocations": polar_locations,
        "GridLocations": grid_locations, "Locations": locations, "Circle": circle, "Rectangle": rectangle,
        "RectangleRounded": rectangle_rounded, "Polygon": polygon, "RegularPolygon": regular_polygon, "SlotOverall": slot_overall,
        "SlotCenterToCenter": slot_center_to_center, "Polyline": polyline, "make_face": make_face, "make_hull": make_hull,
        "extrude": extrude, "revolve": revolve, "loft": loft, "mirror": mirror, "fillet": fillet, "chamfer": chamfer,
    }  # fmt: skip
    module = ModuleType("build123d")
    for name in dir(real):
        held = getattr(real, name)
        if name.startswith("_") or isinstance(held, ModuleType):
            continue
        passed = name in _PASSED or not callable(held) or (isinstance(held, type) and issubclass(held, enum.Enum))
        setattr(module, name, recorded.get(name, held if passed else _not_recorded(name)))
    module.__dict__["__all__"] = [name for name in real.__all__ if hasattr(module, name)]
    return module


def _not_recorded(name: str) -> Callable[..., Any]:
    def call(*_: Any, **__: Any) -> Any:
        raise _refused(name)

    return call
