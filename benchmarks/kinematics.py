"""Trees: from joints to arrays, and from coordinates to poses, beside Pinocchio, yourdfpy and a numba floor.

python benchmarks/kinematics.py [--out kinematics.json]

The scene is that of the performance notes: chains and stars whose joints are fixed, revolute, slider, cylindrical and ball
in turn, between connectors at random frames. numba is no dependency of the project: where it is not installed, its row and
the goals beside it are left out.
"""

from __future__ import annotations

import argparse
import io
import json
import math
import statistics
import subprocess
import sys
import time
import tracemalloc
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pinocchio as pin
import yourdfpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from articad.connectors import SE3
from articad.kinematics import Configuration, Joint, JointLimits, JointType, Mechanism, forward
from articad.plan.resolve import resolve
from articad.plan.schema import AssemblyPlan
from benchmarks.timing import Goal, Table, Times, measure, report

cpu_time = partial(measure, clock=time.process_time)  # every method here uses one thread

try:
    import numba
except ModuleNotFoundError:
    numba = None

TYPES = ("fixed", "revolute", "slider", "cylindrical", "ball")
REACH = 100.0  # mm
AGREES_MM = 1e-7  # over chains of a hundred metres
BUILD_GOALS = {50: 0.6, 200: 0.4, 1000: 0.2}  # of Pinocchio's time
FLOOR_GOALS = {10: 2.5, 50: 2.5, 1000: 4.0}  # of numba's time
IMPORTS = ("pass", "import numpy", "import pinocchio", "import articad.kinematics")


def scene(n: int, shape: str = "chain") -> tuple[list[str], list[Joint]]:
    """Return the names of n parts and the joints that connect them, as a plan that has been resolved holds them."""
    rng = np.random.default_rng(0)
    parts = [f"p{i}" for i in range(n)]
    joints = []
    for i in range(1, n):
        kind = JointType(TYPES[i % len(TYPES)])
        near, far = (SE3.exp(np.concatenate([rng.uniform(-REACH, REACH, 3), rng.normal(size=3)])) for _ in range(2))
        k = len(kind.coordinates)
        limits = JointLimits(cone=3.0) if kind is JointType.BALL else JointLimits((-10.0,) * k, (10.0,) * k)
        joints.append(
            Joint(
                name=f"j{i}",
                type=kind,
                parent=parts[i - 1] if shape == "chain" else parts[0],
                child=parts[i],
                parent_connector=f"out{i}",
                child_connector="in",
                T_parent_connector=near,
                T_child_connector=far,
                limits=limits,
                rest=kind.neutral,
            )
        )
    return parts, joints


# --- Pinocchio


def pinocchio_model(joints: list[Joint]) -> pin.Model:
    """Build what the same joints are there: a joint, a body and a frame for each part."""
    model, inertia = pin.Model(), pin.Inertia(1.0, np.zeros(3), np.eye(3))
    carrier, place = {"p0": 0}, {"p0": pin.SE3.Identity()}
    for joint in joints:
        here = place[joint.parent] * pin.XYZQUATToSE3(joint.T_parent_connector.data)
        back = pin.XYZQUATToSE3(joint.T_child_connector.data).inverse()
        number = carrier[joint.parent]
        if joint.type is JointType.FIXED:
            back = here * back
        else:
            number = model.addJoint(number, pinocchio_joint(joint.type), here, joint.name)
            model.appendBodyToJoint(number, inertia, back)
        model.addFrame(pin.Frame(joint.child, number, back, pin.FrameType.BODY))
        carrier[joint.child], place[joint.child] = number, back
    return model


def pinocchio_joint(kind: JointType) -> object:
    if kind is JointType.REVOLUTE:
        return pin.JointModelRZ()
    if kind is JointType.SLIDER:
        return pin.JointModelPZ()
    if kind is JointType.BALL:
        return pin.JointModelSpherical()
    composite = pin.JointModelComposite(2)
    composite.addJoint(pin.JointModelPZ())
    composite.addJoint(pin.JointModelRZ())
    return composite


