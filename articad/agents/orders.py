"""Who made a fault between parts: a script that departs from its order, or the plan that ordered it.

Decided by proof, from the bores, pins, sockets and balls of joints and from the probe of dimensions. A script departs

- if a dimension of its part has no effect;
- if its part alone has nothing round about the axis of a joint, or has its bore or pin beside it;
- if a bore or pin that makes a joint has a diameter that none of its dimensions states;
- if it alone is ordered with a clearance, and the surfaces of both parts touch where a fit demands a gap;
- if such a bore takes its pin, but is closed at a depth that its dimensions do not give, or at both ends, so that no pin could go in;
- if of the slot and the tongue of a slider, which would have play, one alone lies beside the axis at a distance that no dimension states;
- if of two holes of a fixed joint that should meet, one alone is at a place that its dimensions do not give, and they give the place where it
  would meet the other;
- if its shape, mirrored, turned or shifted as a whole, has no fault (`misplaced`), and the faults are not those of a pin that is where it was
  ordered and too thick for its bore.

It does not depart if it follows its order once a number of the plan that is far out of proportion is a thousandth of what it is: what that
number sizes hides or cuts away the rest. What else is wrong about a part that departs may follow from that, so it waits for the script. A fault of two parts of which neither departs follows
from the orders, so it goes to the designer. All faults of two parts go to the same author. Where a joint without
bore and pin has faces that are neither planes, cylinders nor spheres, and no slot and tongue as wide as their dimensions state, departures
cannot be measured: its faults stay open, but a fit goes to the designer if the overlap at rest of its parts has a root cause and goes there.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any, Final, NamedTuple, Self

import numpy as np

from articad.agents.misplaced import misplaced
from articad.arrays import FloatArray
from articad.assembly import Assembly
from articad.errors import ArticadError
from articad.findings import Finding, Findings
from articad.geometry.faces import Face
from articad.interference.report import PairCheck
from articad.interference.scene import Scene
from articad.kernels.slips import numbers_of
from articad.kinematics.joints import Joint, JointType
from articad.plan.fields import lengths_in
from articad.plan.resolve import Fit, ResolvedPlan
from articad.plan.usage import CLEARANCE
from articad.realisation.bores import TILT, along, beside
from articad.realisation.holes import HolesApart, OpenHole, holes_apart, point_text
from articad.realisation.sides import Sides, sides
from articad.realisation.slots import Between, Slot, slots_of
from articad.realisation.verdicts import is_loose

__all__ = ["FITS", "HELD", "addressed", "as_built", "is_fault_of_joint", "source_of"]

FITS: Final = frozenset({"E_FIT_TIGHT", "E_FIT_LOOSE", "E_FIT_CONTACT"})
APART: Final = "W_HOLES_APART"
HELD: Final = frozenset({"W_JOINT_NOT_MADE", "W_JOINT_PARTLY_MADE", "W_JOINT_LEAVES", "W_JOINT_SHORT", APART})
"""Codes of joints that surfaces do not make."""
_CODES: Final = FITS | HELD | {"E_OVERLAP", "E_STATIC_OVERLAP", "E_MOTION_COLLISION", "E_FLOATING", "E_NOT_TOUCHING"}
_CUT: Final = frozenset({"unbored_hole", "missing_slot"})  # causes that a cut mends: one that was ordered, or one that must be
_ABOUT_AXIS: Final = (JointType.REVOLUTE, JointType.CYLINDRICAL, JointType.SCREW)
_ON_AXIS_MM: Final = 0.2  # a pin whose axis is farther away from that of a bore was not made for it
_BESIDE: Final = 2.0  # distance from the joint's axis over the diameter: farther away, it is the bore of another joint
_ALIKE: Final = 0.3  # difference of radii, as a share of the larger
_ROUNDING_MM: Final = 0.005  # of a diameter
_PLAY_MM: Final = 0.02  # a smaller clearance is none
_BINDING_MM: Final = 0.02  # between half the difference of two widths and a gap that was measured: this pair makes the gap
_LOOSE: Final = 0.05  # play of a tongue in its slot, over its width
_ASIDE_MM: Final = 0.05  # of a tongue beside its slot, beyond their play
_OUT_OF_PROPORTION: Final = 5.0  # a length over the longest other one of its part, or a clearance over the shortest one
_OF_ROUND: Final = re.compile(r"radius|diameter|bore|hole|pin|shaft|arbor|axle|spigot|socket|ball|thread")
_OF_FLAT: Final = re.compile(r"width|height|length|thick|depth|wall|board|gap|pitch|(^|_)[xyz](_|$)")
_OF_HOLE: Final = re.compile(r"screw|hole|bolt|thread|tap|dowel|rivet|fix|mount|pitch|spacing|distance|(^|_)[xyz](_|$)")
_NUMBER: Final = re.compile(r"\d+(?:\.\d+)?")
_WORDS: Final = {"cylinder": ("bore", "pin"), "sphere": ("socket", "ball")}


class _Round(NamedTuple):
    """A cylinder or sphere that makes a joint, or the slot or tongue of a slider.

    Attributes:
        part: Its part.
        what: "bore", "pin", "socket", "ball", "slot" or "tongue".
        diameter: Its diameter, or its width [mm].
        off: Error of its radius, or of half its width [mm].
        depth: Of a bore that is closed at one end [mm], else None.
        shut: Whether a bore is closed at both ends.
    """

    part: str
    what: str
    diameter: float
    off: float
    depth: float | None = None
    shut: bool = False


class _Joined(NamedTuple):
    """A joint with the faces of both sides, its bores with their pins or sockets with their balls, the slots of a slider, and holes of a fixed joint.

    Attributes:
        wide: Bores with pins that hang in them, where a finding says so and no pair is nearly equal in size.
    """

    joint: Joint
    sides: Sides
    fits: tuple[tuple[_Round, _Round], ...]
    slots: tuple[Slot, ...]
    holes: tuple[HolesApart, ...]
    wide: tuple[tuple[_Round, _Round], ...] = ()

    @classmethod
    def of(cls, assembly: Assembly, scene: Scene, joint: Joint, *, is_loose: bool = False) -> Self:
        both = sides(scene, joint)
        fits = tuple(_mating(both))
        slots = tuple(slots_of(both)) if joint.type is JointType.SLIDER and not fits else ()
        wide = tuple(_mating(both, most=1.0)) if is_loose and not fits else ()
        return cls(joint, both, fits, slots, tuple(holes_apart(scene, assembly.at(), joint)), wide)

    @property
    def parts(self) -> frozenset[str]:
        return frozenset({self.joint.parent, self.joint.child})


def is_fault_of_joint(finding: Finding) -> bool:
    """Return whether a warning about a joint must be answered once: it leaves its guide, a pin is loose in its bore, or holes do not meet."""
    return finding.code == APART or (finding.code in HELD and is_loose(finding))


def addressed(findings: Iterable[Finding], assembly: Assembly, scene: Scene, verdicts: Iterable[PairCheck] = ()) -> Findings:
    """Send each error about two parts to whoever made it, where the parts prove it; others keep their route.

    Args:
        findings: Of an examination of the assembly.
        assembly: A product that was built from a plan.
        scene: The assembly's scene.
        verdicts: Of the pairs at rest.
    """
    several = tuple(findings)
    between = {f"joints.{joint.name}": (joint.parent, joint.child) for joint in assembly.joints}
    pairs = {frozenset(finding.parts) for finding in several if finding.code in _CODES and len(finding.parts) == 2}
    if assembly.resolved is None or not pairs:
        return Findings(several)
    loose = {finding.where for finding in several if finding.code in HELD - {APART} and is_loose(finding)}
    judged = [joint for joint in assembly.joints if frozenset({joint.parent, joint.child}) in pairs]
    joined = [_Joined.of(assembly, scene, joint, is_loose=f"joints.{joint.name}" in loose) for joint in judged]
    departed = _touching(several, assembly.resolved, joined) | _departed(assembly, assembly.resolved, joined)
    joints = [one.joint for one in joined]
    departed = {source: why for source, why in departed.items() if not _follows_otherwise(source, assembly, assembly.resolved, joints)}
    too_thick = {one.parts for one in joined if any(inside.diameter > around.diameter + _ROUNDING_MM for around, inside in one.fits)}
    open_ones = [one for one in several if _is_open(one, assembly.resolved, departed) and frozenset(one.parts) not in too_thick]
    doubted = {name for name, part in assembly.realised.items() if part.findings.of("W_SCALE")}
    if open_ones and (found := misplaced(assembly, scene, _sources(assembly.resolved), open_ones, verdicts, doubted=doubted)) is not None:
        departed[found.part] = (
            f"All faults of {found.part} are gone if its shape is {found.how} of its frame: the script built it elsewhere."
        )
    unmeasured = {one.parts for one in joined if _is_unmeasured(one, assembly.resolved)}
    by_fit = {f"joints.{one.joint.name}.fit": one for one in joined if one.joint.name in assembly.fits}
    fitting = {
        one.where: _fitting(one, by_fit[one.where], assembly.fits[by_fit[one.where].joint.name], assembly.resolved)
        for one in several
        if one.where in by_fit
    }
    fitting |= {f"joints.{one.joint.name}": _moving(one.holes, assembly.resolved) for one in joined if one.holes}
    told = [
        _addressed(finding, between.get(finding.where, finding.parts), assembly.resolved, departed, unmeasured, fitting)
        for finding in several
    ]
    return Findings(_with_its_overlap(finding, told) for finding in told)


def _with_its_overlap(finding: Finding, several: Sequence[Finding]) -> Finding:
    """Return a fit's finding, sent to the designer if the overlap at rest of the same two parts is; its numbers follow from that."""
    if finding.code not in FITS or finding.route == "design":
        return finding
    ordered = any(
        other.code == "E_STATIC_OVERLAP" and other.route == "design" and other.cause is not None and set(other.parts) == set(finding.parts)
        for other in several
    )
    return replace(finding, route="design") if ordered else finding


