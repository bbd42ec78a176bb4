"""The mechanisms of the reference table, made joint by joint without a plan."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from articad.connectors import SE3, Mate
from articad.kinematics import Coupling, Joint, JointLimits, JointType, Mechanism

ENDLESS = (-math.inf, math.inf)


def joint(
    name: str,
    kind: str,
    parent: tuple[str, SE3],
    child: tuple[str, SE3],
    *,
    rest: Sequence[float] | None = None,
    limits: Sequence[tuple[float, float]] | None = None,
    driver: bool = False,
    mate: Mate = Mate.ALIGNED,
    lead: float = 0.0,
) -> Joint:
    """Return a joint; endless unless limits are given."""
    joint_type = JointType(kind)
    if joint_type is JointType.BALL:
        bounds = JointLimits(cone=math.pi)
    else:
        pairs = limits or [ENDLESS] * len(joint_type.coordinates)
        bounds = JointLimits(tuple(lo for lo, _ in pairs), tuple(hi for _, hi in pairs))
    return Joint(
        name=name,
        type=joint_type,
        parent=parent[0],
        child=child[0],
        parent_connector=f"{name}_on_{parent[0]}",
        child_connector=f"{name}_on_{child[0]}",
        T_parent_connector=parent[1],
        T_child_connector=child[1],
        limits=bounds,
        rest=tuple(rest) if rest is not None else joint_type.neutral,
        driver=driver,
        mate=mate,
        lead=lead,
    )


def at(x: float, y: float = 0.0, z: float = 0.0) -> SE3:
    return SE3.trans(x, y, z)


def four_bar_angles(a: float, b: float, c: float, d: float, crank: float, branch: int = 1) -> tuple[float, float]:
    """Return coupler and rocker angle against the ground's x axis [rad]: circles, nothing shared with the solver."""
    p = np.array([a * math.cos(crank), a * math.sin(crank)])
    to_d = np.array([d, 0.0]) - p
    e = float(np.hypot(*to_d))
    u = (b * b - c * c + e * e) / (2 * e)
    h = branch * math.sqrt(b * b - u * u)
    pin = p + (u * to_d + h * np.array([-to_d[1], to_d[0]])) / e
    return math.atan2(*(pin - p)[::-1]), math.atan2(pin[1], pin[0] - d)


def four_bar(
    a: float = 30,
    b: float = 90,
    c: float = 70,
    d: float = 100,
    *,
    crank: float = math.radians(60),
    branch: int = 1,
    limits: tuple[float, float] = ENDLESS,
    rocker_limits: tuple[float, float] = ENDLESS,
    tilt: float = 0.0,
) -> Mechanism:
    """Joints crank, pin_b, pin_c, rocker; link frames at their first pin, x along the link; rest on the given branch."""
    coupler, rocker = four_bar_angles(a, b, c, d, crank, branch)
    joints = [
        joint("crank", "revolute", ("frame", at(0)), ("crank", at(0)), rest=[crank], limits=[limits], driver=True),
        joint("pin_b", "revolute", ("crank", at(a)), ("coupler", at(0)), rest=[coupler - crank]),
        joint("pin_c", "revolute", ("coupler", at(b) @ SE3.rot_x(tilt)), ("rocker", at(c)), rest=[rocker - coupler]),
        joint("rocker", "revolute", ("frame", at(d)), ("rocker", at(0)), rest=[rocker], limits=[rocker_limits]),
    ]
    return Mechanism(("frame", "crank", "coupler", "rocker"), "frame", joints)


def impossible() -> Mechanism:
    """A four-bar 30/30/30/200 that no configuration closes."""
    joints = [
        joint("crank", "revolute", ("ground", at(0)), ("crank", at(0)), rest=[0.3], driver=True),
        joint("pin_b", "revolute", ("crank", at(30)), ("coupler", at(0))),
        joint("pin_c", "revolute", ("coupler", at(30)), ("rocker", at(30))),
        joint("rocker", "revolute", ("ground", at(200)), ("rocker", at(0)), rest=[2.5]),
    ]
    return Mechanism(("ground", "crank", "coupler", "rocker"), "ground", joints)


def slider_crank(r: float = 30, l: float = 90, e: float = 10, *, crank: float = 0.0, travel: tuple[float, float] = ENDLESS) -> Mechanism:
    """Crank at the origin, piston along x at the height e; the slider's travel is the piston's x."""
    rod = math.asin((e - r * math.sin(crank)) / l)
    x = r * math.cos(crank) + l * math.cos(rod)
    along_x = SE3.from_axes((0, e, 0), (1, 0, 0), (0, 1, 0))
    joints = [
        joint("crank", "revolute", ("frame", at(0)), ("crank", at(0)), rest=[crank], driver=True),
        joint("big_end", "revolute", ("crank", at(r)), ("rod", at(0)), rest=[rod - crank]),
        joint("small_end", "revolute", ("rod", at(l)), ("piston", at(0)), rest=[-rod]),
        joint(
            "piston", "slider", ("frame", along_x), ("piston", SE3.from_axes((0, 0, 0), (1, 0, 0), (0, 1, 0))), rest=[x], limits=[travel]
        ),
    ]
    return Mechanism(("frame", "crank", "rod", "piston"), "frame", joints)


