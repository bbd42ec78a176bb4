"""Views of built solids, drawn by the confined worker: visible and hidden edges, sections, and what dimensions measure."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from articad.aliases import Json
from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.errors import KernelError
from articad.files import RECORD_BYTES, read_file
from articad.kernels.build123d import Build123dKernel
from articad.kernels.results import MAX_MM, PoisonedError, read_bytes
from articad.kernels.zygote import ends_by

__all__ = ["Arc", "DrawnView", "Features", "Path2d", "Segment", "View", "ViewKernel"]

SECONDS: Final = 240.0  # wall clock of all views of one sheet
_MOST = 400_000  # lines of a view


class Segment(NamedTuple):
    """A straight line on paper."""

    x0: float
    y0: float
    x1: float
    y1: float


class Arc(NamedTuple):
    """An arc or a circle on paper, counterclockwise, in degrees."""

    x: float
    y: float
    radius: float
    start: float
    end: float


class Path2d(NamedTuple):
    """A curve on paper through points `(N, 2)`."""

    points: FloatArray


Line = Segment | Arc | Path2d


@dataclass(frozen=True)
class View:
    """A parallel projection.

    Attributes:
        name: Its name.
        right: Direction that points right on the paper, `(3,)`, a unit vector.
        up: Direction that points up.
        hidden: Whether hidden edges are wanted.
        cut: Distance of the plane of a section from the origin, towards the eye [mm]; None for no section.
    """

    name: str
    right: tuple[float, float, float]
    up: tuple[float, float, float]
    hidden: bool = False
    cut: float | None = None


@dataclass(frozen=True, eq=False)
class DrawnView:
    """The lines of a view [mm], from the image of the origin.

    Attributes:
        name: Of the view.
        visible: Visible edges and outlines.
        hidden: Hidden ones, if they were wanted.
        cut: Of each face in the plane of a section, its closed outlines.
    """

    name: str
    visible: tuple[Line, ...]
    hidden: tuple[Line, ...] = ()
    cut: tuple[tuple[FloatArray, ...], ...] = ()


@dataclass(frozen=True, eq=False)
class Features:
    """What dimensions measure.

    Attributes:
        straight: Ends of straight edges, `(N, 2, 3)` [mm].
        circles: Centre, axis, radius and angle of circular edges, `(N, 8)` [mm, rad].
        spheres: Centre and radius of spherical faces, `(N, 4)` [mm].
    """

    straight: FloatArray = field(default_factory=lambda: np.zeros((0, 2, 3)))
    circles: FloatArray = field(default_factory=lambda: np.zeros((0, 8)))
    spheres: FloatArray = field(default_factory=lambda: np.zeros((0, 4)))


class ViewKernel(Build123dKernel):
    """Projects B-reps in the confined worker."""

    def project(self, shapes: Sequence[tuple[Path, SE3]], views: Sequence[View]) -> tuple[dict[str, DrawnView], Features]:
        """Return views of shapes.

        Args:
            shapes: Files of B-reps, and the poses of their frames in the frame of the views.
            views: What to draw.

        Raises:
            KernelError: If the kernel fails, or does not end in time.
        """
        self._require_sandbox()
        contents = [read_file(path, RECORD_BYTES) for path, _ in shapes]
        request = {
            "lengths": [len(content) for content in contents],
            "matrices": [T.matrix.tolist() for _, T in shapes],
            "views": [
                {"name": view.name, "right": list(view.right), "up": list(view.up), "hidden": view.hidden, "cut": view.cut}
                for view in views
            ],
        }
        try:
            with self.job_folder() as job:
                (job / "shape.bin").write_bytes(b"".join(contents))
                limits = replace(self.limits, seconds=max(self.limits.seconds, SECONDS), probe_seconds=0.0)
                ran = self._run("project", job, request, {"shape": "shape.bin", "lines": "lines.json"}, limits)
                if not ran.report or ran.report[0].get("ok") is not True:
                    why = "it did not end in time" if ran.outcome.late else ends_by(ran.outcome) or ran.crash or "it said nothing"
                    raise KernelError(f"The kernel cannot project {', '.join(view.name for view in views)}: {why[:200]}.")
                found = json.loads(read_bytes(job / "lines.json"))
            return {row["name"]: _view(row) for row in found["views"]}, _features(found["features"])
        except (PoisonedError, KeyError, TypeError, ValueError, IndexError) as error:
            raise KernelError(f"The kernel's views are not of the expected form: {error}") from error


def _view(row: Json) -> DrawnView:
    visible, hidden = (tuple(_line(line) for line in row[key][:_MOST]) for key in ("visible", "hidden"))
    cut = tuple(tuple(_numbers(loop).reshape(-1, 2) for loop in face) for face in row["cut"])
    return DrawnView(str(row["name"]), visible, hidden, cut)


def _line(row: list[Any]) -> Line:
    kind, *rest = row
    if kind == "path":
        return Path2d(_numbers(rest[0]).reshape(-1, 2))
    values = _numbers(rest).tolist()
    if kind == "line":
        return Segment(*values)
    return Arc(*values)


def _features(row: Json) -> Features:
    return Features(
        *(_numbers(row[kind]).reshape(shape) for kind, shape in (("straight", (-1, 2, 3)), ("circles", (-1, 8)), ("spheres", (-1, 4))))
    )


def _numbers(value: Any) -> FloatArray:
    array = np.array(value, dtype=np.float64)
    if not np.isfinite(array).all() or (array.size and np.abs(array).max() > MAX_MM):
        raise PoisonedError("a coordinate is not a number")
    return array