def _sources(resolved: ResolvedPlan) -> dict[str, str]:
    return {name: source_of(name, resolved) for name in resolved.parts}


def _is_open(finding: Finding, resolved: ResolvedPlan, departed: Container[str]) -> bool:
    """Return whether a finding is an error about two parts at rest of which neither is known to depart."""
    at_rest = finding.severity == "error" and finding.code in _CODES - {"E_MOTION_COLLISION"}
    is_between = at_rest and len(finding.parts) == 2
    return is_between and not any(source_of(name, resolved) in departed for name in finding.parts if name in resolved.parts)


def source_of(name: str, resolved: ResolvedPlan) -> str:
    """Return the part that has the script: a derived part's faults belong to its source."""
    while (derivation := resolved.parts[name].derivation) is not None:
        name = derivation.source
    return name


def _touching(findings: Iterable[Finding], resolved: ResolvedPlan, joined: Sequence[_Joined]) -> dict[str, str]:
    """Return why scripts left out a clearance, by part.

    A fit has no gap, one of its two parts alone is ordered with a clearance, and no bore or pin of this part shows it.
    """
    found: dict[str, str] = {}
    for finding in findings:
        if finding.code not in {"E_FIT_TIGHT", "E_FIT_CONTACT"} or finding.value is None or abs(finding.value) > _ROUNDING_MM:
            continue
        with_clearance = {
            source: name
            for source in dict.fromkeys(source_of(part, resolved) for part in finding.parts if part in resolved.parts)
            for name, value in resolved.parts[source].dimensions.items()
            if CLEARANCE.search(name) and value > _PLAY_MM
        }
        if len(with_clearance) != 1:
            continue
        ((source, name),) = with_clearance.items()
        plain = {key: value for key, value in resolved.parts[source].dimensions.items() if not CLEARANCE.search(key)}
        fits = [one.fits for one in joined if finding.where == f"joints.{one.joint.name}.fit"]
        own = [surface for pair in itertools.chain.from_iterable(fits) for surface in pair if source_of(surface.part, resolved) == source]
        if all(_stated_by(surface, plain) is not None for surface in own):
            found[source] = f"The fit has no gap, although {source} is ordered with {name!r}."
    return found


