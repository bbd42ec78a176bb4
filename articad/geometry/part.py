"""Part: one type for the results of kernels and importers and for meshes given in Python."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Literal, Self

import numpy as np
from numpy.typing import ArrayLike

from articad.arrays import FloatArray
from articad.connectors.attachment import Attachment
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.errors import ConnectorError, InvalidSolidError, did_you_mean
from articad.geometry.mass import MassProperties
from articad.geometry.mesh import TriMesh, merged
from articad.geometry.mesh_files import read_mesh

__all__ = ["MassProperties", "Part", "Primitive", "Shape", "Solid", "SolidReader"]


DEFAULT_COLOR = "#9aa5b1"
IDENTITY = SE3.identity()


@dataclass(frozen=True)
class Primitive:
    """The exact primitive that a mesh represents, in the mesh's frame.

    Attributes:
        kind: Type of the body; all are centred, and a cylinder and a capsule lie along z.
        size: [mm]: x, y, z of a box; radius and length of a cylinder; radius and length between the balls' centres of a capsule; radius of a
            sphere; half axes x, y, z of an ellipsoid.
    """

    kind: Literal["box", "cylinder", "sphere", "capsule", "ellipsoid"]
    size: tuple[float, ...]


@dataclass(frozen=True, eq=False)
class Shape:
    """A mesh for drawing or for collision.

    Attributes:
        mesh: In its own frame [mm].
        frame: `T_part_mesh`: pose of that frame in the part.
        color: "#rrggbb", or None for the part's.
        name: For files and reports.
        primitive: The primitive that the mesh represents, if a file stated it.
    """

    mesh: TriMesh
    frame: SE3 = IDENTITY
    color: str | None = None
    name: str = ""
    primitive: Primitive | None = None

    @property
    def placed(self) -> TriMesh:
        """The mesh in the part's frame."""
        return self.mesh if self.frame == IDENTITY else self.mesh.transformed(self.frame)

    @cached_property
    def digest(self) -> str:
        """SHA-256 over mesh, frame and colour: shapes with equal digests share one file."""
        total = hashlib.sha256(self.mesh.digest.encode())
        total.update(np.ascontiguousarray(self.frame.data, dtype="<f8").tobytes())
        total.update((self.color or "").encode())
        return total.hexdigest()

    def reflected(self, S: FloatArray) -> Shape:
        """Return the mirror image under `S (4, 4)` of the part's frame, applied to the mesh."""
        return Shape(self.placed.reflected(S), IDENTITY, self.color, self.name)


@dataclass(frozen=True, eq=False)
class Solid:
    """One closed body, with exact numbers if it has a B-rep.

    Attributes:
        mesh: Its surface in the part's frame, closed.
        brep: File of the B-rep, if there is one.
        step: The same as STEP.
        deflection: Largest distance between mesh and true surface [mm]; 0 if the mesh itself is the solid.
        volume: [mm³].
        area: [mm²].
        com: Centre of the volume [mm], `(3,)`.
        inertia_mm5: Inertia about the centre at density one [mm⁵], `(3, 3)`.
        bbox: Smallest and largest coordinates [mm], `(2, 3)`.
    """

    mesh: TriMesh
    brep: Path | None
    step: Path | None
    deflection: float
    volume: float
    area: float
    com: FloatArray
    inertia_mm5: FloatArray
    bbox: FloatArray

    @classmethod
    def from_mesh(cls, mesh: TriMesh, *, deflection: float = 0.0) -> Self:
        """Return the solid bounded by a closed mesh, with numbers computed from the mesh.

        Raises:
            InvalidSolidError: If the mesh is open or inside out.
        """
        if not mesh.is_closed:
            raise InvalidSolidError(f"The mesh is not closed: {mesh.open_edges} of its edges belong to only one triangle.", status="open")
        volume, com, inertia = mesh.solid_integrals()
        if volume <= 0:
            raise InvalidSolidError(
                f"The mesh encloses {volume:.6g} mm³: it is inside out or flat; reverse its triangles.", status="inside_out"
            )
        return cls(mesh, None, None, deflection, volume, mesh.area, com, inertia, mesh.bounds)

    def mass(self, density: float) -> MassProperties:
        """Return its mass at a density [kg/m³]."""
        return MassProperties.from_solid(self.volume, self.com, self.inertia_mm5, density)

    def mirrored(self, S: ArrayLike) -> Solid:
        """Return the mirror image under `S (4, 4)`, without B-rep files, which show the original."""
        matrix = np.asarray(S, dtype=np.float64)
        mesh = self.mesh.reflected(matrix)
        Q = matrix[:3, :3]
        return Solid(
            mesh, None, None, self.deflection, self.volume, self.area, Q @ self.com + matrix[:3, 3], Q @ self.inertia_mm5 @ Q.T, mesh.bounds
        )

    def moved(self, T: SE3) -> Solid:
        """Return the solid in the frame into which `T` maps; the B-rep files stay unmoved and are kept."""
        mesh = self.mesh.transformed(T)
        R = T.rotation
        return replace(self, mesh=mesh, com=R @ self.com + T.translation, inertia_mm5=R @ self.inertia_mm5 @ R.T, bbox=mesh.bounds)


