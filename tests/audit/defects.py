"""One model for each defect, made of boxes of our own, and the sound model that each differs from by that defect alone."""

from __future__ import annotations

import copy
import math
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from lxml import etree

from articad.geometry.mesh import TriMesh, merged
from articad.geometry.mesh_files import write_glb, write_stl
from articad.geometry.shapes import box

DENSITY = 700.0  # kg/m³
Mutation = Callable[[Any, Path], Any]


@dataclass(frozen=True)
class Defect:
    """What a fixture has wrong, and what must be said of it."""

    name: str
    spoil: Mutation
    code: str
    value: float | None = None
    cause: str | None = None
    also: frozenset[str] = field(default_factory=frozenset)  # what necessarily follows from the same defect
    base: Callable[[Path], Any] | None = None  # the sound twin, where it is not the stand
    relative: float = 1e-6


def moved(mesh: TriMesh, x: float, y: float, z: float) -> TriMesh:
    return TriMesh(mesh.vertices + np.array([x, y, z]), mesh.triangles)


def link(name: str, mesh: TriMesh, folder: Path, *, file: str | None = None) -> Any:
    """A link of one mesh in mm, with the mass and inertia of a box."""
    file = file or f"{name}.stl"
    (folder / file).write_bytes(write_stl(mesh))
    low, high = mesh.bounds
    a, b, c = (high - low) / 1000
    m = DENSITY * a * b * c
    centre = " ".join(f"{x:.9g}" for x in (low + high) / 2000)
    moments = {"ixx": m * (b * b + c * c) / 12, "iyy": m * (a * a + c * c) / 12, "izz": m * (a * a + b * b) / 12}
    shape = f'<geometry><mesh filename="{file}" scale="0.001 0.001 0.001"/></geometry>'
    return etree.fromstring(
        f'<link name="{name}"><inertial><origin xyz="{centre}"/><mass value="{m:.12g}"/>'
        f'<inertia ixx="{moments["ixx"]:.9g}" iyy="{moments["iyy"]:.9g}" izz="{moments["izz"]:.9g}" ixy="0" ixz="0" iyz="0"/></inertial>'
        f"<visual>{shape}</visual><collision>{shape}</collision></link>"
    )


def joint(
    name: str, kind: str, parent: str, child: str, xyz: str, *, axis: str = "0 0 1", lower: float = 0, upper: float = 0, effort: float = 7.5
) -> Any:
    limit = "" if kind == "fixed" else f'<limit effort="{effort}" velocity="1.7"'
    limit += f' lower="{lower}" upper="{upper}"/>' if kind in {"revolute", "prismatic"} else "/>" if limit else ""
    axis = "" if kind == "fixed" else f'<axis xyz="{axis}"/>'
    return etree.fromstring(
        f'<joint name="{name}" type="{kind}"><origin xyz="{xyz}"/><parent link="{parent}"/><child link="{child}"/>{axis}{limit}</joint>'
    )


def stand(folder: Path) -> Any:
    """A plate with an arm that turns ±60° above it and a block that slides; nothing is wrong with it."""
    root = etree.Element("robot", name="stand")
    root.append(link("plate", moved(box(200, 200, 20), 0, 0, 10), folder))
    root.append(link("arm", moved(box(80, 20, 10), 30, 0, 5), folder))
    root.append(link("block", moved(box(30, 30, 10), 0, 0, 5), folder))
    root.append(joint("turn", "revolute", "plate", "arm", "-0.05 0 0.0205", lower=-math.pi / 3, upper=math.pi / 3))
    root.append(joint("slide", "prismatic", "plate", "block", "0.06 -0.06 0.0205", axis="1 0 0", lower=-0.02, upper=0.02, effort=3.2))
    return root


def three_turns(folder: Path) -> Any:
    """The stand with three arms, far from each other, of different efforts."""
    root = stand(folder)
    for index, y in enumerate((-0.07, 0.07)):
        root.append(link(f"flag_{index}", moved(box(20, 6, 8), 0, 0, 4), folder))
        root.append(
            joint(f"wave_{index}", "revolute", "plate", f"flag_{index}", f"-0.08 {y} 0.0205", lower=-1, upper=1, effort=2.5 + index)
        )
    for index, limit in enumerate(root.iterfind("joint/limit")):
        limit.set("velocity", str(1.3 + 0.2 * index))
    return root