def _departed(assembly: Assembly, resolved: ResolvedPlan, joined: Sequence[_Joined]) -> dict[str, str]:
    """Return why scripts depart from their orders, by the part that has the script."""
    found: dict[str, str] = {}
    for source in sorted({source_of(name, resolved) for one in joined for name in one.parts}):
        unused = assembly.realised[source].findings.of("W_DIMENSION_UNUSED")
        if unused:
            found[source] = f"{source} does not follow its dimension {unused[0].where.rsplit('.', 1)[-1]!r}."
    for one in joined:
        for part, reason in _elsewhere(one) if not one.fits else ():
            source = source_of(part, resolved)
            found.setdefault(source, f"{source} {reason} the axis of joint {one.joint.name!r}.")
        for surface, mating in [pair for bore, pin in one.fits or one.wide for pair in ((bore, pin), (pin, bore))]:
            source = source_of(surface.part, resolved)
            dimensions = resolved.parts[source].dimensions
            which = f"The {surface.what} of {source} in joint {one.joint.name!r}"
            goes_in = mating.diameter <= surface.diameter  # else the depth explains nothing
            if surface.shut and goes_in:
                reason = f"{which} is closed at both ends, so that the {mating.what} cannot go in."
            elif _stated_by(surface, dimensions) is None:
                reason = f"{which} has a diameter of {surface.diameter:.4g} mm, which none of its dimensions states."
            elif surface.depth is not None and goes_in and not _is_given(surface.depth, dimensions):
                reason = f"{which} is {surface.depth:.4g} mm deep, which its dimensions do not give."
            else:
                continue
            found.setdefault(source, reason)
        for part, reason in _beside(one, resolved):
            found.setdefault(source_of(part, resolved), reason)
    return found


