"""SDFormat: poses that the test chose itself, expressed in frames at random; PyBullet; and the list of all elements of the format."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from articad import cli
from articad.assembly import Assembly
from articad.errors import ReadError
from articad.export.sdf import write_sdf
from articad.export.urdf import write_urdf
from articad.formats import NAMED, read
from articad.geometry.mesh_files import write_stl
from articad.geometry.shapes import box
from articad.importers.sdf import read_sdf
from articad.importers.sdf_kept import READ_SDF
from articad.importers.urdf import read_urdf
from tests.assemblies import all_joint_kinds, closed, four_bar, geared_pair
from tests.engines import our_poses

FloatArray = NDArray[np.float64]
KINDS = ("revolute", "continuous", "prismatic", "fixed", "ball", "universal", "revolute2", "screw")


def written(text: str, folder: Path, name: str = "a.sdf") -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text if "<sdf" in text else f'<sdf version="1.11"><model name="m">{text}</model></sdf>')
    return path


def random_pose(random: np.random.Generator) -> FloatArray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = Rotation.random(random_state=int(random.integers(1 << 30))).as_matrix(), random.uniform(-1, 1, 3)
    return T


def turn(axis: FloatArray, angle: float) -> FloatArray:
    T = np.eye(4)
    T[:3, :3] = Rotation.from_rotvec(axis * angle).as_matrix()
    return T


def shift(vector: FloatArray) -> FloatArray:
    T = np.eye(4)
    T[:3, 3] = vector
    return T


def own_motion(kind: str, axes: FloatArray, values: list[float]) -> FloatArray:
    """Return how a joint moves in its own frame; its axes are the columns."""
    x, y, (a, b) = axes[:, 0], axes[:, 1], values
    if kind == "prismatic":
        return shift(x * a)
    if kind == "screw":
        return turn(x, a) @ shift(x * a * 0.25 / (2 * np.pi))
    if kind in {"universal", "revolute2"}:
        return turn(x, a) @ turn(y, b)
    return turn(x, a) if kind in {"revolute", "continuous"} else np.eye(4)


class RandomModel:
    """A tree of links whose poses in the world are drawn first; then each is written relative to some frame that is known already."""

    def __init__(self, seed: int) -> None:
        self.random = np.random.default_rng(seed)
        self.model = random_pose(self.random)
        self.frames: dict[str, FloatArray] = {"__model__": self.model}
        self.links: dict[str, FloatArray] = {}
        self.joints: list[dict[str, Any]] = []
        rows = []
        for index in range(7):
            rows.append(self._link(f"l{index}"))
            if self.random.random() < 0.5:
                rows.append(self._frame(f"f{index}", f"l{index}"))
            if index:
                rows.append(self._joint(f"j{index}", f"l{self.random.integers(index)}", f"l{index}"))
        rows.append('<joint name="hold" type="fixed"><parent>world</parent><child>l0</child></joint>')
        order = self.random.permutation(len(rows))  # names may be used before they are declared
        body = "".join(rows[i] for i in order)
        self.text = f'<sdf version="1.11"><model name="m" canonical_link="l0">{self._pose(self.model, np.eye(4))}{body}</model></sdf>'

    def _pose(self, T: FloatArray, base: FloatArray, relative_to: str = "") -> str:
        """Write a pose relative to another, in one of the ways of the format."""
        inside = np.linalg.inv(base) @ T
        place = " ".join(repr(float(x)) for x in inside[:3, 3])
        to = f' relative_to="{relative_to}"' if relative_to else ""
        way, R = self.random.integers(3), Rotation.from_matrix(inside[:3, :3])
        if way == 0:
            return f"<pose{to}>{place} {' '.join(repr(float(x)) for x in R.as_euler('xyz'))}</pose>"
        if way == 1:
            return f"<pose{to} degrees='true'>{place} {' '.join(repr(float(x)) for x in R.as_euler('xyz', degrees=True))}</pose>"
        return f"<pose{to} rotation_format='quat_xyzw'>{place} {' '.join(repr(float(x)) for x in R.as_quat())}</pose>"

    def _somewhere(self, T: FloatArray, usual: str) -> str:
        """Write a pose relative to the frame that the format takes, or to any other."""
        if self.random.random() < 0.4:
            return self._pose(T, self.frames[usual])
        name = self.random.choice(list(self.frames))
        return self._pose(T, self.frames[name], name)

    def _link(self, name: str) -> str:
        T = random_pose(self.random)
        text = f'<link name="{name}">{self._somewhere(T, "__model__")}</link>'
        self.links[name] = self.frames[name] = T
        return text

    def _frame(self, name: str, link: str) -> str:
        T = random_pose(self.random)
        text = f'<frame name="{name}" attached_to="{link}">{self._somewhere(T, link)}</frame>'
        self.frames[name] = T
        return text

    def _joint(self, name: str, parent: str, child: str) -> str:
        T, kind = random_pose(self.random), str(self.random.choice(KINDS))
        axis = Rotation.random(random_state=int(self.random.integers(1 << 30))).as_matrix()
        ends = [self._on(parent), self._on(child)]
        pose = self._pose(T, self.frames[ends[1]]) if self.random.random() < 0.4 else self._somewhere_else(T)
        text = f"<parent>{ends[0]}</parent><child>{ends[1]}</child>{pose}"
        for tag, vector in (("axis", axis[:, 0]), ("axis2", axis[:, 1]))[
            : {"fixed": 0, "ball": 0, "universal": 2, "revolute2": 2}.get(kind, 1)
        ]:
            base = self.random.choice(list(self.frames)) if self.random.random() < 0.5 else ""
            inside = self.frames[base][:3, :3].T @ T[:3, :3] @ vector if base else vector
            stated = f' expressed_in="{base}"' if base else ""
            numbers = " ".join(repr(float(x)) for x in 3 * inside)  # of any length
            text += f"<{tag}><xyz{stated}>{numbers}</xyz></{tag}>"
        text += "<screw_thread_pitch>0.25</screw_thread_pitch>" if kind == "screw" else ""
        self.joints.append({"name": name, "kind": kind, "parent": parent, "child": child, "T": T, "axes": axis})
        self.frames[name] = T
        return f'<joint name="{name}" type="{kind}">{text}</joint>'

    def _somewhere_else(self, T: FloatArray) -> str:
        name = self.random.choice(list(self.frames))
        return self._pose(T, self.frames[name], name)

    def _on(self, link: str) -> str:
        """Return the link, or a frame that is attached to it."""
        frame = link.replace("l", "f")
        return frame if frame in self.frames and self.random.random() < 0.5 else link

    def moved(self, values: dict[str, list[float]]) -> dict[str, FloatArray]:
        """Return the poses of all links in the world where joints have these values [rad, m]."""
        motion = {name: np.eye(4) for name in self.links}
        for joint in self.joints:  # in the order of the tree
            v, T = values[joint["name"]], joint["T"]
            own = own_motion(joint["kind"], joint["axes"], v)
            motion[joint["child"]] = motion[joint["parent"]] @ T @ own @ np.linalg.inv(T)
        return {name: motion[name] @ T for name, T in self.links.items()}


def configuration(assembly: Assembly, model: RandomModel) -> tuple[FloatArray, dict[str, list[float]]]:
    """Return random values of all joints but balls, as ours and as the test's."""
    values = {joint["name"]: list(map(float, model.random.uniform(-1, 1, 2))) for joint in model.joints}
    at: dict[str, Any] = {}
    for joint in model.joints:
        a, b = values[joint["name"]]
        if joint["kind"] in {"revolute", "continuous", "screw"}:
            at[joint["name"]] = a
        elif joint["kind"] == "prismatic":
            at[joint["name"]] = 1000 * a
        elif joint["kind"] == "universal":
            at[joint["name"]] = (a, b)
        elif joint["kind"] == "revolute2":
            at |= {f"{joint['name']}__1": a, f"{joint['name']}__2": b}
    return assembly.q(**at), values


