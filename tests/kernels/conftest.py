"""One kernel for all tests of this room: its zygote starts once."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from articad.kernels.build123d import Build123dKernel
from articad.kernels.kernel import BuiltPart
from articad.kernels.zygote import Zygote

Brief = dict[str, Any]
Build = Callable[..., BuiltPart]

HEAD = "from build123d import *\nfrom math import *\n\n\ndef build(part):\n    d = part.dimensions\n"


def kernel_of_its_own(**options: Any) -> Build123dKernel:
    """Return a kernel that shares its process with no other."""
    kernel = Build123dKernel(**options)
    kernel.__dict__["_zygote"] = zygote = Zygote(kernel._layers)
    zygote.users.add(kernel)
    return kernel


@pytest.fixture(scope="session")
def kernel() -> Iterator[Build123dKernel]:
    kernel = kernel_of_its_own(timeout=20.0)
    yield kernel
    kernel.close()


@pytest.fixture
def brief() -> Brief:
    return {
        "name": "lug",
        "description": "A lug.",
        "material": "steel",
        "envelope_mm": None,
        "dimensions": {},
        "connectors": {},
    }


@pytest.fixture
def build(kernel: Build123dKernel, brief: Brief, tmp_path: Path) -> Build:
    """Build the body of a `build(part)` that returns `(shape, connectors)`; keyword arguments go into the brief."""

    def run(
        body: str, *, probe: bool = False, deflection: float = 0.01, with_kernel: Build123dKernel | None = None, **changes: Any
    ) -> BuiltPart:
        folder = tmp_path / f"part{len(list(tmp_path.iterdir()))}"
        folder.mkdir()
        script = HEAD + "".join(f"    {line}\n" for line in body.splitlines())
        return (with_kernel or kernel).build(script.encode(), {**brief, **changes}, folder=folder, deflection=deflection, probe=probe)

    return run


def frame(o: tuple[float, float, float] = (0, 0, 0), joints: list[dict[str, Any]] | None = None) -> dict[str, Any]:
    return {"o": list(o), "z": [0.0, 0.0, 1.0], "x": [1.0, 0.0, 0.0], "label": "", "joints": joints or []}
