"""A policy in the environment that it is trained in, and as a leaf on the same play."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from robobt.learning.envs.soccer.suite import SUITE
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.models.policy import load_policy
from robobt.skills import SKILLS
from robobt.tree import Status
from robobt.world import BallState, Frame, RobotState
from robobt.world.team_view import team_view_of
from tests.models.made_models import network, team_card, write_model
from tests.skills.fixed_world import Alone


def the_leaf_does_what_it_does_in_training(
    task: str, skill: str, folder: Path, own: int = 0, decisions: int = 12
) -> None:
    """Statement: both observe and command the same, for as long as nothing ends.

    ``own`` is which of the task's learners; where it plays for blue, the observations are equal bit for bit.
    """
    made = SoccerTask(SUITE[task](rules={"held_by": None, "areas": False}), 1, seed=3)
    places = made.settings.places
    model = write_model(folder, network(made.observation.size, 4), team_card(skill, *places))
    policy, alone = load_policy(model), Alone(SKILLS[skill](policy=str(model)))
    decide, robot = made.jointly(policy), made.learners[own]
    seen = made.reset()
    for decision in range(decisions):
        mine = np.array_split(seen[0], len(made.learners))[own]
        frame = _frame(made, robot, 0.06 * decision)
        me = frame.own[robot if robot < made.blue else robot - made.blue]
        found = team_view_of(frame, me, *places)
        if robot < made.blue:
            np.testing.assert_array_equal(found, mine)
        np.testing.assert_allclose(found, mine, rtol=0, atol=1e-12)
        assert alone.tick(frame, me.id) is Status.RUNNING
        decided = alone.command
        result = made.advance(decide(seen))
        told = decided.vx, decided.vy, decided.omega, decided.kick_speed
        assert told == pytest.approx(made._commands[0, robot, :4].tolist(), abs=1e-5)
        assert decided.dribbler
        # In the second period of a decision it looks at nothing.
        elsewhere = Frame(0.06 * decision + 0.03, frame.field, BallState(-1.0, 2.0), frame.own, period=0.03)
        alone.tick(elsewhere, me.id)
        assert alone.command == decided
        assert made.ended is None
        seen = result.observation


def _frame(made: SoccerTask, robot: int, time: float) -> Frame:
    """What the robot's team sees of the arena."""
    robots = [RobotState(k, *row) for k, row in enumerate(made.arenas.robots[0].tolist())]
    ball = BallState(*made.arenas.balls[0].tolist())
    blue, yellow = tuple(robots[: made.blue]), tuple(robots[made.blue :])
    frame = Frame(time, made.settings.field, ball, blue, yellow, period=0.03)
    return frame if robot < made.blue else frame.mirrored()
