"""Collision shapes: hulls and convex pieces, what they add, and the contacts that they must not bring."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from lxml import etree

from articad.assembly import Assembly
from articad.connectors.connector import Connector
from articad.connectors.se3 import SE3
from articad.export import collisions, contacts, convex, gaps, meshes
from articad.export.contacts import poses_in_motion
from articad.export.convex import pieces_of, whole_hull
from articad.export.mjcf import write_mjcf
from articad.export.sdf import write_sdf
from articad.export.urdf import write_urdf
from articad.export.usd import write_usd
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part, Solid
from articad.geometry.shapes import box, sphere, tube
from articad.importers.urdf import read_urdf
from articad.interference.body import Body
from articad.kernels.cache import BuildCache
from articad.kinematics import declare
from articad.simulation.examine import simulate_assembly
from tests.assemblies import STEEL, block, four_bar, frame

WRITERS: dict[str, Any] = {"urdf": write_urdf, "mjcf": write_mjcf}


@pytest.fixture(scope="module")
def cache(tmp_path_factory: Any) -> BuildCache:
    return BuildCache(tmp_path_factory.mktemp("pieces"))


def channel() -> TriMesh:
    """A channel along x, 100 mm long, open above: a floor and two walls, 10 mm thick, 40 mm wide inside."""
    profile = [(-30, 0), (30, 0), (30, 40), (20, 40), (20, 10), (-20, 10), (-20, 40), (-30, 40)]
    n = len(profile)
    vertices = np.array([(x, y, z) for x in (-50.0, 50.0) for y, z in profile])
    caps = [(0, 1, 4), (0, 4, 5), (1, 2, 3), (1, 3, 4), (0, 5, 6), (0, 6, 7)]
    sides = [(i, (i + 1) % n) for i in range(n)]
    triangles = [(a, c, b) for a, b, c in caps] + [(a + n, b + n, c + n) for a, b, c in caps]
    triangles += [corner for i, j in sides for corner in ((i, j, j + n), (i, j + n, i + n))]
    return TriMesh(vertices, np.array(triangles))


def sledge(*, from_outside: bool) -> Assembly:
    """A block that slides in a channel which stands on a base: no joint connects the two."""
    base = block("base", (10, 10, 5), foot=frame(at=(0, 0, -200)), rail=frame(at=(-150.0 if from_outside else 0.0, 0, 25), z=(1, 0, 0)))
    rail = Part.from_mesh("rail", channel(), density=STEEL, connectors={"foot": Connector("foot", SE3.from_translation((0, 0, -200)))})
    slider = block("slider", (20, 30, 20), rail=frame(z=(1, 0, 0)))
    joints = [
        declare.revolute("stand", base["foot"], rail["foot"], limits=(0, 0.001)),
        declare.slider("slide", base["rail"], slider["rail"], limits=(0.0, 150.0) if from_outside else (-20.0, 20.0)),
    ]
    return Assembly.from_parts("sledge", parts=[replace(base, collisions=()), rail, slider], joints=joints, ground="base")


def test_the_channel_is_a_body() -> None:
    assert Body(channel()).fault is None
    assert channel().volume == pytest.approx(100 * (60 * 40 - 40 * 30))


@pytest.mark.parametrize("collision", ["solid", "hull"])
@pytest.mark.parametrize("from_outside", [False, True])
@pytest.mark.parametrize("writer", WRITERS)
def test_hulls_that_meet_at_rest_or_only_in_motion_are_told(writer: str, from_outside: bool, collision: str) -> None:
    bundle = WRITERS[writer](sledge(from_outside=from_outside), collision=collision)

    assert "parts.rail+slider" in [loss.where for loss in bundle.losses]
    assert (b'body1="rail" body2="slider"' in bundle.files[bundle.main]) == (writer == "mjcf")


@pytest.mark.parametrize("from_outside", [False, True])
@pytest.mark.parametrize("writer", WRITERS)
def test_pieces_are_the_default_and_let_the_slider_pass(writer: str, from_outside: bool, cache: BuildCache) -> None:
    bundle = WRITERS[writer](sledge(from_outside=from_outside), cache=cache)

    assert "parts.rail+slider" not in [loss.where for loss in bundle.losses]
    assert b'body1="rail" body2="slider"' not in bundle.files[bundle.main]
    assert "parts.rail" not in [loss.where for loss in bundle.losses]  # three boxes are all of it


@pytest.mark.engines
def test_mujoco_holds_the_slider_in_its_channel_without_contact(cache: BuildCache, tmp_path: Path) -> None:
    import mujoco

    bundle = write_mjcf(sledge(from_outside=True), cache=cache)
    bundle.write(tmp_path)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / bundle.main))
    data = mujoco.MjData(model)
    for travel in np.linspace(0, 0.15, 31):
        data.qpos[:] = [0, travel]
        mujoco.mj_forward(model, data)

        assert data.ncon == 0
    slides = model.joint("slide").qposadr[0]
    data.qpos[slides] = 0.15
    model.body_pos[model.body("slider").id][1] += 0.01  # pushed through the wall: now there must be contact
    mujoco.mj_forward(model, data)

    assert data.ncon > 0


def test_only_parts_that_share_a_joint_are_excluded_and_the_joint_is_cited(cache: BuildCache) -> None:
    assembly = sledge(from_outside=False)
    root = etree.fromstring(write_mjcf(assembly, cache=cache).files["sledge.xml"])
    rows = list(root.find("contact"))
    cited = [(rows[i].text.strip(), (rows[i + 1].get("body1"), rows[i + 1].get("body2"))) for i in range(0, len(rows), 2)]

    assert {pair for _, pair in cited} == {("base", "rail"), ("base", "slider")}
    assert all(text.startswith("adjacent:") for text, _ in cited)
    assert "joint stand" in cited[0][0]


def rail_on_bracket(gap: float, *, standing: bool) -> Assembly:
    """A rail that turns about a pin which is fixed to a bracket, `gap` above the bracket; perhaps all of it on a turntable."""
    table = block("table", (60, 60, 10), on=frame(at=(0, 0, 5)))
    bracket = block("bracket", (40, 40, 10), foot=frame(at=(0, 0, -5)), top=frame(at=(0, 0, 5)))
    pin = block("pin", (4, 4, 40), foot=frame(at=(0, 0, -20)))
    rail = Part.from_mesh("rail", tube(3, 6, 10), density=STEEL, connectors={"bore": Connector("bore", SE3.identity())})
    arm = block("arm", (100, 8, 10), bore=frame(at=(-56, 0, 0)))
    far = Connector("up", SE3.from_translation((0, 0, -15 + gap)))
    pin = replace(pin, connectors={**pin.connectors, "up": far})
    joints = [
        declare.fixed("stands", table["on"], bracket["foot"])
        if standing
        else declare.revolute("spin", table["on"], bracket["foot"], limits=(-1, 1)),
        declare.fixed("held", bracket["top"], pin["foot"]),
        declare.revolute("swing", pin["up"], rail["bore"], limits=(0.0, 3.0)),
        declare.fixed("welded", rail["bore"], arm["bore"]),
    ]
    return Assembly.from_parts("rack", parts=[table, bracket, pin, rail, arm], joints=joints, ground="table")


@pytest.mark.parametrize("standing", [True, False])
@pytest.mark.parametrize(("gap", "resting"), [(0.0, True), (0.5, False)])
def test_parts_that_rest_on_what_carries_their_joint_are_excluded(gap: float, resting: bool, standing: bool, cache: BuildCache) -> None:
    assembly = rail_on_bracket(gap, standing=standing)
    text = write_mjcf(assembly, cache=cache).files["rack.xml"].decode()
    semantics = write_urdf(assembly, srdf=True, cache=cache).files["rack.srdf"].decode()

    assert ('<exclude body1="bracket" body2="arm"/>' in text) == resting
    assert ('link1="bracket" link2="arm"' in semantics) == resting
    assert '<exclude body1="table" body2="arm"/>' not in text
    assert simulate_assembly(assembly, "rack", engines=("mujoco",)).ok


def test_parts_that_are_fixed_together_rest_on_nothing(cache: BuildCache) -> None:
    """Two blocks that touch each other, both on one plate, beside a wheel: they never move, which is the only claim about them."""
    plate = block("plate", (60, 60, 10), a=frame(at=(-10, 0, 5)), b=frame(at=(10, 0, 5)), hub=frame(at=(0, 0, 80)))
    blocks = [block(name, (20, 20, 20), foot=frame(at=(0, 0, -10))) for name in "ab"]
    wheel = block("wheel", (5, 5, 5), hub=frame())
    joints = [declare.fixed(f"on_{each.name}", plate[each.name], each["foot"]) for each in blocks]
    joints.append(declare.revolute("spin", plate["hub"], wheel["hub"], limits=(-1, 1)))
    assembly = Assembly.from_parts("two", parts=[plate, *blocks, wheel], joints=joints, ground="plate")

    assert gaps.resting(assembly) == {}
    assert write_urdf(assembly, srdf=True, cache=cache).files["two.srdf"].decode().count('link1="a" link2="b"') == 1


def lid_above_box(gap: float, wide: float = 20.0) -> Assembly:
    """Two blocks, 20 mm high, the upper one `gap` above the lower one."""
    lower, upper = block("lower", (20, 20, 20), top=frame(at=(0, 0, 10 + gap))), block("upper", (wide, 20, 20), foot=frame(at=(0, 0, -10)))
    return Assembly.from_parts("two", parts=[lower, upper], joints=[declare.fixed("lid", lower["top"], upper["foot"])], ground="lower")


def test_the_gap_of_joined_parts_is_measured_once_for_their_shapes_and_poses(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ARTICAD_CACHE", str(tmp_path))
    pair = ("lower", "upper")
    wide = collisions.adjacent(lid_above_box(0.25), pair)
    assert wide == "adjacent: lower and upper touch by design at joint lid: the gap at rest is 0.25 mm"
    with monkeypatch.context() as measured_no_more:
        measured_no_more.setattr(gaps, "manifold", None)
        assert collisions.adjacent(lid_above_box(0.25), pair) == wide
    assert "the gap at rest is 0.5 mm" in collisions.adjacent(lid_above_box(0.5), pair)
    assert "more than 1 mm apart" in collisions.adjacent(lid_above_box(1.5), pair)
    assert "the gap at rest is 0.25 mm" in collisions.adjacent(lid_above_box(0.25, wide=30.0), pair)


def test_solids_that_overlap_at_rest_are_excluded_and_it_is_said(cache: BuildCache) -> None:
    a, b = block("a", (20, 20, 20), at=frame()), block("b", (20, 20, 20), at=frame(at=(-35, 0, 0)))
    ground = block("ground", (5, 5, 5), one=frame(at=(0, 0, 200)), two=frame(at=(-20, 0, 200)))
    joints = [declare.fixed("first", ground["one"], a["at"]), declare.revolute("second", ground["two"], b["at"], limits=(-0.1, 0.1))]
    text = (
        write_mjcf(Assembly.from_parts("pair", parts=[ground, a, b], joints=joints, ground="ground"), cache=cache)
        .files["pair.xml"]
        .decode()
    )

    assert "not checked: the solids of a and b overlap by 2e+03 mm³ at rest" in text
    assert '<exclude body1="a" body2="b"/>' in text


def forms(assembly: Assembly, cache: BuildCache) -> dict[str, list[str]]:
    """Return the kinds of collision shapes of the part `rail` by format."""
    urdf = etree.fromstring(write_urdf(assembly, cache=cache).files["sledge.urdf"])
    mjcf = etree.fromstring(write_mjcf(assembly, cache=cache).files["sledge.xml"])
    sdf = etree.fromstring(write_sdf(assembly, cache=cache).files["sledge.sdf"])
    usd = write_usd(assembly, cache=cache).files["sledge.usda"].decode()
    usd = usd.partition('def Xform "rail"')[2].partition('def Xform "slider"')[0]
    return {
        "urdf": [one.tag for one in urdf.iterfind("link[@name='rail']/collision/geometry/*")],
        "mjcf": [one.get("type") for one in mjcf.iterfind(".//body[@name='rail']/geom[@class='collision']")],
        "sdf": [one.tag for one in sdf.iterfind("model/link[@name='rail']/collision/geometry/*")],
        "usd": re.findall(r'def (\w+) "collision_\d+"', usd),
    }


def test_all_formats_have_the_same_shapes(cache: BuildCache) -> None:
    found = forms(sledge(from_outside=False), cache)

    assert found["urdf"] == found["mjcf"] == found["sdf"] == ["box"] * 3
    assert found["usd"] == ["Cube"] * 3


def test_what_pieces_leave_out_is_told(cache: BuildCache) -> None:
    ring = Part.from_mesh("ring", tube(20, 30, 10, 64), density=STEEL)
    bundle = write_mjcf(Assembly.from_parts("alone", parts=[ring], joints=[], ground="ring"), cache=cache)
    (loss,) = (loss for loss in bundle.losses if loss.where == "parts.ring")

    assert "of the solid left out" in loss.kept
    assert not loss.refused


def test_an_open_mesh_collides_as_it_is(cache: BuildCache) -> None:
    whole = box(10, 10, 10)
    part = Part.from_mesh("lid", TriMesh(whole.vertices, whole.triangles[:-1]))
    bundle = write_mjcf(Assembly.from_parts("alone", parts=[part], joints=[], ground="lid"), cache=cache)

    assert [loss.lost for loss in bundle.losses if loss.where == "parts.lid"] == ["convex pieces: the surface encloses no volume"]


def test_the_hull_of_a_ring_is_measured() -> None:
    assert whole_hull(tube(20, 30, 10, 12)).more == pytest.approx(0.8)  # 30² / (30² - 20²) - 1


def test_pieces_are_kept_by_shape(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    cache = BuildCache(tmp_path)
    first = pieces_of(channel(), cache)

    def never(*_: object, **__: object) -> None:
        raise AssertionError("pieces are found anew")

    monkeypatch.setattr(convex, "inscribed", never)
    again = pieces_of(channel(), cache)

    assert [(piece.mesh.digest, piece.primitive, piece.frame.data.tolist()) for piece in again.pieces] == [
        (piece.mesh.digest, piece.primitive, piece.frame.data.tolist()) for piece in first.pieces
    ]
    assert (again.missing, again.bound, again.less) == (first.missing, first.bound, first.less)


@pytest.mark.parametrize("write", [write_mjcf, write_urdf, write_sdf, write_usd])
def test_an_export_with_a_filled_cache_computes_no_mesh_again(write: Any, cache: BuildCache, monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither pieces nor visual meshes are computed, and no body of a fine mesh is made: the files are the same."""

    def balls() -> Assembly:
        built = [Solid.from_mesh(sphere(20, count), deflection=0.001) for count in (160, 170)]  # of 25,600 triangles or more
        connectors = {"at": Connector("at", SE3.identity())}
        parts = [Part.from_solid(name, one, density=STEEL, connectors=connectors) for name, one in zip(("a", "b"), built, strict=True)]
        return Assembly.from_parts(
            "two", parts=parts, joints=[declare.slider("slide", parts[0]["at"], parts[1]["at"], limits=(100, 200), rest=150)], ground="a"
        )

    first = write(balls(), cache=cache)
    meshes._drawn.cache_clear()  # as in another process
    sizes: list[int] = []
    made = convex.manifold

    def counted(mesh: TriMesh) -> Any:
        sizes.append(len(mesh.triangles))
        return made(mesh)

    for module in (convex, gaps, contacts, meshes):
        monkeypatch.setattr(module, "manifold", counted)
    monkeypatch.setattr(convex, "inscribed", lambda *_, **__: pytest.fail("pieces are found anew"))
    again = write(balls(), cache=cache)

    assert again.files == first.files
    assert max(sizes, default=0) <= meshes.DRAWN_TRIANGLES