@pytest.mark.parametrize("seed", range(25))
def test_links_are_where_the_test_put_them_whatever_frames_say_so(seed: int, tmp_path: Path) -> None:
    model = RandomModel(seed)
    assembly = read_sdf(written(model.text, tmp_path))
    q, values = configuration(assembly, model)
    poses, truth = assembly.poses(q), model.moved(values)

    for name, T in truth.items():
        ours = poses[assembly.mechanism.parts.index(name)].matrix.copy()
        ours[:3, 3] /= 1000
        assert np.allclose(ours, T, atol=1e-9), (name, [joint["kind"] for joint in model.joints])
    assert assembly.mechanism.ground == "world"


@pytest.mark.parametrize("seed", range(8))
def test_out_and_in_again_by_the_file_alone_nothing_has_moved(seed: int, tmp_path: Path) -> None:
    """The copy is read without articad's records: link frames, joints and axes are what the XML says."""
    model = RandomModel(100 + seed)
    assembly = read_sdf(written(model.text, tmp_path))
    bundle = write_sdf(assembly)
    bundle.write(tmp_path / "out")
    again = read_sdf(tmp_path / "out" / bundle.main, metadata=False)
    q, values = configuration(again, model)
    truth = model.moved(values)

    assert not [loss for loss in bundle.losses if "frame" in loss.lost and "<frame" not in loss.lost]
    assert set(again.parts) == set(assembly.parts)
    for name, T in truth.items():
        ours = again.poses(q)[again.mechanism.parts.index(name)].matrix.copy()
        ours[:3, 3] /= 1000
        assert np.allclose(ours, T, atol=1e-9), name


# ---------------------------------------------------------------------- PyBullet


