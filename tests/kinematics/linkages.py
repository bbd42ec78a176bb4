"""The mechanisms of the reference table, made joint by joint without a plan."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from articad.connectors import SE3, Mate, flip
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
    last = stages - 1
    parts += ["platform", "top_shoe"]  # carried by the upper end of b, level by the upper end of a in a second shoe
    joints.append(joint("top_left", "revolute", (f"b{last}", at(2 * half)), ("platform", at(0)), rest=[phi - math.pi]))
    joints.append(joint("top_right", "revolute", (f"a{last}", at(2 * half)), ("top_shoe", at(0)), rest=[-phi]))
    joints.append(joint("top_slide", "slider", ("platform", foot), ("top_shoe", foot), rest=[2 * half * math.cos(phi)]))
    return Mechanism(parts, "base", joints)


def from_rest(
    name: str,
    kind: str,
    parent: str,
    child: str,
    W: SE3,
    *,
    rest: Sequence[float] | np.ndarray | None = None,
    driver: bool = False,
    mate: Mate = Mate.ALIGNED,
    lead: float = 0.0,
) -> Joint:
    """Return a joint at the world frame W between parts whose frames are all the world's at rest: it is closed by construction."""
    values = tuple(rest) if rest is not None else JointType(kind).neutral
    C_c = W @ JointType(kind).motion(values, lead) @ flip(mate)
    return joint(name, kind, (parent, W), (child, C_c), rest=values, driver=driver, mate=mate, lead=lead)


def circles(p: np.ndarray, rp: float, q: np.ndarray, rq: float, branch: int) -> np.ndarray:
    """Return where two circles meet, left of p → q for branch +1."""
    e = q - p
    n = float(np.hypot(*e))
    u = (rp * rp - rq * rq + n * n) / (2 * n)
    h = branch * math.sqrt(rp * rp - u * u)
    meet: np.ndarray = p + (u * e + h * np.array([-e[1], e[0]])) / n
    return meet


def watt(crank: float = math.radians(60), branch: tuple[int, int] = (1, 1)) -> Mechanism:
    """A six-bar: the four-bar 30/90/70/100, a point (60, 40) of its coupler and one (90, -20) of its rocker carry links of 60 and 50."""
    plain = four_bar(crank=crank, branch=branch[0])
    coupler, rocker = four_bar_angles(30, 90, 70, 100, crank, branch[0])
    p5 = np.array([30 * math.cos(crank), 30 * math.sin(crank)]) + turned(coupler, (60, 40))
    p6 = np.array([100.0, 0.0]) + turned(rocker, (90, -20))
    pin = circles(p5, 60, p6, 50, branch[1])
    link5, link6 = (math.atan2(*(pin - p)[::-1]) for p in (p5, p6))
    joints = [
        *plain.joints,
        joint("pin_5", "revolute", ("coupler", at(60, 40)), ("link5", at(0)), rest=[link5 - coupler]),
        joint("pin_6", "revolute", ("rocker", at(90, -20)), ("link6", at(0)), rest=[link6 - rocker]),
        joint("pin_7", "revolute", ("link5", at(60)), ("link6", at(50)), rest=[link6 - link5]),
    ]
    return Mechanism((*plain.parts, "link5", "link6"), "frame", joints)


def turned(angle: float, p: tuple[float, float]) -> np.ndarray:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * p[0] - s * p[1], s * p[0] + c * p[1]])


STEWART_BASE = [at(100 * math.cos(a), 100 * math.sin(a)) for a in np.radians([-10, 10, 110, 130, 230, 250])]
STEWART_TOP = [at(60 * math.cos(a), 60 * math.sin(a)) for a in np.radians([-50, 50, 70, 170, 190, 290])]


def stewart(kind: str = "universal", height: float = 120.0) -> Mechanism:
    """Six legs, each a universal (or ball) below, a driven slider and a ball above; rest above the centre."""
    parts, joints = ["base", "top"], []
    for i, (b, p) in enumerate(zip(STEWART_BASE, STEWART_TOP, strict=True)):
        foot, head = b.translation, p.translation + np.array([0, 0, height])
        W = SE3.from_axes(foot, head - foot)
        length = float(np.linalg.norm(head - foot))
        parts += [f"lower{i}", f"upper{i}"]
        joints.append(from_rest(f"foot{i}", kind, "base", f"lower{i}", W))
        joints.append(from_rest(f"leg{i}", "slider", f"lower{i}", f"upper{i}", W, rest=[length], driver=True))
        joints.append(from_rest(f"head{i}", "ball", f"upper{i}", "top", SE3.from_axes(head, head - foot)))
    return Mechanism(parts, "base", joints)


