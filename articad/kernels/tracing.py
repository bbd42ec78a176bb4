"""Run a part script with traced numbers and report its operations with their formulas; run it plainly at other dimensions and measure.

Untrusted code, in a confined process of its own; whoever reads the report must not trust it.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final

from build123d import Solid
from OCP.BRep import BRep_Tool
from OCP.BRepAdaptor import BRepAdaptor_Curve
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps

from articad.kernels import measure, timers
from articad.kernels.part_script import FILE, as_object, built, called, described, plain_connectors
from articad.kernels.traced_numbers import Formula, formula_of, operands_first, plain, traced, traced_builtins, traced_math
from articad.kernels.traced_shapes import Frame, NotRecordedError, TracedOperation, recorded_build123d, solid_node

__all__ = ["run"]

MAX_ROWS: Final = 1500  # operations of one part

Json = dict[str, Any]
_Number = float | list[int]  # plain, or the place of a formula


def run(
    script: str,
    part: Json,
    variations: Sequence[Sequence[Json]],
    *,
    seconds: float,
    report: Callable[[Json], None],
) -> None:
    """Report the operations of a script, then the measures of its solid at other dimensions.

    The first line of the report is `{"ok": true, "rows", "formulas", "connectors"}` or `{"ok": false, "reason"}`. Each further line has
    the solid's numbers at the first of one variation's dimensions that the script builds, its `choice`, or `"ok": false`.

    Args:
        script: The source.
        part: The brief of the part.
        variations: For each, dimensions by name, and others to try where the script does not build those.
        seconds: Processor time; see `timers.allow`.
        report: Receives each line.
    """
    timers.allow(seconds)
    try:
        told = _recorded(script, part)
    except NotRecordedError as error:
        report({"ok": False, "reason": str(error)[:300]})
        return
    except BaseException as error:  # noqa: BLE001 - a script may raise anything
        said = described(error)
        report({"ok": False, "reason": f"line {said['line']}: with traced numbers it fails: {said['type']}: {said['message']}"[:300]})
        return
    report({"ok": True} | told)
    for options in variations:
        measured: Json = {"ok": False}
        for choice, dimensions in enumerate(options):
            measured = {"choice": choice} | _measured(script, {**part, "dimensions": dimensions})
            if measured["ok"]:
                break
        report(measured)
    timers.unlimited()


def _recorded(script: str, part: Json) -> Json:
    replaced = {"build123d": recorded_build123d(), "math": traced_math()}
    before = {name: sys.modules[name] for name in replaced}
    sys.modules.update(replaced)
    try:
        namespace: Json = {"__name__": "part", "__builtins__": traced_builtins()}
        exec(compile(script, FILE, "exec"), namespace)  # noqa: S102 - this is what the sandbox is for
        dimensions = {name: traced(name, value) for name, value in part["dimensions"].items()}
        shape, connectors = called(namespace, as_object({**part, "dimensions": dimensions}))
        solid = solid_node(shape)
        writer = _Rows()
        writer.add(solid.node, solid.frame)
    finally:
        sys.modules.update(before)
    return {"rows": writer.rows, "formulas": writer.listed(), "connectors": plain_connectors(connectors, [])}


def _measured(script: str, part: Json) -> Json:
    """Return the measures of the solid that a script builds, or why it builds none."""
    try:
        namespace: Json = {"__name__": "part", "__builtins__": __builtins__}
        exec(compile(script, FILE, "exec"), namespace)  # noqa: S102 - as above
        shape, _ = built(namespace, part)
        solids = measure.solids_of(shape)
        if len(solids) != 1 or not measure.is_valid(solids[0]):
            return {"ok": False}
        return {"ok": True, "faces": len(Solid(solids[0]).clean().faces())} | measure.properties(solids[0])
    except BaseException:  # noqa: BLE001 - a script may raise anything
        return {"ok": False}


class _Rows:
    """Lists operations with every place in the part's frame, operands first."""

    def __init__(self) -> None:
        self.rows: list[Json] = []
        self._places: dict[int, int] = {}  # id of a formula -> its place
        self._kept: list[Formula] = []

    def add(self, node: TracedOperation, frame: Frame) -> int:
        """Add an operation, moved, and return its row."""
        if len(self.rows) >= MAX_ROWS:
            raise NotRecordedError(f"the script performs more than {MAX_ROWS} operations")
        if node.kind == "at":
            ((inner, place),) = node.operands
            return self.add(inner, frame * place)
        row: Json = {"kind": node.kind, "line": node.line, "numbers": self._numbers(node.numbers)}
        if node.kind in ("fuse", "cut"):
            operands = list(_chained(node, frame))
        else:
            operands = [(inner, frame * place) for inner, place in node.operands]
        row["operands"] = [self.add(inner, place) for inner, place in operands]
        if node.kind in ("fuse", "cut", "common"):
            pass
        elif node.kind in ("fillet", "chamfer"):
            row["edges"] = [_seen(edge, frame * Frame()) for edge in node.edges]
        elif node.kind == "mirror":
            point, normal = node.vectors
            row["vectors"] = [self._numbers(frame.apply(point)), self._numbers(frame.direct(normal))]
        else:
            row["at"] = self._numbers(frame.at)
            row["turn"] = [self._numbers(line) for line in frame.turn]
            row["points"] = [self._numbers(point) for point in node.points]
            if node.vectors:
                row["vectors"] = [self._numbers(frame.apply(node.vectors[0])), self._numbers(frame.direct(node.vectors[1]))]
        self.rows.append(row)
        return len(self.rows) - 1

    def listed(self) -> list[list[Any]]:
        """Return the formulas, operands first."""
        return [[formula.name, *map(self._number, formula.operands)] for formula in self._kept]

    def _numbers(self, numbers: Sequence[Any]) -> list[_Number]:
        return [self._number(formula_of(number)) for number in numbers]

    def _number(self, formula: Formula | float) -> _Number:
        if not isinstance(formula, Formula):
            return formula
        for needed in operands_first([formula]) if id(formula) not in self._places else ():
            if id(needed) not in self._places:
                self._places[id(needed)] = len(self._kept)
                self._kept.append(needed)
        return [self._places[id(formula)]]


def _chained(node: TracedOperation, frame: Frame) -> Iterator[tuple[TracedOperation, Frame]]:
    """Yield the operands of a union of unions, or of a cut of cuts."""
    (first, place), *others = node.operands
    while first.kind == "at":
        ((first, inner),) = first.operands
        place = place * inner
    if first.kind == node.kind:
        yield from _chained(first, frame * place)
    else:
        yield first, frame * place
    yield from ((other, frame * where) for other, where in others)


def _seen(edge: Any, frame: Frame) -> list[float]:
    """Return the centre [mm] and the length of a real edge, moved."""
    curve = BRepAdaptor_Curve(edge.wrapped)
    if BRep_Tool.Degenerated_s(edge.wrapped) or curve.LastParameter() <= curve.FirstParameter():
        raise NotRecordedError("an edge has no length")
    held = GProp_GProps()
    BRepGProp.LinearProperties_s(edge.wrapped, held)
    center = held.CentreOfMass()
    return [*(float(plain(number)) for number in frame.apply((center.X(), center.Y(), center.Z()))), held.Mass()]
