"""Read the results of a confined process without trusting them: first sizes, then form, then every number."""

from __future__ import annotations

import io
import json
import math
import re
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from articad.aliases import Json
from articad.errors import InvalidSolidError
from articad.files import UnsafeFileError, read_left
from articad.geometry.mesh import TriMesh

REPORT_BYTES = 2**20
MESH_BYTES = 2**28
MAX_ROWS = 20_000_000  # of an array; the largest checked part so far has had 5 million triangles
MAX_MM = 1e7  # a coordinate beyond 10 km is invalid
# The header of an array in a .npz, as NumPy writes it in version 1.0. Not `np.lib.format`, whose `ast.literal_eval` fails now and then
# (SystemError: AST constructor recursion depth mismatch) when several threads of Python 3.11 use it.
_HEADER = re.compile(
    rb"\x93NUMPY\x01\0(?P<length>..)(?P<text>\{'descr': '(?P<descr><\w\d)', 'fortran_order': False, "
    rb"'shape': \((?P<rows>\d{1,18}),(?: (?P<columns>\d))?\), \} *\n)",
    re.DOTALL,
)
_ARRAYS: dict[str, tuple[np.dtype[Any], int]] = {
    "vertices": (np.dtype("<f8"), 2),
    "triangles": (np.dtype("<i4"), 2),
    "face": (np.dtype("<i4"), 1),
}


class PoisonedError(Exception):
    """A result that no honest worker would leave; the message says what is wrong."""


def read_lines(path: Path) -> list[Json]:
    """Read a report: one JSON object per line; an unfinished last line is ignored.

    Raises:
        PoisonedError: If it is too large or not JSON.
    """
    content = read_bytes(path, REPORT_BYTES)
    try:
        lines = [json.loads(line, parse_constant=_refuse) for line in content.split(b"\n")[:-1]]
    except (ValueError, RecursionError) as error:
        raise PoisonedError(f"{path.name} is not JSON") from error
    if not all(isinstance(line, dict) for line in lines):
        raise PoisonedError(f"{path.name} contains values that are not objects")
    return lines


def numbers(value: Any, *shape: int) -> NDArray[np.float64]:
    """Return finite numbers of a shape.

    Raises:
        PoisonedError: If the value is anything else.
    """
    try:
        array = np.array(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        raise PoisonedError("numbers are missing") from error
    if array.shape != shape or not np.isfinite(array).all():
        raise PoisonedError(f"{shape} finite numbers are expected")
    return array


def number(value: Any) -> float:
    """Return a finite number.

    Raises:
        PoisonedError: If the value is anything else.
    """
    try:
        if not isinstance(value, bool) and isinstance(value, (int, float)) and math.isfinite(value):
            return float(value)
    except OverflowError:  # JSON allows integers of any length
        pass
    raise PoisonedError("a finite number is missing")


def read_mesh(content: bytes) -> TriMesh:
    """Read `part.npz`, without pickles and without trusting its headers.

    Raises:
        PoisonedError: If it is not the mesh that the contract requires.
    """
    try:
        arrays = _arrays(content)
    except PoisonedError:
        raise
    except Exception as error:  # zipfile and NumPy raise whatever they stumble over: tokenize.TokenError, struct.error, SyntaxError
        raise PoisonedError("part.npz cannot be read") from error
    vertices, face = arrays["vertices"], arrays["face"]
    if vertices.size and np.nanmax(np.abs(vertices)) > MAX_MM:
        raise PoisonedError("a vertex is farther than 10 km away")
    if face.size and face.min() < 0:
        raise PoisonedError("a triangle belongs to a negative face")
    try:
        return TriMesh(vertices, arrays["triangles"], face)
    except InvalidSolidError as error:
        raise PoisonedError(error.message) from error


def _arrays(content: bytes) -> dict[str, NDArray[Any]]:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        members = {member.filename: member for member in archive.infolist()}
        if set(members) != {f"{name}.npy" for name in _ARRAYS} or len(archive.infolist()) != len(_ARRAYS):
            raise PoisonedError("part.npz has other arrays than vertices, triangles and face")
        if any(member.compress_type != zipfile.ZIP_STORED or member.file_size > len(content) for member in members.values()):
            raise PoisonedError("part.npz is compressed")
        return {name: _array(archive.read(f"{name}.npy"), *_ARRAYS[name]) for name in _ARRAYS}


def _array(content: bytes, dtype: np.dtype[Any], dimensions: int) -> NDArray[Any]:
    """Return an array whose header promises exactly the bytes that follow it."""
    header = _HEADER.match(content)
    if header is None or int.from_bytes(header["length"], "little") != len(header["text"]):
        raise PoisonedError("part.npz has an unknown header")
    shape = tuple(int(size) for size in header.group("rows", "columns") if size is not None)
    found = header["descr"].decode()
    if found != dtype.str or len(shape) != dimensions or (dimensions == 2 and shape[1] != 3) or shape[0] > MAX_ROWS:
        raise PoisonedError(f"part.npz holds an array {shape} of {found}")
    if len(content) - header.end() != math.prod(shape) * dtype.itemsize:
        raise PoisonedError(f"part.npz claims an array {shape}, but has bytes for another")
    return np.frombuffer(content, dtype, offset=header.end()).reshape(shape)


def read_bytes(path: Path, limit: int = MESH_BYTES) -> bytes:
    """Return a file's content.

    Raises:
        PoisonedError: If it is larger than the limit [bytes].
    """
    try:
        return read_left(path, limit)
    except UnsafeFileError as error:
        raise PoisonedError(f"{path.name}: {error.strerror}") from None


def _refuse(constant: str) -> None:
    raise ValueError(f"{constant} is not a JSON number")
