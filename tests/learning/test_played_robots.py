"""Any play is an opponent in the arenas, as it is in a match."""

from __future__ import annotations

import numpy as np
import pytest
from pydantic import ValidationError

from robobt.config.validation import first_problem
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.match.players import Player
from robobt.plays import PLAYS
from robobt.sim import SimWorld
from robobt.skills.store import Store, TeamStore
from robobt.tree import TreeRunner
from robobt.world import GameState, Placement, RefereeCommand, RobotCommand, RobotId, RobotState, Team

STAY = np.array([[0.0, 0.0, 0.0, -1.0]])


def task(*plays: object, n: int = 1, **changes: object) -> SoccerTask:
    settings = {"yellow": ["play"] * len(plays), "plays": plays, "decide_every": 1, **changes}
    return SoccerTask(SoccerSettings.model_validate(settings), n, seed=4)


@pytest.mark.parametrize("plays", [("attack_main",), ("team_goalkeeper", "team_player", "team_player")])
def test_a_play_does_in_an_arena_what_it_does_in_a_match(plays: tuple[str, ...]) -> None:
    made = task(*plays, starts={"yellow_x": (0.5, 1.5), "ball_x": (-0.5, 0.5), "y": (-1.0, 1.0)})
    made.reset()
    settings, start = made.settings, made.arenas
    me, others = RobotId(Team.BLUE, 0), [RobotId(Team.YELLOW, k) for k in range(len(plays))]
    limits = {me: settings.robot_limits, **dict.fromkeys(others)}
    world = SimWorld(settings.field, limits, settings.stepped_simulator, settings.period)
    poses = {robot: tuple(start.robots[0, k, :3]) for k, robot in enumerate([me, *others])}
    world.reset(Placement(poses, tuple(start.balls[0])), seed=0)
    shared, view = TeamStore(), world.observe().mirrored()
    players = []
    for robot, play in zip(others, plays, strict=True):
        store = Store(view, RobotState(robot.number, 0.0, 0.0), team=shared)
        players.append(Player(robot, TreeRunner(PLAYS[play](), store), store))
    for _ in range(70):
        view = world.observe().mirrored()
        commands = {each.robot: each.decide(view, view.own[each.robot.number]) for each in players}
        sent = {robot: command for robot, command in commands.items() if command is not None}
        world.act({me: RobotCommand(dribbler=True), **sent})
        made.advance(STAY)
        seen = world.observe()
        now = [[it.x, it.y, it.heading, it.vx, it.vy, it.omega] for it in (*seen.own, *seen.opponents)]
        np.testing.assert_allclose(made.arenas.robots[0], now, rtol=0, atol=1e-9)
    assert made.arenas.touch[0] > 0


def test_episodes_start_anew_and_arenas_do_not_know_of_each_other() -> None:
    rows = task("attack_main").sample_starts(7, 2)

    def played(*starts: int) -> np.ndarray:
        made = task("attack_main", n=len(starts), time_limit=20)
        made.reset_to(rows[list(starts)])
        for _ in range(15):
            made.step(np.tile(STAY, (len(starts), 1)))
        return made.arenas.robots.copy()

    np.testing.assert_array_equal(played(0, 1), np.concatenate((played(0), played(1))))
    made = task("attack_main", time_limit=15)
    made.reset_to(rows[[1, 0]])
    ends = [made.step(STAY).truncated[0] for _ in range(15)]
    assert ends == [False] * 14 + [True]
    for _ in range(14):
        made.step(STAY)
    fresh = task("attack_main", time_limit=20)
    fresh.reset_to(rows[[0]])
    for _ in range(14):
        fresh.step(STAY)
    np.testing.assert_allclose(made.arenas.robots, fresh.arenas.robots, atol=1e-9)


def test_a_play_has_its_parameters() -> None:
    def after(play: object) -> np.ndarray:
        made = task(play, starts={"yellow_x": (1.0, 1.5), "ball_x": (-2.5, -2.0)})
        made.reset()
        for _ in range(30):
            made.advance(STAY)
        return made.arenas.robots[0, 1, :2] - made.arenas.balls[0, :2]

    slow, fast = (
        np.hypot(*after({"play": "attack_main", "params": {"speed_factor": speed}})) for speed in (0.2, 2.0)
    )
    assert slow > fast + 0.5


def test_a_play_takes_its_restart_and_leaves_the_ball_alone_then() -> None:
    made = task("team_player", rules={"restarts": True, "double_touch": True})
    # Blue's robot puts the ball out, over the touch line before it.
    made.reset_to([0, 2.5, np.pi / 2, 0, 0, 0, 2, 1, 0, 0, 0, 0, 0, 2.5968, 0, 0])
    made.advance(np.array([[0.0, 0.0, 0.0, 1.0]]))
    touched = []
    for _ in range(220):
        made.advance(STAY)
        assert made.ended is None
        touched.append(int(made.arenas.touch[0]))
    assert touched[-1] == 1
    # Nothing has stopped play since: a second touch would have been blue's free kick.
    assert made.game(0) == GameState(RefereeCommand.DIRECT_FREE_YELLOW)


@pytest.mark.parametrize(
    ("plays", "said"),
    [
        ([], "plays: names 0, for 1 robots with the role play"),
        (["nobody"], "plays.0.play: no play is called 'nobody'; 'robobt list plays' lists all"),
        ([{"play": "attack_main", "params": {"sped": 1}}], "plays.0.params.sped: attack_main has no such"),
        (
            [{"play": "attack_main", "params": {"speed_factor": "x"}}],
            "plays.0.params.speed_factor: input should be",
        ),
    ],
)
def test_every_such_robot_needs_a_play_that_can_be_built(plays: list[object], said: str) -> None:
    with pytest.raises(ValidationError) as raised:
        SoccerSettings.model_validate({"yellow": ["play"], "plays": plays})
    assert ": ".join(first_problem(raised.value, SoccerSettings)).removeprefix(": ").startswith(said)
