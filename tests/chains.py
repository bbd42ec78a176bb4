"""Long chains: assemblies whose size is chosen, for what must grow as they do."""

from __future__ import annotations

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.geometry.part import Part, Solid
from articad.geometry.shapes import box
from articad.kinematics import declare

LENGTH_MM = 10.0


def chain(count: int) -> Assembly:
    """Return a chain of equal blocks, each hinged on the one below and 0.5 mm away from it."""
    solid = Solid.from_mesh(box(6.0, 6.0, LENGTH_MM - 0.5), deflection=0.01)
    across = SE3.rot_y(1.5707963267948966)
    ends = {"low": SE3.trans(0, 0, -LENGTH_MM / 2) @ across, "high": SE3.trans(0, 0, LENGTH_MM / 2) @ across}
    connectors = {name: Connector(name, place) for name, place in ends.items()}
    parts = [Part.from_solid(f"link{number}", solid, density=1000.0, connectors=connectors) for number in range(count)]
    joints = [
        declare.revolute(f"hinge{number}", parts[number]["low"], parts[number - 1]["high"], limits=(-0.02, 0.02))
        for number in range(1, count)
    ]
    return Assembly.from_parts("chain", parts=parts, joints=joints, ground="link0")
