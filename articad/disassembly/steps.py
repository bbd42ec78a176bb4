"""The form of an order of assembly: its steps with their paths, and the parts for which none was found."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Final, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from articad.aliases import Fastening
from articad.arrays import FloatArray
from articad.findings import Finding, Findings

__all__ = ["ENDED", "AssemblyOrder", "AssemblyStep", "Blocked", "Move", "StopRow", "beside_words", "shown_path", "turned_over", "words_of"]

_SHOWN: Final = (0.14, 0.75)  # of the size of what is shown: least and largest distance of new parts from their place
_FROM: Final = {
    (0, False): "from the left", (0, True): "from the right", (1, False): "from the front", (1, True): "from behind",
    (2, False): "from below", (2, True): "from above",
}  # fmt: skip
_TOWARDS: Final = {
    (0, False): "the left", (0, True): "the right", (1, False): "the front", (1, True): "the back", (2, False): "the bottom",
    (2, True): "the top",
}  # fmt: skip
_BESIDE: Final = {
    (0, False): "left of", (0, True): "right of", (1, False): "in front of", (1, True): "behind", (2, False): "below", (2, True): "above",
}  # fmt: skip

_UPWARDS: Final = 0.7  # vertical part of a unit vector, from which a part comes from below
_AXIS: Final = 1e-6  # of a unit vector: it points along an axis

Vector3 = tuple[float, float, float]

ENDED = " The search ended at its limit of work: not every other pose and not every pair of moves was tried."
NOT_CHECKED = "Parts are rigid; room for hands and tools, the order of adhesives, and whether a step needs a fixture are not checked."


class _Form(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Move(_Form):
    """One piece of a path, in the order of assembly.

    Attributes:
        kind: "straight", or "screw": along the direction while turning about it, sampled at 16 places of each turn.
        direction: Unit vector in the ground frame, towards the place of the part.
        length_mm: From where the part is clear of everything.
        apart_mm: From where it is clear of the parts that it is joined to: enough for an exploded picture.
        turns: Of a screw, right-handed about the direction; 0 for a straight move.
        axis_point: A point on the axis of a screw [mm]; None for a straight move.
    """

    kind: Literal["straight", "screw"] = "straight"
    direction: Vector3
    length_mm: float
    apart_mm: float
    turns: float = 0.0
    axis_point: Vector3 | None = None


class AssemblyStep(_Form):
    """One step: parts that are put in place together.

    Attributes:
        number: From 1.
        assembly: What is being assembled: the product, or the name of a sub-assembly.
        parts: The parts that move; several are a sub-assembly that earlier steps have made.
        subassembly: Its name if they are several.
        onto: The parts that are in place.
        moves: The path; empty if nothing is in place yet.
        at: Values of the drivers at which the step is done, such as a door that stands open [rad, mm]; the others, and all if empty, at rest.
        slides: Whether the parts are there already, beside their places, and are moved to them.
        beside: By how much parts are beside their places when the step is done [mm], in the ground frame: they wait there until others are in.
        opened: Whether `at` is the value of a joint of what is there so far, which moves farther than in the whole product because a loop is still open.
        joints: Joints between the parts and those in place that this step makes.
        fastened: How those of them are held together whose fastening is stated.
        strength: "proven": free of collision all along the path; "permitted": so but for pairs that are fastened by force, such as a snap, bought as one, or
            turned into each other's thread, which is sampled.
        permitted: These pairs, with their fastening.
        forced_mm: Length of the end of the path on which such a pair overlaps; 0 where it is not known.
    """

    number: int
    assembly: str
    parts: tuple[str, ...]
    subassembly: str | None = None
    onto: tuple[str, ...]
    moves: tuple[Move, ...]
    at: dict[str, float] = Field(default_factory=dict)
    slides: bool = False
    beside: dict[str, Vector3] = Field(default_factory=dict)
    opened: bool = False
    joints: tuple[str, ...] = ()
    fastened: dict[str, Fastening] = Field(default_factory=dict)
    strength: Literal["proven", "permitted"] = "proven"
    permitted: tuple[tuple[str, str, Fastening], ...] = ()
    forced_mm: float = 0.0


def shown_path(step: AssemblyStep, size: float) -> FloatArray:
    """Return the path of a step for a picture, as offsets of the new parts from their place `(n, 3)` [mm]; the last point is the place.

    It begins where the new parts are clear of their partners, but neither so near that this is not seen nor so far that it fills the
    picture. All points are on the path that is proven, which goes on in a straight line beyond its length.

    Args:
        step: The step.
        size: Of what is shown [mm].
    """
    points = [np.zeros(3)]
    for index, move in reversed(list(enumerate(step.moves))):
        outside = index == 0 and not step.slides
        far = min(max(move.apart_mm, _SHOWN[0] * size), _SHOWN[1] * size) if outside else move.length_mm
        points.append(points[-1] - far * np.array(move.direction))
    return np.array(points[::-1])


def words_of(step: AssemblyStep) -> str:
    """Return what is done in a step, in a sentence."""
    what = step.parts[0] if len(step.parts) == 1 else step.subassembly or ", ".join(step.parts)
    if not step.moves:
        return f"Start with {what}."
    ways = [_way(move) for move in step.moves]
    over = ", with the assembly turned over or held up" if any(move.direction[2] > _UPWARDS for move in step.moves) else ""
    turned = f"{over}{turned_over(step.at) if step.opened else ''}"
    if step.slides:
        return f"Move {what} to its place: {', then '.join(ways)}{turned}{_waiting(step)}."
    where = beside_words(step.beside[step.parts[0]]) if step.parts[0] in step.beside else "in place"
    return f"Put {what} {where}: {', then '.join(ways)}{turned}{_waiting(step)}."


def beside_words(offset: Vector3) -> str:
    """Return where a part is that an offset [mm] takes from its place: "24.3 mm above its place"."""
    along = [axis for axis in range(3) if abs(offset[axis]) > _AXIS]
    where = _BESIDE[along[0], offset[along[0]] > 0] if len(along) == 1 else "from"
    return f"{math.hypot(*offset):.3g} mm {where} its place"


def _waiting(step: AssemblyStep) -> str:
    """Return which of the parts that are there wait beside their places, as the end of a sentence."""
    names = [name for name in step.beside if name in step.onto]
    return f", with {' and '.join(names)} still beside {'its place' if len(names) == 1 else 'their places'}" if names else ""


def turned_over(at: Mapping[str, float]) -> str:
    """Return to which values joints of an opened loop are turned [rad], as the end of a sentence."""
    return f", with {' and '.join(f'{joint} turned over to {math.degrees(value):.0f}°' for joint, value in at.items())}"


def _way(move: Move) -> str:
    """Return where a part comes from, and towards what that direction leans if it is not along an axis: "from above, 28° towards the right"."""
    back = -np.array(move.direction)
    strongest = sorted((axis for axis in range(3) if abs(back[axis]) > _AXIS), key=lambda axis: -abs(back[axis]))
    main, others = strongest[0], strongest[1:]
    way = _FROM[main, bool(back[main] > 0)]
    if move.kind == "screw":
        return f"turned in {way} by {abs(move.turns):g} turns{' of a left-hand thread' if move.turns < 0 else ''}"
    if not others:
        return way
    angle = math.degrees(math.atan2(float(np.linalg.norm(back[others])), abs(float(back[main]))))
    return f"{way}, {angle:.3g}° towards {' and '.join(_TOWARDS[axis, bool(back[axis] > 0)] for axis in others)}"


class StopRow(_Form):
    """How far a part moves in one direction before another stops it.

    Attributes:
        part: The part.
        direction: Unit vector in the ground frame, out of its place.
        travel_mm: How far it moves.
        by: The part in its way.
    """

    part: str
    direction: Vector3
    travel_mm: float
    by: str


class Blocked(_Form):
    """Parts that the search could not take apart, so that it found no order that puts them together.

    Attributes:
        parts: The parts that hold each other.
        stops: For each of them the direction in which it moves farthest, and what stops it there.
        remedy: What can be done.
        ended: Whether the search ended at its limit of work; then not all other poses, pairs of moves and moves aside were tried.
    """

    parts: tuple[str, ...]
    stops: tuple[StopRow, ...]
    remedy: str
    ended: bool = False


class AssemblyOrder(_Form):
    """In which order the parts of an assembly go together, and how each gets to its place.

    Attributes:
        form: Version of this form, `schema` in JSON.
        name: Of the assembly.
        base: The part that everything is put onto.
        steps: In order; a sub-assembly is made before it is put in place.
        blocked: Sets of parts for which no order was found; they are put in place together.
        left_out: Parts without a valid solid, of which nothing is known.
        not_checked: What this does not say.
    """

    form: Literal["articad.order/1"] = Field("articad.order/1", alias="schema")
    name: str
    base: str
    steps: tuple[AssemblyStep, ...]
    blocked: tuple[Blocked, ...] = ()
    left_out: tuple[str, ...] = ()
    not_checked: str = NOT_CHECKED

    @property
    def ok(self) -> bool:
        """Whether every part can be put in place."""
        return not self.blocked and not self.left_out

    @property
    def findings(self) -> Findings:
        """A warning for each set of parts for which no order was found."""
        return Findings(_finding(blocked) for blocked in self.blocked)

    def to_json(self) -> dict[str, Any]:
        """Return the JSON document, with its findings."""
        document = self.model_dump(mode="json", by_alias=True)
        return {"schema": document.pop("schema"), "ok": self.ok, "findings": [finding.to_json() for finding in self.findings], **document}

    @classmethod
    def from_json(cls, document: dict[str, Any]) -> AssemblyOrder:
        """Return the order that `to_json` wrote."""
        return cls.model_validate({key: value for key, value in document.items() if key not in {"ok", "findings"}})


def _finding(blocked: Blocked) -> Finding:
    ways = "; ".join(f"{row.part} moves {row.travel_mm:.3g} mm at most before {row.by} stops it" for row in blocked.stops)
    return Finding(
        code="W_NOT_INSERTABLE",
        where=f"parts.{blocked.parts[0]}",
        parts=blocked.parts,
        message=f"No order was found in which {' and '.join(blocked.parts)} get to their places one after the other, in one or two straight moves each: {ways}."
        f"{ENDED if blocked.ended else ''}",
        hint=blocked.remedy,
    )
