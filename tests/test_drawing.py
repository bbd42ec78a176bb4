"""Pictures of a run: drawn in a process of their own, once for each content, and never at the price of a result."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest

from articad import cli
from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.geometry.part import Part
from articad.geometry.shapes import box
from articad.kinematics import declare
from articad.plan.schema import AssemblyPlan
from articad.processes import launcher
from articad.runs import drawing
from articad.runs.run import Run
from tests.render.test_pictures import frame


@pytest.fixture(scope="module", autouse=True)
def cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("ARTICAD_CACHE", str(tmp_path_factory.mktemp("cache")))
        yield


@pytest.fixture(scope="module")
def product(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("work") / "my_box"
    assert cli.main(["new", str(folder), "-q"]) == 0
    assert cli.main(["build", str(folder), "--out", str(folder.parent / "first"), "--export", "urdf", "-q"]) == 0
    return folder


def pictures(run: Path) -> dict[str, bytes]:
    found = [*run.glob("parts/*/views/*.png"), *run.glob("motion/*")]
    return {file.relative_to(run).as_posix(): file.read_bytes() for file in found}


def test_a_second_build_of_the_same_product_draws_nothing_and_has_the_same_pictures(
    product: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(*_: object, **__: object) -> launcher.Ended:
        raise AssertionError("a process was started")

    monkeypatch.setattr(drawing, "launcher", SimpleNamespace(run=refuse, Limits=launcher.Limits))  # simulators still have processes

    assert cli.main(["build", str(product), "--out", str(tmp_path / "second"), "--export", "urdf", "-q"]) == 0

    first = pictures(product.parent / "first")
    assert "motion/lid_hinge.gif" in first or any(name.startswith("motion/") for name in first)
    assert len([name for name in first if name.startswith("parts/")]) == 4 * len(AssemblyPlan.load(product).parts)
    assert pictures(tmp_path / "second") == first


@pytest.mark.parametrize("ended", [launcher.Ended(-11, late=False, out=b"", err=b""), launcher.Ended(0, late=False, out=b"", err=b"")])
def test_a_drawing_process_that_crashes_takes_no_result_with_it(
    product: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], ended: launcher.Ended
) -> None:
    stand_in = {name: getattr(launcher, name) for name in ("Limits", "OWN", "environment")} | {"run": lambda *_, **__: ended}
    monkeypatch.setattr(drawing, "launcher", SimpleNamespace(**stand_in))
    monkeypatch.setattr(drawing, "_RECIPE", "another")  # nothing of it is in the cache

    assert cli.main(["build", str(product), "--out", str(tmp_path / "run"), "--export", "urdf"]) == 0

    said = capsys.readouterr().out
    assert ("signal 11" if ended.code else "the cache has lost them") in said
    assert pictures(tmp_path / "run") == {}
    assert Run.view(tmp_path / "run").checks() is not None
    assert (tmp_path / "run" / "report.html").is_file()


def slide(colour: str = "#808080", width: float = 10.0, upper: float = 20.0, at: float = 15.0, kind: str = "slider") -> Assembly:
    base = Part.from_mesh("base", box(120, 10, 10), connectors={"slide": Connector("slide", frame((0, 0, at), (1, 0, 0)))})
    cube = Part.from_mesh("cube", box(width, 10, 10), color=colour, connectors={"slide": Connector("slide", frame((0, 0, 0), (1, 0, 0)))})
    joint = getattr(declare, kind)("drive", base["slide"], cube["slide"], limits=(-1.0, upper))
    return Assembly.from_parts("rail", parts=[base, cube], joints=[joint], ground="base")


def test_the_key_of_a_motion_changes_with_everything_that_it_shows() -> None:
    def key(assembly: Assembly) -> str:
        return next(one.key for one in drawing.drawings(assembly) if one.joint == "drive")

    kept = key(slide())

    changed = [slide(colour="#818080"), slide(width=11.0), slide(upper=21.0), slide(at=16.0), slide(kind="revolute")]
    assert key(slide()) == kept
    assert len({kept, *map(key, changed)}) == 1 + len(changed)


def test_the_look_of_a_part_is_its_shape_and_its_colour() -> None:
    part = slide().parts["cube"]

    assert drawing._look(part) == drawing._look(replace(part, name="other"))
    assert drawing._look(part) != drawing._look(replace(part, color="#123456", visuals=()))