def _follows_otherwise(source: str, assembly: Assembly, resolved: ResolvedPlan, joints: Sequence[Joint]) -> bool:
    """Return whether a script departs no more once a number of the plan that is far out of proportion is a thousandth of what it is."""
    for address, value in _out_of_proportion(resolved, source):
        try:
            other = assembly.with_changes({address: value / 1000.0})
        except (ArticadError, ValueError):
            continue
        assert other.resolved is not None
        scene, names = other.scene(), {joint.name for joint in joints}
        if source not in _departed(
            other, other.resolved, [_Joined.of(other, scene, joint) for joint in other.joints if joint.name in names]
        ):
            return True
    return False


def _out_of_proportion(resolved: ResolvedPlan, source: str) -> Iterator[tuple[str, float]]:
    """Yield numbers of the plan far longer than all lengths of a part that do not follow from them; of a clearance, than the shortest."""
    lengths = lengths_in(resolved.parts[source].dimensions)
    for address, (value, driven) in numbers_of(resolved, source, lengths).items():
        others = [abs(length) for name, length in lengths.items() if name not in driven and length]
        limit = min(others, default=math.inf) if CLEARANCE.search(address) else max(others, default=math.inf)
        if abs(value) > _OUT_OF_PROPORTION * limit:
            yield address, value


