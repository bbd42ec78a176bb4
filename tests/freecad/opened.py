"""FreeCAD documents, opened by FreeCAD in a new process; and residuals of joints, computed here."""

from __future__ import annotations

import json
import os
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from articad.assembly import Assembly
from articad.connectors.mate import FLIP, Mate
from articad.connectors.se3 import SE3
from articad.errors import KernelUnavailableError
from articad.kernels import freecad_install
from articad.kernels.freecad_install import FreeCAD
from articad.kinematics.joints import Joint

Json = dict[str, Any]
FloatArray = NDArray[np.float64]

OWN_KINDS = ("fixed", "revolute", "slider", "cylindrical", "ball")  # of joints that FreeCAD has by itself
EXAMINE = Path(freecad_install.__file__).parent / "inside_freecad" / "examine.py"


def why_not() -> str:
    """Return why there is no FreeCAD here, or nothing."""
    try:
        freecad_install.find()
    except KernelUnavailableError as error:
        return error.message
    return ""


WHY_NOT = why_not()
# where CI=true these tests run without FreeCAD too, and fail: it is to be there
needs_freecad = pytest.mark.skipif(bool(WHY_NOT) and os.environ.get("CI") != "true", reason=f"no FreeCAD 1.0 or later here: {WHY_NOT}")


def newer() -> FreeCAD:
    """Return the FreeCAD of the next series, which `articad install freecad --next` leaves beside the other."""
    return FreeCAD("/usr/bin/freecadcmd", root=freecad_install.tree().with_name("freecad-next"))


def steps(content: bytes, *wanted: Json, freecad: FreeCAD | None = None) -> list[Json]:
    """Do steps on a document in a new FreeCAD process."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        (folder / "it.FCStd").write_bytes(content)
        (folder / "job.json").write_text(json.dumps({"file": "it.FCStd", "steps": wanted}))
        ended = (freecad or freecad_install.find()).run(EXAMINE, folder=folder, limits=freecad_install.FreeCADLimits(seconds=600.0))
        assert (folder / "report.json").is_file(), ended.said
        report: Json = json.loads((folder / "report.json").read_text())
    return list(report["steps"])


def frames(rows: dict[str, list[float]]) -> dict[str, SE3]:
    return {name: SE3.from_quaternion(row[3:], row[:3]) for name, row in rows.items()}


def residual(joint: Joint, parts: dict[str, SE3]) -> tuple[float, float]:
    """Return by how much a joint does not hold [mm, rad]; a flipped axis is an error of pi."""
    C_c = joint.T_child_connector @ (FLIP if joint.mate is Mate.OPPOSED else SE3.identity())
    D = (parts[joint.parent] @ joint.T_parent_connector).inverse() @ parts[joint.child] @ C_c
    x, y, z = D.translation
    R = D.rotation
    tilt = float(np.arctan2(np.hypot(R[0, 2], R[1, 2]), R[2, 2]))
    roll = float(abs(np.arctan2(R[1, 0] - R[0, 1], R[0, 0] + R[1, 1])))
    whole = float(np.linalg.norm(D.log()[3:]))
    off, away = float(np.hypot(x, y)), float(np.linalg.norm(D.translation))
    return {
        "fixed": (away, whole),
        "revolute": (away, tilt),
        "slider": (off, max(tilt, roll)),
        "cylindrical": (off, tilt),
        "screw": (off, tilt),
        "ball": (away, 0.0),
        "planar": (abs(float(z)), tilt),
        "universal": (away, abs(float(R[0, 1]))),
    }[str(joint.type)]


def worst(assembly: Assembly, parts: dict[str, SE3], connectors: dict[str, dict[str, list[float]]] | None = None) -> tuple[float, float]:
    """Return the largest residuals over all joints [mm, rad], with the connectors of the assembly or those of a document."""
    joints = assembly.joints
    if connectors is not None:
        held = {part: frames(rows) for part, rows in connectors.items()}
        joints = tuple(
            replace(
                joint,
                T_parent_connector=held[joint.parent][joint.parent_connector],
                T_child_connector=held[joint.child][joint.child_connector],
            )
            for joint in joints
        )
    rows = [residual(joint, parts) for joint in joints]
    return max(row[0] for row in rows), max(row[1] for row in rows)


def moved(before: dict[str, SE3], after: dict[str, SE3]) -> tuple[float, float]:
    """Return the largest motion of a part [mm, rad]."""
    return (
        max(float(np.linalg.norm(before[name].translation - after[name].translation)) for name in before),
        max(float(np.linalg.norm((before[name].inverse() @ after[name]).log()[3:])) for name in before),
    )


def small(found: tuple[float, float], mm: float, rad: float) -> bool:
    return found[0] <= mm and found[1] <= rad


def shaken(rng: np.random.Generator) -> list[float]:
    """Return a motion of up to 20 mm and 30 degrees."""
    axis, direction = (vector / np.linalg.norm(vector) for vector in rng.normal(size=(2, 3)))
    T = SE3.from_axis_angle(axis, float(rng.uniform(0, np.radians(30))))
    return [*(direction * rng.uniform(0, 20)), *T.quaternion]
