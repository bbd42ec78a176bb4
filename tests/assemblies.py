"""Assemblies made in Python for tests: no plan, no kernel, meshes of a few triangles."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from articad.assembly import Assembly
from articad.connectors.attachment import Attachment
from articad.connectors.connector import Connector
from articad.connectors.mate import flip
from articad.connectors.se3 import SE3
from articad.geometry.part import Part
from articad.geometry.shapes import box
from articad.kinematics import declare
from articad.kinematics.configuration import Configuration
from articad.kinematics.joints import Coupling, Joint, JointType

STEEL = 7850.0


def frame(*, at: tuple[float, float, float] = (0, 0, 0), z: tuple[float, float, float] = (0, 0, 1), x: Any = None) -> SE3:
    return SE3.from_axes(at, z, x)


def block(name: str, size: tuple[float, float, float] = (20, 30, 40), **connectors: SE3) -> Part:
    return Part.from_mesh(
        name, box(*size), density=STEEL, connectors={key: Connector(key, value) for key, value in connectors.items()}, color="#8a9299"
    )


def of_density(assembly: Assembly, density: float) -> Assembly:
    """Return an assembly with parts of another density [kg/m³]."""
    parts = {name: replace(part, mass=part.solid.mass(density)) for name, part in assembly.parts.items() if part.solid is not None}
    return replace(assembly, parts=parts)


def all_joint_kinds() -> Assembly:
    """A base with one branch per kind: both mates, joints declared child to parent, an endless revolute, rests off zero."""
    tilted = frame(at=(10, -20, 30), z=(0.3, -0.4, 0.8), x=(1, 0, -0.375))
    other = frame(at=(-5, 8, 12), z=(-0.6, 0.1, 0.5), x=(0.5, 0, 0.6))
    kinds = ["fixed", "hinge", "wheel", "drawer", "rod", "head", "nut", "puck", "cross", "flap", "tray", "ring", "knob", "bolt"]
    base = block(
        "base", (100, 100, 10), **{name: tilted @ SE3.trans(15.0 * i, 5.0 * i, 0) @ SE3.rot_x(0.2 * i) for i, name in enumerate(kinds)}
    )
    parts = {name: block(name, (8 + i, 20, 12), root=other @ SE3.rot_y(0.3 * i), tip=tilted) for i, name in enumerate(kinds)}
    pi = math.pi

    def on(name: str) -> tuple[Attachment, Attachment]:
        return base[name], parts[name]["root"]

    joints = [
        declare.fixed("fixed", *on("fixed"), mate="opposed"),
        declare.revolute("hinge", *on("hinge"), limits=(-1.0, 2.0), rest=0.5),
        declare.revolute("wheel", *on("wheel"), limits="endless", mate="opposed"),
        declare.slider("drawer", *on("drawer"), limits=(10.0, 200.0), rest=20.0),
        declare.cylindrical("rod", *on("rod"), travel=(-50.0, 50.0), angle="endless", mate="opposed"),
        declare.ball("head", *on("head"), cone=pi / 3, twist=(-1.0, 0.5)),
        declare.screw("nut", *on("nut"), lead=-3.0, limits=(-20.0, 20.0), rest=1.0),
        declare.planar("puck", *on("puck"), x=(-30.0, 30.0), y=(-40.0, 40.0), angle="endless", mate="opposed"),
        declare.universal("cross", *on("cross"), a=(-1.0, 1.0), b=(-0.5, 0.7)),
        # declared from the moving part to the ground
        declare.revolute("flap", *on("flap")[::-1], limits=(-1.0, 2.0), rest=0.25),
        declare.slider("tray", *on("tray")[::-1], limits=(0.0, 80.0), mate="opposed"),
        declare.cylindrical("ring", *on("ring")[::-1], travel=(-5.0, 25.0), angle=(-3.0, 1.0), rest=(5.0, -1.0)),
        replace(declare.ball("knob", *on("knob")[::-1], cone=pi / 4, mate="opposed"), rest=(0.1, 0.2, 0.3, math.sqrt(1 - 0.14))),
        declare.screw("bolt", *on("bolt")[::-1], lead=2.0, limits="endless"),
    ]
    # a chain on top, so that frames beyond the first joint matter
    arm, hand = block("arm", (60, 6, 6), root=other, tip=tilted), block("hand", (12, 8, 30), root=tilted)
    joints += [
        declare.revolute("elbow", arm["root"], parts["hinge"]["tip"], limits=(-2.0, 2.0)),
        declare.cylindrical("wrist", hand["root"], arm["tip"], travel=(-20.0, 20.0), angle=(-1.0, 1.0), mate="opposed"),
    ]
    return Assembly.from_parts(
        "all_kinds",
        parts=[base, *parts.values(), arm, hand],
        joints=joints,
        ground="base",
        T_ground=SE3.from_axis_angle([1.0, 2.0, 3.0], 0.7) @ SE3.trans(5.0, -7.0, 11.0),
    )


def random_tree(seed: int, count: int = 6) -> Assembly:
    """A random tree of all joint kinds, frames and mates; balls stay away from gimbal lock."""
    rng = np.random.default_rng(seed)
    parts = [block("part_0", _size(rng))]
    joints: list[Joint] = []
    for index in range(1, count):
        near = int(rng.integers(index))
        name = f"part_{index}"
        parts[near] = _with(parts[near], f"to_{index}", _random_frame(rng))
        part = block(name, _size(rng), root=_random_frame(rng))
        parts.append(part)
        ends = (parts[near][f"to_{index}"], part["root"])
        kind = list(JointType)[rng.integers(8)]
        if kind.reversible and rng.random() < 0.5:
            ends = (ends[1], ends[0])
        joints.append(_random_joint(rng, f"joint_{index}", kind, ends))
    return Assembly.from_parts("random", parts=parts, joints=joints, ground="part_0", T_ground=_random_frame(rng))


def random_configurations(assembly: Assembly, seed: int, count: int) -> NDArray[np.float64]:
    """Configurations of a tree within its limits, `(count, nq)`; endless coordinates within a half turn or 100 mm."""
    return Configuration.random(assembly.joints, np.random.default_rng(seed), (count,)).columns


def walker() -> Assembly:
    """A base that floats over the ground, with an arm that runs into the base at 90°."""
    ground, base = (
        block("ground", (100, 100, 2), top=frame()),
        block("base", (40, 40, 40), root=frame(), tip=frame(at=(0, 0, 30), z=(0, 1, 0))),
    )
    arm = block("arm", (60, 6, 6), root=frame(at=(-25, 0, 0), z=(0, 1, 0)))
    joints = [
        declare.free("root", ground["top"], base["root"], rest=SE3.trans(0, 0, 500)),
        declare.revolute("shoulder", base["tip"], arm["root"], limits=(-0.5, 2.0)),
    ]
    return Assembly.from_parts("walker", parts=[ground, base, arm], joints=joints, ground="ground")


def geared_pair() -> Assembly:
    """Two wheels and a rack, tied by couplings."""
    base = block("base", (100, 40, 5), a=frame(), b=frame(at=(60, 0, 0)), s=frame(at=(0, 40, 0), z=(1, 0, 0)))
    wheel_a, wheel_b = (block(name, (20, 20, 5), axis=frame()) for name in ("wheel_a", "wheel_b"))
    rack = block("rack", (50, 5, 5), slide=frame(z=(1, 0, 0)))
    joints = [
        declare.revolute("a", base["a"], wheel_a["axis"], limits="endless", driver=True),
        declare.revolute("b", base["b"], wheel_b["axis"], limits="endless"),
        declare.slider("s", base["s"], rack["slide"], limits=(-100.0, 100.0), rest=1.0),
    ]
    couplings = [Coupling("mesh", "gear", "a", "b", -0.5), Coupling("pinion", "rack", "b", "s", 20.0, 1.0)]
    return Assembly.from_parts("geared", parts=[base, wheel_a, wheel_b, rack], joints=joints, couplings=couplings, ground="base")


def _with(part: Part, name: str, T: SE3) -> Part:
    return replace(part, connectors={**part.connectors, name: Connector(name, T)})


def _size(rng: np.random.Generator) -> tuple[float, float, float]:
    x, y, z = rng.uniform(5, 60, 3)
    return float(x), float(y), float(z)


def _random_frame(rng: np.random.Generator) -> SE3:
    q = rng.normal(size=4)
    return SE3.from_quaternion(q / np.linalg.norm(q), rng.uniform(-50, 50, 3))


def _random_joint(rng: np.random.Generator, name: str, kind: JointType, ends: tuple[Attachment, Attachment]) -> Joint:  # noqa: PLR0911 - one per kind
    mate: Any = ("aligned", "opposed")[rng.integers(2)]
    angle: Any = "endless" if rng.random() < 0.3 else (-float(rng.uniform(0.1, 3)), float(rng.uniform(0.1, 3)))
    travel = (-float(rng.uniform(1, 80)), float(rng.uniform(1, 80)))
    match kind:
        case JointType.FIXED:
            return declare.fixed(name, *ends, mate=mate)
        case JointType.REVOLUTE:
            return declare.revolute(name, *ends, limits=angle, mate=mate)
        case JointType.SLIDER:
            return declare.slider(name, *ends, limits=travel, mate=mate)
        case JointType.CYLINDRICAL:
            return declare.cylindrical(name, *ends, travel=travel, angle=angle, mate=mate)
        case JointType.BALL:
            return declare.ball(name, *ends, cone=float(rng.uniform(0.1, 1.4)), mate=mate)
        case JointType.SCREW:
            return declare.screw(name, *ends, lead=float(rng.uniform(-9, 9)), limits=angle, mate=mate)
        case JointType.PLANAR:
            return declare.planar(name, *ends, x=travel, y=travel, angle=angle, mate=mate)
        case JointType.UNIVERSAL:
            return declare.universal(name, *ends, a=(-1.0, 1.0), b=(-0.8, 1.2), mate=mate)
        case JointType.FREE:
            return declare.free(name, *ends, mate=mate)


def closed(kind: Callable[[Attachment, Attachment], Joint], *, turned: bool = False) -> Assembly:
    """A chain of three slides and three screws, free in all six directions, closed by a joint of the given kind; rests closed.

    The slides and screws come first and carry the tree, so the given joint closes the loop; `turned` declares it to the ground.
    """
    axes: list[Any] = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    names = ["base", *(f"part_{i}" for i in range(1, 7))]
    frames = [frame(at=(10 + 2 * i, 5 - i, 3 * i), z=axes[i % 3]) for i in range(6)]
    parts = [
        block(
            name,
            (20 + 5 * i, 8, 6),
            **({"root": frames[i - 1]} if i else {}),
            **({"tip": frames[i]} if i < 6 else {"end": frame(at=(0, 9, 4))}),
        )
        for i, name in enumerate(names)
    ]
    joints: list[Joint] = []
    for i in range(6):
        ends = (parts[i]["tip"], parts[i + 1]["root"])
        if i < 3:
            joints.append(declare.slider(f"slide_{i}", *ends, limits=(-50.0, 50.0), rest=4.0 + i))
        else:
            joints.append(declare.screw(f"screw_{i}", *ends, lead=2.0 + i, limits=(-9.0, 9.0), rest=0.3 * i))
    return _closed_by(kind, parts, joints, end="end", turned=turned)


def four_bar(limits: Any = "endless", crank: Any = "endless") -> Assembly:
    """Links of 30, 90 and 70 mm over a span, hinged in a plane; it rests closed at a crank of 60°."""
    lengths = (("crank", 30), ("coupler", 90), ("rocker", 70))
    parts = [
        block("base", (120, 20, 4), tip=frame()),
        *(block(name, (size, 6, 4), root=frame(), tip=frame(at=(size, 0, 0))) for name, size in lengths),
    ]
    joints = [
        declare.revolute("a", parts[0]["tip"], parts[1]["root"], limits=crank, rest=math.pi / 3, driver=True),
        declare.revolute("b", parts[1]["tip"], parts[2]["root"], limits="endless", rest=-0.6),
        declare.revolute("c", parts[2]["tip"], parts[3]["root"], limits="endless", rest=-0.9),
    ]
    return _closed_by(lambda near, far: declare.revolute("d", near, far, limits=limits), parts, joints, end="tip")


def rigid_ring() -> Assembly:
    """Three parts fixed to each other in a ring, with a drawer on the side."""
    parts = [block("base", tip=frame()), *(block(f"part_{i}", root=frame(), tip=frame(at=(30, 5, i))) for i in range(2))]
    joints = [declare.fixed(f"f_{i}", parts[i]["tip"], parts[i + 1]["root"]) for i in range(2)]
    drawer = block("drawer", root=frame(at=(0, 0, 90)))
    slide = declare.slider("slide", parts[0]["tip"], drawer["root"], limits=(0.0, 9.0))
    return _closed_by(lambda near, far: declare.fixed("d", near, far), parts, joints, end="tip", beside=((drawer, slide),))


def _closed_by(
    kind: Callable[[Attachment, Attachment], Joint],
    parts: list[Part],
    joints: list[Joint],
    *,
    end: str,
    turned: bool = False,
    beside: tuple[tuple[Part, Joint], ...] = (),
) -> Assembly:
    """Close the chain from the ground to the last part's connector `end`, by a frame on the ground that is where that comes to rest."""
    base, last = parts[0], parts[-1]
    tip = SE3.identity()
    for joint in joints:
        tip = tip @ joint.T_parent_connector @ joint.motion(joint.rest) @ flip(joint.mate) @ joint.T_child_connector.inverse()
    tip = tip @ last.connectors[end].frame
    draft = kind(last[end], base["tip"]) if turned else kind(base["tip"], last[end])
    motion = draft.motion(draft.rest) @ flip(draft.mate)
    T_base = tip @ (motion if turned else motion.inverse())
    parts = [_with(base, "close", T_base), *parts[1:]]
    ends = (
        {"child_connector": "close", "T_child_connector": T_base} if turned else {"parent_connector": "close", "T_parent_connector": T_base}
    )
    closing: Joint = replace(draft, **ends)  # type: ignore[arg-type]
    more_parts, more_joints = [part for part, _ in beside], [joint for _, joint in beside]
    return Assembly.from_parts("loop", parts=[*parts, *more_parts], joints=[*joints, closing, *more_joints], ground="base")
