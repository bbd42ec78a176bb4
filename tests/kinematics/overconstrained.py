"""Linkages of the literature whose mobility no count of joints gives, made from their published conditions."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from scipy.optimize import least_squares

from articad.connectors import SE3
from articad.kinematics import Coupling, Joint, Mechanism
from tests.kinematics.linkages import at, bennett, from_rest, joint

Row = tuple[float, float, float]  # link length a, twist α, offset d (Denavit and Hartenberg)


def screw(a: float, alpha: float, d: float, theta: float) -> np.ndarray:
    """Return the homogeneous matrix Rz(θ) Tz(d) Tx(a) Rx(α): the test's own arithmetic."""
    ct, sn, ca, sa = math.cos(theta), math.sin(theta), math.cos(alpha), math.sin(alpha)
    return np.array([[ct, -sn * ca, sn * sa, a * ct], [sn, ct * ca, -ct * sa, a * sn], [0, sa, ca, d], [0, 0, 0, 1]])


def ring_gap(rows: Sequence[Row], angles: np.ndarray) -> np.ndarray:
    """Return the twelve numbers by which a ring is open: of the rotation, and of the place over the longest link."""
    size = max(max(abs(a), abs(d)) for a, _, d in rows)
    T = np.eye(4)
    for (a, alpha, d), theta in zip(rows, angles, strict=True):
        T = T @ screw(a, alpha, d, theta)
    return np.concatenate([(T[:3, :3] - np.eye(3)).ravel(), T[:3, 3] / size])


def closing_angles(rows: Sequence[Row], guess: Sequence[float] | np.ndarray, fixed: dict[int, float]) -> tuple[np.ndarray, float]:
    """Return the joint angles that close a ring with some of them given, and the residual that is left, by least squares."""
    free = [i for i in range(len(rows)) if i not in fixed]

    def angles(x: np.ndarray) -> np.ndarray:
        full = np.empty(len(rows))
        full[free] = x
        for i, value in fixed.items():
            full[i] = value
        return full

    best = least_squares(lambda x: ring_gap(rows, angles(x)), [guess[i] for i in free], xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=500)
    return angles(best.x), math.sqrt(2 * best.cost)


def ring(rows: Sequence[Row], angles: Sequence[float] | np.ndarray) -> Mechanism:
    """Return the closed chain of revolute joints: joint i turns about the z of link i, then the link leads to the next."""
    n = len(rows)
    joints = []
    for i, theta in enumerate(angles):
        before = (i - 1) % n
        a_, alpha_, d_ = rows[before]
        near = SE3.trans(a_, 0, d_) @ SE3.rot_x(alpha_)
        joints.append(joint(f"j{i}", "revolute", (f"l{before}", near), (f"l{i}", at(0)), rest=[float(theta)], driver=i == 0))
    return Mechanism(tuple(f"l{i}" for i in range(n)), f"l{n - 1}", joints)


def closed_ring(rows: Sequence[Row], *, first: float, seeds: int = 40) -> Mechanism:
    """Return a ring closed at the first joint's angle, from random starts."""
    rng = np.random.default_rng(5)
    for _ in range(seeds):
        angles, left = closing_angles(rows, rng.uniform(-math.pi, math.pi, len(rows)), {0: first})
        if left < 1e-12:
            return ring(rows, angles)
    raise AssertionError("no closed configuration was found")


def bricard_line_symmetric() -> Mechanism:
    """Bricard 1897: a_i = a_{i+3}, α_i = α_{i+3}, d_i = d_{i+3}; mobility 1."""
    rows = [(60.0, 0.9, 10.0), (80.0, 1.4, -20.0), (50.0, 0.6, 35.0)]
    return closed_ring([*rows, *rows], first=0.7)


