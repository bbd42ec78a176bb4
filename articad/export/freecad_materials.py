"""Cards of FreeCAD's material library for the materials of a plan.

A document states a material by the identifier of a card alone, so a density of its own is not possible. A card is therefore used only if its
density is within 1 % of the plan's, and only a generic one: a plan does not state a grade. The exact density and mass are in properties of the part.
"""

from __future__ import annotations

import re

NEAR = 0.01  # relative difference of the densities

_CARDS = (  # words of a material's name, the card's identifier in FreeCAD 1.0 and 1.1, its density [kg/m³]
    (("steel",), "90bbd8ef-8623-4d78-b3bf-e0bdb9b74dd3", 7900.0),  # Steel-Generic
    (("iron",), "1826c364-d26a-43fb-8f61-288281236836", 7874.0),  # Iron-Generic
    (("aluminium", "aluminum", "alu", "anodised", "anodized"), "9bf060e9-1663-44a2-88e2-2ff6ee858efe", 2700.0),  # Aluminum-Generic
    (("copper",), "6c03899d-496e-4c60-a41b-3d66f2337fb9", 8960.0),  # Copper-Generic
    (("wood", "oak", "beech", "ash", "maple", "birch", "plywood"), "b588224e-e8d6-47ad-ba1f-a058333fd1c6", 700.0),  # Wood-Generic
    (("glass",), "3e3a3e13-04a4-410e-8e36-bbd83ca66847", 2520.0),  # Glass-Generic
    (("concrete",), "26042aa5-56e6-4d99-8b63-dd8b9ea5a37a", 2400.0),  # Concrete-Generic
    (("graphite",), "5c67b675-69a2-4782-902a-bb90c3952f07", 1750.0),  # Graphite
    (("abs",), "73371529-2983-47dd-b988-6739a2e20029", 1060.0),  # ABS-Generic
    (("pla",), "93861244-fbbe-41a9-a7e0-aeed53abd782", 1240.0),  # PLA-Generic
    (("pa", "pa6", "nylon", "polyamide"), "9d59dc3b-ce66-4bec-82c9-b962082e7c9e", 1150.0),  # PA6-Generic
    (("pp", "polypropylene"), "0e669f57-de27-4915-9a02-124f36047972", 916.0),  # PP-Generic
    (("petg", "pet"), "f73004e3-6fb4-4591-8be7-89d1370be312", 1380.0),  # PET-Generic
    (("pvc",), "758cfc44-f4ad-4605-8645-75e9e6b053ab", 1380.0),  # PVC-Generic
    (("ptfe", "teflon"), "8ce226db-43ef-4471-93f1-07e7276aa276", 2070.0),  # PTFE-Generic
    (("acrylic", "pmma", "plexiglass"), "f255cd82-91d5-4e97-9032-1843128a2eaa", 1160.0),  # Acrylic-Glass-Generic
)


def card(material: str | None, density: float | None) -> str | None:
    """Return the identifier of the card in FreeCAD's library that a material is, or None.

    Args:
        material: Its name in the plan, such as "zinc_plated_steel".
        density: Its density [kg/m³].
    """
    if material is None or not density:
        return None
    words = set(re.split(r"[^a-z0-9]+", material.lower()))
    fitting = [(abs(held / density - 1.0), identifier) for names, identifier, held in _CARDS if words & set(names)]
    near, identifier = min(fitting, default=(NEAR + 1.0, ""))
    return identifier if near <= NEAR else None
