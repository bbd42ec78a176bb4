"""The filmstrip of a simulation: the motion of the joints as the engine reported it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from articad.connectors.se3 import SE3
from articad.render import Camera, filmstrip, picture, png
from articad.render.scene import DrawnScene, scene_of
from articad.simulation.verdict import EngineOutcome, FilmFrame

if TYPE_CHECKING:
    from articad.assembly import Assembly
    from articad.kinematics.joints import Coordinate

MOST_FRAMES = 12
SIZE = 240  # pixels of a frame
_SUFFIXES = {"travel": "__t", "angle": "__r", "x": "__x", "y": "__y", "a": "__rx", "b": "__ry"}


def film(assembly: Assembly, outcome: EngineOutcome, *, size: int = SIZE) -> bytes | None:
    """Return a filmstrip as PNG; None if nothing moved.

    Args:
        assembly: The assembly that was simulated; values of its drivers are found by the names of joints.
        outcome: The outcome with its frames.
        size: Width and height of a frame [pixels].
    """
    frames = _chosen(outcome.frames)
    if not frames or not any(part.visuals or part.collisions for part in assembly.parts.values()):
        return None
    scenes = [_scene(assembly, frame) for frame in frames]
    bounds = np.array([np.min([scene.bounds[0] for scene in scenes], axis=0), np.max([scene.bounds[1] for scene in scenes], axis=0)])
    camera = Camera.fit("iso", bounds, width=size, height=size)
    titles = [f"{frame.joint} = {_shown(assembly, frame)}" for frame in frames]
    pictures = [picture(scene, camera, supersample=1, labels=False, title=title) for scene, title in zip(scenes, titles, strict=True)]
    return png(filmstrip(pictures))


def _chosen(frames: list[FilmFrame]) -> list[FilmFrame]:
    """Return a limited number of frames: complete strokes of some joints rather than parts of all."""
    return frames[:MOST_FRAMES]


def _scene(assembly: Assembly, frame: FilmFrame) -> DrawnScene:
    q = np.array(assembly.mechanism.rest, dtype=np.float64)
    for column, driver in enumerate(assembly.drivers):
        value = _value(driver, frame)
        if value is not None:
            q[column] = value
    poses: SE3 = assembly.poses(q)
    return scene_of(assembly.parts, dict(zip(assembly.mechanism.parts, poses, strict=True)))


def _value(driver: Coordinate, frame: FilmFrame) -> float | None:
    """Return a driver's value [rad, mm] among those of the engine's joints [rad, m]."""
    joint, _, coordinate = driver.name.partition(".")
    names = (driver.name, joint + _SUFFIXES.get(coordinate or "angle", ""), joint)
    value = next((frame.values[name] for name in names if name in frame.values), None)
    return None if value is None or driver.unit == "1" else value * (1000.0 if driver.unit == "mm" else 1.0)


def _shown(assembly: Assembly, frame: FilmFrame) -> str:
    value = frame.values.get(frame.joint, 0.0)
    slides = any(driver.unit == "mm" and driver.name.partition(".")[0] == frame.joint.partition("__")[0] for driver in assembly.drivers)
    return f"{value * 1000:.1f} mm" if slides and not frame.joint.endswith("__r") else f"{math.degrees(value):.1f}°"
