"""Pictures of assemblies and parts: views, motion keyframes, sheets, filmstrips, animations."""

from __future__ import annotations

import io
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import numpy as np
from PIL import Image

from articad.arrays import FloatArray
from articad.connectors.se3 import SE3
from articad.errors import KernelUnavailableError, UnknownJointError
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part
from articad.interference.explosion import exploded
from articad.interference.overlap_meshes import overlap_meshes
from articad.kinematics.joints import Coordinate, Joint, JointType
from articad.render import vtk
from articad.render.annotate import Labels, annotate, room_beside
from articad.render.camera import VIEWS, Camera
from articad.render.raycast import cast
from articad.render.scene import DrawnScene, Section, scene_of
from articad.render.shade import PAPER, overlaid, reduced, shade
from articad.render.shade import Picture as Pixels
from articad.render.sight import cleared, of_glass, sights, with_hands
from articad.render.studio import framed, studio

if TYPE_CHECKING:
    from articad.assembly import Assembly

Renderer = Literal["embree", "pyvista"]

RECIPE = "articad.picture/4"  # changes when the same scene would be drawn differently; part of a model request's key
DEFAULT_VIEWS = ("iso", "front", "right", "top")
DEFAULT_SIZE = 512
MOTION_VIEWS = ("iso", "iso_left", "front", "right", "top", "iso_back", "iso_below")
FRAMES = 8
_PROBE_SIZE = 96  # pixels of the pictures that serve to choose a view
_FREE_TRAVEL = 0.1  # of the assembly's size: range shown of a travel without limits
_MOST_MOTIONS = 14  # of a sheet
_SHEET_FRAMES = 5  # two of which are shown: first and last, or the first quarter if it turns more than half a turn
_SHEET_COLUMNS = 4
_NEAR = 0.3  # of the assembly's size: smaller moving parts are shown close up…
_CONTEXT = 1.5  # …with this share of their own size around them
_BETWEEN = (226, 228, 231)
_GAP = 6  # pixels between the pictures of a sheet
_GIF_MILLISECONDS = 60
_GLASS = 0.4  # opacity of parts of glass
_JUDGED = 12  # frames of a motion, at most, that are judged by pixels
_NAMED = 2  # parts of glass that a title names
_FINE = 0.1  # pixels: deviation of the meshes of clean pictures


def picture(
    scene: DrawnScene,
    camera: Camera,
    *,
    supersample: int = 2,
    labels: Labels = True,
    axes: bool = True,
    title: str | None = None,
    renderer: Renderer = "embree",
) -> Image.Image:
    """Draw a scene.

    Args:
        scene: What to draw.
        camera: The camera.
        supersample: Rays per pixel in each direction; 1 is fastest.
        labels: Write the parts' names; "aside": in columns beside the picture.
        axes: Draw the joints' axes with the direction of positive motion.
        title: Written in the upper left corner.
        renderer: "embree" works everywhere and always gives the same pixels; "pyvista" is smoother, if it is available.

    Raises:
        KernelUnavailableError: If PyVista was requested and cannot draw here.
    """
    if renderer == "pyvista":
        _require_pyvista()
        buffers = cast(scene, camera)
        image = Image.fromarray(overlaid(vtk.draw(scene, camera), scene, buffers))
        return annotate(image, scene, camera, buffers, labels=labels, axes=axes, title=title)
    fine = camera.scaled(supersample)
    buffers = cast(scene, fine)
    image = Image.fromarray(reduced(_through_glass(scene, fine, shade(scene, fine, buffers)), supersample))
    return annotate(image, scene, camera, buffers, labels=labels, axes=axes, title=title)


def _through_glass(scene: DrawnScene, camera: Camera, behind: Pixels) -> Pixels:
    """Return a picture with the scene's glass before it, `(height, width, 3)`."""
    if all(item.manner != "glass" for item in scene.items):
        return behind
    full = replace(scene, items=tuple(replace(item, manner="faded") if item.manner == "glass" else item for item in scene.items))
    before = shade(full, camera, cast(full, camera)).astype(np.float64)
    mixed: Pixels = np.rint(behind + _GLASS * (before - behind)).astype(np.uint8)
    return mixed


