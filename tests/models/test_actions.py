"""A learned policy's action means the same in training and in a match."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.models.actions import GO_TO_BALL_ACTION, SHOOT_ACTION, ActionScaling, command_of, fill_commands
from robobt.models.card import action_outputs
from robobt.world import KickTrigger
from robobt.world.compiled import numbers_of


def filled(actions: np.ndarray, scaling: ActionScaling, kick_factor: float = 1.0) -> np.ndarray | None:
    commands = np.full((len(actions), 6), 9.0)
    factors = np.full(len(actions), kick_factor)
    kind = scaling.drives, scaling.kicks, scaling.holds
    return commands if fill_commands(actions, numbers_of(scaling), *kind, factors, commands) else None


BOTH = ActionScaling(kind="drive_and_kick", max_speed=3.0, max_turn=6.0, kick_speed=6.0, dribbler=True)
HOLD = ActionScaling(kind="drive_and_hold", max_speed=2.0, max_turn=4.0)


@pytest.mark.parametrize(
    "scaling",
    [GO_TO_BALL_ACTION, SHOOT_ACTION, BOTH, HOLD, GO_TO_BALL_ACTION.model_copy(update={"dribbler": True})],
)
def test_a_single_action_stands_for_the_same_command_as_in_a_batch(scaling: ActionScaling) -> None:
    actions = np.random.default_rng(3).normal(0.0, 0.8, (300, scaling.size))
    actions[0] = 0.0
    for action, expected in zip(actions, filled(actions, scaling), strict=True):
        found = command_of(action.tolist(), scaling)
        np.testing.assert_allclose(
            [found.vx, found.vy, found.omega, found.kick_speed, 0.0, found.dribbler], expected, rtol=1e-15
        )
        assert found.kick_trigger is KickTrigger.NOW


def test_the_dribbler_turns_where_the_action_holds() -> None:
    held, let_go = filled(np.array([[0.0, 0.0, 0.0, 0.1], [0.0, 0.0, 0.0, 0.0]]), HOLD)
    assert (held[5], let_go[5]) == (1.0, 0.0)


@pytest.mark.parametrize("scaling", [GO_TO_BALL_ACTION, SHOOT_ACTION, BOTH, HOLD])
def test_a_card_has_an_output_for_every_entry(scaling: ActionScaling) -> None:
    assert tuple(output.name for output in action_outputs(scaling)) == scaling.entries


def test_driving_diagonally_is_not_faster() -> None:
    commands = filled(np.random.default_rng(2).uniform(-1.5, 1.5, (300, 3)), GO_TO_BALL_ACTION)
    speeds = np.hypot(commands[:, 0], commands[:, 1])
    assert speeds.max() == pytest.approx(GO_TO_BALL_ACTION.max_speed)


def test_a_kick_is_multiplied_by_the_robots_factor() -> None:
    kick, hold = filled(np.array([[0.0, 0.1], [0.0, 0.0]]), SHOOT_ACTION, 0.5)[:, 3]
    assert kick == 0.5 * SHOOT_ACTION.kick_speed
    assert hold == 0.0


@pytest.mark.parametrize("bad", [np.nan, np.inf])
@pytest.mark.parametrize("scaling", [GO_TO_BALL_ACTION, SHOOT_ACTION, BOTH])
def test_an_action_that_is_not_finite_is_refused(scaling: ActionScaling, bad: float) -> None:
    actions = np.zeros((3, scaling.size))
    actions[1, -1] = bad
    assert filled(actions, scaling) is None
