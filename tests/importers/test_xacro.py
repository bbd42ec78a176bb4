"""xacro files are expanded where they can do nothing else: packages are found, and what reaches for more is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from articad.errors import ReadError
from articad.formats import read
from articad.importers import xacro

pytest.importorskip("xacro")

HEAD = '<robot name="a" xmlns:xacro="http://www.ros.org/wiki/xacro">'
MACRO = (
    f'{HEAD}<xacro:macro name="bar" params="name size"><link name="${{name}}"><visual><geometry><box size="${{size}} ${{2*size}} 0.1"/>'
    "</geometry></visual></link></xacro:macro></robot>"
)


def package(folder: Path, name: str, text: str) -> Path:
    """A ROS package with one xacro file; its folder has another name than the package."""
    (folder / "urdf").mkdir(parents=True)
    (folder / "package.xml").write_text(f"<package><name>{name}</name></package>")
    (folder / "urdf/a.urdf.xacro").write_text(text)
    return folder / "urdf/a.urdf.xacro"


def test_macros_properties_and_packages_are_expanded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package(tmp_path / "elsewhere/parts", "robot_parts", MACRO)
    path = package(
        tmp_path / "mine",
        "robot",
        f'{HEAD}<xacro:include filename="$(find robot_parts)/urdf/a.urdf.xacro"/><xacro:property name="s" value="${{0.1 * 3}}"/>'
        '<xacro:bar name="b" size="${s}"/></robot>',
    )
    with pytest.raises(ReadError, match="ROS_PACKAGE_PATH"):
        read(path)
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "elsewhere/parts"))  # as the advice says
    assembly = read(path)
    assert assembly.parts["b"].visuals[0].mesh.bounds.ravel() == pytest.approx([-150, -300, -50, 150, 300, 50])


@pytest.mark.parametrize(
    "reach",
    [
        "${xacro.load_yaml('/etc/passwd')}",
        "${xacro.load_yaml('SECRET')}",
        "${[c for c in ().__class__.__base__.__subclasses__() if c.__name__ == 'Popen'][0](['touch', 'MADE'])}",
        "${().__class__.__base__.__subclasses__()}",
        "$(env GEMINI_API_KEY)",
    ],
)
def test_a_file_that_reaches_for_more_gets_nothing(reach: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GEMINI_API_KEY", "swordfish")
    secret, made = tmp_path / "secret.yaml", tmp_path / "made"
    secret.write_text("word: swordfish")
    path = package(
        tmp_path / "mine", "robot", f'{HEAD}<link name="{reach.replace("SECRET", str(secret)).replace("MADE", str(made))}"/></robot>'
    )
    with pytest.raises(ReadError) as refused:
        read(path)
    assert "swordfish" not in str(refused.value)
    assert not made.exists()


def test_without_xacro_the_refusal_names_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda _name: None)
    path = package(tmp_path / "mine", "robot", f"{HEAD}<link name='b'/></robot>")
    with pytest.raises(ReadError, match=r"pip install 'articad\[xacro\]'"):
        read(path)
    assert xacro.INSTALL in "pip install 'articad[xacro]'"


def test_a_file_that_never_ends_is_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xacro, "SECONDS", 3.0)
    path = package(tmp_path / "mine", "robot", f'{HEAD}<link name="${{sum(x * y for x in range(10**5) for y in range(10**5))}}"/></robot>')
    with pytest.raises(ReadError, match=r"did not end within 3 s|xacro fails"):
        read(path)


def test_macros_that_double_end_with_their_processor_time(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(xacro, "PROCESSOR", 2)
    doubled = "".join(f'<xacro:macro name="m{i}"><xacro:m{i - 1}/><xacro:m{i - 1}/></xacro:macro>' for i in range(1, 40))
    path = tmp_path / "a.urdf.xacro"
    path.write_text(f'{HEAD}<xacro:macro name="m0"><b/></xacro:macro>{doubled}<xacro:m39/></robot>')
    with pytest.raises(ReadError, match="it did not end within 2 s of processor time"):
        read(path)


@pytest.mark.parametrize(
    "reach",
    [
        "<link name=\"${xacro.load_yaml('../../secret.yaml')}\"/>",
        '<xacro:include filename="../../secret.xacro"/>',
        '<xacro:include filename="$(find other)/secret.xacro"/>',
    ],
)
def test_a_file_below_the_root_of_all_that_is_read_reads_nothing_above_it(
    reach: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The server of an agent's tools sets that root; it may lie in a ROS package, whose other files are not the agent's."""
    package(tmp_path / "mine", "robot", MACRO)
    package(tmp_path / "other", "other", MACRO)
    for folder in ("mine", "other"):
        (tmp_path / folder / "secret.yaml").write_text("swordfish")
        (tmp_path / folder / "secret.xacro").write_text(f'{HEAD}<link name="swordfish"/></robot>')
    root = tmp_path / "mine" / "designs"
    (root / "arm").mkdir(parents=True)
    (root / "arm" / "a.urdf.xacro").write_text(f"{HEAD}{reach}</robot>")
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "other"))
    assert "swordfish" in read(root / "arm" / "a.urdf.xacro").parts
    monkeypatch.setenv("ARTICAD_ROOT", str(root))
    with pytest.raises(ReadError) as refused:
        read(root / "arm" / "a.urdf.xacro")
    assert "swordfish" not in str(refused.value)
    (root / "arm" / "a.urdf.xacro").write_text(f'{HEAD}<xacro:include filename="../part.xacro"/></robot>')
    (root / "part.xacro").write_text(f'{HEAD}<link name="mine"/></robot>')
    assert [*read(root / "arm" / "a.urdf.xacro").parts] == ["mine"]
    with pytest.raises(ReadError):
        read(tmp_path / "mine" / "urdf" / "a.urdf.xacro")
