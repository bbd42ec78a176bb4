"""The operations that a traced script reports, as objects of FreeCAD's Part workbench with expressions over a VarSet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from articad.aliases import Json
from articad.connectors.se3 import SE3
from articad.kernels.failures import scrubbed
from articad.kernels.results import PoisonedError

__all__ = ["tree_objects"]

MAX_OBJECTS: Final = 1500
MAX_FORMULAS: Final = 20_000
_MAX_TEXT: Final = 240  # characters of an expression that stays where it is used
_SHORT: Final = 40  # one that is used twice and longer becomes a value of its own
_INFIX: Final = {"add": "+", "sub": "-", "mul": "*", "div": "/", "pow": "^"}
_CALLS: Final = {"abs": "abs", "min": "min", "max": "max", "sqrt": "sqrt", "hypot": "hypot", "floor": "floor", "ceil": "ceil", "mod": "mod"}
_OF_ANGLES: Final = ("sin", "cos", "tan")  # FreeCAD's take degrees
_ANGLES: Final = ("asin", "acos", "atan", "atan2")  # FreeCAD's give degrees with their unit
_OTHERS: Final = {"neg": "(-{0})", "radians": "({0} * pi / 180)", "degrees": "({0} * 180 / pi)", "floordiv": "floor({0} / {1})"}
_ARGUMENTS: Final = {"add": 2, "sub": 2, "mul": 2, "div": 2, "pow": 2, "mod": 2, "floordiv": 2, "atan2": 2, "hypot": 2, "min": 0, "max": 0}
_PRIMITIVES: Final = {
    "box": ("Part::Box", ("Length", "Width", "Height")),
    "cylinder": ("Part::Cylinder", ("Radius", "Height")),
    "cone": ("Part::Cone", ("Radius1", "Radius2", "Height")),
    "sphere": ("Part::Sphere", ("Radius",)),
    "torus": ("Part::Torus", ("Radius1", "Radius2")),
}
_NUMBERS: Final = {kind: len(names) for kind, (_, names) in _PRIMITIVES.items()} | {"prism": 1, "ring": 1, "fillet": 1, "chamfer": 1}
_OPERANDS: Final = {"fuse": 2, "cut": 2, "common": 2, "loft": 2, "fillet": 1, "chamfer": 1, "mirror": 1}


class _Formulas:
    """Formulas as FreeCAD expressions. One that is long, or long enough and used twice, becomes a value of the VarSet."""

    def __init__(self, listed: Any, dimensions: Mapping[str, float]) -> None:
        if not isinstance(listed, list) or len(listed) > MAX_FORMULAS:
            raise PoisonedError("the trace has no formulas, or too many")
        self.derived: dict[str, str] = {}
        self._dimensions, self._listed = dimensions, listed
        self._uses = [0] * len(listed)
        for place, row in enumerate(listed):
            if not isinstance(row, list) or not row or not isinstance(row[0], str):
                raise PoisonedError("a formula has the wrong form")
            for operand in row[1:]:
                if isinstance(operand, list):
                    self._uses[self._place(operand, place)] += 1
        self._texts: list[str] = []
        for place, row in enumerate(listed):
            text = self._text(row)
            if not row[0].startswith("d ") and (len(text) > _MAX_TEXT or (self._uses[place] > 1 and len(text) > _SHORT)):
                name = f"v_{len(self.derived) + 1}"
                self.derived[name] = text
                text = f"Dimensions.{name}"
            self._texts.append(text)

    def text(self, number: Any) -> str:
        """Return a number as an expression."""
        if isinstance(number, list):
            return self._texts[self._place(number, len(self._listed))]
        value = _finite(number)
        return repr(value) if value >= 0 else f"({value!r})"

    def _place(self, operand: list[Any], end: int) -> int:
        if len(operand) != 1 or type(operand[0]) is not int or not 0 <= operand[0] < end:
            raise PoisonedError("a formula names one that does not exist")
        return operand[0]

    def _text(self, row: list[Any]) -> str:
        name, operands = row[0], row[1:]
        if name.startswith("d "):
            if name[2:] not in self._dimensions or operands:
                raise PoisonedError("a formula names a dimension that the part does not have")
            return f"Dimensions.d_{name[2:]}"
        count = _ARGUMENTS.get(name, 1)
        if (count and len(operands) != count) or (not count and len(operands) < 2):
            raise PoisonedError("a formula has the wrong operands")
        words = [self.text(operand) for operand in operands]
        if name in _INFIX:
            text = f"({words[0]} {_INFIX[name]} {words[1]})"
        elif name in _CALLS:
            text = f"{_CALLS[name]}({'; '.join(words)})"
        elif name in _OF_ANGLES:
            text = f"{name}({self._inner(operands[0], ('radians',)) or f'{words[0]} * 180 / pi'})"
        elif name in _ANGLES:
            text = f"({name}({'; '.join(words)}) / 1 deg * pi / 180)"
        elif name == "degrees" and (angle := self._inner(operands[0], _ANGLES)):
            text = f"({angle} / 1 deg)"
        elif name in _OTHERS:
            text = _OTHERS[name].format(*words)
        else:
            raise PoisonedError("a formula has an unknown operation")
        return text

    def _inner(self, operand: Any, kinds: tuple[str, ...]) -> str:
        """Return the degrees inside a conversion, without the conversion; empty if the operand is none."""
        row = self._listed[operand[0]] if isinstance(operand, list) else [""]
        if row[0] not in kinds:
            return ""
        words = "; ".join(self.text(inner) for inner in row[1:])
        return words if row[0] == "radians" else f"{row[0]}({words})"


def tree_objects(rows: Any, formulas: Any, dimensions: Mapping[str, float], source: Sequence[str]) -> Json:
    """Return the objects of a tree for FreeCAD, operands first, and the derived values of its VarSet.

    Args:
        rows: Operations of a traced script; untrusted.
        formulas: The formulas that they refer to; untrusted.
        dimensions: Dimensions of the part.
        source: Lines of the script, for the descriptions of objects.

    Raises:
        PoisonedError: If something has the wrong form.
    """
    if not isinstance(rows, list) or not 0 < len(rows) <= MAX_OBJECTS or not all(isinstance(row, dict) for row in rows):
        raise PoisonedError("the trace has no operations, or too many")
    held = _Formulas(formulas, dimensions)
    writer = _Objects(held, source)
    for place, row in enumerate(rows):
        writer.add(place, row)
    writer.close()
    return {"objects": writer.objects, "derived": held.derived}


class _Objects:
    def __init__(self, formulas: _Formulas, source: Sequence[str]) -> None:
        self._formulas, self._source = formulas, source
        self.objects: list[Json] = []
        self._places: list[int] = []  # row -> its object

    def add(self, place: int, row: Json) -> None:
        """Add the objects of an operation."""
        kind, operands = row.get("kind"), row.get("operands")
        if not isinstance(kind, str):
            raise PoisonedError("an operation has no kind")
        if not isinstance(operands, list) or not all(type(operand) is int and 0 <= operand < place for operand in operands):
            raise PoisonedError("an operation has the wrong operands")
        if len(operands) < _OPERANDS.get(kind, 0):
            raise PoisonedError("an operation has too few operands")
        self._note = self._described(row.get("line"))
        numbers = _listed(row.get("numbers"))
        if len(numbers) != _NUMBERS.get(kind, 0):
            raise PoisonedError("an operation has the wrong numbers")
        make = self._made_of_operands if kind in _OPERANDS else self._made_of_numbers
        self._places.append(make(kind, [self._places[operand] for operand in operands], numbers, row))

    def close(self) -> None:
        """Wrap a last object that has a placement: the body that is based on it would ignore the placement."""
        last = self.objects[-1]
        if last["placement"] is not None or "Placement" in last["expressions"]:
            self._object("Part::Compound", "Compound", links={"Links": [len(self.objects) - 1]})

    def _made_of_operands(self, kind: str, used: list[int], numbers: list[Any], row: Json) -> int:
        """Add a union, a cut or the like, and return its place."""
        if kind == "cut":
            tool = (
                used[1] if len(used) == 2 else self._object("Part::MultiFuse", "Tools", links={"Shapes": used[1:]}, given={"Refine": False})
            )
            return self._object("Part::Cut", "Cut", links={"Base": used[0], "Tool": tool}, given={"Refine": True})
        if kind in ("fillet", "chamfer"):
            return self._dressed(kind, used[0], numbers, row.get("edges"))
        if kind == "mirror":
            return self._object("Part::Mirroring", "Mirror", links={"Source": used[0]}, vectors=self._axis(row, "Base", "Normal"))
        if kind == "loft":
            return self._object("Part::Loft", "Loft", links={"Sections": used}, given={"Solid": True, "Ruled": True})
        family = "Part::MultiFuse" if kind == "fuse" else "Part::MultiCommon"
        return self._object(family, kind.title(), links={"Shapes": used}, given={"Refine": True})

    def _made_of_numbers(self, kind: str, _: list[int], numbers: list[Any], row: Json) -> int:
        """Add a primitive, an extrusion or a revolution, and return its place."""
        if kind in _PRIMITIVES:
            family, names = _PRIMITIVES[kind]
            return self._object(family, kind.title(), placed=row, lengths=dict(zip(names, numbers, strict=True)))
        if kind == "wire":
            return self._polygon(row)
        if kind == "prism":
            return self._object(
                "Part::Extrusion",
                "Extrude",
                links={"Base": self._polygon(row)},
                given={"DirMode": "Custom", "Solid": True},
                vectors={"Dir": [line[2] for line in _turn(row)]},
                lengths={"LengthFwd": numbers[0]},
            )
        if kind not in ("revolution", "ring"):
            raise PoisonedError("the trace has an unknown operation")
        ring = kind == "ring"
        outline = self._object("Part::Circle", "Circle", placed=row, lengths={"Radius": numbers[0]}) if ring else self._polygon(row)
        axis, given = self._axis(row, "Base", "Axis"), {"Angle": 360.0, "Solid": True}
        return self._object("Part::Revolution", "Revolve", links={"Source": outline}, given=given, vectors=axis)

    def _described(self, line: Any) -> str:
        if type(line) is not int or not 0 < line <= len(self._source):
            return ""
        return f"line {line}: {scrubbed(self._source[line - 1].strip(), 120)}"

    def _polygon(self, row: Json) -> int:
        points = [_listed(point) for point in _listed(row.get("points"))]
        if len(points) < 3 or any(len(point) != 2 for point in points):
            raise PoisonedError("a polygon has the wrong corners")
        made = self._object("Part::Polygon", "Outline", placed=row, given={"Close": True})
        if all(isinstance(number, (int, float)) for point in points for number in point):
            self.objects[made]["nodes"] = [[_finite(number) for number in point] for point in points]
        else:
            corners = "; ".join(f"vector({'; '.join(self._formulas.text(number) for number in point)}; 0)" for point in points)
            self.objects[made]["expressions"]["Nodes"] = f"list({corners})"
        return made

    def _dressed(self, kind: str, base: int, numbers: list[Any], edges: Any) -> int:
        rows = [[_finite(number) for number in _listed(edge)] for edge in _listed(edges)]
        if len(numbers) != 1 or not rows or any(len(row) != 4 for row in rows):
            raise PoisonedError(f"a {kind} has the wrong edges")
        family = "Part::Fillet" if kind == "fillet" else "Part::Chamfer"
        made = self._object(family, kind.title(), links={"Base": base})
        follows = isinstance(numbers[0], list)
        self.objects[made]["edges"] = {
            "at": rows,
            "size": 1e-3 if follows else _finite(numbers[0]),
            "expression": self._formulas.text(numbers[0]) if follows else "",
        }
        return made

    def _axis(self, row: Json, *names: str) -> dict[str, list[Any]]:
        vectors = [_listed(vector) for vector in _listed(row.get("vectors"))]
        if len(vectors) != 2 or any(len(vector) != 3 for vector in vectors):
            raise PoisonedError("an axis or plane has the wrong form")
        return dict(zip(names, vectors, strict=True))

    def _object(
        self,
        family: str,
        name: str,
        *,
        placed: Json | None = None,
        links: Mapping[str, int | list[int]] | None = None,
        given: Mapping[str, Any] | None = None,
        lengths: Mapping[str, Any] | None = None,
        vectors: Mapping[str, Sequence[Any]] | None = None,
    ) -> int:
        form: Json = {
            "type": family, "name": name, "note": self._note, "set": dict(given or {}), "links": dict(links or {}),
            "expressions": {}, "placement": None, "nodes": None, "edges": None,
        }  # fmt: skip
        for key, number in (lengths or {}).items():
            if isinstance(number, list):
                form["expressions"][key] = f"({self._formulas.text(number)}) * 1 mm"
            else:
                form["set"][key] = _finite(number)
        for key, vector in (vectors or {}).items():
            if any(isinstance(number, list) for number in vector):
                form["expressions"][key] = self._vector(vector)
            else:
                form["set"][key] = [_finite(number) for number in vector]
        if placed is not None:
            self._place(form, placed)
        self.objects.append(form)
        return len(self.objects) - 1

    def _vector(self, vector: Sequence[Any]) -> str:
        return f"vector({'; '.join(map(self._formulas.text, vector))})"

    def _place(self, form: Json, row: Json) -> None:
        """Set a placement, and the expressions of those of its numbers that follow dimensions."""
        at, turn = _listed(row.get("at")), _turn(row)
        if len(at) != 3:
            raise PoisonedError("a place has the wrong form")
        if any(isinstance(number, list) for line in turn for number in line):
            x, y, z = ([line[axis] for line in turn] for axis in range(3))
            axes = "; ".join(map(self._vector, (x, y, z)))
            form["expressions"]["Placement"] = f"placement({self._vector(at)}; create(<<rotation>>; {axes}; <<ZXY>>))"
            return
        R = np.array([[_finite(number) for number in line] for line in turn])
        if not np.allclose(R @ R.T, np.eye(3), atol=1e-9) or np.linalg.det(R) < 0:
            raise PoisonedError("a place is not a rotation")
        quaternion = [float(number) for number in SE3.from_rotation(R).data[3:]]
        form["placement"] = [*(0.0 if isinstance(number, list) else _finite(number) for number in at), *quaternion]
        for axis, number in zip("xyz", at, strict=True):
            if isinstance(number, list):
                form["expressions"][f"Placement.Base.{axis}"] = f"({self._formulas.text(number)}) * 1 mm"


def _turn(row: Json) -> list[list[Any]]:
    turn = [_listed(line) for line in _listed(row.get("turn"))]
    if len(turn) != 3 or any(len(line) != 3 for line in turn):
        raise PoisonedError("a rotation has the wrong form")
    return turn


def _listed(value: Any) -> list[Any]:
    if not isinstance(value, list) or len(value) > MAX_FORMULAS:
        raise PoisonedError("the trace has something else where a list is due")
    return value


def _finite(value: Any) -> float:
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not abs(value) <= 1e9:
        raise PoisonedError("the trace has a number that is none")
    return float(value)
