"""Known answers: a door, a drawer, a wheel, a chain, a screw, a loop."""

from __future__ import annotations

import math
import time
from dataclasses import replace

import pytest

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.export.carried import CarriedParts
from articad.export.loads import GRAVITY_M_S2, Load, joint_loads
from articad.geometry.part import Part
from articad.geometry.shapes import box, cylinder
from articad.kinematics import declare
from articad.kinematics.joints import Joint, JointType
from tests.assemblies import random_configurations, random_tree

WATER = 1000.0
g = GRAVITY_M_S2


def part(name: str, mesh: object = None, **origins: tuple[float, float, float]) -> Part:
    connectors = {key: Connector(key, SE3.from_translation(at)) for key, at in origins.items()}
    return Part.from_mesh(name, mesh or box(100, 100, 100), density=WATER, connectors=connectors)  # type: ignore[arg-type]


def loads_of(parts: list[Part], joints: list[Joint]) -> dict[str, tuple[Load, ...]]:
    assembly = Assembly.from_parts("a", parts=parts, joints=joints, ground=parts[0].name)
    return joint_loads(assembly.mechanism, assembly.parts)


def test_a_door_holds_its_weight_at_its_lever() -> None:
    base, door = part("base", a=(0, 0, 0)), part("door", box(400, 20, 100), edge=(-200, 0, 0))
    ((load,),) = loads_of([base, door], [declare.revolute("hinge", base["a"], door["edge"], limits=(0, 1))]).values()
    mass, reach = 0.8, math.hypot(0.4, 0.01)

    assert load.effort == pytest.approx(2 * g * mass * 0.2)
    assert load.velocity == pytest.approx(math.sqrt(2 * g / reach))
    assert load.damping == pytest.approx(0.05 * load.effort / load.velocity)


def test_a_drawer_is_lifted_and_runs_its_length_as_if_it_fell() -> None:
    base, drawer = part("base", a=(0, 0, 0)), part("drawer", a=(0, 0, 0))
    ((load,),) = loads_of([base, drawer], [declare.slider("slide", base["a"], drawer["a"], limits=(-100, 150))]).values()

    assert load.effort == pytest.approx(2 * g * 1.0)
    assert load.velocity == pytest.approx(math.sqrt(2 * g * 0.25))


def test_a_balanced_wheel_still_gets_the_effort_to_spin_it_up() -> None:
    base, wheel = part("base", a=(0, 0, 0)), part("wheel", cylinder(50, 10, 256), a=(0, 0, 0))
    ((load,),) = loads_of([base, wheel], [declare.revolute("axle", base["a"], wheel["a"], limits="endless")]).values()
    mass = math.pi * 0.05**2 * 0.01 * WATER
    spin_up = mass * 0.05**2 / 2 * g / 0.05

    assert load.effort == pytest.approx(2 * spin_up, rel=1e-3)


def test_a_shoulder_carries_the_stretched_arm() -> None:
    base, upper, lower = part("base", a=(0, 0, 0)), part("upper", a=(-50, 0, 0), b=(50, 0, 0)), part("lower", a=(-50, 0, 0))
    loads = loads_of(
        [base, upper, lower],
        [
            declare.revolute("shoulder", base["a"], upper["a"], limits=(-1, 1)),
            declare.revolute("elbow", upper["b"], lower["a"], limits=(-1, 1)),
        ],
    )

    assert loads["elbow"][0].effort == pytest.approx(2 * g * 0.05)
    assert loads["shoulder"][0].effort == pytest.approx(2 * g * (0.05 + 0.15))


def test_what_is_fixed_to_a_door_turns_with_it_at_its_own_distance() -> None:
    base, door = part("base", a=(0, 0, 0)), part("door", a=(-50, 0, 0), handle=(30, 0, 40))
    knob = part("knob", a=(0, 0, 0))
    joints = [
        declare.revolute("hinge", base["a"], door["a"], limits=(0, 1)),
        declare.fixed("glue", door["handle"], knob["a"], mate="opposed"),
    ]

    loads = loads_of([base, door, knob], joints)

    assert loads["glue"] == ()
    assert loads["hinge"][0].effort == pytest.approx(2 * g * (0.05 + 0.08))


def test_a_joint_declared_from_the_moving_part_carries_that_part() -> None:
    base, door = part("base", a=(0, 0, 0)), part("door", a=(-50, 0, 0))
    ((load,),) = loads_of([base, door], [declare.revolute("hinge", door["a"], base["a"], limits=(0, 1))]).values()

    assert load.effort == pytest.approx(2 * g * 0.05)


def test_stated_loads_win_and_are_converted() -> None:
    base, door = part("base", a=(0, 0, 0)), part("door", a=(-50, 0, 0))
    joint = declare.cylindrical("j", base["a"], door["a"], travel=(0, 10), angle=(0, 1))
    stated = replace(joint, effort=(7.0, 1500.0), velocity=(250.0, None))
    slide, turn = loads_of([base, door], [stated])["j"]

    assert (slide.effort, slide.velocity, turn.effort) == (7.0, 0.25, 1.5)
    assert turn.velocity == pytest.approx(math.sqrt(2 * g / math.hypot(0.1, 0.05)))


