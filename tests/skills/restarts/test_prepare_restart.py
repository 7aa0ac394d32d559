from __future__ import annotations

from math import hypot

import pytest

from robobt.skills.restarts.prepare_restart import PrepareRestart
from robobt.skills.store import Pass
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import DIVISION_B, FieldGeometry, Restart, Team
from robobt.world.geometry import direction, wrap_angle
from tests.skills.fixed_world import Alone, moved
from tests.skills.refereed import OPEN, Drive, free_kick, kickoff, penalty, stop_before

SPOTS = [(1.0, 2.8), (4.3, 2.8), (4.3, -2.8), (-3.5, 2.8), (0.0, 0.0)]


@pytest.mark.parametrize("spot", SPOTS, ids=str)
def test_in_a_stop_it_waits_half_a_metre_from_the_spot(spot: tuple[float, float]) -> None:
    game = stop_before(Restart.FREE_KICK, Team.BLUE, spot)
    drive = Drive(PrepareRestart(), robot(0.0, 1.0, number=1), game, spot)
    assert 0.59 < hypot(drive.end.x - spot[0], drive.end.y - spot[1]) < 0.8
    assert drive.status is Status.RUNNING
    assert max(state.speed for state in drive.way) <= 1.5 + 1e-9


def test_on_a_field_too_small_for_the_distance_it_waits_beyond_the_middle() -> None:
    tiny = FieldGeometry(length=0.9, width=0.9, goal_width=0.3, defense_width=0.3, defense_depth=0.1)
    game = stop_before(Restart.KICKOFF, Team.BLUE, (0.0, 0.0))
    view = frame(robot(-0.2, 0.1, number=1), (0.0, 0.0), game=game, field=tiny)
    alone = Alone(PrepareRestart())
    assert alone.tick(view, 1) is Status.RUNNING
    assert alone.command.finite()


def test_before_a_kick_off_it_waits_in_the_circle_behind_the_ball() -> None:
    drive = Drive(PrepareRestart(), robot(-2.0, 1.0, number=1), kickoff(Team.BLUE, False), (0.0, 0.0))
    end = drive.end
    assert -0.5 < end.x < -0.12
    assert abs(end.y) < 0.02
    assert abs(end.heading) < 0.05
    assert drive.status is Status.RUNNING


def test_it_comes_round_the_ball_without_touching_it() -> None:
    drive = Drive(PrepareRestart(), robot(1.0, 0.1, number=1), kickoff(Team.BLUE, False), (0.0, 0.0))
    assert min(hypot(state.x, state.y) for state in drive.way) > 0.09 + 0.0215
    assert drive.end.x < -0.12


def test_before_a_penalty_it_looks_over_the_ball_at_the_goal() -> None:
    spot = (-1.5, 0.0)
    end = Drive(PrepareRestart(), robot(-3.0, 1.0, number=1), penalty(Team.BLUE, spot), spot).end
    assert abs(wrap_angle(end.heading - direction(spot, DIVISION_B.their_goal))) < 0.05
    assert end.x < spot[0]


def test_it_is_done_when_the_restart_may_be_taken() -> None:
    view = frame(robot(number=1), SPOTS[0], game=free_kick(Team.BLUE, SPOTS[0]))
    assert Alone(PrepareRestart()).tick(view, 1) is Status.SUCCESS


def test_it_stays_behind_the_ball_until_the_kick_if_told_so() -> None:
    spot = (1.0, 2.8)
    game = free_kick(Team.BLUE, spot)
    drive = Drive(PrepareRestart(stay=True), robot(0.3, 2.2, number=1), game, spot)
    assert drive.status is Status.RUNNING
    assert hypot(drive.end.x - spot[0], drive.end.y - spot[1]) == pytest.approx(0.25, abs=0.03)


@pytest.mark.parametrize("game", [OPEN, free_kick(Team.YELLOW, SPOTS[0])], ids=["in play", "theirs"])
def test_it_fails_without_a_restart_of_ours(game: object) -> None:
    view = frame(robot(number=1), SPOTS[0], game=game)  # type: ignore[arg-type]
    assert Alone(PrepareRestart()).tick(view, 1) is Status.FAILURE


def test_before_a_kick_off_to_go_back_it_waits_in_its_own_half_all_the_same() -> None:
    me = robot(-0.2, 0.0, number=1)
    alone = Alone(PrepareRestart())
    alone.store.pass_ = Pass(2, (-3.0, 0.5), 3.0, 0.9)
    for _ in range(120):
        alone.tick(frame(me, (0.0, 0.0), game=kickoff(Team.BLUE, False)), 1)
        me = moved(me, alone.command, 1 / 60)
    assert me.x < -0.09
    assert 0.2 < hypot(me.x, me.y) < 0.5
