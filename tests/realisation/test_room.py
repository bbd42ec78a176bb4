"""How far bodies may move between contacts, for contacts made by hand."""

from __future__ import annotations

import numpy as np

from articad.realisation.room import GROUND, Touch, room

FREE = np.zeros(6, dtype=bool)


def floor(body: int) -> Touch:
    """Three points of a body that stand on the ground."""
    points = np.array([[10.0, 0.0, 0.0], [-10.0, 10.0, 0.0], [-10.0, -10.0, 0.0]])
    return Touch(GROUND, body, points, np.tile([0.0, 0.0, 1.0], (3, 1)), np.zeros(3), 0.1)


def test_bodies_without_contacts_change_nothing() -> None:
    alone = room([floor(0)], FREE, np.zeros(3))
    assert np.allclose(room([floor(0), floor(3)], FREE, np.zeros(3)), alone, atol=1e-9)  # bodies 1 and 2 touch nothing
    assert alone[0, 2] > 1.0 or alone[1, 2] > 1.0