def random_old_sdf(random: np.random.Generator) -> str:
    """Return a tree in the words of 1.6, which PyBullet reads."""

    def vector(size: float) -> str:
        return " ".join(f"{x:.4f}" for x in random.uniform(-size, size, 3))

    inertia = "<ixx>0.2</ixx><ixy>0.01</ixy><ixz>0</ixz><iyy>0.3</iyy><iyz>0.02</iyz><izz>0.25</izz>"
    rows = []
    for index in range(6):
        inertial = f"<inertial><pose>{vector(0.1)} {vector(1)}</pose><mass>{random.uniform(0.5, 3):.3f}</mass><inertia>{inertia}</inertia></inertial>"
        shape = (
            f"<collision name='c'><pose>{vector(0.2)} {vector(1)}</pose><geometry><box><size>.1 .2 .3</size></box></geometry></collision>"
        )
        rows.append(f'<link name="l{index}"><pose>{vector(1)} {vector(3)}</pose>{inertial}{shape}</link>')
        kind = random.choice(["revolute", "prismatic"])
        limit = f"<limit><lower>-{random.uniform(0.1, 1):.3f}</lower><upper>{random.uniform(0.1, 1):.3f}</upper><effort>{3 + index}</effort></limit>"
        dynamics = f"<dynamics><damping>{random.uniform(0, 1):.3f}</damping><friction>{random.uniform(0, 1):.3f}</friction></dynamics>"
        if not index:
            continue
        parent = f"l{random.integers(index)}"
        unit = random.normal(size=3)
        axis = f"<axis><xyz>{' '.join(repr(float(x)) for x in unit / np.linalg.norm(unit))}</xyz>{limit}{dynamics}</axis>"
        rows.append(f'<joint name="j{index}" type="{kind}"><parent>{parent}</parent><child>l{index}</child>{axis}</joint>')
    return f'<sdf version="1.6"><model name="m"><pose>{vector(1)} {vector(3)}</pose>{"".join(rows)}</model></sdf>'


@pytest.mark.engines
@pytest.mark.parametrize("seed", range(6))
def test_pybullet_reads_the_same(seed: int, tmp_path: Path) -> None:
    pybullet = pytest.importorskip("pybullet")
    random = np.random.default_rng(seed)
    path = written(random_old_sdf(random), tmp_path)
    assembly = read_sdf(path)
    client = pybullet.connect(pybullet.DIRECT)
    try:
        (body,) = pybullet.loadSDF(str(path), physicsClientId=client)
        names, at = {}, {}
        for index in range(pybullet.getNumJoints(body, physicsClientId=client)):
            info = pybullet.getJointInfo(body, index, physicsClientId=client)
            names[info[12].decode()] = index, info
            value = random.uniform(info[8], info[9])
            pybullet.resetJointState(body, index, value, physicsClientId=client)
            at[info[1].decode()] = value
        moving = {joint.name: joint for joint in assembly.joints if joint.name in at and joint.limits.lower}
        q = assembly.q(
            **{name: value * (1000 if joint.type == "slider" else 1) for name, value in at.items() if (joint := moving.get(name))}
        )
        poses = our_poses(assembly, q)
        base = np.eye(4)
        place, quaternion = pybullet.getBasePositionAndOrientation(body, physicsClientId=client)
        base[:3, :3], base[:3, 3] = Rotation.from_quat(quaternion).as_matrix(), place
        for name, (index, info) in names.items():
            state = pybullet.getLinkState(body, index, computeForwardKinematics=True, physicsClientId=client)
            T = np.eye(4)
            T[:3, :3], T[:3, 3] = Rotation.from_quat(state[5]).as_matrix(), state[4]
            assert np.allclose(
                np.linalg.inv(poses["l0"]) @ poses[name], np.linalg.inv(_frame_of_base(pybullet, body, client, base)) @ T, atol=1e-5
            )
            joint = moving[info[1].decode()]
            unit = 1000 if joint.type == "slider" else 1
            assert (joint.limits.lower[0] / unit, joint.limits.upper[0] / unit) == pytest.approx((info[8], info[9]), abs=1e-6)
            mass = pybullet.getDynamicsInfo(body, index, physicsClientId=client)[0]
            own = assembly.parts[name].mass
            assert own is not None
            assert own.mass == pytest.approx(mass, rel=1e-6)
    finally:
        pybullet.disconnect(client)


def _frame_of_base(pybullet: Any, body: int, client: int, inertial: FloatArray) -> FloatArray:
    """Return the link frame of the base; PyBullet poses its inertial frame."""
    info = pybullet.getDynamicsInfo(body, -1, physicsClientId=client)
    local = np.eye(4)
    local[:3, :3], local[:3, 3] = Rotation.from_quat(info[4]).as_matrix(), info[3]
    return inertial @ np.linalg.inv(local)


@pytest.mark.engines
def test_models_that_pybullet_ships_are_read() -> None:
    data = Path(pytest.importorskip("pybullet_data").getDataPath())

    gripper = read_sdf(data / "gripper/wsg50_one_motor_gripper.sdf", root=data)
    arm = read_sdf(data / "kuka_iiwa/model.sdf", root=data)
    shelf = read_sdf(data / "kiva_shelf/model.sdf", root=data)

    assert (len(gripper.parts), gripper.mechanism.mobility) == (10, 6)
    assert sum(joint.type == "revolute" for joint in arm.joints) == 7
    assert [str(joint.type) for joint in arm.joints].count("free") == 1  # nothing holds it
    assert [joint.type for joint in shelf.joints] == ["fixed"]  # it is static
    with pytest.raises(ReadError, match="leads out"):
        read_sdf(data / "kuka_iiwa/kuka_with_gripper.sdf", root=data)


# ---------------------------------------------------------------------- models in models, includes, worlds

