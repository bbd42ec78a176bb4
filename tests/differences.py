"""What engines read from a file and from its conversion, compared field by field; each difference needs a row of the losses that names it.

Only MuJoCo and Pinocchio speak here: a file and its conversion are compiled by the engine of their formats, and every fact is a number or a
name of the compiled model. Two MJCF files are compared in every field of MuJoCo's model; the other pairs in what both formats have, and in
what only MJCF can say, where a conversion to URDF must name it.

    python -m tests.differences FILE TARGET FOLDER   # TARGET: urdf or mjcf
"""

from __future__ import annotations

import json
import math
import os
import re
import sys
import tempfile
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from lxml import etree
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

RELATIVE = 1e-6  # of a number, or of the largest of its vector: meshes are single precision
ABSOLUTE = 1e-9
MESH_M = 2e-6  # by which a bounding box of a mesh may differ, and 1e-5 of its size


@dataclass(frozen=True)
class Difference:
    """One fact that the conversion does not have.

    Attributes:
        kind: Of the element, such as "joint" or "actuator".
        element: Its name, or what stands for one.
        holder: The body or joint that it belongs to.
        field: Which fact.
        was: In the original.
        now: In the conversion.
        free: True where the difference comes with a free joint.
        members: Other elements that the fact is about.
    """

    kind: str
    element: str
    holder: str
    field: str
    was: str
    now: str
    free: bool = False
    members: tuple[str, ...] = ()

    def __str__(self) -> str:
        return f"{self.kind} {self.element!r} {self.field}: {self.was} -> {self.now}"


@dataclass
class Element:
    """A thing of a compiled model.

    Attributes:
        name: As the file has it; empty where it has none.
        path: Where it stands, for those without a name.
        holder: Name of the body or joint it belongs to.
        facts: By field.
        members: Of a link that moves: the links that are fixed to it, whose masses are its own here.
    """

    name: str
    path: str
    holder: str
    facts: dict[str, Any] = field(default_factory=dict)
    members: tuple[str, ...] = ()


Facts = dict[str, list[Element]]

# ---------------------------------------------------------------------- MuJoCo


class Compiled:
    """An MJCF file as MuJoCo compiles it."""

    def __init__(self, path: Path | None) -> None:
        import mujoco

        self.mj = mujoco
        mujoco.set_mju_user_warning(lambda _text: None)
        self.m = mujoco.MjModel.from_xml_string("<mujoco/>") if path is None else mujoco.MjModel.from_xml_path(str(path))
        self.data = mujoco.MjData(self.m)
        self.body_paths = self._body_paths()

    @classmethod
    def usual(cls) -> Compiled:
        """Return the model of a file that says nothing."""
        return cls(None)

    def name(self, kind: str, index: int) -> str:
        """Return the name of an object of a kind such as "BODY"."""
        if index < 0:
            return ""
        return self.mj.mj_id2name(self.m, getattr(self.mj.mjtObj, f"mjOBJ_{kind}"), index) or ""

    def _body_paths(self) -> list[str]:
        paths = [""]
        counts: dict[int, int] = {}
        for body in range(1, self.m.nbody):
            parent = int(self.m.body_parentid[body])
            counts[parent] = counts.get(parent, 0) + 1
            paths.append(f"{paths[parent]}/{counts[parent]}")
        return paths

    def body(self, index: int) -> str:
        """Return a body's name, or its path."""
        return self.name("BODY", index) or self.body_paths[index]

    def joint(self, index: int) -> str:
        """Return a joint's name, or its path."""
        if index < 0:
            return ""
        body = int(self.m.jnt_bodyid[index])
        return self.name("JOINT", index) or f"{self.body_paths[body]}:{index - int(self.m.body_jntadr[body])}"

    def reference(self, objtype: int, index: int) -> str:
        """Return the name of what a sensor or tuple is about."""
        kind = self.mj.mjtObj(int(objtype)).name.removeprefix("mjOBJ_")
        if kind == "UNKNOWN" or index < 0:
            return ""
        if kind in {"BODY", "XBODY"}:
            return self.body(index)
        if kind == "JOINT":
            return self.joint(index)
        return self.name(kind, index) or str(index)


_DERIVED = re.compile(
    r"adr$|num$|id$|_invweight0|bvh|_simple|sameframe|subtree|^dof_M|length0|acc0|rbound|aabb|pos0$|poscom0|mat0|dir0|needstage|datatype|signature|treenum"
)


def _fields(compiled: Compiled, prefix: str, index: int, skip: Iterable[str] = ()) -> dict[str, Any]:
    """Return every field of MuJoCo's model that a kind of object has, of one object."""
    m = compiled.m
    found = {}
    for name in _names(compiled, prefix):
        short = name.removeprefix(f"{prefix}_")
        if short not in skip:
            found[short] = np.array(getattr(m, name)[index], dtype=np.float64)
    return found


_NAMES: dict[str, list[str]] = {}


def _names(compiled: Compiled, prefix: str) -> list[str]:
    if prefix not in _NAMES:
        _NAMES[prefix] = [
            name
            for name in dir(compiled.m)
            if name.startswith(f"{prefix}_") and not _DERIVED.search(name) and isinstance(getattr(compiled.m, name), np.ndarray)
        ]
    return _NAMES[prefix]


def _turn(wxyz: FloatArray) -> FloatArray:
    w, x, y, z = np.asarray(wxyz, dtype=np.float64) / np.linalg.norm(wxyz)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def mujoco_facts(compiled: Compiled) -> Facts:
    """Return everything that a compiled model says, element by element."""
    facts: Facts = {
        "model": [Element("", "", "", _settings(compiled))],
        "body": [],
        "joint": [],
        "geom": [],
        "site": [],
        "cam": [],
        "light": [],
    }
    m = compiled.m
    for body in range(m.nbody):
        facts["body"].append(Element(compiled.name("BODY", body), compiled.body_paths[body], compiled.body(body), _body(compiled, body)))
    for joint in range(m.njnt):
        facts["joint"].append(
            Element(compiled.name("JOINT", joint), _joint_path(compiled, joint), compiled.joint(joint), _joint(compiled, joint))
        )
    counts: dict[str, int] = {}
    for geom in range(m.ngeom):
        body = int(m.geom_bodyid[geom])
        collides = bool(m.geom_contype[geom] or m.geom_conaffinity[geom])
        path = f"{compiled.body_paths[body]} {compiled.mj.mjtGeom(int(m.geom_type[geom])).name} {collides}"
        counts[path] = counts.get(path, 0) + 1
        facts["geom"].append(Element(compiled.name("GEOM", geom), f"{path} {counts[path]}", compiled.body(body), _geom(compiled, geom)))
    for kind, prefix, number in (("SITE", "site", m.nsite), ("CAMERA", "cam", m.ncam), ("LIGHT", "light", m.nlight)):
        for index in range(number):
            body = int(getattr(m, f"{prefix}_bodyid")[index])
            found = _fields(compiled, prefix, index, {"quat"}) | {"body": compiled.body(body)}
            if prefix != "light":
                found["turn"] = _turn(getattr(m, f"{prefix}_quat")[index])
            if prefix == "site" and m.site_matid[index] >= 0:
                found["rgba"] = np.array(m.mat_rgba[m.site_matid[index]])
            if prefix != "site":
                found["target"] = compiled.name("BODY", int(getattr(m, f"{prefix}_targetbodyid")[index]))
            path = f"{compiled.body_paths[body]} {prefix}"
            counts[path] = counts.get(path, 0) + 1
            facts[prefix].append(Element(compiled.name(kind, index), f"{path} {counts[path]}", compiled.body(body), found))
    facts |= _relations(compiled)
    return facts


def _same_turn(data: FloatArray, at: int) -> FloatArray:
    """Return numbers with a quaternion among them that begins with a number above zero: its opposite is the same turn."""
    found = np.array(data)
    lead = next((x for x in found[at : at + 4] if abs(x) > 1e-9), 1.0)
    found[at : at + 4] *= math.copysign(1.0, lead)
    return found


