from __future__ import annotations

import math

import pytest

from articad.connectors import SE3, Attachment, Connector
from articad.kinematics import Joint, JointType, Mechanism, declare


def on(part: str, x: float = 0.0) -> Attachment:
    return Attachment(part, Connector("pin", SE3.trans(x, 0, 0)))


JOINTS = [
    declare.fixed("j0", on("p0"), on("p1")),
    declare.revolute("j1", on("p1", 10), on("p2"), limits=(-1.0, 1.0), rest=0.5),
    declare.slider("j2", on("p2", 10), on("p3"), limits=(0.0, 50.0), rest=5.0, mate="opposed"),
    declare.cylindrical("j3", on("p3", 10), on("p4"), travel=(0.0, 20.0), angle="endless", rest=(2.0, 0.1)),
    declare.ball("j4", on("p4", 10), on("p5"), cone=0.7, twist=(-0.2, 0.2)),
    declare.screw("j5", on("p5", 10), on("p6"), lead=4.0, limits="endless", driver=True),
    declare.planar("j6", on("p6", 10), on("p7"), x=(-5.0, 5.0), y=(-6.0, 6.0), angle="endless"),
    declare.universal("j7", on("p7", 10), on("p8"), a=(-1.0, 1.0), b=(-1.5, 1.5)),
    declare.free("j8", on("p8", 10), on("p9"), rest=SE3.trans(5, 0, 90)),
]


def test_every_type_is_declared_by_a_function_of_its_name() -> None:
    assert [joint.type for joint in JOINTS] == list(JointType)
    mechanism = Mechanism([f"p{i}" for i in range(10)], "p0", JOINTS)
    assert mechanism.mobility == 19
    assert mechanism.findings().ok


@pytest.mark.parametrize("joint", JOINTS, ids=lambda joint: str(joint.type))
def test_what_was_said_is_what_the_joint_holds(joint: Joint) -> None:
    assert joint.parent_connector == joint.child_connector == "pin"
    assert len(joint.rest) == len(joint.type.coordinates)
    assert joint.findings() == []


def test_endless_is_infinite_and_the_rest_is_as_given() -> None:
    assert JOINTS[3].limits.lower == (0.0, -math.inf)
    assert JOINTS[3].limits.upper == (20.0, math.inf)
    assert JOINTS[3].rest == (2.0, 0.1)
    assert JOINTS[4].limits.cone == 0.7
    assert JOINTS[5].lead == 4.0
    assert JOINTS[5].driver
    assert JOINTS[2].mate == "opposed"