def with_post(folder: Path, *, y: float = 80.0) -> Any:
    """The stand with a post fixed on its plate, out of the arm's way."""
    root = stand(folder)
    root.append(link("post", moved(box(20, 20, 30), 0, 0, 15), folder))
    root.append(joint("mount", "fixed", "plate", "post", f"0.01 {y / 1000} 0.02"))
    return root


def two_arms(folder: Path, *, second: float = 0.075) -> Any:
    """Two arms side by side; with `second` small they meet only when both turn towards each other."""
    root = stand(folder)
    for element in [*root.iterfind("link"), *root.iterfind("joint")]:
        if element.get("name") in {"block", "slide"}:
            root.remove(element)
    for name in ("first", "second"):
        root.append(link(name, moved(box(60, 8, 10), 25, 0, 5), folder))
    root.remove(root.find("link[@name='arm']"))
    root.remove(root.find("joint[@name='turn']"))
    root.append(joint("turn_first", "revolute", "plate", "first", "-0.03 -0.02 0.0205", lower=-0.01, upper=0.4))
    root.append(joint("turn_second", "revolute", "plate", "second", f"-0.03 {second - 0.02} 0.0205", lower=-0.4, upper=0.01, effort=4.0))
    return root


def find(root: Any, path: str) -> Any:
    element = root.find(path)
    assert element is not None, path
    return element


def setting(path: str, **attributes: str) -> Mutation:
    def spoil(root: Any, _folder: Path) -> None:
        for key, value in attributes.items():
            find(root, path).set(key, value)

    return spoil


def removing(*paths: str) -> Mutation:
    def spoil(root: Any, _folder: Path) -> None:
        for path in paths:
            element = find(root, path)
            element.getparent().remove(element)

    return spoil


def renaming(old: str, new: str) -> Mutation:
    def spoil(root: Any, _folder: Path) -> None:
        for element in root.iter():
            for key in ("name", "link", "joint"):
                if element.get(key) == old:
                    element.set(key, new)

    return spoil


def adding(*elements: Any) -> Mutation:
    def spoil(root: Any, _folder: Path) -> None:
        for element in elements:
            root.append(copy.deepcopy(element))

    return spoil


def mesh_of(name: str, mesh: TriMesh) -> Mutation:
    def spoil(_root: Any, folder: Path) -> None:
        (folder / f"{name}.stl").write_bytes(write_stl(mesh))

    return spoil


def limits(name: str, **bounds: float) -> Mutation:
    return setting(f"joint[@name='{name}']/limit", **{key: repr(value) for key, value in bounds.items()})


def open_mesh() -> TriMesh:
    whole = moved(box(30, 30, 10), 0, 0, 5)
    return TriMesh(whole.vertices, whole.triangles[1:])


def two_pieces(gap: float) -> TriMesh:
    return merged([moved(box(20, 20, 10), 0, 0, 5), moved(box(10, 10, 10), 15 + gap, 0, 5)])


