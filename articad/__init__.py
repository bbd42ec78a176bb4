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
    "AuditOptions": "auditing.examine",
    "AssemblyPlan": "plan.schema",
    "Attachment": "connectors.attachment",
    "Budget": "agents.llm",
    "Bundle": "export.bundle",
    "Checks": "interference.report",
    "Connector": "connectors.connector",
    "Coupling": "kinematics.joints",
    "Dynamics": "kinematics.dynamics",
    "Finding": "findings",
    "Findings": "findings",
    "Fit": "plan.resolve",
    "Joint": "kinematics.joints",
    "LiteLLM": "agents.live",
    "MassProperties": "geometry.mass",
    "Material": "plan.resolve",
    "Mechanism": "kinematics.mechanism",
    "Part": "geometry.part",
    "Replay": "agents.llm",
    "Run": "runs.run",
    "RunOptions": "agents.settings",
    "SE3": "connectors.se3",
    "Scripted": "agents.llm",
    "Services": "agents.settings",
    "TriMesh": "geometry.mesh",
    "Waiver": "plan.resolve",
    "ball": "kinematics.declare",
    "assembly_order": "entry",
    "audit": "entry",
    "build": "assembly",
    "certify": "entry",
    "check_plan": "plan.check",
    "convert": "formats",
    "cylindrical": "kinematics.declare",
    "edit": "agents.edit",
    "fixed": "kinematics.declare",
    "free": "kinematics.declare",
    "generate": "agents.pipeline",
    "planar": "kinematics.declare",
    "read": "entry",
    "replay": "agents.pipeline",
    "revolute": "kinematics.declare",
    "screw": "kinematics.declare",
    "simulate": "entry",
    "slider": "kinematics.declare",
    "universal": "kinematics.declare",
    "write": "formats",
    "write_3mf": "export.threemf",
    "write_freecad": "export.freecad",
    "write_glb": "export.gltf",
    "write_mjcf": "export.mjcf",
    "write_plan": "export.plan",
    "write_sdf": "export.sdf",
    "write_step": "export.step",
    "write_urdf": "export.urdf",
    "write_usd": "export.usd",
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
    from articad.agents.settings import RunOptions as RunOptions
    from articad.agents.settings import Services as Services
    from articad.assembly import Assembly as Assembly
    from articad.assembly import build as build
    from articad.auditing.examine import AuditOptions as AuditOptions
    from articad.connectors.attachment import Attachment as Attachment
    from articad.connectors.connector import Connector as Connector
    from articad.connectors.se3 import SE3 as SE3
    from articad.entry import assembly_order as assembly_order
    from articad.entry import audit as audit
    from articad.entry import certify as certify
    from articad.entry import read as read
    from articad.entry import simulate as simulate
    from articad.errors import ArticadError as ArticadError
    from articad.export.bundle import Bundle as Bundle
    from articad.export.freecad import write_freecad as write_freecad
    from articad.export.gltf import write_glb as write_glb
    from articad.export.mjcf import write_mjcf as write_mjcf
    from articad.export.plan import write_plan as write_plan
    from articad.export.sdf import write_sdf as write_sdf
    from articad.export.step import write_step as write_step
    from articad.export.threemf import write_3mf as write_3mf
    from articad.export.urdf import write_urdf as write_urdf
    from articad.export.usd import write_usd as write_usd
    from articad.findings import Finding as Finding
    from articad.findings import Findings as Findings
    from articad.formats import convert as convert
    from articad.formats import write as write
    from articad.geometry.mass import MassProperties as MassProperties
    from articad.geometry.mesh import TriMesh as TriMesh
    from articad.geometry.part import Part as Part
    from articad.interference.report import Checks as Checks
    from articad.kinematics.declare import ball as ball
    from articad.kinematics.declare import cylindrical as cylindrical
    from articad.kinematics.declare import fixed as fixed
    from articad.kinematics.declare import free as free
    from articad.kinematics.declare import planar as planar
    from articad.kinematics.declare import revolute as revolute
    from articad.kinematics.declare import screw as screw
    from articad.kinematics.declare import slider as slider
    from articad.kinematics.declare import universal as universal
    from articad.kinematics.dynamics import Dynamics as Dynamics
    from articad.kinematics.joints import Coupling as Coupling
    from articad.kinematics.joints import Joint as Joint
    from articad.kinematics.mechanism import Mechanism as Mechanism
    from articad.plan.check import check_plan as check_plan
    from articad.plan.resolve import Fit as Fit
    from articad.plan.resolve import Material as Material
    from articad.plan.resolve import Waiver as Waiver
    from articad.plan.schema import AssemblyPlan as AssemblyPlan
    from articad.runs.run import Run as Run
