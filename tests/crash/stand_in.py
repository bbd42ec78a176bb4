"""A kernel that knows one solid: every script gives the same cube, in a millisecond and with no process."""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from articad.geometry.mesh import TriMesh
from articad.geometry.shapes import box
from articad.kernels.kernel import BuiltPart, Inspect

SIDE = 8.0  # mm


class FixedKernel:
    """Stands for a kernel where what matters is what becomes of its files."""

    name = "build123d"
    version = "fixed"

    def build(
        self,
        script: bytes,
        brief: Mapping[str, Any],
        *,
        folder: Path,
        deflection: float = 0.01,
        probe: bool = True,
        inspect: Inspect | None = None,
    ) -> BuiltPart:
        """Leave the cube, with the connectors where the plan has them."""
        assert probe is not None
        assert inspect is None or callable(inspect)
        frames = {name: {axis: frame[axis] for axis in ("o", "z", "x", "label")} for name, frame in brief["connectors"].items()}
        return _left(folder, box(SIDE, SIDE, SIDE), frames, dict(brief), deflection, hashlib.sha256(script).hexdigest())

    def moved(self, built: BuiltPart, matrix: ArrayLike, folder: Path) -> BuiltPart:
        """Leave the part under a motion or a reflection."""
        T = np.asarray(matrix, dtype=np.float64)
        mesh = built.solid.mesh
        triangles = mesh.triangles[:, ::-1] if np.linalg.det(T[:3, :3]) < 0 else mesh.triangles
        moved = TriMesh(mesh.vertices @ T[:3, :3].T + T[:3, 3], triangles, mesh.face)
        frames = {}
        for name, connector in built.connectors.items():
            frame = connector.mirrored(T).frame if np.linalg.det(T[:3, :3]) < 0 else connector.frame
            frames[name] = {
                "o": frame.translation.tolist(),
                "z": frame.z_axis.tolist(),
                "x": frame.x_axis.tolist(),
                "label": connector.label,
            }
        return _left(folder, moved, frames, dict(built.brief), built.solid.deflection, "moved")


def _left(folder: Path, mesh: TriMesh, frames: dict[str, Any], brief: dict[str, Any], deflection: float, mark: str) -> BuiltPart:
    stream = io.BytesIO()
    np.savez(stream, vertices=mesh.vertices, triangles=mesh.triangles, face=np.zeros(len(mesh.triangles), dtype=np.int32))
    (folder / "part.npz").write_bytes(stream.getvalue())
    (folder / "part.brep").write_text(f"CASCADE {mark}")
    (folder / "part.step").write_text(f"ISO-10303-21; {mark}")
    volume, com, inertia = mesh.solid_integrals()
    shape = {
        "volume_mm3": volume,
        "area_mm2": 6 * SIDE**2,
        "com_mm": com.tolist(),
        "inertia_mm5": inertia.tolist(),
        "bbox_mm": mesh.bounds.tolist(),
    }
    result = {"shape": shape, "connectors": frames, "findings": [], "part": brief, "deflection_mm": deflection, "sandbox": "none"}
    (folder / "result.json").write_text(json.dumps(result))
    return BuiltPart.load(folder)
