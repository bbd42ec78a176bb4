"""Engines open nothing outside the folder that a file may use: such a file is refused, and an engine that got it could not."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest
import trimesh

from articad.auditing.examine import AuditOptions, audit_file
from articad.errors import ReadError
from articad.importers.mjcf import read_mjcf
from articad.importers.referenced_files import require_closed
from articad.kernels import landlock
from articad.simulation.examine import simulate_file
from articad.simulation.loading import load
from articad.simulation.trial import try_out

BODY = '<worldbody><body><joint/><geom type="mesh" mesh="m" mass="1"/></body></worldbody>'
DISC = '<worldbody><body><joint/><geom size="1" mass="1"/></body></worldbody>'

# Ways for a model to name the file NAME, which is DIR/LAST: other files of the model by their names, the model first.
MJCF: dict[str, dict[str, str]] = {
    "a mesh": {"model.xml": f'<mujoco><asset><mesh name="m" file="NAME"/></asset>{BODY}</mujoco>'},
    "a mesh in the folder of meshes": {
        "model.xml": f'<mujoco><compiler meshdir="DIR"/><asset><mesh name="m" file="LAST"/></asset>{BODY}</mujoco>'
    },
    "a mesh in the folder of assets": {
        "model.xml": f'<mujoco><compiler assetdir="DIR"/><asset><mesh name="m" file="LAST"/></asset>{BODY}</mujoco>'
    },
    "an included mesh": {
        "model.xml": f'<mujoco><include file="sub/assets.xml"/>{BODY}</mujoco>',
        "sub/assets.xml": '<mujoco><asset><mesh name="m" file="NAME"/></asset></mujoco>',
    },
    "an included mesh in the model's folder of meshes": {
        "model.xml": f'<mujoco><compiler meshdir="DIR"/><include file="assets.xml"/>{BODY}</mujoco>',
        "assets.xml": '<mujoco><asset><mesh name="m" file="LAST"/></asset></mujoco>',
    },
    "a mesh in an included folder of meshes": {
        "model.xml": f'<mujoco><include file="where.xml"/><asset><mesh name="m" file="LAST"/></asset>{BODY}</mujoco>',
        "where.xml": '<mujoco><compiler meshdir="DIR"/></mujoco>',
    },
    "a mesh of a model within": {
        "model.xml": f'<mujoco><asset><model name="in" file="sub/inner.xml"/></asset>{DISC}</mujoco>',
        "sub/inner.xml": f'<mujoco><asset><mesh name="m" file="NAME"/></asset>{BODY}</mujoco>',
    },
    "an include of a model within": {
        "model.xml": f'<mujoco><asset><model name="in" file="inner.xml"/></asset>{DISC}</mujoco>',
        "inner.xml": f'<mujoco><include file="NAME"/>{DISC}</mujoco>',
    },
    "an include": {"model.xml": f'<mujoco><include file="NAME"/>{DISC}</mujoco>'},
    "a texture": {
        "model.xml": f'<mujoco><asset><texture name="t" type="2d" file="NAME"/><material name="a" texture="t"/></asset>{DISC}</mujoco>'
    },
    "a height field": {"model.xml": f'<mujoco><asset><hfield name="h" file="NAME" size="1 1 1 1"/></asset>{DISC}</mujoco>'},
}
LINK = '<link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>VISUAL</link>'
URDF: dict[str, dict[str, str]] = {
    "a mesh of URDF": {"model.urdf": '<robot name="r">' + LINK.replace("VISUAL", '<visual><geometry><mesh filename="NAME"/></geometry></visual>') + "</robot>"},
    "MuJoCo's folder of meshes in URDF": {
        "model.urdf": '<robot name="r"><mujoco><compiler meshdir="DIR"/></mujoco>'
        + LINK.replace("VISUAL", '<visual><geometry><mesh filename="LAST"/></geometry></visual>')
        + "</robot>"
    },
}  # fmt: skip
WAYS = MJCF | URDF


def absolute(_folder: Path, secret: Path) -> str:
    return str(secret)


def upwards(_folder: Path, secret: Path) -> str:
    return f"../../{secret.parent.name}/{secret.name}"  # deep enough for files in a folder below, too


def through_a_link(folder: Path, secret: Path) -> str:
    (folder / "link").symlink_to(secret.parent)
    return f"{folder}/link/{secret.name}"


OUT: tuple[Callable[[Path, Path], str], ...] = (absolute, upwards, through_a_link)


def written(folder: Path, files: dict[str, str], name: str) -> Path:
    for place, text in files.items():
        (folder / place).parent.mkdir(parents=True, exist_ok=True)
        base, _, last = name.rpartition("/")
        (folder / place).write_text(text.replace("NAME", name).replace("DIR", base or ".").replace("LAST", last))
    return folder / next(iter(files))


@pytest.fixture
def secret(tmp_path: Path) -> Path:
    place = tmp_path / "a" / "elsewhere" / "secret.stl"
    place.parent.mkdir(parents=True)
    trimesh.creation.box().export(place)
    (tmp_path / "elsewhere").symlink_to(place.parent)  # so that it lies two folders up, and one
    return place


@pytest.mark.parametrize("out", OUT)
@pytest.mark.parametrize("way", WAYS)
def test_a_file_that_names_a_file_outside_is_refused_before_any_engine_has_it(
    way: str, out: Callable[[Path, Path], str], tmp_path: Path, secret: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def never(*_words: object, **_options: object) -> None:
        raise AssertionError("an engine was started")

    monkeypatch.setattr("articad.processes.launcher.start", never)
    monkeypatch.setattr("mujoco.MjModel.from_xml_path", never)
    folder = tmp_path / "a" / "robot"
    folder.mkdir()
    path = written(folder, WAYS[way], out(folder, secret))

    found = audit_file(path, AuditOptions(motion=False))
    assert found.findings.of("E_UNSAFE_PATH") or found.findings.of("W_AUDIT_MESH_OUTSIDE"), found.findings
    assert found.engines == ()
    for reader in (simulate_file, require_closed) if path.suffix == ".urdf" else (simulate_file, require_closed, read_mjcf):
        with pytest.raises(ReadError) as error:
            reader(path)
        assert "E_UNSAFE_PATH" in error.value.findings.codes


@pytest.mark.parametrize("way", WAYS)
def test_a_pipe_is_refused(way: str, tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.stl")
    (tmp_path / "sub").mkdir()
    path = written(tmp_path, WAYS[way], f"{tmp_path}/pipe.stl")
    with pytest.raises(ReadError, match="pipe"):
        require_closed(path)


@pytest.mark.skipif(landlock.abi() == 0, reason="this kernel has no Landlock")
@pytest.mark.parametrize("name", ["absolute", "link", "inside"])
def test_an_engine_can_read_its_folder_and_nothing_else(name: str, tmp_path: Path, secret: Path) -> None:
    folder = tmp_path / "robot"
    (folder / "sub").mkdir(parents=True)
    (folder / "link.stl").symlink_to(secret)
    (folder / "sub" / "inside.stl").write_bytes(secret.read_bytes())
    named = {"absolute": str(secret), "link": "link.stl", "inside": "sub/inside.stl"}[name]
    path = written(
        folder, MJCF["an included mesh"] | {"sub/assets.xml": '<mujoco><asset><mesh name="m" file="NAME"/></asset></mujoco>'}, named
    )

    loading = load("mujoco", path)

    assert loading.loads == (name == "inside"), loading.message
    if name == "inside":
        assert try_out("mujoco", path).loads


@pytest.mark.parametrize(
    "way", [way for way in WAYS if "texture" not in way and "height" not in way and "include of" not in way and way != "an include"]
)
def test_a_file_that_names_files_of_its_own_folder_is_loaded(way: str, tmp_path: Path, secret: Path) -> None:
    folder = tmp_path / "a" / "robot"
    for place in (folder, folder / "sub"):
        (place / "meshes").mkdir(parents=True)
        (place / "meshes" / "own.stl").write_bytes(secret.read_bytes())
    path = written(folder, WAYS[way], "meshes/own.stl")

    require_closed(path)

    assert load("mujoco", path).loads, load("mujoco", path).message


def test_a_ros_package_is_one_folder(tmp_path: Path, secret: Path) -> None:
    (tmp_path / "robot" / "urdf").mkdir(parents=True)
    (tmp_path / "robot" / "meshes").mkdir()
    (tmp_path / "robot" / "package.xml").write_text("<package/>")
    (tmp_path / "robot" / "meshes" / "own.stl").write_bytes(secret.read_bytes())
    path = written(tmp_path / "robot" / "urdf", URDF["MuJoCo's folder of meshes in URDF"], "../meshes/own.stl")
    assert simulate_file(path, engines=("mujoco",)).outcomes[0].loads
