"""Hints of audits, followed literally: the file is changed as the hint says and nothing else; its finding is gone, and no error has come.

A reader of a hint knows the file, the finding and the words of its hint. Where a hint offers alternatives, each has a rule. `--fix` is
followed by calling it, with `--density` where the hint names it.
"""

from __future__ import annotations

import copy
import math
import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import manifold3d as m3
import numpy as np
import pytest
import trimesh
from lxml import etree

from articad.auditing import contact
from articad.auditing.examine import AuditOptions, audit_file
from articad.auditing.mend import mend
from articad.findings import Finding, Findings
from articad.formats import convert
from articad.geometry.mesh import TriMesh, merged
from articad.geometry.mesh_files import read_mesh, write_stl
from articad.geometry.shapes import box
from tests.audit import defects
from tests.audit.defects import DEFECTS, DENSITY, Defect, find, joint, link, moved
from tests.audit.test_formats import TABLE, mjcf, step_file
from tests.audit.test_hostile import piled
from tests.audit.test_jams import foreign
from tests.obedience import assert_heals

QUICK = AuditOptions(engines=False, budget=5.0)
Match = re.Match[str]
Change = Callable[[Any, Path, Finding, Match], None]


def element_of(root: Any, finding: Finding) -> Any:
    """Return the element at the line that the finding names; the file was written as it is."""
    line = re.search(r"\(line (\d+)\)", finding.where)
    assert line, finding.where
    text = etree.fromstring(etree.tostring(root, pretty_print=True))
    place = next(index for index, one in enumerate(text.iter()) if one.sourceline == int(line[1]))
    return list(root.iter())[place]


def named(root: Any, kind: str, name: str) -> Any:
    return find(root, f"{kind}[@name='{name}']")


def link_of(root: Any, finding: Finding) -> Any:
    return named(root, "link", finding.parts[0])


def joint_of(root: Any, finding: Finding) -> Any:
    told = re.search(r"joints\.(\w+)", finding.where)
    assert told
    return named(root, "joint", told[1])


