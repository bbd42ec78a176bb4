"""Whether a script took a diameter for a radius, or a radius for a diameter."""

from __future__ import annotations

import itertools
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Final, NamedTuple

from articad.findings import Finding, Findings
from articad.geometry.faces import Face, faces_of
from articad.geometry.mesh import TriMesh

_RADIUS: Final = re.compile(r"radius|(^|_)r(_|$)")
_DIAMETER: Final = re.compile(r"diameter|(^|_)(d|dia)(_|$)")
_NO_FACE: Final = re.compile(r"crank|throw|pitch|circle|bend|edge|fillet|corner|round|swing|orbit|path|cent(re|er)|distance|offset")
"""Words of radii on which features lie, or of edges: the solid need not have a round face of that size."""
_SAME: Final = 2e-3  # difference of two radii, as a share: a mesh has that of a cylinder to a few 1e-4
_ROUND: Final = ("cylinder", "sphere")


class _Mistaken(NamedTuple):
    """A dimension, the radius that it states, and the radius that was built instead [mm]."""

    dimension: str
    stated: float
    built: float


def radius_findings(part: str, mesh: TriMesh, lengths: Mapping[str, float]) -> Findings:
    """Return W_RADIUS_MISTAKEN for each dimension that states a radius or a diameter which no round face has, where one has twice or half of it.

    Nothing is said if another dimension, or the sum or difference of two, explains the face that has twice or half: then it is another face.

    Args:
        part: Its name.
        mesh: Its surface, in any frame [mm].
        lengths: Its dimensions by name [mm].
    """
    return Findings(
        Finding(
            code="W_RADIUS_MISTAKEN",
            where=f"parts.{part}.dimensions.{found.dimension}",
            parts=(part,),
            message=f"Dimension {found.dimension!r} of {part} is {lengths[found.dimension]:.6g} mm, but no round face has the radius "
            f"{found.stated:.6g} mm, and one has {'twice' if found.built > found.stated else 'half'} of it, {found.built:.6g} mm.",
            hint=f"Build the feature with the radius {found.stated:.6g} mm: "
            f"{found.dimension} is a {'radius, not a diameter' if _is_radius(found.dimension) else 'diameter, not a radius'}.",
            value=found.built,
            limit=found.stated,
            unit="mm",
        )
        for found in _mistaken(faces_of(mesh), lengths)
    )


def _is_radius(name: str) -> bool:
    return bool(_RADIUS.search(name))


def _is_round(name: str) -> bool:
    return _is_radius(name) != bool(_DIAMETER.search(name))


def _mistaken(faces: Iterable[Face], lengths: Mapping[str, float]) -> Iterator[_Mistaken]:
    radii = {face.radius for face in faces if face.kind in _ROUND}
    for name, value in lengths.items():
        if value <= 0 or not _is_round(name) or _NO_FACE.search(name):
            continue
        stated = value if _is_radius(name) else value / 2
        if any(_same(radius, stated) for radius in radii):
            continue
        for built in sorted(radii):
            if (_same(built, 2 * stated) or _same(built, stated / 2)) and not _explained(built, name, lengths):
                yield _Mistaken(name, stated, built)
                break


def _explained(radius: float, name: str, lengths: Mapping[str, float]) -> bool:
    """Return whether another dimension gives a radius, as a radius or a diameter, or that of a round thing and a wall or clearance on it do."""
    others = [length for other, length in lengths.items() if other != name]
    rounds = [length * (1.0 if _is_radius(other) else 0.5) for other, length in lengths.items() if _is_round(other)]
    walls = [length for other, length in lengths.items() if not _is_round(other)]
    terms = [*others, *(length / 2 for length in others)]
    terms += [abs(one + sign * wall) for one, wall in itertools.product(rounds, walls) for sign in (1, -1)]
    return any(_same(radius, term) for term in terms)


def _same(a: float, b: float) -> bool:
    return abs(a - b) <= _SAME * max(abs(a), abs(b))