LINK = '<link name="{}"><collision name="c"><geometry><box><size>.1 .1 .1</size></box></geometry></collision></link>'


def test_models_in_models_are_placed_by_their_placement_frames(tmp_path: Path) -> None:
    inner = '<model name="hand" placement_frame="grip"><pose relative_to="tip">0 0 1 0 0 0</pose>' + LINK.format("palm")
    inner += '<frame name="grip" attached_to="palm"><pose>0 0 0.5 0 0 0</pose></frame></model>'
    text = f'<pose>1 0 0 0 0 0</pose>{LINK.format("arm")}<frame name="tip" attached_to="arm"><pose>0 2 0 0 0 1.5707963267948966</pose></frame>{inner}'
    text += '<joint name="wrist" type="revolute"><parent>arm</parent><child>hand::grip</child><axis><xyz>1 0 0</xyz></axis></joint>'
    text += '<joint name="stand" type="fixed"><parent>world</parent><child>arm</child></joint>'
    assembly = read_sdf(written(text, tmp_path))

    zero = assembly.at()
    assert zero["arm"].translation == pytest.approx([1000, 0, 0])
    assert zero["hand::palm"].translation == pytest.approx([1000, 2000, 500])  # its grip is 1 m above the tip, half a metre above the palm
    turned = assembly.at(wrist=np.pi / 2)  # about x of the grip, which is y of the world
    assert turned["hand::palm"].translation == pytest.approx([500, 2000, 1000])


@pytest.mark.parametrize("uri", ["model://crate", "crate", "file://crate/model.sdf", "model://crate/model.sdf"])
def test_an_included_model_is_read_where_it_lies_in_the_root(uri: str, tmp_path: Path) -> None:
    mesh = '<link name="box"><visual name="v"><geometry><mesh><uri>meshes/b.stl</uri></mesh></geometry></visual></link>'
    written(mesh, tmp_path / "models/crate", "model.sdf")
    (tmp_path / "models/crate/model.config").write_text(
        '<model><sdf version="1.5">old.sdf</sdf><sdf version="1.11">model.sdf</sdf></model>'
    )
    (tmp_path / "models/crate/meshes").mkdir()
    (tmp_path / "models/crate/meshes/b.stl").write_bytes(write_stl(box(1, 2, 3)))
    include = f"<include><uri>{uri}</uri><name>{{}}</name><pose>{{}} 0 0 0 0 0</pose><static>{{}}</static></include>"
    text = f'<sdf version="1.9"><world name="w">{include.format("a", 1, "true")}{include.format("b", 2, "false")}<gravity>0 0 -3</gravity></world></sdf>'
    path = written(text, tmp_path / "models")

    assembly = read_sdf(path)

    assert list(assembly.parts) == ["world", "a::box", "b::box"]
    assert {joint.child: str(joint.type) for joint in assembly.joints} == {"a::box": "fixed", "b::box": "free"}
    assert [assembly.at()[name].translation[0] for name in ("a::box", "b::box")] == [1000, 2000]
    mesh_of = assembly.parts["a::box"].visuals[0].mesh
    assert mesh_of.bounds[1] - mesh_of.bounds[0] == pytest.approx([1000, 2000, 3000])
    assert any("<gravity>" in loss.lost for loss in write_sdf(assembly).losses)
    with pytest.raises(ReadError, match="no link"):
        read_sdf(written(text, tmp_path / "elsewhere"))
    more = text.replace("</world>", f'<model name="c">{LINK.format("c")}</model></world>')
    assert read_sdf(written(more, tmp_path / "elsewhere")).findings.codes == ("W_IMPORT_DROPPED",)  # two includes of one name


def test_an_include_that_leads_out_of_the_root_or_round_is_refused(tmp_path: Path) -> None:
    written(LINK.format("l"), tmp_path / "secret", "model.sdf")
    path = written(f"{LINK.format('l')}<include><uri>../secret/model.sdf</uri></include>", tmp_path / "in")
    with pytest.raises(ReadError) as refused:
        read_sdf(path)
    assert refused.value.findings.codes == ("E_UNSAFE_PATH",)
    path = written(f"{LINK.format('l')}<include><uri>a.sdf</uri><name>n</name></include>", tmp_path / "in")
    with pytest.raises(ReadError, match="nested deeper"):
        read_sdf(path)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ('<link name="a"><pose relative_to="b"/></link><link name="b"><pose relative_to="a"/></link>', "relative to itself"),
        (
            '<link name="a"/><frame name="f" attached_to="g"/><frame name="g" attached_to="f"/><joint name="j" type="fixed"><parent>a</parent><child>f</child></joint>',
            "itself",
        ),
        ('<link name="a"><pose relative_to="nothing"/></link>', "no frame 'nothing'"),
        ('<link name="a"><pose>1 2 3</pose></link>', "6 plausible numbers"),
        ('<link name="a"><pose>nan 0 0 0 0 0</pose></link>', "plausible"),
        ('<link name="a"/><link name="a"/>', "have the name 'a'"),
        ("<link/>", "no name"),
        ('<link name="a"/><joint name="j" type="fixed"><parent>a</parent><child>a</child></joint>', "with itself"),
        ('<link name="a"/><joint name="j" type="revolute"><parent>world</parent><child>a</child></joint>', "0 axes"),
        (
            '<link name="a"/><joint name="j" type="revolute"><parent>world</parent><child>a</child><axis><xyz>0 0 0</xyz></axis></joint>',
            "no direction",
        ),
        ('<link name="a"><inertial><mass>heavy</mass></inertial></link>', "'heavy', not a plausible number"),
        ("", "no link"),
        ('<sdf version="1.6"><model><link name="a"/></model></sdf>', "<model> has no name"),
        ('<sdf version="one"><model name="m"><link name="a"/></model></sdf>', "not a version"),
        ('<sdf version="1.6"/>', "0 worlds and 0 models"),
    ],
)
def test_what_is_wrong_is_refused_with_its_place(text: str, reason: str, tmp_path: Path) -> None:
    with pytest.raises(ReadError, match=reason):
        read_sdf(written(text, tmp_path))


