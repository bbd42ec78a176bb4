"""Selects a kernel by name."""

from __future__ import annotations

from typing import Literal

from articad.errors import KernelUnavailableError
from articad.findings import Finding
from articad.kernels.build123d import Build123dKernel
from articad.kernels.freecad import FreeCADKernel
from articad.kernels.kernel import PartKernel

__all__ = ["Sandbox", "kernel_named"]

Sandbox = Literal["strict", "weak"]


def kernel_named(name: str, *, sandbox: Sandbox = "strict") -> PartKernel:
    """Return the kernel of this name.

    Raises:
        KernelUnavailableError: If this version does not have it.
    """
    if name == "build123d":
        return Build123dKernel(sandbox=sandbox)
    if name == "freecad":
        kernel = FreeCADKernel(sandbox=sandbox)
        kernel.warm_up()
        return kernel
    message = f"This version cannot build parts with the kernel {name!r}; it has 'build123d' and 'freecad'."
    finding = Finding(
        code="E_KERNEL_UNAVAILABLE", where="kernel", message=message, hint="Use --kernel build123d, with scripts parts/<part>.py."
    )
    raise KernelUnavailableError(message, findings=[finding])
