"""Misplaced shapes: scripts that built their part mirrored, turned, shifted or in another unit, against its connectors.

The shape of each part with faults at rest is shifted, mirrored, turned and enlarged, and measured again. If its faults are then gone and its joints
are made, the script put the shape in the wrong place. Nothing is proven about parts that no such motion heals.
"""

from __future__ import annotations

import math
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from articad.arrays import FloatArray
from articad.assembly import Assembly, Poses
from articad.certificates.fits import check_fits, followed
from articad.connectors.se3 import SE3
from articad.findings import Finding
from articad.geometry.mesh import TriMesh
from articad.interference.check import check_scene
from articad.interference.report import PairCheck
from articad.interference.scene import Scene
from articad.kernels.slips import UNITS
from articad.realisation.verdicts import check_joints

__all__ = ["Misplaced", "misplaced"]

_AXES: Final = "xyz"
_AT_ONCE: Final = 3  # parts that are tried
_TOLD: Final = 2  # motions that a hint states
_LEAST_MM: Final = 1.0  # a smaller shift is a matter of fits
_SHIFTS: Final = 2  # distances that are tried, the shallowest overlaps


class Misplaced(NamedTuple):
    """A script that built its part elsewhere.

    Attributes:
        part: The part that has the script.
        how: What brings the shape to its place: "mirrored at x = 0".
    """

    part: str
    how: str


class _Motion(NamedTuple):
    """A motion or enlargement of a shape `(4, 4)` in its part's frame, in words."""

    how: str
    matrix: FloatArray


def misplaced(
    assembly: Assembly,
    scene: Scene,
    sources: Mapping[str, str],
    faults: Sequence[Finding],
    pairs: Iterable[PairCheck],
    *,
    doubted: Container[str] = (),
) -> Misplaced | None:
    """Return the one script whose shape, moved as a whole, heals more faults than that of any other; None if there is none or it is not clear.

    Args:
        assembly: The product at rest.
        scene: Its scene.
        sources: The part that has the script, by part.
        faults: Errors about two parts at rest.
        pairs: Verdicts of all pairs at rest.
        doubted: Parts with a dimension out of proportion. If any of them has a fault, only these are tried, and only in other units.
    """
    counts: dict[str, int] = {}
    for finding in faults:
        for source in _of(sources, finding):
            counts[source] = counts.get(source, 0) + 1
    scaled = [source for source in sorted(counts) if source in doubted]
    suspects = scaled or sorted(counts, key=lambda source: (-counts[source], source))[:_AT_ONCE]
    known, reached = {pair.parts: pair for pair in pairs}, followed(assembly.mechanism)
    found = []
    for source in suspects:
        values = {round(abs(one.value), 3) for one in faults if one.value and source in _of(sources, one)}
        depths = sorted(value for value in values if value >= _LEAST_MM)
        motions = _enlargements() if scaled else _motions(depths[:_SHIFTS])
        how = _healing(assembly, scene, sources, source, motions, known, reached)
        found += [Misplaced(source, " or ".join(how))] if how else []
    most = max((counts[one.part] for one in found), default=0)
    best = [one for one in found if counts[one.part] == most]
    return best[0] if len(best) == 1 else None


def _of(sources: Mapping[str, str], finding: Finding) -> set[str]:
    return {sources[name] for name in finding.parts if name in sources}


def _healing(
    assembly: Assembly,
    scene: Scene,
    sources: Mapping[str, str],
    source: str,
    motions: Iterable[_Motion],
    known: Mapping[tuple[str, str], PairCheck],
    reached: Mapping[str, tuple[float, float]],
) -> list[str]:
    """Return how a part's shape can be moved so that its faults are gone; `reached` are the ranges of coordinates of linkages."""
    copies = frozenset(name for name in scene.meshes if sources.get(name) == source)
    joints = [joint.name for joint in assembly.joints if copies & {joint.parent, joint.child}]
    others = {names: pair for names, pair in known.items() if copies.isdisjoint(names)}
    poses = Poses(assembly.mechanism.parts, assembly.mechanism.at_rest)
    fits = [name for name in joints if name in assembly.fits]

    def loose(scene: Scene) -> set[tuple[str, str]]:
        """Return the findings about joints that surfaces do not make, by code and place."""
        made = check_joints(scene, poses, reached=reached, joints=joints)
        return {(finding.code, finding.where) for finding in made.findings}

    before = loose(scene)
    healing: list[str] = []
    for motion in motions:
        moved = replace(scene, meshes=dict(scene.meshes) | {name: _moved(assembly, scene, source, name, motion) for name in copies})
        if check_scene(moved, poses, over="rest", ground=assembly.ground, known=others).findings.errors:
            continue
        if fits and not check_fits(moved, reached, joints=fits).findings.ok:
            continue
        if loose(moved) <= before:
            healing.append(motion.how)
        if len(healing) == _TOLD:
            break
    return healing


def _motions(depths: Iterable[float]) -> Iterator[_Motion]:
    """Yield shifts along the axes of a part's frame by given distances [mm], reflections at its planes, and turns about its axes."""
    for depth in depths:
        for at, axis in enumerate(_AXES):
            for shift in (depth, -depth):
                yield _Motion(f"moved by {shift:.4g} mm along {axis}", np.asarray(SE3.from_translation(np.eye(3)[at] * shift).matrix))
    for at, axis in enumerate(_AXES):
        signs = np.ones(4)
        signs[at] = -1.0
        yield _Motion(f"mirrored at {axis} = 0", np.diag(signs))
    for at, axis in enumerate(_AXES):
        for degrees in (90, -90, 180):
            turned = SE3.from_axis_angle(np.eye(3)[at], math.radians(degrees))
            yield _Motion(f"turned by {degrees}° about {axis}", np.asarray(turned.matrix))


def _enlargements() -> Iterator[_Motion]:
    """Yield enlargements from other units."""
    for factor, unit in UNITS.items():
        yield _Motion(f"enlarged {factor:g} times, from {unit},", np.diag([factor, factor, factor, 1.0]))


def _moved(assembly: Assembly, scene: Scene, source: str, name: str, motion: _Motion) -> TriMesh:
    """Return the mesh of a part or of its copy after its source's shape was moved: with a reflection S of the copy, by S T S⁻¹."""
    matrix = motion.matrix
    planned = None if assembly.resolved is None else assembly.resolved.parts[name].derivation
    if name != source and planned is not None and planned.S is not None:
        S = np.asarray(planned.S)
        matrix = S @ matrix @ np.linalg.inv(S)
    mesh, volume = scene.meshes[name], float(np.linalg.det(matrix[:3, :3]))
    if volume < 0.0:
        return mesh.reflected(matrix)
    factor = float(np.cbrt(volume))
    rigid = matrix @ np.diag([1.0 / factor, 1.0 / factor, 1.0 / factor, 1.0])
    return mesh.scaled(factor).transformed(SE3.from_matrix(rigid))
