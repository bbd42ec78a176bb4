"""What is exported: the product, without the environment that it is checked against."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Concatenate, ParamSpec, TypeVar

from articad.export.once import once

if TYPE_CHECKING:
    from articad.assembly import Assembly

_Options = ParamSpec("_Options")
_Written = TypeVar("_Written")


def of_the_product(write: Callable[Concatenate[Assembly, _Options], _Written]) -> Callable[Concatenate[Assembly, _Options], _Written]:
    """Let a writer see the product alone: parts with `"environment": true`, and the joints that fix them, are left out."""

    @wraps(write)
    def written(assembly: Assembly, /, *arguments: _Options.args, **options: _Options.kwargs) -> _Written:
        return write(once(assembly, "product", assembly.product) if assembly.environment else assembly, *arguments, **options)

    return written