def stewart_legs(T: SE3) -> np.ndarray:
    """Return the leg lengths (6,) that hold the platform at T."""
    return np.array([np.linalg.norm(T.apply(p.translation) - b.translation) for b, p in zip(STEWART_BASE, STEWART_TOP, strict=True)])


def bennett(theta: float = 1.0, a: float = 100.0, b: float = 60.0, alpha: float = math.radians(50)) -> Mechanism:
    """The skew four-bar that moves against all counting: sin β / b = sin α / a.

    Neighbouring angles have tan(θ/2) tan(φ/2) = sin((α + β)/2) / sin((α − β)/2) but for sign, opposite ones are equal.
    """
    beta = math.asin(b / a * math.sin(alpha))
    phi = -2 * math.atan(math.sin((alpha + beta) / 2) / math.sin((alpha - beta) / 2) / math.tan(theta / 2))
    links = [(a, alpha), (b, beta), (a, alpha), (b, beta)]
    joints = []
    for i, (length, twist) in enumerate(links):
        far = at(length) @ SE3.rot_x(twist)
        rest = theta if i % 2 == 0 else phi
        joints.append(joint(f"j{i}", "revolute", (f"l{i}", far), (f"l{(i + 1) % 4}", at(0)), rest=[rest], driver=i == 0))
    return Mechanism(tuple(f"l{i}" for i in range(4)), "l0", joints)


def parallelogram(crank: float = 1.0) -> Mechanism:
    """A four-bar 30/80/30/80, flat at crank 0."""
    return four_bar(30, 80, 30, 80, crank=crank)


def misaligned(tilt: float) -> Mechanism:
    """A four-bar that closes at rest, but one of its axes is tilted [rad] against the others."""
    a, b, c, d = ((0.0, 0.0), (15.0, 25.98), (93.66, 69.7), (100.0, 0.0))
    frames = [SE3.trans(*a, 0), SE3.trans(*b, 0), SE3.trans(*c, 0) @ SE3.rot_x(tilt), SE3.trans(*d, 0)]
    names = ["frame", "crank", "coupler", "rocker", "frame"]
    joints = [
        from_rest(n, "revolute", names[i], names[i + 1], frames[i], driver=i == 0)
        for i, n in enumerate(("crank", "pin_b", "pin_c", "rocker"))
    ]
    return Mechanism(names[:4], "frame", joints)


def geared_four_bar() -> Mechanism:
    """A motor gear of 20 teeth drives the crank's 40."""
    plain = four_bar()
    joints = [
        joint("motor", "revolute", ("frame", at(-60)), ("pinion", at(0)), driver=True),
        *(Joint(**{**j.__dict__, "driver": False}) for j in plain.joints),
    ]
    mesh = Coupling("mesh", "gear", "motor", "crank", -20 / 40, math.radians(60))
    return Mechanism(("frame", "pinion", "crank", "coupler", "rocker"), "frame", joints, [mesh])


def gear_train() -> Mechanism:
    """Two gears of 20 and 30 teeth, and a rack of module 2 on the second: no loop, two couplings."""
    joints = [
        joint("gear_a", "revolute", ("frame", at(0)), ("a", at(0))),
        joint("gear_b", "revolute", ("frame", at(50)), ("b", at(0)), rest=[0.1]),
        joint("rack", "slider", ("frame", SE3.from_axes((50, 30, 0), (1, 0, 0))), ("rack", SE3.from_axes((0, 0, 0), (1, 0, 0)))),
    ]
    couplings = [Coupling("mesh", "gear", "gear_a", "gear_b", -20 / 30, 0.1), Coupling("pinion", "rack", "gear_b", "rack", 30.0, -3.0)]
    return Mechanism(("frame", "a", "b", "rack"), "frame", joints, couplings)


def mismatch(mechanism: Mechanism, q: np.ndarray) -> tuple[float, float]:
    """Return the largest [mm] and [rad] by which any joint misses `T_child C_c = T_parent C_p J F` at q: shares nothing with the solver."""
    T = dict(zip(mechanism.parts, mechanism.poses(q), strict=True))
    values = mechanism.configuration(q)
    worst = np.zeros(2)
    for j in mechanism.joints:
        here = T[j.parent] @ j.T_parent_connector @ j.motion(values[j.name]) @ flip(j.mate)
        there = T[j.child] @ j.T_child_connector
        worst = np.maximum(worst, [here.distance_to(there), here.angle_to(there)])
    for c in mechanism.couplings:
        columns = {k.name: v for k, v in zip(mechanism.coordinates, values.columns, strict=True)}
        worst[1] = max(worst[1], abs(columns[c.b] - c.ratio * columns[c.a] - c.offset))
    return float(worst[0]), float(worst[1])