def _settings(compiled: Compiled) -> dict[str, Any]:
    m = compiled.m
    found: dict[str, Any] = {}
    for top, prefix in (
        (m.opt, "option"),
        (m.vis.global_, "visual"),
        (m.vis.quality, "visual"),
        (m.vis.headlight, "visual"),
        (m.vis.map, "visual"),
    ):
        for name in dir(top):
            value = getattr(top, name)
            if not name.startswith("_") and isinstance(value, (int, float, np.ndarray)):
                found[f"{prefix}.{name}"] = np.array(value, dtype=np.float64)
    return found


def _body(compiled: Compiled, body: int) -> dict[str, Any]:
    m = compiled.m
    R = _turn(m.body_iquat[body])
    return {
        "parent": compiled.body(int(m.body_parentid[body])) if body else "",
        "pos": np.array(m.body_pos[body]),
        "turn": _turn(m.body_quat[body]),
        "mass": np.array(m.body_mass[body]),
        "com": np.array(m.body_ipos[body]) * (m.body_mass[body] > 0),
        "inertia": R @ np.diag(m.body_inertia[body]) @ R.T,
        "gravcomp": np.array(m.body_gravcomp[body]),
        "mocap": np.array(m.body_mocapid[body] >= 0),
    } | ({"user": np.array(m.body_user[body])} if m.body_user.size else {})


def _joint_path(compiled: Compiled, joint: int) -> str:
    body = int(compiled.m.jnt_bodyid[joint])
    return f"{compiled.body_paths[body]}:{joint - int(compiled.m.body_jntadr[body])}"


def _joint(compiled: Compiled, joint: int) -> dict[str, Any]:
    m = compiled.m
    q, v = int(m.jnt_qposadr[joint]), int(m.jnt_dofadr[joint])
    kind = compiled.mj.mjtJoint(int(m.jnt_type[joint])).name
    width = {"mjJNT_FREE": 7, "mjJNT_BALL": 4}.get(kind, 1)
    found = _fields(compiled, "jnt", joint, {"range", "actfrcrange", "limited", "actfrclimited", "axis", "pos"})
    found |= _fields(compiled, "dof", v, {"length"})
    found |= {
        "limit": _limit(m.jnt_limited[joint], m.jnt_range[joint]),
        "effort": _limit(m.jnt_actfrclimited[joint], m.jnt_actfrcrange[joint]),
    }
    found |= {"qpos0": np.array(m.qpos0[q : q + width]), "springref": np.array(m.qpos_spring[q : q + width])}
    if width == 1:
        found["axis"] = np.array(m.jnt_axis[joint])
    if kind != "mjJNT_FREE":
        found["pos"] = np.array(m.jnt_pos[joint])
    return found | {"type": kind, "body": compiled.body(int(m.jnt_bodyid[joint]))}


def _limit(limited: Any, bounds: FloatArray) -> FloatArray:
    return np.array(bounds) if limited else np.array([-math.inf, math.inf])


def _geom(compiled: Compiled, geom: int) -> dict[str, Any]:
    m = compiled.m
    kind = compiled.mj.mjtGeom(int(m.geom_type[geom])).name
    found = _fields(compiled, "geom", geom, {"pos", "quat", "size", "rgba", "type"}) | {
        "type": kind,
        "body": compiled.body(int(m.geom_bodyid[geom])),
    }
    R = _turn(m.geom_quat[geom])
    if kind == "mjGEOM_MESH":
        mesh = int(m.geom_dataid[geom])
        points = m.mesh_vert[m.mesh_vertadr[mesh] :][: m.mesh_vertnum[mesh]].astype(np.float64) @ R.T + m.geom_pos[geom]
        found["box"] = np.array([points.min(axis=0), points.max(axis=0)])
    else:
        found |= {"pos": np.array(m.geom_pos[geom]), "turn": _axes(kind, R), "size": np.array(m.geom_size[geom])[: _SIZES.get(kind, 3)]}
    material = int(m.geom_matid[geom])
    found["rgba"] = np.array(m.mat_rgba[material] if material >= 0 else m.geom_rgba[geom])
    return found


_SIZES = {"mjGEOM_SPHERE": 1, "mjGEOM_CAPSULE": 2, "mjGEOM_CYLINDER": 2}  # how many of its three sizes a geom has


def _axes(kind: str, R: FloatArray) -> FloatArray:
    """Return what of a geom's turn can be seen: nothing of a ball, the axis of a cylinder."""
    if kind == "mjGEOM_SPHERE":
        return np.eye(3)
    return np.outer(R[:, 2], R[:, 2]) if kind in {"mjGEOM_CAPSULE", "mjGEOM_CYLINDER"} else R


def _relations(compiled: Compiled) -> Facts:
    """Return what refers to bodies, joints and geoms: equalities, tendons, actuators, sensors, pairs, keys and custom data."""
    m = compiled.m
    numbers = {"equality": m.neq, "tendon": m.ntendon, "actuator": m.nu, "sensor": m.nsensor, "pair": m.npair, "key": m.nkey}
    numbers |= {"numeric": m.nnumeric, "text": m.ntext, "tuple": m.ntuple}
    facts: Facts = {
        kind: [Element(compiled.name(kind.upper(), row), str(row), "", _RELATIONS[kind](compiled, row)) for row in range(number)]
        for kind, number in numbers.items()
        if number
    }
    facts["text"] = [element for element in facts.get("text", []) if not element.name.startswith("articad.")]
    facts["exclude"] = []
    for row in range(m.nexclude):
        signature = int(m.exclude_signature[row])
        ends = sorted(compiled.body(i) for i in (signature >> 16, signature & 0xFFFF))
        facts["exclude"].append(Element("+".join(ends), str(row), ends[0], {"ends": ends}))
    return {kind: elements for kind, elements in facts.items() if elements}


def _equality(compiled: Compiled, row: int) -> dict[str, Any]:
    m = compiled.m
    kind = compiled.mj.mjtEq(int(m.eq_type[row])).name
    ids = [int(i) for i in (m.eq_obj1id[row], m.eq_obj2id[row])]
    if kind == "mjEQ_JOINT":
        ends = [compiled.joint(i) for i in ids]
    elif kind == "mjEQ_TENDON":
        ends = [compiled.name("TENDON", i) for i in ids]
    else:
        ends = [compiled.reference(m.eq_objtype[row], i) for i in ids]
    found = _fields(compiled, "eq", row, {"type", "objtype"}) | {"type": kind, "ends": ends, "objtype": int(m.eq_objtype[row])}
    return found | ({"data": _same_turn(m.eq_data[row], 6)} if kind == "mjEQ_WELD" else {})


def _tendon(compiled: Compiled, row: int) -> dict[str, Any]:
    m = compiled.m
    wraps: list[tuple[Any, ...]] = []
    for at in range(int(m.tendon_adr[row]), int(m.tendon_adr[row] + m.tendon_num[row])):
        kind, index, value = compiled.mj.mjtWrap(int(m.wrap_type[at])).name, int(m.wrap_objid[at]), float(m.wrap_prm[at])
        if kind == "mjWRAP_JOINT":
            wraps.append((kind, compiled.joint(index), round(value, 9)))
        elif kind in {"mjWRAP_SPHERE", "mjWRAP_CYLINDER"}:
            wraps.append((kind, compiled.name("GEOM", index), compiled.name("SITE", int(value))))
        else:
            wraps.append((kind, compiled.name("SITE", index) if kind == "mjWRAP_SITE" else "", round(value, 9)))
    return _fields(compiled, "tendon", row) | {"path": wraps}


