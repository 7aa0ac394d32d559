"""Who places the ball: one team, then the other, then a hand.

Source: RoboCup SSL rules, chapter "Ball Placement"; the order and the cost of a failure follow the league's
game controller.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from math import hypot

import numpy as np

from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.match.referee.restarts import Resumption
from robobt.match.referee.settings import RefereeSettings
from robobt.match.referee.teams import TeamRecord
from robobt.world.division import Division
from robobt.world.game import Restart, Team
from robobt.world.geometry import distance
from robobt.world.state import Frame

_INTERFERENCE_TIME = 10.0
"""Additional time of the placing team for each interference [s]. Source: SSL rules."""


class Placing:
    """The ball placement in each stoppage.

    Attributes:
        team: the team that places the ball now, or None.
        done: whether the team with the restart has placed the ball itself, so that it needs no preparation
            time.
        by_hand: whether the ball is placed by hand in this stoppage.
        deadline: end of the placing team's time [s].
    """

    def __init__(
        self,
        settings: RefereeSettings,
        division: Division,
        records: Mapping[Team, TeamRecord],
        generator: np.random.Generator,
    ) -> None:
        self._settings, self._division, self._records = settings, division, records
        self._generator = generator
        self.team: Team | None = None
        self.done = False
        self.by_hand = False
        self.deadline = 0.0
        self._tried: set[Team] = set()
        self._interfered: set[Team] = set()

    def begin(self, following: Resumption) -> None:
        """Begin a stoppage that leads to this restart."""
        self.team, self.done = None, False
        by_robots = following.restart not in (Restart.KICKOFF, Restart.PENALTY)
        self.by_hand = self._settings.placement == "by_hand" or not by_robots
        self._tried.clear()

    def choose(self, following: Resumption, time: float) -> Team | None:
        """Return the team that is to place the ball now; None if no team is left, then a hand places it."""
        able = [team for team in Team if team not in self._tried and self._records[team].places]
        if not able:
            self.by_hand = True
            return None
        if following.team in able:
            team = following.team
        elif following.team is None and not self._tried and len(able) > 1:
            team = able[int(self._generator.integers(len(able)))]
        else:
            team = able[0]
        return self.order(team, time)

    def order(self, team: Team, time: float) -> Team:
        """Let a team place the ball from now on."""
        self.team = team
        self.deadline = time + self._settings.placement_time
        self._interfered.clear()
        return team

    def succeed(self, following: Resumption) -> None:
        """Note that the ball is in place; if the placing team also takes the restart, it is ready at once."""
        if self.team is not None:
            record = self._records[self.team]
            record.failures = max(0, record.failures - 1)
        self.team, self.done = None, self.team is following.team

    def fail(self, frame: Frame, following: Resumption) -> tuple[RefereeEvent, Resumption]:
        """Note that the placing team's time is over; return the event and the restart that follows now."""
        team = self.team
        assert team is not None
        ball = frame.ball
        robots = frame.own if team is Team.BLUE else frame.opponents
        nearest = min((hypot(it.x - ball.x, it.y - ball.y) for it in robots), default=None)
        event = RefereeEvent(
            frame.time,
            EventKind.PLACEMENT_FAILED,
            team,
            None,
            ball.x,
            ball.y,
            {
                "remaining_distance": distance(ball.position, following.spot),
                "nearest_own_bot_distance": nearest,
            },
        )
        self._records[team].failures += 1
        self._tried.add(team)
        self.team = None
        if self._division.failure_loses_kick and following.left_field and following.team is team:
            following = replace(following, team=team.other)
        return event, following

    def interfere(self, team: Team) -> bool:
        """Give the placing team more time; return whether this counts as a foul of ``team``."""
        self.deadline += _INTERFERENCE_TIME
        counts = team not in self._interfered
        self._interfered.add(team)
        return counts
