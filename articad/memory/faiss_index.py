"""FAISS, for stores of a hundred thousand cases: an index beside the database, rebuilt whenever it is outdated."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from articad.errors import ReadError
from articad.files import RECORD_BYTES, read_file
from articad.findings import Finding
from articad.memory.embedding import FloatArray
from articad.runs.run import write_atomically


def load(folder: Path, label: str, stamp: str) -> Any | None:
    """Return the stored index of a label if it has this stamp, else None; an incomplete file counts as missing."""
    faiss = _faiss()
    path = _path(folder, label)
    try:
        head, _, content = read_file(path, RECORD_BYTES).partition(b"\n")
        if head != stamp.encode() + hashlib.sha256(content).hexdigest().encode():
            return None
        return faiss.deserialize_index(np.frombuffer(content, np.uint8))
    except OSError:
        return None


def build(folder: Path, label: str, stamp: str, numbers: NDArray[np.int64], vectors: FloatArray) -> Any:
    """Return an index of vectors by their numbers, and store it under a stamp that identifies its content."""
    faiss = _faiss()
    index = faiss.IndexIDMap(faiss.IndexFlatIP(vectors.shape[1]))
    index.add_with_ids(vectors, numbers)
    content = faiss.serialize_index(index).tobytes()
    write_atomically(_path(folder, label), stamp.encode() + hashlib.sha256(content).hexdigest().encode() + b"\n" + content)
    return index


def _path(folder: Path, label: str) -> Path:
    return folder / f"{hashlib.sha256(label.encode()).hexdigest()[:16]}.faiss"


def _faiss() -> Any:
    try:
        import faiss  # noqa: PLC0415 - an extra
    except ImportError as error:
        message = "The index 'faiss' needs the package faiss-cpu."
        finding = Finding(code="E_READ", where="faiss", message=message, hint="pip install 'articad[faiss]', or leave the index out.")
        raise ReadError(f"{message} {finding.hint}", path="faiss", findings=[finding]) from error
    return faiss