def printed(scene: DrawnScene, camera: Camera) -> bytes:
    """Return a picture without labels on white paper, as PNG with few colours."""
    fine = camera.scaled(2)
    pixels = reduced(shade(scene, fine, cast(scene, fine)), 2).astype(np.float64) * (255.0 / PAPER.min())
    stream = io.BytesIO()
    image = Image.fromarray(np.clip(np.rint(pixels), 0, 255).astype(np.uint8))
    image.quantize(128, dither=Image.Dither.NONE).save(stream, "PNG", optimize=True)
    return stream.getvalue()


def render_views(
    assembly: Assembly,
    views: Sequence[str] = DEFAULT_VIEWS,
    *,
    q: FloatArray | None = None,
    size: int = DEFAULT_SIZE,
    only: Sequence[str] | None = None,
    section: str | Section | None = None,
    explode: float = 0.0,
    highlights: Sequence[TriMesh] = (),
    show_overlaps: bool = False,
    supersample: int = 2,
    labels: Labels = True,
    axes: bool = True,
    renderer: Renderer = "embree",
    glass: bool = False,
) -> dict[str, Image.Image]:
    """Draw one pose of an assembly from several sides, at one scale.

    Args:
        assembly: What to draw.
        views: Keys of `articad.render.VIEWS`.
        q: Configuration; the rest pose by default.
        size: Width and height of each picture [pixels].
        only: Parts shown in full; the others are faded.
        section: A cutting plane, or its short form such as `x` or `-y=12.5`.
        explode: How far each part is moved out of its carrier along their joint; at 1, all parts are free of each other.
        highlights: Meshes in the ground frame drawn over everything.
        show_overlaps: Draw common volumes of parts in red, over everything.
        supersample: Rays per pixel in each direction.
        labels: Write the parts' names; "aside": in columns beside the picture.
        axes: Draw the joints' axes.
        renderer: As in `picture`.
        glass: Draw the parts that are not in `only` as glass, which hides nothing.
    """
    scene = _prepared(assembly, q=q, only=only, section=section, explode=explode, highlights=highlights, show_overlaps=show_overlaps)
    if glass:
        scene = of_glass([scene], [item.name for item in scene.items if item.manner == "faded"])[0]
    beside = room_beside(scene) if labels == "aside" else 0
    return {
        view: picture(
            scene,
            Camera.fit(view, scene.bounds, width=size, height=size).widened(beside),
            supersample=supersample,
            labels=labels,
            axes=axes,
            title=f"{assembly.name} · {view}",
            renderer=renderer,
        )
        for view in views
    }


def render_clean(
    assembly: Assembly,
    views: Sequence[str] = DEFAULT_VIEWS,
    *,
    q: FloatArray | None = None,
    size: tuple[int, int] = (DEFAULT_SIZE, DEFAULT_SIZE),
    only: Sequence[str] | None = None,
    section: str | Section | None = None,
    explode: float = 0.0,
    show_overlaps: bool = False,
    transparent: bool = False,
) -> dict[str, Image.Image]:
    """Draw product pictures: declared materials under soft light, on the ground, without labels.

    Args:
        assembly: What to draw.
        views: Keys of `articad.render.VIEWS`; each is framed by itself.
        q: Configuration; the rest pose by default.
        size: Width and height of each picture [pixels].
        only: Parts shown in full; the others are faded.
        section: As in `render_views`.
        explode: As in `render_views`.
        show_overlaps: Draw common volumes of parts in red, over everything.
        transparent: Leave out the background; the shadow stays, as a translucent dark.

    Returns:
        RGB pictures by view, RGBA if they are transparent.
    """
    scene = _prepared(assembly, q=q, only=only, section=section, explode=explode, show_overlaps=show_overlaps)
    pictures = {}
    for view in views:
        camera = framed(scene, Camera.fit(view, scene.bounds, width=size[0], height=size[1]))
        pictures[view] = studio(scene.simplified(_FINE * camera.mm_per_pixel), camera, transparent=transparent)
    return pictures


def clean_motion(
    assembly: Assembly, joint: str, *, view: str = "iso", frames: int = FRAMES, size: tuple[int, int] = (DEFAULT_SIZE, DEFAULT_SIZE)
) -> list[Image.Image]:
    """Draw the frames of `motion_frames` as product pictures, with one camera and one ground for all of them."""
    _, q = motion_frames(assembly, joint, frames)
    return clean_frames(assembly, q, view=view, size=size)


