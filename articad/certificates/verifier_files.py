"""Read the files of a certificate without trusting them: a part of the checker in `verifier.py`, which shares nothing with the prover.

Whoever calls the checker, it reads regular files within bounds of size, number of values, and memory. A file beyond them is not read, which
refutes nothing: the reason begins with `UNREAD`.
"""

from __future__ import annotations

import io
import math
import os
import stat
import zipfile
from pathlib import Path
from typing import Any

import numpy as np

BYTES, TEXT, VALUES = 2**29, 2**27, 6_000_000  # largest size of a file; of a certificate, and how many values it has
ARRAYS, ROOM = 2**20, 2**29  # how many arrays one file has; bytes of the arrays of all files together
UNREAD = "not read: "  # begins a reason why files are not checked: this refutes nothing
TYPES = {"f": "f8", "i": "i8", "u": "i8", "U": "U"}  # of arrays, by kind: short numbers overflow, and complex ones have no order


class Refuted(Exception):  # noqa: N818 - not an error of the program
    """The reason why the checker rejects a certificate."""


def need(condition: Any, reason: str) -> None:
    """Refute the certificate unless a condition holds."""
    if not condition:
        raise Refuted(reason)


def content(file: Path, most: int) -> bytes:
    """Return the bytes of a regular file; refuse a pipe or a device, which might never end."""
    handle = os.open(file, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with os.fdopen(handle, "rb") as stream:
        need(stat.S_ISREG(os.fstat(handle).st_mode), f"{file.name} is not a file")
        need(os.fstat(handle).st_size <= most, f"{UNREAD}{file.name} is larger than {most} bytes")
        return stream.read(most)


def text(file: Path) -> bytes:
    """Return the text of a certificate, unless it has more values than a parser should make."""
    found = content(file, TEXT)
    need(sum(map(found.count, (b",", b"[", b"{", b":"))) <= VALUES, f"{UNREAD}{file.name} has more than {VALUES} values")
    return found


def arrays_in(folder: Path, names: list[str]) -> dict[str, dict[str, Any]]:
    """Return the arrays of files `<name>.npz`, unless they take more than the room that all files have."""
    arrays, left = dict[str, dict[str, Any]](), ROOM
    for name in names:
        need(Path(name).name == name, "a mesh has a name that is not a file name")
        packed, arrays[name] = content(folder / f"{name}.npz", BYTES), {}
        need(packed.count(b"PK\x01\x02") <= ARRAYS, f"{UNREAD}{name}.npz has more than {ARRAYS} arrays")
        with zipfile.ZipFile(io.BytesIO(packed)) as archive:
            for member in archive.infolist():
                need(member.file_size <= left, f"{UNREAD}the arrays of all files have more than {ROOM} bytes")
                with archive.open(member) as stream, io.BytesIO(stream.read(member.file_size)) as unpacked:  # and no more
                    array = read(unpacked)
                left -= room(array)
                need(left >= 0, f"{UNREAD}the arrays of all files have more than {ROOM} bytes")
                arrays[name][member.filename.removesuffix(".npy")] = widened(array)
    return arrays


def read(stream: io.BytesIO) -> Any:
    """Return the array of a stream; refuse one with fewer bytes than its head states, for which memory would be taken."""
    of = np.lib.format
    head = of.read_array_header_1_0 if of.read_magic(stream) == (1, 0) else of.read_array_header_2_0
    shape, _, kind = head(stream)
    need(math.prod(shape) * kind.itemsize <= len(stream.getbuffer()), "an array is not whole")
    stream.seek(0)
    return of.read_array(stream, allow_pickle=False)


def room(array: Any) -> int:
    """Return how many bytes an array takes here, where each number has 64 bits."""
    return int(array.size * max(8, array.itemsize))


def widened(array: Any) -> Any:
    """Return an array of 64-bit numbers, which do not overflow here; refuse other kinds of arrays."""
    return array.astype(TYPES[array.dtype.kind])
