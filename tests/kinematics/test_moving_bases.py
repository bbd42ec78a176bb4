"""Loops and couplings on a base that moves: every driver moves its parts, wherever it stands in the tree."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from articad.assembly import Assembly
from articad.connectors import SE3
from tests import moving_bases
from tests.kinematics.linkages import mismatch


@pytest.mark.parametrize("make", moving_bases.ALL.values(), ids=moving_bases.ALL)
def test_the_joint_below_all_turns_everything_above_it(make: Callable[[], Assembly]) -> None:
    mechanism = make().mechanism
    rng = np.random.default_rng(0)
    still = mechanism.rest + rng.uniform(-0.3, 0.3, (5, mechanism.nq))
    still[:, 0] = 0.0
    turned = still.copy()
    turned[:, 0] = rng.uniform(-2, 2, 5)
    pivot = mechanism.joints[0].T_parent_connector
    turn = pivot @ SE3.rot_z(turned[:, 0]) @ pivot.inverse()
    wanted = turn.matrix[:, None] @ mechanism.poses(still).matrix[:, 1:]
    assert np.abs(mechanism.poses(turned).matrix[:, 1:] - wanted).max() < 1e-9


@pytest.mark.parametrize("make", moving_bases.ALL.values(), ids=moving_bases.ALL)
def test_every_driver_has_the_value_that_was_asked_for_and_all_joints_meet(make: Callable[[], Assembly]) -> None:
    mechanism = make().mechanism
    rng = np.random.default_rng(1)
    for _ in range(5):
        q = mechanism.rest + rng.uniform(-0.3, 0.3, mechanism.nq)
        assert np.abs(mechanism.configuration(q).columns[list(mechanism.driver_columns)] - q).max() == 0.0
        assert max(mismatch(mechanism, q)) < 1e-9


@pytest.mark.parametrize("make", moving_bases.ALL.values(), ids=moving_bases.ALL)
def test_a_sweep_moves_what_is_above_its_driver_too(make: Callable[[], Assembly]) -> None:
    mechanism = make().mechanism
    for index, driver in enumerate(mechanism.drivers):
        values = np.linspace(-0.2, 0.2, 5) + mechanism.rest[index]
        q = np.tile(mechanism.rest, (5, 1))
        q[:, index] = values
        swept = mechanism.drive(driver.name, values[0], values[-1], 5)
        assert np.abs(swept.poses().matrix - mechanism.poses(q).matrix).max() < 1e-9