def bricard_trihedral() -> Mechanism:
    """Bricard 1897: a₁² + a₃² + a₅² = a₂² + a₄² + a₆², α = ±90° in turn, d = 0; mobility 1."""
    a = [50.0, 60.0, 70.0, 55.0, 80.0]
    last = math.sqrt(a[0] ** 2 + a[2] ** 2 + a[4] ** 2 - a[1] ** 2 - a[3] ** 2)
    twists = [math.pi / 2, -math.pi / 2] * 3
    return closed_ring(list(zip([*a, last], twists, [0.0] * 6, strict=True)), first=2.0)


def bricard_plane_symmetric() -> Mechanism:
    """Bricard 1897: links 1-6, 2-5, 3-4 equal across a plane: a₁=a₆, α₁=−α₆, …, d₁=d₄=0, d₂=d₆, d₃=d₅; mobility 1."""
    a, alpha, d = (60.0, 80.0, 50.0), (0.9, 1.3, 0.7), (15.0, -25.0)
    rows = [
        (a[0], alpha[0], 0.0),
        (a[1], alpha[1], d[0]),
        (a[2], alpha[2], d[1]),
        (a[2], -alpha[2], 0.0),
        (a[1], -alpha[1], -d[1]),
        (a[0], -alpha[0], -d[0]),
    ]
    return closed_ring(rows, first=1.0)


def tetrahedra(n: int) -> list[Row]:
    """Return the links of a ring of n tetrahedra: equal lengths, α = ±90° in turn, no offsets."""
    return [(50.0, math.pi / 2 * (-1) ** i, 0.0) for i in range(n)]


def kaleidocycle(n: int = 6) -> Mechanism:
    """A ring of n tetrahedra, n even, in its symmetric shape: every second joint angle is the same.

    For n ≥ 6 the symmetric ring has n − 5 mechanisms of first order and one state of self-stress (Fowler and Guest 2005); six
    tetrahedra move with mobility 1, n ≥ 8 with n − 6.
    """
    rows = tetrahedra(n)
    for guess in np.random.default_rng(5).uniform(-math.pi, math.pi, (60, 2)):
        angles, left = alternating(rows, guess)
        if left < 1e-12 and np.abs(np.cos(angles)).max() < 0.95:  # no link folded onto the one beside it
            return ring(rows, angles)
    raise AssertionError("no symmetric configuration was found")


def alternating(rows: Sequence[Row], guess: Sequence[float] | np.ndarray) -> tuple[np.ndarray, float]:
    """Return joint angles u, v, u, v, … that close a ring, from a guess of u and v, and the residual that is left."""
    half = len(rows) // 2
    best = least_squares(lambda z: ring_gap(rows, np.tile(z, half)), guess, xtol=1e-15, ftol=1e-15, gtol=1e-15)
    return np.tile(best.x, half), math.sqrt(2 * best.cost)


def goldberg_six_bar() -> Mechanism:
    """Goldberg 1943: three Bennett loops in a row that share links b, which are taken away: six revolutes, mobility 1."""
    alpha, beta, gamma, delta_ = 1.0, 0.6, 0.45, 0.3
    a, b, c, d = (100.0 * math.sin(x) for x in (alpha, beta, gamma, delta_))
    rows = [(a, alpha, 0.0), (b, beta, 0.0), (a + c + d, alpha + gamma + delta_, 0.0), (b, beta, 0.0), (d, delta_, 0.0), (c, gamma, 0.0)]
    return closed_ring(rows, first=1.0)


def goldberg_five_bar() -> Mechanism:
    """Goldberg 1943: two Bennett loops that share a link and a joint, both taken away: five revolutes, mobility 1."""
    # a/sin α = b/sin β = c/sin γ; the second loop has links b and c, the shared link b is dropped, links a and c are made one
    ratio = 100.0
    alpha, beta, gamma = 1.0, 0.6, 0.45
    a, b, c = (ratio * math.sin(x) for x in (alpha, beta, gamma))
    rows = [(a, alpha, 0.0), (b, beta, 0.0), (a + c, alpha + gamma, 0.0), (b, beta, 0.0), (c, gamma, 0.0)]
    return closed_ring(rows, first=1.0)