def _actuator(compiled: Compiled, row: int) -> dict[str, Any]:
    m = compiled.m
    kind = compiled.mj.mjtTrn(int(m.actuator_trntype[row])).name
    first, second = (int(i) for i in m.actuator_trnid[row])
    if "JOINT" in kind:
        ends = [compiled.joint(first)]
    elif kind == "mjTRN_BODY":
        ends = [compiled.body(first)]
    elif kind == "mjTRN_TENDON":
        ends = [compiled.name("TENDON", first)]
    else:
        ends = [compiled.name("SITE", first), compiled.name("SITE", second)]
    return _fields(compiled, "actuator", row) | {"moves": [kind, *ends]}


def _sensor(compiled: Compiled, row: int) -> dict[str, Any]:
    m = compiled.m
    pairs = ((m.sensor_objtype[row], m.sensor_objid[row]), (m.sensor_reftype[row], m.sensor_refid[row]))
    return _fields(compiled, "sensor", row) | {"about": [compiled.reference(kind, int(index)) for kind, index in pairs]}


def _pair(compiled: Compiled, row: int) -> dict[str, Any]:
    ends = [compiled.name("GEOM", int(i)) for i in (compiled.m.pair_geom1[row], compiled.m.pair_geom2[row])]
    return _fields(compiled, "pair", row, {"geom1", "geom2"}) | {"ends": ends}


def _key_of_file(compiled: Compiled, row: int) -> dict[str, Any]:
    m = compiled.m
    found: dict[str, Any] = {}
    for joint in range(m.njnt):
        at, width = int(m.jnt_qposadr[joint]), {0: 7, 1: 4}.get(int(m.jnt_type[joint]), 1)
        found[f"qpos of {compiled.joint(joint)}"] = np.array(m.key_qpos[row][at : at + width])
    return found | {name: np.array(getattr(m, f"key_{name}")[row]) for name in ("time", "qvel", "act", "ctrl", "mpos", "mquat")}


def _text_of_file(compiled: Compiled, row: int) -> dict[str, Any]:
    m = compiled.m
    return {"data": bytes(m.text_data[m.text_adr[row] :][: m.text_size[row]]).decode(errors="replace")}


def _tuple(compiled: Compiled, row: int) -> dict[str, Any]:
    m = compiled.m
    span = range(int(m.tuple_adr[row]), int(m.tuple_adr[row] + m.tuple_size[row]))
    return {"of": [(compiled.reference(m.tuple_objtype[i], int(m.tuple_objid[i])), float(m.tuple_objprm[i])) for i in span]}


_RELATIONS: Mapping[str, Callable[[Compiled, int], dict[str, Any]]] = {
    "equality": _equality,
    "tendon": _tendon,
    "actuator": _actuator,
    "sensor": _sensor,
    "pair": _pair,
    "key": _key_of_file,
    "numeric": lambda compiled, row: {
        "data": np.array(compiled.m.numeric_data[compiled.m.numeric_adr[row] :][: compiled.m.numeric_size[row]])
    },
    "text": _text_of_file,
    "tuple": _tuple,
}


# ---------------------------------------------------------------------- what both engines have


_KINDS = {0: "free", 1: "ball", 2: "slide", 3: "turn"}  # of MuJoCo's joints


def common_of_mujoco(path: Path) -> Facts:
    """Return what URDF can say too, and what only MJCF says."""
    compiled = Compiled(path)
    m = compiled.m
    names = [compiled.name("BODY", body) or f"body_{body}" for body in range(m.nbody)]
    return {
        **_links_of_mujoco(compiled, names),
        "joint": [
            Element(compiled.name("JOINT", joint) or f"joint_{joint}", "", names[int(m.jnt_bodyid[joint])], _common_joint(compiled, joint))
            for joint in range(m.njnt)
        ],
        "shape": list(_shapes_of_mujoco(compiled, names, _posed(compiled, moved=False))),
        "mimic": _ties(compiled),
        "model": [Element("", "", "", {"gravity": np.array(m.opt.gravity)})],
    } | _only_mjcf(compiled, names)


def _posed(compiled: Compiled, *, moved: bool) -> list[FloatArray]:
    """Return the poses of all bodies with all joints at zero, or at the values that belong to their names."""
    m, data = compiled.m, compiled.data
    data.qpos[:] = 0
    for joint in range(m.njnt):
        at, kind = int(m.jnt_qposadr[joint]), _KINDS[int(m.jnt_type[joint])]
        if kind == "ball":
            data.qpos[at] = 1
        elif kind == "free":  # URDF counts from where the body stands in the file
            data.qpos[at : at + 7] = m.qpos0[at : at + 7]
        elif moved:
            data.qpos[at] = _value(compiled.name("JOINT", joint) or f"joint_{joint}")
    compiled.mj.mj_kinematics(m, data)
    return [_pose(data.xmat[body].reshape(3, 3), data.xpos[body]) for body in range(m.nbody)]


def _links_of_mujoco(compiled: Compiled, names: list[str]) -> Facts:
    """Return where links are, and the inertia of the ground and of those that move, with all that is fixed to them."""
    m = compiled.m
    at_zero, moved = (_posed(compiled, moved=moved) for moved in (False, True))
    groups: dict[int, list[tuple[float, FloatArray, FloatArray]]] = {}
    roots: list[int] = []
    for body in range(m.nbody):
        roots.append(body if body == 0 or m.body_jntnum[body] else roots[int(m.body_parentid[body])])
        R = at_zero[body][:3, :3] @ _turn(m.body_iquat[body])
        com = at_zero[body] @ np.array([*m.body_ipos[body], 1.0])
        groups.setdefault(roots[body], []).append((float(m.body_mass[body]), com[:3], R @ np.diag(m.body_inertia[body]) @ R.T))
    members = {root: tuple(other for other, above in zip(names, roots, strict=True) if above == root) for root in set(roots)}
    links = [
        Element(
            name,
            "",
            name,
            {"frame": at_zero[body], "frame in motion": moved[body]} | (_combined(groups[body]) if body and roots[body] == body else {}),
            members.get(body, ()),
        )
        for body, name in enumerate(names)
    ]
    return {"link": links, "ground": [Element("ground", "", "", _combined(groups[0]), members[0])]}


def _common_joint(compiled: Compiled, joint: int) -> dict[str, Any]:
    m = compiled.m
    at, kind = int(m.jnt_dofadr[joint]), _KINDS[int(m.jnt_type[joint])]
    found: dict[str, Any] = {
        "type": kind,
        "damping": np.array(m.dof_damping[at]),
        "friction": np.array(m.dof_frictionloss[at]),
        "armature": np.array(m.dof_armature[at]),
        "stiffness": np.array(m.jnt_stiffness[joint]),
        "effort": np.array(float(np.abs(m.jnt_actfrcrange[joint]).max()) if m.jnt_actfrclimited[joint] else math.inf),
        "velocity": np.array(math.inf),
    }
    if kind in {"turn", "slide"}:
        found["limit"] = _limit(m.jnt_limited[joint], m.jnt_range[joint])
        found["qpos0"] = np.array(m.qpos0[int(m.jnt_qposadr[joint])])
    if kind == "ball" and m.jnt_limited[joint]:
        found["cone"] = np.array(m.jnt_range[joint][1])
    return found


def _value(name: str) -> float:
    """Return a value for a joint that depends on its name alone [rad or m]."""
    if re.search(r"__r?[xyz]$", name):  # of a ball or a free body, which are left at rest
        return 0.0
    plain = unicodedata.normalize("NFKD", name).encode("ascii", "ignore").decode()  # names of URDF are such
    plain = re.sub(r"^n(?=\d)", "", plain)  # and begin with a letter
    return 0.05 + 0.3 * (sum(ord(letter) for letter in plain if letter.isalnum()) % 17) / 17


def _pose(R: FloatArray, p: FloatArray) -> FloatArray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R, p
    return T