def test_old_files_state_axes_in_the_models_frame(tmp_path: Path) -> None:
    text = '<sdf version="{}"><model name="m"><link name="a"><pose>0 0 0 0 1.5707963267948966 0</pose></link><joint name="j" type="revolute"><parent>world</parent>'
    text += "<child>a</child><axis><xyz>0 0 1</xyz>{}</axis></joint></model></sdf>"
    old = "<use_parent_model_frame>{}</use_parent_model_frame>"

    def axis(version: str, more: str = "") -> list[float]:
        assembly = read_sdf(written(text.format(version, more), tmp_path))
        turned = assembly.at(j=0.1)["a"].rotation @ assembly.at()["a"].rotation.T
        found: list[float] = np.round(Rotation.from_matrix(turned).as_rotvec() / 0.1, 6).tolist()
        return found

    assert axis("1.4") == [0, 0, 1]
    assert axis("1.6") == axis("1.11") == [1, 0, 0]
    assert axis("1.6", old.format("true")) == [0, 0, 1]
    assert axis("1.6", old.format("0")) == [1, 0, 0]


def test_mimics_screws_and_masses_that_are_not_stated(tmp_path: Path) -> None:
    joint = '<joint name="{0}" type="{1}"><parent>world</parent><child>{0}l</child>{2}<axis><xyz>0 0 1</xyz>{3}</axis></joint><link name="{0}l">{4}</link>'
    mimic = '<mimic joint="a"><multiplier>0.5</multiplier><offset>0.3</offset><reference>0.2</reference></mimic>'
    auto = '<inertial auto="true"/>'
    text = joint.format("a", "revolute", "", "", "") + joint.format("b", "prismatic", "", mimic, auto)
    text += joint.format("c", "screw", "<thread_pitch>-20</thread_pitch>", "", "<inertial><mass>2</mass></inertial>")
    assembly = read_sdf(written(text, tmp_path))

    poses = assembly.at(a=0.6, c=1.0)
    assert poses["bl"].translation[2] == pytest.approx(1000 * (0.5 * (0.6 - 0.2) + 0.3))
    assert poses["cl"].translation[2] == pytest.approx(1000 / 20)  # 20 rad per m, right-handed
    masses = {name: part.mass.mass if part.mass else None for name, part in assembly.parts.items()}
    assert masses == {"world": None, "al": 1.0, "bl": None, "cl": 2.0}
    assert np.allclose(assembly.parts["al"].mass.inertia, np.eye(3) * 1e6)  # type: ignore[union-attr]
    assert assembly.findings.codes == ("W_IMPORT_DROPPED",)


# ---------------------------------------------------------------------- our own files, other formats


@pytest.mark.parametrize("make", [all_joint_kinds, geared_pair, four_bar])
def test_our_own_files_come_back_as_they_were(make: Any, tmp_path: Path) -> None:
    assembly = make()
    bundle = write_sdf(assembly)
    bundle.write(tmp_path)
    again = read(tmp_path / bundle.main)

    assert list(again.parts) == list(assembly.parts)
    assert [joint.type for joint in again.joints] == [joint.type for joint in assembly.joints]
    rest, before = again.mechanism.rest_poses(), assembly.mechanism.rest_poses()
    assert all(rest[name].allclose(before[name], mm=1e-9, rad=1e-9) for name in assembly.parts)
    edited = tmp_path / bundle.main
    edited.write_text(edited.read_text().replace("<mass>", "<mass>1", 1))
    assert "W_IMPORT_STALE" in read(edited).findings.codes


def test_loops_are_read_and_close(tmp_path: Path) -> None:
    from articad.kinematics import declare

    for assembly in (four_bar((-3.0, 3.0)), closed(lambda a, b: declare.ball("d", a, b, cone=1.0))):
        bundle = write_sdf(assembly)
        bundle.write(tmp_path)
        again = read_sdf(tmp_path / bundle.main, metadata=False)

        assert len(again.mechanism.loop_joints) == len(assembly.mechanism.loop_joints)
        assert again.mechanism.mobility == assembly.mechanism.mobility