def clean_frames(
    assembly: Assembly,
    q: FloatArray,
    *,
    view: str = "iso",
    size: tuple[int, int] = (DEFAULT_SIZE, DEFAULT_SIZE),
    margin: float = 1.1,
    transparent: bool = False,
) -> list[Image.Image]:
    """Draw configurations as product pictures, with one camera and one ground for all of them.

    Args:
        assembly: What to draw.
        q: Configurations, `(n, nq)`.
        view: A key of `articad.render.VIEWS`.
        size: Width and height of each picture [pixels].
        margin: Size of the picture relative to everything that is shown in it.
        transparent: As in `render_clean`.
    """
    scenes = [scene_of(assembly.parts, _poses(assembly, row)) for row in q]
    bounds = _envelope(scenes)
    rough = [scene.simplified(_FINE * float(np.ptp(bounds, axis=0).max()) / max(size)) for scene in scenes]
    everything = np.concatenate([item.vertices for scene in rough for item in scene.items if len(item.mesh.vertices)])
    camera = framed(rough[0], Camera.fit(view, bounds, width=size[0], height=size[1]), margin=margin, also=everything)
    light = [scene.simplified(_FINE * camera.mm_per_pixel) for scene in scenes]
    return [studio(scene, camera, transparent=transparent, floor=float(bounds[0][2])) for scene in light]


def _prepared(
    assembly: Assembly,
    *,
    q: FloatArray | None,
    only: Sequence[str] | None,
    section: str | Section | None,
    explode: float,
    highlights: Sequence[TriMesh] = (),
    show_overlaps: bool = False,
) -> DrawnScene:
    """Return the scene of one pose, exploded and cut."""
    poses = _poses(assembly, assembly.mechanism.rest if q is None else q)
    marks = [*highlights, *(overlap_meshes(assembly.parts, poses) if show_overlaps else ())]
    mechanism = assembly.mechanism
    if explode:
        poses = exploded(assembly.parts, tuple(mechanism.tree.edges), _poses(assembly, mechanism.rest), poses, explode)
    scene = scene_of(assembly.parts, poses, joints=() if explode else assembly.joints, only=only, highlights=marks)
    cut = Section.parse(section, scene.bounds) if isinstance(section, str) else section
    return DrawnScene(scene.items, scene.axes, cut)


def render_part(
    part: Part, views: Sequence[str] = DEFAULT_VIEWS, *, size: int = DEFAULT_SIZE, supersample: int = 2, coarse: float = 0.0
) -> dict[str, Image.Image]:
    """Draw one part in its own frame from several sides; `coarse` as in `render_motion`."""
    scene = scene_of({part.name: part}, {part.name: SE3.identity()})
    if coarse:
        scene = scene.simplified(coarse * _pixel(scene.bounds, size))
    return {
        view: picture(
            scene,
            Camera.fit(view, scene.bounds, width=size, height=size),
            supersample=supersample,
            labels=False,  # the title names it; a label would cover the part
            title=f"{part.name} · {view}",
        )
        for view in views
    }


def motion_frames(assembly: Assembly, joint: str, count: int = FRAMES) -> tuple[list[str], FloatArray]:
    """Return configurations that show the motion of a driving joint, all other drivers at rest.

    Each coordinate runs from its lower to its upper limit, an endless angle over one turn from rest; a ball swings about both axes
    perpendicular to z and then twists.

    Returns:
        A caption for each frame, and `q`, `(frames, nq)`.

    Raises:
        UnknownJointError: If the joint does not drive anything.
    """
    driving = assembly.mechanism.driving_joints
    if joint not in driving:
        raise UnknownJointError(joint, sorted(driving))
    declared = next(entry for entry in assembly.joints if entry.name == joint)
    if declared.type is JointType.BALL:
        return _ball_frames(assembly, declared, count)
    captions: list[str] = []
    rows: list[FloatArray] = []
    size = float(np.linalg.norm(np.ptp(scene_of(assembly.parts, _poses(assembly, assembly.mechanism.rest)).bounds, axis=0)))
    for column, driver in enumerate(assembly.drivers):
        if driver.joint != joint:
            continue
        free = 2 * math.pi if driver.unit == "rad" else _FREE_TRAVEL * size
        lower, upper = driver_range(assembly, driver)
        lower = lower if math.isfinite(lower) else driver.rest
        upper = upper if math.isfinite(upper) else lower + free
        for value in np.linspace(lower, upper, count):
            q = np.array(assembly.mechanism.rest, dtype=np.float64)
            q[column] = value
            rows.append(q)
            shown = f"{math.degrees(value):.1f}°" if driver.unit == "rad" else f"{value:.1f} mm"
            captions.append(f"{driver.name} = {shown}")
    return captions, np.array(rows)


