"""Pictures for models: what a failed script had made, drawn so that its author can see where it went wrong."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Final

from articad.agents.llm import Image
from articad.connectors.se3 import SE3
from articad.kernels.results import PoisonedError, read_mesh

VIEWS: Final = ("iso", "front", "right", "top")
SIZE: Final = 320  # pixels of each view: a feature of a hundredth of the part is still seen
_COLOR = "#c8a46e"
_MESH = "part.npz"


def partial_picture(folder: Path | None, name: str, build: str) -> Image | None:
    """Draw the solids that a failed script had made, from four sides.

    Args:
        folder: Where the kernel left them; None if there were none.
        name: The part.
        build: Digest of the build that failed: with the views it is the picture's recipe.

    Returns:
        One sheet, or None if there is nothing to be seen.
    """
    from articad.render.camera import Camera  # noqa: PLC0415 - pictures are drawn when something failed, and not before
    from articad.render.pictures import RECIPE, contact_sheet, picture  # noqa: PLC0415 - the same
    from articad.render.scene import Item, Scene  # noqa: PLC0415 - the same

    if folder is None:
        return None
    try:
        mesh = read_mesh((folder / _MESH).read_bytes())
    except (OSError, PoisonedError):
        return None
    scene = Scene((Item(name, mesh, SE3.identity(), _COLOR),))
    views = [picture(scene, Camera.fit(view, scene.bounds, width=SIZE, height=SIZE), labels=False, title=view) for view in VIEWS]
    stream = io.BytesIO()
    contact_sheet(views, 2).save(stream, "PNG")
    return Image(stream.getvalue(), recipe={"recipe": RECIPE, "of": "partial", "build": build, "views": list(VIEWS), "size": SIZE})