def test_what_is_drawn_of_a_built_part_is_coarser_and_says_by_how_much(cache: BuildCache, tmp_path: Path) -> None:
    """A ball of 100,000 triangles becomes one of at most 5,000; what is read back states the larger deflection."""
    fine = Solid.from_mesh(sphere(20, 320), deflection=0.001)
    part = Part.from_solid("ball", fine, density=STEEL)
    bundle = write_urdf(Assembly.from_parts("alone", parts=[part], joints=[], ground="ball"), cache=cache)
    bundle.write(tmp_path)
    again = read_urdf(tmp_path / bundle.main).parts["ball"]

    assert len(fine.mesh.triangles) > 90_000
    assert again.solid is not None
    assert len(again.solid.mesh.triangles) <= 5000
    off = np.abs(np.linalg.norm(again.solid.mesh.vertices[again.solid.mesh.triangles].mean(axis=1), axis=1) - 20)
    assert float(off.max()) <= again.solid.deflection <= 0.01 * 40 * np.sqrt(3)
    assert again.mass is not None
    assert part.mass is not None
    assert again.mass.mass == part.mass.mass


def test_motion_is_sampled_as_far_as_loops_go() -> None:
    mechanism = four_bar((-1.0, 1.0)).mechanism
    poses = poses_in_motion(mechanism)

    assert len(poses) > 5
    assert np.allclose(poses[0], mechanism.poses(mechanism.rest).matrix)
