"""The model of a page: parts, meshes and the mechanism, all numbers at full precision."""

from __future__ import annotations

import math

import numpy as np

from articad.aliases import Json
from articad.assembly import Assembly
from articad.connectors.mate import Mate
from articad.disassembly.opened import step_poses
from articad.disassembly.steps import AssemblyOrder, shown_path, words_of
from articad.errors import ArticadError
from articad.export.meshes import drawn_shapes
from articad.geometry.finish import finish_of
from articad.geometry.part import Part
from articad.interference.explosion import explosion
from articad.kinematics.joints import Coordinate, Joint, JointType
from articad.report.drawing import drawn_mesh

MODEL_SCHEMA = "articad.viewer/1"
_FREE_TRAVEL = 0.25  # of the assembly's size: slider range of a travel without limits, in both directions
_DEFAULT_CONE = math.pi / 2  # slider range of a ball without limits
_UNSEEN = 2.5e-4  # of the assembly's size: a quarter of a pixel of the whole on a screen
_DEFAULT_LENGTH = 100.0  # mm, if nothing has a size


def viewer_model(assembly: Assembly) -> Json:
    """Return the data that the page needs to draw and move an assembly, `articad.viewer/1`; the page solves loops itself.

    Args:
        assembly: Any assembly, from a plan, from Python or from a file.
    """
    mechanism = assembly.mechanism
    index = {name: number for number, name in enumerate(mechanism.parts)}
    place = {joint.name: number for number, joint in enumerate(mechanism.joints)}
    meshes, parts = _parts(assembly)
    layout = mechanism.layout
    following = _dependent_freedoms(assembly)
    columns = [
        {
            "name": c.name,
            "joint": c.joint,
            "unit": c.unit,
            "lower": _finite(c.lower),
            "upper": _finite(c.upper),
            "follows": layout.freedom_of(column) in following,
        }
        for column, c in enumerate(layout.coordinates)
    ]
    tree = [
        {"joint": place[edge.joint.name], "from": index[edge.parent], "to": index[edge.part], "reversed": edge.reversed}
        for edge in mechanism.tree.edges
    ]
    couplings = [
        {
            "a": layout.column_of[c.a],
            "b": layout.column_of[c.b],
            "ratio": c.ratio,
            "offset": c.offset,
            "unit": layout.coordinates[layout.column_of[c.b]].unit,
        }
        for c in mechanism.couplings
    ]
    rest = layout.rest if mechanism.is_tree else mechanism.branch.Q_rest
    return {
        "schema": MODEL_SCHEMA,
        "name": assembly.name,
        "ground": index[assembly.ground],
        "ground_pose": mechanism.T_ground.data.tolist(),
        "parts": parts,
        "meshes": meshes,
        "joints": [_joint(joint, index, layout.columns[joint.name].start) for joint in mechanism.joints],
        "coordinates": columns,
        "tree": tree,
        "loops": [place[joint.name] for joint in mechanism.loop_joints],
        "couplings": couplings,
        "dependent": sorted(following),
        "length": _DEFAULT_LENGTH if mechanism.is_tree else float(mechanism.branch.system.length),
        "rest": np.asarray(rest).tolist(),
        "drivers": _drivers(assembly),
    }


def drawn_steps(assembly: Assembly, order: Json) -> Json:
    """Return the steps of an order of assembly as the page plays them: what is new, what is in place, and the path.

    The page moves the whole by itself. Where a loop is still open, or parts wait beside their places, they stand where the whole never has them,
    and their poses are stated.
    """
    mechanism = assembly.mechanism
    index = {name: number for number, name in enumerate(mechanism.parts)}
    size, found = _size(assembly), AssemblyOrder.from_json(order)
    steps: list[Json] = []
    for step in found.steps:
        poses = step_poses(mechanism, step, found.base) if step.opened or step.beside else {}
        steps.append(
            {
                "parts": [index[name] for name in step.parts],
                "onto": [index[name] for name in step.onto],
                "path": shown_path(step, size).tolist(),
                "at": {} if step.opened else step.at,
                "poses": {
                    str(index[name]): poses[name].matrix[:3].ravel().tolist() for name in sorted({*step.parts, *step.onto} & poses.keys())
                },
                "text": f"Step {step.number}: {words_of(step)}",
            }
        )
    return {"steps": steps}


