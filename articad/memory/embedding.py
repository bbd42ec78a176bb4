"""Texts as vectors: near in meaning, near in angle."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float32]


class Embedder(Protocol):
    """Turns texts into vectors of one space, which its name stands for: vectors of two spaces are never compared."""

    @property
    def name(self) -> str:
        """The model and its dimension."""
        ...

    def embed(self, texts: Sequence[str]) -> FloatArray:
        """Return unit vectors, shape (texts, dimension)."""
        ...


class WordLlamaEmbedder:
    """The default: static word vectors, 256 numbers a text, offline."""

    name = "wordllama-l2-256"

    def embed(self, texts: Sequence[str]) -> FloatArray:
        """Return unit vectors, shape (texts, 256)."""
        if not texts:
            return np.zeros((0, 256), np.float32)
        return normalised(_word_vectors().embed(list(texts)))


def normalised(vectors: Any) -> FloatArray:
    """Return vectors of length 1; a zero vector, as of a text without words, stays one."""
    rows = np.asarray(vectors, np.float32)
    lengths = np.linalg.norm(rows, axis=1, keepdims=True)
    return np.asarray(rows / np.where(lengths > 0.0, lengths, 1.0), np.float32)


@cache
def _word_vectors() -> Any:
    import wordllama  # noqa: PLC0415 - takes a second: loaded when something is looked for

    # Told where its tokenizer is, it does not look for one on a network.
    return wordllama.WordLlama.load(cache_dir=Path(wordllama.__file__).parent, disable_download=True)