def render_motion(
    assembly: Assembly,
    joint: str,
    *,
    view: str | None = None,
    frames: int = FRAMES,
    size: int = 320,
    supersample: int = 2,
    axes: bool = True,
    coarse: float = 0.0,
    near: bool = False,
) -> list[Image.Image]:
    """Draw the frames of `motion_frames`, all with one camera that shows the whole motion.

    Args:
        assembly: What to draw.
        joint: The joint that moves.
        view: A key of `articad.render.VIEWS`; by default one in which the moving parts are seen and change from frame to frame. If there
            is none, what hides them is of glass, and the title says so; a round part that turns gets a hand.
        frames: Number of pictures for each coordinate of the joint.
        size: Width and height of each picture [pixels].
        supersample: Rays per pixel in each direction.
        axes: Draw the joint's axis.
        coarse: Draw simplified meshes with smooth normals, at most this many pixels away from the real ones; 0 draws the meshes themselves.
        near: Draw the moving parts alone from nearby, with hands on turning axes and all that stands still of glass.
    """
    captions, q = motion_frames(assembly, joint, frames)
    scenes = _motion_scenes(assembly, joint, q)
    if coarse:
        whole = _pixel(scenes[0].bounds, size)
        rough = [scene.simplified(coarse * whole) for scene in scenes]
        pixel = _pixel(_shown(rough), size)
        scenes = rough if pixel >= whole else [scene.simplified(coarse * pixel) for scene in scenes]
    shown = _envelope(_moving(scenes)) if near else _shown(scenes)
    through: tuple[str, ...] = ()
    if near:
        view = view or best_view(_moving(scenes))
        scenes = with_hands(of_glass(scenes, [item.name for item in scenes[0].items if item.manner == "faded"]), shown)
    elif view is None:
        view, through, hands = _shot(scenes, shown)
        scenes = of_glass(scenes, through)
        scenes = with_hands(scenes, shown) if hands else scenes
    camera = Camera.fit(view, shown, width=size, height=size)
    looking = f"\nthrough {', '.join(through[:_NAMED])}{', …' if len(through) > _NAMED else ''}" if through else ""
    return [
        picture(scene, camera, supersample=supersample, labels=False, axes=axes, title=f"{caption}{looking}")
        for scene, caption in zip(scenes, captions, strict=True)
    ]


def best_view(scenes: Sequence[DrawnScene], candidates: Sequence[str] = MOTION_VIEWS) -> str:
    """Return the view that shows a motion best: moving items travel far across the picture, and much of it changes.

    Both are measured in millimetres: a view that is closer because the product is slim from there shows no more.

    Args:
        scenes: The same items in different places.
        candidates: Keys of `articad.render.VIEWS`; the first one wins a tie.
    """
    return _ranked(scenes, candidates)[0]


def _shot(scenes: Sequence[DrawnScene], bounds: FloatArray) -> tuple[str, tuple[str, ...], bool]:
    """Return how a motion is seen: the view, the parts of glass, and whether its axis needs a hand."""
    few = scenes[:: math.ceil(len(scenes) / _JUDGED)]
    views = [*_ranked(scenes, MOTION_VIEWS), *(view for view in VIEWS if view not in MOTION_VIEWS)]
    looks = sights(few, views[:1], bounds)
    if not looks[views[0]].shows:
        looks |= sights(few, views[1:], bounds)
    for view, look in looks.items():
        if look.shows:
            return view, (), False
    inside = best_view(_moving(scenes))
    through = cleared(few, inside, bounds)
    if sights(of_glass(few, through), [inside], bounds)[inside].shows:
        return inside, through, False
    seen = [view for view, look in looks.items() if look.is_seen]
    return (seen[0], (), True) if seen else (inside, through, True)


