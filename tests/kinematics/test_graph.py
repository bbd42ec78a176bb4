from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from articad.connectors import Mate
from articad.errors import KinematicsError, PlanError
from articad.kinematics import Edge, Joint, JointGraph, JointType, KinematicTree, Mechanism
from tests.strategies import random_joint, trees


def joint(name: str, parent: str, child: str, joint_type: str = "revolute", *, driver: bool = False) -> Joint:
    made = random_joint(np.random.default_rng(0), name, JointType(joint_type), parent, child, Mate.ALIGNED)
    return Joint(**{**made.__dict__, "driver": driver})


def square(*types: str) -> list[Joint]:
    ends = [("g", "crank"), ("crank", "coupler"), ("coupler", "rocker"), ("g", "rocker")]
    return [joint(f"j{i}", *end, joint_type) for i, (end, joint_type) in enumerate(zip(ends, types, strict=True))]


PARTS = ("g", "crank", "coupler", "rocker")


@given(trees())
def test_a_tree_has_every_part_after_its_parent_and_subtrees_in_one_piece(mechanism: Mechanism) -> None:
    tree = mechanism.tree
    assert sorted(tree.parts) == sorted(mechanism.parts)
    assert mechanism.loop_joints == ()
    for part in tree.parts:
        at = tree.parts.index(part)
        carried = tree.subtree(part)
        assert tree.parts[at : at + len(carried)] == carried  # depth-first: Pinocchio needs it
        edge = tree.edge(part)
        assert (edge is None) == (part == "p0")
        if edge is not None:
            assert tree.parts.index(edge.parent) < at
            assert tree.depth(part) == tree.depth(edge.parent) + 1
            assert {edge.parent, edge.part} == {edge.joint.parent, edge.joint.child}
            assert edge.reversed == (edge.joint.child == edge.parent)


@given(trees(), st.integers(0, 2**16))
def test_a_path_steps_along_joints_and_is_the_same_backwards(mechanism: Mechanism, seed: int) -> None:
    a, b = np.random.default_rng(seed).choice(mechanism.parts, 2)
    path = mechanism.tree.path(a, b)
    assert (path[0], path[-1]) == (a, b)
    assert mechanism.tree.path(b, a) == path[::-1]
    assert len(set(path)) == len(path)
    for joint_, pair in zip(mechanism.tree.joints_between(a, b), itertools.pairwise(path), strict=True):
        assert {joint_.parent, joint_.child} == set(pair)
    assert [edge.part for edge in mechanism.tree.ancestors(b)] == list(mechanism.tree.path("p0", b)[1:])


def test_the_heaviest_joint_closes_the_loop_and_the_first_declared_carries_on_ties() -> None:
    for types, loop in (
        (("revolute", "revolute", "revolute", "revolute"), "j3"),
        (("revolute", "ball", "revolute", "revolute"), "j1"),
        (("revolute", "revolute", "slider", "revolute"), "j3"),
        (("revolute", "revolute", "revolute", "fixed"), "j2"),
    ):
        tree, loops = JointGraph(PARTS, "g", square(*types)).spanning_tree()
        assert [j.name for j in loops] == [loop], types
        assert len(tree.parts) == 4


def test_a_driver_stays_in_the_tree() -> None:
    joints = square("revolute", "revolute", "revolute", "revolute")
    joints[3] = joint("j3", "g", "rocker", driver=True)
    _, loops = JointGraph(PARTS, "g", joints).spanning_tree()
    assert [j.name for j in loops] == ["j2"]


def test_planar_and_universal_are_crossed_in_their_declared_direction() -> None:
    joints = square("revolute", "revolute", "universal", "revolute")  # coupler -> rocker
    tree, loops = JointGraph(PARTS, "g", joints).spanning_tree()
    assert all(not edge.reversed for edge in tree.edges if not edge.joint.type.reversible)
    assert [j.name for j in loops] == ["j2"] or any(edge.joint.name == "j2" for edge in tree.edges)
    turned = [joint("a", "g", "b", "universal"), joint("b", "c", "b", "planar")]
    (found,) = JointGraph(("g", "b", "c"), "g", turned).findings()
    assert found.code == "E_REVERSE_UNSUPPORTED"
    assert found.where == "joints.b"
    assert "Exchange" in found.hint


