"""Collision shapes of a model: convex pieces inside the parts, the parts' own meshes, or their hulls.

Convex pieces lie inside the solids. So they touch only where the solids touch, and a certificate about the solids is valid for them.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from itertools import combinations
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from articad.connectors.se3 import SE3
from articad.export.contacts import ContactSearch, poses_in_motion
from articad.export.convex import Pieces, as_it_is, pieces_of, whole_hull
from articad.export.gaps import TOUCHING_MM, gaps_at_rest, resting
from articad.export.hulls import HullOverlap, Pair
from articad.export.losses import Feature
from articad.export.lowering import metres
from articad.export.once import once
from articad.geometry.part import Shape
from articad.kernels.cache import BuildCache

if TYPE_CHECKING:
    from articad.assembly import Assembly
    from articad.export.lowering import Link, LoweredModel, Placed

Collision = Literal["pieces", "solid", "hull"]

HULL_SHARE = 1e-6  # of a part's volume: rounding in hulls and pieces
EXACT_MM = 1e-3  # of the surface that pieces may omit and still count as exact


class Collisions(NamedTuple):
    """A model with its collision shapes.

    Attributes:
        model: The model, with its collision shapes and their losses.
        contacts: Pairs of parts whose shapes overlap though no joint connects them. For pieces: pairs whose solids overlap at rest. For
            meshes and hulls: also those that meet at rest or in motion where the solids are apart, because engines use the hulls of
            meshes.
    """

    model: LoweredModel
    contacts: tuple[HullOverlap, ...]


def collide(
    assembly: Assembly, model: LoweredModel, collision: Collision | None, skip: set[Pair], cache: BuildCache | None = None
) -> Collisions:
    """Return the model with the requested collision shapes, and the contacts that these add.

    Args:
        assembly: The assembly, for its motion.
        model: Its lowering.
        collision: "pieces" for convex pieces inside the solids, "solid" for the parts' own meshes, "hull" for one hull each; None for
            pieces, or for the original meshes if the assembly was read from a file that articad did not write.
        skip: Pairs that need no check because engines do not let them collide.
        cache: Stores pieces by shape; the cache of built parts by default.
    """
    kind = kind_of(assembly, collision)
    shaped = shape_model(assembly, model, kind, cache)
    own = {link.part.name: tuple(placed.shape for placed in link.collisions) for link in model.links}
    formed = {link.part.name: tuple(placed.shape for placed in link.collisions) for link in shaped.links}
    asked = any(own[a] and own[b] and (a, b) not in skip and (b, a) not in skip for a, b in combinations(assembly.mechanism.parts, 2))
    at_rest = assembly.mechanism.at_rest[None].matrix

    def begun() -> ContactSearch:
        search = ContactSearch(assembly.mechanism.parts, at_rest, own)
        for name, shapes in formed.items():
            search.update(name, shapes)
        if asked and kind != "pieces" and not search.is_convex:  # in motion, such pieces meet only where the solids do
            search.poses = once(assembly, "poses in motion", lambda: poses_in_motion(assembly.mechanism))
        return search

    # The solids never change, so the results for one format are reused for the next.
    shapes = tuple((name, tuple((id(shape.mesh), shape.frame.data.tobytes()) for shape in solids)) for name, solids in own.items())
    contacts = tuple(once(assembly, ("contacts", kind, asked, shapes), begun).contacts(skip))
    return Collisions(shaped, contacts)


def kind_of(assembly: Assembly, collision: Collision | None) -> Collision:
    """Return the collision shapes of an assembly: the requested kind, else pieces, or the shapes of the file that it was read from."""
    return collision or ("solid" if assembly.foreign else "pieces")


def shape_model(assembly: Assembly, model: LoweredModel, kind: Collision, cache: BuildCache | None = None) -> LoweredModel:
    """Return the model with the requested collision shapes, and with features that state what these leave out.

    Args:
        assembly: The assembly to write.
        model: Its lowering.
        kind: As for `collide`.
        cache: Stores pieces by shape; the cache of built parts by default.
    """
    if kind == "solid":
        return model
    cache = cache or BuildCache()
    found: dict[Any, Pieces] = {}  # equal shapes share their pieces
    shaped = once(assembly, ("shaped", kind), lambda: {link.part.name: _formed(link, kind, cache, found) for link in model.links})
    features = [*model.features, *(feature for name, formed in shaped.items() for feature in _features(name, kind, formed))]
    links = tuple(_reshaped(link, shaped[link.part.name]) for link in model.links)
    return replace(model, links=links, features=tuple(features))


def contact_feature(contact: HullOverlap) -> Feature:
    """Return a contact as a row of the table of losses."""
    return Feature("hull", "parts." + "+".join(contact.parts), f"hulls share {contact.volume:.3g} mm³")


class _Formed(NamedTuple):
    """The pieces of a shape as shapes of the part, which no format changes, and their poses in the shape's frame [m]."""

    pieces: Pieces
    shapes: tuple[Shape, ...]
    frames: SE3