def test_a_screw_also_lifts_through_its_lead() -> None:
    base, nut = part("base", a=(0, 0, 0)), part("nut", a=(0, 0, 0))
    plain = loads_of([base, nut], [declare.revolute("j", base["a"], nut["a"], limits=(0, 1))])["j"][0]
    slide, turn = loads_of([base, nut], [declare.screw("j", base["a"], nut["a"], lead=10, limits=(0, 100))])["j"]

    assert turn.effort == pytest.approx(plain.effort + 2 * g * 0.01 / math.tau)
    assert slide.velocity == pytest.approx(turn.velocity * 0.01 / math.tau)


def test_slides_of_unknown_length_and_parts_of_no_size_have_finite_loads() -> None:
    base, nothing = part("base", a=(0, 0, 0)), Part.without_geometry("nothing", {"a": Connector("a", SE3.identity())})
    slide, turn = loads_of([base, nothing], [declare.cylindrical("j", base["a"], nothing["a"], travel="endless", angle="endless")])["j"]

    assert 0 < slide.effort < 0.01
    assert 0 < turn.effort < 1e-5
    assert math.isfinite(slide.velocity)
    assert math.isfinite(turn.velocity)


def test_a_ball_has_three_equal_loads() -> None:
    base, head = part("base", a=(0, 0, 0)), part("head", a=(-50, 0, 0))
    loads = loads_of([base, head], [declare.ball("j", base["a"], head["a"], cone=1.0)])["j"]

    assert len(set(loads)) == 1
    assert loads[0].effort == pytest.approx(2 * g * 0.05)
    assert len(loads) == 3


def test_every_joint_of_a_loop_carries_what_the_loop_carries() -> None:
    base = part("base", a=(0, 0, 0), d=(300, 0, 0))
    links = [part(f"link_{i}", a=(-50, 0, 0), b=(50, 0, 0)) for i in range(3)]
    joints = [
        declare.revolute("j0", base["a"], links[0]["a"], limits=(-1, 1)),
        declare.revolute("j1", links[0]["b"], links[1]["a"], limits=(-1, 1)),
        declare.revolute("j2", links[1]["b"], links[2]["a"], limits=(-1, 1)),
        declare.revolute("j3", base["d"], links[2]["b"], limits=(-1, 1)),
    ]
    loads = loads_of([base, *links], joints)
    three = 2 * g * 3.0

    assert all(0.05 * three / 3 < load.effort for (load,) in loads.values())
    assert loads["j1"][0].effort > 2 * g * (0.05 + 0.15)


@pytest.mark.parametrize("seed", range(12))
def test_no_pose_has_longer_levers_than_a_joint_is_given(seed: int) -> None:
    assembly = random_tree(seed, 9)
    mechanism = assembly.mechanism
    carried = CarriedParts(mechanism, assembly.parts)
    for q in random_configurations(assembly, seed, 20):
        poses = dict(zip(mechanism.parts, mechanism.poses(q), strict=True))
        for edge in mechanism.tree.edges:
            joint = edge.joint
            near = poses[joint.child] @ joint.T_child_connector if not edge.reversed else poses[joint.parent] @ joint.T_parent_connector
            about_axis = joint.type not in {JointType.BALL, JointType.UNIVERSAL}
            levers = []
            for name in mechanism.tree.subtree(edge.part):
                mass = assembly.parts[name].mass
                assert mass is not None
                at = near.inverse().apply(poses[name].apply(mass.com)) / 1000
                levers.append((mass.mass, math.hypot(*(at[:2] if about_axis else at))))
            found = carried.of(joint)

            assert found.mass == pytest.approx(sum(mass for mass, _ in levers), rel=1e-12)
            assert sum(mass * lever for mass, lever in levers) <= found.moment * (1 + 1e-9)
            assert sum(mass * lever**2 for mass, lever in levers) <= found.inertia * (1 + 1e-9)
            assert max(lever for _, lever in levers) <= found.reach * (1 + 1e-9)


def test_a_long_chain_is_summed_up_in_one_pass() -> None:
    """1,500 links in a chain: looking at every link from every joint would take two minutes."""
    links = [part(f"link_{i}", a=(-50, 0, 0), b=(50, 0, 0)) for i in range(1500)]
    joints = [declare.revolute(f"j_{i}", links[i]["b"], links[i + 1]["a"], limits=(-1, 1)) for i in range(len(links) - 1)]
    assembly = Assembly.from_parts("chain", parts=links, joints=joints, ground="link_0")
    start = time.monotonic()
    loads = joint_loads(assembly.mechanism, assembly.parts)

    assert time.monotonic() - start < 10
    n = len(joints)
    assert loads["j_0"][0].effort == pytest.approx(2 * g * sum(0.05 + 0.1 * i for i in range(n)))
