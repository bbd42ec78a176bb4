"""The items of a product: parts of one shape and one material, counted and numbered. Every paper uses these numbers."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, Literal

from articad.errors import ArticadError, did_you_mean
from articad.geometry.congruence import same_shape
from articad.geometry.part import Part

if TYPE_CHECKING:
    from articad.assembly import Assembly

__all__ = ["Item", "items_of"]


@dataclass(frozen=True)
class Item:
    """One row of a parts list.

    Attributes:
        number: From 1, in the order of the plan.
        parts: Names of the parts that it counts; the first one names the item.
        material: None if it is not known.
        masses_kg: Mass of each part; None where it is not known.
        size_mm: Extent along x, y and z of the part's own frame; None for a part without geometry.
        supply: `purchased` if the user named it so, or a joint states that its two parts are bought as one; else `made`.
        description: What it is for.
        note: What distinguishes it from another item.
    """

    number: int
    parts: tuple[str, ...]
    material: str | None
    masses_kg: tuple[float | None, ...]
    size_mm: tuple[float, float, float] | None
    supply: Literal["made", "purchased"]
    description: str
    note: str = ""

    @property
    def name(self) -> str:
        """Name of the first part."""
        return self.parts[0]

    @property
    def quantity(self) -> int:
        """How many parts it counts."""
        return len(self.parts)

    @property
    def size(self) -> str:
        """Its extents in mm to a tenth, such as "900 × 500 × 1800"; empty for a part without geometry."""
        return " × ".join(f"{round(length, 1):.8g}" for length in self.size_mm or ())

    @property
    def mass_kg(self) -> float | None:
        """Mass of one part."""
        return self.masses_kg[0]

    @property
    def total_kg(self) -> float | None:
        """Mass of all its parts; None if one of them is not known."""
        known = [mass for mass in self.masses_kg if mass is not None]
        return sum(known) if len(known) == self.quantity else None


def items_of(assembly: Assembly, purchased: Iterable[str] = ()) -> tuple[Item, ...]:
    """Return the items of a product, without its environment.

    Parts are one item if they have the same material, and a rigid motion maps one onto the other. A mirror image is an
    item of its own unless the shape is its own mirror image.

    Args:
        assembly: The product.
        purchased: Names of parts that are bought, with `*` and `?` as wildcards, beside the two parts of each joint whose fastening is
            `purchased`.

    Raises:
        ArticadError: If one of these names is that of no part.
    """
    product = assembly.product()
    patterns = tuple(purchased)
    for pattern in patterns:
        if not any(fnmatchcase(name, pattern) for name in product.parts):
            message = (
                f"--purchased {pattern}: no part has this name.{did_you_mean(pattern, product.parts)} Parts: {', '.join(product.parts)}."
            )
            raise ArticadError(message, stage="export")
    pairs = [(joint.parent, joint.child) for joint in product.mechanism.joints if joint.fastening == "purchased"]
    bought = {name for name in product.parts if any(fnmatchcase(name, pattern) for pattern in patterns)}.union(*pairs)
    groups: list[list[Part]] = []
    for part in product.parts.values():
        for group in groups:
            if group[0].material == part.material and (group[0].name in bought) == (part.name in bought) and _alike(group[0], part):
                group.append(part)
                break
        else:
            groups.append([part])
    numbers = {part.name: number for number, group in enumerate(groups, start=1) for part in group}
    return tuple(_item(product, number, group, bought, numbers) for number, group in enumerate(groups, start=1))


def _item(product: Assembly, number: int, group: list[Part], bought: set[str], numbers: dict[str, int]) -> Item:
    first = group[0]
    size = None if first.mesh is None else tuple(float(length) for length in first.mesh.bounds[1] - first.mesh.bounds[0])
    if first.solid is not None:
        size = tuple(float(length) for length in first.solid.bbox[1] - first.solid.bbox[0])
    told = note = ""
    if product.resolved is not None:
        planned = product.resolved.parts[first.name]
        told = planned.role or planned.description.partition(". ")[0].rstrip(".")
        derivation = planned.derivation
        if derivation is not None and derivation.op == "mirror":
            note = f"mirror image of item {numbers[derivation.source]}"
    return Item(
        number=number,
        parts=tuple(part.name for part in group),
        material=first.material,
        masses_kg=tuple(None if part.mass is None else part.mass.mass for part in group),
        size_mm=size,  # type: ignore[arg-type]
        supply="purchased" if first.name in bought else "made",
        description=" ".join(told.split()),
        note=note,
    )


def _alike(a: Part, b: Part) -> bool:
    if a.mesh is None or b.mesh is None:
        return False
    same = a.mesh is b.mesh or a.mesh.digest == b.mesh.digest
    return same or (a.solid is not None and b.solid is not None and same_shape(a.solid, b.solid))
