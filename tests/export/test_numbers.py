"""Numbers of exports have no rounding dust, and actuators do what they say."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from lxml import etree

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.export.mjcf import write_mjcf
from articad.export.sdf import write_sdf
from articad.export.urdf import write_urdf
from articad.geometry.part import Part
from articad.geometry.shapes import box
from articad.kernels.cache import BuildCache
from articad.kinematics import declare
from tests.assemblies import STEEL

DUST_M = 1e-13


def turned(angle: float, about: tuple[float, float, float]) -> Assembly:
    """A bar on a hinge whose mesh was turned forth and back, so that every number of it has errors of rounding."""
    T = SE3.from_axis_angle(about, angle)
    mesh = box(20, 90, 14).transformed(T).transformed(SE3.from_axis_angle(about, -angle))
    mesh = mesh.transformed(SE3.from_axis_angle((0, 0, 1), math.pi / 2))
    base = Part.from_mesh("base", box(10, 10, 10), density=STEEL, connectors={"a": Connector("a", SE3.from_translation((0.1 + 0.2, 0, 0)))})
    frame = SE3.from_axis_angle((0, 1, 0), math.pi / 2) @ SE3.from_axis_angle((0, 1, 0), -math.pi / 2)
    bar = Part.from_mesh("bar", mesh, density=STEEL, connectors={"a": Connector("a", frame)})
    return Assembly.from_parts("bar", parts=[base, bar], joints=[declare.revolute("j", base["a"], bar["a"], limits=(-1, 1))], ground="base")


@pytest.mark.parametrize("angle", [0.3, 1.0, math.pi / 3, 2.0])
@pytest.mark.parametrize("write", [write_mjcf, write_urdf, write_sdf])
def test_lengths_and_directions_have_no_dust(write: object, angle: float, tmp_path: Path) -> None:
    assert callable(write)
    bundle = write(turned(angle, (1, 2, 3)), cache=BuildCache(tmp_path))
    root = etree.fromstring(bundle.files[bundle.main])
    for element in root.iter(etree.Element):
        texts = [*element.attrib.items(), (element.tag, element.text or "")]
        for name, text in texts:
            if name not in {"pos", "quat", "size", "xyz", "rpy", "pose", "axis", "radius", "length"}:
                continue
            values = [float(word) for word in text.split()]
            assert all(value == 0 or abs(value) > DUST_M for value in values), (element.tag, name, text)
            assert all(len(word.lstrip("-")) < 17 for word in text.split() if abs(float(word) - round(float(word), 6)) < 1e-14), text


def test_products_of_inertia_that_are_rounding_errors_are_zero(tmp_path: Path) -> None:
    root = etree.fromstring(write_mjcf(turned(1.0, (1, 2, 3)), cache=BuildCache(tmp_path)).files["bar.xml"])
    inertial = root.find(".//body[@name='bar']/inertial")

    assert inertial.get("quat") is None  # the principal axes are those of the body
    assert len(inertial.get("diaginertia").split()) == 3
    assert [float(word) for word in inertial.get("pos").split()] == [0, 0, 0]


@pytest.mark.engines
def test_a_motor_takes_the_torque_that_it_is_told_and_no_more_than_the_effort(tmp_path: Path) -> None:
    import mujoco

    bundle = write_mjcf(turned(1.0, (1, 2, 3)), actuators="motor", cache=BuildCache(tmp_path / "cache"))
    bundle.write(tmp_path)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "bar.xml"))
    data = mujoco.MjData(model)
    model.opt.gravity[:] = 0
    model.dof_damping[:] = 0
    effort = float(model.actuator_ctrlrange[0, 1])
    inertia = np.zeros((1, 1))
    for asked, given in ((0.1 * effort, 0.1 * effort), (7 * effort, effort)):
        mujoco.mj_resetData(model, data)
        data.ctrl[0] = asked
        mujoco.mj_forward(model, data)
        mujoco.mj_fullM(model, data, inertia)
        assert float(data.qacc[0]) == pytest.approx(given / inertia[0, 0], rel=1e-6)