def scissor(stages: int, half: float = 100.0, *, phi: float = math.radians(15)) -> Mechanism:
    """A lift of crossed arms 2·half long: the left foot is pinned, the right one slides in a shoe; driven by the first arm's angle."""
    parts, joints = ["base", "shoe"], []
    foot = SE3.from_axes((0, 0, 0), (1, 0, 0), (0, 1, 0))
    for i in range(stages):
        a, b = f"a{i}", f"b{i}"  # a rises to the right, b to the left; both have their origin at the lower end, x along the arm
        parts += [a, b]
        if i == 0:
            joints.append(joint("lift", "revolute", ("base", at(0)), (a, at(0)), rest=[phi], driver=True))
            joints.append(joint("shoe", "slider", ("base", foot), ("shoe", foot), rest=[2 * half * math.cos(phi)]))
            joints.append(joint("foot", "revolute", ("shoe", at(0)), (b, at(0)), rest=[math.pi - phi]))
        else:
            joints.append(joint(f"left{i}", "revolute", (f"b{i - 1}", at(2 * half)), (a, at(0)), rest=[2 * phi - math.pi]))
            joints.append(joint(f"right{i}", "revolute", (f"a{i - 1}", at(2 * half)), (b, at(0)), rest=[math.pi - 2 * phi]))
        joints.append(joint(f"cross{i}", "revolute", (a, at(half)), (b, at(half)), rest=[math.pi - 2 * phi]))
    return Mechanism(parts, "base", joints)


def circles(p: np.ndarray, rp: float, q: np.ndarray, rq: float, branch: int) -> np.ndarray:
    """Return where two circles meet, left of p → q for branch +1."""
    e = q - p
    n = float(np.hypot(*e))
    u = (rp * rp - rq * rq + n * n) / (2 * n)
    h = branch * math.sqrt(rp * rp - u * u)
    meet: np.ndarray = p + (u * e + h * np.array([-e[1], e[0]])) / n
    return meet


def bennett(a: float = 100.0, b: float = 60.0, alpha: float = math.radians(50)) -> Mechanism:
    """The skew four-bar that moves against all counting: sin β / b = sin α / a."""
    beta = math.asin(b / a * math.sin(alpha))
    links = [(a, alpha), (b, beta), (a, alpha), (b, beta)]
    parts = tuple(f"l{i}" for i in range(4))
    joints = []
    for i in range(4):
        length, twist = links[i]
        far = at(length) @ SE3.rot_x(twist)
        joints.append(joint(f"j{i}", "revolute", (parts[i], far), (parts[(i + 1) % 4], at(0)), rest=[0.5], driver=i == 0))
    return Mechanism(parts, "l0", joints)


def bennett_closed(theta: float = 1.0) -> Mechanism:
    """A Bennett linkage whose rest closes: opposite angles θ, φ with tan(θ/2) tan(φ/2) = sin((β + α)/2) / sin((β − α)/2)."""
    a, b, alpha = 100.0, 60.0, math.radians(50)
    beta = math.asin(b / a * math.sin(alpha))
    phi = 2 * math.atan(math.sin((beta + alpha) / 2) / math.sin((beta - alpha) / 2) / math.tan(theta / 2))
    open_ = bennett(a, b, alpha)
    joints = [Joint(**{**j.__dict__, "rest": (theta if i % 2 == 0 else phi,)}) for i, j in enumerate(open_.joints)]
    return Mechanism(open_.parts, "l0", joints)


BASE = [
    (80.0, 20.0),
    (-22.67949192, 79.28203230),
    (-57.32050808, 59.28203230),
    (-57.32050808, -59.28203230),
    (-22.67949192, -79.28203230),
    (80.0, -20.0),
]


def geared_four_bar() -> Mechanism:
    """A motor gear of 20 teeth drives the crank's 40."""
    plain = four_bar()
    joints = [
        joint("motor", "revolute", ("frame", at(-60)), ("pinion", at(0)), driver=True),
        *(Joint(**{**j.__dict__, "driver": False}) for j in plain.joints),
    ]
    mesh = Coupling("mesh", "gear", "motor", "crank", -20 / 40, math.radians(60))
    return Mechanism(("frame", "pinion", "crank", "coupler", "rocker"), "frame", joints, [mesh])