def truncated(_root: Any, folder: Path) -> None:
    content = (folder / "arm.stl").read_bytes()
    (folder / "arm.stl").write_bytes(content[: len(content) // 2])


def as_glb(root: Any, folder: Path, *, scale: float, mesh_scale: float) -> None:
    """Draw the arm from a GLB in another unit."""
    (folder / "arm.glb").write_bytes(write_glb(moved(box(80, 20, 10), 30, 0, 5).scaled(mesh_scale)))
    element = find(root, "link[@name='arm']/visual/geometry/mesh")
    element.set("filename", "arm.glb")
    element.set("scale", " ".join([repr(scale)] * 3))


def glb_in_metres(folder: Path) -> Any:
    root = stand(folder)
    as_glb(root, folder, scale=1.0, mesh_scale=0.001)
    return root


def carried(root: Any, _folder: Path) -> None:
    """Let the arm slide before it turns, over a link with neither shape nor mass."""
    find(root, "joint[@name='turn']/parent").set("link", "carrier")
    find(root, "joint[@name='turn']/origin").set("xyz", "0 0 0")
    root.append(etree.fromstring('<link name="carrier"/>'))
    root.append(joint("lift", "prismatic", "plate", "carrier", "-0.05 0 0.0205", upper=0.01))


def carried_with_mass(root: Any, folder: Path) -> None:
    carried(root, folder)
    find(root, "link[@name='carrier']").append(
        etree.fromstring('<inertial><mass value="0.0005"/><inertia ixx="1e-7" iyy="1e-7" izz="1e-7" ixy="0" ixz="0" iyz="0"/></inertial>')
    )


def held_together(folder: Path) -> Any:
    """The stand whose block is two bodies that a bar, fixed to it, joins."""
    root = stand(folder)
    mesh_of("block", two_pieces(4.0))(root, folder)
    root.append(link("bar", moved(box(32, 8, 6), 5, 0, 13), folder))
    root.append(joint("rivet", "fixed", "block", "bar", "0 0 0"))
    return root


def lone_link(root: Any, folder: Path) -> None:
    root.append(link("lone", box(10, 10, 10), folder))


def ring(root: Any, folder: Path) -> None:
    for name in ("ring_a", "ring_b"):
        root.append(link(name, box(10, 10, 10), folder))
    root.append(joint("to_a", "fixed", "ring_b", "ring_a", "0 0 0.01"))
    root.append(joint("to_b", "fixed", "ring_a", "ring_b", "0 0 0.01"))


def second_parent(root: Any, folder: Path) -> None:
    root.append(joint("again", "fixed", "block", "arm", "0 0 0"))


def twice(root: Any, folder: Path) -> None:
    root.append(link("arm", box(10, 10, 10), folder, file="other.stl"))


def outside(root: Any, folder: Path) -> None:
    (folder.parent / "elsewhere.stl").write_bytes(write_stl(moved(box(80, 20, 10), 30, 0, 5)))
    for element in root.iter("mesh"):
        if element.get("filename") == "arm.stl":
            element.set("filename", "../elsewhere.stl")


def same_efforts(root: Any, _folder: Path) -> None:
    for limit in root.iterfind("joint[@type='revolute']/limit"):
        limit.set("effort", "1.0")


def post_in_the_way(root: Any, _folder: Path) -> None:
    find(root, "joint[@name='mount']/origin").set("xyz", "0.01 0.05 0.02")


def post_in_the_block(root: Any, _folder: Path) -> None:
    find(root, "joint[@name='mount']/origin").set("xyz", "0.06 -0.043 0.02")


def nearer(root: Any, _folder: Path) -> None:
    find(root, "joint[@name='turn_second']/origin").set("xyz", "-0.03 0.018 0.0205")


TIP = math.hypot(70, 10)  # radius of the arm's corner
FIRST_CONTACT_DEG = math.degrees(math.asin(40 / TIP) - math.atan2(10, 70))  # … where it meets the post's side at y = 40
INERTIA_OF_ONE = {axis: ("1" if axis in {"ixx", "iyy", "izz"} else "0") for axis in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")}
ARM_KG = DENSITY * 0.08 * 0.02 * 0.01

DEFECTS = [
    Defect("number", setting("joint[@name='turn']/origin", xyz="-0.05 zero 0.0205"), "E_AUDIT_NUMBER", also=frozenset({"I_AUDIT_BASE"})),
    Defect("no_size", lambda root, _: find(root, "link[@name='arm']").append(etree.fromstring('<collision><geometry><sphere radius="0"/></geometry></collision>')), "E_AUDIT_NUMBER", 1),
    Defect("name_twice", twice, "E_AUDIT_NAME_TWICE", 2),
    Defect("no_name", adding(etree.fromstring('<joint type="fixed"><parent link="plate"/><child link="tag"/></joint>'), etree.fromstring('<link name="tag"/>')), "E_AUDIT_NO_NAME", 1),
    Defect("link_unknown", setting("joint[@name='turn']/parent", link="plat"), "E_AUDIT_LINK_UNKNOWN"),
    Defect("joint_type", setting("joint[@name='turn']", type="hinge"), "E_AUDIT_JOINT_TYPE"),
    Defect("two_parents", second_parent, "E_AUDIT_TWO_PARENTS", 2),
    Defect("roots", lone_link, "E_AUDIT_ROOTS", 2),
    Defect("circle", ring, "E_AUDIT_CIRCLE", 2),
    Defect("mimic", lambda root, _: find(root, "joint[@name='slide']").append(etree.fromstring('<mimic joint="trun"/>')), "E_AUDIT_MIMIC"),
    Defect("awkward_name", renaming("arm", "left arm, long"), "W_AUDIT_NAME", 1),
    Defect("long_name", lambda root, _: root.set("name", "a stand " * 213), "W_AUDIT_LONG_NAME", 1704),
    Defect("no_inertia", removing("link[@name='arm']/inertial"), "E_AUDIT_NO_INERTIA", 1, "no_inertia"),
    Defect("massless_carrier", carried, "E_AUDIT_MASSLESS", 1, "carrier", frozenset({"I_AUDIT_CARRIERS"})),
    Defect("carriers", carried_with_mass, "I_AUDIT_CARRIERS", None, "carrier"),
    Defect("zero_mass", setting("link[@name='arm']/inertial/mass", value="0"), "E_AUDIT_MASS", 0.0),
    Defect("negative_mass", setting("link[@name='arm']/inertial/mass", value="-0.2"), "E_AUDIT_MASS", -0.2),
    Defect("negative_moment", setting("link[@name='arm']/inertial/inertia", ixx="-1e-5"), "E_AUDIT_INERTIA", -1e-5),
    Defect("zero_inertia", setting("link[@name='arm']/inertial/inertia", ixx="0", iyy="0", izz="0"), "E_AUDIT_INERTIA", 0.0, "placeholder"),
    Defect("triangle", setting("link[@name='arm']/inertial/inertia", ixx="1e-6", iyy="2e-6", izz="9e-6"), "E_AUDIT_INERTIA_TRIANGLE", 3.0),
    Defect("placeholder_inertia", setting("link[@name='arm']/inertial/inertia", **INERTIA_OF_ONE), "W_AUDIT_INERTIA_SHAPE", 1.0, "placeholder"),
    Defect("centre_outside", setting("link[@name='arm']/inertial/origin", xyz="0.03 0 0.105"), "W_AUDIT_COM", 95.0),
    Defect("density", setting("link[@name='arm']/inertial/mass", value=repr(1000 * ARM_KG)), "W_AUDIT_DENSITY", 700_000.0, None),
    Defect("limits_reversed", limits("turn", lower=1.0, upper=-1.0), "E_AUDIT_LIMITS_ORDER", math.degrees(1.0)),
    Defect("no_limits", removing("joint[@name='turn']/limit"), "W_AUDIT_NO_LIMITS", also=frozenset({"W_AUDIT_NO_EFFORT", "W_AUDIT_PLACEHOLDER"})),
    Defect("locked", limits("turn", lower=0.0, upper=0.0), "W_AUDIT_LOCKED", 0.0),
    Defect("degrees", limits("turn", lower=-60.0, upper=60.0), "W_AUDIT_DEGREES", 120.0, "units"),
    Defect("endless", limits("turn", lower=-2 * math.pi, upper=2 * math.pi), "W_AUDIT_ENDLESS", 720.0),
    Defect("zero_outside", limits("turn", lower=0.5, upper=1.0), "I_AUDIT_ZERO_OUTSIDE", math.degrees(0.5)),
    Defect("no_effort", limits("turn", effort=0.0), "W_AUDIT_NO_EFFORT", 1),
    Defect("placeholder_effort", same_efforts, "W_AUDIT_PLACEHOLDER", 1.0, "placeholder", base=three_turns),
    Defect("mesh_absent", lambda _, folder: (folder / "arm.stl").unlink(), "E_AUDIT_MESH_ABSENT", 2),
    Defect("mesh_unreadable", truncated, "E_AUDIT_MESH_UNREADABLE", 2),
    Defect("mesh_outside", outside, "W_AUDIT_MESH_OUTSIDE", 2),
    Defect("mesh_open", mesh_of("block", open_mesh()), "W_AUDIT_MESH_OPEN", 3),
    Defect("mesh_flat", mesh_of("block", TriMesh(moved(box(30, 30, 1e-7), 0, 0, 0).vertices, box(30, 30, 1).triangles)), "W_AUDIT_MESH_FLAT", 9e-5, also=frozenset({"W_AUDIT_DENSITY", "W_AUDIT_COM", "W_AUDIT_MESH_OPEN"}), relative=10),
    Defect("mesh_inside_out", mesh_of("block", moved(box(30, 30, 10), 0, 0, 5).flipped()), "W_AUDIT_MESH_INSIDE_OUT", -9000.0),
    Defect("pieces", mesh_of("block", two_pieces(4.0)), "W_AUDIT_PIECES", 4.0, "multi_solid"),
    Defect("unfused", mesh_of("block", two_pieces(-1.0)), "I_AUDIT_UNFUSED", 2, "multi_solid"),
    Defect("no_collision", removing("link[@name='arm']/collision"), "W_AUDIT_NO_COLLISION", 1, "no_collision"),
    Defect("units", lambda root, _: [element.attrib.pop("scale") for element in root.iter("mesh") if element.get("filename") == "block.stl"], "W_AUDIT_UNITS", None, "units", frozenset({"W_AUDIT_DENSITY", "E_OVERLAP", "E_STATIC_OVERLAP", "W_STATIC_OVERLAP", "E_MOTION_COLLISION", "W_AUDIT_COM", "W_AUDIT_PAIR_COLLISION"})),
    Defect("visual_units", setting("link[@name='arm']/visual/geometry/mesh", scale="1 1 1"), "W_AUDIT_UNITS", 1000.0, "units", frozenset({"W_AUDIT_DENSITY"}), relative=1e-3),
    Defect("scale", lambda root, _: [element.set("scale", "1 1 1") for element in root.iter("mesh")], "W_AUDIT_SCALE", None, "units", frozenset({"W_AUDIT_DENSITY", "E_OVERLAP", "E_STATIC_OVERLAP", "W_STATIC_OVERLAP", "E_MOTION_COLLISION", "W_AUDIT_PAIR_COLLISION"})),
    Defect("base_below", lambda root, _: [find(root, f"link[@name='plate']/{role}").insert(0, etree.fromstring('<origin xyz="0 0 -0.0325"/>')) for role in ("visual", "collision")], "I_AUDIT_BASE", 32.5, also=frozenset({"E_FLOATING", "W_AUDIT_COM"})),
    Defect("gltf", lambda root, folder: as_glb(root, folder, scale=0.001, mesh_scale=1.0), "W_AUDIT_GLTF", 1, "units", base=glb_in_metres),
    Defect("overlap", post_in_the_block, "E_OVERLAP", None, None, frozenset({"E_MOTION_COLLISION"}), base=with_post),
    Defect("neighbours_overlap", setting("joint[@name='slide']/origin", xyz="0.06 -0.06 0.017"), "E_STATIC_OVERLAP", None, None, frozenset({"W_STATIC_OVERLAP"})),
    Defect("collision_in_motion", post_in_the_way, "E_MOTION_COLLISION", FIRST_CONTACT_DEG, base=with_post, relative=1e-4),
    Defect("collision_of_two", nearer, "W_AUDIT_PAIR_COLLISION", base=two_arms),
    Defect("floating", setting("joint[@name='turn']/origin", xyz="-0.05 0 0.05"), "E_FLOATING", 30.0, "floating"),
    Defect("not_touching", setting("joint[@name='mount']/origin", xyz="0.01 0.08 0.023"), "E_NOT_TOUCHING", 3.0, "not_touching", base=with_post),
]  # fmt: skip


def write(root: Any, folder: Path) -> Path:
    path = folder / "model.urdf"
    path.write_bytes(etree.tostring(root, pretty_print=True))
    return path
