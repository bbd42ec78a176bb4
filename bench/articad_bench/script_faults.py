"""Mistakes in part scripts, by rule: in the source (dimensions, cuts, extrusions), or in what `build` returns (shape, connectors)."""

from __future__ import annotations

import ast
import copy
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from typing import Final

from articad_bench.faulty import Kind, Product, Site
from articad_bench.plan_faults import APART, CLASH, HELD, PLACE, SIZE

__all__ = ["SCRIPT_KINDS", "edited", "left_out", "makes_shape"]

_UNUSED: Final = frozenset({"W_DIMENSION_UNUSED"})
_BROKEN: Final = frozenset({"E_SCRIPT_ERROR", "E_NO_BUILD"})
_SHAPE: Final = SIZE | PLACE | CLASH | APART | HELD | _UNUSED
_CLEARANCES: Final = ("clearance", "play", "gap")

# The script's own `build` is kept, and what it returns is changed.
_WRAPPED: Final = """

import build123d as _b

_as_ordered = build


def build(part):
    shape, connectors = _as_ordered(part)
    {statement}
    return shape, connectors
"""


def _sites(product: Product, part: str, said: str, sources: Iterable[Callable[[], str]]) -> Iterator[Site]:
    joints = {joint["name"] for joint in product.plan["joints"] if part in {joint[end].split(".")[0] for end in ("parent", "child")}}
    copies = {one["name"] for one in product.plan["parts"] if one.get("derive", {}).get("from") == part}
    for source in sources:
        yield Site(f"{part}.py: {said}", frozenset({part, *copies, *joints}), script=(part, source))


def _as_is(source: str) -> Callable[[], str]:
    return lambda: source


# ---------------------------------------------------------------- in the source

Edit = Callable[[ast.AST], ast.AST | None]
"""Returns a node in place of the given one, or None to leave it."""


class _Edited(ast.NodeTransformer):
    """Replaces the n-th node that an edit takes, or every one if n is None."""

    def __init__(self, edit: Edit, number: int | None) -> None:
        self.edit, self.number, self.seen = edit, number, 0

    def visit(self, node: ast.AST) -> ast.AST:
        """Visit a node."""
        other = self.edit(node)
        if other is not None:
            self.seen += 1
            if self.number in (None, self.seen - 1):
                return ast.copy_location(other, node)
        return self.generic_visit(node)


def edited(source: str, edit: Edit, *, everywhere: bool = False) -> Iterator[Callable[[], str]]:
    """Yield what makes the source with one edit, for each place where it can be made, or with all of them at once."""
    places = _Edited(edit, -1)
    places.visit(ast.parse(source))
    numbers = [None] if everywhere and places.seen else range(places.seen if not everywhere else 0)
    yield from (partial(_written, source, edit, number) for number in numbers)


def _written(source: str, edit: Edit, number: int | None) -> str:
    tree = _Edited(edit, number).visit(ast.parse(source))
    return ast.unparse(ast.fix_missing_locations(tree)) + "\n"


def _is_dimension(node: ast.AST, names: Sequence[str]) -> bool:
    return (
        isinstance(node, ast.Subscript)
        and isinstance(node.ctx, ast.Load)
        and isinstance(node.slice, ast.Constant)
        and node.slice.value in names
    )


def _literal(factor: float, product: Product) -> Iterator[Site]:
    """Put a number in place of a dimension, everywhere in the script."""
    for part, source in product.scripts.items():
        for name, value in product.resolved.parts[part].dimensions.items():
            number = ast.Constant(value * factor)

            def edit(node: ast.AST, name: str = name, number: ast.Constant = number) -> ast.AST | None:
                return copy.copy(number) if _is_dimension(node, [name]) else None

            if value and not name.endswith("_count"):
                yield from _sites(product, part, f"{name} is {value * factor:.6g}", edited(source, edit, everywhere=True))


def _misspelt(product: Product) -> Iterator[Site]:
    for part, source in product.scripts.items():
        names = list(product.resolved.parts[part].dimensions)

        def edit(node: ast.AST, names: Sequence[str] = names) -> ast.AST | None:
            if not _is_dimension(node, names):
                return None
            assert isinstance(node, ast.Subscript)
            assert isinstance(node.slice, ast.Constant)
            return ast.Subscript(node.value, ast.Constant(f"{node.slice.value!s}_mm"), ast.Load())

        yield from _sites(product, part, "a dimension is misspelt", edited(source, edit))


