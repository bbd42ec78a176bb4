"""The file formats: one row each, with its reader, its writer and their options; `read`, `write` and `convert`."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

from articad.assembly import Assembly
from articad.errors import ArticadError, ExportError, ReadError
from articad.export.bundle import Bundle
from articad.export.freecad import write_freecad
from articad.export.freecad_split import is_part_file
from articad.export.gltf import write_glb
from articad.export.mjcf import write_mjcf
from articad.export.plan import write_plan
from articad.export.sdf import write_sdf
from articad.export.step import write_step
from articad.export.threemf import write_3mf
from articad.export.urdf import write_urdf
from articad.export.usd import write_usd
from articad.files import RECORD_BYTES, differs, read_file
from articad.findings import Finding, Findings
from articad.geometry.mesh_files import MADE_BY_ARTICAD
from articad.importers.freecad import read_freecad
from articad.importers.mjcf import read_mjcf
from articad.importers.sdf import read_sdf
from articad.importers.step import read_step
from articad.importers.urdf import read_urdf
from articad.plan.schema import AssemblyPlan


def read_plan(path: str | Path) -> Assembly:
    """Build the plan of a file with the part scripts in the folder `parts` beside it.

    Raises:
        ReadError: If the file cannot be read.
        PlanError: If the plan is refused by `check_plan`.
        BuildError: If a part script fails.
    """
    path = Path(path)
    return Assembly.from_plan(AssemblyPlan.load(path), path.parent / "parts")


@dataclass(frozen=True)
class Format:
    """A file format.

    Attributes:
        name: Its name on the command line and in reports.
        suffixes: Endings of its files, lower case; the first one is written.
        writer: `writer(assembly, *, strict=False, **options) -> Bundle`.
        reader: `reader(path, **options) -> Assembly`; None where the format is only written.
        holds: What a reader of the file sees of an assembly, in words.
        keeps: What a file of the format says that an assembly has no field for, and that the writer puts back; "" for nothing.
    """

    name: str
    suffixes: tuple[str, ...]
    writer: Callable[..., Bundle]
    reader: Callable[..., Assembly] | None = None
    holds: str = ""
    keeps: str = ""

    def write(self, assembly: Assembly, *, strict: bool = False, **options: Any) -> Bundle:
        """Return the files of an assembly; options that this format does not have are ignored."""
        return self.writer(assembly, strict=strict, **_known(self.writer, options))

    def read(self, path: Path, **options: Any) -> Assembly:
        """Return the assembly of a file; options that this format does not have are ignored.

        Raises:
            ReadError: If the format cannot be read, or the file cannot.
        """
        if self.reader is None:
            raise _not_read(path)
        return self.reader(path, **_known(self.reader, options))


FORMATS: Final = (
    Format(
        "urdf",
        (".urdf",),
        write_urdf,
        read_urdf,
        "a tree of links and joints, mass, shapes; couplings as `<mimic>`; loops only for Isaac and Drake",
        "elements of links, joints and the robot, and the SRDF",
    ),
    Format(
        "mjcf",
        (".xml", ".mjcf"),
        write_mjcf,
        read_mjcf,
        "bodies, joints, mass, shapes, couplings and loops",
        "attributes of joints, geoms and bodies, and the sections beside the bodies",
    ),
    Format("freecad", (".fcstd",), write_freecad, read_freecad, "parts with their features, an assembly with joints and limits"),
    Format("step", (".step", ".stp"), write_step, read_step, "B-rep of the parts where they rest, names, colours, sub-assemblies"),
    Format("glb", (".glb",), write_glb, None, "meshes, names, colours, and an animation for every driver"),
    Format("3mf", (".3mf",), write_3mf, None, "one closed mesh for each part, as it is printed"),
    Format(
        "sdf",
        (".sdf", ".world"),
        write_sdf,
        read_sdf,
        "links, joints, mass, shapes and loops; couplings as `<mimic>`",
        "elements of models, links, joints and shapes that name no frames",
    ),
    Format("usd", (".usda",), write_usd, None, "bodies, joints, mass, shapes and loops"),
    Format("plan", (".json",), write_plan, read_plan, "everything but shapes, which part scripts build"),
)
"""All formats, in the order in which they are listed."""

NAMED: Final = {row.name: row for row in FORMATS}
"""Format by its name."""


def readable() -> Iterator[str]:
    """Yield the endings of files that can be read."""
    return (suffix for row in FORMATS if row.reader for suffix in row.suffixes)


def format_of(path: str | Path) -> Format | None:
    """Return the format that a file's ending means, or None."""
    suffix = Path(path).suffix.lower()
    return next((row for row in FORMATS if suffix in row.suffixes), None)


