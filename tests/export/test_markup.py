from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path, PureWindowsPath

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree
from scipy.spatial.transform import Rotation

import articad
from articad.assembly import Assembly
from articad.connectors.se3 import SE3
from articad.export.bundle import Bundle
from articad.export.markup import child, comment, document, number, rgba, rounded_angles, rounded_quaternion, rpy, texts, wxyz
from articad.export.mjcf import write_mjcf
from articad.export.names import MAX_LENGTH, FileNames, Names, valid_name
from articad.export.sdf import write_sdf
from articad.export.urdf import write_urdf
from articad.kinematics import declare
from tests.assemblies import block, frame

DEVICES = ["con", "prn", "aux", "nul", *(f"{name}{digit}" for name in ("com", "lpt") for digit in range(1, 10))]

angles = st.floats(-math.pi, math.pi)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_numbers_read_back_bit_for_bit(value: float) -> None:
    assert float(number(value)) == value


@pytest.mark.parametrize(("value", "text"), [(-0.0, "0"), (1.0, "1"), (0.1, "0.1"), (1e-7, "1e-07"), (-2.5, "-2.5")])
def test_numbers_are_short(value: float, text: str) -> None:
    assert number(value) == text


@given(st.lists(st.floats(allow_nan=False, allow_infinity=False) | st.integers(-(10**6), 10**6).map(float)))
def test_many_numbers_have_the_texts_of_each(values: list[float]) -> None:
    assert texts(values) == [number(value) for value in values]


@given(angles, angles, angles)
def test_roll_pitch_yaw_give_the_rotation_back(roll: float, pitch: float, yaw: float) -> None:
    R = Rotation.from_euler("xyz", [roll, pitch, yaw]).as_matrix()

    assert np.allclose(Rotation.from_euler("xyz", rpy(SE3.from_rotation(R))).as_matrix(), R, atol=1e-14)


@given(st.sampled_from([-math.pi / 2, math.pi / 2]), angles, angles, st.floats(-1e-8, 1e-8))
def test_roll_pitch_yaw_are_exact_at_and_near_gimbal_lock(pitch: float, roll: float, yaw: float, off: float) -> None:
    R = Rotation.from_euler("xyz", [roll, pitch + off, yaw]).as_matrix()

    # up to 1e-14 beyond 90° nothing is certain of the yaw, and a pitch of less than 90° is written
    assert np.allclose(Rotation.from_euler("xyz", rpy(SE3.from_rotation(R))).as_matrix(), R, atol=3e-14)


def test_a_quaternion_is_written_w_first() -> None:
    assert wxyz(SE3.rot_z(math.pi)) == pytest.approx((0, 0, 0, 1), abs=1e-15)
    assert wxyz(SE3.identity()) == [1, 0, 0, 0]


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (-1, 0, 1), (1, -2, 3)])
def test_a_half_turn_has_one_quaternion_and_one_set_of_angles(axis: tuple[float, float, float]) -> None:
    """Both signs of a quaternion are one rotation; rounding noise decided between them, and between 180 and -180 degrees."""
    turns = [SE3.from_axis_angle(axis, sign * (math.pi + off)) for sign in (-1, 1) for off in (-3e-16, 0.0, 3e-16)]
    quaternions = {tuple(rounded_quaternion(T)) for T in turns}
    assert len(quaternions) == 1
    assert next(value for value in reversed(quaternions.pop()) if value) > 0
    assert len({tuple(rounded_angles(rpy(T))) for T in turns}) == 1
    for T in turns:
        assert np.allclose(Rotation.from_quat(rounded_quaternion(T)).as_matrix(), T.rotation, atol=1e-11)
        assert np.allclose(Rotation.from_euler("xyz", rounded_angles(rpy(T))).as_matrix(), T.rotation, atol=1e-11)


def test_colours_are_between_zero_and_one() -> None:
    assert rgba("#ff0080") == "1 0 0.5019607843137255 1"


def test_hostile_text_stays_text() -> None:
    root = etree.Element("robot")
    child(root, "text", {"data": '"/><evil/>&<![CDATA['}, "]]></text><evil/>")
    read = etree.fromstring(document(root))

    assert [element.tag for element in read.iter()] == ["robot", "text"]
    assert read[0].get("data") == '"/><evil/>&<![CDATA['
    assert read[0].text == "]]></text><evil/>"


@given(st.text(st.one_of(st.sampled_from("-->!<\n]"), st.characters())))
def test_any_text_is_a_comment_and_only_that(text: str) -> None:
    root = etree.Element("robot")
    root.append(comment(text))
    child(root, "after")
    first, after = etree.fromstring(document(root))

    assert first.tag is etree.Comment
    assert after.tag == "after"


@pytest.mark.parametrize("text", ["---", "a -- b", "<!----->", "-", "--"])
def test_a_comment_keeps_its_characters_but_for_spaces(text: str) -> None:
    assert comment(text).text.replace(" ", "") == text.replace(" ", "")


@given(st.text(st.one_of(st.sampled_from("ab\n\r\u2028\x85\x0b"), st.characters())))
def test_a_comment_has_one_line(text: str) -> None:
    assert len(comment(text).text.splitlines()) == 1


def test_comments_are_made_in_one_place() -> None:
    package = Path(articad.__file__).parent
    made = {path.name for path in package.rglob("*.py") if "etree.Comment(" in path.read_text(encoding="utf-8")}
    assert made == {"markup.py"}


@pytest.mark.parametrize(
    ("wanted", "valid"),
    [
        ("door_left", "door_left"),
        ("Door Left", "Door_Left"),
        ("../../etc/passwd", "etc_passwd"),
        ("Tür", "Tur"),
        ("9lives", "n9lives"),
        ("", "n"),
        ("日本", "n"),
        ("a<b>&\"'", "a_b"),
        ("_x", "n_x"),
        ("x" * 500, "x" * MAX_LENGTH),
    ],
)
def test_names_become_valid(wanted: str, valid: str) -> None:
    assert valid_name(wanted) == valid


def test_names_are_unique_and_changes_are_remembered() -> None:
    names = Names()

    assert [names.claim(name) for name in ("a b", "a_b", "a-b", "c")] == ["a_b", "a_b_2", "a_b_3", "c"]
    assert names.changed == {"a b": "a_b", "a_b": "a_b_2", "a-b": "a_b_3"}


@given(st.lists(st.one_of(st.text("aAbB_2"), st.sampled_from([*DEVICES, *(f" {name.upper()}" for name in DEVICES)]), st.text())))
def test_no_two_files_are_one_on_a_system_that_ignores_case_and_none_is_a_device(wanted: list[str]) -> None:
    names = FileNames()
    claimed = [names.claim(one) for one in wanted]

    assert len({name.lower() for name in claimed}) == len(claimed)
    assert not [name for name in claimed if PureWindowsPath(f"{name}.stl").is_reserved()]


@pytest.mark.parametrize("write", [write_mjcf, write_urdf, write_sdf])
def test_exports_name_their_meshes_so_on_every_system(write: Callable[[Assembly], Bundle]) -> None:
    base, *others = [block(name, (20, 30, 10 + at), root=frame()) for at, name in enumerate(["Arm", "arm", "con", "ARM", "nul"])]
    joints = [declare.fixed(f"fixed_{at}", base["root"], part["root"]) for at, part in enumerate(others)]
    assembly = Assembly.from_parts("names", parts=[base, *others], joints=joints, ground="Arm")
    paths = [PureWindowsPath(path) for path in write(assembly).files]

    assert len({str(path).lower() for path in paths}) == len(paths) > 5
    assert not [path for path in paths if path.is_reserved()]
