"""What file formats cannot state, and the checks that a file of such a format cannot meet therefore.

Another tool's file is judged by what it states alone. The rules are the only place that excuses a format; the how-to shows them.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import Final, Literal, NamedTuple

from articad.kinematics.joints import JointType
from articad_bench.checks import Joints, Loops, Mass
from articad_bench.function_checks import PutTogether
from articad_bench.room_checks import Weighs
from articad_bench.stack_checks import Stack
from articad_bench.task import Task

Format = Literal["urdf", "mjcf", "step", "freecad"]
Asked = Literal["motion", "loop", "cone", "force", "fit", "weight", "linear", "swing", "plane"]
"""What a product has: joints that move, a closed loop, a ball whose cone is limited and whose twist has a range of its own, parts that are pressed
or snapped together, declared fits, a mass that is asked for, joints coupled by other means than gears, belts, racks and screws,
a universal joint whose angles are limited, a planar joint whose ways are limited."""

MOTION: Final = frozenset(
    {
        "freedoms",
        "joints",
        "effort",
        "folds",
        "loops",
        "ratio",
        "rise",
        "travel",
        "straight",
        "level",
        "floor",
        "turns",
        "meshes",
        "links",
        "gap",
        "moves",
        "reaches",
    }
) | {"made", "captive", "clear_in_motion", "certified", "simulates"}
_OF_A_CONE: Final = frozenset({"joints", "travel", "clear_in_motion", "certified"})

_EVERY: Final[tuple[tuple[Format, str], ...]] = (("urdf", "URDF"), ("mjcf", "MJCF"), ("step", "STEP"), ("freecad", "FreeCAD"))


class Unsaid(NamedTuple):
    """A rule.

    Attributes:
        format: Format of a file.
        asked: What it cannot state.
        kinds: Kinds of the checks that cannot hold where this is asked for.
        why: The reason, a sentence.
    """

    format: Format
    asked: Asked
    kinds: frozenset[str]
    why: str


UNSAID: Final = (
    Unsaid("urdf", "loop", MOTION, "URDF holds trees of joints: the joint that closes a loop is missing."),
    Unsaid(
        "mjcf",
        "cone",
        _OF_A_CONE,
        "MJCF limits the total angle of a ball, not cone and twist.",
    ),
    *(
        rule
        for form, called in _EVERY
        for rule in (
            Unsaid(form, "force", frozenset({"put_together"}), f"{called} does not say what is pressed or snapped together."),
            Unsaid(form, "fit", frozenset({"stack"}), f"{called} holds no fits."),
        )
    ),
    Unsaid("freecad", "cone", _OF_A_CONE, "FreeCAD limits no angle of a ball."),
    Unsaid("freecad", "swing", _OF_A_CONE | {"moves"}, "FreeCAD limits no angle of a universal joint."),
    Unsaid("freecad", "plane", _OF_A_CONE | {"moves", "reaches"}, "FreeCAD limits no way of a planar joint."),
    Unsaid("freecad", "linear", MOTION, "FreeCAD couples joints by gears, belts, racks and screws alone."),
    Unsaid("freecad", "weight", frozenset({"mass", "weighs"}), "FreeCAD holds no densities but those of its own library."),
    Unsaid(
        "step",
        "motion",
        MOTION | {"lead", "threads", "joined", "arranged", "carries", "holds", "passage", "section"},
        "STEP holds no joints.",
    ),
    Unsaid("step", "weight", frozenset({"mass", "weighs"}), "STEP holds no densities."),
)


def asked_for(task: Task) -> set[Asked]:
    """Return what the checks of a task ask for."""
    found: set[Asked] = {"motion"} if task.moves else set()
    for check in task.checks:
        if isinstance(check, Loops) and check.number[0] >= 1:
            found.add("loop")
        if isinstance(check, Joints) and check.joint.type is JointType.BALL and check.joint.span not in {None, "endless"}:
            found.add("cone")
        if isinstance(check, Joints) and check.joint.type is JointType.UNIVERSAL and check.joint.span not in {None, "endless"}:
            found.add("swing")
        if isinstance(check, Joints) and check.joint.type is JointType.PLANAR and check.joint.span not in {None, "endless"}:
            found.add("plane")
        if isinstance(check, PutTogether) and check.force:
            found.add("force")
        if isinstance(check, Mass | Weighs):
            found.add("weight")
        if isinstance(check, Stack) and check.plays:
            found.add("fit")
    return found


def unsaid(form: str, asked: Collection[Asked]) -> dict[str, str]:
    """Return the kinds of checks that cannot hold in a format, each with the reason."""
    return {kind: rule.why for rule in UNSAID if rule.format == form and rule.asked in asked for kind in rule.kinds}
