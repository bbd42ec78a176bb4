"""The project's examples: plans with part scripts, in the checkout or as the installed package carries them."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from articad.errors import ReadError, did_you_mean

_CHECKOUT: Final = Path(__file__).parents[2] / "examples"  # else they lie beside this file, as the wheel carries them


def names() -> tuple[str, ...]:
    """Return the names of the examples."""
    return tuple(sorted(file.parent.name for file in _root().glob("*/plan.json")))


def folder(name: str) -> Path:
    """Return an example's folder: `plan.json` and `parts/`.

    Raises:
        ReadError: If there is no example of this name.
    """
    if name not in names():
        message = f"There is no example {name!r}.{did_you_mean(name, names())} There are {', '.join(names())}."
        raise ReadError.at(name, message, "Name one of these.", said=message)
    return _root() / name


def _root() -> Path:
    return _CHECKOUT if _CHECKOUT.is_dir() else Path(__file__).parent
