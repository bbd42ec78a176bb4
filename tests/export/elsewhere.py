"""Run by the Python of another environment: say where Drake or SAPIEN puts the links of a file.

python elsewhere.py drake|sapien FILE '{"joint": value, …}' prints {"link": [16 numbers, row by row], …} in m.
"""

from __future__ import annotations

import json
import sys
from types import SimpleNamespace
from typing import Any


def drake(path: str, values: dict[str, float]) -> dict[str, Any]:
    """Load a file in Drake, its root held by the world if nothing else holds it."""
    from pydrake.multibody.parsing import Parser  # type: ignore[import-not-found]
    from pydrake.multibody.plant import AddMultibodyPlantSceneGraph, DiscreteContactApproximation  # type: ignore[import-not-found]
    from pydrake.systems.framework import DiagramBuilder  # type: ignore[import-not-found]

    plant, _ = AddMultibodyPlantSceneGraph(DiagramBuilder(), 0.001)
    plant.set_discrete_contact_approximation(DiscreteContactApproximation.kSap)  # the one that holds balls of loops
    (model,) = Parser(plant).AddModels(path)
    root = plant.get_body(plant.GetBodyIndices(model)[0])
    if path.endswith(".urdf"):
        plant.WeldFrames(plant.world_frame(), root.body_frame())
    plant.Finalize()
    context = plant.CreateDefaultContext()
    for name, value in values.items():
        if plant.HasJointNamed(name, model):
            joint = plant.GetJointByName(name, model)
            (joint.set_translation if joint.type_name() == "prismatic" else joint.set_angle)(context, value)
    bodies = [plant.get_body(index) for index in plant.GetBodyIndices(model)]
    return {body.name(): plant.EvalBodyPoseInWorld(context, body).GetAsMatrix4().ravel().tolist() for body in bodies}


def sapien(path: str, values: dict[str, float]) -> dict[str, Any]:
    """Load a URDF in SAPIEN, without what needs a graphics card."""
    import sapien  # type: ignore[import-not-found]
    from sapien.wrapper import actor_builder, urdf_loader  # type: ignore[import-not-found]

    urdf_loader.RenderMaterial = SimpleNamespace
    actor_builder.ActorBuilder.add_visual_from_file = lambda *_, **__: None
    scene = sapien.Scene([sapien.physx.PhysxCpuSystem()])
    loader = scene.create_urdf_loader()
    loader.fix_root_link = True
    robot = loader.load(path)
    robot.set_qpos([values.get(joint.name, 0.0) for joint in robot.get_active_joints()])
    return {link.name: link.entity_pose.to_transformation_matrix().ravel().tolist() for link in robot.get_links()}


if __name__ == "__main__":
    engine, file, given = sys.argv[1:]
    print(json.dumps({"drake": drake, "sapien": sapien}[engine](file, json.loads(given))))  # noqa: T201 - what the caller reads