def _combined(bodies: list[tuple[float, FloatArray, FloatArray]]) -> dict[str, Any]:
    """Return mass, centre and inertia of bodies that do not move against each other, about their centre, along the world's axes."""
    mass = sum(one[0] for one in bodies)
    if not mass > 0:
        return {"mass": np.array(0.0)}
    com = sum((one[0] * one[1] for one in bodies), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for m, c, I in bodies:
        d = c - com
        inertia += I + m * (d @ d * np.eye(3) - np.outer(d, d))
    return {"mass": np.array(mass), "com": com, "inertia": inertia}


_BEYOND_SHAPES = {"mjGEOM_PLANE": " plane", "mjGEOM_HFIELD": " hfield", "mjGEOM_SDF": " sdf"}


def _shapes_of_mujoco(compiled: Compiled, names: list[str], at_zero: list[FloatArray]) -> Iterator[Element]:
    """Yield shapes to see and to collide with, as they stand in the world where all joints are at zero."""
    counts: dict[str, int] = {}
    m = compiled.m
    words = {
        "mjGEOM_BOX": "box",
        "mjGEOM_SPHERE": "sphere",
        "mjGEOM_CYLINDER": "cylinder",
        "mjGEOM_CAPSULE": "capsule",
        "mjGEOM_MESH": "mesh",
    }
    for geom in range(m.ngeom):
        body = int(m.geom_bodyid[geom])
        kind = compiled.mj.mjtGeom(int(m.geom_type[geom])).name
        without = _BEYOND_SHAPES.get(kind, "")  # URDF leaves these out, and counts the others
        key = f"{names[body]}{without} {'collision' if m.geom_contype[geom] or m.geom_conaffinity[geom] else 'visual'}"
        counts[key] = counts.get(key, -1) + 1
        T = at_zero[body] @ _pose(_turn(m.geom_quat[geom]), m.geom_pos[geom])
        found: dict[str, Any] = {"type": words.get(kind, kind)}
        if kind == "mjGEOM_MESH":
            mesh = int(m.geom_dataid[geom])
            points = m.mesh_vert[m.mesh_vertadr[mesh] :][: m.mesh_vertnum[mesh]].astype(np.float64) @ T[:3, :3].T + T[:3, 3]
            found["box"] = np.array([points.min(axis=0), points.max(axis=0)])
        elif kind in words:
            a, b, c = (float(x) for x in m.geom_size[geom])
            sizes = {
                "mjGEOM_BOX": (2 * a, 2 * b, 2 * c),
                "mjGEOM_SPHERE": (a,),
                "mjGEOM_CYLINDER": (a, 2 * b),
                "mjGEOM_CAPSULE": (a, 2 * b),
            }
            found |= {"size": np.array(sizes[kind]), "place": T[:3, 3], "turn": _axes(kind, T[:3, :3])}
        yield Element(f"{key} {counts[key]}", compiled.name("GEOM", geom), names[body], found)


def _ties(compiled: Compiled) -> list[Element]:
    """Return q1 = c0 + c1 · q2, without the offsets of the joints' references."""
    m = compiled.m
    rows = []
    for row in range(m.neq):
        first, second = int(m.eq_obj1id[row]), int(m.eq_obj2id[row])
        if m.eq_type[row] != compiled.mj.mjtEq.mjEQ_JOINT or second < 0 or any(m.eq_data[row][2:5]) or not m.eq_active0[row]:
            continue
        c0, c1 = (float(c) for c in m.eq_data[row][:2])
        zero1, zero2 = (float(m.qpos0[int(m.jnt_qposadr[joint])]) for joint in (first, second))
        names = [compiled.name("JOINT", joint) or f"joint_{joint}" for joint in (first, second)]
        rows.append(_tie(names[0], names[1], c1, zero1 + c0 - c1 * zero2))
    return rows


def _tie(follower: str, leader: str, ratio: float, offset: float) -> Element:
    """Return q_follower = ratio · q_leader + offset, the same from whichever side it is written."""
    if follower > leader and ratio:
        follower, leader, ratio, offset = leader, follower, 1 / ratio, -offset / ratio
    return Element(f"{follower}+{leader}", "", follower, {"line": np.array([ratio, offset])})


_GEOM_DEFAULTS: Mapping[str, Any] = {
    "contype": 1, "conaffinity": 1, "condim": 3, "priority": 0, "solmix": 1, "margin": 0, "gap": 0, "friction": (1, 0.005, 0.0001),
    "solref": (0.02, 1), "solimp": (0.9, 0.95, 0.001, 0.5, 2),
}  # fmt: skip
_JOINT_DEFAULTS: Mapping[str, Any] = {"margin": 0, "solref": (0.02, 1), "solimp": (0.9, 0.95, 0.001, 0.5, 2), "actgravcomp": 0}


def _only_mjcf(compiled: Compiled, names: list[str]) -> Facts:
    """Return what URDF has no word for, where it is not what MuJoCo takes where nothing is said."""
    m = compiled.m
    facts: Facts = {"geom": [], "mjcf joint": [], "mjcf body": []}
    for geom in range(m.ngeom):
        holder = names[int(m.geom_bodyid[geom])]
        collides = m.geom_contype[geom] or m.geom_conaffinity[geom]
        facts["geom"].append(
            Element(compiled.name("GEOM", geom) or holder, "", holder, _unusual(m, "geom", geom, _GEOM_DEFAULTS) if collides else {})
        )
    for joint in range(m.njnt):
        name = compiled.name("JOINT", joint) or f"joint_{joint}"
        facts["mjcf joint"].append(Element(name, "", name, _unusual(m, "jnt", joint, _JOINT_DEFAULTS) | _one_sided(m, joint)))
    for body, name in enumerate(names):
        said: dict[str, Any] = _unusual(m, "body", body, {"gravcomp": 0.0}) | ({"mocap": True} if m.body_mocapid[body] >= 0 else {})
        facts["mjcf body"].append(Element(name, "", name, said))
    facts["settings"] = [Element("", "", "", _unusual_settings(compiled))]
    facts = {kind: [element for element in elements if element.facts] for kind, elements in facts.items()} | _by_name(compiled, names)
    return {kind: elements for kind, elements in facts.items() if elements}


def _unusual(m: Any, prefix: str, index: int, usual: Mapping[str, Any]) -> dict[str, Any]:
    values = {name: np.array(getattr(m, f"{prefix}_{name}")[index]) for name in usual if hasattr(m, f"{prefix}_{name}")}
    return {name: value for name, value in values.items() if not np.array_equal(value, usual[name])}


def _one_sided(m: Any, joint: int) -> dict[str, Any]:
    """Return a range of forces whose ends differ, and where a spring rests."""
    found: dict[str, Any] = {}
    if m.jnt_actfrclimited[joint] and m.jnt_actfrcrange[joint][0] != -m.jnt_actfrcrange[joint][1]:
        found["actuatorfrcrange"] = np.array(m.jnt_actfrcrange[joint])
    at = int(m.jnt_qposadr[joint])
    if _KINDS[int(m.jnt_type[joint])] in {"slide", "turn"} and m.qpos_spring[at]:
        found["springref"] = np.array(m.qpos_spring[at])
    return found


def _unusual_settings(compiled: Compiled) -> dict[str, Any]:
    usual = _settings(Compiled.usual())
    said = _settings(compiled)
    return {name: value for name, value in said.items() if not _same(value, usual[name], name) and name != "option.gravity"}


def _by_name(compiled: Compiled, names: list[str]) -> Facts:
    """Return that there is what URDF does not have: relations, keys, sites, cameras and lights."""
    m = compiled.m
    facts: Facts = {}
    for kind, elements in _relations(compiled).items():
        for number, element in enumerate(elements):
            said = element.facts
            if kind == "equality" and said["type"] == "mjEQ_JOINT" and said["ends"][1] and said["active0"] and not any(said["data"][2:5]):
                continue  # a tie
            facts.setdefault(kind, []).append(Element(element.name or f"{kind}_{number}", "", "", {"it": True}))
    for kind, word, count in (("site", "SITE", m.nsite), ("cam", "CAMERA", m.ncam), ("light", "LIGHT", m.nlight)):
        for index in range(count):
            body = names[int(getattr(m, f"{kind}_bodyid")[index])]
            facts.setdefault(kind, []).append(Element(compiled.name(word, index) or body, "", body, {"it": True}))
    return facts


def common_of_pinocchio(path: Path, packages: Path, *, both: bool = False) -> Facts:
    """Return the same of a URDF; what fixed joints hold, link by link, where both files are URDF."""
    import pinocchio as pin

    model = pin.buildModelFromUrdf(str(path))
    shapes, unread = _shapes_of_pinocchio(model, path, packages)
    return {
        "link": _links_of_pinocchio(model),
        "ground": [_ground_of_pinocchio(model)],
        "fixed joint": _fixed_in_pinocchio(model) if both else [],
        "joint": [
            Element(model.names[index], "", model.names[index], _joint_of_pinocchio(model, index)) for index in range(1, model.njoints)
        ],
        "shape": shapes,
        "unread": unread,
        "mimic": _mimics(path),
        "model": [Element("", "", "", {"gravity": np.array(model.gravity.linear)})],
    }


def _links_of_pinocchio(model: Any) -> list[Element]:
    import pinocchio as pin

    data = model.createData()
    poses = []
    for moved in (True, False):  # masses are asked for at zero
        q = pin.neutral(model)
        for name, joint in list(zip(model.names, model.joints, strict=True))[1:]:
            if moved and joint.nv == 1:
                value = _value(name)
                q[joint.idx_q : joint.idx_q + joint.nq] = [math.cos(value), math.sin(value)] if joint.nq == 2 else [value]
        pin.framesForwardKinematics(model, data, q)
        poses.append([data.oMf[index].homogeneous.copy() for index in range(model.nframes)])
    elements = []
    seen: set[int] = {0}
    for index, frame in enumerate(model.frames):
        if frame.type == pin.FrameType.BODY:
            found: dict[str, Any] = {"frame": poses[1][index], "frame in motion": poses[0][index]}
            members: tuple[str, ...] = ()
            if frame.parentJoint not in seen:  # the first link of a joint, with all that is fixed to it
                Y, T = model.inertias[frame.parentJoint], data.oMi[frame.parentJoint]
                found |= _combined([(float(Y.mass), T.act(Y.lever), T.rotation @ Y.inertia @ T.rotation.T)])
                members = tuple(one.name for one in model.frames if one.parentJoint == frame.parentJoint and one.type == pin.FrameType.BODY)
            seen.add(frame.parentJoint)
            elements.append(Element(frame.name, "", frame.name, found, members))
    return elements


_PINOCCHIO = {"FreeFlyer": "free", "Spherical": "ball", "Planar": "planar", "P": "slide", "R": "turn"}
"""How the names of Pinocchio's joints begin, after `JointModel`."""


def _ground_of_pinocchio(model: Any) -> Element:
    """Return the inertia of what does not move."""
    import pinocchio as pin

    Y = model.inertias[0]
    fixed = tuple(frame.name for frame in model.frames if frame.parentJoint == 0 and frame.type == pin.FrameType.BODY)
    return Element("ground", "", "", _combined([(float(Y.mass), Y.lever, Y.inertia)]), fixed)


def _fixed_in_pinocchio(model: Any) -> list[Element]:
    """Return the fixed joints, each with the inertia of the link that it holds."""
    import pinocchio as pin

    return [
        Element(
            frame.name,
            "",
            model.frames[index + 1].name,
            {"mass": np.array(Y.mass), "com": np.array(Y.lever) * (Y.mass > 0), "inertia": np.array(Y.inertia)},
        )
        for index, frame in enumerate(model.frames)
        if index and frame.type == pin.FrameType.FIXED_JOINT
        for Y in [frame.inertia]
    ]


def _joint_of_pinocchio(model: Any, index: int) -> dict[str, Any]:
    joint = model.joints[index]
    word = joint.shortname().removeprefix("JointModel")
    found: dict[str, Any] = {"type": next(kind for start, kind in _PINOCCHIO.items() if word.startswith(start)), "nv": joint.nv}
    if joint.nv != 1:
        return found
    at, endless = joint.idx_v, joint.nq == 2
    ends = (-math.inf, math.inf) if endless else (model.lowerPositionLimit[joint.idx_q], model.upperPositionLimit[joint.idx_q])
    return found | {
        "limit": np.array(ends),
        "effort": np.array(model.effortLimit[at]),
        "velocity": np.array(model.velocityLimit[at]),
        "qpos0": np.array(0.0),
        "damping": np.array(model.damping[at]),
        "friction": np.array(model.friction[at]),
        "armature": np.array(model.armature[at]),
        "stiffness": np.array(0.0),
    }


def _mimics(path: Path) -> list[Element]:
    import pinocchio as pin

    try:
        model = pin.buildModelFromUrdf(str(path), mimic=True)
    except ValueError:  # it wants the leader above the follower in the tree; the text says the same
        text = [(joint.get("name"), joint.find("mimic")) for joint in etree.parse(str(path)).getroot().iterfind("joint")]
        said = [
            (name, mimic.get("joint"), mimic.get("multiplier", "1"), mimic.get("offset", "0")) for name, mimic in text if mimic is not None
        ]
        return [_tie(follower, leader, float(ratio), float(offset)) for follower, leader, ratio, offset in said]
    rows = []
    for follower, leader in zip(model.mimicking_joints, model.mimicked_joints, strict=True):
        mimic = model.joints[follower].extract()
        rows.append(_tie(model.names[follower], model.names[leader], float(mimic.scaling), float(mimic.offset)))
    return rows


def _shapes_of_pinocchio(model: Any, path: Path, packages: Path) -> tuple[list[Element], list[Element]]:
    """Return the shapes of all links, and whether those to see or to collide with cannot be read, such as for a mesh that is missing."""
    import pinocchio as pin

    folders = [str(folder) for folder in (path.parent, *path.parents) if folder.is_relative_to(packages)]
    data = model.createData()
    pin.forwardKinematics(model, data, pin.neutral(model))
    elements, unread = [], []
    for kind, word in ((pin.GeometryType.VISUAL, "visual"), (pin.GeometryType.COLLISION, "collision")):
        try:
            shapes = pin.buildGeomFromUrdf(model, str(path), kind, package_dirs=folders)
        except (ValueError, RuntimeError):
            unread.append(Element(word, "", "", {}))
            continue
        counts: dict[str, int] = {}
        for shape in shapes.geometryObjects:
            link = model.frames[shape.parentFrame].name
            key = f"{link} {word}"
            counts[key] = counts.get(key, -1) + 1
            T = data.oMi[shape.parentJoint] * shape.placement
            elements.append(Element(f"{key} {counts[key]}", "", link, _shape(shape, T)))
    return elements, unread


def _shape(shape: Any, T: Any) -> dict[str, Any]:
    form = shape.geometry
    kind = type(form).__name__
    R = T.rotation
    place = {"place": np.array(T.translation)}
    if kind == "Box":
        return {"type": "box", "size": 2 * np.array(form.halfSide), "turn": R} | place
    if kind == "Sphere":
        return {"type": "sphere", "size": np.array([form.radius]), "turn": np.eye(3)} | place
    if kind in {"Cylinder", "Capsule"}:
        return {"type": kind.lower(), "size": np.array([form.radius, 2 * form.halfLength]), "turn": np.outer(R[:, 2], R[:, 2])} | place
    points = np.array(form.vertices()) @ R.T + T.translation if hasattr(form, "vertices") and len(form.vertices()) else None
    return {"type": "mesh"} | ({} if points is None else {"box": np.array([points.min(axis=0), points.max(axis=0)])})


# ---------------------------------------------------------------------- comparing


_ONLY_STATED = frozenset({"geom", "mjcf joint", "mjcf body", "settings"})  # kinds of elements that the other engine does not have at all


_BEYOND_URDF = frozenset({"settings", "geom", "site", "cam", "light"})  # what MuJoCo has for every model, and URDF cannot state


def _renamed(name: str, renames: Mapping[str, str]) -> str:
    """Return the new name of an element, or of the link that a shape such as `arm visual 0` belongs to."""
    if name in renames:
        return renames[name]
    link = re.sub(r"(?: plane| hfield| sdf)? (?:visual|collision) \d+$", "", name)
    return renames.get(link, link) + name[len(link) :]


def differences(one: Facts, other: Facts, renames: Mapping[str, str] = MappingProxyType({})) -> list[Difference]:
    """Return the facts of `one` that `other` does not have, and elements that only `other` has.

    Args:
        one: Of the original.
        other: Of the conversion.
        renames: What links and joints with other names are called in the conversion.
    """
    found: list[Difference] = []
    other = _with_the_names_of(one, other)
    one, other = _both_read(one, other)
    old = {new: name for name, new in renames.items()}
    floating = [
        (index, element) for index, element in enumerate(one.get("joint", [])) if element.facts.get("type") in {"free", "mjJNT_FREE"}
    ]
    free = {
        name
        for index, element in floating
        for name in (element.name or element.path, f"joint_{index}", str(element.facts.get("body", element.holder)))
    }
    for kind in (*one, *(kind for kind in other if kind not in one and kind not in _BEYOND_URDF)):
        left, right = one.get(kind, []), other.get(kind, [])
        by_name = {element.name: element for element in right if element.name}
        by_path = {element.path: element for element in right}
        seen = set()
        for element in left:
            new = _renamed(element.name, renames)
            new = new if new in by_name else element.name
            twin = by_name.get(new) if element.name else by_path.get(element.path)
            label = element.name or f"{element.holder} {element.path}".strip()
            if twin is None:
                fields = element.facts.items() if kind in _ONLY_STATED else [("exists", "yes")]
                said = [(name, _text(value)) for name, value in fields]
                found += [Difference(kind, label, element.holder, name, value, "no", _of_free(element, free)) for name, value in said]
                continue
            if element.name in renames and kind in {"link", "joint", "fixed joint"}:
                found.append(Difference(kind, label, element.holder, "name", element.name, renames[element.name], _of_free(element, free)))
            seen.add(id(twin))
            for name, value in element.facts.items():
                if name in twin.facts and not _same(value, twin.facts[name], name):
                    members = element.members if name in {"mass", "com", "inertia"} else ()
                    was, now = _text(value), _text(twin.facts[name])
                    found.append(Difference(kind, label, element.holder, name, was, now, _of_free(element, free), members))
        found += [
            Difference(
                kind,
                old.get(element.name, element.name) or element.path,
                _made_for(element.holder, old),
                "exists",
                "no",
                "yes",
                _of_free(element, free),
            )
            for element in right
            if id(element) not in seen
            and not (kind == "link" and element.name == "world" and set(element.facts) == {"frame", "frame in motion"})
        ]
    return found


def _both_read(one: Facts, other: Facts) -> tuple[Facts, Facts]:
    """Return both without the shapes that an engine cannot read in one of them."""
    unread = {f" {element.name} " for facts in (one, other) for element in facts.get("unread", [])}
    one, other = ({kind: elements for kind, elements in facts.items() if kind != "unread"} for facts in (one, other))
    for facts in (one, other):
        if unread and "shape" in facts:
            facts["shape"] = [element for element in facts["shape"] if not any(word in element.name for word in unread)]
    return one, other


def _made_for(name: str, old: Mapping[str, str]) -> str:
    """Return the original's name of an element, or of the joint that a carrier stands for."""
    match = _CARRIER.match(name)
    return old.get(name) or (old.get(match[1]) if match else None) or name


def _with_the_names_of(one: Facts, other: Facts) -> Facts:
    """Return `other` with the names of bodies and joints that have none in `one` replaced by what `one` calls them."""
    calls: dict[str, str] = {}
    for kind in ("body", "joint"):
        by_path = {element.path: element for element in other.get(kind, [])}
        for element in one.get(kind, []):
            if not element.name and (twin := by_path.get(element.path)) is not None and twin.name:
                calls[twin.name] = element.path

    def renamed(value: Any) -> Any:
        if isinstance(value, str):
            return calls.get(value, value)
        return [renamed(item) for item in value] if isinstance(value, list) else value

    return {
        kind: [
            Element(
                element.name,
                element.path,
                renamed(element.holder),
                {renamed_key(name, calls): renamed(value) for name, value in element.facts.items()},
                element.members,
            )
            for element in elements
        ]
        for kind, elements in other.items()
    }


def renamed_key(name: str, calls: Mapping[str, str]) -> str:
    """Return the field with a joint's name as the original has it, such as of `qpos of joint_3`."""
    head, of, joint = name.partition(" of ")
    return f"{head}{of}{calls.get(joint, joint)}"


_CARRIER = re.compile(r"(.*)__(?:d\d+|[xyz]|ball|rx|ry|rz)_*$")


def _of_free(element: Element, free: set[str]) -> bool:
    """True for a free joint and for what stands for one."""
    names = {element.name, element.holder}
    names |= {match[1] for name in names if (match := _CARRIER.match(name))}
    return bool(names & free)


def _same(a: Any, b: Any, name: str) -> bool:
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        a, b = a.astype(np.float64), b.astype(np.float64)
        if a.shape != b.shape:
            return not a.any() and not b.any()
        finite = np.isfinite(a) & np.isfinite(b)
        if not np.array_equal(a[~finite], b[~finite]):
            return False
        scale = float(np.abs(a[finite]).max(initial=0.0))
        slack = MESH_M + 1e-5 * scale if name == "box" else ABSOLUTE + RELATIVE * scale
        if name in {"inertia", "mass"}:
            slack = 1e-12 + RELATIVE * scale
        return bool((np.abs(a[finite] - b[finite]) <= slack).all())
    return bool(a == b)


def _text(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return " ".join(f"{x:.6g}" for x in value.ravel()[:16])
    return str(value)


# ---------------------------------------------------------------------- matching with rows

WORDS: Mapping[str, str] = {
    # by kind and field: a word of these must stand in the row
    "geom.exists": "geom|shape|plane|hfield|height|sdf|mesh",
    "shape.exists": r"<capsule>|the \w+ geom|without shapes|\ba mesh\b|left out",
    "shape.*": "primitive|hull|flat|capsule|ellipsoid|<collision_checking>",
    "link.frame": "original frame",
    "link.frame in motion": "original frame",
    **dict.fromkeys(("link.mass", "ground.mass", "fixed joint.mass", "body.mass"), r"\bmass\b|1e-4 kg"),
    **dict.fromkeys(("link.com", "ground.com", "fixed joint.com", "body.com"), r"\bmass\b|1e-4 kg|centre"),
    **dict.fromkeys(("link.inertia", "ground.inertia", "fixed joint.inertia", "body.inertia"), r"\binertia\b|\bmass\b|1e-4 kg"),
    "fixed joint.exists": "joint is left out|carrier",
    "fixed joint.name": "the name as given",
    "link.exists": "carrier|bodies|chain of joints|nothing between them",
    "link.name": "the name as given",
    "joint.name": "the name as given",
    "settings.*": "option|visual",
    "cam.it": "camera",
    "cam.exists": "camera",
    "mjcf body.*": "gravcomp|mocap",
    "body.exists": "body|bodies|carrier",
    "body.turn": "frame",
    "body.pos": "frame",
    "joint.exists": "joints?",
    "joint.nv": "joints?",
    "joint.type": "joints?|endless",
    "joint.limit": "limits?|range|lower|upper|endless|cone|twist",
    "joint.effort": "effort|actuatorfrcrange|force",
    "joint.velocity": "velocity",
    "joint.friction": "friction",
    "joint.frictionloss": "friction|frictionloss",
    "joint.qpos0": "rest|qpos0|ref",
    "joint.cone": "cone|limit",
    "mjcf joint.actgravcomp": "actuatorgravcomp",
    "mjcf joint.solref": "solreflimit",
    "mjcf joint.solimp": "solimplimit",
    "exclude.exists": "excluded?",
    "mimic.exists": "mimic|follow|tie|equality",
    "mimic.*": "mimic|follow|tie|equality",
    "equality.*": "equality|loop|weld|connect",
    "key.*": "key",
    "model.gravity": "gravity",
}
"""Whole words that speak of a field; a field that is not here must be named itself."""

ASIDES = re.compile(
    r"(?<=no )limit on a joint's (?=velocity)"
    r"|: MuJoCo reads an empty range as unlimited|(?<=force may )drive the joint"
    r"|that a joint connects: MuJoCo lets a body touch what stands still"
    r"|, with which engines cannot collide|on the joint(?=;)|: the joint does not pass through its origin"
    r"|: zero is outside of its limits|readers that ignore <mimic>.*|in readers that ignore <mimic>.*"
    r"|the joint is (?=endless in that direction)|at rest or in motion.*|(?<=no friction )between surfaces.*"
    r"|its carriers take a small share of the part's (?=mass)"
)
"""What rows of losses say by the way, about other fields than the one that they are about."""


@dataclass(frozen=True)
class Row:
    """A row of a report of losses."""

    where: str
    text: str


def rows_of(report: Mapping[str, Any]) -> list[Row]:
    """Return the rows of a report `articad.losses/1`."""
    return [Row(row["where"], f"{row['kept']}; {row['lost']}") for row in report["rows"]]


def names_it(difference: Difference, row: Row) -> bool:
    """True when a row speaks of a difference: of its field, and of its element or of what that belongs to."""
    kind, name = difference.kind, difference.field
    if kind == "key" and name == "exists" and re.fullmatch(r"key_\d+", difference.element) and re.search(r"<size>.*\bnkey\b", row.text):
        return True  # MuJoCo makes keys without an element where the file states room for them
    words = (
        WORDS.get(f"{kind}.{name}") or WORDS.get(f"{kind}.*") or re.escape(kind if name in {"exists", "it"} else name.rpartition(".")[2])
    )
    if kind == "geom":
        words += r"|the \w+ geom"  # that is left out as a whole
    if not re.search(rf"(?<![A-Za-z])(?:{words})(?![A-Za-z])", ASIDES.sub("", row.text), re.IGNORECASE):
        return False
    if kind == "settings":
        return name.rpartition(".")[2].strip("_") in row.text or f"<{name.partition('.')[0]}>" in row.text
    if kind == "model":
        return True
    where = row.where.partition(".")[2]
    names = {difference.element, difference.holder, *difference.members, *difference.element.split("+")} - {""}
    names |= {match[1] for name in names if (match := _CARRIER.match(name))}
    return any(
        where == one or where.startswith((f"{one}.", f"{one}+")) or where.endswith(f"+{one}") or _token(one, row.text) for one in names
    )


def _token(name: str, text: str) -> bool:
    return re.search(rf"(?<![\w/.-]){re.escape(name)}(?![\w/-])", text) is not None


@dataclass
class Comparison:
    """What a conversion changed, and what its report says.

    Attributes:
        silent: Differences that no row names.
        named: Those that a row names.
        free: Those that come with free joints, and that no row names.
        idle: Rows that no difference stands behind.
    """

    silent: list[Difference]
    named: list[Difference]
    free: list[Difference]
    idle: list[Row]


def compare(found: Iterable[Difference], rows: list[Row]) -> Comparison:
    """Hold differences against the rows of a report."""
    result = Comparison([], [], [], [])
    used: set[Row] = set()
    for difference in found:
        matching = [row for row in rows if names_it(difference, row)]
        used.update(matching)
        (result.named if matching else result.free if difference.free else result.silent).append(difference)
    result.idle = [row for row in rows if row not in used]
    return result


def facts_of(path: Path, target: str, packages: Path, *, both: bool) -> Facts:
    """Return what the engine of a file's format reads; all of it where both files are MJCF."""
    if target == "mjcf":
        return mujoco_facts(Compiled(path)) if both else common_of_mujoco(path)
    return common_of_pinocchio(path, packages, both=both)


@contextmanager
def _heard() -> Iterator[list[str]]:
    """Yield a list that holds, at the end, what libraries wrote to the standard error: parsers of URDF give their reasons there."""
    lines: list[str] = []
    sys.stderr.flush()
    kept = os.dup(2)
    with tempfile.TemporaryFile() as file:
        os.dup2(file.fileno(), 2)
        try:
            yield lines
        finally:
            os.dup2(kept, 2)
            os.close(kept)
            file.seek(0)
            lines += file.read().decode(errors="replace").splitlines()


def examine(source: Path, target: str, folder: Path, packages: Path) -> dict[str, Any]:
    """Convert a file, compile both, and say what is silent, named, idle or refused."""
    from articad.errors import ArticadError
    from articad.formats import convert

    origin = "urdf" if source.suffix == ".urdf" else "mjcf"

    def reason(error: Exception, heard: Iterable[str] = ()) -> str:
        first = next((line for line in heard if line.startswith("Error:")), str(error) or type(error).__name__)
        words = re.sub(r"^(?:(?:XML )?Error: )+", "", " ".join(first.split())).replace(f"{source}: ", "")
        return words.replace(f"{packages}/", "").replace(str(packages), "its package")[:200]

    heard: list[str] = []
    try:
        with _heard() as heard:
            before = facts_of(source, origin, packages, both=origin == target)
    except Exception as error:  # noqa: BLE001 - engines raise what they like
        return {"original refused": reason(error, heard)}
    try:
        _, bundle = convert(source, folder / f"copy.{ {'urdf': 'urdf', 'mjcf': 'xml'}[target] }", root=packages)
    except ArticadError as error:
        return {"not converted": reason(error)}
    bundle.write(folder)
    try:
        with _heard() as heard:
            after = facts_of(folder / bundle.main, target, folder, both=origin == target)
    except Exception as error:  # noqa: BLE001
        return {"copy refused": reason(error, heard)}
    rows = rows_of(bundle.to_json())
    renames = {
        row.where.partition(".")[2]: match[1] for row in rows if (match := re.search(r"underscores \((.*)\); the name as given", row.text))
    }
    result = compare(differences(before, after, renames), rows)
    return {
        "silent": [str(one) for one in result.silent],
        "named": [str(one) for one in result.named],
        "free": [str(one) for one in result.free],
        "idle": [f"{row.where}: {row.text}" for row in result.idle],
        "rows": len(rows),
    }


COMPARED = {
    "urdf→urdf": "in Pinocchio: names of links and joints, the type of each joint, its limits, effort, velocity, damping, friction, armature and "
    "`<mimic>`; the frame of each link at zero and in motion; mass, centre of mass and inertia of what moves, of what stands still, and of each "
    "link that a fixed joint holds; kind, size and place of each shape, and the box around each mesh",
    "urdf→mjcf": "the original in Pinocchio, the conversion in MuJoCo: all of that, fixed links with what they are fixed to; and equalities, "
    "actuators, sensors, excluded pairs and keys that the conversion adds",
    "mjcf→urdf": "the original in MuJoCo, the conversion in Pinocchio: all of that; and everything that only MJCF can say, where it is not "
    "MuJoCo's default: contact parameters of geoms, options, visual settings, springs, reference values, ranges of forces, gravity compensation, "
    "mocap bodies, sites, cameras, lights, equalities, tendons, actuators, sensors, pairs, keys and custom data",
    "mjcf→mjcf": "in MuJoCo: every field of the compiled model (`mjModel`) of every body, joint, geom, site, camera, light, equality, tendon, "
    "actuator, sensor, pair and key, custom data and all options; of meshes the box around them; no textures and materials but their colours",
}
"""What is compared, by direction."""

ENGINES = {"urdf": "Pinocchio", "mjcf": "MuJoCo"}


def page(results: Iterable[Mapping[str, Any]], files: Mapping[tuple[str, str], int]) -> str:
    """Return the page of the documentation that says what conversions change.

    Args:
        results: Of `examine`, each with `package`, `path` (below the package), `origin` and `target`.
        files: How many files there are, by package and format; each is converted into both formats.
    """
    found = sorted(results, key=lambda result: (result["package"], result["origin"], result["target"], result["path"]))
    return PAGE.format(
        compared="".join(f"- **{direction}**, {text}.\n" for direction, text in COMPARED.items()),
        table=_counts(found, files),
        refused=_refused(found),
        idle=_idle(found),
        relative=RELATIVE,
        silent=sum(_silent(result) for result in found),
        models=sum(files.values()),
        conversions=len(found),
        all=2 * sum(files.values()),
    )


def _silent(result: Mapping[str, Any]) -> int:
    return len(result.get("silent", ())) + len(result.get("free", ()))


def _counts(results: list[Mapping[str, Any]], files: Mapping[tuple[str, str], int]) -> str:
    rows: dict[tuple[str, str, str], list[Mapping[str, Any]]] = {}
    for result in results:
        for package in (result["package"], "**all**"):
            rows.setdefault((package, result["origin"], result["target"]), []).append(result)
    lines = []
    for (package, origin, target), found in sorted(rows.items(), key=lambda item: (item[0][0].startswith("*"), item[0])):
        compared = [result for result in found if "silent" in result]
        refused = [sum(key in result for result in found) for key in ("original refused", "not converted", "copy refused")]
        counts = [
            sum(result["rows"] for result in compared),
            *(sum(len(result[kind]) for result in compared) for kind in ("named", "idle")),
        ]
        models = sum(count for (name, format_), count in files.items() if package in {name, "**all**"} and format_ == origin)
        numbers = [models, models - len(found), len(compared), *refused, *counts, sum(map(_silent, compared))]
        lines.append(f"| {package} | {origin}→{target} | {' | '.join(f'{number:,}' for number in numbers)} |\n")
    return "".join(lines)


def _refused(results: list[Mapping[str, Any]]) -> str:
    rows: dict[tuple[str, str, str, str], None] = {}
    for result in results:
        who = {
            "original refused": ENGINES[result["origin"]],
            "not converted": "articad",
            "copy refused": f"{ENGINES[result['target']]}, the copy",
        }
        for key in who.keys() & result.keys():
            rows[
                result["package"],
                result["path"],
                who[key],
                str(result[key]).partition(" Element ")[0].replace("|", "\\|").replace("`", "'"),
            ] = None
    return "".join(f"| {package} | `{path}` | {who} | `{reason}` |\n" for package, path, who, reason in rows)


LISTED = 30  # subjects of rows without a difference


def _idle(results: list[Mapping[str, Any]]) -> str:
    """Return the rows without a difference by what they speak of, the most frequent first."""
    counts: dict[str, dict[str, int]] = {}
    for result in results:
        for row in result.get("idle", ()):
            by_direction = counts.setdefault(_subject(row), {})
            direction = f"{result['origin']}→{result['target']}"
            by_direction[direction] = by_direction.get(direction, 0) + 1
    ordered = sorted(counts.items(), key=lambda item: (-sum(item[1].values()), item[0]))
    shown = ordered[:LISTED] + ([("others", _added(rest for _, rest in ordered[LISTED:]))] if ordered[LISTED:] else [])
    return "".join(f"| {subject} | {' | '.join(f'{by.get(direction, 0):,}' for direction in COMPARED)} |\n" for subject, by in shown)


def _added(counts: Iterable[Mapping[str, int]]) -> dict[str, int]:
    total: dict[str, int] = {}
    for one in counts:
        for direction, count in one.items():
            total[direction] = total.get(direction, 0) + count
    return total


_SUBJECTS = (
    (r"; group \S+(?:, transparency alpha \S+)? of (?:a )?geom", "group or transparency of a geom"),
    (r" of (?:a )?geom", "contact parameters of a geom that is only seen"),
    (r"transparency|alpha", "transparency"),
    (r"colours of mesh", "colours that mesh files state"),
    (r"[Tt]exture|tex(?:repeat|uniform)", "textures"),
    (r"(?:reflectance|shininess|specular|emission|metallic|roughness) of <material>|<specular>", "materials beyond their colour"),
    (r"; Mesh .* is left out", "a mesh that is not in the package"),
    (r"physically possible", "an inertia that no body can have"),
    (r"the name as given", "names of fixed joints, models and links with other characters"),
    (r"names of <(?:visual|collision)>", "names of shapes"),
    (r"; <option>", "`<option>` with MuJoCo's defaults"),
    (r"; (?:damping|frictionloss|armature)\b", "damping, friction or armature of a free joint"),
    (r"<mimic>; readers", "`<mimic>`, which some readers ignore"),
)
"""Words of rows, and what a row with them speaks of; the first that is there counts."""


def _subject(row: str) -> str:
    """Return what a row speaks of, in a few words."""
    text = row[row.find(": ") :]
    for pattern, subject in _SUBJECTS:
        if re.search(pattern, text):
            return subject
    if match := re.search(r"; (?:<([\w-]+)|.*(?:of|in) <([\w-]+)>)", text):
        return f"`<{match[1] or match[2]}>`"
    return re.sub(r"\(.*?\)|'[^']*'", "", text.partition("; ")[2]).strip()[:60] or "others"


PAGE = """# What conversions change

This page states what articad's conversions between URDF and MJCF keep of robots that other people made: {models:,} models, the URDF and MJCF
files of seven packages from PyPI. It has {conversions:,} of {all:,} conversions. The comparing program
sees only the files that articad wrote and the reports of their losses, nothing else of articad. The engines Pinocchio (for URDF) and MuJoCo (for MJCF) compile the original and the conversion, and the program
compares the compiled models field by field. Two numbers are equal if they differ by less than {relative:g} of the largest number of their
field.

- A *named difference* is reported by a row of the conversion's losses, for this field of this element. Every conversion prints these rows.
- A *silent difference* is any other. There are {silent:,}.
- A *row without a difference* is a loss that no engine sees, such as an element of another program, a picture or the name of a shape.

## The table

*Models* are files; those *not run* had not been converted when the page was written. Refused models are not compiled by the engine of the
original, not converted by articad, or not compiled after the conversion.

| package | conversion | models | not run | compared | refused by the engine | refused by articad | copy refused | rows of losses | named differences | rows without a difference | silent differences |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
{table}
Of the 1,000 random objects that PyBullet ships, ten are converted.

## What is compared

{compared}
Shapes are compared if the engine can read all meshes of the file; Pinocchio reads none if one is missing.

## Refused models, and why

| package | file | by | why |
| --- | --- | --- | --- |
{refused}
Most of these MJCF files are fragments that other files include.

## Rows without a difference

| subject of the rows | urdf→urdf | urdf→mjcf | mjcf→urdf | mjcf→mjcf |
| --- | ---: | ---: | ---: | ---: |
{idle}
## How to repeat it

```sh
scripts/corpus DIR                            # compares, and checks that the result is this page
ARTICAD_CORPUS_WRITE=1 scripts/corpus DIR     # writes the page
```

The script fetches the packages into DIR (2 GB) without installing them and runs `pytest -m corpus tests/importers/test_corpus.py`, which takes
about an hour of one processor. Each result is appended to a file in `DIR.results` as soon as it exists, so an interrupted run can continue;
results of other versions of the code are not used. For one file, `python -m tests.differences FILE TARGET FOLDER` prints what differs.
"""


def main(arguments: list[str]) -> int:
    """Examine one file and print the result as JSON."""
    source, target, folder, *packages = arguments
    result = examine(Path(source), target, Path(folder), Path(packages[0]) if packages else Path(source).parent)
    print(json.dumps(result))  # noqa: T201
    return bool(result.get("silent"))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