def _beside(joined: _Joined, resolved: ResolvedPlan) -> Iterator[tuple[str, str]]:
    """Yield the part with a slot, a tongue or a hole of a joint at a place that its dimensions do not give, and what is so."""
    name = joined.joint.name
    for side, reason in _aside(joined, resolved):
        yield side.part, f"The {reason} of {source_of(side.part, resolved)} in joint {name!r}, which its dimensions do not give."
    for hole in _misplaced_holes(joined.holes, resolved):
        which = f"The hole of {hole.diameter:.4g} mm of {hole.part} in joint {name!r}"
        yield hole.part, f"{which} is at {point_text(hole.place)}; its dimensions give {point_text(hole.partner)}."


def _aside(joined: _Joined, resolved: ResolvedPlan) -> Iterator[tuple[Between, str]]:
    """Yield the slot or the tongue of a slider that alone lies at a distance from the axis which its dimensions do not give."""
    for slot in joined.slots:
        if not 0.0 <= slot.play < min(slot.shift - _ASIDE_MM, _LOOSE * slot.tongue.width):
            continue  # a tongue that is too thick may well lie beside a slot on one side, and in a far wider one it may lie anywhere
        strange = [
            (side, what)
            for side, what in ((slot.slot, "slot"), (slot.tongue, "tongue"))
            if not _is_length(abs(side.middle), resolved.parts[source_of(side.part, resolved)].dimensions)
        ]
        if len(strange) == 1:
            ((side, what),) = strange
            yield side, f"middle of the {what} is {abs(side.middle):.4g} mm beside the axis"


def _are_stated(slot: Slot, resolved: ResolvedPlan) -> bool:
    """Return whether the dimensions of both parts give how wide slot and tongue are, such as a width less two walls."""
    sides = (slot.slot, slot.tongue)
    return all(_is_given(side.width, resolved.parts[source_of(side.part, resolved)].dimensions, twice=True) for side in sides)


def _prismatic(slot: Slot) -> tuple[_Round, _Round]:
    return (
        _Round(slot.slot.part, "slot", slot.slot.width, slot.slot.off),
        _Round(slot.tongue.part, "tongue", slot.tongue.width, slot.tongue.off),
    )


def _is_unmeasured(joined: _Joined, resolved: ResolvedPlan) -> bool:
    """Return whether departures of a joint's parts cannot be measured."""
    if joined.fits or any(_are_stated(slot, resolved) for slot in joined.slots):
        return False
    return any(each.face.kind == "other" for each in (*joined.sides.parent, *joined.sides.child))


def _addressed(
    finding: Finding,
    parts: Sequence[str],
    resolved: ResolvedPlan,
    departed: Mapping[str, str],
    unmeasured: Container[frozenset[str]],
    fitting: Mapping[str, str],
) -> Finding:
    if finding.code not in _CODES:
        return finding
    guilty = [source for name in parts if (source := source_of(name, resolved)) in departed]
    if guilty:
        is_named = finding.route == "code" and finding.where == f"parts.{guilty[0]}"
        more = finding.hint if is_named else f"Build {guilty[0]} as its specification states."
        return replace(finding, route="code", where=f"parts.{guilty[0]}", hint=f"{departed[guilty[0]]} {more}")
    if finding.cause in _CUT:
        culprit = finding.where.removeprefix("parts.")
        follows = f"As far as it can be measured, the script of {culprit} follows its order, so the order is at fault"
        return replace(finding, route="design", hint=f"{follows}: {finding.hint[0].lower()}{finding.hint[1:]}")
    if len(parts) != 2 or (frozenset(parts) in unmeasured and finding.code != APART):
        return finding
    numbers = fitting.get(finding.where, "") if finding.code in FITS | {APART} else ""
    return replace(finding, route="design", hint=f"{numbers} {finding.hint}".strip())