def _no_clearance(product: Product) -> Iterator[Site]:
    """Leave out a clearance where it is used."""
    for part, source in product.scripts.items():
        names = [name for name in product.resolved.parts[part].dimensions if any(word in name for word in _CLEARANCES)]

        def edit(node: ast.AST, names: Sequence[str] = names) -> ast.AST | None:
            return ast.Constant(0) if _is_dimension(node, names) else None

        yield from _sites(product, part, f"without {', '.join(names)}", edited(source, edit) if names else ())


def _cut(node: ast.AST) -> ast.expr | None:
    """Return what a statement or expression subtracts, if it is a shape: it contains a call with a capital letter."""
    right = node.value if isinstance(node, ast.AugAssign) else node.right if isinstance(node, ast.BinOp) else None
    op = getattr(node, "op", None)
    return right if isinstance(op, ast.Sub) and right is not None and makes_shape(right) else None


def _added(node: ast.AST) -> ast.expr | None:
    """Return what a statement adds, if it is a shape."""
    if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add) and makes_shape(node.value):
        return node.value
    return None


def makes_shape(node: ast.AST) -> bool:
    """Return whether an expression makes a shape; a call that only places something does not."""
    calls = {one.func.id for one in ast.walk(node) if isinstance(one, ast.Call) and isinstance(one.func, ast.Name)}
    return bool({"Cylinder", "Box", "Sphere", "Cone", "Torus", "extrude", "revolve", "Circle", "Rectangle", "loft"} & calls)


def _with_right(node: ast.AST, right: ast.expr) -> ast.AST:
    if isinstance(node, ast.AugAssign):
        return ast.AugAssign(node.target, node.op, right)
    assert isinstance(node, ast.BinOp)
    return ast.BinOp(node.left, node.op, right)


def left_out(found: Callable[[ast.AST], ast.expr | None], node: ast.AST) -> ast.AST | None:
    """Return what stands in place of a node without what is found in it; None if nothing is."""
    if found(node) is None:
        return None
    return ast.Pass() if isinstance(node, ast.AugAssign) else node.left if isinstance(node, ast.BinOp) else None


def _round_scaled(place: int, factor: float, node: ast.AST) -> ast.AST | None:
    """Multiply the radius (0) or the length (1) of the cylinder that is cut out."""
    right = _cut(node)
    if right is None:
        return None

    def edit(one: ast.AST) -> ast.AST | None:
        if not (isinstance(one, ast.Call) and isinstance(one.func, ast.Name) and one.func.id in ("Cylinder", "Circle")[: 2 - place]):
            return None
        if len(one.args) <= place:
            return None
        args = list(one.args)
        args[place] = ast.BinOp(args[place], ast.Mult(), ast.Constant(factor))
        return ast.Call(one.func, args, one.keywords)

    scaled = _Edited(edit, None)
    other = scaled.visit(copy.deepcopy(right))
    return _with_right(node, other) if scaled.seen and isinstance(other, ast.expr) else None


def _shifted_cut(by: float, node: ast.AST) -> ast.AST | None:
    right = _cut(node)
    if right is None or isinstance(right, ast.ListComp | ast.List):
        return None
    call = ast.parse(f"__import__('build123d').Pos({by}, {by}, {by})", mode="eval").body
    return _with_right(node, ast.BinOp(call, ast.Mult(), right))


def _other_end(node: ast.AST) -> ast.AST | None:
    """Extrude to the other side: a negated amount, or the other end of an alignment."""
    if isinstance(node, ast.Attribute) and node.attr in ("MIN", "MAX") and isinstance(node.value, ast.Name) and node.value.id == "Align":
        return ast.Attribute(node.value, "MAX" if node.attr == "MIN" else "MIN", node.ctx)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "extrude" and len(node.args) > 1:
        args = [*node.args[:1], ast.UnaryOp(ast.USub(), node.args[1]), *node.args[2:]]
        return ast.Call(node.func, args, node.keywords)
    return None


def _in_source(said: str, edit: Edit, product: Product) -> Iterator[Site]:
    for part, source in product.scripts.items():
        yield from _sites(product, part, said, edited(source, edit))


# ---------------------------------------------------------------- in what is returned


def _returned(said: str, statement: str, product: Product) -> Iterator[Site]:
    for part, source in product.scripts.items():
        yield from _sites(product, part, said, [_as_is(source + _WRAPPED.format(statement=statement))])


