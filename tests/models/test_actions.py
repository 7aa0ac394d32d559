"""One robot's action is read as those of many are."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.models.actions import GO_TO_BALL_ACTION, SHOOT_ACTION, ActionScaling, command_of, commands_of
from robobt.world import KickTrigger


@pytest.mark.parametrize("scaling", [GO_TO_BALL_ACTION, SHOOT_ACTION])
def test_a_single_action_stands_for_the_same_command_as_in_a_batch(scaling: ActionScaling) -> None:
    actions = np.random.default_rng(3).normal(0.0, 0.8, (300, scaling.size))
    for action, wanted in zip(actions, commands_of(actions, scaling), strict=True):
        found = command_of(action.tolist(), scaling)
        np.testing.assert_allclose(
            [found.vx, found.vy, found.omega, found.kick_speed, found.dribbler],
            [*wanted[:4], wanted[5]],
            rtol=1e-15,
        )
        assert found.kick_trigger is KickTrigger.NOW
