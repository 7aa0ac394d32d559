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
from robobt.world.geometry import FloatArray

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