def myard_five_bar() -> Mechanism:
    """Myard 1931: two Bennett loops with a right angle, mirrored in a plane: a₃ = 0, α₂ = α₃ = 90°…; mobility 1."""
    alpha = 0.8
    b = 80.0
    a = b * math.sin(alpha)
    rows = [(a, alpha, 0.0), (b, math.pi / 2, 0.0), (0.0, math.pi - 2 * alpha, 0.0), (b, math.pi / 2, 0.0), (a, math.pi - alpha, 0.0)]
    return closed_ring(rows, first=1.2)


def schatz() -> Mechanism:
    """Schatz 1929 (the Turbula mixer): a₁ = a₅ = 0, a₂ = a₃ = a₄ = a, a₆ = √3 a, α₁…α₅ = 90°, α₆ = 0; mobility 1."""
    a, q = 50.0, math.pi / 2
    rng = np.random.default_rng(2)
    # joints 1 and 6 are parallel and √3 a apart; their offsets are equal and opposite
    rows = [(0.0, q, -20.0), (a, q, 0.0), (a, q, 0.0), (a, q, 0.0), (0.0, q, 0.0), (math.sqrt(3) * a, 0.0, 20.0)]
    for _ in range(60):
        angles, left = closing_angles(rows, rng.uniform(-math.pi, math.pi, 6), {0: 0.8})
        if left < 1e-12:
            return ring(rows, angles)
    raise AssertionError("no closed configuration was found")


def sarrus() -> Mechanism:
    """Sarrus 1853: two hinged pairs of plates in planes at an angle; the platform moves along a straight line: mobility 1."""
    joints = []
    parts = ["base", "top"]
    for i, turn in enumerate((0.0, 1.2)):
        R = SE3.rot_z(turn)
        y = R @ SE3.rot_x(-math.pi / 2)  # z of the hinge along the leg's own y
        parts += [f"lower{i}", f"upper{i}"]
        places = [R @ at(60, 0, 0), R @ at(90, 0, 40), R @ at(60, 0, 80)]
        frames = [SE3.trans(*p.translation) @ y for p in places]
        joints.append(from_rest(f"foot{i}", "revolute", "base", f"lower{i}", frames[0], driver=i == 0))
        joints.append(from_rest(f"knee{i}", "revolute", f"lower{i}", f"upper{i}", frames[1]))
        joints.append(from_rest(f"head{i}", "revolute", f"upper{i}", "top", frames[2]))
    return Mechanism(parts, "base", joints)


def rods(points: np.ndarray, tops: np.ndarray, foot: str = "universal") -> Mechanism:
    """A platform on rods from `points` of the base to `tops`, a joint of the given kind below and a ball above."""
    joints = []
    for i, (p, q) in enumerate(zip(points, tops, strict=True)):
        W = SE3.from_axes(tuple(p), tuple(q - p))
        joints.append(from_rest(f"foot{i}", foot, "base", f"rod{i}", W))
        joints.append(from_rest(f"head{i}", "ball", f"rod{i}", "top", SE3.from_axes(tuple(q), tuple(q - p))))
    return Mechanism(("base", "top", *(f"rod{i}" for i in range(len(points)))), "base", joints)


def parallel_rods(n: int, foot: str = "universal") -> Mechanism:
    """Equal parallel rods at random places."""
    rng = np.random.default_rng(n)
    points = np.column_stack([rng.uniform(-100, 100, (n, 2)), np.zeros(n)])
    return rods(points, points + np.array([0, 0, 120]), foot)


def rods_round_a_circle(n: int, radius: float = 90.0, length: float = 120.0, seed: int = 0) -> Mechanism:
    """Equal parallel rods at random places of one circle."""
    turn = np.sort(np.random.default_rng(seed).uniform(0, 2 * math.pi, n))
    points = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.zeros(n)])
    return rods(points, points + np.array([0, 0, length]), "universal")


def similar_hexagons(twist: float = 0.3) -> Mechanism:
    """Six equal rods between regular hexagons, one turned against the other: the platform screws up and down, mobility 1."""
    turn = np.radians(np.arange(6) * 60.0)
    low, high = (np.column_stack([r * np.cos(t), r * np.sin(t), np.full(6, z)]) for r, t, z in ((100, turn, 0), (60, turn + twist, 120)))
    return rods(low, high)


