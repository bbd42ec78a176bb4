"""Drawings of tasks: views of the reference solution with all the numbers that its checks hold it to, for tasks that are asked by pictures.

Four views on one sheet, the whole's measures as dimension lines, a letter at each kind of joint, and what the letters mean below.
"""

from __future__ import annotations

import io
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from string import ascii_uppercase
from typing import Final

import numpy as np
from PIL import Image, ImageDraw

from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.kinematics.joints import Joint, JointType
from articad.render.annotate import font
from articad.render.camera import Camera
from articad.render.raycast import cast
from articad.render.scene import DrawnMesh, DrawnScene, scene_of
from articad.render.shade import reduced, shade
from articad_bench.subject import Subject
from articad_bench.task import Drawing

DRAWING: Final = "drawing.png"
PANE: Final = 320  # pixels of a view's sides; there are two side by side
COLORS: Final = 16  # of the file: greys and two blues
_FINE: Final = 2  # rays per pixel, each way
_ROOM: Final = 1.30  # of a view, for dimension lines and letters
_LINE: Final = 17  # pixels of a line of text
_TEXT: Final = 13
_MARGIN: Final = 8
_COLUMNS: Final = 88  # characters of a line
_OFF: Final = 18.0  # pixels between an outline and its dimension line
_MARKS: Final = 2  # joints of each kind that get a letter: more would hide the product
_REACH: Final = 26.0  # pixels of an axis to each side
_RADIUS: Final = 8.0
_INK: Final = (24, 28, 34)
_BLUE: Final = (20, 70, 160)
_WHITE: Final = (255, 255, 255)
_GREY: Final = "#c4c7cb"
_SHADES: Final = ("#d3d6da", "#b9bdc3", "#e2e4e6", "#a6abb2", "#c8ccd1")  # neighbours in the plan's order differ
_ALONG: Final = {"front": ("x", "z"), "back": ("x", "z"), "right": ("y", "z"), "left": ("y", "z"), "top": ("x", "y"), "bottom": ("x", "y")}


@dataclass(frozen=True, eq=False)
class JointKind:
    """Joints that do the same: their letter, what they do, their names, where they are and along what."""

    letter: str
    words: str
    joints: tuple[str, ...]
    places: tuple[tuple[FloatArray, FloatArray], ...]


