"""Materials of FreeCAD's library: a part has the card whose density is its own, or none."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache

import pytest

import articad as ac
from articad.export.freecad import write_freecad, write_freecad_alone
from articad.export.freecad_materials import NEAR, card
from articad.importers.freecad_materials import DENSITIES
from articad.kernels import freecad_install
from articad.kernels.freecad_install import FreeCAD
from tests.freecad import cupboard, opened
from tests.freecad.test_split import metronome

VERSIONS = pytest.mark.parametrize(
    "freecad", [freecad_install.find, pytest.param(opened.newer, marks=pytest.mark.freecad_next)], ids=["1.0", "next"]
)


@pytest.mark.parametrize(
    ("material", "density", "expected"),
    [
        ("zinc_plated_steel", 7850.0, 7900.0),
        ("oak", 700.0, 700.0),
        ("aluminium", 2700.0, 2700.0),
        ("steel", 7700.0, None),  # too light
        ("brass", 8500.0, None),  # not in the library
        ("steelblue_paint", 7900.0, None),  # another word
        (None, 7900.0, None),
        ("steel", None, None),
    ],
)
def test_a_card_fits_by_name_and_density(material: str | None, density: float | None, expected: float | None) -> None:
    found = card(material, density)
    assert (None if found is None else DENSITIES[found]) == expected


@cache
def documents() -> list[tuple[ac.Assembly, bytes]]:
    made = [(cupboard.assembly(), write_freecad(cupboard.assembly())), (metronome(), write_freecad_alone(metronome()))]
    return [(assembly, bundle.files[bundle.main]) for assembly, bundle in made]


@pytest.mark.freecad
@opened.needs_freecad
@VERSIONS
def test_freecad_reads_the_densities_back(freecad: Callable[[], FreeCAD]) -> None:
    seen = set()
    for assembly, document in documents():
        (look,) = opened.steps(document, {"do": "look"}, freecad=freecad())
        for name, part in assembly.parts.items():
            material, density = look["materials"][name]
            assert part.solid is not None
            assert part.mass is not None
            if card(part.material, part.mass.mass / part.solid.volume * 1e9) is None:
                assert material == "Default"
                continue
            seen.add(material)
            assert density * part.solid.volume * 1e-9 == pytest.approx(part.mass.mass, rel=NEAR), name
    assert {"Wood-Generic", "Steel-Generic"} <= seen
