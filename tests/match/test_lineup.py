"""The game controller decides who keeps goal and how many robots play."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from math import hypot

import pytest

from robobt.match import MatchLoop, lineup, load_scenario
from robobt.match.lineup import leave
from robobt.sim import SimWorld
from robobt.testing import frame, robot
from robobt.world import Frame, GameState, RefereeCommand, RobotId, Team
from robobt.world.game import TeamStatus
from robobt.world.geometry import Point, distance
from robobt.world.protocol import World
from robobt.world.rules import STOP_DISTANCE
from robobt.world.state import ROBOT_RADIUS
from robobt.worlds import sim_world

pytestmark = pytest.mark.integration


class Controlled:
    """Six against six in the simulator, refereed by whoever sets ``game``."""

    def __init__(self) -> None:
        self.game = GameState(RefereeCommand.FORCE_START)
        self.match = MatchLoop(load_scenario("six_v_six").without_referee(), 1, self._world)

    def _world(self, scenario: object) -> World:
        world = sim_world(scenario)  # type: ignore[arg-type]
        assert isinstance(world, SimWorld)
        truth = world.truth

        def judged() -> Frame:
            frame = truth()
            frame.game = self.game
            return frame

        world.truth = judged  # type: ignore[method-assign]
        type(self)._refereed(world)
        return world

    @staticmethod
    def _refereed(world: SimWorld) -> None:
        kind = type(world)
        world.__class__ = type("Refereed", (kind,), {"refereed": True, "scenario_ends": False})

    def play(self, seconds: float) -> Frame:
        for _ in range(round(seconds * 60)):
            assert self.match.tick()
        return self.match.world.truth()

    def tree_of(self, robot: RobotId) -> str:
        return next(player.runner.root.name for player in self.match.players if player.robot == robot)


def test_the_goalkeeper_is_whom_the_controller_names() -> None:
    controlled = Controlled()
    controlled.play(0.1)
    assert controlled.tree_of(RobotId(Team.BLUE, 0)) == "goalkeeper"
    controlled.game = replace(controlled.game, blue=TeamStatus(keeper=4))
    frame = controlled.play(6.0)
    assert controlled.tree_of(RobotId(Team.BLUE, 4)) == "goalkeeper"
    assert controlled.tree_of(RobotId(Team.BLUE, 0)) == "team player"
    assert controlled.tree_of(RobotId(Team.YELLOW, 0)) == "goalkeeper"
    # Its own wall may be in the way into the defence area.
    assert frame.robots()[RobotId(Team.BLUE, 4)].x < -3.0
    controlled.game = replace(controlled.game, blue=TeamStatus(keeper=0))
    controlled.play(0.1)
    assert controlled.tree_of(RobotId(Team.BLUE, 0)) == "goalkeeper"


def test_a_goalkeeper_that_does_not_play_changes_nothing(caplog: pytest.LogCaptureFixture) -> None:
    controlled = Controlled()
    controlled.game = replace(controlled.game, yellow=TeamStatus(keeper=9))
    controlled.play(0.1)
    assert controlled.tree_of(RobotId(Team.YELLOW, 0)) == "goalkeeper"
    assert len([record for record in caplog.records if "does not play here" in record.message]) == 1


def beside(frame: Frame) -> set[int]:
    """Numbers of the own robots that stand beside the field, where they count as taken off."""
    return {robot.id for robot in frame.own if abs(robot.y) > 3.0 and abs(robot.x) <= 1.0}


def test_a_team_with_a_card_takes_a_robot_off_and_brings_it_back() -> None:
    controlled = Controlled()
    controlled.game = replace(controlled.game, yellow=TeamStatus(max_robots=5))
    frame = controlled.play(6.0).seen_by(Team.YELLOW)
    assert beside(frame) == {5}
    # Its handler has carried it out of the way, behind the wall.
    assert abs(frame.robots()[RobotId(Team.YELLOW, 5)].y) > 3.3
    controlled.game = replace(controlled.game, yellow=TeamStatus(max_robots=6))
    frame = controlled.play(3.0).seen_by(Team.YELLOW)
    assert not beside(frame)
    # Inside the walls again, if beyond the touch line for a free kick from there.
    assert abs(frame.robots()[RobotId(Team.YELLOW, 5)].y) < 3.3


def test_two_robots_leave_and_the_goalkeeper_stays() -> None:
    controlled = Controlled()
    controlled.game = replace(controlled.game, blue=TeamStatus(keeper=5, max_robots=4))
    assert beside(controlled.play(6.0)) == {3, 4}


@pytest.mark.parametrize(("ball", "stays"), [((0.6, -2.84), True), ((-0.2, -3.25), False)])
def test_a_robot_that_has_left_makes_way_for_the_ball(ball: tuple[float, float], stays: bool) -> None:
    command = leave(frame(robot(-0.15, -3.15), ball), robot(-0.15, -3.15), {1})
    assert (hypot(command.vx, command.vy) < 0.01) is stays


def test_robots_that_make_way_for_the_ball_stand_apart() -> None:
    ball, places = (-0.2, -2.55), ((-0.91, -3.15), (-0.61, -3.15))
    team = tuple(robot(x, y, number=number) for number, (x, y) in enumerate(places, 4))
    for me in team:
        command = leave(replace(frame(team[0], ball), own=team), me, {4, 5})
        assert hypot(command.vx, command.vy) < 0.05


@pytest.mark.parametrize("x", [-1.4, -0.6, 0.1])
def test_three_robots_that_make_way_for_the_ball_have_places_apart(
    x: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    places: list[Point] = []
    monkeypatch.setattr(lineup, "travel", lambda _view, _me, place, *_others, **_how: places.append(place))
    team = tuple(robot(-0.3 * number, -2.9, number=number) for number in (3, 4, 5))
    for me in team:
        leave(replace(frame(team[0], (x, -2.9)), own=team), me, {3, 4, 5})
    assert all(distance(*pair) > 2.0 * ROBOT_RADIUS for pair in combinations(places, 2))
    assert all(distance(place, (x, -2.9)) > STOP_DISTANCE for place in places)


def test_a_robot_that_has_left_is_not_there_for_the_trees() -> None:
    controlled = Controlled()
    controlled.game = replace(controlled.game, blue=TeamStatus(max_robots=5))
    controlled.play(6.0)
    for player in controlled.match.players:
        if player.robot != RobotId(Team.BLUE, 5):
            seen = player.store.frame.seen_by(Team.BLUE)
            assert [robot.id for robot in seen.own] == [0, 1, 2, 3, 4]
            assert len(seen.opponents) == 6


def test_everybody_stands_in_a_halt_whatever_the_plays_are() -> None:
    controlled = Controlled()
    controlled.match = MatchLoop(load_scenario("striker_vs_goalkeeper"), 1, controlled._world)
    moving = controlled.play(0.7)
    assert max(robot.speed for robot in (*moving.own, *moving.opponents)) > 0.5
    controlled.game = GameState(RefereeCommand.HALT, may_touch=False)
    halted = controlled.play(1.0)
    assert max(robot.speed for robot in (*halted.own, *halted.opponents)) < 0.01


def test_the_ends_of_the_scenario_do_not_end_a_match_that_a_controller_decides() -> None:
    controlled = Controlled()
    controlled.match = MatchLoop(load_scenario("striker_vs_goalkeeper").lasting(0.5), 1, controlled._world)
    controlled.game = GameState(RefereeCommand.FORCE_START, blue_score=2, yellow_score=1)
    controlled.play(2.0)
    result = controlled.match.result()
    assert (result.blue_score, result.yellow_score) == (2, 1)


def test_a_scenario_with_its_own_referee_is_refused_where_a_controller_decides() -> None:
    controlled = Controlled()
    with pytest.raises(Exception, match=r"six_v_six.*referee: .*--referee none"):
        MatchLoop(load_scenario("six_v_six"), 1, controlled._world)
