"""articad's own records inside files of other formats, so that reading them back loses nothing.

A record is one JSON object: `{"kind": "assembly" | "part" | "joint" | "coupling" | "material" | "fit" | "waiver" | "kept", …}`, in mm, rad, kg and
N·mm, numbers in full, frames as seven numbers `x y z qx qy qz qw`; null stands for an infinite limit. URDF holds each as the text
of an `<articad>` element below `<robot>`, MJCF as the data of a `<text>` below `<custom>`.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from dataclasses import asdict, is_dataclass
from typing import TYPE_CHECKING, Any

from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.export.fingerprint import fingerprint
from articad.export.lowering import Link, LoweredModel
from articad.export.meshes import MeshFiles
from articad.geometry.part import Part
from articad.kinematics.joints import Coupling, Joint

if TYPE_CHECKING:
    from articad.assembly import Assembly

VERSION = 1

Record = dict[str, Any]


def records(assembly: Assembly, model: LoweredModel, files: MeshFiles, written: Iterable[Any] = ()) -> list[Record]:
    """Return everything that a format does not hold by itself.

    Args:
        assembly: The assembly that is exported.
        model: Its lowering, with the names of parts and joints in the file.
        files: The meshes of the bundle.
        written: The elements that state the same data in the format's own terms; editing them makes the records outdated.
    """
    links = {link.part.name: link for link in model.links}
    names = {lowered.joint.name: lowered.name for lowered in (*model.joints, *model.loops)}
    mechanism = assembly.mechanism
    return [
        {
            "kind": "assembly",
            "version": VERSION,
            "name": assembly.name,
            "ground": mechanism.ground,
            "frame": _frame(mechanism.T_ground),
            "deflection": assembly.deflection,
            "fingerprint": fingerprint(elements) if (elements := list(written)) else None,
            **({"foreign": True} if assembly.foreign else {}),
        },
        *({"kind": "material", **asdict(material)} for material in assembly.materials.values()),
        *(_part(links[name], files) for name in mechanism.parts),
        *(_joint(joint, names[joint.name]) for joint in mechanism.joints),
        *(_coupling(coupling) for coupling in mechanism.couplings),
        *({"kind": "fit", "joint": joint, **_plain(fit)} for joint, fit in assembly.fits.items()),
        *({"kind": "waiver", **_plain(waiver)} for waiver in assembly.waivers),
        *({"kind": "kept", **_plain(kept)} for kept in assembly.kept),
    ]


def dumps(record: Record) -> str:
    """Return the record as one line of ASCII JSON, so that it fits any XML."""
    return json.dumps(record, ensure_ascii=True, allow_nan=False)


def _part(link: Link, files: MeshFiles) -> Record:
    part = link.part
    return {
        "kind": "part",
        "name": part.name,
        "link": link.name,
        "color": part.color,
        "material": part.material,
        "mass": None if part.mass is None else {"kg": part.mass.mass, "com": part.mass.com.tolist(), "inertia": part.mass.inertia.tolist()},
        "solid": _solid(part, files),
        "connectors": [_connector(connector) for connector in part.connectors.values()],
        "visuals": _shapes(part.visuals, files),
        "collisions": _shapes(part.collisions, files),
    }


def _solid(part: Part, files: MeshFiles) -> Record | None:
    if part.solid is None:
        return None
    solid = part.solid
    return {
        "file": files.by_digest.get(solid.mesh.digest),
        "deflection": solid.deflection + files.deviation(solid.mesh),
        "volume": solid.volume,
        "area": solid.area,
        "com": solid.com.tolist(),
        "inertia": solid.inertia_mm5.tolist(),
    }


def _shapes(shapes: tuple[Any, ...], files: MeshFiles) -> list[Record]:
    return [
        {
            "file": files.by_digest.get(shape.mesh.digest),
            "frame": _frame(shape.frame),
            "color": shape.color,
            "name": shape.name,
            **({"primitive": [shape.primitive.kind, *shape.primitive.size]} if shape.primitive else {}),
        }
        for shape in shapes
    ]


def _connector(connector: Connector) -> Record:
    return {
        "name": connector.name,
        "frame": _frame(connector.frame),
        "label": connector.label,
        "type": connector.kind,
        "roll_free": connector.roll_free,
    }


def _joint(joint: Joint, name: str) -> Record:
    return {
        "kind": "joint",
        "name": joint.name,
        "as": name,
        "type": str(joint.type),
        "parent": joint.parent,
        "child": joint.child,
        "parent_connector": joint.parent_connector,
        "child_connector": joint.child_connector,
        "parent_frame": _frame(joint.T_parent_connector),
        "child_frame": _frame(joint.T_child_connector),
        "mate": str(joint.mate),
        "lower": [_finite(value) for value in joint.limits.lower],
        "upper": [_finite(value) for value in joint.limits.upper],
        "cone": joint.limits.cone,
        "twist": None if joint.limits.twist is None else list(joint.limits.twist),
        "rest": list(joint.rest),
        "lead": joint.lead,
        "driver": joint.driver,
        **({"closing": True} if joint.closing else {}),
        "effort": list(joint.effort),
        "velocity": list(joint.velocity),
        **({"damping": list(joint.damping)} if joint.damping else {}),
        **({"friction": list(joint.friction)} if joint.friction else {}),
        **({"fastening": joint.fastening} if joint.fastening else {}),
    }


def _coupling(coupling: Coupling) -> Record:
    return {
        "kind": "coupling",
        "name": coupling.name,
        "type": coupling.kind,
        "a": coupling.a,
        "b": coupling.b,
        "ratio": coupling.ratio,
        "offset": coupling.offset,
    }


def _plain(value: Any) -> Record:
    return asdict(value) if is_dataclass(value) and not isinstance(value, type) else dict(value)


def _frame(T: SE3) -> list[float]:
    return [float(x) for x in T.data]


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
