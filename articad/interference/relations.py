"""The relation of two parts by joints: mating, rigid or unrelated; and the overlap that it permits."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Literal, Protocol

from articad.kinematics.joints import Joint, JointType

Relation = Literal["mating", "rigid", "unrelated"]

UNRELATED_DEPTH_MM = 0.02  # parts without a joint may touch; this covers inaccuracies of modelling
MATING_DEPTH_MM = 0.10  # parts that share a joint may have a fit; a press fit can be a tenth


class WaiverLike(Protocol):
    """An overlap that the plan allows."""

    @property
    def parts(self) -> tuple[str, str]: ...  # noqa: D102
    @property
    def max_depth(self) -> float: ...  # noqa: D102
    @property
    def reason(self) -> str: ...  # noqa: D102


class FitLike(Protocol):
    """What a joint declares about the gap between its two parts."""

    @property
    def gap_min(self) -> float | None: ...  # noqa: D102
    @property
    def gap_max(self) -> float | None: ...  # noqa: D102
    @property
    def within(self) -> float | None: ...  # noqa: D102
    @property
    def contact(self) -> str | None: ...  # noqa: D102


class Groups:
    """Disjoint sets of names."""

    def __init__(self, names: Iterable[str] = ()) -> None:
        self._leader = {name: name for name in names}

    def leader(self, name: str) -> str:
        """Return the representative of a name's set."""
        self._leader.setdefault(name, name)
        while self._leader[name] != name:
            self._leader[name] = self._leader[self._leader[name]]
            name = self._leader[name]
        return name

    def join(self, a: str, b: str) -> None:
        """Unite the sets of two names."""
        self._leader[self.leader(b)] = self.leader(a)

    def together(self, a: str, b: str) -> bool:
        """Return whether two names are in one set."""
        return self.leader(a) == self.leader(b)

    def sets(self) -> list[tuple[str, ...]]:
        """Return all sets, in the order in which their first names were given."""
        members: dict[str, list[str]] = {}
        for name in self._leader:
            members.setdefault(self.leader(name), []).append(name)
        return [tuple(names) for names in members.values()]


class Relations:
    """Relations of all parts of a mechanism.

    Attributes:
        joints: In the order in which they are declared.
        rigid: Parts joined by fixed joints only.
    """

    def __init__(self, joints: Iterable[Joint], waivers: Iterable[WaiverLike] = ()) -> None:
        self.joints = tuple(joints)
        self.rigid = Groups()
        self._between: dict[frozenset[str], list[Joint]] = {}
        self._waivers = {frozenset(waiver.parts): waiver for waiver in waivers}
        for joint in self.joints:
            if joint.type is not JointType.FREE:  # a free joint is not a fit
                self._between.setdefault(frozenset((joint.parent, joint.child)), []).append(joint)
            if joint.type is JointType.FIXED:
                self.rigid.join(joint.parent, joint.child)

    def between(self, a: str, b: str) -> Sequence[Joint]:
        """Return the joints that connect two parts directly."""
        return self._between.get(frozenset((a, b)), ())

    def of(self, a: str, b: str) -> Relation:
        """Return the relation of two parts."""
        if self.rigid.together(a, b):
            return "rigid"
        return "mating" if self.between(a, b) else "unrelated"

    def tolerated(self, a: str, b: str, deflection: float) -> float:
        """Return the depth that needs no waiver [mm]; `deflection` is the sum of both meshes' [mm]."""
        return (MATING_DEPTH_MM if self.between(a, b) else UNRELATED_DEPTH_MM) + deflection

    def waiver(self, a: str, b: str) -> WaiverLike | None:
        """Return the waiver for two parts, if the plan has one."""
        return self._waivers.get(frozenset((a, b)))

    def where(self, a: str, b: str) -> str:
        """Return the path in the plan at which an overlap of two parts is reported."""
        joints = self.between(a, b)
        return f"joints.{joints[0].name}" if joints else f"parts.{a}"
