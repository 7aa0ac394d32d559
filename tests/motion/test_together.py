"""What is found for all robots at once is what each would find for itself."""

from __future__ import annotations

import random

import numpy as np
import pytest

from robobt.motion.arrival import meetings
from robobt.motion.meetings import meetings_of
from robobt.motion.path_planner import travel
from robobt.motion.scene import BALL_GAP
from robobt.motion.together import travel_together
from robobt.testing import frame
from robobt.world import DIVISION_B, BallState, Frame, RefereeCommand, Restart, RobotLimits, RobotState, Team
from robobt.world.game import GameState
from robobt.world.records import ball_of, movers, movers_of, shared_view
from robobt.world.rules import owner

PLACEMENT = GameState(
    command=RefereeCommand.BALL_PLACEMENT_YELLOW,
    restart=Restart.BALL_PLACEMENT,
    restart_team=Team.YELLOW,
    placement=(1.0, 1.0),
)

LIMITS = RobotLimits(max_speed=2.0), RobotLimits(max_speed=3.0)


def crowd(seed: int, game: GameState | None = None) -> Frame:
    generator = random.Random(seed)

    def one(number: int) -> RobotState:
        x, y = generator.uniform(-4.0, 4.0), generator.uniform(-2.8, 2.8)
        vx, vy = generator.uniform(-2.0, 2.0), generator.uniform(-2.0, 2.0)
        heading = generator.uniform(-3.0, 3.0)
        return RobotState(number, x, y, heading, vx, vy, 0.5, limits=LIMITS[number % 2])

    ball = BallState(generator.uniform(-4.0, 4.0), generator.uniform(-2.8, 2.8), 1.5, -0.7)
    own, opponents = (tuple([one(number) for number in range(5)]) for _ in range(2))
    return Frame(1.0, DIVISION_B, ball, own, opponents, game=game or GameState())


@pytest.mark.parametrize("game", [None, PLACEMENT])
@pytest.mark.parametrize("alike", [True, False])
def test_ways_found_together_are_those_that_each_robot_finds(game: GameState | None, alike: bool) -> None:
    for seed in range(40):
        view = crowd(seed, game)
        robots = [me for me in view.own if not alike or me.id % 2]
        ways = [(me, (0.5 * me.id, -1.0), 0.3 * me.id, 0.1 if me.id == 3 else BALL_GAP) for me in robots]
        alone = [
            travel(view, me, to, heading, me.limits, avoid_ball=True, ball_gap=gap, spare_mates=True)
            for me, to, heading, gap in ways
        ]
        assert travel_together(view, ways, spare_mates=True) == alone


def test_the_other_team_sees_the_same_robots_and_meetings() -> None:
    for seed in range(40):
        blue = crowd(seed)
        # A frame of its own, without anything that was found before.
        anew = crowd(seed).mirrored()
        rolling = 0.8
        for view in (blue, shared_view(blue, Team.YELLOW)):
            model, field = view.ball_model, view.field
            slide, roll = model.slide_deceleration, model.roll_deceleration
            everybody = movers((*view.own, *view.opponents))
            sizes = field.half_length, field.half_width
            met = meetings(everybody, ball_of(view.ball), rolling, slide, roll, *sizes)
            assert np.array_equal(movers_of(view), everybody)
            assert np.array_equal(meetings_of(view, rolling), met)
        assert np.array_equal(movers_of(shared_view(blue, Team.YELLOW)), movers_of(anew))


def test_a_mirrored_frame_may_change_before_anything_is_found_in_it() -> None:
    blue = crowd(0)
    movers_of(blue)
    yellow = blue.mirrored()
    yellow.own[0].x = 0.5
    assert np.array_equal(movers_of(yellow), movers((*yellow.own, *yellow.opponents)))


def test_who_has_the_ball_is_looked_for_once_a_frame() -> None:
    view = frame(RobotState(1, 0.0, 0.0), (0.1, 0.0))
    before = owner(view)
    view.ball.x = 3.0
    assert before is not None
    assert owner(view) == before
    view.made.clear()
    assert owner(view) is None
