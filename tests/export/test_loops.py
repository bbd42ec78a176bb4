"""Loops in MuJoCo: the equality constraints of every kind of closing joint hold at `home`, and tie what they should."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree

from articad.assembly import Assembly
from articad.entry import read
from articad.errors import ExportError
from articad.export.lowering import lower
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.kinematics import declare
from articad.kinematics.joints import Joint
from articad.kinematics.mechanism import Mechanism
from tests.assemblies import block, closed, four_bar, frame, geared_pair, rigid_ring
from tests.engines import YourdfpyUrdf, joint_values, largest_difference, our_poses
from tests.export import judges

Closing = Callable[[Any, Any], Any]

# each kind, and how many freedoms it leaves to a chain that is free in all six directions
KINDS: dict[str, tuple[Closing, int]] = {
    "endless revolute": (lambda a, b: declare.revolute("d", a, b, limits="endless", mate="opposed"), 1),
    "revolute": (lambda a, b: declare.revolute("d", a, b, limits=(-3, 3), rest=0.5, mate="opposed"), 1),
    "slider": (lambda a, b: declare.slider("d", a, b, limits=(-20, 20), rest=5.0), 1),
    "cylindrical": (lambda a, b: declare.cylindrical("d", a, b, travel=(-20, 20), angle="endless", rest=(5.0, 0.3)), 2),
    "ball": (lambda a, b: declare.ball("d", a, b, cone=1.0), 3),
    "screw": (lambda a, b: declare.screw("d", a, b, lead=4.0, limits=(-9, 9), rest=1.0, mate="opposed"), 1),
    "planar": (lambda a, b: declare.planar("d", a, b, x=(-9, 9), y=(-9, 9), angle="endless"), 3),
    "universal": (lambda a, b: declare.universal("d", a, b, a=(-1, 1), b=(-1, 1), mate="opposed"), 2),
}


def loaded(assembly: Assembly, folder: Path) -> tuple[Any, Any]:
    import mujoco

    bundle = write_mjcf(assembly)
    bundle.write(folder)
    model = mujoco.MjModel.from_xml_path(str(folder / bundle.main))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, model.key("home").id)
    mujoco.mj_forward(model, data)
    return model, data


def equality_rows(model: Any, data: Any) -> Any:
    import mujoco

    rows = data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
    J = np.zeros((data.nefc, model.nv))
    if mujoco.mj_isSparse(model):
        mujoco.mju_sparse2dense(J, data.efc_J, data.efc_J_rownnz, data.efc_J_rowadr, data.efc_J_colind)
    else:
        J = data.efc_J.reshape(data.nefc, model.nv)
    return data.efc_pos[rows], J[rows]


@pytest.mark.engines
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("declared", ["from the ground", "to the ground"])
def test_loops_of_every_kind_are_closed_at_home(kind: str, declared: str, tmp_path: Path) -> None:
    closing, _ = KINDS[kind]
    residual, _ = equality_rows(*loaded(closed(closing, turned=declared == "to the ground"), tmp_path))

    assert len(residual) >= 3
    assert np.abs(residual).max() < 1e-9


@pytest.mark.engines
@pytest.mark.parametrize("kind", KINDS)
def test_a_closing_joint_leaves_the_freedoms_that_it_has(kind: str, tmp_path: Path) -> None:
    closing, freedoms = KINDS[kind]
    model, data = loaded(closed(closing), tmp_path)
    _, J = equality_rows(model, data)
    scale = np.where(model.jnt_type[model.dof_jntid] == 2, 0.01, 1.0)  # slides in cm, so that the rank is one of like numbers
    s = np.linalg.svd(J * scale, compute_uv=False)

    assert model.nv - int((s > 1e-7 * s[0]).sum()) == freedoms


@pytest.mark.engines
def test_a_ring_of_fixed_joints_is_welded(tmp_path: Path) -> None:
    bundle = write_mjcf(rigid_ring())

    assert bundle.files[bundle.main].count(b"<weld ") == 1
    assert not bundle.losses


@pytest.mark.engines
@pytest.mark.parametrize("limits", ["endless", (-3.0, 3.0)])
def test_a_four_bar_stays_closed_while_it_falls(limits: Any, tmp_path: Path) -> None:
    import mujoco

    model, data = loaded(four_bar(limits), tmp_path)
    model.opt.gravity[:] = 0, -9.81, 0
    start = data.qpos.copy()
    for _ in range(500):
        mujoco.mj_step(model, data)
    residual, _ = equality_rows(model, data)

    assert np.abs(data.qpos - start).max() > 0.05
    assert np.abs(residual).max() < 1e-4


def length_of(mechanism: Mechanism, loop: Joint) -> float:
    """Return the length of a loop at rest [mm]: once around its joints."""
    rest = mechanism.rest_poses()
    chain = [*mechanism.tree.joints_between(loop.parent, loop.child), loop]
    points = np.array([(rest[joint.parent] @ joint.T_parent_connector).translation for joint in chain])
    return float(np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1).sum())


def gaps_of(name: str, folder: Path, seconds: float = 1.0) -> tuple[float, float]:
    """Return the largest gap of a loop as a share of its length, while a model falls from rest at the file's own time step.

    Returns:
        While nothing stops it, and while a joint is at an end of its range, where it arrives with an impact.
    """
    import mujoco

    assembly = read(judges.folder_of(name))
    model, data = loaded(assembly, folder)
    lengths = {row.name: length_of(assembly.mechanism, row.joint) / 1000 for row in lower(assembly).loops}
    closing = [row for row in range(model.neq) if model.eq_type[row] != mujoco.mjtEq.mjEQ_JOINT]
    worst = [0.0, 0.0]
    for _ in range(round(seconds / model.opt.timestep)):
        mujoco.mj_step(model, data)
        stopped = bool((data.efc_type == mujoco.mjtConstraint.mjCNSTR_LIMIT_JOINT).any())
        for row in closing:
            own = (data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY) & (data.efc_id == row)
            gap = float(np.linalg.norm(data.efc_pos[own][:3]))
            worst[stopped] = max(worst[stopped], gap / lengths[model.equality(row).name.partition("__")[0]])
    return worst[False], worst[True]


@pytest.mark.engines
@pytest.mark.slow
@pytest.mark.parametrize("name", judges.example_names())
def test_loops_of_the_examples_open_by_less_than_a_ten_thousandth_of_their_length(name: str, tmp_path: Path) -> None:
    """The scissor lift opens by 1.11e-4 for a moment, when it has fallen to the end of its range."""
    falling, stopped = gaps_of(name, tmp_path)

    assert falling < 1e-4
    assert stopped < (1.2e-4 if name == "scissor_lift" else 1e-4)


def test_ghosts_take_their_mass_from_the_part_they_stand_for(tmp_path: Path) -> None:
    assembly = closed(KINDS["cylindrical"][0])
    model, _ = loaded(assembly, tmp_path)

    assert model.body_mass.sum() == pytest.approx(sum(part.mass.mass for part in assembly.parts.values() if part.mass), rel=1e-12)


@pytest.mark.parametrize("kind", KINDS)
def test_a_comment_says_why_a_body_of_half_the_mass_stands_there(kind: str) -> None:
    assembly = closed(KINDS[kind][0])
    bundle = write_mjcf(assembly)
    root = etree.fromstring(bundle.files[bundle.main])
    parts = {body.get("name") for body in root.iter("body")} & set(assembly.parts)
    ghosts = [body for body in root.iter("body") if body.get("name") not in parts and body.find("geom") is None]
    comments = [node.text for node in root.iter() if node.tag is etree.Comment and "Closes a loop by joint d" in (node.text or "")]
    assert (
        len(comments)
        == bundle.files[bundle.main].count(b"Closes a loop")
        == len([body for body in ghosts if body.find("joint") is not None])
    )


def test_urdf_leaves_the_closing_joint_out_and_says_so() -> None:
    bundle = write_urdf(closed(KINDS["revolute"][0]))

    assert [loss.where for loss in bundle.losses if loss.refused] == ["joints.d"]
    assert b'<joint name="d"' not in bundle.files[bundle.main]


def test_the_limits_of_a_ball_that_closes_a_loop_are_lost_in_mjcf() -> None:
    assert [loss.lost for loss in write_mjcf(closed(KINDS["ball"][0])).losses if loss.refused] == [
        "the cone and twist of a ball that closes a loop"
    ]


POINTS: dict[str, tuple[Assembly, int]] = {
    "a ring": (rigid_ring(), 3),
    "a hinge": (closed(KINDS["endless revolute"][0]), 2),
    "a ball": (closed(KINDS["ball"][0], turned=True), 1),
    "a slide": (closed(KINDS["cylindrical"][0]), 0),
}


@pytest.mark.engines
@pytest.mark.parametrize(
    ("kind", "flavour"),
    list(product(POINTS, ["isaac", "drake"])),
)
def test_points_that_close_a_loop_meet_at_rest(kind: str, flavour: Any, tmp_path: Path) -> None:
    import pinocchio as pin

    assembly, count = POINTS[kind]
    bundle = write_urdf(assembly, loops=flavour)
    bundle.write(tmp_path)
    root = etree.fromstring(bundle.files[bundle.main])
    model = pin.buildModelFromUrdf(str(tmp_path / bundle.main))  # unchanged, whatever the flavour
    data = model.createData()
    q = pin.neutral(model)
    for freedom in (freedom for joint in lower(assembly).joints for freedom in joint.freedoms):
        q[model.joints[model.getJointId(freedom.name)].idx_q] = freedom.rest
    pin.framesForwardKinematics(model, data, q)
    points = isaac_points(root) if flavour == "isaac" else drake_points(root)

    assert len(points) == count
    for (near, p_near), (far, p_far) in points:
        placed = [data.oMf[model.getFrameId(link)].act(np.array(p)) for link, p in ((near, p_near), (far, p_far))]
        assert np.abs(placed[0] - placed[1]).max() < 1e-12
    lost = [loss for loss in bundle.losses if loss.where == "joints.d"]
    assert [loss.refused for loss in lost] == [count == 0]


def isaac_points(root: Any) -> list[Any]:
    return [
        [(end.get("link"), floats(end.get("xyz"))) for end in (loop.find("link1"), loop.find("link2"))]
        for loop in root.iterfind("loop_joint")
    ]


def drake_points(root: Any) -> list[Any]:
    namespace = {"drake": "http://drake.mit.edu"}
    return [
        [
            (
                tie.find(f"drake:ball_constraint_{body}", namespace).get("name"),
                floats(tie.find(f"drake:ball_constraint_{point}", namespace).get("value")),
            )
            for body, point in (("body_A", "p_AP"), ("body_B", "p_BQ"))
        ]
        for tie in root.iterfind("drake:ball_constraint", namespace)
    ]


def floats(text: str) -> list[float]:
    return [float(word) for word in text.split()]


def parallelogram() -> Assembly:
    """Links of 30, 100, 30 and 100 mm: the rocker turns as the crank does, and the coupler not at all."""
    lengths = (("crank", 30), ("coupler", 100), ("rocker", 30))
    parts = [
        block("base", (120, 20, 4), tip=frame(), far=frame(at=(100, 0, 0))),
        *(block(name, (size, 6, 4), root=frame(), tip=frame(at=(size, 0, 0))) for name, size in lengths),
    ]
    joints = [
        declare.revolute("a", parts[0]["tip"], parts[1]["root"], limits=(0.5, 2.0), rest=1.0, driver=True),
        declare.revolute("b", parts[1]["tip"], parts[2]["root"], limits=(-3.0, 3.0), rest=-1.0),
        declare.revolute("c", parts[3]["tip"], parts[2]["tip"], limits=(-3.0, 3.0), rest=-1.0),
        declare.revolute("d", parts[0]["far"], parts[3]["root"], limits=(-3.0, 3.0), rest=1.0),
    ]
    return Assembly.from_parts("parallelogram", parts=parts, joints=joints, ground="base")


@pytest.mark.engines
def test_a_parallelogram_is_written_as_mimics(tmp_path: Path) -> None:
    assembly = parallelogram()
    bundle = write_urdf(assembly, loops="mimic")
    bundle.write(tmp_path)
    root = etree.fromstring(bundle.files[bundle.main])
    mimics = {mimic.getparent().get("name"): mimic for mimic in root.iterfind("joint/mimic")}
    urdf = YourdfpyUrdf(tmp_path / bundle.main)

    assert len(mimics) == 2
    assert {mimic.get("joint") for mimic in mimics.values()} == {"a"}
    for angle in (0.6, 1.3, 1.9):
        assert largest_difference(our_poses(assembly, np.array([angle])), urdf.poses({"a": angle})) < 1e-9
    assert [loss.refused for loss in bundle.losses if "mimic" in loss.kept] == [False]


def test_a_loop_that_is_no_straight_line_is_refused_with_the_gap() -> None:
    bar = four_bar()
    crank, *others = bar.joints
    crank = replace(crank, limits=replace(crank.limits, lower=(0.6,), upper=(1.4,)))
    with pytest.raises(ExportError) as error:
        write_urdf(replace(bar, mechanism=Mechanism(bar.mechanism.parts, "base", [crank, *others])), loops="mimic")
    (finding,) = error.value.findings

    assert finding.code == "E_MIMIC_FIT"
    assert finding.value is not None
    assert finding.value > 0.1


def test_a_driver_that_cannot_go_its_range_is_refused() -> None:
    with pytest.raises(ExportError, match="does not reach its whole range"):
        write_urdf(four_bar(), loops="mimic")


def test_a_loop_of_several_drivers_is_refused() -> None:
    with pytest.raises(ExportError, match="drivers"):
        write_urdf(closed(KINDS["ball"][0]), loops="mimic")


def test_a_tree_has_no_loops_to_mimic() -> None:
    assert write_urdf(geared_pair(), loops="mimic").files == write_urdf(geared_pair()).files


CLOSED = {
    "parallelogram": (parallelogram(), [[0.6], [0.9], [1.3], [1.6], [1.9]]),
    "four-bar": (four_bar(), [[0.6], [0.8], [1.0], [1.3], [1.5]]),
    "six slides and screws": (closed(KINDS["cylindrical"][0]), None),
}


@pytest.mark.engines
@pytest.mark.parametrize("name", CLOSED)
def test_loops_are_closed_at_configurations_that_articad_closes(name: str, tmp_path: Path) -> None:
    import mujoco

    assembly, given = CLOSED[name]
    rest = assembly.mechanism.rest
    configurations = [rest + 0.05 * step for step in range(1, 6)] if given is None else given
    model, data = loaded(assembly, tmp_path)
    for q in configurations:
        values = joint_values(assembly, np.array(q))
        for index in range(model.njnt):
            data.qpos[model.jnt_qposadr[index]] = values[model.joint(index).name]
        mujoco.mj_forward(model, data)
        residual, _ = equality_rows(model, data)

        assert np.abs(residual).max() < 1e-9
