"""Exports are loaded by Drake and SAPIEN, which live in an environment of their own.

python -m venv DIR; DIR/bin/pip install drake sapien; ARTICAD_ENGINES=DIR/bin/python .venv/bin/python -m pytest -m engines_all
"""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from articad.assembly import Assembly
from articad.export.bundle import Bundle
from articad.export.mjcf import write_mjcf
from articad.export.sdf import write_sdf
from articad.export.urdf import write_urdf
from tests.assemblies import all_joint_kinds, four_bar, geared_pair, random_configurations
from tests.engines import _urdf_origins, joint_values, largest_difference, our_poses

PYTHON = os.environ.get("ARTICAD_ENGINES", "")
SINGLE = 1e-5  # m: SAPIEN computes in single precision
POSE_TOLERANCE = {"drake": 1e-9, "sapien": SINGLE}

pytestmark = [pytest.mark.engines_all, pytest.mark.skipif(not PYTHON, reason="ARTICAD_ENGINES names no Python with Drake and SAPIEN")]


def loaded(engine: str, bundle: Bundle, folder: Path, values: Any = None) -> dict[str, NDArray[np.float64]]:
    bundle.write(folder)
    command = [PYTHON, str(Path(__file__).with_name("elsewhere.py")), engine, str(folder / bundle.main), json.dumps(values or {})]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert done.returncode == 0, done.stderr[-2000:]
    return {link: np.array(row).reshape(4, 4) for link, row in json.loads(done.stdout.splitlines()[-1]).items()}


@pytest.mark.parametrize("engine", POSE_TOLERANCE)
@pytest.mark.parametrize("make", [all_joint_kinds, geared_pair])
def test_a_urdf_is_posed_as_we_pose_it(engine: str, make: Any, tmp_path: Path) -> None:
    assembly: Assembly = make()
    q = random_configurations(assembly, 0, 1)[0] if make is all_joint_kinds else assembly.mechanism.rest + 0.1
    bundle = write_urdf(assembly, meshes="obj")
    links = loaded(engine, bundle, tmp_path, joint_values(assembly, q))
    origins = _urdf_origins(tmp_path / bundle.main)

    assert links.keys() >= assembly.parts.keys()
    assert largest_difference(our_poses(assembly, q), {name: links[name] @ origins[name] for name in origins}) < POSE_TOLERANCE[engine]


@pytest.mark.parametrize("engine", POSE_TOLERANCE)
@pytest.mark.parametrize(
    "options", [{"loops": "drake"}, {"loops": "isaac"}, {"collision": "hull"}, {"srdf": True, "ros2_control": True}], ids=str
)
def test_options_of_urdf_load(engine: str, options: Any, tmp_path: Path) -> None:
    if (engine, options.get("loops")) == ("drake", "isaac"):
        pytest.skip("Drake calls <loop_joint> an error: that flavour is for Isaac Sim")

    assert loaded(engine, write_urdf(four_bar(), meshes="obj", **options), tmp_path).keys() >= four_bar().parts.keys()


SDF_LOOPS = "loops"  # Drake takes no joint of an SDF that closes a loop; the URDF for Drake and the MJCF close them by constraints


@pytest.mark.parametrize("write", [write_mjcf, write_sdf])
@pytest.mark.parametrize("make", [all_joint_kinds, geared_pair, four_bar])
def test_drake_loads_mjcf_and_sdf(write: Any, make: Any, tmp_path: Path) -> None:
    if (write, make) == (write_sdf, four_bar):
        with pytest.raises(AssertionError, match=SDF_LOOPS):
            loaded("drake", write(make(), meshes="obj"), tmp_path)
        return
    assert loaded("drake", write(make(), meshes="obj"), tmp_path).keys() >= make().parts.keys()