def _fitting(finding: Finding, joined: _Joined, fit: Fit, resolved: ResolvedPlan) -> str:
    """Return the numbers of a plan that mend a fit: a dimension of the bore or the pin, or the fit declared as it is.

    A bore of diameter D and a pin of diameter d have the gap (D - d) / 2. The new gap is the middle of the declared range, or none where
    contact is required.
    """
    if finding.value is None or (fit.gap_max is None and fit.contact == "forbidden"):
        return ""
    least, most = fit.gap_min or 0.0, fit.gap_max
    several = joined.fits or [_prismatic(slot) for slot in joined.slots]
    value = finding.value
    binding = [(around, inside) for around, inside in several if abs((around.diameter - inside.diameter) / 2 - value) < _BINDING_MM]
    meant = 0.0 if fit.contact == "required" else least if most is None else (least + most) / 2
    offers = []
    for bore, pin in binding or several:
        for surface, diameter in ((bore, pin.diameter + 2 * meant), (pin, bore.diameter - 2 * meant)):
            source = source_of(surface.part, resolved)
            stated = _stated_by(surface, resolved.parts[source].dimensions)
            if stated is not None and diameter > 0.0:
                name, times = stated
                value = float(resolved.parts[source].dimensions[name]) + (diameter - surface.diameter) / times
                offers.append(f"parts.{source}.dimensions.{name} to {value:.6g}")
    declared = as_built(finding, fit)
    if "contact" in declared:
        offers.append(f"contact to {declared['contact']!r} if the gap is meant as it is")
    elif declared:
        offers.append(f"{finding.where}.gap_mm to {declared['gap_mm']} if the gap is meant as it is")
    return f"Set {', or '.join(dict.fromkeys(offers))}." if offers else ""


def as_built(finding: Finding, fit: Fit) -> dict[str, Any]:
    """Return the fields of a fit that declare a gap as it was measured; empty if the parts overlap or may not touch."""
    least, most = fit.gap_min or 0.0, fit.gap_max
    if finding.value is None or (most is None and fit.contact == "forbidden"):
        return {}
    if finding.code == "E_FIT_CONTACT":
        return {"contact": "allowed"} if fit.contact == "required" and (most is None or finding.value <= most) else {}
    if finding.value <= 0.0:
        return {}
    low, high = math.floor(100 * finding.value) / 100, math.ceil(100 * finding.value) / 100
    return {"gap_mm": [min(least, low), max(most or 0.0, high)]}


def _misplaced_holes(several: Iterable[HolesApart], resolved: ResolvedPlan) -> Iterator[OpenHole]:
    """Yield each hole that alone of its pair is at a place that the dimensions of its part do not give, where they give the other place."""
    for apart in several:
        strange = []
        for hole in (apart.parent, apart.child):
            differing = np.flatnonzero(np.abs(hole.place - hole.partner) > _ROUNDING_MM).tolist()
            if not _is_place(hole.place, differing, hole.part, resolved) and _is_place(hole.partner, differing, hole.part, resolved):
                strange.append(hole)
        if len(strange) == 1:
            yield strange[0]


def _is_place(place: FloatArray, coordinates: Sequence[int], name: str, resolved: ResolvedPlan) -> bool:
    """Return whether dimensions of a part, or numbers of its description, give coordinates of a point, from its origin or from a connector."""
    part = resolved.parts[source_of(name, resolved)]
    origins = _origins(name, resolved)
    said = {f"said {k}": float(number) for k, number in enumerate(_NUMBER.findall(part.description))}
    stated = {**part.dimensions, **said}
    return all(any(_is_given(2 * abs(float(place[k] - origin[k])), stated, twice=True) for origin in origins) for k in coordinates)


def _moving(several: Iterable[HolesApart], resolved: ResolvedPlan) -> str:
    """Return the dimensions that move a hole to the one that it should meet, of the first pair that has some."""
    for apart in several:
        offers = [offer for hole in (apart.child, apart.parent) if (offer := _moved(hole, resolved))]
        if offers:
            return f"Set {', or '.join(offers)}."
    return ""


