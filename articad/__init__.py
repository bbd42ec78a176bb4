"""articad: editable, articulated CAD assemblies from text, images or a plan.

Names are loaded when they are first used, so that `import articad` costs nothing that is not needed.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_MODULE_OF = {
    "ArticadError": "errors",
    "Assembly": "assembly",
    "AssemblyPlan": "plan.schema",
    "Attachment": "connectors.attachment",
    "Budget": "agents.llm",
    "Bundle": "export.bundle",
    "Checks": "interference.check",
    "Connector": "connectors.connector",
    "Coupling": "kinematics.joints",
    "Finding": "findings",
    "Findings": "findings",
    "Joint": "kinematics.joints",
    "LiteLLM": "agents.live",
    "MassProperties": "geometry.part",
    "Mechanism": "kinematics.mechanism",
    "Part": "geometry.part",
    "Replay": "agents.llm",
    "Run": "runs.run",
    "SE3": "connectors.se3",
    "Scripted": "agents.llm",
    "TriMesh": "geometry.mesh",
    "ball": "kinematics.declare",
    "build": "assembly",
    "check_plan": "plan.check",
    "cylindrical": "kinematics.declare",
    "edit": "agents.edit",
    "fixed": "kinematics.declare",
    "generate": "agents.pipeline",
    "planar": "kinematics.declare",
    "replay": "agents.pipeline",
    "revolute": "kinematics.declare",
    "screw": "kinematics.declare",
    "slider": "kinematics.declare",
    "universal": "kinematics.declare",
    "write_freecad": "export.freecad",
    "write_mjcf": "export.mjcf",
    "write_urdf": "export.urdf",
}

__all__ = [  # noqa: PLE0604, RUF100 - the table above is the list
    "__version__",
    *_MODULE_OF,
]


def __getattr__(name: str) -> Any:
    """Load a public name from its module."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module 'articad' has no attribute {name!r}")
    value = getattr(import_module(f"articad.{_MODULE_OF[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)


if TYPE_CHECKING:
    from articad.agents.edit import edit as edit
    from articad.agents.live import LiteLLM as LiteLLM
    from articad.agents.llm import Budget as Budget
    from articad.agents.llm import Replay as Replay
    from articad.agents.llm import Scripted as Scripted
    from articad.agents.pipeline import generate as generate
    from articad.agents.pipeline import replay as replay
    from articad.assembly import Assembly as Assembly
    from articad.assembly import build as build
    from articad.connectors.attachment import Attachment as Attachment
    from articad.connectors.connector import Connector as Connector
    from articad.connectors.se3 import SE3 as SE3
    from articad.errors import ArticadError as ArticadError
    from articad.export.bundle import Bundle as Bundle
    from articad.export.freecad import write_freecad as write_freecad
    from articad.export.mjcf import write_mjcf as write_mjcf
    from articad.export.urdf import write_urdf as write_urdf
    from articad.findings import Finding as Finding
    from articad.findings import Findings as Findings
    from articad.geometry.mesh import TriMesh as TriMesh
    from articad.geometry.part import MassProperties as MassProperties
    from articad.geometry.part import Part as Part
    from articad.interference.check import Checks as Checks
    from articad.kinematics.declare import ball as ball
    from articad.kinematics.declare import cylindrical as cylindrical
    from articad.kinematics.declare import fixed as fixed
    from articad.kinematics.declare import planar as planar
    from articad.kinematics.declare import revolute as revolute
    from articad.kinematics.declare import screw as screw
    from articad.kinematics.declare import slider as slider
    from articad.kinematics.declare import universal as universal
    from articad.kinematics.joints import Coupling as Coupling
    from articad.kinematics.joints import Joint as Joint
    from articad.kinematics.mechanism import Mechanism as Mechanism
    from articad.plan.check import check_plan as check_plan
    from articad.plan.schema import AssemblyPlan as AssemblyPlan
    from articad.runs.run import Run as Run