def _connectors(said: str, statement: str, product: Product) -> Iterator[Site]:
    """Change one connector that the script returns; `{name}`, `{across}` and `{z}` stand for its name and directions in the part."""
    for part, source in product.scripts.items():
        for name, connector in product.resolved.parts[part].connectors.items():
            across, z = (tuple(round(float(value), 9) + 0.0 for value in axis) for axis in (connector.frame.x_axis, connector.frame.z_axis))
            changed = statement.format(name=name, across=across, z=z)
            yield from _sites(product, part, f"connector {name}: {said}", [_as_is(source + _WRAPPED.format(statement=changed))])


_SHIFT: Final = (
    'connectors["{name}"] = {{**connectors["{name}"], "o": tuple(a + %s * b for a, b in zip(connectors["{name}"]["o"], {across}))}}'
)
_ACROSS: Final = 'connectors["{name}"] = {{"o": connectors["{name}"]["o"], "z": {across}, "x": {z}}}'
_REVERSED: Final = 'connectors["{name}"] = {{**connectors["{name}"], "z": tuple(-a for a in {z})}}'
_BESIDE: Final = "box = shape.bounding_box(); shape = shape + _b.Pos(box.max.X + 10, box.max.Y + 10, box.max.Z + 10) * _b.Box(2, 2, 2)"


def _kind(name: str, meaning: str, causes: frozenset[str], sites: Callable[..., Iterator[Site]], *given: object) -> Kind:
    return Kind(name, "script", meaning, _BROKEN | causes, partial(sites, *given))


SCRIPT_KINDS: Final = (
    _kind("literal_number", "a number in place of a dimension", _UNUSED, _literal, 1.0),
    _kind("dimension_ignored", "another number in place of a dimension", _SHAPE, _literal, 0.8),
    _kind("dimension_misspelt", "a dimension that does not exist", _BROKEN, _misspelt),
    _kind("clearance_forgotten", "built without a clearance", _SHAPE, _no_clearance),
    _kind("bore_missing", "a cut left out", _SHAPE, _in_source, "a cut left out", partial(left_out, _cut)),
    _kind("bore_small", "a hole with 0.8 of its radius", _SHAPE, _in_source, "a hole × 0.8", partial(_round_scaled, 0, 0.8)),
    _kind("bore_shallow", "a hole with a quarter of its length", _SHAPE, _in_source, "a hole × 0.25 deep", partial(_round_scaled, 1, 0.25)),
    _kind("bore_off", "a cut 2 mm off in x, y and z", _SHAPE, _in_source, "a cut 2 mm off", partial(_shifted_cut, 2.0)),
    _kind("feature_missing", "a body left out", _SHAPE, _in_source, "a body left out", partial(left_out, _added)),
    _kind("extrusion_flipped", "an extrusion to the other side", _SHAPE, _in_source, "an extrusion to the other side", _other_end),
    _kind("plane_wrong", "the shape in another plane", _SHAPE, _returned, "turned by 90° about x", "shape = _b.Rot(X=90) * shape"),
    _kind("shape_mirrored", "the shape mirrored", _SHAPE, _returned, "mirrored at x = 0", "shape = _b.mirror(shape, about=_b.Plane.YZ)"),
    _kind("shape_off", "the shape 5 mm off", _SHAPE, _returned, "5 mm off along x", "shape = _b.Pos(5, 0, 0) * shape"),
    _kind("shape_inch", "the shape in inches", _SHAPE, _returned, "÷ 25.4", "shape = _b.scale(shape, by=1 / 25.4)"),
    _kind("two_solids", "a second solid", frozenset({"E_NOT_ONE_SOLID"}), _returned, "a second solid", _BESIDE),
    _kind("connector_off_1", "a connector 1 mm off", PLACE, _connectors, "1 mm off", _SHIFT % 1),
    _kind("connector_off_5", "a connector 5 mm off", PLACE, _connectors, "5 mm off", _SHIFT % 5),
    _kind("connector_turned", "a connector with another axis", PLACE, _connectors, "another axis", _ACROSS),
    _kind("connector_reversed", "a connector with z reversed", PLACE, _connectors, "z reversed", _REVERSED),
    _kind(
        "connector_missing", "a connector left out", frozenset({"E_CONNECTOR_MISSING"}), _connectors, "left out", 'del connectors["{name}"]'
    ),
)