def _moved(hole: OpenHole, resolved: ResolvedPlan) -> str:
    """Return new values of the dimensions that are coordinates of a hole, or twice as much, and must change; empty if one coordinate has none."""
    source = source_of(hole.part, resolved)
    lengths = lengths_in(resolved.parts[source].dimensions)
    differing = np.flatnonzero(np.abs(hole.place - hole.partner) > _ROUNDING_MM).tolist()
    for origin in _origins(hole.part, resolved):
        old, new = hole.place - origin, hole.partner - origin
        stated = [
            [
                (not _OF_HOLE.search(name), times, name, times * abs(float(new[k])))
                for name, value in lengths.items()
                for times in (1, 2)
                if old[k] * new[k] > 0 and abs(times * abs(old[k]) - value) < _ROUNDING_MM
            ]
            for k in differing
        ]
        if all(stated):
            return " and ".join(f"parts.{source}.dimensions.{name} to {value:.6g}" for *_, name, value in map(min, stated))
    return ""


def _origins(name: str, resolved: ResolvedPlan) -> list[FloatArray]:
    """Return the points of a part from which its dimensions may count, `(3,)` each in its frame [mm]."""
    return [np.zeros(3), *(connector.frame.translation for connector in resolved.parts[name].connectors.values())]


def _mating(both: Sides, *, most: float = _ALIKE) -> Iterator[tuple[_Round, _Round]]:
    """Yield each bore with its pin and each socket with its ball, one on each side of a joint.

    Args:
        both: The faces of the two sides.
        most: Largest difference of their radii, as a share of the larger; nearly equal in size by default.
    """
    for one, other in ((both.parent, both.child), (both.child, both.parent)):
        bores = [each for each in one if each.face.kind in _WORDS and each.face.hollow]
        pins = [each for each in other if each.face.kind in _WORDS and not each.face.hollow]
        for (part, bore), (against, pin) in itertools.product(bores, pins):
            if abs(bore.radius - pin.radius) <= most * max(bore.radius, pin.radius) and _goes_into(pin, bore):
                around, inside = _WORDS[bore.kind]
                floors = _floors(bore, [each.face for each in one if each.part == part])
                depth = float(np.ptp(bore.corners @ bore.axis)) if floors == 1 else None
                yield _Round(part, around, 2 * bore.radius, bore.off, depth, floors > 1), _Round(against, inside, 2 * pin.radius, pin.off)


def _elsewhere(joined: _Joined) -> Iterator[tuple[str, str]]:
    """Yield the part of a joint about an axis that has nothing round about it, or its bore or pin beside it, and which of these."""
    joint, both = joined.joint, joined.sides
    if joint.type not in _ABOUT_AXIS:
        return
    several = ((joint.parent, both.parent, both.child), (joint.child, both.child, both.parent))
    bare = [part for part, own, _ in several if not any(_is_about(one.face) for one in own)]
    if len(bare) == 1:
        yield bare[0], "has no bore or pin about"
        return
    for part, own, other in several:
        about = [one.face for one in other if one.face.kind == "cylinder" and _is_about(one.face)]
        for face in (one.face for one in own if one.part == part and one.face.kind == "cylinder" and not _is_about(one.face)):
            distance = beside(face)
            if distance < _BESIDE * 2 * face.radius and any(_suits(face, one) for one in about):
                yield part, f"has its {_WORDS['cylinder'][not face.hollow]} of {2 * face.radius:.4g} mm {distance:.3g} mm beside"
                return


def _suits(face: Face, other: Face) -> bool:
    """Return whether one of two cylinders about parallel axes is a bore and the other a pin that is a little thinner."""
    bore, pin = (face, other) if face.hollow else (other, face)
    return bore.hollow and not pin.hollow and 0.0 <= bore.radius - pin.radius <= _ALIKE * bore.radius


