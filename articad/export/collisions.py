"""What a model collides with: the parts' own meshes, their hulls, or convex pieces that add no contact."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from typing import TYPE_CHECKING, Literal, NamedTuple

from articad.export.contacts import ContactSearch, poses_in_motion
from articad.export.convex import THRESHOLDS, Pieces, is_convex, pieces_of, whole_hull
from articad.export.hulls import HullOverlap, Pair
from articad.export.losses import Feature
from articad.export.once import once
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Shape
from articad.kernels.cache import BuildCache

if TYPE_CHECKING:
    from articad.assembly import Assembly
    from articad.export.lowering import Link, LoweredModel

Collision = Literal["solid", "hull", "pieces"]

HULL_SHARE = 1e-6  # of a part's volume: what hulls and pieces may add by rounding
LARGEST_SHARE = 0.1  # of a part's volume: pieces that add or leave out more are cut finer as long as that helps


class Collisions(NamedTuple):
    """A model with the shapes that it collides with.

    Attributes:
        model: With its collision shapes and what they lose.
        contacts: Pairs of parts that these shapes, which engines take the hulls of, bring into contact: at rest, or in motion where the
            solids are apart.
    """

    model: LoweredModel
    contacts: tuple[HullOverlap, ...]


def collide(assembly: Assembly, model: LoweredModel, collision: Collision, skip: set[Pair], cache: BuildCache | None = None) -> Collisions:
    """Return the model with the shapes that are asked for, and the contacts that they add.

    Args:
        assembly: Whose motion counts.
        model: Its lowering.
        collision: "solid" for the parts' own meshes, "hull" for one hull each, "pieces" for convex pieces, which are cut finer until they
            are near the solid and add no contact, or cannot be cut finer.
        skip: Pairs that need no check: engines do not let them collide.
        cache: Keeps pieces by shape; that of built parts by default.
    """
    cache = cache or BuildCache()
    shaped = {link.part.name: _Shaped(link, collision, cache) for link in model.links}
    own = {name: tuple(placed.shape for placed in one.link.collisions) for name, one in shaped.items()}
    asked = any(own[a] and own[b] and (a, b) not in skip and (b, a) not in skip for a, b in combinations(assembly.mechanism.parts, 2))
    at_rest = assembly.poses(assembly.mechanism.rest)[None].matrix

    def begun() -> ContactSearch:
        search = ContactSearch(assembly.mechanism.parts, at_rest, own)
        for name, one in shaped.items():
            search.update(name, one.shapes)
        if asked and not search.is_convex:  # in motion, where convex pieces meet the solids do
            search.poses = once(assembly, "poses in motion", lambda: poses_in_motion(assembly.mechanism))
        return search

    # The solids never change, so that what one format has found is known to the next.
    shapes = tuple((name, tuple((id(shape.mesh), shape.frame.data.tobytes()) for shape in solids)) for name, solids in own.items())
    search = once(assembly, ("contacts", asked, shapes), begun) if collision == "solid" else begun()
    while True:
        contacts = search.contacts(skip)
        added = dict.fromkeys(part for contact in contacts if not contact.solids for part in contact.parts)
        finer = [name for name in added if shaped[name].refine()]
        if not finer:
            break
        for name in finer:
            search.update(name, shaped[name].shapes)
    if collision == "solid":
        return Collisions(model, tuple(contacts))
    features = [*model.features, *(feature for one in shaped.values() for feature in one.features())]
    links = tuple(shaped[link.part.name].result for link in model.links)
    return Collisions(replace(model, links=links, features=tuple(features)), tuple(contacts))


def _reshaped(shape: Shape, mesh: TriMesh) -> Shape:
    return shape if mesh is shape.mesh else replace(shape, mesh=mesh, primitive=None)


def contact_feature(contact: HullOverlap) -> Feature:
    """Return the row of the table of losses that a contact is."""
    return Feature("hull", "parts." + "+".join(contact.parts), f"hulls share {contact.volume:.3g} mm³")


class _Shaped:
    """A part's collision shapes in convex pieces, as coarse as is good enough so far."""

    def __init__(self, link: Link, collision: Collision, cache: BuildCache) -> None:
        self.link, self._cache, self._fineness = link, cache, 0
        self._key = f"collision.{collision}"
        meshes = [placed.shape.mesh for placed in link.collisions]
        self._cuts = collision == "pieces" and not all(map(is_convex, meshes))
        if collision == "pieces":
            self._pieces = self._cut()
            while self._error > LARGEST_SHARE and self.refine():
                pass
        else:
            self._pieces = [whole_hull(mesh) for mesh in meshes] if collision == "hull" else [Pieces((mesh,), 0.0, 0.0) for mesh in meshes]

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The pieces, in the part's frame."""
        rows = zip(self.link.collisions, self._pieces, strict=True)
        return tuple(_reshaped(placed.shape, mesh) for placed, pieces in rows for mesh in pieces.meshes)

    @property
    def result(self) -> Link:
        """The link with its pieces."""
        rows = zip(self.link.collisions, self._pieces, strict=True)
        pieces = (replace(placed, shape=_reshaped(placed.shape, mesh)) for placed, found in rows for mesh in found.meshes)
        return replace(self.link, collisions=tuple(pieces))

    @property
    def _error(self) -> float:
        return max((max(pieces.more, pieces.less) for pieces in self._pieces), default=0.0)

    def refine(self) -> bool:
        """Cut the shapes finer; False where that is not possible."""
        if not self._cuts or self._fineness + 1 >= len(THRESHOLDS):
            return False
        self._fineness += 1
        self._pieces = self._cut()
        return True

    def features(self) -> list[Feature]:
        """Return what the pieces are not, if they are not the shape itself."""
        if self._error <= HULL_SHARE:
            return []
        more, less = (100 * max(getattr(pieces, name) for pieces in self._pieces) for name in ("more", "less"))
        detail = f"{more:.3g} % more volume"
        if self._key == "collision.pieces":
            detail = f"{sum(len(pieces.meshes) for pieces in self._pieces)} of them, {detail}, {less:.3g} % less"
        return [Feature(self._key, f"parts.{self.link.part.name}", detail)]

    def _cut(self) -> list[Pieces]:
        return [pieces_of(placed.shape.mesh, self._fineness, self._cache) for placed in self.link.collisions]
