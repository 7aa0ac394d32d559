"""The robots of a team: what each does at the referee's word, and whole matches in the simulator."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import cos, hypot, sin

import pytest

from robobt.match import load_scenario
from robobt.match.loop import MatchLoop
from robobt.match.referee.settings import RefereeSettings
from robobt.plays import defender, field_player, refereed_goalkeeper
from robobt.skills.store import Store, TeamStore
from robobt.tree import Behaviour, TreeRunner
from robobt.world import (
    DIVISION_B,
    BallState,
    Frame,
    GameState,
    Restart,
    RobotCommand,
    RobotId,
    RobotState,
    Team,
)
from robobt.world.presence import without_absent
from robobt.world.rules import in_own_defense_area, touches
from robobt.worlds import sim_world
from tests.skills.fixed_world import moved
from tests.skills.refereed import HALT, OPEN, STOP, free_kick, kickoff, penalty, penalty_in_play, stop_before

pytestmark = pytest.mark.integration

PERIOD = 1 / 60
CLEAR = 0.5 + 0.09
SPOT = (1.0, 1.5)

Point = tuple[float, float]


def six() -> dict[int, Behaviour]:
    return {
        0: refereed_goalkeeper(),
        1: defender(place=0, size=2),
        2: defender(place=1, size=2),
        3: field_player(),
        4: field_player(),
        5: field_player(),
    }


STARTS: dict[int, Point] = {
    0: (-4.3, 0.0),
    1: (-3.2, 0.3),
    2: (-3.2, -0.3),
    3: (-0.7, 0.0),
    4: (0.6, 1.4),
    5: (1.0, -1.5),
}


class Squad:
    """Six robots of one team that drive without contacts; the ball lies where it is put."""

    def __init__(
        self, game: GameState, ball: tuple[float, ...], starts: Mapping[int, Point] = STARTS
    ) -> None:
        self.game, self.ball = game, BallState(*ball)
        self.opponents: tuple[RobotState, ...] = ()
        self.last_touch: RobotId | None = None
        self.time = 0.0
        self.robots = {number: RobotState(number, *place) for number, place in starts.items()}
        team = TeamStore()
        view = self.frame()
        self.stores = {number: Store(view, self.robots[number], team=team) for number in self.robots}
        trees = six()
        self.runners = {number: TreeRunner(trees[number], self.stores[number]) for number in self.robots}
        self.commands: dict[int, RobotCommand] = {}

    def frame(self) -> Frame:
        return Frame(
            self.time,
            DIVISION_B,
            self.ball,
            tuple(self.robots.values()),
            self.opponents,
            Team.BLUE,
            PERIOD,
            self.game,
            self.last_touch,
        )

    def tick(self) -> None:
        view = self.frame()
        for number, runner in self.runners.items():
            store = self.stores[number]
            store.frame, store.me, store.command = view, self.robots[number], RobotCommand()
            runner.tick()
            assert runner.error is None, runner.error
            self.commands[number] = store.command
        for number, command in self.commands.items():
            self.robots[number] = moved(self.robots[number], command, PERIOD)
        self.time += PERIOD

    def play(self, seconds: float) -> Iterator[None]:
        """Tick by tick."""
        for _ in range(round(seconds / PERIOD)):
            self.tick()
            yield

    def run(self, seconds: float) -> Squad:
        for _ in self.play(seconds):
            pass
        return self

    def gap(self, number: int, place: Point | None = None) -> float:
        x, y = place or self.ball.position
        return hypot(self.robots[number].x - x, self.robots[number].y - y)

    def tips(self) -> dict[int, str]:
        """The name of what each robot does."""
        found = {}
        for number, runner in self.runners.items():
            tip = runner.root.tip()
            assert tip is not None
            found[number] = type(tip).__name__
        return found


def held_by(me: RobotState) -> tuple[float, float]:
    return (me.x + 0.0965 * cos(me.heading), me.y + 0.0965 * sin(me.heading))


# At the referee's word.


def test_everybody_stands_still_in_a_halt() -> None:
    squad = Squad(HALT, (0.0, 0.0))
    squad.tick()
    assert all(command == RobotCommand() for command in squad.commands.values())


def test_nobody_is_fast_near_the_ball_or_kicks_in_a_stop() -> None:
    squad = Squad(STOP, (-0.5, 0.1))
    for _ in squad.play(4.0):
        assert all(robot.speed <= 1.5 + 1e-9 for robot in squad.robots.values())
        assert all(command.kick_speed == 0.0 for command in squad.commands.values())
    assert all(squad.gap(number) >= CLEAR for number in squad.robots)


def test_robots_that_were_fast_slow_down_in_a_stop() -> None:
    squad = Squad(STOP, (3.0, 2.0))
    squad.robots[3] = RobotState(3, -0.7, 0.0, vx=3.0)
    squad.run(0.5)
    assert squad.robots[3].speed <= 1.5 + 1e-9


@pytest.mark.parametrize("spot", [SPOT, (4.3, 2.8), (-3.5, -2.8), (-2.5, 0.5)], ids=str)
def test_everybody_keeps_off_the_opponents_free_kick(spot: Point) -> None:
    squad = Squad(stop_before(Restart.FREE_KICK, Team.YELLOW, spot), (spot[0], spot[1] + 0.3))
    squad.run(2.0)
    squad.ball, squad.game = BallState(*spot), free_kick(Team.YELLOW, spot)
    squad.run(2.0)
    for _ in squad.play(2.0):
        assert all(squad.gap(number) >= CLEAR - 0.01 for number in squad.robots)


def test_the_nearest_robot_takes_our_free_kick_and_nobody_else_comes_near() -> None:
    squad = Squad(stop_before(Restart.FREE_KICK, Team.BLUE, SPOT), SPOT)
    for _ in squad.play(2.0):
        assert all(command.kick_speed == 0.0 for command in squad.commands.values())
    assert all(squad.gap(number) >= CLEAR for number in squad.robots)
    squad.game = free_kick(Team.BLUE, SPOT)
    kicked = set()
    for _ in squad.play(2.0):
        kicked |= {number for number, command in squad.commands.items() if command.kick_speed > 0.0}
        assert all(squad.gap(number) > 0.3 for number in squad.robots if number != 4)
    assert kicked == {4}


def test_the_kicker_of_a_free_kick_does_not_go_for_the_ball_again() -> None:
    squad = Squad(free_kick(Team.BLUE, SPOT), SPOT, {**STARTS, 4: (SPOT[0] - 0.2, SPOT[1])})
    squad.run(0.2)
    squad.game, squad.ball, squad.last_touch = OPEN, BallState(1.7, 1.5), RobotId(Team.BLUE, 4)
    for _ in squad.play(1.0):
        assert squad.gap(4) > 0.3
        assert squad.commands[4].kick_speed == 0.0
    squad.last_touch = RobotId(Team.YELLOW, 2)
    squad.robots[4] = RobotState(4, 1.0, 1.5)
    squad.run(2.0)
    assert min(squad.gap(number) for number in (3, 4, 5)) < 0.3


@pytest.mark.parametrize("team", list(Team), ids=["ours", "theirs"])
def test_before_a_kick_off_everybody_is_in_the_own_half(team: Team) -> None:
    squad = Squad(kickoff(team, may_touch=False), (0.0, 0.0))
    squad.run(4.0)
    inside = [number for number in squad.robots if squad.gap(number) < 0.5 + 0.09]
    assert len(inside) == (1 if team is Team.BLUE else 0)
    assert all(robot.x < 0.0 and robot.speed < 0.05 for robot in squad.robots.values())


def test_nobody_touches_the_ball_before_our_kick_off_and_one_takes_it_then() -> None:
    squad = Squad(kickoff(Team.BLUE, may_touch=False), (0.0, 0.0))
    for _ in squad.play(4.0):
        assert all(squad.gap(number) > 0.12 for number in squad.robots)
    squad.game = kickoff(Team.BLUE, may_touch=True)
    kicked = set()
    for _ in squad.play(2.0):
        kicked |= {number for number, command in squad.commands.items() if command.kick_speed > 0.0}
    assert len(kicked) == 1


@pytest.mark.parametrize("team", list(Team), ids=["ours", "theirs"])
def test_before_a_penalty_kick_everybody_is_behind_the_ball(team: Team) -> None:
    spot = (-1.5, 0.0) if team is Team.BLUE else (1.5, 0.0)
    squad = Squad(penalty(team, spot), spot)
    squad.run(6.0)
    behind = {
        number: (spot[0] - robot.x) * (1.0 if team is Team.BLUE else -1.0)
        for number, robot in squad.robots.items()
    }
    near = [number for number, gap in behind.items() if gap < 1.0]
    if team is Team.BLUE:
        assert len(near) == 1
        assert behind[near[0]] > 0.1
    else:
        assert near == [0]
        assert abs(squad.robots[0].x + DIVISION_B.half_length) <= 0.09


def test_the_ball_of_a_penalty_kick_is_played_by_its_taker_alone() -> None:
    squad = Squad(penalty(Team.BLUE, (-1.5, 0.0)), (-1.5, 0.0))
    squad.run(6.0)
    takers = [number for number in squad.robots if squad.gap(number) < 0.5]
    squad.game = penalty_in_play(Team.BLUE)
    squad.ball = BallState(-1.0, 0.3)
    squad.run(2.0)
    assert [number for number in squad.robots if squad.gap(number) < 0.5] == takers
    assert all(-1.0 - robot.x >= 1.0 for number, robot in squad.robots.items() if number not in takers)


# Open play.


def test_one_robot_goes_for_the_ball() -> None:
    squad = Squad(OPEN, (0.0, 0.5))
    squad.run(0.8)
    assert [number for number in (3, 4, 5) if squad.gap(number) < 0.35] == [3]
    assert min(squad.gap(number) for number in (4, 5)) > 0.5


def test_defenders_wall_while_the_ball_is_far() -> None:
    squad = Squad(OPEN, (2.0, 1.0))
    squad.run(2.0)
    for number in (1, 2):
        robot = squad.robots[number]
        assert squad.tips()[number] == "Wall"
        assert in_own_defense_area(DIVISION_B, robot.x, robot.y, 0.16)


def test_a_defender_clears_a_ball_near_the_own_area() -> None:
    squad = Squad(OPEN, (-2.8, 0.6))
    kicked = set()
    for _ in squad.play(2.0):
        kicked |= {number for number, command in squad.commands.items() if command.kick_speed > 0.0}
    assert kicked == {1}


def test_nobody_but_the_keeper_goes_for_a_ball_in_our_area() -> None:
    squad = Squad(OPEN, (-4.0, 0.3))
    for _ in squad.play(3.0):
        for number in range(1, 6):
            robot = squad.robots[number]
            assert not in_own_defense_area(DIVISION_B, robot.x, robot.y, 0.0)


def test_field_players_mark_opponents_in_our_half_while_the_ball_is_there() -> None:
    squad = Squad(OPEN, (-1.5, -1.0))
    squad.opponents = (
        RobotState(7, -1.5, -1.1, 1.57),
        RobotState(8, -2.0, 1.5),
        RobotState(9, -1.0, 2.0),
    )
    for _ in squad.play(2.0):
        # The attacker is kept from the ball, which else would be ours.
        squad.robots[3] = RobotState(3, -1.2, -0.5)
    assert squad.tips()[4] == squad.tips()[5] == "MarkOpponent"
    marked = {
        opponent.id
        for opponent in squad.opponents
        for number in (4, 5)
        if hypot(squad.robots[number].x - opponent.x, squad.robots[number].y - opponent.y) < 0.4
    }
    assert marked == {8, 9}


def test_field_players_without_the_ball_support_in_the_other_half() -> None:
    squad = Squad(OPEN, (0.5, 0.5))
    squad.robots[3] = RobotState(3, 0.4, 0.5, ball_contact=True)
    squad.ball = BallState(*held_by(squad.robots[3]))
    for _ in range(150):
        squad.robots[3] = RobotState(3, 0.4, 0.5, ball_contact=True)
        squad.tick()
    places = [squad.robots[number] for number in (4, 5)]
    assert all(robot.x > 0.0 for robot in places)
    assert hypot(places[0].x - places[1].x, places[0].y - places[1].y) > 1.0


def test_an_attacker_lets_the_ball_go_before_it_has_carried_it_a_metre() -> None:
    squad = Squad(OPEN, (0.0, 0.0))
    carried = []
    for step in range(90):
        x = 0.7 / 60 * step
        me = RobotState(3, x, 0.0, vx=0.7, ball_contact=True)
        squad.robots[3] = me
        squad.ball = BallState(*held_by(me), 0.7, 0.0)
        squad.tick()
        if squad.tips()[3] == "Stop":
            carried.append(x)
    assert carried
    assert 0.5 < carried[0] < 0.8


def test_a_pressed_attacker_kicks_the_ball_away() -> None:
    squad = Squad(OPEN, (0.0, 0.0))
    squad.opponents = (RobotState(1, 0.25, 0.1),)
    kicked = False
    for _ in range(60):
        robot = squad.robots[3]
        squad.robots[3] = RobotState(3, 0.0, 0.0, robot.heading, omega=robot.omega, ball_contact=True)
        squad.ball = BallState(*held_by(squad.robots[3]))
        squad.tick()
        kicked = kicked or squad.commands[3].kick_speed > 0.0
    assert kicked


# Whole matches in the simulator.

SETTLED = 0.7
"""Time a robot has to react to a stop [s]."""


@dataclass
class Played:
    """What was seen in a match."""

    errors: list[str] = field(default_factory=list)
    in_play: float = 0.0
    touches_in_stop: int = 0
    fastest_in_stop: float = 0.0
    restarts: int = 0
    taken: int = 0
    outside: int = 0
    ball_way: float = 0.0


@pytest.fixture(scope="module", params=["six_v_six", "three_v_three"])
def played(request: pytest.FixtureRequest) -> Played:
    """Fifty seconds of a bundled match, with stops long enough to see who minds them."""
    scenario = load_scenario(request.param).lasting(50.0)
    scenario = scenario.model_copy(update={"referee": RefereeSettings(stop_time=1.5, placement="by_hand")})
    match = MatchLoop(scenario, 1, sim_world)
    seen = Played()
    before, since = match.game, 0.0
    ball: Point = (0.0, 0.0)
    ticks = 0
    while match.tick():
        # A robot that a card has cost is behind the wall.
        game, frame = match.game, without_absent(match.world.truth(), match.game)
        everybody = (*frame.own, *frame.opponents)
        ticks += 1
        if game.command is not before.command:
            since = frame.time
        if game.restart is not None and game.may_touch and not before.may_touch:
            seen.restarts += 1
        if before.restart is not None and before.may_touch and game.in_play:
            seen.taken += 1
        if game.stopped and frame.time - since > SETTLED:
            seen.touches_in_stop += sum(touches(robot, frame.ball) for robot in everybody)
            seen.fastest_in_stop = max(seen.fastest_in_stop, *(robot.speed for robot in everybody))
        seen.in_play += game.in_play
        border = frame.field.margin - 0.08
        present = without_absent(frame, game).robots().values()
        seen.outside += sum(not frame.field.contains(robot.x, robot.y, border) for robot in present)
        step = hypot(frame.ball.x - ball[0], frame.ball.y - ball[1])
        seen.ball_way += step if step < 0.3 else 0.0
        ball, before = frame.ball.position, game
    seen.in_play /= ticks
    seen.errors = [
        f"{name}: {figures.first_error}" for name, figures in match.result().robots.items() if figures.errors
    ]
    return seen


def test_a_match_runs_without_a_tree_failing(played: Played) -> None:
    assert played.errors == []


def test_the_ball_is_in_play_and_moves(played: Played) -> None:
    assert played.in_play > 0.4
    assert played.ball_way > 15.0


def test_restarts_are_taken(played: Played) -> None:
    assert played.restarts >= 1
    assert played.taken >= played.restarts - 1


def test_nobody_touches_the_ball_in_a_stop(played: Played) -> None:
    assert played.touches_in_stop == 0


def test_nobody_is_fast_in_a_stop(played: Played) -> None:
    assert played.fastest_in_stop <= 1.6


def test_nobody_leaves_the_surface(played: Played) -> None:
    assert played.outside == 0
