"""Camera: parallel projection, as on a drawing."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from articad.arrays import FloatArray

# Direction to the eye, and the up direction of the picture. X right, Y back, Z up: "front" looks along +Y.
VIEWS: dict[str, tuple[tuple[float, float, float], tuple[float, float, float]]] = {
    "iso": ((1.0, -1.4, 0.9), (0.0, 0.0, 1.0)),
    "iso_left": ((-1.0, -1.4, 0.9), (0.0, 0.0, 1.0)),
    "iso_back": ((1.0, 1.4, 0.9), (0.0, 0.0, 1.0)),
    "iso_back_left": ((-1.0, 1.4, 0.9), (0.0, 0.0, 1.0)),
    "iso_below": ((1.0, -1.4, -0.9), (0.0, 0.0, 1.0)),
    "iso_below_left": ((-1.0, -1.4, -0.9), (0.0, 0.0, 1.0)),
    "front": ((0.0, -1.0, 0.0), (0.0, 0.0, 1.0)),
    "back": ((0.0, 1.0, 0.0), (0.0, 0.0, 1.0)),
    "left": ((-1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "right": ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
    "top": ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0)),
    "bottom": ((0.0, 0.0, -1.0), (0.0, -1.0, 0.0)),
}
_MARGIN = 1.12  # of the silhouette's box, so that labels have room


@dataclass(frozen=True, eq=False)
class Camera:
    """Parallel rays through the centres of square pixels.

    Attributes:
        eye: Unit vector from the scene to the viewer, `(3,)`.
        right: Direction of increasing columns, `(3,)`.
        up: Direction of decreasing rows, `(3,)`.
        centre: Point in the middle of the picture [mm], `(3,)`.
        mm_per_pixel: Scale.
        width: Columns.
        height: Rows.
    """

    eye: FloatArray
    right: FloatArray
    up: FloatArray
    centre: FloatArray
    mm_per_pixel: float
    width: int
    height: int

    @classmethod
    def fit(cls, view: str, bounds: ArrayLike, *, width: int = 512, height: int = 512) -> Camera:
        """Return the camera of a named view that shows a whole box.

        Args:
            view: A key of `VIEWS`.
            bounds: Smallest and largest coordinates [mm], `(2, 3)`.
            width: Columns.
            height: Rows.

        Raises:
            ValueError: If there is no such view.
        """
        if view not in VIEWS:
            raise ValueError(f"No view {view!r}; there are {', '.join(VIEWS)}.")
        toward, upward = (np.array(axis) for axis in VIEWS[view])
        eye = toward / np.linalg.norm(toward)
        right = np.cross(upward, eye)
        right /= np.linalg.norm(right)
        up = np.cross(eye, right)
        lower, upper = np.asarray(bounds, dtype=np.float64)
        corners = np.array([[x, y, z] for x in (lower[0], upper[0]) for y in (lower[1], upper[1]) for z in (lower[2], upper[2])])
        centre = (lower + upper) / 2
        span_x, span_y = np.ptp(corners @ right), np.ptp(corners @ up)
        scale = max(span_x / width, span_y / height, 1e-6 / width) * _MARGIN
        return cls(eye, right, up, centre, float(scale), width, height)

    def scaled(self, factor: int) -> Camera:
        """Return the same picture with `factor` times as many pixels in each direction."""
        return Camera(self.eye, self.right, self.up, self.centre, self.mm_per_pixel / factor, self.width * factor, self.height * factor)

    def widened(self, columns: int) -> Camera:
        """Return the same picture with `columns` more pixels on both sides."""
        return replace(self, width=self.width + 2 * columns)

    def project(self, points: ArrayLike) -> FloatArray:
        """Return column and row [pixels, from the upper left corner] of points `(n, 3)`, as `(n, 2)`."""
        offset = np.asarray(points, dtype=np.float64) - self.centre
        columns = offset @ self.right / self.mm_per_pixel + self.width / 2
        rows = -(offset @ self.up) / self.mm_per_pixel + self.height / 2
        return np.stack([columns, rows], axis=-1)

    def plane_points(self, rows: slice = slice(None), columns: slice = slice(None)) -> FloatArray:
        """Return the points where the pixels' rays pass the picture plane through `centre`, relative to `centre`.

        Args:
            rows: Rows of the picture; all by default.
            columns: Columns of the picture; all by default.

        Returns:
            Row by row, `(rows * columns, 3)` [mm].
        """
        x = ((np.arange(self.width) + 0.5 - self.width / 2) * self.mm_per_pixel)[columns]
        y = (-(np.arange(self.height) + 0.5 - self.height / 2) * self.mm_per_pixel)[rows]
        grid = x[None, :, None] * self.right + y[:, None, None] * self.up
        return grid.reshape(-1, 3)
