"""The ROS 2 files around a URDF: a package, pairs that need no collision check, and joints that controllers may drive."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from lxml import etree

from articad.errors import ExportError
from articad.export.hulls import Pair
from articad.export.lowering import AxisMotion, LoweredModel
from articad.export.markup import child, comment, document, number

if TYPE_CHECKING:
    from articad.assembly import Assembly

_PACKAGE_NAME = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")  # REP 144

_CMAKE = """\
cmake_minimum_required(VERSION 3.8)
project({package})
find_package(ament_cmake REQUIRED)
install(DIRECTORY {folders} DESTINATION share/${{PROJECT_NAME}})
ament_package()
"""

_MANIFEST = """\
<?xml version="1.0"?>
<package format="3">
  <name>{package}</name>
  <version>0.0.0</version>
  <description>Description of {robot}, written by articad.</description>
  <maintainer email="nobody@example.invalid">nobody</maintainer>
  <license>unlicensed</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <exec_depend>robot_state_publisher</exec_depend>
  <export>
    <build_type>ament_cmake</build_type>
  </export>
</package>
"""


def require_package_name(package: str) -> None:
    """Refuse names that ROS does not accept.

    Raises:
        ExportError: If it does not consist of lower-case words joined by single underscores.
    """
    if not _PACKAGE_NAME.fullmatch(package):
        raise ExportError(
            f"{package!r} is not a valid name for a ROS package: use lower-case letters, digits and single underscores, such as 'desk_lamp'."
        )


def package_files(package: str, robot: str, folders: Iterable[str]) -> dict[str, bytes]:
    """Return the manifest and the build file of an ament package that installs these folders."""
    return {
        "package.xml": _MANIFEST.format(package=package, robot=robot).encode(),
        "CMakeLists.txt": _CMAKE.format(package=package, folders=" ".join(folders)).encode(),
    }


def srdf(name: str, links: Mapping[str, str], pairs: Iterable[tuple[str, Pair, str]] = (), kept: Iterable[Any] = ()) -> bytes:
    """Return an SRDF.

    Args:
        name: Name of the robot.
        links: Name of the link by part.
        pairs: SRDF's word for the reason, the pair of parts that needs no collision check, and the claim, which becomes a comment.
        kept: Elements that come first, unchanged.
    """
    root = etree.Element("robot", {"name": name})
    root.extend(kept)
    known = {frozenset((row.get("link1"), row.get("link2"))) for row in root.iterfind("disable_collisions")}
    for reason, pair, claim in pairs:
        a, b = (links[part] for part in pair)
        if frozenset((a, b)) not in known:
            known.add(frozenset((a, b)))
            root.append(comment(claim))
            child(root, "disable_collisions", {"link1": a, "link2": b, "reason": reason})
    return document(root)


def srdf_names(element: Any) -> tuple[set[str], set[str]]:
    """Return the links and the joints that an element of an SRDF names."""
    links: set[str] = set()
    joints: set[str] = set()
    for one in element.iter():
        links |= {value for key, value in one.attrib.items() if key in _LINKS}
        links |= {one.get("name", "")} if one.tag == "link" else set()
        joints |= {one.get("joint_name", one.get("name", ""))} if one.tag in _JOINTS else set()
    return links - {""}, joints - {""}


_LINKS = frozenset({"link", "link1", "link2", "base_link", "tip_link", "parent_link", "child_link"})
_JOINTS = frozenset({"joint", "passive_joint", "joint_property"})


def add_control(root: Any, assembly: Assembly, model: LoweredModel) -> None:
    """Add a `<ros2_control>` system with a position command for every driving freedom, on mock hardware."""
    driven = {driver.name for driver in assembly.mechanism.drivers}
    freedoms: list[AxisMotion] = [freedom for joint in model.joints for freedom in joint.freedoms if _is_driven(freedom, driven)]
    system = child(root, "ros2_control", {"name": model.name, "type": "system"})
    child(child(system, "hardware"), "plugin", text="mock_components/GenericSystem")
    for freedom in freedoms:
        joint = child(system, "joint", {"name": freedom.name})
        child(joint, "command_interface", {"name": "position"})
        position = child(joint, "state_interface", {"name": "position"})
        child(position, "param", {"name": "initial_value"}, number(freedom.rest))
        child(joint, "state_interface", {"name": "velocity"})


def _is_driven(freedom: AxisMotion, driven: set[str]) -> bool:
    """True for a driver's own coordinate; the angles of a ball are not coordinates, but they drive as well."""
    return freedom.column in driven or (freedom.column is None and freedom.follows is None)