def test_a_world_model_converts_to_urdf_and_a_file_is_audited_by_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = written(random_old_sdf(np.random.default_rng(1)), tmp_path)

    assert cli.main(["convert", str(path), str(tmp_path / "out.urdf")]) == 0
    assert cli.main(["convert", str(path), str(tmp_path / "out.xml")]) == 0
    capsys.readouterr()
    urdf = write_urdf(read_sdf(path))
    assert etree.fromstring(urdf.files[urdf.main]).find("joint[@name='j1']") is not None


# ---------------------------------------------------------------------- the ledger


def empty(tags: str | list[str]) -> dict[str, Any]:
    """Return elements that hold nothing but a text."""
    return {tag: {} for tag in (tags.split() if isinstance(tags, str) else tags)}


POSE = {"": "relative_to rotation_format degrees"}
GEOMETRY: dict[str, Any] = {
    "empty": {},
    "box": {"size": {}},
    "capsule": {"radius": {}, "length": {}},
    "cone": {"radius": {}, "length": {}},
    "cylinder": {"radius": {}, "length": {}},
    "ellipsoid": {"radii": {}},
    "heightmap": {"uri": {}, "size": {}, "pos": {}, "texture": {}, "blend": {}, "use_terrain_paging": {}, "sampling": {}},
    "image": {"uri": {}, "scale": {}, "threshold": {}, "height": {}, "granularity": {}},
    "mesh": {
        "": "optimization",
        "convex_decomposition": {"max_convex_hulls": {}, "voxel_resolution": {}},
        "uri": {},
        "submesh": {"name": {}, "center": {}},
        "scale": {},
    },
    "plane": {"normal": {}, "size": {}},
    "polyline": {"point": {}, "height": {}},
    "sphere": {"radius": {}},
}
MAPS = "albedo_map environment_map ambient_occlusion_map normal_map emissive_map light_map"
AXIS: dict[str, Any] = {
    "xyz": {"": "expressed_in"},
    "dynamics": empty("damping friction spring_reference spring_stiffness"),
    "limit": empty("lower upper effort velocity stiffness dissipation"),
    "mimic": {"": "joint axis", "multiplier": {}, "offset": {}, "reference": {}},
    "initial_position": {},
    "use_parent_model_frame": {},
}
SCHEMA: dict[str, Any] = {
    "": "name canonical_link placement_frame namespace",
    **empty("static self_collide allow_auto_disable enable_wind plugin gripper model_state"),
    "pose": POSE,
    "frame": {"": "name attached_to", "pose": POSE},
    "include": {"": "merge", **empty("uri name namespace static placement_frame plugin model_state"), "pose": POSE},
    "link": {
        "": "name",
        **empty("gravity enable_wind self_collide kinematic must_be_base_link sensor projector audio_sink audio_source battery light particle_emitter"),
        "velocity_decay": {"linear": {}, "angular": {}},
        "pose": POSE,
        "inertial": {
            "": "auto",
            "mass": {}, "density": {}, "auto_inertia_params": {},
            "pose": POSE,
            "inertia": empty("ixx ixy ixz iyy iyz izz"),
            "fluid_added_mass": empty("xx xy xz xp xq xr yy yz yp yq yr zz zp zq zr pp pq pr qq qr rr"),
        },
        "visual": {
            "": "name",
            **empty("cast_shadows laser_retro transparency visibility_flags plugin"),
            "meta": {"layer": {}},
            "pose": POSE,
            "geometry": GEOMETRY,
            "material": {
                **empty("render_order lighting ambient diffuse specular shininess emissive double_sided"),
                "script": {"uri": {}, "name": {}},
                "shader": {"": "type", "normal_map": {}},
                "pbr": {"metal": empty(f"{MAPS} roughness metalness"), "specular": empty(f"{MAPS} glossiness")},
            },
        },
        "collision": {
            "": "name",
            **empty("laser_retro max_contacts density auto_inertia_params"),
            "pose": POSE,
            "geometry": GEOMETRY,
            "surface": {
                "bounce": {"restitution_coefficient": {}, "threshold": {}},
                "friction": {
                    "torsional": empty("coefficient use_patch_radius patch_radius surface_radius ode"),
                    "ode": empty("mu mu2 fdir1 slip1 slip2"),
                    "bullet": empty("friction friction2 fdir1 rolling_friction"),
                },
                "contact": empty("collide_without_contact collide_without_contact_bitmask collide_bitmask category_bitmask poissons_ratio elastic_modulus ode bullet"),
                "soft_contact": {"dart": empty("bone_attachment stiffness damping flesh_mass_fraction")},
            },
        },
    },
    "joint": {
        "": "name type",
        **empty("parent child gearbox_ratio gearbox_reference_body thread_pitch screw_thread_pitch sensor"),
        "pose": POSE,
        "axis": AXIS,
        "axis2": AXIS,
        "physics": {"simbody": {"must_be_loop_joint": {}}, "ode": {"limit": {"cfm": {}, "erp": {}}, "suspension": {"cfm": {}, "erp": {}}, "cfm_damping": {}}, "provide_feedback": {}},
    },
}  # fmt: skip
"""Elements and attributes of a model in sdformat 1.6 to 1.12, from its schema files; "" holds attributes."""