class PinocchioPoses:
    """Forward kinematics with the poses read out as one array."""

    def __init__(self, parts: list[str], joints: list[Joint]) -> None:
        self.model = pinocchio_model(joints)
        self.data = self.model.createData()
        self.frames = [self.model.getFrameId(part) for part in parts[1:]]

    def one(self, q: np.ndarray) -> np.ndarray:
        """Return the matrices `(N − 1, 4, 4)`."""
        pin.forwardKinematics(self.model, self.data, q)
        pin.updateFramePlacements(self.model, self.data)
        placed = self.data.oMf
        return np.array([placed[i].homogeneous for i in self.frames])

    def many(self, Q: np.ndarray) -> np.ndarray:
        """Return the matrices `(batch, N − 1, 4, 4)`."""
        out = np.empty((len(Q), len(self.frames), 4, 4))
        for i, q in enumerate(Q):
            out[i] = self.one(q)
        return out


# --- yourdfpy


def urdf(parts: list[str], joints: list[Joint]) -> str:
    """Return the scene in URDF, whose joints have one freedom: a ball is three of them."""
    axes = {"revolute": ["z"], "slider": ["Z"], "cylindrical": ["Z", "z"], "ball": ["x", "y", "z"], "fixed": []}
    lines = [f'<link name="{part}"/>' for part in parts]
    for joint in joints:
        link, T = joint.parent, joint.T_parent_connector
        for i, axis in enumerate(axes[joint.type]):
            between = f"{joint.child}_{i}"
            kind, vector = "prismatic" if axis.isupper() else "revolute", " ".join("1" if a == axis.lower() else "0" for a in "xyz")
            lines += [f'<link name="{between}"/>', urdf_joint(f"{joint.name}_{i}", kind, link, between, T, f'<axis xyz="{vector}"/>')]
            link, T = between, SE3.identity()
        lines.append(urdf_joint(f"{joint.name}_end", "fixed", link, joint.child, T @ joint.T_child_connector.inverse(), ""))
    return f'<robot name="scene">{"".join(lines)}</robot>'


def urdf_joint(name: str, kind: str, parent: str, child: str, T: SE3, axis: str) -> str:
    R = T.rotation
    rpy = math.atan2(R[2, 1], R[2, 2]), math.atan2(-R[2, 0], math.hypot(R[2, 1], R[2, 2])), math.atan2(R[1, 0], R[0, 0])
    xyz, angles = (" ".join(f"{v:.17g}" for v in values) for values in (T.translation, rpy))
    limit = '<limit lower="-10" upper="10" effort="1" velocity="1"/>'
    ends = f'<parent link="{parent}"/><child link="{child}"/><origin xyz="{xyz}" rpy="{angles}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{axis}{limit if axis else ""}</joint>'


# --- numba


def numba_poses(mechanism: Mechanism) -> Callable[[np.ndarray, np.ndarray], None]:  # noqa: C901 - one function is what is compiled
    """Return a compiled loop over configurations and parts, which writes matrices `(batch, N, 3, 4)`: one thread, fast mathematics."""
    c = mechanism.arrays.compiled
    near, far, first = (np.array(values) for values in (c.near, c.far, c.first))
    kind = np.array([TYPES.index(joint.type) for joint in c.joints])
    A, B = np.ascontiguousarray(c.A), np.ascontiguousarray(c.B)

    @numba.njit(fastmath=True, error_model="numpy")
    def place(Q: np.ndarray, out: np.ndarray) -> None:  # noqa: C901 - the same
        for b in range(Q.shape[0]):
            for r in range(3):
                for i in range(4):
                    out[b, 0, r, i] = 1.0 if r == i else 0.0
            for k in range(len(near)):
                p, f, j = near[k], far[k], first[k]
                c, s, d = 1.0, 0.0, 0.0
                if kind[k] == 1 or kind[k] == 3:
                    angle = Q[b, j + (1 if kind[k] == 3 else 0)]
                    c, s = math.cos(angle), math.sin(angle)
                if kind[k] == 2 or kind[k] == 3:
                    d = Q[b, j]
                if kind[k] == 4:
                    x, y, z, w = Q[b, j], Q[b, j + 1], Q[b, j + 2], Q[b, j + 3]
                    r00, r01, r02 = 1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)
                    r10, r11, r12 = 2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)
                    r20, r21, r22 = 2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)
                for r in range(3):
                    t0, t1, t2, o = out[b, p, r, 0], out[b, p, r, 1], out[b, p, r, 2], out[b, p, r, 3]
                    u = t0 * A[k, 0, 0] + t1 * A[k, 1, 0] + t2 * A[k, 2, 0]
                    v = t0 * A[k, 0, 1] + t1 * A[k, 1, 1] + t2 * A[k, 2, 1]
                    n = t0 * A[k, 0, 2] + t1 * A[k, 1, 2] + t2 * A[k, 2, 2]
                    o += t0 * A[k, 0, 3] + t1 * A[k, 1, 3] + t2 * A[k, 2, 3]
                    if kind[k] == 4:
                        u, v, n = u * r00 + v * r10 + n * r20, u * r01 + v * r11 + n * r21, u * r02 + v * r12 + n * r22
                    else:
                        u, v, o = u * c + v * s, v * c - u * s, o + n * d
                    for i in range(4):
                        out[b, f, r, i] = u * B[k, 0, i] + v * B[k, 1, i] + n * B[k, 2, i]
                    out[b, f, r, 3] += o

    return place