def _formed(link: Link, kind: Collision, cache: BuildCache, known: dict[Any, Pieces]) -> list[_Formed]:
    """Return the pieces of each of a link's collision shapes; those of `known` shapes are not looked for again."""
    found = []
    for placed in link.collisions:
        pieces, shape = _pieces(link, placed, kind, cache, known), placed.shape
        frames = SE3.stack([piece.frame for piece in pieces.pieces])
        poses = shape.frame @ frames
        shapes = [
            shape if piece.mesh is shape.mesh else Shape(piece.mesh, poses[index], shape.color, shape.name, piece.primitive)
            for index, piece in enumerate(pieces.pieces)
        ]
        found.append(_Formed(pieces, tuple(shapes), metres(frames)))
    return found


def _pieces(link: Link, placed: Placed, kind: Collision, cache: BuildCache, known: dict[Any, Pieces]) -> Pieces:
    shape, solid = placed.shape, link.part.solid
    if kind == "solid" or (kind == "pieces" and shape.primitive is not None):
        return as_it_is(shape.mesh, shape.primitive)
    if kind == "hull":
        return whole_hull(shape.mesh)
    deflection = solid.deflection if solid is not None and solid.mesh.digest == shape.mesh.digest else 0.0
    key = shape.mesh.digest, None if shape.mesh.face is None else shape.mesh.face.tobytes(), deflection
    if key not in known:
        known[key] = pieces_of(shape.mesh, cache, deflection=deflection)
    return known[key]


def _reshaped(link: Link, formed: list[_Formed]) -> Link:
    """Return the link with pieces for its collision shapes."""
    collisions = []
    for placed, (_, shapes, frames) in zip(link.collisions, formed, strict=True):
        poses = placed.T_link_shape @ frames
        collisions += [
            placed if shape is placed.shape else replace(placed, shape=shape, T_link_shape=poses[index])
            for index, shape in enumerate(shapes)
        ]
    return replace(link, collisions=tuple(collisions))


def _features(name: str, kind: Collision, formed: list[_Formed]) -> list[Feature]:
    """Return how the pieces differ from the shape, if they do."""
    found = [one.pieces for one in formed]
    where = f"parts.{name}"
    if kind == "hull":
        more = max((pieces.more for pieces in found), default=0.0)
        return [Feature("collision.hull", where, f"{100 * more:.3g} % more volume")] if more > HULL_SHARE else []
    features = [Feature("collision.open", where) for pieces in found if not pieces.inside]
    missing = max((pieces.missing for pieces in found), default=0.0)
    less = max((pieces.less for pieces in found), default=0.0)
    if missing > EXACT_MM or less > HULL_SHARE:
        count, bound = sum(len(pieces.pieces) for pieces in found), max(pieces.bound for pieces in found)
        detail = f"{count} of them, up to {round(missing, 6):.3g} mm of the solid left out, {100 * less:.3g} % of its volume"
        features.append(Feature("collision.pieces", where, detail + (f", more than {bound:.3g} mm" if missing > bound else "")))
    return features


def adjacent(assembly: Assembly, pair: Pair) -> str:
    """Return why two parts that share joints do not collide: they touch by design there, or they were not checked."""
    joints = ", ".join(once(assembly, "names of joints", lambda: _names_of_joints(assembly))[frozenset(pair)])
    a, b = pair
    gap = once(assembly, "gaps", lambda: gaps_at_rest(assembly))[pair]
    if gap is None:
        return f"adjacent: joint {joints} connects {a} and {b}, and one of them has no solid"
    if gap < TOUCHING_MM:
        return f"adjacent: {a} and {b} touch by design at joint {joints}: the gap at rest is {gap:.2g} mm"
    return f"not checked: joint {joints} connects {a} and {b}, whose solids are more than {TOUCHING_MM:g} mm apart at rest"


def lying(assembly: Assembly) -> dict[Pair, str]:
    """Return the pairs of parts that touch at rest and are fixed to those that a joint connects, and why they do not collide.

    Their joint carries them. MuJoCo would press them against each other with the whole stiffness of the joint.
    """
    found = once(assembly, "resting", lambda: resting(assembly))
    return {
        (a, b): f"resting: {a} and {b} touch at rest, and joint {name} connects them or parts that are fixed to them"
        for (a, b), name in found.items()
    }


def _names_of_joints(assembly: Assembly) -> defaultdict[frozenset[str], list[str]]:
    """Return the names of the joints between two parts."""
    names: defaultdict[frozenset[str], list[str]] = defaultdict(list)
    for joint in assembly.mechanism.joints:
        names[frozenset((joint.parent, joint.child))].append(joint.name)
    return names


def excuse(contact: HullOverlap) -> str:
    """Return why two parts that overlap do not collide."""
    a, b = contact.parts
    if contact.solids:
        return f"not checked: the solids of {a} and {b} overlap by {contact.volume:.3g} mm³ at rest"
    return f"not checked: the hulls of {a} and {b} overlap by {contact.volume:.3g} mm³ where the solids are apart"
