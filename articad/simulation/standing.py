"""The cheap half of a simulation: an export is loaded, held at rest and let go, but not driven."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from articad.assembly import Assembly
from articad.export.lowering import lower
from articad.findings import Findings
from articad.simulation.trial import SECONDS, try_out
from articad.simulation.verdict import SimulationVerdict

STANDING: Final = ("urdf", "mjcf")  # formats that MuJoCo loads


def stands(assembly: Assembly, path: Path, *, seconds: float = SECONDS) -> Findings:
    """Return what is wrong with an export in MuJoCo: it does not load, moves at rest, a loop is open, or energy grows.

    If it does not finish in time, that is a warning: nothing was tried.

    Args:
        assembly: What was exported: it states the rest pose, which a URDF does not.
        path: The URDF or MJCF file.
        seconds: Time after which the simulation is stopped.
    """
    model = lower(assembly)
    rest = {freedom.name: freedom.rest for joint in (*model.joints, *model.loops) for freedom in joint.freedoms}
    outcome = try_out("mujoco", path, rest=rest, opened=tuple(rest), seconds=seconds)
    return Findings(finding for finding in SimulationVerdict(str(path), (outcome,)).findings if finding.severity != "info")
