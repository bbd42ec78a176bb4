"""The verdict of simulators on a file or an assembly."""

from __future__ import annotations

import contextlib
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from articad.assembly import Assembly
from articad.errors import ArticadError, ReadError
from articad.export.lowering import lower
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.importers.reading import read_xml
from articad.importers.referenced_files import package_of, require_closed
from articad.processes import scratch
from articad.simulation.expected import held_to_kinematics
from articad.simulation.loading import Engine
from articad.simulation.trial import SECONDS, try_out
from articad.simulation.verdict import SimulationVerdict

ENGINES: tuple[Engine, ...] = ("mujoco", "pybullet")
SIMULATED = (".urdf", ".xml", ".mjcf")


def simulate_file(path: str | Path, *, engines: tuple[Engine, ...] = ENGINES, seconds: float = SECONDS) -> SimulationVerdict:
    """Simulate the model of a URDF or MJCF file as it is: hold it, drive it and let it go.

    Args:
        path: The file.
        engines: Engines to use; those that are not installed are skipped.
        seconds: Time limit of each.

    Raises:
        ReadError: If its extension is neither; E_UNSAFE_PATH if it names files outside its ROS package, or outside its folder without
            one.
    """
    path = Path(path)
    if path.suffix.lower() not in SIMULATED:
        raise ReadError(f"{path}: simulators load {', '.join(SIMULATED)}; convert it first.", path=str(path))
    if not path.is_file():
        raise ReadError(f"{path}: there is no such file.", path=str(path))
    root = package_of(path)
    require_closed(path, root)
    told = _told(path)
    outcomes = []
    for engine in engines:
        alone = engine == "pybullet"  # it drives the tree of joints: parts of one body do not collide, and loops are left open
        opened, mimics = () if alone else told.opened, {**told.mimics, **(told.couplings if alone else {})}
        outcome = try_out(engine, path, root=root, rest=told.rest, opened=opened, mimics=mimics, seconds=seconds)
        outcome.open_loops = told.loops + (told.equalities if alone else 0)
        outcomes.append(outcome)
    return SimulationVerdict(str(path), tuple(outcomes))


class _Told(NamedTuple):
    """Data of a file, and of articad's records in it, beyond what engines read.

    Attributes:
        rest: Rest values of joints of a URDF by name [rad or m].
        mimics: Leader, multiplier and offset of joints of a URDF that follow others.
        loops: Number of loops that a URDF leaves open.
        opened: Joints of these loops, and those coupled with them.
        equalities: Number of equality constraints of an MJCF but `couplings`; PyBullet leaves them out.
        couplings: Leader, multiplier and offset of joints of an MJCF that an equality makes a linear function of another joint.
    """

    rest: dict[str, float]
    mimics: dict[str, tuple[str, float, float]]
    loops: int = 0
    opened: tuple[str, ...] = ()
    equalities: int = 0
    couplings: Mapping[str, tuple[str, float, float]] = MappingProxyType({})


def _told(path: Path) -> _Told:
    """Return the data of a file beyond what engines read; empty if it cannot be parsed, which engines will report."""
    try:
        root = read_xml(path)
    except ReadError:
        return _Told({}, {})
    if path.suffix.lower() != ".urdf":
        linear = _couplings(root)
        return _Told({}, {}, equalities=len(root.findall("equality/*")) - len(linear), couplings=linear)
    mimics = _mimics(root)
    assembly = readable(path) if root.find("articad") is not None else None
    if assembly is None:
        return _Told({}, mimics)
    model, mechanism = lower(assembly), assembly.mechanism
    rest = {freedom.name: freedom.rest for joint in model.joints for freedom in joint.freedoms}
    couplings = {name for _, name, _ in model.couplings} | {follows.leader for _, _, follows in model.couplings}
    ties = [(freedom.name, freedom.follows) for joint in model.joints for freedom in joint.freedoms]
    couplings |= {end for name, follows in ties if follows is not None for end in (name, follows.leader)}  # the file may state either
    inside = {joint.name for loop in mechanism.loop_joints for joint in mechanism.tree.joints_between(loop.parent, loop.child)}
    opened = {freedom.name for joint in model.joints if joint.joint.name in inside for freedom in joint.freedoms}
    if opened & ({*mimics} - couplings):  # <mimic> replaces the loops
        return _Told(rest, mimics)
    for _ in model.couplings:
        for _, name, follows in model.couplings:
            if {name, follows.leader} & opened:
                opened |= {name, follows.leader}
    return _Told(rest, mimics, len(mechanism.loop_joints), tuple(sorted(opened & rest.keys())))


def _couplings(root: Any) -> dict[str, tuple[str, float, float]]:
    """Return leader, multiplier and offset of the joints of an MJCF that follow others linearly, by equalities that state so."""
    found = {}
    for tie in root.iterfind("equality/joint"):
        with contextlib.suppress(ValueError):  # not numbers: engines will report it
            offset, ratio, *higher = [float(word) for word in tie.get("polycoef", "").split()] or [0.0, 0.0, 1.0]
            if tie.get("joint2") and not any(higher) and tie.get("joint1", "") not in found:
                found[tie.get("joint1", "")] = (tie.get("joint2"), ratio, offset)
    return found


def _mimics(root: Any) -> dict[str, tuple[str, float, float]]:
    """Return leader, multiplier and offset of the joints of a URDF that follow others."""
    found = {}
    for joint in root.iterfind("joint"):
        tie = joint.find("mimic")
        if tie is not None:
            with contextlib.suppress(ValueError):  # not a number: engines will report it
                found[joint.get("name", "")] = (tie.get("joint", ""), float(tie.get("multiplier", 1)), float(tie.get("offset", 0)))
    return found


def simulate_assembly(
    assembly: Assembly, file: str, *, engines: tuple[Engine, ...] = ENGINES, seconds: float = SECONDS
) -> SimulationVerdict:
    """Export an assembly and simulate the exports: MJCF in MuJoCo, and URDF in PyBullet, which leaves loops open."""
    drivers = driving(assembly)
    outcomes = []
    with scratch.folder("simulate") as folder:
        for engine in engines:
            bundle = (write_mjcf if engine == "mujoco" else write_urdf)(assembly)
            target = Path(folder) / engine
            bundle.write(target)
            outcome = try_out(engine, target / bundle.main, drivers=drivers, seconds=seconds)
            if engine == "mujoco":
                outcome = held_to_kinematics(assembly, outcome)
            else:
                outcome.open_loops = len(assembly.mechanism.loop_joints)
            outcomes.append(outcome)
    return SimulationVerdict(file, tuple(outcomes))


def driving(assembly: Assembly) -> tuple[str, ...]:
    """Return the names of the drivers in formats."""
    model, columns = lower(assembly), {driver.name for driver in assembly.drivers}
    return tuple(freedom.name for joint in (*model.joints, *model.loops) for freedom in joint.freedoms if freedom.column in columns)


def readable(path: str | Path) -> Assembly | None:
    """Return the assembly of a file, for pictures of it; None if it cannot be read."""
    from articad.formats import read  # noqa: PLC0415 - only if there is something to draw

    try:
        return read(path, root=Path(path).resolve().parent)
    except ArticadError:
        return None