def _ranked(scenes: Sequence[DrawnScene], candidates: Sequence[str]) -> list[str]:
    """Return the views, the one first that shows most of a motion."""
    bounds = _envelope(scenes)
    farthest = max(scenes, key=lambda scene: _displacement(scenes[0], scene))
    first, last = scenes[0].items, farthest.items
    moving = [index for index, item in enumerate(first) if not item.T_ground.allclose(last[index].T_ground)]

    def shown(view: str) -> float:
        camera = Camera.fit(view, bounds, width=_PROBE_SIZE, height=_PROBE_SIZE)
        travel = sum(
            float(np.linalg.norm(camera.project(first[index].vertices) - camera.project(last[index].vertices), axis=1).mean())
            for index in moving
        )
        before, after = cast(scenes[0], camera).item, cast(farthest, camera).item
        return travel * int((before != after).sum()) * camera.mm_per_pixel**3

    return sorted(candidates, key=shown, reverse=True)


def before_after(
    before: DrawnScene, after: DrawnScene, view: str = "iso", *, size: int = DEFAULT_SIZE, supersample: int = 2
) -> Image.Image:
    """Return two scenes side by side, drawn with one camera at one scale."""
    camera = Camera.fit(view, _envelope([before, after]), width=size, height=size)
    pair = [picture(scene, camera, supersample=supersample, title=title) for scene, title in ((before, "before"), (after, "after"))]
    return contact_sheet(pair, 2)


