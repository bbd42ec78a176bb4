"""Pictures of parts, poses and motion, without display, GPU or OpenGL."""

from articad.render.camera import VIEWS, Camera
from articad.render.pictures import (
    before_after,
    best_view,
    clean_frames,
    clean_motion,
    contact_sheet,
    filmstrip,
    motion_frames,
    motion_gif,
    picture,
    png,
    product_sheet,
    render_clean,
    render_motion,
    render_part,
    render_views,
)
from articad.render.raycast import Buffers, cast
from articad.render.scene import DrawnMesh, DrawnScene, Section

__all__ = [
    "VIEWS",
    "Buffers",
    "Camera",
    "DrawnMesh",
    "DrawnScene",
    "Section",
    "before_after",
    "best_view",
    "cast",
    "clean_frames",
    "clean_motion",
    "contact_sheet",
    "filmstrip",
    "motion_frames",
    "motion_gif",
    "picture",
    "png",
    "product_sheet",
    "render_clean",
    "render_motion",
    "render_part",
    "render_views",
]
