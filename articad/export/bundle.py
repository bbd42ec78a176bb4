"""The result of an exporter: files as bytes, and what the format could not hold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from types import MappingProxyType
from typing import Any

from articad.errors import ExportError
from articad.findings import Finding, Findings
from articad.processes import scratch


@dataclass(frozen=True)
class Loss:
    """Something that a format cannot hold as it is.

    Attributes:
        format: The format, such as "urdf".
        where: Its place: `joints.elbow`, `parts.arm`, `couplings.mesh`.
        kept: What was written instead.
        lost: What a reader of the file does not see.
        refused: True if `strict` refuses it: motion, mass or shape differ from what was declared.
    """

    format: str
    where: str
    kept: str
    lost: str
    refused: bool = True

    def to_json(self) -> dict[str, Any]:
        """Return a row of the report `articad.losses/1`."""
        return {"format": self.format, "where": self.where, "kept": self.kept, "lost": self.lost}

    def __str__(self) -> str:
        return f"{self.format} {self.where}: written as {self.kept}; lost: {self.lost}"


@dataclass(frozen=True, eq=False)
class Bundle:
    """Files that belong together, not yet written.

    Attributes:
        files: Content by path, relative and with forward slashes; the first is the main file.
        losses: What the format could not hold.
        findings: Findings of the export beyond its losses.
    """

    files: Mapping[str, bytes]
    losses: tuple[Loss, ...] = ()
    findings: Findings = field(default_factory=Findings)

    def __post_init__(self) -> None:
        object.__setattr__(self, "files", MappingProxyType(dict(self.files)))
        object.__setattr__(self, "losses", tuple(self.losses))

    @property
    def main(self) -> str:
        """Path of the file that a reader is given."""
        return next(iter(self.files))

    def to_json(self) -> dict[str, Any]:
        """Return the report `articad.losses/1`: files and their sizes, losses, findings."""
        return {
            "schema": "articad.losses/1",
            "ok": self.findings.ok,
            "files": {path: len(content) for path, content in self.files.items()},
            "rows": [loss.to_json() for loss in self.losses],
            "findings": [finding.to_json() for finding in self.findings],
        }

    def write(self, folder: str | Path) -> list[Path]:
        """Write all files into a folder; each file appears complete or not at all.

        Args:
            folder: Created if it does not exist. Files of the same names are replaced, others are not changed.

        Returns:
            The files written, the main one first.

        Raises:
            ExportError: E_UNSAFE_PATH if a path leads out of the folder; nothing is written then.
        """
        root = Path(folder)
        targets = {path: _inside(root, path) for path in self.files}
        for path, content in self.files.items():
            scratch.write(targets[path], content)
        return list(targets.values())


def _inside(root: Path, path: str) -> Path:
    """Return where a path of the bundle is written, or refuse it; links to folders are resolved before the check."""
    pure = PurePosixPath(path)
    target = root / pure
    harmless = pure.parts and not pure.is_absolute() and ".." not in pure.parts and "\\" not in path and "\0" not in path
    if not harmless or not target.parent.resolve().is_relative_to(root.resolve()):
        finding = Finding(
            code="E_UNSAFE_PATH",
            where=repr(path),
            message="This path leads out of the output folder.",
            hint="Use a relative path.",
            stage="export",
        )
        raise ExportError(f"{path!r} leads out of the folder {root}.", findings=[finding])
    return target