def setting(path: str, **attributes: str) -> Change:
    """Set attributes of an element below the link or joint that the finding names."""

    def change(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
        owner = joint_of(root, finding) if finding.where.startswith("joints.") else link_of(root, finding)
        for key, value in attributes.items():
            (find(owner, path) if path else owner).set(key, value)

    return change


def left_out(path: str) -> Change:
    def change(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
        owner = joint_of(root, finding) if finding.where.startswith("joints.") else link_of(root, finding)
        gone = find(owner, path)
        gone.getparent().remove(gone)

    return change


def plain_number(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    told = re.match(r"(\w+) (\w+)='(.*?)'", finding.message)
    assert told
    element = next(one for one in root.iter(told[1]) if one.get(told[2]) == told[3])
    element.set(told[2], re.sub(r"[a-z]+", "0", told[3]))


def renamed_second(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    """Rename the second link of the name, and the joint that refers to it: the second that names it as its child."""
    name = finding.where.split(".")[1].split(" ")[0]
    root.findall(f"link[@name='{name}']")[1].set("name", f"{name}_2")
    children = [one for one in root.iterfind("joint/child") if one.get("link") == name]
    children[1].set("link", f"{name}_2")


def with_name(root: Any, _folder: Path, _finding: Finding, _match: Match) -> None:
    next(one for one in root if one.tag in {"link", "joint"} and not one.get("name")).set("name", "given")


def as_meant(path: str, key: str) -> Change:
    """Take the name that the message suggests."""

    def change(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
        meant = re.search(r"Did you mean '(\w+)'", finding.message)
        assert meant
        find(joint_of(root, finding), path).set(key, meant[1])

    return change


def carried_link(root: Any, _folder: Path, _finding: Finding, match: Match) -> None:
    root.append(etree.fromstring(f'<link name="{match[1]}"/>'))
    root.append(joint(f"carry_{match[1]}", "fixed", "plate", match[1], "0 0 0"))


def without_second_carrier(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    told = re.search(r"joints: (\w+) and (\w+)\.", finding.message)
    assert told
    root.remove(named(root, "joint", told[2]))


def loose(finding: Finding) -> str:
    told = re.search(r": \w+ and (\w+)\.", finding.message)
    assert told
    return told[1]


def connected(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    root.append(joint("hold", "fixed", "plate", loose(finding), "-0.08 -0.08 0.025"))


def removed(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    root.remove(named(root, "link", loose(finding)))


def off_the_circle(root: Any, _folder: Path, _finding: Finding, match: Match) -> None:
    start = named(root, "joint", match[1])
    start.find("parent").set("link", "plate")
    start.find("origin").set("xyz", "-0.08 -0.08 0.025")


def shortened(root: Any, _folder: Path, _finding: Finding, _match: Match) -> None:
    root.set("name", "stand")


def weighed(kg: float) -> Any:
    moment = kg * 1e-4
    return etree.fromstring(
        f'<inertial><mass value="{kg}"/><inertia ixx="{moment}" iyy="{moment}" izz="{moment}" ixy="0" ixz="0" iyz="0"/></inertial>'
    )


def with_mass(kg: float) -> Change:
    return lambda root, _folder, finding, _match: link_of(root, finding).append(weighed(kg))


def merged_chain(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    """Let the joint after the carrier start where the one before it does."""
    carrier = finding.parts[0]
    before = next(one for one in root.iterfind("joint") if one.find("child").get("link") == carrier)
    after = next(one for one in root.iterfind("joint") if one.find("parent").get("link") == carrier)
    after.find("parent").set("link", before.find("parent").get("link"))
    after.find("origin").set("xyz", before.find("origin").get("xyz"))
    root.remove(before)
    root.remove(named(root, "link", carrier))


def positive_mass(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    find(link_of(root, finding), "inertial/mass").set("value", repr(defects.ARM_KG))


def centre_of_shapes(root: Any, folder: Path, finding: Finding, _match: Match) -> None:
    """Give the centre in the link's frame, in metres: that of the mesh, which stands in mm."""
    own = link_of(root, finding)
    low, high = read_mesh(folder / own.find("visual/geometry/mesh").get("filename")).bounds
    find(own, "inertial/origin").set("xyz", " ".join(f"{x:.9g}" for x in (low + high) / 2000))


def exchanged(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    bounds = find(joint_of(root, finding), "limit")
    lower, upper = bounds.get("lower"), bounds.get("upper")
    bounds.set("lower", upper)
    bounds.set("upper", lower)


def bounded(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    etree.SubElement(joint_of(root, finding), "limit", lower="-1", upper="1", effort="4", velocity="1.1")


def continuous(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    own = joint_of(root, finding)
    own.set("type", "continuous")
    for key in ("lower", "upper"):
        if own.find("limit") is not None:
            own.find("limit").attrib.pop(key, None)


def fixed(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    own = joint_of(root, finding)
    own.set("type", "fixed")
    for path in ("limit", "axis"):
        own.remove(own.find(path))


def bounds_told(root: Any, _folder: Path, finding: Finding, match: Match) -> None:
    setting("limit", lower=match[1], upper=match[2])(root, _folder, finding, match)


def turned_origin(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    """Turn the origin to the middle of the range, so that zero is there."""
    own = joint_of(root, finding)
    lower, upper = (float(own.find("limit").get(key)) for key in ("lower", "upper"))
    middle = (lower + upper) / 2
    own.find("origin").set("rpy", f"0 0 {middle}")
    own.find("limit").set("lower", repr(lower - middle))
    own.find("limit").set("upper", repr(upper - middle))


def driven(root: Any, _folder: Path, _finding: Finding, match: Match) -> None:
    """State another value of the kind for each joint."""
    for index, bounds in enumerate(root.iterfind("joint/limit")):
        bounds.set(match[1] if match.groups() else "effort", f"{2.3 + index:.4g}")


def mesh_again(root: Any, folder: Path, _finding: Finding, _match: Match) -> None:
    (folder / "arm.stl").write_bytes(write_stl(moved(box(80, 20, 10), 30, 0, 5)))


def name_corrected(root: Any, folder: Path, _finding: Finding, _match: Match) -> None:
    mesh_again(root, folder, _finding, _match)
    (folder / "arm.stl").rename(folder / "arm_1.stl")
    for element in root.iter("mesh"):
        if element.get("filename") == "arm.stl":
            element.set("filename", "arm_1.stl")


def brought_below(root: Any, folder: Path, _finding: Finding, _match: Match) -> None:
    shutil.copy(folder.parent / "elsewhere.stl", folder / "elsewhere.stl")
    for element in root.iter("mesh"):
        if element.get("filename") == "../elsewhere.stl":
            element.set("filename", "elsewhere.stl")


def block_mesh(mesh: TriMesh) -> Change:
    def put(_root: Any, folder: Path, _finding: Finding, _match: Match) -> None:
        (folder / "block.stl").write_bytes(write_stl(mesh))

    return put


def closed(_root: Any, folder: Path, _finding: Finding, _match: Match) -> None:
    """Close the mesh over the edges that belong to only one triangle."""
    mesh = read_mesh(folder / "block.stl")
    edges = [tuple(sorted(pair)) for a, b, c in mesh.triangles.tolist() for pair in ((a, b), (b, c), (c, a))]
    corners = sorted({corner for edge in edges if edges.count(edge) == 1 for corner in edge})
    for order in (corners, corners[::-1]):
        whole = TriMesh(mesh.vertices, np.vstack([mesh.triangles, [order]]))
        if whole.is_closed:
            (folder / "block.stl").write_bytes(write_stl(whole))


def reversed_corners(_root: Any, folder: Path, _finding: Finding, _match: Match) -> None:
    (folder / "block.stl").write_bytes(write_stl(read_mesh(folder / "block.stl").flipped()))


def separate_links(root: Any, folder: Path, _finding: Finding, _match: Match) -> None:
    """Give the second body a link of its own, fixed to the first's: they do not touch, so a bar joins them."""
    block = find(root, "link[@name='block']")
    root.replace(block, link("block", moved(box(20, 20, 10), 0, 0, 5), folder))
    root.append(link("second", moved(box(10, 10, 10), 0, 0, 5), folder))
    root.append(joint("slide_too", "prismatic", "plate", "second", "0.079 -0.02 0.0205", axis="1 0 0", lower=0, upper=0.01, effort=2.1))


def fused(_root: Any, folder: Path, _finding: Finding, _match: Match) -> None:
    halves = [moved(box(20, 20, 10), 0, 0, 5), moved(box(10, 10, 10), 14, 0, 5)]
    solids = [m3.Manifold(m3.Mesh(np.asarray(one.vertices, np.float32), np.asarray(one.triangles, np.uint32))) for one in halves]
    whole = (solids[0] + solids[1]).to_mesh()
    (folder / "block.stl").write_bytes(write_stl(TriMesh(np.asarray(whole.vert_properties, float)[:, :3], np.asarray(whole.tri_verts))))


def collides_as_drawn(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    own = link_of(root, finding)
    shape = copy.deepcopy(own.find("visual"))
    shape.tag = "collision"
    own.append(shape)


def scaled(root: Any, _folder: Path, finding: Finding, match: Match) -> None:
    for element in link_of(root, finding).iter("mesh"):
        element.set("scale", match[1])


def of_one_unit(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    own = link_of(root, finding)
    find(own, "visual/geometry/mesh").set("scale", find(own, "collision/geometry/mesh").get("scale"))


def scaled_by(root: Any, _folder: Path, _finding: Finding, match: Match) -> None:
    """Scale its mesh by the number, and those of the other links, which say the same one after the other."""
    for element in root.iter("mesh"):
        element.set("scale", " ".join([match[1]] * 3))


def based_below(root: Any, _folder: Path, finding: Finding, match: Match) -> None:
    root.insert(0, etree.fromstring('<link name="floor"/>'))
    root.append(joint("stand_on", "fixed", "floor", "plate", f"0 0 {match[1]}"))


def as_stl(root: Any, folder: Path, _finding: Finding, _match: Match) -> None:
    (folder / "arm.stl").write_bytes(write_stl(read_mesh(folder / "arm.glb")))
    for element in root.iter("mesh"):
        if element.get("filename") == "arm.glb":
            element.set("filename", "arm.stl")


def in_metres(root: Any, folder: Path, _finding: Finding, _match: Match) -> None:
    defects.as_glb(root, folder, scale=1.0, mesh_scale=0.001)


def narrowed(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    """Narrow one of the ranges to half, away from where they met."""
    assert finding.pose
    name, value = next(iter(finding.pose.items()))
    bounds = find(root, f"joint[@name='{name}']/limit")
    bounds.set("upper" if value > 0 else "lower", repr(value / 4))


def with_clearance(root: Any, _folder: Path, finding: Finding, _match: Match) -> None:
    assert finding.value
    place = find(root, "joint[@name='turn_second']/origin")
    x, y, z = map(float, place.get("xyz").split())
    place.set("xyz", f"{x} {y + 2 * finding.value / 1000} {z}")


def moved_apart(root: Any, _folder: Path, _finding: Finding, match: Match) -> None:
    """Move the second part of the pair by the stated way, along y, to the side that it is on."""
    place = find(root, "joint[@name='mount']/origin")
    x, y, z = map(float, place.get("xyz").split())
    place.set("xyz", f"{x} {y + math.copysign(float(match[1]) / 1000 + 1e-4, y)} {z}")


def lifted(path: str) -> Change:
    def change(root: Any, _folder: Path, _finding: Finding, match: Match) -> None:
        place = find(root, path)
        x, y, z = map(float, place.get("xyz").split())
        place.set("xyz", f"{x} {y} {z - float(match[1]) / 1000 + 1e-5}")

    return change


def lowered(root: Any, _folder: Path, _finding: Finding, match: Match) -> None:
    """Move the block by the stated amount along z, out of the plate."""
    place = find(root, "joint[@name='slide']/origin")
    x, y, z = map(float, place.get("xyz").split())
    place.set("xyz", f"{x} {y} {z + float(match[1]) / 1000}")


FIX = None  # a rule that calls `--fix`
FOLLOWED: dict[str, list[tuple[str, Change | None]]] = {
    "number": [("Give plain decimal numbers", plain_number)],
    "no_size": [
        ("Give it a positive size", setting("collision[2]/geometry/sphere", radius="0.0004")),
        ("or leave the shape out", left_out("collision[2]")),
    ],
    "shared_name": [("Rename all but one, and update references to them", renamed_second)],
    "no_name": [("Give each a unique name", with_name)],
    "link_unknown": [
        ("Name one of the 3 links", as_meant("parent", "link")),
        (r"or add a link '(\w+)' and a joint that carries it", carried_link),
    ],
    "joint_type": [("Use .*revolute", setting("", type="revolute")), ("Use .*continuous", continuous)],
    "two_parents": [("Keep one of them", without_second_carrier)],
    "roots": [("Connect each of them with a joint", connected), ("or remove it", removed)],
    "circle": [(r"Let one of the joints between them, such as '(\w+)', start from a link outside the cycle", off_the_circle)],
    "mimic": [("Name a joint that moves", as_meant("mimic", "joint")), ("or remove the mimic", left_out("mimic"))],
    "awkward_name": [(r"such as '(\w+)'", lambda root, folder, _f, match: defects.renaming("left arm, long", match[1])(root, folder)), ("--fix does", FIX)],
    "long_name": [("Give it a short name", shortened), ("--fix shortens it", FIX)],
    "no_inertia": [("Give each a mass and an inertia", with_mass(0.01)), ("--fix computes them from closed meshes and --density", FIX)],
    "massless_carrier": [("Give each a small mass and inertia", with_mass(0.0005)), ("or merge the chain into one joint", merged_chain)],
    "zero_mass": [("Give a positive mass", positive_mass), ("leave <inertial> out and use --fix with --density", left_out("inertial"))],
    "negative_mass": [("Give a positive mass", positive_mass), ("leave <inertial> out and use --fix with --density", left_out("inertial"))],
    "negative_moment": [("--fix does", FIX)],
    "zero_inertia": [("--fix does", FIX)],
    "triangle": [("--fix does", FIX)],
    "placeholder_inertia": [("--fix does", FIX)],
    "centre_outside": [("Give it in the link's frame, in metres", centre_of_shapes), ("as --fix does", FIX)],
    "density": [("Check the units of mass", positive_mass), ("Or leave <inertial> out and use --fix with --density", left_out("inertial"))],
    "limits_reversed": [("Exchange the two", exchanged)],
    "no_limits": [("Give lower and upper", bounded), ("or make it continuous", continuous)],
    "locked": [("Make it fixed", fixed), ("or open its range", setting("limit", lower="-1", upper="1"))],
    "degrees": [(r"Write (\S+) and (\S+)\.", bounds_told)],
    "endless": [("Make it continuous", continuous), ("--fix does", FIX)],
    "zero_outside": [("Rotate or shift their origins so that zero is within their range", turned_origin)],
    "no_effort": [("Give each the (effort) of its drive", driven)],
    "placeholder_effort": [("State the value of each drive", driven)],
    "mesh_absent": [("Add the file", mesh_again), ("correct the name", name_corrected)],
    "mesh_unreadable": [("Export the mesh again", mesh_again)],
    "mesh_outside": [("Keep meshes below the file's own folder", brought_below)],
    "mesh_open": [("Close the mesh: every edge must belong to two triangles", closed)],
    "mesh_flat": [("Give it a thickness", block_mesh(moved(box(30, 30, 10), 0, 0, 5)))],
    "mesh_inside_out": [("Reverse the order of the corners of all its triangles", reversed_corners)],
    "pieces": [("Make each body a separate link", separate_links), ("or join them", block_mesh(merged([moved(box(29, 20, 10), 4.5, 0, 5)])))],
    "unfused": [("Fuse the bodies into one", fused)],
    "no_collision": [("Use the same mesh or a simpler one for collision", collides_as_drawn), ("--fix adds the closed visual meshes", FIX)],
    "units": [('add scale="(.*?)"', scaled)],
    "visual_units": [("Give both meshes the same unit by their scale", of_one_unit)],
    "scale": [(r"scale its mesh by ([\d.]+),", scaled_by)],
    "base_below": [(r"Add a base link (\S+) m below it", based_below), ("--fix does", FIX)],
    "gltf": [("Write STL or OBJ", as_stl), ("or glTF in metres", in_metres)],
    "overlap": [("or move it by the same amount|by ([0-9.]+) mm", moved_apart)],
    "neighbours_overlap": [(r"by ([0-9.]+) mm along its z.*or move it by the same", lowered)],
    "collision_in_motion": [(r"move one by ([0-9.]+) mm", moved_apart)],
    "collision_of_two": [("Narrow one of the ranges", narrowed), ("or add clearance", with_clearance)],
    "floating": [(r"Move arm to the part that holds it, or extend one of the two by about ([0-9.]+) mm", lifted("joint[@name='turn']/origin"))],
    "not_touching": [(r"Extend one of them by ([0-9.]+) mm towards the other", lifted("joint[@name='mount']/origin"))],
}  # fmt: skip
"""What a reader does, by the name of a defect, for each alternative of its hint."""


def two_of_a_name(root: Any, folder: Path) -> None:
    """Two links of one name, each carried by a joint."""
    defects.setting("joint[@name='wave_1']/child", link="flag_0")(root, folder)
    defects.setting("link[@name='flag_1']", name="flag_0")(root, folder)


OTHERS = [Defect("shared_name", two_of_a_name, "E_AUDIT_NAME_TWICE", 2, base=defects.three_turns)]
UNFOLLOWED = {
    "name_twice": "`shared_name` is the same fault, of a link that a joint carries.",
    "carriers": "Nothing needs to be done; what it says of other formats is followed below.",
}
CASES = {defect.name: defect for defect in [*DEFECTS, *OTHERS]}
CODES = {defect.code for defect in CASES.values()}


def audited(root: Any, folder: Path) -> Findings:
    return audit_file(defects.write(root, folder), QUICK).findings


def test_every_defect_has_its_hint_followed_or_says_why_not() -> None:
    assert set(FOLLOWED) | set(UNFOLLOWED) == set(CASES)
    assert not set(FOLLOWED) & set(UNFOLLOWED)


@pytest.mark.parametrize(("name", "way"), [(name, way) for name, rules in FOLLOWED.items() for way in range(len(rules))])
def test_a_file_changed_as_the_hint_says_has_the_finding_no_more(name: str, way: int, tmp_path: Path) -> None:
    folder = tmp_path / "model"
    folder.mkdir()
    defect, (words, change) = CASES[name], FOLLOWED[name][way]
    root = (defect.base or defects.stand)(folder)
    defect.spoil(root, folder)
    before = audited(root, folder)
    finding = before.of(defect.code)[0]
    match = re.search(words, finding.hint)
    assert match, finding.hint
    if change is not None:
        change(root, folder, finding, match)
    if change is not None and "--fix" not in words:
        after = audited(root, folder)
    else:
        density = DENSITY if "--density" in finding.hint else None
        rest = mend(defects.write(root, folder), tmp_path / "mended", density=density, choices=QUICK).rest
        assert rest
        after = rest.findings
    assert_heals(finding, before, after)


# ---------------------------------------------------------------------- hints about options, other formats and other programs


def planted(folder: Path, name: str) -> Path:
    """Return the file of a defect of the list."""
    folder.mkdir(exist_ok=True)
    root = (CASES[name].base or defects.stand)(folder)
    CASES[name].spoil(root, folder)
    return defects.write(root, folder)


def only(found: Findings, code: str, words: str) -> Finding:
    """Return the finding of a code whose hint has these words."""
    return next(finding for finding in found.of(code) if words in finding.hint)


def test_a_folder_given_with_root_lets_a_mesh_be_read(tmp_path: Path) -> None:
    path = planted(tmp_path / "model", "mesh_outside")
    before = audit_file(path, QUICK).findings
    finding = only(before, "W_AUDIT_MESH_OUTSIDE", "name the folder that holds both with --root")
    assert_heals(finding, before, audit_file(path, replace(QUICK, root=tmp_path)).findings)


def test_a_folder_of_packages_given_with_root_lets_a_mesh_be_found(tmp_path: Path) -> None:
    path = planted(tmp_path / "model", "mesh_absent")
    (tmp_path / "packages" / "robot").mkdir(parents=True)
    (tmp_path / "packages" / "robot" / "arm.stl").write_bytes(write_stl(moved(box(80, 20, 10), 30, 0, 5)))
    path.write_text(path.read_text().replace('"arm.stl"', '"package://robot/arm.stl"'))
    before = audit_file(path, QUICK).findings
    finding = only(before, "E_AUDIT_MESH_ABSENT", "give the folder of packages with --root")
    assert_heals(finding, before, audit_file(path, replace(QUICK, root=tmp_path / "packages")).findings)


def test_a_mesh_converted_to_a_format_of_the_hint_is_read(tmp_path: Path) -> None:
    path = planted(tmp_path / "model", "mesh_absent")
    path.write_text(path.read_text().replace('"arm.stl"', '"arm.msh"'))
    (path.parent / "arm.msh").write_text("a format that is not read")
    before = audit_file(path, QUICK).findings
    finding = only(before, "I_AUDIT_MESH_FORMAT", "Convert it to one of .stl")
    (path.parent / "arm.stl").write_bytes(write_stl(moved(box(80, 20, 10), 30, 0, 5)))
    path.write_text(path.read_text().replace('"arm.msh"', '"arm.stl"'))
    assert_heals(finding, before, audit_file(path, QUICK).findings)


def test_every_link_in_a_circle_is_rooted_by_removing_the_joint_that_closes_it(tmp_path: Path) -> None:
    root = defects.stand(tmp_path)
    root.append(joint("back", "fixed", "arm", "plate", "0 0 0.1"))
    before = audited(root, tmp_path)
    finding = only(before, "E_AUDIT_ROOTS", "Remove the joint that closes the cycle")
    root.remove(named(root, "joint", "back"))
    assert_heals(finding, before, audited(root, tmp_path))


def test_carriers_merged_as_the_hint_says_are_one_joint_of_an_mjcf(tmp_path: Path) -> None:
    path = planted(tmp_path / "model", "carriers")
    before = audit_file(path, QUICK).findings
    finding = only(before, "I_AUDIT_CARRIERS", "merge them with `articad convert --fuse`")
    convert(path, tmp_path / "model.xml", fuse=True)
    assert_heals(finding, before, audit_file(tmp_path / "model.xml", QUICK).findings)
    assert "carrier" not in (tmp_path / "model.xml").read_text()


@pytest.mark.parametrize("from_outside", [True, False])
def test_hulls_that_jam_are_divided_into_pieces(from_outside: bool, tmp_path: Path) -> None:
    path = foreign(tmp_path / "bare", from_outside=from_outside)
    before = audit_file(path, QUICK).findings
    finding = only(before, "W_AUDIT_HULL_JAM", "articad audit FILE --fix OUT --collision pieces")
    rest = mend(path, tmp_path / "pieces", collision="pieces", choices=QUICK).rest
    assert rest
    assert_heals(finding, before, rest.findings)


@pytest.mark.parametrize(
    ("words", "small", "large"),
    [
        ("Raise --budget", AuditOptions(engines=False, budget=0.0), AuditOptions(engines=False, budget=5.0)),
        ("Raise --certify", AuditOptions(engines=False, certified=1e-9), AuditOptions(engines=False, certified=30.0)),
    ],
)
def test_a_larger_budget_lets_the_audit_finish(words: str, small: AuditOptions, large: AuditOptions, tmp_path: Path) -> None:
    path = defects.write(defects.stand(tmp_path), tmp_path)
    before = audit_file(path, small).findings
    finding = only(before, "W_AUDIT_NOT_CHECKED", words)
    assert_heals(finding, before, audit_file(path, large).findings)


def test_parts_that_are_spread_out_are_all_compared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contact, "REST_S", 0.0)
    path = tmp_path / "a.urdf"
    path.write_text(piled(6))
    before = audit_file(path, QUICK).findings
    finding = only(before, "W_AUDIT_NOT_CHECKED", "Spread the parts out")
    spread = iter(range(1, 6))
    path.write_text(re.sub("<parent", lambda _: f'<origin xyz="0 {0.5 * next(spread)} 0"/><parent', piled(6)))
    assert_heals(finding, before, [one for one in audit_file(path, QUICK).findings if one.code not in {"E_NOT_TOUCHING", "E_FLOATING"}])


def test_a_file_audited_in_pieces_is_compared(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contact, "MOST_BODIES", 20)
    path = tmp_path / "a.urdf"
    path.write_text(piled(30))
    finding = only(audit_file(path, QUICK).findings, "W_AUDIT_NOT_CHECKED", "Audit the file in pieces")
    for piece in range(2):
        path.write_text(piled(15))
        assert not [one for one in audit_file(path, QUICK).findings if one.message == finding.message], piece


def test_a_product_that_is_named_in_cad_has_a_name(tmp_path: Path) -> None:
    path = step_file(tmp_path, {"SOLID": TABLE["top"], "leg": TABLE["leg"]})
    before = audit_file(path, QUICK).findings
    finding = only(before, "W_AUDIT_UNNAMED", "Name the products in CAD before you export them")
    assert_heals(finding, before, audit_file(step_file(tmp_path, TABLE), QUICK).findings)


def test_a_surface_whose_faces_are_sewn_is_a_solid(tmp_path: Path) -> None:
    """A box whose six faces are not sewn, and the solid that sewing makes of them."""
    from build123d import Box, Compound, Pos, Shell, Solid, export_step

    def table(*, sewn: bool) -> Path:
        faces = list((Pos(0, 0, 20) * Box(10, 10, 40)).faces())
        leg = Solid(Shell(faces)) if sewn else Compound(children=faces)
        leg.label = "leg"
        top = Pos(0, 0, 45) * Box(100, 60, 10)
        top.label = "top"
        export_step(Compound(children=[top, leg], label="table"), str(tmp_path / "table.step"))
        return tmp_path / "table.step"

    before = audit_file(table(sewn=False), QUICK).findings
    finding = only(before, "E_AUDIT_NOT_SOLID", "Repair it in CAD: sew its faces")
    assert_heals(finding, before, audit_file(table(sewn=True), QUICK).findings)


def test_shapes_that_are_never_compared_and_fit_need_nothing(tmp_path: Path) -> None:
    """The hint says that nothing need be done if the shapes fit: shapes that are apart have no such finding."""
    rest = {"rest": '<contact><exclude body1="a" body2="b"/></contact>'}
    before = audit_file(mjcf(tmp_path, x=0.09, **rest), ENGINES).findings
    finding = only(before, "I_AUDIT_SHARED", "Nothing needs to be done if the shapes represent bodies that fit")
    assert_heals(finding, before, audit_file(mjcf(tmp_path, x=0.115, **rest), ENGINES).findings)


def bare_arm(root: Any, folder: Path) -> None:
    defects.removing("link[@name='arm']/inertial", "link[@name='arm']/collision", "link[@name='arm']/visual")(root, folder)


def arm_in(ending: str) -> Callable[[Any, Path], None]:
    def spoil(root: Any, folder: Path) -> None:
        whole = trimesh.load(folder / "arm.stl")
        whole.export(folder / f"arm.{ending}")
        for element in root.iter("mesh"):
            if element.get("filename") == "arm.stl":
                element.set("filename", f"arm.{ending}")

    return spoil


def arm_weighed(root: Any, _folder: Path, _finding: Finding, _match: Match) -> None:
    find(root, "link[@name='arm']").append(weighed(0.01))


def as_stl_again(root: Any, _folder: Path, _finding: Finding, _match: Match) -> None:
    for element in root.iter("mesh"):
        if element.get("filename") == "arm.ply":
            element.set("filename", "arm.stl")


def in_a_folder(root: Any, folder: Path) -> None:
    (folder / "meshes").mkdir()
    for name in ("plate", "arm", "block"):
        (folder / f"{name}.stl").rename(folder / "meshes" / f"{name}.stl")
    for element in root.iter("mesh"):
        element.set("filename", f"meshes/{element.get('filename')}")
    root.append(etree.fromstring('<mujoco><compiler strippath="true"/></mujoco>'))  # as MuJoCo before version 4 does without being told


def keeping_paths(root: Any, _folder: Path, _finding: Finding, match: Match) -> None:
    root.replace(root.find("mujoco"), etree.fromstring(match[1]))


def flat_collision(root: Any, folder: Path) -> None:
    (folder / "flat.stl").write_bytes(write_stl(TriMesh(moved(box(80, 20, 10), 30, 0, 5).vertices * [1, 1, 0], box(80, 20, 10).triangles)))
    find(root, "link[@name='arm']/collision/geometry/mesh").set("filename", "flat.stl")


def thick(_root: Any, folder: Path, _finding: Finding, _match: Match) -> None:
    (folder / "flat.stl").write_bytes(write_stl(moved(box(80, 20, 10), 30, 0, 5)))


def as_box(root: Any, _folder: Path, _finding: Finding, _match: Match) -> None:
    own = find(root, "link[@name='arm']/collision")
    own.append(etree.fromstring('<origin xyz="0.03 0 0.005"/>'))
    geometry = find(own, "geometry")
    geometry.remove(geometry[0])
    geometry.append(etree.fromstring('<box size="0.08 0.02 0.01"/>'))


ENGINES = AuditOptions(budget=5.0)
BY_MUJOCO: dict[str, tuple[Callable[[Any, Path], None], str, Change | None]] = {
    "no_inertia": (bare_arm, "Give every body that moves a mass and an inertia", arm_weighed),
    "fix": (defects.removing("link[@name='arm']/inertial", "link[@name='arm']/collision"), "--fix computes them from closed meshes and --density", FIX),
    "mesh_format": (arm_in("ply"), "MuJoCo reads STL, OBJ and MSH; convert the meshes", as_stl_again),
    "mesh_absent": (CASES["mesh_absent"].spoil, "Add the file", mesh_again),
    "mesh_misnamed": (CASES["mesh_absent"].spoil, "or correct its name", name_corrected),
    "strippath": (in_a_folder, "drops folders from URDF names without (<mujoco>.*</mujoco>)", keeping_paths),
    "inertia": (CASES["triangle"].spoil, "Correct the named inertia", FIX),
    "name_twice": (two_of_a_name, "Rename one of the two", renamed_second),
    "number": (CASES["number"].spoil, "Write plain decimal numbers", plain_number),
    "mesh_flat": (flat_collision, "Give the mesh a thickness", thick),
    "as_box": (flat_collision, "or use a box for collision", as_box),
}  # fmt: skip


@pytest.mark.engines
@pytest.mark.parametrize("name", BY_MUJOCO)
def test_a_file_that_an_engine_refuses_loads_when_its_hint_is_followed(name: str, tmp_path: Path) -> None:
    spoil, words, change = BY_MUJOCO[name]
    folder = tmp_path / "model"
    folder.mkdir()
    root = (defects.three_turns if name == "name_twice" else defects.stand)(folder)
    spoil(root, folder)
    before = audit_file(defects.write(root, folder), ENGINES).findings
    (finding,) = [one for one in before.of("W_AUDIT_ENGINE") if one.where == "mujoco"]
    match = re.search(words, finding.hint)
    assert match, finding
    if change is None:
        rest = mend(defects.write(root, folder), tmp_path / "mended", density=DENSITY, choices=ENGINES).rest
        assert rest
        after = rest.findings
    else:
        told = before[0] if name in {"name_twice", "number"} else finding  # which place it is, only the audit's own finding says
        change(root, folder, told, match)
        after = audit_file(defects.write(root, folder), ENGINES).findings
    assert_heals(finding, before, after)


CODES |= {"W_AUDIT_MESH_OUTSIDE", "I_AUDIT_MESH_FORMAT", "W_AUDIT_HULL_JAM", "W_AUDIT_NOT_CHECKED", "W_AUDIT_UNNAMED"}
CODES |= {"E_AUDIT_NOT_SOLID", "I_AUDIT_SHARED", "W_AUDIT_ENGINE", "I_AUDIT_CARRIERS"}
