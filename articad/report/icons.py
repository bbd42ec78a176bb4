"""The page's icons: line drawings in a square of 24 units, in the colour of the text beside them."""

from __future__ import annotations

_CUBE = '<path d="M12 3l8 4.5v9L12 21l-8-4.5v-9zM4 7.5l8 4.5 8-4.5M12 12v9"/>'
_DRAWINGS = {
    "iso": _CUBE,
    "front": f'<path class="filled" d="M4 7.5l8 4.5v9l-8-4.5z"/>{_CUBE}',
    "right": f'<path class="filled" d="M20 7.5L12 12v9l8-4.5z"/>{_CUBE}',
    "top": f'<path class="filled" d="M12 3l8 4.5-8 4.5-8-4.5z"/>{_CUBE}',
    "parallel": '<path d="M3 9l6-5h12v11l-6 5H3zM3 9h12v11M15 9l6-5"/>',
    "axes": '<path d="M9 15V4M9 15h11M9 15l-5 5M6.5 6.5L9 4l2.5 2.5M17.5 12.5L20 15l-2.5 2.5"/>',
    "names": '<path d="M4 4h8l8.5 8.5-8 8L4 12z"/><circle cx="8.3" cy="8.3" r="1.4"/>',
    "measure": '<path d="M3 16L16 3l5 5L8 21zM7 12l2 2M10 9l2.6 2.6M13 6l2 2"/>',
    "reset": '<path d="M4.5 12a7.8 7.8 0 1 0 2.4-5.6L4 9M4 4v5h5"/>',
    "explode": '<path d="M9 9h6v6H9zM12 6V2M12 22v-4M6 12H2M22 12h-4M10 3.5L12 2l2 1.5M10 20.5l2 1.5 2-1.5"/>',
    "section": '<path class="filled" d="M4 7.5l8 4.5v9l-8-4.5z"/><path d="M4 7.5l8 4.5v9l-8-4.5zM4 7.5L12 3v9M12 3l8 4.5v9L12 21" />',
    "save": '<path d="M12 3v12M7 10.5l5 5 5-5M4 20h16"/>',
    "theme": '<circle cx="12" cy="12" r="8"/><path class="filled" d="M12 4a8 8 0 0 1 0 16z"/>',
}


def icon(name: str) -> str:
    """Return the element that draws an icon; screen readers pass over it."""
    return f'<svg class="icon" viewBox="0 0 24 24" aria-hidden="true">{_DRAWINGS[name]}</svg>'
