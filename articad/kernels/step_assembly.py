"""STEP assemblies of unknown origin, read in the confined worker: every solid with its product's name and pose."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from articad.errors import InvalidSolidError, ReadError
from articad.files import read_file
from articad.geometry.mesh import TriMesh
from articad.kernels.build123d import ANGLE_DEG, Build123dKernel
from articad.kernels.results import PoisonedError, read_bytes, read_mesh
from articad.kernels.zygote import ends_by
from articad.texts import escaped

MAX_BYTES = 256 * 2**20
MAX_PARTS = 2000
_NAME = 200  # characters kept of a product's name


@dataclass(frozen=True, eq=False)
class StepPart:
    """One solid, or loose faces, of a STEP file.

    Attributes:
        name: Unique in the file: the instance's name if several instances share a product and have names, else the product's, numbered.
        product: Name of the product in the file.
        where: Names of the products above it, joined by "/".
        mesh: In the assembly's frame [mm]; None if it cannot be meshed.
        valid: Whether the kernel considers it a valid solid with volume.
        loose: True for faces that belong to no solid.
        faces: Number of its faces.
    """

    name: str
    product: str
    where: str
    mesh: TriMesh | None
    valid: bool
    loose: bool
    faces: int

    @property
    def gaps(self) -> int:
        """Number of open edges of a valid solid's mesh: the kernel meshes some with gaps, however finely; 0 of all other parts."""
        if not self.valid or self.mesh is None or self.mesh.is_closed:
            return 0
        return self.mesh.open_edges


class StepReader(Build123dKernel):
    """Reads STEP assemblies in the confined worker."""

    def read_assembly(self, path: Path, *, deflection: float = 0.05) -> tuple[StepPart, ...]:
        """Return the parts of a STEP file.

        Args:
            path: The file.
            deflection: Largest distance of the meshes from the surfaces [mm].

        Raises:
            ReadError: If it is not a STEP file, or contains no shape.
        """
        self._require_sandbox()
        try:
            content = read_file(path, MAX_BYTES)
        except OSError as error:
            raise ReadError(f"{path.name} cannot be read: {error.strerror}.", path=str(path)) from error
        try:
            with self.job_folder() as job:
                (job / "shape.bin").write_bytes(content)
                request = {"deflection_mm": deflection, "angle_deg": ANGLE_DEG}
                limits = replace(self.limits, probe_seconds=0.0)
                ran = self._run("assembly", job, request, {"shape": "shape.bin", "npz": "part.npz"}, limits)
                head = ran.report[0] if ran.report else {}
                if head.get("ok") is not True:
                    why = head.get("message") or ends_by(ran.outcome) or ran.crash
                    raise ReadError(f"{path.name} is not a readable STEP file: {str(why)[:200]}.", path=str(path))
                mesh = read_mesh(read_bytes(job / "part.npz"))
                return _parts(ran.report[1:], mesh)
        except (PoisonedError, InvalidSolidError) as error:
            raise ReadError(f"{path.name} is not a readable STEP file: {error}", path=str(path)) from error


def _parts(rows: list[dict[str, Any]], whole: TriMesh) -> tuple[StepPart, ...]:
    """Return the parts that the worker reported. The worker read untrusted input, so every field is validated."""
    if len(rows) > MAX_PARTS or whole.face is None:
        raise PoisonedError("there are too many parts")
    taken: Counter[str] = Counter()
    return tuple(_part(index, row, whole, taken) for index, row in enumerate(rows))


def _part(index: int, row: Mapping[str, Any], whole: TriMesh, taken: Counter[str]) -> StepPart:
    product = escaped(str(row.get("product") or ""))[:_NAME]
    path = row.get("path")
    above = [escaped(str(name))[:_NAME] for name in path[:50]] if isinstance(path, list) else []
    wanted = escaped(str(row.get("instance") or ""))[:_NAME] or product or f"part_{index + 1}"
    name = wanted
    while name in taken:  # the file may state a name that looks numbered
        taken[wanted] += 1
        name = f"{wanted} ({taken[wanted]})"
    taken[name] = 1
    assert whole.face is not None
    chosen = whole.face == index
    mesh = whole.submesh(np.asarray(chosen)) if chosen.any() else None
    faces = row.get("faces")
    return StepPart(
        name,
        product,
        "/".join([*above, name]),
        None if mesh is None else TriMesh(mesh.vertices, mesh.triangles),
        row.get("valid") is True and mesh is not None,
        row.get("loose") is True,
        faces if isinstance(faces, int) else 0,
    )
