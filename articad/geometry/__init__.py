"""Meshes, solids, mass and parts."""

from articad.geometry.mass import MassProperties
from articad.geometry.mesh import TriMesh, merged
from articad.geometry.mesh_files import read_mesh, write_glb, write_obj, write_ply, write_stl
from articad.geometry.part import Part, Primitive, Shape, Solid, SolidReader
from articad.geometry.shapes import box, capsule, cylinder, sphere, tube

__all__ = [
    "MassProperties",
    "Part",
    "Primitive",
    "Shape",
    "Solid",
    "SolidReader",
    "TriMesh",
    "box",
    "capsule",
    "cylinder",
    "merged",
    "read_mesh",
    "sphere",
    "tube",
    "write_glb",
    "write_obj",
    "write_ply",
    "write_stl",
]
