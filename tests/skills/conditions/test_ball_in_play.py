from __future__ import annotations

import pytest

from robobt.skills.conditions.ball_in_play import BallInPlay
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import OPEN_PLAY, GameState, Team
from tests.skills.fixed_world import Alone
from tests.skills.refereed import HALT, OPEN, STOP, free_kick, kickoff


@pytest.mark.parametrize("game", [OPEN, OPEN_PLAY], ids=["after a restart", "without a referee"])
def test_the_ball_is_in_play_once_no_restart_is_pending(game: GameState) -> None:
    assert Alone(BallInPlay()).tick(frame(robot(), game=game)) is Status.SUCCESS


@pytest.mark.parametrize(
    "game",
    [HALT, STOP, free_kick(Team.BLUE, (0.0, 0.0)), kickoff(Team.BLUE, False), kickoff(Team.BLUE, True)],
    ids=["halt", "stop", "free kick", "before the kick-off", "at the kick-off"],
)
def test_the_ball_is_not_in_play_before(game: GameState) -> None:
    assert Alone(BallInPlay()).tick(frame(robot(), game=game)) is Status.FAILURE
