"""The compiled challengers do what the play ``team_player`` does where they say so."""

from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from numpy.typing import NDArray

from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.opponents.challengers import Challengers
from robobt.sim.arenas import Arenas
from robobt.sim.records import COMMAND
from robobt.skills.plan import Task
from robobt.skills.store import TeamStore
from robobt.skills.tactics.agree import agree
from robobt.skills.tactics_settings import TacticsSettings
from robobt.testing import frame, robot
from robobt.world import DIVISION_B, RobotLimits
from robobt.world.geometry import FloatArray
from tests.skills.refereed import OPEN

N = 7
SAME = ("GoToBall", "PickUpBall", "KickLoose", "wall")


class Beside:
    """Challengers that decide what they would do where ``team_player`` decides what is done."""

    def __init__(self, players: int, monkeypatch: pytest.MonkeyPatch) -> None:
        settings = {
            "yellow": ["play"] * players,
            "plays": ["team_player"] * players,
            "decide_every": 1,
            "rules": {"held_by": None, "areas": False},
            "starts": {"held": 0.7, "blue_x": (-1.5, 0.5), "yellow_x": (-1.5, 0.5), "y": (-1.0, 1.0)},
        }
        self.task = task = SoccerTask(SoccerSettings.model_validate(settings), N, seed=3)
        given = task.settings
        roles = ["learner"] + ["challenge"] * players
        self.twins = Challengers(given.field, given.simulator.limits, given.period, N, roles, 1)
        self.ticks: Counter[str] = Counter()
        self.same: Counter[str] = Counter()
        self._commands = np.zeros((N, 1 + players, 7))
        task.reset()
        self._decide = task._played.decide
        monkeypatch.setattr(task._played, "decide", self.decide)

    def decide(self, arenas: Arenas, commands: FloatArray) -> None:
        self.twins.restart(np.flatnonzero(self.task.ticks == 0))
        self.twins.decide(arenas.robots, arenas.balls, arenas.contact, self._commands)
        self._decide(arenas, commands)
        differ = np.abs(commands - self._commands)
        # When a kicker that has nothing to do would fire.
        differ.view(COMMAND)["on_contact"] *= commands.view(COMMAND)["kick_speed"] > 0.0
        for arena, players in enumerate(self.task._played._players):
            for index, player in players.items():
                tip = player.runner.root.tip()
                assert tip is not None
                walls = player.store.team.plan.tasks[player.robot.number] is Task.WALL
                name = "wall" if walls else tip.name
                self.ticks[name] += 1
                self.same[name] += bool(differ[arena, index].max() < 1e-6)


def at_the_ball(task: SoccerTask) -> NDArray[np.float64]:
    """Drive at the ball, without a kick."""
    me, to_ball = task.arenas.robots[:, 0], task.arenas.balls[:, :2] - task.arenas.robots[:, 0, :2]
    c, s = np.cos(me[:, 2]), np.sin(me[:, 2])
    ahead, left = c * to_ball[:, 0] + s * to_ball[:, 1], c * to_ball[:, 1] - s * to_ball[:, 0]
    drive = np.clip([ahead, left], -0.5, 0.5)
    return np.column_stack((*drive, np.clip(0.6 * np.arctan2(left, ahead), -1.0, 1.0), -np.ones(N)))


@pytest.mark.parametrize("players", [1, 2])
def test_they_do_what_the_play_does(players: int, monkeypatch: pytest.MonkeyPatch) -> None:
    both = Beside(players, monkeypatch)
    for _ in range(85):
        both.task.step(at_the_ball(both.task))
    for name in SAME[: 2 + players]:
        # Where the play does something else for a while, what it remembers differs from then on.
        assert both.same[name] > 0.9 * both.ticks[name] > 0.0, name
    assert sum(both.ticks[name] for name in SAME) > 0.5 * sum(both.ticks.values())


def chosen_in_arena(
    ball: tuple[float, float], own: list[tuple[float, float]], tactics: TacticsSettings
) -> int | None:
    """Return who of blue's challengers goes for the ball in an arena, None for nobody."""
    arenas = Challengers(
        DIVISION_B, RobotLimits(), 1 / 60, 1, ["challenge"] * len(own), len(own), tactics=tactics
    )
    robots, commands = np.zeros((1, len(own), 6)), np.zeros((1, len(own), 7))
    robots[0, :, :2] = own
    contact: NDArray[np.bool_] = np.zeros((1, len(own)), dtype=np.bool_)
    for _ in range(100):  # Until nobody is a new attacker any more.
        arenas.decide(robots, np.array([[*ball, 0.0, 0.0]]), contact, commands)
    chosen = int(arenas._plans[0, 0, 0])
    return None if chosen < 0 else chosen


def chosen_in_plan(
    ball: tuple[float, float], own: list[tuple[float, float]], tactics: TacticsSettings
) -> int | None:
    """Return who of a team goes for the ball by its plan."""
    team = TeamStore()
    team.attacker = 0
    team.plan.tactics = tactics
    team.plan.players.update(range(len(own)))
    robots = tuple(robot(x, y, number=number) for number, (x, y) in enumerate(own))
    for tick in range(100):
        agree(frame(robots[0], ball, robots[1:], time=tick / 60, game=OPEN), team)
    return team.attacker


@pytest.mark.parametrize(
    ("ball", "changes"),
    [
        ((-3.3, 0.0), {"own_reach": 0.3}),
        ((0.0, 0.0), {"behind_ball": 0.0}),
        ((0.2, 0.0), {"switch_gain": 0.0}),
    ],
)
def test_a_changed_setting_of_the_tactics_changes_who_goes_in_an_arena_as_in_a_match(
    ball: tuple[float, float], changes: dict[str, float]
) -> None:
    own = [(0.75, 0.0), (-0.75, 0.0)]
    before, after = TacticsSettings(), TacticsSettings.model_validate(changes)
    assert chosen_in_arena(ball, own, before) == chosen_in_plan(ball, own, before)
    assert chosen_in_arena(ball, own, after) == chosen_in_plan(ball, own, after)
    assert chosen_in_arena(ball, own, before) != chosen_in_arena(ball, own, after)