def read(path: str | Path, *, root: str | Path | None = None, fuse: bool = False, srdf: str | Path | None = None) -> Assembly:
    """Read an assembly from a file in any format that articad reads.

    Args:
        path: A URDF, MJCF, SDFormat, FreeCAD or STEP file, or a plan with its part scripts.
        root: Folder that meshes may be read from; the file's own by default.
        fuse: For URDF, MJCF and SDFormat: replace chains of joints over links without shapes, and the constraints that close a loop, by the one
            joint that they represent.
        srdf: For URDF: the SRDF that belongs to it; by default the file of the same name beside it.

    Raises:
        ReadError: If the format cannot be read, or the file cannot.
    """
    path = Path(path)
    if not path.exists():
        raise ReadError.at(path, f"There is no {path}.", "Correct the name.", said=f"There is no {path}.")
    if path.suffix.lower() == ".xacro":
        return NAMED["urdf"].read(path, root=root, fuse=fuse, srdf=srdf)
    if path.is_dir():
        message, inside = f"{path} is a folder; a file is needed.", path / "plan.json"
        hint = f"Name the file: {inside}." if inside.is_file() else "Name a file in it."
        raise ReadError(message, path=str(path), findings=[Finding(code="E_READ", where=str(path), message=message, hint=hint)])
    found = format_of(path)
    if found is None:
        raise _not_read(path)
    return found.read(path, root=root, fuse=fuse, srdf=srdf)


def write(assembly: Assembly, path: str | Path, *, strict: bool = False, **options: Any) -> Bundle:
    """Write an assembly to a file; meshes and other files that it needs go beside it.

    Args:
        assembly: What to write.
        path: The file; its ending says the format.
        strict: Refuse losses of motion, mass or shape.
        options: Options of the format's writer, such as `collision="hull"` for `write_urdf`.

    Returns:
        What was written, with the losses.

    Raises:
        ExportError: If the format cannot be written, an option is unknown to its writer, `strict` refuses a loss, or a file that belongs
            to something else would be replaced (E_REPLACES).
    """
    path, found = Path(path), _written_as(path)
    require_options([found], options)
    bundle = found.write(assembly, strict=strict, **options)
    bundle = replace(bundle, files={path.name if name == bundle.main else name: content for name, content in bundle.files.items()})
    _require_free(bundle, path)
    bundle.write(path.parent)
    return bundle


def require_options(written: Sequence[Format], options: Iterable[str]) -> None:
    """Refuse options that none of the formats to be written has.

    Raises:
        ExportError: An option is unknown; the message lists those of the formats.
    """
    known = {name for found in written for name in options_of(found.writer)}
    if unknown := sorted(set(options) - known):
        names = ", ".join(found.name for found in written)
        has, it_has = ("has", "it has") if len(written) == 1 else ("have", "they have")
        raise ExportError(f"{names} {has} no option {', '.join(unknown)}; {it_has} {', '.join(sorted(known)) or 'none'}.")


_NAMING: Final = frozenset({".urdf", ".xacro", ".xml", ".mjcf", ".sdf", ".world"})
"""Endings of files that name meshes."""


def _require_free(bundle: Bundle, path: Path) -> None:
    """Refuse to replace a folder, a mesh of somebody else, or a mesh that another file beside the target names.

    Raises:
        ExportError: E_REPLACES; nothing is written then.
    """
    elsewhere = path.parent / path.stem / path.name
    hint = f"Write {elsewhere.as_posix()}, or another file in a folder of its own."
    if path.is_dir():
        raise _replaces(path, f"{path} is a folder.", f"Name a file in it, such as {(path / path.name).as_posix()}.")
    changed = [name for name, content in bundle.files.items() if name != bundle.main and differs(path.parent / name, content)]
    beside = [other for other in path.parent.iterdir() if other.suffix.lower() in _NAMING and other.name != path.name] if changed else []
    texts = {other: text for other in beside if (text := _text_of(other)) is not None}
    for name in changed:
        there = path.parent / name
        text = _text_of(there) or b""
        if there.suffix == ".FCStd" and not is_part_file(text):
            raise _replaces(there, f"{there} is another document, which articad did not write.", hint)
        if there.suffix != ".FCStd" and not text.startswith(MADE_BY_ARTICAD):
            raise _replaces(there, f"{there} is another mesh, which articad did not write.", hint)
        if user := next((other for other, text in texts.items() if name.encode() in text), None):
            raise _replaces(there, f"{there} is another mesh, which {user.name} names.", hint)