def product_sheet(assembly: Assembly, *, size: int = 480) -> Image.Image:
    """Return one picture that shows what a product is and in which direction each joint moves.

    Two views with names and axes, then for each driving joint its first and last keyframe, in the view that shows the motion best.

    Args:
        assembly: What to draw.
        size: Width and height of the two views [pixels]; a keyframe is half as large.
    """
    views = list(render_views(assembly, ("iso", "front"), size=size).values())
    ends: list[Image.Image] = []
    for joint in dict.fromkeys(driver.joint for driver in assembly.drivers):
        frames = render_motion(assembly, joint, frames=_SHEET_FRAMES, size=(size - _GAP) // 2)
        for start in range(0, len(frames), _SHEET_FRAMES):
            ends += [frames[start], frames[start + (1 if _turns_far(assembly, joint, start // _SHEET_FRAMES) else _SHEET_FRAMES - 1)]]
    top = contact_sheet(views, 2)
    if not ends:
        return top
    bottom = contact_sheet(ends[: 2 * _MOST_MOTIONS], _SHEET_COLUMNS)
    sheet = Image.new("RGB", (top.width, top.height + _GAP + bottom.height), _BETWEEN)
    sheet.paste(top, (0, 0))
    sheet.paste(bottom, (0, top.height + _GAP))
    return sheet


def contact_sheet(pictures: Sequence[Image.Image], columns: int) -> Image.Image:
    """Return pictures of one size arranged in rows."""
    width, height = pictures[0].size
    rows = math.ceil(len(pictures) / columns)
    sheet = Image.new("RGB", (columns * (width + _GAP) - _GAP, rows * (height + _GAP) - _GAP), _BETWEEN)
    for index, entry in enumerate(pictures):
        sheet.paste(entry, ((index % columns) * (width + _GAP), (index // columns) * (height + _GAP)))
    return sheet


def filmstrip(frames: Sequence[Image.Image], columns: int = 4) -> Image.Image:
    """Return motion frames as one picture, to be read like lines of text."""
    return contact_sheet(frames, min(columns, len(frames)))


def motion_gif(frames: Sequence[Image.Image]) -> bytes:
    """Return an animation that runs forwards and backwards endlessly."""
    palette = [frame.quantize(colors=128, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE) for frame in frames]
    loop = [*palette, *palette[-2:0:-1]]
    stream = io.BytesIO()
    loop[0].save(stream, format="GIF", save_all=True, append_images=loop[1:], duration=_GIF_MILLISECONDS, loop=0, optimize=False)
    return stream.getvalue()


def png(image: Image.Image) -> bytes:
    """Return the picture as a PNG file."""
    stream = io.BytesIO()
    image.save(stream, format="PNG", optimize=False)
    return stream.getvalue()


def _pixel(bounds: FloatArray, size: int) -> float:
    """Return a width that no pixel of a picture of this box falls short of by much [mm]."""
    return float(np.ptp(bounds, axis=0).max()) / size


def driver_range(assembly: Assembly, driver: Coordinate) -> tuple[float, float]:
    """Return how far a driver goes [rad or mm]: in a loop, a dead point or another joint may stop it before its own limits.

    Raises:
        UnknownJointError: If the assembly has no such driver.
    """
    if assembly.mechanism.is_tree:
        return driver.lower, driver.upper
    feasible = assembly.feasible_range(driver.name)
    return feasible.lower, feasible.upper


def _ball_frames(assembly: Assembly, joint: Joint, count: int) -> tuple[list[str], FloatArray]:
    columns = [index for index, driver in enumerate(assembly.drivers) if driver.joint == joint.name]
    cone = joint.limits.cone if joint.limits.cone is not None else math.pi / 4
    twist = joint.limits.twist or (0.0, 2 * math.pi)
    captions, rows = [], []
    swings = (("x", -cone, cone), ("y", -cone, cone), ("z", *twist))
    for axis, lower, upper in swings:
        for angle in np.linspace(lower, upper, count):
            q = np.array(assembly.mechanism.rest, dtype=np.float64)
            quaternion = np.zeros(4)
            quaternion["xyz".index(axis)], quaternion[3] = math.sin(angle / 2), math.cos(angle / 2)
            q[columns] = quaternion
            rows.append(q)
            captions.append(f"{joint.name} {'twist' if axis == 'z' else 'swing ' + axis} = {math.degrees(angle):.1f}°")
    return captions, np.array(rows)


def _require_pyvista() -> None:
    if not vtk.available():
        raise KernelUnavailableError(
            "PyVista cannot draw here: it is not installed, or there is no OpenGL. The renderer 'embree' needs neither.",
            how_to_get="pip install 'articad[render]', and libegl1 or libosmesa6 from the distribution",
        )


def _displacement(before: DrawnScene, after: DrawnScene) -> float:
    return sum(
        float(a.T_ground.distance_to(b.T_ground) + a.T_ground.angle_to(b.T_ground)) for a, b in zip(before.items, after.items, strict=True)
    )


def _envelope(scenes: Sequence[DrawnScene]) -> FloatArray:
    """Return the box that contains every scene [mm], `(2, 3)`."""
    return np.array([np.min([scene.bounds[0] for scene in scenes], axis=0), np.max([scene.bounds[1] for scene in scenes], axis=0)])


def _motion_scenes(assembly: Assembly, joint: str, q: FloatArray) -> list[DrawnScene]:
    """Return the scene of each configuration, with everything faded that never moves."""
    poses = [_poses(assembly, row) for row in q]
    moving = [name for name in assembly.parts if not all(poses[0][name].allclose(pose[name]) for pose in poses)]
    return [scene_of(assembly.parts, pose, joints=_of(assembly.joints, joint), only=moving or None) for pose in poses]


def _shown(scenes: Sequence[DrawnScene]) -> FloatArray:
    """Return the box that pictures of a motion show: the whole, or only the surroundings of small moving parts."""
    whole = _envelope(scenes)
    moving = _moving(scenes)
    part = _envelope(moving)
    size = float(np.linalg.norm(part[1] - part[0]))
    if not moving[0].items or size > _NEAR * float(np.linalg.norm(whole[1] - whole[0])):
        return whole
    near: FloatArray = part + _CONTEXT * size * np.array([[-0.5], [0.5]])
    return near


def _moving(scenes: Sequence[DrawnScene]) -> list[DrawnScene]:
    """Return the scenes with nothing but what moves."""
    return [replace(scene, items=tuple(item for item in scene.items if item.manner == "solid")) for scene in scenes]


def _turns_far(assembly: Assembly, joint: str, index: int) -> bool:
    """Whether a joint's coordinate turns by more than half a turn, so that first and last frame do not show the direction."""
    declared = next(entry for entry in assembly.joints if entry.name == joint)
    if declared.type is JointType.BALL:
        twist = declared.limits.twist
        return index == len("xyz") - 1 and (twist is None or twist[1] - twist[0] > math.pi)
    driver = [entry for entry in assembly.drivers if entry.joint == joint][index]
    lower, upper = driver_range(assembly, driver)
    return driver.unit == "rad" and upper - lower > math.pi + 1e-6


def _of(joints: Sequence[Joint], name: str) -> tuple[Joint, ...]:
    return tuple(joint for joint in joints if joint.name == name)


def _poses(assembly: Assembly, q: FloatArray) -> Mapping[str, SE3]:
    stacked = assembly.poses(q)
    return {name: stacked[index] for index, name in enumerate(assembly.mechanism.parts)}
