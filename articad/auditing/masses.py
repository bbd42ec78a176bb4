"""Inertias: present where something moves, physically possible, and possible for the shapes they belong to.

The bounds hold for every body whose mass lies within the convex hull of its shapes: its centre of mass is in the hull's box, and no
principal moment exceeds m·R², with R the largest distance of a vertex from the centre.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from articad.auditing.declared import Declared, DeclaredInertial, DeclaredLink
from articad.auditing.wording import counted, listed
from articad.findings import Finding

SYMMETRY = 1e-6  # relative rounding of moments written with six digits
ROUNDING = 1e-12  # relative; a smaller moment is zero
TRIANGLE = 1e-3  # relative; files round their moments
SLACK = 1.05  # of bounds from shapes, which are drawn a little smaller than the bodies they represent
SLACK_MM = 1.0
DENSEST_KG_M3 = 22_600.0  # osmium
THINNEST_KG_M3 = 1.2  # air
UNITS = 1e5  # times too dense or too thin: metres instead of millimetres are a factor of 10⁹, inches of 2·10⁷
LEAST_SIZE_MM = 0.1


def missing(declared: Declared) -> Iterator[Finding]:
    """Bodies that move and have no mass, although they have a shape."""
    yield from _without_mass(declared, shaped=True)


def massless_carriers(declared: Declared) -> Iterator[Finding]:
    """Links without shape or mass that carry a joint."""
    yield from _without_mass(declared, shaped=False)


def _without_mass(declared: Declared, *, shaped: bool) -> Iterator[Finding]:
    if not declared.states_inertia:
        return
    links = declared.by_name
    bare = [group for group in declared.moving_groups if not any(_mass(links[name]) is not None for name in group)]
    groups = [group for group in bare if any(links[name].shapes for name in group) is shaped]
    if not groups:
        return
    names = tuple(next((name for name in group if links[name].shapes), group[0]) for group in groups)
    moving = len(declared.moving_groups)
    if shaped:
        code, what = "E_AUDIT_NO_INERTIA", "has shapes but no <inertial>" if len(groups) == 1 else "have shapes but no <inertial>"
        hint = "Give each a mass and an inertia; --fix computes them from closed meshes and --density."
    else:
        code, what = "E_AUDIT_MASSLESS", "carries joints but has" if len(groups) == 1 else "carry joints but have"
        what += " neither mass nor shape"
        hint = "Give each a small mass and inertia, or merge the chain into one joint; simulators refuse massless bodies that move."
    yield Finding(
        code=code,
        where=links[names[0]].where,
        parts=names,
        message=f"{len(groups)} of {counted(moving, 'moving body', 'moving bodies')} {what}: {listed(names)}.",
        hint=hint,
        value=len(groups),
        limit=0,
        cause="no_inertia" if shaped else "carrier",
    )


def impossible_mass(declared: Declared) -> Iterator[Finding]:
    """A mass that is not positive, on a body that moves."""
    moving = {name for group in declared.moving_groups for name in group}
    for link in declared.links:
        if link.inertial is None or link.inertial.mass is None or link.inertial.mass > 0:
            continue
        heavy = any((_mass(declared.by_name[name]) or 0.0) > 0 for name in declared.rigid_groups[link.name] if name != link.name)
        if link.inertial.mass == 0 and (link.name not in moving or heavy):
            continue  # some files write zero for "none"
        yield Finding(
            code="E_AUDIT_MASS",
            where=link.where,
            parts=(link.name,),
            message=f"{link.name} has a mass of {link.inertial.mass:.6g} kg.",
            hint="Give a positive mass, or leave <inertial> out and use --fix with --density.",
            value=link.inertial.mass,
            limit=0.0,
            unit="kg",
        )


def zero(declared: Declared) -> Iterator[Finding]:
    """Inertias of only zeros, in one finding."""
    found = [(link, mass) for link, inertial, mass in _weighed(declared) if inertial.inertia is not None and not inertial.inertia.any()]
    if found:
        names = tuple(link.name for link, _ in found)
        yield Finding(
            code="E_AUDIT_INERTIA",
            where=found[0][0].where,
            parts=names,
            message=f"{counted(len(found), 'link')} with a total mass of {sum(mass for _, mass in found):.4g} kg have zero inertia: {listed(names)}.",
            hint="Compute it from the shape; --fix does.",
            value=0.0,
            limit=0.0,
            unit="kg·m²",
            cause="placeholder",
        )


def not_positive(declared: Declared) -> Iterator[Finding]:
    """An inertia with a principal moment that is not positive."""
    for link, inertial, mass in _weighed(declared):
        assert inertial.inertia is not None
        small, _, large = np.linalg.eigvalsh(inertial.inertia)
        small = 0.0 if abs(small) < ROUNDING * abs(large) else float(small)
        if small > SYMMETRY * abs(large) or (small >= 0 and _is_thin(link)) or not inertial.inertia.any():
            continue
        yield Finding(
            code="E_AUDIT_INERTIA",
            where=link.where,
            parts=(link.name,),
            message=f"The inertia of {link.name} ({mass:.4g} kg) has a principal moment of {small * 1e-6:.4g} kg·m²; all three must be positive.",
            hint="Compute it from the shape (--fix does), or correct the signs of the products of inertia.",
            value=small * 1e-6,
            limit=0.0,
            unit="kg·m²",
        )


def triangle(declared: Declared) -> Iterator[Finding]:
    """An inertia whose largest moment exceeds the sum of the others, which is physically impossible."""
    for link, inertial, _ in _weighed(declared):
        assert inertial.inertia is not None
        small, middle, large = np.linalg.eigvalsh(inertial.inertia)
        if small > 0 and large > (small + middle) * (1 + TRIANGLE):
            yield Finding(
                code="E_AUDIT_INERTIA_TRIANGLE",
                where=link.where,
                parts=(link.name,),
                message=f"The inertia of {link.name} is physically impossible: its largest moment is {large * 1e-6:.4g} kg·m², "
                f"the sum of the other two is {(small + middle) * 1e-6:.4g}.",
                hint="Compute it from the shape; --fix does.",
                value=large / (small + middle),
                limit=1.0,
            )


def beyond_shape(declared: Declared) -> Iterator[Finding]:
    """An inertia larger than that of all the mass at the farthest point of the shapes; links with the same inertia in one finding."""
    alike: dict[str, list[tuple[float, float, DeclaredLink, float, float]]] = {}
    for link, inertial, mass in _weighed(declared):
        assert inertial.inertia is not None
        if not len(link.points) or not _all_read(link) or _shared(declared, link.name):
            continue
        reach = float(np.linalg.norm(link.points - inertial.com, axis=1).max()) + SLACK_MM
        large, bound = float(np.linalg.eigvalsh(inertial.inertia)[-1]), mass * reach**2
        if large > SLACK * bound:
            alike.setdefault(f"{np.diag(inertial.inertia)}", []).append((large / bound, large, link, bound, mass))
    for rows in alike.values():
        _, large, link, bound, mass = max(rows, key=lambda row: row[0])
        others = [row[2].name for row in rows if row[2] is not link]
        reach = math.sqrt(bound / mass)
        yield Finding(
            code="W_AUDIT_INERTIA_SHAPE",
            where=link.where,
            parts=(link.name, *others),
            message=f"{link.name} weighs {mass:.4g} kg and reaches {reach:.4g} mm from its centre of mass, so no moment can exceed "
            f"{bound * 1e-6:.4g} kg·m²; it has {large * 1e-6:.4g}."
            + (f" The inertias of {listed(others)} are also too large for their shapes." if others else ""),
            hint="Compute it from the shape (--fix does); check its unit and its reference point.",
            value=large * 1e-6,
            limit=bound * 1e-6,
            unit="kg·m²",
            cause="placeholder" if others or _is_power_of_ten(large * 1e-6) else None,
        )


def centre_outside(declared: Declared) -> Iterator[Finding]:
    """A centre of mass outside the box of the shapes."""
    for link in declared.links:
        inertial = link.inertial
        if (
            inertial is None
            or not (inertial.mass or 0.0) > 0
            or not len(link.points)
            or not _all_read(link)
            or _shared(declared, link.name)
        ):
            continue
        low, high = link.points.min(axis=0), link.points.max(axis=0)
        allowed = SLACK_MM + (SLACK - 1) * float(np.linalg.norm(high - low))
        outside = float(np.linalg.norm(np.maximum(np.maximum(low - inertial.com, inertial.com - high), 0.0)))
        if outside > allowed:
            yield Finding(
                code="W_AUDIT_COM",
                where=link.where,
                parts=(link.name,),
                message=f"The centre of mass of {link.name} lies {outside:.4g} mm outside the box of its shapes.",
                hint="Give it in the link's frame, in metres; or compute it from the shape, as --fix does.",
                value=outside,
                limit=allowed,
                unit="mm",
            )


def density(declared: Declared) -> Iterator[Finding]:
    """A body denser than any matter, even if it filled the hull of its shapes; or less dense than air."""
    for link in declared.links:
        inertial = link.inertial
        if inertial is None or not (inertial.mass or 0.0) > 0 or not _all_read(link) or _shared(declared, link.name):
            continue
        mass, volume = inertial.mass or 0.0, _largest_volume(link)
        if volume is None:
            continue
        found, heavy = mass / (volume * 1e-9), mass / (volume * 1e-9) > DENSEST_KG_M3
        if heavy:  # a hollow body may be, a filled one not
            volume = max(volume, _hull_volume(link))
            found = mass / (volume * 1e-9)
        limit = DENSEST_KG_M3 if heavy else THINNEST_KG_M3
        if (found <= limit) if heavy else (found >= limit):
            continue
        yield Finding(
            code="W_AUDIT_DENSITY",
            where=link.where,
            parts=(link.name,),
            message=f"{link.name} weighs {mass:.4g} kg and its shapes, with cavities filled, have {volume:.4g} mm³: {found:.4g} kg/m³, {'more than osmium' if heavy else 'less than air'}.",
            hint="Check the units of mass and mesh; steel is 7850 kg/m³, wood 700. Or leave <inertial> out and use --fix with --density.",
            value=found,
            limit=limit,
            unit="kg/m³",
            cause="units" if max(found / limit, limit / found) > UNITS and any(shape.kind == "mesh" for shape in link.shapes) else None,
        )


def _hull_volume(link: DeclaredLink) -> float:
    """Return the volume of the convex hull of all shapes [mm³]; 0 if they are flat."""
    from scipy.spatial import ConvexHull, QhullError  # noqa: PLC0415 - 0.2 s that only suspicious links need

    try:
        return float(ConvexHull(link.points).volume)
    except (QhullError, ValueError):
        return 0.0


def _is_power_of_ten(value: float) -> bool:
    return math.isclose(math.log10(value), round(math.log10(value)), abs_tol=1e-9)


def _weighed(declared: Declared) -> Iterator[tuple[DeclaredLink, DeclaredInertial, float]]:
    """Yield the links that have mass and inertia."""
    for link in declared.links:
        if link.inertial is not None and link.inertial.inertia is not None and (link.inertial.mass or 0.0) > 0:
            yield link, link.inertial, link.inertial.mass or 0.0


def _mass(link: DeclaredLink) -> float | None:
    return None if link.inertial is None else link.inertial.mass


def _shared(declared: Declared, name: str) -> bool:
    """True if a fixed neighbour has no mass of its own: then this link's mass may include it."""
    return any(
        declared.by_name[other].shapes and _mass(declared.by_name[other]) in {None, 0.0}
        for other in declared.rigid_groups[name]
        if other != name
    )


def _all_read(link: DeclaredLink) -> bool:
    return all(shape.mesh is not None for shape in link.shapes)


def _is_thin(link: DeclaredLink) -> bool:
    """True if the shapes are flatter than any real part: a sheet or a wire has a moment of nearly zero."""
    return bool(len(link.points)) and float(np.ptp(link.points, axis=0).min()) < LEAST_SIZE_MM


def _largest_volume(link: DeclaredLink) -> float | None:
    """Return the larger of the volumes of its visual and its collision shapes [mm³]; None if one is not a closed mesh."""
    meshes = [(shape.role, shape.mesh) for shape in link.shapes if shape.mesh is not None]
    if not meshes or any(not mesh.is_closed or mesh.volume <= 0 for _, mesh in meshes):
        return None
    return max(sum(mesh.volume for role, mesh in meshes if role == wanted) for wanted in ("visual", "collision")) or None


CHECKS = (missing, massless_carriers, impossible_mass, zero, not_positive, triangle, beyond_shape, centre_outside, density)