def _text_of(path: Path) -> bytes | None:
    """Return the content of a file in the target's folder, or None if it is not a regular file or too large."""
    try:
        return read_file(path, RECORD_BYTES)
    except OSError:
        return None


def _replaces(path: Path, message: str, hint: str) -> ExportError:
    finding = Finding(code="E_REPLACES", where=str(path), message=message, hint=hint, stage="export")
    return ExportError(f"{message} {hint}", findings=[finding])


def convert(
    source: str | Path,
    target: str | Path,
    *,
    strict: bool = False,
    root: str | Path | None = None,
    fuse: bool = False,
    srdf: str | Path | None = None,
    **options: Any,
) -> tuple[Assembly, Bundle]:
    """Read a file and write it in another format.

    Args:
        source: The file to read.
        target: The file to write; its ending says the format.
        strict: Refuse losses of motion, mass or shape.
        root: Folder that meshes may be read from; the source's own by default.
        fuse: As for `read`.
        srdf: As for `read`.
        options: As for `write`.

    Returns:
        What was read, with its findings, and what was written, with its losses.

    Raises:
        ReadError: If the source cannot be read.
        ExportError: As for `write`; the source is not read if the target's format is unknown. If writing fails, the findings of the
            error go on with the reader's: what is wrong with the file may be the cause.
    """
    _written_as(target)
    if any(one.is_file() and Path(target).exists() and one.samefile(target) for one in (Path(source), Path(source) / "plan.json")):
        raise _replaces(Path(target), f"{target} is the file to convert.", "Name another file.")
    assembly = read(source, root=root, fuse=fuse, srdf=srdf)
    try:
        return assembly, write(assembly, target, strict=strict, **options)
    except ArticadError as error:
        error.findings = Findings([*error.findings, *(finding for finding in assembly.findings if finding not in error.findings)])
        raise


def _written_as(path: str | Path) -> Format:
    """Return the format that a file to be written has, or refuse it."""
    found = format_of(path)
    if found is None:
        known = ", ".join(suffix for row in FORMATS for suffix in row.suffixes)
        raise ExportError(f"{path}: extension {Path(path).suffix!r} is not one of {known}.")
    return found


def options_of(function: Callable[..., object]) -> tuple[str, ...]:
    """Return the names of a reader's or writer's own options."""
    named = (parameter for parameter in inspect.signature(function).parameters.values() if parameter.kind is parameter.KEYWORD_ONLY)
    return tuple(parameter.name for parameter in named if parameter.name != "strict")


def _known(function: Callable[..., object], options: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in options.items() if name in options_of(function)}


def _not_read(path: Path) -> ReadError:
    suffix = path.suffix.lower()
    message = f"{path}: extension {path.suffix!r} is not one of {', '.join(readable())}."
    advice = next((text for endings, text in ADVICE.items() if suffix in endings), "Convert it first, or correct its name.")
    finding = Finding(code="E_READ", where=str(path), message=message, hint=advice)
    return ReadError(f"{message} {advice}", path=str(path), findings=[finding])


ADVICE: Final = {
    (".usd", ".usda", ".usdc", ".usdz"): "Export URDF or MJCF from the program that made it; USD is only written.",
    (
        ".stl",
        ".obj",
        ".ply",
        ".dae",
        ".glb",
        ".gltf",
        ".3mf",
    ): "A mesh is a part, not an assembly: Part.from_mesh reads it, and a URDF can name it.",
    (
        ".igs",
        ".iges",
        ".brep",
        ".sldasm",
        ".sldprt",
        ".ipt",
        ".iam",
        ".f3d",
        ".prt",
        ".catpart",
        ".x_t",
    ): "Export STEP from the CAD program.",
    (
        ".srdf",
    ): "An SRDF belongs to a URDF: read the URDF. The SRDF of the same name beside it, or the one that --srdf names, is read with it.",
}
"""What to do with files in formats that are not read, by their endings."""
