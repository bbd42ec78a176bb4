"""Loops as mimics: dependent joints as linear functions of the driver, if that is accurate enough."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from articad.arrays import FloatArray
from articad.errors import ExportError, KinematicsError
from articad.export.lowering import Follows, LoweredModel
from articad.findings import Finding
from articad.geometry.part import Part
from articad.kinematics.mechanism import Mechanism

if TYPE_CHECKING:
    from articad.assembly import Assembly


LARGEST_GAP_MM = 0.1  # largest error of any point of a part if a linear relation replaces a loop
SAMPLES = 33  # of the driver's range


def linear_followers(assembly: Assembly, model: LoweredModel) -> dict[str, Follows]:
    """Return the leader of each dependent joint of the tree, with the straight line that fits its motion best.

    Raises:
        ExportError: E_MIMIC_FIT if there is not exactly one driver, or a part would be off by more than 0.1 mm.
    """
    mechanism = assembly.mechanism
    if len(mechanism.drivers) != 1:
        raise _refused(assembly, f"It has {len(mechanism.drivers)} drivers, and a mimic joint follows only one.", None)
    driver = mechanism.drivers[0]
    freedoms = {freedom.column: freedom for joint in model.joints for freedom in joint.freedoms if freedom.column is not None}
    if driver.name not in freedoms:
        raise _refused(assembly, f"Its driver {driver.name!r} closes a loop, so it is not in the file.", None)
    samples = _samples(driver.lower, driver.upper, driver.rest)
    try:
        columns = mechanism.configuration(samples[:, None]).columns
    except KinematicsError as error:
        raise _refused(assembly, f"It does not reach its whole range: {error.message}", None) from error
    names = [coordinate.name for coordinate in mechanism.coordinates]
    fitted = columns.copy()
    lines = {}
    for index, name in enumerate(names):
        if name in freedoms and name != driver.name:
            slope, offset = np.polyfit(samples, columns[:, index], 1)
            fitted[:, index] = slope * samples + offset
            lines[name] = float(slope), float(offset)
    gap = _largest_gap(assembly, columns, fitted)
    if gap > LARGEST_GAP_MM:
        raise _refused(assembly, f"A straight line is off by up to {gap:.3g} mm.", gap)
    leader = freedoms[driver.name]
    unit = {name: 1000.0 if freedoms[name].kind == "slide" else 1.0 for name in (*lines, driver.name)}
    return {
        freedoms[name].name: Follows(leader.name, slope * unit[driver.name] / unit[name], offset / unit[name])
        for name, (slope, offset) in lines.items()
    }


def _samples(lower: float, upper: float, rest: float) -> FloatArray:
    if not math.isfinite(upper - lower):
        lower, upper = rest - math.pi, rest + math.pi
    return np.linspace(lower, upper, SAMPLES)


def _largest_gap(assembly: Assembly, exact: FloatArray, fitted: FloatArray) -> float:
    """Return the largest distance [mm] of any corner of a part's bounding box between the exact motion and the fit."""
    mechanism = assembly.mechanism
    closing = {joint.name for joint in mechanism.loop_joints}
    tree = [joint for joint in mechanism.joints if joint.name not in closing]
    kept = [index for index, coordinate in enumerate(mechanism.coordinates) if coordinate.joint not in closing]
    opened = Mechanism(mechanism.parts, mechanism.ground, tree, T_ground=mechanism.T_ground)
    there, here = opened.poses(exact[:, kept]), opened.poses(fitted[:, kept])
    gap = 0.0
    for index, name in enumerate(mechanism.parts):
        points = _corners(assembly.parts[name])
        apart = there[:, index][:, None].apply(points[None]) - here[:, index][:, None].apply(points[None])
        gap = max(gap, float(np.linalg.norm(apart, axis=-1).max()))
    return gap


def _corners(part: Part) -> FloatArray:
    """Return the corners of a part's bounding box and its connectors' origins [mm], `(n, 3)`."""
    points = [connector.frame.translation for connector in part.connectors.values()]
    if part.mesh is not None:
        low, high = part.mesh.bounds
        points += [np.where([i & 1, i & 2, i & 4], high, low) for i in range(8)]
    return np.array(points or [np.zeros(3)])


def _refused(assembly: Assembly, reason: str, gap: float | None) -> ExportError:
    finding = Finding(
        code="E_MIMIC_FIT",
        where="joints",
        message=f"The loops of {assembly.name!r} cannot be written as mimics. {reason}",
        hint="Use loops none, isaac or drake, or MJCF, which closes loops.",
        value=gap,
        limit=LARGEST_GAP_MM,
        unit="mm",
    )
    return ExportError(finding.message, findings=[finding])
