"""One file in, another out: every reader with every writer, and what is lost on the way."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final

from articad.assembly import Assembly
from articad.errors import ExportError, ReadError
from articad.export.bundle import Bundle
from articad.export.freecad import write_freecad
from articad.export.gltf import write_glb
from articad.export.mjcf import write_mjcf
from articad.export.plan import write_plan
from articad.export.sdf import write_sdf
from articad.export.step import write_step
from articad.export.threemf import write_3mf
from articad.export.urdf import write_urdf
from articad.export.usd import write_usd
from articad.findings import Finding
from articad.importers.freecad import read_freecad
from articad.importers.mjcf import read_mjcf
from articad.importers.step import read_step
from articad.importers.urdf import EXPAND, read_urdf
from articad.plan.schema import AssemblyPlan

WRITERS: Final[Mapping[str, Callable[..., Bundle]]] = {
    "urdf": write_urdf,
    "mjcf": write_mjcf,
    "freecad": write_freecad,
    "sdf": write_sdf,
    "usd": write_usd,
    "step": write_step,
    "glb": write_glb,
    "3mf": write_3mf,
    "plan": write_plan,
}
"""Writer of each format: `write(assembly, *, strict=False) -> Bundle`."""


def read_plan(path: str | Path, *, root: str | Path | None = None) -> Assembly:
    """Build the plan of a file, with the part scripts in the folder `parts` beside it.

    Args:
        path: The file, `.json`.
        root: Unused: a plan names no files.
    """
    del root
    path = Path(path)
    return Assembly.from_plan(AssemblyPlan.load(path), path.parent / "parts")


READERS: Final[Mapping[str, Callable[..., Assembly]]] = {
    ".urdf": read_urdf,
    ".xml": read_mjcf,
    ".mjcf": read_mjcf,
    ".fcstd": read_freecad,
    ".step": read_step,
    ".stp": read_step,
    ".json": read_plan,
}
"""Reader of each file name's ending."""

FORMAT_OF: Final[Mapping[str, str]] = {
    ".urdf": "urdf",
    ".xml": "mjcf",
    ".mjcf": "mjcf",
    ".sdf": "sdf",
    ".fcstd": "freecad",
    ".usda": "usd",
    ".step": "step",
    ".stp": "step",
    ".glb": "glb",
    ".3mf": "3mf",
    ".json": "plan",
}
"""Format that a file name's ending asks for."""


FUSING: Final = frozenset({".urdf", ".xml", ".mjcf"})
"""Endings whose readers can fuse chains of joints."""


def read(path: str | Path, *, root: str | Path | None = None, fuse: bool = False) -> Assembly:
    """Read an assembly from a file in any format that articad reads.

    Args:
        path: A URDF, MJCF, FreeCAD or STEP file, or a plan with its part scripts.
        root: Folder that meshes may be read from; the file's own by default.
        fuse: Of URDF and MJCF: make chains of joints over bare links the one joint that they stand for, such as a ball.

    Raises:
        ReadError: If the format is not read, or the file cannot be.
    """
    path = Path(path)
    reader = READERS.get(path.suffix.lower())
    if path.suffix.lower() == ".xacro":
        message = f"{path}: a xacro file is a program that writes a URDF; it is not run here."
        raise ReadError(
            f"{message} {EXPAND}", path=str(path), findings=[Finding(code="E_READ", where=str(path), message=message, hint=EXPAND)]
        )
    if reader is None:
        message = f"{path}: {path.suffix or 'no'} extension is not one of {', '.join(READERS)}."
        finding = Finding(code="E_READ", where=str(path), message=message, hint="Convert it first, or correct its name.")
        raise ReadError(message, path=str(path), findings=[finding])
    return reader(path, root=root, fuse=True) if fuse and path.suffix.lower() in FUSING else reader(path, root=root)


def convert(
    source: str | Path, target: str | Path, *, strict: bool = False, root: str | Path | None = None, fuse: bool = False
) -> tuple[Assembly, Bundle]:
    """Convert a file; nothing is written yet.

    Args:
        source: The file to read.
        target: The file to write; its ending says the format, its folder is where `bundle.write(...)` should put the rest.
        strict: Refuse losses of motion, mass or shape.
        root: Folder that meshes may be read from.
        fuse: As for `read`.

    Returns:
        What was read, with its findings, and what is to be written, with its losses.

    Raises:
        ReadError: If the source cannot be read.
        ExportError: If the target's format is not written, or `strict` refuses it.
    """
    suffix = Path(target).suffix.lower()
    if suffix not in FORMAT_OF:
        raise ExportError(f"{target}: {suffix or 'no'} extension is not one of {', '.join(FORMAT_OF)}.")
    assembly = read(source, root=root, fuse=fuse)
    return assembly, WRITERS[FORMAT_OF[suffix]](assembly, strict=strict)