def planar(links: dict[str, dict[str, tuple[float, float]]], ground: str) -> Mechanism:
    """Return a planar linkage: for each link its pins by name and place in the plane at rest; two links of a pin turn on each other.

    A pin on three links joins the second and the third to the first.
    """
    at_pin: dict[str, list[str]] = {}
    for link, pins in links.items():
        for pin in pins:
            at_pin.setdefault(pin, []).append(link)
    joints: list[Joint] = []
    for pin, on in at_pin.items():
        for k, link in enumerate(on[1:]):
            joints.append(from_rest(f"{pin}{k or ''}", "revolute", on[0], link, SE3.trans(*links[on[0]][pin], 0.0)))
    return Mechanism(tuple(links), ground, joints)


def stephenson() -> Mechanism:
    """A six-bar with its ternary links apart: mobility 1."""
    A, B, C, D, E, F, G = (0.0, 0.0), (20.0, 40.0), (90.0, 60.0), (100.0, 0.0), (60.0, 90.0), (150.0, 70.0), (160.0, 0.0)
    return planar(
        {"ground": {"a": A, "d": D, "g": G}, "crank": {"a": A, "b": B}, "coupler": {"b": B, "c": C, "e": E}, "rocker": {"c": C, "d": D}}
        | {"link": {"e": E, "f": F}, "second": {"f": F, "g": G}},
        "ground",
    )


def double_parallelogram() -> Mechanism:
    """A parallelogram with a third, redundant, equal crank: Grübler's plane count is 0, the mobility 1."""
    feet, heads = [(0.0, 0.0), (50.0, 0.0), (90.0, 0.0)], [(20.0, 40.0), (70.0, 40.0), (110.0, 40.0)]
    links = {"ground": {f"f{i}": p for i, p in enumerate(feet)}, "bar": {f"h{i}": p for i, p in enumerate(heads)}}
    return planar(links | {f"crank{i}": {f"f{i}": feet[i], f"h{i}": heads[i]} for i in range(3)}, "ground")


def dixon_first() -> Mechanism:
    """Dixon's first mechanism, K₃,₃ and up: points on two perpendicular lines, every one of one line tied to every one of the other.

    (x − x')² + (y − y')² = x² + y'² stays constant if all x² change by s and all y² by −s. Mobility 1 with one bar held.
    """
    xs, ys = (30.0, 55.0, -80.0), (40.0, -65.0, 90.0, 20.0)
    links: dict[str, dict[str, tuple[float, float]]] = {}
    for i, x in enumerate(xs):
        for k, y in enumerate(ys):
            links[f"bar{i}{k}"] = {f"x{i}": (x, 0.0), f"y{k}": (0.0, y)}
    return planar(links, "bar00")


def dixon_second() -> Mechanism:
    """Dixon's second mechanism, K₄,₄: the corners (±a, ±b) of one rectangle tied to the corners (±c, ±d) of another.

    The sixteen squared lengths are a² + b² + c² + d² ± 2ac ± 2bd: three numbers that four unknowns keep constant. Mobility 1.
    """
    signs = [(x, y) for x in (1, -1) for y in (1, -1)]
    inner, outer = ([(x * w, y * h) for x, y in signs] for w, h in ((50.0, 30.0), (20.0, 70.0)))
    links = {f"bar{i}{k}": {f"p{i}": p, f"q{k}": q} for i, p in enumerate(inner) for k, q in enumerate(outer)}
    return planar(links, "bar00")


