"""The verdict of simulators on a file or an assembly."""

from __future__ import annotations

from pathlib import Path

from articad.assembly import Assembly
from articad.errors import ArticadError, ReadError
from articad.export.lowering import lower
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.importers.closure import package_of, require_closed
from articad.processes import scratch
from articad.simulation.expected import held_to_kinematics
from articad.simulation.loading import Engine
from articad.simulation.trial import SECONDS, try_out
from articad.simulation.verdict import Verdict

ENGINES: tuple[Engine, ...] = ("mujoco", "pybullet")
SIMULATED = (".urdf", ".xml", ".mjcf")


def simulate_file(path: str | Path, *, engines: tuple[Engine, ...] = ENGINES, seconds: float = SECONDS) -> Verdict:
    """Hold, drive and let go the model of a URDF or MJCF file, as it stands.

    Args:
        path: The file.
        engines: Which to ask; those that are not installed are passed over.
        seconds: For each of them.

    Raises:
        ReadError: If its ending is neither; E_UNSAFE_PATH if it names files outside its ROS package, or outside its folder without one.
    """
    path = Path(path)
    if path.suffix.lower() not in SIMULATED:
        raise ReadError(f"{path}: simulators load {', '.join(SIMULATED)}; convert it first.", path=str(path))
    if not path.is_file():
        raise ReadError(f"{path}: there is no such file.", path=str(path))
    root = package_of(path)
    require_closed(path, root)
    return Verdict(str(path), tuple(try_out(engine, path, root=root, seconds=seconds) for engine in engines))


def simulate_assembly(assembly: Assembly, file: str, *, engines: tuple[Engine, ...] = ENGINES, seconds: float = SECONDS) -> Verdict:
    """Export an assembly and hold, drive and let go what was exported: MJCF in MuJoCo, URDF in PyBullet, which leaves loops open."""
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
    return Verdict(file, tuple(outcomes))


def driving(assembly: Assembly) -> tuple[str, ...]:
    """Return the names that formats have for the drivers."""
    model, columns = lower(assembly), {driver.name for driver in assembly.drivers}
    return tuple(freedom.name for joint in (*model.joints, *model.loops) for freedom in joint.freedoms if freedom.column in columns)


def readable(path: str | Path) -> Assembly | None:
    """Return the assembly of a file, for pictures of it; None where it cannot be read."""
    from articad.formats import read  # noqa: PLC0415 - only where there is something to draw

    try:
        return read(path, root=Path(path).resolve().parent)
    except ArticadError:
        return None