def paths(schema: dict[str, Any], above: str = "") -> Any:
    """Yield every path of the schema with "" and each of its attributes."""
    for tag, inside in schema.items():
        if tag == "":
            yield from ((above, attribute) for attribute in inside.split())
            continue
        path = f"{above}/{tag}".removeprefix("/")
        yield path, ""
        yield from paths(inside, path)


BASE = """<sdf version="1.11"><model name="m"><link name="a"><pose/><inertial><mass>1</mass></inertial>
<visual name="v"><geometry><box><size>1 1 1</size></box></geometry></visual><collision name="c"><geometry><sphere><radius>1</radius></sphere></geometry></collision>
</link><link name="b"/><joint name="j" type="universal"><parent>a</parent><child>b</child><axis><xyz>1 0 0</xyz></axis><axis2><xyz>0 1 0</xyz></axis2></joint></model></sdf>"""
UNREAD = [
    (path, attribute)
    for path, attribute in paths(SCHEMA)
    if attribute not in READ_SDF.get(path, frozenset()) and (attribute or path not in READ_SDF)
]


def test_what_the_reader_claims_to_read_is_in_the_schema() -> None:
    known = {path for path, _ in paths(SCHEMA)} | {""}
    attributes = {(path, attribute) for path, attribute in paths(SCHEMA)}

    assert set(READ_SDF) <= known
    for path, names in READ_SDF.items():
        for name in names - {"frame"}:  # `frame` of a pose is 1.5's word for relative_to
            assert (path, name) in attributes, (path, name)
    assert len(UNREAD) > 100


# elements that are reported with the shape or element that contains them, which is left out with a finding
TOLD_WITH_ITS_SHAPE = ("heightmap", "image", "plane", "polyline", "cone", "submesh")


@pytest.mark.parametrize(("path", "attribute"), UNREAD, ids=lambda text: text or "element")
def test_every_element_of_the_schema_that_is_not_read_comes_back_or_is_a_row(path: str, attribute: str, tmp_path: Path) -> None:
    root = etree.fromstring(BASE)
    element = root.find("model")
    for tag in path.split("/") if path else ():
        inside = element.find(tag)
        if tag in GEOMETRY and inside is None:
            element[:] = []  # a geometry is one thing
        element = etree.SubElement(element, tag) if inside is None else inside
        if tag == "include":
            etree.SubElement(element, "uri").text = "nothing"
        if tag == "mesh":
            (tmp_path / "b.stl").write_bytes(write_stl(box(1, 2, 3)))
            etree.SubElement(element, "uri").text = "b.stl"
    if attribute:
        element.set(attribute, "0.125")
    elif not len(element):
        element.text = "0.125"
    if attribute == "merge":
        element.set(attribute, "true")
        with pytest.raises(ReadError, match="merged"):
            read_sdf(written(etree.tostring(root, encoding="unicode"), tmp_path))
        return
    assembly = read_sdf(written(etree.tostring(root, encoding="unicode"), tmp_path))

    bundle = write_sdf(assembly)
    copy = etree.fromstring(bundle.files[bundle.main])
    tag = path.rpartition("/")[2]
    there = [one for one in copy.iter(tag) if (one.get(attribute) == "0.125" if attribute else True)] if tag else []
    words = " ".join([*(loss.lost for loss in bundle.losses), *(finding.message for finding in assembly.findings)])
    above = [path.rsplit("/", count)[0] for count in range(path.count("/") + 1)]  # what is not read is named with all that is in it
    told = attribute in words if attribute else any(f"<{one.rpartition('/')[2]}" in words for one in above if one not in READ_SDF)
    shape = next((one for one in TOLD_WITH_ITS_SHAPE if one in path.split("/")), "")
    assert there or told or (shape and shape in words) or (path.startswith("include") and "left out" in words), words


INERTIAL = "<inertial><mass>1</mass><inertia><ixx>.1</ixx><iyy>.1</iyy><izz>.1</izz></inertia></inertial>"
SHAPE = '<collision name="c"><geometry><sphere><radius>.1</radius></sphere></geometry></collision>'


def link(name: str, at: str = "0 0 0 0 0 0") -> str:
    return f'<link name="{name}"><pose>{at}</pose>{INERTIAL}{SHAPE}</link>'


def joint(kind: str, parent: str, child: str, more: str = "<axis><xyz>0 0 1</xyz></axis>", name: str = "j") -> str:
    return f'<joint name="{name}" type="{kind}"><parent>{parent}</parent><child>{child}</child>{more}</joint>'


def in_a_file(text: str, folder: Path) -> Path:
    return written(f'<sdf version="1.11">{text}</sdf>', folder)


