"""Drawings of an assembly that is built: a sheet of the assembly, and one of each item that is made."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from articad.connectors.se3 import SE3
from articad.errors import ArticadError, did_you_mean
from articad.kernels.choice import Sandbox
from articad.kernels.views import View, ViewKernel
from articad.papers.assembly_sheet import assembly_sheet
from articad.papers.holes import Fitted, fits_of, holes_of
from articad.papers.items import Item, items_of
from articad.papers.part_sheet import ISO, PartFacts, part_sheet, section_of, views_of
from articad.papers.sheet import DrawingSheet

if TYPE_CHECKING:
    from articad.assembly import Assembly

__all__ = ["drawings_of"]


def drawings_of(
    assembly: Assembly,
    part: str | None = None,
    *,
    purchased: Sequence[str] = (),
    size: tuple[float, float] | None = None,
    notes: Sequence[str] = (),
    section: View | None = None,
    sandbox: Sandbox = "strict",
) -> Iterator[DrawingSheet]:
    """Yield the sheets of a product: the assembly first, then each item that is made; or the sheet of one part.

    Args:
        assembly: Built from a plan.
        part: Name of a part.
        purchased: Parts that are bought, which get no sheet.
        size: Of the sheets of parts [mm]; A4 or A3 by need if None.
        notes: Lines of text on the sheet of the assembly.
        section: A view with a cut that is drawn on the sheet of the assembly, under its name.
        sandbox: Isolation of the kernel.

    Raises:
        ArticadError: If there is no such part, or a part has no B-rep.
        KernelError: If the kernel fails.
    """
    product = assembly.product()
    items = items_of(product, purchased)
    if part is not None and part not in product.parts:
        known = ", ".join(product.parts)
        raise ArticadError(f"There is no part {part!r}.{did_you_mean(part, product.parts)} Parts: {known}.", stage="export")
    without = [name for name in product.parts if name not in product.realised or product.realised[name].built.solid.brep is None]
    if without:
        message = f"Drawings need the B-rep of each part, which a run or a plan has; these have none: {', '.join(without)}."
        raise ArticadError(message, stage="export", parts=without)
    kernel, fits = ViewKernel(sandbox=sandbox), fits_of(product)
    drawn = [item for item in items if item.supply == "made"]
    if part is not None:
        (item,) = [one for one in items if part in one.parts]
        yield _part_sheet(product, item, fits, kernel, "1 / 1", size, name=part)
        return
    count = len(drawn) + 1
    yield _assembly_sheet(product, items, kernel, f"1 / {count}", notes, section)
    for number, item in enumerate(drawn, start=2):
        yield _part_sheet(product, item, fits, kernel, f"{number} / {count}", size)


def _part_sheet(
    product: Assembly,
    item: Item,
    fits: dict[str, list[Fitted]],
    kernel: ViewKernel,
    sheet: str,
    size: tuple[float, float] | None,
    name: str = "",
) -> DrawingSheet:
    name = name or item.name
    part, brep = product.parts[name], product.realised[name].built.solid.brep
    if part.solid is None or brep is None or product.resolved is None:
        raise AssertionError("a sheet shows a solid of a plan")
    holes = holes_of(part.solid.mesh, fits, name)
    section = section_of(holes, part.solid.bbox)
    views, features = kernel.project([(brep, SE3.identity())], views_of(section))
    wide = part.solid.bbox[1] - part.solid.bbox[0]
    fields = {
        "Assembly": product.name,
        "Sheet": sheet,
        "Material": part.material or "-",
        "Overall": " × ".join(f"{length:.5g}" for length in wide),
        "Item": str(item.number),
        "Tolerances": "fits: see table" if any(hole.fit for hole in holes) else "none stated",
        "Quantity": str(item.quantity),
        "Mass": "-" if part.mass is None else f"{part.mass.mass:.4g} kg",
    }
    planned = product.resolved.parts[name]
    dimensions = {key: float(value) for key, value in planned.dimensions.items()}
    return part_sheet(PartFacts(name, part.solid.bbox, dimensions, holes, features, views, section, fields), size)


def _assembly_sheet(
    product: Assembly, items: Sequence[Item], kernel: ViewKernel, sheet: str, notes: Sequence[str], section: View | None
) -> DrawingSheet:
    poses = product.at()
    shapes = [(brep, poses[name]) for name, one in product.realised.items() if (brep := one.built.solid.brep) is not None]
    views, _ = kernel.project(shapes, [View(ISO.name, ISO.right, ISO.up), *(() if section is None else (section,))])
    corners = np.concatenate(
        [T.rotation @ mesh.vertices.T + T.translation[:, None] for name, T in poses.items() if (mesh := product.parts[name].mesh)], axis=1
    )
    fields = {
        "Sheet": sheet,
        "Overall": " × ".join(f"{length:.5g}" for length in np.ptp(corners, axis=1)),
        "Parts": str(len(product.parts)),
        "Items": str(len(items)),
        "Mass": f"{sum(part.mass.mass for part in product.parts.values() if part.mass is not None):.4g} kg",
    }
    return assembly_sheet(product, items, views[ISO.name], fields, notes, None if section is None else views[section.name])
