"""Texts as vectors: a similar meaning gives a small angle."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float32]


class Embedder(Protocol):
    """Converts texts to vectors of one space, identified by its name: vectors of two spaces are never compared."""

    @property
    def name(self) -> str:
        """The model and its dimension."""
        ...

    def embed(self, texts: Sequence[str]) -> FloatArray:
        """Return unit vectors, shape (texts, dimension)."""
        ...


class WordLlamaEmbedder:
    """The default: static word vectors, 256 numbers per text, offline."""

    name = "wordllama-l2-256"

    def embed(self, texts: Sequence[str]) -> FloatArray:
        """Return unit vectors, shape (texts, 256)."""
        if not texts:
            return np.zeros((0, 256), np.float32)
        return normalised(_word_vectors().embed(list(texts)))


def normalised(vectors: Any) -> FloatArray:
    """Return vectors of length 1; a zero vector, as for a text without words, stays zero."""
    rows = np.asarray(vectors, np.float32)
    lengths = np.linalg.norm(rows, axis=1, keepdims=True)
    return np.asarray(rows / np.where(lengths > 0.0, lengths, 1.0), np.float32)


@cache
def _word_vectors() -> Any:
    import wordllama  # noqa: PLC0415 - takes a second: loaded for the first search

    # With its tokenizer's path given, it does not look for one on a network.
    return wordllama.WordLlama.load(cache_dir=Path(wordllama.__file__).parent, disable_download=True)