def _parts(assembly: Assembly) -> tuple[list[Json], list[Json]]:
    """Return the meshes for drawing, each once, and the parts that show them."""
    meshes: list[Json] = []
    known: dict[str, int] = {}
    parts: list[Json] = []
    mechanism = assembly.mechanism
    rest = dict(zip(mechanism.parts, mechanism.at_rest, strict=True))
    least = _UNSEEN * _size(assembly)
    ways = explosion(assembly.parts, tuple(mechanism.tree.edges), rest)
    for name, part in assembly.parts.items():
        shapes = []
        for shape in drawn_shapes(part, least):
            if not len(shape.mesh.triangles):
                continue
            if shape.mesh.digest not in known:
                known[shape.mesh.digest] = len(meshes)
                meshes.append(drawn_mesh(shape.mesh))
            shapes.append({"mesh": known[shape.mesh.digest], "pose": shape.frame.data.tolist(), "color": shape.color})
        look = finish_of(part.material or "")
        parts.append(
            {
                "name": name,
                "material": part.material,
                "color": part.color,
                "finish": {
                    "metal": look.metal,
                    "roughness": look.roughness,
                    "opacity": look.opacity,
                    "gloss": look.gloss,
                    "grain": look.grain,
                },
                "mass": None if part.mass is None else part.mass.mass,
                "size": _extent(part),
                "middle": _middle(part),
                "explode": ways[name].tolist() if name in ways else [0.0, 0.0, 0.0],
                "facts": [],
                "shapes": shapes,
            }
        )
    return meshes, parts


def _middle(part: Part) -> list[float]:
    corners = [shape.placed.bounds for shape in part.visuals or part.collisions if len(shape.mesh.vertices)]
    if not corners:
        return [0.0, 0.0, 0.0]
    middle: list[float] = ((np.min([c[0] for c in corners], axis=0) + np.max([c[1] for c in corners], axis=0)) / 2).tolist()
    return middle


def _extent(part: Part) -> list[float] | None:
    """Return the size of the bounding box in the part's frame [mm]."""
    corners = [shape.placed.bounds for shape in part.visuals or part.collisions if len(shape.mesh.vertices)]
    if not corners:
        return None
    size: list[float] = (np.max([c[1] for c in corners], axis=0) - np.min([c[0] for c in corners], axis=0)).tolist()
    return size


def _joint(joint: Joint, index: dict[str, int], column: int) -> Json:
    return {
        "name": joint.name,
        "type": str(joint.type),
        "parent": index[joint.parent],
        "child": index[joint.child],
        "parent_frame": joint.T_parent_connector.data.tolist(),
        "child_frame": joint.T_child_connector.data.tolist(),
        "opposed": joint.mate == Mate.OPPOSED,
        "lead": joint.lead,
        "column": column,
        "coordinates": len(joint.type.coordinates),
    }


def _dependent_freedoms(assembly: Assembly) -> set[int]:
    mechanism = assembly.mechanism
    if mechanism.is_tree:
        return set()
    branch = mechanism.branch
    return {int(freedom) for freedom in np.asarray(branch.system.freedoms)[branch.dependent]}


def _drivers(assembly: Assembly) -> list[Json]:
    """Return the sliders: each driving coordinate with its feasible range, and each driving ball."""
    mechanism = assembly.mechanism
    joints = {joint.name: joint for joint in mechanism.joints}
    size = _size(assembly)
    found: list[Json] = []
    for column, driver in zip(mechanism.driver_columns, mechanism.drivers, strict=True):
        joint = joints[driver.joint]
        if joint.type is JointType.FREE:  # it has no range
            continue
        if joint.type is not JointType.BALL:
            found.append({"kind": "plain", "name": driver.name, "column": column, "unit": driver.unit} | _range(assembly, driver, size))
        elif not any(entry.get("joint") == joint.name for entry in found):
            twist = joint.limits.twist or (-math.pi, math.pi)
            cone = _DEFAULT_CONE if joint.limits.cone is None else joint.limits.cone
            found.append({"kind": "ball", "joint": joint.name, "column": column, "cone": cone, "twist": list(twist)})
    return found


def _range(assembly: Assembly, driver: Coordinate, size: float) -> Json:
    lower, upper = driver.lower, driver.upper
    if not assembly.mechanism.is_tree:
        try:
            feasible = assembly.feasible_range(driver.name)
        except ArticadError:  # the page itself finds how far it goes
            pass
        else:
            lower, upper = feasible.lower, feasible.upper
    free = math.pi if driver.unit == "rad" else _FREE_TRAVEL * size
    return {
        "lower": lower if math.isfinite(lower) else driver.rest - free,
        "upper": upper if math.isfinite(upper) else driver.rest + free,
        "endless": math.isinf(lower) and math.isinf(upper),
    }


def _size(assembly: Assembly) -> float:
    """Return the diagonal of the bounding box of everything at rest [mm]."""
    poses = assembly.mechanism.at_rest
    points = [
        poses[number].apply(shape.placed.bounds)
        for number, part in enumerate(assembly.parts.values())
        for shape in part.visuals or part.collisions
        if len(shape.mesh.vertices)
    ]
    return float(np.linalg.norm(np.ptp(np.concatenate(points), axis=0))) if points else _DEFAULT_LENGTH


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
