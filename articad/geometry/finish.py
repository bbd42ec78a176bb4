"""The look of declared materials: how much they reflect, how roughly, and whether light passes through."""

from __future__ import annotations

import re
from dataclasses import dataclass


@dataclass(frozen=True)
class Finish:
    """How a material answers light; the colour is the part's own.

    Attributes:
        metal: Share of the colour that is reflected as by a metal, 0 to 1.
        roughness: 0 for a mirror, 1 for chalk.
        opacity: 1 for solid; less lets through what is behind.
        gloss: Strength of the clear reflection over the colour; about 1 for paint and plastic, less for cloth and rubber.
        grain: Strength of the rings of wood in the colour.
    """

    metal: float = 0.0
    roughness: float = 0.5
    opacity: float = 1.0
    gloss: float = 1.0
    grain: float = 0.0


# The first row with a word of the material's name counts: "painted_steel" is paint, "cast_iron" is rougher than steel.
_LOOKS: tuple[tuple[frozenset[str], Finish], ...] = (
    (frozenset({"glass", "acrylic", "plexiglass", "polycarbonate", "clear", "transparent", "crystal"}), Finish(0.0, 0.06, 0.42, 1.6)),
    (
        frozenset({"painted", "paint", "enamel", "enamelled", "lacquer", "lacquered", "powder", "coated", "glazed"}),
        Finish(0.0, 0.28, 1.0, 1.2),
    ),
    (frozenset({"rubber", "neoprene", "silicone", "tyre", "tire", "epdm"}), Finish(0.0, 0.8, 1.0, 0.6)),
    (
        frozenset({"felt", "baize", "cloth", "fabric", "leather", "foam", "cork", "paper", "cardboard", "velvet"}),
        Finish(0.0, 1.0, 1.0, 0.15),
    ),
    (
        frozenset(
            [
                "wood",
                "oak",
                "walnut",
                "beech",
                "birch",
                "pine",
                "ash",
                "maple",
                "cherry",
                "spruce",
                "teak",
                "mahogany",
                "bamboo",
                "plywood",
                "mdf",
                "timber",
                "hardwood",
                "softwood",
            ]
        ),
        Finish(0.0, 0.5, 1.0, 0.7, 1.0),
    ),
    (frozenset({"anodised", "anodized"}), Finish(0.55, 0.42)),
    (frozenset({"chrome", "chromed", "chromium", "mirror", "polished", "silver", "gold", "nickel"}), Finish(0.9, 0.12)),
    (frozenset({"cast", "iron", "dark", "forged", "lead", "graphite"}), Finish(0.6, 0.6)),
    (
        frozenset(
            [
                "steel",
                "stainless",
                "aluminium",
                "aluminum",
                "brass",
                "bronze",
                "copper",
                "zinc",
                "titanium",
                "tin",
                "magnesium",
                "metal",
                "alloy",
                "galvanised",
            ]
        ),
        Finish(0.9, 0.26),
    ),
    (frozenset({"ceramic", "porcelain", "bone", "ivory", "marble", "stone", "granite"}), Finish(0.0, 0.25, 1.0, 1.1)),
    (
        frozenset(
            [
                "plastic",
                "abs",
                "pla",
                "petg",
                "nylon",
                "pom",
                "delrin",
                "acetal",
                "pvc",
                "hdpe",
                "ptfe",
                "teflon",
                "resin",
                "pa12",
                "pa6",
                "peek",
                "bakelite",
            ]
        ),
        Finish(0.0, 0.4),
    ),
)


def finish_of(material: str) -> Finish:
    """Return the look of a material by the words of its name; an unknown one looks like matt plastic."""
    words = set(re.split(r"[^a-z0-9]+", material.lower()))
    return next((look for names, look in _LOOKS if words & names), Finish())
