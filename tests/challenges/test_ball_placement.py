"""The ball placement challenge: what earns points."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.challenges.ball_placement import PLACEMENTS, BallPlacement, PlacementJudge, PlacementReferee
from robobt.challenges.run import ChallengeEntry, play_run
from robobt.match.loop import MatchLoop
from robobt.world.field import DIVISION_B
from robobt.world.game import RefereeCommand, Restart
from robobt.world.geometry import Point
from robobt.world.state import BallState, Frame, RobotState
from robobt.worlds import sim_world

START, SPOT = (-1.0, -3.15), (-3.5, -2.8)


Ball = tuple[float, float, float]
"""x, y and the speed along x [m, m, m/s]."""


def judged(*balls: Ball, contact: bool = False, boundary: bool = True) -> PlacementJudge:
    """Return a judge that has seen the ball at its start, then at each of these places, 1 s apart."""
    referee, judge = PlacementReferee(START, SPOT), PlacementJudge(SPOT, boundary)
    for second, (x, y, speed) in enumerate([(*START, 0.0), (*START, 0.0), *balls]):
        robots = (RobotState(0, 2.0, 2.0, ball_contact=contact),)
        frame = Frame(float(second), DIVISION_B, BallState(x, y, speed), robots)
        judge.see(frame, referee.update(frame).game)
    return judge


def points(*balls: Ball, **given: bool) -> dict[str, float]:
    return dict(judged(*balls, **given).figures())


def test_an_untouched_ball_earns_nothing() -> None:
    assert points()["points"] == 0.0


def test_a_ball_at_the_boundary_that_nobody_moves_earns_nothing() -> None:
    attempt = BallPlacement().attempts(np.random.default_rng(1))[5]
    attempt = ChallengeEntry("ball_placement", ("stand_still", {})).of(attempt)
    judge = attempt.judge()
    with MatchLoop(attempt.scenario, 1, sim_world, referee=attempt.referee) as match:
        for _ in range(4):
            truth = match.world.truth()
            match.tick()
            judge.see(truth, match.game)
    assert judge.figures()["points"] == 0.0


def test_the_dribbler_earns_a_point() -> None:
    assert points(contact=True)["dribbler"] == 1.0


@pytest.mark.parametrize(("way", "earned"), [(0.49, 0.0), (0.51, 1.0)])
def test_half_a_metre_counts_as_moved(way: float, earned: float) -> None:
    assert points((START[0] - way, START[1], 1.0))["moved"] == earned


def test_a_ball_inside_the_lines_has_left_the_boundary() -> None:
    inside = (-1.0, -2.9, 1.0)
    assert points(inside)["off boundary"] == 1.0
    assert points(inside, boundary=False)["off boundary"] == 0.0


def test_a_ball_that_rolls_past_the_spot_has_not_stopped_there() -> None:
    assert points((-3.5, -2.6, 1.0))["stopped near"] == 0.0
    rolls_on = points((-3.5, -2.6, 0.0), (-2.0, -2.0, 1.0))
    assert (rolls_on["stopped near"], rolls_on["near"]) == (1.0, 0.0)


def test_a_ball_at_rest_at_its_spot_is_placed() -> None:
    told = points(*[(*SPOT, 0.0)] * 8)
    assert told["placed"] == 1.0
    assert told["points"] == 5.0


def test_play_is_stopped_for_two_seconds_and_the_ball_put_down_once() -> None:
    referee = PlacementReferee(START, SPOT)
    first, stopped, placing = (
        referee.update(Frame(time, DIVISION_B, BallState(0.0, 0.0))) for time in (0.0, 1.9, 2.0)
    )
    assert (first.place_ball, stopped.place_ball) == (START, None)
    assert stopped.game.command is RefereeCommand.STOP
    assert (placing.game.restart, placing.game.placement) == (Restart.BALL_PLACEMENT, SPOT)


def test_the_scores_are_added() -> None:
    assert len(PLACEMENTS) == 8
    one: dict[str, float] = {"points": 5.0, "placed": 1.0, "time": 10.0}
    assert BallPlacement().score([one] * 8) == {"points": 40.0, "placed": 8.0, "time": 80.0}
    assert sum(5 + boundary for _, _, boundary in PLACEMENTS) == BallPlacement.most


@pytest.mark.integration
def test_the_team_places_every_ball() -> None:
    result = play_run(ChallengeEntry("ball_placement", ("team_player", {})), 0, 1, sim_world)
    assert result.figures["placed"] == 8.0


def test_distances_are_in_metres() -> None:
    places: list[Point] = [place for start, spot, _ in PLACEMENTS for place in (start, spot)]
    assert all(DIVISION_B.contains(*place, 0.16) for place in places)
