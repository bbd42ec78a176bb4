"""What a product is said by must not matter: a reference passes in other frames, names and orders, turned where no direction is asked for, and as URDF or MJCF.

Files are read as another tool's are: without the records that articad leaves in its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.connectors import SE3
from articad.kinematics.joints import Joint, JointLimits, JointType
from articad_bench.heading import is_directed
from articad_bench.reference import reference
from articad_bench.subject import Subject
from articad_bench.task import TASKS, tasks_in
from articad_bench.unsaid import Format
from tests.bench.forms import FORMS, as_file, refused, sayable
from tests.bench.wrong import changed, shaped_as

ALL = {task.name: (folder, task) for folder, task in tasks_in(TASKS) if task.given is None}
IN_CI = ("engine_single", "corkscrew_wing", "bracket_corner")
"""A loop, a screw, and a single part."""
NAMES = [*IN_CI, *(pytest.param(name, marks=pytest.mark.soak) for name in ALL if name not in IN_CI)]
BOTH_WAYS = frozenset({JointType.REVOLUTE, JointType.SLIDER, JointType.CYLINDRICAL, JointType.SCREW, JointType.FIXED})
HALF_TURN = SE3.rot_x(math.pi)


@cache
def built(name: str) -> Assembly:
    return reference(*ALL[name])


def framed(assembly: Assembly) -> Assembly:
    """Every part is drawn in a frame of its own."""
    rng = np.random.default_rng(5)
    frames = {
        name: SE3.from_axis_angle(rng.normal(size=3), rng.uniform(0.2, 3)) @ SE3.trans(*rng.normal(0, 90, 3)) for name in assembly.parts
    }
    parts = [
        part if part.mesh is None else replace(shaped_as(part, part.mesh.transformed(frames[name])), connectors={})
        for name, part in assembly.parts.items()
    ]
    joints = [
        replace(
            joint,
            T_parent_connector=frames[joint.parent] @ joint.T_parent_connector,
            T_child_connector=frames[joint.child] @ joint.T_child_connector,
        )
        for joint in assembly.joints
    ]
    return changed(assembly, parts, joints, T_ground=assembly.mechanism.T_ground @ frames[assembly.ground].inverse())


def renamed(assembly: Assembly) -> Assembly:
    """Parts and joints have other names, and the opposite order."""
    names = {name: f"body_{index}" for index, name in enumerate(reversed(list(assembly.parts)))}
    pins = {joint.name: f"pin_{index}" for index, joint in enumerate(reversed(assembly.joints))}

    def column(text: str) -> str:
        joint, dot, rest = text.partition(".")
        return f"{pins[joint]}{dot}{rest}"

    parts = [part.renamed(names[name]) for name, part in reversed(list(assembly.parts.items()))]
    joints = [replace(j, name=pins[j.name], parent=names[j.parent], child=names[j.child]) for j in reversed(assembly.joints)]
    couplings = [replace(c, a=column(c.a), b=column(c.b)) for c in assembly.mechanism.couplings]
    return Assembly.from_parts(
        "renamed",
        parts=parts,
        joints=joints,
        ground=names[assembly.ground],
        couplings=couplings,
        fits={pins[name]: fit for name, fit in assembly.fits.items()},
        T_ground=assembly.mechanism.T_ground,
    )


def exchanged(assembly: Assembly) -> Assembly:
    """The parent of each joint is its child, and its axis points the other way: its value is the same.

    With R the half turn about x, R M(q) R = M(-q) for a motion M along and about z.
    """

    def other(joint: Joint) -> Joint:
        if joint.type not in BOTH_WAYS:
            return joint
        sides: dict[str, Any] = {"parent": joint.child, "child": joint.parent}
        sides |= {"parent_connector": joint.child_connector, "child_connector": joint.parent_connector}
        mate = joint.T_parent_connector @ joint.motion(joint.type.neutral)
        return replace(joint, **sides, T_parent_connector=joint.T_child_connector @ HALF_TURN, T_child_connector=mate @ HALF_TURN)

    return changed(assembly, joints=[other(joint) for joint in assembly.joints])


def rested(assembly: Assembly) -> Assembly:
    """Joints are at zero at rest, as most tools write what stands before them: URDF states no other pose."""
    simple = {joint.name: joint for joint in assembly.joints if joint.type in BOTH_WAYS and joint.rest}
    rest = {name: value for joint in simple.values() for name, value in zip(joint.column_names, joint.rest, strict=True)}

    def other(joint: Joint) -> Joint:
        if joint.name not in simple:
            return joint
        lower, upper = (tuple(np.subtract(bounds, joint.rest)) for bounds in (joint.limits.lower, joint.limits.upper))
        return replace(
            joint,
            T_parent_connector=joint.T_parent_connector @ joint.motion(joint.rest),
            limits=JointLimits(lower, upper),
            rest=joint.type.neutral,
        )

    couplings = [replace(c, offset=c.offset + c.ratio * rest.get(c.a, 0.0) - rest.get(c.b, 0.0)) for c in assembly.mechanism.couplings]
    return changed(assembly, joints=[other(joint) for joint in assembly.joints], couplings=couplings)


def turned(assembly: Assembly) -> Assembly:
    """The whole stands turned by a quarter about the upright axis."""
    return changed(assembly, T_ground=SE3.rot_z(math.pi / 2) @ assembly.mechanism.T_ground)


WAYS: dict[str, Callable[[Assembly], Assembly]] = {"framed": framed, "renamed": renamed, "exchanged": exchanged}


@pytest.mark.slow
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", NAMES)
def test_a_reference_passes_whatever_its_parts_are_drawn_in_named_or_joined_from(name: str, way: str) -> None:
    assert refused(ALL[name][1], Subject(WAYS[way](built(name)))) == []


YAW_IN_CI = "lamp_two_arms"
FREE = [name for name, (_, task) in ALL.items() if task.may_turn or not any(map(is_directed, task.checks))]


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param(name, marks=() if name == YAW_IN_CI else pytest.mark.soak) for name in FREE])
def test_a_reference_passes_turned_where_no_level_direction_is_asked_for(name: str) -> None:
    assert refused(ALL[name][1], Subject(turned(built(name)))) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("form", FORMS)
def test_a_reference_passes_as_a_file_of_another_tool_but_for_what_the_format_cannot_state(name: str, form: Format, tmp_path: Path) -> None:
    assembly = rested(built(name))

    assert refused(sayable(ALL[name][1], assembly, form), Subject(as_file(assembly, form, tmp_path))) == []