def draw_task(assembly: Assembly, form: Drawing) -> bytes:
    """Return a task's drawing as a PNG file, the same for the same assembly.

    Args:
        assembly: The reference solution.
        form: What is drawn of it and written below.
    """
    subject = Subject(assembly)
    kinds = kinds_of(subject) if form.legend else ()
    scene = _scene(subject)
    lines = legend(subject, kinds, form)
    rows = math.ceil(len(form.views) / 2)
    sheet = Image.new("RGB", (2 * PANE, rows * PANE + len(lines) * _LINE + 2 * _MARGIN), _WHITE)
    cameras = _cameras(scene, form.views)
    measured: set[str] = set()
    for index, (view, camera) in enumerate(zip(form.views, cameras, strict=True)):
        sheet.paste(_view(scene, view, camera, kinds, measured), (index % 2 * PANE, index // 2 * PANE))
    draw = ImageDraw.Draw(sheet)
    for row, line in enumerate(lines):
        draw.text((_MARGIN, rows * PANE + _MARGIN + row * _LINE), line, fill=_INK, font=font(_TEXT))
    stream = io.BytesIO()
    sheet.quantize(palette=_palette(), dither=Image.Dither.NONE).save(stream, format="PNG", optimize=True)
    return stream.getvalue()


def _palette() -> Image.Image:
    greys = [(level, level, level) for level in np.linspace(_INK[0], 255, COLORS - 2).round().astype(int).tolist()]
    paler = tuple((channel + 255) // 2 for channel in _BLUE)
    palette = Image.new("P", (1, 1))
    palette.putpalette([channel for color in (*greys, _BLUE, paler) for channel in color])
    return palette


def _scene(subject: Subject) -> DrawnScene:
    scene = scene_of(subject.assembly.parts, subject.rest)
    order = {name: index for index, name in enumerate(dict.fromkeys(item.name for item in scene.items))}
    return DrawnScene(
        tuple(DrawnMesh(item.name, item.mesh, item.T_ground, _SHADES[order[item.name] % len(_SHADES)]) for item in scene.items)
    )


def _cameras(scene: DrawnScene, views: Sequence[str]) -> list[Camera]:
    """Return the views' cameras; those straight on have one scale."""
    cameras = [Camera.fit(view, scene.bounds, width=PANE, height=PANE) for view in views]
    straight = max((camera.mm_per_pixel for view, camera in zip(views, cameras, strict=True) if view in _ALONG), default=1.0)
    scales = [straight if view in _ALONG else camera.mm_per_pixel for view, camera in zip(views, cameras, strict=True)]
    return [
        Camera(camera.eye, camera.right, camera.up, camera.centre, scale * _ROOM, PANE, PANE)
        for camera, scale in zip(cameras, scales, strict=True)
    ]


def _view(scene: DrawnScene, view: str, camera: Camera, kinds: Sequence[JointKind], measured: set[str]) -> Image.Image:
    fine = camera.scaled(_FINE)
    image = Image.fromarray(reduced(shade(scene, fine, cast(scene, fine)), _FINE))
    draw = ImageDraw.Draw(image)
    if view in _ALONG:
        _dimensions(draw, scene.bounds, view, camera, measured)
    else:
        _letters(draw, camera, kinds)
        _triad(draw, camera)
    draw.text((_MARGIN, 4), view, fill=_INK, font=font(11))
    return image


# ---------------------------------------------------------------------- the whole's measures


def _dimensions(draw: ImageDraw.ImageDraw, bounds: FloatArray, view: str, camera: Camera, measured: set[str]) -> None:
    """Draw a dimension line for each side that no other view has shown yet."""
    corners = camera.project(bounds)
    left, right = sorted(corners[:, 0])
    top, bottom = sorted(corners[:, 1])
    across, upward = _ALONG[view]
    if across not in measured:
        measured.add(across)
        _dimension(draw, (left, bottom), (right, bottom), (0.0, _OFF), _side(bounds, across))
    if upward not in measured:
        measured.add(upward)
        _dimension(draw, (left, top), (left, bottom), (-_OFF, 0.0), _side(bounds, upward))


def _side(bounds: FloatArray, axis: str) -> str:
    return f"{_number(float(np.ptp(bounds[:, 'xyz'.index(axis)])))}"


def _dimension(draw: ImageDraw.ImageDraw, a: tuple[float, float], b: tuple[float, float], off: tuple[float, float], text: str) -> None:
    start, end = np.array(a) + off, np.array(b) + off
    for outline, foot in ((a, start), (b, end)):
        draw.line([*outline, *(foot + 0.25 * np.array(off))], fill=_BLUE, width=1)
    draw.line([*start, *end], fill=_BLUE, width=1)
    along = (end - start) / max(float(np.linalg.norm(end - start)), 1e-9)
    for tip, unit in ((start, along), (end, -along)):
        _head(draw, tip, unit)
    box = draw.textbbox((0, 0), text, font=font(_TEXT))
    width, height = box[2] - box[0], box[3] - box[1]
    middle = (start + end) / 2 + np.sign(off) * 4
    x = middle[0] - (width / 2 if off[0] == 0 else width)
    y = middle[1] if off[0] == 0 else middle[1] - height
    draw.text((max(float(x), 1.0), float(y)), text, fill=_BLUE, font=font(_TEXT), stroke_width=2, stroke_fill=_WHITE)


def _head(draw: ImageDraw.ImageDraw, tip: FloatArray, unit: FloatArray) -> None:
    across = np.array([-unit[1], unit[0]])
    draw.polygon([tuple(tip), tuple(tip + 8 * unit + 2.5 * across), tuple(tip + 8 * unit - 2.5 * across)], fill=_BLUE)


# ---------------------------------------------------------------------- joints


def kinds_of(subject: Subject) -> tuple[JointKind, ...]:
    """Return what joints that move do, each kind with its letter."""
    drivers = {driver.joint for driver in subject.assembly.drivers}
    coupled = {coupling.b.split(".")[0] for coupling in subject.assembly.mechanism.couplings}
    found: dict[str, list[Joint]] = {}
    for joint in subject.assembly.joints:
        if joint.type is not JointType.FIXED:
            words = _range_of(subject, joint) if joint.name in drivers else _FOLLOWS[joint.type].format(axis=_axis(subject, joint))
            how = "" if joint.name in drivers else "; is coupled" if joint.name in coupled else "; follows the others"
            found.setdefault(words + how, []).append(joint)
    return tuple(
        JointKind(letter, words, tuple(joint.name for joint in joints), tuple(_place(subject, joint) for joint in joints))
        for letter, (words, joints) in zip(ascii_uppercase, found.items(), strict=False)
    )


def _place(subject: Subject, joint: Joint) -> tuple[FloatArray, FloatArray]:
    return (subject.rest[joint.parent] @ joint.T_parent_connector).translation, subject.axis(joint)


def _axis(subject: Subject, joint: Joint) -> str:
    direction = np.abs(subject.axis(joint))
    return "xyz"[int(direction.argmax())] if direction.max() > math.cos(math.radians(1)) else "a slanted axis"


def _range_of(subject: Subject, joint: Joint) -> str:
    """Return what a driving joint does, and how far."""
    axis, limits, kind = _axis(subject, joint), joint.limits, joint.type
    widths = zip(kind.coordinates, kind.units, limits.lower, limits.upper, strict=False)
    spans = {name: _span(high - low, unit) for name, unit, low, high in widths}
    cone = "" if limits.cone is None else f", tilts {_number(math.degrees(limits.cone))}° to every side"
    twist = "" if limits.twist is None else f", twists {_span(limits.twist[1] - limits.twist[0], 'rad')}"
    pitch = f"{abs(joint.lead):.4g} mm a turn"  # of a thread, hundredths count
    return _DOES[kind].format(axis=axis, cone=cone, twist=twist, pitch=pitch, **spans)


_DOES: Final = {
    JointType.REVOLUTE: "turns {angle} about {axis}",
    JointType.SLIDER: "slides {travel} along {axis}",
    JointType.CYLINDRICAL: "slides {travel} along {axis} and turns {angle} about it",
    JointType.SCREW: "screw along {axis}, {pitch}, turns {angle}",
    JointType.PLANAR: "slides on a plane square to {axis}, {x} by {y}, and turns {angle}",
    JointType.UNIVERSAL: "universal joint, bends {a} one way and {b} the other",
    JointType.BALL: "ball joint{cone}{twist}",
}
_FOLLOWS: Final = {
    JointType.REVOLUTE: "pin along {axis}",
    JointType.SLIDER: "slide along {axis}",
    JointType.CYLINDRICAL: "sleeve along {axis}, slides and turns",
    JointType.SCREW: "screw along {axis}",
    JointType.PLANAR: "plane square to {axis}",
    JointType.UNIVERSAL: "universal joint",
    JointType.BALL: "ball joint",
}


def _span(width: float, unit: str) -> str:
    if math.isinf(width):
        return "without end" if unit == "rad" else "freely"
    return f"{_number(math.degrees(width))}°" if unit == "rad" else f"{_number(width)} mm"


def _letters(draw: ImageDraw.ImageDraw, camera: Camera, kinds: Sequence[JointKind]) -> None:
    """Draw the axes of a few joints of each kind, with the kind's letter."""
    taken: list[FloatArray] = []
    for kind in kinds:
        for point, axis in kind.places[:_MARKS]:
            _letter(draw, kind.letter, point, axis, camera, taken)


def _letter(draw: ImageDraw.ImageDraw, letter: str, point: FloatArray, axis: FloatArray, camera: Camera, taken: list[FloatArray]) -> None:
    at = camera.project(point[None])[0]
    flat = np.array([axis @ camera.right, -(axis @ camera.up)])
    flat = flat / max(float(np.linalg.norm(flat)), 1e-9) * _REACH
    draw.line([*(at - flat), *(at + flat)], fill=_BLUE, width=2)
    tip = at + 1.3 * flat
    for _ in range(8):  # out of the way of another letter
        if all(float(np.linalg.norm(tip - other)) > 2 * _RADIUS for other in taken):
            break
        tip = tip + 0.7 * flat
    tip = np.clip(tip, _RADIUS + 1, PANE - _RADIUS - 1)
    taken.append(tip)
    draw.line([*(at + flat), *tip], fill=_BLUE, width=1)
    draw.ellipse((*(tip - _RADIUS), *(tip + _RADIUS)), fill=_WHITE, outline=_BLUE)
    draw.text(tuple(tip), letter, fill=_BLUE, font=font(_TEXT), anchor="mm")


def _triad(draw: ImageDraw.ImageDraw, camera: Camera) -> None:
    origin = np.array([34.0, PANE - 34.0])
    for index, name in enumerate("xyz"):
        axis = np.eye(3)[index]
        end = origin + 22 * np.array([axis @ camera.right, -(axis @ camera.up)])
        draw.line([*origin, *end], fill=_INK, width=1)
        draw.text(tuple(origin + 1.35 * (end - origin)), name, fill=_INK, font=font(11), anchor="mm")


# ---------------------------------------------------------------------- what is written


def legend(subject: Subject, kinds: Sequence[JointKind], form: Drawing) -> list[str]:
    """Return the lines that are written below a drawing."""
    sides = " x ".join(_number(float(side)) for side in subject.size)
    said = [f"{sides} mm (x, y, z), {len(subject.shaped)} parts." if len(subject.shaped) > 1 else f"{sides} mm (x, y, z), one part."]
    said += motion_lines(subject, kinds)
    said += [f"{name.replace('_', ' ')}: {' x '.join(_number(float(side)) for side in subject.extents(name))} mm" for name in form.parts]
    return [line for text in (*said, *form.notes) for line in _wrapped(text)]


def motion_lines(subject: Subject, kinds: Sequence[JointKind]) -> list[str]:
    """Return what the joints do and how far, and what they are coupled to, a line for each kind."""
    said = [f"{kind.letter}: {f'{len(kind.joints)} x ' if len(kind.joints) > 1 else ''}{kind.words}" for kind in kinds]
    return [*said, *(dict.fromkeys(_couplings(subject, kinds)) if kinds else ())]


def _couplings(subject: Subject, kinds: Sequence[JointKind]) -> Iterator[str]:
    letters = {name: kind.letter for kind in kinds for name in kind.joints}
    joints = {joint.name: joint for joint in subject.assembly.joints}
    for coupling in subject.assembly.mechanism.couplings:
        a, b = (column.split(".")[0] for column in (coupling.a, coupling.b))
        lead, follow = letters.get(a, a), letters.get(b, b)
        slides = [subject.per_unit(joints[name]) == 1.0 for name in (a, b)]
        ratio = abs(coupling.ratio)
        if slides == [False, True]:
            yield f"{follow} slides {_number(ratio * math.tau)} mm for each turn of {lead}"
        elif slides == [True, False]:
            yield f"{follow} turns {_number(math.degrees(ratio))}° for each mm of {lead}"
        else:
            yield f"{follow} moves {_number(ratio)} times as far as {lead}"


def _wrapped(text: str) -> Iterator[str]:
    line = ""
    for word in text.split():
        if line and len(line) + 1 + len(word) > _COLUMNS:
            yield line
            line = f"    {word}"
        else:
            line = f"{line} {word}".strip() if not line.startswith("    ") else f"{line} {word}"
    yield line


def _number(value: float) -> str:
    return f"{round(value, 1):g}" if abs(value) >= 1 else f"{value:.3g}"