SolidReader = Callable[[Path, float], Solid]
"""Turns a STEP file into a solid meshed to a deflection [mm]; the kernels' worker is one."""


@dataclass(frozen=True, eq=False)
class Part:
    """A rigid body of an assembly.

    Attributes:
        name: Unique in the assembly.
        connectors: By name, in the part's own frame.
        visuals: Shapes to draw.
        collisions: Shapes for collision, if not the solid.
        solid: The body itself, if it is known; None for a part without geometry or from a file of loose triangles.
        mass: Given, or from solid and density; None if neither is known.
        color: "#rrggbb".
        material: Name of its material, if it has one.
    """

    name: str
    connectors: Mapping[str, Connector] = field(default_factory=dict)
    visuals: tuple[Shape, ...] = ()
    collisions: tuple[Shape, ...] = ()
    solid: Solid | None = None
    mass: MassProperties | None = None
    color: str = DEFAULT_COLOR
    material: str | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "connectors", MappingProxyType(dict(self.connectors)))
        object.__setattr__(self, "visuals", tuple(self.visuals))
        object.__setattr__(self, "collisions", tuple(self.collisions))

    def __reduce__(self) -> tuple[object, ...]:
        """Support pickling: a read-only mapping cannot be pickled as it is."""
        values = [dict(self.connectors) if entry.name == "connectors" else getattr(self, entry.name) for entry in fields(self)]
        return type(self), tuple(values)

    @classmethod
    def from_mesh(
        cls,
        name: str,
        mesh: TriMesh | str | Path,
        *,
        density: float | None = None,
        connectors: Mapping[str, Connector] | None = None,
        scale: float = 1.0,
        color: str = DEFAULT_COLOR,
        material: str | None = None,
    ) -> Self:
        """Return a part made from a triangle mesh or from a mesh file.

        A closed mesh becomes the solid; an open one is only drawn and used for collision: it has no volume and so no mass.

        Args:
            name: Name of the part.
            mesh: The mesh, or an STL, OBJ, GLB, PLY or DAE file.
            density: [kg/m³]; without it the part has no mass.
            connectors: By name.
            scale: Millimetres per unit of the file or mesh.
            color: "#rrggbb".
            material: Name of its material.

        Raises:
            ReadError: If the file cannot be read.
            InvalidSolidError: If a density is given and the mesh is open or inside out.
        """
        trimesh = mesh if isinstance(mesh, TriMesh) else read_mesh(mesh)
        trimesh = trimesh if scale == 1.0 else trimesh.scaled(scale)
        shape = Shape(trimesh, name=name)
        solid = Solid.from_mesh(trimesh) if density is not None or (trimesh.is_closed and trimesh.volume > 0) else None
        mass = solid.mass(density) if solid is not None and density is not None else None
        return cls(name, connectors or {}, (shape,), (shape,), solid, mass, color, material)

    @classmethod
    def from_solid(
        cls,
        name: str,
        solid: Solid,
        *,
        density: float | None = None,
        connectors: Mapping[str, Connector] | None = None,
        color: str = DEFAULT_COLOR,
        material: str | None = None,
    ) -> Self:
        """Return a part with one solid, whose mesh is drawn and used for collision.

        Args:
            name: Name of the part.
            solid: Its shape.
            density: Density for its mass [kg/m³]; None for no mass.
            connectors: By name, in the part's frame.
            color: "#rrggbb".
            material: Name of the material.
        """
        shape = Shape(solid.mesh, name=name)
        return cls(name, connectors or {}, (shape,), (shape,), solid, None if density is None else solid.mass(density), color, material)

    @classmethod
    def from_step(
        cls,
        name: str,
        path: str | Path,
        *,
        read: SolidReader,
        deflection: float = 0.01,
        density: float | None = None,
        connectors: Mapping[str, Connector] | None = None,
        color: str = DEFAULT_COLOR,
        material: str | None = None,
    ) -> Self:
        """Return a part from a STEP file.

        B-rep never enters this process, so the reader is an argument: the kernels' worker, which meshes and measures the solid.

        Args:
            name: Name of the part.
            path: Path of the file.
            read: Reads a file with a deflection and returns the solid.
            deflection: Largest distance of the mesh from the solid [mm].
            density: Density for its mass [kg/m³]; None for no mass.
            connectors: By name, in the part's frame.
            color: "#rrggbb".
            material: Name of the material.
        """
        solid = read(Path(path), deflection)
        return cls.from_solid(name, solid, density=density, connectors=connectors, color=color, material=material)

    @classmethod
    def without_geometry(cls, name: str, connectors: Mapping[str, Connector] | None = None, mass: MassProperties | None = None) -> Self:
        """Return a part that has frames and perhaps mass, but no shape."""
        return cls(name, connectors or {}, mass=mass)

    def __getitem__(self, connector: str) -> Attachment:
        """Return one side of a joint: this part with one of its connectors.

        Raises:
            ConnectorError: If the part has no such connector.
        """
        if connector not in self.connectors:
            known = ", ".join(self.connectors) or "none"
            raise ConnectorError(
                f"Part {self.name!r} has no connector {connector!r}.{did_you_mean(connector, self.connectors)} Known: {known}."
            )
        return Attachment(self.name, self.connectors[connector])

    @cached_property
    def mesh(self) -> TriMesh | None:
        """The mesh for interference checks: the solid's mesh, else all collision shapes as one mesh, else None."""
        if self.solid is not None:
            return self.solid.mesh
        return merged([shape.placed for shape in self.collisions]) if self.collisions else None

    @property
    def deflection(self) -> float:
        """Largest distance between `mesh` and the true surface [mm]; 0 if there is only the mesh."""
        return 0.0 if self.solid is None else self.solid.deflection

    def mirrored(self, name: str, S: ArrayLike) -> Part:
        """Return the mirror image as a part of its own.

        Args:
            name: Name of the image.
            S: Reflection of the part's frame, `(4, 4)`.
        """
        matrix = np.asarray(S, dtype=np.float64)
        images = {id(shape): shape.reflected(matrix) for shape in (*self.visuals, *self.collisions)}
        return replace(
            self,
            name=name,
            connectors={key: connector.mirrored(matrix) for key, connector in self.connectors.items()},
            visuals=tuple(images[id(shape)] for shape in self.visuals),
            collisions=tuple(images[id(shape)] for shape in self.collisions),
            solid=None if self.solid is None else self.solid.mirrored(matrix),
            mass=None if self.mass is None else self.mass.mirrored(matrix),
        )

    def renamed(self, name: str) -> Part:
        """Return the same part under another name."""
        return replace(self, name=name)

    def _repr_html_(self) -> str:
        """Return the HTML by which a notebook shows the part: its page."""
        from articad.report import notebook_part  # noqa: PLC0415 - only where one looks

        return notebook_part(self)

    def _repr_mimebundle_(self, **_wanted: object) -> dict[str, str]:
        """Return the forms a notebook may choose from: the page, and plain text if nothing can be drawn."""
        return {"text/plain": repr(self), "text/html": self._repr_html_()}

    def __repr__(self) -> str:
        return f"<Part {self.name}: {len(self.connectors)} connectors, {self.mesh or 'no geometry'}>"
