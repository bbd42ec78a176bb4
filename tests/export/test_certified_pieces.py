"""The certificate of the solids is valid for their collision shapes: it is run again with the shapes in place of the solids."""

from __future__ import annotations

import math
from dataclasses import replace

import manifold3d
import numpy as np
import pytest
from lxml import etree

from articad.assembly import Assembly
from articad.certificates.certificate import Certificate
from articad.entry import read
from articad.export.collisions import shape_model
from articad.export.convex import manifold
from articad.export.lowering import lower
from articad.export.mjcf import write_mjcf
from articad.export.urdf import write_urdf
from articad.geometry.mesh import TriMesh
from articad.geometry.part import Part, Primitive, Shape, Solid
from articad.geometry.shapes import box, cylinder, sphere
from tests.assemblies import STEEL
from tests.export import judges

SAGITTA = 0.005  # of the facets of round shapes, which the deflection of their mesh states [mm]
QUICK = ("sewing_things_box", "four_bar", "toggle_clamp")
MODELS = [*judges.example_names(), *judges.hard_names()]
NAMES = [name if name in QUICK else pytest.param(name, marks=pytest.mark.soak) for name in MODELS]


def surface(shape: Shape) -> tuple[TriMesh, float]:
    """Return a collision shape as a mesh, and the largest distance of its true surface from that [mm]."""
    form = shape.primitive
    if form is None or form.kind == "box":
        return shape.placed, 0.0
    r = form.size[0]
    segments = max(24, math.ceil(math.pi / math.acos(max(0.0, 1 - SAGITTA / r))))
    sagitta = r * (1 - math.cos(math.pi / segments))
    if form.kind == "cylinder":
        return cylinder(r, form.size[1], segments).transformed(shape.frame), sagitta
    assert form.kind == "sphere"
    return sphere(r, segments).transformed(shape.frame), 2 * sagitta


def with_pieces(assembly: Assembly) -> Assembly:
    """Return the assembly whose solids are the unions of their collision shapes; declared fits hold for the solids only."""
    model = shape_model(assembly, replace(lower(assembly), features=()), "pieces")
    pieces = {link.part.name: pieced(link.part, [placed.shape for placed in link.collisions]) for link in model.links}
    return replace(assembly, parts={**assembly.parts, **pieces}, fits={})


def pieced(part: Part, shapes: list[Shape]) -> Part:
    if part.solid is None or not shapes:
        return part
    found = [surface(shape) for shape in shapes]
    body = manifold3d.Manifold.batch_boolean([manifold(mesh) for mesh, _ in found], manifold3d.OpType.Add).to_mesh64()
    mesh = TriMesh(np.array(body.vert_properties[:, :3], dtype=np.float64), np.array(body.tri_verts, dtype=np.int32))
    solid = Solid.from_mesh(mesh, deflection=max(off for _, off in found))
    return replace(part, solid=solid, collisions=(Shape(mesh),), visuals=())


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_the_pieces_of_an_example_are_certified_as_its_solids_are(name: str) -> None:
    """No contact is added: what is proven apart as solids is proven apart as pieces, over the same ranges, alone and two joints at a time."""
    assembly = read(judges.folder_of(name))
    certificate = with_pieces(assembly).certify()
    assert certificate.pairs

    if left := unproven(certificate):  # only what the solids leave, too; pieces have no declared fits, so neither have these solids
        assert left <= unproven(replace(assembly, fits={}).certify()), [str(finding) for finding in certificate.findings]


def unproven(certificate: Certificate) -> set[frozenset[str]]:
    """Return the pairs of parts that a certificate does not prove apart."""
    return {
        frozenset(pair.parts) for pair in certificate.pairs if pair.verdict in ("overlap", "unknown") or pair.strength.kind != "certified"
    }


def test_a_piece_outside_its_solid_is_seen() -> None:
    """The check has teeth: with hulls in place of pieces, the certificate of a drawer in its case fails."""
    assembly = read(judges.folder_of("sewing_things_box"))
    model = shape_model(assembly, replace(lower(assembly), features=()), "hull")
    hulls = {link.part.name: pieced(link.part, [placed.shape for placed in link.collisions]) for link in model.links}

    assert not replace(assembly, parts={**assembly.parts, **hulls}, fits={}).certify(pairs=False, budget=10).ok


@pytest.mark.parametrize(
    ("form", "volume"), [(Primitive("sphere", (5.0,)), 4 / 3 * math.pi * 125), (Primitive("cylinder", (5.0, 8.0)), 200 * math.pi)]
)
def test_round_shapes_have_their_true_size_within_the_stated_deflection(form: Primitive, volume: float) -> None:
    part = pieced(Part.from_mesh("one", box(1, 1, 1), density=STEEL), [Shape(box(1, 1, 1), primitive=form)])

    assert part.solid is not None
    assert 0 < part.solid.deflection <= 2 * SAGITTA
    assert part.solid.volume == pytest.approx(
        volume, rel=3 * part.solid.deflection / 5.0
    )  # dV/V = 3 dr/r of a sphere, 2 dr/r of a cylinder


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_every_pair_that_does_not_collide_cites_its_claim(name: str) -> None:
    """In MJCF and SRDF; and the pairs are those that share a joint, never move, or whose solids overlap at rest."""
    assembly = read(judges.folder_of(name))
    mjcf = write_mjcf(assembly)
    urdf = write_urdf(assembly, srdf=True)
    contact = etree.fromstring(mjcf.files[mjcf.main]).find("contact")
    semantics = etree.fromstring(next(content for path, content in urdf.files.items() if path.endswith(".srdf")))
    joined = {frozenset((joint.parent, joint.child)) for joint in assembly.joints}
    names = {valid: part for part, valid in ((link.part.name, link.name) for link in lower(assembly).links)}

    for rows, first, second in ((contact, "body1", "body2"), (semantics, "link1", "link2")):
        for row in rows.iter("exclude", "disable_collisions") if rows is not None else ():
            claim = row.getprevious()
            assert isinstance(claim, etree._Comment), (name, row.attrib)
            pair = frozenset((names[row.get(first)], names[row.get(second)]))
            text = str(claim.text).strip()
            assert text.startswith(("adjacent: ", "resting: ", "never move: ", "not checked: ")), text
            assert all(part in text for part in pair)
            if text.startswith("adjacent: "):
                assert pair in joined
                assert "joint" in text
