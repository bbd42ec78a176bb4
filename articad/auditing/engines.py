"""Findings about engines that do not load a file, with the engine's message and the cause."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Final

from articad.findings import Finding
from articad.simulation.loading import Loading

NAMES: Final = {"mujoco": "MuJoCo", "pinocchio": "Pinocchio", "pybullet": "PyBullet"}

_CAUSES: Final = (
    (r"mass and inertia of moving bodies", "no_inertia", "Give every body that moves a mass and an inertia; --fix computes them from closed meshes and --density."),
    (r"no decoder found|unknown mesh file type|[Uu]nsupported.*mesh", "mesh_format", "MuJoCo reads STL, OBJ and MSH; convert the meshes."),
    (r"package:", "package_uri", "It does not resolve ROS packages: name meshes relative to the file, as --fix does."),
    (r"geometry specification not found", "geometry", "Use a box, a cylinder, a sphere or a mesh: engines differ in the other shapes they accept."),
    (r"opening file|resource not found|not found", "mesh_absent", 'Add the file, or correct its name. MuJoCo before version 4 drops folders from URDF names without <mujoco><compiler strippath="false"/></mujoco>.'),
    (r"inertia must satisfy|A \+ B >= C|positive definite|inertia", "inertia", "Correct the named inertia."),
    (r"repeated (URDF )?name|not unique|duplicate", "name_twice", "Rename one of the two."),
    (r"number of faces should be between", "mesh_size", "Reduce the mesh to fewer than 200,000 triangles, or split it."),
    (r"bad format in attribute|to a double|not a number", "number", "Write plain decimal numbers; expand xacro first."),
    (r"No valid root|two parents|multiple|root link", "structure", "Give the file one root link."),
    (r"mesh volume is too small|volume", "mesh_flat", "Give the mesh a thickness."),
    (r"qhull|coplanar", "mesh_flat", "Give the mesh a thickness, or use a box for collision."),
)  # fmt: skip


def refusals(loadings: Iterable[Loading]) -> Iterator[Finding]:
    """Yield a finding for each engine that does not load the file."""
    for loading in loadings:
        if loading.late is not None:
            yield _unfinished(loading)
        if loading.loads is not False:
            continue
        cause, hint = next(
            ((cause, hint) for pattern, cause, hint in _CAUSES if re.search(pattern, loading.message)),
            (None, "Correct what the message names."),
        )
        yield Finding(
            code="W_AUDIT_ENGINE",
            where=loading.engine,
            message=f"{NAMES[loading.engine]} {loading.version} does not load the file: {loading.message}",
            hint=hint,
            cause=cause,
        )


def _unfinished(loading: Loading) -> Finding:
    return Finding(
        code="W_AUDIT_ENGINE",
        where=loading.engine,
        message=f"Whether {NAMES[loading.engine]} loads the file is not known: {loading.message}.",
        hint="Use fewer or smaller meshes, or try again while the machine does less.",
        cause="time",
    )