def klann() -> Mechanism:
    """Klann's walking leg: a Stephenson six-bar, mobility 1 (its published proportions, closed at 0.6 rad of crank by circles)."""
    crank, lower, upper = (0.0, 0.0), (-0.8 * 100, -0.6 * 50), (-0.6 * 100, 1.1 * 100)
    pin = (26.0 * math.cos(0.6), 26.0 * math.sin(0.6))
    elbow, knee, shoulder = (-62.0, 12.0), (-98.0, 44.0), (-70.0, 82.0)
    foot = (-150.0, -60.0)
    return planar(
        {
            "ground": {"o": crank, "lower": lower, "upper": upper},
            "crank": {"o": crank, "pin": pin},
            "connecting": {"pin": pin, "elbow": elbow, "knee": knee},
            "rocker": {"lower": lower, "elbow": elbow},
            "swing": {"upper": upper, "shoulder": shoulder},
            "leg": {"shoulder": shoulder, "knee": knee, "foot": foot},
        },
        "ground",
    )


def delta() -> Mechanism:
    """A Delta robot: three arms, each with a parallelogram of two ball-ended rods: three translations, and six rods that spin."""
    joints, parts = [], ["base", "top"]
    for i in range(3):
        R = SE3.rot_z(2 * math.pi / 3 * i)
        parts += [f"arm{i}", f"rod{i}a", f"rod{i}b"]
        hinge = R @ at(100, 0, 0) @ SE3.rot_x(-math.pi / 2)
        joints.append(from_rest(f"motor{i}", "revolute", "base", f"arm{i}", hinge, driver=True))
        for side, y in (("a", 20.0), ("b", -20.0)):
            low, high = (R @ at(x, y, z) for x, z in ((150.0, -60.0), (40.0, -220.0)))
            joints.append(from_rest(f"elbow{i}{side}", "ball", f"arm{i}", f"rod{i}{side}", low))
            joints.append(from_rest(f"wrist{i}{side}", "ball", f"rod{i}{side}", "top", high))
    return Mechanism(parts, "base", joints)


def gear_triangle(teeth: Sequence[int] = (20, 30, 40), *, belt: bool = False) -> Mechanism:
    """Three wheels, each in mesh with both others: locked; with one belt instead of a mesh of the right ratio they turn."""
    joints = [joint(f"wheel{i}", "revolute", ("frame", at(40.0 * i)), (f"w{i}", at(0))) for i in range(3)]
    pairs = [(0, 1), (1, 2), (2, 0)]
    ratios = [-teeth[a] / teeth[b] for a, b in pairs]
    if belt:
        ratios[2] = -ratios[2]
    couplings = [Coupling(f"mesh{a}{b}", "gear", f"wheel{a}", f"wheel{b}", ratio) for (a, b), ratio in zip(pairs, ratios, strict=True)]
    return Mechanism(("frame", "w0", "w1", "w2"), "frame", joints, couplings)


def slack_bars(slack: float, scale: float = 1.0) -> Mechanism:
    """Three bars of 30 m between pivots 90 m less `slack` apart: they bow by √(slack · …), so they move although nearly straight."""
    bar = 30_000.0 * scale
    span = 3 * bar - slack * scale
    x = (span - bar) / 2
    h = math.sqrt(max(0.0, bar * bar - x * x))
    places = [(0.0, 0.0), (x, h), (x + bar, h), (span, 0.0)]
    names = ["frame", "a", "b", "c", "frame"]
    joints = [from_rest(f"pin{i}", "revolute", names[i], names[i + 1], at(*p), driver=i == 0) for i, p in enumerate(places)]
    return Mechanism(names[:4], "frame", joints)


SINGLE: dict[str, Callable[[], Mechanism]] = {
    "bennett": lambda: bennett(1.0),
    "bricard_line_symmetric": bricard_line_symmetric,
    "bricard_trihedral": bricard_trihedral,
    "bricard_plane_symmetric": bricard_plane_symmetric,
    "kaleidocycle": kaleidocycle,
    "goldberg": goldberg_five_bar,
    "goldberg_six": goldberg_six_bar,
    "myard": myard_five_bar,
    "schatz": schatz,
    "sarrus": sarrus,
    "stephenson": stephenson,
    "double_parallelogram": double_parallelogram,
    "dixon": dixon_first,
    "dixon_second": dixon_second,
    "klann": klann,
}