AXES = "<axis><xyz>1 0 0</xyz></axis><axis2><xyz>0 1 0</xyz></axis2>"
UNUSED = {
    "ball with an axis": ("ball", "<axis><dynamics><damping>1</damping></dynamics></axis>", "<axis> of a joint of type ball"),
    "two axes where one is read": ("revolute", AXES, "<axis2> of a joint of type revolute"),
    "limits of continuous": (
        "continuous",
        "<axis><limit><lower>-1</lower><upper>1</upper></limit></axis>",
        "<lower>, <upper> of a joint of type continuous",
    ),
    "no limits of continuous": ("continuous", "<axis><limit><lower>-1e16</lower><upper>inf</upper></limit></axis>", ""),
    "a pitch without a screw": (
        "prismatic",
        "<axis><xyz>0 0 1</xyz></axis><screw_thread_pitch>2</screw_thread_pitch>",
        "<screw_thread_pitch> of a joint of type prismatic",
    ),
    "an oblique universal": ("universal", "<axis><xyz>1 0 0</xyz></axis><axis2><xyz>.6 .8 0</xyz></axis2>", "j__1 and j__2"),
    "revolute2": ("revolute2", AXES, "j__1 and j__2"),
    "a universal": ("universal", AXES, ""),
    "a universal that follows": ("universal", AXES.replace("</xyz></axis>", '</xyz><mimic joint="k"/></axis>'), "cannot follow 'k'"),
    "a gearbox": ("gearbox", AXES, "type 'gearbox' is left out"),
    "fixed with an axis": ("fixed", "<axis><xyz>0 0 1</xyz></axis>", ""),
}


@pytest.mark.parametrize("name", UNUSED)
@pytest.mark.parametrize("target", ["sdf", "urdf", "mjcf"])
def test_what_a_joint_states_and_its_type_does_not_use_is_one_row(name: str, target: str, tmp_path: Path) -> None:
    kind, more, expected = UNUSED[name]
    path = in_a_file(
        f'<model name="m">{link("a")}{link("b")}{link("c")}{joint("revolute", "a", "c", name="k")}{joint(kind, "a", "b", more)}</model>',
        tmp_path,
    )
    rows = [loss.lost for loss in NAMED[target].write(read_sdf(path)).losses if loss.kept == "nothing" and loss.where == "joints.j"]

    assert len(rows) == bool(expected)
    assert all(expected in row for row in rows), rows


def test_a_mimic_follows_a_slide_of_a_nested_model_in_metres(tmp_path: Path) -> None:
    inner = f'<model name="n">{link("c")}{link("d")}{joint("prismatic", "c", "d", name="p")}</model>'
    follower = joint("revolute", "a", "b", '<axis><mimic joint="n::p"><multiplier>4</multiplier><reference>.1</reference></mimic></axis>')
    path = in_a_file(f'<model name="m">{link("a")}{link("b")}{inner}{joint("fixed", "a", "n::c", "", "f")}{follower}</model>', tmp_path)
    (coupling,) = read_sdf(path).mechanism.couplings

    assert (coupling.a, coupling.b) == ("n::p", "j")
    assert coupling.ratio == pytest.approx(4 / 1000)  # rad per mm
    assert coupling.offset == pytest.approx(-0.4)


@pytest.mark.parametrize("seed", range(4))
def test_a_model_hangs_on_the_link_that_no_joint_carries(seed: int, tmp_path: Path) -> None:
    """Parents stay parents, whatever the order of the links is."""
    random = np.random.default_rng(seed)
    count = 6
    above = {f"l{i}": f"l{random.integers(0, i)}" for i in range(1, count)}
    links = [link(f"l{i}", " ".join(f"{x:.3f}" for x in random.uniform(-1, 1, 6))) for i in range(count)]
    joints = [joint("revolute", parent, child, name=f"j_{child}") for child, parent in above.items()]
    path = in_a_file(f'<model name="m">{"".join(random.permutation(links))}{"".join(random.permutation(joints))}</model>', tmp_path)

    tree = read_sdf(path).mechanism.tree

    assert {edge.part: edge.parent for edge in tree.edges if edge.part != "l0"} == above
    assert not any(edge.reversed for edge in tree.edges)


@pytest.mark.parametrize("moving", [False, True])
def test_a_static_model_is_a_row_only_if_it_has_joints_that_would_move(moving: bool, tmp_path: Path) -> None:
    still = f'<model name="s"><static>true</static>{link("a")}{link("b")}{joint("revolute" if moving else "fixed", "a", "b")}</model>'
    path = in_a_file(
        f'<world name="w">{still}<model name="t">{link("a")}{link("b")}{joint("revolute", "a", "b")}</model></world>', tmp_path
    )
    rows = [item.what for item in read_sdf(path).kept if "<static>" in item.what]

    assert rows == (["<static> of s: that its joints do not move"] if moving else [])


@pytest.mark.parametrize("origin", ["sdf", "urdf"])
def test_the_world_of_a_file_is_that_of_mujoco_and_excludes_nothing(origin: str, tmp_path: Path) -> None:
    import mujoco

    text = f'<model name="m">{link("a")}{link("b", "1 0 0 0 0 0")}{joint("revolute", "world", "a")}{joint("revolute", "a", "b", name="k")}</model>'
    path = in_a_file(text, tmp_path)
    if origin == "urdf":
        NAMED["urdf"].write(read_sdf(path)).write(tmp_path / "urdf")
        path = next((tmp_path / "urdf").glob("*.urdf"))
    bundle = NAMED["mjcf"].write((read_urdf if origin == "urdf" else read_sdf)(path, metadata=False))
    bundle.write(tmp_path / "out")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "out" / bundle.main))

    assert [model.body(index).name for index in range(model.nbody)] == ["world", "a", "b"]
    assert model.nexclude == 0
    assert not [loss for loss in bundle.losses if loss.where == "parts.world"]