# --- tables


def build_table(n: int, shape: str) -> Table:
    parts, joints = scene(n, shape)
    times = cpu_time({"articad": lambda: Mechanism(parts, "p0", joints), "Pinocchio, model": lambda: pinocchio_model(joints)})
    goals = (Goal("articad", "Pinocchio, model", at_most=BUILD_GOALS[n]),) if shape == "chain" else ()
    return Table(f"joints to arrays, checks included: {shape} of {n}", times, goals)


def growth(tables: dict[int, Table]) -> str:
    least = {n: table.seconds.least["articad"] for n, table in tables.items() if isinstance(table.seconds, Times)}
    return f"t(1000) = {least[1000] / least[200]:.2f} t(200) (goal <= 6)"


def batch_table(n: int, batch: int) -> Table:
    parts, joints = scene(n)
    mechanism = Mechanism(parts, "p0", joints)
    Q = Configuration.random(joints, np.random.default_rng(1), (batch,)).columns.copy()
    methods: dict[str, Callable[[], object]] = {"articad": lambda: mechanism.poses(Q)}
    calls, goals = {"articad": batch}, []
    if numba is not None:
        place, out = numba_poses(mechanism), np.empty((batch, n, 3, 4))
        place(Q, out)
        assert np.abs(out[:50] - mechanism.poses(Q).matrix[:50, :, :3]).max() < AGREES_MM
        methods["numba, one thread"], calls["numba, one thread"] = lambda: place(Q, out), batch
        goals.append(Goal("articad", "numba, one thread", at_most=FLOOR_GOALS[n]))
    if n <= 50:
        peer, few = PinocchioPoses(parts, joints), Q[: max(1, 5000 // n)]
        assert np.abs(peer.many(few[:50]) - mechanism.poses(Q[:50]).matrix[:, 1:]).max() < AGREES_MM
        methods["Pinocchio, loop"], calls["Pinocchio, loop"] = lambda: peer.many(few), len(few)
        robot = yourdfpy.URDF.load(io.StringIO(urdf(parts, joints)), load_meshes=False, build_scene_graph=True)
        cfg = np.zeros(robot.num_actuated_joints)
        methods["yourdfpy"], calls["yourdfpy"] = lambda: (robot.update_cfg(cfg), [robot.get_transform(part) for part in parts]), 1
        goals += [Goal("articad", "Pinocchio, loop", at_least=12.0), Goal("articad", "yourdfpy", at_least=400.0)]
    times = cpu_time(methods, rounds=9).each(calls)
    return Table(f"poses of {batch} configurations, chain of {n}, time for each", times, tuple(goals))


def single_table(n: int) -> Table:
    parts, joints = scene(n)
    mechanism = Mechanism(parts, "p0", joints)
    compiled, peer, q = forward.compile(mechanism), PinocchioPoses(parts, joints), mechanism.rest
    assert np.abs(peer.one(compiled.q(q)) - mechanism.poses(q).matrix[1:]).max() < AGREES_MM
    peer_q = compiled.q(q)
    methods = {
        "articad, compiled model": lambda: compiled.poses(q),
        "articad, Mechanism.poses": lambda: mechanism.poses(q),
        "Pinocchio and extraction": lambda: peer.one(peer_q),
    }
    held = ["articad, compiled model"]
    if mechanism.layout.n_freedoms <= forward.MOST_FREEDOMS:  # larger ones are placed in NumPy
        held.append("articad, Mechanism.poses")
    goals = tuple(Goal(method, "Pinocchio and extraction", at_most=1.3) for method in held)
    return Table(f"poses of one configuration, chain of {n}", cpu_time(methods), goals)


def plan_table(n: int) -> Table:
    """Return what comes before: reading a plan's text, and working out its expressions and frames."""
    connectors = [
        {"name": name, "label": name, "o": o, "z": [0, 1, 0], "x": [1, 0, 0]}
        for name, o in (("root", [0, 0, 0]), ("tip", [0, 0, "length"]))
    ]
    link = {"description": "link", "material": "steel", "connectors": connectors}
    poses = [{"rest_pose": {"at": [0, 0, f"{i} * length"]}} for i in range(n)]
    joints = [{"type": "revolute", "parent": f"p{i - 1}.tip", "child": f"p{i}.root", "angle_deg": [-90, 90]} for i in range(1, n)]
    text = json.dumps(
        {
            "schema": "articad.plan/1",
            "name": "chain",
            "ground": "p0",
            "freedoms": n - 1,
            "description": "chain",
            "parameters": [{"name": "length", "value": 10}],
            "materials": [{"name": "steel", "density_kg_m3": 7800, "color": "#888888"}],
            "parts": [{"name": f"p{i}"} | link | pose for i, pose in enumerate(poses)],
            "joints": [{"name": f"j{i}"} | joint for i, joint in enumerate(joints)],
        }
    )
    plan = AssemblyPlan.loads(text)
    resolved = resolve(plan)
    methods = {
        "read and validate the text": lambda: AssemblyPlan.loads(text),
        "expressions, frames and joints": lambda: resolve(plan),
        "joints to arrays": lambda: Mechanism(tuple(resolved.parts), resolved.ground, resolved.joints),
    }
    return Table(f"what comes before arrays: a plan of {n} parts", cpu_time(methods, rounds=7))


def import_table() -> Table:
    rounds: dict[str, list[float]] = {code: [] for code in IMPORTS}
    for _ in range(9):
        for code, seconds in rounds.items():
            start = time.perf_counter()
            subprocess.run([sys.executable, "-c", code], check=True)
            seconds.append(time.perf_counter() - start)
    bare = statistics.median(rounds["pass"])
    note = f"over bare Python: {', '.join(f'{code} {1e3 * (statistics.median(s) - bare):.0f} ms' for code, s in rounds.items())}"
    return Table("a process that imports", Times(rounds), (Goal("import articad.kinematics", "import pinocchio", at_most=1.5),), (note,))


def thousand_table() -> Table:
    """Return times per part of building and placing 200 and 1000 parts: near-linear if they are alike."""
    methods: dict[str, Callable[[], object]] = {}
    calls = {}
    for n in (200, 1000):
        parts, joints = scene(n)
        mechanism = Mechanism(parts, "p0", joints)
        methods[f"build {n}"] = lambda parts=parts, joints=joints: Mechanism(parts, "p0", joints)
        methods[f"place {n}"] = lambda mechanism=mechanism: mechanism.poses(mechanism.rest)
        methods[f"build and place {n}"] = lambda parts=parts, joints=joints: first_poses(Mechanism(parts, "p0", joints))
        calls |= {name: n for name in methods if name.endswith(f" {n}")}
    parts, joints = scene(1000)
    tracemalloc.start()
    first_poses(Mechanism(parts, "p0", joints))
    note = f"building and placing 1000 parts takes {tracemalloc.get_traced_memory()[1] / 2**20:.1f} MB at most (goal < 20 MB over the plan)"
    tracemalloc.stop()
    goals = tuple(Goal(f"{what} 1000", f"{what} 200", at_most=1.2) for what in ("build", "place", "build and place"))
    return Table("a thousand parts beside two hundred, time per part", cpu_time(methods).each(calls), goals, (note,))


def first_poses(mechanism: Mechanism) -> SE3:
    return mechanism.poses(mechanism.rest)


def main() -> int:
    """Measure, print, and return the number of goals missed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", help="write the tables as JSON")
    options = parser.parse_args()
    chains = {n: build_table(n, "chain") for n in BUILD_GOALS}
    tables = [*chains.values(), *(build_table(n, "star") for n in BUILD_GOALS)]
    tables += [batch_table(n, batch) for n, batch in ((10, 10_000), (50, 10_000), (1000, 4096))]
    tables += [*(single_table(n) for n in (10, 50, 100)), plan_table(200), thousand_table(), import_table()]
    missed = report(tables, options.out)
    print(growth(chains))
    if numba is None:
        print("numba is not installed: its floor was not measured")
    return missed


if __name__ == "__main__":
    sys.exit(min(main(), 1))