def test_components_put_the_ground_first() -> None:
    graph = JointGraph(("x", "y", "g", "z"), "g", [joint("a", "x", "y"), joint("b", "z", "g")])
    assert graph.components() == (("g", "z"), ("x", "y"))
    (found,) = graph.findings()
    assert found.code == "E_DISCONNECTED"
    assert found.message == "Parts [['x', 'y']] are not connected to ground 'g'."
    assert found.hint == "Add a joint between one part of each group and one of ['g', 'z']."
    with pytest.raises(PlanError, match="E_DISCONNECTED"):
        graph.spanning_tree()


@pytest.mark.parametrize(
    ("parts", "ground", "joints", "codes", "text"),
    [
        (("g", "crank"), "g", [joint("j1", "g", "crnk")], {"E_PART_UNKNOWN"}, "Did you mean 'crank'?"),
        (("g", "a"), "gr", [joint("j1", "g", "a")], {"E_NO_GROUND"}, "Choose one of ['g', 'a']."),
        (("g", "a"), "g", [joint("j1", "g", "a"), joint("j2", "a", "a")], {"E_JOINT_SELF"}, "itself"),
        (("g", "a", "a"), "g", [joint("j1", "g", "a")], {"E_DUP_NAME"}, "2 parts are called 'a'."),
        (("g", "a"), "g", [joint("j1", "g", "a"), joint("j1", "a", "g")], {"E_DUP_NAME", "E_JOINT_DUP"}, "connect the same two connectors"),
        (("g", "a", "b"), "g", [joint("j1", "x", "a"), joint("j2", "b", "b")], {"E_PART_UNKNOWN", "E_JOINT_SELF"}, "itself"),
    ],
)
def test_all_structural_faults_are_found_at_once(
    parts: tuple[str, ...], ground: str, joints: list[Joint], codes: set[str], text: str
) -> None:
    findings = JointGraph(parts, ground, joints).findings()
    assert set(findings.codes) == codes
    assert text in str(findings)
    with pytest.raises(PlanError) as caught:
        Mechanism(parts, ground, joints)
    assert set(caught.value.findings.codes) == codes


def test_edges_that_are_no_tree_are_refused() -> None:
    a, b = joint("a", "g", "x"), joint("b", "g", "x")
    with pytest.raises(KinematicsError, match="reached twice"):
        KinematicTree("g", [Edge(a, "g", "x"), Edge(b, "g", "x")])
    with pytest.raises(KinematicsError, match="not connected to the ground"):
        KinematicTree("g", [Edge(a, "y", "x"), Edge(b, "x", "y")])
    with pytest.raises(KinematicsError, match="not a part"):
        KinematicTree("g", []).depth("x")


def test_the_tree_is_deterministic_and_linear_in_size() -> None:
    n = 400
    joints = [joint(f"j{i}", f"p{i}", f"p{i + 1}") for i in range(n)]
    mechanism = Mechanism([f"p{i}" for i in range(n + 1)], "p0", joints)
    assert mechanism.tree.parts == mechanism.parts
    assert mechanism.tree.depth(f"p{n}") == n


def test_a_tree_declared_outwards_is_the_one_that_a_search_finds() -> None:
    rng = np.random.default_rng(2)
    for n in (2, 5, 30):
        parts = [f"p{i}" for i in range(n)]
        joints = [joint(f"j{i}", parts[rng.integers(i)], parts[i]) for i in range(1, n)]
        joints = [joints[i] for i in rng.permutation(n - 1)]
        tree, loops = JointGraph(parts, "p0", joints).spanning_tree()
        searching = JointGraph(parts, "p0", joints)
        searching.__dict__["_outward"] = None
        searched, none = searching.spanning_tree()
        assert not loops
        assert not none
        assert tree.edges == searched.edges
        assert tree.parts == searched.parts


def test_parts_in_a_ring_of_their_own_are_not_connected_though_a_joint_leads_to_each() -> None:
    joints = [joint("a", "g", "x"), joint("b", "y", "z"), joint("c", "z", "y")]
    (found,) = [f for f in JointGraph(("g", "x", "y", "z"), "g", joints).findings() if f.code != "E_JOINT_DUP"]
    assert found.code == "E_DISCONNECTED"