def _is_about(face: Face) -> bool:
    """Return whether a face is a cylinder about the z axis, or a curved face whose kind is not known."""
    return face.kind == "other" or (face.kind == "cylinder" and beside(face) < _ON_AXIS_MM)


def _goes_into(pin: Face, bore: Face) -> bool:
    """Return whether two faces of one kind have the same centre, or the same axis and a common extent along it."""
    if pin.kind != bore.kind:
        return False
    between = bore.point - pin.point
    if pin.kind == "sphere":
        return float(np.linalg.norm(between)) < _ON_AXIS_MM
    if np.linalg.norm(np.cross(pin.axis, bore.axis)) > TILT or np.linalg.norm(np.cross(between, bore.axis)) > _ON_AXIS_MM:
        return False
    (low, high), (start, end) = (along(face, bore.axis) for face in (bore, pin))
    return min(high, end) > max(low, start)


def _floors(bore: Face, faces: Iterable[Face]) -> int:
    """Return at how many ends a whole floor closes a bore."""
    if bore.kind != "cylinder":
        return 0
    ends = along(bore, bore.axis)
    closed = set()
    for face in faces:
        if face.kind == "plane" and np.linalg.norm(np.cross(face.axis, bore.axis)) < TILT:
            height = float(face.point @ bore.axis)
            reach = np.linalg.norm(np.cross(face.corners.reshape(-1, 3) - bore.point, bore.axis), axis=1).max()
            if reach < bore.radius + _ROUNDING_MM:
                closed |= {end for end in ends if abs(height - end) < _ROUNDING_MM}
    return len(closed)


def _stated_by(surface: _Round, dimensions: Mapping[str, float]) -> tuple[str, int] | None:
    """Return the dimension that states a diameter, with or without a clearance: 1 as a diameter, 2 as a radius; None if none does.

    Of several, that whose name suits best.
    """
    allowed = 2 * surface.off + _ROUNDING_MM
    several = [(name, times) for name, times, stated in _diameters(dimensions) if abs(surface.diameter - stated) <= allowed]
    return min(several, key=lambda one: _unsuitable(surface, *one), default=None)


def _unsuitable(surface: _Round, name: str, times: int) -> int:
    """Return how badly a dimension's name suits a diameter that it states once or twice, or the width of a slot or tongue."""
    is_flat, of_round, of_flat = surface.what in {"slot", "tongue"}, bool(_OF_ROUND.search(name)), bool(_OF_FLAT.search(name))
    if is_flat:
        return (times != 1) + (0 if of_flat else 2 if of_round else 1)
    return (times != (2 if "radius" in name else 1)) + (0 if of_round else 2 if of_flat else 1)


def _is_given(length: float, dimensions: Mapping[str, float], *, twice: bool = False) -> bool:
    """Return whether a length is that of a dimension, or the sum or difference of two, each perhaps taken twice."""
    stated = np.array(list(lengths_in(dimensions).values()))
    terms = np.concatenate([[0.0], stated, -stated, *((2 * stated, -2 * stated) if twice else ())])
    return bool((np.abs(terms[:, None] + terms - length) < _ROUNDING_MM).any())


def _is_length(distance: float, dimensions: Mapping[str, float]) -> bool:
    """Return whether a distance is zero, that of a dimension or half of it."""
    return distance < _ROUNDING_MM or any(abs(times * distance - value) < _ROUNDING_MM for value in dimensions.values() for times in (1, 2))


def _diameters(dimensions: Mapping[str, float]) -> Iterator[tuple[str, int, float]]:
    """Yield each dimension, how many times it is taken, and the diameter that it then states, with or without a clearance."""
    lengths = lengths_in(dimensions)
    clearances = [0.0, *(value for name, value in lengths.items() if CLEARANCE.search(name))]
    for name, value in lengths.items():
        for clearance, sign, times, twice in itertools.product(clearances, (1, -1), (1, 2), (1, 2)):
            yield name, times, times * value + twice * sign * clearance
