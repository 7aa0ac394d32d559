"""Robots of arenas moved by any play: trees are ticked one by one, as in a match."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from robobt.learning.opponents.play_settings import PlaySettings
from robobt.match.players import Player, shut_down
from robobt.sim.arenas import Arenas
from robobt.sim.world import command_row, robot_states
from robobt.skills.store import Store, TeamStore
from robobt.tree import TreeRunner
from robobt.world.game import OPEN_PLAY, GameState, Team
from robobt.world.geometry import FloatArray
from robobt.world.limits import RobotLimits
from robobt.world.records import shared_view
from robobt.world.state import BallState, Frame, RobotId, RobotState


class PlayedRobots:
    """Robots with their own trees in each arena; a team's robots share its store.

    They see the arena's true state, as in a match without noise and delay, in open play or in the state that
    ``game`` returns. A robot whose tree fails stands still for that tick.

    Args:
        plays: the plays by robots' indices.
        blue: number of an arena's blue robots, which come first.
        limits: what each robot can do.
        n: number of arenas.
        game: the state of the game in an arena, as blue sees it; None for open play.
    """

    def __init__(
        self,
        plays: Mapping[int, PlaySettings],
        blue: int,
        limits: Sequence[RobotLimits],
        n: int,
        game: Callable[[int], GameState] | None = None,
    ) -> None:
        self._plays = dict(plays)
        self._game = game
        self._blue = list(enumerate(limits[:blue]))
        self._yellow = list(enumerate(limits[blue:]))
        self._players: list[dict[int, Player]] = [{} for _ in range(n)]
        self._ticks = [0] * n

    def restart(self, arenas: Arenas, which: NDArray[np.int64]) -> None:
        """Reset these ``arenas``."""
        if not self._plays:
            return
        for arena in which.tolist():
            self._ticks[arena] = 0
            frame, teams = self._frame(arenas, arena), {team: TeamStore() for team in Team}
            shut_down(self._players[arena].values())
            self._players[arena] = {}
            for index, play in self._plays.items():
                blue = len(self._blue)
                robot = RobotId(Team.BLUE, index) if index < blue else RobotId(Team.YELLOW, index - blue)
                store = Store(frame, RobotState(robot.number, 0.0, 0.0), team=teams[robot.team])
                self._players[arena][index] = Player(robot, TreeRunner(play.build_tree(), store), store)

    def decide(self, arenas: Arenas, commands: FloatArray, ticks: int = 1) -> None:
        """Decide for some control ``ticks``: fill these robots' commands (n, R, COMMAND)."""
        if not self._plays:
            return
        for arena, players in enumerate(self._players):
            frame = self._frame(arenas, arena)
            views = {team: shared_view(frame, team) for team in Team}
            for index, player in players.items():
                view = views[player.robot.team]
                told = player.decide(view, view.own[player.robot.number])
                commands[arena, index] = 0.0 if told is None else command_row(told)
            self._ticks[arena] += ticks

    def _frame(self, arenas: Arenas, arena: int) -> Frame:
        """Return an arena's frame as blue sees it."""
        robots, contact = arenas.robots[arena].tolist(), arenas.contact[arena].tolist()
        (x, y, vx, vy), (z, vz, _) = arenas.balls[arena].tolist(), arenas.flight[arena].tolist()
        touch, blue = int(arenas.touch[arena]), len(self._blue)
        touched = RobotId(Team.BLUE, touch) if touch < blue else RobotId(Team.YELLOW, touch - blue)
        return Frame(
            self._ticks[arena] * arenas.period,
            arenas.field,
            BallState(x, y, vx, vy, z, vz),
            robot_states(self._blue, robots[:blue], contact[:blue]),
            robot_states(self._yellow, robots[blue:], contact[blue:]),
            Team.BLUE,
            arenas.period,
            OPEN_PLAY if self._game is None else self._game(arena),
            last_touch=touched if touch >= 0 else None,
            ball_model=arenas.settings.ball.model,
        )
