"""The pictures that a task is asked by, in the form that it states: one overview, dimensioned sheets, or photos."""

from __future__ import annotations

import io
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from articad.assembly import Assembly
from articad.kernels.views import View
from articad.papers.drawing import drawings_of
from articad.papers.raster import sheet_png
from articad.render import render_clean
from articad.render.pictures import driver_range
from articad_bench.drawing import DRAWING, JointKind, draw_task, kinds_of, motion_lines
from articad_bench.subject import Subject
from articad_bench.task import Drawing, Task

__all__ = ["PHOTO_VIEWS", "SHEET_PIXELS", "is_drawn", "pictures_of"]

SHEET_PIXELS: Final = 1568  # of the longer side: what most models see of a picture without reducing it
PHOTO_PIXELS: Final = (640, 480)
PHOTO_VIEWS: Final = ("front", "right", "iso_back", "iso_left")
_QUALITY: Final = 85
_AXES: Final = "At rest; x to the lower right, y to the upper right, z up. Lengths in mm."
_MODELLED: Final = "Fitted diameters are modelled within their limits."
_SECTIONS: Final = {"x": ((0.0, -1.0, 0.0), (0.0, 0.0, 1.0), -1.0), "y": ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), -1.0)}


def pictures_of(assembly: Assembly, form: Drawing) -> dict[str, bytes]:
    """Return a task's pictures by the names of their files, the same for the same assembly.

    Args:
        assembly: The reference solution.
        form: What is drawn of it, and how.
    """
    if form.form == "sheets":
        return {f"sheet_{number}.png": picture for number, picture in enumerate(_sheets(assembly, form), start=1)}
    if form.form == "photos":
        return {f"photo_{number}.jpg": picture for number, picture in enumerate(_photos(assembly, form), start=1)}
    return {DRAWING: draw_task(assembly, form)}


def is_drawn(task: Task) -> bool:
    """Return whether a task's pictures are those that `pictures_of` makes, and not pictures that somebody put there."""
    first = {"overview": DRAWING, "sheets": "sheet_1.png", "photos": "photo_1.jpg"}
    return task.drawing is not None and first[task.drawing.form] in task.images


def _sheets(assembly: Assembly, form: Drawing) -> Iterator[bytes]:
    """Yield the sheet of the assembly, with what its joints do, then one of each part; one sheet alone for a product of one part."""
    subject = Subject(assembly)
    if len(subject.shaped) == 1:
        pages = drawings_of(assembly, subject.shaped[0])
    else:
        fitted = [_MODELLED] if any(fit.name for fit in assembly.fits.values()) else []
        notes = [*motion_lines(subject, _named(subject)), *form.notes, *fitted, _AXES]
        pages = drawings_of(assembly, notes=notes, section=_section(form))
    yield from (sheet_png(page, SHEET_PIXELS) for page in pages)


def _named(subject: Subject) -> list[JointKind]:
    """Return what joints do, with the names of their parts, which the sheets show in place of letters."""
    joints = {joint.name: joint for joint in subject.assembly.joints}
    named = []
    for kind in kinds_of(subject):
        ends = [joints[name] for name in kind.joints]
        on = " and ".join(dict.fromkeys(joint.parent for joint in ends))
        named.append(replace(kind, words=f"{' and '.join(joint.child for joint in ends)} on {on}: {kind.words}"))
    return named


def _section(form: Drawing) -> View | None:
    if form.section is None:
        return None
    axis, at = form.section
    right, up, towards = _SECTIONS[axis]
    return View(f"Section at {axis} = {at:g}", right, up, cut=towards * at)


def _photos(assembly: Assembly, form: Drawing) -> Iterator[bytes]:
    """Yield the product at rest from three sides, and from a fourth with its drivers on their way."""
    moved = np.array(assembly.mechanism.rest)
    for column, driver in enumerate(assembly.drivers):
        if form.moved and driver.unit != "1":
            low, high = driver_range(assembly, driver)
            ends = [end for end in (low, high) if np.isfinite(end)] or [1.0]
            moved[column] += form.moved * (max(ends, key=lambda end: abs(end - moved[column])) - moved[column])
    for view in PHOTO_VIEWS:
        q = moved if view == PHOTO_VIEWS[-1] else None
        stream = io.BytesIO()
        render_clean(assembly, (view,), q=q, size=PHOTO_PIXELS)[view].convert("RGB").save(stream, format="JPEG", quality=_QUALITY)
        yield stream.getvalue()
