"""A logged match: its recording, and the scenario in which its moments are played on."""

from __future__ import annotations

import tempfile
from copy import deepcopy
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from robobt.config.errors import RobobtError
from robobt.league.log.names import is_log
from robobt.match.recording import Recording, load_recording
from robobt.match.scenario.scenario import Scenario, scenario_from
from robobt.world.game import OPEN_PLAY, STARTED, GameState, Team
from robobt.world.rules import own_side, scorer

_CLOCK_SLACK = 1e-6
"""Rounding of times [s]."""


class WhatIfError(RobobtError, ValueError):
    """A moment cannot be played on; the message is one line."""


@dataclass(slots=True)
class LoggedMatch:
    """A logged match.

    Attributes:
        recording: what happened, tick by tick.
        scenario: field, simulator, and what the robots play when they no longer follow the log.
        known: whether the scenario's plays are those that really played.
    """

    recording: Recording
    scenario: Scenario
    known: bool

    def tick(self, time: float) -> int:
        """Return the number of the tick at a time [s].

        Raises:
            WhatIfError: the log holds no such time.
        """
        times = self.recording.times
        if not len(times) or not times[0] - _CLOCK_SLACK <= time <= times[-1] + _CLOCK_SLACK:
            there = f"from {times[0]:g} to {times[-1]:g} s" if len(times) else "nothing"
            raise WhatIfError(f"{self.recording.path}: holds {there}, not {time:g} s")
        return min(int(np.searchsorted(times, time - _CLOCK_SLACK)), len(times) - 1)

    def game(self, tick: int) -> GameState:
        """Return the referee's state at a tick."""
        latest = OPEN_PLAY
        for since, game in self.recording.games:
            if since > tick:
                break
            latest = game
        return latest

    def goals(self, first: int, last: int) -> dict[Team, int]:
        """Return the goals of each team from one tick to another.

        The referee's score counts, also where it changes only after play was stopped, as in the league.
        Without a referee the ball's way counts, up to the first goal.

        Args:
            first: the tick from which goals count.
            last: the last tick; play is not stopped between the two.
        """
        games = self.recording.games
        goals = dict.fromkeys(Team, 0)
        if all(game.command is OPEN_PLAY.command for _, game in games):
            field = self.recording.header.field
            balls = [self.recording.frame(tick).ball for tick in range(first, last + 1)]
            scorers = [scorer(field, before, after) for before, after in pairwise(balls)]
            if (team := next(filter(None, scorers), None)) is not None:
                goals[team] = 1
            return goals
        then, now = self.game(first), self.game(last)
        if now.command not in STARTED:
            later = [game for since, game in games if since > last]
            now = next((game for game in later if game.command in STARTED), later[-1] if later else now)
        goals[Team.BLUE] = max(0, now.blue_score - then.blue_score)
        goals[Team.YELLOW] = max(0, now.yellow_score - then.yellow_score)
        return goals

    def check_moment(self, tick: int) -> None:
        """Check that the match can be played on from a tick.

        Raises:
            WhatIfError: nobody may play the ball then, or the ball or all robots are missing.
        """
        game, time = self.game(tick), self.recording.times[tick]
        where = f"{self.recording.path}: at {time:.2f} s"
        if not playable(game):
            later = next((t for t in range(tick, len(self.recording)) if playable(self.game(t))), None)
            again = "" if later is None else f"; play goes on at {self.recording.times[later]:.2f} s"
            raise WhatIfError(f"{where} the game is stopped ({game.command.name}){again}")
        if not np.isfinite(self.recording.truth.ball[tick, :4]).all():
            raise WhatIfError(f"{where} the ball is not known")
        if not np.isfinite(self.recording.truth.robots[tick, :, 0]).any():
            raise WhatIfError(f"{where} no robot is known")


def playable(game: GameState) -> bool:
    """Return whether the ball may be played: it is in play, or a kick-off or free kick may be taken."""
    return game.penalty is None and (game.in_play or any(game.ball_for(team) == 1 for team in Team))


def load_logged(path: str | Path, simulator: str | None = None) -> LoggedMatch:
    """Load a recording or a league log.

    Args:
        path: a recording (``*.robobt.arrows``), or a league log (``*.log``, ``*.log.gz``), which is filtered.
        simulator: preset of the simulator; by default the one in which the match was played, for a league log
            the default preset.

    Raises:
        RecordingError: the recording cannot be read.
        LogError: the log cannot be read.
        ScenarioError: what played cannot be built any more, such as a Python file that is gone.
    """
    path = Path(path)
    if is_log(path):
        from robobt.league.log.world import record_log  # needs the extra league, which recordings do not

        with tempfile.TemporaryDirectory() as folder:
            recording = load_recording(record_log(path, Path(folder) / "log.robobt.arrows"))
        recording.path = path
    else:
        recording = load_recording(path)
    known = bool(recording.header.played)
    data = deepcopy(recording.header.played) if known else _stand_ins(recording)
    if simulator is not None:
        data["simulator"] = {"preset": simulator}
    return LoggedMatch(recording, scenario_from(data, str(path)), known)


def _stand_ins(recording: Recording) -> dict[str, Any]:
    """Return the scenario in which robobt's team plays for both teams of a log."""
    header = recording.header
    robots: dict[str, list[dict[str, Any]]] = {team.value: [] for team in Team}
    keepers = {team: _keeper(recording, team) for team in Team}
    for slot, robot in enumerate(header.robots):
        keeper = robot.number == keepers[robot.team]
        # Robots start elsewhere before each branch is placed.
        place = [-0.3 - 0.25 * (slot % 12), 1.0 if robot.team is Team.BLUE else -1.0]
        if robot.team is Team.YELLOW:
            place[1] = 1.0
        robots[robot.team.value].append(
            {
                "number": robot.number,
                "play": "team_goalkeeper" if keeper else "team_player",
                "goalkeeper": keeper,
                "start": {"position": place},
            }
        )
    return {
        "name": header.scenario or "log",
        "field": header.field.model_dump(mode="json"),
        "simulator": {"preset": "default"},
        "period": header.period,
        "robots": robots,
        "ball": {"position": [0.0, 0.0]},
        "ends": {"time_limit": 3600},
        "referee": {},
    }


def _keeper(recording: Recording, team: Team) -> int | None:
    """Return the goalkeeper's number: the referee's, else of the robot that is mostly nearest to its goal."""
    for _, game in recording.games:
        if (number := game.status(team).keeper) is not None:
            return number
    goal = own_side(team) * recording.header.field.half_length
    away = {
        robot.number: float(np.nanmedian(np.abs(recording.truth.robots[:, slot, 0] - goal)))
        for slot, robot in enumerate(recording.header.robots)
        if robot.team is team and np.isfinite(recording.truth.robots[:, slot, 0]).any()
    }
    return min(away, key=away.__getitem__, default=None)
